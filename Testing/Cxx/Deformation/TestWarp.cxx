// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP and its anisotropic forms: the propositions of section 4.9.1, the coefficients, the
// limits in which they vanish, and what is kept for the next boundary position.

#include "../../Benchmark/KuhnMesh.h"
#include "Registry.h"
#include "Warping.h"
#include "tautline/Elliptic/FiniteElements.h"

using namespace tautline;

namespace
{
constexpr WarpMethod allMethods[] = { WarpMethod::Hybrid, WarpMethod::Femwarp,
  WarpMethod::AnisotropicFemwarp, WarpMethod::SmallStepFemwarp, WarpMethod::FemwarpUntangling,
  WarpMethod::IterativeStiffening, WarpMethod::JacobianStiffening, WarpMethod::Biharmonic,
  WarpMethod::InverseDistance, WarpMethod::RadialBasis, WarpMethod::WeightedLaplacian,
  WarpMethod::InverseDistanceRotations, WarpMethod::Automatic };

constexpr CellType elementTypes[] = { CellType::Triangle, CellType::Quadrilateral,
  CellType::Tetrahedron, CellType::Hexahedron };

std::vector<double> spaced(Index n, double length, double growth)
{
  std::vector<double> at = { 0 };
  double step = 1;
  for (Index i = 0; i < n; ++i, step *= growth)
  {
    at.push_back(at.back() + step);
  }
  const double total = at.back();
  for (double& v : at)
  {
    v *= length / total;
  }
  return at;
}

/// Right triangles as in (4.12), or quadrilaterals: columns at x, rows at y.
MeshData rectangle(CellType type, const std::vector<double>& x, const std::vector<double>& y)
{
  MeshData data = blockMesh(type, Index(x.size()) - 1, Index(y.size()) - 1, 0);
  data.transform(TAUTLINE_PLACE(x[Index(p[0])], y[Index(p[1])], 0));
  return data;
}

//------------------------------------------------------------------------------
/// alpha = 0, beta = 1: columns are independent (1), and keep their relative spacing (2, 3).
TAUTLINE_PART(testPropositions)
{
  for (const double growth : { 1.0, 1.3 })
  {
    const MeshData data =
      rectangle(CellType::Triangle, spaced(16, 2.0, 1.0), spaced(10, 1.0, growth));
    const auto motion =
      TAUTLINE_PLACE(0, p[1] > 0.999 ? -0.85 * std::pow(std::sin(1.5 * p[0]), 2) : 0.0, 0);
    WarpOptions options = manual(0, 1);
    const WarpResult result = warped(data, motion, options);
    double worst = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i), top = { p[0], 1, 0 };
      const double gamma = 1 + motion(top)[1]; // of Proposition 3
      if (p[0] > 0 && p[0] < 2)
      {
        worst = std::max({ worst, std::abs(result.points[3 * i + 1] - gamma * p[1]),
          std::abs(result.points[3 * i] - p[0]) });
      }
    }
    TAUTLINE_CHECK_NEAR(worst, 0, 1e-12);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK_EQUAL(result.decoupled, 0);
    TAUTLINE_CHECK_EQUAL(result.regularization, 0.0);

