// SPDX-License-Identifier: BSD-3-Clause
#include "Peridynamics.h"

#include "Dilatation.h"
#include "PeridynamicsKernel.h"
#include "PeridynamicsRanks.h"
#include "TriangleAssembler.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr Index SampledRows = 200; // used for the memory estimate
// Fraction of the progress at which the bonds of the state-based model are in the matrix.
constexpr double StateBasedShare = 0.7;

std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

void checkOptions(const PeridynamicOptions& o)
{
  if (!(o.horizon > 0.0) || !std::isfinite(o.horizon))
  {
    throw Error("the horizon is " + number(o.horizon) + "; it must be above 0");
  }
  if (!(o.tolerance >= 1e-10) || !(o.tolerance <= 0.1))
  {
    throw Error("the tolerance is " + number(o.tolerance) + "; it must be from 1e-10 to 0.1");
  }
  if (o.model == PeridynamicModel::StateBased)
  {
    if (!(o.poissonRatio > -1.0) || !(o.poissonRatio < 0.5))
    {
      throw Error(
        "Poisson's ratio is " + number(o.poissonRatio) + "; it must be above -1 and below 0.5");
    }
    if (o.discretization != Discretization::Exact)
    {
      throw Error(
        "the rules of the dissertation are for bond-based models; use the exact discretization "
        "for the state-based model");
    }
  }
  const KernelFunction& k = o.kernel;
  const double limit = singularLimit(o.basis, o.model);
  if (k.shape == KernelShape::Power && !(k.exponent >= 0.0 && k.exponent < limit))
  {
    throw Error("the exponent p is " + number(k.exponent) +
      "; with this basis it must be from 0 to below " + number(limit) +
      ", where the integrals become infinite" +
      (o.basis == PeridynamicBasis::Linear ? "" : " (the linear basis allows more)"));
  }
  if (k.shape == KernelShape::Gaussian && !(k.width > 0.0 && std::isfinite(k.width)))
  {
    throw Error("the width of the Gaussian is " + number(k.width) + "; it must be above 0");
  }
  if (k.shape == KernelShape::Table)
  {
    bool positive = false;
    for (const double v : k.table)
    {
      if (!std::isfinite(v) || v < 0.0)
      {
        throw Error("the tabulated kernel has values that are negative or not finite");
      }
      positive = positive || v > 0.0;
    }
    if (k.table.size() < 2 || !positive)
    {
      throw Error("the tabulated kernel needs two or more values, not all of them 0");
    }
  }
}

/// A horizon far larger than the mesh is in another unit; the quadrature would not terminate.
void checkHorizon(const HorizonMesh& mesh, double horizon)
{
  constexpr double MostExtents = 1e6;
  double low[] = { INFINITY, INFINITY }, high[] = { -INFINITY, -INFINITY };
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    low[i % 2] = std::min(low[i % 2], mesh.points[i]);
    high[i % 2] = std::max(high[i % 2], mesh.points[i]);
  }
  const double extent = std::max(high[0] - low[0], high[1] - low[1]);
  if (horizon > MostExtents * extent)
  {
    throw Error("the horizon is " + number(horizon) + " but the mesh extends over " +
      number(extent) + " only: specify the horizon in mesh units");
  }
}

/// Colors triangles so that triangles of one color share no function; each color in increasing
/// order.
std::vector<std::vector<std::int32_t>> colourTriangles(
  const PlanarTriangles& triangles, const FunctionSpace& space, const std::vector<char>& needed)
{
  std::vector<std::vector<std::int32_t>> colours;
  // Functions of one triangle are never shared, so a single color suffices.
  if (space.basis != PeridynamicBasis::Linear)
  {
    colours.emplace_back();
    for (Index t = 0; t < triangles.size(); ++t)
    {
      if (needed[t])
      {
        colours[0].push_back(static_cast<std::int32_t>(t));
      }
    }
    return colours;
  }
  // Greedy: use the first color whose triangles share no vertex with this one.
  std::vector<std::vector<char>> used; // per color and vertex
  for (Index t = 0; t < triangles.size(); ++t)
  {
    if (!needed[t])
    {
      continue;
    }
    std::size_t colour = 0;
    const auto& ids = triangles.triangles[t];
    while (colour < used.size() &&
      (used[colour][ids[0]] || used[colour][ids[1]] || used[colour][ids[2]]))
    {
      ++colour;
    }
    if (colour == used.size())
    {
      used.emplace_back(triangles.points.size(), 0);
      colours.emplace_back();
    }
    for (const std::int32_t id : ids)
    {
      used[colour][id] = 1;
    }
    colours[colour].push_back(static_cast<std::int32_t>(t));
  }
  return colours;
}

