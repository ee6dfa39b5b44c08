// SPDX-License-Identifier: BSD-3-Clause
// Solve PDE, Condition Estimator and Solver Study on processes that redistribute the mesh: the
// results equal the results of one process, at the points and in the cells of the pieces, however
// these are cut; messages name the cells of the pieces, and an error of one process is an error of
// all.
#include "Registry.h"
#include "ThreadRanks.h"
#include "VtkMeshes.h"
#include "vtkConditionEstimator.h"
#include "vtkEllipticSolver.h"
#include "vtkMPIController.h"
#include "vtkSolverStudy.h"

using namespace tautline;

namespace
{
constexpr double Tight = 1e-12, Close = 1e-8;
constexpr int Ways[] = { vtkEllipticAlgorithm::NO_REDISTRIBUTION, vtkEllipticAlgorithm::KD_TREE,
  vtkEllipticAlgorithm::PT_SCOTCH };

vtkMPIController* processes = nullptr;

std::string sentence(int how)
{
  return how == vtkEllipticAlgorithm::NO_REDISTRIBUTION ? "Seconds"
                                                        : std::string("The mesh was ") +
      wording("redistributed") + " among " + std::to_string(processes->GetNumberOfProcesses()) +
      " processes" + (how == vtkEllipticAlgorithm::PT_SCOTCH ? " by PT-Scotch." : ".");
}

/// A part with arrays that follow from the points and cells of the whole mesh.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(const RankPart& part)
{
  auto grid = toGrid(part.data);
  const auto add = [&](vtkDataSetAttributes* data, const char* name, int components,
                     const std::vector<Index>& of, const std::function<double(Index, int)>& value)
  {
    TAUTLINE_NEW(vtkDoubleArray, array, SetName(name), SetNumberOfComponents(components));
    for (const Index item : of)
    {
      for (int k = 0; k < components; ++k)
      {
        array->InsertNextValue(value(item, k));
      }
    }
    data->AddArray(array);
  };
  add(grid->GetPointData(), "f", 3, part.pointOf,
    [](Index p, int k) { return k == 2 ? 0.0 : std::sin(0.7 * static_cast<double>(p) + k); });
  add(grid->GetPointData(), "g", 1, part.pointOf,
    [](Index p, int) { return std::cos(0.3 * static_cast<double>(p)); });
  add(grid->GetCellData(), "stiffness", 1, part.cellOf,
    [](Index cell, int) { return 1.0 + static_cast<double>(cell % 5); });
  add(grid->GetCellData(), "tensor", 6, part.cellOf,
    [](Index cell, int k)
    { return k < 3 ? 1.0 + static_cast<double>((cell + k) % 3) : 0.1 * (k - 3); });
  add(grid->GetCellData(), "held", 1, part.cellOf, [](Index cell, int) { return cell == 5; });
  const auto ghosts =
    filledArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(), part.ghosts,
      [&](const unsigned char ghost) { return ghost ? vtkDataSetAttributes::DUPLICATECELL : 0; });
  grid->GetCellData()->AddArray(ghosts);
  return grid;
}

template <class Filter>
using Set = std::function<void(Filter*, const RankPart&)>;

/// The values of an array by the points or cells of the whole mesh.
std::vector<double> arrayOf(
  vtkAlgorithm* filter, const RankPart& part, const char* name, bool ofCells, Index count)
{
  auto* output = outputOf(filter);
  const std::vector<Index>& of = ofCells ? part.cellOf : part.pointOf;
  std::vector<double> values;
  vtkDataArray* array =
    ofCells ? output->GetCellData()->GetArray(name) : output->GetPointData()->GetArray(name);
  if (of.empty() ||
    !TAUTLINE_CHECK(array && array->GetNumberOfTuples() == static_cast<vtkIdType>(of.size())))
  {
    return values;
  }
  const int components = array->GetNumberOfComponents();
  values.assign(static_cast<std::size_t>(components * count), HUGE_VAL);
  for (std::size_t i = 0; i < of.size(); ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      values[components * of[i] + k] = array->GetComponent(static_cast<vtkIdType>(i), k);
    }
  }
  return values;
}

/// The local values are within a tolerance, relative to the largest expected value.
void checkSame(
  const std::vector<double>& here, const std::vector<double>& expected, double tolerance)
{
  double largest = 0, farthest = 0;
  for (const double value : expected)
  {
    largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < here.size(); ++i)
  {
    farthest = here[i] == HUGE_VAL ? farthest : std::max(farthest, std::abs(here[i] - expected[i]));
  }
  TAUTLINE_CHECK(largest > 0 && farthest <= tolerance * largest);
}

