// SPDX-License-Identifier: BSD-3-Clause
/**
 * Untangling: meshes with a few and with many inverted elements, of all cell types; Mesquite's
 * tangled meshes; what cannot be untangled and why; limits; the same result in any frame and with
 * any number of threads.
 */

#include "Registry.h"
#include "Surfaces.h"
#include "VtkMeshes.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Perturbation/Perturb.h"
#include "tautline/Untangling/LinearProgram.h"
#include "tautline/Untangling/Untangle.h"

#include <filesystem>
#include <fstream>
#include <thread>

using namespace tautline;

namespace
{

bool isFlat(CellType type)
{
  return topology(type).dimension == 2;
}

MeshData block(CellType type, Index n)
{
  return blockMesh(type, n, n, isFlat(type) ? 0 : n);
}

/// One flag per point: on the boundary.
std::vector<char> boundaryOf(const MeshData& data)
{
  return Mesh(data.view()).boundary().isBoundaryPoint;
}

/// A part of the inner vertices, drawn at random, somewhere in the bounding box.
MeshData scattered(MeshData data, double part, unsigned seed = 1)
{
  const std::vector<char> boundary = boundaryOf(data);
  Vec3 low = data.point(0), high = low;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], data.point(i)[c]);
      high[c] = std::max(high[c], data.point(i)[c]);
    }
  }
  Random random(seed);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    if (!boundary[i] && random.uniform(0, 1) < part)
    {
      Vec3 p;
      for (int c = 0; c < 3; ++c)
      {
        p[c] = random.uniform(low[c], high[c]);
      }
      data.setPoint(i, p);
    }
  }
  return data;
}

/// All inner vertices at one point.
MeshData collapsed(MeshData data, const Vec3& at)
{
  const std::vector<char> boundary = boundaryOf(data);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    if (!boundary[i])
    {
      data.setPoint(i, at);
    }
  }
  return data;
}

/// A block with a hole whose boundary is turned about z and leaves the vertices between behind.
MeshData turnedHole(CellType type, Index n, double degrees)
{
  const MeshData full = block(type, n);
  constexpr double halfWidth = 0.15, pi = 3.14159265358979323846;
  const double middle = 0.5 * static_cast<double>(n);
  const int dimension = topology(type).dimension;
  TAUTLINE_LET(MeshData, data, points = full.points);
  for (Index cell = 0; cell < full.numberOfCells(); ++cell)
  {
    const std::vector<Index> nodes = full.nodes(cell);
    Vec3 center = sumOf<Vec3>({ 0, 0, 0 }, nodes,
      [&](Index node) { return (1.0 / static_cast<double>(nodes.size())) * full.point(node); });
    bool inHole = true;
    for (int c = 0; c < dimension; ++c)
    {
      inHole = inHole && std::abs(center[c] - middle) < halfWidth * static_cast<double>(n);
    }
    if (!inHole)
    {
      data.addCell(full.types[cell], nodes);
    }
  }
  const std::vector<char> boundary = boundaryOf(data);
  const Columns turn = rotation({ 0, 0, 1 }, degrees * pi / 180);
  const Vec3 origin = { middle, middle, 0 };
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    bool inner = boundary[i] != 0;
    for (int c = 0; c < dimension; ++c)
    {
      inner = inner && p[c] > 0.5 && p[c] < static_cast<double>(n) - 0.5;
    }
    if (inner)
    {
      data.setPoint(i, origin + turn * (p - origin));
    }
  }
  return data;
}

/// A few elements inverted.
MeshData slightlyTangled(const MeshData& data, double part)
{
  TAUTLINE_LET(PerturbOptions, options, tangledFraction = part);
  MeshData result = data;
  result.points = perturb(Mesh(data.view()), nullptr, options).points;
  return result;
}

Index countNotValid(const MeshData& data, bool mirrored = false)
{
  Mesh mesh(data.view());
  mesh.setMirrored(mirrored);
  const std::vector<signed char> validity = validityOf(mesh);
  return std::count_if(validity.begin(), validity.end(), [](signed char v) { return v != Valid; });
}

MeshData moved(const MeshData& data, const UntangleResult& result)
{
  return TAUTLINE_CHANGED(data, points = result.points);
}

