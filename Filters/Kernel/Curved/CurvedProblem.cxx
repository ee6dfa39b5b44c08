// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedProblem.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
//------------------------------------------------------------------------------
CurvedProblem::CurvedProblem(const Mesh& mesh, const CurvedOptions& options)
  : TheMesh(mesh)
  , Options(options)
  , Dimension(mesh.dimension() == Dimension::Volume ? 3 : 2)
{
  if (mesh.dimension() == Dimension::Surface)
  {
    throw Error("Curved cells of a surface in space are not supported: reduce them to order 1 "
                "(Curve Mesh), or extract a planar part.");
  }
  const MeshView& view = mesh.view();
  Index elements = 0;
  for (const CurvedBlock& block : curvedBlocks(mesh, options.facts, true))
  {
    const ElementType& type = *block.type;
    elements += type.dimension() == this->Dimension ? block.count() : 0;
    for (Index i = 0; type.dimension() == this->Dimension && i < block.count(); ++i)
    {
      this->Elements.push_back({ &type, block.mirrored[i] != 0, block.cells[i],
        std::vector<Index>(block.nodes[i], block.nodes[i] + type.nodes()) });
    }
  }
  Index supported = 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    supported += type != CellType::Unsupported && topology(type).dimension == this->Dimension;
  }
  if (supported > elements)
  {
    throw Error(std::to_string(supported - elements) +
      " curved cells are of a type that cannot be certified (Lagrange pyramids, Bezier cells with "
      "weights, orders above " +
      std::to_string(MaxElementOrder) +
      "): reduce the mesh to order 1 (Curve Mesh), or remove them.");
  }
  // The order of the cells does not depend on their division into blocks.
  std::sort(this->Elements.begin(), this->Elements.end(),
    [](const CurvedElement& a, const CurvedElement& b) { return a.cell < b.cell; });

  this->X = this->inFrame(view.points);
  this->Start = this->X;
  this->Guard.reset(new CurvedGuard(this->Elements, this->Dimension, options.threads));

  this->CellsAtOffsets.assign(view.numberOfPoints + 1, 0);
  for (const CurvedElement& element : this->Elements)
  {
    for (const Index p : element.nodes)
    {
      ++this->CellsAtOffsets[p + 1];
    }
  }
  std::partial_sum(
    this->CellsAtOffsets.begin(), this->CellsAtOffsets.end(), this->CellsAtOffsets.begin());
  this->CellsAt.resize(this->CellsAtOffsets.back());
  std::vector<Index> next(this->CellsAtOffsets.begin(), this->CellsAtOffsets.end() - 1);
  for (std::size_t e = 0; e < this->Elements.size(); ++e)
  {
    for (const Index p : this->Elements[e].nodes)
    {
      this->CellsAt[next[p]++] = static_cast<Index>(e);
    }
  }
}

//------------------------------------------------------------------------------
std::vector<double> CurvedProblem::inFrame(const double* points) const
{
  const Index count = this->TheMesh.view().numberOfPoints;
  std::vector<double> x(points, points + 3 * count);
  for (Index p = 0; p < count && this->Dimension == 2; ++p)
  {
    const Vec3 at = { points[3 * p], points[3 * p + 1], points[3 * p + 2] };
    x[3 * p] = dot(this->TheMesh.frame()[0], at);
    x[3 * p + 1] = dot(this->TheMesh.frame()[1], at);
    x[3 * p + 2] = 0;
  }
  return x;
}

//------------------------------------------------------------------------------
std::vector<double> CurvedProblem::points() const
{
  return this->points(this->X);
}

//------------------------------------------------------------------------------
std::vector<double> CurvedProblem::points(const std::vector<double>& x) const
{
  const MeshView& view = this->TheMesh.view();
  std::vector<double> result(view.points, view.points + 3 * view.numberOfPoints);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    // Points that have not moved keep their coordinates exactly; the conversion from the frame
    // would round them.
    if (std::equal(x.begin() + 3 * p, x.begin() + 3 * (p + 1), this->Start.begin() + 3 * p))
    {
      continue;
    }
    for (int c = 0; c < 3; ++c)
    {
      if (this->Dimension == 3)
      {
        result[3 * p + c] = x[3 * p + c];
        continue;
      }
      for (int a = 0; a < 2; ++a)
      {
        result[3 * p + c] += (x[3 * p + a] - this->Start[3 * p + a]) * this->TheMesh.frame()[a][c];
      }
    }
  }
  return result;
}

//------------------------------------------------------------------------------
const SlidingBoundary& CurvedProblem::boundary()
{
  if (!this->Boundary)
  {
    this->Boundary.reset(new SlidingBoundary(
      this->Elements, this->Start, this->Dimension, this->Options.featureAngle));
  }
  return *this->Boundary;
}

