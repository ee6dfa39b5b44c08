// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetCorner.h
 * @brief The Jacobians at the corners of a batch of elements, relative to their targets.
 * Internal: not installed.
 */
#ifndef tautline_TargetCorner_h
#define tautline_TargetCorner_h

#include "Batch.h"
#include "TargetMetrics.h"

#include <algorithm>

namespace tautline
{
/// A corner Jacobian in local coordinates, with the data needed to propagate a derivative back.
template <int N>
struct Corner
{
  Packet t[N][N];         ///< T = A W^-1
  Packet inverse[N][N];   ///< W^-1
  Packet root[N][N];      ///< M^(1/2), if the targets have a metric tensor
  Packet axes[2][3] = {}; ///< 2D: the frame of A
  TargetInvariants<N> invariants;
  Packet cofactor[N][N];
  Packet slope[N][N]; ///< dq/dT for a user metric; other metrics give d/d(invariants)
  Mask degenerate;
};

/// Planar cells use the frame of the mesh; a mirrored mesh is viewed from the other side.
inline void planarAxes(const Mesh& mesh, Packet (&axes)[2][3])
{
  for (int a = 0; a < 2; ++a)
  {
    const Vec3& axis = mesh.frame()[mesh.mirrored() ? 1 - a : a];
    for (int c = 0; c < 3; ++c)
    {
      axes[a][c] = broadcast(axis[c]);
    }
  }
}

/// Unit normals of surface cells: of the triangle, or across the diagonals of the quadrilateral.
inline void surfaceNormal(const Batch& batch, int nodes, Packet (&normal)[3])
{
  Packet a[3], b[3];
  subtract(batch.points[nodes == 3 ? 1 : 2], batch.points[0], a);
  subtract(batch.points[nodes == 3 ? 2 : 3], batch.points[nodes == 3 ? 0 : 1], b);
  cross(a, b, normal);
}

/// The frame of a surface corner: the first edge, and its perpendicular in the plane of the corner,
/// on the side that makes the corner positive if it turns like the cell. Rotation-invariant metrics
/// only depend on the Gram matrix of the corner and this sign, so that the motion of the frame does
/// not contribute to the gradient.
inline void surfaceAxes(
  const Packet* a, const Packet* b, const Packet* normal, Packet (&axes)[2][3])
{
  Packet own[3];
  cross(a, b, own);
  const Packet turn = signOf(dot(own, normal));
  const Packet lengthA = sqrt(dot(a, a)), lengthOwn = sqrt(dot(own, own));
  const Packet overA = select(lengthA > 0.0, 1.0 / lengthA, Packet{});
  const Packet overOwn = select(lengthOwn > 0.0, turn / lengthOwn, Packet{});
  for (int c = 0; c < 3; ++c)
  {
    axes[0][c] = a[c] * overA;
    own[c] *= overOwn;
  }
  cross(own, axes[0], axes[1]);
}

/// Whether the targets have a metric tensor that the metric uses.
template <class M>
bool seenByTensor(const BatchContext& context)
{
  return !M::usesSize && context.options->targets && !context.options->targets->metricRoots.empty();
}

template <int N>
void multiply(const Packet (&left)[N][N], const Packet (&right)[N][N], Packet (&product)[N][N])
{
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      product[r][c] = left[r][0] * right[0][c];
      for (int k = 1; k < N; ++k)
      {
        product[r][c] += left[r][k] * right[k][c];
      }
    }
  }
}

/**
 * @brief A, column by column.
 * @param normal of a surface, or null
 * @param lengths2 the product of the squared lengths of the columns
 * @return det A, independent of the target; it decides whether a corner is degenerate
 */
template <int N>
Packet loadMatrix(const Packet (&edge)[N][3], const Packet* normal, Corner<N>& corner,
  Packet (&a)[N][N], Packet& lengths2)
{
  lengths2 = broadcast(1.0);
  for (int k = 0; k < N; ++k)
  {
    lengths2 *= dot(edge[k], edge[k]);
  }
  if constexpr (N == 2)
  {
    if (normal)
    {
      surfaceAxes(edge[0], edge[1], normal, corner.axes);
    }
    for (int k = 0; k < 2; ++k)
    {
      a[0][k] = dot(corner.axes[0], edge[k]);
      a[1][k] = dot(corner.axes[1], edge[k]);
    }
  }
  else
  {
    for (int k = 0; k < 3; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        a[c][k] = edge[k][c];
      }
    }
  }

  Packet det;
  if constexpr (N == 2)
  {
    det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  }
  else
  {
    Packet c01[3];
    cross(edge[0], edge[1], c01);
    det = dot(c01, edge[2]);
  }
  return det;
}

/// Replaces A by M^(1/2) A. Not inlined: a program has one copy, instead of one for each metric.
template <int N>
__attribute__((noinline)) void applyTensor(
  const BatchContext& context, const Batch& batch, Corner<N>& corner, Packet (&a)[N][N])
{
  Packet seen[N][N];
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      for (int l = 0; l < PacketWidth; ++l)
      {
        corner.root[r][c][l] =
          context.options->targets->metricRoots[9 * batch.cells[l] + 3 * r + c];
      }
    }
  }
  multiply<N>(corner.root, a, seen);
  std::copy(&seen[0][0], &seen[0][0] + N * N, &a[0][0]);
}

