// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeDynamicProgram.h"

#include "ShapeEnergy.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Steps with fewer triangles run on one thread.
constexpr Index SmallStep = 100000;

/// Selects the function for the cost of a triangle: one for each set of terms.
template <class Action>
void dispatch(const ShapeEnergy& energy, const Action& action)
{
  const bool distortion = energy.distortion > 0.0, rotation = energy.rotation > 0.0;
  const bool free = energy.reflection == Reflection::Free;
  const auto with = [&](auto d, auto r)
  {
    if (free)
    {
      action(d, r, std::true_type{});
    }
    else
    {
      action(d, r, std::false_type{});
    }
  };
  if (rotation && distortion)
  {
    with(std::true_type{}, std::true_type{});
  }
  else if (rotation)
  {
    with(std::false_type{}, std::true_type{});
  }
  else if (distortion)
  {
    with(std::true_type{}, std::false_type{});
  }
  else
  {
    with(std::false_type{}, std::false_type{});
  }
}

PairTable transpose(const PairTable& table)
{
  PairTable result(table.columns, table.rows, 0.0f);
  for (Index i = 0; i < table.rows; ++i)
  {
    throwIfInterrupted();
    for (Index j = 0; j < table.columns; ++j)
    {
      result.row(j)[i] = table.row(i)[j];
    }
  }
  return result;
}

/// The minimum of each row of slots, for each row of the table.
PairTable rowMinima(const PairTable& table, const LocationSet& set)
{
  PairTable minima(table.rows, (set.rows + FloatWidth - 1) / FloatWidth * FloatWidth, Unreachable);
  for (Index p = 0; p < table.rows; ++p)
  {
    throwIfInterrupted();
    const float* values = table.row(p);
    for (Index row = 0; row < set.rows; ++row)
    {
      FloatPacket low = loadFloats(values + row * set.rowLength);
      for (Index c = FloatWidth; c < set.rowLength; c += FloatWidth)
      {
        low = min(low, loadFloats(values + row * set.rowLength + c));
      }
      minima.row(p)[row] = least(low);
    }
  }
  return minima;
}

float minimumOf(const float* values, Index n)
{
  return *std::min_element(values, values + n);
}
}

PlacementSolver::PlacementSolver(const PlacementProblem& problem)
  : Problem(problem)
{
}

double PlacementSolver::memory(const PlacementProblem& problem)
{
  double floats = 0.0;
  for (const auto& triangle : problem.mesh->triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      floats += 0.75 * static_cast<double>(problem.sets[triangle[c]]->size()) *
        static_cast<double>(problem.sets[triangle[(c + 1) % 3]]->size());
    }
  }
  return floats * sizeof(float);
}

bool PlacementSolver::report(double fraction)
{
  if (!this->Stopped && this->Problem.progress && !this->Problem.progress(fraction))
  {
    this->Stopped = true;
  }
  return !this->Stopped;
}

PairTable PlacementSolver::take(Index from, Index to)
{
  const Index n = static_cast<Index>(this->Problem.mesh->points.size());
  if ((from + 1) % n == to)
  {
    return *this->Problem.edges[from];
  }
  if ((to + 1) % n == from)
  {
    const PairTable& table = *this->Problem.edges[to];
    return this->Problem.symmetricEdges ? table : transpose(table);
  }
  // The table of an inner edge was made by the step that eliminated the part of the polygon behind
  // it.
  auto found = this->Pending.find({ from, to });
  const bool turned = found == this->Pending.end();
  if (turned)
  {
    found = this->Pending.find({ to, from });
  }
  PairTable table = turned ? transpose(found->second) : std::move(found->second);
  this->Pending.erase(found);
  return table;
}

const PairTable& PlacementSolver::distances(const LocationSet* a, const LocationSet* b)
{
  PairTable& table = this->Distances[{ a, b }];
  if (table.values.empty())
  {
    table = PairTable(a->size(), b->size(), 0.0f);
    for (Index i = 0; i < a->size(); ++i)
    {
      throwIfInterrupted();
      for (Index j = 0; j < b->size(); j += FloatWidth)
      {
        const FloatPacket dx = loadFloats(b->x.data() + j) - a->x[i];
        const FloatPacket dy = loadFloats(b->y.data() + j) - a->y[i];
        storeFloats(table.row(i) + j, sqrt(dx * dx + dy * dy));
      }
    }
  }
  return table;
}