bool samePoint(const MeshData& a, const MeshData& b, Index i)
{
  return a.point(i) == b.point(i);
}

/// Untangles and checks that the result keeps its guarantees and is valid throughout.
UntangleResult checkUntangles(
  const MeshData& data, const std::string& name, const UntangleOptions& options = {})
{
  const Context context(name);
  const UntangleResult result = untangle(Mesh(data.view()), options);
  const MeshData after = moved(data, result);
  TAUTLINE_CHECK_EQUAL(result.invertedBefore, countNotValid(data));
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  TAUTLINE_CHECK_EQUAL(countNotValid(after), 0);
  TAUTLINE_CHECK(result.reason == StopReason::AllValid);
  TAUTLINE_CHECK_EQUAL(result.impossible, 0);
  const std::vector<char> boundary = boundaryOf(data);
  Index fixedMoved = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const bool fixed = options.fixed ? options.fixed[i] != 0 : boundary[i] != 0;
    fixedMoved += fixed && !samePoint(data, after, i);
  }
  TAUTLINE_CHECK_EQUAL(fixedMoved, 0);
  if (result.invertedBefore > 0)
  {
    TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 0);
    TAUTLINE_CHECK_EQUAL(result.history.back().objective, 0);
  }
  return result;
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testCellTypes)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const Index n = isFlat(type) ? 20 : 7;
    const MeshData data = block(type, n);
    const double middle = 0.5 * static_cast<double>(n);
    checkUntangles(slightlyTangled(data, 0.02), "2 %");
    checkUntangles(scattered(data, 0.3), "30 %");
    checkUntangles(scattered(data, 0.6), "60 %");
    checkUntangles(scattered(data, 1.0), "100 %");
    checkUntangles(collapsed(data, { middle, middle, isFlat(type) ? 0 : middle }), "at one point");
  }
}

TAUTLINE_PART(testTurnedHoles)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const Index n = isFlat(type) ? 30 : type == CellType::Pyramid ? 7 : 10;
    checkUntangles(turnedHole(type, n, 90), "turned by 90 degrees");
    checkUntangles(turnedHole(type, n, 120), "turned by 120 degrees");
  }
  // Half a turn, where the energies alone lead into a fold.
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    checkUntangles(turnedHole(type, isFlat(type) ? 30 : 12, 180), "turned by 180 degrees");
  }
}

/// Only the neighborhood of inverted elements moves.
TAUTLINE_PART(testLocality)
{
  MeshData data = block(CellType::Tetrahedron, 12);
  const Index center = 6 + 13 * (6 + 13 * 6);
  const Vec3 from = data.point(center);
  data.setPoint(center, from + Vec3{ 1.4, 0.1, 0.2 });
  TAUTLINE_LET(UntangleOptions, options, effort = Effort::Local);
  const UntangleResult result = checkUntangles(data, "one vertex astray", options);
  Index far = 0, any = 0;
  const MeshData after = moved(data, result);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const bool changed = !samePoint(data, after, i);
    any += changed;
    far += changed && norm(data.point(i) - from) > 4;
  }
  TAUTLINE_CHECK(any > 0 && any < 60);
  TAUTLINE_CHECK_EQUAL(far, 0);
}

/// Where fixed points keep some elements invalid: how many valid ones have become invalid.
TAUTLINE_PART(testNewlyInvalid)
{
  Index all = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    MeshData data = block(CellType::Quadrilateral, 8);
    Random random(seed);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 d = random.vector(-1.2, 1.2);
      data.setPoint(i, data.point(i) + Vec3{ d[0], d[1], 0 });
    }
    const UntangleResult result = untangle(Mesh(data.view()), UntangleOptions());
    MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
    const std::vector<signed char> before = validityOf(data), after = validityOf(moved);
    Index newly = sumOf<Index>(0, before.size(),
      [&](std::size_t cell) { return before[cell] == Valid && after[cell] != Valid; });
    TAUTLINE_CHECK_EQUAL(result.newlyInvalid, newly);
    TAUTLINE_CHECK(result.newlyInvalid <= result.invertedAfter);
    all += newly;
  }
  TAUTLINE_CHECK(all > 0);
}

