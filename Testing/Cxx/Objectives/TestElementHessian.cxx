// Element Hessians: against differences of the whole gradient, positive semidefinite on tangled
// meshes, and at work in a truncated Newton method.
#include "Blocks.h"
#include "Check.h"

#include "tautline/Objectives/ElementHessian.h"
#include "tautline/Optimization/Minimize.h"

#include <numeric>

using namespace tautline;

namespace
{
constexpr CellType types[] = { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
  CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };
using Vector = std::vector<double>;

Objective make(Metric metric, ObjectiveTemplate objectiveTemplate = ObjectiveTemplate::Default)
{
  Objective objective;
  objective.metric = metric;
  objective.objectiveTemplate = objectiveTemplate;
  objective.evaluation.threads = 1;
  return objective;
}

Vector randomVector(std::size_t n, bool flat, unsigned seed)
{
  Random random(seed);
  Vector d(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    d[i] = random.uniform(-1, 1) * (flat && i % 3 == 2 ? 0 : 1);
  }
  return d;
}

double dot(const Vector& a, const Vector& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double norm(const Vector& a)
{
  return std::sqrt(dot(a, a));
}

Vector times(const ElementHessian& hessian, const Vector& d)
{
  Vector product(d.size(), 0.0);
  hessian.addTimes(1, d.data(), product.data());
  return product;
}

//------------------------------------------------------------------------------
/// Without projection the product is the derivative of the gradient; every type, mirrored ones too.
void testDifferences()
{
  struct Case
  {
    Metric metric;
    ObjectiveTemplate objectiveTemplate;
  };
  using T = ObjectiveTemplate;
  const Case cases[] = { { Metric::InverseMeanRatio, T::SumOfSquares },
    { Metric::MeanRatio, T::SumOfSquaredReciprocals }, { Metric::Size, T::SumOfSquares },
    { Metric::ConditionNumber, T::Sum }, { Metric::ShapeSizeBarrier, T::Sum },
    { Metric::ConditioningScaleInvariant, T::SumOfReciprocals },
    { Metric::InterpolationSizeShape, T::SumOfSquaredReciprocals } };
  for (CellType type : types)
  {
    const bool flat = topology(type).dimension == 2;
    for (bool mirrored : { false, true })
    {
      for (const Case& c : cases)
      {
        if (!metricInfo(c.metric).definedOn(type))
        {
          continue;
        }
        const Context name(std::string(topology(type).plural) + ", " + metricInfo(c.metric).name +
          (mirrored ? ", mirrored" : ""));
        MeshData data = movedBlock(type, 2, 0.08);
        if (mirrored)
        {
          data.transform([](const Vec3& p) { return Vec3{ p[1], p[0], p[2] }; });
        }
        Mesh mesh(data.view());
        mesh.setMirrored(mirrored);
        const ObjectiveSum sum(mesh, make(c.metric, c.objectiveTemplate));
        TAUTLINE_CHECK(std::isfinite(sum.value()));
        ElementHessian hessian(sum, false);
        hessian.assemble();
        const Vector d = randomVector(data.points.size(), flat, 42), start = data.points;
        constexpr double step = 1e-4;
        auto gradientAt = [&](int s)
        {
          for (std::size_t i = 0; i < start.size(); ++i)
          {
            data.points[i] = start[i] + s * step * d[i];
          }
          Vector gradient(start.size(), 0.0);
          sum.addGradient(1, gradient.data());
          data.points = start;
          return gradient;
        };
        const Vector p1 = gradientAt(1), m1 = gradientAt(-1), p2 = gradientAt(2),
                     m2 = gradientAt(-2), product = times(hessian, d);
        double difference = 0;
        for (std::size_t i = 0; i < d.size(); ++i)
        {
          const double expected = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * step);
          difference = std::max(difference, std::abs(product[i] - expected));
        }
        TAUTLINE_CHECK(difference < 1e-7 * norm(product));
      }
    }
  }
}

/// A convex quadratic is reproduced with projection; the model of a mean keeps its slopes' scale.
void testConvex()
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 3, 0.6); // tangled: it does not matter
  const Mesh mesh(data.view());
  const ObjectiveSum sum(mesh, make(Metric::ShapeSizeOrientation, ObjectiveTemplate::Sum));
  ElementHessian hessian(sum);
  hessian.assemble();
  const Vector d = randomVector(data.points.size(), false, 43), product = times(hessian, d);
  // |T - I|^2 is quadratic: F(x + d) = F + g.d + d.H.d / 2 for any d.
  MeshData moved = data;
  for (std::size_t i = 0; i < d.size(); ++i)
  {
    moved.points[i] += d[i];
  }
  const Mesh movedMesh(moved.view());
  Vector gradient(d.size(), 0.0);
  const double before = sum.addGradient(1, gradient.data());
  const double after = ObjectiveSum(movedMesh, sum.objective()).value();
  TAUTLINE_CHECK_RELATIVE(before + dot(gradient, d) + 0.5 * dot(d, product), after, 1e-8);
}

