// SPDX-License-Identifier: BSD-3-Clause
// Solve PDE: known solutions of problems described in every way, blocks, partitions, rejections.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkConditionEstimator.h"
#include "vtkEllipticSolver.h"
#include "vtkMultiPieceDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

using namespace tautline;

namespace
{
constexpr double Tight = 1e-12; // relative tolerance of the solver
constexpr int Points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
constexpr int Cells = vtkDataObject::FIELD_ASSOCIATION_CELLS;

MeshData block(CellType type, Index n)
{
  return blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
}

MeshData scaled(MeshData data, double factor)
{
  for (double& x : data.points)
  {
    x *= factor;
  }
  return data;
}

vtkDataSet* solved(vtkEllipticSolver* filter)
{
  TAUTLINE_SET(filter, SetRelativeTolerance(Tight), Update());
  return outputOf(filter);
}

std::vector<double> values(vtkDataSet* data, const char* name = "Solution", bool ofCells = false)
{
  vtkDataArray* array =
    ofCells ? data->GetCellData()->GetArray(name) : data->GetPointData()->GetArray(name);
  std::vector<double> result;
  for (vtkIdType i = 0; TAUTLINE_CHECK(array) && i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      result.push_back(array->GetComponent(i, k));
    }
  }
  return result;
}

double distance(const std::vector<double>& a, const std::vector<double>& b)
{
  return largestOf<double>(a.size() == b.size() && !a.empty() ? 0.0 : 1e300,
    std::min(a.size(), b.size()), [&](std::size_t i) { return std::abs(a[i] - b[i]); });
}

vtkSmartPointer<vtkDoubleArray> arrayOf(
  const char* name, vtkIdType tuples, const std::vector<double>& tuple)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  TAUTLINE_SET(array, SetName(name), SetNumberOfComponents(static_cast<int>(tuple.size())));
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    array->InsertNextTuple(tuple.data());
  }
  return array;
}

//------------------------------------------------------------------------------
/// A linear function is its own solution, for all cells, precisions and sizes.
TAUTLINE_PART(testLinear)
{
  for (CellType type : allTypes)
  {
    for (double scale : { 1.0, 1e-8, 1e8 })
    {
      const Context context(std::string(topology(type).name) + " " + std::to_string(scale));
      vtkNew<vtkEllipticSolver> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(toGrid(scaled(block(type, 5), scale))), SetSourceValue(0),
        SetGivenType(vtkEllipticAlgorithm::EXPRESSION),
        SetGivenExpression("(2*x - 3*y)/" + std::to_string(scale) + " + 1"));
      if (scale < 1)
      {
        filter->SetGivenExpression("(2*x - 3*y)*1e8 + 1");
      }
      vtkDataSet* mesh = solved(filter);
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        const double* p = mesh->GetPoint(i);
        TAUTLINE_CHECK_NEAR(
          component(mesh->GetPointData(), "Solution", i), (2 * p[0] - 3 * p[1]) / scale + 1, 1e-9);
      }
      for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
      {
        TAUTLINE_CHECK_NEAR(component(mesh->GetCellData(), "Gradient", i, 0) * scale, 2, 1e-8);
        TAUTLINE_CHECK_NEAR(component(mesh->GetCellData(), "Gradient", i, 1) * scale, -3, 1e-8);
        TAUTLINE_CHECK_NEAR(component(mesh->GetCellData(), "Gradient", i, 2) * scale, 0, 1e-8);
      }
      TAUTLINE_CHECK(filter->GetConverged() && messages.empty());
      TAUTLINE_CHECK_EQUAL(filter->GetUnknowns(),
        topology(type).dimension == 2 ? 16
          : type == CellType::Pyramid ? 64 + 125
                                      : 64);
      TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), filter->GetIterations() + 1);
      TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetValueByName(0, "Log10 residual").ToDouble(), 0);
    }
  }
}

