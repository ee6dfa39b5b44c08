// SPDX-License-Identifier: BSD-3-Clause
// Boundary value problems on a mesh spread over MPI ranks: the solution, its derivatives, norms,
// steps in time and the study of solvers equal the results of the whole mesh in one process; an
// error of one rank is an error of all. Runs on any number of ranks.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "tautline/Elliptic/ErrorNorms.h"
#include "tautline/Elliptic/SolverStudy.h"
#include "tautline/Elliptic/TimeStepping.h"

#include <mpi.h>

using namespace tautline;

namespace
{
/// This rank's cells of a mesh, and ghosts: cells of other ranks, which do not count.
struct Share
{
  MeshData data;
  std::vector<Index> points, cells; // ids in the whole mesh
  std::vector<unsigned char> skip;
  MeshPart part;

  Share(MPI_Comm& comm, const MeshData& whole, bool scattered, bool lastIsEmpty = false)
  {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    const int takers = lastIsEmpty ? std::max(1, ranks - 1) : ranks;
    std::vector<Index> local(whole.numberOfPoints(), -1);
    for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
    {
      // Bands of cells by their order in x; every seventh cell is also a ghost of the next rank.
      const Index first = whole.offsets[cell], end = whole.offsets[cell + 1];
      const double x = whole.points[3 * whole.connectivity[first]];
      const int band = std::min(takers - 1, static_cast<int>(x / blockSize * takers));
      const int owner = scattered ? static_cast<int>(cell % takers) : band;
      const bool ghost = cell % 7 == 0 && (owner + 1) % takers == rank && takers > 1;
      if (owner != rank && !ghost)
      {
        continue;
      }
      std::vector<Index> nodes;
      for (Index k = first; k < end; ++k)
      {
        const Index node = whole.connectivity[k];
        if (local[node] < 0)
        {
          local[node] = this->data.addPoint(whole.point(node));
          this->points.push_back(node);
        }
        nodes.push_back(local[node]);
      }
      this->data.addCell(static_cast<int>(whole.types[cell]), nodes);
      this->cells.push_back(cell);
      this->skip.push_back(owner != rank);
    }
    this->part.communicator = &comm;
    this->part.globalIds = this->points.data();
    this->part.skip = this->skip.data();
  }

  /// This rank's part of a field of the whole mesh.
  std::vector<double> pointField(const std::vector<double>& whole, int components) const
  {
    std::vector<double> field;
    for (Index point : this->points)
    {
      for (int k = 0; k < components; ++k)
      {
        field.push_back(whole[components * point + k]);
      }
    }
    return field;
  }

