/**
 * @file TangledMesh.h
 * @brief A SimplexMesh with the simplices that are not valid, and the moves of one vertex that make
 * more of them valid. Internal: not installed.
 */
#ifndef tautline_TangledMesh_h
#define tautline_TangledMesh_h

#include "tautline/Patches/Energies.h"
#include "LinearProgram.h"
#include "tautline/Core/Parallel.h"

namespace tautline
{
/// N^(n/2), the volume D would have were the simplex of ideal shape, up to a factor.
template <int Dim>
inline Packet sizeOf(Packet N)
{
  return Dim == 2 ? N : N * sqrt(N);
}

/// What is wrong in a patch.
struct PatchState
{
  int bad = 0;      ///< simplices that are not valid
  double least = 0; ///< D
  double size = 0;  ///< mean of |D|
};

/// What is wrong in the mesh.
struct MeshState
{
  Index bad = 0;                        ///< simplices that are not valid, without the infeasible
  double least = 0;                     ///< D among the simplices that are not infeasible
  double depth = 0;                     ///< the sum of -D over the inverted ones
  std::vector<std::int32_t> simplices;  ///< the bad ones, in increasing order
  std::vector<std::int32_t> infeasible; ///< bad ones among the infeasible, in increasing order
};

template <int Dim>
class TangledMesh
{
public:
  TangledMesh(SimplexMesh& mesh, int threads)
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

  SimplexMesh& mesh() const { return this->Simplices; }
  int threads() const { return this->Threads; }

  /// A simplex is valid if D > margin() * N^(n/2).
  double margin() const { return this->Margin; }
  void setMargin(double margin) { this->Margin = margin; }

  /// Simplices that cannot become valid take no part; see exclude().
  bool infeasible(std::int32_t simplex) const { return this->Infeasible[simplex] != 0; }
  void exclude(const std::vector<std::int32_t>& simplices)
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
    this->HopelessEntry.assign(this->Simplices.patchStart(free), 0);
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
          this->HopelessEntry[next[v]++] = this->Infeasible[s];
        }
      }
    }
  }

  MeshState examine(const double* x) const;

  void gather(const double* x, std::int32_t v, Patch<Dim>& patch) const
  {
    gatherPatch<Dim>(this->Simplices, x, v, nullptr, patch);
    if (!this->HopelessEntry.empty())
    {
      const std::int32_t begin = this->Simplices.patchStart(v),
                         end = this->Simplices.patchStart(v + 1);
      for (std::int32_t i = begin; i < end; ++i)
      {
        if (this->HopelessEntry[i])
        {
          patch.packets[(i - begin) / PacketWidth].weight[(i - begin) % PacketWidth] = 0.0;
        }
      }
    }
  }

  PatchState examine(const Patch<Dim>& patch, const double* d) const
  {
    Packet bad = {}, size = {}, count = {};
    Packet least = broadcast(std::numeric_limits<double>::infinity());
    for (int i = 0; i < patch.count; ++i)
    {
      const PatchPacket<Dim>& p = patch.packets[i];
      Packet N, D;
      invariants(p, d, N, D);
      const Mask counts = p.weight > 0.0;
      const Mask isBad = ~(D > this->Margin * sizeOf<Dim>(N)) & counts;
      bad += select(isBad, broadcast(1.0), Packet{});
      least = select((D < least) & counts, D, least);
      size += p.weight * abs(D);
      count += p.weight;
    }
    PatchState state;
    state.bad = static_cast<int>(sumOf(bad));
    state.least = leastOf(least);
    state.size = sumOf(size) / std::max(1.0, sumOf(count));
    return state;
  }

  /**
   * @brief Moves v to lower the regularised shape energy of its patch, a few Newton steps; never to
   * more bad simplices. The regularisation is chosen for the patch, anew in each step.
   * @param tryWidest where simplices stay bad, try the place farthest from all of the patch's
   * planes
   * @return whether it moved
   */
  bool relax(double* x, std::int32_t v, int steps, bool tryWidest, Patch<Dim>& patch) const;

  /// The farthest place from the planes of the patch within reach, and how far; negative if none is
  /// valid.
  double chebyshevCenter(const Patch<Dim>& patch, std::array<double, Dim>& place) const;

  /// Calls visit(v, patch) for all free vertices with a nonzero flag (all if flags is null), in an
  /// order and concurrency that make the result independent of the number of threads; visit may
  /// move v.
  template <class Visit>
  void sweep(const unsigned char* flags, const Visit& visit) const
  {
    const VertexBlocks& blocks = this->Simplices.blocks();
    const std::int32_t free = this->Simplices.freeVertices();
    for (std::size_t colour = 0; colour + 1 < blocks.colourStarts.size(); ++colour)
    {
      const std::int32_t begin = blocks.colourStarts[colour], end = blocks.colourStarts[colour + 1];
#pragma omp parallel num_threads(resolveThreads(this->Threads)) if (end - begin > 1)
      {
        Patch<Dim> patch;
#pragma omp for schedule(dynamic)
        for (std::int32_t b = begin; b < end; ++b)
        {
          const std::int32_t first = blocks.byColour[b] * blocks.size;
          for (std::int32_t v = first; v < std::min(free, first + blocks.size); ++v)
          {
            if (!flags || flags[v])
            {
              visit(v, patch);
            }
          }
        }
      }
    }
  }