//------------------------------------------------------------------------------
/// u = L x - x^2 / 2 on a strip held on the left: the nodes are exact. Described in all ways.
TAUTLINE_PART(testWays)
{
  constexpr Index n = 6;
  const MeshData data = block(CellType::Quadrilateral, n);
  auto grid = toGrid(data);
  const vtkIdType points = data.numberOfPoints(), cells = data.numberOfCells();
  vtkNew<vtkDoubleArray> left, leftCells;
  left->SetName("left");
  leftCells->SetName("leftCells");
  std::vector<double> expected;
  for (Index i = 0; i < points; ++i)
  {
    const double x = data.point(i)[0];
    left->InsertNextValue(x < 0.5);
    expected.push_back(n * x - 0.5 * x * x);
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(left),
    GetPointData()->AddArray(arrayOf("one", points, { 1 })),
    GetPointData()->AddArray(arrayOf("my source", points, { 1, 2, 3 })));

  vtkNew<vtkEllipticSolver> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid), SetFixedPart(vtkEllipticAlgorithm::PART_OF_BOUNDARY),
    SetFixedWhere("x < 0.5"));
  TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-9);
  filter->SetSourceType(vtkEllipticAlgorithm::EXPRESSION);
  for (const char* f :
    { "one", "2*one - 1", "if(x < 100, one, y)", "\"my source_X\"", "mag(\"my source\")^2/14" })
  {
    const Context context(f);
    filter->SetSourceExpression(f);
    TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-9);
  }
  filter->SetSourceType(vtkEllipticAlgorithm::ARRAY);
  filter->SetInputArrayToProcess(1, 0, 0, Points, "one");
  TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-9);
  filter->SetFixedPart(vtkEllipticAlgorithm::ONLY_CHOSEN);
  filter->SetInputArrayToProcess(0, 0, 0, Points, "left");
  TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-9);
  filter->SetInputArrayToProcess(0, 0, 0, Points, "None");

  // The same points by a selection.
  vtkNew<vtkIdTypeArray> ids;
  for (Index i = 0; i < points; i += n + 1)
  {
    ids->InsertNextValue(i);
  }
  const auto selection = pointSelection(ids);
  filter->SetInputData(1, selection);
  TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-9);
  filter->RemoveAllInputConnections(1);

  // Given values count at fixed points only: elsewhere they need not be finite.
  vtkNew<vtkEllipticSolver> some;
  Messages silent(some);
  TAUTLINE_SET(some, SetInputData(grid), SetFixedPart(vtkEllipticAlgorithm::PART_OF_BOUNDARY),
    SetFixedWhere("x < 0.5"), SetGivenType(vtkEllipticAlgorithm::EXPRESSION),
    SetGivenExpression("0/(x - 3)"));
  TAUTLINE_CHECK_NEAR(distance(values(solved(some)), expected), 0, 1e-9);
  TAUTLINE_CHECK(silent.empty());
  TAUTLINE_SET(some, SetGivenExpression("1/x"), Update());
  TAUTLINE_CHECK(silent.has(wording("not-finite")) || silent.has(wording("not-a-finite")));

  // Cells hold all their points: the first column of cells is left out of the strip.
  for (Index i = 0; i < cells; ++i)
  {
    leftCells->InsertNextValue(i % n == 0);
  }
  grid->GetCellData()->AddArray(leftCells);
  TAUTLINE_SET(filter, SetInputArrayToProcess(0, 0, 0, Cells, "leftCells"),
    SetGivenType(vtkEllipticAlgorithm::ARRAY), SetInputArrayToProcess(2, 0, 0, Points, "one"));
  const std::vector<double> held = values(solved(filter));
  for (Index i = 0; i < points; ++i)
  {
    const double x = std::max(0.0, data.point(i)[0] - 1);
    TAUTLINE_CHECK_NEAR(held[i], 1 + (n - 1) * x - 0.5 * x * x, 1e-9);
  }
  TAUTLINE_CHECK(messages.empty());
}

//------------------------------------------------------------------------------
/// Coefficients, constant and as arrays.
TAUTLINE_PART(testCoefficients)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    auto grid = toGrid(block(type, 4));
    const vtkIdType cells = grid->GetNumberOfCells();
    TAUTLINE_NEW(vtkEllipticSolver, filter, SetInputData(grid),
      SetEquation(vtkEllipticAlgorithm::ELLIPTIC), SetAlpha(2), SetBeta(3), SetGamma(5),
      SetReaction(0.5));
    const std::vector<double> expected = values(solved(filter));
    grid->GetCellData()->AddArray(arrayOf("six", cells, { 2, 3, 5, 0, 0, 0 }));
    grid->GetCellData()->AddArray(arrayOf("nine", cells, { 2, 0, 0, 0, 3, 0, 0, 0, 5 }));
    filter->SetAlpha(7);
    for (const char* name : { "six", "nine" })
    {
      filter->SetInputArrayToProcess(3, 0, 0, Cells, name);
      TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-12);
    }
    // With a alone, u = f / a within; with a of 0 and a tensor of 1 it is Poisson's equation.
    TAUTLINE_NEW(vtkEllipticSolver, poisson, SetInputData(grid));
    TAUTLINE_SET(filter, SetInputArrayToProcess(3, 0, 0, Cells, "None"), SetAlpha(1), SetBeta(1),
      SetGamma(1), SetReaction(0));
    TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), values(solved(poisson))), 0, 1e-12);
  }
}

