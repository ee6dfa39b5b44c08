// SPDX-License-Identifier: BSD-3-Clause
#include "InputMetric.h"

#include "tautline/Core/Parallel.h"

namespace tautline
{
InputMetric::InputMetric(const std::vector<MetricTensor>& metrics, const ReconnectionInput& input,
  const InputLocator& locator, int threads)
  : Input(input)
  , Locator(locator)
  , Logarithms(metrics.size())
{
  forEachChunk(static_cast<Index>(metrics.size()), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        this->Logarithms[v] = functionOf(metrics[v], [](double value) { return std::log(value); });
      }
    });
}

MetricTensor InputMetric::at(const Vec3& x, TetId& cell) const
{
  cell = this->Locator.nearest(x, cell);
  std::array<double, 4> weights = this->Locator.weights(x, cell);
  // Outside the input, use approximately the nearest position in the cell.
  double sum = 0.0;
  for (double& w : weights)
  {
    w = std::max(w, 0.0); // NaN of a flat cell becomes 0
    sum += w;
  }
  const TetVertices& v = this->Input.cells[cell];
  // Interpolation of the logarithms keeps the result positive definite.
  MetricTensor mean = {};
  for (int i = 0; i < 4; ++i)
  {
    const double w = sum > 0.0 ? weights[i] / sum : 0.25;
    for (std::size_t k = 0; k < mean.size(); ++k)
    {
      mean[k] += w * this->Logarithms[v[i]][k];
    }
  }
  return functionOf(mean, [](double value) { return std::exp(value); });
}
}
