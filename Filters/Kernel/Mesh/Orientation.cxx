#include "Mesh.h"

#include "tautline/Core/UnionFind.h"
#include "FacetTable.h"

namespace tautline
{
namespace
{
/**
 * Signed area or volume of a cell with its faces cut into triangles about their centres, so that
 * the sum over a mesh whose cells agree depends on its boundary only, however tangled its inside.
 * With one origin for all cells, the contributions of an inner edge or face cancel exactly.
 */
double signedSize(const Mesh& mesh, const CellTopology& t, const Index* node, const Vec3& origin)
{
  const MeshView& view = mesh.view();
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    p[k] = pointOf(view, node[k]) - origin;
  }
  if (t.dimension == 2)
  {
    Vec3 area = { 0, 0, 0 };
    for (int k = 0; k < t.nodes; ++k)
    {
      area += cross(p[k], p[(k + 1) % t.nodes]);
    }
    return 0.5 * dot(mesh.normal(), area);
  }
  double sum = 0;
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    Vec3 center = { 0, 0, 0 };
    for (int k = 0; k < size; ++k)
    {
      center += (1.0 / size) * p[t.faceNodes[f][k]];
    }
    for (int k = 0; k < size; ++k)
    {
      sum += dot(center, cross(p[t.faceNodes[f][k]], p[t.faceNodes[f][(k + 1) % size]])) / 6;
    }
  }
  return sum;
}

/// Counts the parts, which `sets` has by cell, and those that are reversed: the signed size of a
/// part decides, tangled or not; where it is lost to rounding (a vertex far out), the majority.
void countParts(const Mesh& mesh, const signed char* validity, UnionFind& sets, Orientation& result)
{
  const MeshView& view = mesh.view();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  const bool haveSigns = mesh.dimension() != Dimension::Surface;
  struct Part
  {
    double sum = 0, magnitude = 0;
    Index majority = 0; // positive less inverted cells
  };
  std::vector<Part> parts(view.numberOfCells);
  Vec3 origin = { 0, 0, 0 };
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    origin = pointOf(view, i);
    if (std::isfinite(dot(origin, origin)))
    {
      break;
    }
  }
  for (const CellBlock& block : mesh.blocks())
  {
    if (topology(block.type).dimension == dimension)
    {
      for (Index i = 0; i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        if (haveSigns && validity[cell] >= Inverted) // flat ones, too: they may be long
        {
          const double size =
            signedSize(mesh, topology(block.type), view.connectivity + view.offsets[cell], origin);
          Part& part = parts[sets.find(cell)];
          part.sum += size;
          part.magnitude += std::abs(size);
          part.majority += validity[cell]; // 1, 0 or -1
        }
        result.parts += sets.find(cell) == cell;
      }
    }
  }
  if (haveSigns)
  {
    constexpr double rounding = 1e-9;
    const double sign = mesh.mirrored() ? -1 : 1;
    result.reversedParts = std::count_if(parts.begin(), parts.end(),
      [=](const Part& p)
      { return std::abs(p.sum) > rounding * p.magnitude ? sign * p.sum < 0 : p.majority < 0; });
  }
}
}

//------------------------------------------------------------------------------
Orientation Mesh::orientation(const signed char* validity) const
{
  Orientation result;
  const int dimension = this->Dim == Dimension::Volume ? 3 : 2;
  Index cells = 0;
  for (const CellBlock& block : this->Blocks)
  {
    if (topology(block.type).dimension == dimension)
    {
      cells += block.count;
      for (Index i = 0; i < block.count; ++i)
      {
        result.positiveCells += validity[block.cell(i)] == Valid;
        result.negativeCells += validity[block.cell(i)] == Inverted;
      }
    }
  }
  if (cells == 0)
  {
    return result;
  }
  const bool haveSigns = this->Dim != Dimension::Surface;
  if (haveSigns && result.negativeCells == 0)
  {
    return result;
  }
  if (haveSigns && result.positiveCells == 0)
  {
    result.state = Orientation::Reversed;
    return result;
  }

  // Signs differ (a tangled or a mixed mesh), or there are none (a surface): compare neighbours.
  UnionFind sets(this->View.numberOfCells);
  FacetTable(*this).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count == 2)
      {
        result.disagreeing += uses[0].forward == uses[1].forward;
        sets.join(uses[0].cell, uses[1].cell);
      }
    });

  countParts(*this, validity, sets, result);
  if (result.disagreeing > 0 || (result.reversedParts > 0 && result.reversedParts < result.parts))
  {
    result.state = Orientation::Mixed;
  }
  else if (result.reversedParts > 0)
  {
    result.state = Orientation::Reversed;
  }
  return result;
}
}
