// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedQuality.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Elements/ElementSamples.h"
#include "tautline/Elements/JacobianCertifier.h"
#include "tautline/Elements/MetricCertifier.h"
#include "tautline/Elements/TargetForm.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// The accuracy of certified metrics: absolute, and for small values relative.
constexpr double metricTolerance = 1e-3;
/// Below this value, the relative accuracy is stricter than the absolute one.
constexpr double smallMetric = 0.25;
constexpr double smallestGap = 1e-8;

bool isCertified(Metric metric, const EvaluationOptions& options)
{
  const bool worst = options.combination == Combination::Worst;
  return metric == Metric::ScaledJacobian ||
    (worst &&
      (metric == Metric::InverseMeanRatio || metric == Metric::MeanRatio ||
        metric == Metric::ConditionNumber));
}

ElementMetric certifiedMetric(Metric metric)
{
  return metric == Metric::ScaledJacobian ? ElementMetric::ScaledJacobian
    : metric == Metric::ConditionNumber   ? ElementMetric::InverseCondition
                                          : ElementMetric::MeanRatio;
}

/// The corners of the ideal triangle and tetrahedron.
constexpr int MaxSimplexNodes = 4;
Vec3 idealCorner(bool flat, int node)
{
  const double root3 = std::sqrt(3.0);
  const Vec3 corners[MaxSimplexNodes] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, root3 / 2, 0 },
    { 0.5, root3 / 6, std::sqrt(2.0 / 3) } };
  return corners[flat ? std::min(node, 2) : node];
}

/**
 * @brief Simplices, one per sample, whose map from the ideal simplex has the gradient T: a metric
 * of T has the same value on them.
 */
class SampleMesh
{
public:
  SampleMesh(const Mesh& mesh, const ElementType& type)
    : Space(mesh.space())
    , Flat(type.dimension() == 2)
    , Corners(Flat ? 3 : 4)
    , Inverse(idealInverseOf(type.shape()))
  {
  }

  /// @param columns of A
  void add(const std::array<Vec3, 3>& columns)
  {
    Vec3 t[3];
    // T = A W^-1, column by column, with the ideal element W.
    for (int c = 0; c < 3; ++c)
    {
      t[c] = this->Inverse[0][c] * columns[0] + this->Inverse[1][c] * columns[1] +
        this->Inverse[2][c] * columns[2];
    }
    // Corner k of the sample simplex is T w_k, with corner w_k of the ideal simplex.
    for (int k = 0; k < this->Corners; ++k)
    {
      const Vec3 w = idealCorner(this->Flat, k);
      this->Points.push_back(w[0] * t[0] + w[1] * t[1] + w[2] * t[2]);
    }
  }

  Index count() const { return static_cast<Index>(this->Points.size()) / this->Corners; }

  /// The values of a metric.
  std::vector<double> evaluate(Metric metric, const EvaluationOptions& options, bool mirrored)
  {
    const Index n = this->count();
    std::vector<double> values(n);
    if (n == 0)
    {
      return values;
    }
    const auto type =
      static_cast<unsigned char>(this->Flat ? CellType::Triangle : CellType::Tetrahedron);
    this->Types.assign(n, type);
    this->Offsets.resize(n + 1);
    this->Connectivity.resize(n * this->Corners);
    for (Index i = 0; i <= n; ++i)
    {
      this->Offsets[i] = i * this->Corners;
    }
    for (Index i = 0; i < n * this->Corners; ++i)
    {
      this->Connectivity[i] = i;
    }
    MeshView view;
    view.numberOfPoints = n * this->Corners;
    view.points = this->Points[0].data();
    view.numberOfCells = n;
    view.cellTypes = this->Types.data();
    view.offsets = this->Offsets.data();
    view.connectivity = this->Connectivity.data();
    Mesh samples(view, 1);
    samples.setSpace(this->Space);
    samples.setMirrored(mirrored);
    // The samples of one chunk are evaluated inside a parallel loop.
    EvaluationOptions one = options;
    one.threads = 1;
    evaluateMetric(samples, metric, one, values.data());
    return values;
  }

private:
  MeshSpace Space;
  bool Flat;
  int Corners;
  std::array<Vec3, 3> Inverse;
  std::vector<Vec3> Points;
  std::vector<unsigned char> Types;
  std::vector<Index> Offsets, Connectivity;
};

