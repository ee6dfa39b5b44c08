// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedEnergy.h
 * @brief A sum over the samples of curved elements, with its gradient and the product of its
 * Hessian with a vector.
 * Internal: not installed.
 *
 * E = sum over items, their samples q: weight w_q f(T_q), T = M^(1/2) A W^-1, A the Jacobian of the
 * map. Hessians are applied matrix-free, sample by sample, from T and the derivatives of f.
 */
#ifndef tautline_CurvedEnergy_h
#define tautline_CurvedEnergy_h

#include "SampleFunction.h"
#include "SampleTable.h"
#include "tautline/Core/Parallel.h"

namespace tautline
{
/// An element, by its nodes as positions of points.
struct CurvedElement
{
  const ElementType* type;
  bool mirrored; ///< treated as its mirror image
  Index cell;    ///< of the mesh
  std::vector<Index> nodes;
};

/// Samples of one element.
struct SampleItem
{
  Index element;
  std::shared_ptr<const SampleTable> table;
  double weight = 1;  ///< of all its samples together; 0: excluded
  double perSize = 1; ///< T is multiplied by it
  /// The right factor of T: dimension^2 packets per packet of the table, row by row; or empty.
  std::vector<Packet> targets;
  /// The left factor of T, symmetric; used if `rooted`.
  SmallMatrix root = {};
  bool rooted = false;
};

/// The diagonal block of the Hessian for one point.
using PointBlock = std::array<std::array<double, 3>, 3>;

/// The range of the values of a function at samples.
struct SampleRange
{
  double mean, largest;
};

/**
 * @class CurvedEnergy
 * @brief Points have 3 coordinates each, of which the first Dim are used.
 */
template <int Dim>
class CurvedEnergy
{
public:
  /// All arguments must outlive the energy.
  CurvedEnergy(const std::vector<CurvedElement>& elements, Index points, int threads);

  /// Replaces the samples. Elements without an item are ignored.
  void setItems(std::vector<SampleItem> items);
  const std::vector<SampleItem>& items() const { return this->Items; }
  /// Multiplies the weights of the items from a position on.
  void scaleWeights(std::size_t first, double factor);
  void addItems(const std::vector<SampleItem>& items);

  /// Infinite if the function is undefined at a sample.
  double value(const SampleFunction<Dim>& function, const std::vector<double>& x);
  /// The share of the first items in the last value.
  double partialValue(std::size_t items) const;
  /// The energy and its gradient; prepares apply() and the blocks.
  double linearize(const SampleFunction<Dim>& function, const std::vector<double>& x,
    std::vector<double>& gradient, std::vector<PointBlock>& diagonal);
  /// The product of the Hessian with d, at the last argument of linearize().
  void apply(const std::vector<double>& d, std::vector<double>& product);

  /// Covers the first items with nonzero weight.
  SampleRange range(
    const SampleFunction<Dim>& function, const std::vector<double>& x, std::size_t items);
  /// The means of |A W^-1|^2 over the samples of each item.
  std::vector<double> meanNorms(const std::vector<double>& x);
  /// The smallest det T of the samples of all items.
  double leastDeterminant(const std::vector<double>& x);
  /// The smallest det A of the samples of each element, relative to its reference coordinates;
  /// infinite without samples.
  std::vector<double> leastJacobians(const std::vector<double>& x);

private:
  /// The data of a packet of samples kept between linearize() and apply().
  struct Kept
  {
    Packet t[Dim][Dim];
    Packet slopes[NumberOfInvariants];
    Packet curvatures[NumberOfSecondDerivatives];
    Packet bend;
  };
  struct Scratch
  {
    std::vector<Packet> sums;
  };

  template <class Work>
  void forEachItem(const Work& work);
  void load(const SampleItem& item, int packet, const double* x, Packet (&t)[Dim][Dim]) const;
  void loadIdeal(const SampleItem& item, int packet, const double* x, Packet (&t)[Dim][Dim]) const;
  template <class Load>
  void findLeast(const std::vector<double>& x, const Load& load);
  void addRow(const SampleItem& item, int packet, const Packet (&p)[Dim][Dim],
    std::vector<Packet>& sums) const;
  void keep(const std::vector<Packet>& sums, std::size_t item);
  void addDiagonal(
    const SampleItem& item, int packet, const Kept& kept, std::vector<Packet>& sums) const;
  void changeOf(
    const Kept& kept, const Packet (&dt)[Dim][Dim], Packet (&derivative)[Dim][Dim]) const;
  double total(const std::vector<double>& values) const;
  void gather(std::vector<double>& to) const;

  const std::vector<CurvedElement>& Elements;
  Index Points;
  int Threads;
  std::vector<SampleItem> Items;
  std::vector<std::size_t> First;       ///< by item, in Shares: nodes x Dim numbers
  std::vector<std::size_t> FirstPacket; ///< by item, in State
  std::vector<double> Shares, Values, Blocks;
  std::vector<Index> Offsets;         ///< by point, in Positions
  std::vector<std::size_t> Positions; ///< of the shares of a point, in units of Dim
  std::vector<Kept> State;
  bool Adjugate = false, Trace = false;
  ScratchPool<Scratch> Pool;
};
}
#endif