/// The unknown functions near an unknown one, including itself, in increasing order of unknowns.
void neighbours(const FunctionSpace& space, const BoxGrid& supports, double horizon, Index unknown,
  std::vector<std::int32_t>& found)
{
  const Index f = space.functionOf[unknown];
  supports.near(space.low[f], space.high[f], horizon, found);
  std::size_t kept = 0;
  for (const std::int32_t g : found)
  {
    if (space.unknownOf[g] >= 0)
    {
      found[kept++] = static_cast<std::int32_t>(space.unknownOf[g]);
    }
  }
  found.resize(kept);
  std::sort(found.begin(), found.end());
}

double bytesFor(const HorizonMesh& mesh, const FunctionSpace& space, const BoxGrid& supports,
  const PeridynamicOptions& options)
{
  // The mean length of some rows, evenly spread.
  const Index sampled = std::min(space.unknowns, SampledRows);
  std::vector<std::int32_t> found;
  double entries = 0.0;
  for (Index s = 0; s < sampled; ++s)
  {
    neighbours(space, supports, interactionReach(options), s * space.unknowns / sampled, found);
    entries += static_cast<double>(found.size());
  }
  const double c = isElastic(options.model) ? 2.0 : 1.0;
  const double nonzeros =
    c * c * entries / static_cast<double>(sampled) * static_cast<double>(space.unknowns);
  // Values twice, because they are mirrored once; columns; the mesh with its boxes and grid; sums
  // per thread; integrals of touching pairs, about thirteen per triangle.
  const double triangles = static_cast<double>(mesh.numberOfTriangles());
  const double perEntry = 2.0 * sizeof(double) + sizeof(std::int32_t);
  const double sums = 3.0 * c * c * sizeof(double) * static_cast<double>(space.functions) *
    resolveThreads(options.threads);
  const double perPair = options.discretization == Discretization::Exact
    ? 4.0 * c * c * space.perTriangle() * space.perTriangle() * sizeof(double)
    : 0.0;
  return perEntry * nonzeros + (300.0 + 6.5 * perPair) * triangles + sums;
}

void checkMemory(double needed, const PeridynamicOptions& options)
{
  constexpr double share = 0.9; // the rest is for the solver and the output
  requireMemory(needed, "the matrix",
    "use a smaller horizon, larger elements or a piecewise linear basis, or raise the limit",
    options.memoryLimit > 0.0 ? options.memoryLimit : std::max(1.0, share * availableMemory()));
}

void checkLayer(const HorizonMesh& mesh, const PeridynamicOptions& options, double deficit)
{
  if (!options.constrained || options.allowThinLayer || deficit == 0.0)
  {
    return;
  }
  const bool none =
    std::all_of(mesh.layer.begin(), mesh.layer.end(), [](unsigned char c) { return c == 0; });
  const double reach = interactionReach(options);
  const std::string twice = options.model == PeridynamicModel::StateBased
    ? " (twice the horizon for the state-based model)"
    : "";
  throw Error(none ? "the mesh has no interaction layer; one of width " + number(reach) + twice +
        " around the domain is needed: add it with Interaction Layer"
                   : "the interaction layer is " + number(reach - deficit) +
        " wide and the horizon is " + number(options.horizon) + ": an interaction layer of width " +
        number(reach) + twice + " is needed (Interaction Layer makes it), or allow a thin one");
}

