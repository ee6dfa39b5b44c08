// SPDX-License-Identifier: BSD-3-Clause
// The order of the points of a mesh on ranks: by their coordinates, however the mesh is cut.
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Mesh/DistributedMesh.h"

using namespace tautline;

namespace
{
/// The points of a mesh by x, then y, then z.
std::vector<Index> placesOf(const MeshData& data)
{
  std::vector<Index> order(data.numberOfPoints()), places(order.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(),
    [&data](Index a, Index b) { return data.point(a) < data.point(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    places[order[i]] = static_cast<Index>(i);
  }
  return places;
}

TAUTLINE_PART(testOrder)
{
  const Context context("order of coordinates");
  const MeshData whole = blockMesh(CellType::Tetrahedron, 5, 5, 5);
  const std::vector<Index> places = placesOf(whole);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    const auto rankOf = cutBy(whole, cut, 3);
    onRanks(3,
      [&](RankGroup& group)
      {
        const RankPart part = partOf(whole, group.rank(), rankOf);
        const DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
        const std::vector<Index> order = coordinateOrder(mesh);
        TAUTLINE_EACH(std::size_t, p, part.pointOf.size(),
          TAUTLINE_CHECK_EQUAL(order[mesh.localOfPiece()[p]], places[part.pointOf[p]]));
      });
  }
}
}
