// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPointwise.h"

#include "WarpBatches.h"
#include "tautline/Geometry/PointTree.h"

#include <type_traits>

namespace tautline
{
namespace
{
constexpr double LargestPower = 20.0;
/// Squared distance below which points coincide; above it, the largest power is far from overflow.
constexpr double Coincident = 1e-28;
constexpr std::size_t InverseDistanceLeafSize = 16;
/// A group of points is treated as a whole from the distance at which the third term of its
/// expansion, for points all in one direction, is this fraction of the first. (Groups surround
/// their centers, so the actual third term is far smaller.)
constexpr double ThirdTerm = 0.05;
/// The same for points that turn: close to a wall, where cells are small, distant groups have no
/// weight.
constexpr double TurningThirdTerm = 0.5;
constexpr double LargestOpening = 0.5; ///< radius of a group over its distance, for any power

/// The squared radius of a group over its squared distance up to which it is treated as a whole.
double squaredOpening(double power, double thirdTerm)
{
  const double opening =
    std::min(LargestOpening, std::cbrt(thirdTerm * 6 / (power * (power + 2) * (power + 4))));
  return opening * opening;
}

std::array<double, 6> products(const Vec3& u)
{
  return { u[0] * u[0], u[1] * u[1], u[2] * u[2], u[0] * u[1], u[1] * u[2], u[0] * u[2] };
}

/// A weight w(r) as a function of r^2 = u.u: w(|u - o|) = value + one u.o + (two (u.o)^2 - one o.o
/// / 2), to second order in o.
struct Expansion
{
  double value, one, two;
};

Expansion expansionOf(double value, double power, double square)
{
  const double one = value * power / square;
  return { value, one, 0.5 * one * (power + 2) / square };
}

/// 1 / distance^power; Whole 0 stands for any other number.
template <int Whole>
class PowerLaw
{
public:
  explicit PowerLaw(double power)
    : Power(power)
    , Opening(squaredOpening(power, ThirdTerm))
  {
  }

  double at(double square) const
  {
    if constexpr (Whole == 1)
    {
      return 1 / std::sqrt(square);
    }
    else if constexpr (Whole == 2)
    {
      return 1 / square;
    }
    else if constexpr (Whole == 3)
    {
      return 1 / (square * std::sqrt(square));
    }
    else if constexpr (Whole == 4)
    {
      return 1 / (square * square);
    }
    else
    {
      return std::pow(square, -0.5 * this->Power);
    }
  }
  Expansion expand(double square) const
  {
    return expansionOf(this->at(square), this->Power, square);
  }
  double opening(double) const { return this->Opening; }

private:
  double Power, Opening;
};

/// (1 / distance)^3 + (stiff / distance)^5, with distances relative to the overall size: the second
/// term makes points closer than `stiff` follow only the closest wall points.
class TwoPowers
{
public:
  TwoPowers(double size, double stiff)
    : Far(size * size * size)
    , Near(std::pow(stiff, NearPower))
    , Change(this->Near / (NearShare * this->Far))
  {
  }

  double at(double square) const
  {
    const double cubed = 1 / (square * std::sqrt(square));
    return this->Far * cubed + this->Near * cubed / square;
  }
  Expansion expand(double square) const
  {
    const double cubed = 1 / (square * std::sqrt(square));
    const Expansion far = expansionOf(this->Far * cubed, FarPower, square);
    const Expansion near = expansionOf(this->Near * cubed / square, NearPower, square);
    return { far.value + near.value, far.one + near.one, far.two + near.two };
  }
  double opening(double square) const
  {
    return square > this->Change ? this->FarOpening : this->NearOpening;
  }

private:
  static constexpr double FarPower = 3, NearPower = 5;
  /// The second term below which its expansion does not matter, relative to the first.
  static constexpr double NearShare = 0.05;
  double Far, Near, Change;
  double FarOpening = squaredOpening(FarPower, TurningThirdTerm);
  double NearOpening = squaredOpening(NearPower, TurningThirdTerm);
};

/// A displacement at a position and, if points turn, its derivatives along x, y and z.
template <bool Turns>
using Jet = std::array<double, Turns ? 12 : 3>;

/// Adds factor times one array to another.
template <std::size_t Size>
void addTo(std::array<double, Size>& sum, double factor, const std::array<double, Size>& value)
{
  for (std::size_t k = 0; k < Size; ++k)
  {
    sum[k] += factor * value[k];
  }
}

/// Evaluates at u a jet given at the origin.
template <bool Turns>
Vec3 valueAt(const Jet<Turns>& jet, const Vec3& u)
{
  Vec3 value = { jet[0], jet[1], jet[2] };
  for (std::size_t k = 0; Turns && k < 3; ++k)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      value[c] += u[k] * jet[3 + 3 * k + c];
    }
  }
  return value;
}

