// SPDX-License-Identifier: BSD-3-Clause
#include "FacePieces.h"

#include "FaceShape.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Random.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

namespace tautline
{
namespace
{
using Key = std::array<std::uint64_t, 2>;

/// A hash of a point; two of them, with different seeds, make collisions unlikely.
std::uint64_t hashOf(const FacePiece& piece, Index point, std::uint64_t seed)
{
  if (piece.globalIds)
  {
    return SplitMix::mixed(seed ^ static_cast<std::uint64_t>(piece.globalIds[point]));
  }
  const Vec3 place = pointAt(piece.points, point) + Vec3{ 0, 0, 0 }; // -0 becomes 0
  std::array<std::uint64_t, 3> bits;
  std::memcpy(bits.data(), place.data(), sizeof(bits));
  return SplitMix::mixed(SplitMix::mixed(SplitMix::mixed(seed ^ bits[0]) ^ bits[1]) ^ bits[2]);
}

/// Independent of the order of the points.
Key keyOfFace(const FacePiece& piece, Index face)
{
  Key key = { 0, 0 };
  for (Index i = piece.mesh->offsets[face]; i < piece.mesh->offsets[face + 1]; ++i)
  {
    for (std::uint64_t seed = 0; seed < key.size(); ++seed)
    {
      key[seed] += hashOf(piece, piece.mesh->nodes[i], seed);
    }
  }
  return key;
}

/// A key for a processorCyclic patch, including the number of its faces: the same for the coupled
/// patch; "" if the name does not follow OpenFOAM's scheme.
std::string pairName(const FaceMesh& mesh, const FacePatch& patch)
{
  const std::string prefix = "procBoundary", separator = "to", through = "through";
  const std::size_t to = patch.name.find(separator, prefix.size());
  const std::size_t via = patch.name.find(through);
  if (patch.name.rfind(prefix, 0) != 0 || to == std::string::npos || via == std::string::npos ||
    via < to)
  {
    return "";
  }
  const std::string from = patch.name.substr(prefix.size(), to - prefix.size());
  const std::string other = patch.name.substr(to + separator.size(), via - to - separator.size());
  std::string referred = patch.name.substr(via + through.size());
  const bool first = std::make_pair(from.size(), from) < std::make_pair(other.size(), other);
  if (!first)
  {
    const auto known = std::find_if(mesh.patches.begin(), mesh.patches.end(),
      [&](const FacePatch& one) { return one.name == referred; });
    if (known == mesh.patches.end() || known->partner < 0)
    {
      return "";
    }
    referred = mesh.patches[known->partner].name;
  }
  return (first ? from + " " + other : other + " " + from) + " " + referred + " " +
    std::to_string(patch.count);
}

/// A face of a piece, in order of rank, piece and face.
struct FacePlace
{
  Index rank, piece, face;
  auto tied() const { return std::tie(this->rank, this->piece, this->face); }
  bool operator<(const FacePlace& other) const { return this->tied() < other.tied(); }
};

/// A face that may also belong to another piece.
struct Candidate
{
  Key key;
  FacePlace place;
  bool hasFacet;
  /// on a patch between processors, or one of a pair: may also match within a piece
  bool ofProcessors;
  bool operator<(const Candidate& other) const
  {
    return std::tie(this->key, this->place) < std::tie(other.key, other.place);
  }
};

/// Two occurrences of one face.
struct Mates
{
  FacePlace here, there;
  bool operator<(const Mates& other) const { return this->here < other.here; }
};

class Border
{
public:
  Border(RankGroup& group, const std::vector<FacePiece>& pieces)
    : Group(group)
    , Pieces(pieces)
    , Added(pieces.size())
  {
  }

