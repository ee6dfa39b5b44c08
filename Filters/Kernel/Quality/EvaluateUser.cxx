// SPDX-License-Identifier: BSD-3-Clause
#include "Batch.h"
#include "UserMetric.h"

namespace tautline
{
namespace
{
/// Coordinates in the form used by a user metric: in the plane of a planar mesh, in mesh units.
template <int Nodes>
void loadCorners(
  const Batch& batch, const Packet (*axes)[3], Packet unit, Packet (&points)[Nodes][3])
{
  for (int k = 0; k < Nodes; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      points[k][c] = unit *
        (!axes      ? batch.points[k][c]
            : c < 2 ? dot(axes[c], batch.points[k])
                    : Packet{});
    }
  }
}

/// Derivatives with respect to the coordinates of the batch, which are the mesh coordinates per
/// unit.
template <int Nodes>
void carryBack(const Packet (*slopes)[3], const Packet (*axes)[3], Packet unit, Batch& batch)
{
  for (int k = 0; k < Nodes; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      batch.gradient[k][c] = unit *
        (axes ? Packet(axes[0][c] * slopes[k][0] + axes[1][c] * slopes[k][1]) : slopes[k][c]);
    }
  }
}

template <int Nodes, bool WithGradient>
void evaluateCorners(const BatchContext& context, Batch& batch)
{
  const Mesh& mesh = *context.mesh;
  const bool planar = context.topology->dimension == 2 && mesh.dimension() == Dimension::Planar;
  Packet axes[2][3] = {};
  for (int a = 0; planar && a < 2; ++a)
  {
    const Vec3& axis = mesh.frame()[mesh.mirrored() ? 1 - a : a];
    for (int c = 0; c < 3; ++c)
    {
      axes[a][c] = broadcast(axis[c]);
    }
  }
  // User metrics expect mesh coordinates instead of the normalized ones of the batch.
  const Packet unit = batch.scaled ? batch.unit : broadcast(1.0);
  Packet points[Nodes][3], slopes[Nodes][3];
  loadCorners<Nodes>(batch, planar ? axes : nullptr, unit, points);
  if (WithGradient && batch.moving)
  {
    context.user->evaluateAlong(context.topology->type, PacketWidth, PacketWidth,
      reinterpret_cast<const double*>(points), reinterpret_cast<const double*>(batch.moving),
      reinterpret_cast<double*>(&batch.value), reinterpret_cast<double*>(slopes));
    carryBack<1>(slopes, planar ? axes : nullptr, unit, batch);
    return;
  }
  context.user->evaluate(context.topology->type, PacketWidth, PacketWidth,
    reinterpret_cast<const double*>(points), reinterpret_cast<double*>(&batch.value),
    WithGradient ? reinterpret_cast<double*>(slopes) : nullptr);
  if constexpr (WithGradient)
  {
    carryBack<Nodes>(slopes, planar ? axes : nullptr, unit, batch);
  }
}

template <bool WithGradient>
void evaluateAny(const BatchContext& context, Batch& batch)
{
  withNodes(*context.topology,
    [&](auto nodes) { evaluateCorners<decltype(nodes)::value, WithGradient>(context, batch); });
}
}

//------------------------------------------------------------------------------
MetricCode userCornerMetricCode()
{
  return { evaluateAny<false>, evaluateAny<true>, evaluateAny<false>, evaluateAny<true> };
}
}
