// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PatchFunction.h
 * @brief One objective as a function of one free vertex: in closed form if it is an energy f(N, D),
 * otherwise through the evaluator of the metric.
 * Internal: not installed.
 */
#ifndef tautline_PatchFunction_h
#define tautline_PatchFunction_h

#include "tautline/Objectives/ObjectiveSumState.h"
#include "tautline/Patches/Energies.h"

#include <memory>

namespace tautline
{
/// Cells of one type around a vertex, in the form required by the metric evaluators.
struct CellBatch
{
  Batch batch;
  int block = 0;
  Packet here[MaxNodes]; ///< 1 in the lanes whose cell has the vertex at this position, otherwise 0
};

/// The data of the current vertex. One per thread.
template <int Dim>
struct VertexPatch
{
  std::int32_t vertex = -1;
  Patch<Dim> simplices;
  std::vector<CellBatch> cells; ///< only filled if a function needs them
  int cellBatches = 0;
  /// Displacement in the coordinates of the mesh = sum axes[c] d[c].
  Vec3 axes[Dim];
};

/// The value, gradient and Hessian of one objective with respect to the displacement of a vertex.
template <int Dim>
class PatchFunction
{
public:
  virtual ~PatchFunction() = default;
  virtual bool needsCells() const { return false; }
  /// The scale of PowerMean and Maximum: the objective's current value.
  virtual void setCurrent(double /*value*/) {}
  /// The objective after its patch sum has changed by `change` since setCurrent(value).
  virtual double objective(double value, double change) const { return value + change; }
  /// Its derivative with respect to the change, at 0.
  virtual double slope(double /*value*/) const { return 1.0; }
  virtual double value(const VertexPatch<Dim>& patch, const double* d) const = 0;
  virtual PatchSum<Dim> sum(const VertexPatch<Dim>& patch, const double* d, bool hessian) const = 0;
};

template <int Dim, class Energy>
class EnergyFunction : public PatchFunction<Dim>
{
public:
  explicit EnergyFunction(const Energy& energy)
    : TheEnergy(energy)
  {
  }
  double value(const VertexPatch<Dim>& patch, const double* d) const override
  {
    return valueOver(patch.simplices, d, this->TheEnergy);
  }
  PatchSum<Dim> sum(const VertexPatch<Dim>& patch, const double* d, bool) const override
  {
    return sumOver(patch.simplices, d, this->TheEnergy);
  }

private:
  Energy TheEnergy;
};

/// Any metric and template.
template <int Dim>
class MetricFunction : public PatchFunction<Dim>
{
public:
  /// The sum must outlive the function.
  explicit MetricFunction(const ObjectiveSumState& sum)
    : Sum(sum)
  {
    for (const CellBlock& block : sum.elements.mesh().blocks())
    {
      const Metric metric = sum.objective.metric;
      const Mesh& mesh = sum.elements.mesh();
      this->Contexts.push_back(contextFor(mesh, block, metric, sum.elements.options()));
      this->Value.push_back(elementEvaluatorFor(mesh, metric, metricCode(metric), block, false));
      this->Gradient.push_back(elementEvaluatorFor(mesh, metric, metricCode(metric), block, true));
    }
  }

  bool needsCells() const override { return true; }
  void setCurrent(double value) override { this->Current = value; }

  double objective(double value, double change) const override
  {
    switch (this->Sum.function.objectiveTemplate)
    {
      case ObjectiveTemplate::PowerMean: // the patch sum is in units of value^p
        return value * std::pow(std::max(0.0, 1.0 + change), 1.0 / this->Sum.function.power);
      case ObjectiveTemplate::Maximum: // the patch sum is in units of exp(k value)
        return value + std::log1p(std::max(-1.0, change)) / this->Sum.function.power;
      default:
        return value + change;
    }
  }

  double slope(double value) const override
  {
    const ElementFunction& function = this->Sum.function;
    return function.objectiveTemplate == ObjectiveTemplate::PowerMean ? value / function.power
      : function.objectiveTemplate == ObjectiveTemplate::Maximum      ? 1.0 / function.power
                                                                      : 1.0;
  }

