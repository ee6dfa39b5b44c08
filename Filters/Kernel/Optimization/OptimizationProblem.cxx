// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizationProblem.h"

#include "tautline/Mesh/MeshElements.h"
#include "tautline/Quality/UserMetric.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Whether a template is a sum of functions of single elements.
bool addsUp(ObjectiveTemplate form)
{
  return form != ObjectiveTemplate::PowerMean && form != ObjectiveTemplate::Maximum;
}

/// Whether a metric is a user metric that only depends on |T|^2 and det T.
bool isOfInvariants(const MetricInfo& info, CellType type)
{
  if (!info.user || info.user->argument() != MetricArgument::Jacobian)
  {
    return false;
  }
  const double ideal[2] = { static_cast<double>(topology(type).dimension), 1.0 };
  double value = 0, derivatives[5];
  return info.user->evaluateInvariants(type, 1, 1, ideal, &value, derivatives);
}

/// The bounds of points and the scale of edges of a mesh on several ranks.
SimplexFrame frameOf(const Mesh& local, const Ranks& ranks)
{
  const MeshView& view = local.view();
  SimplexFrame frame;
  for (int c = 0; c < 3; ++c)
  {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      low = std::min(low, view.points[3 * p + c]);
      high = std::max(high, view.points[3 * p + c]);
    }
    frame.low[c] = -ranks.maximum(-low);
    frame.high[c] = ranks.maximum(high);
  }
  std::vector<double> lengths;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    if (ranks.ownsCell(cell))
    {
      lengths.push_back(norm(pointOf(view, node[1]) - pointOf(view, node[0])));
    }
  }
  const auto cells = static_cast<double>(std::max<Index>(1, ranks.mesh().globalCells()));
  frame.scale = powerOfTwo(ranks.total(lengths) / cells);
  return frame;
}
}

//------------------------------------------------------------------------------
OptimizationProblem::OptimizationProblem(const Mesh& mesh, const OptimizeOptions& options,
  std::vector<double>& points, const Stopwatch& clock, const Ranks& ranks)
  : TheMesh(mesh)
  , TheRanks(ranks)
  , Options(options)
  , Points(points)
  , Clock(clock)
{
  const MeshView& view = mesh.view();
  this->Moving = std::make_unique<Mesh>(mesh.at(points.data()));
  // Keep the space of the input although the points may have moved: it decides which methods are
  // applicable.
  this->Moving->setSpace(mesh.space());
  this->Resolved = options.objectives;

  // One set of targets can be built into the simplices; objectives with other targets use the
  // general path.
  const Targets* targets = nullptr;
  for (Objective& objective : this->Resolved)
  {
    objective.objectiveTemplate = objective.objectiveTemplate == ObjectiveTemplate::Default
      ? defaultTemplate(objective.metric)
      : objective.objectiveTemplate;
    objective.evaluation.threads = options.threads;
    if (!targets && objective.evaluation.targets &&
      objective.evaluation.targets->metricRoots.empty())
    {
      targets = objective.evaluation.targets;
    }
  }
  const SimplexFrame frame = ranks.several() ? frameOf(*this->Moving, ranks) : SimplexFrame();
  this->Simplices = std::make_unique<SimplexMesh>(
    *this->Moving, options.fixed, targets, options.threads, ranks.several() ? &frame : nullptr);
  this->makeSurface();
  // Objectives that are energies of the simplices are evaluated without the metrics.
  this->Sums.resize(this->Resolved.size());
  this->Weights.resize(this->Resolved.size());
  this->AllFast = true;
  for (const Objective& objective : this->Resolved)
  {
    this->Terms.push_back(this->fastTerm(objective));
    // Simplices have the targets of the objective, or the ideal ones.
    const LocalTerm& term = this->Terms.back();
    this->AllFast = this->AllFast && (term.shapePower > 0 || term.sizeSquared > 0);
    if (objective.evaluation.targets != targets && (term.shapePower > 0 || term.invariantScale > 0))
    {
      this->Terms.back() = LocalTerm();
      this->AllFast = false;
    }
  }
  bool some = this->Moving->nonFinitePoints() > 0 || !this->AllFast;
  if (!some)
  {
    this->summarizeSimplices(this->AtStart);
    some = this->AtStart.inverted > 0;
  }
  if (ranks.any(some))
  {
    // Inverted elements that no objective can repair, and elements with NaN, are left out.
    this->AtStart = {};
    std::vector<signed char> validity(view.numberOfCells);
    this->Moving->classifyCells(validity.data(), options.threads);
    this->leaveOut(validity);
  }
  std::vector<double> largest = this->largestValues();
  std::transform(largest.begin(), largest.end(), largest.begin(),
    [&ranks](double value) { return ranks.maximum(value); });
  this->rescaleUntangling(largest);
  if (ranks.several())
  {
    this->agreeOnForms();
  }
}