/// The arrays to compare: name, of cells, tolerance.
struct Compared
{
  const char* name;
  bool ofCells;
  double tolerance;
};

/// On one process, and on all with the mesh cut in several ways and redistributed.
template <class Filter>
void testFilter(const char* name, const MeshData& whole, const Set<Filter>& set,
  const std::vector<Compared>& arrays,
  const std::function<void(Filter* serial, Filter* filter)>& check)
{
  const Context context(name);
  const int rank = processes->GetLocalProcessId(), size = processes->GetNumberOfProcesses();
  const RankPart all = partOf(whole, 0, [](Index) { return 0; });
  const auto countOf = [&](const Compared& array)
  { return array.ofCells ? whole.numberOfCells() : whole.numberOfPoints(); };
  vtkNew<Filter> serial;
  vtkMultiProcessController::SetGlobalController(nullptr);
  serial->SetInputData(gridOf(all));
  set(serial, all);
  serial->Update();
  vtkMultiProcessController::SetGlobalController(processes);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    const RankPart part = partOf(whole, rank, cutBy(whole, cut, size), cut == Cut::Slabs);
    for (const int how : Ways)
    {
      const Context inner(
        "cut " + std::to_string(static_cast<int>(cut)) + ", divided " + std::to_string(how));
      vtkNew<Filter> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(gridOf(part)), SetRedistribute(how));
      set(filter, part);
      filter->Update();
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("redistributed")) ||
        contains(filter->GetSummary(), sentence(how)));
      TAUTLINE_CHECK_EQUAL(contains(filter->GetSummary(), wording("redistributed")),
        how != vtkEllipticAlgorithm::NO_REDISTRIBUTION);
      TAUTLINE_CHECK_EQUAL(filter->GetUnknowns(), serial->GetUnknowns());
      for (const Compared& array : arrays)
      {
        const Context which(array.name);
        checkSame(arrayOf(filter, part, array.name, array.ofCells, countOf(array)),
          arrayOf(serial, all, array.name, array.ofCells, countOf(array)), array.tolerance);
      }
      check(serial, filter);
    }
  }
}

void setTolerance(vtkEllipticSolver* filter)
{
  TAUTLINE_SET(filter, SetRelativeTolerance(Tight), SetPreconditioner(vtkEllipticSolver::JACOBI));
}

//------------------------------------------------------------------------------
void testSolutions()
{
  const std::vector<Compared> scalar = { { "Solution", false, Close },
    { "Gradient", true, Close } };
  const auto converged = [](vtkEllipticSolver*, vtkEllipticSolver* filter)
  { TAUTLINE_CHECK(filter->GetConverged()); };
  for (const CellType type : { CellType::Tetrahedron, CellType::Wedge, CellType::Triangle })
  {
    testFilter<vtkEllipticSolver>(
      topology(type).plural, jittered(type, 5, 0.15),
      [](vtkEllipticSolver* filter, const RankPart&)
      {
        setTolerance(filter);
        TAUTLINE_SET(filter, SetSourceType(vtkEllipticSolver::EXPRESSION),
          SetSourceExpression("x*y + z"), SetGivenType(vtkEllipticSolver::ARRAY),
          SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "g"));
      },
      scalar, converged);
  }
  testFilter<vtkEllipticSolver>(
    "elasticity", jittered(CellType::Quadrilateral, 6, 0.15),
    [](vtkEllipticSolver* filter, const RankPart&)
    {
      setTolerance(filter);
      TAUTLINE_SET(filter, SetEquation(vtkEllipticSolver::ELASTICITY),
        SetSourceType(vtkEllipticSolver::ARRAY),
        SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "f"),
        SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "stiffness"),
        SetFixedPart(vtkEllipticSolver::PART_OF_BOUNDARY), SetFixedWhere("x < 0.01"));
    },
    { { "Displacement", false, Close }, { "Stress", true, Close }, { "VonMises", true, Close } },
    converged);
  // A point is selected in one piece, and a cell flagged, of which others have points.
  testFilter<vtkEllipticSolver>(
    "tensors and chosen points", jittered(CellType::Hexahedron, 4, 0.1),
    [](vtkEllipticSolver* filter, const RankPart& part)
    {
      setTolerance(filter);
      filter->SetEquation(vtkEllipticSolver::ELLIPTIC);
      filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "tensor");
      filter->SetFixedPart(vtkEllipticSolver::ONLY_CHOSEN);
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "held");
      vtkNew<vtkIdTypeArray> ids;
      constexpr Index middle = 62, beside = 21; // a point, and a cell that has it
      for (std::size_t i = 0; i < part.cellOf.size(); ++i)
      {
        for (std::size_t p = 0; p < part.pointOf.size(); ++p)
        {
          if (part.cellOf[i] == beside && !part.ghosts[i] && part.pointOf[p] == middle)
          {
            ids->InsertNextValue(static_cast<vtkIdType>(p));
          }
        }
      }
      const auto selection = pointSelection(ids);
      filter->SetInputData(1, selection);
    },
    scalar, converged);
}

