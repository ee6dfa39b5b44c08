// SPDX-License-Identifier: BSD-3-Clause
// PT-Scotch divides the points of a mesh on MPI ranks: about as much work for each, short borders,
// and owners that the ranks agree about.
#include "ProcessGroup.h"
#include "Processes.h"
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Solvers/GraphPartition.h"
#include "vtkMPIController.h"
#include "vtkNew.h"

using namespace tautline;

namespace
{
/// The target owners, per point of the piece.
std::vector<int> ofPiece(const DistributedMesh& mesh, const std::vector<int>& ofLocal)
{
  return collect<int>(
    mesh.localOfPiece(), [&](const Index local) { return local < 0 ? 0 : ofLocal[local]; });
}

/// All ranks that have a point have the same target owner for it.
void checkAgreed(const DistributedMesh& mesh, const std::vector<int>& owners)
{
  std::vector<Index> pairs;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    pairs.push_back(mesh.numbers()[p]);
    pairs.push_back(owners[p]);
  }
  std::map<Index, Index> known;
  for (const std::vector<Index>& list : mesh.group().gatherItems(pairs))
  {
    for (std::size_t i = 0; i < list.size(); i += 2)
    {
      TAUTLINE_CHECK_EQUAL(known.emplace(list[i], list[i + 1]).first->second, list[i + 1]);
    }
  }
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(known.size()), mesh.globalPoints());
}

/// The points of others that the cells about own points have, of all ranks.
double haloOf(const DistributedMesh& mesh)
{
  std::vector<char> used(mesh.localPoints(), 0);
  const MeshView& view = mesh.view();
  for (Index n = 0; n < view.offsets[view.numberOfCells]; ++n)
  {
    used[view.connectivity[n]] = !mesh.owned(view.connectivity[n]);
  }
  return static_cast<double>(mesh.group().sum(std::count(used.begin(), used.end(), 1)));
}

/// The elements at the points of each rank, by which the graph is weighted, differ by 10 %.
void checkBalance(const DistributedMesh& mesh)
{
  const VertexCells cells = Mesh(mesh.view()).vertexCells();
  Index own = sumOf<Index>(0, mesh.localPoints(),
    [&](Index p) { return mesh.owned(p) ? cells.offsets[p + 1] - cells.offsets[p] : 0; });
  const double mean =
    static_cast<double>(mesh.group().sum(own)) / static_cast<double>(mesh.group().size());
  TAUTLINE_CHECK(static_cast<double>(mesh.group().maximum(own)) < 1.1 * mean);
}

void testDivision(RankGroup& group, Communicator communicator, CellType type, Cut cut)
{
  const Context context(
    std::string(topology(type).plural) + ", cut " + std::to_string(static_cast<int>(cut)));
  const MeshData whole = movedBlock(type, topology(type).dimension == 2 ? 40 : 13, 0.1);
  const RankPart part = partOf(whole, group.rank(), cutBy(whole, cut, group.size()));
  MeshPiece piece = { part.data.view() };
  piece.divideAnew = true;
  const DistributedMesh tree(group, piece);
  const std::vector<int> wanted = partitionPoints(tree, communicator);
  checkAgreed(tree, wanted);

  const std::vector<int> owners = ofPiece(tree, wanted);
  piece.owners = owners.data();
  const DistributedMesh graph(group, piece);
  TAUTLINE_CHECK_EQUAL(graph.globalPoints(), tree.globalPoints());
  TAUTLINE_CHECK_EQUAL(graph.globalCells(), tree.globalCells());
  for (std::size_t p = 0; p < owners.size(); ++p)
  {
    TAUTLINE_CHECK_EQUAL(graph.owners()[graph.localOfPiece()[p]], owners[p]);
    TAUTLINE_CHECK_EQUAL(
      graph.numbers()[graph.localOfPiece()[p]], tree.numbers()[tree.localOfPiece()[p]]);
  }
  checkBalance(graph);

  // Few points on the border: no more than a third above the boxes', and far fewer than of
  // points that are dealt out.
  auto dealt = collect<int>(tree.localOfPiece(),
    [&](const Index local) { return static_cast<int>(tree.numbers()[local] % group.size()); });
  piece.owners = dealt.data();
  const DistributedMesh scattered(group, piece);
  TAUTLINE_CHECK(haloOf(graph) > 0);
  TAUTLINE_CHECK(haloOf(graph) <= 4.0 / 3.0 * haloOf(tree));
  TAUTLINE_CHECK(haloOf(graph) <= 0.5 * haloOf(scattered));
}

/// Fewer points than ranks (of four), and a rank that does not exist.
void testLimits(RankGroup& group, Communicator communicator)
{
  MeshData triangle = movedBlock(CellType::Triangle, 1, 0.0);
  const RankPart part =
    partOf(triangle, group.rank(), [](Index cell) { return cell == 0 ? 0 : -1; });
  MeshPiece piece = { part.data.view() };
  const DistributedMesh mesh(group, piece);
  const std::vector<int> owners = partitionPoints(mesh, communicator);
  checkAgreed(mesh, owners);
  if (group.size() > mesh.globalPoints())
  {
    TAUTLINE_CHECK(owners == mesh.owners());
  }
  const std::vector<int> wrong(part.data.numberOfPoints(), group.size());
  piece.owners = wrong.data();
  TAUTLINE_CHECK_THROWS(DistributedMesh(group, piece), wording("shall-be-owned-by-rank"));
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestPointPartition)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  {
    const auto group = makeProcessGroup();
    const Communicator communicator = group->communicator();
    for (const Cut cut : { Cut::FirstOnly, Cut::Slabs, Cut::Random })
    {
      TAUTLINE_RUN(testDivision(*group, communicator, CellType::Tetrahedron, cut));
      TAUTLINE_RUN(testDivision(*group, communicator, CellType::Quadrilateral, cut));
    }
    TAUTLINE_RUN(testDivision(*group, communicator, CellType::Hexahedron, Cut::Random));
    TAUTLINE_RUN(testLimits(*group, communicator));
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
