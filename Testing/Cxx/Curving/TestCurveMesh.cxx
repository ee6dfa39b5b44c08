// SPDX-License-Identifier: BSD-3-Clause
// Curved cells share their nodes, have the boundary on the true surface, keep the shape of cells
// that are curved, and are certified.
#include "Registry.h"
#include "Surfaces.h"
#include "tautline/Curving/CurveMesh.h"
#include "tautline/Elements/ElementType.h"

using namespace tautline;

namespace
{
CurvingResult curve(const MeshData& data, int order,
  const std::function<void(CurvingOptions&)>& set = {}, const CurvedCellFacts& facts = {})
{
  const Mesh mesh(data.view());
  TAUTLINE_LET(CurvingOptions, options, order = order);
  if (set)
  {
    set(options);
  }
  return curveMesh(mesh, data.view(), facts, options);
}

MeshData dataOf(const CurvingResult& curved)
{
  TAUTLINE_LET(MeshData, data, points = curved.points, types = curved.types,
    offsets = curved.offsets, connectivity = curved.connectivity);
  return data;
}

Index invalid(const CurvingResult& curved)
{
  return std::count_if(curved.validity.begin(), curved.validity.end(), isInvalid);
}

/// The points of a mesh that no other point is at.
std::size_t places(const MeshData& data)
{
  std::set<std::array<long, 3>> found;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 x = data.point(p);
    constexpr double grid = 1e7;
    found.insert({ std::lround(grid * x[0]), std::lround(grid * x[1]), std::lround(grid * x[2]) });
  }
  return found.size();
}

/// A point of a cell of a mesh.
Vec3 pointIn(const MeshData& data, Index cell, const Vec3& at)
{
  const std::vector<Index> nodes = data.nodes(cell);
  const std::vector<double> n =
    ElementType::ofVtk(data.types[cell], static_cast<int>(nodes.size())).shapeFunctions(at);
  Vec3 x = { 0, 0, 0 };
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    x += n[k] * data.point(nodes[k]);
  }
  return x;
}

/// A quarter of a pipe of the radii 1 and 2 round the axis z, from 0 to 2.
MeshData pipe(CellType type, Index n)
{
  MeshData data = blockMesh(type, n, n, n);
  data.transform(
    [n](const Vec3& p)
    {
      const double r = 1 + p[0] / double(n), a = Pi / 2 * p[1] / double(n);
      return Vec3{ r * std::cos(a), r * std::sin(a), 2 * p[2] / double(n) };
    });
  return data;
}

double radius(const Vec3& x)
{
  return std::hypot(x[0], x[1]);
}

/// The distance of a point near the surface of the pipe from it.
double distanceOfPipe(const Vec3& x)
{
  const double r = radius(x);
  return std::min({ std::abs(r - 1), std::abs(r - 2), std::abs(x[0]), std::abs(x[1]),
    std::abs(x[2]), std::abs(x[2] - 2) });
}

/// A torus of radii 3 and 1, in m x n quadrilaterals, or twice as many triangles.
MeshData torus(CellType type, Index m, Index n)
{
  MeshData data;
  for (Index i = 0; i < m; ++i)
  {
    for (Index j = 0; j < n; ++j)
    {
      const double a = 2 * Pi * double(i) / double(m), b = 2 * Pi * double(j) / double(n);
      const double r = 3 + std::cos(b);
      data.addPoint({ r * std::cos(a), r * std::sin(a), std::sin(b) });
    }
  }
  for (Index i = 0; i < m; ++i)
  {
    for (Index j = 0; j < n; ++j)
    {
      const Index a = i * n + j, b = (i + 1) % m * n + j, c = (i + 1) % m * n + (j + 1) % n,
                  d = i * n + (j + 1) % n;
      if (type == CellType::Quadrilateral)
      {
        data.addCell(type, { a, b, c, d });
        continue;
      }
      data.addCell(type, { a, b, c });
      data.addCell(type, { a, c, d });
    }
  }
  return data;
}

/// The mean and the largest distance from a surface, of the new nodes of the boundary, in the mean
/// length of edges.
struct Errors
{
  double mean = 0, largest = 0;
  Index nodes = 0;
};

