// SPDX-License-Identifier: BSD-3-Clause
// Meshes spread over MPI ranks: numbering, sums, boundaries, and linear systems whose solution does
// not depend on the number of ranks. Runs on however many ranks it is started on.
#include "Registry.h"
#include "Systems.h"
#include "tautline/Elliptic/ElementContributions.h"
#include "tautline/Elliptic/EllipticSystem.h"
#include "tautline/Solvers/ConditionEstimate.h"

#include <limits>
#include <mpi.h>
#include <set>

using namespace tautline;

namespace
{
constexpr int columns = 24, rows = 18; // of squares, in the whole mesh

/// A rank's part of a grid of squares: a band of columns, or, `scattered`, every so-many-th square.
struct Part
{
  std::vector<double> points;
  std::vector<Index> ids, offsets = { 0 }, connectivity;
  std::vector<unsigned char> types;

  Part(int rank, int ranks, bool scattered, int ghostBand = 0)
  {
    std::vector<Index> local((columns + 1) * (rows + 1), -1);
    for (int square = 0; square < columns * rows; ++square)
    {
      const int i = square % columns, j = square / columns;
      const int first = columns * rank / ranks - ghostBand,
                last = columns * (rank + 1) / ranks + ghostBand;
      if (scattered ? square % ranks != rank : i < first || i >= last)
      {
        continue;
      }
      const int corner = j * (columns + 1) + i;
      for (const int node : { corner, corner + 1, corner + columns + 2, corner + columns + 1 })
      {
        if (local[node] < 0)
        {
          local[node] = static_cast<Index>(this->ids.size());
          this->ids.push_back(1000 + 7 * node);
          this->points.insert(this->points.end(),
            { double(node % (columns + 1)), double(node / (columns + 1)), 0.0 });
        }
        this->connectivity.push_back(local[node]);
      }
      this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
      this->types.push_back(static_cast<unsigned char>(CellType::Quadrilateral));
    }
  }

  Index numberOfPoints() const { return static_cast<Index>(this->ids.size()); }
  int node(Index point) const { return static_cast<int>((this->ids[point] - 1000) / 7); }
  bool onBoundary(Index point) const
  {
    const int i = this->node(point) % (columns + 1), j = this->node(point) / (columns + 1);
    return i == 0 || i == columns || j == 0 || j == rows;
  }
  Mesh mesh() const
  {
    TAUTLINE_LET(MeshView, view, numberOfPoints = this->numberOfPoints(),
      points = this->points.data(), numberOfCells = static_cast<Index>(this->types.size()),
      cellTypes = this->types.data(), offsets = this->offsets.data(),
      connectivity = this->connectivity.data());
    return Mesh(view);
  }
};

int rankOf(MPI_Comm comm)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int ranksOf(MPI_Comm comm)
{
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  return ranks;
}

//------------------------------------------------------------------------------
void testNumbering(MPI_Comm comm, bool scattered)
{
  const int rank = rankOf(comm), ranks = ranksOf(comm);
  const Part part(rank, ranks, scattered);
  const Index n = part.numberOfPoints();
  std::vector<unsigned char> used(static_cast<std::size_t>(n));
  for (Index p = 0; p < n; ++p)
  {
    used[p] = !part.onBoundary(p);
  }
  const PointNumbering numbering(&comm, n, part.ids.data(), used.data());
  constexpr Index whole = (columns - 1) * (rows - 1);
  TAUTLINE_CHECK_EQUAL(numbering.ranks(), ranks);
  TAUTLINE_CHECK_EQUAL(numbering.globalSize(), whole);
  TAUTLINE_CHECK_EQUAL(numbering.sum(numbering.ownedRows()), whole);

  // Rows: one per point on all ranks, contiguous where owned, owned once, by the lowest rank.
  std::vector<Index> rowOfNode((columns + 1) * (rows + 1), -1), most(rowOfNode), least(rowOfNode);
  std::vector<int> lowest(rowOfNode.size(), ranks), lowestOfAll(lowest);
  Index next = numbering.firstRow(), largest = -1;
  for (Index p = 0; p < n; ++p)
  {
    const Index row = numbering.rows()[p];
    TAUTLINE_CHECK_EQUAL(row >= 0, used[p] != 0);
    rowOfNode[part.node(p)] = row;
    lowest[part.node(p)] = used[p] ? rank : ranks;
    largest = std::max(largest, row);
    if (numbering.owned(p))
    {
      TAUTLINE_CHECK_EQUAL(row, next);
      ++next;
    }
  }
  TAUTLINE_CHECK_EQUAL(next, numbering.firstRow() + numbering.ownedRows());
  TAUTLINE_CHECK(largest < whole);
  const int nodes = static_cast<int>(rowOfNode.size());
  MPI_Allreduce(rowOfNode.data(), most.data(), nodes, MPI_INT64_T, MPI_MAX, comm);
  MPI_Allreduce(lowest.data(), lowestOfAll.data(), nodes, MPI_INT, MPI_MIN, comm);
  std::set<Index> distinct(most.begin(), most.end());
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(distinct.size()), whole + 1);
  for (Index p = 0; p < n; ++p)
  {
    TAUTLINE_CHECK_EQUAL(numbering.rows()[p], most[part.node(p)]);
    TAUTLINE_CHECK_EQUAL(numbering.owned(p), used[p] && lowestOfAll[part.node(p)] == rank);
  }

