// SPDX-License-Identifier: BSD-3-Clause
#include "FieldTransfer.h"

#include "TransferCells.h"
#include "TransferLocator.h"
#include "TransferOverlaps.h"
#include "TransferPoints.h"
#include "TransferTotals.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

namespace tautline
{
namespace
{
constexpr Index PlacesPerChunk = 256;
/// Meshes are coplanar if no point is farther from the plane, relative to the common diagonal.
constexpr double FlatMesh = 1e-6;
/// How many components are projected at once: each needs memory for every simplex.
constexpr std::size_t ComponentsAtOnce = 16;
/// A source that covers less of the target is an error, for example a mistaken unit of length.
constexpr double LeastOverlap = 1e-6;
constexpr const char* NoOverlap = "The meshes do not overlap";
/// Totals are preserved if each mesh covers at least this fraction of the other.
constexpr double LeastCoverage = 0.5;
/// Fields with all magnitudes in this range need no scaling.
constexpr double SmallestValue = 1e-60, LargestValue = 1e60;

BoundingBox boxOfMesh(const TransferMesh& mesh)
{
  BoundingBox box;
  for (Index s = 0; s < mesh.numberOfSimplices(); ++s)
  {
    pollInterruption(s);
    box.add(boxOf(mesh, s));
  }
  return box;
}

std::string describeBox(const BoundingBox& box, const CoordinateFrame& frame)
{
  std::vector<double> x(box.low.begin(), box.low.end());
  x.insert(x.end(), box.high.begin(), box.high.end());
  frame.leave(x);
  std::ostringstream text;
  text << "from (" << x[0] << ", " << x[1] << ", " << x[2] << ") to (" << x[3] << ", " << x[4]
       << ", " << x[5] << ")";
  return text.str();
}

[[noreturn]] void failWithoutOverlap(const std::string& problem, const TransferMesh& target,
  const TransferMesh& source, const CoordinateFrame& frame)
{
  throw Error(problem + ": the target extends " + describeBox(boxOfMesh(target), frame) +
    ", the source " + describeBox(boxOfMesh(source), frame) +
    ". Move or scale one of them first (Transform).");
}

void requireElements(const TransferMesh& target, const TransferMesh& source)
{
  for (const TransferMesh* mesh : { &target, &source })
  {
    if (mesh->numberOfSimplices() == 0)
    {
      throw Error(std::string(mesh == &target ? "The target" : "The source") +
        " has no element with an area or volume: provide a mesh of triangles, quadrilaterals, "
        "polygons, tetrahedra, hexahedra, wedges or pyramids.");
    }
  }
  if (target.dimension() != source.dimension())
  {
    throw Error(target.dimension() == 3
        ? "The target is a volume, but the source is not: provide two volumes or two surfaces "
          "(Extract Surface)."
        : "The source is a volume, but the target is not: provide two volumes or two surfaces "
          "(Extract Surface).");
  }
}

/// Determines the space of the two meshes; coplanar meshes are converted to in-plane coordinates
/// with z = 0.
TransferSpace enterPlane(TransferMesh& target, TransferMesh& source)
{
  if (target.dimension() == 3)
  {
    return TransferSpace::Volume;
  }
  // The largest simplex determines the plane most accurately.
  const auto largest = std::max_element(target.sizes().begin(), target.sizes().end());
  const TransferMesh::Simplex& s = target.simplices()[largest - target.sizes().begin()];
  const Vec3 origin = target.points()[s[0]];
  const Vec3 edge = target.points()[s[1]] - origin;
  const Vec3 normal = cross(edge, target.points()[s[2]] - origin);
  const Vec3 n = (1.0 / norm(normal)) * normal;
  BoundingBox box = boxOfMesh(target);
  box.add(boxOfMesh(source));
  const double farthest = FlatMesh * norm(box.high - box.low);
  const auto isFlat = [&](const TransferMesh& mesh)
  {
    return std::all_of(mesh.simplices().begin(), mesh.simplices().end(),
      [&](const TransferMesh::Simplex& t)
      {
        return std::all_of(t.begin(), t.begin() + 3,
          [&](Index p) { return std::abs(dot(n, mesh.points()[p] - origin)) <= farthest; });
      });
  };
  if (!isFlat(target) || !isFlat(source))
  {
    return TransferSpace::Surface;
  }
  // Coordinates in a plane of two axes stay as they are.
  const bool plain = std::abs(n[2]) == 1.0;
  const Vec3 e1 = plain ? Vec3{ 1, 0, 0 } : (1.0 / norm(edge)) * edge;
  const Vec3 e2 = plain ? Vec3{ 0, 1, 0 } : cross(n, e1);
  for (TransferMesh* mesh : { &target, &source })
  {
    mesh->flatten(plain ? Vec3{ 0, 0, 0 } : origin, e1, e2);
  }
  return TransferSpace::Plane;
}

/// The values that may change to preserve totals: nonzero next to regions covered by only one of
/// the meshes; all 0 if there are none.
struct BesideGaps
{
  std::vector<unsigned char> cells, points;
};

/// Flags the simplices that have a point of a simplex without a flag.
std::vector<unsigned char> besideUnflagged(
  const TransferMesh& mesh, const std::vector<unsigned char>& flags)
{
  std::vector<unsigned char> points(mesh.points().size(), 0), beside(flags.size(), 0);
  const auto forEachPoint = [&](const auto& work)
  {
    for (std::size_t s = 0; s < flags.size(); ++s)
    {
      for (int k = 0; k < mesh.corners(); ++k)
      {
        work(s, mesh.simplices()[s][k]);
      }
    }
  };
  forEachPoint([&](std::size_t s, Index p) { points[p] |= !flags[s]; });
  forEachPoint([&](std::size_t s, Index p) { beside[s] |= points[p]; });
  return beside;
}

BesideGaps findGaps(
  const TransferMesh& target, const TransferMesh& source, const TransferOverlaps& overlaps)
{
  const std::vector<unsigned char> ofSource = besideUnflagged(source, overlaps.sourceIsCovered);
  std::vector<unsigned char> beside = besideUnflagged(target, overlaps.targetIsCovered);
  BesideGaps gaps;
  gaps.cells.assign(target.numberOfCells(), 0);
  gaps.points.assign(target.points().size(), 0);
  for (Index t = 0; t < target.numberOfSimplices(); ++t)
  {
    // A target simplex is also beside a gap if it overlaps a source simplex that is.
    for (Index k = overlaps.starts[t]; k < overlaps.starts[t + 1]; ++k)
    {
      beside[t] |= ofSource[overlaps.overlaps[k].simplex];
    }
    for (int k = 0; beside[t] && k < target.corners(); ++k)
    {
      gaps.cells[target.cells()[t]] = 1;
      gaps.points[target.simplices()[t][k]] = 1;
    }
  }
  return gaps;
}

/// A component scaled by a power of two so that no value is very large or small.
struct Component
{
  std::size_t field;
  int number;
  double unit = 1.0;
  std::vector<double> values;