/// Mesquite's tangled meshes and Tautline's, with their own flags and with the boundary fixed.
void testFiles(const std::string& directory)
{
  for (const char* name : { "rotsq", "tangled_quad", "tangled_tri", "inverted-hole-1",
         "hex_5_tangled", "tet_4_tangled", "pave2.e", "disk2d_20k_t1", "disk3d_50k_t1" })
  {
    const Context context(name);
    const std::string file = directory + "/" + name + ".vtk";
    if (!TAUTLINE_CHECK(std::ifstream(file).good()))
    {
      continue;
    }
    const vtkSmartPointer<vtkUnstructuredGrid> grid = readGrid(file);
    const MeshData data = toMesh(grid);
    const UntangleResult byBoundary = checkUntangles(data, name);
    TAUTLINE_CHECK(byBoundary.invertedBefore > 0);
    vtkDataArray* flags = grid->GetPointData()->GetArray("fixed");
    if (TAUTLINE_CHECK(flags))
    {
      auto fixed = collect<unsigned char>(
        data.numberOfPoints(), [&](Index i) { return flags->GetTuple1(i) != 0; });
      TAUTLINE_LET(UntangleOptions, options, fixed = fixed.data());
      checkUntangles(data, std::string(name) + ", its own flags", options);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testFrames)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Quadrilateral })
  {
    const Context context(topology(type).name);
    const MeshData data = scattered(block(type, isFlat(type) ? 20 : 8), 0.3);
    const UntangleResult plain = checkUntangles(data, "plain");
    MeshData other = data;
    other.transform([](const Vec3& p) { return p + Vec3{ 1e6, -1e6, 1e6 }; });
    checkUntangles(other, "translated by 1e6");
    for (double scale : { 1e-8, 1e8 })
    {
      other = data;
      other.transform([=](const Vec3& p) { return scale * p; });
      checkUntangles(other, "scaled");
    }
    other = data;
    const double scale = 0x1p20;
    other.transform([=](const Vec3& p) { return scale * p; });
    const UntangleResult scaled = checkUntangles(other, "scaled by a power of two");
    Index different = sumOf<Index>(0, plain.points.size(),
      [&](std::size_t i) { return scaled.points[i] != scale * plain.points[i]; });
    TAUTLINE_CHECK_EQUAL(different, 0);
    const Columns turn = rotation({ 1, 2, -0.5 }, 1.1);
    other = data;
    other.transform([&](const Vec3& p) { return turn * p; });
    checkUntangles(other, "rotated");
  }
}

TAUTLINE_PART(testThreads)
{
  for (const MeshData& data : { slightlyTangled(block(CellType::Tetrahedron, 20), 0.02),
         turnedHole(CellType::Tetrahedron, 20, 60) })
  {
    UntangleResult one;
    for (int threads : { 1, 2, 4 })
    {
      TAUTLINE_LET(UntangleOptions, options, threads = threads);
      // Far enough into the phase of all vertices.
      options.observer = [](const IterationState& state) { return state.record.iteration < 8; };
      const UntangleResult result = untangle(Mesh(data.view()), options);
      if (threads == 1)
      {
        one = result;
        continue;
      }
      TAUTLINE_CHECK(result.points == one.points);
      TAUTLINE_CHECK_EQUAL(result.history.size(), one.history.size());
      TAUTLINE_CHECK_EQUAL(result.history.back().objective, one.history.back().objective);
    }
  }
}

//------------------------------------------------------------------------------
/// Six tetrahedra between a vertex in the middle and the corners of a tetrahedron cut once more.
MeshData star(const Vec3& center)
{
  MeshData data = block(CellType::Tetrahedron, 1);
  data = TAUTLINE_CHANGED(MeshData(),
    addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, center }),
    addCell(CellType::Tetrahedron, std::vector<Index>{ 4, 1, 2, 3 }),
    addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 4, 2, 3 }),
    addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 4, 3 }),
    addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 2, 4 }));
  return data;
}