  // Sums over copies: the number of ranks that have a point, and something of each rank.
  std::vector<double> values(2 * static_cast<std::size_t>(n));
  std::vector<unsigned char> flags(static_cast<std::size_t>(n), 0);
  std::vector<int> copies(rowOfNode.size(), 0), powers(copies), allCopies(copies),
    allPowers(copies);
  for (Index p = 0; p < n; ++p)
  {
    values[2 * p] = copies[part.node(p)] = 1;
    values[2 * p + 1] = powers[part.node(p)] = 1 << rank;
    flags[p] = rank == ranks - 1;
  }
  MPI_Allreduce(copies.data(), allCopies.data(), nodes, MPI_INT, MPI_SUM, comm);
  MPI_Allreduce(powers.data(), allPowers.data(), nodes, MPI_INT, MPI_SUM, comm);
  numbering.sum(values.data(), 2);
  numbering.either(flags.data());
  for (Index p = 0; p < n; ++p)
  {
    TAUTLINE_CHECK_EQUAL(values[2 * p], used[p] ? allCopies[part.node(p)] : 1);
    TAUTLINE_CHECK_EQUAL(values[2 * p + 1], used[p] ? allPowers[part.node(p)] : 1 << rank);
    const bool last = (allPowers[part.node(p)] >> (ranks - 1)) % 2 == 1;
    TAUTLINE_CHECK_EQUAL(flags[p] != 0, used[p] ? last : rank == ranks - 1);
  }
  TAUTLINE_CHECK_EQUAL(numbering.sum(1.5), 1.5 * ranks);
  TAUTLINE_CHECK_EQUAL(numbering.maximum(double(rank)), ranks - 1.0);
}

/// The boundary of the whole, whatever the parts and their ghosts.
void testBoundary(MPI_Comm comm)
{
  const int rank = rankOf(comm), ranks = ranksOf(comm);
  for (const int kind : { 0, 1, 2 })
  {
    const Part part(rank, ranks, kind == 1, kind == 2 ? 1 : 0);
    std::vector<unsigned char> skip(part.types.size(), 0);
    for (std::size_t cell = 0; cell < skip.size(); ++cell)
    {
      double x = sumOf<double>(
        0.0, 4, [&](int k) { return part.points[3 * part.connectivity[4 * cell + k]] / 4.0; });
      skip[cell] = kind == 2 &&
        (x < columns * rank / ranks || x > columns * (rank + 1) / ranks); // NOLINT: whole columns
    }
    const std::vector<unsigned char> flags =
      globalBoundaryPoints(part.mesh(), &comm, part.ids.data(), skip.data());
    TAUTLINE_EACH(
      Index, p, part.numberOfPoints(), TAUTLINE_CHECK_EQUAL(flags[p] != 0, part.onBoundary(p)));
  }
  // Alone, and without a communicator, the same as Mesh.
  const Part whole(0, 1, false);
  const Mesh mesh = whole.mesh();
  const std::vector<char> expected = mesh.boundary().isBoundaryPoint;
  const std::vector<unsigned char> alone = globalBoundaryPoints(mesh, nullptr, nullptr, nullptr);
  TAUTLINE_CHECK(std::equal(alone.begin(), alone.end(), expected.begin()));
}

//------------------------------------------------------------------------------
/// A rank's contributions to a system on the inner points: a spring along each side and diagonal of
/// its squares, `block` unknowns per point that are coupled; side and reaction scaled.
struct Springs
{
  SparseMatrix matrix;
  std::vector<double> b, coordinates;