  Component(const std::vector<TransferField>& fields, std::size_t ofField, int component)
    : field(ofField)
    , number(component)
    , values(fields[ofField].values.size() / fields[ofField].components)
  {
    const TransferField& from = fields[ofField];
    double largest = 0.0;
    for (std::size_t i = 0; i < this->values.size(); ++i)
    {
      this->values[i] = from.values[i * from.components + component];
      largest = std::max(largest, std::abs(this->values[i]));
    }
    if (largest < SmallestValue || largest > LargestValue)
    {
      constexpr int farthest = 1022; // so that its reciprocal is normal
      this->unit =
        largest > 0.0 ? std::ldexp(1.0, std::clamp(std::ilogb(largest), -farthest, farthest)) : 1.0;
      for (double& value : this->values)
      {
        value /= this->unit;
      }
    }
  }
};

/// The smallest and largest of the values with a weight.
void takeExtremes(const std::vector<double>& weights, const std::vector<double>& values,
  double& minimum, double& maximum)
{
  bool first = true;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (weights[i] > 0.0)
    {
      minimum = first ? values[i] : std::min(minimum, values[i]);
      maximum = first ? values[i] : std::max(maximum, values[i]);
      first = false;
    }
  }
}

std::vector<double> sizesOfCells(const TransferMesh& mesh)
{
  std::vector<double> sizes;
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    sizes.push_back(mesh.sizeOfCell(cell));
  }
  return sizes;
}

