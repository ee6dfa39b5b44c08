// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarMesher.h"

#include "SizeField.h"

#include "tautline/Core/Memory.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_criteria_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <sstream>
#include <unordered_map>

namespace tautline
{
namespace
{
/// Index of an input point; -1 for a point of the refinement.
struct Info
{
  Index id = -1;
};

using Traits = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Delaunay_mesh_vertex_base_2<Traits,
  CGAL::Triangulation_vertex_base_with_info_2<Info, Traits>>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Traits>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Traits, Structure,
  CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

/// The options, with the sizes at points as a function of position.
struct Bounds : PlanarOptions
{
  std::function<double(double, double)> sizeField;
};

/// Angle and size bounds according to CGAL's concept MeshingCriteria_2.
class Criteria
{
public:
  using Face_handle = Face;

  /// Triangles that are too large come first, in decreasing size; then the smallest angle.
  struct Quality
  {
    double sine = 1.0;   ///< squared, of the smallest angle
    double excess = 0.0; ///< squared ratio of longest edge and size
    bool operator<(const Quality& other) const
    {
      if (this->excess > 1.0 || other.excess > 1.0)
      {
        return this->excess > other.excess;
      }
      return this->sine < other.sine;
    }
  };

  class Is_bad
  {
  public:
    Is_bad(const Bounds& options, double smallest)
      : Options(options)
      , Smallest(smallest)
    {
      const double sine = std::sin(options.minimumAngle * Pi / 180.0);
      this->Bound = sine * sine;
    }
    CGAL::Mesh_2::Face_badness operator()(const Quality& q) const
    {
      return q.excess > 1.0    ? CGAL::Mesh_2::IMPERATIVELY_BAD
        : q.sine < this->Bound ? CGAL::Mesh_2::BAD
                               : CGAL::Mesh_2::NOT_BAD;
    }
    CGAL::Mesh_2::Face_badness operator()(const Face& face, Quality& q) const
    {
      const auto& a = face->vertex(0)->point();
      const auto& b = face->vertex(1)->point();
      const auto& c = face->vertex(2)->point();
      double lengths[] = { CGAL::squared_distance(b, c), CGAL::squared_distance(c, a),
        CGAL::squared_distance(a, b) };
      std::sort(lengths, lengths + 3);
      double size = this->Options.size;
      if (this->Options.sizeField)
      {
        const double local =
          this->Options.sizeField((a.x() + b.x() + c.x()) / 3.0, (a.y() + b.y() + c.y()) / 3.0);
        size = size > 0.0 ? std::min(size, local) : local;
      }
      q.excess = size > 0.0 ? lengths[2] / (size * size) : 0.0;
      const double area = 2.0 * CGAL::area(a, b, c);
      // Small angles near sharp corners of the input cannot be refined away: attempts would end in
      // edges shorter than the resolution of the coordinates.
      q.sine = lengths[0] > this->Smallest ? area * area / (lengths[1] * lengths[2]) : 1.0;
      return (*this)(q);
    }

  private:
    const Bounds& Options;
    double Smallest; ///< squared edge below which angles do not count
    double Bound;
  };

