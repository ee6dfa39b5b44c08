// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticChecks.h
 * @brief Checks that a boundary value problem has a solution.
 * Internal: not installed.
 */
#ifndef tautline_EllipticChecks_h
#define tautline_EllipticChecks_h

#include "EllipticProblem.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/Ranks/PointNumbering.h"

namespace tautline
{
class UnionFind;

/// Checks a mesh and a problem before anything is assembled; all ranks throw together.
class EllipticChecks
{
public:
  /// @param numbering of all points
  EllipticChecks(const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part,
    const PointNumbering& numbering, int threads);

  /// Does work on each rank; if it throws Error on one rank, all throw.
  template <class Work>
  void everywhere(const Work& work) const
  {
    std::string message;
    try
    {
      work();
    }
    catch (const Error& error)
    {
      message = error.what();
    }
    this->throwTogether(message);
  }

  void requireCoefficients() const;
  void requireValidElements() const;
  /// Points of cells, on any rank.
  std::vector<unsigned char> usedPoints() const;
  void requireData(
    const std::vector<unsigned char>& used, const std::vector<unsigned char>& fixed) const;
  /// Checks that every part of the mesh with a free point has enough fixed points.
  void requireFixedParts(
    const std::vector<unsigned char>& used, const std::vector<unsigned char>& fixed) const;
  /// Unknowns per point of elasticity; a rank without cells uses the number of the other ranks.
  int elasticUnknowns() const;

private:
  bool skipped(Index cell) const { return this->Part.skip && this->Part.skip[cell]; }
  void throwTogether(const std::string& message) const;
  void requireFlatElements() const;
  void requireInPlane(
    const double* vectors, const std::vector<unsigned char>& where, const char* name) const;
  void spreadHeld(UnionFind& parts, std::vector<unsigned char>& held) const;

  const Mesh& Input;
  const EllipticProblem& Problem;
  const MeshPart& Part;
  const PointNumbering& Numbering;
  int Threads;
};
}
#endif