bool PlacementSolver::run()
{
  const PolygonMesh& mesh = *this->Problem.mesh;
  const std::size_t n = mesh.elimination.size();
  this->Steps.reserve(n);
  // Floor is the sum of the minima of all tables not yet combined: a lower bound of their total
  // cost.
  for (const PairTable* edge : this->Problem.edges)
  {
    this->Floor += minimumOf(edge->values.data(), static_cast<Index>(edge->values.size()));
  }
  for (std::size_t number = 0; number < n; ++number)
  {
    const EliminationStep& e = mesh.elimination[number];
    const Index k = e.vertex, i = e.parents[0], j = e.parents[1];
    this->Steps.push_back({ e, this->take(i, k), this->take(j, k),
      TriangleTerms(mesh.points[i], mesh.points[j], mesh.points[k], this->Problem.energy,
        this->Problem.delta) });
    Step& step = this->Steps.back();
    // Both tables are combined in this step, so the floor no longer includes them.
    for (const PairTable* part : { &step.fromI, &step.fromJ })
    {
      this->Floor -= minimumOf(part->values.data(), static_cast<Index>(part->values.size()));
    }
    // Rounding must not exclude the best placement itself.
    this->StepLimit =
      static_cast<float>(this->Problem.limit - std::max(0.0, this->Floor) * (1.0 - 1e-5) + 1e-5);
    // The cost of vertex k itself is added once, on the edge from i.
    const std::vector<float>& vertex = this->Problem.vertices[k];
    for (Index p = 0; p < step.fromI.rows && !vertex.empty(); ++p)
    {
      throwIfInterrupted();
      for (Index r = 0; r < step.fromI.columns; ++r)
      {
        step.fromI.row(p)[r] += vertex[r];
      }
    }
    // Eliminates vertex k: the minimum cost for each pair of locations of its parents.
    PairTable out(this->Problem.sets[i]->size(), this->Problem.sets[j]->size(), Unreachable);
    this->solveStep(number, step, out);
    if (!this->report(static_cast<double>(number + 1) / static_cast<double>(n)))
    {
      return false;
    }
    if (number + 1 < n)
    {
      const float low = minimumOf(out.values.data(), static_cast<Index>(out.values.size()));
      this->Floor += low < Unreachable ? low : 0.0f;
      this->Pending[{ i, j }] = std::move(out);
      continue;
    }
    // One edge remains: its own cost or the cost beyond it, and the costs of its vertices.
    const PairTable last = this->take(i, j);
    const std::vector<float>&ui = this->Problem.vertices[i], &uj = this->Problem.vertices[j];
    for (Index p = 0; p < out.rows; ++p)
    {
      for (Index q = 0; q < out.columns; ++q)
      {
        float& value = out.row(p)[q];
        value = std::min(Unreachable,
          value + last.row(p)[q] + (ui.empty() ? 0.0f : ui[p]) + (uj.empty() ? 0.0f : uj[q]));
      }
    }
    this->Values = std::move(out);
  }
  return true;
}

void PlacementSolver::solveStep(std::size_t number, const Step& step, PairTable& out)
{
  const EliminationStep& e = step.elimination;
  const LocationSet* set = this->Problem.sets[e.vertex];
  const bool grid =
    set->grid && this->Problem.sets[e.parents[0]] == set && this->Problem.sets[e.parents[1]] == set;
  if (grid)
  {
    this->solveGrid(number, step, out);
  }
  else
  {
    this->solveRows(number, step, out);
  }
}

//------------------------------------------------------------------------------
namespace
{
/// Finds the best location of vertex k for locations p of i and q of j, in packets of locations r.
class RowSearch
{
public:
  /// Work space of one thread.
  struct Scratch
  {
    std::vector<float> best;     ///< minimum cost for each q
    std::vector<Index> guess;    ///< packet of the best r for each q, with which the next p starts
    std::vector<Index> tried;    ///< packet tried first
    std::vector<BaseEdge> edges; ///< from p to each q

