// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceMeshes.h
 * @brief Meshes of owner and neighbor for the tests of finite volumes.
 */
#ifndef tautline_FaceMeshes_h
#define tautline_FaceMeshes_h

#include "Meshes.h"

#include "tautline/FiniteVolume/FacePieces.h"
#include "tautline/FiniteVolume/ListFaces.h"

namespace tautline
{
/// The metrics of finite volumes.
inline std::vector<Metric> faceMetrics()
{
  std::vector<Metric> metrics;
  for (const MetricInfo& info : metricRegistry())
  {
    if (info.family == MetricFamily::Faces)
    {
      metrics.push_back(info.metric);
    }
  }
  return metrics;
}

/// The faces of the linear 3D cells of a mesh.
inline ListedFaces facesOf(const MeshData& data)
{
  ListedFaces list;
  const MeshView view = data.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (topology(type).dimension == 3)
    {
      listLinearCell(list, type, view.connectivity + view.offsets[cell]);
    }
  }
  return list;
}

inline FaceMesh faceMeshOf(const MeshData& data)
{
  return findFaces(data.view().numberOfPoints, facesOf(data), {}, {});
}

/// Marks the layer of a mesh in one piece, if it is one.
inline int markLayerAlone(FaceMesh& mesh, const MeshData& data)
{
  SingleRank alone;
  return markLayer(alone, { { &mesh, data.points.data() } });
}

/// A metric on the cells of a mesh.
inline std::vector<double> faceMetricOf(
  const MeshData& data, Metric metric, FaceConvention convention = FaceConvention::Esi)
{
  const FaceMesh mesh = faceMeshOf(data);
  return FaceMeasures(mesh, data.points.data(), convention).evaluate(metric).cells;
}

inline double largestOf(const std::vector<double>& values)
{
  return *std::max_element(values.begin(), values.end());
}

inline double largestX(const MeshData& data)
{
  double largest = data.points.front();
  for (std::size_t i = 0; i < data.points.size(); i += 3)
  {
    largest = std::max(largest, data.points[i]);
  }
  return largest;
}

inline double smallestOf(const std::vector<double>& values)
{
  return *std::min_element(values.begin(), values.end());
}

/// A facet of given points, of a patch.
inline void addFacet(ListedFacets& facets, const std::vector<Index>& nodes, int patch)
{
  facets.nodes.insert(facets.nodes.end(), nodes.begin(), nodes.end());
  facets.offsets.push_back(static_cast<Index>(facets.nodes.size()));
  facets.patch.push_back(patch);
}

/// The boundary faces whose points all fulfill a condition, as facets of a patch.
template <class Condition>
void addFacets(
  ListedFacets& facets, const FaceMesh& mesh, int patch, const MeshData& data, const Condition& in)
{
  for (Index face = mesh.internalFaces; face < mesh.faces(); ++face)
  {
    const std::vector<Index> nodes(
      mesh.nodes.begin() + mesh.offsets[face], mesh.nodes.begin() + mesh.offsets[face + 1]);
    const bool all = std::all_of(nodes.begin(), nodes.end(),
      [&](Index node)
      {
        const double* p = &data.points[3 * node];
        return in(Vec3{ p[0], p[1], p[2] });
      });
    if (all)
    {
      addFacet(facets, nodes, patch);
    }
  }
}

inline FacePatch patchOf(const std::string& name, const std::string& type, int partner = -1)
{
  FacePatch patch;
  patch.name = name;
  patch.type = type;
  patch.partner = partner;
  return patch;
}
}
#endif