    // The sums of the displacements find these coefficients, to the last bit.
    options.coefficients = WarpCoefficients::DisplacementSums;
    const WarpResult same = warped(data, motion, options);
    TAUTLINE_CHECK((same.tensor == SymmetricTensor{ 0, 1, 0, 0, 0, 0 }));
    TAUTLINE_CHECK(same.points == result.points);
    // FEMWARP inverts elements here, Figure 4.20.
    TAUTLINE_CHECK(warped(data, motion, withMethod(WarpMethod::Femwarp)).invertedAfter > 0);
  }

  // One boundary point moves, and nothing but its column follows; along x, nothing but its row.
  for (int axis = 0; axis < 2; ++axis)
  {
    const MeshData data = rectangle(CellType::Triangle, spaced(12, 1.0, 1.1), spaced(12, 1.0, 1.2));
    const Vec3 place = data.point(axis == 0 ? 5 * 13 + 12 : 12 * 13 + 5);
    const auto motion = [&](const Vec3& p)
    {
      Vec3 d = { 0, 0, 0 };
      d[axis] = norm(p - place) == 0 ? 0.01 : 0.0;
      return d;
    };
    const WarpResult result = warped(data, motion, axis == 0 ? manual(1, 0) : manual(0, 1));
    double others = 0, own = 1;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i);
      const double moved = std::abs(result.points[3 * i + axis] - p[axis]);
      const bool same = p[1 - axis] == place[1 - axis];
      others = same ? others : std::max(others, moved);
      own = same && p[axis] > 0 ? std::min(own, std::abs(moved - 0.01 * p[axis])) : own;
    }
    TAUTLINE_CHECK_NEAR(others, 0, 1e-14);
    TAUTLINE_CHECK_NEAR(own, 0, 1e-14);
  }

  // In space: cubes cut into six tetrahedra round a diagonal, each of which has one edge along z.
  constexpr Index n = 6;
  const std::vector<double> z = spaced(n, 1.0, 1.4);
  MeshData cubes = cutIntoTetrahedra(blockMesh(CellType::Hexahedron, n, n, n), n);
  cubes.transform(TAUTLINE_PLACE(p[0] / n, p[1] / n, z[Index(p[2])]));
  const auto top = TAUTLINE_PLACE(0, 0, p[2] > 0.999 ? -2.4 * p[0] * (1 - p[0]) * p[1] : 0.0);
  const WarpResult result = warped(cubes, top, manual(0, 0, 1));
  TAUTLINE_CHECK_EQUAL(result.decoupled, 0);
  TAUTLINE_CHECK_EQUAL(result.regularization, 0.0);
  for (Index i = 0; i < cubes.numberOfPoints(); ++i)
  {
    const Vec3 p = cubes.point(i);
    const bool boundary = p[0] == 0 || p[1] == 0 || p[0] == 1 || p[1] == 1;
    const double gamma = 1 + top({ p[0], p[1], 1 })[2];
    TAUTLINE_CHECK_NEAR(result.points[3 * i + 2],
      (boundary ? 1.0 : gamma) * p[2] + (boundary && p[2] > 0.999 ? gamma - 1 : 0.0), 1e-12);
  }
}

