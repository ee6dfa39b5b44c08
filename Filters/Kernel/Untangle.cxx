#include "Untangle.h"

#include "GlobalDescent.h"

#include <chrono>

namespace tautline
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Iterations an effort allows, of all phases together.
int iterationLimit(Effort effort)
{
  constexpr int local = 60, normal = 500, thorough = 5000;
  return effort == Effort::Local ? local : effort == Effort::Normal ? normal : thorough;
}

Index countInvalid(const std::vector<signed char>& validity)
{
  return static_cast<Index>(std::count_if(validity.begin(), validity.end(),
    [](signed char v) { return v == Inverted || v == Degenerate; }));
}

/// A falling sequence of regularisations, with a solve for each.
struct Schedule
{
  double eps;       ///< the first
  double factor;    ///< from each to the next
  double tolerance; ///< a solve ends when an iteration lowers the energy by less, relative to it
  int solves;
  int iterations; ///< of a solve, at most
};

/// The history, the observer, the limits, and the best coordinates so far.
class Progress
{
public:
  Progress(const Mesh& mesh, const SimplexMesh& simplices, const UntangleOptions& options,
    Clock::time_point start, Untangling& result)
    : Input(mesh)
    , Simplices(simplices)
    , Options(options)
    , Result(result)
    , Start(start)
    , Best(simplices.coordinates(),
        simplices.coordinates() + static_cast<std::size_t>(VertexStride) * simplices.vertices())
  {
  }

  /// Records an iteration that led to x. False if it has to be the last.
  bool record(const double* x, Index invalidCells, double depth)
  {
    if (this->Result.history.empty() || invalidCells < this->Fewest)
    {
      this->Fewest = invalidCells;
      std::copy_n(x, this->Best.size(), this->Best.begin());
    }
    IterationRecord record;
    record.iteration = static_cast<int>(this->Result.history.size());
    record.seconds = this->seconds();
    record.objective = depth;
    record.objectives = { depth };
    record.inverted = invalidCells;
    this->Result.history.push_back(record);
    const int limit = iterationLimit(this->Options.effort);
    double part = static_cast<double>(record.iteration) / limit;
    if (this->Options.maximumSeconds > 0)
    {
      part = std::max(part, record.seconds / this->Options.maximumSeconds);
    }
    if (this->Options.observer)
    {
      const auto points = [this, x](double* to)
      {
        const MeshView& view = this->Input.view();
        std::copy_n(view.points, 3 * view.numberOfPoints, to);
        this->Simplices.store(x, to, this->Options.threads);
      };
      if (!this->Options.observer({ record, std::min(part, 1.0), points }))
      {
        return this->stop(StopReason::Aborted);
      }
    }
    if (this->Options.maximumSeconds > 0 && record.seconds >= this->Options.maximumSeconds)
    {
      return this->stop(StopReason::TimeLimit);
    }
    if (record.iteration >= limit)
    {
      return this->stop(StopReason::IterationLimit);
    }
    return true;
  }

  bool stopped() const { return this->Stopped; }
  const double* best() const { return this->Best.data(); }
  Index fewest() const { return this->Fewest; }
  /// Forgets the best so far but keeps the limits.
  void restart(Index fewest) { this->Fewest = fewest; }

private:
  bool stop(StopReason reason)
  {
    this->Result.reason = reason;
    this->Stopped = true;
    return false;
  }
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

  const Mesh& Input;
  const SimplexMesh& Simplices;
  const UntangleOptions& Options;
  Untangling& Result;
  Clock::time_point Start;
  std::vector<double> Best;
  Index Fewest = 0;
  bool Stopped = false;
};

//------------------------------------------------------------------------------
template <int Dim>
class Untangler
{
public:
  Untangler(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
    Clock::time_point start, Untangling& result)
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

