// SPDX-License-Identifier: BSD-3-Clause
// Energies of points with a boundary that slides: derivatives against differences, what is
// untangled, how far the surface goes, and what stays.
#include "Blocks.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Sliding/ImproveSliding.h"
#include "tautline/Sliding/MovingBarrier.h"
#include "tautline/Sliding/SlidingUntangler.h"
#include "tautline/Untangling/Untangle.h"
#include "vtkXMLUnstructuredGridReader.h"

using namespace tautline;

namespace
{
/// A mesh with the features of another one of the same cells, and the constraints made of them.
struct SlidingMesh
{
  explicit SlidingMesh(const MeshData& reference, double angle = 40, bool smooth = false)
    : data(reference)
  {
    const Mesh mesh(reference.view());
    FeatureOptions options;
    options.angle = angle;
    const Features features = findFeatures(mesh, options);
    this->model = makeSurfaceModel(mesh, features, smooth);
    this->parts = partsOfPoints(features);
    for (const signed char kind : features.kind)
    {
      this->fixed.push_back(kind == CornerPoint);
    }
    Vec3 low = reference.point(0), high = low;
    for (Index p = 0; p < reference.numberOfPoints(); ++p)
    {
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], reference.point(p)[c]);
        high[c] = std::max(high[c], reference.point(p)[c]);
      }
    }
    this->diagonal = norm(high - low);
  }

  BoundaryConstraints constraints() const
  {
    BoundaryConstraints result;
    result.fixed = this->fixed.data();
    result.model = &this->model;
    result.parts = this->parts.data();
    result.surfaceTolerance = 1e-3 * this->diagonal;
    return result;
  }
  UntangleOptions untangling() const
  {
    UntangleOptions options;
    options.fixed = this->fixed.data();
    options.model = &this->model;
    options.parts = this->parts.data();
    options.surfaceTolerance = 1e-3 * this->diagonal;
    return options;
  }
  double meanEdge() const
  {
    double sum = 0;
    Index count = 0;
    for (Index cell = 0; cell < this->data.numberOfCells(); ++cell)
    {
      const std::vector<Index> nodes = this->data.nodes(cell);
      const CellTopology& t = topology(cornerType(this->data.types[cell]));
      for (int e = 0; e < t.edges; ++e, ++count)
      {
        sum += norm(
          this->data.point(nodes[t.edgeNodes[e][1]]) - this->data.point(nodes[t.edgeNodes[e][0]]));
      }
    }
    return sum / static_cast<double>(count);
  }

  MeshData data;
  SurfaceModel model;
  std::vector<std::int32_t> parts;
  std::vector<unsigned char> fixed;
  double diagonal;
};

Index invalidOf(const MeshData& data)
{
  const std::vector<signed char> validity = validityOf(data);
  return std::count_if(
    validity.begin(), validity.end(), [](signed char v) { return isInvalid(v); });
}

double worstJacobian(const MeshData& data)
{
  const std::vector<double> values = valuesOf(data, Metric::ScaledJacobian);
  return *std::min_element(values.begin(), values.end());
}

MeshData withPoints(MeshData data, const std::vector<double>& points)
{
  data.points = points;
  return data;
}

/// 6 rings of 48 cells about a hole.
MeshData ring(CellType type)
{
  constexpr int around = 48, layers = 6;
  MeshData data;
  for (int layer = 0; layer <= layers; ++layer)
  {
    for (int i = 0; i < around; ++i)
    {
      const double angle = 2 * Pi * i / around, radius = 1 + static_cast<double>(layer) / layers;
      data.addPoint({ radius * std::cos(angle), radius * std::sin(angle), 0 });
    }
  }
  for (Index layer = 0; layer < layers; ++layer)
  {
    for (Index i = 0; i < around; ++i)
    {
      const Index a = layer * around + i, b = layer * around + (i + 1) % around, c = b + around,
                  d = a + around;
      if (type == CellType::Quadrilateral)
      {
        data.addCell(type, std::vector<Index>{ a, d, c, b });
      }
      else
      {
        data.addCell(type, std::vector<Index>{ a, d, c });
        data.addCell(type, std::vector<Index>{ a, c, b });
      }
    }
  }
  return data;
}

//------------------------------------------------------------------------------
/// A block whose points all move, a little away from its lattice.
MeshData looseBlock(CellType type, double amplitude)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, 2, 2, flat ? 0 : 2);
  Random random(3);
  data.transform(
    [&](const Vec3& p)
    {
      const double a = amplitude;
      return p +
        Vec3{ random.uniform(-a, a), random.uniform(-a, a), flat ? 0.0 : random.uniform(-a, a) };
    });
  return data;
}

