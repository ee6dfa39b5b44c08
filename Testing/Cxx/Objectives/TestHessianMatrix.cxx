// SPDX-License-Identifier: BSD-3-Clause
// Hessians over the free points: against differences of the whole gradient, finite on tangled
// meshes, with their preconditioners, and their use in a truncated Newton method.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Objectives/HessianMatrix.h"
#include "tautline/Optimization/Minimize.h"

using namespace tautline;

namespace
{
constexpr CellType types[] = { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
  CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };
using Vector = std::vector<double>;

Objective make(Metric metric, ObjectiveTemplate objectiveTemplate = ObjectiveTemplate::Default)
{
  return TAUTLINE_CHANGED(
    Objective(), metric = metric, objectiveTemplate = objectiveTemplate, evaluation.threads = 1);
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

/// All points of a mesh as rows.
HessianMatrix wholeMatrix(
  const Mesh& mesh, HessianMatrix::Pattern pattern = HessianMatrix::Pattern::Full, int threads = 1)
{
  std::vector<std::int32_t> rows(mesh.view().numberOfPoints);
  std::iota(rows.begin(), rows.end(), 0);
  return HessianMatrix(mesh, rows, mesh.view().numberOfPoints, pattern, threads);
}

/// The Hessian of an objective over all points.
HessianMatrix hessianOf(const ObjectiveSum& sum, const Mesh& mesh)
{
  HessianMatrix matrix = wholeMatrix(mesh);
  matrix.add(sum, 1);
  return matrix;
}

/// 3 entries per point in the coordinates of the matrix, and back.
Vector toMatrix(const HessianMatrix& matrix, const Mesh& mesh, const Vector& d)
{
  const std::array<Vec3, 3> axes = coordinateAxes(mesh);
  const int n = matrix.blockSize();
  Vector result(matrix.size());
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const double* v = d.data() + 3 * (i / n);
    result[i] = tautline::dot(Vec3{ v[0], v[1], v[2] }, axes[i % n]);
  }
  return result;
}

Vector fromMatrix(const HessianMatrix& matrix, const Mesh& mesh, const Vector& x)
{
  const std::array<Vec3, 3> axes = coordinateAxes(mesh);
  const int n = matrix.blockSize();
  Vector result(3 * x.size() / n, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      result[3 * (i / n) + c] += x[i] * axes[i % n][c];
    }
  }
  return result;
}

/// The product of the matrix with a vector of 3 entries per point.
Vector times(const HessianMatrix& matrix, const Mesh& mesh, const Vector& d)
{
  Vector product(matrix.size());
  matrix.times(toMatrix(matrix, mesh, d).data(), product.data());
  return fromMatrix(matrix, mesh, product);
}

//------------------------------------------------------------------------------
/// Without projection the product is the derivative of the gradient; every type, mirrored ones too.
TAUTLINE_PART(testDifferences)
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
          data.transform(TAUTLINE_PLACE(p[1], p[0], p[2]));
        }
        Mesh mesh(data.view());
        mesh.setMirrored(mirrored);
        const ObjectiveSum sum(mesh, make(c.metric, c.objectiveTemplate));
        TAUTLINE_CHECK(std::isfinite(sum.value()));
        const HessianMatrix hessian = hessianOf(sum, mesh);
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
                     m2 = gradientAt(-2), product = times(hessian, mesh, d);
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

/// A convex quadratic is reproduced.
TAUTLINE_PART(testConvex)
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 3, 0.6); // tangled: it does not matter
  const Mesh mesh(data.view());
  const ObjectiveSum sum(mesh, make(Metric::ShapeSizeOrientation, ObjectiveTemplate::Sum));
  const HessianMatrix hessian = hessianOf(sum, mesh);
  const Vector d = randomVector(data.points.size(), false, 43), product = times(hessian, mesh, d);
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

bool isSymmetric(const HessianMatrix& matrix)
{
  const Vector a = randomVector(matrix.size(), false, 50),
               b = randomVector(matrix.size(), false, 51);
  Vector pa(a.size()), pb(b.size());
  matrix.times(a.data(), pa.data());
  matrix.times(b.data(), pb.data());
  return std::abs(dot(a, pb) - dot(b, pa)) <= 1e-11 * norm(a) * norm(pb);
}