  std::vector<std::vector<double>> join()
  {
    for (const FacePiece& piece : this->Pieces)
    {
      this->flagForeign(*piece.mesh);
    }
    const Index pieces = this->Group.sum(static_cast<Index>(this->Pieces.size()));
    this->Several = pieces > 1;
    this->findFirstIds();
    std::vector<std::vector<Candidate>> sent(this->Group.size());
    for (std::size_t i = 0; i < this->Pieces.size(); ++i)
    {
      this->listCandidates(static_cast<Index>(i), sent);
    }
    const bool any = std::any_of(
      sent.begin(), sent.end(), [](const std::vector<Candidate>& list) { return !list.empty(); });
    if (this->Group.any(any))
    {
      const std::vector<Mates> mates = this->match(sent);
      this->coupleOwn(mates);
      this->fetchCells(mates);
    }
    return std::move(this->Added);
  }

private:
  void addRole(FaceMesh& mesh, Index face, int role)
  {
    mesh.roles.resize(mesh.faces(), 0);
    mesh.roles[face] = static_cast<unsigned char>(mesh.roles[face] | role);
  }

  /// Faces between cells of other pieces are counted there.
  void flagForeign(FaceMesh& mesh)
  {
    for (Index face = 0; face < mesh.faces() && !mesh.foreignCells.empty(); ++face)
    {
      if (!mesh.touches(face))
      {
        this->addRole(mesh, face, CountsElsewhere);
      }
    }
  }

  /// Finds the smallest facet id of each "cyclic" patch, if pieces have ids, and uncouples these
  /// patches.
  void findFirstIds()
  {
    const bool here = std::all_of(this->Pieces.begin(), this->Pieces.end(),
      [](const FacePiece& piece) { return piece.facetIds != nullptr; });
    if (!this->Several || !this->Group.everywhere(here))
    {
      return;
    }
    Index patches = 0;
    for (const FacePiece& piece : this->Pieces)
    {
      patches = std::max(patches, static_cast<Index>(piece.mesh->patches.size()));
    }
    this->FirstIds.assign(this->Group.maximum(patches), std::numeric_limits<Index>::max());
    for (const FacePiece& piece : this->Pieces)
    {
      FaceMesh& mesh = *piece.mesh;
      for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      {
        const FacePatch& patch = mesh.patches[p];
        for (Index face = patch.first; isPaired(patch) && face < patch.first + patch.count; ++face)
        {
          const Index facet = mesh.facet[face - mesh.internalFaces];
          this->FirstIds[p] = std::min(this->FirstIds[p], piece.facetIds[facet]);
          mesh.partner[face - mesh.internalFaces] = -1;
        }
      }
    }
    for (Index& first : this->FirstIds)
    {
      first = -this->Group.maximum(-first);
    }
  }

  static bool isPaired(const FacePatch& patch) { return patch.isCyclic() && patch.partner >= 0; }

  /// A key for a face of a "cyclic" patch: the same as the key of the coupled face.
  Key keyOfPair(const FacePiece& piece, Index number, Index face) const
  {
    const FacePatch& patch = piece.mesh->patches[number];
    const Index facet = piece.mesh->facet[face - piece.mesh->internalFaces];
    const auto at = static_cast<std::uint64_t>(piece.facetIds[facet] - this->FirstIds[number]);
    const Index lower = std::min<Index>(number, patch.partner);
    return { SplitMix::mixed(hashOfText(piece.mesh->patches[lower].name) + at), at };
  }

