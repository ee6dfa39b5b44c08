// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TangledMesh.h
 * @brief A SimplexMesh with its invalid simplices, and the moves of single vertices that make more
 * simplices valid.
 * Internal: not installed.
 */
#ifndef tautline_TangledMesh_h
#define tautline_TangledMesh_h

#include "tautline/Core/Parallel.h"
#include "tautline/Patches/Patch.h"

namespace tautline
{
/// N^(n/2), the value that D would have, up to a factor, if the simplex had the ideal shape.
template <int Dim>
inline Packet sizeOf(Packet N)
{
  return Dim == 2 ? N : N * sqrt(N);
}

/// The validity of the simplices of a patch.
struct PatchState
{
  int invalid = 0;            ///< invalid simplices
  double minDeterminant = 0;  ///< the smallest D
  double meanDeterminant = 0; ///< mean of |D|
};

/// The validity of the simplices of a mesh. Infeasible simplices are ignored.
struct MeshState
{
  Index invalid = 0;         ///< invalid simplices, without the infeasible ones
  double minDeterminant = 0; ///< the smallest D among the simplices that are not infeasible
  double invertedVolume = 0; ///< the sum of -D over the inverted ones
  std::vector<std::int32_t> simplices;  ///< the invalid ones, in increasing order
  std::vector<std::int32_t> infeasible; ///< invalid infeasible ones, in increasing order
};

/// A mesh of simplices of dimension Dim, 2 or 3.
template <int Dim>
class TangledMesh
{
public:
  /**
   * @param mesh must outlive this object
   * @param threads as in Parallel.h; small meshes use one
   */
  TangledMesh(SimplexMesh& mesh, int threads);

  SimplexMesh& mesh() const { return this->Simplices; }
  int threads() const { return this->Threads; }

  /// A simplex is valid if D > margin() * N^(n/2). Default: 1e-12.
  double margin() const { return this->Margin; }
  void setMargin(double margin) { this->Margin = margin; }

  /// Simplices that cannot become valid are ignored; initially, those without a free vertex.
  bool infeasible(std::int32_t simplex) const { return this->Infeasible[simplex] != 0; }
  /// Marks more simplices as infeasible.
  void exclude(const std::vector<std::int32_t>& simplices);

  /// The validity at the coordinates x, VertexStride per vertex.
  MeshState examine(const double* x) const;
  /// The validity of a patch at the displacement d of its vertex.
  PatchState examine(const Patch<Dim>& patch, const double* d) const;

  /// Builds the patch of the free vertex v; the infeasible simplices have weight 0.
  void gather(const double* x, std::int32_t v, Patch<Dim>& patch) const;

  /**
   * @brief Moves v to reduce the regularized shape energy of its patch, by a few Newton steps,
   * without increasing the number of invalid simplices. The regularization is chosen for the patch
   * in each step.
   * @param tryCenter if simplices remain invalid, try the Chebyshev center of the patch
   * @param patch workspace
   * @param mayInvert whether more simplices of a patch with invalid ones may become invalid
   * @return whether v moved
   */
  bool relax(double* x, std::int32_t v, int steps, bool tryCenter, Patch<Dim>& patch,
    bool mayInvert = false) const;

  /// Calls visit(v, patch) for all free vertices with a nonzero flag (all if flags is null), in an
  /// order and concurrency that make the result independent of the number of threads; visit may
  /// move v.
  template <class Visit>
  void sweep(const unsigned char* flags, const Visit& visit) const
  {
    const VertexBlocks& blocks = this->Simplices.blocks();
    const std::int32_t free = this->Simplices.freeVertices();
    ScratchPool<Patch<Dim>> patches;
    for (std::size_t colour = 0; colour + 1 < blocks.colourStarts.size(); ++colour)
    {
      const std::int32_t begin = blocks.colourStarts[colour], end = blocks.colourStarts[colour + 1];
      parallelFor(end - begin, 1, this->Threads, patches,
        [&](Patch<Dim>& patch, Index i)
        {
          const std::int32_t first = blocks.byColour[begin + i] * blocks.size;
          for (std::int32_t v = first; v < std::min(free, first + blocks.size); ++v)
          {
            if (!flags || flags[v])
            {
              visit(v, patch);
            }
          }
        });
    }
  }

private:
  void examine(const double* x, Index begin, Index end, MeshState& state) const;
  void loadTarget(Index first, int lanes, Packet* weight, Packet& det) const;
  double regularization(const PatchState& state) const;
  std::array<double, Dim> patchCenter(const Patch<Dim>& patch) const;

  static constexpr int Edges = Dim * (Dim + 1) / 2;

  SimplexMesh& Simplices;
  int Threads;
  double Margin = 1e-12;
  std::vector<char> Infeasible;      ///< per simplex
  std::vector<char> InfeasibleEntry; ///< per entry of the patches; empty if none
};
}
#endif