template <class Distance>
Errors errorsOf(const CurvingResult& curved, double edge, const Distance& distance)
{
  Errors errors;
  const MeshData data = dataOf(curved);
  for (auto p = static_cast<Index>(curved.kept.size()); p < data.numberOfPoints(); ++p)
  {
    if (curved.onBoundary[p])
    {
      const double error = std::abs(distance(data.point(p))) / edge;
      errors.mean += error;
      errors.largest = std::max(errors.largest, error);
      ++errors.nodes;
    }
  }
  errors.mean /= std::max<double>(1, double(errors.nodes));
  return errors;
}

double edgeOf(const MeshData& data)
{
  const std::vector<Index> nodes = data.nodes(0);
  return norm(data.point(nodes[1]) - data.point(nodes[0]));
}
}

TAUTLINE_PART(testShared)
{
  for (CellType type : allTypes)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = shuffled(blockMesh(type, 2, 3, flat ? 0 : 2), 3);
    for (int order = 1; order <= (type == CellType::Pyramid ? 2 : 4); ++order)
    {
      for (bool serendipity : { false, true })
      {
        const Context context(std::string(topology(type).name) + " of order " +
          std::to_string(order) + (serendipity ? ", serendipity" : ""));
        const CurvingResult curved =
          curve(data, order, [&](CurvingOptions& o) { o.serendipity = serendipity; });
        const MeshData result = dataOf(curved);
        TAUTLINE_CHECK_EQUAL(places(result), static_cast<std::size_t>(result.numberOfPoints()));
        TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
        // A box has flat sides: nothing leaves them.
        TAUTLINE_CHECK(curved.largestOffset < 1e-14);
        TAUTLINE_CHECK_EQUAL(curved.kept.size(), static_cast<std::size_t>(data.numberOfPoints()));
        const bool lattice = !serendipity &&
          (type == CellType::Hexahedron || type == CellType::Quadrilateral ||
            type == CellType::Triangle || type == CellType::Wedge);
        if (lattice)
        {
          const Index expected = (2 * order + 1) * (3 * order + 1) * (flat ? 1 : 2 * order + 1);
          TAUTLINE_CHECK_EQUAL(result.numberOfPoints(), expected);
        }
        // Weights reproduce the coordinates.
        for (std::size_t n = 0; n + 1 < curved.starts.size(); ++n)
        {
          Vec3 x = { 0, 0, 0 };
          for (Index i = curved.starts[n]; i < curved.starts[n + 1]; ++i)
          {
            x += curved.weights[i] * data.point(curved.sources[i]);
          }
          const Vec3 own = result.point(static_cast<Index>(curved.kept.size() + n));
          TAUTLINE_CHECK(norm(x - own) < 1e-13);
        }
      }
    }
  }
}

TAUTLINE_PART(testSphere)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const MeshData data = sphereSurface(type, 6);
    for (int order : { 2, 3, 4 })
    {
      const CurvingResult curved = curve(data, order);
      const Errors errors =
        errorsOf(curved, edgeOf(data), [](const Vec3& x) { return norm(x) - 1; });
      std::cout << "sphere, " << topology(type).plural << " of order " << order << ": mean "
                << errors.mean << ", largest " << errors.largest << "\n";
      TAUTLINE_CHECK(errors.mean < 1e-3 && errors.largest < 0.01);
      TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
      TAUTLINE_CHECK_EQUAL(curved.curves, Index(0));
    }
  }
}

TAUTLINE_PART(testTorus)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const MeshData data = torus(type, 30, 12);
    for (int order : { 2, 3, 4 })
    {
      const CurvingResult curved = curve(data, order);
      const Errors errors = errorsOf(curved, edgeOf(data),
        [](const Vec3& x) { return std::hypot(std::hypot(x[0], x[1]) - 3, x[2]) - 1; });
      std::cout << "torus, " << topology(type).plural << " of order " << order << ": mean "
                << errors.mean << ", largest " << errors.largest << "\n";
      TAUTLINE_CHECK(errors.mean < 5e-3 && errors.largest < 0.02);
      TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
    }
  }
}

