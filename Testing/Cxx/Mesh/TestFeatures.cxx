// SPDX-License-Identifier: BSD-3-Clause
// Corners, curves and patches of surfaces, of boundaries and of regions.
#include "Registry.h"
#include "Surfaces.h"
#include "tautline/Mesh/Features.h"

using namespace tautline;

namespace
{
Features featuresOf(const MeshData& data, const FeatureOptions& options = {})
{
  return findFeatures(Mesh(data.view()), options);
}

void checkCounts(const Features& found, Index corners, int curves, int patches)
{
  TAUTLINE_CHECK_EQUAL(found.corners, corners);
  TAUTLINE_CHECK_EQUAL(found.curves, curves);
  TAUTLINE_CHECK_EQUAL(found.patches, patches);
}

/// Two blocks of cells, x < 2 and x > 2, of a mesh of unit cells.
std::vector<double> twoRegions(const MeshData& data)
{
  std::vector<double> regions;
  const Mesh mesh(data.view());
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    double x = 0;
    for (Index n = data.offsets[c]; n < data.offsets[c + 1]; ++n)
    {
      x += data.point(data.connectivity[n])[0] /
        static_cast<double>(data.offsets[c + 1] - data.offsets[c]);
    }
    regions.push_back(x < 2 ? 3 : 7);
  }
  return regions;
}

TAUTLINE_PART(testSurfaces)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const Context context(topology(type).name);
    const MeshData cube = cubeSurface(type, 4);
    const Features found = featuresOf(cube);
    checkCounts(found, 8, 12, 6);
    TAUTLINE_CHECK_EQUAL(found.curvePoints, Index(12 * 3));
    for (Index p = 0; p < cube.numberOfPoints(); ++p)
    {
      int ends = sumOf<int>(0, cube.point(p), [&](double x) { return x == 0 || x == 1; });
      TAUTLINE_CHECK_EQUAL(int(found.kind[p]), ends - 1);
      TAUTLINE_CHECK_EQUAL(found.curveOf[p] >= 0, ends == 2);
      TAUTLINE_CHECK_EQUAL(found.patchOf[p] >= 0, ends == 1);
    }
    checkCounts(featuresOf(sphereSurface(type, 8)), 0, 0, 1);
    // Without the corner of the cube at (1, 1, 1) it has the shape of an L.
    checkCounts(featuresOf(lSurface(type, 4)), 12, 18, 8);
    MeshData sheet = blockMesh(type, 6, 6, 0);
    sheet.transform(TAUTLINE_PLACE(p[0], p[1], 0.02 * p[0] * p[0]));
    checkCounts(featuresOf(sheet), 4, 4, 1);
  }
  checkCounts(featuresOf(cylinderSurface(32, 8)), 0, 2, 3);
  // The same at any size, turned, and with the sense of some cells reversed.
  for (double scale : { 1e-8, 1e8 })
  {
    MeshData data = cylinderSurface(32, 8);
    data.transform(
      [=](Vec3 p) {
        return scale * Vec3{ 0.6 * p[0] + 0.8 * p[2], p[1], 0.6 * p[2] - 0.8 * p[0] };
      });
    data.swapNodes(0, 1, 0, 3);
    checkCounts(featuresOf(data), 0, 2, 3);
  }
}

TAUTLINE_PART(testBoundaries)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const Context context(topology(type).name);
    const MeshData block = blockMesh(type, 4, 4, 4);
    checkCounts(featuresOf(block), 8, 12, 6);
    // An interface has a patch, a closed curve of four sides, and four corners more.
    const std::vector<double> regions = twoRegions(block);
    TAUTLINE_LET(FeatureOptions, options, regions = regions.data());
    const Features found = featuresOf(block, options);
    checkCounts(found, 12, 20, 11);
    Index interface = 0;
    for (const Features::Facet& facet : found.facets)
    {
      interface += facet.interface;
      for (int k = 0; k < facet.size && facet.interface; ++k)
      {
        TAUTLINE_CHECK_EQUAL(block.point(facet.nodes[k])[0], 2.0);
      }
    }
    TAUTLINE_CHECK(interface >= 16);
  }
  const MeshData square = blockMesh(CellType::Triangle, 4, 4, 0);
  checkCounts(featuresOf(square), 4, 4, 0);
  const std::vector<double> regions = twoRegions(square);
  TAUTLINE_LET(FeatureOptions, options, regions = regions.data());
  checkCounts(featuresOf(square, options), 6, 7, 0);
  checkCounts(featuresOf(square, TAUTLINE_CHANGED(FeatureOptions(), asSurface = true)), 4, 4, 1);
}

/// The border of two regions of a surface is a curve without corners, whatever the order of cells.
TAUTLINE_PART(testNumbering)
{
  MeshData cube = cubeSurface(CellType::Triangle, 4);
  cube.transform([](const Vec3& p) { return 4.0 * p; });
  constexpr unsigned orders = 10;
  for (unsigned seed = 0; seed < orders; ++seed)
  {
    const MeshData data = shuffled(cube, seed);
    const std::vector<double> regions = twoRegions(data);
    TAUTLINE_LET(FeatureOptions, options, regions = regions.data());
    checkCounts(featuresOf(data, options), 12, 20, 10);
  }
}

/// Given kinds replace those found.
TAUTLINE_PART(testKinds)
{
  const MeshData cube = cubeSurface(CellType::Triangle, 4);
  const Features found = featuresOf(cube);
  std::vector<signed char> kinds(cube.numberOfPoints(), DetectKind);
  TAUTLINE_LET(FeatureOptions, options, kinds = kinds.data());
  checkCounts(featuresOf(cube, options), 8, 12, 6);
  // All points in patches: one smooth surface.
  std::fill(kinds.begin(), kinds.end(), PatchPoint);
  checkCounts(featuresOf(cube, options), 0, 0, 1);
  // One point of a curve is made a corner, which cuts the curve.
  std::fill(kinds.begin(), kinds.end(), DetectKind);
  const auto onCurve = std::find(found.kind.begin(), found.kind.end(), CurvePoint);
  kinds[onCurve - found.kind.begin()] = CornerPoint;
  checkCounts(featuresOf(cube, options), 9, 13, 6);
  // The equator of a sphere.
  const MeshData sphere = sphereSurface(CellType::Quadrilateral, 8);
  kinds.assign(sphere.numberOfPoints(), DetectKind);
  options.kinds = kinds.data();
  for (Index p = 0; p < sphere.numberOfPoints(); ++p)
  {
    kinds[p] = std::abs(sphere.point(p)[2]) < 1e-12 ? CurvePoint : PatchPoint;
  }
  checkCounts(featuresOf(sphere, options), 0, 1, 2);
  kinds[0] = 5;
  TAUTLINE_CHECK_THROWS(featuresOf(sphere, options), wording("must-be-0-patch-1-curve-2"));
  options = TAUTLINE_CHANGED(FeatureOptions(), angle = 200);
  TAUTLINE_CHECK_THROWS(featuresOf(sphere, options), wording("between-0-and-180"));
}
}