/// A prescribed point with its share of the weights.
template <bool Turns>
struct Source
{
  Vec3 place;
  double share;
  Jet<Turns> jet;
};

/// Moments of the sources of a node about its center: of shares and of jets.
template <bool Turns>
struct Moments
{
  double share = 0;
  std::array<double, 3> shares1 = {}; ///< of offsets
  std::array<double, 6> shares2 = {}; ///< of products of offsets: xx yy zz xy yz xz
  Jet<Turns> sum = {};
  std::array<Jet<Turns>, 3> first = {};  ///< [k]: of offset k times jet
  std::array<Jet<Turns>, 6> second = {}; ///< of products of offsets times jet
};

/// The sources of the weighted means, in groups.
template <class Law, bool Turns>
class Sources
{
public:
  Sources(std::vector<Source<Turns>> all, const Law& law)
    : Weights(law)
    , Tree(placesOf(all), InverseDistanceLeafSize)
  {
    for (const std::size_t i : this->Tree.order())
    {
      this->Points.push_back(all[i]);
    }
    for (const PointTree::Node& node : this->Tree.nodes())
    {
      Moments<Turns> m;
      for (std::size_t i = node.begin; i < node.end && !node.leaf; ++i)
      {
        this->include(this->Points[i], node.center, m);
      }
      this->Groups.push_back(m);
    }
  }

  Vec3 mean(const Vec3& y) const
  {
    const std::vector<PointTree::Node>& nodes = this->Tree.nodes();
    double weights = 0;
    Vec3 values = { 0, 0, 0 };
    for (std::size_t n = 0; n < nodes.size();)
    {
      const PointTree::Node& node = nodes[n];
      const Vec3 u = y - node.center;
      const double square = dot(u, u);
      if (!node.leaf && node.radius * node.radius < this->Weights.opening(square) * square)
      {
        this->add(this->Groups[n], u, this->Weights.expand(square), weights, values);
        n = node.next;
        continue;
      }
      for (std::size_t i = node.begin; i < node.end && node.leaf; ++i)
      {
        const Source<Turns>& source = this->Points[i];
        const Vec3 d = y - source.place;
        const double apart = dot(d, d);
        if (apart < Coincident)
        {
          return { source.jet[0], source.jet[1], source.jet[2] }; // the mean has a limit here
        }
        const double w = source.share * this->Weights.at(apart);
        weights += w;
        values += w * valueAt<Turns>(source.jet, d);
      }
      ++n;
    }
    return (1 / weights) * values;
  }

private:
  static std::vector<Vec3> placesOf(const std::vector<Source<Turns>>& all)
  {
    std::vector<Vec3> places;
    places.reserve(all.size());
    for (const Source<Turns>& source : all)
    {
      places.push_back(source.place);
    }
    return places;
  }

  void include(const Source<Turns>& source, const Vec3& center, Moments<Turns>& m) const
  {
    const Vec3 offset = source.place - center;
    const std::array<double, 6> two = products(offset);
    Jet<Turns> jet = source.jet;
    const Vec3 there = valueAt<Turns>(jet, center - source.place);
    std::copy(there.begin(), there.end(), jet.begin());
    m.share += source.share;
    addTo(m.shares1, source.share, offset);
    addTo(m.shares2, source.share, two);
    addTo(m.sum, source.share, jet);
    for (std::size_t k = 0; k < 3; ++k)
    {
      addTo(m.first[k], source.share * offset[k], jet);
    }
    for (std::size_t k = 0; k < 6; ++k)
    {
      addTo(m.second[k], source.share * two[k], jet);
    }
  }

