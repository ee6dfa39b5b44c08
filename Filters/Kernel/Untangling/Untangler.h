/**
 * @file Untangler.h
 * @brief The phases of untangling: sweeps around the inverted simplices; all vertices at once;
 * holes that were turned. Internal: not installed.
 */
#ifndef tautline_Untangler_h
#define tautline_Untangler_h

#include "UntangleProgress.h"
#include "RotationContinuation.h"

namespace tautline
{
/// A falling sequence of regularisations, with a solve for each.
struct Schedule
{
  double eps;       ///< the first
  double factor;    ///< from each to the next
  double tolerance; ///< a solve ends when an iteration lowers the energy by less, relative to it
  int solves;
  int iterations; ///< of a solve, at most
};

template <int Dim>
class Untangler
{
public:
  Untangler(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
    Clock::time_point start, UntangleResult& result)
    : Simplices(simplices)
    , Options(options)
    , Tangled(simplices, options.threads)
    , Run(mesh, simplices, options, start, result)
    , OnlySimplices(std::all_of(mesh.blocks().begin(), mesh.blocks().end(),
        [](const CellBlock& block)
        { return topology(block.type).dimension != Dim || topology(block.type).samples == 1; }))
    , Coordinates(static_cast<std::size_t>(VertexStride) * simplices.vertices())
    , Start(simplices.coordinates(), simplices.coordinates() + Coordinates)
    , Active(simplices.freeVertices())
  {
  }

  /// Untangles until no simplex is bad; returns the best coordinates.
  const double* run(double margin);

  /// Simplices no place of their free vertex makes valid while the fixed vertices are where they
  /// are.
  const std::vector<std::int32_t>& impossible() const { return this->Impossible; }
  bool stopped() const { return this->Run.stopped(); }
  /// Cells that are not valid.
  Index cells() const;
  bool untangled() const { return this->State.bad == 0; }

private:
  double* x() const { return this->Simplices.coordinates(); }
  bool record()
  {
    return this->OnTheWay
      ? this->Run.record(this->Run.best(), this->Run.fewest(), this->State.depth)
      : this->Run.record(this->x(), this->cells(), this->State.depth);
  }
  void examine() { this->State = this->Tangled.examine(this->x()); }
  void setCoordinates(const std::vector<double>& from)
  {
    std::copy(from.begin(), from.end(), this->x());
    this->examine();
  }
  std::vector<double> coordinates() const
  {
    return std::vector<double>(this->x(), this->x() + this->Coordinates);
  }

  double badFraction() const
  {
    return static_cast<double>(this->State.bad) / std::max(1, this->Simplices.simplices());
  }
  bool done() const { return this->untangled() || this->Run.stopped(); }

  void markActive(int rings);
  void local(int sweeps, double progress, int patience);
  void finish() { this->local(10, 0.7, 1); }
  void excludeInfeasible();
  void smoothWorst();
  void descend(const Schedule& schedule);
  bool startHarmonic(double tolerance);
  void unwind(double tolerance);
  void untangleOnce();
  void untangleNearby();
  void smoothAll();
  void global();

  SimplexMesh& Simplices;
  const UntangleOptions& Options;
  TangledMesh<Dim> Tangled;
  Progress Run;
  bool OnlySimplices;
  std::size_t Coordinates;
  std::vector<double> Start; ///< coordinates of the input
  std::vector<unsigned char> Active;
  std::vector<std::int32_t> Impossible;
  MeshState State;
  bool OnTheWay = false; ///< fixed vertices are not at their places
};

/// Cells with bad simplices, the infeasible included.
template <int Dim>
Index Untangler<Dim>::cells() const
{
  const MeshState& state = this->State;
  if (this->OnlySimplices)
  {
    return state.bad + static_cast<Index>(state.infeasible.size());
  }
  std::vector<Index> ids;
  ids.reserve(state.simplices.size() + state.infeasible.size());
  for (const std::vector<std::int32_t>* list : { &state.simplices, &state.infeasible })
  {
    for (std::int32_t s : *list)
    {
      ids.push_back(this->Simplices.cell(s));
    }
  }
  std::sort(ids.begin(), ids.end());
  return std::unique(ids.begin(), ids.end()) - ids.begin();
}

/// The free vertices of bad simplices and as many rings of vertices around them.
template <int Dim>
void Untangler<Dim>::markActive(int rings)
{
  const std::int32_t free = this->Simplices.freeVertices();
  std::fill(this->Active.begin(), this->Active.end(), 0);
  std::vector<std::int32_t> front, next;
  const auto mark = [&](std::int32_t v, std::vector<std::int32_t>& to)
  {
    if (v < free && !this->Active[v])
    {
      this->Active[v] = 1;
      to.push_back(v);
    }
  };
  for (std::int32_t s : this->State.simplices)
  {
    for (int k = 0; k <= Dim; ++k)
    {
      mark(this->Simplices.corners()[static_cast<std::size_t>(Dim + 1) * s + k], front);
    }
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    next.clear();
    for (std::int32_t v : front)
    {
      const std::size_t end = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v + 1);
      for (std::size_t i = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v); i < end;
           ++i)
      {
        mark(this->Simplices.patchVertices()[i], next);
      }
    }
    front.swap(next);
  }
}

