// SPDX-License-Identifier: BSD-3-Clause
#include "HostileParts.h"
#include "VtkCompatibility.h"
#include "VtkMeshes.h"
#include "vtkAMRBox.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkHyperTreeGrid.h"
#include "vtkMolecule.h"
#include "vtkMutableUndirectedGraph.h"
#include "vtkOverlappingAMR.h"
#include "vtkRectilinearGrid.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkUniformGrid.h"

#include <sstream>

namespace tautline
{

namespace
{
using Data = vtkSmartPointer<vtkDataObject>;

Data grid(const MeshData& mesh)
{
  return toGrid(mesh);
}

/** A mesh of cells of one type, each with its points in a row. */
Data cells(int type, const std::vector<Vec3>& points, const std::vector<std::vector<Index>>& nodes)
{
  TAUTLINE_LET(MeshData, mesh, addPoints(points));
  for (const auto& cell : nodes)
  {
    mesh.addCell(type, cell);
  }
  return grid(mesh);
}

Data cubePolyhedron()
{
  const MeshData cube = blockMesh(CellType::Hexahedron, 1, 1, 1);
  auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
  mesh->SetPoints(toPoints(cube));
  const vtkIdType ids[] = { 0, 1, 2, 3, 4, 5, 6, 7 };
  const vtkIdType faces[] = { 4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4, 4, 2, 6, 7, 3, 4, 0, 4,
    6, 2, 4, 1, 3, 7, 5 };
  mesh->InsertNextCell(VTK_POLYHEDRON, 8, ids, 6, faces);
  return mesh;
}

Data image(int x, int y, int z)
{
  return TAUTLINE_CHANGED(vtkSmartPointer<vtkImageData>::New(), SetDimensions(x, y, z),
    GetPointData()->SetScalars(makeArray<vtkDoubleArray>("T", Index(x) * y * z)));
}

Data rectilinear()
{
  auto result = vtkSmartPointer<vtkRectilinearGrid>::New();
  result->SetDimensions(4, 3, 2);
  const auto axis = [](int n)
  {
    auto array = makeArray<vtkDoubleArray>("", n);
    for (int i = 0; i < n; ++i)
    {
      array->SetValue(i, i * (i + 1.0));
    }
    return array;
  };
  TAUTLINE_SET(
    result, SetXCoordinates(axis(4)), SetYCoordinates(axis(3)), SetZCoordinates(axis(2)));
  return result;
}

vtkSmartPointer<vtkStructuredGrid> structured(int points)
{
  auto result = TAUTLINE_CHANGED(vtkSmartPointer<vtkStructuredGrid>::New(), SetDimensions(4, 3, 1));
  TAUTLINE_NEW(vtkPoints, place, SetDataType(VTK_DOUBLE));
  for (int i = 0; i < points; ++i)
  {
    place->InsertNextPoint(i % 4 + 0.1 * (i / 4), i / 4, 0);
  }
  result->SetPoints(place);
  return result;
}

Data hyperTreeGrid()
{
  return TAUTLINE_CHANGED(vtkSmartPointer<vtkHyperTreeGrid>::New(), SetDimensions(3, 3, 1));
}

Data amr()
{
  auto result = vtkSmartPointer<vtkOverlappingAMR>::New();
  const double origin[] = { 0, 0, 0 }, spacing[] = { 1, 1, 1 };
  initializeLevels(result, { 1 });
  TAUTLINE_SET(result, SetOrigin(origin), SetSpacing(0, spacing));
  TAUTLINE_NEW(vtkUniformGrid, leaf, SetDimensions(4, 4, 4));
  result->SetAMRBox(0, 0, vtkAMRBox(origin, leaf->GetDimensions(), spacing, origin));
  result->SetDataSet(0, 0, leaf);
  return result;
}

Data explicitStructured(Index wrong)
{
  const MeshData mesh = blockMesh(CellType::Hexahedron, 2, 1, 1);
  auto result = vtkSmartPointer<vtkExplicitStructuredGrid>::New();
  TAUTLINE_SET(result, SetPoints(toPoints(mesh)), SetDimensions(3, 2, 2));
  vtkNew<vtkCellArray> list;
  for (Index cell = 0; cell < 2; ++cell)
  {
    std::vector<vtkIdType> ids(
      mesh.connectivity.begin() + 8 * cell, mesh.connectivity.begin() + 8 * (cell + 1));
    ids[0] += wrong;
    list->InsertNextCell(8, ids.data());
  }
  result->SetCells(list);
  return result;
}

Data graph()
{
  auto result = vtkSmartPointer<vtkMutableUndirectedGraph>::New();
  const vtkIdType a = result->AddVertex(), b = result->AddVertex();
  result->AddEdge(a, b);
  return result;
}

Data molecule()
{
  auto result = vtkSmartPointer<vtkMolecule>::New();
  TAUTLINE_SET(result, AppendAtom(1, 0, 0, 0), AppendAtom(8, 0, 0, 1));
  return result;
}

//------------------------------------------------------------------------------
Data fixedData(const Data& data)
{
  return data;
}

/** One that does not depend on what suits the filter. */
HostileData fixed(const char* name, const std::function<Data()>& make,
  Expected expected = Expected::Anything, bool nonFinite = false)
{
  return { name, [make](vtkDataObject*) { return fixedData(make()); }, expected, false, nonFinite };
}
}

//------------------------------------------------------------------------------
Data makeTable()
{
  auto result = vtkSmartPointer<vtkTable>::New();
  result->AddColumn(makeArray<vtkDoubleArray>("T", 5));
  return result;
}

//------------------------------------------------------------------------------
Data makeBlocks(const std::vector<Data>& leaves)
{
  auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (const Data& leaf : leaves)
  {
    result->SetBlock(result->GetNumberOfBlocks(), leaf);
  }
  return result;
}

#define MESH(...) [=]() -> Data { return __VA_ARGS__; }

//------------------------------------------------------------------------------
void addHostileMeshes(std::vector<HostileData>& list)
{
  const auto add = [&list](const char* name, const std::function<Data()>& make,
                     Expected expected = Expected::Anything)
  { list.push_back(fixed(name, make, expected)); };
  add("empty grid", MESH((vtkSmartPointer<vtkUnstructuredGrid>::New())));
  add("empty surface", MESH((vtkSmartPointer<vtkPolyData>::New())));
  add("points only", MESH(cells(VTK_VERTEX, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {})));
  add("one triangle",
    MESH(cells(VTK_TRIANGLE, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } })));
  add("one tetrahedron",
    MESH(cells(
      VTK_TETRA, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { { 0, 1, 2, 3 } })));
  add("a triangle in a point",
    MESH(cells(VTK_TRIANGLE, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 1, 1, 1 } })));
  add("vertices", MESH(cells(VTK_VERTEX, { { 0, 0, 0 }, { 1, 0, 0 } }, { { 0 }, { 1 } })));
  add("lines", MESH(cells(VTK_LINE, { { 0, 0, 0 }, { 1, 0, 0 } }, { { 0, 1 } })));
  add("tetrahedra", MESH(grid(blockMesh(CellType::Tetrahedron, 2, 2, 2))));
  add("hexahedra", MESH(grid(blockMesh(CellType::Hexahedron, 2, 2, 2))));
  add("wedges", MESH(grid(blockMesh(CellType::Wedge, 2, 2, 2))));
  add("pyramids", MESH(grid(blockMesh(CellType::Pyramid, 1, 1, 1))));
  add("quadrilaterals", MESH(grid(blockMesh(CellType::Quadrilateral, 3, 3, 0))));
  add("mixed dimensions",
    []
    {
      MeshData mesh = TAUTLINE_CHANGED(blockMesh(CellType::Tetrahedron, 2, 2, 2),
        addCell(VTK_TRIANGLE, { 0, 1, 4 }), addCell(VTK_LINE, { 0, 1 }),
        addCell(VTK_VERTEX, { 0 }));
      return grid(mesh);
    });
  add("non-manifold edge",
    MESH(cells(VTK_TRIANGLE, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 } },
      { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 1, 4 } })));
  add("surface in space",
    []
    {
      MeshData mesh = blockMesh(CellType::Triangle, 4, 4, 0);
      mesh.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[1]));
      return grid(mesh);
    });
  add("triangle strip",
    MESH(cells(VTK_TRIANGLE_STRIP, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } },
      { { 0, 1, 2, 3 } })));
  add("pentagon",
    MESH(cells(VTK_POLYGON, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0.5, 1.5, 0 }, { 0, 1, 0 } },
      { { 0, 1, 2, 3, 4 } })));
  const std::vector<Vec3> six = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 },
    { 0.5, 0.5, 0 }, { 0, 0.5, 0 } };
  add("quadratic triangle", MESH(cells(VTK_QUADRATIC_TRIANGLE, six, { { 0, 1, 2, 3, 4, 5 } })));
  add("Lagrange triangle", MESH(cells(VTK_LAGRANGE_TRIANGLE, six, { { 0, 1, 2, 3, 4, 5 } })));
  add("polyhedron", cubePolyhedron);
  add("image", MESH(image(5, 4, 1)));
  add("image of a volume", MESH(image(4, 3, 3)));
  add("image of one pixel", MESH(image(1, 1, 1)));
  add("rectilinear grid", rectilinear);
  add("structured grid", MESH((structured(12))));
  add("explicit structured grid", MESH(explicitStructured(0)));
  add("adaptive grid", amr);
  add("hyper tree grid", hyperTreeGrid, Expected::Error);
  add("table", makeTable, Expected::Error);
  add("graph", graph, Expected::Error);
  add("molecule", molecule, Expected::Error);
  add("blocks without meshes", MESH(makeBlocks({ makeTable(), nullptr })));
  add("blocks of nothing", MESH(makeBlocks({ nullptr, nullptr })));
  add("no blocks", MESH(makeBlocks({})));
  // Corrupt ones.
  add("structured grid with too few points", MESH((structured(11))), Expected::Error);
  add("explicit structured grid, wrong id", MESH(explicitStructured(1000000)), Expected::Error);
}

} // namespace tautline