  void listCandidates(Index number, std::vector<std::vector<Candidate>>& sent)
  {
    const FacePiece& piece = this->Pieces[number];
    const FaceMesh& mesh = *piece.mesh;
    const auto add = [&](Index face, const Key& key, bool ofProcessors)
    {
      const bool facet = !mesh.internal(face) && mesh.facet[face - mesh.internalFaces] >= 0;
      const auto home = static_cast<std::size_t>(key[0] % sent.size());
      sent[home].push_back(
        { key, { this->Group.rank(), number, face }, facet && !ofProcessors, ofProcessors });
    };
    for (Index face = 0; face < mesh.internalFaces && !mesh.foreignCells.empty(); ++face)
    {
      if (mesh.ownsCell(mesh.owner[face]) != mesh.ownsCell(mesh.neighbor[face]))
      {
        add(face, keyOfFace(piece, face), false);
      }
    }
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    {
      const FacePatch& patch = mesh.patches[p];
      const bool ofProcessors = patch.type.rfind("processor", 0) == 0;
      const bool paired = !this->FirstIds.empty() && isPaired(patch);
      const std::string pair =
        patch.type == "processorCyclic" ? pairName(mesh, patch) : std::string();
      for (Index i = 0; i < patch.count && (this->Several || ofProcessors); ++i)
      {
        const Index face = patch.first + i;
        pollInterruption(face);
        const auto at = static_cast<std::uint64_t>(i);
        if (paired && mesh.ownsCell(mesh.owner[face]))
        {
          add(face, this->keyOfPair(piece, static_cast<Index>(p), face), true);
        }
        else if (mesh.ownsCell(mesh.owner[face]))
        {
          add(face,
            pair.empty() ? keyOfFace(piece, face)
                         : Key{ SplitMix::mixed(hashOfText(pair) + at), at },
            ofProcessors);
        }
      }
    }
  }

  static std::uint64_t hashOfText(const std::string& text)
  {
    std::uint64_t hash = 0;
    for (const char c : text)
    {
      hash = SplitMix::mixed(hash ^ static_cast<unsigned char>(c));
    }
    return hash;
  }

  /// The pairs whose first face is in a piece of this rank, in order.
  std::vector<Mates> match(const std::vector<std::vector<Candidate>>& sent)
  {
    std::vector<Candidate> all = this->Group.exchangeJoined(sent);
    std::sort(all.begin(), all.end());
    std::vector<std::vector<Mates>> found(this->Group.size());
    for (std::size_t i = 0, next = 0; i < all.size(); i = next)
    {
      while (next < all.size() && all[next].key == all[i].key)
      {
        ++next;
      }
      if (next - i > 2)
      {
        throw Error("A face of the mesh belongs to three or more cells in its pieces: remove "
                    "duplicate and overlapping cells.");
      }
      const Candidate &a = all[i], &b = all[next - 1];
      const bool samePiece = a.place.rank == b.place.rank && a.place.piece == b.place.piece;
      const bool baffle = a.hasFacet && b.hasFacet;
      if (next - i == 2 && !baffle && (!samePiece || (a.ofProcessors && b.ofProcessors)))
      {
        found[a.place.rank].push_back({ a.place, b.place });
        found[b.place.rank].push_back({ b.place, a.place });
      }
    }
    std::vector<Mates> mates = this->Group.exchangeJoined(found);
    std::sort(mates.begin(), mates.end());
    return mates;
  }

  static bool sameSide(const Mates& pair)
  {
    return pair.here.rank == pair.there.rank && pair.here.piece == pair.there.piece;
  }

  static const FacePatch& patchOf(const FaceMesh& mesh, Index face)
  {
    return *(std::upper_bound(mesh.patches.begin(), mesh.patches.end(), face,
               [](Index f, const FacePatch& patch) { return f < patch.first; }) -
      1);
  }

  static bool isCyclic(const FaceMesh& mesh, Index face)
  {
    return !mesh.internal(face) &&
      (patchOf(mesh, face).type == "processorCyclic" || isPaired(patchOf(mesh, face)));
  }

  /// Couples faces of one piece, and sets where the others are counted.
  void coupleOwn(const std::vector<Mates>& mates)
  {
    for (const Mates& pair : mates)
    {
      FaceMesh& mesh = *this->Pieces[pair.here.piece].mesh;
      const Index face = pair.here.face;
      const bool later = pair.there < pair.here;
      if (isCyclic(mesh, face))
      {
        this->addRole(mesh, face, later ? PairComesElsewhere : 0);
      }
      else
      {
        this->addRole(mesh, face, (later ? CountsElsewhere : 0) | OnBorder);
      }
      if (sameSide(pair))
      {
        mesh.partner[face - mesh.internalFaces] = pair.there.face;
      }
    }
  }