//------------------------------------------------------------------------------
/// A uniform strain has a known stress.
TAUTLINE_PART(testElasticity)
{
  constexpr double E = 200, nu = 0.25, strain = 0.01;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    for (int plane : { vtkEllipticAlgorithm::PLANE_STRAIN, vtkEllipticAlgorithm::PLANE_STRESS })
    {
      auto grid = toGrid(block(type, 4));
      grid->GetCellData()->AddArray(arrayOf("four", grid->GetNumberOfCells(), { 4 }));
      vtkNew<vtkEllipticSolver> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(grid), SetEquation(vtkEllipticAlgorithm::ELASTICITY),
        SetYoungsModulus(E / 4), SetInputArrayToProcess(4, 0, 0, Cells, "four"),
        SetPoissonRatio(nu), SetPlaneState(plane), SetBodyForce(0, 0, 0),
        SetGivenType(vtkEllipticAlgorithm::EXPRESSION),
        SetGivenExpression("0.01*x*iHat + 0.01*x*jHat"));
      vtkDataSet* mesh = solved(filter);
      const bool stress = flat && plane == vtkEllipticAlgorithm::PLANE_STRESS;
      // eps_xx = strain, eps_xy = strain / 2, and in plane stress eps_zz such that tau_zz = 0
      const double zz = stress ? -nu / (1 - nu) * strain : 0;
      const std::array<double, 6> tau = { lambda * (strain + zz) + 2 * mu * strain,
        lambda * (strain + zz), lambda * (strain + zz) + 2 * mu * zz, mu * strain, 0, 0 };
      const double mises = std::sqrt(0.5 *
          (std::pow(tau[0] - tau[1], 2) + std::pow(tau[1] - tau[2], 2) +
            std::pow(tau[2] - tau[0], 2)) +
        3 * tau[3] * tau[3]);
      for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
      {
        TAUTLINE_EACH(int, k, 6,
          TAUTLINE_CHECK_NEAR(component(mesh->GetCellData(), "Stress", i, k), tau[k], 1e-8));
        TAUTLINE_CHECK_NEAR(component(mesh->GetCellData(), "VonMises", i), mises, 1e-8);
      }
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        const double x = mesh->GetPoint(i)[0];
        TAUTLINE_CHECK_NEAR(
          component(mesh->GetPointData(), "Displacement", i, 1), strain * x, 1e-10);
      }
      TAUTLINE_CHECK_EQUAL(
        std::string(mesh->GetCellData()->GetArray("Stress")->GetComponentName(5)), "XZ");
      TAUTLINE_CHECK(messages.empty());
    }
  }
}

