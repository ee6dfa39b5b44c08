/**
 * @file GlobalDescent.h
 * @brief Limited-memory BFGS on all free vertices of a tangled mesh, preconditioned by the Hessian
 * blocks of the vertices, and the harmonic map of the mesh. Internal: not installed.
 */
#ifndef tautline_GlobalDescent_h
#define tautline_GlobalDescent_h

#include "TangledMesh.h"

#include <cstring>

namespace tautline
{
/// Vectors of VertexStride doubles per free vertex, the last of each zero.
using VertexVector = std::vector<double>;

/// a . b, summed chunk by chunk.
inline double dotOf(const VertexVector& a, const VertexVector& b, int threads)
{
  const Index n = static_cast<Index>(a.size());
  std::vector<double> parts(numberOfChunks(n), 0.0);
  forEachChunk(n, threads,
    [&](Index chunk, Index begin, Index end)
    {
      Packet sum = {};
      Index i = begin;
      for (; i + PacketWidth <= end; i += PacketWidth)
      {
        Packet p, q;
        std::memcpy(&p, &a[i], sizeof(p));
        std::memcpy(&q, &b[i], sizeof(q));
        sum += p * q;
      }
      double total = sumOf(sum);
      for (; i < end; ++i)
      {
        total += a[i] * b[i];
      }
      parts[chunk] = total;
    });
  double total = 0;
  for (double part : parts)
  {
    total += part;
  }
  return total;
}

/// y = x + a z, where y may be x.
inline void addScaled(const double* x, double a, const VertexVector& z, double* y, int threads)
{
  forEachChunk(static_cast<Index>(z.size()), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        y[i] = x[i] + a * z[i];
      }
    });
}

/// The regularised shape energy of a mesh and what was found on the way.
struct EnergyState
{
  double energy = 0;
  Index bad = 0; ///< simplices that are not valid
};

/// The Cholesky factor of a block, shifted until it is positive definite; the diagonal inverted.
template <int Dim>
void factor(const double (&H)[Dim][Dim], double* L)
{
  double square = 0;
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      square += H[r][c] * H[r][c];
    }
  }
  constexpr double smallPivot = 1e-3, firstShift = 0.1;
  const double norm = std::sqrt(square);
  if (!(norm > 0) || !std::isfinite(norm))
  {
    // Nothing is known of this vertex: it stays.
    std::fill_n(L, Dim * (Dim + 1) / 2, 0.0);
    return;
  }
  for (double shift = 0.0;; shift = shift > 0 ? 3.0 * shift : firstShift * norm)
  {
    bool definite = true;
    double* row = L;
    for (int r = 0; r < Dim && definite; row += ++r)
    {
      const double* column = L;
      for (int c = 0; c <= r; column += ++c)
      {
        double x = H[r][c] + (r == c ? shift : 0.0);
        for (int k = 0; k < c; ++k)
        {
          x -= row[k] * column[k];
        }
        if (r == c)
        {
          definite = x > smallPivot * norm;
          row[c] = 1.0 / std::sqrt(x);
        }
        else
        {
          row[c] = x * column[c];
        }
      }
    }
    if (definite)
    {
      return;
    }
  }
}

template <int Dim>
class GlobalDescent
{
public:
  explicit GlobalDescent(const TangledMesh<Dim>& tangled)
    : Tangled(tangled)
    , Mesh(tangled.mesh())
    , Size(static_cast<std::size_t>(VertexStride) * tangled.mesh().freeVertices())
    , Gradient(Size)
    , Direction(Size)
    , Blocks(static_cast<std::size_t>(Triangle) * tangled.mesh().freeVertices())
    , Next(tangled.mesh().coordinates(),
        tangled.mesh().coordinates() +
          static_cast<std::size_t>(VertexStride) * tangled.mesh().vertices())
  {
  }

  /// Forgets the past steps and evaluates the energy with this eps.
  EnergyState start(const double* x, double eps)
  {
    this->Energy.eps = eps;
    this->Used = 0;
    this->State = this->evaluate(x, true);
    return this->State;
  }

  /// One step from the coordinates x, which change. False if no step lowers the energy.
  bool step(double* x);

  const EnergyState& state() const { return this->State; }

private:
  static constexpr int Memory = 8;
  static constexpr int Triangle = Dim * (Dim + 1) / 2;

  EnergyState evaluate(const double* x, bool derivatives);
  void precondition(VertexVector& q) const;

  const TangledMesh<Dim>& Tangled;
  SimplexMesh& Mesh;
  std::size_t Size;
  RegularizedShapeEnergy<Dim> Energy;
  EnergyState State;
  VertexVector Gradient, Direction;
  VertexVector Blocks; ///< Cholesky factors of the Hessian blocks, the diagonal inverted
  VertexVector Next;
  std::vector<VertexVector> Steps, Changes;
  std::vector<double> Curvatures;
  int Used = 0, Last = 0;
};