TAUTLINE_PART(testObstacles)
{
  {
    const Context context("a single free vertex");
    const UntangleResult result = checkUntangles(star({ 3, 3, 3 }), "outside");
    TAUTLINE_CHECK_EQUAL(result.invertedBefore, 1);
  }
  {
    const Context context("no free vertex");
    MeshData data = singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
    std::swap(data.connectivity[0], data.connectivity[1]);
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK(result.reason == StopReason::NoFreeVertices);
    TAUTLINE_CHECK_EQUAL(int(result.obstacles[0]), int(Obstacle::FixedElement));
    TAUTLINE_CHECK_EQUAL(result.impossible, 1);
    TAUTLINE_CHECK(result.points == data.points);
  }
  {
    // An inverted element apart does not keep the rest from becoming valid.
    const Context context("a fixed element");
    MeshData data = scattered(block(CellType::Tetrahedron, 6), 0.3);
    const Index first = data.numberOfPoints(), cell = data.numberOfCells();
    for (const Vec3& p : idealCell(CellType::Tetrahedron))
    {
      data.addPoint(p + Vec3{ 20, 0, 0 });
    }
    data.addCell(CellType::Tetrahedron, { first + 1, first, first + 2, first + 3 });
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK(result.invertedBefore > 100);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 1);
    TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 1);
    TAUTLINE_CHECK_EQUAL(result.impossible, 1);
    TAUTLINE_CHECK_EQUAL(int(result.obstacles[cell]), int(Obstacle::FixedElement));
    TAUTLINE_CHECK_EQUAL(countNotValid(moved(data, result)), 1);
  }
  {
    // A square whose fixed corner is pulled through the opposite side: no place for the middle.
    const Context context("a star without a place");
    MeshData data;
    data.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { -1, -1, 0 }, { 0, 1, 0 }, { 0.4, 0.4, 0 } });
    for (Index k = 0; k < 4; ++k)
    {
      data.addCell(CellType::Triangle, std::vector<Index>{ k, (k + 1) % 4, 4 });
    }
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK(result.invertedAfter > 0);
    TAUTLINE_CHECK(result.invertedAfter <= result.invertedBefore);
    TAUTLINE_CHECK_EQUAL(result.impossible, result.invertedAfter);
    TAUTLINE_CHECK_EQUAL(countNotValid(moved(data, result)), result.invertedAfter);
    Index named = 0;
    for (signed char o : result.obstacles)
    {
      named += o == static_cast<signed char>(Obstacle::FixedNeighbours);
    }
    TAUTLINE_CHECK_EQUAL(named, result.invertedAfter);
  }
  {
    // A boundary quadrilateral with a fixed reflex corner: the block around it becomes valid.
    const Context context("a reflex corner of the boundary");
    MeshData data = scattered(block(CellType::Quadrilateral, 8), 0.3);
    data.setPoint(0, { 1.5, 1.5, 0 });
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 1);
    TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 1);
    TAUTLINE_CHECK_EQUAL(result.impossible, 1);
    TAUTLINE_CHECK_EQUAL(int(result.obstacles[0]), int(Obstacle::FixedNeighbours));
  }
}

TAUTLINE_PART(testDegenerate)
{
  {
    const Context context("empty");
    const UntangleResult result = untangle(Mesh(MeshData().view()), {});
    TAUTLINE_CHECK(result.points.empty() && result.reason == StopReason::AllValid);
  }
  {
    const Context context("already valid");
    const MeshData data = block(CellType::Hexahedron, 3);
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK(result.points == data.points);
    TAUTLINE_CHECK(result.reason == StopReason::AllValid);
  }
  {
    const Context context("two parts");
    MeshData data = scattered(block(CellType::Tetrahedron, 5), 0.5);
    const MeshData other = scattered(block(CellType::Tetrahedron, 5), 0.5, 2);
    const Index first = data.numberOfPoints();
    for (Index i = 0; i < other.numberOfPoints(); ++i)
    {
      data.addPoint(other.point(i) + Vec3{ 30, 0, 0 });
    }
    for (Index cell = 0; cell < other.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes;
      for (Index n = other.offsets[cell]; n < other.offsets[cell + 1]; ++n)
      {
        nodes.push_back(first + other.connectivity[n]);
      }
      data.addCell(other.types[cell], nodes);
    }
    checkUntangles(data, "");
  }
  {
    const Context context("NaN");
    MeshData data = scattered(block(CellType::Tetrahedron, 6), 0.3);
    const Index bad = 3 + 7 * (3 + 7 * 3);
    data.setPoint(bad, { std::numeric_limits<double>::quiet_NaN(), 0, 0 });
    const UntangleResult result = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    Index nonFinite = 0, nan = 0;
    for (signed char o : result.obstacles)
    {
      nonFinite += o == static_cast<signed char>(Obstacle::NonFinite);
    }
    for (double x : result.points)
    {
      nan += std::isnan(x);
    }
    TAUTLINE_CHECK(nonFinite > 0);
    TAUTLINE_CHECK_EQUAL(nan, 1);
  }
  for (CellType type : { CellType::Tetrahedron, CellType::Triangle, CellType::Wedge })
  {
    const Context context(std::string("mirrored ") + topology(type).name);
    MeshData data = scattered(block(type, isFlat(type) ? 12 : 6), 0.3);
    data.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
    Mesh mesh(data.view());
    mesh.setMirrored(true);
    const UntangleResult result = untangle(mesh, {});
    TAUTLINE_CHECK(result.invertedBefore > 0);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK_EQUAL(countNotValid(moved(data, result), true), 0);
  }
}