//------------------------------------------------------------------------------
/// On several ranks: an objective is in closed form either on all ranks or on none.
void OptimizationProblem::agreeOnForms()
{
  // A rank without cells follows the others.
  const bool here = this->Moving->view().numberOfCells > 0;
  bool weighted = false, all = true;
  for (std::size_t i = 0; i < this->Terms.size(); ++i)
  {
    const bool closed = !this->TheRanks.any(here && !this->Terms[i].ofSimplices());
    this->Terms[i] = closed ? this->Terms[i] : LocalTerm();
    all = all && closed;
    weighted = weighted || this->Resolved[i].elementWeights;
  }
  this->AllFast = all && (this->AllFast || !here);
  if (this->TheRanks.any(weighted) && !all)
  {
    this->Terms.assign(this->Terms.size(), LocalTerm()); // weights of cells differ by objective
  }
  for (std::size_t i = 0; i < this->Resolved.size(); ++i)
  {
    this->sum(i); // a collective call
  }
}

//------------------------------------------------------------------------------
LocalTerm OptimizationProblem::fastTerm(const Objective& objective) const
{
  LocalTerm term;
  const CellTopology* elements = nullptr;
  for (const CellBlock& block : this->Moving->blocks())
  {
    if (!isElement(*this->Moving, block.type))
    {
      continue;
    }
    elements = &topology(block.type);
    if (elements->samples > 1)
    {
      return term; // several corners make one value
    }
  }
  // Weights and tensors belong to cells, which the energies do not distinguish.
  if (!elements || objective.elementWeights ||
    (objective.evaluation.targets && !objective.evaluation.targets->metricRoots.empty()))
  {
    return term;
  }
  using T = ObjectiveTemplate;
  const T objectiveTemplate = objective.objectiveTemplate;
  if (objective.metric == Metric::InverseMeanRatio)
  {
    term.shapePower = objectiveTemplate == T::SumOfSquares ? 2
      : objectiveTemplate == T::Sum                        ? 1
                                                           : 0;
  }
  else if (objective.metric == Metric::MeanRatio)
  {
    term.shapePower = objectiveTemplate == T::SumOfSquaredReciprocals ? 2
      : objectiveTemplate == T::SumOfReciprocals                      ? 1
                                                                      : 0;
  }
  else if (objective.metric == Metric::Size && objectiveTemplate == T::SumOfSquares &&
    !objective.evaluation.targets && this->Simplices->uniform() && !this->Simplices->surface())
  {
    // V = size of the ideal cell x D, in units of the simplices' scale.
    const double size = elements->sizePerDeterminant / this->Simplices->target(0).det *
      std::pow(this->Simplices->scale(), elements->dimension);
    term.sizeSquared = size * size;
  }
  else if (!this->Options.allowInversion && addsUp(objectiveTemplate) &&
    isOfInvariants(metricInfo(objective.metric), elements->type))
  {
    const bool ideal = !objective.evaluation.targets && this->Simplices->uniform();
    term.invariantScale = metricInfo(objective.metric).scaleInvariant ? 1.0
      : ideal                                                         ? this->Simplices->scale()
                                                                      : 0.0;
  }
  return term;
}

