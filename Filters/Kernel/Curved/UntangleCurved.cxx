// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleCurved.h"

#include "CurvedNewton.h"
#include "CurvedProblem.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <map>

namespace tautline
{
namespace
{
constexpr double RuleShare = 0.7, NodeShare = 0.3; ///< of the weight of an element
/// number of steps in which an element was invalid
constexpr int DenseAfter = 4;

/// The samples of the quadrature and the nodes.
std::shared_ptr<const SampleTable> tableOf(const CurvedElement& element)
{
  std::vector<SamplePlace> places = quadrature(*element.type);
  for (SamplePlace& place : places)
  {
    place.weight *= RuleShare;
  }
  // Quadrature points are inside the element: the nodes sample its boundary.
  const std::vector<Vec3>& nodes = element.type->coordinates();
  for (const Vec3& node : nodes)
  {
    places.push_back({ node, NodeShare / static_cast<double>(nodes.size()) });
  }
  return std::make_shared<const SampleTable>(*element.type, element.mirrored, places);
}

const ElementType& linearType(ElementShape shape)
{
  static const std::map<ElementShape, CellType> types = { { ElementShape::Triangle,
                                                            CellType::Triangle },
    { ElementShape::Quadrilateral, CellType::Quadrilateral },
    { ElementShape::Tetrahedron, CellType::Tetrahedron },
    { ElementShape::Hexahedron, CellType::Hexahedron }, { ElementShape::Wedge, CellType::Wedge },
    { ElementShape::Pyramid, CellType::Pyramid } };
  const CellTopology& corners = topology(types.at(shape));
  return ElementType::ofVtk(static_cast<int>(corners.type), corners.nodes);
}

/// The result of an attempt.
struct Attempt
{
  std::vector<double> x;
  std::vector<WeakPlace> weak; ///< in elements of the region
  bool stopped = false;
};

class CurvedUntangling
{
public:
  CurvedUntangling(CurvedProblem& problem, const CurvedOptions& options)
    : Problem(problem)
    , Options(options)
  {
  }

  CurvedUntangleResult run();

private:
  template <int Dim>
  Attempt untangle(CurvedRegion& region);
  template <int Dim>
  std::vector<SampleItem> itemsOf(const CurvedRegion& region);
  Index straighten(const std::vector<WeakPlace>& weak);
  bool proceed(double energy, Index invalid, Index moving, const CurvedRegion* region,
    const std::vector<double>* x);

