// SPDX-License-Identifier: BSD-3-Clause
#include "ObjectiveSum.h"

#include "ObjectiveSumState.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
Objective resolved(Objective objective, int threads)
{
  if (objective.objectiveTemplate == ObjectiveTemplate::Default)
  {
    objective.objectiveTemplate = defaultTemplate(objective.metric);
  }
  objective.evaluation.threads = threads > 0 ? threads : objective.evaluation.threads;
  return objective;
}

void checkTemplate(const Objective& objective)
{
  using T = ObjectiveTemplate;
  const int number = static_cast<int>(objective.objectiveTemplate);
  if (number < 0 || number > static_cast<int>(T::Maximum))
  {
    throw Error("Unknown objective template number " + std::to_string(number) + ".");
  }
  const std::string problem = templateProblem(objective.metric, objective.objectiveTemplate);
  if (!problem.empty())
  {
    throw Error(problem);
  }
  if (!(objective.weight > 0) || !std::isfinite(objective.weight))
  {
    throw Error("The weight of an objective must be above 0 and finite.");
  }
  if (objective.objectiveTemplate == T::PowerMean &&
    !(objective.power >= 1 && std::isfinite(objective.power)))
  {
    throw Error("The power of a power mean must be at least 1 and finite.");
  }
  if (objective.objectiveTemplate == T::Maximum &&
    !(objective.power > 0 && std::isfinite(objective.power)))
  {
    throw Error("The sharpness of a smooth maximum must be above 0 and finite.");
  }
}

Fault faultOf(const Objective& objective)
{
  const MetricInfo& info = metricInfo(objective.metric);
  using T = ObjectiveTemplate;
  if (info.barrier)
  {
    // If no valid element is close to 0, only the sign indicates inverted elements.
    const bool separated =
      (!info.in2D || info.full2D.low > 0) && (!info.in3D || info.full3D.low > 0);
    return separated && info.inverted == InvertedValue::Negative ? Fault::NotPositive
                                                                 : Fault::Jacobian;
  }
  // Squares hide the sign of a metric: without this check, an inverted element could reduce the
  // sum.
  if (objective.objectiveTemplate == T::SumOfSquaredReciprocals ||
    (objective.objectiveTemplate == T::PowerMean && info.direction == Direction::LargerIsBetter))
  {
    return Fault::NotPositive;
  }
  return objective.objectiveTemplate == T::SumOfReciprocals ? Fault::Zero : Fault::None;
}

/// @param defined whether the metric is defined on any element
[[noreturn]] void throwNoElements(const MetricInfo& info, bool defined)
{
  throw Error(defined ? "The weights of all elements are 0: there is nothing to minimize."
                      : "The metric \"" + std::string(info.label) +
        "\" is not defined on any cell of the mesh. Choose another metric, or convert the cells.");
}
}

//------------------------------------------------------------------------------
void requireElementWeight(Index cell, double weight)
{
  if (!(weight >= 0) || !std::isfinite(weight))
  {
    throw Error("The weight of cell " + std::to_string(cell) + " is " + std::to_string(weight) +
      "; weights must be finite and at least 0.");
  }
}

//------------------------------------------------------------------------------
ObjectiveSumState::ObjectiveSumState(
  const Mesh& mesh, const Objective& given, int threads, const Ranks& ofMesh)
  : objective(resolved(given, threads))
  , elements(mesh, objective.metric, objective.evaluation)
  , ranks(ofMesh)
{
  const MetricInfo& info = metricInfo(this->objective.metric);
  checkTemplate(this->objective);
  if (!this->ranks.any(!this->elements.empty()))
  {
    throwNoElements(info, false);
  }
  const double* weights = this->objective.elementWeights;
  std::vector<double> sums;
  for (const ElementSum::Chunk& chunk : this->elements.chunks())
  {
    const CellBlock& block = mesh.blocks()[chunk.block];
    double sum = 0;
    for (Index i = chunk.begin; i < chunk.end; ++i)
    {
      const Index cell = block.cell(i);
      const double w = weights ? weights[cell] : 1.0;
      requireElementWeight(cell, w);
      // Cells that several ranks have are counted by their owner only.
      sum += this->ranks.ownsCell(cell) ? w : 0.0;
    }
    sums.push_back(sum);
  }
  const double total = this->ranks.total(sums);
  if (!(total > 0))
  {
    throwNoElements(info, true);
  }
  this->function = { this->objective.objectiveTemplate, this->objective.power,
    info.direction == Direction::LargerIsBetter ? -1.0 : 1.0, faultOf(this->objective), weights,
    total };
}

