// SPDX-License-Identifier: BSD-3-Clause
#include "MakeMetric.h"

#include "CurvatureMetric.h"
#include "LpMetric.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
constexpr int tensorSize = 6;

void requireRange(const char* name, double value, bool holds, const char* range)
{
  if (!holds)
  {
    std::ostringstream text;
    text << name << " is " << value << ": enter a number " << range << ".";
    throw Error(text.str());
  }
}

void checkOptions(const MetricOptions& o)
{
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  const MetricLimits& limits = o.limits;
  requireRange("The largest size", limits.largest, positive(limits.largest), "above 0");
  requireRange("The smallest size", limits.smallest,
    limits.smallest >= 0.0 && limits.smallest <= limits.largest, "up to the largest size");
  requireRange("The largest ratio of sizes", limits.ratio,
    limits.ratio >= 1.0 && limits.ratio <= MaximumSizeRatio, "from 1 to 10000");
  requireRange("The growth factor of the gradation", o.gradation,
    o.gradation == 0.0 || (o.gradation > 1.0 && std::isfinite(o.gradation)),
    "above 1, or 0 for none");
  switch (o.source)
  {
    case MetricSource::Hessian:
      requireRange("The norm", o.norm, o.norm >= 1.0, "of at least 1");
      requireRange("The target", o.targetValue, positive(o.targetValue), "above 0");
      break;
    case MetricSource::Curvature:
      requireRange("The chord error", o.chordError, positive(o.chordError), "above 0");
      break;
    case MetricSource::Distance:
      requireRange("The size at the wall", o.layers.first, positive(o.layers.first), "above 0");
      requireRange("The growth of layers", o.layers.growth,
        o.layers.growth >= 1.0 && std::isfinite(o.layers.growth), "of at least 1");
      requireRange("The tangential ratio", o.layers.ratio,
        o.layers.ratio >= 1.0 && std::isfinite(o.layers.ratio), "of at least 1");
      break;
    default:
      break;
  }
}

/// Values per point that are finite.
std::vector<double> finiteValues(const AdaptationMesh& mesh, const double* values, int components,
  const char* missing, const char* what)
{
  if (!values)
  {
    throw Error(missing);
  }
  std::vector<double> result = mesh.taken(values, components);
  const auto wrong =
    std::count_if(result.begin(), result.end(), [](double value) { return !std::isfinite(value); });
  if (wrong > 0)
  {
    throw Error(std::to_string(wrong) + " " + what + " are not finite: correct the array.");
  }
  return result;
}

std::vector<MetricTensor> metricsOfSizes(const AdaptationMesh& mesh, const PointSizes& sizes)
{
  if (!sizes.values || (sizes.components != 1 && sizes.components != tensorSize))
  {
    throw Error("Sizes are needed: choose a point array with one component (sizes) or six (metric "
                "tensors).");
  }
  const bool tensors = sizes.components == tensorSize;
  const std::vector<double> values = mesh.taken(sizes.values, sizes.components);
  std::vector<MetricTensor> result(mesh.numberOfPoints());
  Index wrong = 0;
  for (std::size_t p = 0; p < result.size(); ++p)
  {
    pollInterruption(static_cast<Index>(p));
    if (tensors)
    {
      std::copy_n(&values[tensorSize * p], tensorSize, result[p].begin());
    }
    else
    {
      const double size = values[p];
      result[p] = size > 0.0 ? isotropicMetric(size) : MetricTensor{};
    }
    wrong += !isPositiveDefinite(result[p]);
  }
  if (wrong > 0)
  {
    throw Error(std::to_string(wrong) +
      (tensors ? " metric tensors are not positive definite: correct the array."
               : " sizes are not positive numbers: correct the array."));
  }
  return result;
}

/// Computes the metrics of a mesh step by step.
class MetricMaker
{
public:
  MetricMaker(const Mesh& mesh, const MetricOptions& options)
    : Options(options)
    , TheMesh(mesh, options.representative, options.skip, options.threads)
  {
  }

  MetricResult make()
  {
    if (this->Options.others.values)
    {
      this->Others = metricsOfSizes(this->TheMesh, this->Options.others);
      limitMetrics(this->TheMesh, this->Options.limits, this->Others);
    }
    std::vector<MetricTensor> metrics = this->Options.source == MetricSource::Hessian
      ? this->ofHessian()
      : this->finished(this->ofSource());
    MetricResult& result = this->Result;
    result.tensors = this->TheMesh.given(metrics, isotropicMetric(this->Options.limits.largest));
    result.complexity = complexity(this->TheMesh, metrics);
    result.elements = expectedElements(this->TheMesh, metrics);
    result.extremes = extremesOf(this->TheMesh, metrics);
    result.points = this->TheMesh.origins();
    for (const Index place : this->TheMesh.places())
    {
      if (this->TheMesh.dimension() == 2)
      {
        result.normals.push_back(place < 0 ? Vec3{ 0, 0, 1 } : this->TheMesh.normals()[place]);
      }
    }
    if (!result.gradation.complete)
    {
      this->note("The gradation stopped after " + std::to_string(MaximumGradationRounds) +
        " rounds, while sizes were still changing.");
    }
    return std::move(result);
  }

private:
  std::vector<MetricTensor> ofSource()
  {
    const MetricOptions& o = this->Options;
    switch (o.source)
    {
      case MetricSource::Sizes:
        return metricsOfSizes(this->TheMesh, o.sizes);
      case MetricSource::Distance:
        return distanceMetrics(this->TheMesh, this->distances(), o.layers);
      default:
        return curvatureMetrics(this->TheMesh, o.chordError, o.featureAngle, o.limits.largest);
    }
  }