/// How far the nodes of the arcs of the pipe are from these: those between two points of an arc.
double errorOfArcs(const MeshData& data, const CurvingResult& curved)
{
  double error = 0;
  const auto onArc = [](const Vec3& x, double r)
  { return std::abs(radius(x) - r) < 1e-9 && (x[2] == 0 || x[2] == 2); };
  for (std::size_t n = 0; n + 1 < curved.starts.size(); ++n)
  {
    for (double r : { 1.0, 2.0 })
    {
      bool all = curved.starts[n + 1] - curved.starts[n] == 2;
      for (Index i = curved.starts[n]; i < curved.starts[n + 1]; ++i)
      {
        all = all && onArc(data.point(curved.sources[i]), r);
      }
      const Vec3 x = dataOf(curved).point(static_cast<Index>(curved.kept.size() + n));
      error = all ? std::max(error, std::abs(radius(x) - r)) : error;
    }
  }
  return error;
}

TAUTLINE_PART(testPipe)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge })
  {
    const MeshData data = pipe(type, 4);
    for (int order : { 2, 3, 4 })
    {
      const Context context(
        std::string(topology(type).plural) + " of order " + std::to_string(order));
      const CurvingResult curved = curve(data, order);
      const Errors errors = errorsOf(curved, 0.5, distanceOfPipe);
      const double arcs = errorOfArcs(data, curved);
      std::cout << "pipe, " << topology(type).plural << " of order " << order << ": mean "
                << errors.mean << ", largest " << errors.largest << ", arcs " << arcs << "\n";
      TAUTLINE_CHECK(errors.mean < 2e-3 && errors.largest < 0.01 && arcs < 1e-4);
      TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
      TAUTLINE_CHECK_EQUAL(curved.corners, Index(8));
      TAUTLINE_CHECK_EQUAL(curved.curves, Index(12));
      TAUTLINE_CHECK_EQUAL(curved.patches, Index(6));
      const MeshData result = dataOf(curved);
      TAUTLINE_CHECK_EQUAL(places(result), static_cast<std::size_t>(result.numberOfPoints()));
      const CurvingResult straight =
        curve(data, order, [](CurvingOptions& o) { o.smooth = false; });
      TAUTLINE_CHECK(errorOfArcs(data, straight) > 0.03);
    }
  }
}

// The nodes inside do not depend on which of the cells beside them is first, also of two types:
// they follow the boundary in the same way on both sides of a face.
TAUTLINE_PART(testInside)
{
  const auto placesOf = [](const MeshData& data)
  {
    std::set<std::array<long, 3>> found;
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      const Vec3 x = data.point(p);
      constexpr double grid = 1e6;
      found.insert({ std::lround(grid * x[0] + 0.25), std::lround(grid * x[1] + 0.25),
        std::lround(grid * x[2] + 0.25) });
    }
    return found;
  };
  const MeshData hexahedra = pipe(CellType::Hexahedron, 3);
  TAUTLINE_LET(MeshData, mixed, points = hexahedra.points);
  for (Index cell = 0; cell < hexahedra.numberOfCells(); ++cell)
  {
    const std::vector<Index> p = hexahedra.nodes(cell);
    if (cell % 3 % 2 == cell / 3 % 3 % 2)
    {
      mixed.addCell(CellType::Hexahedron, p);
      continue;
    }
    mixed.addCell(CellType::Wedge, { p[0], p[2], p[1], p[4], p[6], p[5] });
    mixed.addCell(CellType::Wedge, { p[0], p[3], p[2], p[4], p[7], p[6] });
  }
  for (const MeshData& data : { mixed, pipe(CellType::Tetrahedron, 3), pipe(CellType::Wedge, 3) })
  {
    TAUTLINE_LET(MeshData, backwards, points = data.points);
    for (Index cell = data.numberOfCells() - 1; cell >= 0; --cell)
    {
      backwards.addCell(data.types[cell], data.nodes(cell));
    }
    for (int order : { 2, 3, 4 })
    {
      const CurvingResult one = curve(data, order), other = curve(backwards, order);
      TAUTLINE_CHECK(placesOf(dataOf(one)) == placesOf(dataOf(other)));
      TAUTLINE_CHECK_EQUAL(invalid(one), Index(0));
    }
  }
  const CurvingResult curved = curve(hexahedra, 2);
  for (Index cell = 0; cell < hexahedra.numberOfCells(); ++cell)
  {
    // Straight, and half of the offset of the side that is on the boundary.
    constexpr int last = 26;
    const double flat = std::cos(Pi / 12), layer = double(cell % 3);
    const double side = layer == 0 ? 1 : layer == 1 ? 0 : 2;
    const double expected = flat * (1 + (layer + 0.5) / 3) + 0.5 * (1 - flat) * side;
    const Vec3 middle = dataOf(curved).point(curved.connectivity[curved.offsets[cell] + last]);
    TAUTLINE_CHECK_NEAR(radius(middle), expected, 0.01);
  }
}