//------------------------------------------------------------------------------
/// Every solver finds the same; the result does not depend on threads, nor on filters before it.
TAUTLINE_PART(testSolvers)
{
  auto grid = toGrid(block(CellType::Triangle, 12));
  vtkNew<vtkEllipticSolver> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid), SetSolver(vtkEllipticSolver::DIRECT));
  const std::vector<double> expected = values(solved(filter));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("a-direct-solve")));
  for (int solver = vtkEllipticSolver::CG; solver < vtkEllipticSolver::DIRECT; ++solver)
  {
    for (int p = vtkEllipticSolver::JACOBI; p <= vtkEllipticSolver::NONE; ++p)
    {
      const Context context(std::to_string(solver) + " " + std::to_string(p));
      TAUTLINE_SET(filter, SetSolver(solver), SetPreconditioner(p));
      TAUTLINE_CHECK_NEAR(distance(values(solved(filter)), expected), 0, 1e-7);
      TAUTLINE_CHECK(filter->GetConverged());
    }
  }
  TAUTLINE_SET(filter, SetSolver(vtkEllipticSolver::CG), SetPreconditioner(vtkEllipticSolver::AMG),
    SetThreads(1));
  const std::vector<double> one = values(solved(filter));
  filter->SetThreads(3);
  TAUTLINE_CHECK(values(solved(filter)) == one);
  filter->SetPETScOptions("-ksp_max_it 1");
  solved(filter);
  TAUTLINE_CHECK(!filter->GetConverged() && messages.has(wording("limit-of-iterations")));
  TAUTLINE_CHECK_EQUAL(filter->GetIterations(), 1);
  messages.clear();
  filter->SetPETScOptions("");

  // Two in a pipeline: the second has the solution of the first as its source.
  TAUTLINE_NEW(vtkEllipticSolver, second, SetInputConnection(filter->GetOutputPort()),
    SetSourceType(vtkEllipticAlgorithm::ARRAY), SetInputArrayToProcess(1, 0, 0, Points, "Solution"),
    SetSolutionName("again"), SetComputeGradient(false));
  vtkDataSet* mesh = solved(second);
  TAUTLINE_CHECK(values(mesh) == one);
  TAUTLINE_CHECK(values(mesh, "again") != one);
  TAUTLINE_CHECK(messages.empty());
}

//------------------------------------------------------------------------------
/// Blocks are meshes of their own; partitions are one mesh.
TAUTLINE_PART(testBlocks)
{
  const MeshData data = block(CellType::Quadrilateral, 6);
  TAUTLINE_NEW(vtkEllipticSolver, whole, SetInputData(toGrid(data)));
  vtkDataSet* mesh = solved(whole);
  const std::vector<double> expected = values(mesh), gradient = values(mesh, "Gradient", true);

  // The lower and the upper half, with a line of points in both.
  std::array<MeshData, 2> halves;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const double y = data.point(i)[1];
    for (int h = 0; h < 2; ++h)
    {
      if (h == 0 ? y <= 3 : y >= 3)
      {
        halves[h].addPoint(data.point(i));
      }
    }
  }
  const Index lower = halves[0].numberOfPoints(), shift = lower - 7;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const int h = cell < data.numberOfCells() / 2 ? 0 : 1;
    const Index* p = data.connectivity.data() + data.offsets[cell];
    const Index s = h * shift;
    halves[h].addCell(CellType::Quadrilateral, { p[0] - s, p[1] - s, p[2] - s, p[3] - s });
  }
  TAUTLINE_NEW(vtkPartitionedDataSet, parts, SetPartition(0, toGrid(halves[0])),
    SetPartition(1, toGrid(halves[1])));
  TAUTLINE_NEW(vtkPartitionedDataSetCollection, collection, SetPartitionedDataSet(0, parts));
  TAUTLINE_NEW(vtkMultiPieceDataSet, pieces, SetPartition(0, parts->GetPartition(0)),
    SetPartition(1, parts->GetPartition(1)));
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(data)), SetBlock(2, pieces));
  vtkNew<vtkEllipticSolver> filter;
  Messages messages(filter);
  filter->SetRelativeTolerance(Tight);
  for (vtkDataObject* input : { static_cast<vtkDataObject*>(parts),
         static_cast<vtkDataObject*>(collection), static_cast<vtkDataObject*>(blocks) })
  {
    const Context context(input->GetClassName());
    TAUTLINE_SET(filter, SetInputDataObject(input), Update());
    vtkDataObject* output = filter->GetOutputDataObject(0);
    if (auto* solvedBlocks = vtkMultiBlockDataSet::SafeDownCast(output))
    {
      TAUTLINE_CHECK_NEAR(
        distance(values(vtkDataSet::SafeDownCast(solvedBlocks->GetBlock(0))), expected), 0, 1e-10);
      output = solvedBlocks->GetBlock(2);
      TAUTLINE_CHECK(contains(filter->GetSummary(), wording("in-block-3")));
      TAUTLINE_CHECK_EQUAL(filter->GetUnknowns(), 50);
      TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetValueByName(0, "Block").ToString(), "block 1");
    }
    if (auto* found = vtkPartitionedDataSetCollection::SafeDownCast(output))
    {
      output = found->GetPartitionedDataSet(0);
    }
    auto* found = vtkPartitionedDataSet::SafeDownCast(output);
    for (int h = 0; TAUTLINE_CHECK(found) && h < 2; ++h)
    {
      const auto part = values(found->GetPartition(h));
      const std::vector<double> same(expected.begin() + h * shift,
        expected.begin() + h * shift + static_cast<Index>(part.size()));
      TAUTLINE_CHECK_NEAR(distance(part, same), 0, 1e-10);
      const auto cells = values(found->GetPartition(h), "Gradient", true);
      const std::vector<double> sameCells(
        gradient.begin() + h * 54, gradient.begin() + (h + 1) * 54);
      TAUTLINE_CHECK_NEAR(distance(cells, sameCells), 0, 1e-10);
    }
    TAUTLINE_CHECK(messages.empty());
  }
  // A ghost in one partition only: a square of the lower half, again.
  MeshData more = halves[1];
  const std::array<Index, 2> corners = { more.addPoint({ 0, 2, 0 }), more.addPoint({ 1, 2, 0 }) };
  more.addCell(CellType::Quadrilateral, { corners[0], corners[1], 1, 0 });
  auto withGhost = toGrid(more);
  const auto ghosts = filledArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(),
    more.numberOfCells(), [&](Index cell) { return cell + 1 == more.numberOfCells() ? 1 : 0; });
  withGhost->GetCellData()->AddArray(ghosts);
  TAUTLINE_SET(parts, SetPartition(1, withGhost), Modified());
  TAUTLINE_SET(filter, SetInputDataObject(parts), Update());
  const auto upper = values(outputOf<vtkPartitionedDataSet>(filter)->GetPartition(1));
  TAUTLINE_CHECK_EQUAL(filter->GetUnknowns(), 25);
  TAUTLINE_EACH(Index, i, halves[1].numberOfPoints(),
    TAUTLINE_CHECK_NEAR(upper[i], expected[shift + i], 1e-10));
  TAUTLINE_CHECK_NEAR(upper[corners[1]], expected[2 * 7 + 1], 1e-10);
  TAUTLINE_CHECK(messages.empty());

  halves[1].setPoint(1, halves[1].point(2)); // two points at one place
  parts->SetPartition(1, toGrid(halves[1]));
  TAUTLINE_SET(filter, SetInputDataObject(parts), Update());
  TAUTLINE_CHECK(messages.has(wording("1-points-are-at-the-place-of")));

  TAUTLINE_NEW(vtkImageData, image, SetDimensions(7, 7, 1));
  whole->SetInputData(image);
  TAUTLINE_CHECK_NEAR(distance(values(solved(whole)), expected), 0, 1e-10);
  whole->SetInputData(toPolyData(data, VTK_FLOAT));
  TAUTLINE_CHECK_NEAR(distance(values(solved(whole)), expected), 0, 1e-10);
  vtkNew<vtkUnstructuredGrid> nothing;
  TAUTLINE_SET(whole, SetInputData(nothing), Update());
  TAUTLINE_CHECK_EQUAL(whole->GetUnknowns(), 0);
  whole->SetInputData(toGrid(shuffled(data, 3)));
  TAUTLINE_CHECK_EQUAL(values(solved(whole)).size(), expected.size());
}

