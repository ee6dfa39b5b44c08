// SPDX-License-Identifier: BSD-3-Clause
#include "Batch.h"
#include "CombineCorners.h"
#include "TargetMetrics.h"
#include "UserMetric.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// A corner Jacobian in local coordinates, and what is needed to carry a derivative back.
template <int N>
struct Corner
{
  Packet t[N][N];         ///< T = A W^-1
  Packet inverse[N][N];   ///< W^-1
  Packet root[N][N];      ///< M^(1/2), if the targets have a metric tensor
  Packet axes[2][3] = {}; ///< 2D: the frame A is taken in
  TargetInvariants<N> invariants;
  Packet cofactor[N][N];
  Packet slope[N][N]; ///< dq/dT of a user's metric; the others give d/d(invariants)
  Mask degenerate;
};

/// A metric that was registered: BatchContext::user evaluates it.
template <bool Singular>
struct UserTarget : TargetMetric
{
  static constexpr bool user = true;
  static constexpr bool singular = Singular;
};

/// Frames of a planar mesh are the mesh's; a mirrored mesh is viewed from the other side.
void planarAxes(const Mesh& mesh, Packet (&axes)[2][3])
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
void surfaceNormal(const Batch& batch, int nodes, Packet (&normal)[3])
{
  Packet a[3], b[3];
  subtract(batch.points[nodes == 3 ? 1 : 2], batch.points[0], a);
  subtract(batch.points[nodes == 3 ? 2 : 3], batch.points[nodes == 3 ? 0 : 1], b);
  cross(a, b, normal);
}

/// The frame of a surface corner: first edge, and its perpendicular in the corner's plane on the
/// side that makes the corner positive when it turns as the cell does. Rotation-invariant metrics
/// depend on the corner's Gram matrix and this sign only, so the frame's own motion adds no
/// gradient.
void surfaceAxes(const Packet* a, const Packet* b, const Packet* normal, Packet (&axes)[2][3])
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

/// Whether the targets have a metric tensor that the metric takes notice of.
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
 * @return det A, whatever the target: by it a corner is degenerate or not
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