// A circle of few edges is round, a chamfer and a hexagonal prism of two cells around are not.
TAUTLINE_PART(testCoarse)
{
  const auto prism = [](Index around, double limit)
  {
    MeshData data;
    for (double z : { 0.0, 1.0 })
    {
      for (Index i = 0; i < around; ++i)
      {
        const double a = 2 * Pi * double(i) / double(around);
        data.addPoint({ std::cos(a), std::sin(a), z });
      }
    }
    for (Index i = 0; i < around; ++i)
    {
      const Index j = (i + 1) % around;
      data.addCell(CellType::Quadrilateral, { i, j, j + around, i + around });
    }
    return curve(data, 2, [&](CurvingOptions& o) { o.featureAngle = limit; });
  };
  for (Index around : { 6, 7, 8, 12 })
  {
    const CurvingResult curved = prism(around, 40);
    TAUTLINE_CHECK_EQUAL(curved.corners, Index(0));
    TAUTLINE_CHECK_EQUAL(curved.patches, Index(1));
    TAUTLINE_CHECK(errorsOf(curved, 1, [](const Vec3& x) { return radius(x) - 1; }).largest < 1e-6);
    TAUTLINE_CHECK_EQUAL(prism(around, 19).patches, around == 12 ? Index(12) : around);
  }
  TAUTLINE_CHECK_EQUAL(prism(5, 40).patches, Index(5));
  // A strip with one bend of 45 degrees at each side of its chamfer.
  MeshData strip;
  for (double y : { 0.0, 1.0 })
  {
    strip.addPoints(
      { { 0, y, 0 }, { 1, y, 0 }, { 2, y, 0 }, { 2.5, y, 0.5 }, { 2.5, y, 1.5 }, { 2.5, y, 2.5 } });
  }
  for (Index i = 0; i < 5; ++i)
  {
    strip.addCell(CellType::Quadrilateral, { i, i + 1, i + 7, i + 6 });
  }
  const CurvingResult chamfer = curve(strip, 2);
  TAUTLINE_CHECK_EQUAL(chamfer.patches, Index(3));
  TAUTLINE_CHECK(chamfer.largestOffset < 1e-12);
}

// Where a flat face meets a fillet it stays flat.
TAUTLINE_PART(testFlatFace)
{
  MeshData data = blockMesh(CellType::Quadrilateral, 8, 3, 0);
  data.transform(
    [](const Vec3& p)
    {
      const double a = Pi / 12 * (p[0] - 5);
      return p[0] <= 5 ? Vec3{ p[0], p[1], 0 }
                       : Vec3{ 5 + 2 * std::sin(a), p[1], 2 - 2 * std::cos(a) };
    });
  const CurvingResult curved = curve(data, 3);
  TAUTLINE_CHECK_EQUAL(curved.patches, Index(1));
  double off = 0;
  const MeshData result = dataOf(curved);
  for (Index p = 0; p < result.numberOfPoints(); ++p)
  {
    const Vec3 x = result.point(p);
    const bool inside = x[1] > 1 - 1e-9 && x[1] < 2 + 1e-9; // beside the borders, which are curves
    off = x[0] < 4.999 && inside ? std::max(off, std::abs(x[2])) : off;
  }
  std::cout << "flat face: " << off << "\n";
  TAUTLINE_CHECK(off < 1e-12);
}