/// Time limit, observer and progress of an assembly; the first reason to stop is kept. For the
/// calling thread only.
class AssemblyControl
{
public:
  AssemblyControl(const PeridynamicOptions& options, double first, double last)
    : Options(options)
    , First(first)
    , Last(last)
  {
  }
  /// Reports the fraction done; false if the work must stop.
  bool proceed(double fraction)
  {
    if (this->Time.reached(this->Options.timeLimit))
    {
      this->Reason = "the time limit of " + number(this->Options.timeLimit) +
        " s is reached; use a smaller horizon, larger elements or a longer limit";
    }
    else if (this->Options.progress &&
      !this->Options.progress(this->First + (this->Last - this->First) * fraction))
    {
      this->Reason = "stopped by the user";
    }
    return this->Reason.empty();
  }
  void throwIfStopped() const
  {
    if (!this->Reason.empty())
    {
      throw Error(this->Reason);
    }
  }
  void setRange(double first, double last)
  {
    this->First = first;
    this->Last = last;
  }

private:
  const PeridynamicOptions& Options;
  double First, Last;
  std::string Reason;
  Stopwatch Time;
};

/// @param rows per unknown: whether its rows are needed; the others are empty
SparseMatrix makePattern(const FunctionSpace& space, const std::vector<char>& rows,
  const BoxGrid& supports, double horizon, Index components, int threads)
{
  SparseMatrix pattern;
  pattern.size = space.unknowns * components;
  std::vector<Index> counts(space.unknowns, 0);
  constexpr Index grain = 64;
  ScratchPool<std::vector<std::int32_t>> lists;
  // First pass: count the entries of the rows; second pass: fill their columns.
  for (const bool fill : { false, true })
  {
    parallelFor(space.unknowns, grain, threads, lists,
      [&](std::vector<std::int32_t>& found, Index row)
      {
        if (!rows[row])
        {
          return;
        }
        neighbours(space, supports, horizon, row, found);
        counts[row] = static_cast<Index>(found.size());
        for (Index c = 0; fill && c < components; ++c)
        {
          std::int32_t* to = pattern.columns.data() + pattern.offsets[row * components + c];
          for (const std::int32_t f : found)
          {
            for (Index d = 0; d < components; ++d)
            {
              *to++ = static_cast<std::int32_t>(f * components + d);
            }
          }
        }
      });
    if (!fill)
    {
      pattern.offsets.assign(pattern.size + 1, 0);
      for (Index i = 0; i < pattern.size; ++i)
      {
        pattern.offsets[i + 1] = pattern.offsets[i] + components * counts[i / components];
      }
      pattern.columns.resize(pattern.offsets.back());
      pattern.values.assign(pattern.offsets.back(), 0.0);
    }
  }
  return pattern;
}

/// Moves the sums of the functions of a triangle to their rows. @param rows per unknown: whether
/// its rows are needed
void flush(const PeridynamicWork& work, const std::vector<char>& rows, Index t,
  const std::vector<std::int32_t>& near, RowSums& sums, double scale,
  const std::vector<double>* given, PeridynamicSystem& system)
{
  const FunctionSpace& space = work.space;
  const int functions = space.perTriangle();
  const auto c = static_cast<int>(system.components);
  SparseMatrix& matrix = system.matrix;
  for (int a = 0; a < functions; ++a)
  {
    const Index row = space.unknownOf[space.function(work.triangles, t, a)];
    if (row < 0 || !rows[row])
    {
      continue;
    }
    for (int i = 0; i < c; ++i)
    {
      const Index begin = matrix.offsets[row * c + i], end = matrix.offsets[row * c + i + 1];
      for (Index k = begin; k < end; k += c)
      {
        const double* from = sums.at(a, space.functionOf[matrix.columns[k] / c]) + i * c;
        for (int j = 0; j < c; ++j)
        {
          matrix.values[k + j] += scale * from[j];
        }
      }
    }
  }
  // Move the parts of given functions to the load; then reset the sums to 0.
  for (const std::int32_t other : near)
  {
    for (int b = 0; b < functions; ++b)
    {
      const Index f = space.function(work.triangles, other, b);
      for (int a = 0; a < functions; ++a)
      {
        double* from = sums.at(a, f);
        const Index row = space.unknownOf[space.function(work.triangles, t, a)];
        const bool counts = given && row >= 0 && rows[row] && space.unknownOf[f] < 0;
        for (int i = 0; counts && i < c; ++i)
        {
          for (int j = 0; j < c; ++j)
          {
            system.constraintLoad[row * c + i] += scale * from[i * c + j] * (*given)[f * c + j];
          }
        }
        std::fill(from, from + c * c, 0.0);
      }
    }
  }
}