  std::vector<double> distances() const
  {
    const MetricOptions& o = this->Options;
    if (o.distances)
    {
      return finiteValues(this->TheMesh, o.distances, 1, "", "distances");
    }
    std::vector<unsigned char> marks;
    for (std::size_t p = 0; o.walls && p < this->TheMesh.origins().size(); ++p)
    {
      marks.push_back(o.walls[this->TheMesh.origins()[p]]);
    }
    return wallDistances(this->TheMesh, marks);
  }

  /// The metrics intersected with the others, within limits, and graded.
  std::vector<MetricTensor> finished(std::vector<MetricTensor> metrics)
  {
    const MetricOptions& o = this->Options;
    limitMetrics(this->TheMesh, o.limits, metrics);
    if (!this->Others.empty())
    {
      intersectMetrics(this->TheMesh, this->Others, metrics);
      // Intersection and gradation change the eigenvalues, so the limits apply again.
      limitMetrics(this->TheMesh, o.limits, metrics);
    }
    if (o.gradation > 0.0)
    {
      this->Result.gradation = gradeMetrics(this->TheMesh, o.gradation, metrics);
      limitMetrics(this->TheMesh, o.limits, metrics);
    }
    return metrics;
  }

  std::vector<MetricTensor> ofHessian()
  {
    const MetricOptions& o = this->Options;
    const std::vector<double>& volumes = this->TheMesh.volumes();
    if (!(std::accumulate(volumes.begin(), volumes.end(), 0.0) > 0.0))
    {
      throw Error("The elements have no area or volume: use another mesh.");
    }
    const std::vector<double> field = finiteValues(this->TheMesh, o.field, o.fieldComponents,
      "A field is needed: choose a point array.", "values of the field");
    const HessianMagnitudes hessians = hessianMagnitudes(
      this->TheMesh, field, o.fieldComponents, o.recovery, o.fieldPrecision, o.limits.ratio);
    if (hessians.vanish)
    {
      this->note("The field is linear: its interpolation has no error, and all sizes are the "
                 "largest size.");
      return this->finished(std::vector<MetricTensor>(
        this->TheMesh.numberOfPoints(), isotropicMetric(o.limits.largest)));
    }
    const LpMetric metric(this->TheMesh, hessians.tensors, o.norm, o.limits);
    return o.target == MetricTarget::Error
      ? this->finished(metric.at(metric.factorForError(o.targetValue / hessians.unit)))
      : this->withTarget(metric);
  }

  /// Corrects the factor for the elements that intersection and gradation add.
  std::vector<MetricTensor> withTarget(const LpMetric& metric)
  {
    constexpr int maximumCorrections = 8;
    constexpr double near = 0.01, far = 0.1; // relative
    const MetricOptions& o = this->Options;
    const bool elements = o.target == MetricTarget::Elements;
    // Volumes in units of the ideal element turn the complexity into a number of elements.
    const std::vector<double>& weights =
      elements ? this->TheMesh.idealVolumes() : this->TheMesh.volumes();
    std::vector<MetricTensor> metrics;
    double requested = o.targetValue, found = 0.0;
    for (int i = 0; i < maximumCorrections; ++i)
    {
      metrics = this->finished(metric.at(metric.factorFor(weights, requested)));
      const double before = found;
      found =
        elements ? expectedElements(this->TheMesh, metrics) : complexity(this->TheMesh, metrics);
      if (found == before || std::abs(found / o.targetValue - 1.0) < near)
      {
        break; // all sizes are at a limit
      }
      // The elements that are added later are about proportional to the requested number.
      requested *= o.targetValue / found;
    }
    if (std::abs(found / o.targetValue - 1.0) > far)
    {
      std::ostringstream text;
      text << "The target of " << o.targetValue << (elements ? " elements" : "")
           << " was not reached (result: " << found
           << "): change the smallest and largest size, the anisotropy or the gradation.";
      this->note(text.str());
    }
    return metrics;
  }

  void note(const std::string& sentence)
  {
    this->Result.note += (this->Result.note.empty() ? "" : " ") + sentence;
  }

  const MetricOptions& Options;
  AdaptationMesh TheMesh;
  std::vector<MetricTensor> Others;
  MetricResult Result;
};
}

//------------------------------------------------------------------------------
MetricResult makeMetric(const Mesh& mesh, const MetricOptions& options)
{
  checkOptions(options);
  return MetricMaker(mesh, options).make();
}
}