TAUTLINE_PART(testKeptShape)
{
  Random random(5);
  for (CellType type : allTypes)
  {
    const bool flat = topology(type).dimension == 2;
    MeshData linear = blockMesh(type, 2, 2, flat ? 0 : 2);
    for (bool serendipity : { false, true })
    {
      for (int from : { 2, 3 })
      {
        if (from == 3 && type == CellType::Pyramid)
        {
          continue;
        }
        MeshData data =
          dataOf(curve(linear, from, [&](CurvingOptions& o) { o.serendipity = serendipity; }));
        data.transform(
          [](const Vec3& p) {
            return Vec3{ p[0] + 0.1 * std::sin(2 * p[1]), p[1] + 0.05 * std::cos(3 * p[0]), p[2] };
          });
        for (int to = from; to <= (type == CellType::Pyramid ? 2 : 4); ++to)
        {
          const Context context(std::string(topology(type).name) + " of order " +
            std::to_string(from) + " to " + std::to_string(to) + (serendipity ? ", s" : ""));
          const CurvingResult curved = curve(data, to);
          const MeshData result = dataOf(curved);
          TAUTLINE_CHECK_EQUAL(curved.curvedBefore, data.numberOfCells());
          double error = 0;
          for (Index cell = 0; cell < data.numberOfCells(); ++cell)
          {
            const Vec3 r = random.vector(0, 0.3);
            const Vec3 at = { r[0], r[1], flat ? 0 : r[2] };
            // The triangles of Lagrange wedges are listed from the other side.
            const bool turned = type == CellType::Wedge && from == 2 && to > 2;
            error = std::max(error,
              norm(pointIn(data, cell, at) -
                pointIn(result, cell, turned ? Vec3{ at[1], at[0], at[2] } : at)));
          }
          TAUTLINE_CHECK(error < 1e-13);
        }
        // Back: the corners, in their order.
        const CurvingResult back = curve(data, 1);
        TAUTLINE_CHECK_EQUAL(back.points.size(), linear.points.size());
        TAUTLINE_CHECK(back.types == linear.types);
        TAUTLINE_CHECK(back.connectivity == linear.connectivity);
        for (Index p = 0; p < linear.numberOfPoints(); ++p)
        {
          TAUTLINE_CHECK(dataOf(back).point(p) == data.point(p));
        }
        // Straight: where the corners have the nodes.
        const CurvingResult straight = curve(data, from,
          [&](CurvingOptions& o)
          {
            o.smooth = false;
            o.serendipity = serendipity;
          });
        const MeshData corners = dataOf(back);
        const MeshData again = dataOf(curve(corners, from,
          [&](CurvingOptions& o)
          {
            o.smooth = false;
            o.serendipity = serendipity;
          }));
        TAUTLINE_CHECK(straight.connectivity == again.connectivity);
        TAUTLINE_CHECK(straight.points == again.points);
      }
    }
  }
}

TAUTLINE_PART(testGeometry)
{
  const MeshData fine = pipe(CellType::Hexahedron, 24);
  const Mesh fineMesh(fine.view());
  const Features features = findFeatures(fineMesh, {});
  MeshData surface;
  surface.points = fine.points;
  for (const Features::Facet& facet : features.facets)
  {
    surface.addCell(CellType::Quadrilateral,
      std::vector<Index>(facet.nodes.begin(), facet.nodes.begin() + facet.size));
  }
  const Mesh geometry(surface.view());
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge })
  {
    const MeshData data = pipe(type, 4);
    for (int order : { 2, 4 })
    {
      const CurvingResult curved =
        curve(data, order, [&](CurvingOptions& o) { o.geometry = &geometry; });
      std::cout << "on a geometry, " << topology(type).plural << " of order " << order
                << ": distance " << curved.distanceBefore << " before, " << curved.distanceAfter
                << " after\n";
      TAUTLINE_CHECK(curved.distanceBefore > 0.03);
      TAUTLINE_CHECK(curved.distanceAfter < 0.05 * curved.distanceBefore);
      TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
    }
  }
}

