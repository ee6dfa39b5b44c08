// SPDX-License-Identifier: BSD-3-Clause
#include "PointMotion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace tautline
{
namespace
{
using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Path = std::function<Vector(const Vector&)>; ///< the position of a point at a given amount

constexpr double Degree = Pi / 180;
constexpr double SmallAngle = 1e-7; // the axis of a smaller rotation is undetermined and not needed
// relative volume, compared with the cube of the length, below which a box is flat
constexpr double Flattened = 1e-12;
constexpr int MaxPolarSteps = 100; // the worst accepted matrix needs about twelve
constexpr double PolarChange =
  // of the second-to-last step; the error after the last is its square
  1e-9;
// largest distance of the points from a plane, relative to their extent
constexpr double Planar = 1e-12;
// sin(x) / x and (1 - cos(x)) / x use their series below this value
constexpr double SmallBend = 1e-4;

Vector toVector(const Vec3& v)
{
  return { v[0], v[1], v[2] };
}

Vector unit(const Vector& v, const char* what)
{
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !v.allFinite())
  {
    throw Error(std::string("The ") + what +
      " of the motion has no length, or is not finite: enter a direction, such as 0 0 1.");
  }
  return (v / largest).normalized();
}

/// The rotation R of A = R P, P symmetric and positive, by Newton's iteration (Higham 1986).
Matrix rotationOf(const Matrix& a)
{
  Matrix r = a;
  for (int i = 0; i < MaxPolarSteps; ++i)
  {
    const Matrix other = r.inverse().transpose();
    const double scale = std::sqrt(other.norm() / r.norm());
    const Matrix next = 0.5 * (scale * r + other / scale);
    const double change = (next - r).norm();
    r = next;
    if (change < PolarChange)
    {
      break;
    }
  }
  return r;
}

Matrix rotation(double angle, const Vector& axis)
{
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// The box around the marked points, and its center.
struct Extent
{
  Vector low = Vector::Constant(std::numeric_limits<double>::infinity());
  Vector high = -low;
  Vector middle() const { return 0.5 * low + 0.5 * high; }
};

template <class Visit>
void forEachMoved(Index n, const double* points, const unsigned char* moved, const Visit& visit)
{
  for (Index i = 0; i < n; ++i)
  {
    if (moved[i])
    {
      visit(i, Vector(Eigen::Map<const Vector>(points + 3 * i)));
    }
  }
}

/// The unit normal of the plane that contains all marked points; zero if there is none.
Vector normalOf(Index n, const double* points, const unsigned char* moved, const Vector& middle)
{
  Matrix spread = Matrix::Zero();
  forEachMoved(n, points, moved,
    [&](Index, const Vector& x) { spread += (x - middle) * (x - middle).transpose(); });
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(spread);
  const Vector normal = axes.eigenvectors().col(0);
  double off = 0, extent = 0;
  forEachMoved(n, points, moved,
    [&](Index, const Vector& x)
    {
      off = std::max(off, std::abs(normal.dot(x - middle)));
      extent = std::max(extent, (x - middle).norm());
    });
  return off <= Planar * extent ? normal : Vector(Vector::Zero());
}

/**
 * @brief The in-plane part of the map for the plane with this normal, which stays a unit normal.
 * The scaling normal to the plane is ignored: ParaView's box around a flat mesh scales by 0 in that
 * direction.
 */
Matrix withinPlane(const Matrix& linear, const Vector& normal)
{
  if (normal.isZero())
  {
    return linear;
  }
  const Vector u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector image = (linear * u).cross(linear * v);
  const double area = image.norm();
  const bool proper = linear.determinant() > Flattened * std::pow(linear.norm(), 3);
  if (!(area > Flattened * linear.squaredNorm()) || (!proper && image.dot(normal) < 0))
  {
    return linear; // the map flattens or mirrors within the plane itself
  }
  return linear * (Matrix::Identity() - normal * normal.transpose()) +
    image / area * normal.transpose();
}

/// x -> c(a) + R(a) (I + a (P - I)) (x - c), where the matrix is R P and the shift; c(a) goes along
/// a screw.
Path matrixPath(
  const PointMotion& motion, double amount, const Vector& middle, const Vector& normal)
{
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> whole(motion.matrix.data());
  if (!whole.allFinite() || whole.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
  {
    throw Error(
      "The transform is not affine, or not finite: use only translation, rotation and scaling.");
  }
  const Matrix linear = withinPlane(whole.topLeftCorner<3, 3>(), normal);
  if (!(linear.determinant() > Flattened * std::pow(linear.norm(), 3)))
  {
    throw Error(
      "The transform mirrors or flattens the moved points, which no mesh can follow: scale by "
      "positive factors.");
  }
  const Matrix turn = rotationOf(linear);
  const Matrix stretch = turn.transpose() * linear;
  const Vector shift = linear * middle + whole.topRightCorner<3, 1>() - middle;
  const Matrix stretched = Matrix::Identity() + amount * (stretch - Matrix::Identity());
  const Eigen::AngleAxisd turned(turn);
  const double angle = turned.angle();
  if (angle < SmallAngle)
  {
    const Matrix part = Matrix::Identity() + amount * (turn - Matrix::Identity());
    return [=](const Vector& x) -> Vector
    { return middle + amount * shift + part * (stretched * (x - middle)); };
  }
  const Vector& axis = turned.axis();
  const Vector along = axis.dot(shift) * axis, across = shift - along;
  const Vector pivot = middle + across / 2 + axis.cross(across) / (2 * std::tan(angle / 2));
  const Matrix part = rotation(amount * angle, axis);
  const Vector now = pivot + part * (middle - pivot) + amount * along;
  return [=](const Vector& x) -> Vector { return now + part * (stretched * (x - middle)); };
}

Path bendingPath(const PointMotion& motion, double amount, Index n, const double* points,
  const unsigned char* moved, const Vector& middle)
{
  const Vector axis = unit(toVector(motion.axis), "axis");
  const Vector given = unit(toVector(motion.direction), "direction");
  const Vector across = given - axis.dot(given) * axis;
  if (across.norm() < Flattened)
  {
    throw Error("The bar is parallel to the bending axis: change the axis or the direction.");
  }
  const Vector direction = across.normalized(), normal = axis.cross(direction);
  double first = std::numeric_limits<double>::infinity(), last = -first;
  forEachMoved(n, points, moved,
    [&](Index, const Vector& x)
    {
      const double s = direction.dot(x - middle);
      first = std::min(first, s);
      last = std::max(last, s);
    });
  const double start = motion.ownCenter ? first : 0.0;
  if (!(last > start))
  {
    throw Error(
      "There is nothing to bend: no point lies beyond the clamped end of the bar along the "
      "direction.");
  }
  const double curvature = amount * motion.angle * Degree / (last - start);
  return [=](const Vector& x) -> Vector
  {
    const double s = direction.dot(x - middle) - start, r = normal.dot(x - middle);
    if (s <= 0)
    {
      return x;
    }
    const double t = curvature * s;
    const bool small = std::abs(t) < SmallBend;
    const double sine = small ? 1 - t * t / 6 : std::sin(t) / t;
    const double cosine = small ? t / 2 - t * t * t / 24 : (1 - std::cos(t)) / t;
    const double forth = s * sine - r * std::sin(t) - s, aside = s * cosine + r * (std::cos(t) - 1);
    return x + forth * direction + aside * normal;
  };
}

Path pathOf(const PointMotion& motion, double amount, Index n, const double* points,
  const unsigned char* moved, const Vector& middle)
{
  const Vector center = motion.ownCenter ? middle : toVector(motion.center);
  switch (motion.kind)
  {
    case MotionKind::Translation:
    {
      const Vector shift = amount * toVector(motion.translation);
      return [=](const Vector& x) -> Vector { return x + shift; };
    }
    case MotionKind::Rotation:
    {
      const Matrix turn =
        rotation(amount * motion.angle * Degree, unit(toVector(motion.axis), "axis"));
      return [=](const Vector& x) -> Vector { return center + turn * (x - center); };
    }
    case MotionKind::Scaling:
    {
      const Vector factors = toVector(motion.factors);
      if (!(factors.minCoeff() > 0))
      {
        throw Error("A scale factor is not positive, which would flatten or mirror the part: "
                    "use factors above 0.");
      }
      const Vector now = Vector::Ones() + amount * (factors - Vector::Ones());
      return [=](const Vector& x) -> Vector { return center + now.cwiseProduct(x - center); };
    }
    case MotionKind::Bending:
      return bendingPath(motion, amount, n, points, moved, center);
    default:
      return matrixPath(motion, amount, middle, normalOf(n, points, moved, middle));
  }
}
}

//------------------------------------------------------------------------------
std::vector<double> displacements(const PointMotion& motion, double amount, Index numberOfPoints,
  const double* points, const unsigned char* moved)
{
  std::vector<double> result(3 * numberOfPoints, 0.0);
  Extent extent;
  forEachMoved(numberOfPoints, points, moved,
    [&](Index, const Vector& x)
    {
      extent.low = extent.low.cwiseMin(x);
      extent.high = extent.high.cwiseMax(x);
    });
  if (!(extent.low[0] <= extent.high[0]))
  {
    return result; // no point is marked
  }
  if (!std::isfinite(amount) || !std::isfinite(motion.angle))
  {
    throw Error("The amount or the angle of the motion is not finite.");
  }
  const Path path = pathOf(motion, amount, numberOfPoints, points, moved, extent.middle());
  Index wrong = 0;
  forEachMoved(numberOfPoints, points, moved,
    [&](Index i, const Vector& x)
    {
      const Vector d = amount == 0 ? Vector(Vector::Zero()) : Vector(path(x) - x);
      wrong += !d.allFinite();
      std::copy_n(d.data(), 3, &result[3 * i]);
    });
  if (wrong > 0)
  {
    throw Error("The motion moves " + std::to_string(wrong) +
      " points to positions that are not finite: check its parameters.");
  }
  return result;
}
}