  /// The faces of a cell. If a face is split between a patch that isPartly() and the patch for the
  /// rest, only one is kept, so that the copy of the cell has the whole face once.
  static std::vector<Index> facesOnce(const FacePiece& piece, Index cell)
  {
    const FaceMesh& mesh = *piece.mesh;
    std::vector<Index> faces;
    std::vector<Key> keys;
    for (Index i = mesh.cellOffsets[cell]; i < mesh.cellOffsets[cell + 1]; ++i)
    {
      const Index face = mesh.cellFaces[i];
      const Key key = mesh.internal(face) ? Key{ 0, 0 } : keyOfFace(piece, face);
      const bool twice =
        !mesh.internal(face) && std::find(keys.begin(), keys.end(), key) != keys.end();
      if (!twice)
      {
        keys.push_back(key);
        faces.push_back(face);
      }
    }
    return faces;
  }

  /// Packs a cell for sending: its faces with points numbered from 0, and which of them the
  /// receiving piece has.
  void pack(const FacePiece& piece, Index cell, const std::vector<Mates>& pairs,
    std::vector<Index>& numbers, std::vector<double>& places) const
  {
    const FaceMesh& mesh = *piece.mesh;
    const std::vector<Index> faces = facesOnce(piece, cell);
    numbers.push_back(pairs.front().there.piece);
    numbers.push_back(static_cast<Index>(pairs.size()));
    for (const Mates& pair : pairs)
    {
      numbers.push_back(pair.there.face);
      numbers.push_back(std::find(faces.begin(), faces.end(), pair.here.face) - faces.begin());
    }
    std::map<Index, Index> local;
    std::vector<Index> order, nodes;
    for (const Index face : faces)
    {
      const Index first = mesh.offsets[face], size = mesh.size(face);
      const bool out = mesh.owner[face] == cell;
      nodes.push_back(size);
      for (Index k = 0; k < size; ++k)
      {
        const Index node = mesh.nodes[first + (out ? k : (size - k) % size)];
        const auto entry = local.emplace(node, static_cast<Index>(order.size()));
        if (entry.second)
        {
          order.push_back(node);
        }
        nodes.push_back(entry.first->second);
      }
    }
    numbers.push_back(static_cast<Index>(order.size()));
    numbers.push_back(static_cast<Index>(faces.size()));
    numbers.insert(numbers.end(), nodes.begin(), nodes.end());
    for (const Index node : order)
    {
      places.insert(places.end(), piece.points + 3 * node, piece.points + 3 * node + 3);
    }
  }

  void fetchCells(const std::vector<Mates>& mates)
  {
    const auto ranks = static_cast<std::size_t>(this->Group.size());
    // Sorted by receiving piece, then by own piece and cell, so that a cell is sent once.
    std::map<std::array<Index, 4>, std::vector<Mates>> cells;
    for (const Mates& pair : mates)
    {
      if (sameSide(pair))
      {
        continue;
      }
      const FaceMesh& mesh = *this->Pieces[pair.here.piece].mesh;
      const Index face = pair.here.face;
      const Index cell = mesh.ownsCell(mesh.owner[face]) ? mesh.owner[face] : mesh.neighbor[face];
      cells[{ pair.there.rank, pair.there.piece, pair.here.piece, cell }].push_back(pair);
    }
    std::vector<std::vector<Index>> numbers(ranks);
    std::vector<std::vector<double>> places(ranks);
    for (const auto& [place, pairs] : cells)
    {
      this->pack(this->Pieces[place[2]], place[3], pairs, numbers[place[0]], places[place[0]]);
    }
    const std::vector<Index> arrived = this->Group.exchangeJoined(numbers);
    const std::vector<double> coordinates = this->Group.exchangeJoined(places);
    for (const FacePiece& piece : this->Pieces)
    {
      piece.mesh->patches.emplace_back();
      piece.mesh->patches.back().name = "across the border";
      piece.mesh->patches.back().first = piece.mesh->faces();
    }
    const Index* next = arrived.data();
    const double* place = coordinates.data();
    while (next != arrived.data() + arrived.size())
    {
      this->addCell(next, place);
    }
    for (const FacePiece& piece : this->Pieces)
    {
      this->finish(*piece.mesh);
    }
  }