  Criteria(const Bounds& options, double smallest)
    : Options(&options)
    , Smallest(smallest)
  {
  }
  Is_bad is_bad_object() const { return Is_bad(*this->Options, this->Smallest); }

private:
  const Bounds* Options;
  double Smallest;
};

/// The exponent of the largest coordinate. Throws Error if a coordinate is not finite.
int exponentOf(const PlanarBoundary& boundary)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < boundary.points.size(); ++i)
  {
    if (!std::isfinite(boundary.points[i]))
    {
      throw Error(
        "point " + std::to_string(i / 2) + " has a coordinate that is not a finite number");
    }
    largest = std::max(largest, std::abs(boundary.points[i]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  return exponent;
}

/// Scales by 2^exponent, which is exact: except for overflow and underflow, all subsequent results
/// are the same.
void scale(std::vector<double>& values, int exponent)
{
  for (double& value : values)
  {
    value = std::ldexp(value, exponent);
  }
}

Bounds scaled(const PlanarBoundary& boundary, const PlanarOptions& options, int exponent)
{
  Bounds result = { options, {} };
  // Relative to the largest coordinate; shorter edges can hardly be distinguished from points.
  constexpr double Resolution = 1e-13;
  const auto size = [exponent](double value)
  {
    const double relative = std::ldexp(value, exponent);
    if (value > 0.0 && relative < Resolution)
    {
      std::ostringstream text;
      text << "a size is " << value << ", less than coordinates of up to "
           << std::ldexp(1.0, -exponent)
           << " resolve; choose larger sizes, or move the outlines to the origin";
      throw Error(text.str());
    }
    return relative;
  };
  result.size = size(options.size);
  if (!options.pointSizes.empty())
  {
    if (options.pointSizes.size() != boundary.points.size() / 2)
    {
      throw Error("there must be one size for each point");
    }
    const auto field = makeSizeField(boundary.points, options.pointSizes, options.gradation);
    result.sizeField = [=](double x, double y)
    { return size(field(std::ldexp(x, -exponent), std::ldexp(y, -exponent))); };
  }
  return result;
}

/// Throws Error if the segments alone need more points than allowed; refinement would detect this
/// only after a long time.
void checkSize(const PlanarBoundary& boundary, const PlanarOptions& options)
{
  double pieces = 0.0;
  for (std::size_t s = 0; options.size > 0.0 && s + 1 < boundary.segments.size(); s += 2)
  {
    const auto a = static_cast<std::size_t>(2 * boundary.segments[s]);
    const auto b = static_cast<std::size_t>(2 * boundary.segments[s + 1]);
    if (std::max(a, b) + 1 < boundary.points.size())
    {
      pieces += std::hypot(boundary.points[a] - boundary.points[b],
                  boundary.points[a + 1] - boundary.points[b + 1]) /
        options.size;
    }
  }
  if (pieces > static_cast<double>(options.pointLimit))
  {
    throw Error("edges of the given size would divide the outlines into more than " +
      std::to_string(options.pointLimit) + " parts; choose a larger size");
  }
}

/// The square of an edge length that is tiny compared to the region.
double tinyEdge(const PlanarBoundary& boundary)
{
  constexpr double Tiny = 1e-6;
  double low[] = { INFINITY, INFINITY }, high[] = { -INFINITY, -INFINITY };
  for (std::size_t i = 0; i < boundary.points.size(); ++i)
  {
    low[i % 2] = std::min(low[i % 2], boundary.points[i]);
    high[i % 2] = std::max(high[i % 2], boundary.points[i]);
  }
  const double extent = Tiny * std::max(high[0] - low[0], high[1] - low[1]);
  return extent * extent;
}

std::vector<Vertex> insertPoints(Triangulation& triangulation, const PlanarBoundary& boundary)
{
  std::vector<Vertex> vertices;
  Face hint;
  for (std::size_t i = 0; i < boundary.points.size() / 2; ++i)
  {
    const double x = boundary.points[2 * i], y = boundary.points[2 * i + 1];
    vertices.push_back(triangulation.insert({ x, y }, hint));
    hint = vertices.back()->face();
    if (vertices.back()->info().id < 0)
    {
      vertices.back()->info().id = static_cast<Index>(i);
    }
  }
  return vertices;
}

void insertSegments(
  Triangulation& triangulation, const PlanarBoundary& boundary, const std::vector<Vertex>& vertices)
{
  for (std::size_t s = 0; s < boundary.markers.size(); ++s)
  {
    const Index a = boundary.segments[2 * s], b = boundary.segments[2 * s + 1];
    try
    {
      const Vertex& va = vertices.at(static_cast<std::size_t>(a));
      const Vertex& vb = vertices.at(static_cast<std::size_t>(b));
      if (va != vb)
      {
        triangulation.insert_constraint(va, vb);
      }
    }
    catch (const std::out_of_range&)
    {
      throw Error("segment " + std::to_string(s) + " has a point that does not exist");
    }
    catch (const std::exception&)
    {
      throw Error("segment " + std::to_string(s) + " (points " + std::to_string(a) + " and " +
        std::to_string(b) + ") crosses another one; split both where they cross");
    }
  }
}

/// Sets the inside flag of all faces reached from a start without crossing a segment.
void fill(Triangulation& triangulation, Face start, bool inside,
  std::unordered_map<Face, int, CGAL::Handle_hash_function>& level, int value,
  std::deque<std::pair<Face, int>>* border)
{
  std::deque<Face> front = { start };
  level[start] = value;
  while (!front.empty())
  {
    const Face face = front.front();
    front.pop_front();
    face->set_in_domain(inside && !triangulation.is_infinite(face));
    for (int i = 0; i < 3; ++i)
    {
      const Face next = face->neighbor(i);
      if (level.count(next))
      {
        continue;
      }
      if (face->is_constrained(i))
      {
        if (border)
        {
          border->push_back({ next, value + 1 });
        }
        continue;
      }
      level[next] = value;
      front.push_back(next);
    }
  }
}

/// The inside is surrounded by an odd number of outlines, or consists of all parts not reached from
/// a hole's point.
void markDomain(Triangulation& triangulation, const PlanarBoundary& boundary, bool holesGiven)
{
  std::unordered_map<Face, int, CGAL::Handle_hash_function> level;
  std::deque<std::pair<Face, int>> border;
  fill(triangulation, triangulation.infinite_face(), false, level, 0, &border);
  while (!border.empty())
  {
    const auto [face, value] = border.front();
    border.pop_front();
    if (!level.count(face))
    {
      fill(triangulation, face, holesGiven || value % 2 == 1, level, value, &border);
    }
  }
  for (std::size_t i = 0; holesGiven && i + 1 < boundary.holes.size(); i += 2)
  {
    level.clear();
    const Face face = triangulation.locate({ boundary.holes[i], boundary.holes[i + 1] });
    if (face == Face() || triangulation.is_infinite(face))
    {
      throw Error("the point of hole " + std::to_string(i / 2) + " is outside the outlines");
    }
    fill(triangulation, face, false, level, 0, nullptr);
  }
}

void refine(Triangulation& triangulation, const Bounds& options, double smallest)
{
  CGAL::Delaunay_mesher_2<Triangulation, Criteria> mesher(
    triangulation, Criteria(options, smallest));
  mesher.init(true);
  constexpr int Steps = 1000;
  // Reserves memory for a quarter more points whenever the number has grown by a quarter.
  constexpr double BytesPerPoint = 600, Growth = 1.25;
  double checked = 1e5;
  while (!mesher.is_refinement_done())
  {
    for (int step = 0; step < Steps && mesher.try_one_step_refine_mesh(); ++step)
    {
    }
    const auto points = static_cast<Index>(triangulation.number_of_vertices());
    if (points > options.pointLimit)
    {
      throw Error("the triangulation has more than " + std::to_string(options.pointLimit) +
        " points; choose larger triangles or a smaller angle");
    }
    if (static_cast<double>(points) > checked)
    {
      requireMemory((Growth - 1) * checked * BytesPerPoint,
        "a triangulation of more than " + std::to_string(points) + " points",
        "choose larger triangles or a smaller angle");
      checked *= Growth;
    }
    if (options.progress && !options.progress(points))
    {
      throw Error("stopped");
    }
  }
}

/// The parts of every segment: chains of constrained edges between two input points.
void collectEdges(const Triangulation& triangulation, const PlanarBoundary& boundary,
  const std::vector<Vertex>& vertices, PlanarMesh& mesh)
{
  // the smaller marker if two segments coincide
  std::map<std::pair<Index, Index>, int> markers;
  for (std::size_t s = 0; s < boundary.markers.size(); ++s)
  {
    const auto ids =
      std::minmax(vertices[static_cast<std::size_t>(boundary.segments[2 * s])]->info().id,
        vertices[static_cast<std::size_t>(boundary.segments[2 * s + 1])]->info().id);
    const auto [entry, added] = markers.insert({ ids, boundary.markers[s] });
    entry->second = added ? entry->second : std::min(entry->second, boundary.markers[s]);
  }
  const auto inputs = static_cast<Index>(boundary.points.size() / 2);
  std::map<Index, std::vector<Index>> neighbors; // along segments, by point
  for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end();
       ++edge)
  {
    if (triangulation.is_constrained(*edge))
    {
      const Index a = edge->first->vertex(Triangulation::cw(edge->second))->info().id;
      const Index b = edge->first->vertex(Triangulation::ccw(edge->second))->info().id;
      neighbors[a].push_back(b);
      neighbors[b].push_back(a);
    }
  }
  for (const auto& [start, nexts] : neighbors)
  {
    for (const Index first : nexts)
    {
      if (start >= inputs)
      {
        continue;
      }
      std::vector<Index> chain = { start, first };
      while (chain.back() >= inputs && neighbors[chain.back()].size() == 2)
      {
        const std::vector<Index>& two = neighbors[chain.back()];
        chain.push_back(two[0] == chain[chain.size() - 2] ? two[1] : two[0]);
      }
      const auto marker = markers.find(std::minmax(chain.front(), chain.back()));
      for (std::size_t i = 1; chain.front() < chain.back() && i < chain.size(); ++i)
      {
        mesh.edges.insert(mesh.edges.end(), { chain[i - 1], chain[i] });
        mesh.edgeMarkers.push_back(marker == markers.end() ? 0 : marker->second);
      }
    }
  }
}
}

//------------------------------------------------------------------------------
PlanarMesh meshPlane(const PlanarBoundary& given, const PlanarOptions& required)
{
  // Squares and cubes of coordinates are computed, which must neither overflow nor vanish.
  const int exponent = exponentOf(given);
  PlanarBoundary boundary = given;
  scale(boundary.points, -exponent);
  scale(boundary.holes, -exponent);
  const Bounds options = scaled(given, required, -exponent);
  if (!(options.minimumAngle >= 0.0 && options.minimumAngle <= 35.0) || !(options.size >= 0.0))
  {
    throw Error("the smallest angle must be from 0 to 35 degrees and the size not negative");
  }
  checkSize(boundary, options);
  Triangulation triangulation;
  const std::vector<Vertex> vertices = insertPoints(triangulation, boundary);
  insertSegments(triangulation, boundary, vertices);
  if (triangulation.dimension() < 2)
  {
    throw Error("the segments do not surround anything");
  }
  markDomain(triangulation, boundary, options.holesGiven);
  refine(triangulation, options, tinyEdge(boundary));

  PlanarMesh mesh;
  mesh.points = boundary.points;
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end();
       ++v)
  {
    if (v->info().id < 0)
    {
      v->info().id = static_cast<Index>(mesh.points.size() / 2);
      mesh.points.insert(mesh.points.end(), { v->point().x(), v->point().y() });
    }
  }
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end();
       ++face)
  {
    for (int i = 0; i < 3 && face->is_in_domain(); ++i)
    {
      mesh.triangles.push_back(face->vertex(i)->info().id);
    }
  }
  if (mesh.triangles.empty())
  {
    throw Error("the segments do not surround anything: is an outline closed?");
  }
  scale(mesh.points, exponent);
  std::copy(given.points.begin(), given.points.end(), mesh.points.begin());
  collectEdges(triangulation, boundary, vertices, mesh);
  mesh.pointMarkers.assign(mesh.points.size() / 2, 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
  {
    int& marker = mesh.pointMarkers[static_cast<std::size_t>(mesh.edges[e])];
    const int value = mesh.edgeMarkers[e / 2];
    marker = marker == 0 || (value != 0 && value < marker) ? value : marker;
  }
  return mesh;
}
}
