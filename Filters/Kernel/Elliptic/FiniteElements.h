// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FiniteElements.h
 * @brief Stiffness matrices and load vectors of finite elements: P1 on triangles and tetrahedra, Q1
 * on quadrilaterals and hexahedra, conforming functions on wedges and pyramids, and P2 on quadratic
 * triangles (VTK's types 22, 34 and 69) and tetrahedra (24, 71), whose edges and faces may be
 * curved: isoparametric elements.
 *
 * Matrices cover all points of the mesh, before any boundary condition: a point outside all cells
 * has an empty row. They are bitwise identical for any number of threads, and exactly symmetric.
 *
 * Example: the matrix of -laplace u, and then the matrix of -div(C grad u) without computing the
 * pattern again.
 *
 *     tautline::AssemblyPattern pattern(mesh);
 *     tautline::SparseMatrix matrix = pattern.assemble(tautline::DiffusionOperator());
 *     tautline::DiffusionOperator other;
 *     other.tensor = { 2, 1, 1, 0, 0, 0 };
 *     pattern.assemble(other, matrix);
 */
#ifndef tautline_FiniteElements_h
#define tautline_FiniteElements_h

#include "Materials.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/Solvers/SparseMatrix.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// Options of an assembly; shared by all functions below.
struct AssemblyOptions
{
  const unsigned char* skip = nullptr; ///< one flag per cell, nonzero = ignore (ghosts); or null
  int threads = 0;                     ///< 0: all cores
};

/**
 * @class tautline::AssemblyPattern
 * @brief The sparsity pattern of the matrices of a mesh: computed once and used for every assembly
 * on that mesh.
 *
 * Cells of other types and mixtures of linear and quadratic elements are rejected. Elements with a
 * vanishing Jacobian (Mesh::degenerateTolerance()) contribute nothing; inverted elements contribute
 * with its absolute value. If this matters, check first with Mesh::classifyCells() or, for
 * quadratic cells, certifyCurvedCells().
 */
class TAUTLINE_SOLVERS_EXPORT AssemblyPattern
{
public:
  /**
   * @param mesh must outlive the pattern
   * @param options the flags are only read here. Throws Error for cells of other types, stating
   * which, how many, and a remedy.
   */
  explicit AssemblyPattern(const Mesh& mesh, const AssemblyOptions& options = {});

  /**
   * @brief Fills a matrix of size numberOfPoints x numberOfPoints; a matrix filled by this pattern
   * before keeps its memory.
   * @param points coordinates that replace the mesh points, 3 per point; or null. Throws Error for
   * coordinates or coefficients that are not finite, stating the first such cell.
   */
  void assemble(
    const DiffusionOperator& pde, SparseMatrix& matrix, const double* points = nullptr) const;

  /**
   * @brief The same for linear elasticity: unknown d p + k is component k of point p, d =
   * elasticComponents(). The components of a planar mesh are along Mesh::frame(). Also throws Error
   * for surfaces in space, and for E, nu or factors out of range.
   */
  void assemble(
    const ElasticOperator& pde, SparseMatrix& matrix, const double* points = nullptr) const;

  template <class Operator>
  SparseMatrix assemble(const Operator& pde, const double* points = nullptr) const
  {
    SparseMatrix matrix;
    this->assemble(pde, matrix, points);
    return matrix;
  }

  const Mesh& mesh() const { return *this->Input; }

private:
  void findUses(const unsigned char* skip);
  void findColumns();
  void expand(int components, SparseMatrix& matrix) const;
  template <class Element>
  void computeBatch(const Element& element, const MeshView& view, Index firstCell, Index endCell,
    Index entries, double* buffer) const;
  template <int Components>
  void addUse(Index use, Index firstColumn, Index width, const double* k, double* row) const;
  template <class Element>
  void gather(const Element& element, SparseMatrix& matrix, const double* points) const;
  int nodesOf(Index cell) const
  {
    const MeshView& view = this->Input->view();
    const int nodes = this->Uniform ? this->Stride : this->Nodes[view.cellTypes[cell]];
    // Lagrange triangles have 6 or 7 nodes.
    return this->Quadratic && nodes > 0
      ? static_cast<int>(view.offsets[cell + 1] - view.offsets[cell])
      : nodes;
  }
  Index firstNode(Index cell) const
  {
    const Index* offsets = this->Input->view().offsets;
    return this->Uniform ? offsets[0] + this->Stride * cell : offsets[cell];
  }

  const Mesh* Input;
  int Threads;
  int placeOf(Index use) const { return this->Uses[use] & ((1U << this->PlaceBits) - 1); }
  Index cellOf(Index use) const { return this->Uses[use] >> this->PlaceBits; }

  int Stride = 0;                     // maximum number of nodes of a cell
  int PlaceBits = 0;                  // bits of a position in a cell
  bool Uniform = false;               // whether all cells have this many, without gaps
  bool Quadratic = false;             // whether the elements are quadratic
  std::array<signed char, 256> Nodes; // of a cell by its VTK type; 0: ignored
  /// The cells at each point, in increasing order, each with the position of the point in it: cell
  /// * 2^PlaceBits + position.
  std::vector<Index> UseOffsets;
  std::vector<std::uint32_t> Uses;
  /// The positions of the nodes of each use in the row of its point; Stride per use.
  std::vector<std::uint16_t> Slots;
  std::vector<Index> Offsets; // rows of points
  std::vector<std::int32_t> Columns;
};

/// The matrix of a scalar operator: a single use of AssemblyPattern.
TAUTLINE_SOLVERS_EXPORT SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const DiffusionOperator& pde, const AssemblyOptions& options = {});

/// The matrix of linear elasticity: a single use of AssemblyPattern.
TAUTLINE_SOLVERS_EXPORT SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const ElasticOperator& pde, const AssemblyOptions& options = {});

/// Unknowns per point of linear elasticity: 2 or 3.
TAUTLINE_SOLVERS_EXPORT int elasticComponents(const Mesh& mesh);

/**
 * @brief Integrals of f phi_p: f is given at the points (components per point, interpolated by the
 * shape functions).
 * @return components x numberOfPoints
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> loadVector(
  const Mesh& mesh, const double* f, int components, const AssemblyOptions& options = {});
}
#endif
