// SPDX-License-Identifier: BSD-3-Clause
#include "MeshParts.h"

#include "BlockSeams.h"
#include "MergedPieces.h"
#include "MeshAdapter.h"
#include "PointMerge.h"

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
#include <sstream>
#include <utility>

namespace tautline
{
namespace
{
constexpr char SeamRemedy[] =
  ": on several processes run Merge Blocks first, or switch Merge Coincident Points off to solve "
  "on each block by itself.";

/// The partitions of a mesh on this process.
struct Group
{
  std::string name;
  std::vector<Piece> pieces;
  std::string notice;
};

//------------------------------------------------------------------------------
/// Walks through a data object; outputs are made and put into the output's structure.
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
        ++this->FlatIndex;
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

  int FlatIndex = 0;
  std::vector<vtkSmartPointer<vtkDataSet>> Made;
};

//------------------------------------------------------------------------------
/// Removes from the flagged points those inside of a mesh without ghosts, which no other piece can
/// have.
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

/// The place of a piece and its number.
struct Box
{
  int rank, piece;
  vtkBoundingBox bounds;
};

/// Flags, for each piece, the points that other pieces may share. @param ghosts whether any
/// piece has some. Collective.
std::vector<std::vector<char>> sharedPoints(
  const std::vector<Piece>& pieces, bool ghosts, const Processes& processes)
{
  constexpr std::size_t numbersPerBox = 8;
  constexpr double few = 0.1; // of the points: then finding those inside costs more than it saves
  std::vector<double> numbers;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    double bounds[6];
    pieces[i].input->GetBounds(bounds);
    numbers.insert(
      numbers.end(), { static_cast<double>(processes.rank()), static_cast<double>(i) });
    numbers.insert(numbers.end(), bounds, bounds + 6);
  }
  numbers = processes.gather(numbers);
  std::vector<Box> boxes;
  for (std::size_t k = 0; k + numbersPerBox <= numbers.size(); k += numbersPerBox)
  {
    boxes.push_back({ static_cast<int>(numbers[k]), static_cast<int>(numbers[k + 1]),
      vtkBoundingBox(&numbers[k + 2]) });
  }
  std::vector<std::vector<char>> shared;
  processes.together(
    [&]()
    {
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
                const bool same = box.rank == processes.rank() && box.piece == static_cast<int>(i);
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
    });
  return shared;
}

/// Whether any piece has ghosts. Collective.
bool anyGhosts(const std::vector<Piece>& pieces, const Processes& processes)
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
std::vector<std::vector<Index>> generateIds(
  const std::vector<Piece>& pieces, const Processes& processes)
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
  // Shared points first, in the order of their coordinates; then those of one process after the
  // other.
  coordinates = processes.gather(coordinates);
  std::vector<Vec3> places;
  for (std::size_t k = 0; k + 2 < coordinates.size(); k += 3)
  {
    places.push_back({ coordinates[k], coordinates[k + 1], coordinates[k + 2] });
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  auto next = static_cast<Index>(places.size());
  const std::vector<double> counts = processes.gather({ privates });
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
/// Global point ids of each piece, from the input or by coordinates. Collective.
std::vector<std::vector<Index>> globalIdsOf(
  const std::vector<Piece>& pieces, const Processes& processes)
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
  processes.together(
    [&]()
    {
      for (std::size_t i = 0; i < pieces.size(); ++i)
      {
        for (vtkIdType k = 0; known && k < given[i]->GetNumberOfTuples(); ++k)
        {
          ids[i].push_back(static_cast<Index>(given[i]->GetComponent(k, 0)));
        }
        std::vector<Index> sorted = ids[i];
        std::sort(sorted.begin(), sorted.end());
        const auto distinct = std::unique(sorted.begin(), sorted.end()) - sorted.begin();
        const auto repeated = static_cast<Index>(sorted.size()) - distinct;
        if (repeated > 0 || (!sorted.empty() && sorted.front() < 0))
        {
          throw Error(std::to_string(repeated) +
            " points are at the place of another one, or have its global id, and cannot be "
            "distinguished from points of other parts: run Clean to Grid first, or solve in one "
            "process.");
        }
      }
    });
  return ids;
}