//------------------------------------------------------------------------------
template <bool WithGradient>
double ObjectiveSumState::run(double scale, double* gradient) const
{
  const ElementFunction& f = this->function;
  const bool weighted = f.weights != nullptr;
  return withTemplate(f.objectiveTemplate,
    [&](auto objectiveTemplate)
    {
      constexpr ObjectiveTemplate Template = decltype(objectiveTemplate)::value;
      if constexpr (Template == ObjectiveTemplate::PowerMean ||
        Template == ObjectiveTemplate::Maximum)
      {
        // Scale by the largest term; the gradient needs the value first, so use two passes.
        const double F = f.combine<Template>(this->elements.run<false, ScaledSums>(
          [&f](const BatchContext& context, const Batch& batch, ScaledSums& total, Packet&)
          { f.addScaled<Template>(context, batch, total); },
          nullptr, weighted));
        if (WithGradient && std::isfinite(F))
        {
          this->elements.run<true, LaneSums>([&f, F, scale](const BatchContext& context,
                                               const Batch& batch, LaneSums&, Packet& slope)
            { slope = scale * f.slopeOf<Template>(context, batch, F); },
            gradient, weighted);
        }
        return F;
      }
      else
      {
        const auto totals = this->elements.run<WithGradient, LaneSums>(
          [&f, scale](
            const BatchContext& context, const Batch& batch, LaneSums& total, Packet& slope)
          {
            Packet value;
            f.term<Template>(context, batch, value, slope);
            slope *= scale;
            total.lanes += onlyCells(batch, value);
          },
          gradient, weighted);
        double sum = 0;
        for (const LaneSums& total : totals)
        {
          sum += total.sum();
        }
        // Infinite terms of both signs: an element at fault takes precedence.
        return std::isnan(sum) ? HUGE_VAL : sum;
      }
    });
}

//------------------------------------------------------------------------------
double ObjectiveSumState::runOnRanks(double scale, double* gradient) const
{
  const MeshView& view = this->elements.mesh().view();
  // The terms of single cells and orderless sums make value and gradient independent of the
  // distribution of the cells.
  std::vector<double> terms(view.numberOfCells), own;
  OrderlessSums sums(gradient, gradient ? 3 * view.numberOfPoints : 0);
  this->findTerms(scale, gradient ? &sums : nullptr, terms.data());
  sums.finish();
  const ElementFunction& f = this->function;
  if (f.objectiveTemplate != ObjectiveTemplate::PowerMean)
  {
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      if (this->ranks.ownsCell(cell))
      {
        own.push_back(terms[cell]);
      }
    }
    const double sum = this->ranks.total(own);
    return std::isnan(sum) ? HUGE_VAL : sum;
  }
  // The terms of a power mean are relative to the largest of all ranks, so that powers neither
  // overflow nor underflow.
  double unit = 0;
  const auto weightOf = [&](Index cell) {
    return !this->ranks.ownsCell(cell) ? 0.0 : f.weights ? f.weights[cell] : 1.0;
  };
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    unit = weightOf(cell) > 0 ? std::max(unit, terms[cell]) : unit;
  }
  unit = this->ranks.maximum(unit);
  for (Index cell = 0; cell < view.numberOfCells && unit > 0 && std::isfinite(unit); ++cell)
  {
    const double weight = weightOf(cell);
    own.push_back(weight > 0 ? weight * std::pow(terms[cell] / unit, f.power) : 0.0);
  }
  return std::isfinite(unit) ? unit * std::pow(this->ranks.total(own) / f.totalWeight, 1 / f.power)
                             : unit;
}

