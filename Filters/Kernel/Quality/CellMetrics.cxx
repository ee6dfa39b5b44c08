// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellMetrics.cxx
 * @brief Metrics of whole cells: lengths, angles, sizes. Scalar code, one function per metric.
 *
 * A function returns the value and, on request, adds the gradient; for an extremum, it is the
 * gradient of the extremal term. The most expensive functions are in ExtremalMetrics.cxx, the facts
 * in MetricRegistry.cxx.
 */
#include "Batch.h"

#include "tautline/Mesh/JacobianBounds.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{

/// One cell, the argument of a metric function.
struct Cell
{
  const CellTopology& topology;
  const Vec3* points;
  bool planar;
  Vec3 normal; ///< of the (possibly mirrored) planar mesh
};

/// The gradient to add to, or null.
using Gradient = Vec3*;

Vec3 perpendicular(const Vec3& x, const Vec3& unit)
{
  return x - dot(x, unit) * unit;
}

/// Angle between two vectors in [0, pi] and its derivatives; 0 with zero derivatives if one
/// vanishes.
double angleBetween(const Vec3& a, const Vec3& b, Vec3* da, Vec3* db)
{
  const double la = norm(a), lb = norm(b);
  if (da)
  {
    *da = *db = { 0, 0, 0 };
  }
  if (la == 0 || lb == 0)
  {
    return 0;
  }
  const Vec3 ua = (1 / la) * a, ub = (1 / lb) * b;
  // The arc tangent is accurate near 0 and 180 degrees, where the arc cosine is not.
  const double sine = norm(cross(ua, ub));
  // The angle is not differentiable at 0 and 180 degrees.
  if (da && sine > 0)
  {
    *da = (-1 / (la * sine)) * perpendicular(ub, ua);
    *db = (-1 / (lb * sine)) * perpendicular(ua, ub);
  }
  return std::atan2(sine, dot(ua, ub));
}

/// The normal of a face, twice its vector area: (p1 - p0) x (p2 - p0), or across the diagonals.
struct FaceNormal
{
  const int* nodes;
  int size;
  Vec3 u, v, normal;
  FaceNormal(const Vec3* p, const int* faceNodes, int faceSize)
    : nodes(faceNodes)
    , size(faceSize)
    , u(p[faceNodes[faceSize == 3 ? 1 : 2]] - p[faceNodes[0]])
    , v(p[faceNodes[faceSize == 3 ? 2 : 3]] - p[faceNodes[faceSize == 3 ? 0 : 1]])
    , normal(cross(u, v))
  {
  }
  void addGradient(const Vec3& dNormal, Gradient g) const
  {
    // The derivative of (u x v) . w with respect to u is v x w, and with respect to v it is w x u.
    const Vec3 du = cross(this->v, dNormal), dv = cross(dNormal, this->u);
    g[this->nodes[this->size == 3 ? 1 : 2]] += du;
    g[this->nodes[0]] -= du;
    g[this->nodes[this->size == 3 ? 2 : 3]] += dv;
    g[this->nodes[this->size == 3 ? 0 : 1]] -= dv;
  }
};

constexpr int allNodes[MaxFaceNodes] = { 0, 1, 2, 3 };

/// The sign of a 2D cell: relative to the plane of the mesh, or + on a surface.
double cellSign(const Cell& cell, const FaceNormal& face)
{
  return cell.planar && dot(face.normal, cell.normal) < 0 ? -1.0 : 1.0;
}

//------------------------------------------------------------------------------
/// Signed area or volume. A bilinear face bounds the mean volume of its two triangulations,
/// exactly.
double size(const Cell& cell, Gradient g)
{
  const CellTopology& t = cell.topology;
  const Vec3* p = cell.points;
  if (t.dimension == 2)
  {
    const FaceNormal face(p, allNodes, t.nodes);
    const double length = norm(face.normal);
    if (length == 0)
    {
      return 0;
    }
    const double sign = cellSign(cell, face);
    if (g)
    {
      face.addGradient((0.5 * sign / length) * face.normal, g);
    }
    return 0.5 * sign * length;
  }
  double volume = 0;
  // The volume is the sum of the signed tetrahedra from node 0 to the triangles of all faces.
  auto addTriangle = [&](int i, int j, int k, double weight)
  {
    const Vec3 a = p[i] - p[0], b = p[j] - p[0], c = p[k] - p[0];
    const Vec3 bc = cross(b, c);
    volume += weight / 6 * dot(a, bc);
    if (g)
    {
      const Vec3 da = (weight / 6) * bc, db = (weight / 6) * cross(c, a),
                 dc = (weight / 6) * cross(a, b);
      g[i] += da;
      g[j] += db;
      g[k] += dc;
      g[0] -= da + db + dc;
    }
  };
  for (int f = 0; f < t.faces; ++f)
  {
    const auto& n = t.faceNodes[f];
    if (t.faceSizes[f] == 3)
    {
      addTriangle(n[0], n[1], n[2], 1.0);
    }
    else
    {
      addTriangle(n[0], n[1], n[2], 0.5);
      addTriangle(n[0], n[2], n[3], 0.5);
      addTriangle(n[0], n[1], n[3], 0.5);
      addTriangle(n[1], n[2], n[3], 0.5);
    }
  }
  return volume;
}