//------------------------------------------------------------------------------
/// A sentence on point arrays that differ between points that are one, or "".
std::string differingArrays(vtkDataSet* input, const std::vector<Index>& representative)
{
  std::string names;
  for (int i = 0; i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = input->GetPointData()->GetArray(i);
    const bool ids = array && array == input->GetPointData()->GetGlobalIds();
    bool differs = false;
    for (std::size_t p = 0; array && !ids && !differs && p < representative.size(); ++p)
    {
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      {
        const double own = array->GetComponent(static_cast<vtkIdType>(p), c);
        const double other = array->GetComponent(representative[p], c);
        differs = differs || (own != other && !(std::isnan(own) && std::isnan(other)));
      }
    }
    names += differs ? (names.empty() ? "'" : ", '") + std::string(array->GetName()) + "'" : "";
  }
  return names.empty() ? ""
                       : "Their values differ in the point array" +
      std::string(names.find(',') == std::string::npos ? " " : "s ") + names +
      ": those of the point with the smallest id are taken.";
}

/// The pieces with their coincident points as one, and the way back.
class Seamless
{
public:
  std::vector<Piece> pieces;
  std::string notice;

  Seamless(const std::vector<Piece>& given, bool mergePoints)
    : pieces(given)
    , Given(given)
    , Made(given.size())
  {
    for (std::size_t i = 0; mergePoints && i < given.size(); ++i)
    {
      vtkDataSet* input = given[i].input;
      const MeshAdapter adapter(input);
      const CoincidentPoints found = findCoincidentPoints(adapter.mesh());
      this->add(describeMerged(found, adapter.mesh()));
      if (found.apart() > 0)
      {
        throw Error(this->notice + " Or switch Merge Coincident Points off to keep all apart.");
      }
      if (found.any())
      {
        this->add(differingArrays(input, found.representative));
        this->Made[i] = std::make_unique<Merged>(
          std::vector<Piece>{ given[i] }, std::vector<std::vector<Index>>{ found.representative });
        this->Outputs.push_back(vtkSmartPointer<vtkUnstructuredGrid>::New());
        this->Outputs.back()->ShallowCopy(this->Made[i]->Input);
        this->pieces[i] = { this->Made[i]->Input, this->Made[i]->Selected, this->Outputs.back() };
      }
    }
  }

  /// Hands what is new in the outputs of the pieces to those that were given.
  void scatter() const
  {
    for (std::size_t i = 0; i < this->Made.size(); ++i)
    {
      if (this->Made[i])
      {
        this->Made[i]->scatter(this->pieces[i].output, { this->Given[i] });
      }
    }
  }

private:
  void add(const std::string& sentence)
  {
    this->notice += (this->notice.empty() || sentence.empty() ? "" : " ") + sentence;
  }

  std::vector<Piece> Given;
  std::vector<std::unique_ptr<Merged>> Made; ///< null where no points are one
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> Outputs;
};

//------------------------------------------------------------------------------
void visitGroup(const Group& group, LocalMesh& mesh, bool mergePoints, const Processes& processes,
  const std::function<void(LocalMesh&)>& visit)
{
  std::unique_ptr<Seamless> seamless;
  processes.together([&]() { seamless = std::make_unique<Seamless>(group.pieces, mergePoints); });
  const std::vector<Piece>& pieces = seamless->pieces;
  mesh.notice =
    group.notice + (group.notice.empty() || seamless->notice.empty() ? "" : " ") + seamless->notice;
  std::vector<std::vector<Index>> ids;
  if (processes.maximum(static_cast<Index>(pieces.size())) > 1 || processes.count() > 1)
  {
    ids = globalIdsOf(pieces, processes);
  }
  std::unique_ptr<Merged> merged;
  processes.together(
    [&]()
    {
      if (pieces.size() == 1)
      {
        mesh.input = pieces[0].input;
        mesh.selected = pieces[0].selected;
        mesh.output = pieces[0].output;
        mesh.globalIds = ids.empty() ? std::vector<Index>() : std::move(ids[0]);
        return;
      }
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
    });
  visit(mesh);
  if (merged)
  {
    merged->scatter(mesh.output, pieces);
  }
  seamless->scatter();
}