  /// Simplices no place of their free vertex makes valid while the fixed vertices are where they are.
  const std::vector<std::int32_t>& impossible() const { return this->Impossible; }
  bool stopped() const { return this->Run.stopped(); }
  /// Cells that are not valid.
  Index cells() const;
  bool untangled() const { return this->State.bad == 0; }

private:
  double* x() const { return this->Simplices.coordinates(); }
  bool record() { return this->Run.record(this->x(), this->cells(), this->State.depth); }
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
  void giveUpImpossible();
  void smoothWorst();
  void descend(const Schedule& schedule);
  bool startHarmonic(double tolerance);
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
};

/// Cells with bad simplices, the hopeless included.
template <int Dim>
Index Untangler<Dim>::cells() const
{
  const MeshState& state = this->State;
  if (this->OnlySimplices)
  {
    return state.bad + static_cast<Index>(state.hopeless.size());
  }
  std::vector<Index> ids;
  ids.reserve(state.simplices.size() + state.hopeless.size());
  for (const std::vector<std::int32_t>* list : { &state.simplices, &state.hopeless })
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
/// Sweeps around the bad simplices until `patience` of them in a row leave more than the part `progress`.
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
/// Looks at free vertices of bad simplices: whether the simplices they have with fixed vertices alone can all be valid.
template <int Dim>
void Untangler<Dim>::giveUpImpossible()
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
    if (others == Dim && this->Active[v] && !this->Tangled.hopeless(s))
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
    this->Tangled.giveUp(impossible);
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
 * @brief Minimises the energy of the whole mesh for a falling sequence of regularisations. Between the solves
 * the local sweeps try to finish; where they cannot, what they did is undone.
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
    this->finish();
    this->descend({ firstEps, 0.5, loose, 12, 30 });
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
    this->giveUpImpossible();
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

//------------------------------------------------------------------------------
/// The validity of the cells that have a moved point; the others keep theirs.
void classifyMoved(const Mesh& mesh, const double* points, std::vector<signed char>& validity)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    forEachChunk(block.count, 1,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const Index* node = view.connectivity + view.offsets[cell];
          Vec3 p[MaxNodes];
          bool moved = false;
          for (int k = 0; k < t.nodes; ++k)
          {
            const double* to = points + 3 * node[k];
            p[k] = { to[0], to[1], to[2] };
            moved = moved || !std::equal(to, to + 3, view.points + 3 * node[k]);
          }
          if (moved)
          {
            validity[cell] = mesh.classifyCell(t, p);
          }
        }
      });
  }
}

/// Writes the vertices that moved; the others stay bitwise what they were.
void storeMoved(const SimplexMesh& simplices, const std::vector<double>& start, const double* x,
  int threads, std::vector<double>& points)
{
  std::vector<double> all = points;
  simplices.store(x, all.data(), threads);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    const std::size_t i = VertexStride * static_cast<std::size_t>(v);
    if (!std::equal(&start[i], &start[i] + VertexStride, x + i))
    {
      std::copy_n(&all[3 * static_cast<std::size_t>(simplices.point(v))], 3,
        &points[3 * static_cast<std::size_t>(simplices.point(v))]);
    }
  }
}

//------------------------------------------------------------------------------
/// Says of each cell that is not valid, why.
void findObstacles(const Mesh& mesh, const SimplexMesh& simplices,
  const std::vector<signed char>& validity, const std::vector<std::int32_t>& impossible,
  Untangling& result)
{
  const MeshView& view = mesh.view();
  std::vector<char> free(view.numberOfPoints, 0);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    free[simplices.point(v)] = 1;
  }
  std::vector<char> held(view.numberOfCells, 0);
  for (std::int32_t s : impossible)
  {
    held[simplices.cell(s)] = 1;
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      if (validity[cell] == NonFinite)
      {
        result.obstacles[cell] = static_cast<signed char>(Obstacle::NonFinite);
      }
      if (validity[cell] != Inverted && validity[cell] != Degenerate)
      {
        continue;
      }
      const Index* node = view.connectivity + view.offsets[cell];
      const auto isFree = [&](int k) { return free[node[k]] != 0; };
      bool anyFree = false;
      for (int k = 0; k < t.nodes; ++k)
      {
        anyFree = anyFree || isFree(k);
      }
      Obstacle obstacle = anyFree ? Obstacle::Unknown : Obstacle::FixedElement;
      if (anyFree && held[cell])
      {
        obstacle = Obstacle::FixedNeighbours;
      }
      for (int s = 0; anyFree && s < t.samples && t.dimension == simplices.dimension(); ++s)
      {
        // A corner of fixed vertices that is not valid: the cell cannot be either.
        bool fixedCorner = true;
        Vec3 e[4];
        for (int k = 0; k <= t.dimension; ++k)
        {
          fixedCorner = fixedCorner && !isFree(t.cornerNodes[s][k]);
          e[k] = pointOf(view, node[t.cornerNodes[s][k]]);
        }
        if (fixedCorner)
        {
          const Vec3 a = e[1] - e[0], b = e[2] - e[0];
          const Vec3 c = t.dimension == 3 ? e[3] - e[0] : mesh.normal();
          const double det = (mesh.mirrored() ? -1.0 : 1.0) * dot(cross(a, b), c);
          if (det <= Mesh::degenerateTolerance() * norm(a) * norm(b) * norm(c))
          {
            obstacle = Obstacle::FixedNeighbours;
          }
        }
      }
      result.obstacles[cell] = static_cast<signed char>(obstacle);
      result.impossible += obstacle != Obstacle::Unknown;
    }
  }
}

