// SPDX-License-Identifier: BSD-3-Clause
#include "MeshParts.h"

#include "BlockSeams.h"
#include "MergedPieces.h"
#include "MeshAdapter.h"
#include "ProcessGroup.h"
#include "SeamlessPieces.h"

#include "tautline/Mesh/BlockPieces.h"

#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tautline
{
namespace
{
/// The partitions of a mesh on this process.
struct Group
{
  std::string name;
  std::vector<Piece> pieces;
  std::string notice;
};

//------------------------------------------------------------------------------
/// Traverses a data object; outputs are created and put into the output's structure.
class Collector
{
public:
  std::vector<Group> groups;

  void collect(vtkDataObject* input, vtkDataObject* selected, vtkDataObject* output)
  {
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input))
    {
      auto* marked = vtkMultiBlockDataSet::SafeDownCast(selected);
      auto* results = vtkMultiBlockDataSet::SafeDownCast(output);
      for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
      {
        ++this->FlatIndex;
        vtkDataObject* block = blocks->GetBlock(i);
        vtkDataObject* mark = marked ? marked->GetBlock(i) : nullptr;
        if (vtkCompositeDataSet::SafeDownCast(block))
        {
          this->collect(block, mark, results->GetBlock(i));
          continue;
        }
        this->begin();
        if (vtkDataSet* result = this->add(block, mark))
        {
          results->SetBlock(i, result);
        }
      }
    }
    else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(input))
    {
      auto* marked = vtkPartitionedDataSetCollection::SafeDownCast(selected);
      auto* results = vtkPartitionedDataSetCollection::SafeDownCast(output);
      for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
      {
        ++this->FlatIndex;
        this->collect(collection->GetPartitionedDataSet(i),
          marked ? marked->GetPartitionedDataSet(i) : nullptr, results->GetPartitionedDataSet(i));
      }
    }
    else if (auto* parts = vtkPartitionedDataSet::SafeDownCast(input))
    {
      this->begin();
      auto* marked = vtkPartitionedDataSet::SafeDownCast(selected);
      auto* results = vtkPartitionedDataSet::SafeDownCast(output);
      for (unsigned int i = 0; i < parts->GetNumberOfPartitions(); ++i)
      {
        vtkDataObject* part = parts->GetPartitionAsDataObject(i);
        vtkDataObject* mark = marked ? marked->GetPartitionAsDataObject(i) : nullptr;
        if (vtkDataSet* result = this->add(part, mark))
        {
          results->SetPartition(i, result);
        }
      }
    }
    else if (auto* others = vtkCompositeDataSet::SafeDownCast(input))
    {
      auto* marked = vtkCompositeDataSet::SafeDownCast(selected);
      auto* results = vtkCompositeDataSet::SafeDownCast(output);
      auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(others->NewIterator());
      for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
      {
        this->FlatIndex = static_cast<int>(walk->GetCurrentFlatIndex());
        this->begin();
        if (vtkDataSet* result =
              this->add(walk->GetCurrentDataObject(), marked ? marked->GetDataSet(walk) : nullptr))
        {
          results->SetDataSet(walk, result);
        }
      }
    }
    else if (auto* data = vtkDataSet::SafeDownCast(input))
    {
      auto* result = vtkDataSet::SafeDownCast(output);
      result->ShallowCopy(data);
      this->begin();
      this->keep(data, selected, result);
    }
  }

private:
  void begin()
  {
    this->groups.push_back(
      { this->FlatIndex > 0 ? "block " + std::to_string(this->FlatIndex) : "", {}, "" });
  }

  vtkDataSet* add(vtkDataObject* input, vtkDataObject* selected)
  {
    auto* data = vtkDataSet::SafeDownCast(input);
    if (!data)
    {
      return nullptr;
    }
    this->Made.push_back(vtkSmartPointer<vtkDataSet>::Take(data->NewInstance()));
    vtkDataSet* result = this->Made.back();
    result->ShallowCopy(data);
    this->keep(data, selected, result);
    return result;
  }

  void keep(vtkDataSet* input, vtkDataObject* selected, vtkDataSet* output)
  {
    if (input->GetNumberOfPoints() > 0)
    {
      this->groups.back().pieces.push_back({ input, vtkDataSet::SafeDownCast(selected), output });
    }
  }

  int FlatIndex = 0; ///< as if partitions were one data set, see BlockPlace
  std::vector<vtkSmartPointer<vtkDataSet>> Made;
};

