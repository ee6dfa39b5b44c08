// SPDX-License-Identifier: BSD-3-Clause
// Elements broken by rounded points of a result are found on ranks as on one process, however the
// mesh is cut.
#include "OptimizingRanks.h"
#include "Registry.h"
#include "tautline/Optimization/RoundedResult.h"

using namespace tautline;

namespace
{
/// Points rounded to multiples of a step.
std::vector<double> rounded(std::vector<double> points, double step)
{
  for (double& x : points)
  {
    x = step * std::round(x / step);
  }
  return points;
}

/// The broken elements, as a number that differs by each.
int faults(const RoundedResult& found)
{
  return (found.lost > 0 ? 1 : 0) + (found.worseWorst ? 2 : 0) + (found.largerObjective ? 4 : 0);
}

/// @return the faults on one process
int compare(const MeshData& whole, const OptimizeOptions& options, double step)
{
  constexpr double close = 1e-12;
  const Mesh mesh(whole.view());
  OptimizeResult result = optimize(mesh, options);
  const std::vector<double> points = result.points, to = rounded(points, step);
  const RoundedResult expected =
    measureRounded(mesh, validityOf(whole), options, result, mesh.at(to.data()));
  forEachCut({ 1, 2, 3 },
    [&](Cut cut, int ranks)
    {
      const auto rankOf = cutBy(whole, cut, ranks);
      std::mutex mutex;
      onRanks(ranks,
        [&](RankGroup& group)
        {
          const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
          DistributedMesh pieces(group, { part.data.view(), nullptr, part.ghosts.data() });
          OptimizeResult local;
          local.invertedBefore = result.invertedBefore;
          local.points = pieces.points();
          for (std::size_t p = 0; p < part.pointOf.size(); ++p)
          {
            std::copy_n(
              &points[3 * part.pointOf[p]], 3, &local.points[3 * pieces.localOfPiece()[p]]);
          }
          pieces.exchange(local.points.data(), 3);
          const Mesh start = localMesh(pieces);
          const std::vector<double> there = rounded(local.points, step);
          const RoundedResult found = measureRounded(
            start, validityOf(start), options, local, start.at(there.data()), Ranks(pieces));
          const std::lock_guard<std::mutex> lock(mutex);
          TAUTLINE_CHECK_EQUAL(found.lost, expected.lost);
          TAUTLINE_CHECK_EQUAL(found.inverted, expected.inverted);
          TAUTLINE_CHECK_EQUAL(found.worseWorst, expected.worseWorst);
          TAUTLINE_CHECK_EQUAL(found.largerObjective, expected.largerObjective);
          TAUTLINE_CHECK_EQUAL(found.record.objectives.size(), expected.record.objectives.size());
          for (std::size_t i = 0; i < expected.record.objectives.size(); ++i)
          {
            const auto same = [close](double a, double b) { TAUTLINE_CHECK_RELATIVE(a, b, close); };
            same(found.record.objectives[i], expected.record.objectives[i]);
            same(found.record.mean[i], expected.record.mean[i]);
            same(found.record.worst[i], expected.record.worst[i]);
            same(found.record.objective, expected.record.objective);
          }
        });
    });
  return faults(expected);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestRoundedResult)
{
  std::vector<int> seen(8, 0);
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    for (const Metric second : { Metric::InverseMeanRatio, Metric::Size })
    {
      OptimizeOptions options = with({ Metric::InverseMeanRatio });
      if (second != Metric::InverseMeanRatio)
      {
        options = with({ Metric::InverseMeanRatio, second });
        options.scalarization.method = Scalarization::ObjectiveProduct;
        options.worstMetric = Metric::ScaledJacobian;
      }
      options.stopping.maximumIterations = 10;
      // From a mesh that is as good as that, and from one that is not.
      const MeshData given = jittered(type, topology(type).dimension == 2 ? 8 : 4, 0.2);
      MeshData good = given;
      good.points = optimize(Mesh(given.view()), options).points;
      for (const MeshData& whole : { given, good })
      {
        for (const double step : { 0.8, 0.1, 0.01, 1e-7 })
        {
          const Context context(std::string(topology(type).plural) + ", second metric " +
            std::to_string(static_cast<int>(second)) + ", step " + std::to_string(step));
          ++seen[compare(whole, options, step)];
        }
      }
    }
  }
  std::cout << "faults:";
  for (const int count : seen)
  {
    std::cout << " " << count;
  }
  std::cout << "\n";
  TAUTLINE_CHECK(seen[0] > 0);           // none
  TAUTLINE_CHECK(seen[1] > 0);           // valid elements lost
  TAUTLINE_CHECK(seen[2] + seen[6] > 0); // the worst element
  TAUTLINE_CHECK(seen[4] > 0);           // the objective alone
}