//------------------------------------------------------------------------------
Validity cornerValidity(const Mesh& mesh, Index cell)
{
  const MeshView& view = mesh.view();
  const CellType type = cornerType(view.cellTypes[cell]);
  if (type == CellType::Unsupported)
  {
    return NotMeasured;
  }
  const CellTopology& t = topology(type);
  Vec3 vertices[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    vertices[k] = pointOf(view, view.connectivity[view.offsets[cell] + k]);
  }
  return mesh.classifyCorners(t, vertices);
}

//------------------------------------------------------------------------------
void OptimizationProblem::leaveOut(std::vector<signed char> validity)
{
  const Index cells = static_cast<Index>(validity.size());
  // Objectives are functions of the corners: elements that are folded only between them are
  // included, which often unfolds them.
  for (Index cell = 0; cell < cells; ++cell)
  {
    if (isInvalid(validity[cell]))
    {
      validity[cell] = cornerValidity(*this->Moving, cell);
    }
  }
  for (std::size_t i = 0; i < this->Resolved.size(); ++i)
  {
    Objective& objective = this->Resolved[i];
    const bool repairs = canUntangle(objective);
    const auto out = [&](Index cell)
    { return validity[cell] == NonFinite || (isInvalid(validity[cell]) && !repairs); };
    Index count = 0;
    for (Index cell = 0; cell < cells; ++cell)
    {
      count += out(cell);
    }
    if (!this->TheRanks.any(count > 0))
    {
      continue;
    }
    Index elements = 0;
    for (const CellBlock& block : this->Moving->blocks())
    {
      for (Index c = 0; isElement(*this->Moving, block.type) && c < block.count; ++c)
      {
        elements += !out(block.cell(c));
      }
    }
    if (!this->TheRanks.any(elements > 0))
    {
      throw Error("No element is valid, and no objective repairs them: untangle the mesh "
                  "first; if all remain invalid, allow more points to move.");
    }
    if (count == 0)
    {
      continue;
    }
    this->Weights[i].assign(cells, 1.0);
    this->LeftOut.clear();
    for (Index cell = 0; cell < cells; ++cell)
    {
      if (out(cell) && validity[cell] != NonFinite)
      {
        this->LeftOut.push_back(cell);
      }
      this->Weights[i][cell] = out(cell) ? 0.0
        : objective.elementWeights       ? objective.elementWeights[cell]
                                         : 1.0;
    }
    objective.elementWeights = this->Weights[i].data();
  }
}

//------------------------------------------------------------------------------
bool OptimizationProblem::someRepaired()
{
  return this->TheRanks.any(std::any_of(this->LeftOut.begin(), this->LeftOut.end(),
    [&](Index cell) { return cornerValidity(*this->Moving, cell) == Valid; }));
}

//------------------------------------------------------------------------------
/// The largest absolute element value of each objective at the current points if untangling
/// objectives must be rescaled; otherwise empty.
std::vector<double> OptimizationProblem::largestValues() const
{
  const bool untangles = std::any_of(this->Resolved.begin(), this->Resolved.end(),
    [](const Objective& o) { return o.metric == Metric::UntangleBeta; });
  if (!this->Options.rescaleUntangling || this->Resolved.size() < 2 || !untangles)
  {
    return {};
  }
  std::vector<double> result, q(this->Moving->view().numberOfCells);
  for (const Objective& objective : this->Resolved)
  {
    evaluateMetric(*this->Moving, objective.metric, objective.evaluation, q.data());
    double largest = 0;
    for (double value : q)
    {
      largest = std::max(largest, std::abs(value));
    }
    result.push_back(largest);
  }
  return result;
}

