// SPDX-License-Identifier: BSD-3-Clause
#include "MenuNames.h"

#include <cstring>

namespace tautline
{
namespace
{
struct MenuName
{
  const char* className;
  const char* name;
};

constexpr MenuName Names[] = {
  { "vtkAbaqusReader", "Abaqus Reader" },
  { "vtkConditionEstimator", "Condition Estimator" },
  { "vtkDomainSource", "Mesh Domain" },
  { "vtkElementQuality", "Element Quality" },
  { "vtkEllipticSolver", "Solve PDE" },
  { "vtkFieldTransfer", "Transfer" },
  { "vtkFluentMeshReader", "Fluent Mesh Reader" },
  { "vtkFoamMeshReader", "OpenFOAM Mesh Reader" },
  { "vtkGmshReader", "Gmsh Reader" },
  { "vtkHorizonNeighbors", "Horizon Neighbors" },
  { "vtkInteractionLayer", "Interaction Layer" },
  { "vtkMeditReader", "Medit Reader" },
  { "vtkMeshComparison", "Compare Meshes" },
  { "vtkMeshCurving", "Curve Mesh" },
  { "vtkMeshImprover", "Improve Mesh" },
  { "vtkMeshMetric", "Metric Tensor" },
  { "vtkMeshOptimizer", "Optimize Mesh" },
  { "vtkMeshPerturbation", "Perturb Mesh" },
  { "vtkMeshUntangler", "Untangle Mesh" },
  { "vtkMeshWarp", "Warp Mesh" },
  { "vtkMetricField", "Metric Field" },
  { "vtkMfemReader", "MFEM Reader" },
  { "vtkNastranReader", "Nastran Reader" },
  { "vtkOffReader", "OFF Reader" },
  { "vtkPeridynamicStiffness", "Peridynamic Condition" },
  { "vtkShapeMatcher", "Match Shape" },
  { "vtkShapeRetrieval", "Shape Retrieval" },
  { "vtkSilhouetteMesher", "Silhouette to Mesh" },
  { "vtkSilhouetteSetReader", "Silhouette Set Reader" },
  { "vtkSolverStudy", "Solver Study" },
  { "vtkTetGenMesher", "TetGen Mesher" },
  { "vtkTetGenReader", "TetGen Reader" },
  { "vtkTriangleMesher", "Triangle Mesher" },
};
}

//------------------------------------------------------------------------------
const char* menuName(const char* className)
{
  for (const MenuName& each : Names)
  {
    if (std::strcmp(each.className, className) == 0)
    {
      return each.name;
    }
  }
  return nullptr;
}
}
