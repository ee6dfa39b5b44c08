// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedEnergy.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr Index ItemsPerChunk = 128;
constexpr int MostUnique = 6; ///< entries of a symmetric block

template <int Dim>
void cofactorsOf(const Packet (&t)[Dim][Dim], Packet (&c)[Dim][Dim])
{
  // Cofactors are the derivatives of det T with respect to the entries of T.
  if constexpr (Dim == 2)
  {
    c[0][0] = t[1][1];
    c[0][1] = -t[1][0];
    c[1][0] = -t[0][1];
    c[1][1] = t[0][0];
  }
  else
  {
    cross(t[1], t[2], c[0]);
    cross(t[2], t[0], c[1]);
    cross(t[0], t[1], c[2]);
  }
}

/// The derivative of the cofactors in a direction.
template <int Dim>
void cofactorChange(const Packet (&t)[Dim][Dim], const Packet (&d)[Dim][Dim], Packet (&c)[Dim][Dim])
{
  if constexpr (Dim == 2)
  {
    // In 2D, the cofactors are linear in T.
    cofactorsOf<2>(d, c);
  }
  else
  {
    // Each row of the cofactors is a cross product of two rows of T, so the product rule has two
    // terms.
    Packet other[3];
    for (int r = 0; r < 3; ++r)
    {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
      cross(d[r1], t[r2], c[r]);
      cross(t[r1], d[r2], other);
      for (int k = 0; k < 3; ++k)
      {
        c[r][k] += other[k];
      }
    }
  }
}

template <int Dim>
Packet inner(const Packet (&a)[Dim][Dim], const Packet (&b)[Dim][Dim])
{
  Packet sum = {};
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      sum += a[r][c] * b[r][c];
    }
  }
  return sum;
}

/// T^t T
template <int Dim>
void gramOf(const Packet (&t)[Dim][Dim], Packet (&s)[Dim][Dim])
{
  for (int i = 0; i < Dim; ++i)
  {
    for (int j = 0; j < Dim; ++j)
    {
      s[i][j] = Packet{};
      for (int r = 0; r < Dim; ++r)
      {
        s[i][j] += t[r][i] * t[r][j];
      }
    }
  }
}

template <int Dim>
void product(const Packet (&a)[Dim][Dim], const Packet (&b)[Dim][Dim], Packet (&ab)[Dim][Dim])
{
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      ab[r][c] = Packet{};
      for (int k = 0; k < Dim; ++k)
      {
        ab[r][c] += a[r][k] * b[k][c];
      }
    }
  }
}

/// The gradient of |adj T|^2: 2 (|T|^2 T - T T^t T).
template <int Dim>
void adjugateGradient(const Packet (&t)[Dim][Dim], Packet norm2, Packet (&g)[Dim][Dim])
{
  Packet gram[Dim][Dim];
  gramOf<Dim>(t, gram);
  product<Dim>(t, gram, g);
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      g[r][c] = 2.0 * (norm2 * t[r][c] - g[r][c]);
    }
  }
}

/// Its change if T changes by dt and |T|^2 by dNorm2: 2 (dNorm2 T + |T|^2 dT - dT T^t T - T (dT^t T
/// + T^t dT)).
template <int Dim>
void adjugateGradientChange(const Packet (&t)[Dim][Dim], Packet norm2, const Packet (&dt)[Dim][Dim],
  Packet dNorm2, Packet (&change)[Dim][Dim])
{
  Packet gram[Dim][Dim], gramChange[Dim][Dim], first[Dim][Dim], last[Dim][Dim];
  gramOf<Dim>(t, gram);
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      gramChange[r][c] = Packet{};
      for (int k = 0; k < Dim; ++k)
      {
        gramChange[r][c] += dt[k][r] * t[k][c] + t[k][r] * dt[k][c];
      }
    }
  }
  product<Dim>(dt, gram, first);
  product<Dim>(t, gramChange, last);
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      change[r][c] = 2.0 * (dNorm2 * t[r][c] + norm2 * dt[r][c] - first[r][c] - last[r][c]);
    }
  }
}

