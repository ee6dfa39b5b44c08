// SPDX-License-Identifier: BSD-3-Clause
// Points moved until the checks of checkMesh pass: tangled blocks, boundaries, layers, limits.
#include "Blocks.h"
#include "FiniteVolume/FaceMeshes.h"
#include "Registry.h"

#include "tautline/Polyhedral/ImproveFaces.h"

using namespace tautline;

namespace
{
/// The tetrahedra of the triangles of the faces and the centers of the cells.
MeshData solidOf(const FaceMesh& mesh, const std::vector<double>& points)
{
  MeshData solid;
  solid.points = points;
  const FaceGeometry geometry = faceGeometry(mesh, points.data(), FaceConvention::Esi);
  for (const Vec3& center : geometry.cellCenter)
  {
    solid.addPoint(center);
  }
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    const Index* nodes = mesh.nodes.data() + mesh.offsets[face];
    for (Index i = 1; i + 1 < mesh.size(face); ++i)
    {
      solid.addCell(CellType::Tetrahedron,
        std::vector<Index>{ nodes[0], nodes[i + 1], nodes[i], mesh.points + mesh.owner[face] });
      if (mesh.internal(face))
      {
        solid.addCell(CellType::Tetrahedron,
          std::vector<Index>{
            nodes[0], nodes[i], nodes[i + 1], mesh.points + mesh.neighbor[face] });
      }
    }
  }
  return solid;
}

/// @param fixed whether a point of the mesh stays
template <class Fixed>
ImproveFacesResult improve(const MeshData& data, const FaceMesh& mesh, const Fixed& fixed,
  const ImproveFacesOptions& options = {})
{
  const MeshData solid = solidOf(mesh, data.points);
  const Mesh solidMesh(solid.view());
  std::vector<unsigned char> flags(solid.view().numberOfPoints, 1);
  std::vector<double> planes(3 * flags.size(), 0.0);
  for (Index i = 0; i < mesh.points; ++i)
  {
    flags[i] = fixed(i);
  }
  BoundaryConstraints constraints;
  constraints.fixed = flags.data();
  constraints.slidePlanes = planes.data();
  return improveFaces(mesh, data.points.data(), solidMesh, constraints, options);
}

std::vector<char> boundaryPoints(const FaceMesh& mesh)
{
  std::vector<char> flags(mesh.points, 0);
  for (Index i = mesh.offsets[mesh.internalFaces]; i < mesh.offsets[mesh.faces()]; ++i)
  {
    flags[mesh.nodes[i]] = 1;
  }
  return flags;
}

/// A block whose inner points are moved at random.
MeshData tangledBlock(CellType type, double amplitude, unsigned seed)
{
  MeshData data = blockMesh(type, 5, 5, 5);
  const std::vector<char> boundary = boundaryPoints(faceMeshOf(data));
  Random random(seed);
  for (Index i = 0; i < data.view().numberOfPoints; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      data.points[3 * i + c] += boundary[i] ? 0 : random.uniform(-amplitude, amplitude);
    }
  }
  return data;
}
}

/// Tangled meshes of all types pass; the boundary stays.
TAUTLINE_PART(testTangled)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const Context context(topology(type).name);
    const MeshData data = tangledBlock(type, type == CellType::Pyramid ? 0.3 : 0.7, 4);
    const FaceMesh mesh = faceMeshOf(data);
    const std::vector<char> boundary = boundaryPoints(mesh);
    const ImproveFacesResult result =
      improve(data, mesh, [&](Index i) { return boundary[i] != 0; });
    TAUTLINE_CHECK(result.before.failed(false) > 0);
    TAUTLINE_CHECK_EQUAL(result.after.failed(false), 0);
    TAUTLINE_CHECK(result.after.failed(true) <= result.before.failed(true));
    TAUTLINE_CHECK_EQUAL(result.wantingAfter, 0);
    TAUTLINE_CHECK(result.reason == StopReason::AllValid);
    TAUTLINE_CHECK(result.after[MeshCheckKind::NonOrthogonality].most < 65);
    // The report is of the points.
    const FaceMeasures measures(mesh, result.points.data(), FaceConvention::Esi);
    TAUTLINE_CHECK_EQUAL(
      checkMesh(measures, result.points.data()).failed(true), result.after.failed(true));
    for (Index i = 0; i < mesh.points; ++i)
    {
      TAUTLINE_CHECK(!boundary[i] ||
        std::equal(&data.points[3 * i], &data.points[3 * i] + 3, &result.points[3 * i]));
    }
  }
}

/// Where all faces reach the targets, nothing moves; where one does not, only points near it.
TAUTLINE_PART(testNearOnly)
{
  MeshData data = blockMesh(CellType::Hexahedron, 12, 4, 4);
  const FaceMesh mesh = faceMeshOf(data);
  const std::vector<char> boundary = boundaryPoints(mesh);
  const auto fixed = [&](Index i) { return boundary[i] != 0; };
  const ImproveFacesResult idle = improve(data, mesh, fixed);
  TAUTLINE_CHECK(idle.points == data.points);
  TAUTLINE_CHECK_EQUAL(idle.rounds, 0);
  const auto at = [&](Index i, Index j, Index k) { return i + 13 * (j + 5 * k); };
  const Index moved = at(2, 2, 2);
  data.setPoint(moved, { 3.4, 2.9, 2.6 });
  const ImproveFacesResult result = improve(data, mesh, fixed);
  TAUTLINE_CHECK(result.wantingBefore > 0);
  TAUTLINE_CHECK_EQUAL(result.after.failed(true), 0);
  for (Index i = 0; i < mesh.points; ++i)
  {
    const bool far = data.points[3 * i] > 8;
    TAUTLINE_CHECK(
      !far || std::equal(&data.points[3 * i], &data.points[3 * i] + 3, &result.points[3 * i]));
  }
}

