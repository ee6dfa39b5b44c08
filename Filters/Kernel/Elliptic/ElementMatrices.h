// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementMatrices.h
 * @brief Element stiffness matrices of the diffusion operator and of linear elasticity.
 *
 * All are exactly symmetric: only one of each pair of symmetric entries is computed and then
 * copied.
 * Internal: not installed.
 */
#ifndef tautline_ElementMatrices_h
#define tautline_ElementMatrices_h

#include "ElementShapes.h"
#include "Materials.h"
#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/**
 * @brief Throws Error if a mesh has unsupported cells or elements that do not fit together: both
 * linear and quadratic elements, or edges with several nodes between their ends. The message states
 * which cells, how many, and a remedy.
 * @param skip one flag per cell: nonzero to ignore it; or null
 */
void requireElements(const Mesh& mesh, const unsigned char* skip = nullptr);

/// Throws Error, with a remedy, for a mesh with both linear and quadratic elements.
[[noreturn]] void refuseMixedOrders(Index linear, Index quadratic);

/// The product C v.
inline Vec3 applyTensor(const SymmetricTensor& c, const Vec3& v)
{
  return { c[0] * v[0] + c[3] * v[1] + c[5] * v[2], c[3] * v[0] + c[1] * v[1] + c[4] * v[2],
    c[5] * v[0] + c[4] * v[1] + c[2] * v[2] };
}

/// Whether a tensor is a number times the identity: then only the sizes of edges and faces matter,
/// not their directions.
inline bool isIsotropic(const SymmetricTensor& c)
{
  return c[0] == c[1] && c[1] == c[2] && c[3] == 0 && c[4] == 0 && c[5] == 0;
}

/// Copies the entries above the diagonal below it, and fills the diagonal so that rows sum to 0.
template <int Nodes>
inline void completeRows(double* k)
{
  for (int i = 0; i < Nodes; ++i)
  {
    double sum = 0;
    for (int j = 0; j < Nodes; ++j)
    {
      if (j < i)
      {
        k[Nodes * i + j] = k[Nodes * j + i];
      }
      sum += j == i ? 0 : k[Nodes * i + j];
    }
    k[Nodes * i + i] = -sum;
  }
}

/// Element matrices of -div(C grad u) + a u: K_ij is the integral of grad phi_i . C grad phi_j + a
/// phi_i phi_j.
class DiffusionElement
{
public:
  static constexpr int Components = 1;

  explicit DiffusionElement(const DiffusionOperator& pde)
    : Pde(pde)
    , Isotropic(!pde.tensors && isIsotropic(pde.tensor))
    , Rules(elementRules(elementRule))
  {
  }

  /// Writes the matrix of a cell, Nodes x Nodes.
  template <int Nodes, int CellDimension>
  void compute(Index cell, ElementKind kind, const Vec3* p, double* k) const
  {
    SymmetricTensor c = this->Pde.tensor;
    if (this->Pde.tensors)
    {
      std::copy_n(this->Pde.tensors + 6 * cell, 6, c.begin());
    }
    if constexpr (Nodes == CellDimension + 1)
    {
      this->simplex<Nodes>(c, p, k);
    }
    else
    {
      this->general<Nodes, CellDimension>(this->Rules[static_cast<int>(kind)], c, p, k);
    }
  }

private:
  /**
   * Closed forms. With h_i the edge (face) opposite node i, rotated to its inner normal, with its
   * length (twice its area) as magnitude, grad phi_i = h_i / det J. In a triangle with C = c I, the
   * rotation does not matter.
   */
  template <int Nodes>
  void simplex(const SymmetricTensor& c, const Vec3* p, double* k) const
  {
    Vec3 h[4] = {};
    double det = 0, lengths = 0;
    if (Nodes == 3)
    {
      h[0] = p[2] - p[1];
      h[1] = p[0] - p[2];
      h[2] = p[1] - p[0];
      const Vec3 normal = cross(h[1], h[2]);
      det = norm(normal);
      lengths = std::sqrt(dot(h[1], h[1]) * dot(h[2], h[2]));
      if (!this->Isotropic)
      {
        const Vec3 unit = (det > 0 ? 1 / det : 0.0) * normal;
        for (int i = 0; i < 3; ++i)
        {
          h[i] = cross(unit, h[i]);
        }
      }
    }
    else
    {
      const Vec3 a = p[1] - p[0], b = p[2] - p[0], d = p[3] - p[0];
      h[1] = cross(b, d);
      h[2] = cross(d, a);
      h[3] = cross(a, b);
      h[0] = -1.0 * (h[1] + h[2] + h[3]);
      det = std::abs(dot(a, h[1]));
      lengths = std::sqrt(dot(a, a) * dot(b, b) * dot(d, d));
    }
    constexpr double reference = Nodes == 3 ? 0.5 : 1.0 / 6.0; // size of the reference cell
    const bool flat = isFlat(det, lengths);
    const double scale = flat ? 0.0 : reference / det * (this->Isotropic ? c[0] : 1.0);
    for (int j = 1; j < Nodes; ++j)
    {
      const Vec3 q = scale * (this->Isotropic ? h[j] : applyTensor(c, h[j]));
      for (int i = 0; i < j; ++i)
      {
        k[Nodes * i + j] = dot(h[i], q);
      }
    }
    completeRows<Nodes>(k);
    if (this->Pde.reaction != 0 && !flat)
    {
      const double mass = this->Pde.reaction * reference * det / (Nodes * (Nodes + 1));
      for (int i = 0; i < Nodes * Nodes; ++i)
      {
        k[i] += i % (Nodes + 1) == 0 ? 2 * mass : mass;
      }
    }
  }

