// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPointwise.h"

#include "WarpBatches.h"
#include "tautline/Geometry/PointTree.h"

namespace tautline
{
namespace
{
constexpr double LargestPower = 20.0;
/// Squared distance below which points are at one place: beyond, the largest power is far from
/// overflow.
constexpr double Coincident = 1e-28;
constexpr std::size_t InverseDistanceLeafSize = 16;
/// A group of points counts as a whole from a distance at which the third term of its expansion,
/// for points all in one direction, is this part of the first. (The groups lie around their
/// centres: what is left of it is far less.)
constexpr double ThirdTerm = 0.05;
constexpr double LargestOpening = 0.5; ///< radius of a group over its distance, whatever the power

/// Sums over the points of a node about its centre, of weights 1 and of displacements.
struct Moments
{
  double count = 0;
  Vec3 sum = { 0, 0, 0 };
  std::array<Vec3, 3> first = {};      ///< [k]: of offset k times displacement
  std::array<double, 6> weights2 = {}; ///< of products of offsets: xx yy zz xy yz xz
  std::array<Vec3, 6> second = {};     ///< of the same times displacement
};

std::array<double, 6> products(const Vec3& u)
{
  return { u[0] * u[0], u[1] * u[1], u[2] * u[2], u[0] * u[1], u[1] * u[2], u[0] * u[2] };
}

/// 1 / distance^power from the squared distance; Power 0 stands for any other number.
template <int Power>
double weight(double square, [[maybe_unused]] double power)
{
  if constexpr (Power == 1)
  {
    return 1 / std::sqrt(square);
  }
  else if constexpr (Power == 2)
  {
    return 1 / square;
  }
  else if constexpr (Power == 3)
  {
    return 1 / (square * std::sqrt(square));
  }
  else if constexpr (Power == 4)
  {
    return 1 / (square * square);
  }
  else
  {
    return std::pow(square, -0.5 * power);
  }
}

/// The sources of the weighted means, in groups.
class Sources
{
public:
  Sources(const PrescribedMotion& motion, double power)
    : Power(power)
    , Opening(
        std::min(LargestOpening, std::cbrt(ThirdTerm * 6 / (power * (power + 2) * (power + 4)))))
    , Tree(locals(motion), InverseDistanceLeafSize)
  {
    for (const std::size_t i : this->Tree.order())
    {
      this->Points.push_back(motion.local(motion.prescribed()[i]));
      this->Values.push_back(motion.rest(i));
    }
    for (const PointTree::Node& node : this->Tree.nodes())
    {
      Moments m;
      m.count = static_cast<double>(node.end - node.begin);
      for (std::size_t i = node.begin; i < node.end && !node.leaf; ++i)
      {
        const Vec3 offset = this->Points[i] - node.center;
        const std::array<double, 6> two = products(offset);
        m.sum += this->Values[i];
        for (std::size_t k = 0; k < 3; ++k)
        {
          m.first[k] += offset[k] * this->Values[i];
        }
        for (std::size_t k = 0; k < 6; ++k)
        {
          m.weights2[k] += two[k];
          m.second[k] += two[k] * this->Values[i];
        }
      }
      this->Groups.push_back(m);
    }
  }

  template <int Whole>
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
      if (!node.leaf && node.radius * node.radius < this->Opening * this->Opening * square)
      {
        this->add(this->Groups[n], u, square, weight<Whole>(square, this->Power), weights, values);
        n = node.next;
        continue;
      }
      for (std::size_t i = node.begin; i < node.end && node.leaf; ++i)
      {
        const Vec3 d = y - this->Points[i];
        const double apart = dot(d, d);
        if (apart < Coincident)
        {
          return this->Values[i]; // the mean has a limit here
        }
        const double w = weight<Whole>(apart, this->Power);
        weights += w;
        values += w * this->Values[i];
      }
      ++n;
    }
    return (1 / weights) * values;
  }

private:
  static std::vector<Vec3> locals(const PrescribedMotion& motion)
  {
    std::vector<Vec3> points;
    points.reserve(motion.prescribed().size());
    for (const Index id : motion.prescribed())
    {
      points.push_back(motion.local(id));
    }
    return points;
  }

  /// The terms of |u - offset|^-p: f (1 + p a + p ((p + 2) a^2 - b) / 2), a = u.offset / u.u, b =
  /// offset^2 / u.u.
  void add(
    const Moments& m, const Vec3& u, double square, double f, double& weights, Vec3& values) const
  {
    const double p = this->Power, one = p / square, two = 0.5 * p * (p + 2) / (square * square);
    std::array<double, 6> t = products(u);
    for (std::size_t k = 0; k < 6; ++k)
    {
      t[k] = k < 3 ? two * t[k] - 0.5 * one : 2 * two * t[k];
    }
    double w = m.count;
    Vec3 v = m.sum;
    for (std::size_t k = 0; k < 3; ++k)
    {
      v += (one * u[k]) * m.first[k];
    }
    for (std::size_t k = 0; k < 6; ++k)
    {
      w += t[k] * m.weights2[k];
      v += t[k] * m.second[k];
    }
    weights += f * w;
    values += f * v;
  }

  double Power, Opening;
  PointTree Tree;
  std::vector<Vec3> Points, Values; ///< in the order of the tree
  std::vector<Moments> Groups;      ///< of its nodes; of a leaf only the count
};

using Mean = Vec3 (Sources::*)(const Vec3&) const;

Mean meanFor(double power)
{
  return power == 1 ? &Sources::mean<1>
    : power == 2    ? &Sources::mean<2>
    : power == 3    ? &Sources::mean<3>
    : power == 4    ? &Sources::mean<4>
                    : &Sources::mean<0>;
}
}

//------------------------------------------------------------------------------
std::vector<double> warpByInverseDistance(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement, WarpControl& control)
{
  const WarpOptions& options = control.options();
  if (!(options.distancePower > 0 && options.distancePower <= LargestPower))
  {
    throw Error("the power of the distance is " + std::to_string(options.distancePower) +
      "; it must be above 0 and at most 20");
  }
  const PrescribedMotion motion(mesh, prescribed, displacement, options.threads);
  if (motion.affine())
  {
    return motion.displacements({});
  }
  const Sources sources(motion, options.distancePower);
  const Mean mean = meanFor(options.distancePower);
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  const bool complete = forEachBatch(motion.free().size(), 0.0, control,
    [&](std::size_t i) { rest[i] = (sources.*mean)(motion.local(motion.free()[i])); });
  return complete ? motion.displacements(rest) : std::vector<double>();
}
}