//------------------------------------------------------------------------------
/// Sweeps around the bad simplices until `patience` of them in a row leave more than the part
/// `progress`.
template <int Dim>
void Untangler<Dim>::local(int sweeps, double progress, int patience)
{
  // With time, more vertices give way; the linear programs are for the few that are left.
  constexpr int steps = 4, mostRings = 4, sweepsPerRing = 2;
  constexpr double few = 0.02;
  Index fewest = this->State.bad;
  int without = 0;
  for (int sweep = 0; sweep < sweeps && !this->done() && without < patience; ++sweep)
  {
    this->markActive(std::min(mostRings, (sweep + 1) / sweepsPerRing));
    const bool tryWidest = sweep > 0 && this->badFraction() < few;
    this->Tangled.sweep(this->Active.data(),
      [&](std::int32_t v, Patch<Dim>& patch)
      { this->Tangled.relax(this->x(), v, steps, tryWidest, patch); });
    this->examine();
    this->record();
    const bool better =
      static_cast<double>(this->State.bad) <= progress * static_cast<double>(fewest);
    without = better ? 0 : without + 1;
    fewest = better ? this->State.bad : fewest;
  }
}

//------------------------------------------------------------------------------
/// Looks at free vertices of bad simplices: whether the simplices they have with fixed vertices
/// alone can all be valid.
template <int Dim>
void Untangler<Dim>::excludeInfeasible()
{
  this->markActive(0);
  const std::int32_t free = this->Simplices.freeVertices();
  std::vector<std::pair<std::int32_t, std::int32_t>> held; // vertex, simplex
  for (std::int32_t s = 0; s < this->Simplices.simplices(); ++s)
  {
    const std::int32_t* corner = this->Simplices.corners() + static_cast<std::size_t>(Dim + 1) * s;
    std::int32_t v = -1;
    int others = 0;
    for (int k = 0; k <= Dim; ++k)
    {
      v = corner[k] < free ? corner[k] : v;
      others += corner[k] >= free;
    }
    if (others == Dim && this->Active[v] && !this->Tangled.infeasible(s))
    {
      held.emplace_back(v, s);
    }
  }
  std::sort(held.begin(), held.end());
  std::vector<std::int32_t> impossible;
  for (std::size_t begin = 0, end = 0; begin < held.size(); begin = end)
  {
    struct Plane
    {
      HalfSpace<Dim> space;
      std::int32_t simplex;
    };
    std::vector<Plane> planes;
    double reach = 0;
    const std::int32_t v = held[begin].first;
    const double* center = this->x() + VertexStride * static_cast<std::size_t>(v);
    for (; end < held.size() && held[end].first == v; ++end)
    {
      // D is linear in v: its values at v and one step along each axis tell all.
      const std::int32_t s = held[end].second;
      const std::int32_t* corner =
        this->Simplices.corners() + static_cast<std::size_t>(Dim + 1) * s;
      double e[Dim + 1][Dim];
      int at = 0;
      for (int k = 0; k <= Dim; ++k)
      {
        at = corner[k] == v ? k : at;
        for (int c = 0; c < Dim; ++c)
        {
          e[k][c] = this->x()[VertexStride * static_cast<std::size_t>(corner[k]) + c] - center[c];
          reach = std::max(reach, std::abs(e[k][c]));
        }
      }
      const auto volume = [&]
      {
        double a[3][3] = { {}, {}, { 0, 0, 1 } };
        for (int k = 0; k < Dim; ++k)
        {
          for (int c = 0; c < Dim; ++c)
          {
            a[k][c] = e[k + 1][c] - e[0][c];
          }
        }
        return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
          a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
          a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
      };
      Plane plane;
      plane.simplex = s;
      plane.space.b = volume();
      double length = 0;
      for (int c = 0; c < Dim; ++c)
      {
        e[at][c] = 1.0;
        plane.space.a[c] = plane.space.b - volume();
        e[at][c] = 0.0;
        length += plane.space.a[c] * plane.space.a[c];
      }
      length = std::sqrt(length);
      if (!(length > 0))
      {
        impossible.push_back(s); // the fixed vertices are in one line or plane
        continue;
      }
      plane.space.b /= length;
      for (double& a : plane.space.a)
      {
        a /= length;
      }
      planes.push_back(plane);
    }
    // The most violated of contradicting planes go, until the rest leaves a place.
    constexpr double far = 100, noPlace = 1e-9;
    while (planes.size() > 1)
    {
      std::vector<HalfSpace<Dim>> spaces;
      for (const Plane& plane : planes)
      {
        spaces.push_back(plane.space);
      }
      std::array<double, Dim> place;
      if (widestPlace<Dim>(spaces, far * reach, place) > noPlace * reach)
      {
        break;
      }
      std::size_t worst = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < planes.size(); ++i)
      {
        double room = planes[i].space.b;
        for (int c = 0; c < Dim; ++c)
        {
          room -= planes[i].space.a[c] * place[c];
        }
        if (room < least)
        {
          least = room;
          worst = i;
        }
      }
      impossible.push_back(planes[worst].simplex);
      planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(worst));
    }
  }
  if (!impossible.empty())
  {
    this->Tangled.exclude(impossible);
    this->Impossible.insert(this->Impossible.end(), impossible.begin(), impossible.end());
    this->examine();
  }
}