void checkDiagonal(const PeridynamicSystem& system)
{
  for (Index row = 0; row < system.matrix.size; ++row)
  {
    const double diagonal = system.matrix.at(row, row);
    if (!std::isfinite(diagonal))
    {
      throw Error("the matrix has an entry that is not finite, in row " + std::to_string(row));
    }
    if (diagonal == 0.0)
    {
      throw Error("row " + std::to_string(row) +
        " of the matrix is empty: the horizon is smaller than the elements, and the rules of "
        "the dissertation find no neighbor; use the exact discretization, a larger horizon or "
        "smaller elements");
    }
  }
}
}

//------------------------------------------------------------------------------
double estimatePeridynamicMemory(const HorizonMesh& mesh, const PeridynamicOptions& options)
{
  checkOptions(options);
  const PlanarTriangles triangles(mesh);
  const FunctionSpace space(mesh, triangles, options);
  const BoxGrid supports(space.low, space.high);
  return bytesFor(mesh, space, supports, options);
}

//------------------------------------------------------------------------------
namespace
{
/// The number of slices of a color, and of the pairs, after which ranks check whether one of them
/// has stopped.
constexpr Index SlicesOnRanks = 32;

/// Performs all checks before the expensive part, and sets the resulting members of the system.
/// @param share fraction of the matrix for which this rank needs memory, at most 1
void checkAssembly(const HorizonMesh& mesh, const PeridynamicOptions& options,
  const std::vector<double>* given, double share, PeridynamicSystem& system)
{
  checkOptions(options);
  const PlanarTriangles triangles(mesh);
  checkHorizon(mesh, options.horizon);
  system.components = isElastic(options.model) ? 2 : 1;
  system.layerDeficit =
    options.constrained ? layerDeficit(mesh, interactionReach(options), options.threads) : 0.0;
  checkLayer(mesh, options, system.layerDeficit);
  const FunctionSpace space(mesh, triangles, options);
  if (given && static_cast<Index>(given->size()) != space.functions * system.components)
  {
    throw Error("the given solution has " + std::to_string(given->size()) + " values; " +
      std::to_string(space.functions * system.components) + " are expected");
  }
  system.memory = bytesFor(mesh, space, BoxGrid(space.low, space.high), options);
  checkMemory(share * system.memory, options);
}

/// The data of an assembly.
struct AssemblyParts
{
  AssemblyParts(const HorizonMesh& mesh, const PeridynamicOptions& options)
    : triangles(sorted(mesh))
    , space(mesh, triangles, options)
    , grid(triangles.low, triangles.high)
    , supports(space.low, space.high)
    , cut(triangles, options.horizon, options.cutBonds)
  {
  }

  static PlanarTriangles sorted(const HorizonMesh& mesh)
  {
    PlanarTriangles result(mesh);
    result.sortByPlace();
    return result;
  }

