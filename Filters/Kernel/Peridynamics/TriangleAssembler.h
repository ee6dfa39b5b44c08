// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleAssembler.h
 * @brief The common part of the two discretizations of the peridynamic integrals.
 * Internal: not installed.
 */
#ifndef tautline_TriangleAssembler_h
#define tautline_TriangleAssembler_h

#include "BondCut.h"
#include "FunctionSpace.h"

#include <memory>

namespace tautline
{
/// The input and output of an assembly.
struct PeridynamicWork
{
  const PlanarTriangles& triangles;
  const BoxGrid& grid;
  const FunctionSpace& space;
  const PeridynamicOptions& options;
  const BondCut& cut;
  const std::vector<char>& needed; ///< per triangle: whether rows of its functions are assembled

  /// The triangles with which triangle t interacts, including itself.
  void neighboursOf(Index t, std::vector<std::int32_t>& near) const
  {
    this->grid.near(this->triangles.low[t], this->triangles.high[t], this->options.horizon, near);
    this->cut.keepVisible(t, near);
  }
};

/**
 * @brief Adds up the rows of the functions of one triangle.
 *
 * An assembler keeps the sums of three functions (each with one or two components) over all
 * functions; values are added by function and moved to the matrix together.
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

/// Integrates one triangle against nearby triangles and adds to the rows of its functions.
class TriangleAssembler
{
public:
  virtual ~TriangleAssembler() = default;
  virtual void assemble(Index t, const std::vector<std::int32_t>& near, RowSums& sums) = 0;
};

std::unique_ptr<TriangleAssembler> makeDissertationAssembler(const PeridynamicWork& work);

/// Integrals over pairs of triangles, kept for congruent ones.
class PairIntegrals;
/// Finds the pairs whose integrals are kept.
std::shared_ptr<PairIntegrals> makePairIntegrals(const PeridynamicWork& work);
/**
 * @brief Integrates one of several parts of the pairs.
 * @param slice 0 to slices - 1
 * @param proceed receives the fraction of all pairs done and returns whether to continue
 */
void integratePairs(
  PairIntegrals& integrals, Index slice, Index slices, const std::function<bool(double)>& proceed);
Index numberOfIntegratedPairs(const PairIntegrals& integrals);
std::unique_ptr<TriangleAssembler> makeExactAssembler(
  const PeridynamicWork& work, const PairIntegrals& integrals);

/**
 * @brief For the state-based model: adds (lambda - mu) int theta(u) theta(w) to the matrix and the
 * load of the given values, see Dilatation.h.
 *
 * The integral over x uses a rule of degree 5 on each triangle; the integral over y is exact.
 * @param proceed receives the fraction done and returns whether to continue
 */
void addDilatation(const PeridynamicWork& work, const std::vector<double>* given,
  PeridynamicSystem& system, const std::function<bool(double)>& proceed);
}
#endif