/// Replaces A by M^(1/2) A.
template <int N>
void applyTensor(
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

/// W^-1: a multiple of I where only the size counts, else the target's or the ideal cell's.
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
    for (int l = 0; l < PacketWidth; ++l)
    {
      const double* w = targets->inverse.data() + 9 * (targets->offsets[batch.cells[l]] + sample);
      for (int r = 0; r < N; ++r)
      {
        for (int c = 0; c < N; ++c)
        {
          corner.inverse[r][c][l] = w[3 * r + c];
        }
      }
    }
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
 * @brief Scales the targets of cells or targets of extreme size: T is of the size it has in the
 * unit of the mesh, or, where only its shape counts, near 1. Not inlined: it is rare.
 */
template <class M, int N>
__attribute__((noinline)) void scaleTarget(
  const BatchContext& context, const Batch& batch, Corner<N>& corner, Packet (&a)[N][N])
{
  if (!context.scaleInvariant)
  {
    scaleMatrices<N>(batch.scaled ? batch.unit : broadcast(1.0), corner.inverse);
    return;
  }
  scaleMatrices<N>(perMagnitude<N>(corner.inverse), corner.inverse);
  if (seenByTensor<M>(context))
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
  if (seenByTensor<M>(context))
  {
    applyTensor<N>(context, batch, corner, a);
  }
  loadInverse<M, N>(context, batch, sample, corner);
  if (batch.scaled || (context.options->targets && context.options->targets->extreme))
  {
    scaleTarget<M, N>(context, batch, corner, a);
  }
  findInvariants<M, N>(a, corner);
  // Relative to the lengths of the columns.
  const double tolerance = Mesh::degenerateTolerance() * Mesh::degenerateTolerance();
  corner.degenerate = det * det <= tolerance * lengths2;
}

/// Adds weight * dq/d(points) of one corner.
template <class M, int N>
void addGradient(const BatchContext& context, const Corner<N>& corner, int sample,
  const TargetInvariants<N>& d, Packet weight, Batch& batch)
{
  Packet p[N][N]; // dq/dT
  for (int r = 0; r < N; ++r)
  {
    for (int c = 0; c < N; ++c)
    {
      if constexpr (M::user)
      {
        p[r][c] = corner.slope[r][c];
        continue;
      }
      p[r][c] = 2.0 * d.norm2 * corner.t[r][c] + d.det * corner.cofactor[r][c];
    }
    if constexpr (M::usesTrace)
    {
      p[r][r] += d.trace;
    }
  }
  if constexpr (M::usesAdjugate && N == 3)
  {
    // d|adj T|^2 / dT = 2 (|T|^2 T - T T^t T)
    Packet gram[3][3];
    for (int r = 0; r < 3; ++r)
    {
      for (int c = 0; c < 3; ++c)
      {
        gram[r][c] = corner.t[0][r] * corner.t[0][c] + corner.t[1][r] * corner.t[1][c] +
          corner.t[2][r] * corner.t[2][c];
      }
    }
    for (int r = 0; r < 3; ++r)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Packet ttt =
          corner.t[r][0] * gram[0][c] + corner.t[r][1] * gram[1][c] + corner.t[r][2] * gram[2][c];
        p[r][c] += 2.0 * d.adj2 * (corner.invariants.norm2 * corner.t[r][c] - ttt);
      }
    }
  }

  if (seenByTensor<M>(context))
  {
    // The root is symmetric: d(root A) carries P back to root P.
    Packet seen[N][N];
    multiply<N>(corner.root, p, seen);
    std::copy(&seen[0][0], &seen[0][0] + N * N, &p[0][0]);
  }

  // dq/dA = P W^-t, then from the columns of A to the corner's nodes.
  const auto& nodes = context.topology->cornerNodes[sample];
  for (int k = 0; k < N; ++k)
  {
    Packet column[3] = {};
    for (int r = 0; r < N; ++r)
    {
      Packet entry = p[r][0] * corner.inverse[k][0];
      for (int c = 1; c < N; ++c)
      {
        entry += p[r][c] * corner.inverse[k][c];
      }
      entry *= weight;
      if constexpr (N == 2)
      {
        for (int c = 0; c < 3; ++c)
        {
          column[c] += entry * corner.axes[r][c];
        }
      }
      else
      {
        column[r] = entry;
      }
    }
    for (int c = 0; c < 3; ++c)
    {
      batch.gradient[nodes[k + 1]][c] += column[c];
      batch.gradient[nodes[0]][c] -= column[c];
    }
  }
}

/// Value (and partial derivatives) of a metric at a corner, 0 where it is singular.
template <class M, int N>
Packet evaluateInvariants(
  const BatchContext& context, const Corner<N>& corner, TargetInvariants<N>& d)
{
  Packet q = M::template evaluate<N>(corner.invariants, d, context.options->parameters);
  if constexpr (M::singular)
  {
    q = select(corner.degenerate, Packet{}, q);
    for (Packet* part : { &d.norm2, &d.adj2, &d.det, &d.trace })
    {
      *part = select(corner.degenerate, Packet{}, *part);
    }
  }
  return q;
}

/// As above, also for a user's metric.
template <class M, int N, bool WithGradient>
Packet evaluateFormula(const BatchContext& context, Corner<N>& corner, TargetInvariants<N>& d)
{
  if constexpr (M::user)
  {
    Packet q;
    context.user->evaluate(context.topology->type, PacketWidth, PacketWidth,
      reinterpret_cast<const double*>(corner.t), reinterpret_cast<double*>(&q),
      WithGradient ? reinterpret_cast<double*>(corner.slope) : nullptr);
    for (Packet* part = &corner.slope[0][0];
         M::singular && WithGradient && part != &corner.slope[0][0] + N * N; ++part)
    {
      *part = select(corner.degenerate, Packet{}, *part);
    }
    return M::singular ? select(corner.degenerate, Packet{}, q) : q;
  }
  else
  {
    return evaluateInvariants<M, N>(context, corner, d);
  }
}

/// Whether a metric is a function of |T|^2 and det T alone, with T relative to the target.
template <class M>
constexpr bool ofNormAndDeterminant = !M::usesAdjugate && !M::usesTrace && !M::usesSize && !M::user;

