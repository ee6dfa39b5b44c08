/**
 * @file FiniteElements.h
 * @brief Stiffness matrices, load vectors and derived fields of linear finite elements: P1 on triangles and
 * tetrahedra, Q1 on quadrilaterals and hexahedra.
 *
 * Matrices are those of all points of the mesh, before any boundary condition: a point outside all cells has an
 * empty row. They come out the same, bitwise, for any number of threads, and exactly symmetric.
 */
#ifndef tautline_FiniteElements_h
#define tautline_FiniteElements_h

#include "Mesh.h"
#include "SparseMatrix.h"

namespace tautline
{
/// A symmetric tensor: xx yy zz xy yz xz, the order of VTK's arrays of symmetric tensors.
using SymmetricTensor = std::array<double, 6>;

constexpr SymmetricTensor IdentityTensor = { 1, 1, 1, 0, 0, 0 };

/// The operator -div(C grad u) + a u, section 2.2 (2.3) and section 4.9 (4.11), (4.20).
struct DiffusionOperator
{
  /// C, in the coordinates of space; positive semidefinite. Triangles in space see its tangential part.
  SymmetricTensor tensor = IdentityTensor;
  const double* tensors = nullptr; ///< 6 per cell, instead of tensor; or null
  double reaction = 0.0;           ///< a, at least 0
};

/// What a 2D elastic body is held by in the third direction.
enum class PlaneState : int
{
  Strain = 0, ///< no strain: a slice of a long body
  Stress = 1  ///< no stress: a thin sheet
};

/// Linear elasticity (2.4): -div(lambda (div u) I + 2 mu eps(u)).
struct ElasticOperator
{
  double youngsModulus = 1.0;            ///< E > 0
  double poissonRatio = 0.3;             ///< nu, -1 to 0.5 (exclusive)
  const double* stiffening = nullptr;    ///< factors of E, one per cell, positive; or null
  PlaneState plane = PlaneState::Strain; ///< planar meshes only
};

/// How an assembly is to go; shared by all functions below.
struct AssemblyOptions
{
  const unsigned char* skip = nullptr; ///< one flag per cell, nonzero = leave out (ghosts); or null
  int threads = 0;                     ///< 0: all cores
};

/**
 * @brief The matrix of a scalar operator, numberOfPoints square.
 *
 * Throws Error for cells of other types (names and counts them), coordinates, tensors or a that are not finite.
 * Degenerate elements (Mesh::classifyCell) contribute nothing; inverted ones contribute by the absolute value of their
 * Jacobian's determinant. Ask Mesh::classifyCells() first where that matters.
 */
TAUTLINE_KERNEL_EXPORT SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const DiffusionOperator& pde, const AssemblyOptions& options = {});

/**
 * @brief The matrix of linear elasticity; unknown d p + k is component k of point p, d = 2 for planar meshes (components
 * along Mesh::frame()) and 3 for volumes. Throws Error as above, and for surfaces in space.
 */
TAUTLINE_KERNEL_EXPORT SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const ElasticOperator& pde, const AssemblyOptions& options = {});

/// Unknowns per point of linear elasticity: 2 or 3.
TAUTLINE_KERNEL_EXPORT int elasticComponents(const Mesh& mesh);

/**
 * @brief Integrals of f phi_p: f is given at the points (components per point, interpolated linearly).
 * @return components x numberOfPoints
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> loadVector(
  const Mesh& mesh, const double* f, int components, const AssemblyOptions& options = {});
}
#endif