/// The state of a transfer.
class FieldTransfer
{
public:
  FieldTransfer(TransferMesh& target, TransferMesh& source,
    const std::vector<TransferField>& fields, const TransferOptions& options)
    : Target(target)
    , Source(source)
    , Fields(fields)
    , Options(options)
    , Space(enterPlane(target, source))
    , Locator(source)
  {
  }

  TransferResult run();

private:
  bool has(bool ofCells) const
  {
    return std::any_of(this->Fields.begin(), this->Fields.end(),
      [ofCells](const TransferField& field) { return field.ofCells == ofCells; });
  }
  void findOverlaps();
  void transferCells();
  void transferPoints();
  void project(std::vector<TransferPlace>& places, std::vector<unsigned char>& known);
  std::vector<Index> nearestCells(const std::vector<Index>& known) const;
  /// The linear function with some values at the points of the source.
  double valueAt(const TransferPlace& place, const std::vector<double>& values) const
  {
    const TransferMesh::Simplex& s = this->Source.simplices()[place.simplex];
    double value = 0.0;
    for (int k = 0; k < this->Source.corners(); ++k)
    {
      value += place.weights[k] * values[s[k]];
    }
    return value;
  }
  void finish(const Component& component, BoundedValues& values);

  TransferMesh &Target, &Source;
  const std::vector<TransferField>& Fields;
  const TransferOptions& Options;
  TransferSpace Space;
  TransferLocator Locator;
  TransferOverlaps Overlaps;
  BesideGaps Gaps;
  std::vector<double> CellSizes, PointSizes, SourceCellSizes, SourcePointSizes;
  TransferResult Result;
};

TransferResult FieldTransfer::run()
{
  this->CellSizes = sizesOfCells(this->Target);
  this->SourceCellSizes = sizesOfCells(this->Source);
  this->PointSizes = sharesOfPoints(this->Target);
  this->SourcePointSizes = sharesOfPoints(this->Source);
  this->Result.sourceSize = this->Source.size();
  this->Result.targetSize = this->Target.size();
  this->Result.surface = this->Space == TransferSpace::Surface;
  for (const TransferField& field : this->Fields)
  {
    const Index count =
      field.ofCells ? this->Target.numberOfCells() : this->Target.numberOfPoints();
    TransferredField made;
    made.values.resize(static_cast<std::size_t>(count) * field.components);
    made.totals.resize(field.components);
    this->Result.fields.push_back(std::move(made));
  }
  this->findOverlaps();
  this->transferCells();
  this->transferPoints();
  return std::move(this->Result);
}