  template <int Nodes, int CellDimension>
  void general(const std::vector<ReferencePoint>& rule, const SymmetricTensor& c, const Vec3* p,
    double* k) const
  {
    std::fill(k, k + Nodes * Nodes, 0.0);
    std::array<double, Nodes * Nodes> mass{};
    for (const ReferencePoint& reference : rule)
    {
      ElementSample<Nodes> s;
      sampleElement<Nodes, CellDimension>(reference, p, s);
      for (int i = 0; i < Nodes; ++i)
      {
        const Vec3 q =
          s.weight * applyTensor(c, { s.gradient[0][i], s.gradient[1][i], s.gradient[2][i] });
        for (int j = 0; j < Nodes; ++j)
        {
          k[Nodes * i + j] +=
            q[0] * s.gradient[0][j] + q[1] * s.gradient[1][j] + q[2] * s.gradient[2][j];
        }
      }
      if (this->Pde.reaction != 0)
      {
        for (int i = 0; i < Nodes; ++i)
        {
          const double a = this->Pde.reaction * s.weight * s.value[i];
          for (int j = 0; j < Nodes; ++j)
          {
            mass[Nodes * i + j] += a * s.value[j];
          }
        }
      }
    }
    completeRows<Nodes>(k);
    if (this->Pde.reaction != 0)
    {
      for (int i = 0; i < Nodes; ++i)
      {
        for (int j = 0; j < Nodes; ++j)
        {
          k[Nodes * i + j] += mass[Nodes * std::min(i, j) + std::max(i, j)];
        }
      }
    }
  }

  DiffusionOperator Pde;
  bool Isotropic;
  ElementRules Rules;
};

/// lambda and mu of a body with E = 1 (2.4); for plane stress lambda is replaced so that the third
/// normal stress vanishes.
inline std::array<double, 2> lameParameters(const ElasticOperator& pde, bool planar)
{
  const double nu = pde.poissonRatio, e = pde.youngsModulus;
  const bool stress = planar && pde.plane == PlaneState::Stress;
  return { stress ? e * nu / (1 - nu * nu) : e * nu / ((1 + nu) * (1 - 2 * nu)),
    e / (2 * (1 + nu)) };
}

/// Element matrices of linear elasticity, Dim components per node: the integral of tau(u) : eps(v).
template <int Dim>
class ElasticElement
{
public:
  static constexpr int Components = Dim;

  ElasticElement(const ElasticOperator& pde, const std::array<Vec3, 2>& frame)
    : Pde(pde)
    , Frame(frame)
    , Lame(lameParameters(pde, Dim == 2))
    , Rules(elementRules(elementRule))
  {
  }

  /// Writes the matrix of a cell, of Nodes x Dim rows.
  template <int Nodes, int CellDimension>
  void compute(Index cell, ElementKind kind, const Vec3* p, double* k) const
  {
    if constexpr (CellDimension != Dim)
    {
      return; // such cells are rejected
    }
    constexpr int rows = Nodes * Dim;
    std::fill(k, k + rows * rows, 0.0);
    const double factor = this->Pde.stiffening ? this->Pde.stiffening[cell] : 1.0;
    for (const ReferencePoint& reference : this->Rules[static_cast<int>(kind)])
    {
      ElementSample<Nodes> s;
      sampleElement<Nodes, CellDimension>(reference, p, s);
      // Gradients along the components.
      std::array<double, Nodes> g[Dim];
      for (int a = 0; a < Dim; ++a)
      {
        for (int i = 0; i < Nodes; ++i)
        {
          g[a][i] = Dim == 3 ? s.gradient[a][i]
                             : this->Frame[a % 2][0] * s.gradient[0][i] +
              this->Frame[a % 2][1] * s.gradient[1][i] + this->Frame[a % 2][2] * s.gradient[2][i];
        }
      }
      const double lambda = factor * s.weight * this->Lame[0],
                   mu = factor * s.weight * this->Lame[1];
      for (int i = 0; i < Nodes; ++i)
      {
        for (int a = 0; a < Dim; ++a)
        {
          double* row = k + rows * (Dim * i + a);
          for (int j = i; j < Nodes; ++j)
          {
            double along = 0;
            for (int b = 0; b < Dim; ++b)
            {
              row[Dim * j + b] += lambda * g[a][i] * g[b][j] + mu * g[b][i] * g[a][j];
              along += g[b][i] * g[b][j];
            }
            row[Dim * j + a] += mu * along;
          }
        }
      }
    }
    for (int row = 0; row < rows; ++row)
    {
      for (int column = 0; column < row; ++column)
      {
        k[rows * row + column] = k[rows * column + row];
      }
    }
  }

private:
  ElasticOperator Pde;
  std::array<Vec3, 2> Frame;
  std::array<double, 2> Lame;
  ElementRules Rules;
};
}
#endif