/// Semidefinite, blind to translations, diagonal blocks; any template on tangled meshes.
void testTangled()
{
  for (CellType type : types)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = movedBlock(type, flat ? 4 : 2, 0.7);
    const Mesh mesh(data.view());
    for (const MetricInfo& info : metricRegistry())
    {
      if (!info.definedOn(type))
      {
        continue;
      }
      for (int objectiveTemplate = 0;
           objectiveTemplate <= static_cast<int>(ObjectiveTemplate::Maximum); ++objectiveTemplate)
      {
        const Context name(std::string(topology(type).plural) + ", " + info.name + ", template " +
          std::to_string(objectiveTemplate));
        std::unique_ptr<ObjectiveSum> sum;
        try
        {
          sum = std::make_unique<ObjectiveSum>(
            mesh, make(info.metric, static_cast<ObjectiveTemplate>(objectiveTemplate)));
        }
        catch (const Error&)
        {
          continue; // the template does not fit
        }
        ElementHessian hessian(*sum);
        hessian.assemble();
        double size = 0;
        for (unsigned seed = 0; seed < 4; ++seed)
        {
          const Vector d = randomVector(data.points.size(), flat, seed);
          const Vector product = times(hessian, d);
          size = norm(product) * norm(d);
          TAUTLINE_CHECK(std::isfinite(size));
          TAUTLINE_CHECK(dot(d, product) >= -1e-13 * size);
        }
        TAUTLINE_CHECK(norm(times(hessian, Vector(data.points.size(), 3.0))) <= 1e-10 * size);

        // Column c of the block of a point is the product with a unit vector.
        Vector blocks(2 * data.points.size(), 0.0), unit(data.points.size(), 0.0);
        hessian.addDiagonal(2, blocks.data());
        const double largest = norm(blocks);
        const Index point = data.numberOfPoints() / 2;
        constexpr int position[3][3] = { { 0, 1, 2 }, { 1, 3, 4 }, { 2, 4, 5 } };
        for (int c = 0; c < 3; ++c)
        {
          unit[3 * point + c] = 1;
          const Vector column = times(hessian, unit);
          unit[3 * point + c] = 0;
          for (int r = 0; r < 3; ++r)
          {
            TAUTLINE_CHECK_NEAR(
              blocks[6 * point + position[r][c]], 2 * column[3 * point + r], 1e-13 * largest);
          }
        }
      }
    }
  }
}

void testThreads()
{
  const MeshData data = shuffled(movedBlock(CellType::Tetrahedron, 13, 0.4), 44);
  const Mesh mesh(data.view());
  const Vector d = randomVector(data.points.size(), false, 45);
  Vector first, firstBlocks;
  for (int threads : { 1, 2, 4 })
  {
    const ObjectiveSum sum(mesh, make(Metric::ShapeNonBarrier), threads);
    ElementHessian hessian(sum);
    hessian.assemble();
    const Vector product = times(hessian, d);
    Vector blocks(2 * data.points.size(), 0.0);
    hessian.addDiagonal(1, blocks.data());
    first = threads == 1 ? product : first;
    firstBlocks = threads == 1 ? blocks : firstBlocks;
    TAUTLINE_CHECK(product == first && blocks == firstBlocks);
    TAUTLINE_CHECK(norm(product) > 0);
    // Half a matrix of 9 x 9 doubles per tetrahedron, little more.
    const double perCell =
      static_cast<double>(ElementHessian::memory(sum)) / static_cast<double>(data.numberOfCells());
    TAUTLINE_CHECK(perCell >= 45 * 8 && perCell < 45 * 8 * 1.01);
  }
}

//------------------------------------------------------------------------------
/// Blocks made without Hessians, and their inverses.
void testBlocks()
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 4, 0.15);
  const Mesh mesh(data.view());
  const ObjectiveSum sum(mesh, make(Metric::InverseMeanRatio));
  ElementHessian hessian(sum, false);
  hessian.assemble();
  const Index count = data.numberOfPoints();
  Vector blocks(6 * count, 0.0), direct(6 * count, 0.0);
  hessian.addDiagonal(3, blocks.data());
  addDiagonalBlocks(sum, 3, direct.data());
  TAUTLINE_CHECK(blocks == direct);

  const Vector r = randomVector(data.points.size(), false, 47);
  Vector z(r.size()), back(r.size());
  invertBlocks(direct.data(), count, 1);
  applyBlocks(direct.data(), count, 1, r.data(), z.data());
  applyBlocks(blocks.data(), count, 1, z.data(), back.data());
  Index definite = 0;
  for (Index i = 0; i < count; ++i)
  {
    double difference = 0, power = 0;
    for (Index c = 3 * i; c < 3 * i + 3; ++c)
    {
      difference = std::max(difference, std::abs(back[c] - r[c]));
      power += z[c] * r[c];
    }
    TAUTLINE_CHECK(power > 0);
    definite += difference < 1e-10;
  }
  TAUTLINE_CHECK(definite > count * 3 / 4); // the inverse proper, where there is a definite one

  Vector odd = { 0, 0, 0, 0, 0, 0, 4, 0, 0, -2, 0, 0, 1e300, 0, 0, 1e-300, 0, 1 };
  invertBlocks(odd.data(), 3, 1);
  const Vector expected = { 1, 0, 0, 1, 0, 1, 0.25, 0, 0, 0.5, 0, 250, 1e-300, 0, 0, 1e-297, 0,
    1e-297 };
  for (std::size_t i = 0; i < odd.size(); ++i)
  {
    TAUTLINE_CHECK_RELATIVE(odd[i], expected[i], 1e-13);
  }
}

