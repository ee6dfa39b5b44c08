// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExtremalMetrics.cxx
 * @brief Metrics that are an extremum over the edges or corners of a cell, on packets of cells.
 *
 * A first loop finds the extremal term of each lane and keeps its vectors; the derivatives of this
 * term are then added to its nodes. The facts are in MetricRegistry.cxx.
 */
#include "Batch.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr int allNodes[MaxFaceNodes] = { 0, 1, 2, 3 };

void keep(Mask lanes, const Packet* from, Packet* to)
{
  for (int c = 0; c < 3; ++c)
  {
    to[c] = select(lanes, from[c], to[c]);
  }
}

/// Adds the vector to the gradient of one node in some lanes, and subtracts it from another.
void addDifference(Mask lanes, const Packet* by, int plus, int minus, Batch& batch)
{
  for (int c = 0; c < 3; ++c)
  {
    const Packet d = select(lanes, by[c], Packet{});
    batch.gradient[plus][c] += d;
    batch.gradient[minus][c] -= d;
  }
}

void clearGradient(int nodes, Batch& batch)
{
  for (int k = 0; k < nodes; ++k)
  {
    batch.gradient[k][0] = batch.gradient[k][1] = batch.gradient[k][2] = Packet{};
  }
}

/// The normal of a face, twice its vector area: (p1 - p0) x (p2 - p0), or across the diagonals.
struct FaceNormals
{
  FaceNormals() = default;
  FaceNormals(const Packet (&points)[MaxNodes][3], const int* faceNodes, int faceSize)
    : nodes(faceNodes)
    , triangle(faceSize == 3)
  {
    subtract(points[this->nodes[this->triangle ? 1 : 2]], points[this->nodes[0]], this->u);
    subtract(points[this->nodes[this->triangle ? 2 : 3]],
      points[this->nodes[this->triangle ? 0 : 1]], this->v);
    cross(this->u, this->v, this->normal);
  }

  /// Adds the derivatives with respect to the points, from the derivatives with respect to the
  /// normal.
  void addGradient(const Packet* byNormal, Batch& batch) const
  {
    Packet du[3], dv[3];
    cross(this->v, byNormal, du);
    cross(byNormal, this->u, dv);
    const Mask all = broadcast(1.0) > 0.0;
    addDifference(all, du, this->nodes[this->triangle ? 1 : 2], this->nodes[0], batch);
    addDifference(
      all, dv, this->nodes[this->triangle ? 2 : 3], this->nodes[this->triangle ? 0 : 1], batch);
  }

  const int* nodes = nullptr;
  bool triangle = false;
  Packet u[3], v[3], normal[3];
};

/// The positive side of a 2D cell: relative to the plane of the mesh, or of the cell itself.
void positiveSide(const BatchContext& context, const Batch& batch, Packet* side)
{
  if (context.mesh->dimension() != Dimension::Planar)
  {
    const FaceNormals face(batch.points, allNodes, context.topology->nodes);
    std::copy_n(face.normal, 3, side);
    return;
  }
  for (int c = 0; c < 3; ++c)
  {
    side[c] = broadcast((context.mesh->mirrored() ? -1.0 : 1.0) * context.mesh->normal()[c]);
  }
}