//------------------------------------------------------------------------------
template <int Dim>
EnergyState GlobalDescent<Dim>::evaluate(const double* x, bool derivatives)
{
  const Index free = this->Mesh.freeVertices();
  constexpr Index Chunk = 512;
  const Index chunks = (free + Chunk - 1) / Chunk;
  struct Part
  {
    double energy = 0, bad = 0;
  };
  std::vector<Part> parts(chunks);
  const double zero[Dim] = {};
#pragma omp parallel num_threads(resolveThreads(this->Tangled.threads())) if (chunks > 1)
  {
    Patch<Dim> patch;
#pragma omp for schedule(dynamic)
    for (Index chunk = 0; chunk < chunks; ++chunk)
    {
      Part part;
      for (Index i = chunk * Chunk; i < std::min(free, (chunk + 1) * Chunk); ++i)
      {
        const std::int32_t v = static_cast<std::int32_t>(i);
        this->Tangled.gather(x, v, patch);
        if (derivatives)
        {
          const PatchSum<Dim> sum = sumOver<Dim>(patch, zero, this->Energy);
          for (int c = 0; c < Dim; ++c)
          {
            this->Gradient[VertexStride * i + c] = sum.g[c];
          }
          factor(sum.H, &this->Blocks[Triangle * i]);
        }
        // Each simplex counts once: with the free vertex of the lowest number.
        const std::int32_t begin = this->Mesh.patchStart(v);
        const std::int32_t count = this->Mesh.patchStart(v + 1) - begin;
        for (int k = 0; k < patch.count; ++k)
        {
          PatchPacket<Dim>& p = patch.packets[k];
          for (int l = 0; l < std::min(PacketWidth, count - k * PacketWidth); ++l)
          {
            const std::int32_t* other = this->Mesh.patchVertices() +
              static_cast<std::size_t>(Dim) * (begin + k * PacketWidth + l);
            bool first = true;
            for (int c = 0; c < Dim; ++c)
            {
              first &= v < other[c];
            }
            p.weight[l] = first ? p.weight[l] : 0.0;
          }
          part.energy += sumOf(select(p.weight > 0.0, this->Energy.value(p.N0, p.D0), Packet{}));
          const Mask counts = p.weight > 0.0;
          part.bad += sumOf(select(counts & ~(p.D0 > this->Tangled.margin() * sizeOf<Dim>(p.N0)),
            broadcast(1.0), Packet{}));
        }
      }
      parts[chunk] = part;
    }
  }
  EnergyState state;
  for (const Part& part : parts)
  {
    state.energy += part.energy;
    state.bad += static_cast<Index>(part.bad);
  }
  return state;
}

template <int Dim>
void GlobalDescent<Dim>::precondition(VertexVector& q) const
{
  forEachChunk(this->Mesh.freeVertices(), this->Tangled.threads(),
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        const double* L = &this->Blocks[Triangle * v];
        double* s = &q[VertexStride * v];
        const double* row = L;
        for (int r = 0; r < Dim; row += ++r)
        {
          for (int k = 0; k < r; ++k)
          {
            s[r] -= row[k] * s[k];
          }
          s[r] *= row[r];
        }
        for (int r = Dim - 1; r >= 0; --r)
        {
          row = L + r * (r + 1) / 2;
          s[r] *= row[r];
          for (int k = 0; k < r; ++k)
          {
            s[k] -= row[k] * s[r];
          }
        }
      }
    });
}

//------------------------------------------------------------------------------
template <int Dim>
bool GlobalDescent<Dim>::step(double* x)
{
  const int threads = this->Tangled.threads();
  constexpr double armijo = 1e-4;
  for (;;)
  {
    // The two loops of L-BFGS.
    VertexVector& q = this->Direction;
    q = this->Gradient;
    double alpha[Memory];
    for (int k = 0; k < this->Used; ++k)
    {
      const int i = (this->Last + Memory - k) % Memory;
      alpha[i] = dotOf(this->Steps[i], q, threads) / this->Curvatures[i];
      addScaled(q.data(), -alpha[i], this->Changes[i], q.data(), threads);
    }
    this->precondition(q);
    for (int k = this->Used - 1; k >= 0; --k)
    {
      const int i = (this->Last + Memory - k) % Memory;
      const double beta = dotOf(this->Changes[i], q, threads) / this->Curvatures[i];
      addScaled(q.data(), alpha[i] - beta, this->Steps[i], q.data(), threads);
    }
    const double slope = -dotOf(this->Gradient, q, threads);
    const EnergyState before = this->State;
    const VertexVector gradient = this->Gradient;
    if (slope < 0 && std::isfinite(slope))
    {
      constexpr int halvings = 20;
      double t = 1.0;
      for (int trial = 0; trial < halvings; ++trial, t *= 0.5)
      {
        addScaled(x, -t, q, this->Next.data(), threads);
        const EnergyState next = this->evaluate(this->Next.data(), true);
        if (next.energy <= before.energy + armijo * t * slope)
        {
          std::copy_n(this->Next.data(), this->Size, x);
          this->State = next;
          // Remember the step if the curvature along it is positive.
          const int place = (this->Last + 1) % Memory;
          if (this->Steps.size() <= static_cast<std::size_t>(place))
          {
            this->Steps.emplace_back(this->Size);
            this->Changes.emplace_back(this->Size);
            this->Curvatures.push_back(0.0);
          }
          const int at = std::min<int>(place, static_cast<int>(this->Steps.size()) - 1);
          VertexVector& s = this->Steps[at];
          VertexVector& y = this->Changes[at];
          addScaled(this->Gradient.data(), -1.0, gradient, y.data(), threads);
          for (std::size_t i = 0; i < this->Size; ++i)
          {
            s[i] = -t * q[i];
          }
          const double curvature = dotOf(s, y, threads);
          constexpr double enough = 1e-10;
          if (curvature >
            enough * std::sqrt(dotOf(s, s, threads)) * std::sqrt(dotOf(y, y, threads)))
          {
            this->Curvatures[at] = curvature;
            this->Last = at;
            this->Used = std::min(Memory, this->Used + 1);
          }
          else
          {
            this->Used = std::min(Memory - 1, this->Used); // the oldest step is overwritten
          }
          return true;
        }
      }
    }
    // Back to where the step began, and once more without the memory.
    this->State = this->evaluate(x, true);
    if (this->Used == 0)
    {
      return false;
    }
    this->Used = 0;
  }
}

