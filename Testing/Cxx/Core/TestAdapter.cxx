// SPDX-License-Identifier: BSD-3-Clause
// Data sets of VTK through MeshAdapter: what is copied, what becomes of the cells, the messages.
#include "MeshAdapter.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkDataSetAttributes.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"

using namespace tautline;

namespace
{
std::vector<double> sizes(const MeshAdapter& adapter)
{
  return valuesOf(adapter.mesh(), Metric::Size);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testUnstructuredGrid)
{
  const MeshData data = blockMesh(CellType::Tetrahedron, 3, 2, 2);
  const Mesh expected(data.view());
  const std::vector<double> values = valuesOf(expected, Metric::InverseMeanRatio);

  const auto grid = toGrid(data);
  const MeshAdapter adapter(grid);
  TAUTLINE_CHECK_EQUAL(adapter.copiedBytes(), 0u);
  TAUTLINE_CHECK_EQUAL(adapter.notice(), "");
  TAUTLINE_CHECK(adapter.ghostCells() == nullptr);
  TAUTLINE_CHECK(adapter.mesh().view().points ==
    vtkDoubleArray::SafeDownCast(grid->GetPoints()->GetData())->GetPointer(0));
  TAUTLINE_CHECK(valuesOf(adapter.mesh(), Metric::InverseMeanRatio) == values);

  const auto floats = toGrid(data, VTK_FLOAT);
  const MeshAdapter fromFloats(floats);
  TAUTLINE_CHECK_EQUAL(fromFloats.copiedBytes(), data.points.size() * sizeof(double));
  TAUTLINE_CHECK(valuesOf(fromFloats.mesh(), Metric::InverseMeanRatio) == values);

  const auto narrow = TAUTLINE_CHANGED(toGrid(data), GetCells()->ConvertTo32BitStorage());
  const MeshAdapter fromNarrow(narrow);
  TAUTLINE_CHECK(fromNarrow.copiedBytes() >= data.connectivity.size() * sizeof(Index));
  TAUTLINE_CHECK(valuesOf(fromNarrow.mesh(), Metric::InverseMeanRatio) == values);

  // A cell that names a point the grid has not.
  MeshData bad = TAUTLINE_CHANGED(data, connectivity[4 * 6] = 10000);
  const auto broken = toGrid(bad);
  TAUTLINE_CHECK_THROWS(MeshAdapter rejected(broken), "Cell 6");
  for (int vtkType : { VTK_PIXEL, VTK_VOXEL, VTK_LAGRANGE_WEDGE })
  {
    // Too few points at the very end of the connectivity, and points the grid has not.
    for (Index node : { Index(1), Index(10000) })
    {
      bad = TAUTLINE_CHANGED(data, addCell(vtkType, std::vector<Index>{ 0, node, 2 }));
      const auto last = toGrid(bad);
      TAUTLINE_CHECK_THROWS(
        MeshAdapter rejected(last), "Cell " + std::to_string(data.numberOfCells()));
    }
    bad = data;
    bad.addCell(vtkType, std::vector<Index>(vtkType == VTK_PIXEL ? 4 : 8, Index(1) << 40));
    const auto far = toGrid(bad);
    TAUTLINE_CHECK_THROWS(MeshAdapter rejected(far), "Cell ");
  }
}

/// Pixels and voxels count rows of points; polygons of three and four points are triangles and
/// quadrilaterals.
TAUTLINE_PART(testRelatedTypes)
{
  MeshData data = blockMesh(CellType::Hexahedron, 1, 1, 1); // its points form a voxel
  data.connectivity = { 0, 1, 2, 3, 4, 5, 6, 7 };
  TAUTLINE_SET(data, types[0] = VTK_VOXEL,
    addCell(VTK_TRIANGLE_STRIP, std::vector<Index>{ 0, 1, 2, 3 }),
    addCell(VTK_PIXEL, std::vector<Index>{ 0, 1, 2, 3 }),
    addCell(VTK_POLYGON, std::vector<Index>{ 0, 1, 3 }),
    addCell(VTK_POLYGON, std::vector<Index>{ 0, 1, 3, 2 }),
    addCell(VTK_POLYGON, std::vector<Index>{ 0, 1, 5, 7, 2 }),
    addCell(VTK_VERTEX, std::vector<Index>{ 0 }),
    addCell(VTK_TRIANGLE, std::vector<Index>{ 0, 1, 2 }));
  const auto grid = toGrid(data);
  const MeshAdapter adapter(grid);
  const std::vector<double> expected = { 1, 0, 1, 0.5, 1, 0, 0, 0.5 };
  TAUTLINE_CHECK(sizes(adapter) == expected);
  const std::vector<signed char> validity = validityOf(adapter.mesh());
  TAUTLINE_EACH(std::size_t, i, expected.size(),
    TAUTLINE_CHECK_EQUAL(int(validity[i]), int(expected[i] > 0 ? Valid : NotMeasured)));
  TAUTLINE_CHECK(!contains(adapter.notice(), "vtkVertex")); // no quality is expected of it
  TAUTLINE_CHECK(contains(adapter.notice(), "1 vtkPolygon"));
  TAUTLINE_CHECK(contains(adapter.notice(), "1 vtkTriangleStrip"));
  TAUTLINE_CHECK(contains(adapter.notice(), wording("run-tetrahedralize-first")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testPolyData)
{
  const MeshData data = blockMesh(CellType::Triangle, 3, 2, 0);
  const auto poly = toPolyData(data);
  const MeshAdapter onlyPolys(poly);
  TAUTLINE_CHECK_EQUAL(
    onlyPolys.copiedBytes(), static_cast<std::size_t>(data.numberOfCells())); // the types
  TAUTLINE_CHECK(sizes(onlyPolys) == valuesOf(data, Metric::Size));

  // Cells of a vtkPolyData are numbered vertices, lines, polygons, strips.
  vtkNew<vtkCellArray> verts, lines, strips;
  verts->InsertNextCell({ 0 });
  TAUTLINE_SET(lines, InsertNextCell({ 0, 1 }), InsertNextCell({ 1, 2, 3 }));
  strips->InsertNextCell({ 0, 4, 1, 5 });
  TAUTLINE_SET(poly, SetVerts(verts), SetLines(lines), SetStrips(strips));
  const MeshAdapter all(poly);
  const std::vector<double> values = sizes(all);
  TAUTLINE_CHECK_EQUAL(values.size(), static_cast<std::size_t>(data.numberOfCells() + 4));
  for (Index i = 0; i < static_cast<Index>(values.size()); ++i)
  {
    const bool triangle = i >= 3 && i < 3 + data.numberOfCells();
    TAUTLINE_CHECK_EQUAL(values[i], triangle ? 0.5 : 0.0);
  }
  TAUTLINE_CHECK(all.mesh().dimension() == Dimension::Planar);
  TAUTLINE_CHECK(contains(all.notice(), wording("not-measured-1-vtktrianglestrip")));
}

//------------------------------------------------------------------------------
/// All cells valid, of the size given, and in VTK's order.
void checkBlock(vtkDataSet* input, Dimension dimension, const std::vector<double>& expected)
{
  const MeshAdapter adapter(input);
  const Mesh& mesh = adapter.mesh();
  TAUTLINE_CHECK(mesh.dimension() == dimension);
  TAUTLINE_CHECK_EQUAL(adapter.notice(), "");
  const std::vector<signed char> validity = validityOf(mesh);
  TAUTLINE_CHECK_EQUAL(mesh.orientation(validity.data()).state, Orientation::Consistent);
  const std::vector<double> values = sizes(adapter);
  TAUTLINE_CHECK_EQUAL(values.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(int(validity[i]), int(Valid));
    TAUTLINE_CHECK_NEAR(values[i], expected[i], 1e-12);
    // The adapter's cell has the points of VTK's.
    vtkNew<vtkIdList> ids;
    input->GetCellPoints(static_cast<vtkIdType>(i), ids);
    std::vector<Index> theirs(ids->begin(), ids->end());
    std::vector<Index> ours(mesh.view().connectivity + mesh.view().offsets[i],
      mesh.view().connectivity + mesh.view().offsets[i + 1]);
    std::sort(theirs.begin(), theirs.end());
    std::sort(ours.begin(), ours.end());
    TAUTLINE_CHECK(ours == theirs);
  }
}

TAUTLINE_PART(testStructured)
{
  TAUTLINE_NEW(
    vtkImageData, image, SetSpacing(0.5, 2, 3), SetOrigin(1, 2, 3), SetDimensions(3, 4, 5));
  checkBlock(image, Dimension::Volume, std::vector<double>(2 * 3 * 4, 3.0));
  image->SetDimensions(3, 4, 1);
  checkBlock(image, Dimension::Planar, std::vector<double>(2 * 3, 1.0));
  image->SetDimensions(1, 4, 5);
  checkBlock(image, Dimension::Planar, std::vector<double>(3 * 4, 6.0));
  {
    const Context context("image in the plane y = 2");
    image->SetDimensions(3, 1, 5);
    checkBlock(image, Dimension::Planar, std::vector<double>(2 * 4, 1.5));
  }

  vtkNew<vtkRectilinearGrid> rectilinear;
  vtkNew<vtkDoubleArray> x, y, z;
  for (double value : { 0.0, 1.0, 3.0 })
  {
    x->InsertNextValue(value);
    y->InsertNextValue(2 * value);
    z->InsertNextValue(3 * value);
  }
  TAUTLINE_SET(rectilinear, SetDimensions(3, 3, 3), SetXCoordinates(x), SetYCoordinates(y),
    SetZCoordinates(z));
  checkBlock(rectilinear, Dimension::Volume, { 6, 12, 12, 24, 12, 24, 24, 48 });

  for (int layers : { 1, 2 })
  {
    vtkNew<vtkStructuredGrid> structured;
    vtkNew<vtkPoints> points;
    for (int k = 0; k < layers; ++k)
    {
      for (int j = 0; j < 3; ++j)
      {
        for (int i = 0; i < 4; ++i)
        {
          points->InsertNextPoint(i + 0.25 * j, j, k); // sheared
        }
      }
    }
    TAUTLINE_SET(structured, SetDimensions(4, 3, layers), SetPoints(points));
    checkBlock(
      structured, layers == 1 ? Dimension::Planar : Dimension::Volume, std::vector<double>(6, 1.0));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testEmpty)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPolyData> poly;
  vtkNew<vtkImageData> image;
  vtkNew<vtkStructuredGrid> structured;
  for (vtkDataSet* input : std::initializer_list<vtkDataSet*>{ grid, poly, image, structured })
  {
    const MeshAdapter adapter(input);
    TAUTLINE_CHECK(adapter.mesh().dimension() == Dimension::None);
    TAUTLINE_CHECK_EQUAL(adapter.mesh().view().numberOfCells, 0);
    TAUTLINE_CHECK(sizes(adapter).empty());
    TAUTLINE_CHECK(gradientsOf(adapter.mesh(), Metric::Size).gradients.empty());
    TAUTLINE_CHECK_EQUAL(MetricSum(adapter.mesh(), Metric::Size, {}, 1).value(), 0.0);
    TAUTLINE_CHECK_EQUAL(adapter.notice(), "");
  }
  // Points without cells.
  grid->SetPoints(toPoints(blockMesh(CellType::Triangle, 1, 1, 0), VTK_DOUBLE));
  TAUTLINE_CHECK_EQUAL(MeshAdapter(grid).mesh().boundary().isBoundaryPoint.size(), 4u);
}

TAUTLINE_PART(testNotices)
{
  MeshData data = blockMesh(CellType::Quadrilateral, 2, 2, 0);
  data.setPoint(4, { std::nan(""), 0, 0 });
  const auto broken = toGrid(data);
  TAUTLINE_CHECK(contains(MeshAdapter(broken).notice(), wording("1-points-have-a-nan")));

  const auto grid = toGrid(blockMesh(CellType::Quadrilateral, 2, 2, 0));
  const auto ghosts = filledArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(),
    std::vector<unsigned char>{ 0, 1, 0, 0 }, [&](unsigned char flag) { return flag; });
  grid->GetCellData()->AddArray(ghosts);
  const MeshAdapter adapter(grid);
  TAUTLINE_CHECK(
    adapter.ghostCells() && adapter.ghostCells()[1] == 1 && adapter.ghostCells()[2] == 0);
}

TAUTLINE_PART(testDescription)
{
  MeshData data = blockMesh(CellType::Quadrilateral, 3, 3, 0);
  auto description = [](const MeshData& mesh)
  {
    const auto grid = toGrid(mesh);
    const MeshAdapter adapter(grid);
    const std::vector<signed char> validity = validityOf(adapter.mesh());
    return describe(adapter.mesh().orientation(validity.data()), adapter.mesh());
  };
  TAUTLINE_CHECK_EQUAL(description(data), "");
  std::swap(data.connectivity[1], data.connectivity[3]);
  TAUTLINE_CHECK(contains(description(data), "mixed"));
  TAUTLINE_CHECK(contains(description(data), "2 edges"));
  data.swapNodes(1, 3, 1);
  TAUTLINE_CHECK(contains(description(data), "reversed"));
  TAUTLINE_CHECK(contains(description(data), "9 of 9"));
}

TAUTLINE_PART(testMakePoints)
{
  const std::vector<double> coordinates = { 0.1, 0.2, 0.3, 4, 5, 6 };
  for (int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    TAUTLINE_NEW(vtkPoints, like, SetDataType(precision));
    const auto points = makePoints(coordinates, like);
    TAUTLINE_CHECK_EQUAL(points->GetDataType(), precision);
    TAUTLINE_CHECK_EQUAL(points->GetNumberOfPoints(), 2);
    TAUTLINE_CHECK_NEAR(points->GetPoint(0)[1], 0.2, precision == VTK_FLOAT ? 1e-8 : 0);
  }
  TAUTLINE_CHECK_EQUAL(makePoints(coordinates, nullptr)->GetDataType(), VTK_DOUBLE);
}
}
