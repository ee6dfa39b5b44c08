#include "ShapeDynamicProgram.h"

#include "tautline/Core/Parallel.h"
#include "ShapeEnergy.h"

#include <algorithm>
#include <atomic>

namespace tautline
{
namespace
{
/// Steps of fewer triangles are done by one thread.
constexpr Index SmallStep = 100000;

/// How the cost of a triangle is computed: one function for each set of terms.
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
    for (Index j = 0; j < table.columns; ++j)
    {
      result.row(j)[i] = table.row(i)[j];
    }
  }
  return result;
}

/// The least value of each row of slots, for each row of the table.
PairTable rowMinima(const PairTable& table, const LocationSet& set)
{
  PairTable minima(table.rows, (set.rows + FloatWidth - 1) / FloatWidth * FloatWidth, Unreachable);
  for (Index p = 0; p < table.rows; ++p)
  {
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

float leastOf(const float* values, Index n)
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

bool PlacementSolver::going(double part)
{
  if (!this->Stopped && this->Problem.progress && !this->Problem.progress(part))
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
  for (const PairTable* edge : this->Problem.edges)
  {
    this->Floor += leastOf(edge->values.data(), static_cast<Index>(edge->values.size()));
  }
  for (std::size_t number = 0; number < n; ++number)
  {
    const EliminationStep& e = mesh.elimination[number];
    const Index k = e.vertex, i = e.parents[0], j = e.parents[1];
    this->Steps.push_back({ e, this->take(i, k), this->take(j, k),
      TriangleTerms(mesh.points[i], mesh.points[j], mesh.points[k], this->Problem.energy,
        this->Problem.delta) });
    Step& step = this->Steps.back();
    for (const PairTable* part : { &step.fromI, &step.fromJ })
    {
      this->Floor -= leastOf(part->values.data(), static_cast<Index>(part->values.size()));
    }
    // Rounding must not exclude the best placement itself.
    this->StepLimit =
      static_cast<float>(this->Problem.limit - std::max(0.0, this->Floor) * (1.0 - 1e-5) + 1e-5);
    const std::vector<float>& vertex = this->Problem.vertices[k];
    for (Index p = 0; p < step.fromI.rows && !vertex.empty(); ++p)
    {
      for (Index r = 0; r < step.fromI.columns; ++r)
      {
        step.fromI.row(p)[r] += vertex[r];
      }
    }
    PairTable out(this->Problem.sets[i]->size(), this->Problem.sets[j]->size(), Unreachable);
    this->solveStep(number, step, out);
    if (!this->going(static_cast<double>(number + 1) / static_cast<double>(n)))
    {
      return false;
    }
    if (number + 1 < n)
    {
      const float low = leastOf(out.values.data(), static_cast<Index>(out.values.size()));
      this->Floor += low < Unreachable ? low : 0.0f;
      this->Pending[{ i, j }] = std::move(out);
      continue;
    }
    // What is left is one edge: its own cost, or what lies beyond it, and its vertices' costs.
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

void PlacementSolver::solveRows(std::size_t number, const Step& step, PairTable& out)
{
  const LocationSet &si = *this->Problem.sets[step.elimination.parents[0]],
                    &sj = *this->Problem.sets[step.elimination.parents[1]],
                    &sk = *this->Problem.sets[step.elimination.vertex];
  const PairTable& lengthIJ = this->distances(&si, &sj);
  const PairTable& lengthIK = this->distances(&si, &sk);
  const PairTable& lengthJK = this->distances(&sj, &sk);
  const PairTable minI = rowMinima(step.fromI, sk), minJ = rowMinima(step.fromJ, sk);
  const bool bounds = this->Problem.bounds;
  const float limit = bounds ? this->StepLimit : Unreachable;
  const bool screen = bounds && step.terms.deformation > 0.0f;
  const float inverse = screen ? 1.0f / step.terms.deformation : 0.0f;
  PairTable normJ;
  if (screen)
  {
    normJ = lengthJK;
    for (float& length : normJ.values)
    {
      length *= length * step.terms.weights[2];
    }
  }
  const Index count = static_cast<Index>(si.used.size());
  const double triangles = static_cast<double>(this->Problem.mesh->triangles.size());
  std::atomic<bool> stopped{ false };
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
#pragma omp parallel num_threads( \
  resolveThreads(this->Problem.threads)) if (count * sj.size() * sk.size() > SmallStep)
      {
        std::vector<float> best(static_cast<std::size_t>(sj.size()));
        std::vector<Index> guess(best.size(), 0), tried(best.size(), 0);
        std::vector<BaseEdge> edges;
#pragma omp for schedule(dynamic, 4)
        for (Index at = 0; at < count; ++at)
        {
          if (stopped)
          {
            continue;
          }
          const Index p = si.used[at];
          const float px = si.x[p], py = si.y[p];
          edges.clear();
          for (Index q = 0; q < sj.size(); ++q)
          {
            edges.emplace_back(step.terms, sj.x[q], sj.y[q], px, py, lengthIJ.row(p)[q]);
            best[q] = limit;
          }
          // The best of a packet of places r for vertex k, with q for vertex j.
          const auto visit = [&](Index q, Index row)
          {
            const Index r = row * FloatWidth;
            const FloatPacket parts =
              loadFloats(step.fromI.row(p) + r) + loadFloats(step.fromJ.row(q) + r);
            const float value = least(parts +
              triangleCost<distortion, rotation, mirrored>(step.terms, edges[q],
                loadFloats(sk.x.data() + r) - px, loadFloats(sk.y.data() + r) - py,
                loadFloats(lengthIK.row(p) + r), loadFloats(lengthJK.row(q) + r)));
            if (value < best[q])
            {
              best[q] = value;
              guess[q] = row;
            }
          };
          // The row where the last p found the best comes first; few of the others can beat it.
          const float* rowsI = minI.row(p);
          tried = guess;
          for (Index q : sj.used)
          {
            if (!bounds ||
              rowsI[guess[q]] + minJ.row(q)[guess[q]] + step.terms.bound(edges[q].length) < limit)
            {
              visit(q, tried[q]);
            }
          }
          for (Index row = 0; row < sk.rows; ++row)
          {
            const Index r = row * FloatWidth;
            const FloatPacket rx = loadFloats(sk.x.data() + r) - px;
            const FloatPacket ry = loadFloats(sk.y.data() + r) - py;
            const FloatPacket pr = loadFloats(lengthIK.row(p) + r);
            const FloatPacket normI = step.terms.weights[1] * (pr * pr);
            const FloatPacket partI = loadFloats(step.fromI.row(p) + r);
            for (Index q : sj.used)
            {
              if (row == tried[q])
              {
                continue;
              }
              const float value = best[q] * inverse;
              if (!screen || value > TriangleTerms::MostLog2 ||
                mayStayBelow<mirrored>(edges[q], rx, ry,
                  edges[q].weighted + normI + loadFloats(normJ.row(q) + r),
                  partI + loadFloats(step.fromJ.row(q) + r), value, inverse))
              {
                visit(q, row);
              }
            }
          }
          for (Index q : sj.used)
          {
            out.row(p)[q] = best[q] < limit ? best[q] : Unreachable;
          }
          if (omp_get_thread_num() == 0 && at % 16 == 0 &&
            !this->going(
              (static_cast<double>(number) + static_cast<double>(at) / static_cast<double>(count)) /
              triangles))
          {
            stopped = true;
          }
        }
      }
    });
}

void PlacementSolver::solveGrid(std::size_t number, const Step& step, PairTable& out)
{
  const LocationSet& set = *this->Problem.sets[step.elimination.vertex];
  const Index columns = set.columns, rows = set.rows, width = set.rowLength;
  const PairTable minI = rowMinima(step.fromI, set), minJ = rowMinima(step.fromJ, set);
  const bool bounds = this->Problem.bounds;
  const float limit = bounds ? this->StepLimit : Unreachable;
  const float stepX = static_cast<float>(set.step[0]), stepY = static_cast<float>(set.step[1]);
  // For one offset q - p the cost of the triangle depends on r - p only: a slice of all of them is
  // made once and serves every p. Columns run over r - p from 1 - columns on, padded for whole
  // packets.
  const Index sliceRows = 2 * rows - 1;
  const Index sliceWidth = (2 * columns - 1 + width + FloatWidth) / FloatWidth * FloatWidth;
  const Index offsets = (2 * columns - 1) * sliceRows;
  const double triangles = static_cast<double>(this->Problem.mesh->triangles.size());
  std::atomic<bool> stopped{ false };
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
#pragma omp parallel num_threads(resolveThreads(this->Problem.threads))
      {
        PairTable slice(sliceRows, sliceWidth, 0.0f);
        std::vector<float> sliceMinima(static_cast<std::size_t>(sliceRows), 0.0f);
        std::vector<float> lower(static_cast<std::size_t>(minI.columns));
#pragma omp for schedule(dynamic, 8)
        for (Index offset = 0; offset < offsets; ++offset)
        {
          if (stopped)
          {
            continue;
          }
          const Index dx = offset % (2 * columns - 1) - (columns - 1);
          const Index dy = offset / (2 * columns - 1) - (rows - 1);
          const float bx = stepX * static_cast<float>(dx), by = stepY * static_cast<float>(dy);
          const BaseEdge base(step.terms, bx, by, 0.0f, 0.0f, std::sqrt(bx * bx + by * by));
          if (bounds && step.terms.bound(base.length) >= limit)
          {
            continue;
          }
          for (Index row = 0; row < sliceRows; ++row)
          {
            const float y = stepY * static_cast<float>(row - (rows - 1));
            FloatPacket low = broadcast(Unreachable);
            for (Index c = 0; c < sliceWidth; c += FloatWidth)
            {
              FloatPacket x;
              for (int l = 0; l < FloatWidth; ++l)
              {
                x[l] = static_cast<float>(std::min(c + l, 2 * columns - 2) - (columns - 1));
              }
              x *= stepX;
              const FloatPacket fromQx = x - bx, ry = broadcast(y);
              const float fromQy = y - by;
              const FloatPacket cost = triangleCost<distortion, rotation, mirrored>(step.terms,
                base, x, ry, sqrt(x * x + y * y), sqrt(fromQx * fromQx + fromQy * fromQy));
              storeFloats(slice.row(row) + c, cost);
              low = min(low, cost);
            }
            sliceMinima[row] = least(low);
          }
          Index guess = 0;
          for (Index py = std::max<Index>(0, -dy); py < std::min(rows, rows - dy); ++py)
          {
            for (Index px = std::max<Index>(0, -dx); px < std::min(columns, columns - dx); ++px)
            {
              const Index p = py * width + px, q = (py + dy) * width + px + dx;
              const float *partI = step.fromI.row(p), *partJ = step.fromJ.row(q);
              const float* costs = slice.row(rows - 1 - py) + columns - 1 - px;
              float best = limit;
              const auto visit = [&](Index row)
              {
                FloatPacket low = broadcast(Unreachable);
                for (Index c = 0; c < width; c += FloatWidth)
                {
                  const FloatPacket parts =
                    loadFloats(partI + row * width + c) + loadFloats(partJ + row * width + c);
                  low = min(low, loadFloats(costs + row * sliceWidth + c) + parts);
                }
                const float value = least(low);
                if (value < best)
                {
                  best = value;
                  guess = row;
                }
              };
              if (!bounds)
              {
                for (Index row = 0; row < rows; ++row)
                {
                  visit(row);
                }
              }
              else
              {
                // A row whose three least parts together are no better than what is found is
                // skipped.
                const float *rowsI = minI.row(p), *rowsJ = minJ.row(q);
                const float* rowsCost = sliceMinima.data() + rows - 1 - py;
                for (Index row = 0; row < rows; ++row)
                {
                  lower[row] = rowsI[row] + rowsJ[row] + rowsCost[row];
                }
                const Index first = guess;
                if (lower[first] < best)
                {
                  visit(first);
                }
                for (Index row = 0; row < rows; ++row)
                {
                  if (lower[row] < best && row != first)
                  {
                    visit(row);
                  }
                }
              }
              out.row(p)[q] = best < limit ? best : Unreachable;
            }
          }
          if (omp_get_thread_num() == 0 && offset % 32 == 0 &&
            !this->going((static_cast<double>(number) +
                           static_cast<double>(offset) / static_cast<double>(offsets)) /
              triangles))
          {
            stopped = true;
          }
        }
      }
    });
}

std::vector<Index> PlacementSolver::trace(Index p, Index q) const
{
  std::vector<Index> slots(this->Problem.mesh->points.size(), 0);
  const EliminationStep& last = this->Steps.back().elimination;
  slots[last.parents[0]] = p;
  slots[last.parents[1]] = q;
  dispatch(this->Problem.energy,
    [&](auto distortion, auto rotation, auto mirrored)
    {
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