//------------------------------------------------------------------------------
/// Throws Error if points of a group coincide with those of another group, which may be on another
/// process: then they cannot be joined. Collective.
void requireNoSeams(const std::vector<Group>& groups, const Processes& processes)
{
  std::vector<Piece> pieces;
  std::vector<double> groupOf;
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    for (const Piece& piece : groups[g].pieces)
    {
      pieces.push_back(piece);
      groupOf.push_back(static_cast<double>(g));
    }
  }
  const bool ghosts = anyGhosts(pieces, processes);
  const std::vector<std::vector<char>> shared = sharedPoints(pieces, ghosts, processes);
  std::vector<double> numbers; // the place and the group of each
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (std::size_t k = 0; k < shared[i].size(); ++k)
    {
      if (shared[i][k])
      {
        const Vec3 p = placeOf(pieces[i], k);
        numbers.insert(numbers.end(), { p[0], p[1], p[2], groupOf[i] });
      }
    }
  }
  numbers = processes.gather(numbers);
  std::vector<std::pair<Vec3, std::size_t>> places;
  for (std::size_t k = 0; k + 3 < numbers.size(); k += 4)
  {
    places.push_back(
      { { numbers[k], numbers[k + 1], numbers[k + 2] }, static_cast<std::size_t>(numbers[k + 3]) });
  }
  std::sort(places.begin(), places.end());
  Index points = 0;
  Vec3 first = { 0, 0, 0 };
  for (std::size_t k = 1; k < places.size(); ++k)
  {
    if (places[k].first == places[k - 1].first && places[k].second != places[k - 1].second)
    {
      first = points++ == 0 ? places[k].first : first;
    }
  }
  constexpr Index ofEdge = 2; // one alone is no seam
  if (points >= ofEdge)
  {
    std::ostringstream text;
    text << points << " points of a block coincide with those of another one, the first is at ("
         << first[0] << ", " << first[1] << ", " << first[2] << ")" << SeamRemedy;
    throw Error(text.str());
  }
}

/// Makes one of the groups with seams between them. Collective.
void joinGroups(std::vector<Group>& groups, const Processes& processes)
{
  std::vector<vtkDataSet*> data;
  std::vector<std::string> names;
  std::vector<std::size_t> groupOf;
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    for (const Piece& piece : groups[g].pieces)
    {
      data.push_back(piece.input);
      names.push_back(groups[g].name);
      groupOf.push_back(g);
    }
  }
  BlockSeams seams;
  processes.together(
    [&]()
    {
      if (groups.size() < 2)
      {
        return;
      }
      seams = findBlockSeams(data, names, 0);
      bool between = false; // seams of the partitions of one group do not matter
      for (std::size_t i = 0; i < data.size(); ++i)
      {
        between = between || groupOf[i] != groupOf[seams.group[i]];
      }
      if (between && processes.count() > 1)
      {
        throw Error(std::to_string(seams.points) +
          " points of a block coincide with those of another one, the first is " + seams.first +
          SeamRemedy);
      }
    });
  if (processes.count() > 1 && groups.size() > 1)
  {
    requireNoSeams(groups, processes);
  }
  std::vector<std::size_t> to(groups.size());
  std::iota(to.begin(), to.end(), std::size_t(0));
  for (std::size_t i = 0; seams.points > 0 && i < data.size(); ++i)
  {
    const std::size_t a = to[groupOf[i]], b = to[groupOf[seams.group[i]]];
    std::replace(to.begin(), to.end(), std::max(a, b), std::min(a, b));
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    Group& target = groups[to[g]];
    if (to[g] == g)
    {
      continue;
    }
    target.pieces.insert(target.pieces.end(), groups[g].pieces.begin(), groups[g].pieces.end());
    target.name += ", " + groups[g].name;
    target.notice = "Blocks with a seam between them are one mesh; switch Merge Coincident Points "
                    "off to solve on each by itself.";
    groups[g].pieces.clear();
  }
}
}

//------------------------------------------------------------------------------
void forEachMesh(vtkDataObject* input, vtkDataObject* selected, vtkDataObject* output,
  bool mergePoints, const Processes& processes, const std::function<void(LocalMesh&)>& visit)
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
      visitGroup(groups[g], mesh, mergePoints, processes, visit);
    }
    catch (const Error& error)
    {
      throw Error((mesh.name.empty() ? "" : "In " + mesh.name + ": ") + error.what());
    }
  }
}
}