  CurvedProblem& Problem;
  const CurvedOptions& Options;
  Stopwatch Clock;
  CurvedUntangleResult Result;
  StopReason Stopped = StopReason::NoProgress;
  std::map<std::pair<const ElementType*, bool>, std::shared_ptr<const SampleTable>> Tables;
};

//------------------------------------------------------------------------------
/// Adds a record and reports it. @return false to stop
bool CurvedUntangling::proceed(double energy, Index invalid, Index moving,
  const CurvedRegion* region, const std::vector<double>* x)
{
  IterationRecord record;
  record.iteration = static_cast<int>(this->Result.history.size());
  record.seconds = this->Clock.seconds();
  record.objective = energy;
  record.inverted = invalid;
  record.moving = moving;
  this->Result.history.push_back(record);
  if (this->Clock.reached(this->Options.maximumSeconds))
  {
    this->Stopped = StopReason::TimeLimit;
    return false;
  }
  const auto write = [&](double* to)
  {
    std::vector<double> all = this->Problem.x();
    for (std::size_t p = 0; region && p < region->points.size(); ++p)
    {
      std::copy_n(x->begin() + 3 * p, 3, all.begin() + 3 * region->points[p]);
    }
    const std::vector<double> points = this->Problem.points(all);
    std::copy(points.begin(), points.end(), to);
  };
  const double limit = this->Options.maximumSeconds;
  const IterationState state = { record, limit > 0 ? record.seconds / limit : 0, write };
  if (this->Options.observer && !this->Options.observer(state))
  {
    this->Stopped = StopReason::Aborted;
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
/// The samples of the elements; each T is scaled to the size of its element.
template <int Dim>
std::vector<SampleItem> CurvedUntangling::itemsOf(const CurvedRegion& region)
{
  std::vector<SampleItem> items;
  for (std::size_t e = 0; e < region.elements.size(); ++e)
  {
    const CurvedElement& element = region.elements[e];
    auto& table = this->Tables[{ element.type, element.mirrored }];
    if (!table)
    {
      table = tableOf(element);
    }
    SampleItem item;
    item.element = static_cast<Index>(e);
    item.table = table;
    items.push_back(item);
  }
  CurvedEnergy<Dim> energy(
    region.elements, static_cast<Index>(region.points.size()), this->Options.threads);
  energy.setItems(items);
  const std::vector<double> squares = energy.meanNorms(region.x);
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    // With this factor |T|^2 / n is 1 on average, so that elements of all sizes have the same
    // weight.
    items[i].perSize = squares[i] > 0 ? 1 / std::sqrt(squares[i] / Dim) : 1;
  }
  return items;
}

//------------------------------------------------------------------------------
template <int Dim>
Attempt CurvedUntangling::untangle(CurvedRegion& region)
{
  const auto function = std::make_shared<UntanglingFunction<Dim>>();
  std::vector<CurvedTerm<Dim>> terms(1);
  terms[0].energy.reset(new CurvedEnergy<Dim>(
    region.elements, static_cast<Index>(region.points.size()), this->Options.threads));
  terms[0].function = function;
  CurvedSum<Dim> sum(std::move(terms));
  CurvedEnergy<Dim>& energy = *sum.terms()[0].energy;
  energy.setItems(this->itemsOf<Dim>(region));
  CurvedNewton<Dim> newton(sum, *region.slides, this->Options.threads);
  const CurvedGuard guard(region.elements, Dim, this->Options.threads);

  std::vector<double> x = region.x, trial;
  Attempt best = { x, guard.invalid(x) };
  std::map<Index, int> recurrences; ///< by element: how often it was invalid
  std::vector<WeakPlace> weak = best.weak;
  double least = energy.leastDeterminant(x);
  constexpr double tiny = 1e-9, ofLeast = 0.2, slowest = 0.6;
  // About a fifth of the worst negative determinant, but at least 1e-6.
  double epsilon = std::sqrt(1e-12 + 0.04 * std::min(least, 0.0) * least);
  constexpr int most = 400, patience = 30, steps = 3;
  constexpr int mostWithoutStep = 3;
  int sinceBest = 0, sinceStep = 0;
  for (int outer = 0;
       outer < most && !best.weak.empty() && sinceBest < patience && sinceStep < mostWithoutStep;
       ++outer)
  {
    // The location of the smallest determinant of an invalid element becomes a sample. An element
    // that remains invalid is sampled densely.
    std::vector<SampleItem> added;
    for (const WeakPlace& place : weak)
    {
      const int times = ++recurrences[place.element];
      const CurvedElement& element = region.elements[place.element];
      SampleItem item = energy.items()[place.element];
      const bool everywhere = times == DenseAfter;
      const std::vector<SamplePlace> places = everywhere
        ? lattice(element.type->shape(), element.type->orders())
        : std::vector<SamplePlace>{ { place.at, CurvedGuard::PlaceShare } };
      item.table = std::make_shared<const SampleTable>(*element.type, element.mirrored, places);
      added.push_back(item);
    }
    energy.addItems(added);
    least = energy.leastDeterminant(x);
    // Added samples may have smaller determinants than the ones that epsilon was chosen for.
    epsilon = std::max(epsilon, ofLeast * std::abs(std::min(least, 0.0)));
    function->setEpsilon(epsilon);
    const double before = sum.value(x);
    double after = before;
    ++sinceStep;
    for (int step = 0; step < steps; ++step)
    {
      newton.linearize(x, NewtonLimits());
      double length = 1;
      const Index held = region.slides->held();
      const double value = newton.slope() < 0 ? newton.search(x, length, trial) : HUGE_VAL;
      if (!(value < newton.energy()))
      {
        if (region.slides->held() > held)
        {
          continue; // another direction
        }
        break;
      }
      x.swap(trial);
      region.slides->accept();
      after = value;
      sinceStep = 0;
    }
    region.slides->release();
    weak = guard.invalid(x);
    ++sinceBest;
    if (weak.size() < best.weak.size())
    {
      best.x = x;
      best.weak = weak;
      sinceBest = 0;
    }
    if (!this->proceed(after, static_cast<Index>(best.weak.size()), region.free, &region, &best.x))
    {
      best.stopped = true;
      break;
    }
    // The schedule of Garanzha et al., section 4.
    least = energy.leastDeterminant(x);
    const double gain = std::max(slowest, 1 - after / before);
    const double chi = 0.5 * (least + std::sqrt(epsilon * epsilon + least * least));
    const double mu = (1 - gain) * chi;
    epsilon = least < mu ? 2 * std::sqrt(mu * (mu - least)) : tiny;
    epsilon = std::max(epsilon, tiny);
  }
  return best;
}

//------------------------------------------------------------------------------
/// Moves the nodes of invalid elements toward their positions in a straight element until these are
/// valid. @return the number of changed elements
Index CurvedUntangling::straighten(const std::vector<WeakPlace>& weak)
{
  constexpr int steps = 16;
  std::vector<double>& x = this->Problem.x();
  Index changed = 0;
  for (const WeakPlace& place : weak)
  {
    const CurvedElement& element = this->Problem.elements()[place.element];
    const std::vector<double> before = x;
    const ElementType& linear = linearType(element.type->shape());
    const int corners = linear.nodes();
    bool good = false;
    // Small steps move the nodes no farther than necessary.
    for (int step = 1; step <= steps && !good; ++step)
    {
      const double share = static_cast<double>(step) / steps;
      for (int n = corners; n < element.type->nodes(); ++n)
      {
        const std::vector<double> values = linear.shapeFunctions(element.type->coordinates()[n]);
        for (int c = 0; c < 3; ++c)
        {
          double straight = 0;
          for (int k = 0; k < corners; ++k)
          {
            straight += values[k] * before[3 * element.nodes[k] + c];
          }
          const Index p = element.nodes[n];
          x[3 * p + c] = (1 - share) * before[3 * p + c] + share * straight;
        }
      }
      const std::vector<WeakPlace> left = this->Problem.guard().invalid(x);
      good = left.size() < this->Result.remaining.size() - changed;
    }
    if (good)
    {
      ++changed;
    }
    else
    {
      x = before;
    }
  }
  return changed;
}

//------------------------------------------------------------------------------
CurvedUntangleResult CurvedUntangling::run()
{
  const CurvedGuard& guard = this->Problem.guard();
  const std::vector<WeakPlace> first = guard.invalid(this->Problem.x());
  std::vector<WeakPlace> weak = first;
  this->Result.invalidBefore = static_cast<Index>(first.size());
  this->Result.reason = first.empty() ? StopReason::AllValid : StopReason::NoFreeVertices;
  constexpr std::array<int, 3> rings = { 2, 5, -1 };
  std::size_t tried = 0; // number of elements in the last attempt
  for (std::size_t attempt = 0; attempt < rings.size() && !weak.empty(); ++attempt)
  {
    CurvedRegion region = this->Problem.region(weak, rings[attempt]);
    this->Result.freePoints = std::max(this->Result.freePoints, region.free);
    if (this->Result.history.empty() &&
      !this->proceed(0, this->Result.invalidBefore, region.free, nullptr, nullptr))
    {
      this->Result.reason = this->Stopped;
      break;
    }
    // A wider region may contain the same elements; the result would then be the same.
    const bool same = region.elements.size() == tried;
    tried = region.elements.size();
    if (region.free == 0 || same)
    {
      continue;
    }
    const Attempt found =
      this->Problem.dimension() == 2 ? this->untangle<2>(region) : this->untangle<3>(region);
    if (found.weak.size() < weak.size())
    {
      tried = 0; // the points have changed
      this->Problem.take(region, found.x);
      weak = guard.invalid(this->Problem.x());
    }
    this->Result.reason = weak.empty() ? StopReason::AllValid
      : found.stopped                  ? this->Stopped
                                       : StopReason::NoProgress;
    if (found.stopped)
    {
      break;
    }
  }
  if (!weak.empty() && this->Options.straighten)
  {
    // straighten() compares the number of invalid elements with the length of this list.
    for (const WeakPlace& place : weak)
    {
      this->Result.remaining.push_back(place.element);
    }
    this->Result.straightened = this->straighten(weak);
    weak = guard.invalid(this->Problem.x());
    this->Result.remaining.clear();
    this->Result.reason = weak.empty() ? StopReason::AllValid : this->Result.reason;
  }
  this->Result.invalidAfter = static_cast<Index>(weak.size());
  std::vector<Index> before;
  for (const WeakPlace& place : first)
  {
    before.push_back(place.element);
  }
  for (const WeakPlace& place : weak)
  {
    this->Result.newlyInvalid += !std::binary_search(before.begin(), before.end(), place.element);
    this->Result.remaining.push_back(this->Problem.elements()[place.element].cell);
  }
  this->Result.points = this->Problem.points();
  return std::move(this->Result);
}
}

//------------------------------------------------------------------------------
CurvedUntangleResult untangleCurved(const Mesh& mesh, const CurvedOptions& options)
{
  CurvedProblem problem(mesh, options);
  CurvedUntangleResult result = untangleCurved(problem, options);
  const bool slides =
    options.boundary == BoundaryMotion::OnSurface || options.boundary == BoundaryMotion::FlatParts;
  if (slides && result.invalidAfter > 0 && result.reason == StopReason::NoProgress)
  {
    // Boundary motion may not help: start over with a fixed boundary.
    CurvedOptions held = options;
    held.boundary = BoundaryMotion::Fixed;
    CurvedProblem again(mesh, held);
    CurvedUntangleResult other = untangleCurved(again, held);
    if (other.invalidAfter < result.invalidAfter)
    {
      return other;
    }
  }
  return result;
}

//------------------------------------------------------------------------------
CurvedUntangleResult untangleCurved(CurvedProblem& problem, const CurvedOptions& options)
{
  return CurvedUntangling(problem, options).run();
}
}