  PlanarTriangles triangles;
  FunctionSpace space;
  BoxGrid grid, supports;
  BondCut cut;
};

/// Integrates the triangles of the colors, in order, into the needed rows.
void addTriangles(RankGroup& group, const PeridynamicWork& work, const PairIntegrals* integrals,
  const std::vector<char>& rows, const std::vector<double>* given, AssemblyControl& control,
  PeridynamicSystem& system)
{
  const FunctionSpace& space = work.space;
  const PeridynamicOptions& options = work.options;
  struct Scratch
  {
    RowSums sums;
    std::unique_ptr<TriangleAssembler> assembler;
    std::vector<std::int32_t> near;
  };
  ScratchPool<Scratch> scratches(
    [&]
    {
      return Scratch{ RowSums(space.functions, static_cast<int>(system.components)),
        integrals ? makeExactAssembler(work, *integrals) : makeDissertationAssembler(work), {} };
    });
  constexpr Index grain = 16;
  const double scale = kernelScale(options);
  // Within a color, no two threads write to the same row; the order of the colors is fixed and the
  // same on all ranks, so that rows are summed in this order.
  std::vector<std::vector<std::int32_t>> colours;
  colours = colourTriangles(work.triangles, space, space.trianglesWithUnknowns(work.triangles));
  const Index slices = group.size() > 1 ? SlicesOnRanks : 1;
  Index done = 0;
  const Index all = std::count(work.needed.begin(), work.needed.end(), 1);
  for (const std::vector<std::int32_t>& colour : colours)
  {
    std::vector<std::int32_t> own;
    std::copy_if(colour.begin(), colour.end(), std::back_inserter(own),
      [&work](std::int32_t t) { return work.needed[t] != 0; });
    const auto size = static_cast<Index>(own.size());
    for (Index slice = 0; slice < slices; ++slice)
    {
      const Index begin = size * slice / slices, end = size * (slice + 1) / slices;
      parallelFor(
        end - begin, grain, options.threads, scratches,
        [&](Scratch& scratch, Index k)
        {
          const Index t = own[begin + k];
          work.neighboursOf(t, scratch.near);
          scratch.assembler->assemble(t, scratch.near, scratch.sums);
          flush(work, rows, t, scratch.near, scratch.sums, scale, given, system);
        },
        [&](double fraction)
        {
          const double now = fraction * static_cast<double>(end - begin);
          return control.proceed(
            (static_cast<double>(done) + now) / static_cast<double>(std::max<Index>(all, 1)));
        });
      control.throwIfStopped();
      group.agree();
      done += end - begin;
    }
  }
}

/// Failures on one rank, including the time limit, stop all ranks within a slice.
PeridynamicSystem assembledOnRanks(RankGroup& group, const HorizonMesh& mesh,
  const PeridynamicOptions& options, const std::vector<double>* given)
{
  PeridynamicSystem system;
  std::unique_ptr<AssemblyParts> parts;
  // The first rank needs memory for the whole matrix, because it gathers the rows of all ranks.
  const double share = group.rank() == 0 ? 1.0 : 1.0 / group.size();
  checkAssembly(mesh, options, given, share, system);
  parts = std::make_unique<AssemblyParts>(mesh, options);
  const bool first = group.rank() == 0;
  const PlanarTriangles& triangles = parts->triangles;
  const FunctionSpace& space = parts->space;
  const std::vector<int> ranks = ranksOfRows(group, space);
  std::vector<char> own, needed;
  own.resize(space.unknowns);
  needed.assign(triangles.size(), 0);
  std::transform(ranks.begin(), ranks.end(), own.begin(),
    [&group](int rank) { return static_cast<char>(rank == group.rank()); });
  for (Index t = 0; t < triangles.size(); ++t)
  {
    for (int a = 0; a < space.perTriangle(); ++a)
    {
      const Index row = space.unknownOf[space.function(triangles, t, a)];
      needed[t] |= static_cast<char>(row >= 0 && own[row]);
    }
  }
  const PeridynamicWork work = { triangles, parts->grid, space, options, parts->cut, needed };
  AssemblyControl control(options, 0.0, 0.5);
  const bool exact = options.discretization == Discretization::Exact;
  const bool stateBased = options.model == PeridynamicModel::StateBased;
  std::shared_ptr<PairIntegrals> integrals;
  integrals = exact ? makePairIntegrals(work) : nullptr;
  const Index slices = group.size() > 1 ? SlicesOnRanks : 1;
  for (Index slice = 0; exact && slice < slices; ++slice)
  {
    integratePairs(
      *integrals, slice, slices, [&](double fraction) { return control.proceed(fraction); });
    control.throwIfStopped();
    group.agree();
  }
  control.setRange(exact ? 0.5 : 0.0, stateBased ? StateBasedShare : 1.0);
  system.matrix = makePattern(space, first ? std::vector<char>(own.size(), 1) : own,
    parts->supports, interactionReach(options), system.components, options.threads);
  system.constraintLoad.assign(given ? system.matrix.size : 0, 0.0);
  system.integratedPairs = group.sum(exact ? numberOfIntegratedPairs(*integrals) : 0);
  addTriangles(group, work, integrals.get(), own, given, control, system);
  if (group.size() > 1)
  {
    gatherRows(group, ranks, system);
  }
  if (first)
  {
    // The dilatation term needs all rows, so the first rank adds it after they are gathered.
    if (stateBased)
    {
      control.setRange(StateBasedShare, 1.0);
      addDilatation(
        work, given, system, [&](double fraction) { return control.proceed(fraction); });
      control.throwIfStopped();
    }
    system.asymmetry = symmetrize(system.matrix, options.threads);
    dropZeros(system.matrix);
    if (exact)
    {
      system.asymmetry = 0.0; // rounding
    }
    checkDiagonal(system);
  }
  system.unknownOf = space.unknownOf;
  system.functionOf = space.functionOf;
  return system;
}
}

