// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh with curved cells: corners move as in linear cells, nodes between follow, on the
// boundary by motions of their own, and validity is certified.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "WarpingMeshes.h"
#include "tautline/Deformation/Warp.h"
#include "tautline/Mesh/CurvedCells.h"

using namespace tautline;

namespace
{
/// A ring from radius 1 to 2 of quadratic cells (solid: a tube), all nodes on circles. The seam has
/// points of its own on either side.
MeshData ring(CellType type, Index across, Index around)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = quadraticOf(blockMesh(type, across, around, flat ? 0 : 2));
  data.transform(
    [&](const Vec3& p)
    {
      const double radius = 1 + p[0] / static_cast<double>(across);
      const double angle =
        2 * M_PI * std::fmod(p[1], static_cast<double>(around)) / static_cast<double>(around);
      return Vec3{ radius * std::cos(angle), radius * std::sin(angle), p[2] };
    });
  return data;
}

/// The linear cells of the corners.
MeshData cornersOf(const MeshData& curved)
{
  TAUTLINE_LET(MeshData, linear, points = curved.points);
  for (Index cell = 0; cell < curved.numberOfCells(); ++cell)
  {
    const CellTopology& t = topology(cornerType(curved.types[cell]));
    std::vector<Index> nodes = curved.nodes(cell);
    nodes.resize(t.nodes);
    linear.addCell(t.type, nodes);
  }
  return linear;
}

/// Invalid cells, certified.
Index invalid(const MeshData& data)
{
  std::vector<signed char> validity(data.numberOfCells());
  const Mesh mesh(data.view());
  mesh.classifyCells(validity.data());
  certifyCurvedCells(mesh, {}, validity.data(), nullptr);
  return std::count_if(validity.begin(), validity.end(), isInvalid);
}

double radiusOf(const Vec3& p)
{
  return std::hypot(p[0], p[1]);
}

constexpr CellType warpedTypes[] = { CellType::Triangle, CellType::Tetrahedron };

/// The inner boundary turns: its nodes stay on their circle, the nodes of the outer one do not
/// move.
TAUTLINE_PART(testRotation)
{
  for (CellType type : warpedTypes)
  {
    const Context context(topology(type).name);
    const MeshData data = ring(type, 4, 16);
    TAUTLINE_CHECK_EQUAL(invalid(data), 0);
    const bool flat = type == CellType::Triangle;
    const double degrees = flat ? 20 : 5; // the ends of the tube stay
    for (int method : { vtkMeshWarp::HYBRID, vtkMeshWarp::FEMWARP, vtkMeshWarp::RADIAL_BASIS,
           vtkMeshWarp::INVERSE_DISTANCE, vtkMeshWarp::WEIGHTED_LAPLACIAN })
    {
      const Context inner("method " + std::to_string(method));
      auto grid = toGrid(data);
      grid->GetPointData()->AddArray(arrayOf("inner", data.numberOfPoints(), 1,
        [&](Index i, int) { return radiusOf(data.point(i)) < 1 + 1e-9; }));
      vtkNew<vtkMeshWarp> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(grid), SetMotion(vtkMeshWarp::TRANSFORM),
        SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(degrees), SetMethod(method),
        SetMovedPart(vtkMeshWarp::ARRAY_VALUES),
        SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "inner"),
        Update());
      TAUTLINE_CHECK(messages.empty());
      const MeshData moved = withPointsOf(data, meshOf(filter));
      TAUTLINE_CHECK_EQUAL(invalid(moved), 0);
      TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
      Index turned = 0, still = 0;
      const double angle = degrees * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        const Vec3 p = data.point(i), q = moved.point(i);
        if (radiusOf(p) < 1 + 1e-9)
        {
          TAUTLINE_CHECK(norm(q - Vec3{ c * p[0] - s * p[1], s * p[0] + c * p[1], p[2] }) < 1e-12);
          ++turned;
        }
        else if (radiusOf(p) > 2 - 1e-9)
        {
          TAUTLINE_CHECK_EQUAL(norm(q - p), 0.0);
          ++still;
        }
      }
      TAUTLINE_CHECK(turned >= (flat ? 32 : 160) && still == turned);
      // Neighbors have one node on the seam.
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        for (Index j = 0; flat && j < i; ++j)
        {
          TAUTLINE_CHECK(
            norm(data.point(i) - data.point(j)) > 0 || norm(moved.point(i) - moved.point(j)) == 0);
        }
      }
    }
  }
}

/// An affine motion of the whole boundary is exact for all nodes.
TAUTLINE_PART(testAffine)
{
  for (CellType type : warpedTypes)
  {
    for (bool single : { false, true })
    {
      const Context context(std::string(topology(type).name) + (single ? ", single" : ""));
      const MeshData data = ring(type, 3, 12);
      const auto motion = [&](const Vec3& p)
      {
        return Vec3{ 1.3 * p[0] + 0.2 * p[1] - 1, -0.9 * p[0] + 0.8 * p[1] + 2,
          type == CellType::Triangle ? p[2] : 0.1 * p[0] + 1.1 * p[2] };
      };
      const MeshData expected = TAUTLINE_CHANGED(data, transform(motion));
      auto grid = toGrid(data, single ? VTK_FLOAT : VTK_DOUBLE);
      grid->GetPointData()->AddArray(arrayOf("d", data.numberOfPoints(), 3,
        [&](Index i, int k) { return expected.point(i)[k] - data.point(i)[k]; }));
      vtkNew<vtkMeshWarp> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(grid), SetMotion(vtkMeshWarp::DISPLACEMENT),
        SetMethod(vtkMeshWarp::FEMWARP),
        SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"), Update());
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(
        distance(withPointsOf(data, meshOf(filter)), expected) < (single ? 1e-5 : 1e-10));
      auto* output = vtkPointSet::SafeDownCast(meshOf(filter));
      TAUTLINE_CHECK_EQUAL(output->GetPoints()->GetDataType(), single ? VTK_FLOAT : VTK_DOUBLE);
      // The output has the cells of the input, and nothing moves without an amount.
      TAUTLINE_CHECK_EQUAL(output->GetCellType(0), static_cast<int>(data.types[0]));
      TAUTLINE_SET(filter, SetAmount(0), Update());
      TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == toMesh(grid).points);
    }
  }
}

