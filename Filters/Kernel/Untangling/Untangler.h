// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Untangler.h
 * @brief The phases of untangling: sweeps around the inverted simplices; moves of all vertices at
 * once; continuation for rotated holes.
 * Internal: not installed.
 */
#ifndef tautline_Untangler_h
#define tautline_Untangler_h

#include "TangledMesh.h"
#include "UntangleProgress.h"
#include "tautline/Patches/SimplexMesh.h"

#include <limits>

namespace tautline
{
/// A decreasing sequence of regularizations, with a minimization for each.
struct Regularization
{
  double eps = 1.0;    ///< initial value; determinants are 1 for a simplex with mean edges
  double factor = 0.5; ///< ratio of successive values
  /// a solve ends if an iteration reduces the energy by less than this fraction
  double tolerance = 1e-3;
  int solves = 12;
  int iterations = 30; ///< maximum per solve
};

/// Sweeps around the invalid simplices.
struct SweepLimits
{
  int sweeps = 10;
  double progress = 0.7; ///< a sweep should leave at most this fraction of the invalid simplices
  int patience = 1;      ///< number of consecutive sweeps that may leave more
};

/// The untangling of a mesh of dimension Dim, 2 or 3.
template <int Dim>
class Untangler
{
public:
  /// The references must outlive this object.
  Untangler(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
    UntangleProgress& progress);

  /**
   * @brief Untangles until no simplex is invalid, or the effort is spent.
   * @param margin see TangledMesh::setMargin()
   * @return the best coordinates, VertexStride per vertex
   */
  const double* run(double margin);

  /// Simplices that no position of their free vertex makes valid with the current fixed vertices.
  const std::vector<std::int32_t>& infeasible() const { return this->Infeasible; }
  /// Whether a limit or the observer ended the run.
  bool stopped() const { return this->Progress.stopped(); }
  /// Cells that are not valid, the infeasible included.
  Index invalidCells() const;
  /// Whether all feasible simplices are valid.
  bool untangled() const { return this->State.invalid == 0; }

private:
  double* x() const { return this->Simplices.coordinates(); }
  void record();
  /// Makes the next record the best; the limits are kept.
  void forgetBest() { this->FewestInvalid = std::numeric_limits<Index>::max(); }
  void examine() { this->State = this->Tangled.examine(this->x()); }
  void setCoordinates(const std::vector<double>& from);
  std::vector<double> coordinates() const;
  double invalidFraction() const;
  bool done() const { return this->untangled() || this->stopped(); }

  void markActive(int rings);
  bool moved(std::int32_t simplex) const;
  void sweepLocally(const SweepLimits& limits);
  void excludeInfeasible();
  void smoothWorst();
  void smoothAll();
  void descend(const Regularization& schedule);
  bool startHarmonic(double tolerance);
  void continueRotation(double tolerance);
  void untangleAll();
  void untangleNearby();
  void untangleGlobally();
  void untangleThoroughly(const std::vector<double>& before, double firstEps);
  void untangleAutomatically();
  void untangleSimultaneously();

  const MeshView View;
  SimplexMesh& Simplices;
  const UntangleOptions& Options;
  TangledMesh<Dim> Tangled;
  UntangleProgress& Progress;
  bool OnlySimplices; ///< whether each cell is one simplex
  std::size_t Coordinates;
  std::vector<double> Start; ///< coordinates of the input
  std::vector<double> Best;  ///< coordinates with the fewest invalid cells
  Index FewestInvalid = 0;
  std::vector<unsigned char> Active;
  std::vector<std::int32_t> Infeasible;
  MeshState State;
  bool Continuing = false; ///< whether fixed vertices are displaced
};
}
#endif
