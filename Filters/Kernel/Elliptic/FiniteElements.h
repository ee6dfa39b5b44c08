// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FiniteElements.h
 * @brief Stiffness matrices and load vectors of finite elements: P1 on triangles and tetrahedra, Q1
 * on quadrilaterals and hexahedra, conforming functions on wedges and pyramids, and P2 on quadratic
 * triangles (VTK's types 22, 34 and 69) and tetrahedra (24, 71), whose edges and faces may be
 * curved: isoparametric elements.
 *
 * Matrices are those of all points of the mesh, before any boundary condition: a point outside all
 * cells has an empty row. They come out the same, bitwise, for any number of threads, and exactly
 * symmetric.
 *
 * Example: the matrix of -laplace u, and then that of -div(C grad u) without computing the pattern
 * again.
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
  const unsigned char* skip = nullptr; ///< one flag per cell, nonzero = leave out (ghosts); or null
  int threads = 0;                     ///< 0: all cores
};

/**
 * @class tautline::AssemblyPattern
 * @brief The sparsity pattern of the matrices of a mesh: found once, used for every assembly on
 * that mesh.
 *
 * Cells of other types are refused, and linear elements beside quadratic ones. Where the Jacobian
 * of an element vanishes (Mesh::degenerateTolerance()) it contributes nothing; inverted elements
 * contribute by its absolute value. Check with Mesh::classifyCells(), of quadratic ones with
 * certifyCurvedCells(), first where that matters.
 */
class TAUTLINE_SOLVERS_EXPORT AssemblyPattern
{
public:
  /**
   * @param mesh stays alive as long as the pattern
   * @param options the flags are read here only
   * Throws Error for cells of other types: which, how many, and what to do.
   */
  explicit AssemblyPattern(const Mesh& mesh, const AssemblyOptions& options = {});

  /**
   * @brief Fills a matrix; one that this pattern filled before keeps its memory. numberOfPoints
   * square.
   * @param points coordinates instead of those of the mesh, 3 per point; or null
   * Throws Error for coordinates or coefficients that are not finite: the first cell that has them.
   */
  void assemble(
    const DiffusionOperator& pde, SparseMatrix& matrix, const double* points = nullptr) const;

  /**
   * @brief The same for linear elasticity: unknown d p + k is component k of point p, d =
   * elasticComponents(). The components of a planar mesh are along Mesh::frame(). Throws Error also
   * for surfaces in space, and for E, nu or factors out of their range.
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
    // Lagrange triangles have 6 nodes or 7.
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
  int PlaceBits = 0;                  // that a place in a cell takes
  bool Uniform = false;               // all cells have so many, without gaps
  bool Quadratic = false;             // the elements
  std::array<signed char, 256> Nodes; // of a cell by its VTK type; 0: it does not count
  /// The cells at each point, in increasing order, each with the point's place in it: cell *
  /// 2^PlaceBits + place.
  std::vector<Index> UseOffsets;
  std::vector<std::uint32_t> Uses;
  /// Where the nodes of each use are in the row of its point; Stride per use.
  std::vector<std::uint16_t> Slots;
  std::vector<Index> Offsets; // rows of points
  std::vector<std::int32_t> Columns;
};

/// The matrix of a scalar operator: AssemblyPattern for one time.
TAUTLINE_SOLVERS_EXPORT SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const DiffusionOperator& pde, const AssemblyOptions& options = {});

/// The matrix of linear elasticity: AssemblyPattern for one time.
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