/// The result does not depend on the threads, and is the best so far where the run is ended.
TAUTLINE_PART(testLimits)
{
  const MeshData data = tangledBlock(CellType::Hexahedron, 0.9, 5);
  const FaceMesh mesh = faceMeshOf(data);
  const std::vector<char> boundary = boundaryPoints(mesh);
  const auto fixed = [&](Index i) { return boundary[i] != 0; };
  ImproveFacesOptions options;
  options.threads = 1;
  const ImproveFacesResult one = improve(data, mesh, fixed, options);
  options.threads = 2;
  TAUTLINE_CHECK(improve(data, mesh, fixed, options).points == one.points);
  options.proceed = [](int, double fraction)
  {
    TAUTLINE_CHECK(fraction >= 0 && fraction <= 1);
    return false;
  };
  const ImproveFacesResult ended = improve(data, mesh, fixed, options);
  TAUTLINE_CHECK(ended.reason == StopReason::Aborted);
  TAUTLINE_CHECK(ended.points == data.points);
  options.proceed = nullptr;
  const ImproveFacesResult none = improve(
    data, mesh, [](Index) { return true; }, options);
  TAUTLINE_CHECK(none.reason == StopReason::NoFreeVertices);
  TAUTLINE_CHECK(none.points == data.points);
}

/// A layer that passes, whose points are one above the other to the bit.
template <class OnEdge>
void checkLayer(
  const MeshData& data, const ImproveFacesResult& result, Index perSide, const OnEdge& onEdge)
{
  TAUTLINE_CHECK(result.before.failed(false) > 0);
  TAUTLINE_CHECK_EQUAL(result.after.failed(false), 0);
  bool moved = false;
  for (Index i = 0; i < perSide; ++i)
  {
    const double *low = &result.points[3 * i], *high = &result.points[3 * (i + perSide)];
    TAUTLINE_CHECK(low[0] == high[0] && low[1] == high[1]);
    TAUTLINE_CHECK(low[2] == 0 && high[2] == 1);
    const bool here = low[0] != data.points[3 * i];
    TAUTLINE_CHECK(!here || !onEdge(i));
    moved |= here;
  }
  TAUTLINE_CHECK(moved);
}

/// Both sides of a layer move by the same, in their planes.
TAUTLINE_PART(testLayer)
{
  MeshData data = blockMesh(CellType::Hexahedron, 6, 6, 1);
  Random random(6);
  const Index perSide = data.view().numberOfPoints / 2;
  for (Index i = 0; i < perSide; ++i)
  {
    const double* p = &data.points[3 * i];
    const bool inner = p[0] > 0.5 && p[0] < 5.5 && p[1] > 0.5 && p[1] < 5.5;
    for (int c = 0; c < 2 && inner; ++c)
    {
      data.points[3 * i + c] += random.uniform(-0.9, 0.9);
      data.points[3 * (i + perSide) + c] = data.points[3 * i + c];
    }
  }
  const FaceMesh whole = faceMeshOf(data);
  ListedFacets facets;
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[2] < 0.5; });
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[2] > 0.5; });
  const FaceMesh mesh =
    findFaces(whole.points, facesOf(data), facets, { patchOf("sides", "empty") });
  const auto onEdge = [&](Index i)
  {
    const double* p = &data.points[3 * i];
    return p[0] == 0 || p[0] == 6 || p[1] == 0 || p[1] == 6;
  };
  ImproveFacesOptions stays;
  stays.patchesStay = true; // all but the sides
  const auto nowhere = [](Index) { return false; };
  for (const bool byPatches : { false, true })
  {
    const ImproveFacesResult result =
      byPatches ? improve(data, mesh, nowhere, stays) : improve(data, mesh, onEdge);
    checkLayer(data, result, perSide, onEdge);
  }
}

/// Points of coupled patches stay, those between them pass by their neighbors across.
TAUTLINE_PART(testCoupled)
{
  MeshData data = blockMesh(CellType::Hexahedron, 4, 4, 4);
  const FaceMesh whole = faceMeshOf(data);
  ListedFacets facets;
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[0] < 0.5; });
  addFacets(facets, whole, 1, data, [](const Vec3& p) { return p[0] > 3.5; });
  const FaceMesh mesh = findFaces(whole.points, facesOf(data), facets,
    { patchOf("left", "cyclic", 1), patchOf("right", "cyclic", 0) });
  const MeshData plain = data;
  Random random(8);
  const std::vector<char> boundary = boundaryPoints(whole);
  for (Index i = 0; i < mesh.points; ++i)
  {
    for (int c = 0; c < 3 && !boundary[i]; ++c)
    {
      data.points[3 * i + c] += random.uniform(-0.8, 0.8);
    }
  }
  const ImproveFacesResult result = improve(data, mesh, [](Index) { return false; });
  TAUTLINE_CHECK_EQUAL(result.after.failed(false), 0);
  for (Index i = 0; i < mesh.points; ++i)
  {
    const double x = plain.points[3 * i];
    TAUTLINE_CHECK((x > 0.5 && x < 3.5) ||
      std::equal(&data.points[3 * i], &data.points[3 * i] + 3, &result.points[3 * i]));
  }
}