/// Limits and observers; never more inverted elements than before.
TAUTLINE_PART(testLimits)
{
  const MeshData data = turnedHole(CellType::Tetrahedron, 12, 120);
  const Index before = countNotValid(data);
  for (int last : { 0, 3, 10 })
  {
    UntangleOptions options;
    int calls = 0;
    options.observer = [&](const IterationState& state)
    {
      TAUTLINE_CHECK_EQUAL(state.record.iteration, calls);
      TAUTLINE_CHECK(state.progress >= 0 && state.progress <= 1);
      if (calls == last)
      {
        MeshData now = data;
        state.points(now.points.data());
        TAUTLINE_CHECK_EQUAL(countNotValid(now), state.record.inverted);
      }
      return calls++ < last;
    };
    const UntangleResult result = untangle(Mesh(data.view()), options);
    TAUTLINE_CHECK(result.reason == StopReason::Aborted);
    TAUTLINE_CHECK_EQUAL(calls, last + 1);
    TAUTLINE_CHECK(result.invertedAfter <= before && result.invertedAfter > 0);
    TAUTLINE_CHECK_EQUAL(countNotValid(moved(data, result)), result.invertedAfter);
    TAUTLINE_CHECK_EQUAL(std::count(result.obstacles.begin(), result.obstacles.end(),
                           static_cast<signed char>(Obstacle::Unknown)),
      result.invertedAfter);
  }
  TAUTLINE_LET(UntangleOptions, options, maximumSeconds = 1e-4);
  const UntangleResult result = untangle(Mesh(data.view()), options);
  TAUTLINE_CHECK(result.reason == StopReason::TimeLimit);
  TAUTLINE_CHECK(result.history.size() <= 2);
  TAUTLINE_CHECK(result.invertedAfter <= before);
}

/// A time limit that is reached within the first sweep ends it there.
TAUTLINE_PART(testTimeLimitWithinSweep)
{
  constexpr double limit = 0.5;
  const auto sleep = [](double seconds)
  { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); };
  const MeshData data = movedBlock(CellType::Tetrahedron, 40, 0.9);
  TAUTLINE_LET(UntangleOptions, options, maximumSeconds = limit);
  bool begun = false, slept = false;
  options.observer = [&](const IterationState&)
  {
    // The next poll is due at once, however short a sweep is.
    begun = true;
    sleep(PollScope::Interval);
    return true;
  };
  const PollScope scope(
    [&]
    {
      slept = begun;
      sleep(begun ? limit : 0.0);
    });
  const UntangleResult result = untangle(Mesh(data.view()), options);
  TAUTLINE_CHECK(slept && result.reason == StopReason::TimeLimit);
  TAUTLINE_CHECK_EQUAL(result.history.size(), 1u);
  TAUTLINE_CHECK(result.invertedBefore > 0 && result.invertedAfter == result.invertedBefore);
  TAUTLINE_CHECK(result.points == data.points);
}

