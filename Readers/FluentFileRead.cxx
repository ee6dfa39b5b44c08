// SPDX-License-Identifier: BSD-3-Clause
#include "FluentFile.h"

#include "ArrayIndex.h"
#include "FluentCursor.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace tautline
{
namespace
{
/// Section numbers; the last three digits for binary sections.
enum SectionKind
{
  Dimension = 2,
  Machine = 4,
  Nodes = 10,
  Cells = 12,
  Faces = 13,
  PeriodicFaces = 18,
  ZoneOfMesher = 39,
  ZoneOfSolver = 45,
  CellTree = 58,
  FaceTree = 59,
  InterfaceParents = 61,
  InterfaceFaces = 62
};

constexpr Index Interior = 2, ParentFaces = 31, InactiveCells = 32;
constexpr Index Linear = 2, Mixed = 0, Polygonal = 5;
constexpr const char* HangingNodes =
  "the mesh was adapted and has hanging nodes (parents of cells or faces), which are not "
  "supported: in Fluent, convert these cells to polyhedra (mesh/polyhedra/convert-hanging-nodes) "
  "and save again";
constexpr const char* Interfaces = "the mesh has intersected interfaces, which are not supported: "
                                   "delete the mesh interfaces in Fluent and save again";

/// The type of a face zone in a file without zone names.
std::string typeOf(Index code)
{
  static const std::map<Index, const char*> types = { { Interior, "interior" }, { 3, "wall" },
    { 4, "pressure-inlet" }, { 5, "pressure-outlet" }, { 7, "symmetry" }, { 8, "shadow" },
    { 9, "pressure-far-field" }, { 10, "velocity-inlet" }, { 12, "periodic" }, { 14, "fan" },
    { 20, "mass-flow-inlet" }, { 24, "interface" }, { 36, "outflow" }, { 37, "axis" } };
  const auto found = types.find(code);
  return found == types.end() ? "patch" : found->second;
}

/// The faces of one section, or cells.
struct Range
{
  Index zone = 0;
  Index first = 0; ///< first number in the file
  Index begin = 0; ///< start in the arrays
  Index count = 0;
  Index code = 0;
};

/// A zone of faces and its properties.
struct FaceZone
{
  Index id = 0;
  Index code = 0;
  std::vector<Index> faces; ///< indices in the arrays
};

struct PeriodicPair
{
  Index zone = 0, shadow = 0;
  std::vector<std::pair<Index, Index>> faces; ///< numbers in the file
};

/// All data of a file, in its order.
struct Contents
{
  std::optional<int> dimension;
  std::vector<double> points;
  std::vector<Range> faceRanges, cellRanges;
  std::vector<Index> offsets = { 0 }, nodes;
  std::vector<std::array<Index, 2>> sides; ///< the cells of a face, from 0; -1 for none
  std::map<Index, std::pair<std::string, std::string>> names; ///< type and name by zone
  std::vector<PeriodicPair> periodic;
  Index declaredNodes = -1, declaredFaces = -1, cells = -1;

  Index size(Index face) const { return this->offsets[at(face) + 1] - this->offsets[at(face)]; }
};

class FluentParser
{
public:
  explicit FluentParser(const FileContent& file)
    : Cursor(file)
    , Bytes(static_cast<Index>(this->Cursor.bytesLeft()))
  {
  }

  Contents read()
  {
    FluentSection section;
    while (this->Cursor.nextSection(section))
    {
      this->readSection(section);
    }
    this->check();
    return std::move(this->Found);
  }

private:
  void readSection(const FluentSection& section)
  {
    switch (section.kind)
    {
      case Dimension:
        this->readDimension(section);
        break;
      case Machine:
        this->readMachine(section);
        break;
      case Nodes:
        this->readNodes(section);
        break;
      case Cells:
        this->readCells(section);
        break;
      case Faces:
        this->readFaces(section);
        break;
      case PeriodicFaces:
        this->readPeriodic(section);
        break;
      case ZoneOfMesher:
      case ZoneOfSolver:
        this->readZone(section);
        break;
      case CellTree:
      case FaceTree:
        this->Cursor.failIn(section.begin, HangingNodes);
      case InterfaceParents:
      case InterfaceFaces:
        this->Cursor.failIn(section.begin, Interfaces);
      default:
        this->Cursor.skipSection(section);
    }
  }

  void readDimension(const FluentSection& section)
  {
    const Index dimension = this->Cursor.decimal("the dimension");
    if ((dimension != 2 && dimension != 3) ||
      this->Found.dimension.value_or(dimension) != dimension)
    {
      this->Cursor.failIn(section.begin, "the dimension is " + std::to_string(dimension));
    }
    this->Found.dimension = static_cast<int>(dimension);
    this->Cursor.closeSection(section, "the dimension");
  }

  /// The byte order: the first number is the character '<' or '>'.
  void readMachine(const FluentSection& section)
  {
    this->Cursor.expect('(', "the section of the machine");
    this->Cursor.setSwap(this->Cursor.decimal("the order of bytes") != '<');
    this->Cursor.skipSection(section); // the parenthesis of the list
    this->Cursor.closeSection(section, "the section of the machine");
  }

  /// Zone, first and last number, and further numbers, which are 0 if missing.
  std::vector<Index> header(const FluentSection& section, const char* what, Range& range)
  {
    constexpr std::size_t needed = 3, most = 5;
    std::vector<Index> numbers = this->Cursor.header(what, needed);
    numbers.resize(std::max(numbers.size(), most), 0);
    range.zone = numbers[0];
    range.first = numbers[1];
    range.count = std::max<Index>(numbers[2] - numbers[1] + 1, 0);
    if (range.zone > 0 && range.count > 0 && range.first < 1)
    {
      this->Cursor.failIn(section.begin, std::string(what) + " begins at 0");
    }
    return numbers;
  }

  int dimension(const FluentSection& section) const
  {
    if (!this->Found.dimension)
    {
      this->Cursor.failIn(section.begin, "there is no section 2, the dimension, before this one");
    }
    return *this->Found.dimension;
  }

  void readNodes(const FluentSection& section)
  {
    constexpr std::size_t fewestBytes = 2; // a digit and a space
    Range range;
    const Index last = this->header(section, "a section of nodes", range)[2];
    if (range.zone == 0)
    {
      this->Found.declaredNodes = last;
    }
    if (range.zone == 0 || !this->Cursor.openBody())
    {
      this->Cursor.closeSection(section, "a section of nodes");
      return;
    }
    const int dimension = this->dimension(section);
    if (last < range.first || range.first < 1)
    {
      this->Cursor.failIn(section.begin,
        "nodes " + std::to_string(range.first) + " to " + std::to_string(last) + " are no range");
    }
    if (last > this->Bytes)
    {
      this->Cursor.failIn(section.begin,
        "the last node is " + std::to_string(last) + ", more than the file can have");
    }
    this->Cursor.expectRoom(
      range.count * dimension, section.binary ? section.realBytes : fewestBytes, "coordinates");
    std::vector<double>& points = this->Found.points;
    points.resize(std::max(points.size(), at(3 * (range.first - 1 + range.count))),
      std::numeric_limits<double>::quiet_NaN());
    for (Index i = 0; i < range.count; ++i)
    {
      this->Cursor.countRecord();
      double* point = points.data() + 3 * (range.first - 1 + i);
      if (!std::isnan(point[0]))
      {
        this->Cursor.failHere("there are two nodes " + std::to_string(range.first + i));
      }
      point[2] = 0.0;
      for (int axis = 0; axis < dimension; ++axis)
      {
        point[axis] = this->Cursor.real(section, "a coordinate");
      }
    }
    this->Cursor.closeBody(section, "the nodes");
  }

  void readCells(const FluentSection& section)
  {
    Range range;
    const std::vector<Index> numbers = this->header(section, "a section of cells", range);
    if (range.zone == 0)
    {
      this->Found.cells = numbers[2];
    }
    else
    {
      if (numbers[3] == InactiveCells)
      {
        this->Cursor.failIn(section.begin, HangingNodes);
      }
      this->Found.cellRanges.push_back(range);
    }
    if (this->Cursor.openBody()) // cell types, which also follow from the faces
    {
      const Index mixed = range.zone > 0 && numbers[4] == Mixed ? range.count : 0;
      for (Index i = 0; i < mixed; ++i)
      {
        this->Cursor.countRecord();
        this->Cursor.whole(section, "a type of cell", 0, std::numeric_limits<std::int32_t>::max());
      }
      this->Cursor.expect(')', "the types of cells");
    }
    if (section.binary)
    {
      this->Cursor.closeSection(section, "a section of cells");
    }
    else
    {
      this->Cursor.skipSection(section); // foamMeshToFluent appends an empty list
    }
  }

  void readFaces(const FluentSection& section)
  {
    Range range;
    const std::vector<Index> numbers = this->header(section, "a section of faces", range);
    if (range.zone == 0)
    {
      this->Found.declaredFaces = numbers[2];
    }
    if (range.zone == 0 || !this->Cursor.openBody())
    {
      this->Cursor.closeSection(section, "a section of faces");
      return;
    }
    range.code = numbers[3];
    const Index kind = numbers[4];
    if (range.code == ParentFaces)
    {
      this->Cursor.failIn(section.begin, HangingNodes);
    }
    const bool listed = kind == Mixed || kind == Polygonal;
    const bool planar = this->dimension(section) == 2;
    const Index fewest = planar ? Linear : Linear + 1;
    const Index most = planar ? Linear : std::numeric_limits<std::int32_t>::max();
    if (!listed && (kind < fewest || kind > std::min(most, Polygonal - 1)))
    {
      this->Cursor.failIn(section.begin,
        "faces of type " + std::to_string(kind) + " in a mesh of " +
          std::to_string(*this->Found.dimension) + " dimensions");
    }
    const std::size_t fewestBytes = section.binary ? sizeof(std::int32_t) : 2;
    this->Cursor.expectRoom(range.count * (fewest + 2), fewestBytes, "faces");
    range.begin = static_cast<Index>(this->Found.sides.size());
    for (Index i = 0; i < range.count; ++i)
    {
      this->Cursor.countRecord();
      const Index size =
        listed ? this->Cursor.whole(section, "the number of a face's nodes", fewest, most) : kind;
      this->Cursor.expectRoom(size, fewestBytes, "the nodes of a face");
      this->readFace(section, size);
    }
    this->Found.faceRanges.push_back(range);
    this->Cursor.closeBody(section, "the faces");
  }

  void readFace(const FluentSection& section, Index size)
  {
    constexpr Index most = std::numeric_limits<std::int32_t>::max();
    const Index nodes = this->Found.declaredNodes >= 0 ? this->Found.declaredNodes : most;
    const Index cells = this->Found.cells >= 0 ? this->Found.cells : most;
    const char* const begin = this->Cursor.place();
    for (Index k = 0; k < size; ++k)
    {
      this->Found.nodes.push_back(this->Cursor.whole(section, "a node", 1, nodes) - 1);
    }
    if (this->hasTwice(this->Found.nodes.data() + this->Found.offsets.back(), size))
    {
      this->Cursor.failIn(begin, "a face has the same node twice");
    }
    this->Found.offsets.push_back(static_cast<Index>(this->Found.nodes.size()));
    const Index first = this->Cursor.whole(section, "a cell", 0, cells) - 1;
    this->Found.sides.push_back({ first, this->Cursor.whole(section, "a cell", 0, cells) - 1 });
    if (first >= 0 && first == this->Found.sides.back()[1])
    {
      this->Cursor.failIn(begin, "a face has the same cell on both sides");
    }
  }

  bool hasTwice(const Index* nodes, Index size)
  {
    this->Sorted.assign(nodes, nodes + size);
    std::sort(this->Sorted.begin(), this->Sorted.end());
    return std::adjacent_find(this->Sorted.begin(), this->Sorted.end()) != this->Sorted.end();
  }

  void readPeriodic(const FluentSection& section)
  {
    constexpr Index most = std::numeric_limits<std::int32_t>::max();
    constexpr std::size_t needed = 4;
    const std::vector<Index> numbers = this->Cursor.header("a section of periodic faces", needed);
    PeriodicPair pair{ numbers[2], numbers[3], {} };
    if (this->Cursor.openBody())
    {
      for (Index i = numbers[0]; i <= numbers[1]; ++i)
      {
        this->Cursor.countRecord();
        const Index face = this->Cursor.whole(section, "a periodic face", 1, most);
        pair.faces.emplace_back(face, this->Cursor.whole(section, "a shadow face", 1, most));
      }
      this->Cursor.expect(')', "the periodic faces");
    }
    this->Cursor.closeSection(section, "a section of periodic faces");
    this->Found.periodic.push_back(std::move(pair));
  }

  /// Reads (39 (number type name ...) ...), with a decimal number.
  void readZone(const FluentSection& section)
  {
    this->Cursor.expect('(', "a section of a zone");
    const Index zone = this->Cursor.decimal("the number of a zone");
    std::string type = this->Cursor.name();
    this->Found.names[zone] = { std::move(type), this->Cursor.name() };
    this->Cursor.skipSection(section); // the parenthesis with the name
    this->Cursor.skipSection(section);
  }

  void check()
  {
    Contents& found = this->Found;
    const auto nodes = static_cast<Index>(found.points.size() / 3);
    const auto faces = static_cast<Index>(found.sides.size());
    for (const auto& [what, declared, read] :
      { std::tuple("nodes", found.declaredNodes, nodes), { "faces", found.declaredFaces, faces } })
    {
      if (declared >= 0 && declared != read)
      {
        this->Cursor.failHere("the file has " + std::to_string(read) + " " + what +
          " and declares " + std::to_string(declared) + ": it is truncated or damaged");
      }
    }
    for (Index i = 0; i < nodes; ++i)
    {
      if (std::isnan(found.points[at(3 * i)]))
      {
        this->Cursor.failHere("node " + std::to_string(i + 1) + " is missing");
      }
    }
    const auto highest = std::max_element(found.nodes.begin(), found.nodes.end());
    if (highest != found.nodes.end() && *highest >= nodes)
    {
      this->Cursor.failHere(
        "a face has node " + std::to_string(*highest + 1) + "; there are " + std::to_string(nodes));
    }
    this->checkCells();
  }

  void checkCells()
  {
    Contents& found = this->Found;
    Index last = 0;
    for (const std::array<Index, 2>& sides : found.sides)
    {
      last = std::max({ last, sides[0] + 1, sides[1] + 1 });
    }
    if (last == 0)
    {
      this->Cursor.failHere(found.sides.empty()
          ? "the file has no faces: it is not a Fluent mesh"
          : "no face has a cell: it is a surface mesh. Save the volume mesh");
    }
    found.cells = found.cells < 0 ? last : found.cells;
    if (found.cells > 2 * static_cast<Index>(found.sides.size()))
    {
      this->Cursor.failHere("the file declares " + std::to_string(found.cells) + " cells and has " +
        std::to_string(found.sides.size()) + " faces");
    }
    if (last > found.cells) // the declaration follows the faces
    {
      this->Cursor.failHere("a face has cell " + std::to_string(last) + "; the file declares " +
        std::to_string(found.cells));
    }
    for (const Range& range : found.cellRanges)
    {
      if (range.first - 1 + range.count > found.cells)
      {
        this->Cursor.failHere("zone " + std::to_string(range.zone) + " has cells above " +
          std::to_string(found.cells) + ", their declared number");
      }
    }
  }

  FluentCursor Cursor;
  Index Bytes; ///< size of the file, a bound on the number of nodes
  Contents Found;
  std::vector<Index> Sorted; ///< the nodes of a face
};

/// Orders the faces of a file as in FoamMesh.
class FluentArrangement
{
public:
  explicit FluentArrangement(Contents contents)
    : Found(std::move(contents))
  {
  }

  FluentMesh make()
  {
    FoamMesh& mesh = this->Made.mesh;
    this->Made.dimension = *this->Found.dimension;
    mesh.cells = this->Found.cells;
    this->listZones();
    for (const PeriodicPair& pair : this->Found.periodic)
    {
      this->orderPair(pair);
    }
    this->addInternal();
    for (const FaceZone& zone : this->Zones)
    {
      this->addPatch(zone);
    }
    for (const Range& range : this->Found.cellRanges)
    {
      const auto [place, added] = this->CellZones.emplace(range.zone, mesh.cellZones.size());
      if (added)
      {
        mesh.cellZones.push_back({ this->nameOf(range.zone), {} });
      }
      std::vector<Index>& members = mesh.cellZones[place->second].members;
      members.resize(members.size() + at(range.count));
      std::iota(members.end() - range.count, members.end(), range.first - 1);
    }
    mesh.points = std::move(this->Found.points);
    return std::move(this->Made);
  }

private:
  bool internal(Index face) const
  {
    const std::array<Index, 2>& sides = this->Found.sides[at(face)];
    return sides[0] >= 0 && sides[1] >= 0;
  }
  Index ownerOf(Index face) const
  {
    const std::array<Index, 2>& sides = this->Found.sides[at(face)];
    return this->internal(face) ? std::min(sides[0], sides[1]) : std::max(sides[0], sides[1]);
  }
  std::string nameOf(Index zone) const
  {
    const auto found = this->Found.names.find(zone);
    return found == this->Found.names.end() || found->second.second.empty()
      ? "zone " + std::to_string(zone)
      : found->second.second;
  }

  void listZones()
  {
    std::map<Index, std::size_t> places;
    Index without = 0;
    for (const Range& range : this->Found.faceRanges)
    {
      const auto [place, added] = places.emplace(range.zone, this->Zones.size());
      if (added)
      {
        this->Zones.push_back({ range.zone, range.code, {} });
      }
      for (Index face = range.begin; face < range.begin + range.count; ++face)
      {
        this->Zones[place->second].faces.push_back(face);
        without += this->ownerOf(face) < 0;
      }
    }
    if (without > 0)
    {
      this->Made.warnings.push_back(std::to_string(without) +
        " faces without a cell are left out: they are surfaces beside the mesh");
    }
  }

  /// The index of a face by its number in the file; -1 if there is none.
  Index placeOf(Index number) const
  {
    for (const Range& range : this->Found.faceRanges)
    {
      if (number >= range.first && number < range.first + range.count)
      {
        return range.begin + number - range.first;
      }
    }
    return -1;
  }

  FaceZone* zone(Index id)
  {
    const auto found = std::find_if(
      this->Zones.begin(), this->Zones.end(), [id](const FaceZone& zone) { return zone.id == id; });
    return found == this->Zones.end() ? nullptr : &*found;
  }

  /// Sorts the faces of two periodic zones in the order of their list.
  void orderPair(const PeriodicPair& pair)
  {
    FaceZone *one = this->zone(pair.zone), *other = this->zone(pair.shadow);
    std::vector<Index> first, second;
    for (const auto& [face, shadow] : pair.faces)
    {
      first.push_back(this->placeOf(face));
      second.push_back(this->placeOf(shadow));
    }
    const auto covers = [](std::vector<Index> faces, const FaceZone* zone)
    {
      std::vector<Index> expected = zone ? zone->faces : std::vector<Index>();
      std::sort(faces.begin(), faces.end());
      std::sort(expected.begin(), expected.end());
      return zone && faces == expected;
    };
    if (covers(first, one) && covers(second, other))
    {
      one->faces = std::move(first);
      other->faces = std::move(second);
      this->Partners[pair.zone] = pair.shadow;
      this->Partners[pair.shadow] = pair.zone;
    }
    else
    {
      this->Made.warnings.push_back("the periodic zones " + this->nameOf(pair.zone) + " and " +
        this->nameOf(pair.shadow) +
        " are read as ordinary boundaries: the list of their faces does not fit them");
    }
  }

  /// Appends a face. Fluent's normals point to the first cell; in the plane it is on the left.
  void addFace(Index face)
  {
    FoamMesh& mesh = this->Made.mesh;
    const Index owner = this->ownerOf(face);
    const auto begin = this->Found.nodes.begin() + this->Found.offsets[at(face)];
    const auto end = begin + this->Found.size(face);
    mesh.facePoints.insert(mesh.facePoints.end(), begin, end);
    const bool ofFirst = this->Found.sides[at(face)][0] == owner;
    if (ofFirst == (this->Made.dimension == 3))
    {
      const Index kept = this->Made.dimension == 3 ? 1 : 0; // the first point
      std::reverse(mesh.facePoints.end() - (end - begin) + kept, mesh.facePoints.end());
    }
    mesh.faceOffsets.push_back(static_cast<Index>(mesh.facePoints.size()));
    mesh.owner.push_back(owner);
  }

  void addInternal()
  {
    struct Entry
    {
      Index owner, neighbor, face;
      const FaceZone* zone;
    };
    std::vector<Entry> entries;
    for (const FaceZone& zone : this->Zones)
    {
      for (const Index face : zone.faces)
      {
        if (this->internal(face))
        {
          const std::array<Index, 2>& sides = this->Found.sides[at(face)];
          entries.push_back(
            { std::min(sides[0], sides[1]), std::max(sides[0], sides[1]), face, &zone });
        }
      }
    }
    std::stable_sort(entries.begin(), entries.end(),
      [](const Entry& a, const Entry& b)
      { return std::pair(a.owner, a.neighbor) < std::pair(b.owner, b.neighbor); });
    FoamMesh& mesh = this->Made.mesh;
    std::map<const FaceZone*, std::vector<Index>> named;
    for (const Entry& entry : entries)
    {
      pollInterruption(mesh.numberOfFaces());
      if (entry.zone->code != Interior)
      {
        named[entry.zone].push_back(mesh.numberOfFaces());
      }
      this->addFace(entry.face);
      mesh.neighbor.push_back(entry.neighbor);
    }
    for (const FaceZone& zone : this->Zones)
    {
      if (const auto found = named.find(&zone); found != named.end())
      {
        mesh.faceZones.push_back({ this->nameOf(zone.id), std::move(found->second) });
      }
    }
  }

  void addPatch(const FaceZone& zone)
  {
    FoamMesh& mesh = this->Made.mesh;
    FoamPatch patch;
    patch.start = mesh.numberOfFaces();
    for (const Index face : zone.faces)
    {
      if (!this->internal(face) && this->ownerOf(face) >= 0)
      {
        this->addFace(face);
      }
    }
    patch.size = mesh.numberOfFaces() - patch.start;
    if (patch.size == 0)
    {
      return;
    }
    patch.name = this->nameOf(zone.id);
    const auto found = this->Found.names.find(zone.id);
    patch.type = found == this->Found.names.end() ? typeOf(zone.code) : found->second.first;
    if (const auto partner = this->Partners.find(zone.id); partner != this->Partners.end())
    {
      patch.type = "cyclic";
      patch.neighbor = this->nameOf(partner->second);
    }
    mesh.patches.push_back(std::move(patch));
  }

  Contents Found;
  FluentMesh Made;
  std::vector<FaceZone> Zones;
  std::map<Index, std::size_t> CellZones;
  std::map<Index, Index> Partners;
};

/// Twice the total signed area of all polygons, negative if most run clockwise.
double orientation(const FoamMesh& mesh, const FoamCells& cells)
{
  double sum = 0.0;
  for (std::size_t cell = 0; cell < cells.types.size(); ++cell)
  {
    const Index begin = cells.offsets[cell], end = cells.offsets[cell + 1];
    for (Index i = begin; i < end; ++i)
    {
      const double* a = mesh.points.data() + 3 * cells.connectivity[at(i)];
      const double* b =
        mesh.points.data() + 3 * cells.connectivity[at(i + 1 < end ? i + 1 : begin)];
      sum += a[0] * b[1] - a[1] * b[0];
    }
  }
  return sum;
}

/// The polygons of a mesh in the plane.
FoamCells polygonsOf(const FoamMesh& mesh)
{
  FoamCells cells;
  cells.cellFaces = cellFacesOf(mesh);
  std::vector<std::array<Index, 2>> edges;
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    pollInterruption(cell);
    edges.clear();
    for (Index i = cells.cellFaces.offsets[at(cell)]; i < cells.cellFaces.offsets[at(cell) + 1];
         ++i)
    {
      const Index face = cells.cellFaces.faces[at(i)];
      const Index* points = mesh.facePoints.data() + mesh.faceOffsets[at(face)];
      const bool left = mesh.owner[at(face)] == cell;
      edges.push_back({ points[left ? 0 : 1], points[left ? 1 : 0] });
    }
    const auto open = [&](const std::string& why) -> FoamDefect
    {
      const Index first = cells.cellFaces.offsets[at(cell)];
      return { "owner", edges.empty() ? 0 : cells.cellFaces.faces[at(first)],
        "cell " + std::to_string(cell) + why };
    };
    if (edges.size() < 3)
    {
      throw open(" has " + std::to_string(edges.size()) + " faces; at least 3 are needed");
    }
    for (std::size_t i = 0; i < edges.size(); ++i) // each edge after its predecessor
    {
      cells.connectivity.push_back(edges[i][0]);
      const Index end = edges[i][1];
      const auto next = std::find_if(edges.begin() + static_cast<std::ptrdiff_t>(i) + 1,
        edges.end(), [end](const std::array<Index, 2>& edge) { return edge[0] == end; });
      const bool last = i + 1 == edges.size();
      if (last ? end != edges[0][0] : next == edges.end())
      {
        throw open(" is open: its faces do not run around it");
      }
      if (!last)
      {
        std::swap(edges[i + 1], *next);
      }
    }
    cells.types.push_back(edges.size() == 3 ? FileTriangle
        : edges.size() == 4                 ? FileQuadrilateral
                                            : FilePolygon);
    cells.offsets.push_back(static_cast<Index>(cells.connectivity.size()));
  }
  const bool clockwise = orientation(mesh, cells) < 0.0;
  for (std::size_t cell = 0; clockwise && cell < cells.types.size(); ++cell)
  {
    std::reverse(cells.connectivity.begin() + cells.offsets[cell],
      cells.connectivity.begin() + cells.offsets[cell + 1]);
  }
  return cells;
}
}

//------------------------------------------------------------------------------
bool isFluentFile(const std::string& name)
{
  const std::string start = firstWord(name);
  return start.size() > 1 && start[0] == '(' && start[1] >= '0' && start[1] <= '9';
}

//------------------------------------------------------------------------------
FluentMesh readFluent(const std::string& name)
{
  const FileContent file(name);
  if (file.begin() == file.end())
  {
    throw FileError(name + ": the file is empty");
  }
  return FluentArrangement(FluentParser(file).read()).make();
}

//------------------------------------------------------------------------------
FoamCells fluentCells(const FoamMesh& mesh, int dimension)
{
  return dimension == 2 ? polygonsOf(mesh) : cellsOf(mesh);
}
}
