// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeterminantWork.h
 * @brief The Bernstein coefficients of the Jacobian determinant of one element (of doubles) or of
 * several at once (of packets).
 * Internal: not installed.
 */
#ifndef tautline_DeterminantWork_h
#define tautline_DeterminantWork_h

#include "ElementType.h"
#include "tautline/Core/Packet.h"

#include <algorithm>

namespace tautline
{
inline double larger(double a, double b)
{
  return std::max(a, b);
}

inline Packet larger(Packet a, Packet b)
{
  return max(a, b);
}

inline double rootOf(double x)
{
  return std::sqrt(x);
}

inline Packet rootOf(Packet x)
{
  return sqrt(x);
}

/**
 * @class DeterminantWork
 * @brief Computes coefficients from nodes, with the necessary memory.
 *
 * The nodes are relative to the first one. In the plane they are x y 0.
 */
template <class T>
class DeterminantWork
{
public:
  struct Vector
  {
    T c[3];

    T square() const
    {
      return this->c[0] * this->c[0] + this->c[1] * this->c[1] + this->c[2] * this->c[2];
    }
  };
  struct Scalar
  {
    T value;
  };

  /// @param surface whether a two-dimensional element lies in space, not in the plane
  DeterminantWork(const ElementType& type, bool surface)
    : nodes(type.nodes())
    , coefficients(type.determinant().space.size())
    , Type(type)
    , Form(type.determinant())
    , Controls(type.space().size())
  {
    for (const DerivativeForm& derivative : this->Form.derivatives)
    {
      this->Derivatives.emplace_back(derivative.space.size());
    }
    const bool solid = type.dimension() == 3;
    this->normals.resize(solid ? this->Form.cofactors.size()
        : surface              ? this->Form.space.size()
                               : 0);
  }

  std::vector<Vector> nodes;
  std::vector<Scalar> coefficients; ///< of the determinant
  std::vector<Vector> normals;      ///< coefficients of the normal of a surface
  T noise; ///< bound of the error of a coefficient; NaN or infinite if a node is

  /// The determinants of a solid or of a planar element.
  void run()
  {
    this->differentiate();
    if (this->Type.dimension() == 2)
    {
      this->multiplyInPlane();
    }
    else
    {
      this->multiplyCross(this->Derivatives[1], this->Derivatives[2]);
      this->multiplyDot();
    }
    for (std::size_t k = 0; k < this->coefficients.size(); ++k)
    {
      this->coefficients[k].value *= this->Form.factors[k];
    }
  }

  /// The normals of a surface; the noise bounds the error of their components.
  void runNormals()
  {
    this->differentiate();
    this->multiplyCross(this->Derivatives[0], this->Derivatives[1]);
    for (std::size_t k = 0; k < this->normals.size(); ++k)
    {
      for (T& c : this->normals[k].c)
      {
        c *= this->Form.factors[k];
      }
    }
  }

  /// The mean of the coefficients of the normal: proportional to the area vector.
  Vector meanNormal() const
  {
    Vector sum = {};
    for (const Vector& n : this->normals)
    {
      for (int c = 0; c < 3; ++c)
      {
        sum.c[c] += n.c[c];
      }
    }
    for (T& c : sum.c)
    {
      c *= 1.0 / static_cast<double>(this->normals.size());
    }
    return sum;
  }

  /// Uses the components of the normals along a unit vector as the determinant.
  void project(const Vector& direction)
  {
    for (std::size_t k = 0; k < this->normals.size(); ++k)
    {
      const T* n = this->normals[k].c;
      this->coefficients[k].value =
        n[0] * direction.c[0] + n[1] * direction.c[1] + n[2] * direction.c[2];
    }
  }

private:
  void findControls()
  {
    const ControlMatrix& matrix = this->Type.controls();
    for (int k = 0; k < matrix.rows(); ++k)
    {
      Vector sum = {};
      for (int e = matrix.offsets[k]; e < matrix.offsets[k + 1]; ++e)
      {
        const Vector& node = this->nodes[matrix.columns[e]];
        for (int c = 0; c < 3; ++c)
        {
          sum.c[c] += matrix.values[e] * node.c[c];
        }
      }
      this->Controls[k] = sum;
    }
  }