//------------------------------------------------------------------------------
void rejects(vtkEllipticSolver* filter, const std::string& text)
{
  const Context context(text);
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.has(text));
  auto* mesh = outputOf(filter);
  TAUTLINE_CHECK_EQUAL(mesh->GetNumberOfPoints(), 0);
}

TAUTLINE_PART(testRejections)
{
  const MeshData data = block(CellType::Triangle, 4);
  const vtkIdType points = data.numberOfPoints();
  auto grid = TAUTLINE_CHANGED(toGrid(data),
    GetPointData()->AddArray(arrayOf("nan", points, { std::numeric_limits<double>::quiet_NaN() })),
    GetPointData()->AddArray(arrayOf("vector", points, { 1, 2, 3 })),
    GetCellData()->AddArray(arrayOf("onCells", data.numberOfCells(), { 1 })));
  TAUTLINE_NEW(
    vtkEllipticSolver, filter, SetInputData(grid), SetSourceType(vtkEllipticAlgorithm::ARRAY));
  rejects(filter, wording("no-array-is-chosen-to-take-the"));
  filter->SetInputArrayToProcess(1, 0, 0, Points, "absent");
  rejects(filter, wording("there-is-no-point-array-absent-to"));
  filter->SetInputArrayToProcess(1, 0, 0, Points, "nan");
  rejects(filter, wording("the-array-nan-of-the-source-is"));
  filter->SetInputArrayToProcess(1, 0, 0, Points, "vector");
  rejects(filter, wording("has-3-components-one-is-expected"));
  filter->SetInputArrayToProcess(1, 0, 0, Cells, "onCells");
  rejects(filter, wording("is-on-cells-one-on-points-is"));
  filter->SetSourceType(vtkEllipticAlgorithm::EXPRESSION);
  rejects(filter, wording("the-expression-of-the-source-is-empty"));
  const std::array<std::array<const char*, 2>, 7> wrong = { {
    { "sin(x", "Mismatched brackets" },
    { "x*", "is not understood" },
    { "q + 1", "Undefined symbol: 'q'" },
    { "1/x", "The expression '1/x' of the source is not finite at point 0, (0, 0, 0)" },
    { "sqrt(-1)", "is not finite at point 0" },
    { "x*iHat", "is a vector; a number is expected" },
    { "nan", "is not finite at point 0" },
  } };
  for (const auto& pair : wrong)
  {
    filter->SetSourceExpression(pair[0]);
    rejects(filter, pair[1]);
  }
  TAUTLINE_SET(filter, SetEquation(vtkEllipticAlgorithm::ELASTICITY), SetSourceExpression("x"));
  rejects(filter, wording("is-a-number-a-vector-is-expected"));
  TAUTLINE_SET(filter, SetPoissonRatio(0.5), SetSourceType(vtkEllipticAlgorithm::CONSTANT));
  rejects(filter, "Poisson");
  TAUTLINE_SET(filter, SetEquation(vtkEllipticAlgorithm::POISSON), SetPETScOptions("-nonsense 3"));
  rejects(filter, "-nonsense");
  filter->SetPETScOptions("-pc_type nonsense");
  rejects(filter, "nonsense");
  TAUTLINE_SET(filter, SetPETScOptions(""), SetFixedPart(vtkEllipticAlgorithm::ONLY_CHOSEN));
  rejects(filter, wording("without-a-fixed-point"));
  filter->SetFixedPart(vtkEllipticAlgorithm::PART_OF_BOUNDARY);
  rejects(filter, wording("the-expression-of-the-fixed-part-of"));
  filter->SetFixedPart(vtkEllipticAlgorithm::WHOLE_BOUNDARY);
  filter->SetSourceValue(std::numeric_limits<double>::infinity());
  rejects(filter, wording("not-a-finite-number"));
  TAUTLINE_SET(filter, SetSourceValue(1), SetEquation(vtkEllipticAlgorithm::ELLIPTIC),
    SetInputArrayToProcess(3, 0, 0, Cells, "onCells"));
  rejects(filter, wording("has-1-components-6-or-9-are"));
  filter->SetInputArrayToProcess(3, 0, 0, Points, "vector");
  rejects(filter, wording("is-on-points-one-on-cells-is"));
  TAUTLINE_SET(filter, SetEquation(vtkEllipticAlgorithm::POISSON), SetOmega(2.5),
    SetPreconditioner(vtkEllipticSolver::SSOR));
  rejects(filter, wording("between-0-and-2"));
  filter->SetOmega(1);

  MeshData inverted = TAUTLINE_CHANGED(data, setPoint(6, { 3.2, 3.1, 0 }));
  filter->SetInputData(toGrid(inverted));
  rejects(filter, "inverted");
  filter->SetInputData(toGrid(block(CellType::Triangle, 1)));
  rejects(filter, "free");
  MeshData notFinite = data;
  notFinite.setPoint(6, { std::numeric_limits<double>::quiet_NaN(), 0, 0 });
  filter->SetInputData(toGrid(notFinite));
  rejects(filter, "finite");
  TAUTLINE_NEW(vtkUnstructuredGrid, lines, SetPoints(toPoints(data)));
  const vtkIdType ends[] = { 0, 1 };
  lines->InsertNextCell(VTK_LINE, 2, ends);
  filter->SetInputData(lines);
  rejects(filter, wording("the-mesh-has-no-cells-finite-elements"));
  const vtkIdType corners[] = { 0, 1, 6, 7, 5 };
  auto polygon = TAUTLINE_CHANGED(toGrid(data), InsertNextCell(VTK_POLYGON, 5, corners));
  filter->SetInputData(polygon);
  rejects(filter, wording("1-cells-are-not-triangles"));
  // and after all that it works
  filter->SetInputData(grid);
  TAUTLINE_CHECK_EQUAL(values(solved(filter)).size(), std::size_t(points));
}

