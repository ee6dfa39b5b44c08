// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedPerturbation.h
 * @brief Completes the perturbation of curved cells whose corners were perturbed as in linear
 * cells.
 */
#ifndef tautline_CurvedPerturbation_h
#define tautline_CurvedPerturbation_h

#include "CurvedMesh.h"
#include "tautline/Perturbation/PerturbOptions.h"

namespace tautline
{
/**
 * @class tautline::CurvedPerturbation
 * @brief Makes the nodes between corners follow, except fixed nodes and nodes on the boundary, and
 * keeps valid cells valid.
 */
class CurvedPerturbation
{
public:
  /**
   * @param curved the mesh, with join()
   * @param corners of CurvedMesh::corners()
   * @param fixed one flag per point
   * @param single whether coordinates are rounded to single precision
   */
  CurvedPerturbation(const CurvedMesh& curved, const MeshAdapter& corners,
    const std::vector<unsigned char>& fixed, bool single, int threads);

  /**
   * @brief Places the nodes between the corners, and counts the inverted elements again.
   * @param result with points in the coordinates of the input
   * @param keepValid whether corners retreat toward their original positions until each originally
   * valid cell is valid
   * @return the number of corners that have retreated
   */
  Index finish(Perturbation& result, bool keepValid) const;

private:
  double rounded(double x) const;
  void place(std::vector<double>& points) const;
  std::vector<signed char> validity(const std::vector<double>& points) const;
  std::vector<unsigned char> aroundWorse(
    const std::vector<signed char>& before, const std::vector<signed char>& after) const;
  bool retreat(const std::vector<unsigned char>& around, std::vector<unsigned char>& times,
    std::vector<double>& corners, Perturbation& result) const;
  void report(const std::vector<signed char>& before, const std::vector<signed char>& after,
    Perturbation& result) const;

  const CurvedMesh& Curved;
  const MeshAdapter& Corners;
  const std::vector<unsigned char>& Fixed;
  bool Single;
  int Threads;
  const double* Before;
};
}
#endif
