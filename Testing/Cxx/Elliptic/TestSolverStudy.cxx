// SPDX-License-Identifier: BSD-3-Clause
// The study of solvers: the sixteen combinations, condition numbers that are known, the
// recommendation and what it warns of, limits, stopping, PETSc options.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Elliptic/SolverStudy.h"

using namespace tautline;

namespace
{
//------------------------------------------------------------------------------
TAUTLINE_PART(testCombinations)
{
  const std::vector<SolverCombination> all = dissertationCombinations();
  TAUTLINE_CHECK_EQUAL(all.size(), std::size_t(16));
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(
      combinationNumber(all[i].method, all[i].preconditioner), static_cast<int>(i + 1));
    TAUTLINE_CHECK(!all[i].nearNullSpace);
  }
  TAUTLINE_CHECK_EQUAL(nameOf(all[9]), "GMRES + ILU(0)"); // Table 2.5 names number 10 so
  TAUTLINE_CHECK_EQUAL(
    nameOf({ KrylovMethod::Direct, Preconditioner::None, true }), "direct solver");
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testPoisson)
{
  const Index n = 24; // even: f = 1 has a part in the eigenvectors of both ends
  const MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, {});
  TAUTLINE_LET(SolverStudyOptions, options, solver.relativeTolerance = 1e-10);
  options.combinations.push_back({ KrylovMethod::Direct, Preconditioner::None, true });
  options.combinations.push_back({ KrylovMethod::MINRES, Preconditioner::None, true });
  double last = -1;
  options.progress = [&](double fraction)
  {
    TAUTLINE_CHECK(fraction >= last && fraction <= 1);
    last = fraction;
    return true;
  };
  const SolverStudy study = studySolvers(system, options);
  TAUTLINE_CHECK(last > 0.9);
  TAUTLINE_CHECK_EQUAL(study.rows.size(), std::size_t(18));
  TAUTLINE_CHECK(!study.aborted && !study.timeLimit);
  // The five-point matrix over 4: eigenvalues sin^2(i pi / 2n) + sin^2(j pi / 2n). Without
  // preconditioner the same ratio.
  const double condition = 1 / std::pow(std::tan(M_PI / (2 * n)), 2);
  double fastest = 1e300;
  for (std::size_t i = 0; i < study.rows.size(); ++i)
  {
    const SolverStudyRow& row = study.rows[i];
    const Context context(nameOf(row.combination));
    TAUTLINE_CHECK(row.run && converged(row.linear.reason));
    TAUTLINE_CHECK(row.trueResidual < 1e-7);
    TAUTLINE_CHECK(row.seconds > 0 && row.cpuSeconds > 0);
    TAUTLINE_CHECK_NEAR(row.seconds, row.linear.setupSeconds + row.linear.solveSeconds, 1e-12);
    fastest = std::min(fastest, row.seconds);
    const bool none = row.combination.preconditioner == Preconditioner::None;
    if (row.combination.method == KrylovMethod::Direct)
    {
      TAUTLINE_CHECK_EQUAL(row.condition, 0.0);
    }
    else if (none || row.combination.preconditioner == Preconditioner::Jacobi)
    {
      TAUTLINE_CHECK_RELATIVE(row.condition, condition, 1e-6);
    }
    else
    {
      // Incomplete factors and SSOR do better, multigrid much better.
      const bool multigrid = row.combination.preconditioner == Preconditioner::BoomerAMG;
      TAUTLINE_CHECK(row.condition > 1 && row.condition < (multigrid ? 1.5 : condition / 4));
    }
  }
  TAUTLINE_CHECK(study.recommended >= 0);
  const SolverStudyRow& best = study.rows[study.recommended];
  TAUTLINE_CHECK_EQUAL(best.seconds, fastest);
  // It begins with the fastest, unless others are as fast within the noise.
  TAUTLINE_CHECK(
    study.why.rfind(study.ties > 0 ? "No clear recommendation: " : nameOf(best.combination), 0) ==
    0);
  TAUTLINE_CHECK(contains(study.why, nameOf(best.combination) + ": "));
  TAUTLINE_CHECK(
    contains(study.why, wording("the-next")) && contains(study.why, wording("grows-about-as-n")));
  TAUTLINE_CHECK(!contains(study.why, wording("poor-shape")) && !contains(study.why, "converge"));
  TAUTLINE_CHECK(!contains(study.why, wording("what-remains")));

  // The tolerance is of the preconditioned residual; the study reports the true one.
  options = {};
  const MeshData large = movedBlock(CellType::Triangle, 120, 0.1);
  const Mesh fine(large.view());
  options.combinations = { { KrylovMethod::GMRES, Preconditioner::BoomerAMG, false } };
  options.conditions = false;
  const SolverStudy rough = studySolvers(EllipticSystem(fine, {}), options);
  TAUTLINE_CHECK(rough.rows[0].trueResidual > 1e-4);
  TAUTLINE_CHECK(contains(rough.why, wording("what-remains-of-the-equations-is")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testElasticity)
{
  // Multigrid needs fewer iterations when it is given the points and the rigid body modes.
  const MeshData data = movedBlock(CellType::Triangle, 40, 0.1);
  const Mesh mesh(data.view());
  TAUTLINE_LET(EllipticProblem, problem, pde = Pde::Elasticity);
  const EllipticSystem system(mesh, problem);
  TAUTLINE_LET(SolverStudyOptions, options, combinations = {});
  for (Preconditioner preconditioner : { Preconditioner::BoomerAMG, Preconditioner::GAMG })
  {
    for (bool told : { false, true })
    {
      options.combinations.push_back({ KrylovMethod::ConjugateGradient, preconditioner, told });
    }
  }
  TAUTLINE_SET(options, conditions = false, repetitions = 2);
  const SolverStudy study = studySolvers(system, options);
  for (int i : { 0, 2 })
  {
    const LinearSolution &blind = study.rows[i].linear, &told = study.rows[i + 1].linear;
    TAUTLINE_CHECK(converged(blind.reason) && converged(told.reason));
    TAUTLINE_CHECK(told.iterations < blind.iterations);
    TAUTLINE_CHECK_EQUAL(study.rows[i].condition, 0.0);
  }
  TAUTLINE_CHECK(contains(study.why, wording("rigid-body-modes")));
  options.combinations.resize(1);
  const SolverStudy blind = studySolvers(system, options);
  TAUTLINE_CHECK(contains(blind.why, wording("lacks-the-rigid-body-modes")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testFailuresAndWarnings)
{
  // One flat triangle: a warning that names it. Too few iterations: nothing to recommend.
  MeshData data = blockMesh(CellType::Triangle, 10, 10, 0);
  data.setPoint(60, data.point(60) + Vec3{ 0.97, 0.0, 0 });
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, {});
  TAUTLINE_LET(SolverStudyOptions, options, solver.maximumIterations = 2);
  options.combinations = { { KrylovMethod::ConjugateGradient, Preconditioner::Jacobi, false },
    { KrylovMethod::GMRES, Preconditioner::SSOR, false } };
  SolverStudy study = studySolvers(system, options);
  TAUTLINE_CHECK_EQUAL(study.recommended, Index(-1));
  TAUTLINE_CHECK(contains(study.why, wording("none-converged-2-did-not-converge-cg")));
  TAUTLINE_CHECK(contains(study.why, wording("of-poor-shape")) &&
    contains(study.why, wording("the-worst-cell")));
  for (const SolverStudyRow& row : study.rows)
  {
    TAUTLINE_CHECK(row.run && row.linear.reason == SolveReason::IterationLimit);
    TAUTLINE_CHECK(row.trueResidual > 1e-5 && row.condition == 0);
  }

  // Combinations of the dissertation's list, some limited.
  TAUTLINE_SET(options, solver.maximumIterations = 12, combinations = dissertationCombinations());
  study = studySolvers(system, options);
  TAUTLINE_CHECK(!contains(study.why, wording("nearly-singular")));
  TAUTLINE_CHECK(study.recommended >= 4 && contains(study.why, wording("did-not-converge")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testLimits)
{
  const MeshData data = blockMesh(CellType::Triangle, 60, 60, 0);
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, {});
  TAUTLINE_LET(SolverStudyOptions, options, conditions = false);
  options.solver.observerSeconds = 1e-9; // reports of every iteration
  options.solver.observer = [](int, double) { return true; };
  options.maximumSeconds = 1e-6;
  SolverStudy study = studySolvers(system, options);
  TAUTLINE_CHECK(study.timeLimit && !study.aborted && study.recommended == -1);
  TAUTLINE_CHECK_EQUAL(study.rows.size(), std::size_t(16));
  TAUTLINE_CHECK(!study.rows[15].run && contains(study.why, wording("the-time-was-over")));

  // Stopped in the third combination, in the midst of its iterations.
  options.maximumSeconds = 0;
  options.progress = [](double fraction) { return fraction < 2.3 / 16; };
  study = studySolvers(system, options);
  TAUTLINE_CHECK(study.aborted && !study.timeLimit);
  TAUTLINE_CHECK(study.rows[1].run && converged(study.rows[1].linear.reason));
  TAUTLINE_CHECK(study.rows[2].linear.reason == SolveReason::Aborted && !study.rows[3].run);
  TAUTLINE_CHECK(
    study.recommended >= 0 && contains(study.why, wording("13-were-not-run-the-study-was")));

  // PETSc options go where they have an effect; where none has, that is an error.
  options.progress = nullptr;
  options.combinations = { { KrylovMethod::ConjugateGradient, Preconditioner::Jacobi, false },
    { KrylovMethod::ConjugateGradient, Preconditioner::BoomerAMG, false } };
  const SolverStudy plain = studySolvers(system, options);
  options.solver.petscOptions = "-pc_hypre_boomeramg_max_iter 3";
  const SolverStudy changed = studySolvers(system, options);
  TAUTLINE_CHECK_EQUAL(changed.rows[0].linear.iterations, plain.rows[0].linear.iterations);
  TAUTLINE_CHECK(changed.rows[1].linear.iterations < plain.rows[1].linear.iterations);
  options.solver.petscOptions = "-pc_hypre_boomeramg_max_itter 3";
  TAUTLINE_CHECK_THROWS(studySolvers(system, options), "max_itter");
  options.solver.petscOptions.clear();
  options.solver.omega = 5;
  TAUTLINE_CHECK_THROWS(studySolvers(system, options), "SSOR");
  options.solver.omega = 1;
  options.combinations.clear();
  TAUTLINE_CHECK_THROWS(studySolvers(system, options), wording("no-combination"));
}
}