//------------------------------------------------------------------------------
PeridynamicSystem assemblePeridynamics(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const std::vector<double>* given)
{
  SingleRank alone;
  return assemblePeridynamics(alone, mesh, options, given);
}

//------------------------------------------------------------------------------
PeridynamicSystem assemblePeridynamics(RankGroup& group, const HorizonMesh& mesh,
  const PeridynamicOptions& options, const std::vector<double>* given)
{
  PeridynamicSystem system;
  group.together([&] { system = assembledOnRanks(group, mesh, options, given); });
  return system;
}

//------------------------------------------------------------------------------
HorizonMesh meshOfFirst(RankGroup& group, const HorizonMesh& own)
{
  const bool first = group.rank() == 0;
  HorizonMesh mesh;
  mesh.points = group.gatherItems(first ? own.points : std::vector<double>())[0];
  mesh.triangles = group.gatherItems(first ? own.triangles : std::vector<Index>())[0];
  mesh.layer = group.gatherItems(first ? own.layer : std::vector<unsigned char>())[0];
  mesh.givenPoints = group.gatherItems(first ? own.givenPoints : std::vector<unsigned char>())[0];
  return mesh;
}

//------------------------------------------------------------------------------
std::vector<double> sourceLoad(const HorizonMesh& mesh, const PeridynamicSystem& system,
  PeridynamicBasis basis, const std::vector<double>& source, bool perVertex)
{
  const Index c = system.components;
  const Index expected = c * (perVertex ? mesh.numberOfPoints() : mesh.numberOfTriangles());
  if (static_cast<Index>(source.size()) != expected)
  {
    throw Error("the source has " + std::to_string(source.size()) + " values; " +
      std::to_string(expected) + " are expected");
  }
  const PlanarTriangles triangles(mesh);
  std::vector<double> load(system.matrix.size, 0.0);
  for (Index t = 0; t < triangles.size(); ++t)
  {
    const int functions = basis == PeridynamicBasis::Constant ? 1 : 3;
    for (int a = 0; a < functions; ++a)
    {
      const Index f = functions == 1        ? t
        : basis == PeridynamicBasis::Linear ? triangles.triangles[t][a]
                                            : triangles.sources[t][a];
      const Index row = system.unknownOf[f];
      for (Index i = 0; row >= 0 && i < c; ++i)
      {
        // sum over the corners of the source times the integral of its linear function
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          const Index from = perVertex ? triangles.triangles[t][k] : t;
          const double weight = functions == 1 ? 1.0 / 3.0 : k == a ? 1.0 / 6.0 : 1.0 / 12.0;
          sum += weight * source[c * from + i];
        }
        load[c * row + i] += triangles.areas[t] * sum;
      }
    }
  }
  return load;
}
}
