// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizationProblem.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// How much of the surface tolerance the other elements may use before the worst one is improved:
/// points at the limit are in its way.
constexpr double beforeWorst = 0.3;
/// How much of the surface tolerance is used at the places where distances are measured: places in
/// between may be farther, most of all at points that leave the surface.
constexpr double marginOfSliding = 0.85, marginOfLeaving = 0.7;

/// Cells of the mesh's own dimension: those that are optimized.
bool isElement(const Mesh& mesh, CellType type)
{
  return topology(type).dimension == (mesh.dimension() == Dimension::Volume ? 3 : 2);
}
}

//------------------------------------------------------------------------------
OptimizationProblem::OptimizationProblem(const Mesh& mesh, const OptimizeOptions& options,
  std::vector<double>& points, const Stopwatch& clock, const SimplexFrame* frame)
  : TheMesh(mesh)
  , Part(frame != nullptr)
  , Options(options)
  , Points(points)
  , Clock(clock)
{
  const MeshView& view = mesh.view();
  this->Moving = std::make_unique<Mesh>(mesh.at(points.data()));
  this->Resolved = options.objectives;

  // One set of targets can be built into the simplices; objectives with others take the general
  // way.
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
  this->Simplices =
    std::make_unique<SimplexMesh>(*this->Moving, options.fixed, targets, options.threads, frame);
  this->makeSurface();
  // Objectives that are energies of the simplices are evaluated without the metrics.
  this->Sums.resize(this->Resolved.size());
  this->Weights.resize(this->Resolved.size());
  this->AllFast = true;
  for (const Objective& objective : this->Resolved)
  {
    this->Terms.push_back(this->fastTerm(objective));
    // Simplices carry the objective's targets, or the ideal ones.
    const LocalTerm& term = this->Terms.back();
    this->AllFast = this->AllFast && (term.shapePower > 0 || term.sizeSquared > 0);
    if (objective.evaluation.targets != targets && term.shapePower > 0)
    {
      this->Terms.back() = LocalTerm();
      this->AllFast = false;
    }
  }
  if (this->Moving->nonFinitePoints() > 0 || !this->AllFast)
  {
    // Inverted elements that no objective can repair, and those with NaN, are left out.
    std::vector<signed char> validity(view.numberOfCells);
    this->Moving->classifyCells(validity.data(), options.threads);
    this->leaveOut(validity);
  }
  else
  {
    this->summarizeSimplices(this->AtStart);
    if (this->AtStart.inverted > 0)
    {
      this->AtStart = {};
      std::vector<signed char> validity(view.numberOfCells);
      this->Moving->classifyCells(validity.data(), options.threads);
      this->leaveOut(validity);
    }
  }
  this->rescaleUntangling(this->Part ? std::vector<double>() : this->largestValues());
}

//------------------------------------------------------------------------------
void OptimizationProblem::makeSurface()
{
  const OptimizeOptions& options = this->Options;
  if (options.model)
  {
    for (const SurfacePart& part : options.model->parts)
    {
      this->Parts.emplace_back(part, this->Simplices.get());
    }
  }
  const bool slides = this->TheMesh.dimension() == Dimension::Surface
    ? options.surface.project
    : options.slideSurface != nullptr;
  if (options.model && options.onGeometry)
  {
    this->Surface = std::make_unique<SurfaceProjection>(
      SurfaceProjection::ofFacets(*options.model, this->Simplices.get()));
  }
  else if (options.model || slides)
  {
    this->Surface = std::make_unique<SurfaceProjection>(this->TheMesh, *this->Simplices);
  }
  if (this->Surface && options.surfaceTolerance > 0)
  {
    const double margin = options.leaving ? marginOfLeaving : marginOfSliding;
    this->Limit = std::make_unique<SurfaceLimit>(this->TheMesh, *this->Simplices, *this->Surface,
      margin * options.surfaceTolerance / this->Simplices->scale(), !options.onGeometry);
    this->shareTolerance(options.improveWorst > 0 ? beforeWorst : 1.0);
  }
}

//------------------------------------------------------------------------------
double OptimizationProblem::surfaceError() const
{
  if (!this->Surface)
  {
    return 0.0;
  }
  const int threads = this->Options.threads;
  const int divisions = this->Limit ? SurfaceLimit::divisions : 2;
  const SurfaceProjection now(*this->Moving, *this->Simplices);
  const double there = now.distanceTo(*this->Surface, threads, divisions);
  // A mesh may be of a part of a geometry.
  const double back =
    this->Options.onGeometry ? 0.0 : this->Surface->distanceTo(now, threads, divisions);
  return this->Simplices->scale() * std::max(there, back);
}

//------------------------------------------------------------------------------
void OptimizationProblem::shareTolerance(double share)
{
  if (this->Limit)
  {
    this->Limit->setShare(share);
  }
}