//------------------------------------------------------------------------------
/// Time steps: what was assembled is kept while others are shown, with its division.
void testTime()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.15);
  for (const double time : { 0.1, 0.3 }) // the one that is shown first
  {
    testFilter<vtkEllipticSolver>(
      "time steps", whole,
      [&](vtkEllipticSolver* filter, const RankPart& part)
      {
        setTolerance(filter);
        TAUTLINE_SET(filter, SetTimeScheme(vtkEllipticSolver::NEWMARK), SetTimeStep(0.1),
          SetNumberOfTimeSteps(3), SetInitialType(vtkEllipticSolver::EXPRESSION),
          SetInitialExpression("x*(4 - x)*g"), SetVelocityType(vtkEllipticSolver::ARRAY),
          SetInputArrayToProcess(6, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "g"),
          UpdateTimeStep(time), UpdateTimeStep(0.2));
        if (vtkMultiProcessController::GetGlobalController())
        {
          // Shown again, it is the same.
          const auto shown = arrayOf(filter, part, "Solution", false, whole.numberOfPoints());
          filter->UpdateTimeStep(0.3);
          const auto other = arrayOf(filter, part, "Solution", false, whole.numberOfPoints());
          TAUTLINE_CHECK(part.pointOf.empty() || shown != other);
          filter->UpdateTimeStep(0.2);
          TAUTLINE_CHECK(arrayOf(filter, part, "Solution", false, whole.numberOfPoints()) == shown);
          TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 1);
        }
      },
      { { "Solution", false, Close } }, [](vtkEllipticSolver*, vtkEllipticSolver*) {});
  }
}

//------------------------------------------------------------------------------
void testConditions()
{
  constexpr double ofEigenvalues = 1e-10, ofCondition = 1e-4;
  const MeshData whole = jittered(CellType::Triangle, 7, 0.25);
  std::string undivided;
  testFilter<vtkConditionEstimator>(
    "condition", whole,
    [](vtkConditionEstimator* filter, const RankPart&)
    { filter->SetPreconditioner(vtkEllipticSolver::JACOBI); },
    { { "LargestEigenvalue", true, ofEigenvalues }, { "Excess", true, ofEigenvalues },
      { "Share", true, ofCondition } },
    [&](vtkConditionEstimator* serial, vtkConditionEstimator* filter)
    {
      TAUTLINE_CHECK_RELATIVE(filter->GetCondition(), serial->GetCondition(), ofCondition);
      TAUTLINE_CHECK_RELATIVE(
        filter->GetPreconditionedCondition(), serial->GetPreconditionedCondition(), ofCondition);
      // The named elements belong to the pieces.
      const std::string summary = filter->GetSummary();
      const int how = filter->GetRedistribute();
      if (how == vtkEllipticAlgorithm::NO_REDISTRIBUTION)
      {
        undivided = summary.substr(summary.find("\nElement "));
        TAUTLINE_CHECK(contains(undivided, wording("of-process")));
      }
      else
      {
        TAUTLINE_CHECK_EQUAL(
          summary.substr(summary.find("\nElement ")), undivided + "\n" + sentence(how));
      }
    });
  testFilter<vtkSolverStudy>(
    "study", whole,
    [](vtkSolverStudy* filter, const RankPart&)
    { TAUTLINE_SET(filter, AddCombination(1), AddCombination(17)); },
    {},
    [](vtkSolverStudy* serial, vtkSolverStudy* filter)
    {
      for (vtkIdType row = 0; row < filter->GetStudy()->GetNumberOfRows(); ++row)
      {
        for (const char* column : { "N iterations", "N converged" })
        {
          TAUTLINE_CHECK_EQUAL(filter->GetStudy()->GetValueByName(row, column).ToDouble(),
            serial->GetStudy()->GetValueByName(row, column).ToDouble());
        }
      }
    });
}

