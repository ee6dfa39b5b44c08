// SPDX-License-Identifier: BSD-3-Clause
#include "CurvatureMetric.h"

#include "QuadraticFit.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Elements/ElementPlacement.h"
#include "tautline/Mesh/FacetTable.h"
#include "tautline/Mesh/Features.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace tautline
{
namespace
{
constexpr Index surfacePointsPerChunk = 256;
/// The size with the chord error e at the radius R is sqrt(8 e R).
constexpr double chordFactor = 8.0;

/// The metric of a curvature tensor.
MetricTensor metricOfCurvature(MetricTensor curvature, double chordError, double largest)
{
  for (double& entry : curvature)
  {
    entry /= chordFactor * chordError;
  }
  const MetricTensor m = functionOf(
    curvature, [](double value) { return std::isfinite(value) ? std::abs(value) : 0.0; });
  return limited(m, { 0.0, largest, std::numeric_limits<double>::infinity() });
}

/// Facets around points, and fits to the points of one patch.
class SurfaceCurvature
{
public:
  SurfaceCurvature(const AdaptationMesh& mesh, double featureAngle)
    : TheMesh(mesh)
  {
    FeatureOptions options;
    options.angle = featureAngle;
    this->Found = findFeatures(mesh.mesh(), options);
    this->Starts.assign(mesh.numberOfPoints() + 1, 0);
    this->forEachUse([this](Index p, Index) { ++this->Starts[p + 1]; });
    std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
    this->Facets.resize(this->Starts.back());
    std::vector<Index> next(this->Starts.begin(), this->Starts.end() - 1);
    this->forEachUse([&](Index p, Index facet) { this->Facets[next[p]++] = facet; });
  }

  /// The metric of a point; the largest size where it has no facet.
  MetricTensor metricAt(Index p, double chordError, double largest) const
  {
    // A point on a feature has one curvature per patch; their intersection satisfies all of them.
    std::set<int> patches;
    this->forEachFacetAt(p, [&](const Features::Facet& facet) { patches.insert(facet.patch); });
    MetricTensor m = isotropicMetric(largest);
    for (const int patch : patches)
    {
      m = intersection(m, metricOfCurvature(this->curvatureAt(p, patch), chordError, largest));
    }
    return m;
  }

private:
  template <class Visit>
  void forEachUse(const Visit& visit) const
  {
    for (std::size_t f = 0; f < this->Found.facets.size(); ++f)
    {
      pollInterruption(static_cast<Index>(f));
      const Features::Facet& facet = this->Found.facets[f];
      for (int k = 0; k < facet.size; ++k)
      {
        visit(facet.nodes[k], static_cast<Index>(f));
      }
    }
  }

  template <class Visit>
  void forEachFacetAt(Index p, const Visit& visit) const
  {
    for (Index i = this->Starts[p]; i < this->Starts[p + 1]; ++i)
    {
      visit(this->Found.facets[this->Facets[i]]);
    }
  }

  /// Adds the points of the facets of a patch at some points.
  void grow(Index p, int patch, std::vector<Index>& found) const
  {
    std::vector<Index> front = found;
    front.push_back(p);
    for (const Index q : front)
    {
      this->forEachFacetAt(q,
        [&](const Features::Facet& facet)
        {
          // A fit across a feature would find a nearly infinite curvature.
          if (facet.patch == patch)
          {
            found.insert(found.end(), facet.nodes.begin(), facet.nodes.begin() + facet.size);
          }
        });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    found.erase(std::remove(found.begin(), found.end(), p), found.end());
  }

  Vec3 normalAt(Index p, int patch) const
  {
    Vec3 sum = { 0, 0, 0 };
    this->forEachFacetAt(p,
      [&](const Features::Facet& facet)
      {
        if (facet.patch == patch)
        {
          std::array<Vec3, MaxFaceNodes> x;
          for (int k = 0; k < facet.size; ++k)
          {
            x[k] = this->TheMesh.point(facet.nodes[k]);
          }
          sum +=
            facet.size == 3 ? cross(x[1] - x[0], x[2] - x[0]) : cross(x[2] - x[0], x[3] - x[1]);
        }
      });
    const double length = norm(sum);
    return length > 0.0 ? (1.0 / length) * sum : Vec3{ 0, 0, 1 };
  }

  MetricTensor curvatureAt(Index p, int patch) const
  {
    // Twice as many points as a quadric has coefficients, as it is a second derivative of data.
    constexpr std::size_t enough = 2 * static_cast<std::size_t>(unknownsOf(2));
    constexpr double level = 1e-3; // slope of the fit below which the surface normal is kept
    constexpr int turns = 3;
    std::vector<Index> ring;
    this->grow(p, patch, ring);
    Vec3 normal = this->normalAt(p, patch);
    std::array<Vec3, 3> axes;
    QuadraticFit fit;
    // Second derivatives of the height are curvatures only where its slope vanishes, so the plane
    // is turned until it does.
    for (int turn = 0; turn < turns; ++turn)
    {
      const auto [t1, t2] = frameOfPlane(normal);
      axes = { t1, t2, normal };
      fit = fitRings(
        ring, enough, [&](std::vector<Index>& found) { this->grow(p, patch, found); },
        [&](const std::vector<Index>& found) { return this->fitHeights(p, found, axes); });
      const double slope = norm(fit.gradient);
      if (slope < level || !std::isfinite(slope))
      {
        break;
      }
      // The height minus its linear part has this normal to first order.
      normal = normal - fit.gradient[0] * t1 - fit.gradient[1] * t2;
      normal = (1.0 / norm(normal)) * normal;
    }
    return outOf(fit.hessian, axes);
  }

  /// The height over a plane of points, relative to p.
  QuadraticFit fitHeights(
    Index p, const std::vector<Index>& found, const std::array<Vec3, 3>& axes) const
  {
    std::vector<Vec3> offsets;
    std::vector<double> heights;
    for (const Index q : found)
    {
      const Vec3 e = this->TheMesh.point(q) - this->TheMesh.point(p);
      offsets.push_back({ dot(axes[0], e), dot(axes[1], e), 0.0 });
      heights.push_back(dot(axes[2], e));
    }
    return fitQuadratic(2, offsets, heights);
  }

  const AdaptationMesh& TheMesh;
  Features Found;
  std::vector<Index> Starts, Facets; ///< of each point
};

/// Sets the metrics of the points of the border of a planar mesh.
void setBorderMetrics(const AdaptationMesh& mesh, double chordError, double featureAngle,
  double largest, std::vector<MetricTensor>& metrics)
{
  std::vector<std::vector<Index>> next(mesh.numberOfPoints());
  FacetTable edges(mesh.mesh());
  edges.forEachFacet(
    [&](Index first, const FacetUse* uses, Index count)
    {
      if (count == 1)
      {
        next[first].push_back(uses->others[0]);
        next[uses->others[0]].push_back(first);
      }
    });
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    pollInterruption(p);
    if (next[p].size() != 2)
    {
      continue; // within the mesh, or where two borders touch
    }
    const Vec3 a = mesh.point(p) - mesh.point(next[p][0]);
    const Vec3 b = mesh.point(next[p][1]) - mesh.point(p);
    const Vec3 chord = a + b;
    const double sine = norm(cross(a, b)), cosine = dot(a, b);
    const double length2 = dot(chord, chord);
    if (DegreesPerRadian * std::atan2(sine, cosine) > featureAngle || !(length2 > 0.0))
    {
      continue;
    }
    // The curvature of the circle through three points is 2 |a x b| / (|a| |b| |a + b|).
    const double curvature = 2.0 * sine / (norm(a) * norm(b) * std::sqrt(length2));
    const double scaled = curvature / length2;
    metrics[p] = metricOfCurvature(
      { scaled * chord[0] * chord[0], scaled * chord[1] * chord[1], scaled * chord[2] * chord[2],
        scaled * chord[0] * chord[1], scaled * chord[1] * chord[2], scaled * chord[0] * chord[2] },
      chordError, largest);
  }
}
}

//------------------------------------------------------------------------------
std::vector<MetricTensor> curvatureMetrics(
  const AdaptationMesh& mesh, double chordError, double featureAngle, double largest)
{
  std::vector<MetricTensor> result(mesh.numberOfPoints(), isotropicMetric(largest));
  if (mesh.mesh().dimension() == Dimension::Planar)
  {
    setBorderMetrics(mesh, chordError, featureAngle, largest, result);
    return result;
  }
  const SurfaceCurvature surface(mesh, featureAngle);
  parallelFor(mesh.numberOfPoints(), surfacePointsPerChunk, mesh.threads(),
    [&](Index p) { result[p] = surface.metricAt(p, chordError, largest); });
  return result;
}
}
