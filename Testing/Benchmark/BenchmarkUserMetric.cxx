// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkUserMetric N REPEATS: sums of squares with gradient of built-in metrics and of the same
// metrics as a user writes them (UserMetric.h), by automatic differentiation, on an N x N x N grid
// of perturbed cells. Prints lines "name<tab>built-in<tab>user's<tab>ratio": nanoseconds of one
// thread per element, and their ratio, the best of REPEATS in turns. The build compiles it twice,
// for any machine and (BenchmarkUserMetricNative) for the vector units of this one.

#include "Clocks.h"
#include "KuhnMesh.h"

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
  return EXIT_SUCCESS;
}