/// R^t B R
template <int Dim>
void conjugate(const SmallMatrix& root, Packet (&block)[Dim][Dim])
{
  Packet half[Dim][Dim];
  for (int r = 0; r < Dim; ++r)
  {
    for (int s = 0; s < Dim; ++s)
    {
      half[r][s] = Packet{};
      for (int k = 0; k < Dim; ++k)
      {
        half[r][s] += block[r][k] * root[k][s];
      }
    }
  }
  for (int r = 0; r < Dim; ++r)
  {
    for (int s = 0; s < Dim; ++s)
    {
      block[r][s] = Packet{};
      for (int k = 0; k < Dim; ++k)
      {
        block[r][s] += root[k][r] * half[k][s];
      }
    }
  }
}

template <int Dim>
TargetInvariants<Dim> invariantsOf(
  const Packet (&t)[Dim][Dim], const Packet (&cofactors)[Dim][Dim], bool adjugate)
{
  TargetInvariants<Dim> result;
  result.norm2 = inner<Dim>(t, t);
  // In 2D, |adj T| equals |T|.
  result.adj2 = adjugate && Dim == 3 ? inner<Dim>(cofactors, cofactors) : result.norm2;
  result.det = Packet{};
  result.trace = Packet{};
  for (int c = 0; c < Dim; ++c)
  {
    result.det += t[0][c] * cofactors[0][c];
    result.trace += t[c][c];
  }
  return result;
}

double sumOf(Packet p)
{
  double sum = 0;
  for (int l = 0; l < PacketWidth; ++l)
  {
    sum += p[l];
  }
  return sum;
}
}