//------------------------------------------------------------------------------
/// Ratio of two lengths |a| / |b| with its derivatives with respect to a and b.
double lengthRatio(const Vec3& a, const Vec3& b, Vec3* da, Vec3* db)
{
  const double la = norm(a), lb = norm(b);
  if (lb == 0)
  {
    return 0;
  }
  const double q = la / lb;
  if (da)
  {
    *da = (1 / (la * lb)) * a;
    *db = (-q / (lb * lb)) * b;
  }
  return q;
}

/// Longest over shortest principal axis of a quadrilateral or hexahedron.
double principalAxisRatio(const Cell& cell, Gradient g)
{
  // A principal axis is the sum of the nodes on one side of the cell minus the sum on the opposite
  // side.
  constexpr int quadSigns[2][4] = { { -1, 1, 1, -1 }, { -1, -1, 1, 1 } };
  constexpr int hexSigns[3][8] = { { -1, 1, 1, -1, -1, 1, 1, -1 }, { -1, -1, 1, 1, -1, -1, 1, 1 },
    { -1, -1, -1, -1, 1, 1, 1, 1 } };
  const int nodes = cell.topology.nodes, axes = cell.topology.dimension;
  auto sign = [&](int axis, int k) { return nodes == 4 ? quadSigns[axis][k] : hexSigns[axis][k]; };
  Vec3 axis[3];
  int longest = 0, shortest = 0;
  for (int a = 0; a < axes; ++a)
  {
    axis[a] = { 0, 0, 0 };
    for (int k = 0; k < nodes; ++k)
    {
      axis[a] += sign(a, k) * cell.points[k];
    }
    longest = norm(axis[a]) > norm(axis[longest]) ? a : longest;
    shortest = norm(axis[a]) < norm(axis[shortest]) ? a : shortest;
  }
  Vec3 da, db;
  const double q = lengthRatio(axis[longest], axis[shortest], g ? &da : nullptr, &db);
  for (int k = 0; g && q > 0 && k < nodes; ++k)
  {
    g[k] += sign(longest, k) * da + sign(shortest, k) * db;
  }
  return q;
}

/// Longest edge over the inradius, scaled to 1 for the regular simplex; principal axes elsewhere.
double aspectRatio(const Cell& cell, Gradient g)
{
  const CellTopology& t = cell.topology;
  if (t.samples > 1)
  {
    return principalAxisRatio(cell, g);
  }
  const Vec3* p = cell.points;
  // 1/r is the perimeter over 2 A, or the surface over 3 V.
  const double scale = t.dimension == 2 ? 1 / (4 * std::sqrt(3.0)) : 1 / (6 * std::sqrt(6.0));
  int longest = 0;
  double perimeter = 0;
  auto edge = [&](int e) { return p[t.edgeNodes[e][1]] - p[t.edgeNodes[e][0]]; };
  for (int e = 0; e < t.edges; ++e)
  {
    longest = norm(edge(e)) > norm(edge(longest)) ? e : longest;
    perimeter += t.dimension == 2 ? norm(edge(e)) : 0;
  }
  double area[4] = {};
  for (int f = 0; f < t.faces; ++f)
  {
    area[f] = 0.5 * norm(FaceNormal(p, t.faceNodes[f].data(), 3).normal);
    perimeter += area[f];
  }
  Vec3 dSize[4] = {};
  const double signedSize = size(cell, g ? dSize : nullptr);
  const double length = norm(edge(longest));
  if (signedSize == 0)
  {
    return 0;
  }
  const double q = scale * length * perimeter / std::abs(signedSize);
  if (g)
  {
    // Logarithmic derivatives: each factor of q contributes q times its derivative over its value.
    for (int k = 0; k < t.nodes; ++k)
    {
      g[k] += (-q / signedSize) * dSize[k];
    }
    const Vec3 dLongest = (q / (length * length)) * edge(longest);
    g[t.edgeNodes[longest][1]] += dLongest;
    g[t.edgeNodes[longest][0]] -= dLongest;
    for (int e = 0; t.dimension == 2 && e < t.edges; ++e)
    {
      const Vec3 d = (q / (perimeter * norm(edge(e)))) * edge(e);
      g[t.edgeNodes[e][1]] += d;
      g[t.edgeNodes[e][0]] -= d;
    }
    for (int f = 0; f < t.faces; ++f)
    {
      const FaceNormal face(p, t.faceNodes[f].data(), 3);
      face.addGradient((0.25 * q / (perimeter * area[f])) * face.normal, g);
    }
  }
  return q;
}

