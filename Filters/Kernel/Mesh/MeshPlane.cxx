// SPDX-License-Identifier: BSD-3-Clause
// The plane of a mesh of 2D cells.
#include "PlaneSearch.h"

namespace tautline
{
namespace
{
/// Whether all points, which are finite, have the same third coordinate.
bool areLevel(const MeshView& view)
{
  const double level = view.numberOfPoints > 0 ? view.points[2] : 0.0;
  bool same = true;
  double sum = 0; // finite if all coordinates are, or too large to be sure
  for (Index p = 0; p < view.numberOfPoints && same; ++p)
  {
    const double* x = view.points + 3 * p;
    same = x[2] == level;
    sum += std::abs(x[0]) + std::abs(x[1]);
  }
  return same && std::isfinite(sum) && std::isfinite(level);
}

/// Two corners of cells at different places; none if there are none.
std::vector<Vec3> differentCorners(const MeshView& view, const std::vector<CellBlock>& blocks)
{
  std::vector<Vec3> found;
  for (const CellBlock& block : blocks)
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int k = 0; k < nodes; ++k)
      {
        const Vec3 p = pointOf(view, node[k]);
        if (found.empty() || p != found[0])
        {
          found.push_back(p);
        }
        if (found.size() == 2)
        {
          return found;
        }
      }
    }
  }
  return {};
}
}

//------------------------------------------------------------------------------
void Mesh::findPlane()
{
  OneProcessTotals totals;
  MeshSpace space = this->space();
  // Of level points, two corners have the plane that all have.
  const std::vector<Vec3> two =
    areLevel(this->View) ? differentCorners(this->View, this->Blocks) : std::vector<Vec3>();
  const auto corners = [&](const auto& visit)
  {
    if (two.empty())
    {
      forEachFiniteCorner(this->View, this->Blocks, nullptr, visit);
    }
    std::for_each(two.begin(), two.end(), visit);
  };
  PlaneSearch(corners, totals).run(space);
  this->setSpace(space);
}
}
