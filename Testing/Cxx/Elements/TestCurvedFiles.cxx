// SPDX-License-Identifier: BSD-3-Clause
// The certificate on curved meshes of MFEM and Gmsh with known numbers of invalid elements.
#include "CurvedElements.h"
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

std::vector<std::vector<Vec3>> fileElements(const char* name, unsigned char type)
{
  return elementsOf(readMfem(externalData("curved") + "/" + name, false), type);
}
}

TAUTLINE_PART(testCubeHoles)
{
  const ElementSet set = setOf(fileElements("cube-holes-inv.mesh", FileTetrahedron10));
  const Found found = examine(ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10), set);
  TAUTLINE_CHECK_EQUAL(set.count(), 3782);
  TAUTLINE_CHECK_EQUAL(found.invalid, 219);
  TAUTLINE_CHECK_NEAR(found.least.upper, -6.98984e-4, 5e-9);
  TAUTLINE_CHECK_NEAR(found.least.lower, -6.98984e-4, 5e-9);
}

TAUTLINE_PART(testBlade)
{
  const ElementSet set = setOf(fileElements("blade.mesh", FileLagrangeQuadrilateral));
  const Found found = examine(ElementType::ofVtk(VTK_LAGRANGE_QUADRILATERAL, 25), set);
  TAUTLINE_CHECK_EQUAL(set.count(), 109);
  TAUTLINE_CHECK_EQUAL(found.invalid, 0);
  TAUTLINE_CHECK_NEAR(found.least.upper, 6.516e-5, 5e-9);
}

TAUTLINE_PART(testIcf)
{
  const ElementSet set = setOf(fileElements("icf.mesh", FileQuadrilateral9));
  const Found found = examine(ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9), set);
  TAUTLINE_CHECK_EQUAL(set.count(), 224);
  TAUTLINE_CHECK_EQUAL(found.invalid, 0);
  TAUTLINE_CHECK_NEAR(found.least.upper, 1.49928e-5, 5e-10);
}

/// The mesh is of order 4; with order 2 the nodes are those in the middle of edges and elements.
TAUTLINE_PART(testJagged)
{
  const std::vector<Vec3>& all = ElementType::ofVtk(VTK_LAGRANGE_QUADRILATERAL, 25).coordinates();
  const ElementType& type = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9);
  std::vector<std::vector<Vec3>> elements;
  for (const std::vector<Vec3>& given : fileElements("jagged.mesh", FileLagrangeQuadrilateral))
  {
    std::vector<Vec3>& nodes = elements.emplace_back();
    for (const Vec3& place : type.coordinates())
    {
      nodes.push_back(given.at(std::find(all.begin(), all.end(), place) - all.begin()));
    }
  }
  const Found found = examine(type, setOf(elements));
  TAUTLINE_CHECK_EQUAL(elements.size(), 18u);
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