/// W / w: sides of the least elongated rectangle around the triangle with a side on an edge.
double widthRatio(const Cell& cell, Gradient g)
{
  const Vec3* p = cell.points;
  double best = HUGE_VAL;
  Vec3 bestEdge = {}, bestApex = {};
  int bestCorner = 0;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3 e = p[j] - p[i], d = p[k] - p[i];
    const double length = norm(e), area = norm(cross(e, d));
    if (length == 0 || area == 0)
    {
      return 0;
    }
    const Vec3 u = (1 / length) * e, n = (1 / area) * cross(e, d);
    const double foot = dot(u, d), height = area / length;
    // The rectangle is longer than the edge if the foot of the apex lies outside.
    const double low = std::min(0.0, foot), high = std::max(length, foot);
    const double width = high - low;
    const double q = std::max(width / height, height / width);
    if (q >= best)
    {
      continue;
    }
    best = q;
    bestCorner = i;
    // Derivatives with respect to the edge e and to the vector d to the apex.
    const Vec3 dFootE = (1 / length) * (d - foot * u), dFootD = u;
    Vec3 dWidthE = high == length ? u : dFootE, dWidthD = high == length ? Vec3{ 0, 0, 0 } : dFootD;
    if (low < 0)
    {
      dWidthE -= dFootE;
      dWidthD -= dFootD;
    }
    const Vec3 dHeightE = (1 / length) * cross(d, n) - (height / length) * u;
    const Vec3 dHeightD = (1 / length) * cross(n, e);
    const double s = width > height ? 1.0 : -1.0;
    bestEdge = (s * q / width) * dWidthE - (s * q / height) * dHeightE;
    bestApex = (s * q / width) * dWidthD - (s * q / height) * dHeightD;
  }
  if (g)
  {
    g[(bestCorner + 1) % 3] += bestEdge;
    g[(bestCorner + 2) % 3] += bestApex;
    g[bestCorner] -= bestEdge + bestApex;
  }
  return best;
}

//------------------------------------------------------------------------------
/// max((largest - e) / (180 - e), (e - smallest) / e) over the faces, e = 60 or 90 degrees.
double equiangleSkew(const Cell& cell, Gradient g)
{
  const CellTopology& t = cell.topology;
  const Vec3* p = cell.points;
  const int faces = t.dimension == 2 ? 1 : t.faces;
  double worst = -1, slope = 0;
  int worstNodes[3] = {};
  for (int f = 0; f < faces; ++f)
  {
    const int* nodes = t.dimension == 2 ? allNodes : t.faceNodes[f].data();
    const int count = t.dimension == 2 ? t.nodes : t.faceSizes[f];
    const double equal = count == 3 ? 60.0 : 90.0;
    for (int c = 0; c < count; ++c)
    {
      const int at = nodes[c], next = nodes[(c + 1) % count], last = nodes[(c + count - 1) % count];
      const double a =
        DegreesPerRadian * angleBetween(p[next] - p[at], p[last] - p[at], nullptr, nullptr);
      const double perDegree = a > equal ? 1 / (180.0 - equal) : -1 / equal;
      if (perDegree * (a - equal) > worst)
      {
        worst = perDegree * (a - equal);
        slope = perDegree;
        worstNodes[0] = at;
        worstNodes[1] = next;
        worstNodes[2] = last;
      }
    }
  }
  if (g)
  {
    Vec3 da, db;
    angleBetween(
      p[worstNodes[1]] - p[worstNodes[0]], p[worstNodes[2]] - p[worstNodes[0]], &da, &db);
    const double factor = slope * DegreesPerRadian;
    g[worstNodes[1]] += factor * da;
    g[worstNodes[2]] += factor * db;
    g[worstNodes[0]] -= factor * (da + db);
  }
  return worst;
}