//------------------------------------------------------------------------------
/// Clears the flags of interior points of a mesh without ghosts, which no other piece can have.
void dropInside(vtkDataSet* input, std::vector<char>& flags)
{
  const MeshAdapter adapter(input);
  const Mesh& mesh = adapter.mesh();
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      const Index* node = mesh.view().connectivity + mesh.view().offsets[block.cell(i)];
      std::for_each(node, node + t.nodes,
        [&](Index point) { flags[point] = static_cast<char>(flags[point] && boundary[point]); });
    }
  }
}

/// The position of a piece and a number of it.
struct Box
{
  int rank, number;
  vtkBoundingBox bounds;
};

/// The boxes of the pieces of all processes. @param numbers one per piece. Collective.
std::vector<Box> boxesOf(
  const std::vector<Piece>& pieces, const std::vector<std::size_t>& numbers, RankGroup& processes)
{
  constexpr std::size_t size = 8;
  std::vector<double> sent;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    double bounds[6];
    pieces[i].input->GetBounds(bounds);
    sent.insert(
      sent.end(), { static_cast<double>(processes.rank()), static_cast<double>(numbers[i]) });
    sent.insert(sent.end(), bounds, bounds + 6);
  }
  sent = processes.gatherJoined(sent);
  std::vector<Box> boxes;
  for (std::size_t k = 0; k + size <= sent.size(); k += size)
  {
    boxes.push_back(
      { static_cast<int>(sent[k]), static_cast<int>(sent[k + 1]), vtkBoundingBox(&sent[k + 2]) });
  }
  return boxes;
}

/// Flags, for each piece, the points that other pieces may share. @param ghosts whether any
/// piece has some. Collective.
std::vector<std::vector<char>> sharedPoints(
  const std::vector<Piece>& pieces, bool ghosts, RankGroup& processes)
{
  constexpr double few = 0.1; // fraction of the points that is not worth a search
  std::vector<std::size_t> numbers(pieces.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t(0));
  const std::vector<Box> boxes = boxesOf(pieces, numbers, processes);
  std::vector<std::vector<char>> shared;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    vtkDataSet* input = pieces[i].input;
    std::vector<char> flags(static_cast<std::size_t>(input->GetNumberOfPoints()), 0);
    for (vtkIdType k = 0; k < input->GetNumberOfPoints(); ++k)
    {
      double p[3];
      input->GetPoint(k, p);
      const bool finite = std::isfinite(p[0] + p[1] + p[2]);
      flags[k] = finite &&
        std::any_of(boxes.begin(), boxes.end(),
          [&](const Box& box)
          {
            const bool same = box.rank == processes.rank() && box.number == static_cast<int>(i);
            return !same && box.bounds.ContainsPoint(p);
          });
    }
    const auto count = static_cast<double>(std::count(flags.begin(), flags.end(), 1));
    if (!ghosts && count > few * static_cast<double>(flags.size()))
    {
      dropInside(input, flags);
    }
    shared.push_back(std::move(flags));
  }
  return shared;
}

/// Whether any piece has ghosts. Collective.
bool anyGhosts(const std::vector<Piece>& pieces, RankGroup& processes)
{
  return !processes.everywhere(std::none_of(pieces.begin(), pieces.end(),
    [](const Piece& piece) { return piece.input->GetCellGhostArray() != nullptr; }));
}

Vec3 placeOf(const Piece& piece, std::size_t point)
{
  Vec3 p;
  piece.input->GetPoint(static_cast<vtkIdType>(point), p.data());
  return p + Vec3{ 0, 0, 0 }; // -0 becomes 0
}

/// Global ids by coordinates, which must be equal in all digits. Collective.
std::vector<std::vector<Index>> generateIds(const std::vector<Piece>& pieces, RankGroup& processes)
{
  const bool ghosts = anyGhosts(pieces, processes);
  const std::vector<std::vector<char>> shared = sharedPoints(pieces, ghosts, processes);
  std::vector<double> coordinates;
  double privates = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (std::size_t k = 0; k < shared[i].size(); ++k)
    {
      if (shared[i][k])
      {
        const Vec3 p = placeOf(pieces[i], k);
        coordinates.insert(coordinates.end(), p.begin(), p.end());
      }
      privates += !shared[i][k];
    }
  }
  // Shared points come first, in the order of their coordinates; then the other points, process by
  // process.
  coordinates = processes.gatherJoined(coordinates);
  std::vector<Vec3> places;
  for (std::size_t k = 0; k + 2 < coordinates.size(); k += 3)
  {
    places.push_back({ coordinates[k], coordinates[k + 1], coordinates[k + 2] });
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  auto next = static_cast<Index>(places.size());
  const std::vector<double> counts = processes.gatherJoined(std::vector<double>{ privates });
  for (int rank = 0; rank < processes.rank(); ++rank)
  {
    next += static_cast<Index>(counts[static_cast<std::size_t>(rank)]);
  }
  std::vector<std::vector<Index>> ids(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (std::size_t k = 0; k < shared[i].size(); ++k)
    {
      ids[i].push_back(shared[i][k]
          ? std::lower_bound(places.begin(), places.end(), placeOf(pieces[i], k)) - places.begin()
          : next++);
    }
  }
  return ids;
}

