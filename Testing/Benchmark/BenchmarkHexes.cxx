// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkHexes FILE ANGLE: the worst corner of a mesh of hexahedra whose boundary slides on its
// own surface; features sharper than ANGLE are kept, none with 180. Prints lines
// "key<tab>number". Run by hexes.py.

#include "../Cxx/VtkMeshes.h"
#include "Clocks.h"

#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Optimization/Optimize.h"

#include <iomanip>
#include <iostream>

using namespace tautline;

namespace
{
void print(const std::string& key, double value)
{
  std::cout << key << '\t' << std::setprecision(12) << value << std::endl;
}

double worstJacobian(const MeshData& data)
{
  const std::vector<double> values = valuesOf(data, Metric::ScaledJacobian);
  return *std::min_element(values.begin(), values.end());
}

Index invalidOf(const MeshData& data)
{
  const std::vector<signed char> validity = validityOf(data);
  return std::count_if(
    validity.begin(), validity.end(), [](signed char v) { return isInvalid(v); });
}

/// The boundary as triangles.
SurfaceProjection boundaryOf(const MeshData& data)
{
  SurfacePart part;
  for (const SurfaceFacet& facet : surfaceFacets(Mesh(data.view())))
  {
    for (int k = 2; k < facet.size; ++k)
    {
      part.pieces.push_back(
        { data.point(facet.nodes[0]), data.point(facet.nodes[k - 1]), data.point(facet.nodes[k]) });
    }
  }
  return SurfaceProjection(part, nullptr);
}

double diagonalOf(const MeshData& data)
{
  Vec3 low = data.point(0), high = low;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], data.point(p)[c]);
      high[c] = std::max(high[c], data.point(p)[c]);
    }
  }
  return norm(high - low);
}
}

int main(int argc, char* argv[])
{
  if (argc != 3)
  {
    std::cerr << "BenchmarkHexes FILE ANGLE\n";
    return 1;
  }
  const MeshData before = toMesh(readGrid(argv[1]));
  const Mesh mesh(before.view());
  FeatureOptions featureOptions;
  featureOptions.angle = std::atof(argv[2]);
  const double diagonal = diagonalOf(before);
  OptimizeOptions options;
  applyPreset(Preset::WorstElement, options);
  options.threads = 1;
  options.surfaceTolerance = 1e-3 * diagonal;
  const double start = processTime();
  const Features features = findFeatures(mesh, featureOptions);
  const SurfaceModel model = makeSurfaceModel(mesh, features, true);
  const std::vector<std::int32_t> parts = partsOfPoints(features);
  std::vector<unsigned char> fixed;
  for (const signed char kind : features.kind)
  {
    fixed.push_back(kind == CornerPoint);
  }
  options.model = &model;
  options.parts = parts.data();
  options.fixed = fixed.data();
  const OptimizeResult result = optimize(mesh, options);
  print("seconds", processTime() - start);
  MeshData after = before;
  after.points = result.points;
  constexpr int divisions = 5;
  const SurfaceProjection was = boundaryOf(before), is = boundaryOf(after);
  print("hexahedra", static_cast<double>(before.numberOfCells()));
  print("worst before", worstJacobian(before));
  print("worst", worstJacobian(after));
  print("invalid before", static_cast<double>(invalidOf(before)));
  print("invalid", static_cast<double>(invalidOf(after)));
  print("from the mesh", is.distanceTo(was, 1, divisions) / diagonal);
  print("from the surface", was.distanceTo(is, 1, divisions) / diagonal);
  print("mean inverse mean ratio before", result.history.front().mean[0]);
  print("mean inverse mean ratio", result.history.back().mean[0]);
  return 0;
}