//------------------------------------------------------------------------------
/**
 * @brief Puts every free vertex at the mean of its neighbours, by conjugate gradients. In 2D and
 * with a convex boundary no element is inverted then (W. T. Tutte, 1963).
 * @return false if there is nothing that holds the mesh (no fixed vertices)
 */
template <int Dim>
bool harmonicMap(const SimplexMesh& mesh, double* x, double tolerance, int iterations, int threads)
{
  const std::int32_t free = mesh.freeVertices();
  // Neighbours of each free vertex, once each.
  std::vector<std::int32_t> starts(free + 1, 0), neighbours;
  neighbours.reserve(static_cast<std::size_t>(free) * (Dim == 3 ? 15 : 7));
  bool held = false;
  for (std::int32_t v = 0; v < free; ++v)
  {
    const std::size_t begin = neighbours.size();
    neighbours.insert(neighbours.end(),
      mesh.patchVertices() + static_cast<std::size_t>(Dim) * mesh.patchStart(v),
      mesh.patchVertices() + static_cast<std::size_t>(Dim) * mesh.patchStart(v + 1));
    std::sort(neighbours.begin() + begin, neighbours.end());
    neighbours.erase(std::unique(neighbours.begin() + begin, neighbours.end()), neighbours.end());
    held = held || (neighbours.size() > begin && neighbours.back() >= free);
    starts[v + 1] = static_cast<std::int32_t>(neighbours.size());
  }
  if (!held)
  {
    return false;
  }
  const std::size_t size = static_cast<std::size_t>(VertexStride) * free;
  // r = -L y for the free part of y and the fixed vertices in `fixed` (or none).
  const auto apply = [&](const double* y, bool fixed, double sign, VertexVector& r)
  {
    forEachChunk(free, threads,
      [&](Index, Index begin, Index end)
      {
        for (Index v = begin; v < end; ++v)
        {
          double sum[VertexStride] = {};
          for (std::int32_t i = starts[v]; i < starts[v + 1]; ++i)
          {
            const std::int32_t w = neighbours[i];
            if (w < free || fixed)
            {
              for (int c = 0; c < VertexStride; ++c)
              {
                sum[c] += y[VertexStride * static_cast<std::size_t>(w) + c];
              }
            }
          }
          const double degree = starts[v + 1] - starts[v];
          for (int c = 0; c < VertexStride; ++c)
          {
            r[VertexStride * v + c] = sign * (degree * y[VertexStride * v + c] - sum[c]);
          }
        }
      });
  };
  VertexVector r(size), z(size), p(size), Ap(size);
  const auto scale = [&]
  {
    for (std::int32_t v = 0; v < free; ++v)
    {
      const double over = 1.0 / std::max(1, starts[v + 1] - starts[v]);
      for (int c = 0; c < VertexStride; ++c)
      {
        z[VertexStride * static_cast<std::size_t>(v) + c] =
          over * r[VertexStride * static_cast<std::size_t>(v) + c];
      }
    }
  };
  apply(x, true, -1.0, r);
  scale();
  p = z;
  double rz = dotOf(r, z, threads);
  const double first = rz;
  for (int iteration = 0; iteration < iterations && rz > tolerance * tolerance * first; ++iteration)
  {
    apply(p.data(), false, 1.0, Ap);
    const double curvature = dotOf(p, Ap, threads);
    if (!(curvature > 0))
    {
      break;
    }
    const double alpha = rz / curvature;
    addScaled(x, alpha, p, x, threads);
    addScaled(r.data(), -alpha, Ap, r.data(), threads);
    scale();
    const double next = dotOf(r, z, threads);
    addScaled(z.data(), next / rz, p, p.data(), threads);
    rz = next;
  }
  return true;
}
}
#endif