//------------------------------------------------------------------------------
/// The smallest corner Jacobian of a quadrilateral, on a surface in the plane of its mean normal:
/// it is linear in between.
double smallestOfCorners(const Cell& cell, Gradient g)
{
  const CellTopology& t = cell.topology;
  const FaceNormal face(cell.points, allNodes, t.nodes);
  const double length = norm(face.normal);
  if (!cell.planar && length == 0)
  {
    return 0;
  }
  const Vec3 normal = cell.planar ? cell.normal : (1 / length) * face.normal;
  double least = HUGE_VAL;
  int worst = 0;
  const auto edge = [&](int corner, int k)
  { return cell.points[t.cornerNodes[corner][k]] - cell.points[t.cornerNodes[corner][0]]; };
  for (int c = 0; c < t.corners; ++c)
  {
    const double det = dot(cross(edge(c, 1), edge(c, 2)), normal);
    worst = det < least ? c : worst;
    least = std::min(least, det);
  }
  if (g)
  {
    const auto& nodes = t.cornerNodes[worst];
    const Vec3 a = edge(worst, 1), b = edge(worst, 2);
    const Vec3 da = cross(b, normal), db = cross(normal, a);
    g[nodes[1]] += da;
    g[nodes[2]] += db;
    g[nodes[0]] -= da + db;
    // On a surface, the normal itself depends on the points.
    if (!cell.planar)
    {
      face.addGradient((1 / length) * perpendicular(cross(a, b), normal), g);
    }
  }
  return least;
}

/// The smallest Jacobian determinant anywhere in the cell.
double smallestJacobian(const Cell& cell, Gradient g)
{
  const CellTopology& t = cell.topology;
  if (t.samples == 1)
  {
    // Constant: n! times the size.
    const double factor = t.dimension == 2 ? 2 : 6;
    Vec3 dSize[4] = {};
    const double value = factor * size(cell, g ? dSize : nullptr);
    for (int k = 0; g && k < t.nodes; ++k)
    {
      g[k] += factor * dSize[k];
    }
    return value;
  }
  if (t.dimension == 2)
  {
    return smallestOfCorners(cell, g);
  }
  const JacobianMinimum minimum = minimumJacobian(t, cell.points);
  if (g)
  {
    addJacobianGradient(t, cell.points, minimum.at, 1.0, g);
  }
  return minimum.value;
}

//------------------------------------------------------------------------------
/// Runs a scalar metric on each cell of a batch.
template <double (*Function)(const Cell&, Gradient), bool WithGradient>
void evaluateCells(const BatchContext& context, Batch& batch)
{
  const CellTopology& t = *context.topology;
  Cell cell = { t, nullptr, context.mesh->dimension() == Dimension::Planar,
    (context.mesh->mirrored() ? -1.0 : 1.0) * context.mesh->normal() };
  for (int l = 0; l < PacketWidth; ++l)
  {
    Vec3 points[MaxNodes], gradient[MaxNodes] = {};
    for (int k = 0; k < t.nodes; ++k)
    {
      points[k] = { batch.points[k][0][l], batch.points[k][1][l], batch.points[k][2][l] };
    }
    cell.points = points;
    batch.value[l] = Function(cell, WithGradient ? gradient : nullptr);
    for (int k = 0; WithGradient && k < t.nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        batch.gradient[k][c][l] = gradient[k][c];
      }
    }
  }
}

template <double (*Function)(const Cell&, Gradient)>
MetricCode codeOf()
{
  return { evaluateCells<Function, false>, evaluateCells<Function, true>,
    evaluateCells<Function, false>, evaluateCells<Function, true> };
}
}

MetricCode cellMetricCode(Metric metric)
{
  switch (metric)
  {
    case Metric::Size:
      return codeOf<size>();
    case Metric::AspectRatio:
      return codeOf<aspectRatio>();
    case Metric::WidthRatio:
      return codeOf<widthRatio>();
    case Metric::EquiangleSkew:
      return codeOf<equiangleSkew>();
    case Metric::MinimumJacobian:
      return codeOf<smallestJacobian>();
    default:
      return extremalMetricCode(metric);
  }
}
}
