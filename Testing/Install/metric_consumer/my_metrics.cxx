// SPDX-License-Identifier: BSD-3-Clause
// Two metrics, registered when the library is loaded. The shell, Python and ParaView load it by
//   export TAUTLINE_METRICS=/path/to/libmy_metrics.so
#include "tautline/Quality/UserMetric.h"

namespace
{
/// The distance of T from a multiple of a rotation, with a barrier:
/// |T|^2 / det^(2/n) - n, 0 for the target in any size and orientation.
struct Distortion
{
  template <class Number, int N>
  Number value(const tautline::CornerJacobian<Number, N>& T) const
  {
    return T.norm2() / pow(T.det(), 2.0 / N) - N;
  }
};

/// The longest edge, from the corners of the element.
struct LongestEdge
{
  template <class Number, int Nodes>
  Number value(const tautline::ElementCorners<Number, Nodes>& corners) const
  {
    const tautline::CellTopology& t = tautline::topology(corners.type());
    Number longest = 0.0;
    for (int e = 0; e < t.edges; ++e)
    {
      longest = max(longest, norm(corners.edge(t.edgeNodes[e][0], t.edgeNodes[e][1])));
    }
    return longest;
  }
};

const tautline::MetricRegistration distortion(
  []()
  {
    tautline::MetricDescription facts;
    facts.name = "my_distortion";
    facts.label = "My distortion";
    facts.formula = "|T|^2 / det T^(2/n) - n";
    facts.source = "Testing/Install/metric_consumer";
    facts.acceptable = { 0, 2 };
    facts.ideal = 0;
    facts.barrier = true;
    facts.scaleInvariant = true;
    tautline::registerJacobianMetric(facts, Distortion());
  });

const tautline::MetricRegistration longestEdge(
  []()
  {
    tautline::MetricDescription facts;
    facts.name = "longest_edge";
    facts.label = "Longest edge";
    facts.unit = "length";
    facts.differentiable = false;
    tautline::registerCornerMetric(facts, LongestEdge());
  });
}
