// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedBoundary.h"

#include "tautline/Core/Interruption.h"

#include <cmath>

namespace tautline
{
namespace
{
/// The Bezier points of a straight edge.
CubicCurve straight(const Vec3& a, const Vec3& b)
{
  return { a, (2.0 / 3.0) * a + (1.0 / 3.0) * b, (1.0 / 3.0) * a + (2.0 / 3.0) * b, b };
}

/// Walks through the pieces of each part of a model in their order.
class PieceReader
{
public:
  explicit PieceReader(const SurfaceModel& model)
    : Model(model)
    , Next(model.parts.size(), 0)
  {
  }

  /// The control points of the next piece of a part; null if it is flat. The model omits pieces
  /// with coordinates whose squares overflow.
  const CubicControls* next(int part, const Vec3& a, const Vec3& b, const Vec3& c)
  {
    if (!std::isfinite(dot(a, a) + dot(b, b) + dot(c, c)))
    {
      return nullptr;
    }
    const SurfacePart& of = this->Model.parts[part];
    const std::int32_t controls = of.controlsOf[this->Next[part]++];
    return controls < 0 ? nullptr : &of.controls[controls];
  }

private:
  const SurfaceModel& Model;
  std::vector<std::size_t> Next;
};

/// Edge k of a piece from a to b.
CubicCurve edgeOf(const CubicControls* controls, int k, const Vec3& a, const Vec3& b)
{
  return controls ? CubicCurve{ a, (*controls)[2 * k], (*controls)[2 * k + 1], b } : straight(a, b);
}

CurvedFace faceOf(const MeshView& view, const Features::Facet& facet, PieceReader& pieces)
{
  CurvedFace face = { facet.nodes, facet.size, facet.patch, {}, { 0, 0, 0 } };
  const auto at = [&](int k) { return pointOf(view, facet.nodes[k % facet.size]); };
  const CubicControls* first = pieces.next(facet.patch, at(0), at(1), at(2));
  if (facet.size == 3)
  {
    for (int k = 0; k < 3; ++k)
    {
      face.edges[k] = edgeOf(first, k, at(k), at(k + 1));
    }
    face.center = first ? first->back() : (1.0 / 3.0) * (at(0) + at(1) + at(2));
    return face;
  }
  // Two triangles, 0 1 2 and 0 2 3.
  const CubicControls* second = pieces.next(facet.patch, at(0), at(2), at(3));
  face.edges = { edgeOf(first, 0, at(0), at(1)), edgeOf(first, 1, at(1), at(2)),
    edgeOf(second, 1, at(2), at(3)), edgeOf(second, 2, at(3), at(0)) };
  return face;
}
}

//------------------------------------------------------------------------------
CurvedBoundary curvedBoundary(const Mesh& mesh, const Features& features)
{
  const MeshView& view = mesh.view();
  const SurfaceModel model = makeSurfaceModel(mesh, features, true, true);
  PieceReader pieces(model);
  CurvedBoundary boundary;
  for (const Features::Edge& e : features.edges)
  {
    const int part = features.patches + e.curve;
    const Vec3 a = pointOf(view, e.first), b = pointOf(view, e.second);
    boundary.edges.push_back(
      { e.first, e.second, part, edgeOf(pieces.next(part, a, b, b), 0, a, b) });
  }
  for (std::size_t f = 0; f < features.facets.size(); ++f)
  {
    pollInterruption(static_cast<Index>(f));
    const CurvedFace face = faceOf(view, features.facets[f], pieces);
    for (int k = 0; k < face.size; ++k)
    {
      boundary.edges.push_back(
        { face.nodes[k], face.nodes[(k + 1) % face.size], face.patch, face.edges[k] });
    }
    boundary.faces.push_back(face);
  }
  return boundary;
}

//------------------------------------------------------------------------------
Vec3 pointOn(const CubicCurve& c, double t)
{
  const double s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

//------------------------------------------------------------------------------
Vec3 pointOn(const CurvedFace& face, const std::array<double, MaxFaceNodes>& shares)
{
  Vec3 point = { 0, 0, 0 };
  if (face.size == 3)
  {
    // Bernstein polynomials of degree 3 on a triangle: each edge has its first three control
    // points, as the last one belongs to the next edge.
    for (int k = 0; k < 3; ++k)
    {
      const double a = shares[k], b = shares[(k + 1) % 3];
      point += a * a * a * face.edges[k][0] + 3 * a * a * b * face.edges[k][1] +
        3 * a * b * b * face.edges[k][2];
    }
    return point + 6 * shares[0] * shares[1] * shares[2] * face.center;
  }
  // A Coons patch: both blends of opposite edges minus the bilinear interpolation of the corners.
  const double u = shares[1] + shares[2], v = shares[2] + shares[3];
  point = (1 - v) * pointOn(face.edges[0], u) + v * pointOn(face.edges[2], 1 - u) +
    (1 - u) * pointOn(face.edges[3], 1 - v) + u * pointOn(face.edges[1], v);
  for (int k = 0; k < 4; ++k)
  {
    point -= shares[k] * face.edges[k][0];
  }
  return point;
}
}