TAUTLINE_PART(testSurface)
{
  MeshData data = block(CellType::Quadrilateral, 4);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[0] + p[1]));
  TAUTLINE_CHECK(untangle(Mesh(data.view()), {}).reason == StopReason::AllValid);
  // A point that was pulled along the surface goes back, and stays on it.
  data.setPoint(12, { 3.5, 3.5, 4.725 });
  UntangleResult result = untangle(Mesh(data.view()), {});
  TAUTLINE_CHECK(result.invertedBefore > 0);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  TAUTLINE_CHECK(result.reason == StopReason::AllValid);
  MeshData after = TAUTLINE_CHANGED(data, points = result.points);
  TAUTLINE_EACH_OF(signed char v, validityOf(after),
    TAUTLINE_CHECK_EQUAL(static_cast<int>(v), static_cast<int>(Valid)));
  constexpr double sag = 0.16; // of the longest edges of the point that was pulled
  for (Index p = 0; p < after.numberOfPoints(); ++p)
  {
    const Vec3 x = after.point(p);
    TAUTLINE_CHECK(std::abs(0.1 * x[0] * x[0] + x[1] - x[2]) <= sag);
    TAUTLINE_CHECK(p == 12 || norm(x - data.point(p)) < 1.5);
  }
  // Folded triangles in a flat side of a cube count; the side stays flat, and the cube as it was.
  MeshData cube = cubeSurface(CellType::Triangle, 6);
  TAUTLINE_CHECK_EQUAL(untangle(Mesh(cube.view()), {}).invertedBefore, 0);
  const MeshData given = cube;
  Index inside = 0;
  while (norm(cube.point(inside) - Vec3{ 0.5, 0.5, 1 }) > 0.01)
  {
    ++inside;
  }
  cube.setPoint(inside, cube.point(inside) + Vec3{ 0.21, 0.03, 0 });
  result = untangle(Mesh(cube.view()), {});
  TAUTLINE_CHECK(result.invertedBefore > 0);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  for (Index p = 0; p < cube.numberOfPoints(); ++p)
  {
    const Vec3 x = { result.points[3 * p], result.points[3 * p + 1], result.points[3 * p + 2] };
    TAUTLINE_CHECK_NEAR(x[2], given.point(p)[2], 1e-12);
    TAUTLINE_CHECK(p == inside || norm(x - given.point(p)) < 0.15);
  }
  after = TAUTLINE_CHANGED(given, points = result.points);
  TAUTLINE_CHECK_EQUAL(untangle(Mesh(after.view()), {}).invertedBefore, 0);
}

//------------------------------------------------------------------------------
/// The widest place in a plane against all intersections of three distances.
TAUTLINE_PART(testLinearPrograms)
{
  Random random(5);
  for (int trial = 0; trial < 300; ++trial)
  {
    const int count = 3 + static_cast<int>(random.integer(9));
    std::vector<HalfSpace<2>> planes;
    for (int i = 0; i < count; ++i)
    {
      // The first three positively span the plane, so that the place is bounded.
      const double angle = i < 3 ? 2.0 * i + random.uniform(0, 0.3) : random.uniform(0, 6.28);
      planes.push_back({ { std::cos(angle), std::sin(angle) }, random.uniform(-1, 1) });
    }
    double best = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        for (int k = 0; k < j; ++k)
        {
          const Vec3 rows[3] = { { planes[i].a[0], planes[i].a[1], 1 },
            { planes[j].a[0], planes[j].a[1], 1 }, { planes[k].a[0], planes[k].a[1], 1 } };
          const double det = dot(rows[0], cross(rows[1], rows[2]));
          if (std::abs(det) < 1e-9)
          {
            continue;
          }
          const Vec3 x = (1 / det) *
            (planes[i].b * cross(rows[1], rows[2]) + planes[j].b * cross(rows[2], rows[0]) +
              planes[k].b * cross(rows[0], rows[1]));
          bool feasible = true;
          for (const HalfSpace<2>& h : planes)
          {
            feasible = feasible && h.a[0] * x[0] + h.a[1] * x[1] + x[2] <= h.b + 1e-9;
          }
          best = feasible ? std::max(best, x[2]) : best;
        }
      }
    }
    std::array<double, 2> place;
    const double radius = chebyshevCenter<2>(planes, 100, place);
    TAUTLINE_CHECK_NEAR(radius, best, 1e-8);
  }
}
}

// Meshes that are not part of the repository.
TAUTLINE_TEST(TestUntangleFiles)
{
  testFiles(externalData("tangled"));
}