/// With the larger amplitude, determinants are also in the window.
void testBarrierGradient(CellType type, CornerMeasure measure, double amplitude)
{
  const bool flat = topology(type).dimension == 2;
  const MeshData data = looseBlock(type, amplitude);
  const Mesh mesh(data.view());
  const BoundaryConstraints constraints;
  const ConstrainedPoints constrained(mesh, constraints);
  std::vector<Vec3> x = pointsOf(data.points.data(), data.numberOfPoints());
  const SlidingCells cells(mesh, constrained);
  BoundaryTerms boundary(mesh, constrained, x);
  TAUTLINE_LET(BarrierOptions, options, measure = measure);
  MovingBarrier barrier(cells, constrained, boundary, x, options);
  constexpr double threshold = 1.3, below = 0.1;
  const double low = barrier.worst() - below;
  QuadraticModel model;
  barrier.modelWith(low, threshold, model);
  TAUTLINE_CHECK_EQUAL(model.points(), x.size());
  Random random(5);
  std::vector<Vec3> d(x.size());
  double expected = 0;
  for (std::size_t p = 0; p < x.size(); ++p)
  {
    d[p] = { random.uniform(-1, 1), random.uniform(-1, 1), flat ? 0.0 : random.uniform(-1, 1) };
    expected += dot(d[p], model.gradient()[p]);
  }
  const std::vector<Vec3> at = x;
  const auto valueAt = [&](double t)
  {
    for (std::size_t p = 0; p < x.size(); ++p)
    {
      x[p] = at[p] + t * d[p];
    }
    return barrier.energyWith(low, threshold);
  };
  constexpr double step = 1e-5;
  const double slope = (valueAt(step) - valueAt(-step)) / (2 * step);
  x = at;
  TAUTLINE_CHECK(std::abs(expected) > 0.01);
  TAUTLINE_CHECK_RELATIVE(slope, expected, 1e-4);
}

TAUTLINE_PART(testBarrierGradients)
{
  for (const CellType type : allTypes)
  {
    for (const double amplitude : { 0.1, 0.4 })
    {
      const Context context(topology(type).name + (" " + std::to_string(amplitude)));
      testBarrierGradient(type, CornerMeasure::ScaledJacobian, amplitude);
      testBarrierGradient(type, CornerMeasure::MeanRatio, amplitude);
    }
  }
}