  Springs(const Part& part, const PointNumbering& numbering, int block, double scale)
  {
    std::vector<Index> unknown(part.ids.size(), -1);
    Index points = 0;
    for (std::size_t p = 0; p < unknown.size(); ++p)
    {
      if (numbering.rows()[p] >= 0)
      {
        unknown[p] = points++;
        this->coordinates.insert(
          this->coordinates.end(), &part.points[3 * p], &part.points[3 * p] + 3);
      }
    }
    std::vector<std::vector<double>> dense(
      block * points, std::vector<double>(block * points, 0.0));
    this->b.assign(static_cast<std::size_t>(block * points), 0.0);
    for (std::size_t cell = 0; cell < part.types.size(); ++cell)
    {
      const Index* node = &part.connectivity[4 * cell];
      for (int k = 0; k < 4; ++k)
      {
        for (int l = 0; l < k; ++l)
        {
          this->spring(part, unknown, node[k], node[l], block, scale, dense);
        }
        for (int c = 0; unknown[node[k]] >= 0 && c < block; ++c)
        {
          this->b[block * unknown[node[k]] + c] += scale * (1.0 + c + part.points[3 * node[k]]);
        }
      }
    }
    this->matrix.size = block * points;
    for (const std::vector<double>& row : dense)
    {
      for (std::size_t j = 0; j < row.size(); ++j)
      {
        if (row[j] != 0.0)
        {
          this->matrix.columns.push_back(static_cast<std::int32_t>(j));
          this->matrix.values.push_back(row[j]);
        }
      }
      this->matrix.offsets.push_back(this->matrix.nonzeros());
    }
  }

private:
  void spring(const Part& part, const std::vector<Index>& unknown, Index p, Index q, int block,
    double scale, std::vector<std::vector<double>>& dense)
  {
    const double d[2] = { part.points[3 * q] - part.points[3 * p],
      part.points[3 * q + 1] - part.points[3 * p + 1] };
    const Index ends[2] = { p, q };
    for (int e = 0; e < 2; ++e)
    {
      for (int f = 0; f < 2; ++f)
      {
        for (int c = 0; c < block * block; ++c)
        {
          const Index i = unknown[ends[e]], j = unknown[ends[f]];
          const double weight =
            block == 1 ? 1.0 : d[c / 2] * d[c % 2] / (d[0] * d[0] + d[1] * d[1]);
          if (i >= 0 && j >= 0)
          {
            dense[block * i + c / block][block * j + c % block] +=
              (e == f ? scale : -scale) * weight;
          }
        }
      }
    }
  }
};

/// All nodes' values of a solution with `block` components, on every rank.
std::vector<double> gathered(MPI_Comm comm, const Part& part, const PointNumbering& numbering,
  int block, const std::vector<double>& x)
{
  std::vector<double> mine(block * (columns + 1) * (rows + 1), 0.0), all(mine);
  Index i = 0;
  for (Index p = 0; p < part.numberOfPoints(); ++p)
  {
    const bool free = numbering.rows()[p] >= 0;
    for (int c = 0; free && c < block; ++c)
    {
      mine[block * part.node(p) + c] = numbering.owned(p) ? x[block * i + c] : 0.0;
    }
    i += free;
  }
  MPI_Allreduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM, comm);
  // Copies have what the owner has.
  i = 0;
  for (Index p = 0; p < part.numberOfPoints(); ++p)
  {
    const bool free = numbering.rows()[p] >= 0;
    for (int c = 0; free && c < block; ++c)
    {
      TAUTLINE_CHECK_EQUAL(x[block * i + c], all[block * part.node(p) + c]);
    }
    i += free;
  }
  return all;
}

std::vector<double> solvedOver(
  MPI_Comm comm, bool scattered, int block, double scale, const SolverOptions& options)
{
  const Part part(rankOf(comm), ranksOf(comm), scattered);
  auto used = collect<unsigned char>(
    part.ids.size(), [&](std::size_t p) { return !part.onBoundary(static_cast<Index>(p)); });
  const PointNumbering numbering(&comm, part.numberOfPoints(), part.ids.data(), used.data());
  const Springs springs(part, numbering, block, scale);
  TAUTLINE_LET(LinearSystem, system, matrix = &springs.matrix, blockSize = block,
    coordinates = springs.coordinates.data(), numbering = &numbering);
  LinearSolver solver(system, options);
  std::vector<double> x(springs.b.size());
  const LinearSolution solution = solver.solve(springs.b.data(), x.data());
  TAUTLINE_CHECK(converged(solution.reason));
  TAUTLINE_CHECK(solution.trueResidual < 1e-11);
  return gathered(comm, part, numbering, block, x);
}

