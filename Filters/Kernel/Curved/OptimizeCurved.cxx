// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizeCurved.h"

#include "CurvedNewton.h"
#include "CurvedProblem.h"
#include "UntangleCurved.h"
#include "tautline/Core/Stopwatch.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace tautline
{
namespace
{
constexpr int IterationsOfHolding = 8; ///< after which points that were held move again
constexpr double WeightReduction = 0.1;
constexpr int Reductions = 3; ///< of the weights of added samples before they are dropped

/// W^-1 times the ideal W, and M^(1/2), for the elements of an objective.
template <int Dim>
class CurvedTargets
{
public:
  /// @param reference for a planar mesh, in its frame
  CurvedTargets(const Mesh& mesh, const CurvedObjective& objective, std::vector<double> reference,
    const CurvedRegion& region)
    : TheMesh(mesh)
    , Chosen(objective)
    , Reference(std::move(reference))
    , Region(region)
  {
    if (objective.target != TargetType::Ideal && !objective.data)
    {
      throw Error(
        "The target of an objective has no data: provide sizes, tensors or reference points.");
    }
  }

  void apply(SampleItem& item) const
  {
    const CurvedElement& element = this->Region.elements[item.element];
    if (this->Chosen.target == TargetType::Size)
    {
      const double size = this->Chosen.data[element.cell];
      this->require(size > 0 && std::isfinite(size), element.cell, "its size is not positive");
      const double ideal =
        topology(cornerType(this->TheMesh.view().cellTypes[element.cell])).sizePerDeterminant;
      // The length scale of the target is the root of its determinant relative to the ideal
      // element.
      const double determinant = size / ideal;
      item.perSize = 1 / (Dim == 2 ? std::sqrt(determinant) : std::cbrt(determinant));
    }
    else if (this->Chosen.target == TargetType::Tensor)
    {
      this->applyTensor(item, this->Chosen.data + 9 * element.cell, element.cell);
    }
    else if (this->Chosen.target == TargetType::Reference)
    {
      this->applyReference(item, element);
    }
  }

private:
  void require(bool good, Index cell, const char* why) const
  {
    if (!good)
    {
      throw Error("Cell " + std::to_string(cell) + " has no target: " + why + ".");
    }
  }

  void applyTensor(SampleItem& item, const double* tensor, Index cell) const
  {
    Eigen::Matrix<double, Dim, Dim> m;
    // In a planar mesh, the tensor is expressed in the frame of the plane.
    for (int i = 0; i < Dim; ++i)
    {
      for (int j = 0; j < Dim; ++j)
      {
        m(i, j) = 0;
        for (int r = 0; r < 3; ++r)
        {
          for (int c = 0; c < 3; ++c)
          {
            const auto axis = [&](int k, int of)
            { return Dim == 2 ? this->TheMesh.frame()[k][of] : static_cast<double>(k == of); };
            m(i, j) += axis(i, r) * tensor[3 * r + c] * axis(j, c);
          }
        }
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> solver(m);
    this->require(m.allFinite() && solver.eigenvalues().minCoeff() > 0, cell,
      "its tensor is not positive definite");
    // With T = M^(1/2) A W^-1, the best element is ideal if lengths are measured in the metric M.
    const Eigen::Matrix<double, Dim, Dim> root = solver.operatorSqrt();
    item.rooted = true;
    for (int i = 0; i < Dim; ++i)
    {
      for (int j = 0; j < Dim; ++j)
      {
        item.root[i][j] = root(i, j);
      }
    }
  }

  /// T = A (A_reference)^-1 = (A W^-1) (A_reference W^-1)^-1, with the ideal element W.
  void applyReference(SampleItem& item, const CurvedElement& element) const
  {
    const SampleTable& table = *item.table;
    for (int p = 0; p < table.packets(); ++p)
    {
      const Packet* g = table.gradients(p);
      std::array<Eigen::Matrix<double, Dim, Dim>, PacketWidth> inverse;
      for (int l = 0; l < PacketWidth; ++l)
      {
        Eigen::Matrix<double, Dim, Dim> t = Eigen::Matrix<double, Dim, Dim>::Zero();
        for (int n = 0; n < table.nodes(); ++n)
        {
          const Index point = this->Region.points[element.nodes[n]];
          for (int r = 0; r < Dim; ++r)
          {
            for (int c = 0; c < Dim; ++c)
            {
              t(r, c) += this->Reference[3 * point + r] * g[n * Dim + c][l];
            }
          }
        }
        this->require(t.determinant() > 0, element.cell,
          "the element of the reference mesh is "
          "not valid");
        inverse[l] = t.inverse();
      }
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim; ++c)
        {
          Packet entry;
          for (int l = 0; l < PacketWidth; ++l)
          {
            entry[l] = inverse[l](r, c);
          }
          item.targets.push_back(entry);
        }
      }
    }
  }

  const Mesh& TheMesh;
  const CurvedObjective& Chosen;
  std::vector<double> Reference;
  const CurvedRegion& Region;
};

class CurvedOptimization
{
public:
  CurvedOptimization(const Mesh& mesh, const CurvedOptimizeOptions& options)
    : TheMesh(mesh)
    , Options(options)
    , Problem(mesh, options)
  {
  }

  CurvedOptimizeResult run();
  CurvedObjectiveValue evaluate(const double* direction)
  {
    return this->Problem.dimension() == 2 ? this->evaluate<2>(direction)
                                          : this->evaluate<3>(direction);
  }

private:
  template <int Dim>
  class Descent;
  template <int Dim>
  CurvedObjectiveValue evaluate(const double* direction);

  template <int Dim>
  void optimize();
  template <int Dim>
  CurvedSum<Dim> makeSum(const CurvedRegion& region, const std::set<Index>& leftOut);
  template <int Dim>
  void applyTargets(
    const CurvedObjective& chosen, const CurvedRegion& region, std::vector<SampleItem>& items);
  template <int Dim>
  bool proceed(CurvedSum<Dim>& sum, const CurvedRegion& region, const std::vector<double>& x,
    double gradientNorm);
  template <int Dim>
  void addPlaces(
    CurvedSum<Dim>& sum, const CurvedRegion& region, const std::vector<WeakPlace>& places);

  const Mesh& TheMesh;
  const CurvedOptimizeOptions& Options;
  CurvedProblem Problem;
  Stopwatch Clock;
  CurvedOptimizeResult Result;
  std::vector<WeakPlace> Invalid; ///< excluded elements of the mesh
  std::size_t Items = 0;          ///< items of the quadrature
  std::unique_ptr<Scalarizer> TheScalarizer;
};

//------------------------------------------------------------------------------
template <int Dim>
CurvedSum<Dim> CurvedOptimization::makeSum(
  const CurvedRegion& region, const std::set<Index>& leftOut)
{
  std::map<std::pair<const ElementType*, bool>, std::shared_ptr<const SampleTable>> tables;
  std::vector<SampleItem> items;
  for (std::size_t e = 0; e < region.elements.size(); ++e)
  {
    const CurvedElement& element = region.elements[e];
    // Elements of the same type share a table of samples.
    auto& table = tables[{ element.type, element.mirrored }];
    if (!table)
    {
      table = std::make_shared<const SampleTable>(
        *element.type, element.mirrored, quadrature(*element.type));
    }
    SampleItem item;
    item.element = static_cast<Index>(e);
    item.table = table;
    // Excluded elements have items of weight 0, so that items and elements have the same numbers.
    item.weight = leftOut.count(item.element) > 0 ? 0 : 1;
    items.push_back(item);
  }
  this->Items = items.size();
  std::vector<CurvedTerm<Dim>> terms;
  for (const CurvedObjective& chosen : this->Options.objectives)
  {
    CurvedTerm<Dim> term;
    term.function = sampleFunction<Dim>(chosen.objective);
    term.energy.reset(new CurvedEnergy<Dim>(
      region.elements, static_cast<Index>(region.points.size()), this->Options.threads));
    std::vector<SampleItem> own = items;
    term.totalWeight = 0;
    for (SampleItem& item : own)
    {
      if (chosen.objective.elementWeights)
      {
        item.weight *= chosen.objective.elementWeights[region.elements[item.element].cell];
      }
      term.totalWeight += item.weight;
    }
    term.power = chosen.objective.objectiveTemplate == ObjectiveTemplate::PowerMean
      ? chosen.objective.power
      : 0;
    this->applyTargets<Dim>(chosen, region, own);
    term.energy->setItems(std::move(own));
    terms.push_back(std::move(term));
  }
  CurvedScalarization scalarize;
  if (terms.size() > 1)
  {
    scalarize = [this](const std::vector<double>& values, std::vector<double>* slopes)
    {
      return slopes ? this->TheScalarizer->value(values, *slopes)
                    : this->TheScalarizer->value(values);
    };
  }
  return CurvedSum<Dim>(std::move(terms), scalarize);
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedOptimization::applyTargets(
  const CurvedObjective& chosen, const CurvedRegion& region, std::vector<SampleItem>& items)
{
  if (chosen.target == TargetType::Ideal)
  {
    return;
  }
  std::vector<double> reference;
  if (chosen.target == TargetType::Reference && chosen.data)
  {
    reference = this->Problem.inFrame(chosen.data);
  }
  const CurvedTargets<Dim> targets(this->TheMesh, chosen, std::move(reference), region);
  for (SampleItem& item : items)
  {
    targets.apply(item);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedOptimization::addPlaces(
  CurvedSum<Dim>& sum, const CurvedRegion& region, const std::vector<WeakPlace>& places)
{
  if (places.empty())
  {
    return;
  }
  for (std::size_t k = 0; k < sum.terms().size(); ++k)
  {
    CurvedEnergy<Dim>& energy = *sum.terms()[k].energy;
    std::vector<SampleItem> added;
    for (const WeakPlace& place : places)
    {
      const CurvedElement& element = region.elements[place.element];
      SampleItem item;
      item.element = place.element;
      // The first items belong to the elements, in the same order.
      item.weight = energy.items()[place.element].weight;
      item.table = std::make_shared<const SampleTable>(*element.type, element.mirrored,
        std::vector<SamplePlace>{ { place.at, CurvedGuard::PlaceShare } });
      added.push_back(item);
    }
    this->applyTargets<Dim>(this->Options.objectives[k], region, added);
    energy.addItems(added);
  }
  this->Result.addedSamples += static_cast<Index>(places.size());
}

//------------------------------------------------------------------------------
/// Adds the record of x, where the sum was linearized. @return false to stop
template <int Dim>
bool CurvedOptimization::proceed(CurvedSum<Dim>& sum, const CurvedRegion& region,
  const std::vector<double>& x, double gradientNorm)
{
  IterationRecord record;
  record.iteration = static_cast<int>(this->Result.history.size());
  record.seconds = this->Clock.seconds();
  record.objectives = sum.values(this->Items);
  record.objective = sum.combined(record.objectives);
  record.gradientNorm = gradientNorm;
  record.inverted = static_cast<Index>(this->Invalid.size());
  record.moving = region.free;
  for (std::size_t k = 0; k < this->Options.objectives.size(); ++k)
  {
    // The history reports the metric itself, without the function of the objective.
    Objective own = this->Options.objectives[k].objective;
    own.objectiveTemplate = ObjectiveTemplate::Sum;
    const bool larger = metricInfo(own.metric).direction == Direction::LargerIsBetter;
    // The sign of a metric with better larger values is changed, so that its worst value is the
    // largest.
    const SampleRange range =
      sum.terms()[k].energy->range(*sampleFunction<Dim>(own), x, this->Items);
    record.mean.push_back(larger ? -range.mean : range.mean);
    record.worst.push_back(larger ? -range.largest : range.largest);
  }
  this->Result.history.push_back(record);
  const StoppingCriteria& stopping = this->Options.stopping;
  const auto write = [&](double* to)
  {
    std::vector<double> all = this->Problem.x();
    for (std::size_t p = 0; p < region.points.size(); ++p)
    {
      std::copy_n(x.begin() + 3 * p, 3, all.begin() + 3 * region.points[p]);
    }
    const std::vector<double> points = this->Problem.points(all);
    std::copy(points.begin(), points.end(), to);
  };
  double progress =
    static_cast<double>(this->Result.iterations) / std::max(stopping.maximumIterations, 1);
  if (stopping.maximumSeconds > 0)
  {
    progress = std::max(progress, record.seconds / stopping.maximumSeconds);
  }
  const IterationState state = { record, std::min(progress, 1.0), write };
  if (this->Options.observer && !this->Options.observer(state))
  {
    this->Result.reason = StopReason::Aborted;
    return false;
  }
  if (this->Clock.reached(stopping.maximumSeconds))
  {
    this->Result.reason = StopReason::TimeLimit;
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
/// The iterations on one region.
template <int Dim>
class CurvedOptimization::Descent
{
public:
  Descent(CurvedOptimization& owner, CurvedRegion& region)
    : Owner(owner)
    , Region(region)
    , Guard(region.elements, Dim, owner.Options.threads)
    , LeftOut(invalidOf(this->Guard, region.x))
    , Sum(owner.makeSum<Dim>(region, this->LeftOut))
    , Newton(this->Sum, *region.slides, owner.Options.threads)
    , X(region.x)
    , Best(region.x)
  {
    this->Limits.iterations = MostInnerIterations;
  }

  void run();
  const std::vector<double>& best() const { return this->Best; }

private:
  static constexpr int MostInnerIterations = 300, MostRefusals = 12;
  static constexpr double LargestResidual = 0.3, ShortestStep = 1e-6;

  enum class Outcome
  {
    Accepted,
    Refused,
    OtherDirection
  };

  static std::set<Index> invalidOf(const CurvedGuard& guard, const std::vector<double>& x)
  {
    std::set<Index> elements;
    for (const WeakPlace& place : guard.invalid(x))
    {
      elements.insert(place.element);
    }
    return elements;
  }

  std::vector<WeakPlace> notRepresented(const std::vector<double>& x, std::vector<double>& lower);
  void prepareScalarization();
  bool record();
  bool isConverged();
  bool continuesAfter();
  Outcome step();

  CurvedOptimization& Owner;
  CurvedRegion& Region;
  CurvedGuard Guard;
  std::set<Index> LeftOut;
  CurvedSum<Dim> Sum;
  CurvedNewton<Dim> Newton;
  NewtonLimits Limits;
  std::vector<double> X, Trial, Best;
  std::vector<double> Least; ///< lower bounds of the determinants of the elements at X
  double Objective = 0, FirstObjective = 0, BestObjective = HUGE_VAL, FirstNorm = -1;
  int Refusals = 0, Reduced = 0;
  bool ReleasedAtEnd = false;
};

//------------------------------------------------------------------------------
/// Covers the elements that are not excluded.
template <int Dim>
std::vector<WeakPlace> CurvedOptimization::Descent<Dim>::notRepresented(
  const std::vector<double>& x, std::vector<double>& lower)
{
  std::vector<WeakPlace> places =
    this->Guard.notRepresented(x, this->Sum.terms()[0].energy->leastJacobians(x), &lower);
  places.erase(std::remove_if(places.begin(), places.end(),
                 [this](const WeakPlace& place) { return this->LeftOut.count(place.element) > 0; }),
    places.end());
  return places;
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedOptimization::Descent<Dim>::prepareScalarization()
{
  if (this->Sum.terms().size() < 2)
  {
    return;
  }
  std::vector<double> weights, initial;
  for (std::size_t k = 0; k < this->Sum.terms().size(); ++k)
  {
    CurvedTerm<Dim>& term = this->Sum.terms()[k];
    weights.push_back(this->Owner.Options.objectives[k].objective.weight);
    initial.push_back(term.outer(term.energy->value(*term.function, this->X)));
  }
  this->Owner.TheScalarizer.reset(
    new Scalarizer(this->Owner.Options.scalarization, weights, initial));
}

//------------------------------------------------------------------------------
/// Called after a step. @return false if the work is to end
template <int Dim>
bool CurvedOptimization::Descent<Dim>::record()
{
  if (this->FirstNorm < 0)
  {
    this->FirstNorm = this->Newton.gradientNorm();
    this->FirstObjective = this->Objective;
  }
  // Added samples are not part of the objective, which may increase because of them.
  if (this->Objective < this->BestObjective)
  {
    this->Best = this->X;
    this->BestObjective = this->Objective;
  }
  // Inexact Newton method: with the root of the gradient reduction as the tolerance, convergence is
  // superlinear (Nocedal and Wright, "Numerical Optimization", Section 7.1).
  const double reached =
    this->Newton.gradientNorm() / std::max(this->FirstNorm, std::numeric_limits<double>::min());
  this->Limits.relativeResidual = std::min(LargestResidual, std::sqrt(reached));
  return this->Owner.proceed(this->Sum, this->Region, this->X, this->Newton.gradientNorm());
}

//------------------------------------------------------------------------------
/// Whether a stopping criterion is met; sets the reason.
template <int Dim>
bool CurvedOptimization::Descent<Dim>::isConverged()
{
  const StoppingCriteria& stopping = this->Owner.Options.stopping;
  CurvedOptimizeResult& result = this->Owner.Result;
  if (result.iterations >= stopping.maximumIterations)
  {
    result.reason = StopReason::IterationLimit;
    return true;
  }
  if (std::isfinite(stopping.bestKnown) && stopping.reduction < 1 &&
    this->FirstObjective - this->Objective >=
      stopping.reduction * (this->FirstObjective - stopping.bestKnown))
  {
    result.reason = StopReason::Reduction;
    return true;
  }
  const bool small = this->Newton.gradientNorm() <= stopping.gradientNorm * this->FirstNorm;
  // Half of the slope is the decrease that the quadratic model predicts.
  const bool slow =
    -0.5 * this->Newton.slope() <= stopping.relativeChange * std::abs(this->Objective);
  if (!small && !slow && this->Newton.slope() < 0)
  {
    return false;
  }
  result.reason = small ? StopReason::GradientNorm : StopReason::RelativeChange;
  return !this->continuesAfter();
}

//------------------------------------------------------------------------------
/// Whether to continue at a minimum of the function: held points are released, and the weights of
/// added samples are reduced.
template <int Dim>
bool CurvedOptimization::Descent<Dim>::continuesAfter()
{
  if (this->Region.slides->held() > 0 && !this->ReleasedAtEnd)
  {
    this->Region.slides->release();
    this->ReleasedAtEnd = true;
    return true;
  }
  if (this->Owner.Result.addedSamples > 0 && this->Reduced < Reductions)
  {
    for (CurvedTerm<Dim>& term : this->Sum.terms())
    {
      term.energy->scaleWeights(this->Owner.Items, WeightReduction);
    }
    ++this->Reduced;
    return true;
  }
  return false;
}

//------------------------------------------------------------------------------
template <int Dim>
typename CurvedOptimization::template Descent<Dim>::Outcome CurvedOptimization::Descent<Dim>::step()
{
  double length = 1;
  const Index held = this->Region.slides->held();
  std::vector<double> lower;
  for (; length >= ShortestStep; length *= 0.5)
  {
    const double value = this->Newton.search(this->X, length, this->Trial);
    if (!(value < this->Newton.energy()))
    {
      break;
    }
    const std::vector<WeakPlace> places = this->notRepresented(this->Trial, lower);
    // An element whose smallest determinant has not decreased needs no added sample.
    const auto isWorse = [&](const WeakPlace& place)
    {
      const double now = lower[place.element];
      return !(now > 0) || now < this->Least[place.element];
    };
    if (std::none_of(places.begin(), places.end(), isWorse))
    {
      this->X.swap(this->Trial);
      this->Region.slides->accept();
      this->Least = std::move(lower);
      this->Owner.addPlaces(this->Sum, this->Region, places);
      return Outcome::Accepted;
    }
    // Add samples where the step fails and compute another direction; after too many attempts, only
    // shorten the step.
    if (this->Refusals < MostRefusals)
    {
      this->Owner.addPlaces(this->Sum, this->Region, places);
      break;
    }
  }
  // Points that are newly held change the permitted directions, which is not a failure of the step.
  return this->Region.slides->held() > held ? Outcome::OtherDirection : Outcome::Refused;
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedOptimization::Descent<Dim>::run()
{
  CurvedOptimizeResult& result = this->Owner.Result;
  this->prepareScalarization();
  if (this->Region.free == 0)
  {
    result.reason = StopReason::NoFreeVertices;
    return;
  }
  // Locations in the input mesh with smaller determinants than at the samples become samples from
  // the start.
  this->Owner.addPlaces(this->Sum, this->Region, this->notRepresented(this->X, this->Least));
  bool moved = true;
  for (;;)
  {
    this->Newton.linearize(this->X, this->Limits);
    this->Objective = this->Sum.combined(this->Sum.values(this->Owner.Items));
    if (moved && !this->record())
    {
      return;
    }
    moved = false;
    const int reduced = this->Reduced;
    const Index held = this->Region.slides->held();
    if (this->isConverged())
    {
      return;
    }
    if (this->Reduced > reduced || this->Region.slides->held() < held)
    {
      continue; // another function
    }
    const Outcome outcome = this->step();
    if (outcome == Outcome::Accepted)
    {
      moved = true;
      this->Refusals = 0;
      if (++result.iterations % IterationsOfHolding == 0)
      {
        this->Region.slides->release();
      }
    }
    else if (outcome == Outcome::Refused && ++this->Refusals > MostRefusals)
    {
      result.reason = StopReason::NoProgress;
      return;
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedOptimization::optimize()
{
  CurvedRegion region = this->Problem.region({}, -1);
  this->Result.freePoints = region.free;
  Descent<Dim> descent(*this, region);
  descent.run();
  this->Problem.take(region, descent.best());
}

//------------------------------------------------------------------------------
template <int Dim>
CurvedObjectiveValue CurvedOptimization::evaluate(const double* direction)
{
  const CurvedRegion region = this->Problem.region({}, -1);
  CurvedSum<Dim> sum = this->makeSum<Dim>(region, {});
  const auto size = this->Problem.x().size();
  std::vector<double> gradient, product;
  std::vector<PointBlock> diagonal;
  CurvedObjectiveValue result;
  result.value = sum.linearize(region.x, gradient, diagonal);
  result.gradient.assign(size, 0.0);
  result.product.assign(size, 0.0);
  if (direction)
  {
    std::vector<double> own;
    for (const Index p : region.points)
    {
      own.insert(own.end(), direction + 3 * p, direction + 3 * p + 3);
    }
    sum.apply(own, product);
  }
  for (std::size_t p = 0; p < region.points.size(); ++p)
  {
    for (int c = 0; c < 3; ++c)
    {
      const auto to = static_cast<std::size_t>(3 * region.points[p] + c);
      result.gradient[to] = gradient[3 * p + c];
      result.product[to] = direction ? product[3 * p + c] : 0;
    }
  }
  return result;
}

//------------------------------------------------------------------------------
CurvedOptimizeResult CurvedOptimization::run()
{
  if (this->Options.objectives.empty())
  {
    throw Error("There is no objective: specify at least one.");
  }
  const CurvedGuard& guard = this->Problem.guard();
  const std::vector<WeakPlace> first = guard.invalid(this->Problem.x());
  this->Result.invalidBefore = static_cast<Index>(first.size());
  // In the region, boundary points are already on their surface, which may change the validity.
  CurvedRegion all = this->Problem.region({}, -1);
  this->Invalid = guard.invalid(all.x);
  StopReason before = StopReason::AllValid;
  if (!this->Invalid.empty() && this->Options.untangleFirst)
  {
    CurvedOptions untangling = this->Options;
    untangling.maximumSeconds = this->Options.stopping.maximumSeconds;
    CurvedUntangleResult found = untangleCurved(this->Problem, untangling);
    this->Result.untangled = true;
    this->Result.history = std::move(found.history);
    // The records of untangling have no objectives; zeros keep the number of columns constant.
    for (IterationRecord& record : this->Result.history)
    {
      const std::size_t count = this->Options.objectives.size();
      record.objectives.assign(count, 0);
      record.mean.assign(count, 0);
      record.worst.assign(count, 0);
    }
    before = found.reason;
    this->Invalid = guard.invalid(this->Problem.x());
  }
  if (before == StopReason::Aborted || before == StopReason::TimeLimit)
  {
    this->Result.reason = before;
  }
  else if (this->Problem.dimension() == 2)
  {
    this->optimize<2>();
  }
  else
  {
    this->optimize<3>();
  }
  std::vector<Index> elements;
  for (const WeakPlace& place : first)
  {
    elements.push_back(place.element);
  }
  for (const WeakPlace& place : guard.invalid(this->Problem.x()))
  {
    ++this->Result.invalidAfter;
    this->Result.newlyInvalid +=
      !std::binary_search(elements.begin(), elements.end(), place.element);
    this->Result.remaining.push_back(this->Problem.elements()[place.element].cell);
  }
  this->Result.points = this->Problem.points();
  return std::move(this->Result);
}
}

//------------------------------------------------------------------------------
CurvedOptimizeResult optimizeCurved(const Mesh& mesh, const CurvedOptimizeOptions& options)
{
  return CurvedOptimization(mesh, options).run();
}

//------------------------------------------------------------------------------
CurvedObjectiveValue evaluateCurvedObjective(const Mesh& mesh, const CurvedCellFacts& facts,
  const CurvedObjective& objective, const double* direction)
{
  CurvedOptimizeOptions options;
  options.facts = facts;
  options.objectives = { objective };
  options.boundary = BoundaryMotion::Free;
  return CurvedOptimization(mesh, options).evaluate(direction);
}
}