    explicit Scratch(Index columns)
      : best(static_cast<std::size_t>(columns))
      , guess(best.size(), 0)
      , tried(best.size(), 0)
    {
    }
  };

  /// @param limit placements above it are skipped, if `bounds`
  RowSearch(const TriangleTerms& terms, const PairTable& fromI, const PairTable& fromJ, bool bounds,
    float limit)
    : Terms(terms)
    , FromI(fromI)
    , FromJ(fromJ)
    , Bounds(bounds)
    , Screen(bounds && terms.deformation > 0.0f)
    , Limit(limit)
    , Inverse(Screen ? 1.0f / terms.deformation : 0.0f)
  {
  }

  void setSets(const LocationSet& i, const LocationSet& j, const LocationSet& k)
  {
    this->SetI = &i;
    this->SetJ = &j;
    this->SetK = &k;
    this->MinI = rowMinima(this->FromI, k);
    this->MinJ = rowMinima(this->FromJ, k);
  }

  void setLengths(const PairTable& ij, const PairTable& ik, const PairTable& jk)
  {
    this->LengthIJ = &ij;
    this->LengthIK = &ik;
    this->LengthJK = &jk;
    // For the screen, the share of edge j-k in the norm of the map is computed once for all p.
    if (this->Screen)
    {
      this->NormJ = jk;
      for (float& length : this->NormJ.values)
      {
        length *= length * this->Terms.weights[2];
      }
    }
  }

  /// Fills row p of the table.
  template <bool Distortion, bool Rotation, bool Mirrored>
  void solve(Index p, Scratch& scratch, PairTable& out) const
  {
    const LocationSet &sj = *this->SetJ, &sk = *this->SetK;
    const float px = this->SetI->x[p], py = this->SetI->y[p];
    std::vector<float>& best = scratch.best;
    std::vector<BaseEdge>& edges = scratch.edges;
    edges.clear();
    for (Index q = 0; q < sj.size(); ++q)
    {
      edges.emplace_back(this->Terms, sj.x[q], sj.y[q], px, py, this->LengthIJ->row(p)[q]);
      best[q] = this->Limit;
    }
    // The best of a packet of locations r for vertex k, with q for vertex j.
    const auto visit = [&](Index q, Index row)
    {
      const Index r = row * FloatWidth;
      const FloatPacket parts =
        loadFloats(this->FromI.row(p) + r) + loadFloats(this->FromJ.row(q) + r);
      const float value = least(parts +
        triangleCost<Distortion, Rotation, Mirrored>(this->Terms, edges[q],
          loadFloats(sk.x.data() + r) - px, loadFloats(sk.y.data() + r) - py,
          loadFloats(this->LengthIK->row(p) + r), loadFloats(this->LengthJK->row(q) + r)));
      if (value < best[q])
      {
        best[q] = value;
        scratch.guess[q] = row;
      }
    };
    // Start with the row in which the last p found the best; few other rows can beat it.
    const float* rowsI = this->MinI.row(p);
    scratch.tried = scratch.guess;
    for (Index q : sj.used)
    {
      const Index guess = scratch.guess[q];
      if (!this->Bounds ||
        rowsI[guess] + this->MinJ.row(q)[guess] + this->Terms.bound(edges[q].length) < this->Limit)
      {
        visit(q, scratch.tried[q]);
      }
    }
    // The outer loop runs over the locations r, because the data of p and r are shared by all q.
    for (Index row = 0; row < sk.rows; ++row)
    {
      const Index r = row * FloatWidth;
      const FloatPacket rx = loadFloats(sk.x.data() + r) - px;
      const FloatPacket ry = loadFloats(sk.y.data() + r) - py;
      const FloatPacket pr = loadFloats(this->LengthIK->row(p) + r);
      const FloatPacket normI = this->Terms.weights[1] * (pr * pr);
      const FloatPacket partI = loadFloats(this->FromI.row(p) + r);
      for (Index q : sj.used)
      {
        if (row == scratch.tried[q])
        {
          continue;
        }
        // The remaining budget in units of the deformation weight: larger squared anisotropies
        // cannot win.
        const float value = best[q] * this->Inverse;
        if (!this->Screen || value > TriangleTerms::MaxLog2 ||
          mayStayBelow<Mirrored>(edges[q], rx, ry,
            edges[q].weighted + normI + loadFloats(this->NormJ.row(q) + r),
            partI + loadFloats(this->FromJ.row(q) + r), value, this->Inverse))
        {
          visit(q, row);
        }
      }
    }
    for (Index q : sj.used)
    {
      out.row(p)[q] = best[q] < this->Limit ? best[q] : Unreachable;
    }
  }

private:
  const TriangleTerms& Terms;
  const PairTable &FromI, &FromJ;
  /// Screen: whether packets are ruled out by a cheap bound on the deformation
  bool Bounds, Screen;
  float Limit, Inverse;
  const LocationSet *SetI = nullptr, *SetJ = nullptr, *SetK = nullptr;
  const PairTable *LengthIJ = nullptr, *LengthIK = nullptr, *LengthJK = nullptr;
  PairTable MinI, MinJ, NormJ;
};
}