/// Finite, symmetric, blind to translations; any template on tangled meshes.
TAUTLINE_PART(testTangled)
{
  for (CellType type : types)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = movedBlock(type, flat ? 4 : 2, 0.7);
    const Mesh mesh(data.view());
    for (const MetricInfo& info : elementMetrics())
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
        const HessianMatrix hessian = hessianOf(*sum, mesh);
        double size = 0;
        for (unsigned seed = 0; seed < 4; ++seed)
        {
          const Vector d = randomVector(data.points.size(), flat, seed);
          const Vector product = times(hessian, mesh, d);
          size = norm(product) * norm(d);
          TAUTLINE_CHECK(std::isfinite(size));
        }
        TAUTLINE_CHECK(norm(times(hessian, mesh, Vector(data.points.size(), 3.0))) <= 1e-10 * size);

        TAUTLINE_CHECK(isSymmetric(hessian));
      }
    }
  }
}

TAUTLINE_PART(testThreads)
{
  const MeshData data = shuffled(movedBlock(CellType::Tetrahedron, 13, 0.4), 44);
  const Mesh mesh(data.view());
  const Vector d = randomVector(data.points.size(), false, 45);
  Vector first, firstSolved;
  for (int threads : { 1, 2, 4 })
  {
    const ObjectiveSum sum(mesh, make(Metric::ShapeNonBarrier), threads);
    HessianMatrix hessian = wholeMatrix(mesh, HessianMatrix::Pattern::Full, threads);
    hessian.add(sum, 1);
    hessian.factorize();
    Vector product(d.size()), solved(d.size());
    hessian.times(d.data(), product.data());
    hessian.precondition(d.data(), solved.data());
    first = threads == 1 ? product : first;
    firstSolved = threads == 1 ? solved : firstSolved;
    TAUTLINE_CHECK(product == first && solved == firstSolved);
    TAUTLINE_CHECK(norm(product) > 0 && norm(solved) > 0);
    // About 15 blocks of 9 numbers a point, and 16 places a tetrahedron.
    constexpr double blocks = 15 * (9 * 8 + 4);
    const double points = static_cast<double>(data.numberOfPoints()),
                 cells = static_cast<double>(data.numberOfCells());
    const double expected = blocks * points + 16 * 4 * cells;
    const double bytes = static_cast<double>(hessian.memory());
    TAUTLINE_CHECK(bytes > 0.7 * expected && bytes < 1.3 * expected);
  }
}

//------------------------------------------------------------------------------
/// Preconditioners: symmetric, positive definite, and for the diagonal pattern the inverse blocks.
TAUTLINE_PART(testPreconditioners)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Quadrilateral })
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = movedBlock(type, 4, 0.15);
    const Mesh mesh(data.view());
    const ObjectiveSum sum(mesh, make(Metric::InverseMeanRatio));
    for (auto pattern : { HessianMatrix::Pattern::Full, HessianMatrix::Pattern::Diagonal })
    {
      const Context name(std::string(topology(type).plural) +
        (pattern == HessianMatrix::Pattern::Full ? ", full" : ", diagonal"));
      HessianMatrix matrix = wholeMatrix(mesh, pattern);
      matrix.add(sum, 3);
      matrix.factorize();
      const Vector a = toMatrix(matrix, mesh, randomVector(data.points.size(), flat, 47)),
                   b = toMatrix(matrix, mesh, randomVector(data.points.size(), flat, 48));
      Vector pa(a.size()), pb(b.size());
      matrix.precondition(a.data(), pa.data());
      matrix.precondition(b.data(), pb.data());
      TAUTLINE_CHECK_RELATIVE(dot(a, pb), dot(b, pa), 1e-10);
      TAUTLINE_CHECK(dot(a, pa) > 0 && dot(b, pb) > 0);
      // A point by itself: its block times its column of the preconditioner's inverse is a unit
      // vector, where the block is definite.
      const HessianMatrix whole = hessianOf(sum, mesh);
      const std::size_t n = static_cast<std::size_t>(matrix.blockSize());
      const std::size_t middle = n * (data.numberOfPoints() / 2);
      Vector unit(a.size(), 0.0), column(a.size()), back(a.size());
      unit[middle] = 1;
      matrix.precondition(unit.data(), column.data());
      Vector own(a.size(), 0.0);
      std::copy_n(column.begin() + middle, n, own.begin() + middle);
      whole.times(own.data(), back.data());
      for (std::size_t c = 0; c < n && pattern == HessianMatrix::Pattern::Diagonal; ++c)
      {
        TAUTLINE_CHECK_NEAR(3 * back[middle + c], c == 0 ? 1.0 : 0.0, 1e-9);
      }
    }
  }
}

