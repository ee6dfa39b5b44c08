// SPDX-License-Identifier: BSD-3-Clause
// Stiffness matrices and load vectors: known small matrices, patch test, null spaces, invariances,
// symmetry, threads, degenerate and inverted elements, and whatever is rejected.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Elliptic/FiniteElements.h"

using namespace tautline;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

std::vector<double> times(const SparseMatrix& a, const std::vector<double>& x)
{
  std::vector<double> y(a.size);
  a.multiply(x.data(), y.data());
  return y;
}

double largest(const std::vector<double>& values)
{
  return largestOf<double>(0, values, [&](double v) { return std::abs(v); });
}

double totalSize(const MeshData& data)
{
  return sumOf<double>(0, valuesOf(data, Metric::Size), [&](double v) { return v; });
}

void checkMatrix(const SparseMatrix& a, const std::vector<double>& expected, double tolerance)
{
  TAUTLINE_CHECK_EQUAL(a.size * a.size, static_cast<Index>(expected.size()));
  TAUTLINE_EACH(std::size_t, i, expected.size(),
    TAUTLINE_CHECK_NEAR(a.at(i / a.size, i % a.size), expected[i], tolerance));
}

void checkSameMatrix(const SparseMatrix& a, const SparseMatrix& b, double scale, double tolerance)
{
  TAUTLINE_CHECK(a.columns == b.columns && a.offsets == b.offsets);
  double worst = largestOf<double>(
    0, a.values.size(), [&](std::size_t k) { return std::abs(scale * a.values[k] - b.values[k]); });
  TAUTLINE_CHECK(worst <= tolerance * largest(b.values));
}

bool exactlySymmetric(SparseMatrix a)
{
  const std::vector<double> before = a.values;
  return symmetrize(a) == 0.0 && a.values == before;
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testSmallMatrices)
{
  DiffusionOperator pde;
  // Dissertation (4.12): the right triangle with unit legs, coefficients alpha and beta.
  const double alpha = 3, beta = 5;
  pde.tensor = { alpha, beta, 7, 0, 0, 0 };
  const MeshData triangle =
    singleCell(CellType::Triangle, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  const std::vector<double> expected = { (alpha + beta) / 2, -alpha / 2, -beta / 2, -alpha / 2,
    alpha / 2, 0, -beta / 2, 0, beta / 2 };
  checkMatrix(stiffnessMatrix(Mesh(triangle.view()), pde), expected, 1e-14);

  // The same by the closed form for C = I, and with the mass matrix of (2.3): a A / 12 (1 + delta).
  pde = {};
  pde.reaction = 24;
  checkMatrix(stiffnessMatrix(Mesh(triangle.view()), pde),
    { 1 + 2, -0.5 + 1, -0.5 + 1, -0.5 + 1, 0.5 + 2, 1, -0.5 + 1, 1, 0.5 + 2 }, 1e-14);

  // The corner tetrahedron of the unit cube: gradients (-1, -1, -1), e1, e2, e3, volume 1/6.
  pde = {};
  pde.tensor = { 6, 12, 18, 0, 0, 0 };
  const MeshData corner =
    singleCell(CellType::Tetrahedron, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } });
  checkMatrix(stiffnessMatrix(Mesh(corner.view()), pde),
    { 6, -1, -2, -3, -1, 1, 0, 0, -2, 0, 2, 0, -3, 0, 0, 3 }, 1e-14);

  // The unit square: 2/3 on the diagonal, -1/6 beside, -1/3 across. The unit cube: 1/3, 0, -1/12,
  // -1/12.
  pde = {};
  const MeshData square = singleCell(CellType::Quadrilateral, idealCell(CellType::Quadrilateral));
  std::vector<double> q;
  for (int i = 0; i < 16; ++i)
  {
    const int apart = (i / 4 - i % 4 + 4) % 4;
    q.push_back(apart == 0 ? 2.0 / 3 : apart == 2 ? -1.0 / 3 : -1.0 / 6);
  }
  checkMatrix(stiffnessMatrix(Mesh(square.view()), pde), q, 1e-14);
  const std::vector<Vec3> cube = idealCell(CellType::Hexahedron);
  std::vector<double> h;
  for (int i = 0; i < 64; ++i)
  {
    const Vec3 d = cube[i / 8] - cube[i % 8];
    const long apart = std::lround(dot(d, d));
    h.push_back(apart == 0 ? 1.0 / 3 : apart == 1 ? 0.0 : -1.0 / 12);
  }
  checkMatrix(stiffnessMatrix(Mesh(singleCell(CellType::Hexahedron, cube).view()), pde), h, 1e-14);

  // Elasticity of the right triangle, plane strain: E = 1, nu = 1/4 give lambda = mu = 2/5; see any
  // textbook.
  TAUTLINE_LET(ElasticOperator, elastic, poissonRatio = 0.25);
  const double m = 0.4 / 2; // times the area
  checkMatrix(stiffnessMatrix(Mesh(triangle.view()), elastic),
    { 4 * m, 2 * m, -3 * m, -m, -m, -m, //
      2 * m, 4 * m, -m, -m, -m, -3 * m, //
      -3 * m, -m, 3 * m, 0, 0, m,       //
      -m, -m, 0, m, m, 0,               //
      -m, -m, 0, m, m, 0,               //
      -m, -3 * m, m, 0, 0, 3 * m },
    1e-14);
}

