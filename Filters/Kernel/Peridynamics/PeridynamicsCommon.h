/**
 * @file PeridynamicsCommon.h
 * @brief What the two readings of the peridynamic integrals share. Internal to the kernel: not
 * installed.
 */
#ifndef tautline_PeridynamicsCommon_h
#define tautline_PeridynamicsCommon_h

#include "PeridynamicOptions.h"

#include <array>
#include <chrono>
#include <memory>

namespace tautline
{
/// Squared distance of the segments a-b and c-d, 0 where they cross.
double squaredSegmentDistance(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// The mesh with all triangles counter-clockwise, and what is known of each.
struct PlanarTriangles
{
  std::vector<Vec2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<double> areas;
  std::vector<Vec2> low, high; ///< corners of the bounding boxes
  double shortestEdge = 0.0;
  bool flipped = false; ///< corners 1 and 2 of every triangle are exchanged

  /// Throws Error for a mesh that cannot be integrated over.
  explicit PlanarTriangles(const HorizonMesh& mesh);
  Index size() const { return static_cast<Index>(this->triangles.size()); }
  Vec2 corner(Index t, int k) const { return this->points[this->triangles[t][k]]; }
};

/// Boxes sorted into a grid, to find those near another.
class BoxGrid
{
public:
  BoxGrid(const std::vector<Vec2>& low, const std::vector<Vec2>& high);
  /// All boxes at most `reach` from the given one, in an order that depends on the grid alone.
  void near(Vec2 low, Vec2 high, double reach, std::vector<std::int32_t>& found) const;

private:
  Index column(double x) const;
  Index row(double y) const;

  const std::vector<Vec2>&Low, &High;
  Vec2 Origin = {}, Cell = {}, LargestHalf = {};
  Index Columns = 1, Rows = 1;
  std::vector<std::int32_t> Starts, Boxes;
};

/// Which functions there are, and where.
struct FunctionSpace
{
  PeridynamicBasis basis;
  Index functions = 0, unknowns = 0;
  std::vector<Index> unknownOf, functionOf;
  std::vector<Vec2> low, high; ///< boxes around the supports of the functions

  FunctionSpace(
    const HorizonMesh& mesh, const PlanarTriangles& triangles, const PeridynamicOptions& options);
  int perTriangle() const { return this->basis == PeridynamicBasis::Constant ? 1 : 3; }
  Index function(const PlanarTriangles& triangles, Index t, int k) const
  {
    return this->basis == PeridynamicBasis::Constant ? t
      : this->basis == PeridynamicBasis::Linear      ? triangles.triangles[t][k]
                                                : 3 * t + (triangles.flipped ? (3 - k) % 3 : k);
  }
};

/// What an assembly works on and puts into.
struct PeridynamicWork
{
  const PlanarTriangles& triangles;
  const BoxGrid& grid;
  const FunctionSpace& space;
  const PeridynamicOptions& options;
};

/**
 * @brief Adds up the rows of the functions of one triangle.
 *
 * An assembler keeps the sums of three functions (each with one or two components) over all
 * functions; values are added by function, and go to the matrix all at once.
 */
class RowSums
{
public:
  RowSums(Index functions, int components)
    : Components(components)
    , Sums(static_cast<std::size_t>(3 * functions * components * components), 0.0)
    , Functions(functions)
  {
  }
  /// The components^2 numbers of local function a against function f.
  double* at(int a, Index f)
  {
    const int c = this->Components * this->Components;
    return this->Sums.data() + (a * this->Functions + f) * c;
  }

private:
  int Components;
  std::vector<double> Sums;
  Index Functions;
};

/// Integrates one triangle against the triangles near it and adds to the rows of its functions.
class TriangleAssembler
{
public:
  virtual ~TriangleAssembler() = default;
  virtual void assemble(Index t, const std::vector<std::int32_t>& near, RowSums& sums) = 0;
};

std::unique_ptr<TriangleAssembler> makeDissertationAssembler(const PeridynamicWork& work);

/// Integrals over pairs of triangles, kept for congruent ones.
class PairIntegrals;
std::shared_ptr<PairIntegrals> makePairIntegrals(
  const PeridynamicWork& work, const std::function<bool(double)>& proceed);
Index numberOfIntegratedPairs(const PairIntegrals& integrals);
std::unique_ptr<TriangleAssembler> makeExactAssembler(
  const PeridynamicWork& work, const PairIntegrals& integrals);

/// s of the bilinear form.
double kernelScale(const PeridynamicOptions& options);
}
#endif