/// Corners equal the corners of the linear mesh.
TAUTLINE_PART(testCorners)
{
  for (CellType type : warpedTypes)
  {
    const MeshData data = ring(type, 4, 16), linear = cornersOf(data);
    for (int method = vtkMeshWarp::HYBRID; method <= vtkMeshWarp::AUTOMATIC; ++method)
    {
      const Context context("method " + std::to_string(method));
      std::vector<MeshData> moved;
      for (const MeshData* mesh : { &data, &linear })
      {
        vtkNew<vtkMeshWarp> filter;
        Messages messages(filter);
        TAUTLINE_SET(filter, SetInputData(toGrid(*mesh)), SetMotion(vtkMeshWarp::TRANSFORM),
          SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.2, 0.1, 0),
          SetMethod(method), Update());
        moved.push_back(withPointsOf(data, meshOf(filter)));
      }
      for (Index cell = 0; cell < linear.numberOfCells(); ++cell)
      {
        for (Index i : linear.nodes(cell))
        {
          TAUTLINE_CHECK(norm(moved[0].point(i) - moved[1].point(i)) < 1e-9);
        }
      }
    }
  }
}

/// Cells folded between valid corners are counted, before and after.
TAUTLINE_PART(testFolded)
{
  MeshData data = ring(CellType::Triangle, 4, 8);
  // Curved boundary moved inwards: straight cells stay valid, curved ones do not.
  auto grid = toGrid(data);
  const auto isMiddle = [&](Index i)
  {
    bool corner = false;
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      const std::vector<Index> nodes = data.nodes(cell);
      corner = corner || std::find(nodes.begin(), nodes.begin() + 3, i) != nodes.begin() + 3;
    }
    return !corner;
  };
  Index middles = 0;
  std::vector<unsigned char> pushed(data.numberOfPoints(), 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    pushed[i] = radiusOf(data.point(i)) < 1 + 1e-9 && isMiddle(i);
    middles += pushed[i];
  }
  grid->GetPointData()->AddArray(arrayOf("d", data.numberOfPoints(), 3,
    [&](Index i, int k) { return pushed[i] ? 0.5 * data.point(i)[k] : 0.0; }));
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid), SetMotion(vtkMeshWarp::DISPLACEMENT),
    SetMethod(vtkMeshWarp::FEMWARP),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"), Update());
  TAUTLINE_CHECK_EQUAL(middles, 8);
  const MeshData moved = withPointsOf(data, meshOf(filter));
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), invalid(moved));
  TAUTLINE_CHECK(filter->GetInverted() >= 8);
  TAUTLINE_CHECK_EQUAL(invalid(cornersOf(moved)), 0);
  TAUTLINE_CHECK(messages.has(wording("untangle-mesh-moves-these-too")));
  vtkDataArray* validity = meshOf(filter)->GetCellData()->GetArray("Validity");
  Index counted = 0;
  TAUTLINE_EACH(
    vtkIdType, c, validity->GetNumberOfTuples(), counted += validity->GetComponent(c, 0) < 0);
  TAUTLINE_CHECK_EQUAL(counted, filter->GetInverted());

  // Such a mesh is rejected as an input.
  messages.clear();
  TAUTLINE_SET(filter, SetInputData(toGrid(moved)), SetMotion(vtkMeshWarp::TRANSFORM),
    SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.1, 0, 0), Update());
  TAUTLINE_CHECK(messages.has(wording("inverted-or-degenerate-before-anything-moves")));
}

/// The kernel takes linear cells.
TAUTLINE_PART(testKernel)
{
  const MeshData data = ring(CellType::Triangle, 2, 8);
  const Mesh mesh(data.view());
  TAUTLINE_CHECK_THROWS(Warper(mesh, WarpOptions()), wording("32-cells-of-quadratic-or-higher"));
}

/// To a target of the same mesh: nodes of the boundary go to theirs.
TAUTLINE_PART(testTarget)
{
  const MeshData data = ring(CellType::Triangle, 3, 12);
  const MeshData target = TAUTLINE_CHANGED(data,
    transform(
      [](const Vec3& p) {
        return Vec3{ 1.5 * p[0], p[1] + 0.1 * p[0] * p[0], 0 };
      }));
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetInputData(1, toGrid(target)),
    SetMotion(vtkMeshWarp::TARGET), SetCorrespondence(vtkMeshWarp::SAME_MESH), Update());
  TAUTLINE_CHECK(messages.empty());
  const MeshData moved = withPointsOf(data, meshOf(filter));
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const double radius = radiusOf(data.point(i));
    TAUTLINE_CHECK(
      (radius > 1 + 1e-9 && radius < 2 - 1e-9) || norm(moved.point(i) - target.point(i)) < 1e-12);
  }
  TAUTLINE_CHECK_EQUAL(invalid(moved), 0);
}
}