/**
 * @brief A metric of norm and determinant on tetrahedra, with the regular one of edge length 1 as
 * the target. |T|^2 is half the sum of the squared edges; that sum is 4 sum |p|^2 - |sum p|^2, with
 * the points p relative to the first one.
 */
template <class M, bool WithGradient>
void evaluateRegular(const BatchContext& context, Batch& batch)
{
  constexpr double half = 0.5, points = 4.0;
  constexpr double sqrt2 = 1.4142135623730951; // det T of det A
  Packet p[3][3], sum[3] = {};
  Packet squares = {}, lengths2 = broadcast(1.0);
  for (int k = 0; k < 3; ++k)
  {
    subtract(batch.points[k + 1], batch.points[0], p[k]);
    const Packet length2 = dot(p[k], p[k]);
    squares += length2;
    lengths2 *= length2;
    for (int c = 0; c < 3; ++c)
    {
      sum[c] += p[k][c];
    }
  }
  Packet cofactor[3][3]; // of p
  cross(p[0], p[1], cofactor[2]);
  const Packet det = dot(cofactor[2], p[2]);
  Corner<3> corner;
  corner.invariants.norm2 = half * (points * squares - dot(sum, sum));
  corner.invariants.det = sqrt2 * det;
  const double tolerance = Mesh::degenerateTolerance() * Mesh::degenerateTolerance();
  corner.degenerate = det * det <= tolerance * lengths2;
  TargetInvariants<3> d;
  batch.value = evaluateInvariants<M, 3>(context, corner, d);
  if constexpr (WithGradient)
  {
    cross(p[1], p[2], cofactor[0]);
    cross(p[2], p[0], cofactor[1]);
    const Packet byDet = sqrt2 * d.det, byPoint = points * d.norm2;
    for (int c = 0; c < 3; ++c)
    {
      const Packet middle = d.norm2 * sum[c];
      Packet all = {};
      for (int k = 0; k < 3; ++k)
      {
        const Packet g = byPoint * p[k][c] - middle + byDet * cofactor[k][c];
        batch.gradient[k + 1][c] = g;
        all += g;
      }
      batch.gradient[0][c] = -all;
    }
  }
}

/// Flattened into one function: calls between the steps would cost more than the steps.
template <class M, int N, bool WithGradient>
__attribute__((flatten)) void evaluateTarget(const BatchContext& context, Batch& batch)
{
  const CellTopology& topology = *context.topology;
  const int samples = topology.samples;
  if constexpr (N == 3 && ofNormAndDeterminant<M>)
  {
    if (samples == 1 && !context.options->targets && (!batch.scaled || context.scaleInvariant))
    {
      evaluateRegular<M, WithGradient>(context, batch);
      return;
    }
  }
  Corner<N> corner;
  Packet normal[3];
  const bool surface = N == 2 && context.mesh->dimension() != Dimension::Planar;
  if constexpr (N == 2)
  {
    surface ? surfaceNormal(batch, topology.nodes, normal) : planarAxes(*context.mesh, corner.axes);
  }
  const Packet* own = surface ? normal : nullptr;
  if constexpr (WithGradient)
  {
    for (int k = 0; k < topology.nodes; ++k)
    {
      batch.gradient[k][0] = batch.gradient[k][1] = batch.gradient[k][2] = Packet{};
    }
  }

  if (samples == 1)
  {
    TargetInvariants<N> d;
    evaluateCorner<M, N>(context, batch, 0, own, corner);
    batch.value = evaluateFormula<M, N, WithGradient>(context, corner, d);
    if constexpr (WithGradient)
    {
      addGradient<M, N>(context, corner, 0, d, broadcast(1.0), batch);
    }
    return;
  }

  constexpr int kept = M::user && WithGradient ? MaxNodes : 1; // a user's formula is evaluated once
  Packet q[MaxNodes] = {}, weights[MaxNodes] = {}, slopes[kept][N][N];
  Mask negative[MaxNodes] = {}, degenerate = {};
  for (int s = 0; s < samples; ++s)
  {
    TargetInvariants<N> d;
    evaluateCorner<M, N>(context, batch, s, own, corner);
    q[s] = evaluateFormula < M, N, WithGradient && M::user > (context, corner, d);
    std::copy_n(&corner.slope[0][0], M::user && WithGradient ? N * N : 0, &slopes[s % kept][0][0]);
    negative[s] = (corner.invariants.det < 0.0) & ~corner.degenerate;
    if constexpr (!M::singular)
    {
      negative[s] = Mask{}; // an untangling metric needs the pull of every corner
    }
    else
    {
      degenerate |= corner.degenerate;
    }
  }
  batch.value = combine(context, samples, q, negative, weights);
  Mask anyNegative = {};
  for (int s = 0; s < samples; ++s)
  {
    anyNegative |= negative[s];
  }
  // A cell with a vanishing corner and no negative one is degenerate as a whole.
  const Mask zero = degenerate & ~anyNegative;
  batch.value = select(zero, Packet{}, batch.value);
  if constexpr (WithGradient)
  {
    for (int s = 0; s < samples; ++s)
    {
      TargetInvariants<N> d;
      evaluateCorner<M, N>(context, batch, s, own, corner);
      if constexpr (M::user)
      {
        std::copy_n(&slopes[s][0][0], N * N, &corner.slope[0][0]);
      }
      else
      {
        evaluateFormula<M, N, true>(context, corner, d);
      }
      addGradient<M, N>(context, corner, s, d, select(zero, Packet{}, weights[s]), batch);
    }
  }
}