/// W^-1 of the targets. Not inlined, as above.
template <int N>
__attribute__((noinline)) void loadTargets(
  const Targets& targets, const Batch& batch, int sample, Packet (&inverse)[N][N])
{
  for (int l = 0; l < PacketWidth; ++l)
  {
    const double* w = targets.inverse.data() + 9 * (targets.offsets[batch.cells[l]] + sample);
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        inverse[r][c][l] = w[3 * r + c];
      }
    }
  }
}

/// W^-1: a multiple of I if only the size matters, otherwise from the target or the ideal cell.
template <class M, int N>
void loadInverse(const BatchContext& context, const Batch& batch, int sample, Corner<N>& corner)
{
  const CellTopology& topology = *context.topology;
  if constexpr (M::usesSize)
  {
    const double scale =
      N == 2 ? std::sqrt(topology.sizePerDeterminant) : std::cbrt(topology.sizePerDeterminant);
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        corner.inverse[r][c] = broadcast(r == c ? scale : 0.0);
      }
    }
  }
  else if (const Targets* targets = context.options->targets)
  {
    loadTargets<N>(*targets, batch, sample, corner.inverse);
  }
  else
  {
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        corner.inverse[r][c] = broadcast(topology.idealInverse[sample][3 * r + c]);
      }
    }
  }
}

/// Multiplies the matrix of each cell by a number of the cell.
template <int N>
void scaleMatrices(Packet factor, Packet (&matrix)[N][N])
{
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      matrix[r][c] *= factor;
    }
  }
}

/// Powers of two that bring the largest entry of each matrix near 1.
template <int N>
Packet perMagnitude(const Packet (&matrix)[N][N])
{
  Packet largest = {};
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      largest = max(largest, abs(matrix[r][c]));
    }
  }
  return 1.0 / each(largest, unitOfExtent);
}

/**
 * @brief Scales the targets of cells or targets of extreme size: T has its size in mesh units or,
 * if only its shape matters, a size near 1. Not inlined, because it is rare.
 */
template <int N>
__attribute__((noinline)) void scaleTarget(const BatchContext& context, const Batch& batch,
  bool tensor, Corner<N>& corner, Packet (&a)[N][N])
{
  if (!context.scaleInvariant)
  {
    scaleMatrices<N>(batch.scaled ? batch.unit : broadcast(1.0), corner.inverse);
    return;
  }
  scaleMatrices<N>(perMagnitude<N>(corner.inverse), corner.inverse);
  if (tensor)
  {
    const Packet factor = perMagnitude<N>(corner.root);
    scaleMatrices<N>(factor, corner.root);
    scaleMatrices<N>(factor, a);
  }
}

/// T = A W^-1 with its invariants and cofactors.
template <class M, int N>
void findInvariants(const Packet (&a)[N][N], Corner<N>& corner)
{
  TargetInvariants<N>& t = corner.invariants;
  t = {};
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      corner.t[r][c] = a[r][0] * corner.inverse[0][c];
      for (int k = 1; k < N; ++k)
      {
        corner.t[r][c] += a[r][k] * corner.inverse[k][c];
      }
      t.norm2 += corner.t[r][c] * corner.t[r][c];
    }
    t.trace += corner.t[r][r];
  }
  const auto& m = corner.t;
  if constexpr (N == 2)
  {
    corner.cofactor[0][0] = m[1][1];
    corner.cofactor[0][1] = -m[1][0];
    corner.cofactor[1][0] = -m[0][1];
    corner.cofactor[1][1] = m[0][0];
    t.adj2 = t.norm2;
    t.det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  }
  else
  {
    for (int r = 0; r < 3; ++r)
    {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
      for (int c = 0; c < 3; ++c)
      {
        const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        corner.cofactor[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        if constexpr (M::usesAdjugate)
        {
          t.adj2 += corner.cofactor[r][c] * corner.cofactor[r][c];
        }
      }
    }
    t.det = m[0][0] * corner.cofactor[0][0] + m[0][1] * corner.cofactor[0][1] +
      m[0][2] * corner.cofactor[0][2];
  }
}

template <class M, int N>
void evaluateCorner(const BatchContext& context, const Batch& batch, int sample,
  const Packet* normal, Corner<N>& corner)
{
  const auto& nodes = context.topology->cornerNodes[sample];
  Packet edge[N][3];
  for (int k = 0; k < N; ++k)
  {
    subtract(batch.points[nodes[k + 1]], batch.points[nodes[0]], edge[k]);
  }
  Packet a[N][N], lengths2;
  const Packet det = loadMatrix<N>(edge, normal, corner, a, lengths2);
  const bool tensor = seenByTensor<M>(context);
  if (tensor)
  {
    applyTensor<N>(context, batch, corner, a);
  }
  loadInverse<M, N>(context, batch, sample, corner);
  if (batch.scaled || (context.options->targets && context.options->targets->extreme))
  {
    scaleTarget<N>(context, batch, tensor, corner, a);
  }
  findInvariants<M, N>(a, corner);
  // Relative to the lengths of the columns.
  const double tolerance = Mesh::degenerateTolerance() * Mesh::degenerateTolerance();
  corner.degenerate = det * det <= tolerance * lengths2;
}
}
#endif
