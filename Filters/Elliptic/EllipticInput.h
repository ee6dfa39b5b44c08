// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticInput.h
 * @brief A boundary value problem as a user describes it, and the system it gives on a data set.
 */
#ifndef tautline_EllipticInput_h
#define tautline_EllipticInput_h

#include "MeshAdapter.h"
#include "MeshParts.h"
#include "PointFunction.h"

#include "tautline/Elliptic/EllipticSystem.h"

#include <memory>

namespace tautline
{
/// Arrays are indices of SetInputArrayToProcess.
struct EllipticChoice
{
  Pde pde = Pde::Poisson;
  Vec3 diffusion = { 1, 1, 1 }; ///< alpha, beta, gamma of Pde::Elliptic
  double reaction = 0.0;        ///< a of Pde::Elliptic
  int tensorArray = 0;          ///< of cells, instead of alpha, beta, gamma
  double youngsModulus = 1.0, poissonRatio = 0.3;
  PlaneState plane = PlaneState::Strain;
  int stiffnessArray = 0; ///< of cells: factors of Young's modulus
  PointFunction source, given;

  /// The numbers are stable: ParaView state files hold them.
  enum FixedParts
  {
    WholeBoundary = 0,
    PartOfBoundary = 1, ///< where fixedWhere is not 0
    OnlyChosen = 2      ///< by fixedArray and selection, which count in any case
  };
  int fixedPart = WholeBoundary;
  std::string fixedWhere; ///< an expression
  int fixedArray = 0;     ///< of points or cells, not 0 where points are fixed
};

/**
 * @class tautline::EllipticInput
 * @brief Keeps what the system on a mesh refers to. The orientation is settled as for movable
 * meshes.
 */
class EllipticInput
{
public:
  /**
   * @brief Collective. Throws Error, on all processes, for what EllipticSystem rejects, arrays and
   * expressions that do not fit, cells of higher order, polygons and polyhedra, and parts
   * without a consistent orientation.
   */
  EllipticInput(LocalMesh& mesh, const EllipticChoice& choice, vtkAlgorithm* algorithm,
    const Processes& processes, int threads);

  const EllipticSystem& system() const { return *this->System; }
  /// Remarks for the user on how the mesh is interpreted, as sentences, or "".
  const std::string& notice() const { return this->Notice; }

private:
  void readArrays(const EllipticChoice& choice, vtkAlgorithm* algorithm);
  void settleOrientation(const Processes& processes);
  void settleDimension(const EllipticChoice& choice, const Processes& processes);
  void markFixed(const EllipticChoice& choice, vtkAlgorithm* algorithm, const Processes& processes);

  LocalMesh& Local;
  std::unique_ptr<MeshAdapter> Adapter;
  EllipticProblem Problem;
  MeshPart Part;
  std::vector<unsigned char> Skip, Fixed;
  std::vector<double> Sources, Given, Tensors, Stiffening;
  std::string Notice;
  std::unique_ptr<EllipticSystem> System;
};
}
#endif