//------------------------------------------------------------------------------
/// Proposition 4 for every cell type, method and choice of coefficients, for all scales.
TAUTLINE_PART(testAffine)
{
  const Columns linear = { Vec3{ 0.1, -0.3, 0.2 }, Vec3{ 0.4, 0.2, -0.1 }, Vec3{ -0.2, 0.3, 0.3 } };
  for (const CellType type : elementTypes)
  {
    const bool flat = topology(type).dimension == 2;
    for (const double scale : { 1.0, 1e-8, 1e8 })
    {
      MeshData data = perturbedBlock(type, 4, 0.15);
      data.transform([&](const Vec3& p) { return scale * (p + Vec3{ 3, -5, flat ? 0.0 : 7 }); });
      const auto motion = [&](const Vec3& p)
      {
        Vec3 d = linear * p + scale * Vec3{ 2, 1, 4 };
        d[2] = flat ? 0.0 : d[2];
        return d;
      };
      const auto check = [&](const WarpOptions& options, bool silent = true)
      {
        const WarpResult result = warped(data, motion, options);
        double worst = 0;
        for (Index i = 0; i < data.numberOfPoints(); ++i)
        {
          const Vec3 p = data.point(i), q = p + motion(p);
          for (int c = 0; c < 3; ++c)
          {
            worst = std::max(worst, std::abs(result.points[3 * i + c] - q[c]));
          }
        }
        TAUTLINE_CHECK(worst <= 1e-12 * scale);
        TAUTLINE_CHECK_EQUAL(result.amount, 1.0);
        TAUTLINE_CHECK_EQUAL(result.message.empty(), silent);
      };
      std::vector<double> tensors;
      Random random(5);
      for (Index c = 0; c < data.numberOfCells(); ++c)
      {
        const Vec3 v = random.vector(-1, 1); // v v^T: singular
        tensors.insert(tensors.end(),
          { v[0] * v[0], v[1] * v[1], v[2] * v[2], v[0] * v[1], v[1] * v[2], v[0] * v[2] });
      }
      for (const WarpCoefficients choice :
        { WarpCoefficients::DisplacementSums, WarpCoefficients::PrincipalDirections,
          WarpCoefficients::Manual, WarpCoefficients::PerCell, WarpCoefficients::LocalGradients })
      {
        const Context context(std::string(topology(type).name) + " coefficients " +
          std::to_string(int(choice)) + " scale " + std::to_string(scale));
        WarpOptions options = TAUTLINE_CHANGED(manual(0, 1, 0), coefficients = choice,
          tensors = tensors.data(), tolerance = 0.5, automaticSolver = scale != 1);
        check(options);
      }
      for (const WarpMethod method : allMethods)
      {
        // Stiffening makes a body of many materials, which do not follow affine motions exactly;
        // walls that turn carry no stretch.
        if (method != WarpMethod::JacobianStiffening && method != WarpMethod::Hybrid &&
          method != WarpMethod::InverseDistanceRotations)
        {
          const Context context(
            std::string(topology(type).name) + " method " + std::to_string(int(method)));
          check(withMethod(method), method != WarpMethod::Automatic);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// (4.10): the rows of the interior, applied to the new points.
TAUTLINE_PART(testEquation)
{
  for (const CellType type : elementTypes)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = perturbedBlock(type, 6, 0.2);
    const Mesh mesh(data.view());
    const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
    const auto motion =
      TAUTLINE_PLACE(std::sin(p[1]), 0.3 * p[0] * p[1], flat ? 0.0 : std::cos(p[0] + p[2]));
    for (const bool direct : { true, false })
    {
      WarpOptions options =
        TAUTLINE_CHANGED(manual(2, 0.5, 1), tensor[3] = 0.4, automaticSolver = false,
          solver.method = direct ? KrylovMethod::Direct : KrylovMethod::ConjugateGradient,
          tolerance = 1e-12);
      const WarpResult result = warped(data, motion, options);
      TAUTLINE_LET(DiffusionOperator, pde, tensor = options.tensor);
      const SparseMatrix matrix = stiffnessMatrix(mesh, pde);
      for (int c = 0; c < 3; ++c)
      {
        std::vector<double> x(matrix.size), y(matrix.size);
        for (Index i = 0; i < matrix.size; ++i)
        {
          x[i] = result.points[3 * i + c];
        }
        matrix.multiply(x.data(), y.data());
        double worst = 0;
        for (Index i = 0; i < matrix.size; ++i)
        {
          worst = boundary[i] ? worst : std::max(worst, std::abs(y[i]));
        }
        TAUTLINE_CHECK(worst <= 1e-10);
      }
      TAUTLINE_CHECK(result.tensor == options.tensor);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testCoefficients)
{
  // Absolute sums, the largest 1: displacements that cancel count.
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 4, 0.2);
  WarpOptions options = withMethod(WarpMethod::AnisotropicFemwarp);
  const auto motion = TAUTLINE_PLACE(p[0] == 4 ? 0.6
      : p[0] == 0                              ? -0.6
                                               : 0.0,
    p[0] == 4     ? 0.1
      : p[0] == 0 ? -0.1
                  : 0.0,
    0);
  const SymmetricTensor t = warped(data, motion, options).tensor;
  TAUTLINE_CHECK_NEAR(t[0], 1, 0);
  TAUTLINE_CHECK_NEAR(t[1], 1.0 / 6, 1e-14);
  TAUTLINE_CHECK_EQUAL(t[2], 0.0);
  // Along the diagonal of the motion, and nothing across.
  options.coefficients = WarpCoefficients::PrincipalDirections;
  const SymmetricTensor p = warped(data, motion, options).tensor;
  TAUTLINE_CHECK_NEAR(p[0], 36.0 / 37, 1e-14);
  TAUTLINE_CHECK_NEAR(p[1], 1.0 / 37, 1e-14);
  TAUTLINE_CHECK_NEAR(p[3], 6.0 / 37, 1e-14);
  TAUTLINE_CHECK_NEAR(std::abs(p[2]) + std::abs(p[4]) + std::abs(p[5]), 0, 1e-14);

  // Motions along the axes agree with the sums, to rounding.
  const auto axes = [](const Vec3& q)
  {
    return Vec3{ q[0] == 4 ? 0.3 : 0.0, q[0] == 0 ? 0.2 : 0.0,
      q[2] == 0 ? 0.1 * (q[0] > 0 && q[0] < 4) : 0.0 };
  };
  const SymmetricTensor sums = warped(data, axes,
    [&] { return TAUTLINE_CHANGED(options, coefficients = WarpCoefficients::DisplacementSums); }())
                                 .tensor;
  const SymmetricTensor directions = warped(data, axes, options).tensor;
  TAUTLINE_EACH(int, k, 6, TAUTLINE_CHECK_NEAR(directions[k], sums[k], 1e-14));

  // A mesh turned with its motion gives the result turned: also where directions are not unique.
  const Columns turn = rotation({ 1, 2, -1 }, 0.7);
  const Field motions[] = { motion, axes,
    [](const Vec3& q) {
      return Vec3{ 0, 0, q[2] == 4 ? 0.3 * std::sin(q[0]) : 0.0 };
    },
    [](const Vec3& q) {
      return q[0] == 4 ? Vec3{ 0, 0.1 * (q[2] - 2), -0.1 * (q[1] - 2) } : Vec3{ 0, 0, 0 };
    } };
  for (const Field& field : motions)
  {
    MeshData turned = data;
    turned.transform([&](const Vec3& q) { return turn * q; });
    std::vector<double> d = displacements(data, field), moved(d.size());
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 v = turn * Vec3{ d[3 * i], d[3 * i + 1], d[3 * i + 2] };
      std::copy(v.begin(), v.end(), &moved[3 * i]);
    }
    const Mesh mesh(data.view()), turnedMesh(turned.view());
    MeshData straight = data;
    straight.points = Warper(mesh, options).warp(d.data()).points;
    straight.transform([&](const Vec3& q) { return turn * q; });
    const WarpResult result = Warper(turnedMesh, options).warp(moved.data());
    TAUTLINE_CHECK_NEAR(distance(result.points, straight.points), 0, 1e-8);
  }
}

//------------------------------------------------------------------------------
/// The same tensor in every cell is one tensor; a stiff region keeps its shape.
TAUTLINE_PART(testPerCell)
{
  const MeshData data = boxInBox(CellType::Triangle, 16, 4);
  const Field motion = [](const Vec3& p) {
    return onInnerBox(p, true) ? Vec3{ 0.1, 0.06, 0 } : Vec3{ 0, 0, 0 };
  };
  WarpOptions one = TAUTLINE_CHANGED(manual(2, 0.5), tensor[3] = 0.3);
  std::vector<double> tensors;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    tensors.insert(tensors.end(), one.tensor.begin(), one.tensor.end());
  }
  WarpOptions each = one;
  TAUTLINE_SET(each, coefficients = WarpCoefficients::PerCell, tensors = tensors.data());
  TAUTLINE_CHECK_NEAR(
    distance(warped(data, motion, one).points, warped(data, motion, each).points), 0, 1e-12);

  const auto distortion = [&](double stiffness)
  {
    std::vector<char> inside(data.numberOfCells());
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      Vec3 center = sumOf<Vec3>({ 0, 0, 0 }, 3,
        [&](Index k) { return (1.0 / 3) * data.point(data.connectivity[3 * c + k]); });
      inside[c] = std::abs(center[0] - 0.5) < 0.25 && std::abs(center[1] - 0.5) < 0.25;
      const double value = inside[c] ? stiffness : 1.0;
      const double tensor[6] = { value, value, value, 0, 0, 0 };
      std::copy_n(tensor, 6, &tensors[6 * c]);
    }
    const WarpResult result = warped(data, motion, each);
    const std::vector<double> q = shapeSimilarity(Mesh(data.view()), result.points.data());
    return sumOf<double>(0, data.numberOfCells(), [&](Index c) { return inside[c] ? q[c] : 0.0; });
  };
  const double same = distortion(1), stiff = distortion(100);
  TAUTLINE_CHECK(stiff < 0.01 * same);
}

//------------------------------------------------------------------------------
/// Points that no prescribed one determines.
TAUTLINE_PART(testDecoupled)
{
  // Only columns up to the fifth have prescribed points; beta alone couples along columns.
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const MeshData data = rectangle(type, spaced(10, 1.0, 1.0), spaced(6, 1.0, 1.2));
    std::vector<unsigned char> prescribed(data.numberOfPoints(), 0);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i);
      prescribed[i] = (p[1] == 0 || p[1] > 0.999) && p[0] < 0.55;
    }
    WarpOptions options = TAUTLINE_CHANGED(manual(0, 1), prescribed = prescribed.data());
    const auto motion = TAUTLINE_PLACE(0, p[1] > 0.5 ? -0.4 * p[0] * p[0] : 0.0, 0);
    const WarpResult result = warped(data, motion, options);
    // Q1 couples columns with each other, and no column is alone.
    TAUTLINE_CHECK_EQUAL(result.decoupled, type == CellType::Triangle ? 5 * 7 : 0);
    double worst = 0, most = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i);
      const double y = p[1] * (1 - 0.4 * p[0] * p[0]);
      worst = p[0] < 0.55 ? std::max(worst, std::abs(result.points[3 * i + 1] - y)) : worst;
      most = std::max(most, std::abs(result.points[3 * i + 1] - p[1]));
    }
    if (type == CellType::Triangle)
    {
      TAUTLINE_CHECK_NEAR(
        worst, 0, 1e-8); // Propositions 1 and 3, where there are prescribed points
      TAUTLINE_CHECK(contains(result.message, wording("no-prescribed-point-determines-35-points")));
    }
    TAUTLINE_CHECK(most < 0.4);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  }

  // Unstructured meshes, a boundary that is prescribed in part or wholly, every degenerate limit.
  for (const CellType type : elementTypes)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = boxInBox(type, flat ? 12 : 6, 2);
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    for (int what = 0; what < 3; ++what)
    {
      std::vector<unsigned char> prescribed(data.numberOfPoints(), 0);
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        const Vec3 p = data.point(i);
        prescribed[i] = boundary[i] &&
          (what == 0 || (what == 1 ? onInnerBox(p, flat) : onInnerBox(p, flat) && p[0] < 0.5));
      }
      for (int axis = 0; axis < (flat ? 2 : 3); ++axis)
      {
        const Context context(std::string(topology(type).name) + " prescribed " +
          std::to_string(what) + " axis " + std::to_string(axis));
        WarpOptions options = manual(axis == 0, axis == 1, axis == 2);
        options.prescribed = prescribed.data();
        const auto motion = [&](const Vec3& p)
        {
          Vec3 d = { 0, 0, 0 };
          d[axis] = onInnerBox(p, flat) ? 0.1 * std::sin(9 * p[0] + 7 * p[1] + p[2]) : 0.0;
          return d;
        };
        const WarpResult result = warped(data, motion, options);
        TAUTLINE_CHECK(distance(result.points, data.points) < 0.5);
        TAUTLINE_CHECK(result.regularization < 1);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Former solutions help; they do not change the result.
TAUTLINE_PART(testReuse)
{
  for (const bool direct : { true, false })
  {
    const MeshData data = boxInBox(CellType::Tetrahedron, 8, 3);
    const Mesh mesh(data.view());
    WarpOptions options = TAUTLINE_CHANGED(withMethod(WarpMethod::Femwarp), automaticSolver = false,
      solver.method = direct ? KrylovMethod::Direct : KrylovMethod::ConjugateGradient,
      tolerance = 1e-11);
    Warper warper(mesh, options);
    const auto shifted = [](double degrees)
    {
      return [=](const Vec3& p)
      {
        return turnedBox(degrees, false)(p) +
          (onInnerBox(p, false) ? Vec3{ 0.02, 0.01, -0.03 } : Vec3{ 0, 0, 0 });
      };
    };
    const auto wave = [](const Vec3& p)
    {
      return onInnerBox(p, false)
        ? 0.03 * Vec3{ std::sin(9 * p[1]), std::cos(8 * p[2] + p[0]), p[0] * p[1] }
        : Vec3{ 0, 0, 0 };
    };
    const std::pair<Field, int> positions[] = { { turnedBox(10, false), 2 },
      { turnedBox(35, false), 0 }, { shifted(20), 1 }, { shifted(-50), 0 }, { wave, 3 },
      { shifted(70), 0 } };
    for (const auto& [motion, solves] : positions)
    {
      const WarpResult kept = warper.warp(displacements(data, motion).data());
      const WarpResult fresh = Warper(mesh, options).warp(displacements(data, motion).data());
      TAUTLINE_CHECK_NEAR(distance(kept.points, fresh.points), 0, 1e-9);
      if (direct)
      {
        TAUTLINE_CHECK_EQUAL(kept.history[0].iterations, solves); // one for each solve
      }
      TAUTLINE_CHECK_EQUAL(kept.history[0].iterations == 0, solves == 0);
    }
    // More positions than are kept.
    for (int k = 0; k < 20; ++k)
    {
      const auto motion = [k](const Vec3& p) {
        return onInnerBox(p, false) ? Vec3{ 0.03 * std::sin((3 + k) * p[1]), 0, 0 }
                                    : Vec3{ 0, 0, 0 };
      };
      const WarpResult kept = warper.warp(displacements(data, motion).data());
      if (k == 19)
      {
        const WarpResult fresh = Warper(mesh, options).warp(displacements(data, motion).data());
        TAUTLINE_CHECK_NEAR(distance(kept.points, fresh.points), 0, 1e-9);
      }
    }
  }
}
}
