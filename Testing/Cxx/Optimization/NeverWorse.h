// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NeverWorse.h
 * @brief Random meshes, and what must not get worse on them, computed from element values alone.
 */
#ifndef tautline_NeverWorse_h
#define tautline_NeverWorse_h

#include "Optimizing.h"

namespace tautline
{
/// A block with a wavy side, as a surface on request; inner points are moved by up to `amplitude`.
inline MeshData randomMesh(CellType type, bool surface, double amplitude, unsigned seed)
{
  const Index n = topology(type).dimension == 2 ? 6 : 4;
  MeshData data = perturbedBlock(type, n, amplitude, seed);
  const double wave = 0.05 * (seed % 4);
  data.transform(TAUTLINE_PLACE(p[0] * (1 + wave * std::sin(1.3 * p[1])), p[1],
    surface ? 0.3 * std::sin(p[0]) * std::cos(p[1]) : p[2]));
  return data;
}

/// The objective of a preset, computed from element values alone.
inline double objectiveOf(Preset preset, const Mesh& mesh, const Targets* targets)
{
  const Index cells = mesh.view().numberOfCells;
  const auto sum = [&](Metric metric, const Targets* of, bool reciprocal)
  {
    TAUTLINE_LET(EvaluationOptions, evaluation, targets = of);
    std::vector<double> q(cells);
    evaluateMetric(mesh, metric, evaluation, q.data());
    return std::accumulate(q.begin(), q.end(), 0.0,
      [reciprocal](double total, double v) { return total + (reciprocal ? 1 / (v * v) : v * v); });
  };
  const double shape = sum(Metric::InverseMeanRatio, targets, false);
  switch (preset)
  {
    case Preset::UniformSize:
      return shape * sum(Metric::Size, nullptr, false);
    case Preset::LowInterpolationError:
      return shape * sum(Metric::InterpolationSizeShape, nullptr, true);
    default:
      return shape;
  }
}

/// The value of the worst element, as smaller is better.
inline double worstOf(const Mesh& mesh, const OptimizeOptions& options, CellType type)
{
  const bool jacobian =
    options.improveWorst > 0 && topology(type).samples > 1 && type != CellType::Pyramid;
  EvaluationOptions evaluation = options.objectives[0].evaluation;
  std::vector<double> q(mesh.view().numberOfCells);
  evaluateMetric(
    mesh, jacobian ? Metric::ScaledJacobian : Metric::InverseMeanRatio, evaluation, q.data());
  return jacobian ? -*std::min_element(q.begin(), q.end()) : *std::max_element(q.begin(), q.end());
}
}
#endif
