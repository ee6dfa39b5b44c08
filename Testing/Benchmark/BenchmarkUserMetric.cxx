// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkUserMetric N REPEATS: sums of squares with gradient of built-in metrics and of the same
// metrics as a user writes them (UserMetric.h), by automatic differentiation, on an N x N x N grid
// of perturbed cells; and the optimization of that grid by them with the default options. Prints
// lines "name<tab>built-in<tab>user's<tab>ratio": nanoseconds of one thread per element, and their
// ratio, the best of REPEATS in turns. The build compiles it twice, for any machine and
// (BenchmarkUserMetricNative) for the vector units of this one.

#include "Clocks.h"
#include "KuhnMesh.h"

#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/UserMetric.h"

#include <iostream>
#include <limits>

using namespace tautline;

namespace
{
struct Ratio
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return T.norm2() / (N * pow(T.det(), 2.0 / N));
  }
};

struct Condition
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return sqrt(T.norm2() * T.adjugate2()) / (N * T.det());
  }
};

/// |T - I|^2, entry by entry. Unrolled, the derivatives that are 0 cost nothing.
struct Distance
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    Number sum = 0.0;
#pragma GCC unroll 3
    for (int r = 0; r < N; ++r)
    {
#pragma GCC unroll 3
      for (int c = 0; c < N; ++c)
      {
        const Number x = T(r, c) - (r == c ? 1.0 : 0.0);
        sum += x * x;
      }
    }
    return sum;
  }
};

/// From the corners.
struct Edges
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    const CellTopology& t = topology(p.type());
    Number longest = 0.0, shortest = 1e300;
    for (int e = 0; e < t.edges; ++e)
    {
      const auto edge = p.edge(t.edgeNodes[e][0], t.edgeNodes[e][1]);
      const Number length2 = dot(edge, edge);
      longest = max(longest, length2);
      shortest = min(shortest, length2);
    }
    return sqrt(longest / shortest);
  }
};

/// The inverse mean ratio from the entries of T, not seen to be one of |T|^2 and det T.
struct EntryRatio
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    Number norm2 = 0.0;
#pragma GCC unroll 3
    for (int r = 0; r < N; ++r)
    {
#pragma GCC unroll 3
      for (int c = 0; c < N; ++c)
      {
        norm2 += T(r, c) * T(r, c);
      }
    }
    return norm2 / (N * pow(T.det(), 2.0 / N));
  }
};

/// The same from the corners of a tetrahedron: the sum of the squared edges by the volume.
struct CornerRatio
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    constexpr int apex = Nodes > 3 ? 3 : 2; // of tetrahedra only
    const auto a = p.edge(0, 1), b = p.edge(0, 2), c = p.edge(0, apex);
    const auto ab = p.edge(1, 2), bc = p.edge(2, apex), ca = p.edge(apex, 1);
    const double sqrt2 = std::sqrt(2.0); // det T of det A
    const Number norm2 =
      (dot(a, a) + dot(b, b) + dot(c, c) + dot(ab, ab) + dot(bc, bc) + dot(ca, ca)) / 2.0;
    return norm2 / (3.0 * pow(sqrt2 * dot(cross(a, b), c), 2.0 / 3.0));
  }
};

/// R / (3 r) of a tetrahedron from its corners.
struct CornerRadiusRatio
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    constexpr int apex = Nodes > 3 ? 3 : 2; // of tetrahedra only
    const auto a = p.edge(0, 1), b = p.edge(0, 2), c = p.edge(0, apex);
    const auto ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
    const Number volume6 = dot(ab, c);
    const Number areas2 = norm(ab) + norm(bc) + norm(ca) + norm(ab + bc + ca);
    // R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V) and r = 3 V / (sum of the areas).
    const Number aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
    DualVector<Number> sum;
    for (int i = 0; i < 3; ++i)
    {
      sum[i] = aa * bc[i] + bb * ca[i] + cc * ab[i];
    }
    return norm(sum) * areas2 / (6.0 * volume6 * volume6);
  }
};

MetricDescription describe(const char* name, bool scaleInvariant, bool rotationInvariant)
{
  MetricDescription d;
  d.name = name;
  d.scaleInvariant = scaleInvariant;
  d.rotationInvariant = rotationInvariant;
  return d;
}

/// As BenchmarkQuality's.
MeshData makeMesh(CellType type, Index n)
{
  MeshData data = blockMesh(CellType::Hexahedron, n, n, n);
  std::mt19937 random(1);
  data.transform(
    [&](Vec3 p)
    {
      for (double& x : p)
      {
        x += 0.2 * (random() / 4294967296.0 - 0.5);
      }
      return p;
    });
  return type == CellType::Hexahedron ? data : cutIntoTetrahedra(std::move(data), n);
}

MetricDescription ofTetrahedra(const char* name, bool barrier)
{
  MetricDescription d = describe(name, true, true);
  d.in2D = false;
  d.cellTypes = 1u << topologyIndex(CellType::Tetrahedron);
  d.barrier = barrier;
  return d;
}