//------------------------------------------------------------------------------
/// Longest over shortest edge; 0 if the latter vanishes.
template <bool WithGradient>
void edgeRatio(const BatchContext& context, Batch& batch)
{
  const CellTopology& t = *context.topology;
  Packet longest[3] = {}, shortest[3] = {}, atLongest = {}, atShortest = {};
  Packet most = broadcast(-1.0), least = broadcast(HUGE_VAL);
  for (int e = 0; e < t.edges; ++e)
  {
    Packet edge[3];
    subtract(batch.points[t.edgeNodes[e][1]], batch.points[t.edgeNodes[e][0]], edge);
    const Packet length2 = dot(edge, edge);
    const Mask more = length2 > most, less = length2 < least;
    most = select(more, length2, most);
    least = select(less, length2, least);
    if constexpr (WithGradient)
    {
      keep(more, edge, longest);
      keep(less, edge, shortest);
      atLongest = select(more, broadcast(e), atLongest);
      atShortest = select(less, broadcast(e), atShortest);
    }
  }
  const Packet longestLength = sqrt(most), shortestLength = sqrt(least);
  const Mask good = shortestLength > 0.0;
  batch.value = select(good, longestLength / shortestLength, Packet{});
  if constexpr (WithGradient)
  {
    clearGradient(t.nodes, batch);
    // With longest and shortest edge a and b, the derivatives of |a| / |b| are a / (|a| |b|) and -q
    // b / |b|^2.
    const Packet byLongest = select(good, 1.0 / (longestLength * shortestLength), Packet{});
    const Packet byShortest = select(good, -batch.value / least, Packet{});
    for (int c = 0; c < 3; ++c)
    {
      longest[c] *= byLongest;
      shortest[c] *= byShortest;
    }
    for (int e = 0; e < t.edges; ++e)
    {
      const auto& n = t.edgeNodes[e];
      addDifference(atLongest == static_cast<double>(e), longest, n[1], n[0], batch);
      addDifference(atShortest == static_cast<double>(e), shortest, n[1], n[0], batch);
    }
  }
}