  /// Computes control points, scaled derivatives and the noise.
  void differentiate()
  {
    this->findControls();
    T farthest2 = {}, sum = {};
    for (const Vector& node : this->nodes)
    {
      const T square = node.square();
      farthest2 = larger(farthest2, square);
      sum += square;
    }
    const T notFinite = 0.0 * sum; // 0, or NaN, which a maximum may drop
    T lengths[3];
    double magnitudes[3];
    for (std::size_t d = 0; d < this->Derivatives.size(); ++d)
    {
      lengths[d] = this->differences(d, magnitudes[d]);
    }
    // The error of a control point is at most `shift`; a derivative uses two.
    constexpr double unit = 0x1p-53;
    const ControlMatrix& matrix = this->Type.controls();
    const double products = 4 * unit * this->Form.roundings;
    const T shift = (2 * unit * (matrix.longest + 3) * matrix.norm) * rootOf(farthest2) + notFinite;
    if (this->Derivatives.size() == 2)
    {
      this->noise = products * lengths[0] * lengths[1] +
        2 * shift * (magnitudes[0] * lengths[1] + magnitudes[1] * lengths[0]);
    }
    else
    {
      this->noise = products * lengths[0] * lengths[1] * lengths[2] +
        2 * shift *
          (magnitudes[0] * lengths[1] * lengths[2] + magnitudes[1] * lengths[0] * lengths[2] +
            magnitudes[2] * lengths[0] * lengths[1]);
    }
  }

  /// The scaled derivative with respect to a coordinate; returns the largest length of its
  /// coefficients.
  T differences(std::size_t d, double& magnitude)
  {
    Vector* result = this->Derivatives[d].data();
    T longest2 = {};
    magnitude = 0;
    for (const DerivativeForm::Difference& difference : this->Form.derivatives[d].differences)
    {
      const Vector &high = this->Controls[difference.high], &low = this->Controls[difference.low];
      Vector delta;
      for (int c = 0; c < 3; ++c)
      {
        delta.c[c] = high.c[c] - low.c[c];
      }
      longest2 = larger(longest2, (difference.magnitude * difference.magnitude) * delta.square());
      magnitude = std::max(magnitude, difference.magnitude);
      for (int c = 0; c < 3; ++c)
      {
        result->c[c] = difference.scale * delta.c[c];
      }
      ++result;
    }
    return rootOf(longest2);
  }

  void multiplyInPlane()
  {
    Scalar* sums = this->coefficients.data();
    std::fill(this->coefficients.begin(), this->coefficients.end(), Scalar{});
    const std::vector<Vector>&u = this->Derivatives[0], &v = this->Derivatives[1];
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      const T x = u[i].c[0], y = u[i].c[1];
      const std::uint16_t* target = this->Form.cross.targets(static_cast<int>(i));
      for (std::size_t j = 0; j < v.size(); ++j)
      {
        sums[target[j]].value += x * v[j].c[1] - y * v[j].c[0];
      }
    }
  }

  void multiplyCross(const std::vector<Vector>& a, const std::vector<Vector>& b)
  {
    Vector* sums = this->normals.data();
    std::fill(this->normals.begin(), this->normals.end(), Vector{});
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const T x = a[i].c[0], y = a[i].c[1], z = a[i].c[2];
      const std::uint16_t* target = this->Form.cross.targets(static_cast<int>(i));
      for (std::size_t j = 0; j < b.size(); ++j)
      {
        const T* other = b[j].c;
        T* sum = sums[target[j]].c;
        sum[0] += y * other[2] - z * other[1];
        sum[1] += z * other[0] - x * other[2];
        sum[2] += x * other[1] - y * other[0];
      }
    }
  }

  void multiplyDot()
  {
    Scalar* sums = this->coefficients.data();
    std::fill(this->coefficients.begin(), this->coefficients.end(), Scalar{});
    const std::vector<Vector>& u = this->Derivatives[0];
    const std::size_t count = this->normals.size();
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      const T x = u[i].c[0], y = u[i].c[1], z = u[i].c[2];
      const std::uint16_t* target = this->Form.dot.targets(static_cast<int>(i));
      for (std::size_t k = 0; k < count; ++k)
      {
        const T* n = this->normals[k].c;
        sums[target[k]].value += x * n[0] + y * n[1] + z * n[2];
      }
    }
  }

  const ElementType& Type;
  const DeterminantForm& Form;
  std::vector<Vector> Controls;
  std::vector<std::vector<Vector>> Derivatives; ///< scaled
};
}
#endif