//------------------------------------------------------------------------------
/// See OptimizeOptions::rescaleUntangling.
void OptimizationProblem::rescaleUntangling(const std::vector<double>& largest)
{
  // The untangling objectives must exceed the largest element values of the other objectives.
  const auto untangles = [this](std::size_t i)
  { return this->Resolved[i].metric == Metric::UntangleBeta; };
  double others = 0;
  for (std::size_t i = 0; i < largest.size(); ++i)
  {
    others = untangles(i) ? others : std::max(others, largest[i]);
  }
  const Index cells = this->Moving->view().numberOfCells;
  for (std::size_t i = 0; i < largest.size(); ++i)
  {
    Objective& objective = this->Resolved[i];
    const double own = untangles(i) ? largest[i] : 0.0;
    if (!(own > 0) || own > others)
    {
      continue;
    }
    // Slightly more than equal. The weights multiply q^2 or q, depending on the template.
    constexpr double margin = 1.1;
    const double factor = margin * others / own;
    const double weight =
      objective.objectiveTemplate == ObjectiveTemplate::SumOfSquares ? factor * factor : factor;
    std::vector<double> weights(cells, weight);
    for (Index cell = 0; cell < cells && objective.elementWeights; ++cell)
    {
      weights[cell] *= objective.elementWeights[cell];
    }
    this->Weights[i] = std::move(weights);
    objective.elementWeights = this->Weights[i].data();
  }
  const auto weighted = [](const std::vector<double>& w) { return !w.empty(); };
  if (!this->AllFast && std::any_of(this->Weights.begin(), this->Weights.end(), weighted))
  {
    this->Terms.assign(this->Terms.size(), LocalTerm()); // weights of cells differ by objective
  }
}

//------------------------------------------------------------------------------
const ObjectiveSum& OptimizationProblem::sum(std::size_t objective)
{
  if (!this->Sums[objective])
  {
    this->Sums[objective] = std::make_unique<ObjectiveSum>(
      *this->Moving, this->Resolved[objective], this->Options.threads, this->TheRanks);
  }
  return *this->Sums[objective];
}

//------------------------------------------------------------------------------
std::vector<LocalTerm> OptimizationProblem::localTerms()
{
  for (std::size_t i = 0; i < this->Terms.size(); ++i)
  {
    LocalTerm& term = this->Terms[i];
    if (term.shapePower == 0 && term.sizeSquared == 0)
    {
      term.metric = &this->sum(i);
    }
  }
  return this->Terms;
}

//------------------------------------------------------------------------------
LocalOptions OptimizationProblem::localOptions() const
{
  const SimplexMesh& s = *this->Simplices;
  LocalOptions local;
  local.newton = this->Options.optimizer != Optimizer::LocalConjugateGradient;
  local.patchIterations = this->Options.patchIterations;
  local.relaxation = this->Options.relaxation;
  local.culling = this->Options.culling;
  local.allowInversion = this->Options.allowInversion;
  local.threads = this->Options.threads;
  const auto directions = [&](const double* given, std::vector<Vec3>& ofVertex)
  {
    for (std::int32_t v = 0; given && v < s.freeVertices(); ++v)
    {
      const double* n = given + 3 * static_cast<std::size_t>(s.point(v));
      ofVertex.push_back({ n[0], n[1], n[2] });
    }
  };
  // From points to vertices, in the order and the scale of the simplices.
  directions(this->Options.slidePlanes, local.planes);
  directions(this->Options.slideLines, local.lines);
  for (std::int32_t v = 0; this->Surface && v < s.freeVertices(); ++v)
  {
    const std::int32_t part = this->Options.model ? this->Options.parts[s.point(v)] : -1;
    const bool slides = !this->Options.slideSurface || this->Options.slideSurface[s.point(v)];
    const bool loose = !this->Loose.empty() && this->Loose[s.point(v)];
    local.surfaces.push_back(loose ? nullptr
        : this->Options.model      ? (part < 0 ? nullptr : &this->Parts[part])
        : slides                   ? this->Surface.get()
                                   : nullptr);
    if (!this->Loose.empty())
    {
      local.loose.push_back(loose);
    }
  }
  for (SurfaceLimit* limit : { this->Limit.get(), this->BetweenLimit.get() })
  {
    if (limit)
    {
      local.surfaceLimits.push_back(limit);
    }
  }
  if (this->Options.limits)
  {
    // Relative to the input, even if untangling has moved the points since.
    local.start.resize(VertexStride * static_cast<std::size_t>(s.freeVertices()));
    for (std::int32_t v = 0; v < s.freeVertices(); ++v)
    {
      local.limits.push_back(this->limitOf(s.point(v)) / s.scale());
      const Vec3 start = s.transform(pointOf(this->TheMesh.view(), s.point(v)));
      std::copy(start.begin(), start.end(),
        local.start.begin() + VertexStride * static_cast<std::ptrdiff_t>(v));
    }
  }
  if (this->AllFast && !this->Weights[0].empty())
  {
    for (std::int32_t i = 0; i < s.simplices(); ++i)
    {
      local.weights.push_back(this->Weights[0][s.cell(i)]);
    }
    this->Simplices->indexPatches();
  }
  return local;
}