//------------------------------------------------------------------------------
/// Rounds the worst simplices that moved; none becomes bad.
template <int Dim>
void Untangler<Dim>::smoothWorst()
{
  constexpr int sweeps = 2, steps = 2;
  constexpr double poor = 1e-2;
  for (int sweep = 0; sweep < sweeps && !this->Run.stopped(); ++sweep)
  {
    const double margin = this->Tangled.margin();
    this->Tangled.setMargin(std::max(margin, poor));
    this->examine();
    this->Tangled.setMargin(margin);
    auto& simplices = this->State.simplices;
    simplices.erase(std::remove_if(simplices.begin(), simplices.end(),
                      [&](std::int32_t s)
                      {
                        const std::int32_t* corner =
                          this->Simplices.corners() + static_cast<std::size_t>(Dim + 1) * s;
                        return std::all_of(corner, corner + Dim + 1,
                          [&](std::int32_t v)
                          {
                            const std::size_t i = VertexStride * static_cast<std::size_t>(v);
                            return std::equal(
                              &this->Start[i], &this->Start[i] + Dim, this->x() + i);
                          });
                      }),
      simplices.end());
    this->markActive(0);
    this->Tangled.sweep(this->Active.data(),
      [&](std::int32_t v, Patch<Dim>& patch)
      { this->Tangled.relax(this->x(), v, steps, false, patch); });
    this->examine();
  }
}

//------------------------------------------------------------------------------
/**
 * @brief Minimises the energy of the whole mesh for a falling sequence of regularisations. Between
 * the solves the local sweeps try to finish; where they cannot, what they did is undone.
 */
template <int Dim>
void Untangler<Dim>::descend(const Schedule& schedule)
{
  constexpr double few = 0.02;
  GlobalDescent<Dim> descent(this->Tangled);
  double eps = schedule.eps;
  for (int solve = 0; solve < schedule.solves && !this->done(); ++solve, eps *= schedule.factor)
  {
    double energy = descent.start(this->x(), eps).energy;
    for (int k = 0; k < schedule.iterations && !this->done(); ++k)
    {
      const bool moved = descent.step(this->x());
      this->examine();
      this->record();
      const double next = descent.state().energy;
      if (!moved || energy - next < schedule.tolerance * energy)
      {
        break;
      }
      energy = next;
    }
    if (!this->done() && this->badFraction() < few)
    {
      const std::vector<double> keep = this->coordinates();
      this->finish();
      if (!this->untangled())
      {
        this->setCoordinates(keep);
      }
    }
  }
}

template <int Dim>
bool Untangler<Dim>::startHarmonic(double tolerance)
{
  constexpr int iterations = 1000;
  const bool held =
    harmonicMap<Dim>(this->Simplices, this->x(), tolerance, iterations, this->Tangled.threads());
  this->examine();
  this->record();
  return held;
}

/**
 * @brief For holes that were turned: from a mesh with the holes turned back step by step to where
 * they are, valid after each step. Ends with the fixed vertices where they belong.
 */
template <int Dim>
void Untangler<Dim>::unwind(double tolerance)
{
  constexpr double largestStep = 0.27, smallestStep = 0.01; // radians
  const RotationContinuation<Dim> winding(this->Tangled, this->x(), tolerance);
  if (winding.empty())
  {
    return;
  }
  this->OnTheWay = true;
  this->setCoordinates(winding.start());
  this->untangleOnce();
  this->smoothAll();
  const double largest = largestStep / winding.largestAngle();
  const double smallest = smallestStep / winding.largestAngle();
  double part = 0, step = largest;
  while (part < 1.0 && this->untangled() && !this->Run.stopped())
  {
    // Shorter steps where the elements do not follow.
    step = std::min(step, 1.0 - part);
    const std::vector<double> keep = this->coordinates();
    winding.advance(step, this->x());
    this->examine();
    this->untangleNearby();
    if (this->untangled())
    {
      part += step;
      constexpr double longer = 1.5;
      step = std::min(largest, longer * step);
    }
    else
    {
      this->setCoordinates(keep);
      step *= 0.5;
      if (step < smallest)
      {
        break;
      }
    }
    this->smoothAll();
  }
  this->OnTheWay = false;
  const std::size_t free = VertexStride * static_cast<std::size_t>(this->Simplices.freeVertices());
  std::copy(
    this->Start.begin() + static_cast<std::ptrdiff_t>(free), this->Start.end(), this->x() + free);
  this->examine();
  if (!this->Run.stopped())
  {
    this->record();
    this->untangleNearby();
  }
}

