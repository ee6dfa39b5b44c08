/**
 * @file LocalSweep.h
 * @brief Sweeps over the free vertices that move one after the other, given where the others are by then.
 * Internal: not installed.
 */
#ifndef tautline_LocalSweep_h
#define tautline_LocalSweep_h

#include "Optimize.h"
#include "PatchFunction.h"
#include "SurfaceProjection.h"

namespace tautline
{
/// One of the objectives as the sweeps see it: by the power, the size or the metric, whichever is set.
struct LocalTerm
{
  /// The power (1 or 2) of an inverse mean ratio; 0: see metric.
  int shapePower = 0;
  /// Above 0: the squared inverse mean ratio with emphasis on values near this, see WorstRatioEnergy.
  double worst = 0;
  /// The size to the power of 2, times this; 0: see metric.
  double sizeSquared = 0;
  const ObjectiveSum* metric = nullptr;
};

struct LocalOptions
{
  bool newton = true; ///< or Polak-Ribiere+ conjugate gradients
  int patchIterations = 1;
  double relaxation = 1.0;
  double culling = 0.0;
  bool allowInversion = false;
  int threads = 0;
  /// Per vertex of the simplex mesh, or empty: a direction (line or plane normal) or zero.
  std::vector<Vec3> planes, lines;
  /// Per vertex: the start and how far from it the vertex may go, in the simplex mesh's coordinates; or empty.
  std::vector<double> limits, start;
  /// What a surface mesh is projected to, or what the vertices of onSurface slide on.
  const SurfaceProjection* surface = nullptr;
  std::vector<unsigned char> onSurface; ///< per vertex, or empty
  /// Per simplex, or empty; of the fast terms. Needs SimplexMesh::indexPatches().
  std::vector<double> weights;
};

struct SweepResult
{
  Index visited = 0;
  Index moved = 0;
  double gradientNorm =
    0; ///< of the gradients each vertex saw, over those visited; per length of the mesh
};

class LocalSweeper
{
public:
  /**
   * @param points 3 per point of `mesh`, kept up to date with the simplex mesh if a term needs it; `mesh`
   * is a mesh whose view has these points
   */
  LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options);
  ~LocalSweeper();

  /**
   * @brief One sweep. Objective values in `values` are those of the mesh before and, up to rounding, after.
   * A step is taken if it lowers the scalarized objective.
   */
  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values);

  /// Lets all vertices move again, whatever was culled.
  void wakeAll();

private:
  struct Base;
  template <int Dim>
  struct Implementation;
  std::unique_ptr<Base> Impl;
};
}
#endif
