// SPDX-License-Identifier: BSD-3-Clause
// The check of VTK's data objects: its findings and their names. TestHostileInput tests the
// reaction of filters to such data.
#include "Registry.h"
#include "ValidateInput.h"
#include "VtkCompatibility.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/ArrayChecks.h"
#include "vtkStructuredGrid.h"

using namespace tautline;

namespace
{
constexpr Index Many = 300000; // several chunks
const double NaN = std::numeric_limits<double>::quiet_NaN();

/// The problem of a data object contains a text; or, with "", there is none.
void expect(vtkDataObject* data, const std::string& text, const InputRules& rules = {})
{
  const std::string problem = inputProblem(data, rules);
  if (text.empty() ? !problem.empty() : !contains(problem, text))
  {
    fail(__FILE__, __LINE__) << "found \"" << problem << "\", expected \"" << text << "\"\n";
  }
  if (!text.empty())
  {
    TAUTLINE_CHECK_THROWS(validateInput(data, rules), text);
  }
}

vtkSmartPointer<vtkUnstructuredGrid> solid()
{
  return toGrid(blockMesh(CellType::Tetrahedron, 2, 2, 2)); // 27 points, 40 cells
}

/// The place is the first, with any number of threads, wherever it is.
TAUTLINE_PART(testSearches)
{
  std::vector<std::int64_t> wide(Many, 5);
  std::vector<std::int32_t> narrow(Many, 5);
  std::vector<double> doubles(Many, 1e308);
  std::vector<float> floats(Many, -3e38f);
  std::vector<std::int64_t> offsets(Many + 1);
  for (Index i = 0; i <= Many; ++i)
  {
    offsets[i] = 4 * i;
  }
  const std::vector<unsigned char> types(Many, 10);
  TAUTLINE_LET(CellSizes, sizes, points[10] = 4);
  for (const int threads : { 1, 2, 7 })
  {
    TAUTLINE_CHECK_EQUAL(findIdOutside(wide.data(), Many, 6, threads), -1);
    TAUTLINE_CHECK_EQUAL(findIdOutside(wide.data(), Many, 5, threads), 0);
    TAUTLINE_CHECK_EQUAL(findIdOutside(wide.data(), Many, 0, threads), 0);
    TAUTLINE_CHECK_EQUAL(findIdOutside(narrow.data(), Many, 6, threads), -1);
    TAUTLINE_CHECK_EQUAL(findIdOutside(narrow.data(), Many, Index(1) << 40, threads), -1);
    TAUTLINE_CHECK_EQUAL(findNonFinite(doubles.data(), Many, threads), -1);
    TAUTLINE_CHECK_EQUAL(findNonFinite(floats.data(), Many, threads), -1);
    TAUTLINE_CHECK_EQUAL(findWrongSize(offsets.data(), types.data(), Many, sizes, threads), -1);
    TAUTLINE_CHECK_EQUAL(findTooShort(offsets.data(), Many, 4, threads), -1);
    TAUTLINE_CHECK_EQUAL(findTooShort(offsets.data(), Many, 5, threads), 0);
  }
  // The later defect first, so that the earlier one has to replace it.
  for (const Index place : { Many - 1, Index(123457), Index(4096), Index(4095), Index(0) })
  {
    wide[place] = -1;
    narrow[place] = -1;
    doubles[place] = place % 2 == 0 ? NaN : std::numeric_limits<double>::infinity();
    floats[place] = -std::numeric_limits<float>::infinity();
    for (const int threads : { 1, 2, 7 })
    {
      TAUTLINE_CHECK_EQUAL(findIdOutside(wide.data(), Many, 6, threads), place);
      TAUTLINE_CHECK_EQUAL(findIdOutside(narrow.data(), Many, 6, threads), place);
      TAUTLINE_CHECK_EQUAL(findNonFinite(doubles.data(), Many, threads), place);
      TAUTLINE_CHECK_EQUAL(findNonFinite(floats.data(), Many, threads), place);
    }
  }
  offsets[70001] = std::numeric_limits<std::int64_t>::min();
  TAUTLINE_CHECK_EQUAL(findWrongSize(offsets.data(), types.data(), Many, sizes, 2), 70000);
  TAUTLINE_CHECK_EQUAL(findTooShort(offsets.data(), Many, 0, 2), 70000);
}

TAUTLINE_PART(testArrays)
{
  const auto add = [](auto array, const char* name, vtkIdType tuples, bool ofCells)
  {
    const auto mesh = solid();
    TAUTLINE_SET(array, SetName(name), SetNumberOfTuples(tuples));
    (ofCells ? static_cast<vtkFieldData*>(mesh->GetCellData()) : mesh->GetPointData())
      ->AddArray(array);
    return mesh;
  };
  expect(solid(), "");
  expect(add(vtkSmartPointer<vtkIntArray>::New(), "a", 27, false), "");
  expect(add(vtkSmartPointer<vtkIntArray>::New(), "a", 26, false),
    wording("the-point-array-a-has-26-tuples"));
  expect(add(vtkSmartPointer<vtkIntArray>::New(), "b", 41, true),
    wording("the-cell-array-b-has-41-tuples"));
  expect(
    add(vtkSmartPointer<vtkStringArray>::New(), "c", 1, true), wording("the-cell-array-c-has-1"));
  expect(add(vtkSmartPointer<vtkUnsignedCharArray>::New(), "vtkGhostType", 40, true), "");
  expect(add(vtkSmartPointer<vtkIntArray>::New(), "vtkGhostType", 40, true),
    wording("vtkghosttype-marks-ghosts-and-has-to-be"));
  const auto noPoints = solid();
  noPoints->GetPoints()->SetNumberOfPoints(20);
  expect(noPoints, wording("but-the-mesh-has-20-points-0"));
}

TAUTLINE_PART(testCells)
{
  using Array = vtkAOSDataArrayTemplate<vtkTypeInt64>;
  const auto wrong = [](const std::string& text, const std::function<void(Array*, Array*)>& how)
  {
    const auto mesh = solid();
    mesh->GetCells()->ConvertTo64BitStorage();
    how(offsets64(mesh->GetCells()), connectivity64(mesh->GetCells()));
    expect(mesh, text);
    mesh->GetCells()->ConvertTo32BitStorage();
    expect(mesh, text);
  };
  wrong("Cell 2 lists point 27, but the mesh has 27 points (0 to 26)",
    [](auto*, auto* ids) { ids->SetValue(9, 27); });
  wrong("Cell 39 lists point -1,", [](auto*, auto* ids) { ids->SetValue(159, -1); });
  wrong("Cell 3 is not a valid vtkTetra: it lists 5 points",
    [](auto* offsets, auto*) { offsets->SetValue(4, 17); });
  wrong("Cell 1 has an invalid range in the connectivity: its offsets descend from 4 to 3",
    [](auto* offsets, auto*) { offsets->SetValue(2, 3); });
  wrong("Cell 0 begins at position 1 of the connectivity, not at 0",
    [](auto* offsets, auto*) { offsets->SetValue(0, 1); });
  wrong("The offsets of the cells end at 160, but the connectivity has 159 entries",
    [](auto*, auto* ids) { ids->SetNumberOfValues(159); });
  const auto types = solid();
  cellTypesOf(types)->SetValue(7, VTK_HEXAHEDRON);
  expect(types, wording("cell-7-is-not-a-proper-vtkhexahedron"));
  cellTypesOf(types)->SetValue(7, 250);
  expect(types, wording("cell-7-has-the-type-250-which"));
  cellTypesOf(types)->SetNumberOfValues(39);
  expect(types, wording("there-are-40-cells-but-39-cell"));

  const auto poly = toPolyData(blockMesh(CellType::Triangle, 2, 2, 0));
  vtkNew<vtkCellArray> lines;
  const vtkIdType line[] = { 0, 1 };
  lines->InsertNextCell(2, line);
  poly->SetLines(lines);
  expect(poly, "");
  TAUTLINE_NEW(vtkCellArray, polys, DeepCopy(poly->GetPolys()), InsertNextCell(2, line));
  poly->SetPolys(polys);
  expect(poly, wording("cell-9-is-not-a-proper-polygon"));
}

TAUTLINE_PART(testOthers)
{
  const auto mesh = solid();
  mesh->GetPoints()->SetPoint(5, 0, NaN, 0);
  expect(mesh, "");
  expect(mesh, wording("point-5-has-a-coordinate-that-is"), { true, 1 });

  TAUTLINE_NEW(vtkStructuredGrid, grid, SetDimensions(3, 3, 2));
  TAUTLINE_NEW(vtkPoints, points, SetNumberOfPoints(17));
  grid->SetPoints(points);
  expect(grid, wording("the-grid-has-17-points-but-its"));
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(2, 2, 2));
  expect(image, "");
  image->SetSpacing(1, NaN, 1);
  expect(image, wording("the-spacing-or-the-origin-of-the"));

