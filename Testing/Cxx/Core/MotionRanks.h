// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MotionRanks.h
 * @brief Filters that move the points of a mesh in pieces, on processes and on one, for tests.
 */
#ifndef tautline_MotionRanks_h
#define tautline_MotionRanks_h

#include "ThreadRanks.h"
#include "VtkMeshes.h"

#include "vtkMPIController.h"

namespace tautline
{
/// The piece as a grid, with its arrays.
inline vtkSmartPointer<vtkUnstructuredGrid> gridOf(const RankPart& part)
{
  auto grid = toGrid(part.data);
  const auto ghosts =
    filledArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(), part.ghosts,
      [&](const unsigned char ghost) { return ghost ? vtkDataSetAttributes::DUPLICATECELL : 0; });
  grid->GetCellData()->AddArray(ghosts);
  // Fixed points, limits and kinds of features, by the points of the whole mesh.
  vtkNew<vtkDoubleArray> fixed, limits, kinds;
  fixed->SetName("fixed");
  limits->SetName("limits");
  kinds->SetName("kinds");
  for (const Index p : part.pointOf)
  {
    fixed->InsertNextValue(p % 11 == 0);
    limits->InsertNextValue(p % 3 == 0 ? 0.05 : -1);
    kinds->InsertNextValue(p % 11 == 0 ? 2 : -1); // a corner, or as found
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(fixed), GetPointData()->AddArray(limits),
    GetPointData()->AddArray(kinds));
  // Weights (0 of the first half), sizes, regions and metric tensors, by the cells.
  vtkNew<vtkDoubleArray> weights, wrong, sizes, regions, tensors;
  weights->SetName("weights");
  wrong->SetName("wrong");
  sizes->SetName("sizes");
  regions->SetName("regions");
  TAUTLINE_SET(tensors, SetName("tensors"), SetNumberOfComponents(9));
  for (std::size_t i = 0; i < part.cellOf.size(); ++i)
  {
    const auto cell = static_cast<double>(part.cellOf[i]);
    weights->InsertNextValue(part.cellOf[i] < 190 ? 0.0 : 1.0 + std::fmod(cell, 5));
    wrong->InsertNextValue(part.cellOf[i] == 7 ? -1.0 : 1.0);
    sizes->InsertNextValue((1.0 + std::fmod(cell, 3)) / 6.0);
    regions->InsertNextValue(part.cellOf[i] < 160 ? 7 : -2); // half of 4 x 4 x 4 cubes
    const double tensor[9] = { 1.0 + 0.001 * cell, 0, 0, 0, 1, 0, 0, 0, 1 };
    tensors->InsertNextTuple(tensor);
  }
  TAUTLINE_SET(grid, GetCellData()->AddArray(weights), GetCellData()->AddArray(wrong),
    GetCellData()->AddArray(sizes), GetCellData()->AddArray(regions),
    GetCellData()->AddArray(tensors));
  return grid;
}

/// The same with the numbers of the whole mesh, in whose order it is put together.
inline vtkSmartPointer<vtkUnstructuredGrid> numberedGridOf(const RankPart& part)
{
  auto grid = gridOf(part);
  vtkNew<vtkIdTypeArray> points, cells;
  points->SetName("point ids");
  cells->SetName("cell ids");
  for (const Index p : part.pointOf)
  {
    points->InsertNextValue(p);
  }
  for (const Index cell : part.cellOf)
  {
    cells->InsertNextValue(cell);
  }
  TAUTLINE_SET(grid, GetPointData()->SetGlobalIds(points), GetCellData()->SetGlobalIds(cells));
  return grid;
}

/// The points that a filter gives, in the order of the whole mesh; HUGE_VAL elsewhere.
template <class Filter, class Set>
std::vector<double> moved(const MeshData& whole, const RankPart& part, vtkUnstructuredGrid* grid,
  const Set& set, Filter* filter)
{
  filter->SetInputData(grid);
  set(filter);
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(!messages.has("ERROR: "));
  std::vector<double> points(whole.points.size(), HUGE_VAL);
  auto* output = outputOf<vtkUnstructuredGrid>(filter);
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfPoints(), grid->GetNumberOfPoints());
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), grid->GetNumberOfCells());
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    output->GetPoint(p, &points[3 * part.pointOf[p]]);
  }
  return points;
}

/// The same of a part of the mesh, with a check of the displacements.
template <class Filter, class Set>
std::vector<double> pointsOf(const MeshData& whole, const RankPart& part, const Set& set,
  Filter* filter, bool numbered = false)
{
  const auto grid = numbered ? numberedGridOf(part) : gridOf(part);
  std::vector<double> points = moved(whole, part, grid.Get(), set, filter);
  auto* output = outputOf<vtkUnstructuredGrid>(filter);
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    double way[3];
    output->GetPointData()->GetArray("Displacement")->GetTuple(p, way);
    TAUTLINE_CHECK(std::abs(grid->GetPoint(p)[0] + way[0] - output->GetPoint(p)[0]) <= 1e-14);
  }
  return points;
}

/// Points that are here are within 1e-10 of those expected.
inline void checkSame(const std::vector<double>& here, const std::vector<double>& expected)
{
  double farthest = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
  {
    const double far = here[i] == HUGE_VAL ? 0.0 : std::abs(here[i] - expected[i]);
    const bool broken = std::isnan(expected[i]) && std::isnan(here[i]);
    farthest = broken || far <= farthest ? farthest : far; // NaN stays
    TAUTLINE_CHECK(!std::isnan(farthest));
  }
  TAUTLINE_CHECK(farthest <= 1e-10);
}

/// Settings that need the whole mesh: it is put together, as the summary states; the points equal
/// the result of one process in its own order. `set` also gets the part.
template <class Filter, class Set>
void testGathered(const char* name, vtkMPIController* controller, const MeshData& whole,
  const char* sentence, const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart all = partOf(whole, 0, [](Index) { return 0; });
  vtkNew<Filter> serial;
  const auto setFor = [&set](const RankPart& part)
  { return [&set, &part](Filter* filter) { set(filter, part); }; };
  vtkMultiProcessController::SetGlobalController(nullptr);
  const std::vector<double> expected = pointsOf(whole, all, setFor(all), serial.Get(), true);
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_CHECK(!contains(serial->GetSummary(), wording("put-together")));
  double moved = largestOf<double>(
    0, expected.size(), [&](std::size_t i) { return std::abs(expected[i] - whole.points[i]); });
  TAUTLINE_CHECK(moved > 0.01);
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const Context inner("cut " + std::to_string(static_cast<int>(cut)));
    const RankPart part = partOf(whole, rank, cutBy(whole, cut, size), cut == Cut::Slabs);
    vtkNew<Filter> filter;
    checkSame(pointsOf(whole, part, setFor(part), filter.Get(), true), expected);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), serial->GetInvertedAfter());
    const std::string summary = filter->GetSummary();
    const std::string last =
      std::string("\nThe mesh was put together on the first process: ") + sentence + ".";
    TAUTLINE_CHECK_EQUAL(
      summary.substr(summary.size() - std::min(summary.size(), last.size())), last);
  }
}
}
#endif