private:
  /// The edge's places in TargetSimplex::edge.
  static constexpr int Edges3[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 },
    { 2, 3 } };
  static constexpr int Edges2[3][2] = { { 0, 1 }, { 0, 2 }, { 1, 2 } };
  /// With fewer simplices, threads wait for each other more than they work.
  static constexpr std::int32_t WorthThreads = 32768;

  SimplexMesh& Simplices;
  int Threads;
  double Margin = 1e-12;
  std::vector<char> Infeasible;    ///< per simplex
  std::vector<char> HopelessEntry; ///< per entry of the patches; empty if none
};

//------------------------------------------------------------------------------
template <int Dim>
MeshState TangledMesh<Dim>::examine(const double* x) const
{
  const SimplexMesh& mesh = this->Simplices;
  const Index n = mesh.simplices();
  const Index chunks = numberOfChunks(n);
  std::vector<MeshState> parts(chunks);
  forEachChunk(n, this->Threads,
    [&](Index chunk, Index begin, Index end)
    {
      MeshState& part = parts[chunk];
      part.least = std::numeric_limits<double>::infinity();
      for (Index i = begin; i < end; i += PacketWidth)
      {
        const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - i));
        const std::int32_t* ids = mesh.corners() + (Dim + 1) * i;
        std::int32_t filled[(Dim + 1) * PacketWidth];
        if (lanes < PacketWidth)
        {
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
        constexpr int edges = Dim * (Dim + 1) / 2;
        Packet weight[edges];
        if (mesh.uniform())
        {
          for (int e = 0; e < edges; ++e)
          {
            weight[e] = broadcast(mesh.target(0).edge[e]);
          }
          det = broadcast(mesh.target(0).det);
        }
        else
        {
          for (int l = 0; l < PacketWidth; ++l)
          {
            const TargetSimplex& t =
              mesh.target(static_cast<std::int32_t>(i) + std::min(l, lanes - 1));
            for (int e = 0; e < edges; ++e)
            {
              weight[e][l] = t.edge[e];
            }
            det[l] = t.det;
          }
        }
        for (int e = 0; e < edges; ++e)
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
        const Mask bad = ~(D > this->Margin * sizeOf<Dim>(N));
        if (any(bad) || any(D < part.least))
        {
          for (int l = 0; l < lanes; ++l)
          {
            if (this->Infeasible[i + l])
            {
              if (bad[l])
              {
                part.infeasible.push_back(static_cast<std::int32_t>(i + l));
              }
              continue;
            }
            part.least = std::min(part.least, D[l]);
            if (bad[l])
            {
              part.depth -= std::min(0.0, D[l]);
              part.simplices.push_back(static_cast<std::int32_t>(i + l));
            }
          }
        }
      }
    });
  MeshState state;
  state.least = std::numeric_limits<double>::infinity();
  for (const MeshState& part : parts)
  {
    state.least = std::min(state.least, part.least);
    state.depth += part.depth;
    state.simplices.insert(state.simplices.end(), part.simplices.begin(), part.simplices.end());
    state.infeasible.insert(state.infeasible.end(), part.infeasible.begin(), part.infeasible.end());
  }
  state.bad = static_cast<Index>(state.simplices.size());
  return state;
}

//------------------------------------------------------------------------------
template <int Dim>
bool TangledMesh<Dim>::relax(
  double* x, std::int32_t v, int steps, bool tryWidest, Patch<Dim>& patch) const
{
  this->gather(x, v, patch);
  std::array<double, Dim> d{};
  PatchState state = this->examine(patch, d.data());
  constexpr double target = 0.05; // of the mean volume: where eps wants the least determinant
  constexpr double armijo = 1e-4, beforeInversion = 0.9;
  constexpr int halvings = 12;
  bool moved = false;
  for (int step = 0; step < steps; ++step)
  {
    RegularizedShapeEnergy<Dim> energy;
    if (state.bad > 0)
    {
      const double mu = target * state.size;
      energy.eps = 2.0 * std::sqrt(std::max(0.0, mu * (mu - state.least)));
      if (!(energy.eps > 0))
      {
        break; // collapsed to a point: no direction is better
      }
    }
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
    double t = 1.0;
    if (state.bad == 0)
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
      if (valueOver<Dim>(patch, to.data(), energy) <= sum.f + armijo * t * slope)
      {
        const PatchState next = this->examine(patch, to.data());
        if (next.bad <= state.bad)
        {
          d = to;
          state = next;
          accepted = moved = true;
        }
      }
    }
    if (!accepted || (state.bad == 0 && step > 0))
    {
      break;
    }
  }
  if (state.bad > 0 && tryWidest)
  {
    std::array<double, Dim> place;
    this->chebyshevCenter(patch, place);
    const PatchState there = this->examine(patch, place.data());
    if (there.bad < state.bad)
    {
      d = place;
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
template <int Dim>
double TangledMesh<Dim>::chebyshevCenter(
  const Patch<Dim>& patch, std::array<double, Dim>& place) const
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
  place.fill(0.0);
  if (planes.empty() || !(reach > 0))
  {
    return 0.0;
  }
  return widestPlace<Dim>(planes, 2.0 * reach, place);
}
}
#endif