  static constexpr double blockSize = 5;
};

/// Quadratic cells, all of whose edges are bent.
MeshData curved(const MeshData& linear)
{
  MeshData data = quadraticOf(linear);
  data.transform(
    [](const Vec3& p) {
      return p + 0.1 * Vec3{ std::sin(2 * p[1]), std::sin(2 * p[0]), 0 };
    });
  return data;
}

//------------------------------------------------------------------------------
void testSolutions(
  MPI_Comm comm, CellType type, Pde pde, bool scattered, bool lastIsEmpty, bool quadratic = false)
{
  const Context context(std::string(topology(type).plural) + ", problem " +
    std::to_string(static_cast<int>(pde)) + (scattered ? ", scattered" : ", bands") +
    (quadratic ? ", quadratic" : ""));
  const MeshData linear = movedBlock(type, quadratic ? 4 : 5, 0.1);
  const MeshData whole = shuffled(quadratic ? curved(linear) : linear, 3);
  const Share share(comm, whole, scattered, lastIsEmpty);
  const int given = pde == Pde::Elasticity ? 3 : 1;
  Random random(5);
  std::vector<double> sources, values;
  for (Index i = 0; i < whole.numberOfPoints(); ++i)
  {
    for (int k = 0; k < given; ++k)
    {
      const bool inPlane = k < topology(type).dimension;
      sources.push_back(inPlane ? random.uniform(-1, 1) : 0.0);
      values.push_back(inPlane ? random.uniform(-1, 1) : 0.0);
    }
  }
  TAUTLINE_LET(EllipticProblem, problem, pde = pde);
  problem.diffusion.tensor = { 2, 1, 3, 0.2, 0, 0 };
  TAUTLINE_SET(
    problem, diffusion.reaction = 1, sources = sources.data(), fixedValues = values.data());
  const Mesh mesh(whole.view());
  const EllipticSystem alone(mesh, problem);
  const std::vector<double> mySources = share.pointField(sources, given),
                            myValues = share.pointField(values, given);
  TAUTLINE_SET(problem, sources = mySources.data(), fixedValues = myValues.data());
  const Mesh myMesh(share.data.view());
  const EllipticSystem together(myMesh, problem, share.part);
  TAUTLINE_CHECK_EQUAL(together.unknowns(), alone.unknowns());

  TAUTLINE_LET(
    SolverOptions, options, relativeTolerance = 1e-12, preconditioner = Preconditioner::Jacobi);
  const EllipticSolution expected = alone.solve(options), solution = together.solve(options);
  TAUTLINE_CHECK(converged(expected.linear.reason) && converged(solution.linear.reason));
  TAUTLINE_CHECK_EQUAL(solution.components, given);
  for (std::size_t i = 0; i < share.points.size(); ++i)
  {
    TAUTLINE_EACH(int, k, given,
      TAUTLINE_CHECK_NEAR(
        solution.values[given * i + k], expected.values[given * share.points[i] + k], 1e-9));
  }
  // The same steps in time; the values that are fixed serve as a start.
  for (const TimeScheme scheme :
    { TimeScheme::Bdf2, TimeScheme::CrankNicolson, TimeScheme::Newmark })
  {
    TAUTLINE_LET(TimeOptions, time, scheme = scheme, step = 0.1, steps = 4,
      mass =
        scheme == TimeScheme::Bdf2 && !quadratic ? MassMatrix::Lumped : MassMatrix::Consistent);
    const std::vector<double> start = unknownsOf(alone, values);
    const std::vector<double> myStart = unknownsOf(together, myValues);
    const TimeSeries there = integrate(alone, time, start, start, options);
    const TimeSeries here = integrate(together, time, myStart, myStart, options);
    TAUTLINE_CHECK(converged(there.reason) && converged(here.reason));
    TAUTLINE_CHECK_EQUAL(here.values.size(), there.values.size());
    const EllipticSolution last = together.fields(here.values.back());
    const EllipticSolution known = alone.fields(there.values.back());
    for (std::size_t i = 0; i < share.points.size(); ++i)
    {
      TAUTLINE_EACH(int, k, given,
        TAUTLINE_CHECK_NEAR(
          last.values[given * i + k], known.values[given * share.points[i] + k], 1e-8));
    }
  }
  const int size = given == 1 ? 3 : 6;
  for (std::size_t i = 0; i < share.cells.size(); ++i)
  {
    for (int k = 0; k < size; ++k)
    {
      TAUTLINE_CHECK_NEAR(solution.gradients[size * i + k],
        expected.gradients[size * share.cells[i] + k], 1e-8); // also of ghosts
    }
  }
  const auto zero = [](const Vec3&, double*, double*) {};
  const std::array<double, 2> norms = errorNorms(together, solution, zero),
                              wholeNorms = errorNorms(alone, expected, zero);
  TAUTLINE_CHECK_RELATIVE(norms[0], wholeNorms[0], 1e-9);
  TAUTLINE_CHECK_RELATIVE(norms[1], wholeNorms[1], 1e-9);

  SolverStudyOptions study;
  study.combinations = { { KrylovMethod::ConjugateGradient, Preconditioner::Jacobi, false },
    { KrylovMethod::GMRES, Preconditioner::BoomerAMG, false },
    { KrylovMethod::MINRES, Preconditioner::GAMG, true } };
  const SolverStudy here = studySolvers(together, study), there = studySolvers(alone, study);
  TAUTLINE_CHECK_EQUAL(here.rows[0].linear.iterations, there.rows[0].linear.iterations);
  TAUTLINE_CHECK_RELATIVE(here.rows[0].condition, there.rows[0].condition, 1e-6);
  TAUTLINE_EACH_OF(const SolverStudyRow& row, here.rows,
    TAUTLINE_CHECK(converged(row.linear.reason) && row.trueResidual < 1e-3));
}

//------------------------------------------------------------------------------
void testRejections(MPI_Comm comm)
{
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  const auto rejected = [&](const MeshData& whole, EllipticProblem problem, const std::string& text)
  {
    const Share share(comm, whole, false);
    const Mesh mesh(share.data.view());
    // One rank names it; the others report that one does.
    int named = 0;
    try
    {
      const EllipticSystem system(mesh, problem, share.part);
      TAUTLINE_CHECK(!"rejected");
    }
    catch (const Error& error)
    {
      const std::string message = error.what();
      named = contains(message, text);
      TAUTLINE_CHECK(named || contains(message, wording("another-rank")));
    }
    MPI_Allreduce(MPI_IN_PLACE, &named, 1, MPI_INT, MPI_SUM, comm);
    TAUTLINE_CHECK(named > 0);
  };
  const MeshData good = blockMesh(CellType::Triangle, 5, 5, 0);
  MeshData data = good;
  std::swap(data.connectivity[0], data.connectivity[1]);
  rejected(data, {}, wording("inverted-against-the-rest"));
  rejected(TAUTLINE_CHANGED(good, addCell(3, { 0, 1 })), {}, wording("1-cells-are-not-triangles"));
  rejected(MeshData(), {}, wording("no-cells"));
  TAUTLINE_LET(EllipticProblem, problem, source[0] = std::numeric_limits<double>::quiet_NaN());
  rejected(good, problem, "source f");
  problem = {};
  problem.pde = Pde::Elasticity;
  problem.source = { 0, 0, 1 };
  rejected(good, problem, wording("out-of-the-plane"));
  // Bent where one rank's part ends: each part is flat, the mesh is not.
  problem.source = { 0, 0, 0 };
  data = good;
  data.transform([](const Vec3& p) { return p[0] > 3 ? Vec3{ 3, p[1], p[0] - 3 } : p; });
  rejected(data, problem, wording("surface-in-space"));
  // Nothing fixed: no part of any rank is held. One point fixed on one rank holds them all.
  std::vector<unsigned char> fixed(good.numberOfPoints(), 0);
  problem = {};
  problem.fixed = fixed.data();
  rejected(good, problem, wording("without-a-fixed-point"));
  const Share share(comm, good, true);
  const Mesh mesh(share.data.view());
  fixed[0] = rank == ranks - 1;
  const EllipticSystem held(mesh, problem, share.part);
  TAUTLINE_CHECK_EQUAL(held.unknowns(), good.numberOfPoints() - 1);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestEllipticRanks)
{
  MPI_Init(nullptr, nullptr);
  const MPI_Comm comm = MPI_COMM_WORLD;
  TAUTLINE_RUN(testSolutions(comm, CellType::Triangle, Pde::Poisson, false, false));
  TAUTLINE_RUN(testSolutions(comm, CellType::Quadrilateral, Pde::Elasticity, true, false));
  TAUTLINE_RUN(testSolutions(comm, CellType::Tetrahedron, Pde::Elliptic, true, true));
  TAUTLINE_RUN(testSolutions(comm, CellType::Hexahedron, Pde::Elasticity, false, true));
  TAUTLINE_RUN(testSolutions(comm, CellType::Triangle, Pde::Elasticity, true, false, true));
  TAUTLINE_RUN(testSolutions(comm, CellType::Tetrahedron, Pde::Poisson, false, true, true));
  TAUTLINE_RUN(testRejections(comm));
  MPI_Finalize();
}