template <class M>
MetricCode codeOf()
{
  MetricCode code;
  if constexpr (M::in2D)
  {
    code.value2D = evaluateTarget<M, 2, false>;
    code.gradient2D = evaluateTarget<M, 2, true>;
  }
  if constexpr (M::in3D)
  {
    code.value3D = evaluateTarget<M, 3, false>;
    code.gradient3D = evaluateTarget<M, 3, true>;
  }
  return code;
}
}

MetricCode userTargetMetricCode(bool singular)
{
  return singular ? codeOf<UserTarget<true>>() : codeOf<UserTarget<false>>();
}

MetricCode targetMetricCode(Metric metric)
{
  switch (metric)
  {
    case Metric::InverseMeanRatio:
      return codeOf<InverseMeanRatio>();
    case Metric::MeanRatio:
      return codeOf<MeanRatio>();
    case Metric::ConditionNumber:
      return codeOf<ConditionNumber>();
    case Metric::UntangleBeta:
      return codeOf<UntangleBeta>();
    case Metric::ShapeBarrier:
      return codeOf<ShapeBarrier>();
    case Metric::ShapeNonBarrier:
      return codeOf<ShapeNonBarrier>();
    case Metric::ShapeCondition:
      return codeOf<ShapeCondition>();
    case Metric::ShapeConditionSquared:
      return codeOf<ShapeConditionSquared>();
    case Metric::ShapeSquared:
      return codeOf<ShapeSquared>();
    case Metric::ShapeProduct:
      return codeOf<ShapeProduct>();
    case Metric::ShapeCubic:
      return codeOf<ShapeCubic>();
    case Metric::ShapeSizeAdjugate:
      return codeOf<ShapeSizeAdjugate>();
    case Metric::ShapeSimilarity:
      return codeOf<ShapeSimilarity>();
    case Metric::ShapeSizeBarrier:
      return codeOf<ShapeSizeBarrier>();
    case Metric::ShapeSizeWeighted:
      return codeOf<ShapeSizeWeighted>();
    case Metric::ShapeSizeLogarithm:
      return codeOf<ShapeSizeLogarithm>();
    case Metric::SizeNonBarrier:
      return codeOf<SizeNonBarrier>();
    case Metric::SizeBarrier:
      return codeOf<SizeBarrier>();
    case Metric::SizeBarrierSquared:
      return codeOf<SizeBarrierSquared>();
    case Metric::SizeUntangle:
      return codeOf<SizeUntangle>();
    case Metric::ShapeOrientation:
      return codeOf<ShapeOrientation>();
    case Metric::ShapeOrientationBarrier:
      return codeOf<ShapeOrientationBarrier>();
    case Metric::ShapeSizeOrientation:
      return codeOf<ShapeSizeOrientation>();
    case Metric::ShapeSizeOrientationBarrier:
      return codeOf<ShapeSizeOrientationBarrier>();
    default:
      return {};
  }
}
}