//------------------------------------------------------------------------------
const SweepOrder& OptimizationProblem::order()
{
  if (!this->Order)
  {
    this->Order = std::make_unique<SweepOrder>(*this->Simplices, this->TheRanks);
  }
  return *this->Order;
}

const MatrixRows& OptimizationProblem::rows()
{
  if (!this->Rows)
  {
    std::vector<std::int32_t> points;
    for (std::int32_t v = 0; v < this->Simplices->freeVertices(); ++v)
    {
      points.push_back(this->Simplices->point(v));
    }
    this->Rows =
      std::make_unique<MatrixRows>(points, this->Moving->view().numberOfPoints, this->TheRanks);
  }
  return *this->Rows;
}

//------------------------------------------------------------------------------
Index OptimizationProblem::freePoints() const
{
  Index count = 0;
  for (std::int32_t v = 0; v < this->Simplices->freeVertices(); ++v)
  {
    count += this->TheRanks.owns(this->Simplices->point(v));
  }
  return this->TheRanks.sum(count);
}

//------------------------------------------------------------------------------
void OptimizationProblem::store()
{
  this->Simplices->store(this->Points.data(), this->Options.threads);
  this->TheRanks.exchange(this->Points.data(), 3);
}

//------------------------------------------------------------------------------
void OptimizationProblem::summarizeCells(IterationRecord& record)
{
  const Index cells = this->Moving->view().numberOfCells;
  std::vector<signed char> validity(cells);
  this->Moving->classifyCells(validity.data(), this->Options.threads);
  std::vector<double> q(cells);
  for (std::size_t i = 0; i < this->Resolved.size(); ++i)
  {
    const Objective& objective = this->Resolved[i];
    record.objectives.push_back(this->sum(i).value());
    evaluateMetric(*this->Moving, objective.metric, objective.evaluation, q.data());
    const MetricInfo& info = metricInfo(objective.metric);
    const bool larger = info.direction == Direction::LargerIsBetter;
    std::vector<double> values;
    double worst = -std::numeric_limits<double>::infinity(); // larger is worse
    for (const CellBlock& block : this->Moving->blocks())
    {
      for (Index c = 0; isElement(*this->Moving, block.type) && c < block.count; ++c)
      {
        const Index cell = block.cell(c);
        if (validity[cell] == Valid && this->TheRanks.ownsCell(cell))
        {
          values.push_back(q[cell]);
          worst = std::max(worst, larger ? -q[cell] : q[cell]);
        }
      }
    }
    const Index count = this->TheRanks.sum(static_cast<Index>(values.size()));
    const double total = this->TheRanks.total(values);
    worst = this->TheRanks.maximum(worst);
    record.mean.push_back(count > 0 ? total / static_cast<double>(count) : 0.0);
    record.worst.push_back(count == 0 ? 0.0 : larger ? -worst : worst);
  }
  for (const CellBlock& block : this->Moving->blocks())
  {
    for (Index c = 0; isElement(*this->Moving, block.type) && c < block.count; ++c)
    {
      const Index cell = block.cell(c);
      record.inverted += this->TheRanks.ownsCell(cell) && isInvalid(validity[cell]);
    }
  }
  record.inverted = this->TheRanks.sum(record.inverted);
}