//------------------------------------------------------------------------------
/**
 * @brief The terms of a sum, one per cell of the view: 0 if the metric is undefined, +infinity if
 * an element is at fault.
 * @param gradient null, or as in ObjectiveSum::addGradient()
 */
void ObjectiveSumState::findTerms(double scale, OrderlessSums* gradient, double* terms) const
{
  std::fill_n(terms, this->elements.mesh().view().numberOfCells, 0.0);
  const ElementFunction& f = this->function;
  // Called through a pointer: one body for all templates.
  using Term = void (ElementFunction::*)(const BatchContext&, const Batch&, Packet&, Packet&) const;
  const Term term = withTemplate(f.objectiveTemplate,
    [](auto objectiveTemplate) -> Term
    {
      constexpr ObjectiveTemplate Template = decltype(objectiveTemplate)::value;
      if constexpr (Template == ObjectiveTemplate::Maximum)
      {
        throw Error("A maximum has no terms of single elements.");
      }
      else if constexpr (Template == ObjectiveTemplate::PowerMean)
      {
        return &ElementFunction::exponent<Template>; // without its weight
      }
      else
      {
        return &ElementFunction::term<Template>;
      }
    });
  const std::unique_ptr<ElementTable> table = this->elements.tabulated(gradient != nullptr);
  this->elements.forEachChunk(
    [&](Index i)
    {
      const ElementSum::Chunk& chunk = this->elements.chunks()[i];
      const BatchEvaluator evaluate = this->elements.evaluator(chunk, gradient != nullptr);
      BatchContext context = this->elements.context(chunk);
      context.table = table.get();
      withNodes(*context.topology,
        [&](auto nodesOfCell)
        {
          constexpr int Nodes = decltype(nodesOfCell)::value;
          Batch batch;
          BatchNodes nodes;
          for (Index begin = chunk.begin; begin < chunk.end; begin += PacketWidth)
          {
            const int count = static_cast<int>(std::min<Index>(PacketWidth, chunk.end - begin));
            gather<Nodes>(context, this->elements.order(chunk), begin, count, batch, nodes);
            evaluate(context, batch);
            replaceNonFinite(context, batch);
            Packet value, slope;
            (f.*term)(context, batch, value, slope);
            for (int l = 0; l < count; ++l)
            {
              terms[batch.cells[l]] = value[l];
            }
            if (gradient)
            {
              scatter<Nodes>(context, batch, slope * scale,
                [&](const VectorLanes& lanes, int l, int k)
                {
                  double g[3];
                  lanes.storeTo(g, l);
                  for (int c = 0; c < 3; ++c)
                  {
                    gradient->add(3 * static_cast<std::size_t>(nodes[l][k]) + c, g[c]);
                  }
                });
            }
          }
        });
    });
}

//------------------------------------------------------------------------------
ObjectiveSum::ObjectiveSum(
  const Mesh& mesh, const Objective& objective, int threads, const Ranks& ranks)
  : Impl(std::make_unique<ObjectiveSumState>(mesh, objective, threads, ranks))
{
}

ObjectiveSum::~ObjectiveSum() = default;
ObjectiveSum::ObjectiveSum(ObjectiveSum&&) noexcept = default;
ObjectiveSum& ObjectiveSum::operator=(ObjectiveSum&&) noexcept = default;

double ObjectiveSum::value() const
{
  return this->Impl->ranks.several() ? this->Impl->runOnRanks(1.0, nullptr)
                                     : this->Impl->run<false>(1.0, nullptr);
}

double ObjectiveSum::addGradient(double scale, double* gradient) const
{
  return scale == 0               ? this->value()
    : this->Impl->ranks.several() ? this->Impl->runOnRanks(scale, gradient)
                                  : this->Impl->run<true>(scale, gradient);
}

void ObjectiveSum::elementValues(double* values) const
{
  evaluateMetric(this->Impl->elements.mesh(), this->Impl->objective.metric,
    this->Impl->objective.evaluation, values);
}

const Objective& ObjectiveSum::objective() const
{
  return this->Impl->objective;
}
}
