// SPDX-License-Identifier: BSD-3-Clause
/**
 * Simultaneous untangling and smoothing as published by Escobar et al. 2003: the optimum of one
 * vertex, tangled meshes of all simplices, the smoothing of what was valid, threads, limits.
 */

#include "Blocks.h"
#include "Registry.h"
#include "tautline/Perturbation/Perturb.h"
#include "tautline/Untangling/Untangle.h"

using namespace tautline;

namespace
{
UntangleOptions simultaneous()
{
  return TAUTLINE_CHANGED(UntangleOptions(), method = UntangleMethod::Simultaneous);
}

Index countInvalid(const Mesh& mesh)
{
  const std::vector<signed char> validity = validityOf(mesh);
  return std::count_if(validity.begin(), validity.end(), [](signed char v) { return v != Valid; });
}

/// The mean inverse mean ratio.
double meanShape(const MeshData& data)
{
  std::vector<double> values(data.numberOfCells());
  evaluateMetric(Mesh(data.view()), Metric::InverseMeanRatio, {}, values.data());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

MeshData withPoints(MeshData data, const std::vector<double>& points)
{
  data.points = points;
  return data;
}

MeshData tangled(const MeshData& data, double part)
{
  TAUTLINE_LET(PerturbOptions, options, tangledFraction = part);
  return withPoints(data, perturb(Mesh(data.view()), nullptr, options).points);
}

/// Six equilateral triangles around a vertex that is outside: its best place is the center.
TAUTLINE_PART(testHexagon)
{
  for (const Vec3& start : { Vec3{ 1.6, 0.4, 0 }, Vec3{ -0.2, 3.0, 0 }, Vec3{ -1.3, 0.2, 0 } })
  {
    MeshData data;
    data.points = { start[0], start[1], 0 };
    constexpr double pi = 3.14159265358979323846;
    for (int k = 0; k < 6; ++k)
    {
      const double a = pi * k / 3;
      data.points.insert(data.points.end(), { std::cos(a), std::sin(a), 0 });
    }
    for (Index k = 0; k < 6; ++k)
    {
      data.addCell(CellType::Triangle, { 0, 1 + k, 1 + (k + 1) % 6 });
    }
    const Index before = countInvalid(Mesh(data.view()));
    TAUTLINE_CHECK(before > 0);
    const UntangleResult result = untangle(Mesh(data.view()), simultaneous());
    TAUTLINE_CHECK_EQUAL(result.invertedBefore, before);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK_NEAR(result.points[0], 0.0, 1e-3);
    TAUTLINE_CHECK_NEAR(result.points[1], 0.0, 1e-3);
    for (std::size_t i = 3; i < data.points.size(); ++i)
    {
      TAUTLINE_CHECK_EQUAL(result.points[i], data.points[i]); // the boundary
    }
  }
}

/// All elements become valid, and those far from inverted ones better, which automatic leaves.
TAUTLINE_PART(testTangledMeshes)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
         CellType::Hexahedron, CellType::Wedge })
  {
    const bool flat = topology(type).dimension == 2;
    const Context context(topology(type).plural);
    const Index n = flat ? 24 : 8;
    const MeshData data = tangled(blockMesh(type, n, n, flat ? 0 : n), 0.03);
    const Index before = countInvalid(Mesh(data.view()));
    const UntangleResult result = untangle(Mesh(data.view()), simultaneous());
    const UntangleResult usual = untangle(Mesh(data.view()), {});
    TAUTLINE_CHECK(before > 5);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK(result.reason == StopReason::AllValid);
    const MeshData after = withPoints(data, result.points);
    TAUTLINE_CHECK_EQUAL(countInvalid(Mesh(after.view())), 0);
    TAUTLINE_CHECK(meanShape(after) < 0.98 * meanShape(withPoints(data, usual.points)));
    // The history: the input, then a record per sweep, the last without inverted elements.
    TAUTLINE_CHECK_EQUAL(result.history.front().inverted, before);
    TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 0);
    TAUTLINE_CHECK(result.history.size() > 2 && result.history.size() <= 101);
    // Every free point moves.
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    Index still = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const bool moves = data.point(i)[0] != after.point(i)[0];
      TAUTLINE_CHECK(!boundary[i] || !moves);
      still += !boundary[i] && !moves;
    }
    TAUTLINE_CHECK_EQUAL(still, 0);
    // Any number of threads.
    UntangleOptions two = TAUTLINE_CHANGED(simultaneous(), threads = 2);
    TAUTLINE_CHECK(untangle(Mesh(data.view()), two).points == result.points);
  }
}

/// Valid meshes stay; a limit ends the run with no more inverted elements than before.
TAUTLINE_PART(testLimits)
{
  const MeshData valid = blockMesh(CellType::Triangle, 6, 6, 0);
  TAUTLINE_CHECK(untangle(Mesh(valid.view()), simultaneous()).points == valid.points);
  const MeshData data = tangled(blockMesh(CellType::Tetrahedron, 8, 8, 8), 0.2);
  for (int last : { 0, 1, 3 })
  {
    UntangleOptions options = simultaneous();
    options.observer = [last](const IterationState& state)
    { return state.record.iteration < last; };
    const UntangleResult result = untangle(Mesh(data.view()), options);
    const bool untangled = result.invertedAfter == 0; // by then
    TAUTLINE_CHECK(result.reason == (untangled ? StopReason::AllValid : StopReason::Aborted));
    TAUTLINE_CHECK(last > 1 || !untangled);
    TAUTLINE_CHECK_EQUAL(static_cast<int>(result.history.size()), last + 1);
    TAUTLINE_CHECK(result.invertedAfter <= result.invertedBefore);
    const MeshData after = withPoints(data, result.points);
    TAUTLINE_CHECK_EQUAL(countInvalid(Mesh(after.view())), result.invertedAfter);
  }
}
}