//------------------------------------------------------------------------------
/// Cells of lower dimension beside the elements, in any order, do not count and stay in the output.
TAUTLINE_PART(testCellsBeside)
{
  for (CellType type : { CellType::Triangle, CellType::Hexahedron, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = block(type, 4);
    TAUTLINE_LET(MeshData, before, points = data.points);
    MeshData after = data;
    const std::vector<Index> first = data.nodes(0);
    for (MeshData* mixed : { &before, &after })
    {
      mixed->addCell(VTK_VERTEX, { first[0] });
      mixed->addCell(VTK_LINE, { first[0], first[1] });
      mixed->addCell(VTK_POLY_LINE, { first[0], first[1], first[2], data.numberOfPoints() - 1 });
      if (topology(type).dimension == 3)
      {
        mixed->addCell(VTK_TRIANGLE, { first[0], first[1], first[2] });
      }
    }
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      before.addCell(data.types[cell], data.nodes(cell));
    }
    const auto solve = [](const MeshData& mesh, int pde)
    {
      TAUTLINE_NEW(vtkEllipticSolver, filter, SetInputData(toGrid(mesh)), SetEquation(pde),
        SetSourceValue(1), SetBodyForce(1, 0, 0));
      vtkDataSet* output = solved(filter);
      TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), mesh.numberOfCells());
      return values(output, pde == vtkEllipticSolver::ELASTICITY ? "Displacement" : "Solution");
    };
    for (const int pde : { vtkEllipticSolver::POISSON, vtkEllipticSolver::ELASTICITY })
    {
      const std::vector<double> expected = solve(data, pde);
      for (const MeshData* mixed : { &before, &after })
      {
        TAUTLINE_CHECK(distance(solve(*mixed, pde), expected) <= 1e-9);
      }
    }
    vtkNew<vtkConditionEstimator> estimator;
    double conditions[2];
    for (const bool mixed : { false, true })
    {
      TAUTLINE_SET(estimator, SetInputData(toGrid(mixed ? before : data)), Update());
      conditions[mixed] = estimator->GetCondition();
    }
    TAUTLINE_CHECK(conditions[0] > 1);
    TAUTLINE_CHECK_RELATIVE(conditions[1], conditions[0], 1e-6);
  }
}