//------------------------------------------------------------------------------
/// Surfaces and planes: pieces that lie in one plane are parts of what does not, and pieces list
/// their cells in opposite orders.
void testSpaces()
{
  const auto set = [](vtkEllipticSolver* filter, const RankPart&)
  {
    setTolerance(filter);
    TAUTLINE_SET(filter, SetSourceType(vtkEllipticSolver::EXPRESSION), SetSourceExpression("y"));
  };
  const auto none = [](vtkEllipticSolver*, vtkEllipticSolver*) {};
  const std::vector<Compared> arrays = { { "Solution", false, Close },
    { "Gradient", true, Close } };
  MeshData bent = jittered(CellType::Triangle, 6, 0.1);
  bent.transform([](const Vec3& p) { return p[0] > 3 ? Vec3{ 3, p[1], 3 - p[0] } : p; });
  testFilter<vtkEllipticSolver>("bent", bent, set, arrays, none);
  // The normal has two components of equal size: pieces may take either sense of it.
  MeshData oblique = jittered(CellType::Triangle, 6, 0.1);
  oblique.transform(TAUTLINE_PLACE(0.1 * p[0], p[1], 0.1 * p[0]));
  testFilter<vtkEllipticSolver>("oblique", oblique, set, arrays, none);
  MeshData reversed = jittered(CellType::Triangle, 6, 0.1);
  for (Index cell = 0; cell < reversed.numberOfCells(); ++cell)
  {
    if (reversed.point(reversed.connectivity[reversed.offsets[cell]])[0] > 3)
    {
      std::swap(reversed.connectivity[reversed.offsets[cell]],
        reversed.connectivity[reversed.offsets[cell] + 1]);
    }
  }
  testFilter<vtkEllipticSolver>("reversed", reversed, set, arrays, none);
}

//------------------------------------------------------------------------------
/// Messages are those without redistribution, on all processes, and none waits.
void testRejections()
{
  const int rank = processes->GetLocalProcessId(), size = processes->GetNumberOfProcesses();
  const MeshData whole = blockMesh(CellType::Triangle, 6, 6, 0);
  const auto last = [size](Index cell) { return cell < 70 ? 0 : size - 1; };
  RankPart part = partOf(whole, rank, last);
  const RankPart good = part;
  // Cell 68 of the first process and one of the last one are inverted.
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    if (part.pointOf[p] == 47) // at (5, 6)
    {
      part.data.setPoint(static_cast<Index>(p), { 5, 4.9, 0 });
    }
  }
  for (const int how : Ways)
  {
    const Context context("divided " + std::to_string(how));
    vtkNew<vtkEllipticSolver> filter;
    Messages messages(filter);
    filter->SetRedistribute(how);
    const auto rejected = [&](const RankPart& piece, const std::string& text)
    {
      const Context inner(text);
      messages.clear();
      TAUTLINE_SET(filter, SetInputData(gridOf(piece)), Update());
      TAUTLINE_CHECK(messages.has(text));
      TAUTLINE_CHECK_EQUAL(outputOf(filter)->GetNumberOfCells(), 0);
    };
    rejected(part, wording("in-process-0-2-elements-the-first"));
    filter->SetSourceType(vtkEllipticSolver::EXPRESSION);
    filter->SetSourceExpression("1/((x - 6) + (y - 6))"); // at the last point only
    rejected(good, wording("is-not-finite-at-point"));
    TAUTLINE_SET(filter, SetSourceExpression("x"), SetFixedPart(vtkEllipticSolver::ONLY_CHOSEN));
    rejected(good, wording("without-a-fixed-point"));
    filter->SetFixedPart(vtkEllipticSolver::WHOLE_BOUNDARY);
    messages.clear();
    TAUTLINE_SET(filter, SetInputData(gridOf(good)), Update());
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK_EQUAL(
      outputOf(filter)->GetNumberOfCells(), static_cast<vtkIdType>(good.cellOf.size()));
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestDividedSolvers)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  processes = controller;
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testSolutions());
  TAUTLINE_RUN(testTime());
  TAUTLINE_RUN(testConditions());
  TAUTLINE_RUN(testSpaces());
  TAUTLINE_RUN(testRejections());
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
