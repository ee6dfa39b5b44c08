// SPDX-License-Identifier: BSD-3-Clause
#include "TangledMesh.h"

#include "LinearProgram.h"
#include "tautline/Core/LineSearch.h"
#include "tautline/Patches/Energies.h"

namespace tautline
{
namespace
{
/// The endpoints of the edges in the order of TargetSimplex::edge.
constexpr int Edges3[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
constexpr int Edges2[3][2] = { { 0, 1 }, { 0, 2 }, { 1, 2 } };

/// With fewer simplices, threads spend more time waiting for each other than working.
constexpr std::int32_t WorthThreads = 32768;
}

//------------------------------------------------------------------------------
template <int Dim>
TangledMesh<Dim>::TangledMesh(SimplexMesh& mesh, int threads)
  : Simplices(mesh)
  , Threads(mesh.simplices() < WorthThreads ? 1 : threads)
  , Infeasible(mesh.simplices(), 0)
{
  for (std::int32_t s = 0; s < mesh.simplices(); ++s)
  {
    const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(Dim + 1) * s;
    this->Infeasible[s] = *std::min_element(corner, corner + Dim + 1) >= mesh.freeVertices();
  }
}

template <int Dim>
void TangledMesh<Dim>::exclude(const std::vector<std::int32_t>& simplices)
{
  if (simplices.empty())
  {
    return;
  }
  for (std::int32_t s : simplices)
  {
    this->Infeasible[s] = 1;
  }
  // In the order of SimplexMesh's patches.
  const std::int32_t free = this->Simplices.freeVertices();
  this->InfeasibleEntry.assign(this->Simplices.patchStart(free), 0);
  std::vector<std::int32_t> next(free);
  for (std::int32_t v = 0; v < free; ++v)
  {
    next[v] = this->Simplices.patchStart(v);
  }
  for (std::int32_t s = 0; s < this->Simplices.simplices(); ++s)
  {
    for (int k = 0; k <= Dim; ++k)
    {
      const std::int32_t v = this->Simplices.corners()[static_cast<std::size_t>(Dim + 1) * s + k];
      if (v < free)
      {
        this->InfeasibleEntry[next[v]++] = this->Infeasible[s];
      }
    }
  }
}

template <int Dim>
void TangledMesh<Dim>::gather(const double* x, std::int32_t v, Patch<Dim>& patch) const
{
  gatherPatch<Dim>(this->Simplices, x, v, nullptr, patch);
  if (!this->InfeasibleEntry.empty())
  {
    const std::int32_t begin = this->Simplices.patchStart(v),
                       end = this->Simplices.patchStart(v + 1);
    for (std::int32_t i = begin; i < end; ++i)
    {
      if (this->InfeasibleEntry[i])
      {
        patch.packets[(i - begin) / PacketWidth].weight[(i - begin) % PacketWidth] = 0.0;
      }
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
PatchState TangledMesh<Dim>::examine(const Patch<Dim>& patch, const double* d) const
{
  Packet invalid = {}, size = {}, count = {};
  Packet smallest = broadcast(std::numeric_limits<double>::infinity());
  for (int i = 0; i < patch.count; ++i)
  {
    const PatchPacket<Dim>& p = patch.packets[i];
    Packet N, D;
    invariants(p, d, N, D);
    const Mask counts = p.weight > 0.0;
    const Mask isInvalid = ~(D > this->Margin * sizeOf<Dim>(N)) & counts;
    invalid += select(isInvalid, broadcast(1.0), Packet{});
    smallest = select((D < smallest) & counts, D, smallest);
    size += p.weight * abs(D);
    count += p.weight;
  }
  PatchState state;
  state.invalid = static_cast<int>(sumOf(invalid));
  state.minDeterminant = minOf(smallest);
  state.meanDeterminant = sumOf(size) / std::max(1.0, sumOf(count));
  return state;
}

//------------------------------------------------------------------------------
/// The edge coefficients and determinants of the targets of the simplices starting at `first`.
template <int Dim>
void TangledMesh<Dim>::loadTarget(Index first, int lanes, Packet* weight, Packet& det) const
{
  const SimplexMesh& mesh = this->Simplices;
  if (mesh.uniform())
  {
    for (int e = 0; e < Edges; ++e)
    {
      weight[e] = broadcast(mesh.target(0).edge[e]);
    }
    det = broadcast(mesh.target(0).det);
    return;
  }
  for (int l = 0; l < PacketWidth; ++l)
  {
    const TargetSimplex& t = mesh.target(static_cast<std::int32_t>(first) + std::min(l, lanes - 1));
    for (int e = 0; e < Edges; ++e)
    {
      weight[e][l] = t.edge[e];
    }
    det[l] = t.det;
  }
}

/// Adds the simplices from `begin` to `end` to the state.
template <int Dim>
void TangledMesh<Dim>::examine(const double* x, Index begin, Index end, MeshState& state) const
{
  for (Index i = begin; i < end; i += PacketWidth)
  {
    const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - i));
    const std::int32_t* ids = this->Simplices.corners() + (Dim + 1) * i;
    std::int32_t filled[(Dim + 1) * PacketWidth];
    if (lanes < PacketWidth)
    {
      // The last lanes repeat a simplex; they are not used.
      for (int l = 0; l < PacketWidth; ++l)
      {
        std::copy_n(ids + (Dim + 1) * std::min(l, lanes - 1), Dim + 1, filled + (Dim + 1) * l);
      }
      ids = filled;
    }
    Packet p[Dim + 1][3];
    for (int k = 0; k <= Dim; ++k)
    {
      loadVertices(x, ids + k, Dim + 1, p[k]);
    }
    Packet N = {}, det;
    Packet weight[Edges];
    this->loadTarget(i, lanes, weight, det);
    for (int e = 0; e < Edges; ++e)
    {
      const int* ends = Dim == 3 ? Edges3[e] : Edges2[e % 3];
      for (int c = 0; c < Dim; ++c)
      {
        const Packet d = p[ends[1]][c] - p[ends[0]][c];
        N += weight[e] * d * d;
      }
    }
    Packet a[3], b[3];
    for (int c = 0; c < Dim; ++c)
    {
      a[c] = p[1][c] - p[0][c];
      b[c] = p[2][c] - p[0][c];
    }
    Packet D = a[0] * b[1] - a[1] * b[0];
    if constexpr (Dim == 3)
    {
      Packet d[3];
      for (int c = 0; c < 3; ++c)
      {
        d[c] = p[3][c] - p[0][c];
      }
      D = D * d[2] + (a[1] * b[2] - a[2] * b[1]) * d[0] + (a[2] * b[0] - a[0] * b[2]) * d[1];
    }
    D *= det;
    // Most packets are valid; their lanes need no check.
    const Mask invalid = ~(D > this->Margin * sizeOf<Dim>(N));
    if (!any(invalid) && !any(D < state.minDeterminant))
    {
      continue;
    }
    for (int l = 0; l < lanes; ++l)
    {
      const std::int32_t s = static_cast<std::int32_t>(i + l);
      if (this->Infeasible[s])
      {
        if (invalid[l])
        {
          state.infeasible.push_back(s);
        }
        continue;
      }
      state.minDeterminant = std::min(state.minDeterminant, D[l]);
      if (invalid[l])
      {
        state.invertedVolume -= std::min(0.0, D[l]);
        state.simplices.push_back(s);
      }
    }
  }
}

template <int Dim>
MeshState TangledMesh<Dim>::examine(const double* x) const
{
  const Index n = this->Simplices.simplices();
  MeshState state;
  state.minDeterminant = std::numeric_limits<double>::infinity();
  std::vector<MeshState> chunks(numberOfChunks(n), state);
  forEachChunk(n, this->Threads,
    [&](Index chunk, Index begin, Index end) { this->examine(x, begin, end, chunks[chunk]); });
  for (const MeshState& chunk : chunks)
  {
    state.minDeterminant = std::min(state.minDeterminant, chunk.minDeterminant);
    state.invertedVolume += chunk.invertedVolume;
    state.simplices.insert(state.simplices.end(), chunk.simplices.begin(), chunk.simplices.end());
    state.infeasible.insert(
      state.infeasible.end(), chunk.infeasible.begin(), chunk.infeasible.end());
  }
  state.invalid = static_cast<Index>(state.simplices.size());
  return state;
}

//------------------------------------------------------------------------------
/// The eps for which the smallest determinant of a patch is regularized to a fraction of the mean
/// determinant.
template <int Dim>
double TangledMesh<Dim>::regularization(const PatchState& state) const
{
  constexpr double target = 0.05;
  const double mu = target * state.meanDeterminant;
  return 2.0 * std::sqrt(std::max(0.0, mu * (mu - state.minDeterminant)));
}

template <int Dim>
bool TangledMesh<Dim>::relax(
  double* x, std::int32_t v, int steps, bool tryCenter, Patch<Dim>& patch, bool mayInvert) const
{
  this->gather(x, v, patch);
  std::array<double, Dim> d{};
  PatchState state = this->examine(patch, d.data());
  constexpr double beforeInversion = 0.9; // fraction of the distance to inversion
  constexpr int halvings = 12;
  bool moved = false;
  for (int step = 0; step < steps; ++step)
  {
    RegularizedShapeEnergy<Dim> energy;
    if (state.invalid > 0)
    {
      energy.eps = this->regularization(state);
      if (!(energy.eps > 0))
      {
        break; // collapsed to a point: no direction is better
      }
    }
    // A Newton step of the regularized energy.
    const PatchSum<Dim> sum = sumOver<Dim>(patch, d.data(), energy);
    double s[Dim], slope = 0;
    newtonDirection<Dim>(sum, s);
    for (int c = 0; c < Dim; ++c)
    {
      slope += s[c] * sum.g[c];
    }
    if (!(slope < 0) || !std::isfinite(slope))
    {
      break;
    }
    // Halve the step until it reduces the energy without making more simplices invalid.
    double t = 1.0;
    if (state.invalid == 0)
    {
      t = std::min(t, beforeInversion * stepToInversion<Dim>(patch, d.data(), s));
    }
    bool accepted = false;
    for (int trial = 0; trial < halvings && !accepted; ++trial, t *= 0.5)
    {
      std::array<double, Dim> to = d;
      for (int c = 0; c < Dim; ++c)
      {
        to[c] += t * s[c];
      }
      if (valueOver<Dim>(patch, to.data(), energy) <= sum.f + ArmijoConstant * t * slope)
      {
        const PatchState next = this->examine(patch, to.data());
        if (next.invalid <= state.invalid || (mayInvert && state.invalid > 0))
        {
          d = to;
          state = next;
          accepted = moved = true;
        }
      }
    }
    if (!accepted || (state.invalid == 0 && step > 0))
    {
      break;
    }
  }
  // If descent does not help, try the position farthest from all planes.
  if (state.invalid > 0 && tryCenter)
  {
    const std::array<double, Dim> center = this->patchCenter(patch);
    if (this->examine(patch, center.data()).invalid < state.invalid)
    {
      d = center;
      moved = true;
    }
  }
  if (moved)
  {
    double* p = x + VertexStride * static_cast<std::size_t>(v);
    for (int c = 0; c < Dim; ++c)
    {
      p[c] += d[c];
    }
  }
  return moved;
}

//------------------------------------------------------------------------------
/// The displacement to the Chebyshev center of the positions at which all simplices of the patch
/// are valid, or to the position of the smallest violation; 0 if it is unbounded.
template <int Dim>
std::array<double, Dim> TangledMesh<Dim>::patchCenter(const Patch<Dim>& patch) const
{
  std::vector<HalfSpace<Dim>> planes;
  double reach = 0;
  for (int i = 0; i < patch.count; ++i)
  {
    const PatchPacket<Dim>& p = patch.packets[i];
    for (int l = 0; l < PacketWidth; ++l)
    {
      if (!(p.weight[l] > 0))
      {
        continue;
      }
      // D = D0 - n . d > 0, with a normal of length 1.
      HalfSpace<Dim> plane;
      double length = 0;
      for (int c = 0; c < Dim; ++c)
      {
        plane.a[c] = p.n[c][l];
        length += plane.a[c] * plane.a[c];
      }
      length = std::sqrt(length);
      reach = std::max(reach, std::sqrt(std::abs(p.N0[l])));
      if (length > 0)
      {
        for (double& a : plane.a)
        {
          a /= length;
        }
        plane.b = p.D0[l] / length;
        planes.push_back(plane);
      }
    }
  }
  std::array<double, Dim> center{};
  if (!planes.empty() && reach > 0)
  {
    chebyshevCenter<Dim>(planes, 2.0 * reach, center);
  }
  return center;
}

template class TangledMesh<2>;
template class TangledMesh<3>;
}