//------------------------------------------------------------------------------
/// The gradient everywhere. Along moves of one point the determinants of corners are linear; where
/// eps is small, the model then has the whole second derivative.
TAUTLINE_PART(testUntanglingDerivatives)
{
  for (const CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    for (const double amplitude : { 0.05, 0.8 })
    {
      const MeshData data = looseBlock(type, amplitude);
      const Mesh mesh(data.view());
      const ConstrainedPoints constrained(mesh, BoundaryConstraints());
      std::vector<Vec3> x = pointsOf(data.points.data(), data.numberOfPoints());
      const SlidingCells cells(mesh, constrained);
      BoundaryTerms boundary(mesh, constrained, x);
      SlidingUntangler untangler(cells, constrained, boundary, x, 1);
      const bool valid = amplitude < 0.1;
      const double eps = valid ? 1e-4 : 0.3;
      QuadraticModel model;
      untangler.modelWith(eps, model);
      Random random(7);
      std::vector<Vec3> d(x.size()), hd(x.size());
      const std::vector<Vec3> at = x;
      const auto valueAt = [&](double t)
      {
        for (std::size_t p = 0; p < x.size(); ++p)
        {
          x[p] = at[p] + t * d[p];
        }
        const double value = untangler.energyWith(eps);
        x = at;
        return value;
      };
      const auto direction = [&]
      {
        return Vec3{ random.uniform(-1, 1), random.uniform(-1, 1),
          flat ? 0.0 : random.uniform(-1, 1) };
      };
      const auto slopeOf = [&]
      {
        double sum = 0;
        for (std::size_t p = 0; p < x.size(); ++p)
        {
          sum += dot(d[p], model.gradient()[p]);
        }
        return sum;
      };
      std::generate(d.begin(), d.end(), direction);
      constexpr double step = 1e-5, bend = 1e-3;
      TAUTLINE_CHECK_RELATIVE((valueAt(step) - valueAt(-step)) / (2 * step), slopeOf(), 1e-5);
      for (std::size_t moving = 0; valid && moving < x.size(); moving += 3)
      {
        std::fill(d.begin(), d.end(), Vec3{ 0, 0, 0 });
        d[moving] = direction();
        model.apply(d, hd);
        const double second = (valueAt(bend) - 2 * valueAt(0) + valueAt(-bend)) / (bend * bend);
        TAUTLINE_CHECK_RELATIVE(second, dot(d[moving], hd[moving]), 1e-3);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Distances from flat facets are linear: their squares have the model's Hessian.
TAUTLINE_PART(testBoundaryDerivatives)
{
  SlidingMesh sliding(blockMesh(CellType::Hexahedron, 3, 3, 3), 180);
  const Mesh mesh(sliding.data.view());
  const ConstrainedPoints constrained(mesh, sliding.constraints());
  const std::vector<Vec3> start = pointsOf(sliding.data.points.data(), mesh.view().numberOfPoints);
  BoundaryTerms boundary(mesh, constrained, start);
  std::vector<Vec3> x = start, d(x.size()), hd(x.size());
  Random random(11);
  const double out = 20 * constrained.tolerance();
  for (std::size_t p = 0; p < x.size(); ++p)
  {
    x[p] += { random.uniform(-out, out), random.uniform(-out, out), random.uniform(-out, out) };
    d[p] = { random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) };
  }
  boundary.moveTo(x);
  TAUTLINE_CHECK(!boundary.isWithin());
  std::vector<std::int32_t> local(x.size());
  std::iota(local.begin(), local.end(), 0);
  QuadraticModel model;
  model.start(x.size());
  boundary.add(local, model);
  model.apply(d, hd);
  double slope = 0, bend = 0;
  for (std::size_t p = 0; p < x.size(); ++p)
  {
    slope += dot(d[p], model.gradient()[p]);
    bend += dot(d[p], hd[p]);
  }
  const auto valueAt = [&](double t)
  {
    std::vector<Vec3> moved = x;
    for (std::size_t p = 0; p < x.size(); ++p)
    {
      moved[p] += t * d[p];
    }
    return boundary.value(moved);
  };
  const double step = 1e-4 * constrained.tolerance();
  TAUTLINE_CHECK(slope != 0 && bend > 0);
  TAUTLINE_CHECK_RELATIVE((valueAt(step) - valueAt(-step)) / (2 * step), slope, 1e-4);
  // A few samples are nearest to edges or corners, from which the distance is not linear.
  TAUTLINE_CHECK_RELATIVE(
    (valueAt(step) - 2 * valueAt(0) + valueAt(-step)) / (step * step), bend, 0.2);
}

//------------------------------------------------------------------------------
/// The minimum of a model: no slope is left in the directions in which points can move.
TAUTLINE_PART(testQuadraticModel)
{
  constexpr std::int32_t n = 12;
  Random random(2);
  const auto vector = [&] {
    return Vec3{ random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) };
  };
  QuadraticModel model;
  model.start(n);
  std::vector<Vec3> directions;
  const Freedom freedoms[] = { Freedom::Space, Freedom::Plane, Freedom::Line, Freedom::None };
  for (std::int32_t i = 0; i < n; ++i)
  {
    const Vec3 v = vector();
    directions.push_back((1 / norm(v)) * v);
    model.setFreedom(i, freedoms[i % 4], directions[i]);
    model.addGradient(i, vector());
    model.addEdge(i, i + 1 < n ? i + 1 : -1, 1.5);
    const std::int32_t ends[] = { i, (i + 5) % n, -1 };
    const Vec3 vectors[] = { vector(), vector(), vector() };
    model.addRankOne(3, ends, vectors, 2.0);
  }
  SolutionLimits limits;
  limits.relativeResidual = 1e-12;
  limits.iterations = 500;
  std::vector<Vec3> step, h(n);
  const double promised = model.solve(std::vector<double>(n, 0.1), limits, step);
  model.apply(step, h);
  double change = 0;
  for (std::int32_t i = 0; i < n; ++i)
  {
    const Vec3 slope =
      allowed(freedoms[i % 4], directions[i], model.gradient()[i] + h[i] + 0.1 * step[i]);
    TAUTLINE_CHECK_NEAR(norm(slope), 0, 1e-9);
    TAUTLINE_CHECK_NEAR(norm(step[i] - allowed(freedoms[i % 4], directions[i], step[i])), 0, 1e-12);
    change += dot(model.gradient()[i] + 0.5 * h[i], step[i]);
  }
  TAUTLINE_CHECK_NEAR(promised, change, 1e-9);
  TAUTLINE_CHECK(promised < 0);
}

//------------------------------------------------------------------------------
/// Boundary points in a wrong order on the circles, and the others anywhere in the ring.
TAUTLINE_PART(testRings)
{
  for (const CellType type : { CellType::Quadrilateral, CellType::Triangle })
  {
    for (const unsigned seed : { 1u, 2u, 3u })
    {
      const Context context(std::string(topology(type).name) + " " + std::to_string(seed));
      SlidingMesh sliding(ring(type), 40, true);
      const MeshData before = sliding.data;
      Random random(seed);
      for (Index p = 0; p < before.numberOfPoints(); ++p)
      {
        const Vec3 x = before.point(p);
        const bool onCircle = sliding.parts[p] >= 0;
        const double radius = onCircle ? norm(x) : random.uniform(1.05, 1.95);
        const double angle = std::atan2(x[1], x[0]) +
          (onCircle ? random.uniform(-0.35, 0.35) : random.uniform(-Pi, Pi));
        sliding.data.setPoint(p, { radius * std::cos(angle), radius * std::sin(angle), 0 });
      }
      TAUTLINE_CHECK(invalidOf(sliding.data) > before.numberOfCells() / 3);
      const UntangleResult result = untangle(Mesh(sliding.data.view()), sliding.untangling());
      const MeshData after = withPoints(sliding.data, result.points);
      TAUTLINE_CHECK_EQUAL(invalidOf(after), 0);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
      TAUTLINE_CHECK_EQUAL(result.offSurface, 0);
      for (Index p = 0; p < after.numberOfPoints(); ++p)
      {
        const double radius = norm(after.point(p));
        if (sliding.parts[p] >= 0)
        {
          TAUTLINE_CHECK_NEAR(radius, p < before.numberOfPoints() / 2 ? 1 : 2, 1e-4);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Points of the boundary half an edge away, along the surface or beside it.
void testBracket(const MeshData& bracket)
{
  for (const bool along : { true, false })
  {
    const Context context(along ? "along" : "off");
    SlidingMesh sliding(bracket);
    const double h = 0.5 * sliding.meanEdge();
    Random random(1);
    for (Index p = 0; p < bracket.numberOfPoints(); ++p)
    {
      const Vec3 d = { random.uniform(-h, h), random.uniform(-h, h), random.uniform(-h, h) };
      if (sliding.parts[p] >= 0)
      {
        Vec3 x = bracket.point(p) + d;
        x =
          along ? SurfaceProjection(sliding.model.parts[sliding.parts[p]], nullptr).closest(x) : x;
        sliding.data.setPoint(p, x);
      }
    }
    TAUTLINE_CHECK(invalidOf(sliding.data) > 100);
    const UntangleOptions options = sliding.untangling();
    const UntangleResult result = untangle(Mesh(sliding.data.view()), options);
    TAUTLINE_CHECK_EQUAL(invalidOf(withPoints(sliding.data, result.points)), 0);
    TAUTLINE_CHECK(result.offSurface < bracket.numberOfPoints() / 50);
    TAUTLINE_CHECK(result.offSurfaceDistance < options.surfaceTolerance);
    for (Index p = 0; p < bracket.numberOfPoints(); ++p)
    {
      TAUTLINE_CHECK(!sliding.fixed[p] ||
        std::equal(&result.points[3 * p], &result.points[3 * p] + 3, &sliding.data.points[3 * p]));
    }
  }
}

//------------------------------------------------------------------------------
/// The boundary facets of a mesh as triangles, quadrilaterals divided as in its model.
SurfaceProjection boundaryOf(const MeshData& data)
{
  SurfacePart part;
  for (const SurfaceFacet& facet : surfaceFacets(Mesh(data.view())))
  {
    for (int k = 2; k < facet.size; ++k)
    {
      part.pieces.push_back(
        { data.point(facet.nodes[0]), data.point(facet.nodes[k - 1]), data.point(facet.nodes[k]) });
    }
  }
  return SurfaceProjection(part, nullptr);
}

/// The larger of the distances between the boundaries, at other places than those that are held.
double twoSided(const MeshData& a, const MeshData& b)
{
  constexpr int divisions = 5;
  const SurfaceProjection first = boundaryOf(a), second = boundaryOf(b);
  return std::max(first.distanceTo(second, 0, divisions), second.distanceTo(first, 0, divisions));
}

MeshData improved(const SlidingMesh& sliding, int threads = 0)
{
  const Mesh mesh(sliding.data.view());
  TAUTLINE_LET(SlidingImprovement, options, threads = threads);
  return withPoints(
    sliding.data, improveSliding(mesh, sliding.constraints(), sliding.data.points, options));
}

/// Hexahedra in the cube, pressed together where the boundary is a sphere.
MeshData ball(int n)
{
  MeshData data = blockMesh(CellType::Hexahedron, n, n, n);
  const double half = 0.5 * n;
  data.transform(
    [=](const Vec3& p)
    {
      const Vec3 q = (1 / half) * (p - Vec3{ half, half, half });
      const double largest = std::max({ std::abs(q[0]), std::abs(q[1]), std::abs(q[2]) });
      const double size = norm(q);
      return size > 0 ? (largest / size) * q : q;
    });
  return data;
}

/// The worst corners are on the boundary, where edges of the cube were: only sliding helps.
TAUTLINE_PART(testBall)
{
  SlidingMesh sliding(ball(6), 180);
  const double before = worstJacobian(sliding.data);
  const MeshData after = improved(sliding, 1);
  TAUTLINE_CHECK(worstJacobian(after) > before);
  TAUTLINE_CHECK_EQUAL(invalidOf(after), 0);
  TAUTLINE_CHECK_NEAR(twoSided(sliding.data, after) / sliding.diagonal, 0, 1.1e-3);
  TAUTLINE_CHECK(after.points == improved(sliding, 3).points);
  // Fixed points keep their bits.
  for (Index p = 0; p < after.numberOfPoints(); p += 2)
  {
    sliding.fixed[p] = 1;
  }
  const MeshData half = improved(sliding);
  for (Index p = 0; p < after.numberOfPoints(); p += 2)
  {
    TAUTLINE_CHECK(half.point(p) == sliding.data.point(p));
  }
  TAUTLINE_CHECK(worstJacobian(half) >= before);
}

/// A mesh that is as good as can be stays bitwise as it is.
TAUTLINE_PART(testIdeal)
{
  const SlidingMesh sliding(blockMesh(CellType::Hexahedron, 3, 3, 3));
  TAUTLINE_CHECK(improved(sliding).points == sliding.data.points);
}

//------------------------------------------------------------------------------
/// Meshes published with HexOpt; how far their worst corners get with their own surface.
TAUTLINE_PART(testHexahedra)
{
  struct Case
  {
    const char* name;
    double angle, aim;
  };
  const std::string folder = externalData("hex");
  for (const Case& c : { Case{ "CAD4", 40, 0.6 }, Case{ "rkm012", 40, 0.6 },
         Case{ "lower_arm", 50, 0.28 }, Case{ "lower_arm", 180, 0.4 } })
  {
    const Context context(c.name + (" " + std::to_string(c.angle)));
    const SlidingMesh sliding(toMesh(readGrid(folder + "/" + c.name + ".vtk")), c.angle);
    const MeshData after = improved(sliding);
    TAUTLINE_CHECK_EQUAL(invalidOf(after), 0);
    const double worst = worstJacobian(after);
    TAUTLINE_CHECK(worst > c.aim);
    // A thousandth holds where distances are sampled; between these places, more by as much as
    // rounding, which differs between machines, leads elsewhere.
    TAUTLINE_CHECK_NEAR(twoSided(sliding.data, after) / sliding.diagonal, 0, 1.2e-3);
  }
}

/// CAD4 with all points but the corners at random places.
TAUTLINE_PART(testRandomTangle)
{
  const std::string folder = externalData("hex");
  SlidingMesh sliding(toMesh(readGrid(folder + "/CAD4.vtk")));
  const MeshData tangled = toMesh(readGrid(folder + "/CAD4Per.vtk"));
  TAUTLINE_CHECK(tangled.connectivity == sliding.data.connectivity);
  for (Index p = 0; p < tangled.numberOfPoints(); ++p)
  {
    sliding.data.setPoint(p, sliding.fixed[p] ? sliding.data.point(p) : tangled.point(p));
  }
  TAUTLINE_CHECK(invalidOf(sliding.data) > 2000);
  const UntangleOptions options = sliding.untangling();
  const UntangleResult result = untangle(Mesh(sliding.data.view()), options);
  TAUTLINE_CHECK_EQUAL(invalidOf(withPoints(sliding.data, result.points)), 0);
  TAUTLINE_CHECK(result.offSurfaceDistance < options.surfaceTolerance);
}
}

TAUTLINE_TEST(TestSliding)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((std::string(argv[1]) + "/bracket.vtu").c_str());
  reader->Update();
  TAUTLINE_RUN(testBracket(toMesh(reader->GetOutput())));
}