/// Lowers the energy of a valid mesh a little; it stays valid.
template <int Dim>
void Untangler<Dim>::smoothAll()
{
  constexpr int iterations = 6;
  if (!this->untangled())
  {
    return;
  }
  GlobalDescent<Dim> descent(this->Tangled);
  descent.start(this->x(), 0.0);
  for (int k = 0; k < iterations && !this->Run.stopped(); ++k)
  {
    const std::vector<double> keep = this->coordinates();
    if (!descent.step(this->x()))
    {
      break;
    }
    this->examine();
    this->record();
    if (!this->untangled())
    {
      this->setCoordinates(keep); // positive, but not by the margin
      break;
    }
  }
}

/// The local sweeps, then regularisations of the size of what is wrong, which keep most of a mesh.
template <int Dim>
void Untangler<Dim>::untangleNearby()
{
  constexpr double ofLeast = 0.3, leastEps = 1e-3, loose = 1e-3;
  this->finish();
  this->descend({ std::max(ofLeast * std::abs(this->State.least), leastEps), 0.5, loose, 1, 6 });
}

/// The local sweeps, then the usual schedule.
template <int Dim>
void Untangler<Dim>::untangleOnce()
{
  constexpr double firstEps = 1.0, loose = 1e-3;
  this->finish();
  this->descend({ firstEps, 0.5, loose, 12, 30 });
}

template <int Dim>
void Untangler<Dim>::global()
{
  // Determinants are 1 for a simplex with edges of the mean length.
  constexpr double firstEps = 1.0, ofLeast = 0.1, few = 0.002;
  constexpr double loose = 1e-3, tight = 1e-4, harmonic = 1e-3, exactlyHarmonic = 1e-6;
  const std::vector<double> before = this->coordinates();
  const double depth = ofLeast * std::abs(this->State.least);

  // A few bad simplices: a short try that leaves the others about where they are.
  if (this->badFraction() < few)
  {
    this->descend({ std::max(depth, this->Tangled.margin()), 1.0, loose, 2, 8 });
  }
  if (!this->done() && this->startHarmonic(harmonic))
  {
    this->untangleOnce();
  }
  if (!this->done())
  {
    this->setCoordinates(before);
    this->unwind(harmonic);
  }
  if (!this->done())
  {
    this->setCoordinates(before);
    this->descend({ std::max(firstEps, depth), 0.5, loose, 12, 30 });
  }
  if (this->Options.effort == Effort::Thorough)
  {
    const Schedule slow = { std::max(10.0 * firstEps, depth), 0.7, loose, 30, 30 };
    const Schedule slower = { std::max(10.0 * firstEps, depth), 0.8, tight, 40, 60 };
    for (const Schedule& schedule : { slow, slower })
    {
      if (!this->done())
      {
        this->setCoordinates(this->Start);
        this->descend(schedule);
      }
      if (!this->done())
      {
        this->setCoordinates(before);
        this->startHarmonic(exactlyHarmonic);
        this->descend(schedule);
      }
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
const double* Untangler<Dim>::run(double margin)
{
  this->Tangled.setMargin(margin);
  this->examine();
  this->Run.restart(std::numeric_limits<Index>::max());
  this->record();
  constexpr double many = 0.05;
  constexpr int sweeps = 40, globalSweeps = 12;
  const bool onlyLocal = this->Options.effort == Effort::Local;
  if (!this->done() && (onlyLocal || this->badFraction() < many))
  {
    this->local(onlyLocal ? sweeps : globalSweeps, 0.9, onlyLocal ? 6 : 3);
  }
  if (!this->done())
  {
    this->excludeInfeasible();
    this->record();
  }
  if (!this->done() && !onlyLocal)
  {
    this->global();
  }
  if (this->untangled() && !this->Run.stopped())
  {
    this->smoothWorst();
    this->Run.restart(std::numeric_limits<Index>::max());
    this->record();
  }
  std::copy_n(this->Run.best(), this->Coordinates, this->x());
  this->examine();
  return this->x();
}
}
#endif