/// Every preconditioner, and the direct solver: as one rank has it.
void testSolutions(MPI_Comm comm)
{
  for (const int block : { 1, 2 })
  {
    TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
    const std::vector<double> expected = solvedOver(MPI_COMM_SELF, false, block, 1.0, options);
    for (const double scale : { 1e-8, 1.0, 1e8 })
    {
      TAUTLINE_CHECK(
        relativeDifference(solvedOver(comm, true, block, scale, options), expected) < 1e-12);
    }
    for (const Preconditioner preconditioner : { Preconditioner::Jacobi, Preconditioner::SSOR,
           Preconditioner::ILU, Preconditioner::BoomerAMG, Preconditioner::ICC,
           Preconditioner::GAMG, Preconditioner::None })
    {
      for (const bool scattered : { false, true })
      {
        const Context context(std::string(nameOf(preconditioner)) + " block " +
          std::to_string(block) + " scattered " + std::to_string(scattered));
        TAUTLINE_SET(options, method = KrylovMethod::ConjugateGradient,
          preconditioner = preconditioner, relativeTolerance = 1e-13);
        TAUTLINE_CHECK(
          relativeDifference(solvedOver(comm, scattered, block, 1.0, options), expected) < 1e-10);
      }
    }
  }
}

/// Condition numbers and contributions of elements: of the whole, whatever the parts.
void testConditions(MPI_Comm comm)
{
  MPI_Comm self = MPI_COMM_SELF;
  const Part whole(0, 1, false), part(rankOf(comm), ranksOf(comm), true);
  const Mesh wholeMesh = whole.mesh(), mesh = part.mesh();
  for (const Pde pde : { Pde::Poisson, Pde::Elasticity })
  {
    TAUTLINE_LET(EllipticProblem, problem, pde = pde);
    MeshPart alone, shared;
    TAUTLINE_SET(alone, communicator = &self, globalIds = whole.ids.data());
    TAUTLINE_SET(shared, communicator = &comm, globalIds = part.ids.data());
    const EllipticSystem expected(wholeMesh, problem, alone), system(mesh, problem, shared);
    for (const Preconditioner preconditioner :
      { Preconditioner::None, Preconditioner::Jacobi, Preconditioner::BoomerAMG })
    {
      const Context context(nameOf(preconditioner));
      TAUTLINE_LET(ConditionOptions, options, preconditioner = preconditioner);
      const ConditionEstimate one = estimateCondition(expected.linearSystem(), options),
                              all = estimateCondition(system.linearSystem(), options);
      TAUTLINE_CHECK(one.converged && all.converged);
      // Multigrid is another one on several ranks.
      const bool same = preconditioner != Preconditioner::BoomerAMG;
      TAUTLINE_CHECK_RELATIVE(all.condition, one.condition, same ? 3e-4 : 0.5);
      TAUTLINE_CHECK(all.largestVector.size() == system.rightHandSide().size());
    }
    const ElementContributions one = elementContributions(expected, true),
                               all = elementContributions(system, true);
    TAUTLINE_CHECK_RELATIVE(all.bound, one.bound, 1e-12);
    TAUTLINE_CHECK_RELATIVE(all.lowerBound, one.lowerBound, 1e-12);
    double sum = sumOf<double>(0.0, all.share, [&](const double share) { return share; });
    TAUTLINE_CHECK_NEAR(system.numbering().sum(sum), 1.0, 1e-12);
  }
}

