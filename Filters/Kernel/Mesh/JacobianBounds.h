// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JacobianBounds.h
 * @brief The Jacobian determinant inside hexahedra and wedges: its Bernstein coefficients, its sign
 * and its minimum.
 * Internal: not installed.
 *
 * The reference elements are the unit cube, the prism over a triangle with two legs of length 1,
 * and the pyramid over the unit square. With the derivatives x_u, x_v, x_w of the map of the
 * element, det = x_u . (x_v x x_w) is
 * - for a hexahedron, quadratic in each of u, v, w: 27 Bernstein coefficients;
 * - for a wedge, linear over the triangle and quadratic along w: 3 x 3 coefficients;
 * - for a pyramid, with x = (1 - w) B(u, v) + w apex, the factor (1 - w)^2 times (B_u x B_v) .
 *   (apex - B), of which all terms except the bilinear ones vanish: its minimum is at a corner of
 *   the base (P. Knabner, G. Summ, "The invertibility of the isoparametric mapping for pyramidal
 *   and prismatic finite elements", Numer. Math. 88 (2001)).
 *
 * A coefficient at a corner is the determinant there, and the smallest of all is a lower bound of
 * the determinant, which subdivision (de Casteljau) tightens as much as needed. Coefficients are
 * means of the triple products of three edges in the directions u, v and w.
 *
 * A. Johnen, J.-C. Weill, J.-F. Remacle, "Robust and efficient validation of the linear hexahedral
 * element", Procedia Engineering 203 (2017).
 */
#ifndef tautline_JacobianBounds_h
#define tautline_JacobianBounds_h

#include "CellBatch.h"

namespace tautline
{
/// Whether the determinant inside a cell of a type can be smaller than at its corners.
inline bool hasInside(CellType type)
{
  return type == CellType::Hexahedron || type == CellType::Wedge;
}

constexpr int MaxCoefficients = 27;

/// The smallest determinant of a cell and its position in the reference element.
struct JacobianMinimum
{
  double value = 0;
  Vec3 at = { 0, 0, 0 }; ///< u, v, w; for a wedge, on one of its three edges along w
};

/**
 * @brief Whether the determinant is positive inside a cell that hasInside().
 * @param corners the verdict on the corners, which are not checked again; not Inverted
 * @return Valid if det > Mesh::degenerateTolerance() |x_u| |x_v| |x_w| everywhere, Inverted if det
 * is below the negative of that somewhere, otherwise Degenerate. Values below the rounding error,
 * 1e-15 times the product of the longest edges in each direction, are treated as 0. Also Degenerate
 * if the smallest value is so close to the tolerance that 2000 subdivisions are not conclusive.
 */
Validity classifyInside(const CellTopology& t, const Vec3* vertices, Validity corners);

/**
 * @brief The minimum of the determinant over a hexahedron, wedge or pyramid, to a billionth of the
 * largest coefficient.
 */
TAUTLINE_KERNEL_EXPORT JacobianMinimum minimumJacobian(const CellTopology& t, const Vec3* vertices);

/// The cells of a batch, all of a type that hasInside(), that are certainly valid, inside and at
/// the corners; their points are mirrored if the mesh is, as by loadNodes().
TAUTLINE_KERNEL_EXPORT Mask clearlyValidCells(
  const Mesh& mesh, const CellTopology& t, const CellVertices& batch);

/// Adds the derivative of the determinant at a point of the reference element with respect to each
/// vertex.
TAUTLINE_KERNEL_EXPORT void addJacobianGradient(
  const CellTopology& t, const Vec3* vertices, const Vec3& at, double factor, Vec3* gradient);

//------------------------------------------------------------------------------
/// Vectors of numbers or of packets.
namespace bounds
{
template <class T>
void difference(const T* a, const T* b, T* result)
{
  for (int c = 0; c < 3; ++c)
  {
    result[c] = a[c] - b[c];
  }
}

template <class T>
T product(const T* a, const T* b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
void crossProduct(const T* a, const T* b, T* result)
{
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

/// (a x b + c x d) / 2
template <class T>
void meanCrossProduct(const T* a, const T* b, const T* c, const T* d, T* result)
{
  T other[3];
  crossProduct(a, b, result);
  crossProduct(c, d, other);
  for (int k = 0; k < 3; ++k)
  {
    result[k] = 0.5 * (result[k] + other[k]);
  }
}

/// The nodes of a hexahedron by their coordinates u, v, w in the unit cube.
constexpr int cubeNode[2][2][2] = { { { 0, 4 }, { 3, 7 } }, { { 1, 5 }, { 2, 6 } } };

/// The edges of a cell in the directions u, v, w, by the other two coordinates; for a wedge,
/// [corner of the triangle][0] along w, and [0][end] along u and v.
template <class T>
struct Edges
{
  T u[2][2][3], v[2][2][3], w[2][2][3];
};

template <class T>
void hexahedronEdges(const T (*p)[3], Edges<T>& e)
{
  for (int a = 0; a < 2; ++a)
  {
    for (int b = 0; b < 2; ++b)
    {
      difference(p[cubeNode[1][a][b]], p[cubeNode[0][a][b]], e.u[a][b]);
      difference(p[cubeNode[a][1][b]], p[cubeNode[a][0][b]], e.v[a][b]);
      difference(p[cubeNode[a][b][1]], p[cubeNode[a][b][0]], e.w[a][b]);
    }
  }
}

/**
 * @brief The 27 coefficients c[a + 3 b + 9 c]: the mean of u[j][k] . (v[i][k'] x w[i'][j']) over i
 * + i' = a, j + j' = b, k + k' = c.
 */
template <class T>
void hexahedronCoefficients(const Edges<T>& e, T* c)
{
  for (int a = 0; a < 3; ++a)
  {
    T vw[2][2][3]; // by k' and j'
    for (int k = 0; k < 2; ++k)
    {
      for (int j = 0; j < 2; ++j)
      {
        if (a == 1)
        {
          meanCrossProduct(e.v[0][k], e.w[1][j], e.v[1][k], e.w[0][j], vw[k][j]);
        }
        else
        {
          crossProduct(e.v[a / 2][k], e.w[a / 2][j], vw[k][j]);
        }
      }
    }
    T d[2][2][2][2]; // by j, j', k, k'
    for (int n = 0; n < 16; ++n)
    {
      const int j = n & 1, j2 = n >> 1 & 1, k = n >> 2 & 1, k2 = n >> 3;
      d[j][j2][k][k2] = product(e.u[j][k], vw[k2][j2]);
    }
    for (int k = 0; k < 2; ++k)
    {
      T* at = c + a + 18 * k;
      at[0] = d[0][0][k][k];
      at[3] = 0.5 * (d[0][1][k][k] + d[1][0][k][k]);
      at[6] = d[1][1][k][k];
    }
    T* at = c + a + 9;
    at[0] = 0.5 * (d[0][0][0][1] + d[0][0][1][0]);
    at[3] = 0.25 * ((d[0][1][0][1] + d[1][0][1][0]) + (d[0][1][1][0] + d[1][0][0][1]));
    at[6] = 0.5 * (d[1][1][0][1] + d[1][1][1][0]);
  }
}

/// In VTK's wedge, the triangle 0 1 2 is clockwise as seen from the other one: u goes to node 2, v
/// to 1.
template <class T>
void wedgeEdges(const T (*p)[3], Edges<T>& e)
{
  for (int end = 0; end < 2; ++end)
  {
    difference(p[3 * end + 2], p[3 * end], e.u[0][end]);
    difference(p[3 * end + 1], p[3 * end], e.v[0][end]);
  }
  difference(p[3], p[0], e.w[0][0]);
  difference(p[4], p[1], e.w[0][1]);
  difference(p[5], p[2], e.w[1][0]);
}

/// The 9 coefficients c[k + 3 b]: the k-th along the edge of w[0][0], w[0][1] or w[1][0].
template <class T>
void wedgeCoefficients(const Edges<T>& e, T* c)
{
  T uv[3][3];
  crossProduct(e.u[0][0], e.v[0][0], uv[0]);
  meanCrossProduct(e.u[0][0], e.v[0][1], e.u[0][1], e.v[0][0], uv[1]);
  crossProduct(e.u[0][1], e.v[0][1], uv[2]);
  for (int n = 0; n < 9; ++n)
  {
    c[n] = product(uv[n % 3], e.w[n / 6][n / 3 % 2]);
  }
}

/// The coefficients of a cell with this many nodes, and their number.
template <int Nodes, class T>
int coefficients(const T (*p)[3], Edges<T>& e, T* c)
{
  if constexpr (Nodes == 8)
  {
    hexahedronEdges(p, e);
    hexahedronCoefficients(e, c);
    return MaxCoefficients;
  }
  else
  {
    static_assert(Nodes == 6, "a wedge");
    wedgeEdges(p, e);
    wedgeCoefficients(e, c);
    return 9;
  }
}
}
}
#endif
