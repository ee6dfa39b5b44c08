// SPDX-License-Identifier: BSD-3-Clause
#include "VertexOptimizer.h"

#include "InvariantFunction.h"
#include "tautline/Core/LineSearch.h"
#include "tautline/Mesh/JacobianBounds.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
constexpr int maximumHalvings = 12;
/// The largest step as a fraction of the distance to the first inversion.
constexpr double safety = 0.9;
/// For changes above this fraction of an objective, the scalarization itself is used instead of its
/// slope.
constexpr double visibleChange = 1e-6;
}

//------------------------------------------------------------------------------
template <int Dim>
VertexOptimizer<Dim>::VertexOptimizer(SimplexMesh& simplices, const Mesh& mesh, double* points,
  const std::vector<LocalTerm>& terms, const LocalOptions& options)
  : Simplices(simplices)
  , TheMesh(mesh)
  , Points(points)
  , Options(options)
{
  // Metrics read all points of the cells; energies of simplices only read their patch.
  for (const LocalTerm& term : terms)
  {
    this->Functions.push_back(this->makeFunction(term));
    this->NeedsCells = this->NeedsCells || this->Functions.back()->needsCells();
    this->Guarded =
      this->Guarded || this->NeedsCells || term.sizeSquared > 0 || term.invariantScale > 0;
  }
  this->Inside = !options.allowInversion &&
    std::any_of(mesh.blocks().begin(), mesh.blocks().end(),
      [](const CellBlock& block) { return hasInside(block.type); });
  if (this->Inside)
  {
    this->NeedsCells = true;
    this->Validities.resize(mesh.view().numberOfCells);
    mesh.classifyCells(this->Validities.data(), options.threads);
  }
  if (this->NeedsCells)
  {
    this->Cells = mesh.vertexCells();
  }
  this->Guarded = this->Guarded && !options.allowInversion;
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::begin(const std::vector<double>& values)
{
  this->Values = values;
  for (std::size_t i = 0; i < this->Functions.size(); ++i)
  {
    this->Functions[i]->setCurrent(values[i]);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
PatchWorker<Dim> VertexOptimizer<Dim>::makeWorker() const
{
  PatchWorker<Dim> w;
  const std::size_t n = this->Functions.size();
  w.sums.resize(n);
  w.trial.assign(n, 0.0);
  w.now = this->Values;
  w.slopes.assign(n, 1.0);
  return w;
}

//------------------------------------------------------------------------------
template <int Dim>
std::unique_ptr<PatchFunction<Dim>> VertexOptimizer<Dim>::makeFunction(const LocalTerm& term) const
{
  if (term.worst > 0)
  {
    using Energy = WorstRatioEnergy<Dim>;
    return std::make_unique<EnergyFunction<Dim, Energy>>(Energy{ 1.0 / term.worst });
  }
  if (term.shapePower == 1)
  {
    using Energy = InverseMeanRatioEnergy<Dim, 1>;
    return std::make_unique<EnergyFunction<Dim, Energy>>(Energy());
  }
  if (term.shapePower == 2)
  {
    using Energy = InverseMeanRatioEnergy<Dim, 2>;
    return std::make_unique<EnergyFunction<Dim, Energy>>(Energy());
  }
  if (term.sizeSquared > 0)
  {
    using Energy = SizeSquaredEnergy<Dim>;
    return std::make_unique<EnergyFunction<Dim, Energy>>(Energy{ term.sizeSquared });
  }
  if (term.invariantScale > 0)
  {
    return std::make_unique<InvariantFunction<Dim>>(term.metric->state(), term.invariantScale);
  }
  return std::make_unique<MetricFunction<Dim>>(term.metric->state());
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::gather(std::int32_t v, VertexPatch<Dim>& patch) const
{
  patch.vertex = v;
  const double* weights = this->Options.weights.empty() ? nullptr : this->Options.weights.data();
  if (Dim == 2 && this->Simplices.surface())
  {
    Vec3 tangents[2];
    this->findTangents(v, tangents);
    gatherPatch<Dim>(this->Simplices, this->Simplices.coordinates(), v, weights, patch.simplices,
      tangents, this->isOnCurve(v));
    for (int c = 0; c < Dim; ++c)
    {
      patch.axes[c] = this->Simplices.scale() * tangents[c];
    }
  }
  else
  {
    gatherPatch<Dim>(this->Simplices, this->Simplices.coordinates(), v, weights, patch.simplices);
    for (int c = 0; c < Dim; ++c)
    {
      patch.axes[c] = this->Simplices.axis(c);
    }
  }
  if (this->NeedsCells)
  {
    this->gatherCells(v, patch);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::gatherCells(std::int32_t v, VertexPatch<Dim>& patch) const
{
  const MeshView& view = this->TheMesh.view();
  const Index point = this->Simplices.point(v);
  const auto begin = this->Cells.cells.begin() + this->Cells.offsets[point];
  const auto end = this->Cells.cells.begin() + this->Cells.offsets[point + 1];
  const bool mirrored = this->TheMesh.mirrored() && this->TheMesh.dimension() == Dimension::Volume;
  const auto& blocks = this->TheMesh.blocks();
  patch.cellBatches = 0;
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b)
  {
    // The cells of one type at the vertex, in batches.
    const CellTopology& t = topology(blocks[b].type);
    for (auto c = begin; c != end;)
    {
      if (static_cast<std::size_t>(patch.cellBatches) == patch.cells.size())
      {
        patch.cells.emplace_back();
      }
      CellBatch& batch = patch.cells[patch.cellBatches];
      batch.block = b;
      int& count = batch.batch.count = 0;
      for (; c != end && count < PacketWidth; ++c)
      {
        if (blocks.size() == 1 || cornerType(view.cellTypes[*c]) == blocks[b].type)
        {
          batch.batch.cells[count++] = *c;
        }
      }
      if (count == 0)
      {
        break;
      }
      ++patch.cellBatches;
      const Index* nodes[PacketWidth];
      for (int l = 0; l < PacketWidth; ++l)
      {
        const Index cell = batch.batch.cells[l] = batch.batch.cells[std::min(l, count - 1)];
        nodes[l] = view.connectivity + view.offsets[cell];
      }
      for (int k = 0; k < t.nodes; ++k)
      {
        const double* p[PacketWidth];
        for (int l = 0; l < PacketWidth; ++l)
        {
          p[l] = this->Points + 3 * nodes[l][k];
          batch.here[k][l] = nodes[l][k] == point ? 1.0 : 0.0;
        }
        loadPoints(p, batch.batch.points[k]);
        batch.batch.points[k][0] =
          mirrored ? Packet(-batch.batch.points[k][0]) : batch.batch.points[k][0];
      }
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
bool VertexOptimizer<Dim>::evaluate(PatchWorker<Dim>& w, const double* d, bool hessian) const
{
  for (std::size_t i = 0; i < this->Functions.size(); ++i)
  {
    w.sums[i] = this->Functions[i]->sum(w.patch, d, hessian);
    if (!std::isfinite(w.sums[i].f))
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::findSlopes(const Scalarizer& scalarizer, PatchWorker<Dim>& w) const
{
  const std::size_t n = this->Functions.size();
  if (n == 1) // every scalarization of a single objective is monotonic
  {
    w.slopes[0] = 1.0;
    return;
  }
  if (scalarizer.onPatches())
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      w.now[i] = w.sums[i].f;
    }
    scalarizer.value(w.now, w.slopes);
    return;
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    w.now[i] = this->Functions[i]->objective(this->Values[i], w.change[i]);
  }
  scalarizer.value(w.now, w.slopes);
  for (std::size_t i = 0; i < n; ++i)
  {
    w.slopes[i] *= this->Functions[i]->slope(this->Values[i]);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
PatchSum<Dim> VertexOptimizer<Dim>::combined(const PatchWorker<Dim>& w) const
{
  PatchSum<Dim> sum = {};
  for (std::size_t i = 0; i < this->Functions.size(); ++i)
  {
    sum.f += w.slopes[i] * w.sums[i].f;
    for (int r = 0; r < Dim; ++r)
    {
      sum.g[r] += w.slopes[i] * w.sums[i].g[r];
      for (int c = 0; c < Dim; ++c)
      {
        sum.H[r][c] += w.slopes[i] * w.sums[i].H[r][c];
      }
    }
  }
  return sum;
}

//------------------------------------------------------------------------------
/// The change of the scalarized objective if the vertex moves to d; w.trial receives the changes of
/// the patch sums.
template <int Dim>
double VertexOptimizer<Dim>::changeAt(
  const Scalarizer& scalarizer, PatchWorker<Dim>& w, const double* d) const
{
  const std::size_t n = this->Functions.size();
  double linear = 0;
  bool visible = false;
  for (std::size_t i = 0; i < n; ++i)
  {
    w.trial[i] = this->Functions[i]->value(w.patch, d) - w.sums[i].f;
    linear += w.slopes[i] * w.trial[i];
    const double size = std::abs(scalarizer.onPatches() ? w.now[i] : this->Values[i]);
    visible = visible || !(std::abs(w.trial[i]) <= visibleChange * size);
  }
  if (n == 1 || !visible || !std::isfinite(linear))
  {
    return std::isnan(linear) ? std::numeric_limits<double>::infinity() : linear;
  }
  // Differences of the whole objective lose digits; they are only used if enough remain.
  const double before = scalarizer.value(w.now);
  std::vector<double>& after = w.now;
  std::vector<double> kept = w.now;
  for (std::size_t i = 0; i < n; ++i)
  {
    after[i] = scalarizer.onPatches()
      ? kept[i] + w.trial[i]
      : this->Functions[i]->objective(this->Values[i], w.change[i] + w.trial[i]);
  }
  const double change = scalarizer.value(after) - before;
  w.now = kept;
  return change;
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::newton(
  const PatchWorker<Dim>& w, const PatchSum<Dim>& sum, double* s) const
{
  double basis[Dim][Dim] = {};
  const int free = this->allowed(w.patch.vertex, basis);
  if (free == Dim)
  {
    newtonDirection<Dim>(sum, s);
    return;
  }
  this->newtonIn(basis, free, sum, s);
}

/// The same in a subspace, with the unit matrix in the rest.
template <int Dim>
void VertexOptimizer<Dim>::newtonIn(
  const double basis[Dim][Dim], int free, const PatchSum<Dim>& sum, double* s) const
{
  PatchSum<Dim> part = {};
  for (int i = 0; i < Dim; ++i)
  {
    part.H[i][i] = i < free ? 0.0 : sum.H[0][0] + sum.H[Dim - 1][Dim - 1];
    for (int r = 0; r < Dim && i < free; ++r)
    {
      part.g[i] += basis[r][i] * sum.g[r];
      for (int c = 0; c < Dim; ++c)
      {
        for (int j = 0; j < free; ++j)
        {
          part.H[i][j] += basis[r][i] * sum.H[r][c] * basis[c][j];
        }
      }
    }
  }
  double inPart[Dim];
  newtonDirection<Dim>(part, inPart);
  for (int r = 0; r < Dim; ++r)
  {
    s[r] = 0;
    for (int i = 0; i < free; ++i)
    {
      s[r] += basis[r][i] * inPart[i];
    }
  }
}

//------------------------------------------------------------------------------
/// Updates `direction` by Polak-Ribiere+ and returns the step at which the slope would vanish,
/// extrapolated from a small step; 0 if no step is possible.
template <int Dim>
double VertexOptimizer<Dim>::conjugate(PatchWorker<Dim>& w, const PatchSum<Dim>& sum,
  const double* d, int iteration, double* direction, double* lastGradient) const
{
  double mixed = 0, last2 = 0, length2 = 0;
  for (int c = 0; c < Dim; ++c)
  {
    mixed += sum.g[c] * (sum.g[c] - lastGradient[c]);
    last2 += lastGradient[c] * lastGradient[c];
  }
  const double beta = iteration > 0 && last2 > 0 ? std::max(0.0, mixed / last2) : 0.0;
  double basis[Dim][Dim] = {};
  const int free = this->allowed(w.patch.vertex, basis);
  // The negative gradient in the allowed directions, plus a multiple of the last direction.
  for (int r = 0; r < Dim; ++r)
  {
    double projected = free == Dim ? -sum.g[r] : 0.0;
    for (int i = 0; i < free && free < Dim; ++i)
    {
      for (int c = 0; c < Dim; ++c)
      {
        projected -= basis[r][i] * basis[c][i] * sum.g[c];
      }
    }
    direction[r] = projected + beta * direction[r];
    lastGradient[r] = sum.g[r];
    length2 += direction[r] * direction[r];
  }
  if (!(length2 > 0))
  {
    return 0.0;
  }
  constexpr double fraction = 1e-4;
  const double h = fraction * sizeOf(w.patch.simplices) / std::sqrt(length2);
  double probe[Dim], slopeHere = 0, slopeThere = 0;
  for (int c = 0; c < Dim; ++c)
  {
    probe[c] = d[c] + h * direction[c];
    slopeHere += direction[c] * sum.g[c];
  }
  // A second gradient a small step along the direction gives the curvature.
  const std::vector<PatchSum<Dim>> kept = w.sums;
  const bool good = this->evaluate(w, probe, false);
  const PatchSum<Dim> there = good ? this->combined(w) : PatchSum<Dim>{};
  w.sums = kept;
  for (int c = 0; c < Dim; ++c)
  {
    slopeThere += direction[c] * there.g[c];
  }
  const double curvature = (slopeThere - slopeHere) / h;
  return good && curvature > 0 ? -slopeHere / curvature : h / fraction;
}

//------------------------------------------------------------------------------
/// Halves the step t until the objective decreases sufficiently; `to` is then the resulting
/// displacement.
/// @param alongLimit whether the vertex is moved back to its limit
template <int Dim>
bool VertexOptimizer<Dim>::search(const Scalarizer& scalarizer, PatchWorker<Dim>& w,
  const double* d, const double* direction, double t, double slope, bool alongLimit, double* to)
{
  for (int halving = 0; halving < maximumHalvings && t > 0; ++halving, t *= 0.5)
  {
    for (int c = 0; c < Dim; ++c)
    {
      to[c] = d[c] + t * direction[c];
    }
    if (alongLimit)
    {
      this->keepLimit(w.patch.vertex, to);
    }
    if (this->changeAt(scalarizer, w, to) <= ArmijoConstant * t * slope &&
      (!this->Guarded || staysValid<Dim>(w.patch.simplices, d, to)) &&
      this->staysValidInside(w.patch, to))
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// Whether the fully valid cells are still valid if the vertex is displaced by d.
template <int Dim>
bool VertexOptimizer<Dim>::staysValidInside(const VertexPatch<Dim>& patch, const double* d) const
{
  Vec3 shift = { 0, 0, 0 };
  for (int c = 0; c < Dim; ++c)
  {
    shift += d[c] * patch.axes[c];
  }
  const bool mirrored = this->TheMesh.mirrored();
  for (int i = 0; this->Inside && i < patch.cellBatches; ++i)
  {
    const CellBatch& cells = patch.cells[i];
    const CellTopology& t = topology(this->TheMesh.blocks()[cells.block].type);
    if (!hasInside(t.type))
    {
      continue;
    }
    CellVertices moved;
    for (int k = 0; k < t.nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double by = mirrored && c == 0 ? -shift[c] : shift[c];
        moved.points[k][c] = cells.batch.points[k][c] + by * cells.here[k];
      }
    }
    const Mask clear = clearlyValidCells(this->TheMesh, t, moved);
    for (int l = 0; l < cells.batch.count; ++l)
    {
      if (clear[l] || this->Validities[cells.batch.cells[l]] != Valid)
      {
        continue;
      }
      Vec3 p[MaxNodes];
      for (int k = 0; k < t.nodes; ++k)
      {
        p[k] = { (mirrored ? -1.0 : 1.0) * moved.points[k][0][l], moved.points[k][1][l],
          moved.points[k][2][l] };
      }
      if (this->TheMesh.classifyCell(t, p) != Valid)
      {
        return false;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Moves v by d, and back to the surface if it is on one; returns whether it moved far enough to
/// stay active.
template <int Dim>
bool VertexOptimizer<Dim>::placeMoved(
  std::int32_t v, const double* d, const Scalarizer& scalarizer, PatchWorker<Dim>& w)
{
  const double size = sizeOf(w.patch.simplices);
  double d2 = 0;
  for (int c = 0; c < Dim; ++c)
  {
    d2 += d[c] * d[c];
  }
  if (this->isOnSurface(v))
  {
    if (!this->placeOnSurface(v, d, scalarizer, w))
    {
      return false;
    }
  }
  else
  {
    Vec3 x = { 0, 0, 0 };
    for (int c = 0; c < Dim; ++c)
    {
      x[c] = this->Simplices.coordinates()[VertexStride * static_cast<std::size_t>(v) + c] + d[c];
    }
    this->place(v, x);
  }
  return std::sqrt(d2) > this->Options.culling * size;
}

//------------------------------------------------------------------------------
template <int Dim>
bool VertexOptimizer<Dim>::moveVertex(
  std::int32_t v, const Scalarizer& scalarizer, PatchWorker<Dim>& w, double& gradient2)
{
  this->gather(v, w.patch);
  double d[Dim] = {}, direction[Dim] = {}, lastGradient[Dim] = {};
  std::vector<double>& change = w.change;
  bool moved = false;
  for (int iteration = 0; iteration < this->Options.patchIterations; ++iteration)
  {
    if (!this->evaluate(w, d, this->Options.newton))
    {
      break; // beyond the barrier, which only happens for inverted elements of the input
    }
    this->findSlopes(scalarizer, w);
    const PatchSum<Dim> sum = this->combined(w);
    double norm2 = 0;
    for (int c = 0; c < Dim; ++c)
    {
      norm2 += sum.g[c] * sum.g[c];
    }
    gradient2 += iteration == 0 ? norm2 : 0.0;
    if (!(norm2 > 0) || !std::isfinite(norm2))
    {
      break;
    }

    double t = this->Options.relaxation;
    if (this->Options.newton)
    {
      this->newton(w, sum, direction);
    }
    else
    {
      t = this->conjugate(w, sum, d, iteration, direction, lastGradient);
    }

    const bool alongLimit = this->turnAlongLimit(w, sum, d, direction);
    double slope = 0, s2 = 0;
    for (int c = 0; c < Dim; ++c)
    {
      slope += direction[c] * sum.g[c];
      s2 += direction[c] * direction[c];
    }
    if (!(slope < 0) || !std::isfinite(s2))
    {
      break;
    }
    if (!this->Options.allowInversion)
    {
      t = std::min(t, safety * stepToInversion<Dim>(w.patch.simplices, d, direction));
    }
    t = alongLimit ? t : this->limited(v, d, direction, t);
    double to[Dim];
    if (!this->search(scalarizer, w, d, direction, t, slope, alongLimit, to))
    {
      break;
    }
    std::copy_n(to, Dim, d);
    moved = true;
    if (!this->isOnSurface(v))
    {
      for (std::size_t i = 0; i < change.size(); ++i)
      {
        change[i] += w.trial[i];
      }
    }
  }
  if (!moved)
  {
    return false;
  }
  return this->placeMoved(v, d, scalarizer, w);
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::place(std::int32_t v, const Vec3& x)
{
  double* at = this->Simplices.coordinates() + VertexStride * static_cast<std::size_t>(v);
  std::copy(x.begin(), x.end(), at);
  if (this->NeedsCells)
  {
    this->Simplices.storeVertex(
      at, this->Points + 3 * static_cast<std::size_t>(this->Simplices.point(v)));
  }
}

template class VertexOptimizer<2>;
template class VertexOptimizer<3>;
}