template <int Dim>
void untangleSimplices(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
  const std::vector<signed char>& before, Clock::time_point began, Untangling& result)
{
  const std::vector<double> start(simplices.coordinates(),
    simplices.coordinates() + static_cast<std::size_t>(VertexStride) * simplices.vertices());
  const std::vector<double> input = result.points;
  std::vector<signed char> validity = before;
  Untangler<Dim> untangler(mesh, simplices, options, began, result);
  // The judge sees rounded coordinates: if it does not agree, with a wider margin.
  for (const double margin : { 1e-12, 1e-9, 1e-6 })
  {
    const double* x = untangler.run(margin);
    std::vector<double> points = input;
    storeMoved(simplices, start, x, options.threads, points);
    std::vector<signed char> after = before;
    classifyMoved(mesh, points.data(), after);
    const Index invalid = countInvalid(after);
    if (invalid < result.invertedAfter)
    {
      result.invertedAfter = invalid;
      result.points = points;
      validity = after;
    }
    if (untangler.stopped() || !untangler.untangled() || invalid <= untangler.cells())
    {
      break;
    }
  }
  findObstacles(mesh, simplices, validity, untangler.impossible(), result);
}
}

//------------------------------------------------------------------------------
Untangling untangle(const Mesh& mesh, const UntangleOptions& options)
{
  const Clock::time_point start = Clock::now();
  const MeshView& view = mesh.view();
  Untangling result;
  result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
  result.obstacles.assign(view.numberOfCells, static_cast<signed char>(Obstacle::None));
  std::vector<signed char> validity(view.numberOfCells);
  mesh.classifyCells(validity.data(), options.threads);
  result.invertedBefore = result.invertedAfter = countInvalid(validity);
  if (result.invertedBefore > 0 && mesh.dimension() == Dimension::Surface)
  {
    throw Error(
      "Untangling works on planar and volume meshes: this is a surface in space. Optimize its "
      "shape, which keeps the tangent planes, or project it to a plane first.");
  }
  if (mesh.dimension() == Dimension::None || mesh.dimension() == Dimension::Surface)
  {
    return result;
  }
  SimplexMesh simplices(mesh, options.fixed, nullptr, options.threads);
  if (result.invertedBefore == 0 || simplices.freeVertices() == 0)
  {
    findObstacles(mesh, simplices, validity, {}, result);
    result.reason = result.invertedBefore == 0 ? StopReason::AllValid : StopReason::NoFreeVertices;
    return result;
  }
  result.reason = StopReason::NoProgress;
  if (simplices.dimension() == 3)
  {
    untangleSimplices<3>(mesh, simplices, options, validity, start, result);
  }
  else
  {
    untangleSimplices<2>(mesh, simplices, options, validity, start, result);
  }
  if (result.invertedAfter == 0)
  {
    result.reason = StopReason::AllValid;
  }
  return result;
}
}