TAUTLINE_PART(testOutline)
{
  // A square of which one side is a parabola, inside an outline of lines.
  MeshData data = blockMesh(CellType::Triangle, 4, 4, 0), lines;
  const auto bend = TAUTLINE_PLACE(p[0], p[1] + 0.03 * p[1] * p[0] * (4 - p[0]), 0);
  data.transform(bend);
  constexpr Index steps = 40;
  for (const auto& [from, to] :
    { std::pair(Vec3{ 0, 0, 0 }, Vec3{ 4, 0, 0 }), { Vec3{ 4, 0, 0 }, Vec3{ 4, 4, 0 } },
      { Vec3{ 4, 4, 0 }, Vec3{ 0, 4, 0 } }, { Vec3{ 0, 4, 0 }, Vec3{ 0, 0, 0 } } })
  {
    for (Index i = 0; i < steps; ++i)
    {
      const double t = double(i) / steps;
      lines.addPoint(bend((1 - t) * from + t * to));
    }
  }
  constexpr int line = 3;
  for (Index p = 0; p < 4 * steps; ++p)
  {
    lines.addCell(line, { p, (p + 1) % (4 * steps) });
  }
  const Mesh outline(lines.view());
  const CurvingResult curved = curve(data, 2, [&](CurvingOptions& o) { o.geometry = &outline; });
  TAUTLINE_CHECK_EQUAL(curved.corners, Index(4));
  TAUTLINE_CHECK_EQUAL(curved.curves, Index(4));
  TAUTLINE_CHECK(curved.distanceBefore > 0.02);
  TAUTLINE_CHECK(curved.distanceAfter < 0.1 * curved.distanceBefore);
  TAUTLINE_CHECK_EQUAL(invalid(curved), Index(0));
  for (Index p = 0; p < dataOf(curved).numberOfPoints(); ++p)
  {
    TAUTLINE_CHECK_EQUAL(dataOf(curved).point(p)[2], 0.0);
  }
  // Without it, the cubic curve through the points is nearly the parabola.
  const CurvingResult smooth = curve(data, 2);
  const Errors errors = errorsOf(smooth, 1,
    [](const Vec3& x)
    {
      const double top = 4 + 0.12 * x[0] * (4 - x[0]);
      return std::min({ std::abs(x[0]), std::abs(4 - x[0]), std::abs(x[1]), std::abs(top - x[1]) });
    });
  std::cout << "outline: mean " << errors.mean << ", largest " << errors.largest << "\n";
  TAUTLINE_CHECK(errors.mean < 0.01);
}

TAUTLINE_PART(testBeside)
{
  // Triangles and lines on the boundary of tetrahedra get the nodes of these.
  MeshData data = pipe(CellType::Tetrahedron, 3);
  const Index solids = data.numberOfCells();
  const Mesh mesh(data.view());
  const Features features = findFeatures(mesh, {});
  constexpr int line = 3, vertex = 1;
  for (const Features::Facet& facet : features.facets)
  {
    data.addCell(CellType::Triangle,
      std::vector<Index>(facet.nodes.begin(), facet.nodes.begin() + facet.size));
  }
  for (const Features::Edge& edge : features.edges)
  {
    data.addCell(line, { edge.first, edge.second });
  }
  data.addCell(vertex, { 0 });
  MeshData alone = data;
  alone.types.resize(solids);
  alone.offsets.resize(solids + 1);
  alone.connectivity.resize(alone.offsets.back());
  for (int order : { 2, 3, 4 })
  {
    const CurvingResult curved = curve(data, order);
    TAUTLINE_CHECK_EQUAL(curved.points.size(), curve(alone, order).points.size());
    TAUTLINE_CHECK(curved.points == curve(alone, order).points);
    const MeshData result = dataOf(curved);
    TAUTLINE_CHECK_EQUAL(int(result.types.back()), vertex);
    TAUTLINE_CHECK_EQUAL(int(result.types[data.numberOfCells() - 2]), order == 2 ? 21 : 68);
    // Linear again: the same cells.
    TAUTLINE_CHECK(curve(result, 1).connectivity == data.connectivity);
  }
}

TAUTLINE_PART(testReversed)
{
  // Cells in the opposite order are certified as the others, and listed as they were.
  MeshData data = pipe(CellType::Hexahedron, 2);
  const CurvingResult plain = curve(data, 2);
  const MeshData oriented = data;
  std::vector<unsigned char> reversed(data.numberOfCells(), 0);
  for (Index cell : { 1, 4 })
  {
    reversed[cell] = 1;
    Index* nodes = &data.connectivity[data.offsets[cell]];
    std::swap(nodes[1], nodes[3]);
    std::swap(nodes[5], nodes[7]);
  }
  CurvedCellFacts facts;
  facts.reversed = reversed.data();
  TAUTLINE_LET(CurvingOptions, options, order = 2);
  const CurvingResult curved = curveMesh(Mesh(oriented.view()), data.view(), facts, options);
  TAUTLINE_CHECK(curved.validity == plain.validity);
  TAUTLINE_CHECK_EQUAL(curved.points.size(), plain.points.size());
  TAUTLINE_CHECK_EQUAL(curved.connectivity[curved.offsets[1] + 1], data.nodes(1)[1]);
}