/// The sum of squared inverse mean ratios over the inner points of a block.
struct Smoothing : SmoothFunction
{
  MeshData data;
  Mesh mesh;
  ObjectiveSum sum;
  ElementHessian hessian;
  std::vector<Index> free;
  Vector gradient, full, product, blocks, inverse;

  explicit Smoothing(const MeshData& given)
    : data(given)
    , mesh(data.view())
    , sum(mesh, make(Metric::InverseMeanRatio))
    , hessian(sum)
    , gradient(data.points.size())
    , full(gradient)
    , product(gradient)
    , blocks(2 * gradient.size())
  {
    const Boundary boundary = this->mesh.boundary();
    for (Index i = 0; i < this->data.numberOfPoints(); ++i)
    {
      if (!boundary.isBoundaryPoint[i])
      {
        this->free.push_back(i);
      }
    }
  }
  std::size_t size() const override { return 3 * this->free.size(); }
  void spread(const double* x, Vector& all) const
  {
    for (std::size_t i = 0; i < this->size(); ++i)
    {
      all[3 * this->free[i / 3] + i % 3] = x[i];
    }
  }
  void collect(const Vector& all, double* x) const
  {
    for (std::size_t i = 0; i < this->size(); ++i)
    {
      x[i] = all[3 * this->free[i / 3] + i % 3];
    }
  }
  double valueAndGradient(const double* x, double* g) override
  {
    this->spread(x, this->data.points);
    std::fill(this->gradient.begin(), this->gradient.end(), 0.0);
    const double value = this->sum.addGradient(1, this->gradient.data());
    this->collect(this->gradient, g);
    return value;
  }
  void linearize(const double* x) override
  {
    this->spread(x, this->data.points);
    this->hessian.assemble();
    std::fill(this->blocks.begin(), this->blocks.end(), 0.0);
    this->hessian.addDiagonal(1, this->blocks.data());
    this->inverse.clear();
    for (Index point : this->free)
    {
      const auto block = this->blocks.begin() + 6 * point;
      this->inverse.insert(this->inverse.end(), block, block + 6);
    }
    invertBlocks(this->inverse.data(), static_cast<Index>(this->free.size()), 1);
  }
  bool hessianTimes(const double* d, double* result) override
  {
    this->spread(d, this->full);
    std::fill(this->product.begin(), this->product.end(), 0.0);
    this->hessian.addTimes(1, this->full.data(), this->product.data());
    this->collect(this->product, result);
    return true;
  }
  bool precondition(const double* r, double* z) override
  {
    applyBlocks(this->inverse.data(), static_cast<Index>(this->free.size()), 1, r, z);
    return true;
  }
};

/// Newton and preconditioned L-BFGS reach the same mesh, the one in few iterations, the other in
/// few evaluations.
void testNewton()
{
  // Inner points only: the boundary stays a cube.
  MeshData data = blockMesh(CellType::Tetrahedron, 10, 10, 10);
  Random random(46);
  data.transform(
    [&](const Vec3& p)
    {
      const bool inner = std::all_of(p.begin(), p.end(), [](double x) { return x > 0 && x < 10; });
      return inner ? p + random.vector(-0.24, 0.24) : p;
    });
  double best = 0;
  for (Optimizer method : { Optimizer::NewtonConjugateGradient, Optimizer::LimitedMemoryBFGS,
         Optimizer::ConjugateGradientPolakRibiere })
  {
    Smoothing f(data);
    Vector x(f.size());
    f.collect(f.data.points, x.data());
    MinimizeOptions options;
    options.method = method;
    options.gradientNorm = 1e-6;
    options.maximumIterations = 300;
    options.threads = 1;
    const MinimizeResult m = minimize(f, x.data(), options);
    std::cout << "smoothing, method " << static_cast<int>(method) << ": " << m.iterations
              << " iterations, " << m.evaluations << " evaluations, " << std::setprecision(10)
              << m.value << "\n";
    TAUTLINE_CHECK(m.reason == StopReason::GradientNorm);
    best = best == 0 ? m.value : best;
    TAUTLINE_CHECK_RELATIVE(m.value, best, 1e-8);
    const std::vector<signed char> validity = validityOf(f.mesh);
    TAUTLINE_CHECK(
      std::all_of(validity.begin(), validity.end(), [](signed char v) { return v == Valid; }));
    TAUTLINE_CHECK(method != Optimizer::NewtonConjugateGradient || m.iterations <= 20);
    TAUTLINE_CHECK(
      method != Optimizer::LimitedMemoryBFGS || m.evaluations <= 1.2 * m.iterations + 3);
  }
}
}

int TestElementHessian(int, char*[])
{
  testDifferences();
  testConvex();
  testTangled();
  testThreads();
  testBlocks();
  testNewton();
  return exitCode();
}