//------------------------------------------------------------------------------
/// The number of ids that another point also has.
Index repetitions(std::vector<Index> ids)
{
  std::sort(ids.begin(), ids.end());
  return ids.end() - std::unique(ids.begin(), ids.end());
}

/**
 * @brief Global point ids of each piece, from the input or by coordinates. Collective.
 * @param mergePoints whether points of one piece may share an id by coordinates: they are merged
 */
std::vector<std::vector<Index>> globalIdsOf(
  const std::vector<Piece>& pieces, bool mergePoints, RankGroup& processes)
{
  std::vector<vtkDataArray*> given;
  for (const Piece& piece : pieces)
  {
    given.push_back(piece.input->GetPointData()->GetGlobalIds());
  }
  std::vector<std::vector<Index>> ids(pieces.size());
  const bool known =
    processes.everywhere(std::find(given.begin(), given.end(), nullptr) == given.end());
  if (!known)
  {
    ids = generateIds(pieces, processes);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (vtkIdType k = 0; known && k < given[i]->GetNumberOfTuples(); ++k)
    {
      ids[i].push_back(static_cast<Index>(given[i]->GetComponent(k, 0)));
    }
    const Index repeated = repetitions(ids[i]);
    const bool negative =
      std::any_of(ids[i].begin(), ids[i].end(), [](Index id) { return id < 0; });
    const bool apart =
      repeated > 0 && (known || !mergePoints || anyCollapse(pieces[i].input, ids[i]));
    if (apart || negative)
    {
      throw Error(std::to_string(repeated) +
        " points coincide with another one, or have its global id, and cannot be distinguished "
        "from points of other parts: run Clean to Grid first, or solve in one process.");
    }
  }
  return ids;
}

//------------------------------------------------------------------------------
void visitGroup(const Group& group, LocalMesh& mesh, bool mergePoints, RankGroup& processes,
  const std::function<void(LocalMesh&)>& visit)
{
  std::unique_ptr<Seamless> seamless;
  seamless = std::make_unique<Seamless>(group.pieces, mergePoints);
  const std::vector<Piece>& pieces = seamless->pieces;
  mesh.notice =
    group.notice + (group.notice.empty() || seamless->notice.empty() ? "" : " ") + seamless->notice;
  std::vector<std::vector<Index>> ids;
  if (processes.maximum(static_cast<Index>(pieces.size())) > 1 || processes.size() > 1)
  {
    ids = globalIdsOf(pieces, mergePoints, processes);
  }
  Index united = 0; // points of one piece, by their coordinates
  for (const std::vector<Index>& ofPiece : ids)
  {
    united += repetitions(ofPiece);
  }
  const std::string unitedText = describeUnited(united);
  mesh.notice += (mesh.notice.empty() || unitedText.empty() ? "" : " ") + unitedText;
  std::unique_ptr<Merged> merged;
  if (pieces.size() == 1 && united == 0)
  {
    mesh.input = pieces[0].input;
    mesh.selected = pieces[0].selected;
    mesh.output = pieces[0].output;
    mesh.globalIds = ids.empty() ? std::vector<Index>() : std::move(ids[0]);
  }
  else
  {
    mesh.input = vtkSmartPointer<vtkUnstructuredGrid>::New();
    if (!pieces.empty())
    {
      merged = std::make_unique<Merged>(pieces, ids);
      mesh.input = merged->Input;
      mesh.selected = merged->Selected;
      mesh.globalIds = merged->GlobalIds;
    }
    mesh.output = vtkSmartPointer<vtkUnstructuredGrid>::New();
    mesh.output->ShallowCopy(mesh.input);
  }
  visit(mesh);
  if (merged)
  {
    merged->scatter(mesh.output, pieces);
  }
  seamless->scatter();
}

