// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VertexOptimizer.h
 * @brief Moves one free vertex to reduce the scalarized objective with the others fixed.
 * Internal: not installed.
 */
#ifndef tautline_VertexOptimizer_h
#define tautline_VertexOptimizer_h

#include "LocalOptions.h"
#include "PatchFunction.h"

namespace tautline
{
/// The work space of a thread.
template <int Dim>
struct PatchWorker
{
  VertexPatch<Dim> patch;
  std::vector<PatchSum<Dim>> sums; ///< of each objective over the patch
  /// Per objective: the trial change of the patch sum, the current value, dF/d(patch sum), and the
  /// change since the start of the sweep.
  std::vector<double> trial, now, slopes, change;
};

template <int Dim>
class VertexOptimizer
{
public:
  /// See LocalSweeper.
  VertexOptimizer(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options);

  void setPatchIterations(int count) { this->Options.patchIterations = count; }
  /// Sets the objectives at the start of a sweep.
  void begin(const std::vector<double>& values);
  PatchWorker<Dim> makeWorker() const;
  /// The objective at the start of the sweep after its patch sum has changed by this much.
  double objective(std::size_t i, double change) const
  {
    return this->Functions[i]->objective(this->Values[i], change);
  }
  /**
   * @brief Moves v if that reduces the objective; adds to worker.change.
   * @param gradient2 incremented by the squared gradient norm
   * @return whether it moved farther than the culling threshold
   */
  bool moveVertex(
    std::int32_t v, const Scalarizer& scalarizer, PatchWorker<Dim>& worker, double& gradient2);

private:
  std::unique_ptr<PatchFunction<Dim>> makeFunction(const LocalTerm& term) const;
  void gather(std::int32_t v, VertexPatch<Dim>& patch) const;
  void gatherCells(std::int32_t v, VertexPatch<Dim>& patch) const;
  void findTangents(std::int32_t v, Vec3* tangents) const;
  bool evaluate(PatchWorker<Dim>& w, const double* d, bool hessian) const;
  void findSlopes(const Scalarizer& scalarizer, PatchWorker<Dim>& w) const;
  PatchSum<Dim> combined(const PatchWorker<Dim>& w) const;
  double changeAt(const Scalarizer& scalarizer, PatchWorker<Dim>& w, const double* d) const;
  void newton(const PatchWorker<Dim>& w, const PatchSum<Dim>& sum, double* s) const;
  void newtonIn(const double basis[Dim][Dim], int free, const PatchSum<Dim>& sum, double* s) const;
  double conjugate(PatchWorker<Dim>& w, const PatchSum<Dim>& sum, const double* d, int iteration,
    double* direction, double* lastGradient) const;
  int allowed(std::int32_t v, double basis[Dim][Dim]) const;
  double limited(std::int32_t v, const double* d, const double* s, double t) const;
  bool hasLimit(std::int32_t v) const
  {
    return !this->Options.limits.empty() && std::isfinite(this->Options.limits[v]);
  }
  double wayFromStart(std::int32_t v, const double* d, double* way) const;
  bool turnAlongLimit(
    const PatchWorker<Dim>& w, const PatchSum<Dim>& sum, const double* d, double* direction) const;
  void keepLimit(std::int32_t v, double* to) const;
  /// The surface on which v slides, or null.
  const SurfaceProjection* surfaceOf(std::int32_t v) const
  {
    return this->Options.surfaces.empty() ? nullptr : this->Options.surfaces[v];
  }
  bool isLoose(std::int32_t v) const
  {
    return !this->Options.loose.empty() && this->Options.loose[v];
  }
  bool isOnCurve(std::int32_t v) const
  {
    const SurfaceProjection* surface = this->surfaceOf(v);
    return surface && surface->isCurve();
  }
  bool isOnSurface(std::int32_t v) const
  {
    return (Dim == 2 && this->Simplices.surface()) || this->surfaceOf(v) || this->isLoose(v);
  }
  std::vector<Vec3> normalsAt(std::int32_t v) const;
  bool isUpright(
    std::int32_t v, const VertexPatch<Dim>& patch, const std::vector<Vec3>& normals) const;
  bool search(const Scalarizer& scalarizer, PatchWorker<Dim>& w, const double* d,
    const double* direction, double t, double slope, bool alongLimit, double* to);
  bool staysValidInside(const VertexPatch<Dim>& patch, const double* d) const;
  bool placeMoved(
    std::int32_t v, const double* d, const Scalarizer& scalarizer, PatchWorker<Dim>& w);
  void place(std::int32_t v, const Vec3& x);
  bool placeOnSurface(
    std::int32_t v, const double* d, const Scalarizer& scalarizer, PatchWorker<Dim>& w);

  SimplexMesh& Simplices;
  const Mesh& TheMesh;
  double* Points;
  LocalOptions Options;
  bool NeedsCells = false;
  bool Guarded = false; ///< whether an objective may lack a barrier although no element may invert
  /// Whether elements could fold between their corners; initially valid elements stay valid.
  bool Inside = false;
  std::vector<signed char> Validities;
  VertexCells Cells;
  std::vector<std::unique_ptr<PatchFunction<Dim>>> Functions;
  std::vector<double> Values; ///< of the objectives at the start of the sweep
};

extern template class VertexOptimizer<2>;
extern template class VertexOptimizer<3>;
}
#endif