//------------------------------------------------------------------------------
template <int Dim>
CurvedEnergy<Dim>::CurvedEnergy(
  const std::vector<CurvedElement>& elements, Index points, int threads)
  : Elements(elements)
  , Points(points)
  , Threads(threads)
{
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::setItems(std::vector<SampleItem> items)
{
  this->Items = std::move(items);
  this->First.assign(1, 0);
  this->FirstPacket.assign(1, 0);
  this->Offsets.assign(this->Points + 1, 0);
  for (const SampleItem& item : this->Items)
  {
    const std::vector<Index>& nodes = this->Elements[item.element].nodes;
    this->First.push_back(this->First.back() + nodes.size());
    this->FirstPacket.push_back(this->FirstPacket.back() + item.table->packets());
    for (const Index p : nodes)
    {
      ++this->Offsets[p + 1];
    }
  }
  std::partial_sum(this->Offsets.begin(), this->Offsets.end(), this->Offsets.begin());
  this->Positions.resize(this->First.back());
  // List the contributions of each point in item order, so that gather() sums them in a fixed
  // order.
  std::vector<Index> next(this->Offsets.begin(), this->Offsets.end() - 1);
  for (std::size_t i = 0; i < this->Items.size(); ++i)
  {
    const std::vector<Index>& nodes = this->Elements[this->Items[i].element].nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n)
    {
      this->Positions[next[nodes[n]]++] = this->First[i] + n;
    }
  }
  this->Shares.resize(this->First.back() * Dim);
  this->Blocks.resize(this->First.back() * MostUnique);
  this->Values.resize(this->Items.size());
  this->State.resize(this->FirstPacket.back());
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::addItems(const std::vector<SampleItem>& items)
{
  std::vector<SampleItem> all = std::move(this->Items);
  all.insert(all.end(), items.begin(), items.end());
  this->setItems(std::move(all));
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::scaleWeights(std::size_t first, double factor)
{
  for (std::size_t i = first; i < this->Items.size(); ++i)
  {
    this->Items[i].weight *= factor;
  }
}

//------------------------------------------------------------------------------
template <int Dim>
template <class Work>
void CurvedEnergy<Dim>::forEachItem(const Work& work)
{
  parallelFor(static_cast<Index>(this->Items.size()), ItemsPerChunk, this->Threads, this->Pool,
    [&](Scratch& scratch, Index i) { work(scratch.sums, static_cast<std::size_t>(i)); });
}

//------------------------------------------------------------------------------
/// A W^-1 with the ideal element W; for displacements instead of points, its change.
template <int Dim>
void CurvedEnergy<Dim>::loadIdeal(
  const SampleItem& item, int packet, const double* x, Packet (&t)[Dim][Dim]) const
{
  for (auto& row : t)
  {
    std::fill_n(row, Dim, Packet{});
  }
  const std::vector<Index>& nodes = this->Elements[item.element].nodes;
  const Packet* g = item.table->gradients(packet);
  for (const Index p : nodes)
  {
    for (int r = 0; r < Dim; ++r)
    {
      const double coordinate = x[3 * p + r];
      for (int c = 0; c < Dim; ++c)
      {
        t[r][c] += coordinate * g[c];
      }
    }
    g += Dim;
  }
}

//------------------------------------------------------------------------------
/// T, or its change.
template <int Dim>
void CurvedEnergy<Dim>::load(
  const SampleItem& item, int packet, const double* x, Packet (&t)[Dim][Dim]) const
{
  // T = M^(1/2) (A W^-1) s R; objectives without a metric M, size s or target R omit the factor.
  this->loadIdeal(item, packet, x, t);
  for (auto& row : t)
  {
    for (Packet& entry : row)
    {
      entry *= item.perSize;
    }
  }
  if (!item.targets.empty())
  {
    Packet right[Dim][Dim], full[Dim][Dim];
    std::copy_n(
      item.targets.data() + static_cast<std::size_t>(packet) * Dim * Dim, Dim * Dim, &right[0][0]);
    product<Dim>(t, right, full);
    std::copy_n(&full[0][0], Dim * Dim, &t[0][0]);
  }
  if (item.rooted)
  {
    Packet full[Dim][Dim];
    for (int r = 0; r < Dim; ++r)
    {
      for (int c = 0; c < Dim; ++c)
      {
        full[r][c] = Packet{};
        for (int k = 0; k < Dim; ++k)
        {
          full[r][c] += item.root[r][k] * t[k][c];
        }
      }
    }
    std::copy_n(&full[0][0], Dim * Dim, &t[0][0]);
  }
}

//------------------------------------------------------------------------------
/// Converts a derivative with respect to T to the nodes and adds it.
template <int Dim>
void CurvedEnergy<Dim>::addRow(
  const SampleItem& item, int packet, const Packet (&p)[Dim][Dim], std::vector<Packet>& sums) const
{
  Packet own[Dim][Dim];
  // Chain rule: from T to the Jacobian matrix, through the factors of the target.
  std::copy_n(&p[0][0], Dim * Dim, &own[0][0]);
  if (item.rooted)
  {
    for (int c = 0; c < Dim; ++c)
    {
      for (int r = 0; r < Dim; ++r)
      {
        own[r][c] = Packet{};
        for (int k = 0; k < Dim; ++k)
        {
          own[r][c] += item.root[k][r] * p[k][c];
        }
      }
    }
  }
  if (!item.targets.empty())
  {
    const Packet* right = item.targets.data() + static_cast<std::size_t>(packet) * Dim * Dim;
    for (auto& row : own)
    {
      Packet full[Dim];
      for (int c = 0; c < Dim; ++c)
      {
        full[c] = Packet{};
        for (int k = 0; k < Dim; ++k)
        {
          full[c] += row[k] * right[Dim * c + k];
        }
      }
      std::copy_n(full, Dim, row);
    }
  }
  for (auto& row : own)
  {
    for (Packet& entry : row)
    {
      entry *= item.perSize;
    }
  }
  // From the Jacobian matrix to the nodes, by the gradients of their functions.
  const Packet* g = item.table->gradients(packet);
  const int nodes = item.table->nodes();
  for (int n = 0; n < nodes; ++n)
  {
    for (int r = 0; r < Dim; ++r)
    {
      Packet sum = own[r][0] * g[0];
      for (int c = 1; c < Dim; ++c)
      {
        sum += own[r][c] * g[c];
      }
      sums[n * Dim + r] += sum;
    }
    g += Dim;
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::keep(const std::vector<Packet>& sums, std::size_t item)
{
  double* to = this->Shares.data() + this->First[item] * Dim;
  const std::size_t count = (this->First[item + 1] - this->First[item]) * Dim;
  for (std::size_t k = 0; k < count; ++k)
  {
    to[k] = sumOf(sums[k]);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedEnergy<Dim>::total(const std::vector<double>& values) const
{
  return std::accumulate(values.begin(), values.end(), 0.0);
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::gather(std::vector<double>& to) const
{
  to.assign(3 * this->Points, 0.0);
  forEachChunk(this->Points, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index p = begin; p < end; ++p)
      {
        // A point gathers its shares in a fixed order, which avoids races and makes the sums
        // reproducible.
        for (Index k = this->Offsets[p]; k < this->Offsets[p + 1]; ++k)
        {
          const double* share = this->Shares.data() + this->Positions[k] * Dim;
          for (int c = 0; c < Dim; ++c)
          {
            to[3 * p + c] += share[c];
          }
        }
      }
    });
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedEnergy<Dim>::value(const SampleFunction<Dim>& function, const std::vector<double>& x)
{
  this->forEachItem(
    [&](std::vector<Packet>&, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      Packet sum = {};
      for (int p = 0; item.weight > 0 && p < item.table->packets(); ++p)
      {
        Packet t[Dim][Dim], cofactors[Dim][Dim];
        this->load(item, p, x.data(), t);
        cofactorsOf<Dim>(t, cofactors);
        const Packet w = item.table->weights(p);
        const Packet f = function.value(invariantsOf<Dim>(t, cofactors, function.usesAdjugate()));
        // Padded lanes have weight 0, but 0 times an infinite value would be NaN.
        sum += select(w > 0.0, w * f, Packet{});
      }
      this->Values[i] = item.weight > 0 ? item.weight * sumOf(sum) : 0;
    });
  const double sum = this->total(this->Values);
  // An undefined value counts as infinite, so that a line search rejects it.
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedEnergy<Dim>::partialValue(std::size_t items) const
{
  return std::accumulate(this->Values.begin(), this->Values.begin() + items, 0.0);
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedEnergy<Dim>::linearize(const SampleFunction<Dim>& function,
  const std::vector<double>& x, std::vector<double>& gradient, std::vector<PointBlock>& diagonal)
{
  this->Adjugate = function.usesAdjugate();
  this->Trace = function.usesTrace();
  this->forEachItem(
    [&](std::vector<Packet>& sums, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      const auto nodes = static_cast<std::size_t>(item.table->nodes());
      sums.assign(nodes * (Dim + MostUnique), Packet{});
      Packet energy = {};
      for (int p = 0; p < item.table->packets(); ++p)
      {
        Kept& kept = this->State[this->FirstPacket[i] + p];
        Packet cofactors[Dim][Dim];
        this->load(item, p, x.data(), kept.t);
        cofactorsOf<Dim>(kept.t, cofactors);
        const TargetInvariants<Dim> t = invariantsOf<Dim>(kept.t, cofactors, this->Adjugate);
        SampleTerm term;
        function.curvatures(t, term);
        // Lanes without weight or with a nonfinite value are excluded.
        const Packet w = item.weight * item.table->weights(p);
        const Mask counts = w > 0.0;
        energy += select(counts, w * term.value, Packet{});
        const auto weighted = [&](Packet y)
        { return select(counts, finiteOrZero(w * y), Packet{}); };
        std::transform(term.slopes, term.slopes + NumberOfInvariants, kept.slopes, weighted);
        std::transform(
          term.curvatures, term.curvatures + NumberOfSecondDerivatives, kept.curvatures, weighted);
        kept.bend = weighted(term.bend);
        Packet derivative[Dim][Dim], ofAdjugate[Dim][Dim];
        if (this->Adjugate)
        {
          adjugateGradient<Dim>(kept.t, t.norm2, ofAdjugate);
        }
        // dF/dT = 2 F_norm T + F_adj grad |adj T|^2 + F_det cof T + F_trace I.
        for (int r = 0; r < Dim; ++r)
        {
          for (int c = 0; c < Dim; ++c)
          {
            derivative[r][c] =
              2.0 * kept.slopes[0] * kept.t[r][c] + kept.slopes[2] * cofactors[r][c];
            if (this->Adjugate)
            {
              derivative[r][c] += kept.slopes[1] * ofAdjugate[r][c];
            }
          }
          derivative[r][r] += kept.slopes[3];
        }
        this->addRow(item, p, derivative, sums);
        this->addDiagonal(item, p, kept, sums);
      }
      this->Values[i] = sumOf(energy);
      this->keep(sums, i);
      double* blocks = this->Blocks.data() + this->First[i] * MostUnique;
      for (std::size_t k = 0; k < nodes * MostUnique; ++k)
      {
        blocks[k] = sumOf(sums[nodes * Dim + k]);
      }
    });
  this->gather(gradient);
  diagonal.assign(this->Points, PointBlock{});
  for (Index p = 0; p < this->Points; ++p)
  {
    for (Index k = this->Offsets[p]; k < this->Offsets[p + 1]; ++k)
    {
      const double* block = this->Blocks.data() + this->Positions[k] * MostUnique;
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c <= r; ++c)
        {
          diagonal[p][r][c] += block[secondDerivative(r, c)];
        }
      }
    }
    for (int r = 0; r < Dim; ++r)
    {
      for (int c = 0; c < r; ++c)
      {
        diagonal[p][c][r] = diagonal[p][r][c];
      }
    }
  }
  const double sum = this->total(this->Values);
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

//------------------------------------------------------------------------------
/// The second derivatives with respect to one node in the directions u: T changes by u g^t, and det
/// T is linear in u.
template <int Dim>
void CurvedEnergy<Dim>::addDiagonal(
  const SampleItem& item, int packet, const Kept& kept, std::vector<Packet>& sums) const
{
  Packet cofactors[Dim][Dim], ofAdjugate[Dim][Dim], gram[Dim][Dim], left[Dim][Dim];
  cofactorsOf<Dim>(kept.t, cofactors);
  const Packet norm2 = inner<Dim>(kept.t, kept.t);
  if (this->Adjugate)
  {
    adjugateGradient<Dim>(kept.t, norm2, ofAdjugate);
    gramOf<Dim>(kept.t, gram);
    for (int r = 0; r < Dim; ++r)
    {
      for (int s = 0; s < Dim; ++s)
      {
        left[r][s] = Packet{};
        for (int k = 0; k < Dim; ++k)
        {
          left[r][s] += kept.t[r][k] * kept.t[s][k];
        }
      }
    }
  }
  const Packet* right = item.targets.empty()
    ? nullptr
    : item.targets.data() + static_cast<std::size_t>(packet) * Dim * Dim;
  const Packet* given = item.table->gradients(packet);
  const int nodes = item.table->nodes();
  Packet* to = sums.data() + static_cast<std::size_t>(nodes) * Dim;
  for (int n = 0; n < nodes; ++n, given += Dim, to += MostUnique)
  {
    Packet g[Dim], square = {};
    for (int c = 0; c < Dim; ++c)
    {
      g[c] = given[c];
      if (right)
      {
        g[c] = Packet{};
        for (int k = 0; k < Dim; ++k)
        {
          g[c] += given[k] * right[Dim * k + c];
        }
      }
      g[c] *= item.perSize;
      square += g[c] * g[c];
    }
    // The changes of the invariants along u.
    Packet change[NumberOfInvariants][Dim], stretch = {};
    for (int r = 0; r < Dim; ++r)
    {
      change[0][r] = change[1][r] = change[2][r] = Packet{};
      for (int c = 0; c < Dim; ++c)
      {
        change[0][r] += 2.0 * kept.t[r][c] * g[c];
        change[2][r] += cofactors[r][c] * g[c];
        if (this->Adjugate)
        {
          change[1][r] += ofAdjugate[r][c] * g[c];
          stretch += g[r] * gram[r][c] * g[c];
        }
      }
      change[3][r] = g[r];
    }
    Packet block[Dim][Dim];
    for (int r = 0; r < Dim; ++r)
    {
      for (int s = 0; s <= r; ++s)
      {
        // Along u, the second derivative of |T|^2 is 2 |g|^2 |u|^2; the determinant has none.
        Packet entry = r == s ? 2.0 * kept.slopes[0] * square : Packet{};
        if (this->Adjugate)
        {
          // The second derivative of |adj T|^2 along u and v is twice (u T g) (v T g) + (u . v)
          // (|T|^2 |g|^2 - |T g|^2) - |g|^2 (u T T^t v).
          const Packet isotropic = r == s ? norm2 * square - stretch : Packet{};
          entry += 2.0 * kept.slopes[1] *
            (0.25 * change[0][r] * change[0][s] + isotropic - square * left[r][s]);
        }
        for (int i = 0; i < NumberOfInvariants; ++i)
        {
          const bool used = i == 1 ? this->Adjugate : i != 3 || this->Trace;
          for (int j = 0; used && j <= i; ++j)
          {
            const Packet c = kept.curvatures[secondDerivative(i, j)];
            entry += i == j ? c * change[i][r] * change[i][s]
                            : c * (change[i][r] * change[j][s] + change[j][r] * change[i][s]);
          }
        }
        block[r][s] = block[s][r] = entry;
      }
    }
    // With a metric, a displacement u changes T by M^(1/2) u g^t.
    if (item.rooted)
    {
      conjugate<Dim>(item.root, block);
    }
    for (int r = 0; r < Dim; ++r)
    {
      for (int s = 0; s <= r; ++s)
      {
        to[secondDerivative(r, s)] += block[r][s];
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The change of the derivative with respect to T if T changes by dt.
template <int Dim>
void CurvedEnergy<Dim>::changeOf(
  const Kept& kept, const Packet (&dt)[Dim][Dim], Packet (&derivative)[Dim][Dim]) const
{
  Packet cofactors[Dim][Dim], ofCofactors[Dim][Dim];
  cofactorsOf<Dim>(kept.t, cofactors);
  cofactorChange<Dim>(kept.t, dt, ofCofactors);
  // The changes of |T|^2 and det T; the others follow where a function uses them.
  Packet change[NumberOfInvariants] = { 2.0 * inner<Dim>(kept.t, dt), Packet{},
    inner<Dim>(cofactors, dt), Packet{} };
  Packet ofAdjugate[Dim][Dim], second[Dim][Dim];
  if (this->Adjugate)
  {
    const Packet norm2 = inner<Dim>(kept.t, kept.t);
    adjugateGradient<Dim>(kept.t, norm2, ofAdjugate);
    change[1] = inner<Dim>(ofAdjugate, dt);
    adjugateGradientChange<Dim>(kept.t, norm2, dt, change[0], second);
  }
  for (int r = 0; this->Trace && r < Dim; ++r)
  {
    change[3] += dt[r][r];
  }
  // The slopes change by the curvatures times the changes of all invariants.
  Packet slopes[NumberOfInvariants];
  for (int k = 0; k < NumberOfInvariants; ++k)
  {
    slopes[k] = Packet{};
    for (int j = 0; j < NumberOfInvariants; ++j)
    {
      slopes[k] += kept.curvatures[secondDerivative(std::max(k, j), std::min(k, j))] * change[j];
    }
  }
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      derivative[r][c] = 2.0 * (slopes[0] * kept.t[r][c] + kept.slopes[0] * dt[r][c]) +
        slopes[2] * cofactors[r][c] + kept.bend * ofCofactors[r][c];
      if (this->Adjugate)
      {
        derivative[r][c] += slopes[1] * ofAdjugate[r][c] + kept.slopes[1] * second[r][c];
      }
    }
    derivative[r][r] += slopes[3];
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedEnergy<Dim>::apply(const std::vector<double>& d, std::vector<double>& result)
{
  this->forEachItem(
    [&](std::vector<Packet>& sums, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      sums.assign(static_cast<std::size_t>(item.table->nodes()) * Dim, Packet{});
      for (int p = 0; item.weight > 0 && p < item.table->packets(); ++p)
      {
        Packet dt[Dim][Dim], derivative[Dim][Dim];
        this->load(item, p, d.data(), dt);
        this->changeOf(this->State[this->FirstPacket[i] + p], dt, derivative);
        this->addRow(item, p, derivative, sums);
      }
      this->keep(sums, i);
    });
  this->gather(result);
}

//------------------------------------------------------------------------------
/// Sets the value of each item to its smallest determinant.
template <int Dim>
template <class Load>
void CurvedEnergy<Dim>::findLeast(const std::vector<double>& x, const Load& load)
{
  this->forEachItem(
    [&](std::vector<Packet>&, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      Packet least = broadcast(std::numeric_limits<double>::infinity());
      for (int p = 0; p < item.table->packets(); ++p)
      {
        Packet t[Dim][Dim], cofactors[Dim][Dim];
        load(item, p, x.data(), t);
        cofactorsOf<Dim>(t, cofactors);
        least = min(least, invariantsOf<Dim>(t, cofactors, false).det); // padded lanes are copies
      }
      double& value = this->Values[i] = least[0];
      for (int l = 1; l < PacketWidth; ++l)
      {
        value = std::min(value, static_cast<double>(least[l]));
      }
    });
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedEnergy<Dim>::leastDeterminant(const std::vector<double>& x)
{
  this->findLeast(x,
    [this](const SampleItem& item, int packet, const double* from, Packet(&t)[Dim][Dim])
    { this->load(item, packet, from, t); });
  return *std::min_element(this->Values.begin(), this->Values.end());
}

//------------------------------------------------------------------------------
template <int Dim>
std::vector<double> CurvedEnergy<Dim>::leastJacobians(const std::vector<double>& x)
{
  this->findLeast(x,
    [this](const SampleItem& item, int packet, const double* from, Packet(&t)[Dim][Dim])
    { this->loadIdeal(item, packet, from, t); });
  std::vector<double> least(this->Elements.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < this->Items.size(); ++i)
  {
    double& own = least[this->Items[i].element];
    // The determinant of the ideal element converts det(A W^-1) to the Jacobian.
    own = std::min(own, this->Values[i] * this->Items[i].table->idealDeterminant());
  }
  return least;
}

//------------------------------------------------------------------------------
template <int Dim>
std::vector<double> CurvedEnergy<Dim>::meanNorms(const std::vector<double>& x)
{
  this->forEachItem(
    [&](std::vector<Packet>&, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      Packet sum = {}, weights = {};
      for (int p = 0; p < item.table->packets(); ++p)
      {
        Packet t[Dim][Dim];
        this->loadIdeal(item, p, x.data(), t);
        sum += item.table->weights(p) * inner<Dim>(t, t);
        weights += item.table->weights(p);
      }
      this->Values[i] = sumOf(sum) / sumOf(weights);
    });
  return this->Values;
}

//------------------------------------------------------------------------------
template <int Dim>
SampleRange CurvedEnergy<Dim>::range(
  const SampleFunction<Dim>& function, const std::vector<double>& x, std::size_t items)
{
  std::vector<double> largest(this->Items.size(), -std::numeric_limits<double>::infinity());
  // Later calls need the values of the energy, which are restored at the end.
  const std::vector<double> last = this->Values;
  this->forEachItem(
    [&](std::vector<Packet>&, std::size_t i)
    {
      const SampleItem& item = this->Items[i];
      Packet sum = {}, weights = {};
      for (int p = 0; item.weight > 0 && i < items && p < item.table->packets(); ++p)
      {
        Packet t[Dim][Dim], cofactors[Dim][Dim];
        this->load(item, p, x.data(), t);
        cofactorsOf<Dim>(t, cofactors);
        const Packet w = item.table->weights(p);
        const Packet f = function.value(invariantsOf<Dim>(t, cofactors, function.usesAdjugate()));
        sum += select(w > 0.0, w * f, Packet{});
        weights += w;
        for (int l = 0; l < PacketWidth; ++l)
        {
          largest[i] = w[l] > 0 ? std::max(largest[i], static_cast<double>(f[l])) : largest[i];
        }
      }
      const double weight = sumOf(weights);
      this->Values[i] = weight > 0 ? sumOf(sum) / weight : 0;
    });
  SampleRange range = { 0, -std::numeric_limits<double>::infinity() };
  Index count = 0;
  for (std::size_t i = 0; i < items; ++i)
  {
    if (std::isfinite(largest[i]))
    {
      range.mean += this->Values[i];
      range.largest = std::max(range.largest, largest[i]);
      ++count;
    }
  }
  this->Values = last; // restore the values of the energy
  range.mean = count > 0 ? range.mean / static_cast<double>(count) : 0;
  range.largest = count > 0 ? range.largest : 0;
  return range;
}

template class CurvedEnergy<2>;
template class CurvedEnergy<3>;
}