/// A point that slides along a line: the matrix is P A P there.
TAUTLINE_PART(testRestriction)
{
  const MeshData data = movedBlock(CellType::Hexahedron, 3, 0.1);
  const Mesh mesh(data.view());
  const ObjectiveSum sum(mesh, make(Metric::InverseMeanRatio));
  const HessianMatrix whole = hessianOf(sum, mesh);
  HessianMatrix restricted = hessianOf(sum, mesh);
  const Index row = data.numberOfPoints() / 2;
  const Vec3 line = { 2.0 / 3, -1.0 / 3, 2.0 / 3 };
  double projector[9];
  for (int i = 0; i < 9; ++i)
  {
    projector[i] = line[i / 3] * line[i % 3];
  }
  restricted.restrict(row, projector);
  TAUTLINE_CHECK(isSymmetric(restricted));
  const auto projected = [&](Vector v)
  {
    double* own = v.data() + 3 * row;
    const double along = own[0] * line[0] + own[1] * line[1] + own[2] * line[2];
    for (int c = 0; c < 3; ++c)
    {
      own[c] = along * line[c];
    }
    return v;
  };
  const Vector d = projected(randomVector(data.points.size(), false, 49));
  const Vector expected = projected(times(whole, mesh, d)), got = times(restricted, mesh, d);
  TAUTLINE_EACH(
    std::size_t, i, d.size(), TAUTLINE_CHECK_NEAR(got[i], expected[i], 1e-11 * norm(expected)));
}

/// The sum of squared inverse mean ratios over the inner points of a block.
struct Smoothing : SmoothFunction
{
  MeshData data;
  Mesh mesh;
  ObjectiveSum sum;
  std::vector<Index> free;
  std::unique_ptr<HessianMatrix> hessian;
  Vector gradient;

  explicit Smoothing(const MeshData& given)
    : data(given)
    , mesh(data.view())
    , sum(mesh, make(Metric::InverseMeanRatio))
    , gradient(data.points.size())
  {
    const Boundary boundary = this->mesh.boundary();
    std::vector<std::int32_t> rows(this->data.numberOfPoints(), -1);
    for (Index i = 0; i < this->data.numberOfPoints(); ++i)
    {
      if (!boundary.isBoundaryPoint[i])
      {
        rows[i] = static_cast<std::int32_t>(this->free.size());
        this->free.push_back(i);
      }
    }
    this->hessian = std::make_unique<HessianMatrix>(
      this->mesh, rows, static_cast<Index>(this->free.size()), HessianMatrix::Pattern::Full, 1);
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
    this->hessian->clear();
    this->hessian->add(this->sum, 1);
    this->hessian->factorize();
  }
  bool hessianTimes(const double* d, double* result) override
  {
    this->hessian->times(d, result);
    return true;
  }
  bool precondition(const double* r, double* z) override
  {
    this->hessian->precondition(r, z);
    return true;
  }
};

/// Newton and preconditioned L-BFGS reach the same mesh, in few iterations or few evaluations.
TAUTLINE_PART(testNewton)
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
    TAUTLINE_LET(MinimizeOptions, options, method = method, gradientNorm = 1e-6,
      maximumIterations = 300, threads = 1);
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
