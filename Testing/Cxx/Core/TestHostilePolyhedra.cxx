// SPDX-License-Identifier: BSD-3-Clause
// Polyhedra of any faces, made at random: filters report an error or have finite results.
#include "Registry.h"
#include "Set.h"
#include "VtkMeshes.h"

#include "vtkElementQuality.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshUntangler.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkIdList.h"

#include <limits>

using namespace tautline;

namespace
{
/// Numbers from 0 to below a count.
class Dice
{
public:
  explicit Dice(unsigned seed)
    : Numbers(seed)
  {
  }
  vtkIdType below(int count)
  {
    return std::min<vtkIdType>(
      count - 1, static_cast<vtkIdType>(this->Numbers.uniform(0, static_cast<double>(count))));
  }
  bool oneOf(int count) { return this->below(count) == 0; }
  double place() { return this->Numbers.uniform(-1, 1); }

private:
  Random Numbers;
};

/// A cube, or anything: faces of any size, points that are listed twice, facets.
void addCell(vtkUnstructuredGrid* grid, Dice& dice)
{
  const auto points = static_cast<int>(grid->GetNumberOfPoints());
  vtkNew<vtkIdList> ids;
  if (dice.oneOf(5))
  {
    const vtkIdType size = 3 + dice.below(3);
    for (vtkIdType i = 0; i < size; ++i)
    {
      ids->InsertNextId(dice.below(points));
    }
    grid->InsertNextCell(VTK_POLYGON, ids);
    return;
  }
  constexpr vtkIdType cube[6][4] = { { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 }, { 1, 2, 6, 5 },
    { 2, 3, 7, 6 }, { 3, 0, 4, 7 } };
  const bool isCube = dice.oneOf(2);
  const vtkIdType faces = isCube ? 6 : dice.below(7);
  ids->InsertNextId(faces);
  for (vtkIdType face = 0; face < faces; ++face)
  {
    const vtkIdType size = isCube && !dice.oneOf(6) ? 4 : 1 + dice.below(6);
    ids->InsertNextId(size);
    for (vtkIdType i = 0; i < size; ++i)
    {
      ids->InsertNextId(isCube && size == 4 ? cube[face][i] : dice.below(points));
    }
  }
  grid->InsertNextCell(VTK_POLYHEDRON, ids);
}

vtkSmartPointer<vtkUnstructuredGrid> hostileGrid(Dice& dice)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint((i % 4) % 3 ? 1 : 0, (i % 4) / 2, i / 4);
  }
  for (vtkIdType i = dice.below(4); i > 0; --i)
  {
    points->InsertNextPoint(dice.place(), dice.place(), dice.place());
  }
  if (dice.oneOf(6))
  {
    points->InsertNextPoint(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  }
  grid->SetPoints(points);
  for (vtkIdType i = 1 + dice.below(4); i > 0; --i)
  {
    addCell(grid, dice);
  }
  return grid;
}

/// @return whether the filter reports no error; then its cell arrays are finite
bool passes(vtkAlgorithm* filter)
{
  const Messages messages(filter);
  filter->Update();
  if (!messages.errors().empty())
  {
    return false;
  }
  auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (int k = 0; output && k < output->GetCellData()->GetNumberOfArrays(); ++k)
  {
    vtkDataArray* array = output->GetCellData()->GetArray(k);
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      TAUTLINE_CHECK(std::isfinite(array->GetComponent(i, 0)));
    }
  }
  return true;
}
}

TAUTLINE_PART(testHostilePolyhedra)
{
  constexpr int grids = 2000;
  int measured = 0, optimized = 0, untangled = 0;
  Dice dice(11);
  for (int number = 0; number < grids; ++number)
  {
    const Context context(std::to_string(number));
    const auto grid = hostileGrid(dice);
    TAUTLINE_NEW(vtkElementQuality, quality, SetInputData(grid));
    for (const char* name : { "non_orthogonality", "face_skewness", "fan_tet_quality",
           "cell_determinant", "orthogonal_quality", "face_twist" })
    {
      quality->AddMetricByName(name);
    }
    measured += passes(quality);
    TAUTLINE_NEW(vtkMeshOptimizer, optimizer, SetInputData(grid),
      SetPreset(vtkMeshOptimizer::FINITE_VOLUMES), SetBoundary(vtkMeshBoundaryAlgorithm::FREE),
      SetTimeLimit(1));
    optimized += passes(optimizer);
    TAUTLINE_NEW(vtkMeshUntangler, untangler, SetInputData(grid), SetTimeLimit(1));
    untangled += passes(untangler);
  }
  TAUTLINE_CHECK(measured > grids / 10 && optimized > grids / 20 && untangled > grids / 20);
}