/// An error of one rank is an error of all; an interruption of one rank stops all.
void testTogether(MPI_Comm comm)
{
  const int rank = rankOf(comm), ranks = ranksOf(comm);
  const Part part(rank, ranks, false);
  const bool last = rank == ranks - 1;
  if (ranks > 1)
  {
    std::vector<Index> ids = part.ids;
    ids[3] = last ? -5 : ids[3];
    const char* text = last ? "-5 is negative" : "Another MPI rank";
    TAUTLINE_CHECK_THROWS(PointNumbering(&comm, part.numberOfPoints(), ids.data()), text);
    ids[3] = last ? ids[4] : ids[3];
    TAUTLINE_CHECK_THROWS(PointNumbering(&comm, part.numberOfPoints(), ids.data()), "");
    TAUTLINE_CHECK_THROWS(
      PointNumbering(&comm, part.numberOfPoints(), nullptr), wording("generate-global-ids"));
  }
  auto used = collect<unsigned char>(
    part.ids.size(), [&](std::size_t p) { return !part.onBoundary(static_cast<Index>(p)); });
  const PointNumbering numbering(&comm, part.numberOfPoints(), part.ids.data(), used.data());
  Springs springs(part, numbering, 1, 1.0);
  TAUTLINE_LET(LinearSystem, system, matrix = &springs.matrix, numbering = &numbering);
  TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::None);
  options.observer = [&](int iteration, double) { return !last || iteration < 4; };
  std::vector<double> x(springs.b.size());
  {
    LinearSolver solver(system, options);
    const LinearSolution stopped = solver.solve(springs.b.data(), x.data());
    TAUTLINE_CHECK(stopped.reason == SolveReason::Aborted);
    TAUTLINE_CHECK_EQUAL(stopped.iterations, 4);
    if (last)
    {
      springs.b[0] = std::numeric_limits<double>::quiet_NaN();
    }
    TAUTLINE_CHECK(solver.solve(springs.b.data(), x.data()).reason == SolveReason::NotANumber);
  }
  options.petscOptions = "-ksp_rtolerance 3";
  TAUTLINE_CHECK_THROWS(LinearSolver(system, options), "-ksp_rtolerance");
  if (last)
  {
    springs.matrix.values[5] = std::numeric_limits<double>::infinity();
  }
  TAUTLINE_CHECK_THROWS(LinearSolver(system, {}), last ? "not finite" : "Another MPI rank");
}

/// A rank without cells takes part.
void testEmptyRank(MPI_Comm comm)
{
  const int rank = rankOf(comm), ranks = ranksOf(comm);
  if (ranks == 1)
  {
    return;
  }
  // All cells on the last rank.
  Part part(0, 1, false);
  if (rank != ranks - 1)
  {
    part.points.clear();
    part.ids.clear();
    part.types.clear();
    part.connectivity.clear();
    part.offsets = { 0 };
  }
  std::vector<unsigned char> used =
    globalBoundaryPoints(part.mesh(), &comm, part.ids.data(), nullptr);
  for (unsigned char& flag : used)
  {
    flag = !flag;
  }
  const PointNumbering numbering(&comm, part.numberOfPoints(), part.ids.data(), used.data());
  TAUTLINE_CHECK_EQUAL(numbering.globalSize(), Index(columns - 1) * (rows - 1));
  const Springs springs(part, numbering, 1, 1.0);
  TAUTLINE_LET(LinearSystem, system, matrix = &springs.matrix, numbering = &numbering);
  for (const Preconditioner preconditioner : { Preconditioner::BoomerAMG, Preconditioner::ILU })
  {
    TAUTLINE_LET(SolverOptions, options, preconditioner = preconditioner);
    LinearSolver solver(system, options);
    std::vector<double> x(springs.b.size());
    TAUTLINE_CHECK(converged(solver.solve(springs.b.data(), x.data()).reason));
  }
}
}

TAUTLINE_TEST(TestPointNumbering)
{
  MPI_Init(nullptr, nullptr);
  MPI_Comm comm = MPI_COMM_WORLD;
  // A single rank solves a system while the others do not: nothing is collective.
  if (rankOf(comm) == 0)
  {
    const SparseMatrix a = laplacian(20);
    const std::vector<double> b = someVector(a.size);
    std::vector<double> x(b.size());
    TAUTLINE_LET(LinearSystem, system, matrix = &a);
    LinearSolver solver(system, {});
    TAUTLINE_CHECK(converged(solver.solve(b.data(), x.data()).reason));
    TAUTLINE_CHECK(estimateCondition(system, {}).converged);
  }
  MPI_Barrier(comm);
  TAUTLINE_RUN(testNumbering(comm, false));
  TAUTLINE_RUN(testNumbering(comm, true));
  TAUTLINE_RUN(testBoundary(comm));
  TAUTLINE_RUN(testSolutions(comm));
  TAUTLINE_RUN(testConditions(comm));
  TAUTLINE_RUN(testTogether(comm));
  TAUTLINE_RUN(testEmptyRank(comm));
  MPI_Finalize();
}