void PlacementSolver::solveRows(std::size_t number, const Step& step, PairTable& out)
{
  const LocationSet &si = *this->Problem.sets[step.elimination.parents[0]],
                    &sj = *this->Problem.sets[step.elimination.parents[1]],
                    &sk = *this->Problem.sets[step.elimination.vertex];
  const bool bounds = this->Problem.bounds;
  RowSearch search(
    step.terms, step.fromI, step.fromJ, bounds, bounds ? this->StepLimit : Unreachable);
  search.setSets(si, sj, sk);
  search.setLengths(
    this->distances(&si, &sj), this->distances(&si, &sk), this->distances(&sj, &sk));
  const Index count = static_cast<Index>(si.used.size());
  const double triangles = static_cast<double>(this->Problem.mesh->triangles.size());
  const int threads = count * sj.size() * sk.size() > SmallStep ? this->Problem.threads : 1;
  constexpr Index grain = 4;
  ScratchPool<RowSearch::Scratch> scratches([&] { return RowSearch::Scratch(sj.size()); });
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
      parallelFor(
        count, grain, threads, scratches,
        [&](RowSearch::Scratch& scratch, Index at)
        { search.solve<distortion, rotation, mirrored>(si.used[at], scratch, out); },
        [&](double done)
        { return this->report((static_cast<double>(number) + done) / triangles); });
    });
}

//------------------------------------------------------------------------------
namespace
{
/**
 * @brief The search for vertex k if i, j and k have the same grid of locations.
 *
 * For one offset q - p, the cost of the triangle only depends on r - p: one slice of costs is
 * computed and used for every p.
 */
class GridSearch
{
public:
  /// Per thread: the costs of one offset.
  struct Slice
  {
    /// row r_y - p_y starting at 1 - rows, column r_x - p_x starting at 1 - columns
    PairTable costs;
    std::vector<float> minima; ///< of its rows
    std::vector<float> lower;  ///< lower bound for each row of the grid

    explicit Slice(const GridSearch& search)
      : costs(search.SliceRows, search.SliceWidth, 0.0f)
      , minima(static_cast<std::size_t>(search.SliceRows), 0.0f)
      , lower(static_cast<std::size_t>(search.MinI.columns))
    {
    }
  };

  GridSearch(const TriangleTerms& terms, const PairTable& fromI, const PairTable& fromJ,
    const LocationSet& set, bool bounds, float limit)
    : Terms(terms)
    , FromI(fromI)
    , FromJ(fromJ)
    , Bounds(bounds)
    , Limit(limit)
    , Columns(set.columns)
    , Rows(set.rows)
    , Width(set.rowLength)
    , SliceRows(2 * Rows - 1)
    , SliceWidth((2 * Columns - 1 + Width + FloatWidth) / FloatWidth * FloatWidth)
    , StepX(static_cast<float>(set.step[0]))
    , StepY(static_cast<float>(set.step[1]))
    , MinI(rowMinima(fromI, set))
    , MinJ(rowMinima(fromJ, set))
  {
  }