/// Optimizes a mesh of tetrahedra by built-in metrics and their copies.
bool optimizeAll(Index n, int repeats)
{
  MetricDescription ratio = describe("o_imr", true, true),
                    entries = describe("o_entries", true, true),
                    condition = describe("o_condition", true, true);
  ratio.barrier = entries.barrier = condition.barrier = true;
  const std::pair<Metric, Metric> pairs[] = {
    { Metric::InverseMeanRatio, registerJacobianMetric(ratio, Ratio()) },
    { Metric::InverseMeanRatio, registerJacobianMetric(entries, EntryRatio()) },
    { Metric::InverseMeanRatio,
      registerCornerMetric(ofTetrahedra("o_corners", true), CornerRatio()) },
    { Metric::ConditionNumber, registerJacobianMetric(condition, Condition()) },
    { Metric::NormalizedRadiusRatio,
      registerCornerMetric(ofTetrahedra("o_radii", true), CornerRadiusRatio()) },
  };
  const MeshData data = makeMesh(CellType::Tetrahedron, n);
  const Mesh mesh(data.view());
  for (const auto& [builtIn, user] : pairs)
  {
    double best[2] = { std::numeric_limits<double>::infinity(),
      std::numeric_limits<double>::infinity() };
    double reached[2] = {};
    for (int i = 0; i < repeats; ++i)
    {
      for (int k = 0; k < 2; ++k)
      {
        OptimizeOptions options;
        options.objectives[0].metric = k == 0 ? builtIn : user;
        options.objectives[0].objectiveTemplate = ObjectiveTemplate::SumOfSquares;
        options.threads = 1;
        const double start = threadTime();
        const OptimizeResult result = optimize(mesh, options, {});
        best[k] = std::min(best[k], threadTime() - start);
        reached[k] = result.history.back().objective;
      }
    }
    constexpr double same = 1e-4; // both stop where an iteration is not worth its time
    if (!(std::abs(reached[1] / reached[0] - 1) < same))
    {
      std::cerr << "the optima differ: " << reached[0] << " and " << reached[1] << '\n';
      return false;
    }
    const double perElement = 1e9 / static_cast<double>(data.numberOfCells());
    std::cout << "tetrahedra " << metricInfo(user).name << " optimize\t" << perElement * best[0]
              << '\t' << perElement * best[1] << '\t' << best[1] / best[0] << std::endl;
  }
  return true;
}
}

int main(int argc, char* argv[])
{
  const Index n = argc == 3 ? std::atoi(argv[1]) : 0;
  const int repeats = argc == 3 ? std::atoi(argv[2]) : 0;
  if (n < 1 || repeats < 1)
  {
    std::cerr << "usage: BenchmarkUserMetric N REPEATS\n";
    return EXIT_FAILURE;
  }
  const std::pair<Metric, Metric> pairs[] = {
    { Metric::InverseMeanRatio, registerJacobianMetric(describe("u_imr", true, true), Ratio()) },
    { Metric::ConditionNumber,
      registerJacobianMetric(describe("u_condition", true, true), Condition()) },
    { Metric::ShapeSizeOrientation,
      registerJacobianMetric(describe("u_distance", false, false), Distance()) },
    { Metric::EdgeRatio, registerCornerMetric(describe("u_edges", true, true), Edges()) },
  };
  std::cout.precision(3);
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron })
  {
    const MeshData data = makeMesh(type, n);
    const Mesh mesh(data.view());
    std::vector<double> gradient(data.points.size(), 0.0);
    for (const auto& [builtIn, user] : pairs)
    {
      EvaluationOptions options;
      options.threads = 1;
      const MetricSum sums[] = { { mesh, builtIn, options, 2.0 }, { mesh, user, options, 2.0 } };
      for (const bool withGradient : { false, true })
      {
        double best[2] = { std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::infinity() };
        double values[2] = {};
        for (int i = 0; i < repeats; ++i)
        {
          for (int k = 0; k < 2; ++k)
          {
            const double start = threadTime();
            values[k] = withGradient ? sums[k].valueAndGradient(gradient.data()) : sums[k].value();
            best[k] = std::min(best[k], threadTime() - start);
          }
        }
        if (!(std::abs(values[1] / values[0] - 1) < 1e-10))
        {
          std::cerr << "the metrics differ: " << values[0] << " and " << values[1] << '\n';
          return EXIT_FAILURE;
        }
        const double perElement = 1e9 / static_cast<double>(data.numberOfCells());
        std::cout << topology(type).plural << ' ' << metricInfo(builtIn).name
                  << (withGradient ? " gradient" : " value") << '\t' << perElement * best[0] << '\t'
                  << perElement * best[1] << '\t' << best[1] / best[0] << '\n';
      }
    }
  }
  return optimizeAll(n, repeats) ? EXIT_SUCCESS : EXIT_FAILURE;
}