TAUTLINE_PART(testNotices)
{
  MeshData data = block(CellType::Triangle, 4);
  vtkNew<vtkEllipticSolver> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  const std::vector<double> expected = values(solved(filter));
  data.swapNodes(0, 1);
  data.addPoint({ 9, 9, 0 }); // in no element
  filter->SetInputData(toGrid(data));
  std::vector<double> found = values(solved(filter));
  TAUTLINE_CHECK_EQUAL(found.back(), 0);
  found.pop_back();
  TAUTLINE_CHECK_NEAR(distance(found, expected), 0, 1e-12);
  const std::string summary = filter->GetSummary();
  TAUTLINE_CHECK(contains(summary, "reversed"));
  TAUTLINE_CHECK(contains(summary, wording("1-points-are-in-no-element")));
  TAUTLINE_CHECK(messages.empty());

  // Stopping early keeps what there is, with a warning.
  TAUTLINE_SET(filter, SetInputData(toGrid(block(CellType::Triangle, 60))),
    SetPreconditioner(vtkEllipticSolver::NONE), SetTimeLimit(1e-9));
  solved(filter);
  TAUTLINE_CHECK(messages.has(wording("time-limit")));
  filter->SetTimeLimit(0);
  messages.clear();
  filter->SetInputData(toGrid(block(CellType::Triangle, 250))); // longer than between two reports
  const unsigned long tag = stopAt(filter, vtkCommand::ProgressEvent, 0.6);
  vtkDataSet* mesh = solved(filter);
  TAUTLINE_CHECK(messages.has(wording("topped-by-the-user")));
  TAUTLINE_CHECK(filter->GetIterations() > 0 && !filter->GetConverged());
  const std::vector<double> best = values(mesh);
  TAUTLINE_CHECK(*std::max_element(best.begin(), best.end()) > 0);
  TAUTLINE_SET(filter, RemoveObserver(tag), SetAbortExecute(0));
}
}
