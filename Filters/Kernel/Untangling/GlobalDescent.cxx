// SPDX-License-Identifier: BSD-3-Clause
#include "GlobalDescent.h"

#include "tautline/Core/LineSearch.h"

namespace tautline
{
namespace
{
/// Factors a Hessian block, shifted until it is positive definite. Not inlined: the norm determines
/// the shift and must be rounded identically in all calls.
template <int Dim>
__attribute__((noinline)) void factorBlock(const double (&H)[Dim][Dim], double* L)
{
  using Block = SmallCholesky<Dim, CholeskyDiagonal::InverseRoot>;
  double square = 0;
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      square += H[r][c] * H[r][c];
    }
  }
  constexpr double smallPivot = 1e-3, firstShift = 0.1, growth = 3.0;
  const double norm = std::sqrt(square);
  if (!(norm > 0) || !std::isfinite(norm))
  {
    // No direction for this vertex: it does not move.
    std::fill_n(L, Block::Entries, 0.0);
    return;
  }
  double shift = 0.0;
  while (!Block::factor(H, shift, smallPivot * norm, L))
  {
    shift = shift > 0 ? growth * shift : firstShift * norm;
  }
}
}

//------------------------------------------------------------------------------
template <int Dim>
GlobalDescent<Dim>::GlobalDescent(const TangledMesh<Dim>& tangled)
  : Tangled(tangled)
  , Mesh(tangled.mesh())
  , Algebra(static_cast<std::size_t>(VertexStride) * tangled.mesh().freeVertices(),
      tangled.threads(), LaneOrder::Halves)
  , Memory(this->Algebra)
  , Gradient(this->Algebra.size())
  , Direction(this->Algebra.size())
  , Blocks(static_cast<std::size_t>(Block::Entries) * tangled.mesh().freeVertices())
  , Next(tangled.mesh().coordinates(),
      tangled.mesh().coordinates() +
        static_cast<std::size_t>(VertexStride) * tangled.mesh().vertices())
{
}

template <int Dim>
void GlobalDescent<Dim>::start(const double* x, double eps)
{
  this->Energy.eps = eps;
  this->Memory.clear();
  this->Value = this->evaluate(x);
}

//------------------------------------------------------------------------------
/// Adds the energy of the simplices of a patch whose lowest-numbered free vertex is v, so that each
/// simplex of the mesh counts once.
template <int Dim>
void GlobalDescent<Dim>::addEnergy(std::int32_t v, Patch<Dim>& patch, double& energy) const
{
  const std::int32_t begin = this->Mesh.patchStart(v);
  const std::int32_t count = this->Mesh.patchStart(v + 1) - begin;
  for (int k = 0; k < patch.count; ++k)
  {
    PatchPacket<Dim>& p = patch.packets[k];
    for (int l = 0; l < std::min(PacketWidth, count - k * PacketWidth); ++l)
    {
      const std::int32_t* other =
        this->Mesh.patchVertices() + static_cast<std::size_t>(Dim) * (begin + k * PacketWidth + l);
      bool first = true;
      for (int c = 0; c < Dim; ++c)
      {
        first &= v < other[c];
      }
      p.weight[l] = first ? p.weight[l] : 0.0;
    }
    energy += sumOf(select(p.weight > 0.0, this->Energy.value(p.N0, p.D0), Packet{}));
  }
}

/// Returns the energy at x; sets the gradient and the factors of the Hessian blocks.
template <int Dim>
double GlobalDescent<Dim>::evaluate(const double* x)
{
  const Index free = this->Mesh.freeVertices();
  constexpr Index Chunk = 512;
  const Index chunks = (free + Chunk - 1) / Chunk;
  std::vector<double> energies(chunks, 0.0);
  const double zero[Dim] = {};
  runChunks(chunks, this->Tangled.threads(),
    [&](Index chunk)
    {
      Patch<Dim> patch;
      double energy = 0;
      for (Index i = chunk * Chunk; i < std::min(free, (chunk + 1) * Chunk); ++i)
      {
        const std::int32_t v = static_cast<std::int32_t>(i);
        this->Tangled.gather(x, v, patch);
        const PatchSum<Dim> sum = sumOver<Dim>(patch, zero, this->Energy);
        for (int c = 0; c < Dim; ++c)
        {
          this->Gradient[VertexStride * i + c] = sum.g[c];
        }
        factorBlock(sum.H, &this->Blocks[Block::Entries * i]);
        this->addEnergy(v, patch, energy);
      }
      energies[chunk] = energy;
    });
  return std::accumulate(energies.begin(), energies.end(), 0.0);
}

/// Applies the inverses of the Hessian blocks.
template <int Dim>
void GlobalDescent<Dim>::precondition(std::vector<double>& q) const
{
  forEachChunk(this->Mesh.freeVertices(), this->Tangled.threads(),
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        Block::solve(&this->Blocks[Block::Entries * v], &q[VertexStride * v]);
      }
    });
}

//------------------------------------------------------------------------------
template <int Dim>
bool GlobalDescent<Dim>::step(double* x)
{
  constexpr int halvings = 20;
  for (;;)
  {
    // The L-BFGS direction with the Hessian blocks as preconditioner.
    const double slope = this->Memory.direction(this->Gradient, this->Direction,
      [this](std::vector<double>& q)
      {
        this->precondition(q);
        return 1.0;
      });
    this->Before = this->Gradient;
    // Halve the step until it reduces the energy sufficiently.
    double t = 1.0;
    const bool descent = slope < 0 && std::isfinite(slope);
    for (int trial = 0; descent && trial < halvings; ++trial, t *= 0.5)
    {
      this->Algebra.addScaled(x, t, this->Direction.data(), this->Next.data());
      const double next = this->evaluate(this->Next.data());
      if (next <= this->Value + ArmijoConstant * t * slope)
      {
        std::copy_n(this->Next.data(), this->Algebra.size(), x);
        this->Value = next;
        this->Memory.add(t, this->Direction.data(), this->Before.data(), this->Gradient.data());
        return true;
      }
    }
    // Return to the start of the step and retry without the memory.
    this->Value = this->evaluate(x);
    if (this->Memory.empty())
    {
      return false;
    }
    this->Memory.clear();
  }
}

template class GlobalDescent<2>;
template class GlobalDescent<3>;
}
