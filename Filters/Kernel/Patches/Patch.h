// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Patch.h
 * @brief The simplices around one free vertex, in packets, as functions of its displacement d:
 *
 *     N(d) = N0 - 2 d . S + C |d|^2        D(d) = D0 - d . n
 *
 * (see SimplexMesh.h), and a damped Newton method for the sum of an energy f(N, D) over them.
 * Internal: not installed.
 */
#ifndef tautline_Patch_h
#define tautline_Patch_h

#include "SimplexMesh.h"
#include "tautline/Core/Packet.h"
#include "tautline/Core/SmallCholesky.h"

#include <limits>

namespace tautline
{
/// An energy f(N, D) of one simplex with its first and second derivatives.
struct EnergyTerms
{
  Packet f, fN, fD, fNN, fND, fDD;
};

/// The four coordinates of a vertex per lane, as x y z.
inline void loadVertices(const double* x, const std::int32_t* ids, int stride, Packet* xyz)
{
#if defined(__AVX512F__)
  using Quad = double __attribute__((vector_size(32)));
  const auto load = [=](int lane)
  {
    Quad q;
    std::memcpy(&q, x + VertexStride * static_cast<std::size_t>(ids[lane * stride]), sizeof(q));
    return q;
  };
  const auto two = [&](int lane)
  { return __builtin_shufflevector(load(lane), load(lane + 4), 0, 1, 2, 3, 4, 5, 6, 7); };
  const Packet a = two(0), b = two(1), c = two(2), d = two(3);
  const Packet xzLow = __builtin_shufflevector(a, b, 0, 8, 4, 12, 2, 10, 6, 14);
  const Packet xzHigh = __builtin_shufflevector(c, d, 0, 8, 4, 12, 2, 10, 6, 14);
  const Packet yLow = __builtin_shufflevector(a, b, 1, 9, 5, 13, 1, 9, 5, 13);
  const Packet yHigh = __builtin_shufflevector(c, d, 1, 9, 5, 13, 1, 9, 5, 13);
  // Lanes 0 1 4 5 2 3 6 7 of the first halves become 0 1 2 3 4 5 6 7.
  xyz[0] = __builtin_shufflevector(xzLow, xzHigh, 0, 1, 8, 9, 2, 3, 10, 11);
  xyz[1] = __builtin_shufflevector(yLow, yHigh, 0, 1, 8, 9, 2, 3, 10, 11);
  xyz[2] = __builtin_shufflevector(xzLow, xzHigh, 4, 5, 12, 13, 6, 7, 14, 15);
#else
  double lanes[3][PacketWidth];
  for (int l = 0; l < PacketWidth; ++l)
  {
    const double* p = x + VertexStride * static_cast<std::size_t>(ids[l * stride]);
    for (int c = 0; c < 3; ++c)
    {
      lanes[c][l] = p[c];
    }
  }
  std::memcpy(xyz, lanes, sizeof(lanes));
#endif
}

template <int Dim>
struct PatchPacket
{
  Packet N0, D0, C;
  Packet S[Dim], n[Dim];
  Packet weight; ///< of the simplex in the sum; 0 in padding lanes
};

/// A patch: the work space of a thread.
template <int Dim>
struct Patch
{
  std::vector<PatchPacket<Dim>> packets;
  int count = 0;
};

/// The sum of an energy over a patch with its gradient and Hessian with respect to the
/// displacement.
template <int Dim>
struct PatchSum
{
  double f;
  double g[Dim];
  double H[Dim][Dim];
};

/// Sum by halves: the same order in every run, and few instructions.
inline double sumOf(Packet x)
{
#if defined(__AVX512F__)
  const auto four =
    __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
  const Pair two =
    __builtin_shufflevector(four, four, 0, 1) + __builtin_shufflevector(four, four, 2, 3);
#elif defined(__AVX__)
  const Pair two = __builtin_shufflevector(x, x, 0, 1) + __builtin_shufflevector(x, x, 2, 3);
#else
  const Pair two = x;
#endif
  return two[0] + two[1];
}

inline double minOf(Packet x)
{
  double smallest = x[0];
  for (int l = 1; l < PacketWidth; ++l)
  {
    smallest = x[l] < smallest ? x[l] : smallest;
  }
  return smallest;
}

/// A length scale of the patch: from edge lengths of its first simplex with nonzero weight.
template <int Dim>
double sizeOf(const Patch<Dim>& patch)
{
  for (int i = 0; i < patch.count; ++i)
  {
    const PatchPacket<Dim>& p = patch.packets[i];
    for (int l = 0; l < PacketWidth; ++l)
    {
      if (p.C[l] > 0)
      {
        return std::sqrt(p.N0[l] / p.C[l]);
      }
    }
  }
  return 0.0;
}

/// N and D of the simplices of a packet at the displacement d.
template <int Dim>
void invariants(const PatchPacket<Dim>& p, const double* d, Packet& N, Packet& D)
{
  Packet dS = {}, dn = {};
  double d2 = 0;
  for (int c = 0; c < Dim; ++c)
  {
    dS += d[c] * p.S[c];
    dn += d[c] * p.n[c];
    d2 += d[c] * d[c];
  }
  N = p.N0 - 2.0 * dS + p.C * d2;
  D = p.D0 - dn;
}

/**
 * @brief Whether the simplices that are valid at `from` are valid at `to` with a margin. Without a
 * barrier, steps that each stop just before inversion would accumulate there.
 */
template <int Dim>
bool staysValid(const Patch<Dim>& patch, const double* from, const double* to)
{
  constexpr double room = 1e-10; // of the determinant of the ideal shape; degenerate is 1e-13
  const auto size = [](Packet N) { return Dim == 2 ? N : N * sqrt(N); };
  for (int i = 0; i < patch.count; ++i)
  {
    Packet N0, D0, N, D;
    invariants(patch.packets[i], from, N0, D0);
    invariants(patch.packets[i], to, N, D);
    // Simplices that start below the margin may not get worse.
    const Mask lost = (D0 > 0.0) & ~(D > room * size(N)) & ~(D * size(N0) >= D0 * size(N));
    if (any(lost & (patch.packets[i].C > 0.0)))
    {
      return false;
    }
  }
  return true;
}

/// The edge coefficients at the first vertex of each patch simplex, of its other edges, and the
/// determinants.
template <int Dim>
void loadTargets(
  const SimplexMesh& mesh, std::int32_t first, int lanes, Packet* at, Packet* across, Packet& det)
{
  // Indices into TargetSimplex::edge for each vertex in front: at a b c, across ab bc ca.
  static constexpr int places3[4][6] = { { 0, 1, 2, 3, 5, 4 }, { 0, 4, 3, 2, 5, 1 },
    { 5, 1, 3, 2, 0, 4 }, { 5, 4, 2, 3, 0, 1 } };
  static constexpr int places2[3][3] = { { 0, 1, 2 }, { 2, 0, 1 }, { 1, 2, 0 } };
  for (int l = 0; l < PacketWidth; ++l)
  {
    const std::int32_t corner = mesh.patchCorners()[first + std::min(l, lanes - 1)];
    const TargetSimplex& t = mesh.target(corner / (Dim + 1));
    const int* place = Dim == 3 ? places3[corner % (Dim + 1)] : places2[corner % (Dim + 1)];
    for (int k = 0; k < Dim; ++k)
    {
      at[k][l] = t.edge[place[k]];
    }
    for (int k = 0; k < (Dim == 3 ? 3 : 1); ++k)
    {
      across[k][l] = t.edge[place[Dim + k]];
    }
    det[l] = t.det;
  }
}

/// The edges from v to the other vertices of the simplices of a packet; in the plane of the
/// tangents, if there are any. @param inSpace whether tangents of triangles have three coordinates
template <int Dim>
void loadEdges(const double* x, const double* center, const std::int32_t* ids, const Vec3* tangents,
  Packet (&e)[Dim][3], bool inSpace = false)
{
  for (int k = 0; k < Dim; ++k)
  {
    loadVertices(x, ids + k, Dim, e[k]);
    for (int c = 0; c < (tangents || inSpace ? 3 : Dim); ++c)
    {
      e[k][c] -= center[c];
    }
    if (tangents)
    {
      const Packet inPlane[2] = { e[k][0] * tangents[0][0] + e[k][1] * tangents[0][1] +
          e[k][2] * tangents[0][2],
        e[k][0] * tangents[1][0] + e[k][1] * tangents[1][1] + e[k][2] * tangents[1][2] };
      e[k][0] = inPlane[0];
      e[k][1] = inPlane[1];
    }
  }
}

/// Edges of triangles, each rotated about a line through v into one plane, as on a curve where
/// patches meet at an angle; the line is the first axis. @param tangent of unit length
inline void unfoldEdges(const Vec3& tangent, Packet (&e)[2][3])
{
  const auto along = [](const Packet* a, const Packet* b)
  { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  Packet n[3], t[3], y[3], x[3];
  const auto cross3 = [](const Packet* a, const Packet* b, Packet* r)
  {
    r[0] = a[1] * b[2] - a[2] * b[1];
    r[1] = a[2] * b[0] - a[0] * b[2];
    r[2] = a[0] * b[1] - a[1] * b[0];
  };
  for (int c = 0; c < 3; ++c)
  {
    t[c] = broadcast(tangent[c]);
  }
  cross3(e[0], e[1], n);
  cross3(n, t, y);
  cross3(y, n, x);
  const Packet xx = along(x, x), yy = along(y, y);
  // A triangle without area, or perpendicular to the line, has no side relative to the line.
  const Mask there = (xx > 0.0) & (yy > 0.0);
  const Packet ofX = select(there, 1.0 / sqrt(select(there, xx, broadcast(1.0))), Packet{}),
               ofY = select(there, 1.0 / sqrt(select(there, yy, broadcast(1.0))), Packet{});
  for (int k = 0; k < 2; ++k)
  {
    const Packet inPlane[2] = { ofX * along(e[k], x), ofY * along(e[k], y) };
    e[k][0] = inPlane[0];
    e[k][1] = inPlane[1];
  }
}

/**
 * @brief Sets the coefficients of N(d) and D(d) for the simplices of a packet.
 * @param at, across the coefficients of the edges e at v and of the others
 */
template <int Dim>
void setCoefficients(const Packet (&e)[Dim][3], const Packet (&at)[Dim], const Packet (&across)[3],
  Packet det, PatchPacket<Dim>& p)
{
  if constexpr (Dim == 3)
  {
    Packet ab[3], bc[3], ca[3];
    const auto cross3 = [](const Packet* a, const Packet* b, Packet* r)
    {
      r[0] = a[1] * b[2] - a[2] * b[1];
      r[1] = a[2] * b[0] - a[0] * b[2];
      r[2] = a[0] * b[1] - a[1] * b[0];
    };
    cross3(e[0], e[1], ab);
    cross3(e[1], e[2], bc);
    cross3(e[2], e[0], ca);
    p.D0 = det * (e[0][0] * bc[0] + e[0][1] * bc[1] + e[0][2] * bc[2]);
    p.N0 = Packet{};
    p.C = at[0] + at[1] + at[2];
    for (int c = 0; c < 3; ++c)
    {
      p.n[c] = det * (ab[c] + bc[c] + ca[c]);
      p.S[c] = at[0] * e[0][c] + at[1] * e[1][c] + at[2] * e[2][c];
      const Packet d01 = e[0][c] - e[1][c], d12 = e[1][c] - e[2][c], d20 = e[2][c] - e[0][c];
      p.N0 += at[0] * e[0][c] * e[0][c] + at[1] * e[1][c] * e[1][c] + at[2] * e[2][c] * e[2][c] +
        across[0] * d01 * d01 + across[1] * d12 * d12 + across[2] * d20 * d20;
    }
  }
  else
  {
    const Packet dx = e[0][0] - e[1][0], dy = e[0][1] - e[1][1];
    p.D0 = det * (e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    p.n[0] = -det * dy;
    p.n[1] = det * dx;
    p.C = at[0] + at[1];
    p.N0 = across[0] * (dx * dx + dy * dy);
    for (int c = 0; c < 2; ++c)
    {
      p.S[c] = at[0] * e[0][c] + at[1] * e[1][c];
      p.N0 += at[0] * e[0][c] * e[0][c] + at[1] * e[1][c] * e[1][c];
    }
  }
}

/// Gives simplices of weight 0 the invariants of a fixed ideal simplex.
template <int Dim>
void clearWeightless(PatchPacket<Dim>& p)
{
  const Mask there = p.weight != 0.0;
  p.N0 = select(there, p.N0, broadcast(Dim));
  p.D0 = select(there, p.D0, broadcast(1.0));
  p.C = select(there, p.C, Packet{});
  for (int c = 0; c < Dim; ++c)
  {
    p.S[c] = select(there, p.S[c], Packet{});
    p.n[c] = select(there, p.n[c], Packet{});
  }
}

/**
 * @brief Builds the patch of v from the coordinates x.
 * @param simplexWeights per simplex, or null; simplices of weight 0 are ignored
 * @param tangents of a surface at v: the patch is projected onto their plane; otherwise null
 * @param unfold whether the triangles are unfolded along the first tangent instead of projected
 */
template <int Dim>
void gatherPatch(const SimplexMesh& mesh, const double* x, std::int32_t v,
  const double* simplexWeights, Patch<Dim>& patch, const Vec3* tangents = nullptr,
  bool unfold = false)
{
  const std::int32_t begin = mesh.patchStart(v), end = mesh.patchStart(v + 1);
  patch.count = (end - begin + PacketWidth - 1) / PacketWidth;
  if (patch.packets.size() < static_cast<std::size_t>(patch.count))
  {
    patch.packets.resize(patch.count);
  }
  const double* center = x + VertexStride * static_cast<std::size_t>(v);
  const bool uniform = mesh.uniform();
  for (int i = 0; i < patch.count; ++i)
  {
    PatchPacket<Dim>& p = patch.packets[i];
    const std::int32_t first = begin + i * PacketWidth;
    const int lanes = std::min(PacketWidth, end - first);
    const std::int32_t* ids = mesh.patchVertices() + static_cast<std::size_t>(Dim) * first;
    std::int32_t filled[Dim * PacketWidth];
    p.weight = broadcast(1.0);
    if (lanes < PacketWidth)
    {
      // The last lanes repeat a simplex with zero weight.
      for (int l = 0; l < PacketWidth; ++l)
      {
        for (int k = 0; k < Dim; ++k)
        {
          filled[Dim * l + k] = ids[Dim * std::min(l, lanes - 1) + k];
        }
        p.weight[l] = l < lanes ? 1.0 : 0.0;
      }
      ids = filled;
    }
    Packet e[Dim][3] = {};
    if constexpr (Dim == 2)
    {
      loadEdges<Dim>(x, center, ids, unfold ? nullptr : tangents, e, unfold);
      if (unfold)
      {
        unfoldEdges(tangents[0], e);
      }
    }
    else
    {
      loadEdges<Dim>(x, center, ids, nullptr, e);
    }
    // Coefficients of the edges at v, of the others, and of the determinant.
    Packet at[Dim] = {}, across[3] = {}, det = {};
    if (uniform)
    {
      const TargetSimplex& t = mesh.target(0);
      for (int k = 0; k < Dim; ++k)
      {
        at[k] = broadcast(t.edge[0]);
      }
      across[0] = across[1] = across[2] = broadcast(t.edge[0]);
      det = broadcast(t.det);
    }
    else
    {
      loadTargets<Dim>(mesh, first, lanes, at, across, det);
    }
    if (simplexWeights)
    {
      for (int l = 0; l < lanes; ++l)
      {
        p.weight[l] = simplexWeights[mesh.patchCorners()[first + l] / (Dim + 1)];
      }
    }
    setCoefficients<Dim>(e, at, across, det, p);
    if (simplexWeights && any(p.weight == 0.0))
    {
      clearWeightless<Dim>(p);
    }
  }
}

/// The sum over a patch at the displacement d, which the energy must allow.
template <int Dim, class Energy>
PatchSum<Dim> sumOver(const Patch<Dim>& patch, const double* d, const Energy& energy)
{
  Packet f = {}, diagonal = {}, g[Dim] = {}, H[Dim][Dim] = {};
  for (int i = 0; i < patch.count; ++i)
  {
    const PatchPacket<Dim>& p = patch.packets[i];
    Packet N, D;
    invariants(p, d, N, D);
    EnergyTerms e;
    energy.terms(N, D, e);
    const Packet fN = p.weight * e.fN, fD = p.weight * e.fD, fNN = p.weight * e.fNN,
                 fND = p.weight * e.fND, fDD = p.weight * e.fDD;
    f += p.weight * e.f;
    diagonal += 2.0 * fN * p.C;
    Packet a[Dim], u[Dim], w[Dim]; // a is the gradient of N, -n the gradient of D
    for (int c = 0; c < Dim; ++c)
    {
      a[c] = 2.0 * (p.C * d[c] - p.S[c]);
      g[c] += fN * a[c] - fD * p.n[c];
      u[c] = fNN * a[c] - fND * p.n[c];
      w[c] = fDD * p.n[c] - fND * a[c];
    }
    for (int r = 0; r < Dim; ++r)
    {
      for (int c = 0; c <= r; ++c)
      {
        H[r][c] += a[r] * u[c] + p.n[r] * w[c];
      }
    }
  }
  PatchSum<Dim> sum;
  sum.f = sumOf(f);
  const double onDiagonal = sumOf(diagonal);
  for (int r = 0; r < Dim; ++r)
  {
    sum.g[r] = sumOf(g[r]);
    for (int c = 0; c <= r; ++c)
    {
      sum.H[r][c] = sum.H[c][r] = sumOf(H[r][c]) + (r == c ? onDiagonal : 0.0);
    }
  }
  return sum;
}

/// The sum alone; +infinity where the energy does not allow d.
template <int Dim, class Energy>
double valueOver(const Patch<Dim>& patch, const double* d, const Energy& energy)
{
  Packet f = {};
  for (int i = 0; i < patch.count; ++i)
  {
    Packet N, D;
    invariants(patch.packets[i], d, N, D);
    f += patch.packets[i].weight * energy.value(N, D);
  }
  return sumOf(f);
}

/// The step along s at which the first positive D of the patch vanishes; infinity if none does.
template <int Dim>
double stepToInversion(const Patch<Dim>& patch, const double* d, const double* s)
{
  Packet smallest = broadcast(std::numeric_limits<double>::infinity());
  for (int i = 0; i < patch.count; ++i)
  {
    const PatchPacket<Dim>& p = patch.packets[i];
    Packet rate = {}, D = p.D0;
    for (int c = 0; c < Dim; ++c)
    {
      rate += s[c] * p.n[c];
      D -= d[c] * p.n[c];
    }
    smallest = select((rate > 0.0) & (D > 0.0) & (D < smallest * rate), D / rate, smallest);
  }
  return minOf(smallest);
}

/// The Newton direction -H^-1 g, with H made positive definite if it is not.
template <int Dim>
void newtonDirection(const PatchSum<Dim>& sum, double* s)
{
  double square = 0;
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      square += sum.H[r][c] * sum.H[r][c];
    }
  }
  constexpr double smallPivot = 1e-8, growth = 10.0;
  using Factor = SmallCholesky<Dim, CholeskyDiagonal::Root>;
  const double norm = std::sqrt(square);
  double L[Factor::Entries];
  // The shift of the second try exceeds every negative eigenvalue.
  double shift = 0.0;
  while (!Factor::factor(sum.H, shift, smallPivot * norm, L) && std::isfinite(shift))
  {
    shift = shift > 0.0 ? growth * shift : norm + std::numeric_limits<double>::min();
  }
  for (int r = 0; r < Dim; ++r)
  {
    s[r] = -sum.g[r];
  }
  Factor::solve(L, s);
}
}
#endif