void FieldTransfer::findOverlaps()
{
  if (this->Options.method == TransferMethod::Interpolate)
  {
    // The boxes of surfaces are wider than the surfaces.
    if (!this->Locator.tree().bounds().meets(boxOfMesh(this->Target)))
    {
      failWithoutOverlap(NoOverlap, this->Target, this->Source, this->Options.frame);
    }
    return;
  }
  this->Overlaps = tautline::findOverlaps(
    this->Target, this->Locator.tree(), this->Source, this->Space, this->Options.threads);
  if (this->Overlaps.overlaps.empty())
  {
    failWithoutOverlap(NoOverlap, this->Target, this->Source, this->Options.frame);
  }
  const auto sum = [](const std::vector<double>& sizes)
  { return std::accumulate(sizes.begin(), sizes.end(), 0.0); };
  this->Result.sourceCovered = sum(this->Overlaps.coveredSource);
  this->Result.targetCovered = sum(this->Overlaps.coveredTarget);
  if (this->Result.targetCovered < LeastOverlap * this->Result.targetSize)
  {
    failWithoutOverlap("The source covers less than a millionth of the target", this->Target,
      this->Source, this->Options.frame);
  }
  // Equal totals are only meaningful if each mesh covers the other one.
  this->Result.totalsKept = this->Options.keepTotal &&
    this->Result.sourceCovered >= LeastCoverage * this->Result.sourceSize &&
    this->Result.targetCovered >= LeastCoverage * this->Result.targetSize;
  this->Gaps = findGaps(this->Target, this->Source, this->Overlaps);
}

/// The source cells already known, otherwise the cells nearest to the centers.
std::vector<Index> FieldTransfer::nearestCells(const std::vector<Index>& known) const
{
  std::vector<Index> cells(known);
  cells.resize(this->Target.numberOfCells(), -1);
  parallelFor(this->Target.numberOfCells(), PlacesPerChunk, this->Options.threads,
    [&](Index cell)
    {
      if (cells[cell] < 0)
      {
        cells[cell] =
          this->Source.cells()[this->Locator.nearest(this->Target.center(cell)).simplex];
      }
    });
  return cells;
}

void FieldTransfer::transferCells()
{
  if (!this->Options.cellLabels && !this->has(true))
  {
    return;
  }
  const bool conservative = this->Options.method == TransferMethod::Conservative;
  CellShares shares;
  std::vector<Index> largest(this->Target.numberOfCells(), -1);
  if (conservative)
  {
    shares = cellShares(this->Target, this->Source, this->Overlaps,
      this->Options.cells == CellReconstruction::Linear && this->has(true), this->Options.threads);
    largest = largestShares(shares);
    for (Index cell = 0; cell < this->Target.numberOfCells(); ++cell)
    {
      this->Result.nearestCells += largest[cell] < 0 && this->CellSizes[cell] > 0.0;
    }
  }
  else
  {
    shares.starts.assign(this->Target.numberOfCells() + 1, 0);
  }
  this->Result.cells = this->nearestCells(largest);
  const CellTransfer transfer(
    this->Target, this->Source, shares, this->Result.cells, this->Options.threads);
  for (std::size_t f = 0; f < this->Fields.size(); ++f)
  {
    for (int c = 0; this->Fields[f].ofCells && c < this->Fields[f].components; ++c)
    {
      const Component component(this->Fields, f, c);
      BoundedValues values = transfer.apply(component.values);
      this->finish(component, values);
    }
  }
}

/// Projects the fields of points, and finds the points without a value.
void FieldTransfer::project(std::vector<TransferPlace>& places, std::vector<unsigned char>& known)
{
  std::vector<std::pair<std::size_t, int>> all;
  for (std::size_t f = 0; f < this->Fields.size(); ++f)
  {
    for (int c = 0; !this->Fields[f].ofCells && c < this->Fields[f].components; ++c)
    {
      all.emplace_back(f, c);
    }
  }
  const Index points = this->Target.numberOfPoints();
  for (std::size_t first = 0; first < all.size(); first += ComponentsAtOnce)
  {
    std::vector<Component> components;
    std::vector<std::vector<double>> before;
    for (std::size_t i = first; i < std::min(all.size(), first + ComponentsAtOnce); ++i)
    {
      components.emplace_back(this->Fields, all[i].first, all[i].second);
      before.push_back(components.back().values);
    }
    const PointProjection projection(
      this->Target, this->Source, this->Overlaps, before, this->Options.threads);
    // All components have the same uncovered points.
    if (first == 0)
    {
      parallelFor(points, PlacesPerChunk, this->Options.threads,
        [&](Index p)
        {
          known[p] = projection.common()[p] > 0.0;
          places[p] = known[p] ? TransferPlace() : this->Locator.nearest(this->Target.points()[p]);
        });
    }
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      BoundedValues values = projection.apply(i);
      for (Index p = 0; p < points; ++p)
      {
        if (!known[p])
        {
          values.values[p] = this->valueAt(places[p], before[i]);
          // With equal bounds, this value is kept when totals are restored.
          values.low[p] = values.high[p] = values.values[p];
        }
      }
      this->finish(components[i], values);
    }
  }
}