//------------------------------------------------------------------------------
IterationRecord OptimizationProblem::record(int iteration)
{
  IterationRecord record;
  record.iteration = iteration;
  if (this->hasSimplexTotals())
  {
    this->summarizeSimplices(record);
  }
  else
  {
    this->summarizeCells(record);
  }
  record.objective = this->TheScalarizer && record.objectives.size() > 1
    ? this->TheScalarizer->value(record.objectives)
    : record.objectives[0];
  record.seconds = this->Clock.seconds();
  return record;
}

//------------------------------------------------------------------------------
bool OptimizationProblem::hasSimplexTotals() const
{
  // The mean of the mean ratio does not follow from sums of its reciprocal.
  return this->AllFast && !this->TheRanks.several() &&
    std::none_of(this->Resolved.begin(), this->Resolved.end(),
      [](const Objective& o) { return o.metric == Metric::MeanRatio; });
}

//------------------------------------------------------------------------------
IterationRecord OptimizationProblem::firstRecord(int iteration)
{
  if (this->AtStart.objectives.empty() || !this->hasSimplexTotals())
  {
    return this->record(iteration);
  }
  IterationRecord record = this->AtStart;
  record.iteration = iteration;
  record.objective = record.objectives[0];
  record.seconds = this->Clock.seconds();
  return record;
}

//------------------------------------------------------------------------------
bool OptimizationProblem::isSumOfSquaresOf(const Objective& judged) const
{
  return !this->TheRanks.several() && this->isSimple() && this->Terms[0].shapePower == 2 &&
    this->Simplices->uniform() && judged.metric == Metric::InverseMeanRatio &&
    !judged.evaluation.targets && !this->Resolved[0].evaluation.targets;
}

//------------------------------------------------------------------------------
void OptimizationProblem::start(const IterationRecord& first)
{
  std::vector<double> weights;
  for (const Objective& objective : this->Resolved)
  {
    weights.push_back(objective.weight);
  }
  this->TheScalarizer =
    std::make_unique<Scalarizer>(this->Options.scalarization, weights, first.objectives);
}

//------------------------------------------------------------------------------
void OptimizationProblem::restart(const std::vector<double>& points)
{
  this->AtStart = {};
  this->Points = points;
  this->Simplices->load(this->Points.data(), this->Options.threads);
  this->coordinatesChanged();
}

//------------------------------------------------------------------------------
void OptimizationProblem::coordinatesChanged()
{
  for (SurfaceLimit* limit : { this->Limit.get(), this->BetweenLimit.get() })
  {
    if (limit)
    {
      limit->forget();
    }
  }
}

//------------------------------------------------------------------------------
const PointSlides& OptimizationProblem::slides()
{
  if (!this->Slides)
  {
    OptimizeOptions options = this->Options;
    if (this->TheMesh.dimension() == Dimension::Surface)
    {
      // See SurfaceSlides.
      options.model = nullptr;
      options.slideSurface = nullptr;
    }
    this->Slides = std::make_unique<PointSlides>(slidesOf(this->TheMesh, options));
  }
  return *this->Slides;
}

//------------------------------------------------------------------------------
double OptimizationProblem::limitOf(std::size_t point) const
{
  return this->Options.limits ? std::max(0.0, this->Options.limits[point])
                              : std::numeric_limits<double>::infinity();
}

//------------------------------------------------------------------------------
bool OptimizationProblem::someAtLimit()
{
  bool some = false;
  for (std::int32_t v = 0; this->Options.limits && v < this->Simplices->freeVertices(); ++v)
  {
    const auto p = static_cast<std::size_t>(this->Simplices->point(v));
    const double* now = &this->Points[3 * p];
    const double* start = this->start() + 3 * p;
    const double limit = this->limitOf(p);
    some = some ||
      (limit > 0 &&
        std::hypot(now[0] - start[0], now[1] - start[1], now[2] - start[2]) >= insideLimit * limit);
  }
  return this->TheRanks.any(some);
}

//------------------------------------------------------------------------------
bool OptimizationProblem::outOfTime() const
{
  return this->TheRanks.any(this->Clock.reached(this->Options.stopping.maximumSeconds));
}
}
