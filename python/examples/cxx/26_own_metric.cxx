// SPDX-License-Identifier: BSD-3-Clause
// 26_own_metric [DATA]: registers a metric, a function of the corners of an element, and measures
// by its name.
#include <tautline/Quality/UserMetric.h>

#include <vtkElementQuality.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <iostream>
#include <string>

namespace
{
/// The longest edge by the shortest one. One template serves numbers, vectors of them, and
/// derivatives.
struct EdgeSpan
{
  template <class Number, int Nodes>
  Number value(const tautline::ElementCorners<Number, Nodes>& corners) const
  {
    const tautline::CellTopology& t = tautline::topology(corners.type());
    Number longest = norm(corners.edge(t.edgeNodes[0][0], t.edgeNodes[0][1]));
    Number shortest = longest;
    for (int e = 1; e < t.edges; ++e)
    {
      const Number length = norm(corners.edge(t.edgeNodes[e][0], t.edgeNodes[e][1]));
      longest = max(longest, length);
      shortest = min(shortest, length);
    }
    return longest / shortest;
  }
};
}

int main(int argc, char* argv[])
{
  tautline::MetricDescription facts;
  facts.name = "edge_span";
  facts.label = "Edge Span";
  facts.acceptable = { 1, 3 };
  facts.differentiable = false;
  tautline::registerCornerMetric(facts, EdgeSpan());

  const std::string data = argc > 1 ? argv[1] : "Data";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((data + "/plate.vtu").c_str());
  vtkNew<vtkElementQuality> quality;
  quality->SetInputConnection(reader->GetOutputPort());
  quality->AddMetricByName("edge_span");
  quality->Update();
  std::cout << quality->GetSummary() << "\n";
  return quality->GetStatistics()->GetValueByName(0, "Minimum").ToDouble() >= 1 ? 0 : 1;
}
