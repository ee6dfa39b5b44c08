// SPDX-License-Identifier: BSD-3-Clause
// The part of the boundary that Warp Mesh moves, shown before it moves: edges or faces of the hole,
// parts of blocks, what is chosen by arrays, by displacements, by a target; what Warp Mesh would
// reject.
#include "Registry.h"
#include "WarpingMeshes.h"
#include "vtkMovingBoundary.h"

using namespace tautline;

namespace
{
constexpr Index N = 7; // cubes in each direction, of which the middle one is missing

vtkPolyData* boundaryOf(vtkMovingBoundary* filter)
{
  filter->Update();
  return outputOf<vtkPolyData>(filter);
}

void checkBounds(vtkPolyData* data, double low, double high, double lowZ, double highZ)
{
  const double expected[6] = { low, high, low, high, lowZ, highZ };
  double bounds[6];
  data->GetBounds(bounds);
  TAUTLINE_EACH(int, i, 6, TAUTLINE_CHECK(bounds[i] == expected[i]));
}

TAUTLINE_PART(testHoles)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const bool flat = topology(type).dimension == 2;
    TAUTLINE_NEW(vtkMovingBoundary, filter, SetInputData(toGrid(holedBlock(type, N))));
    vtkPolyData* hole = boundaryOf(filter);
    TAUTLINE_CHECK(hole->GetNumberOfPoints() == (flat ? 4 : 8));
    TAUTLINE_CHECK(hole->GetNumberOfLines() == (flat ? 4 : 0));
    TAUTLINE_CHECK(hole->GetNumberOfPolys() == (flat ? 0 : type == CellType::Hexahedron ? 6 : 12));
    TAUTLINE_CHECK(hole->GetNumberOfVerts() == 0);
    checkBounds(hole, 3, 4, flat ? 0 : 3, flat ? 0 : 4);
    TAUTLINE_CHECK(contains(filter->GetSummary(), flat ? "4 points" : "8 points"));

    filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
    checkBounds(boundaryOf(filter), 0, N, 0, flat ? 0 : N);
    TAUTLINE_SET(filter, SetMovedPart(vtkMeshWarp::NUMBERED_PARTS), AddPart(2));
    checkBounds(boundaryOf(filter), 3, 4, flat ? 0 : 3, flat ? 0 : 4);
  }
}

/// A single point of the boundary is in no edge that moves; a point inside never moves.
TAUTLINE_PART(testSinglePoint)
{
  const MeshData data = holedBlock(CellType::Triangle, N);
  const auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf("moves", data.numberOfPoints(), 1,
    [&](Index i, int) {
      return norm(data.point(i)) == 0 || norm(data.point(i) - Vec3{ 1, 1, 0 }) == 0;
    }));
  TAUTLINE_NEW(vtkMovingBoundary, filter, SetInputData(grid),
    SetMovedPart(vtkMeshWarp::ARRAY_VALUES),
    SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "moves"));
  vtkPolyData* corner = boundaryOf(filter);
  TAUTLINE_CHECK(corner->GetNumberOfVerts() == 1 && corner->GetNumberOfPoints() == 1);
  TAUTLINE_CHECK(corner->GetNumberOfLines() == 0);
  checkBounds(corner, 0, 0, 0, 0);
}

TAUTLINE_PART(testDisplacementsAndTarget)
{
  const MeshData data = holedBlock(CellType::Triangle, N);
  const auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf("Displacement", data.numberOfPoints(), 3,
    [&](Index i, int k) { return k == 0 && data.point(i)[0] == N ? 1.0 : 0.0; }));
  TAUTLINE_NEW(vtkMovingBoundary, filter, SetInputData(grid), SetMotion(vtkMeshWarp::DISPLACEMENT));
  filter->SetAmount(0); // what moves does not depend on it
  vtkPolyData* side = boundaryOf(filter);
  TAUTLINE_CHECK(side->GetNumberOfLines() == N && side->GetNumberOfPoints() == N + 1);
  TAUTLINE_CHECK(side->GetBounds()[0] == N && side->GetBounds()[1] == N);

  MeshData moved = data;
  const std::vector<int> parts = partsOf(data, N);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    moved.setPoint(i, data.point(i) + Vec3{ parts[i] == 2 ? 0.25 : 0.0, 0, 0 });
  }
  TAUTLINE_SET(
    filter, SetInputData(1, toGrid(moved)), SetMotion(vtkMeshWarp::TARGET), SetAmount(1));
  checkBounds(boundaryOf(filter), 3, 4, 0, 0);
}

TAUTLINE_PART(testBlocks)
{
  MeshData far = holedBlock(CellType::Triangle, N);
  for (Index i = 0; i < far.numberOfPoints(); ++i)
  {
    far.setPoint(i, far.point(i) + Vec3{ 20, 20, 0 });
  }
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(holedBlock(CellType::Triangle, N))),
    SetBlock(1, toGrid(far)));
  TAUTLINE_NEW(vtkMovingBoundary, filter, SetInputDataObject(blocks));
  vtkPolyData* holes = boundaryOf(filter);
  TAUTLINE_CHECK(holes->GetNumberOfPoints() == 8 && holes->GetNumberOfLines() == 8);
  checkBounds(holes, 3, 24, 0, 0);
}

/// A missing choice is not an error, but a message in the summary; the next choice works.
TAUTLINE_PART(testNothingChosen)
{
  vtkNew<vtkMovingBoundary> filter;
  const Messages messages(filter);
  filter->SetInputData(toGrid(holedBlock(CellType::Triangle, N)));
  filter->SetMovedPart(vtkMeshWarp::ARRAY_VALUES);
  TAUTLINE_CHECK(boundaryOf(filter)->GetNumberOfPoints() == 0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("no-array-is-chosen")));
  filter->SetMotion(vtkMeshWarp::TIME_STEPS); // the whole boundary
  checkBounds(boundaryOf(filter), 0, N, 0, 0);
  filter->SetMotion(vtkMeshWarp::TARGET);
  TAUTLINE_CHECK(boundaryOf(filter)->GetNumberOfPoints() == 0);
  TAUTLINE_CHECK(messages.empty());
}
}