  vtkNew<vtkTable> table;
  expect(table, wording("the-input-is-a-vtktable-not-a"));
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, table));
  expect(blocks, wording("none-of-the-blocks-is-a-mesh"));
  TAUTLINE_SET(blocks, SetBlock(1, nullptr), SetBlock(2, solid()));
  expect(blocks, "");
  TAUTLINE_CHECK_EQUAL(
    skippedLeaves(blocks), "Blocks that are not meshes are left out: 1 (vtkTable).");
  blocks->SetBlock(3, grid);
  expect(blocks, wording("in-block-4-the-grid-has-17"));
  expect(nullptr, "");
}

TAUTLINE_PART(testSelections)
{
  const auto problem = [](vtkAbstractArray* ids, int field, vtkDataObject* mesh)
  {
    TAUTLINE_NEW(vtkSelectionNode, node, SetContentType(vtkSelectionNode::INDICES),
      SetFieldType(field), SetSelectionList(ids));
    TAUTLINE_NEW(vtkSelection, selection, AddNode(node));
    return selectionProblem(selection, mesh);
  };
  const auto mesh = solid();
  TAUTLINE_NEW(vtkIdTypeArray, ids, InsertNextValue(26));
  TAUTLINE_CHECK_EQUAL(problem(ids, vtkSelectionNode::POINT, mesh), "");
  ids->InsertNextValue(27);
  TAUTLINE_CHECK_EQUAL(problem(ids, vtkSelectionNode::CELL, mesh), "");
  TAUTLINE_CHECK_EQUAL(problem(ids, vtkSelectionNode::POINT, mesh),
    "The selection names point 27, but the mesh has 27 points: it was made on another mesh; select "
    "again.");
  TAUTLINE_NEW(vtkStringArray, text, InsertNextValue("7"));
  TAUTLINE_CHECK_EQUAL(problem(text, vtkSelectionNode::POINT, mesh),
    "The selection lists text instead of ids: select again.");
  TAUTLINE_CHECK_EQUAL(selectionProblem(nullptr, mesh), "");
}
}