  /// The number of offsets q - p.
  Index offsets() const { return (2 * this->Columns - 1) * this->SliceRows; }

  /// Fills the entries (p, q) of the table with this offset.
  template <bool Distortion, bool Rotation, bool Mirrored>
  void solve(Index offset, Slice& slice, PairTable& out) const
  {
    const Index dx = offset % (2 * this->Columns - 1) - (this->Columns - 1);
    const Index dy = offset / (2 * this->Columns - 1) - (this->Rows - 1);
    const float bx = this->StepX * static_cast<float>(dx),
                by = this->StepY * static_cast<float>(dy);
    const BaseEdge base(this->Terms, bx, by, 0.0f, 0.0f, std::sqrt(bx * bx + by * by));
    // The length of the edge i-j alone bounds the cost of its triangle from below.
    if (this->Bounds && this->Terms.bound(base.length) >= this->Limit)
    {
      return;
    }
    this->fillSlice<Distortion, Rotation, Mirrored>(base, slice);
    Index guess = 0;
    // Only locations p for which q = p + offset is also in the grid.
    const Index endY = std::min(this->Rows, this->Rows - dy);
    const Index endX = std::min(this->Columns, this->Columns - dx);
    for (Index py = std::max<Index>(0, -dy); py < endY; ++py)
    {
      for (Index px = std::max<Index>(0, -dx); px < endX; ++px)
      {
        const Index p = py * this->Width + px, q = (py + dy) * this->Width + px + dx;
        const float best = this->search(p, q, px, py, slice, guess);
        out.row(p)[q] = best < this->Limit ? best : Unreachable;
      }
    }
  }

private:
  /// The costs of the triangles p, q, r with p at the origin, for all r.
  template <bool Distortion, bool Rotation, bool Mirrored>
  void fillSlice(const BaseEdge& base, Slice& slice) const
  {
    const float bx = base.dx, by = base.dy;
    for (Index row = 0; row < this->SliceRows; ++row)
    {
      const float y = this->StepY * static_cast<float>(row - (this->Rows - 1));
      FloatPacket low = broadcast(Unreachable);
      for (Index c = 0; c < this->SliceWidth; c += FloatWidth)
      {
        // Columns beyond the last one repeat it, to fill packets.
        FloatPacket x;
        for (int l = 0; l < FloatWidth; ++l)
        {
          x[l] = static_cast<float>(std::min(c + l, 2 * this->Columns - 2) - (this->Columns - 1));
        }
        x *= this->StepX;
        const FloatPacket fromQx = x - bx, ry = broadcast(y);
        const float fromQy = y - by;
        const FloatPacket cost = triangleCost<Distortion, Rotation, Mirrored>(
          this->Terms, base, x, ry, sqrt(x * x + y * y), sqrt(fromQx * fromQx + fromQy * fromQy));
        storeFloats(slice.costs.row(row) + c, cost);
        low = min(low, cost);
      }
      slice.minima[row] = least(low);
    }
  }

  /// The minimum cost over all r, at most the limit. Starts with the row that was best for the last
  /// p and q; a row is skipped if the sum of its three minima is not better than the current best.
  float search(Index p, Index q, Index px, Index py, Slice& slice, Index& guess) const
  {
    const Index width = this->Width;
    const float *partI = this->FromI.row(p), *partJ = this->FromJ.row(q);
    // A slice starts at the offsets 1 - rows and 1 - columns, so this is the cost for the first
    // location r.
    const float* costs = slice.costs.row(this->Rows - 1 - py) + this->Columns - 1 - px;
    float best = this->Limit;
    const auto visit = [&](Index row)
    {
      FloatPacket low = broadcast(Unreachable);
      for (Index c = 0; c < width; c += FloatWidth)
      {
        const FloatPacket parts =
          loadFloats(partI + row * width + c) + loadFloats(partJ + row * width + c);
        low = min(low, loadFloats(costs + row * this->SliceWidth + c) + parts);
      }
      const float value = least(low);
      if (value < best)
      {
        best = value;
        guess = row;
      }
    };
    if (!this->Bounds)
    {
      for (Index row = 0; row < this->Rows; ++row)
      {
        visit(row);
      }
      return best;
    }
    const float *rowsI = this->MinI.row(p), *rowsJ = this->MinJ.row(q);
    const float* rowsCost = slice.minima.data() + this->Rows - 1 - py;
    std::vector<float>& lower = slice.lower;
    for (Index row = 0; row < this->Rows; ++row)
    {
      lower[row] = rowsI[row] + rowsJ[row] + rowsCost[row];
    }
    const Index first = guess;
    if (lower[first] < best)
    {
      visit(first);
    }
    for (Index row = 0; row < this->Rows; ++row)
    {
      if (lower[row] < best && row != first)
      {
        visit(row);
      }
    }
    return best;
  }