TAUTLINE_PART(testSeam)
{
  // Two halves with points of their own on the seam: these get the places that they have in one.
  MeshData one = pipe(CellType::Hexahedron, 4), two = one;
  std::vector<Index> representative(one.numberOfPoints());
  std::iota(representative.begin(), representative.end(), Index(0));
  std::map<Index, Index> copies;
  for (Index cell = one.numberOfCells() / 2; cell < one.numberOfCells(); ++cell)
  {
    for (Index n = one.offsets[cell]; n < one.offsets[cell + 1]; ++n)
    {
      const Index p = one.connectivity[n];
      if (one.point(p)[2] == 1)
      {
        const auto [at, added] = copies.emplace(p, two.numberOfPoints());
        if (added)
        {
          two.addPoint(one.point(p));
          representative.push_back(p);
        }
        two.connectivity[n] = at->second;
      }
    }
  }
  MeshData merged = two;
  for (Index& p : merged.connectivity)
  {
    p = representative[p];
  }
  TAUTLINE_LET(CurvingOptions, options, order = 3, representative = representative.data());
  const CurvingResult apart = curveMesh(Mesh(merged.view()), two.view(), {}, options);
  const CurvingResult whole = curve(one, 3);
  TAUTLINE_CHECK(apart.points.size() > whole.points.size());
  TAUTLINE_CHECK_EQUAL(places(dataOf(apart)), places(dataOf(whole)));
  TAUTLINE_CHECK_EQUAL(apart.curves, whole.curves);
  TAUTLINE_CHECK_EQUAL(invalid(apart), Index(0));
}

TAUTLINE_PART(testRegions)
{
  // Two materials: their boundary is curved if asked for.
  MeshData data = pipe(CellType::Hexahedron, 4);
  std::vector<double> regions(data.numberOfCells());
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    regions[cell] = cell / 2 % 2;
  }
  const CurvingResult without = curve(data, 2);
  const CurvingResult with = curve(data, 2, [&](CurvingOptions& o) { o.regions = regions.data(); });
  TAUTLINE_CHECK(with.patches > without.patches);
  TAUTLINE_CHECK(std::count(with.onBoundary.begin(), with.onBoundary.end(), 1) >
    std::count(without.onBoundary.begin(), without.onBoundary.end(), 1));
}

TAUTLINE_PART(testRejected)
{
  const auto rejects = [](const std::string& text, const std::function<void()>& work)
  { TAUTLINE_CHECK_THROWS(work(), text); };
  const MeshData pyramids = blockMesh(CellType::Pyramid, 1, 1, 1);
  const MeshData cube = blockMesh(CellType::Hexahedron, 1, 1, 1);
  for (int order : { 3, 4 })
  {
    rejects(wording("no-pyramids-of-order"), [&] { curve(pyramids, order); });
  }
  for (int order : { 0, 5 })
  {
    rejects(wording("order-must-be-1-to-4"), [&] { curve(cube, order); });
  }
  MeshData polygons = blockMesh(CellType::Quadrilateral, 2, 1, 0);
  constexpr int polygon = 7, bezierTriangle = 76;
  polygons.addCell(polygon, { 0, 1, 2, 5, 4 });
  rejects(wording("polygons-cannot-be-curved"), [&] { curve(polygons, 2); });
  const Mesh surface(cube.view());
  rejects(wording("straight-cells-on-a-geometry"),
    [&]
    {
      curve(cube, 2,
        [&](CurvingOptions& o)
        {
          o.smooth = false;
          o.geometry = &surface;
        });
    });
  MeshData rational = dataOf(curve(blockMesh(CellType::Triangle, 1, 1, 0), 2));
  std::fill(rational.types.begin(), rational.types.end(), bezierTriangle);
  CurvedCellFacts facts;
  facts.rational = true;
  rejects(wording("cells-are-rational"), [&] { curve(rational, 3, {}, facts); });
}
