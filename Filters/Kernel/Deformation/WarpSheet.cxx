// SPDX-License-Identifier: BSD-3-Clause
#include "WarpSheet.h"

#include "tautline/Core/Interruption.h"

#include <Eigen/SparseCore>

namespace tautline
{
namespace
{
constexpr Index SheetComponents = 3;

/// The cells of a surface unfolded into one plane, each with separate points.
struct FlatCells
{
  explicit FlatCells(const Mesh& surface)
  {
    const MeshView& view = surface.view();
    for (const CellBlock& block : surface.blocks())
    {
      const CellTopology& t = topology(block.type);
      for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
      {
        pollInterruption(i);
        this->add(t, view, block.cell(i));
      }
    }
  }

  MeshView view() const
  {
    MeshView view;
    view.numberOfPoints = static_cast<Index>(this->points.size() / 3);
    view.points = this->points.data();
    view.numberOfCells = static_cast<Index>(this->types.size());
    view.cellTypes = this->types.data();
    view.offsets = this->offsets.data();
    view.connectivity = this->connectivity.data();
    return view;
  }

  std::vector<double> points;
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 }, connectivity;
  std::vector<Index> cells;                ///< of the surface
  std::vector<Index> origin;               ///< per point: the corresponding point of the surface
  std::vector<std::array<Vec3, 3>> frames; ///< per cell: two directions in its plane, the normal

private:
  void add(const CellTopology& t, const MeshView& view, Index cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    Vec3 p[MaxNodes], middle = { 0, 0, 0 };
    for (int k = 0; k < t.nodes; ++k)
    {
      p[k] = pointOf(view, node[k]);
      middle += (1.0 / t.nodes) * p[k];
    }
    Vec3 normal = vectorArea(t, p);
    normal = (1 / norm(normal)) * normal;
    Vec3 along = p[1] - p[0];
    along -= dot(along, normal) * normal;
    along = (1 / norm(along)) * along;
    const Vec3 across = cross(normal, along);
    for (int k = 0; k < t.nodes; ++k)
    {
      const Vec3 r = p[k] - middle;
      this->connectivity.push_back(static_cast<Index>(this->origin.size()));
      this->origin.push_back(node[k]);
      this->points.insert(this->points.end(), { dot(r, along), dot(r, across), 0.0 });
    }
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
    this->types.push_back(static_cast<unsigned char>(t.type));
    this->cells.push_back(cell);
    this->frames.push_back({ along, across, normal });
  }
};
}

//------------------------------------------------------------------------------
SparseMatrix sheetMatrix(
  const Mesh& surface, const ElasticOperator& pde, const AssemblyOptions& options)
{
  const FlatCells flat(surface);
  const Mesh mesh(flat.view(), options.threads);
  std::vector<double> stiffening, tensors;
  const double shear = 0.5 * pde.youngsModulus / (1 + pde.poissonRatio);
  for (const Index cell : flat.cells)
  {
    stiffening.push_back(pde.stiffening ? pde.stiffening[cell] : 1.0);
    const double modulus = shear * stiffening.back();
    tensors.insert(tensors.end(), { modulus, modulus, modulus, 0, 0, 0 });
  }
  ElasticOperator inPlane = pde;
  inPlane.stiffening = stiffening.data();
  DiffusionOperator acrossPlane;
  acrossPlane.tensors = tensors.data();
  const SparseMatrix plane = stiffnessMatrix(mesh, inPlane, options);
  const SparseMatrix normal = stiffnessMatrix(mesh, acrossPlane, options);

  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t cell = 0; cell < flat.cells.size(); ++cell)
  {
    pollInterruption(static_cast<Index>(cell));
    const std::array<Vec3, 3>& frame = flat.frames[cell];
    for (Index a = flat.offsets[cell]; a < flat.offsets[cell + 1]; ++a)
    {
      for (Index b = flat.offsets[cell]; b < flat.offsets[cell + 1]; ++b)
      {
        for (Index i = 0; i < SheetComponents; ++i)
        {
          for (Index j = 0; j < SheetComponents; ++j)
          {
            double sum = frame[2][i] * normal.at(a, b) * frame[2][j];
            for (Index k = 0; k < 4; ++k)
            {
              sum += frame[k / 2][i] * plane.at(2 * a + k / 2, 2 * b + k % 2) * frame[k % 2][j];
            }
            entries.emplace_back(static_cast<int>(SheetComponents * flat.origin[a] + i),
              static_cast<int>(SheetComponents * flat.origin[b] + j), sum);
          }
        }
      }
    }
  }
  const auto size = static_cast<int>(SheetComponents * surface.view().numberOfPoints);
  Eigen::SparseMatrix<double, Eigen::RowMajor> all(size, size);
  all.setFromTriplets(entries.begin(), entries.end());
  SparseMatrix matrix;
  matrix.size = size;
  matrix.offsets.assign(all.outerIndexPtr(), all.outerIndexPtr() + size + 1);
  matrix.columns.assign(all.innerIndexPtr(), all.innerIndexPtr() + all.nonZeros());
  matrix.values.assign(all.valuePtr(), all.valuePtr() + all.nonZeros());
  symmetrize(matrix, options.threads); // removes rounding errors
  return matrix;
}
}