//------------------------------------------------------------------------------
/// Finds, for each patch and curve of the boundary, the patch or curve of the geometry nearest to
/// its points.
void CurvedProblem::matchGeometry()
{
  if (!this->Options.geometry || !this->Geometry.empty())
  {
    return;
  }
  if (this->Dimension == 2)
  {
    throw Error("A Geometry for curved cells in a plane is not supported: choose Boundary on "
                "surface without a Geometry, which keeps the curved outline.");
  }
  for (const SurfacePart& part : this->Options.geometry->parts)
  {
    this->Geometry.emplace_back(part, nullptr);
  }
  const SlidingBoundary& boundary = this->boundary();
  const std::size_t parts = boundary.parts();
  std::vector<std::vector<double>> sums(parts, std::vector<double>(this->Geometry.size(), 0.0));
  const auto points = static_cast<Index>(this->X.size() / 3);
  for (Index p = 0; p < points; ++p)
  {
    const Index piece = boundary.contains(p) ? boundary.pieceOf(p) : -1;
    if (piece < 0)
    {
      continue;
    }
    const int part = boundary.pieces()[piece].part;
    const Vec3 at = { this->Start[3 * p], this->Start[3 * p + 1], this->Start[3 * p + 2] };
    for (std::size_t g = 0; g < this->Geometry.size(); ++g)
    {
      // Curves can only follow curves of the geometry, and patches only patches.
      if (this->Geometry[g].isCurve() == boundary.isCurve(part) && !this->Geometry[g].empty())
      {
        const Vec3 away = this->Geometry[g].closest(at) - at;
        sums[part][g] += dot(away, away);
      }
      else
      {
        sums[part][g] = std::numeric_limits<double>::infinity();
      }
    }
  }
  for (std::size_t part = 0; part < parts; ++part)
  {
    const auto least = std::min_element(sums[part].begin(), sums[part].end());
    const bool found = least != sums[part].end() && std::isfinite(*least);
    this->GeometryOf.push_back(found ? static_cast<int>(least - sums[part].begin()) : -1);
  }
}

//------------------------------------------------------------------------------
CurvedRegion CurvedProblem::region(const std::vector<WeakPlace>& around, int rings)
{
  const auto points = static_cast<Index>(this->X.size() / 3);
  // A negative number of rings selects the whole mesh.
  std::vector<char> chosen(this->Elements.size(), rings < 0), core(points, rings < 0);
  for (const WeakPlace& place : around)
  {
    chosen[place.element] = 1;
  }
  // The points of the last but one ring move; elements at them belong to the region.
  for (int ring = 0; ring < rings; ++ring)
  {
    for (std::size_t e = 0; e < this->Elements.size(); ++e)
    {
      for (const Index p : this->Elements[e].nodes)
      {
        core[p] |= chosen[e];
      }
    }
    for (Index p = 0; p < points; ++p)
    {
      for (Index k = this->CellsAtOffsets[p]; core[p] && k < this->CellsAtOffsets[p + 1]; ++k)
      {
        chosen[this->CellsAt[k]] = 1;
      }
    }
  }
  CurvedRegion region;
  std::vector<Index> local(points, -1);
  std::vector<char> held;
  for (std::size_t e = 0; e < this->Elements.size(); ++e)
  {
    if (!chosen[e])
    {
      continue;
    }
    region.elements.push_back(this->Elements[e]);
    // The copy of the element is renumbered within the region.
    for (Index& p : region.elements.back().nodes)
    {
      if (local[p] < 0)
      {
        local[p] = static_cast<Index>(region.points.size());
        region.points.push_back(p);
        region.x.insert(region.x.end(), this->X.begin() + 3 * p, this->X.begin() + 3 * (p + 1));
        held.push_back(!core[p]);
      }
      p = local[p];
    }
  }
  this->makeSlides(region, held);
  return region;
}

//------------------------------------------------------------------------------
void CurvedProblem::makeSlides(CurvedRegion& region, const std::vector<char>& held)
{
  const auto count = static_cast<Index>(region.points.size());
  region.slides.reset(new CurvedSlides(count));
  const BoundaryMotion motion = this->Options.boundary;
  std::vector<char> corner(count, 0);
  for (const CurvedElement& element : region.elements)
  {
    const int corners = topology(cornerType(this->TheMesh.view().cellTypes[element.cell])).nodes;
    for (int n = 0; n < corners; ++n)
    {
      corner[element.nodes[n]] = 1;
    }
  }
  const SlidingBoundary* boundary = motion == BoundaryMotion::Free ? nullptr : &this->boundary();
  if (motion == BoundaryMotion::OnSurface)
  {
    this->matchGeometry();
  }
  for (Index p = 0; p < count; ++p)
  {
    const Index global = region.points[p];
    if (held[p] || (this->Options.fixed && this->Options.fixed[global]) ||
      (this->Options.midNodesOnly && corner[p]))
    {
      region.slides->fix(p);
      continue;
    }
    if (boundary && boundary->contains(global))
    {
      Index piece = boundary->pieceOf(global);
      const bool stays = motion == BoundaryMotion::Fixed || piece < 0 ||
        (motion == BoundaryMotion::FlatParts && !boundary->isFlat(global, this->Options.flatAngle));
      if (stays)
      {
        region.slides->fix(p);
        continue;
      }
      const int geometry =
        this->GeometryOf.empty() ? -1 : this->GeometryOf[boundary->pieces()[piece].part];
      const double* x = region.x.data() + 3 * p;
      if (geometry < 0 && !std::equal(x, x + 3, this->Start.begin() + 3 * global))
      {
        // The point has slid to another piece.
        piece = boundary->closestOfPart(boundary->pieces()[piece].part, { x[0], x[1], x[2] }).piece;
      }
      geometry < 0 ? region.slides->slide(p, *boundary, piece)
                   : region.slides->slide(p, this->Geometry[geometry]);
    }
    ++region.free;
  }
  // The first linearization needs the tangents at the positions on the boundary.
  region.slides->place(region.x, this->Options.threads);
  region.slides->accept();
}

//------------------------------------------------------------------------------
void CurvedProblem::take(const CurvedRegion& region, const std::vector<double>& x)
{
  for (std::size_t p = 0; p < region.points.size(); ++p)
  {
    std::copy_n(x.begin() + 3 * p, 3, this->X.begin() + 3 * region.points[p]);
  }
}
}