//------------------------------------------------------------------------------
/// The smallest corner Jacobian over its edge lengths, scaled to 1 for the ideal corner. In 2D, the
/// third edge is the unit normal on the positive side.
template <bool WithGradient>
void scaledJacobian(const BatchContext& context, Batch& batch)
{
  const CellTopology& t = *context.topology;
  Packet side[3];
  if (t.dimension == 2)
  {
    positiveSide(context, batch, side);
  }
  Packet edges[3][3] = {}, scale = {}, worst = {};
  batch.value = broadcast(HUGE_VAL);
  for (int corner = 0; corner < t.corners; ++corner)
  {
    const auto& nodes = t.cornerNodes[corner];
    Packet e[3][3], normal[3], lengths = broadcast(1.0);
    for (int k = 0; k < t.dimension; ++k)
    {
      subtract(batch.points[nodes[k + 1]], batch.points[nodes[0]], e[k]);
      lengths *= sqrt(dot(e[k], e[k]));
    }
    cross(e[0], e[1], normal);
    if (t.dimension == 2)
    {
      const Packet length = sqrt(dot(normal, normal));
      const Packet over = select(length > 0.0,
        select(dot(normal, side) < 0.0, broadcast(-1.0), broadcast(1.0)) / length, Packet{});
      for (int c = 0; c < 3; ++c)
      {
        e[2][c] = normal[c] * over;
      }
    }
    const Packet factor = select(lengths > 0.0, t.scaledJacobianFactor / lengths, Packet{});
    const Packet q = factor * dot(normal, e[2]);
    const Mask less = q < batch.value;
    batch.value = select(less, q, batch.value);
    if constexpr (WithGradient)
    {
      keep(less, e[0], edges[0]);
      keep(less, e[1], edges[1]);
      keep(less, e[2], edges[2]);
      scale = select(less, factor, scale);
      worst = select(less, broadcast(corner), worst);
    }
  }
  // A cell whose corners are NaN.
  batch.value = select(batch.value < HUGE_VAL, batch.value, Packet{});
  if constexpr (WithGradient)
  {
    clearGradient(t.nodes, batch);
    Packet d[3][3];
    for (int k = 0; k < t.dimension; ++k)
    {
      // The value is s e_0 . (e_1 x e_2) with the reciprocal product of lengths s: its derivative
      // by an edge is s times the cross product of the others, minus q e / |e|^2.
      const Packet length2 = dot(edges[k], edges[k]);
      const Packet along = select(length2 > 0.0, batch.value / length2, Packet{});
      cross(edges[(k + 1) % 3], edges[(k + 2) % 3], d[k]);
      for (int c = 0; c < 3; ++c)
      {
        d[k][c] = select(scale > 0.0, scale * d[k][c] - along * edges[k][c], Packet{});
      }
    }
    for (int corner = 0; corner < t.corners; ++corner)
    {
      const auto& nodes = t.cornerNodes[corner];
      const Mask here = worst == static_cast<double>(corner);
      for (int k = 0; k < t.dimension; ++k)
      {
        addDifference(here, d[k], nodes[k + 1], nodes[0], batch);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The angle between vectors of length 1, in degrees; 0 if one has length 0.
Packet angleOf(Packet sine, Packet cosine)
{
  Packet angle;
  for (int l = 0; l < PacketWidth; ++l)
  {
    angle[l] =
      sine[l] == 0 && cosine[l] == 0 ? 0.0 : DegreesPerRadian * std::atan2(sine[l], cosine[l]);
  }
  return angle;
}

/// Returns the length of a vector and normalizes it, or sets it to 0 if it has no length.
Packet normalize(Packet* x)
{
  const Packet length = sqrt(dot(x, x));
  const Packet over = select(length > 0.0, 1.0 / length, Packet{});
  for (int c = 0; c < 3; ++c)
  {
    x[c] *= over;
  }
  return length;
}

/// Two vectors of length 1, their lengths before, and the angle between.
struct Angles
{
  Packet a[3], b[3], lengthA, lengthB, sine, cosine, rank;

  void find()
  {
    Packet n[3];
    cross(this->a, this->b, n);
    this->sine = sqrt(dot(n, n));
    this->cosine = dot(this->a, this->b);
    this->rank = rankOfAngle(this->sine, this->cosine);
  }

  void keepFrom(Mask lanes, const Angles& other)
  {
    keep(lanes, other.a, this->a);
    keep(lanes, other.b, this->b);
    this->lengthA = select(lanes, other.lengthA, this->lengthA);
    this->lengthB = select(lanes, other.lengthB, this->lengthB);
    this->sine = select(lanes, other.sine, this->sine);
    this->cosine = select(lanes, other.cosine, this->cosine);
    this->rank = select(lanes, other.rank, this->rank);
  }

  /// The derivatives of the angle with respect to the vectors, times a factor; 0 if the vectors
  /// span no plane.
  void derivatives(Packet factor, Packet* da, Packet* db) const
  {
    const Packet overA = select(this->sine > 0.0, -factor / (this->lengthA * this->sine), Packet{});
    const Packet overB = select(this->sine > 0.0, -factor / (this->lengthB * this->sine), Packet{});
    for (int c = 0; c < 3; ++c)
    {
      da[c] = overA * (this->b[c] - this->cosine * this->a[c]);
      db[c] = overB * (this->a[c] - this->cosine * this->b[c]);
    }
  }
};

/// The extremal dihedral angle inside a 3D cell, between the planes of the two faces of an edge, in
/// [0, pi]. @param Sign 1: the largest, -1: the smallest
template <int Sign, bool WithGradient>
void extremalDihedral(const BatchContext& context, Batch& batch)
{
  const CellTopology& t = *context.topology;
  FaceNormals faces[MaxFaces];
  Packet unit[MaxFaces][3], length[MaxFaces];
  for (int f = 0; f < t.faces; ++f)
  {
    faces[f] = FaceNormals(batch.points, t.faceNodes[f].data(), t.faceSizes[f]);
    std::copy_n(faces[f].normal, 3, unit[f]);
    length[f] = normalize(unit[f]);
  }
  Angles best = {};
  Packet bestRank = broadcast(HUGE_VAL), at = {};
  for (int e = 0; e < t.edges; ++e)
  {
    const int first = t.edgeFaces[e][0], second = t.edgeFaces[e][1];
    Angles angles;
    // The inner angle is between one outward normal and the reversed other one.
    for (int c = 0; c < 3; ++c)
    {
      angles.a[c] = unit[first][c];
      angles.b[c] = -unit[second][c];
    }
    angles.lengthA = length[first];
    angles.lengthB = length[second];
    angles.find();
    const Mask better = static_cast<double>(Sign) * angles.rank < bestRank;
    bestRank = select(better, static_cast<double>(Sign) * angles.rank, bestRank);
    best.keepFrom(better, angles);
    at = select(better, broadcast(e), at);
  }
  batch.value = angleOf(best.sine, best.cosine);
  if constexpr (WithGradient)
  {
    clearGradient(t.nodes, batch);
    Packet da[3], db[3], byNormal[MaxFaces][3] = {};
    best.derivatives(broadcast(DegreesPerRadian), da, db);
    for (int e = 0; e < t.edges; ++e)
    {
      const Mask here = at == static_cast<double>(e);
      // b is the reversed normal of the second face, hence the sign.
      for (int c = 0; c < 3; ++c)
      {
        byNormal[t.edgeFaces[e][0]][c] += select(here, da[c], Packet{});
        byNormal[t.edgeFaces[e][1]][c] -= select(here, db[c], Packet{});
      }
    }
    for (int f = 0; f < t.faces; ++f)
    {
      faces[f].addGradient(byNormal[f], batch);
    }
  }
}

/// The extremal interior angle of a 2D cell in [0, 2 pi), reflex if a corner of a quadrilateral
/// turns opposite to the cell. @param Sign 1: the largest, -1: the smallest
template <int Sign, bool WithGradient>
void extremalCorner(const BatchContext& context, Batch& batch)
{
  const CellTopology& t = *context.topology;
  const FaceNormals face(batch.points, allNodes, t.nodes);
  Angles best = {};
  Packet bestRank = broadcast(HUGE_VAL), at = {}, turn = {};
  for (int corner = 0; corner < t.corners; ++corner)
  {
    const auto& nodes = t.cornerNodes[corner];
    Angles angles;
    Packet normal[3];
    subtract(batch.points[nodes[1]], batch.points[nodes[0]], angles.a);
    subtract(batch.points[nodes[2]], batch.points[nodes[0]], angles.b);
    cross(angles.a, angles.b, normal);
    // Only quadrilaterals can have reflex corners; on triangles, the comparison would be rounding.
    const Mask reflex = t.nodes == 4 ? dot(normal, face.normal) < 0.0 : Mask{};
    angles.lengthA = normalize(angles.a);
    angles.lengthB = normalize(angles.b);
    angles.find();
    // Beyond pi, the rank continues to decrease, from -1 to -3.
    const Packet rank = static_cast<double>(Sign) * select(reflex, -2.0 - angles.rank, angles.rank);
    const Mask better = rank < bestRank;
    bestRank = select(better, rank, bestRank);
    best.keepFrom(better, angles);
    at = select(better, broadcast(corner), at);
    turn = select(better, select(reflex, broadcast(-1.0), broadcast(1.0)), turn);
  }
  constexpr double wholeTurn = 360;
  const Packet angle = angleOf(best.sine, best.cosine);
  batch.value = select(turn < 0.0, wholeTurn - angle, angle);
  if constexpr (WithGradient)
  {
    clearGradient(t.nodes, batch);
    Packet da[3], db[3];
    // A reflex angle is 360 degrees minus the angle between the edges, so its derivatives change
    // their sign.
    best.derivatives(DegreesPerRadian * turn, da, db);
    for (int corner = 0; corner < t.corners; ++corner)
    {
      const auto& nodes = t.cornerNodes[corner];
      const Mask here = at == static_cast<double>(corner);
      addDifference(here, da, nodes[1], nodes[0], batch);
      addDifference(here, db, nodes[2], nodes[0], batch);
    }
  }
}

template <int Sign>
MetricCode anglesCode()
{
  return { extremalCorner<Sign, false>, extremalCorner<Sign, true>, extremalDihedral<Sign, false>,
    extremalDihedral<Sign, true> };
}
}

MetricCode extremalMetricCode(Metric metric)
{
  switch (metric)
  {
    case Metric::EdgeRatio:
      return { edgeRatio<false>, edgeRatio<true>, edgeRatio<false>, edgeRatio<true> };
    case Metric::MinimumAngle:
      return anglesCode<-1>();
    case Metric::MaximumAngle:
      return anglesCode<1>();
    case Metric::ScaledJacobian:
      return { scaledJacobian<false>, scaledJacobian<true>, scaledJacobian<false>,
        scaledJacobian<true> };
    default:
      return {};
  }
}
}
