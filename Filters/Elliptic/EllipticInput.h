// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticInput.h
 * @brief A boundary value problem as described by a user, and its system on a data set.
 */
#ifndef tautline_EllipticInput_h
#define tautline_EllipticInput_h

#include "MeshAdapter.h"
#include "MeshParts.h"
#include "PointFunction.h"
#include "Redistribution.h"

#include "tautline/Elliptic/EllipticSystem.h"
#include "tautline/Mesh/CellDivision.h"

#include <memory>

namespace tautline
{
/// Arrays are indices of SetInputArrayToProcess.
struct EllipticChoice
{
  Pde pde = Pde::Poisson;
  Vec3 diffusion = { 1, 1, 1 }; ///< alpha, beta, gamma of Pde::Elliptic
  double reaction = 0.0;        ///< a of Pde::Elliptic
  int tensorArray = 0;          ///< cell array, instead of alpha, beta, gamma
  double youngsModulus = 1.0, poissonRatio = 0.3;
  PlaneState plane = PlaneState::Strain;
  int stiffnessArray = 0; ///< cell array: factors of Young's modulus
  PointFunction source, given;

  /// The values must not change: ParaView state files contain them.
  enum FixedParts
  {
    WholeBoundary = 0,
    PartOfBoundary = 1, ///< where fixedWhere is not 0
    OnlyChosen = 2      ///< by fixedArray and selection, which count in any case
  };
  int fixedPart = WholeBoundary;
  std::string fixedWhere; ///< an expression
  int fixedArray = 0;     ///< of points or cells, not 0 where points are fixed
  /// How the mesh is redistributed among several processes; the results go back to the pieces.
  Redistribution redistribution = Redistribution::None;
};

/**
 * @class tautline::EllipticInput
 * @brief Keeps the data that the system on a mesh refers to. The orientation is made consistent as
 * for movable meshes.
 */
class EllipticInput
{
public:
  /**
   * @brief Collective. Throws Error, on all processes, for input that EllipticSystem rejects,
   * arrays and expressions that do not fit, cells of higher order except quadratic triangles and
   * tetrahedra, polygons and polyhedra, and parts without a consistent orientation.
   */
  EllipticInput(LocalMesh& mesh, const EllipticChoice& choice, vtkAlgorithm* algorithm,
    RankGroup& processes, int threads);

  /// The system of the part that this process works on: its piece, unless redistributed.
  const EllipticSystem& system() const { return *this->System; }
  /// Remarks for the user on the interpretation of the mesh, as sentences, or "".
  const std::string& notice() const { return this->Notice; }

  /// The mesh of the piece, with the points and cells of the data set.
  const Mesh& piece() const { return this->Adapter->mesh(); }
  /// One flag per cell of the piece, nonzero for cells that do not count; or null.
  const unsigned char* skipped() const { return this->Skip.empty() ? nullptr : this->Skip.data(); }
  /// The fields of a solution of the system, at the points and in the cells of the piece.
  /// Collective, like the following functions.
  EllipticSolution fields(const std::vector<double>& unknowns) const;
  /// Converts values at the points of the piece (elasticity: 3 each) to the unknowns of the system.
  std::vector<double> unknownsOf(const std::vector<double>& ofPiece) const;
  /// Converts values of the cells of the system to the cells of the piece.
  std::vector<double> cellsOfPiece(const std::vector<double>& ofSystem) const;

private:
  void readArrays(const EllipticChoice& choice, vtkAlgorithm* algorithm);
  void settleOrientation(RankGroup& processes, int threads);
  void reverseQuadratic(int threads);
  void settleDimension(const EllipticChoice& choice, RankGroup& processes);
  void markFixed(const EllipticChoice& choice, vtkAlgorithm* algorithm, RankGroup& processes);
  void divide(Redistribution how, int threads);
  void assemble(RankGroup& processes, int threads);

  /// The data that a problem refers to.
  struct Arrays
  {
    std::vector<unsigned char> fixed;
    std::vector<double> sources, given, tensors, stiffening;
  };

  LocalMesh& Local;
  std::unique_ptr<MeshAdapter> Adapter;
  EllipticProblem Problem;
  MeshPart Part;
  std::vector<unsigned char> Skip;
  std::vector<Index> Turned; ///< the connectivity, where reverseQuadratic() has changed it
  Arrays Values;
  std::string Notice;
  std::unique_ptr<RankGroup> Group;       ///< null with one process
  std::unique_ptr<CellDivision> Division; ///< null if the piece has its own system
  std::unique_ptr<Mesh> DividedMesh;
  EllipticProblem DividedProblem;
  MeshPart DividedPart;
  std::vector<unsigned char> DividedSkip;
  Arrays DividedValues;
  std::unique_ptr<EllipticSystem> System;
};
}
#endif
