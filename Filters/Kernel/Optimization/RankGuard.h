// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankGuard.h
 * @brief What an optimization on ranks must not make worse, and the numbers of a record, measured
 * on all ranks. Internal: not installed.
 */
#ifndef tautline_RankGuard_h
#define tautline_RankGuard_h

#include "Optimize.h"
#include "tautline/Mesh/DistributedMesh.h"

namespace tautline
{
/// The local part with other points.
inline Mesh movedMesh(
  const DistributedMesh& mesh, bool mirrored, const std::vector<double>& points, int threads)
{
  MeshView view = mesh.view();
  view.points = points.data();
  Mesh moved(view, threads);
  moved.setMirrored(mirrored);
  return moved;
}

/**
 * @class tautline::RankGuard
 * @brief The counterpart of QualityGuard: the worst element of an input whose elements are all
 * valid.
 */
class RankGuard
{
public:
  /// The local cells at some points.
  struct Elements
  {
    std::vector<double> values; ///< of judged(), larger the worse; -infinity: not defined
    std::vector<signed char> validity;
    double worst = 0; ///< the largest value of the whole mesh
  };

  /// Measures the input. Collective. @param valid whether no element of it is invalid
  RankGuard(const DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options, bool valid);

  const Objective& judged() const { return this->Judged; }
  /// Whether the input has no invalid element and inversion is not allowed.
  bool active() const { return this->Active; }
  /// Whether a value of the metric is worse than that of the worst element of the input.
  bool worse(double value) const { return this->isWorse(this->Larger ? -value : value); }
  /// Whether a local cell is invalid, or worse than all of the input.
  bool offends(const Elements& elements, Index cell) const
  {
    return elements.validity[cell] != Valid || this->isWorse(elements.values[cell]);
  }
  /// Whether one of any rank does; never if not active(). Collective.
  bool violatedAt(const Elements& elements) const;
  /// Collective.
  Elements measure(const std::vector<double>& points) const;

private:
  void requireValues(const Elements& start) const;
  bool isWorse(double value) const;

  const DistributedMesh& TheMesh;
  bool Mirrored;
  int Threads;
  Objective Judged;
  bool Larger = false, HoldsWorst = false, Active;
  double Worst = 0;
};

/**
 * @brief Adds the value, the mean and the worst of an objective on the whole mesh to a record.
 * Collective.
 * @param objective with its template; its weights are of local cells
 * @param moved the local part; null on a rank without cells
 * @param validity of the local cells
 */
void addObjectiveOnRanks(const DistributedMesh& mesh, const Objective& objective, const Mesh* moved,
  const std::vector<signed char>& validity, IterationRecord& record);
}
#endif