void FieldTransfer::transferPoints()
{
  const Index points = this->Target.numberOfPoints();
  if (this->Options.pointLabels)
  {
    this->Result.points.resize(points);
    parallelFor(points, PlacesPerChunk, this->Options.threads,
      [&](Index p)
      { this->Result.points[p] = this->Locator.nearestPoint(this->Target.points()[p]); });
  }
  if (!this->has(false))
  {
    return;
  }
  std::vector<TransferPlace> places(points);
  std::vector<unsigned char> known(points, 1);
  if (this->Options.method == TransferMethod::Conservative)
  {
    this->project(places, known);
    for (Index p = 0; p < points; ++p)
    {
      this->Result.nearestPoints += !known[p] && this->PointSizes[p] > 0.0;
    }
    return;
  }
  parallelFor(points, PlacesPerChunk, this->Options.threads,
    [&](Index p) { places[p] = this->Locator.nearest(this->Target.points()[p]); });
  for (std::size_t f = 0; f < this->Fields.size(); ++f)
  {
    for (int c = 0; !this->Fields[f].ofCells && c < this->Fields[f].components; ++c)
    {
      const Component component(this->Fields, f, c);
      BoundedValues values;
      for (Index p = 0; p < points; ++p)
      {
        values.values.push_back(this->valueAt(places[p], component.values));
      }
      values.low = values.high = values.values;
      this->finish(component, values);
    }
  }
}

/// Restores the total, if requested, and records the report.
void FieldTransfer::finish(const Component& component, BoundedValues& values)
{
  const TransferField& field = this->Fields[component.field];
  const std::vector<double>& weightsBefore =
    field.ofCells ? this->SourceCellSizes : this->SourcePointSizes;
  const std::vector<double>& weights = field.ofCells ? this->CellSizes : this->PointSizes;
  const WeightedTotal total = totalOf(weightsBefore, component.values);
  if (this->Result.totalsKept)
  {
    takeTotal(weights, field.ofCells ? this->Gaps.cells : this->Gaps.points, total.total,
      total.magnitude, values);
  }
  TransferredField& made = this->Result.fields[component.field];
  TransferTotal& report = made.totals[component.number];
  report.before = total.total;
  report.magnitude = total.magnitude;
  report.after = totalOf(weights, values.values).total;
  report.excess = values.excess(weights);
  takeExtremes(weightsBefore, component.values, report.minimumBefore, report.maximumBefore);
  takeExtremes(weights, values.values, report.minimumAfter, report.maximumAfter);
  for (double* each : { &report.before, &report.magnitude, &report.after, &report.excess,
         &report.minimumBefore, &report.maximumBefore, &report.minimumAfter, &report.maximumAfter })
  {
    *each *= component.unit;
  }
  for (std::size_t i = 0; i < values.values.size(); ++i)
  {
    made.values[i * field.components + component.number] = component.unit * values.values[i];
  }
}
}

//------------------------------------------------------------------------------
TransferResult transferFields(TransferMesh target, TransferMesh source,
  const std::vector<TransferField>& fields, const TransferOptions& options)
{
  requireElements(target, source);
  return FieldTransfer(target, source, fields, options).run();
}
}
