// SPDX-License-Identifier: BSD-3-Clause
#include "Batch.h"
#include "CombineCorners.h"
#include "TargetCorner.h"
#include "TargetMetricList.h"
#include "UserMetric.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// A metric that was registered: BatchContext::user evaluates it.
template <bool Singular>
struct UserTarget : TargetMetric
{
  static constexpr bool user = true;
  static constexpr bool singular = Singular;
};

/// Adds weight * dq/d(points) of one corner.
template <class M, int N>
void addGradient(const BatchContext& context, const Corner<N>& corner, int sample,
  const TargetInvariants<N>& d, Packet weight, Batch& batch)
{
  // dq/dT = 2 q_n T + q_d cof T + q_t I, from the derivatives by |T|^2, det T and tr T; the
  // adjugate is added below.
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
    // The root is symmetric, so the chain rule maps P to root P.
    Packet seen[N][N];
    multiply<N>(corner.root, p, seen);
    std::copy(&seen[0][0], &seen[0][0] + N * N, &p[0][0]);
  }

  // dq/dA = P W^-t, then from the columns of A to the nodes of the corner.
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
        // In 2D, a row of T refers to an axis in the plane of the cell.
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

/// The value (and partial derivatives) of a metric at a corner, 0 if it is singular.
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

/// As above, including user metrics.
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

/**
 * @brief A user metric at a corner, with its derivative with respect to the moving vertex
 * (Batch::moving), in mesh coordinates.
 */
template <class M, int N>
Packet evaluateMoving(const BatchContext& context, const Batch& batch, int sample,
  Corner<N>& corner, Packet (&slope)[3])
{
  // A vertex at the corner moves all columns of A backward, a vertex at an edge end only its own
  // column.
  const auto& nodes = context.topology->cornerNodes[sample];
  Packet along[N] = {}, byRow[N], q;
  for (int k = 0; k < N; ++k)
  {
    const Packet moves = batch.moving[nodes[k + 1]] - batch.moving[nodes[0]];
    for (int c = 0; c < N; ++c)
    {
      along[c] += moves * corner.inverse[k][c];
    }
  }
  context.user->evaluateAlong(context.topology->type, PacketWidth, PacketWidth,
    reinterpret_cast<const double*>(corner.t), reinterpret_cast<const double*>(along),
    reinterpret_cast<double*>(&q), reinterpret_cast<double*>(byRow));
  if (seenByTensor<M>(context))
  {
    Packet seen[N] = {};
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        seen[r] += corner.root[r][c] * byRow[c];
      }
    }
    std::copy_n(seen, N, byRow);
  }
  for (int c = 0; c < 3; ++c)
  {
    // The modulo avoids an access beyond the end for N = 2.
    slope[c] =
      N == 2 ? Packet(corner.axes[0][c] * byRow[0] + corner.axes[1][c] * byRow[1]) : byRow[c % N];
    slope[c] = M::singular ? select(corner.degenerate, Packet{}, slope[c]) : slope[c];
  }
  return M::singular ? select(corner.degenerate, Packet{}, q) : q;
}

/// The value of a user metric on cells, and its derivative with respect to the moving vertex.
template <class M, int N>
void evaluateMovingCells(
  const BatchContext& context, const Packet* normal, Corner<N>& corner, Batch& batch)
{
  const int samples = context.topology->samples;
  Packet q[MaxNodes] = {}, weights[MaxNodes] = {}, slopes[MaxNodes][3];
  Mask negative[MaxNodes] = {}, anyNegative = {}, degenerate = {};
  for (int s = 0; s < samples; ++s)
  {
    evaluateCorner<M, N>(context, batch, s, normal, corner);
    q[s] = evaluateMoving<M, N>(context, batch, s, corner, slopes[s]);
    if constexpr (M::singular)
    {
      negative[s] = (corner.invariants.det < 0.0) & ~corner.degenerate;
      degenerate |= corner.degenerate;
      anyNegative |= negative[s];
    }
  }
  if (samples == 1)
  {
    batch.value = q[0];
    std::copy_n(slopes[0], 3, batch.gradient[0]);
    return;
  }
  const Mask zero = degenerate & ~anyNegative; // as in evaluateTarget()
  batch.value = select(zero, Packet{}, combine(context, samples, q, negative, weights));
  for (int c = 0; c < 3; ++c)
  {
    batch.gradient[0][c] = Packet{};
    for (int s = 0; s < samples; ++s)
    {
      batch.gradient[0][c] += select(zero, Packet{}, weights[s]) * slopes[s][c];
    }
  }
}

/// Whether a metric is a function of only |T|^2 and det T, with T relative to the target.
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
    // The derivative of |T|^2 by p_k is 4 p_k - sum p; the derivative of det A is the cofactor.
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

/// Inlined into one function: calls between the steps would cost more than the steps.
template <class M, int N, bool WithGradient>
__attribute__((flatten)) void evaluateTarget(const BatchContext& context, Batch& batch)
{
  const CellTopology& topology = *context.topology;
  const int samples = topology.samples;
  if constexpr (N == 3 && ofNormAndDeterminant<M>)
  {
    // In a scaled batch, T would be in units of the cell, which only scale-invariant metrics allow.
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
  if constexpr (M::user && WithGradient)
  {
    if (batch.moving)
    {
      evaluateMovingCells<M, N>(context, own, corner, batch);
      return;
    }
  }
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

  constexpr int kept = M::user && WithGradient ? MaxNodes : 1; // a user formula is evaluated once
  Packet q[MaxNodes] = {}, weights[MaxNodes] = {}, slopes[kept][N][N];
  Mask negative[MaxNodes] = {}, degenerate = {};
  for (int s = 0; s < samples; ++s)
  {
    TargetInvariants<N> d;
    evaluateCorner<M, N>(context, batch, s, own, corner);
    // A user formula yields its derivatives in this pass; the other metrics compute them in the
    // second one.
    q[s] = evaluateFormula < M, N, WithGradient && M::user > (context, corner, d);
    std::copy_n(&corner.slope[0][0], M::user && WithGradient ? N * N : 0, &slopes[s % kept][0][0]);
    negative[s] = (corner.invariants.det < 0.0) & ~corner.degenerate;
    if constexpr (!M::singular)
    {
      negative[s] = Mask{}; // an untangling metric needs the contribution of every corner
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
    // The weights of the corners are only known now; evaluating a corner twice is cheaper than
    // storing its matrices.
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
  return withTargetMetric(metric, [](auto formula) { return codeOf<decltype(formula)>(); });
}
}