//------------------------------------------------------------------------------
Index OptimizationProblem::heldOnSurface() const
{
  return this->Limit ? this->Limit->held() : 0;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> OptimizationProblem::closedForms() const
{
  std::vector<unsigned char> flags;
  for (const LocalTerm& term : this->Terms)
  {
    flags.push_back(term.shapePower > 0 || term.sizeSquared > 0);
  }
  return flags;
}

//------------------------------------------------------------------------------
void OptimizationProblem::keepClosedForms(const std::vector<unsigned char>& flags)
{
  for (std::size_t i = 0; i < this->Terms.size(); ++i)
  {
    if (!flags[i])
    {
      this->Terms[i] = LocalTerm();
      this->AllFast = false;
    }
  }
}

//------------------------------------------------------------------------------
LocalTerm OptimizationProblem::fastTerm(const Objective& objective) const
{
  LocalTerm term;
  for (const CellBlock& block : this->Moving->blocks())
  {
    if (!isElement(*this->Moving, block.type) || topology(block.type).samples > 1)
    {
      return term; // several corners make one value
    }
  }
  // Weights and tensors belong to cells, which the energies do not distinguish.
  if (this->Moving->blocks().empty() || objective.elementWeights ||
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
    const CellTopology& t = topology(this->Moving->blocks()[0].type);
    const double size = t.sizePerDeterminant / this->Simplices->target(0).det *
      std::pow(this->Simplices->scale(), t.dimension);
    term.sizeSquared = size * size;
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
  // Objectives are functions of the corners: elements that are folded in between take part, and are
  // often unfolded by it.
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
    if (count == 0)
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
    if (elements == 0 && !this->Part)
    {
      throw Error("No element is valid, and no objective repairs them: untangle the mesh first; if "
                  "that leaves all invalid, let more points move.");
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
bool OptimizationProblem::someRepaired() const
{
  return std::any_of(this->LeftOut.begin(), this->LeftOut.end(),
    [&](Index cell) { return cornerValidity(*this->Moving, cell) == Valid; });
}

//------------------------------------------------------------------------------
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
void OptimizationProblem::rescaleUntangling(const std::vector<double>& largest)
{
  // The largest element values of the other objectives are what the untangling ones have to exceed.
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
    // A little more than equal. The weights multiply q^2 or q, whichever the template sums.
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
      *this->Moving, this->Resolved[objective], this->Options.threads, this->Part);
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
  local.surfaceLimit = this->Limit.get();
  if (this->Options.limits)
  {
    // From the input, even where untangling has moved the points since.
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
void OptimizationProblem::store()
{
  this->Simplices->store(this->Points.data(), this->Options.threads);
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
    double total = 0, worst = 0;
    Index count = 0;
    for (const CellBlock& block : this->Moving->blocks())
    {
      for (Index c = 0; isElement(*this->Moving, block.type) && c < block.count; ++c)
      {
        const Index cell = block.cell(c);
        if (validity[cell] == Valid)
        {
          total += q[cell];
          worst = count == 0 ? q[cell]
            : larger         ? std::min(worst, q[cell])
                             : std::max(worst, q[cell]);
          ++count;
        }
      }
    }
    record.mean.push_back(count > 0 ? total / static_cast<double>(count) : 0.0);
    record.worst.push_back(worst);
  }
  for (const CellBlock& block : this->Moving->blocks())
  {
    for (Index c = 0; isElement(*this->Moving, block.type) && c < block.count; ++c)
    {
      const signed char state = validity[block.cell(c)];
      record.inverted += isInvalid(state);
    }
  }
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
  return this->AllFast &&
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
  return this->isSimple() && this->Terms[0].shapePower == 2 && this->Simplices->uniform() &&
    judged.metric == Metric::InverseMeanRatio && !judged.evaluation.targets &&
    !this->Resolved[0].evaluation.targets;
}

//------------------------------------------------------------------------------
double OptimizationProblem::worstMovable(const Objective& judged) const
{
  const MeshView& view = this->Moving->view();
  std::vector<signed char> validity(view.numberOfCells);
  this->Moving->classifyCells(validity.data(), this->Options.threads);
  std::vector<double> q(view.numberOfCells);
  evaluateMetric(*this->Moving, judged.metric, judged.evaluation, q.data());
  // Elements without a free vertex cannot improve.
  std::vector<char> free(view.numberOfPoints, 0);
  for (std::int32_t v = 0; v < this->Simplices->freeVertices(); ++v)
  {
    free[this->Simplices->point(v)] = 1;
  }
  const bool larger = metricInfo(judged.metric).direction == Direction::LargerIsBetter;
  const double infinity = std::numeric_limits<double>::infinity();
  double worst = larger ? infinity : -infinity;
  for (const CellBlock& block : this->Moving->blocks())
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; isElement(*this->Moving, block.type) && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      const bool movable = std::any_of(node, node + nodes, [&](Index p) { return free[p] != 0; });
      if (movable && validity[cell] == Valid)
      {
        worst = larger ? std::min(worst, q[cell]) : std::max(worst, q[cell]);
      }
    }
  }
  return worst;
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
  if (this->Limit)
  {
    this->Limit->forget();
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
bool OptimizationProblem::someAtLimit() const
{
  for (std::int32_t v = 0; this->Options.limits && v < this->Simplices->freeVertices(); ++v)
  {
    const auto p = static_cast<std::size_t>(this->Simplices->point(v));
    const double* now = &this->Points[3 * p];
    const double* start = this->start() + 3 * p;
    const double limit = this->limitOf(p);
    if (limit > 0 &&
      std::hypot(now[0] - start[0], now[1] - start[1], now[2] - start[2]) >= insideLimit * limit)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
bool OptimizationProblem::outOfTime() const
{
  return this->Clock.reached(this->Options.stopping.maximumSeconds);
}
}
