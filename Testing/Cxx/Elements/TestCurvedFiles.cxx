// SPDX-License-Identifier: BSD-3-Clause
// The certificate on curved meshes of MFEM and Gmsh with known numbers of invalid elements.
#include "CurvedElements.h"
#include "MfemMesh.h"
#include "Registry.h"
#include "VtkMeshes.h"

#include "vtkCellType.h"
#include "vtkGmshReader.h"

using namespace tautline;

namespace
{
const Vec3 zAxis = { 0, 0, 1 };

struct Found
{
  Index invalid = 0;
  JacobianBound least;
};

Found examine(const ElementType& type, const ElementSet& set)
{
  JacobianCertifier certifier(type, zAxis);
  Found found;
  const std::vector<ElementValidity> validity = classify(certifier, set);
  MinimumTolerance tolerance;
  tolerance.relative = 1e-8;
  for (Index e = 0; e < set.count(); ++e)
  {
    found.invalid += validity[e] != ElementValidity::Valid;
    const JacobianBound bound = certifier.minimum(set.coordinates(), set.elements[e], tolerance);
    TAUTLINE_CHECK(bound.validity == validity[e]);
    found.least = e == 0 || bound.upper < found.least.upper ? bound : found.least;
  }
  TAUTLINE_CHECK_EQUAL(certifier.counts().undecided, 0);
  return found;
}
}

TAUTLINE_PART(testCubeHoles)
{
  const MfemMesh mesh = readMfemMesh(externalData("curved") + "/cube-holes-inv.mesh");
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(mesh.nodes.size()), mesh.vertices + mesh.edgeCount);
  const ElementSet set = setOf(quadraticTetrahedra(mesh));
  const Found found = examine(ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10), set);
  TAUTLINE_CHECK_EQUAL(set.count(), 3782);
  TAUTLINE_CHECK_EQUAL(found.invalid, 219);
  TAUTLINE_CHECK_NEAR(found.least.upper, -6.98984e-4, 5e-9);
  TAUTLINE_CHECK_NEAR(found.least.lower, -6.98984e-4, 5e-9);
}

/// Quadrilaterals of order 4 with nodes of their own, in the order of the axes.
TAUTLINE_PART(testBlade)
{
  const MfemMesh mesh = readMfemMesh(externalData("curved") + "/blade.mesh");
  TAUTLINE_CHECK_EQUAL(mesh.collection, std::string("L2_T4_2D_P4")); // closed uniform nodes
  std::vector<Vec3> places;
  for (int n = 0; n < 25; ++n)
  {
    places.push_back({ n % 5 / 4.0, n / 5 / 4.0, 0 });
  }
  const ElementType type(ElementShape::Quadrilateral, { 4, 4, 0 }, places);
  std::vector<std::vector<Index>> nodes(mesh.elements.size());
  for (std::size_t e = 0; e < nodes.size(); ++e)
  {
    for (Index n = 0; n < 25; ++n)
    {
      nodes[e].push_back(25 * static_cast<Index>(e) + n);
    }
  }
  const Found found = examine(type, setOf(pointsOf(mesh, nodes)));
  TAUTLINE_CHECK_EQUAL(nodes.size(), 109u);
  TAUTLINE_CHECK_EQUAL(found.invalid, 0);
  TAUTLINE_CHECK_NEAR(found.least.upper, 6.516e-5, 5e-9);
}

/// The mesh is of order 4; with order 2 the nodes are those in the middle of edges and elements.
TAUTLINE_PART(testJagged)
{
  const MfemMesh mesh = readMfemMesh(externalData("curved") + "/jagged.mesh");
  TAUTLINE_CHECK_EQUAL(mesh.collection, std::string("H1_2D_P4"));
  const Index inside = mesh.vertices + 3 * mesh.edgeCount;
  std::vector<std::vector<Index>> nodes = mesh.elements;
  for (std::size_t e = 0; e < nodes.size(); ++e)
  {
    for (Index edge : mesh.edges[e])
    {
      nodes[e].push_back(mesh.vertices + 3 * edge + 1);
    }
    nodes[e].push_back(inside + 9 * static_cast<Index>(e) + 4);
  }
  const Found found =
    examine(ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9), setOf(pointsOf(mesh, nodes)));
  TAUTLINE_CHECK_EQUAL(nodes.size(), 18u);
  TAUTLINE_CHECK_EQUAL(found.invalid, 3);
  TAUTLINE_CHECK_NEAR(found.least.upper, -2.0 / 9, 1e-6);
}

TAUTLINE_PART(testGmsh)
{
  struct CadPart
  {
    const char* name;
    Index tetrahedra, invalid;
  };
  for (const CadPart& part : { CadPart{ "torus", 161, 22 }, CadPart{ "plate_fillet", 588, 16 },
         CadPart{ "swiss", 826, 58 }, CadPart{ "shell", 635, 5 } })
  {
    const Context context(part.name);
    vtkNew<vtkGmshReader> reader;
    reader->SetFileName((externalData("curved") + "/" + part.name + ".msh").c_str());
    reader->Update();
    std::vector<std::vector<Vec3>> elements;
    auto* grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutputDataObject(0));
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    {
      if (grid->GetCellType(c) == VTK_QUADRATIC_TETRA)
      {
        vtkCell* cell = grid->GetCell(c);
        std::vector<Vec3>& points = elements.emplace_back(10);
        for (int k = 0; k < 10; ++k)
        {
          cell->GetPoints()->GetPoint(k, points[k].data());
        }
      }
    }
    TAUTLINE_CHECK_EQUAL(static_cast<Index>(elements.size()), part.tetrahedra);
    const Found found = examine(ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10), setOf(elements));
    TAUTLINE_CHECK_EQUAL(found.invalid, part.invalid);
  }
}
