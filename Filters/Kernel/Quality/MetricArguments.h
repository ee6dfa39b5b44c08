// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricArguments.h
 * @brief The arguments of a user metric (see UserMetric.h): the Jacobian at a corner, or the
 * corners of an element.
 */
#ifndef tautline_MetricArguments_h
#define tautline_MetricArguments_h

#include "InvariantNumber.h"
#include "tautline/Mesh/CellTopology.h"

#include <limits>

namespace tautline
{
/**
 * @brief T = A W^-1 at a corner. N is the dimension.
 *
 * The number has derivatives with respect to all entries, to the displacement d of a vertex (T
 * becomes T + d w^t), or to |T|^2 and det T, whichever is cheapest.
 */
template <class Number, int N>
class CornerJacobian
{
public:
  static constexpr int dimension = N;
  explicit CornerJacobian(const Packet (&t)[N][N])
    : T(t)
  {
  }
  /// @param along w
  CornerJacobian(const Packet (&t)[N][N], const Packet (&along)[N])
    : T(t)
    , Along(along)
  {
  }
  /// @param invariants |T|^2 and det T; no other property of T is available
  explicit CornerJacobian(const Packet (&invariants)[2])
    : Invariants(invariants)
  {
  }
  /// The entry in a row and a column, 0 to N - 1.
  Number operator()(int row, int column) const
  {
    if (this->Invariants)
    {
      return this->unknown();
    }
    if constexpr (Number::variables == N)
    {
      Number result(this->T[row][column]);
      result.slope[row] = this->Along[column];
      return result;
    }
    else if constexpr (Number::variables == 0 || Number::variables == N * N)
    {
      return Number::variable(this->T[row][column], N * row + column);
    }
    else
    {
      return this->unknown();
    }
  }
  /// |T|^2, the sum of the squares of the entries.
  Number norm2() const
  {
    if (this->Invariants)
    {
      return Number::variable(this->Invariants[0], 0);
    }
    Packet sum = {};
    return this->assemble(sum,
      [&](int r, int c)
      {
        sum += this->T[r][c] * this->T[r][c];
        return 2.0 * this->T[r][c];
      });
  }
  /// tau = det T: negative if the corner is inverted.
  Number det() const
  {
    if (this->Invariants)
    {
      return Number::variable(this->Invariants[1], 1);
    }
    Packet sum = {};
    return this->assemble(sum,
      [&](int r, int c)
      {
        const Packet cofactor = this->cofactor(r, c);
        sum += r == 0 ? this->T[r][c] * cofactor : Packet{};
        return cofactor;
      });
  }
  /// tr T, the sum of the diagonal.
  Number trace() const
  {
    if (this->Invariants)
    {
      return this->unknown();
    }
    Packet sum = {};
    return this->assemble(sum,
      [&](int r, int c)
      {
        sum += r == c ? this->T[r][c] : Packet{};
        return broadcast(r == c ? 1.0 : 0.0);
      });
  }
  /// |adj T|^2 = |T^-1|^2 tau^2; in 2D it is |T|^2.
  Number adjugate2() const
  {
    if constexpr (N == 2)
    {
      return this->norm2();
    }
    else
    {
      if (this->Invariants)
      {
        return this->unknown();
      }
      // d|adj T|^2 / dT = 2 (|T|^2 T - T T^t T)
      Packet gram[3][3], norm2 = {}, sum = {};
      for (int r = 0; r < 3; ++r)
      {
        for (int c = 0; c < 3; ++c)
        {
          gram[r][c] = this->T[0][r] * this->T[0][c] + this->T[1][r] * this->T[1][c] +
            this->T[2][r] * this->T[2][c];
        }
        norm2 += gram[r][r];
      }
      return this->assemble(sum,
        [&](int r, int c)
        {
          const Packet cofactor = this->cofactor(r, c);
          sum += cofactor * cofactor;
          return 2.0 *
            (norm2 * this->T[r][c] -
              (this->T[r][0] * gram[0][c] + this->T[r][1] * gram[1][c] +
                this->T[r][2] * gram[2][c]));
        });
    }
  }

  /// Whether the formula has read more of T than |T|^2 and det T while only these were available.
  bool readsMore() const { return this->ReadsMore; }

private:
  /// A number whose derivative with respect to entry r c is slope(r, c), which also adds to the
  /// value.
  template <class Slope>
  Number assemble(Packet& sum, const Slope& slope) const
  {
    Number result(0.0);
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        const Packet part = slope(r, c);
        if constexpr (Number::variables == N * N)
        {
          result.slope[N * r + c] = part;
        }
        else if constexpr (Number::variables == N)
        {
          result.slope[r] += part * this->Along[c];
        }
      }
    }
    result.value = sum;
    return result;
  }
  Number unknown() const
  {
    this->ReadsMore = true;
    return Number(std::numeric_limits<double>::quiet_NaN());
  }
  Packet cofactor(int r, int c) const
  {
    if constexpr (N == 2)
    {
      return r == c ? this->T[1 - r][1 - c] : -this->T[1 - r][1 - c];
    }
    else
    {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      return this->T[r1][c1] * this->T[r2][c2] - this->T[r1][c2] * this->T[r2][c1];
    }
  }

  const Packet (*T)[N] = nullptr;
  const Packet* Along = nullptr;
  const Packet* Invariants = nullptr;
  mutable bool ReadsMore = false;
};

/**
 * @brief The corners of an element. A planar mesh is given in its plane: z is 0, and a valid
 * element is counterclockwise; a fully reversed mesh is given mirrored.
 */
template <class Number, int Nodes>
class ElementCorners
{
public:
  static constexpr int nodes = Nodes;
  ElementCorners(CellType type, const Packet (&points)[Nodes][3])
    : Type(type)
    , Points(points)
  {
  }
  /// @param along how far each corner moves with the vertex of differentiation
  ElementCorners(CellType type, const Packet (&points)[Nodes][3], const Packet (&along)[Nodes])
    : Type(type)
    , Points(points)
    , Along(along)
  {
  }
  CellType type() const { return this->Type; }
  /// x y z of a corner.
  DualVector<Number> point(int node) const
  {
    DualVector<Number> result;
    for (int c = 0; c < 3; ++c)
    {
      if constexpr (Number::variables == 3)
      {
        result[c] = Number(this->Points[node][c]);
        result[c].slope[c] = this->Along[node];
      }
      else
      {
        result[c] = Number::variable(this->Points[node][c], 3 * node + c);
      }
    }
    return result;
  }
  /// The vector from one corner to another.
  DualVector<Number> edge(int from, int to) const
  {
    DualVector<Number> result;
    for (int c = 0; c < 3; ++c)
    {
      result[c] = Number(this->Points[to][c] - this->Points[from][c]);
      if constexpr (Number::variables == 3)
      {
        result[c].slope[c] = this->Along[to] - this->Along[from];
      }
      else if constexpr (Number::variables > 0)
      {
        result[c].slope[3 * to + c] = broadcast(1.0);
        result[c].slope[3 * from + c] = broadcast(-1.0);
      }
    }
    return result;
  }

private:
  CellType Type;
  const Packet (&Points)[Nodes][3];
  const Packet* Along = nullptr;
};
}
#endif