  /// Appends a cell that another piece has sent.
  void addCell(const Index*& next, const double*& place)
  {
    const Index piece = *next++, pairs = *next++;
    const Index* pair = next;
    next += 2 * pairs;
    const Index points = *next++, faces = *next++;
    FaceMesh& mesh = *this->Pieces[piece].mesh;
    const Index firstFace = mesh.faces(), firstPoint = mesh.points;
    mesh.foreignCells.resize(mesh.cells, 0);
    mesh.foreignCells.push_back(1);
    for (Index face = 0; face < faces; ++face)
    {
      const Index size = *next++;
      for (Index k = 0; k < size; ++k)
      {
        mesh.nodes.push_back(firstPoint + *next++);
      }
      mesh.offsets.push_back(static_cast<Index>(mesh.nodes.size()));
      mesh.owner.push_back(mesh.cells);
      mesh.partner.push_back(-1);
      mesh.facet.push_back(-1);
      mesh.cellFaces.push_back(firstFace + face);
      this->addRole(mesh, firstFace + face, CountsElsewhere);
    }
    mesh.cellOffsets.push_back(static_cast<Index>(mesh.cellFaces.size()));
    for (Index i = 0; i < pairs; ++i)
    {
      const Index own = pair[2 * i], copy = firstFace + pair[2 * i + 1];
      if (!mesh.internal(own)) // otherwise a ghost cell is already there
      {
        mesh.partner[own - mesh.internalFaces] = copy;
        mesh.partner[copy - mesh.internalFaces] = own;
      }
    }
    ++mesh.cells;
    mesh.points += points;
    mesh.patches.back().count += faces;
    std::vector<double>& added = this->Added[piece];
    added.insert(added.end(), place, place + 3 * points);
    place += 3 * points;
  }

  /// Patches whose faces are all coupled by a motion get a partner, so that the motion is
  /// determined.
  void finish(FaceMesh& mesh)
  {
    if (mesh.patches.back().count == 0)
    {
      mesh.patches.pop_back();
    }
    for (FacePatch& patch : mesh.patches)
    {
      bool all = patch.type == "processorCyclic" && patch.count > 0;
      for (Index i = 0; all && i < patch.count; ++i)
      {
        all = mesh.coupled(patch.first + i) >= 0;
      }
      if (all)
      {
        const Index other = mesh.coupled(patch.first);
        patch.partner = static_cast<int>(&patchOf(mesh, other) - mesh.patches.data());
      }
    }
  }