  double value(const VertexPatch<Dim>& patch, const double* d) const override
  {
    double total = 0;
    const Vec3 shift = this->shiftOf(patch, d);
    for (int i = 0; i < patch.cellBatches; ++i)
    {
      const CellBatch& cells = patch.cells[i];
      if (this->Value[cells.block])
      {
        Batch batch;
        Packet value, slope;
        this->evaluate(cells, shift, this->Value[cells.block], batch, value, slope);
        total += sumOf(value);
      }
    }
    return total;
  }

  PatchSum<Dim> sum(const VertexPatch<Dim>& patch, const double* d, bool hessian) const override
  {
    PatchSum<Dim> result = this->gradient(patch, d);
    if (hessian)
    {
      // Use differences of the gradient over a small fraction of the patch size; one-sided
      // differences suffice for a direction.
      constexpr double fraction = 1e-6;
      const double h = fraction * sizeOf(patch.simplices);
      for (int r = 0; r < Dim; ++r)
      {
        double forth[Dim];
        std::copy_n(d, Dim, forth);
        forth[r] += h;
        const PatchSum<Dim> plus = this->gradient(patch, forth);
        for (int c = 0; c < Dim; ++c)
        {
          result.H[r][c] = (plus.g[c] - result.g[c]) / h;
        }
      }
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < r; ++c)
        {
          result.H[r][c] = result.H[c][r] = 0.5 * (result.H[r][c] + result.H[c][r]);
        }
      }
    }
    return result;
  }

private:
  Vec3 shiftOf(const VertexPatch<Dim>& patch, const double* d) const
  {
    Vec3 shift = { 0, 0, 0 };
    for (int c = 0; c < Dim; ++c)
    {
      shift += d[c] * patch.axes[c];
    }
    return shift;
  }

  void evaluate(const CellBatch& cells, const Vec3& shift, BatchEvaluator evaluator, Batch& batch,
    Packet& value, Packet& slope) const
  {
    const BatchContext& context = this->Contexts[cells.block];
    const bool mirrored =
      context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
    batch.count = cells.batch.count;
    batch.moving = context.user ? cells.here : nullptr;
    std::copy_n(cells.batch.cells, PacketWidth, batch.cells);
    for (int k = 0; k < context.topology->nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double by = mirrored && c == 0 ? -shift[c] : shift[c];
        batch.points[k][c] = cells.batch.points[k][c] + by * cells.here[k];
      }
    }
    evaluator(context, batch);
    replaceNonFinite(context, batch);
    const ElementFunction& function = this->Sum.function;
    withTemplate(function.objectiveTemplate,
      [&](auto objectiveTemplate)
      {
        constexpr ObjectiveTemplate Template = decltype(objectiveTemplate)::value;
        if constexpr (Template == ObjectiveTemplate::PowerMean ||
          Template == ObjectiveTemplate::Maximum)
        {
          function.template share<Template>(context, batch, this->Current, value, slope);
        }
        else
        {
          function.template term<Template>(context, batch, value, slope);
        }
      });
    value = onlyCells(batch, value);
    slope = onlyCells(batch, slope);
  }

  PatchSum<Dim> gradient(const VertexPatch<Dim>& patch, const double* d) const
  {
    PatchSum<Dim> result = {};
    Vec3 total = { 0, 0, 0 };
    const Vec3 shift = this->shiftOf(patch, d);
    for (int i = 0; i < patch.cellBatches; ++i)
    {
      const CellBatch& cells = patch.cells[i];
      if (!this->Gradient[cells.block])
      {
        continue;
      }
      Batch batch;
      Packet value, slope;
      this->evaluate(cells, shift, this->Gradient[cells.block], batch, value, slope);
      const BatchContext& context = this->Contexts[cells.block];
      const bool mirrored =
        context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
      result.f += sumOf(value);
      for (int c = 0; c < 3; ++c)
      {
        Packet g = batch.moving ? batch.gradient[0][c] : Packet{};
        for (int k = 0; k < context.topology->nodes && !batch.moving; ++k)
        {
          g += select(cells.here[k] > 0.0, batch.gradient[k][c], Packet{});
        }
        const double sum = sumOf(finiteOrZero(slope * g));
        total[c] += mirrored && c == 0 ? -sum : sum;
      }
    }
    for (int c = 0; c < Dim; ++c)
    {
      result.g[c] = dot(total, patch.axes[c]);
    }
    return result;
  }

  const ObjectiveSumState& Sum;
  std::vector<BatchContext> Contexts;
  std::vector<BatchEvaluator> Value, Gradient;
  double Current = 1;
};
}
#endif