  const TriangleTerms& Terms;
  const PairTable &FromI, &FromJ;
  bool Bounds;
  float Limit;
  Index Columns, Rows, Width; ///< Width: slots of a row of the grid
  Index SliceRows, SliceWidth;
  float StepX, StepY;
  PairTable MinI, MinJ;
};
}

void PlacementSolver::solveGrid(std::size_t number, const Step& step, PairTable& out)
{
  const bool bounds = this->Problem.bounds;
  const GridSearch search(step.terms, step.fromI, step.fromJ,
    *this->Problem.sets[step.elimination.vertex], bounds, bounds ? this->StepLimit : Unreachable);
  const Index offsets = search.offsets();
  const double triangles = static_cast<double>(this->Problem.mesh->triangles.size());
  constexpr Index grain = 8;
  ScratchPool<GridSearch::Slice> slices([&] { return GridSearch::Slice(search); });
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
      parallelFor(
        offsets, grain, this->Problem.threads, slices,
        [&](GridSearch::Slice& slice, Index offset)
        { search.solve<distortion, rotation, mirrored>(offset, slice, out); },
        [&](double done)
        { return this->report((static_cast<double>(number) + done) / triangles); });
    });
}

//------------------------------------------------------------------------------
std::vector<Index> PlacementSolver::trace(Index p, Index q) const
{
  std::vector<Index> slots(this->Problem.mesh->points.size(), 0);
  const EliminationStep& last = this->Steps.back().elimination;
  slots[last.parents[0]] = p;
  slots[last.parents[1]] = q;
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
      // In reverse order, the parents of an eliminated vertex are already placed; recomputing its
      // best location saves a table of choices.
      for (auto step = this->Steps.rbegin(); step != this->Steps.rend(); ++step)
      {
        const EliminationStep& e = step->elimination;
        const LocationSet &si = *this->Problem.sets[e.parents[0]],
                          &sj = *this->Problem.sets[e.parents[1]],
                          &sk = *this->Problem.sets[e.vertex];
        const Index i = slots[e.parents[0]], j = slots[e.parents[1]];
        const float px = si.x[i], py = si.y[i], qx = sj.x[j], qy = sj.y[j];
        const BaseEdge base(
          step->terms, qx, qy, px, py, std::sqrt((qx - px) * (qx - px) + (qy - py) * (qy - py)));
        // The limit is above the sum of three unreachable costs, so that a location is always
        // found.
        float best = 4.0f * Unreachable;
        Index slot = sk.used.front();
        for (Index c = 0; c < sk.size(); c += FloatWidth)
        {
          const FloatPacket x = loadFloats(sk.x.data() + c), y = loadFloats(sk.y.data() + c);
          const FloatPacket fromP[2] = { x - px, y - py }, fromQ[2] = { x - qx, y - qy };
          const FloatPacket value =
            triangleCost<distortion, rotation, mirrored>(step->terms, base, fromP[0], fromP[1],
              sqrt(fromP[0] * fromP[0] + fromP[1] * fromP[1]),
              sqrt(fromQ[0] * fromQ[0] + fromQ[1] * fromQ[1])) +
            (loadFloats(step->fromI.row(i) + c) + loadFloats(step->fromJ.row(j) + c));
          for (int l = 0; l < FloatWidth; ++l)
          {
            if (value[l] < best)
            {
              best = value[l];
              slot = c + l;
            }
          }
        }
        slots[e.vertex] = slot;
      }
    });
  return slots;
}
}