  void add(
    const Moments<Turns>& m, const Vec3& u, const Expansion& f, double& weights, Vec3& values) const
  {
    std::array<double, 6> t = products(u);
    for (std::size_t k = 0; k < 6; ++k)
    {
      t[k] = k < 3 ? f.two * t[k] - 0.5 * f.one : 2 * f.two * t[k];
    }
    weights += f.value * m.share;
    Jet<Turns> jet = {};
    addTo(jet, f.value, m.sum);
    for (std::size_t k = 0; k < 3; ++k)
    {
      weights += f.one * u[k] * m.shares1[k];
      addTo(jet, f.one * u[k], m.first[k]);
    }
    for (std::size_t k = 0; k < 6; ++k)
    {
      weights += t[k] * m.shares2[k];
      addTo(jet, t[k], m.second[k]);
    }
    values += valueAt<Turns>(jet, u);
  }

  Law Weights;
  PointTree Tree;
  std::vector<Source<Turns>> Points;  ///< in the order of the tree
  std::vector<Moments<Turns>> Groups; ///< of its nodes; empty for a leaf
};

/// The motion of the free points by weighted means.
template <class Law, bool Turns>
std::vector<double> warpByMeans(const PrescribedMotion& motion, std::vector<Source<Turns>> all,
  const Law& law, WarpControl& control)
{
  const Sources<Law, Turns> sources(std::move(all), law);
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  const bool complete = forEachBatch(motion.free().size(), 0.0, control,
    [&](std::size_t i) { rest[i] = sources.mean(motion.local(motion.free()[i])); });
  return complete ? motion.displacements(rest) : std::vector<double>();
}

/// The mean of the displacements, weighted by the wall shares, and the largest deviation from it:
/// the relative motion of the points.
double spreadOf(const PrescribedMotion& motion)
{
  double area = 0, largest = 0;
  Vec3 mean = { 0, 0, 0 };
  for (std::size_t i = 0; i < motion.prescribed().size(); ++i)
  {
    area += motion.wall(i).area;
    mean += motion.wall(i).area * motion.given(i);
  }
  mean = (area > 0 ? 1 / area : 0.0) * mean;
  for (std::size_t i = 0; i < motion.prescribed().size(); ++i)
  {
    largest = std::max(largest, norm(motion.given(i) - mean));
  }
  return largest;
}
}

//------------------------------------------------------------------------------
std::vector<double> warpByInverseDistance(const PrescribedMotion& motion, WarpControl& control)
{
  const WarpOptions& options = control.options();
  if (!(options.distancePower > 0 && options.distancePower <= LargestPower))
  {
    throw Error("the power of the distance is " + std::to_string(options.distancePower) +
      "; it must be above 0 and at most 20");
  }
  if (motion.affine())
  {
    return motion.displacements({});
  }
  std::vector<Source<false>> sources;
  for (std::size_t i = 0; i < motion.prescribed().size(); ++i)
  {
    const Vec3 place = motion.local(motion.prescribed()[i]);
    sources.push_back({ place, 1.0, motion.rest(i) });
  }
  const auto by = [&](const auto& law)
  { return warpByMeans<std::decay_t<decltype(law)>, false>(motion, sources, law, control); };
  const double power = options.distancePower;
  return power == 1 ? by(PowerLaw<1>(power))
    : power == 2    ? by(PowerLaw<2>(power))
    : power == 3    ? by(PowerLaw<3>(power))
    : power == 4    ? by(PowerLaw<4>(power))
                    : by(PowerLaw<0>(power));
}

//------------------------------------------------------------------------------
std::vector<double> warpByRigidMeans(const PrescribedMotion& motion, WarpControl& control)
{
  // Constants of the source.
  constexpr double spreads = 5.0, least = 0.1;
  double size = 0;
  std::vector<Source<true>> sources;
  for (std::size_t i = 0; i < motion.prescribed().size(); ++i)
  {
    const WallPoint& wall = motion.wall(i);
    const Vec3 place = motion.local(motion.prescribed()[i]), rest = motion.rest(i);
    Source<true> source = { place, wall.area, {} };
    std::copy(rest.begin(), rest.end(), source.jet.begin());
    for (std::size_t k = 0; k < 3; ++k)
    {
      Vec3 column = wall.turn[k];
      column[k] -= 1;
      column = motion.scale() * column - motion.derivative(k);
      std::copy(column.begin(), column.end(), &source.jet[3 + 3 * k]);
    }
    size = std::max(size, norm(place));
    sources.push_back(source);
  }
  if (sources.empty() || !(size > 0))
  {
    return motion.displacements({});
  }
  const double stiff = std::max(least * size, spreads * spreadOf(motion) / motion.scale());
  return warpByMeans<TwoPowers, true>(motion, std::move(sources), TwoPowers(size, stiff), control);
}
}