  RankGroup& Group;
  const std::vector<FacePiece>& Pieces;
  bool Several = false;
  std::vector<Index> FirstIds; ///< per patch; empty: facets have no ids
  std::vector<std::vector<double>> Added;
};

Vec3 sumOf(RankGroup& group, const Vec3& own)
{
  return { group.sum(own[0]), group.sum(own[1]), group.sum(own[2]) };
}

}

//------------------------------------------------------------------------------
FaceExtent unite(RankGroup& group, const FaceExtent& own)
{
  FaceExtent all;
  for (int c = 0; c < 3; ++c)
  {
    all.low[c] = -group.maximum(-own.low[c]);
    all.high[c] = group.maximum(own.high[c]);
  }
  return all;
}

//------------------------------------------------------------------------------
int markLayer(RankGroup& group, const std::vector<FacePiece>& pieces)
{
  FaceExtent extent;
  for (const FacePiece& piece : pieces)
  {
    for (const Index node : piece.mesh->nodes)
    {
      extent.add(pointAt(piece.points, node));
    }
  }
  extent = unite(group, extent);
  int found = -1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool here = std::all_of(pieces.begin(), pieces.end(),
      [&](const FacePiece& piece) { return isLayer(*piece.mesh, piece.points, extent, axis); });
    if (group.everywhere(here) && extent.low[axis] < extent.high[axis])
    {
      if (found >= 0)
      {
        return -1; // a row of cells
      }
      found = axis;
    }
  }
  for (const FacePiece& piece : pieces)
  {
    if (found >= 0)
    {
      markLayer(*piece.mesh, piece.points, extent, found);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
std::vector<std::vector<double>> joinPieces(RankGroup& group, const std::vector<FacePiece>& pieces)
{
  return Border(group, pieces).join();
}

//------------------------------------------------------------------------------
void joinMeasures(RankGroup& group, const std::vector<FaceMeasures*>& pieces)
{
  FaceExtent extent;
  DirectionSums sums;
  for (const FaceMeasures* piece : pieces)
  {
    if (piece->extent().low[0] <= piece->extent().high[0])
    {
      extent.add(piece->extent().low);
      extent.add(piece->extent().high);
    }
    const DirectionSums own = piece->directionSums();
    sums.empty += own.empty;
    sums.wedge += own.wedge;
  }
  extent = unite(group, extent);
  sums.empty = sumOf(group, sums.empty);
  sums.wedge = sumOf(group, sums.wedge);
  for (FaceMeasures* piece : pieces)
  {
    piece->setWhole(extent, sums);
  }
}

namespace
{
/// Keeps each item once: coincident points are counted once, as are coincident edges.
template <class Item>
Index countOnce(RankGroup& group, const std::vector<MeshCheckReport*>& pieces,
  const std::vector<Item> BorderItems::*member)
{
  std::vector<Item> own;
  for (const MeshCheckReport* piece : pieces)
  {
    const std::vector<Item>& more = piece->border.*member;
    own.insert(own.end(), more.begin(), more.end());
  }
  std::vector<Item> all = group.gatherOnFirst(own);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return group.sum(static_cast<Index>(all.size())); // empty on the other ranks
}
}

//------------------------------------------------------------------------------
std::vector<MeshCheck> joinReports(RankGroup& group, const std::vector<MeshCheckReport*>& pieces)
{
  std::vector<std::vector<MeshCheck>> lists;
  BoundarySum boundary;
  for (const MeshCheckReport* piece : pieces)
  {
    lists.push_back(piece->checks);
    boundary.area += piece->boundary.area;
    boundary.size += piece->boundary.size;
  }
  boundary.area = sumOf(group, boundary.area);
  boundary.size = group.sum(boundary.size);
  constexpr auto kinds = static_cast<std::size_t>(MeshCheckKind::Number);
  std::vector<MeshCheckValues> values;
  for (const MeshCheck& check : joinChecks(lists))
  {
    values.push_back(check);
  }
  lists.clear();
  for (const std::vector<MeshCheckValues>& rank : group.gatherItems(values))
  {
    lists.push_back(emptyMeshChecks());
    for (std::size_t i = 0; i < kinds; ++i)
    {
      static_cast<MeshCheckValues&>(lists.back()[i]) = rank[i];
    }
  }
  std::vector<MeshCheck> all = joinChecks(lists);
  const auto at = [&](MeshCheckKind kind) -> MeshCheck&
  { return all[static_cast<std::size_t>(kind)]; };
  at(MeshCheckKind::EdgeLength).offending +=
    countOnce(group, pieces, &BorderItems::shortEdgePoints);
  at(MeshCheckKind::EdgeAlignment).offending += countOnce(group, pieces, &BorderItems::askewEdges);
  setBoundaryOpenness(at(MeshCheckKind::BoundaryOpenness), boundary);
  return all;
}
}
