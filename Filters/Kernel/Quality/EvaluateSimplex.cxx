// SPDX-License-Identifier: BSD-3-Clause
#include "Batch.h"
#include "SimplexMetrics.h"

namespace tautline
{
namespace
{
/// The nodes of the face opposite each vertex of a tetrahedron.
constexpr int oppositeFace[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };

/// Adds scale times the derivatives of the squared normal of a triangle, or of its normal along n:
/// both are n . ((b - a) x (c - a)) to first order.
void addNormalGradient(Packet scale, const Packet* n, int a, int b, int c, Batch& batch)
{
  Packet ab[3], ac[3], forB[3], forC[3];
  subtract(batch.points[b], batch.points[a], ab);
  subtract(batch.points[c], batch.points[a], ac);
  cross(ac, n, forB);
  cross(n, ab, forC);
  for (int i = 0; i < 3; ++i)
  {
    batch.gradient[b][i] += scale * forB[i];
    batch.gradient[c][i] += scale * forC[i];
    batch.gradient[a][i] -= scale * (forB[i] + forC[i]);
  }
}

/**
 * @brief The gradient of a metric with respect to the points, from its derivatives d with respect
 * to the invariants.
 * @param edges from point 0 to the others
 * @param normal of a triangle, of length 1
 * @param faceNormal of the faces of a tetrahedron, with twice their areas as length. Always
 * inlined: it shares products with the value.
 */
template <int N>
inline __attribute__((always_inline)) void setGradient(const CellTopology& topology,
  const SimplexInvariants<N>& d, Mask degenerate, const Packet (&edges)[3][3], const Packet* normal,
  const Packet (&faceNormal)[4][3], Batch& batch)
{
  for (int k = 0; k < topology.nodes; ++k)
  {
    batch.gradient[k][0] = batch.gradient[k][1] = batch.gradient[k][2] = Packet{};
  }
  for (int e = 0; e < d.edges; ++e)
  {
    const int i = topology.edgeNodes[e][0], j = topology.edgeNodes[e][1];
    // The derivative of a squared length is twice the edge vector.
    const Packet factor = select(degenerate, Packet{}, 2.0 * d.edge2[e]);
    for (int c = 0; c < 3; ++c)
    {
      const Packet g = factor * (batch.points[j][c] - batch.points[i][c]);
      batch.gradient[j][c] += g;
      batch.gradient[i][c] -= g;
    }
  }
  const Packet size = select(degenerate, Packet{}, d.size);
  if constexpr (N == 2)
  {
    addNormalGradient(0.5 * size, normal, 0, 1, 2, batch);
  }
  else
  {
    for (int f = 0; f < 4; ++f)
    {
      // The squared area is |n|^2 / 4, and its derivative is half of n times the derivative of n.
      addNormalGradient(select(degenerate, Packet{}, 0.5 * d.face2[f]), faceNormal[f],
        oppositeFace[f][0], oppositeFace[f][1], oppositeFace[f][2], batch);
    }
    // 6 V = ((b - a) x (c - a)) . (d - a)
    Packet g[3][3];
    cross(edges[1], edges[2], g[0]);
    cross(edges[2], edges[0], g[1]);
    cross(edges[0], edges[1], g[2]);
    for (int k = 0; k < 3; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Packet term = (1.0 / 6.0) * size * g[k][c];
        batch.gradient[k + 1][c] += term;
        batch.gradient[0][c] -= term;
      }
    }
  }
}

template <class M, int N, bool WithGradient>
void evaluateSimplex(const BatchContext& context, Batch& batch)
{
  const CellTopology& topology = *context.topology;
  SimplexInvariants<N> s, d;
  for (int e = 0; e < s.edges; ++e)
  {
    Packet edge[3];
    subtract(batch.points[topology.edgeNodes[e][1]], batch.points[topology.edgeNodes[e][0]], edge);
    s.edge2[e] = dot(edge, edge);
  }
  Packet edges[3][3], normal[3], faceNormal[4][3];
  subtract(batch.points[1], batch.points[0], edges[0]);
  subtract(batch.points[2], batch.points[0], edges[1]);
  cross(edges[0], edges[1], normal);
  // Degeneracy is relative to the product of the lengths of the edges at point 0.
  Packet lengths2 = s.edge2[0] * s.edge2[2], jacobian2;
  if constexpr (N == 2)
  {
    // The area of a planar triangle is signed along the mesh normal, the area of a surface triangle
    // along its own normal.
    jacobian2 = dot(normal, normal);
    const Packet length = sqrt(jacobian2);
    // A triangle without area gets a zero normal instead of NaN.
    const Packet over = select(length > 0.0, 1.0 / length, Packet{});
    const bool planar = context.mesh->dimension() == Dimension::Planar;
    for (int c = 0; c < 3; ++c)
    {
      const double mirror = context.mesh->mirrored() ? -1.0 : 1.0;
      const Packet unit =
        planar ? broadcast(mirror * context.mesh->normal()[c]) : Packet(normal[c] * over);
      s.size += 0.5 * normal[c] * unit;
      normal[c] = unit;
    }
  }
  else
  {
    subtract(batch.points[3], batch.points[0], edges[2]);
    const Packet jacobian = dot(normal, edges[2]);
    s.size = jacobian * (1.0 / 6.0);
    jacobian2 = jacobian * jacobian;
    lengths2 *= s.edge2[3];
    for (int f = 0; f < 4; ++f)
    {
      Packet u[3], v[3];
      subtract(batch.points[oppositeFace[f][1]], batch.points[oppositeFace[f][0]], u);
      subtract(batch.points[oppositeFace[f][2]], batch.points[oppositeFace[f][0]], v);
      cross(u, v, faceNormal[f]);
      s.face2[f] = 0.25 * dot(faceNormal[f], faceNormal[f]);
    }
  }
  // Both sides have the same power of a length: the test is independent of the scale.
  const double tolerance = Mesh::degenerateTolerance() * Mesh::degenerateTolerance();
  const Mask degenerate = jacobian2 <= tolerance * lengths2;
  batch.value = select(degenerate, Packet{}, M::template evaluate<N>(s, d));

  if constexpr (WithGradient)
  {
    setGradient<N>(topology, d, degenerate, edges, normal, faceNormal, batch);
  }
}

template <class M>
MetricCode codeOf()
{
  MetricCode code;
  if constexpr (M::in2D)
  {
    code.value2D = evaluateSimplex<M, 2, false>;
    code.gradient2D = evaluateSimplex<M, 2, true>;
  }
  if constexpr (M::in3D)
  {
    code.value3D = evaluateSimplex<M, 3, false>;
    code.gradient3D = evaluateSimplex<M, 3, true>;
  }
  return code;
}
}

MetricCode simplexMetricCode(Metric metric)
{
  switch (metric)
  {
    case Metric::RadiusRatio:
      return codeOf<RadiusRatio>();
    case Metric::NormalizedRadiusRatio:
      return codeOf<NormalizedRadiusRatio>();
    case Metric::ConditioningScaleInvariant:
      return codeOf<ConditioningScaleInvariant>();
    case Metric::ConditioningSizeShape:
      return codeOf<ConditioningSizeShape>();
    case Metric::InterpolationSizeShape:
      return codeOf<InterpolationSizeShape>();
    case Metric::InterpolationScaleInvariant:
      return codeOf<InterpolationScaleInvariant>();
    default:
      return {};
  }
}
}