/// The values at the samples of one cell as one value; see Combination.
double combine(const EvaluationOptions& options, bool largerIsBetter, bool onlyNegative,
  const std::vector<double>& weights, const double* values, const double* determinants)
{
  const std::size_t count = weights.size();
  // As with corners, only inverted samples count in an element that has any.
  const bool some =
    onlyNegative && std::any_of(determinants, determinants + count, [](double d) { return d < 0; });
  const double power = largerIsBetter ? -options.power : options.power;
  double sum = 0, total = 0, sign = 0, unit = 0;
  double worst = largerIsBetter ? std::numeric_limits<double>::infinity()
                                : -std::numeric_limits<double>::infinity();
  const auto counts = [&](std::size_t s) { return !some || determinants[s] < 0; };
  for (std::size_t s = 0; s < count; ++s)
  {
    if (counts(s))
    {
      worst = largerIsBetter ? std::min(worst, values[s]) : std::max(worst, values[s]);
      const double size = std::abs(values[s]);
      // Scale by the extreme value, so that high powers do not overflow.
      unit = total == 0 ? size : largerIsBetter ? std::min(unit, size) : std::max(unit, size);
      total += weights[s];
      sum += weights[s] * values[s];
      sign += weights[s] * values[s];
    }
  }
  switch (options.combination)
  {
    case Combination::Worst:
      return worst;
    case Combination::Mean:
      return sum / total;
    default:
      break;
  }
  // Power mean of the magnitudes; with the sign of the mean.
  double powers = 0;
  for (std::size_t s = 0; s < count && unit > 0; ++s)
  {
    powers += counts(s) ? weights[s] * std::pow(std::abs(values[s]) / unit, power) : 0;
  }
  const double mean = unit > 0 ? unit * std::pow(powers / total, 1 / power) : 0;
  return std::copysign(std::isfinite(mean) ? mean : 0.0, sign);
}
}

//------------------------------------------------------------------------------
CurvedQuality::CurvedQuality(const Mesh& mesh, const CurvedCellFacts& facts, int threads)
  : TheMesh(mesh)
  , Threads(threads)
  , Blocks(curvedBlocks(mesh, facts))
{
  for (const CurvedBlock& block : this->Blocks)
  {
    this->Count += block.count();
  }
}

//------------------------------------------------------------------------------
void CurvedQuality::certify(signed char* validity)
{
  if (this->Count > 0)
  {
    this->Minima.resize(this->TheMesh.view().numberOfCells);
    certifyBlocks(
      this->Blocks, this->TheMesh.view().points, validity, this->Minima.data(), this->Threads);
  }
}

//------------------------------------------------------------------------------
bool CurvedQuality::measures(Metric metric, const EvaluationOptions& options) const
{
  const MetricInfo& info = metricInfo(metric);
  const bool target = info.family == MetricFamily::Target && metric != Metric::UntangleBeta &&
    !options.targets && !needsDifferences(metric);
  return this->Count > 0 &&
    (target || metric == Metric::MinimumJacobian || metric == Metric::Size ||
      isCertified(metric, options));
}

//------------------------------------------------------------------------------
bool CurvedQuality::measure(Metric metric, const EvaluationOptions& options,
  const signed char* validity, double* values) const
{
  if (!this->measures(metric, options))
  {
    return false;
  }
  const MetricInfo& info = metricInfo(metric);
  for (const CurvedBlock& block : this->Blocks)
  {
    if (!info.definedOn(cornerType(this->TheMesh.view().cellTypes[block.cells.front()])))
    {
      continue;
    }
    if (metric == Metric::MinimumJacobian)
    {
      for (Index cell : block.cells)
      {
        values[cell] = this->Minima[cell].value;
      }
    }
    else if (metric == Metric::Size)
    {
      this->measureSizes(block, values);
    }
    else if (isCertified(metric, options) &&
      (!options.targets || info.family != MetricFamily::Target))
    {
      this->bound(block, metric, validity, values);
    }
    else
    {
      this->sample(block, info, options, validity, values);
    }
  }
  return true;
}