//------------------------------------------------------------------------------
/// For each group, the first group that seams connect with it, or its own number, among the pieces
/// of this process.
std::vector<std::size_t> connectedHere(const std::vector<Group>& groups)
{
  std::vector<vtkDataSet*> data;
  std::vector<std::string> names;
  std::vector<std::size_t> groupOf, to(groups.size());
  std::iota(to.begin(), to.end(), std::size_t(0));
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    for (const Piece& piece : groups[g].pieces)
    {
      data.push_back(piece.input);
      names.push_back(groups[g].name);
      groupOf.push_back(g);
    }
  }
  const BlockSeams seams = findBlockSeams(data, names, 0);
  for (std::size_t i = 0; seams.points > 0 && i < data.size(); ++i)
  {
    const std::size_t one = to[groupOf[i]], other = to[groupOf[seams.group[i]]];
    std::replace(to.begin(), to.end(), std::max(one, other), std::min(one, other));
  }
  return to;
}

/// The same for the pieces on all processes. Collective.
std::vector<std::size_t> connectedOnAll(const std::vector<Group>& groups, RankGroup& processes)
{
  std::vector<Piece> all;
  std::vector<std::size_t> groupOf;
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    all.insert(all.end(), groups[g].pieces.begin(), groups[g].pieces.end());
    groupOf.resize(all.size(), g);
  }
  const std::vector<Box> boxes = boxesOf(all, groupOf, processes);
  std::vector<std::unique_ptr<MeshAdapter>> adapters;
  std::vector<BlockPiece> pieces;
  std::vector<RankPiece> parts;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const auto number = static_cast<int>(groupOf[i]);
    const vtkBoundingBox own(all[i].input->GetBounds());
    const auto meets = [&](const Box& box)
    { return box.number != number && box.bounds.IsValid() && own.Intersects(box.bounds); };
    if (own.IsValid() && std::any_of(boxes.begin(), boxes.end(), meets))
    {
      adapters.push_back(std::make_unique<MeshAdapter>(all[i].input));
      parts.push_back({ &adapters.back()->mesh(), adapters.back()->ghostCells(), nullptr });
      pieces.push_back({ parts.back(), number, false });
    }
  }
  const MeshSpace whole = spaceOf(processes, parts);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    Mesh& mesh = adapters[i]->mesh();
    mesh.setSpace(whole);
    std::vector<signed char> validity(static_cast<std::size_t>(mesh.view().numberOfCells));
    mesh.classifyCells(validity.data());
    pieces[i].reversed = mesh.orientation(validity.data()).state == Orientation::Reversed;
  }
  const std::vector<int> found =
    connectedBlocks(processes, pieces, static_cast<int>(groups.size()));
  return { found.begin(), found.end() };
}

/// Joins groups with seams between them. Collective.
void joinGroups(std::vector<Group>& groups, RankGroup& processes)
{
  if (groups.size() < 2)
  {
    return;
  }
  const std::vector<std::size_t> to =
    processes.size() > 1 ? connectedOnAll(groups, processes) : connectedHere(groups);
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    Group& target = groups[to[g]];
    if (to[g] == g)
    {
      continue;
    }
    target.pieces.insert(target.pieces.end(), groups[g].pieces.begin(), groups[g].pieces.end());
    // A process may have no blocks at all, and no names of them.
    target.name += (groups[g].name.empty() ? "" : ", ") + groups[g].name;
    target.notice = "Blocks with a seam between them are one mesh; switch Merge Coincident Points "
                    "off to solve on each by itself.";
    groups[g].pieces.clear();
  }
}
}

//------------------------------------------------------------------------------
void forEachMesh(vtkDataObject* input, vtkDataObject* selected, vtkDataObject* output,
  bool mergePoints, RankGroup& processes, const std::function<void(LocalMesh&)>& visit)
{
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(input))
  {
    vtkCompositeDataSet::SafeDownCast(output)->CopyStructure(blocks);
  }
  Collector collector;
  collector.collect(input, selected, output);
  std::vector<Group>& groups = collector.groups;
  groups.resize(static_cast<std::size_t>(processes.maximum(static_cast<Index>(groups.size()))));
  if (mergePoints)
  {
    joinGroups(groups, processes);
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    Index cells = 0;
    for (const Piece& piece : groups[g].pieces)
    {
      cells += piece.input->GetNumberOfCells();
    }
    if (processes.maximum(cells) == 0)
    {
      continue;
    }
    LocalMesh mesh;
    mesh.name = groups[g].name;
    mesh.number = static_cast<int>(g);
    mesh.meshes = static_cast<int>(groups.size());
    try
    {
      processes.together([&] { visitGroup(groups[g], mesh, mergePoints, processes, visit); });
    }
    catch (const Error& error) // on all processes
    {
      throw Error((mesh.name.empty() ? "" : "In " + mesh.name + ": ") + error.what());
    }
  }
}
}