//------------------------------------------------------------------------------
/// Meshes of one type each, of all types.
std::vector<MeshData> sampleMeshes()
{
  return collect<MeshData>(allTypes,
    [&](CellType type)
    { return shuffled(movedBlock(type, topology(type).dimension == 2 ? 6 : 4, 0.15), 3); });
}

/// Wedges, hexahedra and tetrahedra need not fit for what is tested of them.
MeshData mixedMesh()
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  Random random(5);
  for (CellType type : { CellType::Tetrahedron, CellType::Wedge, CellType::Pyramid })
  {
    data.addCell(type, validCell(type, 0.2, 0.2, random));
  }
  return shuffled(data, 9);
}

TAUTLINE_PART(testLinearFields)
{
  const Vec3 slope = { 2, -3, 0.5 };
  for (const MeshData& data : sampleMeshes())
  {
    const Mesh mesh(data.view());
    const bool planar = mesh.dimension() == Dimension::Planar;
    const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
    DiffusionOperator pde;
    for (const SymmetricTensor& tensor :
      { IdentityTensor, SymmetricTensor{ 2, 1, 3, 0.5, 0.2, -0.3 } })
    {
      pde.tensor = tensor;
      const SparseMatrix a = stiffnessMatrix(mesh, pde);
      TAUTLINE_CHECK(exactlySymmetric(a));
      // Constants are in the null space; linear functions pass the patch test.
      TAUTLINE_CHECK(largest(times(a, std::vector<double>(a.size, 1.0))) < 1e-12);
      auto u = collect<double>(a.size, [&](Index i) { return dot(slope, data.point(i)); });
      const std::vector<double> au = times(a, u);
      double energy = 0;
      Index inner = 0;
      for (Index i = 0; i < a.size; ++i)
      {
        energy += u[i] * au[i];
        inner += !boundary[i];
        TAUTLINE_CHECK(boundary[i] || std::abs(au[i]) < 1e-11);
      }
      TAUTLINE_CHECK(inner > 20);
      const Vec3 g = planar ? Vec3{ slope[0], slope[1], 0 } : slope;
      const Vec3 cg = { tensor[0] * g[0] + tensor[3] * g[1] + tensor[5] * g[2],
        tensor[3] * g[0] + tensor[1] * g[1] + tensor[4] * g[2],
        tensor[5] * g[0] + tensor[4] * g[1] + tensor[2] * g[2] };
      TAUTLINE_CHECK_RELATIVE(energy, dot(g, cg) * totalSize(data), 1e-12);
    }

    // The same of elasticity: rigid body modes, then uniform strain.
    for (PlaneState state : { PlaneState::Strain, PlaneState::Stress })
    {
      TAUTLINE_LET(ElasticOperator, elastic, plane = state, youngsModulus = 2);
      const SparseMatrix a = stiffnessMatrix(mesh, elastic);
      TAUTLINE_CHECK(exactlySymmetric(a));
      const int d = elasticComponents(mesh);
      TAUTLINE_CHECK_EQUAL(d, planar ? 2 : 3);
      std::vector<double> u(a.size);
      const auto set = [&](const auto& motion)
      {
        for (Index i = 0; i < data.numberOfPoints(); ++i)
        {
          const Vec3 v = motion(data.point(i));
          std::copy_n(v.begin(), d, u.begin() + d * i);
        }
      };
      set([](const Vec3&) { return Vec3{ 1, -2, 3 }; });
      TAUTLINE_CHECK(largest(times(a, u)) < 1e-12);
      const Vec3 axis = planar ? Vec3{ 0, 0, 1 } : Vec3{ 1, 2, -1 };
      set([&](const Vec3& p) { return cross(axis, p); });
      TAUTLINE_CHECK(largest(times(a, u)) < 1e-11);
      set(TAUTLINE_PLACE(1e-2 * p[0], -2e-2 * p[1], 3e-2 * p[2]));
      const std::vector<double> au = times(a, u);
      double energy = 0;
      for (Index i = 0; i < a.size; ++i)
      {
        energy += u[i] * au[i];
        TAUTLINE_CHECK(boundary[i / d] || std::abs(au[i]) < 1e-12);
      }
      // Twice the energy density: lambda tr(eps)^2 + 2 mu eps : eps; in plane stress E / (1 - nu^2)
      // (...).
      const double nu = 0.3, mu = 2 / (2 * (1 + nu)), lambda = 2 * nu / ((1 + nu) * (1 - 2 * nu));
      const double x = 1e-2, y = -2e-2, z = planar ? 0 : 3e-2;
      const double density = planar && state == PlaneState::Stress
        ? 2 / (1 - nu * nu) * (x * x + y * y + 2 * nu * x * y)
        : lambda * (x + y + z) * (x + y + z) + 2 * mu * (x * x + y * y + z * z);
      TAUTLINE_CHECK_RELATIVE(energy, density * totalSize(data), 1e-11);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testMassAndLoad)
{
  for (const MeshData& data : sampleMeshes())
  {
    const Mesh mesh(data.view());
    TAUTLINE_LET(DiffusionOperator, pde, reaction = 3);
    const std::vector<double> ones(data.numberOfPoints(), 1.0);
    const std::vector<double> mass = times(stiffnessMatrix(mesh, pde), ones);
    const std::vector<double> load = loadVector(mesh, ones.data(), 1);
    double massSum = 0, loadSum = 0;
    for (std::size_t i = 0; i < ones.size(); ++i)
    {
      massSum += mass[i];
      loadSum += load[i];
      TAUTLINE_CHECK_NEAR(mass[i], 3 * load[i], 1e-11);
    }
    TAUTLINE_CHECK_RELATIVE(massSum, 3 * totalSize(data), 1e-12);
    TAUTLINE_CHECK_RELATIVE(loadSum, totalSize(data), 1e-12);
    // A load is the mass matrix times f; several components go by themselves.
    DiffusionOperator zero;
    zero.tensor = { 0, 0, 0, 0, 0, 0 };
    zero.reaction = 1;
    std::vector<double> f(2 * ones.size()), first(ones.size());
    Random random(11);
    for (std::size_t i = 0; i < f.size(); ++i)
    {
      f[i] = random.uniform(-1, 1);
      first[i / 2] = i % 2 == 0 ? f[i] : first[i / 2];
    }
    const std::vector<double> both = loadVector(mesh, f.data(), 2);
    const std::vector<double> expected = times(stiffnessMatrix(mesh, zero), first);
    TAUTLINE_EACH(
      std::size_t, i, ones.size(), TAUTLINE_CHECK_NEAR(both[2 * i], expected[i], 1e-13));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testInvariance)
{
  Random random(21);
  const Columns turn = randomRotation(random);
  const SymmetricTensor c = { 2, 1, 3, 0.5, 0.2, -0.3 };
  // turn c turn^T
  const Columns columns = { Vec3{ c[0], c[3], c[5] }, Vec3{ c[3], c[1], c[4] },
    Vec3{ c[5], c[4], c[2] } };
  const auto turned = [&](int i, int j)
  {
    const Vec3 row = { turn[0][j], turn[1][j], turn[2][j] };
    return (turn * (columns * row))[i];
  };
  DiffusionOperator before, after;
  before.tensor = c;
  after.tensor = { turned(0, 0), turned(1, 1), turned(2, 2), turned(0, 1), turned(1, 2),
    turned(0, 2) };
  for (const MeshData& data : sampleMeshes())
  {
    const Mesh mesh(data.view());
    const bool planar = mesh.dimension() == Dimension::Planar;
    const SparseMatrix poisson = stiffnessMatrix(mesh, DiffusionOperator());
    const SparseMatrix anisotropic = stiffnessMatrix(mesh, before);
    const SparseMatrix elastic = stiffnessMatrix(mesh, ElasticOperator());
    const int d = planar ? 2 : 3;

    MeshData other = data;
    other.transform([&](const Vec3& p) { return turn * p; });
    const Mesh oblique(other.view());
    TAUTLINE_CHECK(oblique.dimension() == mesh.dimension());
    checkSameMatrix(poisson, stiffnessMatrix(oblique, DiffusionOperator()), 1, 1e-12);
    checkSameMatrix(anisotropic, stiffnessMatrix(oblique, after), 1, 1e-12);
    // Elasticity: the form u^T A u of a displacement that turns with the mesh, by its components
    // there.
    const SparseMatrix there = stiffnessMatrix(oblique, ElasticOperator());
    std::vector<double> u(elastic.size), v(elastic.size);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      Vec3 motion = random.vector(-1, 1);
      motion[2] = planar ? 0 : motion[2];
      const Vec3 moved = turn * motion;
      for (int k = 0; k < d; ++k)
      {
        u[d * i + k] = motion[k];
        v[d * i + k] = planar ? dot(moved, oblique.frame()[k]) : moved[k];
      }
    }
    double here = 0, other2 = 0;
    const std::vector<double> au = times(elastic, u), av = times(there, v);
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      here += u[i] * au[i];
      other2 += v[i] * av[i];
    }
    TAUTLINE_CHECK_RELATIVE(here, other2, 1e-11);

    // Size: stiffness grows by the power d - 2, mass by d.
    for (double scale : { 1e-8, 1e8 })
    {
      other = data;
      other.transform([&](const Vec3& p) { return scale * p; });
      const Mesh scaled(other.view());
      const double factor = planar ? 1 : scale;
      checkSameMatrix(poisson, stiffnessMatrix(scaled, DiffusionOperator()), factor, 1e-12);
      checkSameMatrix(anisotropic, stiffnessMatrix(scaled, before), factor, 1e-12);
      checkSameMatrix(elastic, stiffnessMatrix(scaled, ElasticOperator()), factor, 1e-12);
      DiffusionOperator mass;
      mass.tensor = { 0, 0, 0, 0, 0, 0 };
      mass.reaction = 1;
      checkSameMatrix(
        stiffnessMatrix(mesh, mass), stiffnessMatrix(scaled, mass), factor * scale * scale, 1e-12);
    }

    // A mesh turned inside out has the same matrices.
    other = data;
    other.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
    checkSameMatrix(poisson, stiffnessMatrix(Mesh(other.view()), DiffusionOperator()), 1, 1e-12);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testSurface)
{
  // A cylinder of triangles or quadrilaterals: its matrix equals the plane's.
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    MeshData flat = blockMesh(type, 6, 3, 0), bent = flat;
    const double angle = 0.5, radius = 0.5 / std::sin(angle / 2);
    bent.transform(
      TAUTLINE_PLACE(radius * std::cos(angle * p[0]), radius * std::sin(angle * p[0]), p[1]));
    const Mesh plane(flat.view()), cylinder(bent.view());
    TAUTLINE_CHECK(cylinder.dimension() == Dimension::Surface);
    checkSameMatrix(stiffnessMatrix(plane, DiffusionOperator()),
      stiffnessMatrix(cylinder, DiffusionOperator()), 1, 1e-12);
    // The tangential part of a multiple of the identity given per cell is no other.
    std::vector<double> tensors;
    for (Index cell = 0; cell < flat.numberOfCells(); ++cell)
    {
      tensors.insert(tensors.end(), { 2, 2, 2, 0, 0, 0 });
    }
    TAUTLINE_LET(DiffusionOperator, perCell, tensors = tensors.data());
    checkSameMatrix(
      stiffnessMatrix(plane, DiffusionOperator()), stiffnessMatrix(cylinder, perCell), 2, 1e-12);
    TAUTLINE_CHECK_THROWS(
      stiffnessMatrix(cylinder, ElasticOperator()), wording("surface-in-space"));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testCoefficientsPerCell)
{
  for (const MeshData& data : { shuffled(movedBlock(CellType::Triangle, 5, 0.1), 2), mixedMesh() })
  {
    const Mesh mesh(data.view());
    const Index cells = data.numberOfCells();
    const SymmetricTensor c = { 2, 1, 3, 0.5, 0.2, -0.3 };
    std::vector<double> tensors, stiffening;
    std::vector<unsigned char> even(cells), odd(cells);
    for (Index cell = 0; cell < cells; ++cell)
    {
      even[cell] = cell % 2 == 0;
      odd[cell] = cell % 2 == 1;
      for (double x : c)
      {
        tensors.push_back(even[cell] ? x : 4 * x);
      }
      stiffening.push_back(even[cell] ? 1 : 4);
    }
    // Every second cell counts four times: the sum of matrices where the others are left out.
    const auto check = [&](auto whole, auto part)
    {
      AssemblyOptions skipEven, skipOdd;
      skipEven.skip = even.data();
      skipOdd.skip = odd.data();
      const SparseMatrix a = stiffnessMatrix(mesh, whole),
                         odds = stiffnessMatrix(mesh, part, skipEven),
                         evens = stiffnessMatrix(mesh, part, skipOdd);
      TAUTLINE_CHECK(exactlySymmetric(a));
      for (Index row = 0; row < a.size; ++row)
      {
        for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k)
        {
          TAUTLINE_CHECK_NEAR(
            a.values[k], 4 * odds.at(row, a.columns[k]) + evens.at(row, a.columns[k]), 1e-13 * 50);
        }
      }
    };
    DiffusionOperator whole, part;
    whole.tensors = tensors.data();
    part.tensor = c;
    check(whole, part);
    ElasticOperator elasticWhole, elasticPart;
    elasticWhole.stiffening = stiffening.data();
    check(elasticWhole, elasticPart);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testThreadsAndReuse)
{
  // Enough cells for several chunks and batches; a cell may list a point twice.
  MeshData triangles = shuffled(movedBlock(CellType::Triangle, 140, 0.1), 4);
  const Index twice = triangles.connectivity[0];
  triangles.addCell(CellType::Quadrilateral,
    { twice, triangles.connectivity[1], triangles.connectivity[2], twice });
  for (const MeshData& data : { triangles, movedBlock(CellType::Hexahedron, 12, 0.1), mixedMesh() })
  {
    const Mesh mesh(data.view());
    MeshData moved = data;
    moved.transform(TAUTLINE_PLACE(2 * p[0], p[1] + 0.1 * p[0], p[2]));
    TAUTLINE_LET(AssemblyOptions, options, threads = 1);
    DiffusionOperator pde;
    pde.tensor = { 2, 1, 3, 0.5, 0, 0 };
    pde.reaction = 0.1;
    const SparseMatrix scalar = stiffnessMatrix(mesh, pde, options);
    const SparseMatrix elastic = stiffnessMatrix(mesh, ElasticOperator(), options);
    const SparseMatrix elsewhere = stiffnessMatrix(Mesh(moved.view()), pde, options);
    TAUTLINE_CHECK(exactlySymmetric(scalar));
    TAUTLINE_CHECK(exactlySymmetric(elastic));
    for (int threads : { 1, 2, 3, 7 })
    {
      options.threads = threads;
      const AssemblyPattern pattern(mesh, options);
      SparseMatrix a = pattern.assemble(ElasticOperator());
      TAUTLINE_CHECK(a.values == elastic.values && a.columns == elastic.columns);
      pattern.assemble(pde, a, moved.points.data());
      TAUTLINE_CHECK(a.values == elsewhere.values && a.columns == elsewhere.columns);
      pattern.assemble(pde, a);
      TAUTLINE_CHECK(a.values == scalar.values && a.offsets == scalar.offsets);
    }
  }
  // A row wider than the short integers places are kept in: a fan round one point.
  MeshData fan;
  const Index spokes = 70000;
  fan.addPoint({ 0, 0, 0 });
  for (Index i = 0; i <= spokes; ++i)
  {
    const double angle = 2 * M_PI * static_cast<double>(i) / spokes;
    fan.addPoint({ std::cos(angle), std::sin(angle), 0 });
    if (i > 0)
    {
      fan.addCell(CellType::Triangle, { 0, i, i + 1 });
    }
  }
  const SparseMatrix a = stiffnessMatrix(Mesh(fan.view()), DiffusionOperator());
  TAUTLINE_CHECK_EQUAL(a.offsets[1], spokes + 2);
  TAUTLINE_CHECK(exactlySymmetric(a));
  TAUTLINE_CHECK(largest(times(a, std::vector<double>(a.size, 1.0))) < 1e-7); // entries of 1e4
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testBadElements)
{
  // A flat element and a point outside all cells contribute nothing; an inverted element its
  // absolute value.
  MeshData data = blockMesh(CellType::Triangle, 2, 2, 0);
  const SparseMatrix before = stiffnessMatrix(Mesh(data.view()), DiffusionOperator());
  TAUTLINE_SET(data, addCell(CellType::Triangle, { 0, 1, 2 }), addPoint({ 0.3, 0.3, 0 }));
  const SparseMatrix after = stiffnessMatrix(Mesh(data.view()), DiffusionOperator());
  TAUTLINE_CHECK_EQUAL(after.size, before.size + 1);
  TAUTLINE_CHECK_EQUAL(after.offsets[after.size], after.offsets[after.size - 1]);
  for (Index row = 0; row < before.size; ++row)
  {
    for (Index column = 0; column < before.size; ++column)
    {
      TAUTLINE_CHECK_EQUAL(after.at(row, column), before.at(row, column));
    }
  }
  for (CellType type : allTypes)
  {
    // The corners of an inverted element in another order form its mirror image.
    const std::vector<Vec3> ideal = idealCell(type);
    std::vector<Vec3> mirrored = ideal;
    for (Vec3& p : mirrored)
    {
      p[0] = -p[0];
    }
    const MeshData one = singleCell(type, ideal), other = singleCell(type, mirrored);
    checkSameMatrix(stiffnessMatrix(Mesh(one.view()), DiffusionOperator()),
      stiffnessMatrix(Mesh(other.view()), DiffusionOperator()), 1, 1e-14);
    // Flat beyond measure: zeros, nothing that is not a number.
    if (topology(type).dimension == 3)
    {
      const MeshData flat = singleCell(type, flattenedCell(type, 0));
      TAUTLINE_CHECK_EQUAL(
        largest(stiffnessMatrix(Mesh(flat.view()), ElasticOperator()).values), 0.0);
      TAUTLINE_CHECK_EQUAL(
        largest(stiffnessMatrix(Mesh(flat.view()), DiffusionOperator()).values), 0.0);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejections)
{
  const MeshData good = blockMesh(CellType::Tetrahedron, 1, 1, 1);
  const DiffusionOperator poisson;
  const auto assemble = [&](const MeshData& data)
  { return stiffnessMatrix(Mesh(data.view()), poisson); };
  TAUTLINE_CHECK_THROWS(assemble(MeshData()), wording("no-cells-finite-elements-are-made-of"));
  MeshData data = good;
  constexpr int line = 3, quadraticTriangle = 22;
  TAUTLINE_SET(data, addCell(line, { 0, 1 }), addCell(line, { 1, 2 }));
  TAUTLINE_CHECK_THROWS(assemble(data), wording("2-cells-are-not-triangles"));
  TAUTLINE_CHECK_THROWS(assemble(data), wording("the-first-is-cell-5-vtk-cell"));
  data = TAUTLINE_CHANGED(good, addCell(CellType::Triangle, { 0, 1, 2 }));
  TAUTLINE_CHECK_THROWS(assemble(data), wording("1-triangle-beside-its-volume-cells"));
  TAUTLINE_CHECK_THROWS(
    loadVector(Mesh(data.view()), nullptr, 1), wording("1-triangle-beside-its-volume-cells"));
  data = blockMesh(CellType::Triangle, 2, 2, 0);
  data.addCell(quadraticTriangle, { 0, 1, 3, 2, 4, 5 });
  TAUTLINE_CHECK_THROWS(assemble(data), wording("8-linear-and-1-quadratic-elements"));
  for (double bad : { NaN, std::numeric_limits<double>::infinity(), 1e200 })
  {
    data = good;
    data.points[3 * data.connectivity[4] + 1] = bad;
    TAUTLINE_CHECK_THROWS(assemble(data), wording("not-finite"));
    TAUTLINE_CHECK_THROWS(
      stiffnessMatrix(Mesh(data.view()), ElasticOperator()), wording("not-finite"));
  }
  data = good;
  data.addPoint({ NaN, NaN, NaN }); // no cell uses it
  TAUTLINE_CHECK(std::isfinite(largest(assemble(data).values)));

  const Mesh mesh(good.view());
  TAUTLINE_LET(DiffusionOperator, pde, reaction = NaN);
  TAUTLINE_CHECK_THROWS(
    stiffnessMatrix(mesh, pde), wording("coefficients-of-the-differential-operator"));
  pde = {};
  pde.tensor[4] = NaN;
  TAUTLINE_CHECK_THROWS(
    stiffnessMatrix(mesh, pde), wording("coefficients-of-the-differential-operator"));
  pde = {};
  std::vector<double> tensors(6 * good.numberOfCells(), 1.0);
  tensors[6 * 3 + 5] = NaN;
  pde.tensors = tensors.data();
  TAUTLINE_CHECK_THROWS(stiffnessMatrix(mesh, pde), wording("cell-3-has"));

  const auto elastic = [&](double e, double nu, PlaneState plane, const MeshData& body)
  {
    TAUTLINE_LET(ElasticOperator, op, youngsModulus = e, poissonRatio = nu, plane = plane);
    return stiffnessMatrix(Mesh(body.view()), op);
  };
  const MeshData sheet = blockMesh(CellType::Triangle, 2, 2, 0);
  for (double e : { 0.0, -1.0, NaN })
  {
    TAUTLINE_CHECK_THROWS(elastic(e, 0.3, PlaneState::Strain, good), wording("young-s-modulus"));
  }
  for (double nu : { -1.0, 0.5, NaN })
  {
    TAUTLINE_CHECK_THROWS(elastic(1, nu, PlaneState::Stress, good), wording("poisson-s-ratio"));
    TAUTLINE_CHECK_THROWS(elastic(1, nu, PlaneState::Strain, sheet), wording("poisson-s-ratio"));
  }
  // A thin sheet may keep its volume.
  TAUTLINE_CHECK(std::isfinite(largest(elastic(1, 0.5, PlaneState::Stress, sheet).values)));
  std::vector<double> stiffening(good.numberOfCells(), 1.0);
  stiffening[2] = 0;
  TAUTLINE_LET(ElasticOperator, op, stiffening = stiffening.data());
  TAUTLINE_CHECK_THROWS(stiffnessMatrix(mesh, op), wording("stiffening-factor-of-cell-2"));
}
}