//------------------------------------------------------------------------------
void CurvedQuality::bound(
  const CurvedBlock& block, Metric metric, const signed char* validity, double* values) const
{
  const double* points = this->TheMesh.view().points;
  // The certified bound is a minimum: metrics that are reciprocals are bounded by their inverse.
  const bool reciprocal = metric == Metric::InverseMeanRatio || metric == Metric::ConditionNumber;
  forEachChunk(block.count(), this->Threads,
    [&](Index, Index begin, Index end)
    {
      // A certifier is for one orientation, so mirrored cells form a group of their own.
      for (bool mirrored : { false, true })
      {
        const std::vector<Index> positions = block.positions(begin, end, mirrored);
        if (positions.empty())
        {
          continue;
        }
        MetricCertifier certifier(*block.type, certifiedMetric(metric), block.normal, mirrored);
        for (Index i : positions)
        {
          const Index cell = block.cells[i];
          double value = 0;
          // The value where the determinant is smallest represents an inverted element.
          if (validity[cell] == Inverted)
          {
            value = certifier.valueAt(points, block.nodes[i], this->Minima[cell].at);
          }
          else if (validity[cell] == Valid)
          {
            value = certifier.minimum(points, block.nodes[i], metricTolerance).upper;
            if (value < smallMetric)
            {
              const double gap = std::max(metricTolerance * value, smallestGap);
              value = certifier.minimum(points, block.nodes[i], gap).upper;
            }
          }
          values[cell] = reciprocal && value != 0 ? 1 / value : value;
        }
      }
    });
}

//------------------------------------------------------------------------------
void CurvedQuality::measureSizes(const CurvedBlock& block, double* values) const
{
  const double* points = this->TheMesh.view().points;
  const double reference = referenceSizeOf(block.type->shape());
  // The mean of a polynomial determinant follows exactly from its coefficients; on pyramids and on
  // surfaces in space it is not a polynomial.
  const bool byCoefficients = block.type->shape() != ElementShape::Pyramid &&
    (block.type->dimension() == 3 || norm(block.normal) > 0);
  const ElementSamples samples(*block.type, quadratureOf(*block.type));
  forEachChunk(block.count(), this->Threads,
    [&](Index, Index begin, Index end)
    {
      JacobianCertifier certifier(*block.type, block.normal);
      for (Index i = begin; i < end; ++i)
      {
        double sum = 0;
        if (byCoefficients)
        {
          sum = certifier.meanJacobian(points, block.nodes[i]);
        }
        else
        {
          for (int s = 0; s < samples.count(); ++s)
          {
            const std::array<Vec3, 3> a = samples.columns(s, points, block.nodes[i]);
            const Vec3 n = cross(a[0], a[1]);
            sum +=
              samples.rule().weights[s] * (block.type->dimension() == 3 ? dot(n, a[2]) : norm(n));
          }
        }
        const bool surface = block.type->dimension() == 2 && norm(block.normal) == 0;
        const double size = (block.mirrored[i] && !surface ? -reference : reference) * sum;
        values[block.cells[i]] = std::isfinite(size) ? size : 0;
      }
    });
}

//------------------------------------------------------------------------------
void CurvedQuality::sample(const CurvedBlock& block, const MetricInfo& info,
  const EvaluationOptions& options, const signed char* validity, double* values) const
{
  const double* points = this->TheMesh.view().points;
  const ElementSamples samples(*block.type, quadratureOf(*block.type));
  const bool larger = info.direction == Direction::LargerIsBetter;
  const bool onlyNegative = info.inverted != InvertedValue::Larger;
  const int count = samples.count();
  forEachChunk(block.count(), this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (bool mirrored : { false, true })
      {
        SampleMesh simplices(this->TheMesh, *block.type);
        const std::vector<Index> positions = block.positions(begin, end, mirrored);
        std::vector<double> determinants(count);
        std::vector<double> all;
        for (Index i : positions)
        {
          samples.determinants(points, block.nodes[i], block.normal, mirrored, determinants.data());
          all.insert(all.end(), determinants.begin(), determinants.end());
          for (int s = 0; s < count; ++s)
          {
            simplices.add(samples.columns(s, points, block.nodes[i]));
          }
          if (validity[block.cells[i]] == Inverted)
          {
            // Add the position of the smallest determinant, which the samples may have missed.
            const Vec3& at = this->Minima[block.cells[i]].at;
            simplices.add(samples.columnsAt(at, points, block.nodes[i]));
            // Any negative number: only the sign is used.
            all.push_back(-1);
          }
        }
        // All samples of a chunk form one mesh, so that they fill the packets.
        const std::vector<double> found = simplices.evaluate(info.metric, options, mirrored);
        std::size_t at = 0;
        for (Index i : positions)
        {
          const Index cell = block.cells[i];
          std::vector<double> weights = samples.rule().weights;
          // The added position has the weight of an average sample.
          if (validity[cell] == Inverted)
          {
            weights.push_back(1.0 / count);
          }
          // A metric with a barrier has no value on a degenerate element.
          const bool vanishes = info.barrier && validity[cell] == Degenerate;
          const double value =
            combine(options, larger, onlyNegative, weights, found.data() + at, all.data() + at);
          values[cell] =
            vanishes || validity[cell] == NonFinite || !std::isfinite(value) ? 0 : value;
          at += weights.size();
        }
      }
    });
}

//------------------------------------------------------------------------------
void CurvedQuality::places(double* reference, double* points) const
{
  const MeshView& view = this->TheMesh.view();
  std::fill_n(reference, 3 * view.numberOfCells, 0.0);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    const Vec3 center =
      type == CellType::Unsupported ? Vec3{ 0, 0, 0 } : this->TheMesh.center(cell, type);
    std::copy(center.begin(), center.end(), points + 3 * cell);
  }
  for (const CurvedBlock& block : this->Blocks)
  {
    for (Index i = 0; i < block.count() && !this->Minima.empty(); ++i)
    {
      const Index cell = block.cells[i];
      const Vec3& at = this->Minima[cell].at;
      const Vec3 point = pointOfElement(*block.type, view.points, block.nodes[i], at);
      std::copy(at.begin(), at.end(), reference + 3 * cell);
      std::copy(point.begin(), point.end(), points + 3 * cell);
    }
  }
}

//------------------------------------------------------------------------------
MissedCells CurvedQuality::missed(const signed char* validity, const unsigned char* skip) const
{
  MissedCells missed;
  const double* points = this->TheMesh.view().points;
  for (const CurvedBlock& block : this->Blocks)
  {
    const ElementSamples corners(*block.type, cornersOf(*block.type));
    const ElementSamples usual(*block.type, integrationPoints(*block.type));
    for (Index i = 0; i < block.count(); ++i)
    {
      const Index cell = block.cells[i];
      if (skip && skip[cell])
      {
        continue;
      }
      ++missed.curved;
      if (!isInvalid(validity[cell]))
      {
        continue;
      }
      ++missed.invalid;
      const auto positive = [&](const ElementSamples& samples)
      {
        std::vector<double> values(samples.count());
        samples.determinants(
          points, block.nodes[i], block.normal, block.mirrored[i] != 0, values.data());
        return std::all_of(values.begin(), values.end(), [](double d) { return d > 0; });
      };
      // A check at only these points would miss the element.
      missed.atCorners += positive(corners);
      missed.atIntegrationPoints += positive(usual);
    }
  }
  return missed;
}

//------------------------------------------------------------------------------
Index CurvedQuality::turnedWedges() const
{
  Index count = 0;
  for (const CurvedBlock& block : this->Blocks)
  {
    count += block.turned ? block.count() : 0;
  }
  return count;
}
}
