// SPDX-License-Identifier: BSD-3-Clause
#include "FoamProcessors.h"

#include "ArrayIndex.h"
#include "FoamFile.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace tautline
{
namespace
{
/// The largest difference between the sides of a seam, as a fraction of the diagonal of the points.
constexpr double SeamTolerance = 1e-6;

/// The files of addresses, in the order of the members of FoamAddresses.
constexpr const char* AddressFiles[] = { "pointProcAddressing", "cellProcAddressing",
  "faceProcAddressing", "boundaryProcAddressing" };

std::vector<Index> readAddresses(const std::string& folder, const char* name)
{
  constexpr Index Most = Index{ 1 } << 43; // more than any mesh has; sums do not overflow
  const FoamContent content(folder + "/" + name);
  FoamCursor cursor(content.text());
  std::vector<Index> found =
    cursor.labels(name, -Most, Most, static_cast<Index>(cursor.bytesLeft()));
  cursor.expectEnd("its list of labels");
  return found;
}

std::vector<Index> mapped(const std::vector<Index>& members, const std::vector<Index>& numbers)
{
  std::vector<Index> result(members.size());
  std::transform(members.begin(), members.end(), result.begin(),
    [&numbers](Index member) { return numbers[at(member)]; });
  return result;
}

/// Appends a face of a mesh with renumbered points; a reversed face starts at the same point.
void appendFace(const FoamMesh& from, Index face, const std::vector<Index>& pointNumbers,
  bool reversed, FoamMesh& to)
{
  const auto begin = from.facePoints.begin() + from.faceOffsets[at(face)];
  const auto end = from.facePoints.begin() + from.faceOffsets[at(face) + 1];
  const auto first = to.facePoints.size();
  std::transform(begin, end, std::back_inserter(to.facePoints),
    [&pointNumbers](Index point) { return pointNumbers[at(point)]; });
  if (reversed)
  {
    std::reverse(
      to.facePoints.begin() + static_cast<std::ptrdiff_t>(first) + 1, to.facePoints.end());
  }
  to.faceOffsets.push_back(static_cast<Index>(to.facePoints.size()));
}

/// The mesh of the undecomposed case from the addresses of its parts.
class Composition
{
public:
  Composition(const std::vector<FoamProcessor>& processors, FoamPiece& whole)
    : Processors(processors)
    , Whole(whole)
  {
  }

  std::string compose()
  {
    for (const auto step : { &Composition::findSizes, &Composition::findPatches,
           &Composition::placeFaces, &Composition::checkFaces, &Composition::makeMesh })
    {
      const std::string problem = (this->*step)();
      if (!problem.empty())
      {
        return problem;
      }
    }
    return {};
  }

private:
  struct Face
  {
    int processor = -1;
    Index face = 0;
    Index owner = -1;
    Index neighbor = -1;
    int patch = -1;
    bool reversed = false;
  };

  /// One more than the largest of nonnegative numbers; -1 if there are negative numbers, or if they
  /// exceed the total count.
  template <class Get>
  Index range(const Get& get) const
  {
    Index least = 0, most = -1, count = 0;
    for (const FoamProcessor& each : this->Processors)
    {
      for (const Index number : get(each.addresses))
      {
        least = std::min(least, number);
        most = std::max(most, number);
        ++count;
      }
    }
    return least < 0 || most >= count ? -1 : most + 1;
  }

  std::string findSizes()
  {
    for (const FoamProcessor& each : this->Processors)
    {
      if (static_cast<Index>(each.addresses.points.size()) != each.mesh.numberOfPoints() ||
        static_cast<Index>(each.addresses.cells.size()) != each.mesh.cells ||
        static_cast<Index>(each.addresses.faces.size()) != each.mesh.numberOfFaces() ||
        each.addresses.patches.size() != each.mesh.patches.size())
      {
        return "the mesh in " + each.folder + " does not have the sizes of its addresses";
      }
    }
    this->Points = this->range([](const FoamAddresses& a) -> auto& { return a.points; });
    this->Whole.mesh.cells = this->range([](const FoamAddresses& a) -> auto& { return a.cells; });
    Index most = 0, count = 0;
    for (const FoamProcessor& each : this->Processors)
    {
      for (const Index number : each.addresses.faces)
      {
        most = std::max(most, std::abs(number));
        count += 1;
      }
    }
    if (this->Points < 0 || this->Whole.mesh.cells < 0 || most > count)
    {
      return "the addresses have gaps";
    }
    this->Faces.resize(at(most));
    return {};
  }

  std::string findPatches()
  {
    constexpr Index MostPatches = 1 << 20;
    std::vector<FoamPatch>& patches = this->Whole.mesh.patches;
    for (const FoamProcessor& each : this->Processors)
    {
      for (std::size_t i = 0; i < each.mesh.patches.size(); ++i)
      {
        const Index number = each.addresses.patches[i];
        if (number >= MostPatches)
        {
          return "a patch has number " + std::to_string(number);
        }
        if (number >= 0)
        {
          patches.resize(std::max(patches.size(), at(number) + 1));
          patches[at(number)] = each.mesh.patches[i];
        }
      }
    }
    for (FoamPatch& patch : patches)
    {
      if (patch.type.empty())
      {
        return "no processor has the name of a patch";
      }
      patch.size = 0;
    }
    return {};
  }

  /// The number of the faces' patch in the whole mesh; -1 if they are internal.
  int patchOf(const FoamProcessor& processor, std::size_t patch) const
  {
    const Index number = processor.addresses.patches[patch];
    const std::string& name = processor.mesh.patches[patch].whole;
    const auto& patches = this->Whole.mesh.patches;
    const auto found = std::find_if(
      patches.begin(), patches.end(), [&name](const FoamPatch& each) { return each.name == name; });
    return number >= 0                          ? static_cast<int>(number)
      : !name.empty() && found != patches.end() ? static_cast<int>(found - patches.begin())
                                                : -1;
  }

  bool place(int processor, Index local, int patch, bool seam)
  {
    const FoamProcessor& from = this->Processors[static_cast<std::size_t>(processor)];
    const Index address = from.addresses.faces[at(local)];
    if (address == 0)
    {
      return false;
    }
    Face& face = this->Faces[at(std::abs(address) - 1)];
    const Index owner = from.addresses.cells[at(from.mesh.owner[at(local)])];
    if (seam && address < 0)
    {
      return std::exchange(face.neighbor, owner) < 0;
    }
    const bool internal = local < from.mesh.numberOfInternalFaces();
    if (face.processor >= 0 || (internal && (face.neighbor >= 0 || address < 0)))
    {
      return false;
    }
    const Index neighbor =
      internal ? from.addresses.cells[at(from.mesh.neighbor[at(local)])] : face.neighbor;
    face = { processor, local, owner, neighbor, patch, address < 0 };
    return true;
  }

  std::string placeFaces()
  {
    for (std::size_t p = 0; p < this->Processors.size(); ++p)
    {
      const FoamMesh& mesh = this->Processors[p].mesh;
      bool placed = true;
      for (Index face = 0; face < mesh.numberOfInternalFaces(); ++face)
      {
        pollInterruption(face);
        placed = placed && this->place(static_cast<int>(p), face, -1, false);
      }
      for (std::size_t i = 0; i < mesh.patches.size(); ++i)
      {
        const FoamPatch& patch = mesh.patches[i];
        const int number = this->patchOf(this->Processors[p], i);
        const bool seam = patch.betweenProcessors();
        placed = placed && (seam || number >= 0);
        for (Index face = patch.start; placed && face < patch.start + patch.size; ++face)
        {
          pollInterruption(face);
          placed = this->place(static_cast<int>(p), face, seam ? -1 : number, seam);
        }
      }
      if (!placed)
      {
        return "the addresses of the faces in " + this->Processors[p].folder + " are inconsistent";
      }
    }
    return {};
  }

  std::string checkFaces()
  {
    int patch = -1;
    for (std::size_t i = 0; i < this->Faces.size(); ++i)
    {
      const Face& face = this->Faces[i];
      const bool internal = face.patch < 0;
      if (face.processor < 0 || face.patch < patch ||
        (internal ? face.owner >= face.neighbor : face.neighbor >= 0))
      {
        return "face " + std::to_string(i) + " of the undecomposed mesh is missing or out of order";
      }
      patch = face.patch;
    }
    return {};
  }

  std::string makeMesh()
  {
    FoamMesh& mesh = this->Whole.mesh;
    mesh.points.resize(3 * at(this->Points));
    std::vector<char> placed(at(this->Points));
    for (const FoamProcessor& each : this->Processors)
    {
      for (std::size_t i = 0; i < each.addresses.points.size(); ++i)
      {
        const auto point = at(each.addresses.points[i]);
        placed[point] = 1;
        std::copy_n(each.mesh.points.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
          mesh.points.begin() + static_cast<std::ptrdiff_t>(3 * point));
      }
      this->Whole.pointNumbers.push_back(each.addresses.points);
      this->addZones(each);
    }
    if (std::count(placed.begin(), placed.end(), 0) > 0)
    {
      return "the addresses of the points have gaps";
    }
    for (const Face& face : this->Faces)
    {
      pollInterruption(mesh.numberOfFaces());
      const FoamProcessor& from = this->Processors[static_cast<std::size_t>(face.processor)];
      appendFace(from.mesh, face.face, from.addresses.points, face.reversed, mesh);
      mesh.owner.push_back(face.owner);
      if (face.patch < 0)
      {
        mesh.neighbor.push_back(face.neighbor);
      }
      else
      {
        ++mesh.patches[static_cast<std::size_t>(face.patch)].size;
      }
    }
    Index next = mesh.numberOfInternalFaces();
    for (FoamPatch& patch : mesh.patches)
    {
      patch.start = std::exchange(next, next + patch.size);
    }
    return {};
  }

  void addZones(const FoamProcessor& from)
  {
    for (const FoamZone& zone : from.mesh.cellZones)
    {
      addZone(this->Whole.mesh.cellZones, zone.name, mapped(zone.members, from.addresses.cells));
    }
    std::vector<Index> faces(from.addresses.faces);
    for (Index& face : faces)
    {
      face = std::abs(face) - 1;
    }
    for (const FoamZone& zone : from.mesh.faceZones)
    {
      addZone(this->Whole.mesh.faceZones, zone.name, mapped(zone.members, faces));
    }
  }

  const std::vector<FoamProcessor>& Processors;
  FoamPiece& Whole;
  Index Points = 0;
  std::vector<Face> Faces;
};

/// Sets of merged points.
class PointSets
{
public:
  explicit PointSets(std::size_t count)
    : Parent(count)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), Index{ 0 });
  }
  Index first(Index point)
  {
    while (this->Parent[at(point)] != point)
    {
      Index& parent = this->Parent[at(point)];
      parent = this->Parent[at(parent)];
      point = parent;
    }
    return point;
  }
  void unite(Index a, Index b)
  {
    const Index first = this->first(a), second = this->first(b);
    this->Parent[at(std::max(first, second))] = std::min(first, second);
  }

private:
  std::vector<Index> Parent;
};

/// Joins the meshes of processors into one mesh.
class Join
{
public:
  Join(const std::vector<FoamProcessor>& processors, FoamSeams seams, FoamMesh& joined)
    : Processors(processors)
    , Sewn(seams == FoamSeams::Sewn)
    , Mesh(joined)
  {
    Index points = 0, cells = 0;
    for (const FoamProcessor& each : processors)
    {
      this->FirstPoint.push_back(points);
      this->Numbers.firstCell.push_back(cells);
      points += each.mesh.numberOfPoints();
      cells += each.mesh.cells;
      this->Numbers.faces.emplace_back(at(each.mesh.numberOfFaces()));
    }
    joined.cells = cells;
    this->Points = points;
  }

  FoamNumbers join()
  {
    this->findInternalFaces();
    this->findSeams();
    this->numberPoints();
    if (this->Sewn)
    {
      std::stable_sort(this->Faces.begin(), this->Faces.end(),
        [](const Face& a, const Face& b)
        { return std::tie(a.owner, a.neighbor) < std::tie(b.owner, b.neighbor); });
    }
    for (const Face& face : this->Faces)
    {
      this->Mesh.neighbor.push_back(face.neighbor);
      const Index number = this->add(face.processor, face.face, face.owner);
      if (face.otherProcessor >= 0)
      {
        this->Numbers.faces[static_cast<std::size_t>(face.otherProcessor)][at(face.otherFace)] =
          number;
      }
    }
    this->addPatches();
    this->addZones();
    return std::move(this->Numbers);
  }

private:
  struct Face
  {
    Index owner, neighbor;
    int processor;
    Index face;
    int otherProcessor;
    Index otherFace;
  };

  /// A patch of a processor, as a part of a patch of the joined mesh.
  struct Segment
  {
    std::size_t patch; ///< of the joined mesh
    int first, second; ///< the order in it, the same for both halves of a cyclic patch
    int processor;
    const FoamPatch* part;
  };

  Index globalCell(int processor, Index face) const
  {
    const auto p = static_cast<std::size_t>(processor);
    return this->Numbers.firstCell[p] + this->Processors[p].mesh.owner[at(face)];
  }

  void findInternalFaces()
  {
    for (std::size_t p = 0; p < this->Processors.size(); ++p)
    {
      const FoamMesh& mesh = this->Processors[p].mesh;
      const Index first = this->Numbers.firstCell[p];
      for (Index face = 0; face < mesh.numberOfInternalFaces(); ++face)
      {
        pollInterruption(face);
        this->Faces.push_back({ first + mesh.owner[at(face)], first + mesh.neighbor[at(face)],
          static_cast<int>(p), face, -1, -1 });
      }
    }
  }

  /// The patch on the other side of a seam.
  const FoamPatch& otherSide(int processor, const FoamPatch& patch) const
  {
    const std::string& folder = this->Processors[static_cast<std::size_t>(processor)].folder;
    const auto other = static_cast<std::size_t>(patch.neighborProcessor);
    if (other >= this->Processors.size() || patch.processor != processor)
    {
      throw FileError(folder + "/boundary: patch " + patch.name + " is between processors " +
        std::to_string(patch.processor) + " and " + std::to_string(patch.neighborProcessor) +
        ", this is processor " + std::to_string(processor) + " of " +
        std::to_string(this->Processors.size()));
    }
    for (const FoamPatch& each : this->Processors[other].mesh.patches)
    {
      if (each.betweenProcessors() && each.neighborProcessor == processor)
      {
        if (each.size != patch.size)
        {
          throw FileError(this->Processors[other].folder + "/boundary: patch " + each.name +
            " has " + std::to_string(each.size) + " faces, and patch " + patch.name + " in " +
            folder + " has " + std::to_string(patch.size));
        }
        return each;
      }
    }
    throw FileError(this->Processors[other].folder + "/boundary: has no processor patch to " +
      "processor " + std::to_string(processor) + ", which patch " + patch.name + " in " + folder +
      " needs");
  }

  void findSeams()
  {
    this->Sets = PointSets(at(this->Sewn ? this->Points : 0));
    for (std::size_t p = 0; this->Sewn && p < this->Processors.size(); ++p)
    {
      for (const FoamPatch& patch : this->Processors[p].mesh.patches)
      {
        if (patch.betweenProcessors())
        {
          const FoamPatch& other = this->otherSide(static_cast<int>(p), patch);
          if (patch.processor < patch.neighborProcessor)
          {
            this->sew(patch, other);
          }
        }
      }
    }
  }

  void sew(const FoamPatch& patch, const FoamPatch& other)
  {
    const FoamMesh& a = this->Processors[static_cast<std::size_t>(patch.processor)].mesh;
    const FoamMesh& b = this->Processors[static_cast<std::size_t>(patch.neighborProcessor)].mesh;
    for (Index i = 0; i < patch.size; ++i)
    {
      pollInterruption(i);
      const Index face = patch.start + i, otherFace = other.start + i;
      const Index begin = a.faceOffsets[at(face)], otherBegin = b.faceOffsets[at(otherFace)];
      const Index size = a.faceOffsets[at(face) + 1] - begin;
      bool matches = b.faceOffsets[at(otherFace) + 1] - otherBegin == size;
      for (Index k = 0; matches && k < size; ++k)
      {
        const Index point = a.facePoints[at(begin + k)];
        const Index otherPoint = b.facePoints[at(otherBegin + (k == 0 ? 0 : size - k))];
        matches = this->near(a, point, b, otherPoint);
        this->Sets.unite(this->FirstPoint[static_cast<std::size_t>(patch.processor)] + point,
          this->FirstPoint[static_cast<std::size_t>(patch.neighborProcessor)] + otherPoint);
      }
      if (!matches)
      {
        throw FileError(this->Processors[static_cast<std::size_t>(patch.processor)].folder +
          "/faces: face " + std::to_string(face) + " of patch " + patch.name + " and face " +
          std::to_string(otherFace) + " on the other side have different points");
      }
      this->Faces.push_back({ this->globalCell(patch.processor, face),
        this->globalCell(patch.neighborProcessor, otherFace), patch.processor, face,
        patch.neighborProcessor, otherFace });
    }
  }

  bool near(const FoamMesh& a, Index point, const FoamMesh& b, Index other)
  {
    if (this->Tolerance < 0.0)
    {
      double square = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        double low = std::numeric_limits<double>::max(), high = -low;
        for (const FoamProcessor& each : this->Processors)
        {
          for (std::size_t i = axis; i < each.mesh.points.size(); i += 3)
          {
            low = std::min(low, each.mesh.points[i]);
            high = std::max(high, each.mesh.points[i]);
          }
        }
        square += (high - low) * (high - low);
      }
      this->Tolerance = SeamTolerance * std::sqrt(square);
    }
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double d = a.points[3 * at(point) + axis] - b.points[3 * at(other) + axis];
      square += d * d;
    }
    return std::sqrt(square) <= this->Tolerance;
  }

  void numberPoints()
  {
    std::vector<Index> numbers(at(this->Sewn ? this->Points : 0), -1);
    for (std::size_t p = 0; p < this->Processors.size(); ++p)
    {
      const std::vector<double>& points = this->Processors[p].mesh.points;
      this->Numbers.points.emplace_back();
      for (std::size_t i = 0; 3 * i < points.size(); ++i)
      {
        pollInterruption(static_cast<Index>(i));
        const Index set =
          this->Sewn ? this->Sets.first(this->FirstPoint[p] + static_cast<Index>(i)) : 0;
        Index number = this->Sewn ? numbers[at(set)] : -1;
        if (number < 0)
        {
          number = this->Mesh.numberOfPoints();
          const auto from = points.begin() + static_cast<std::ptrdiff_t>(3 * i);
          this->Mesh.points.insert(this->Mesh.points.end(), from, from + 3);
        }
        if (this->Sewn)
        {
          numbers[at(set)] = number;
        }
        this->Numbers.points[p].push_back(number);
      }
    }
  }

  Index add(int processor, Index face, Index owner)
  {
    pollInterruption(face);
    const auto p = static_cast<std::size_t>(processor);
    const Index number = this->Mesh.numberOfFaces();
    appendFace(this->Processors[p].mesh, face, this->Numbers.points[p], false, this->Mesh);
    this->Mesh.owner.push_back(owner);
    this->Numbers.faces[p][at(face)] = number;
    return number;
  }

  /// The patch of the joined mesh with a given name, created from a part if it is new.
  std::size_t patchNamed(const std::string& name, const FoamPatch& part)
  {
    const auto found = std::find_if(this->Mesh.patches.begin(), this->Mesh.patches.end(),
      [&name](const FoamPatch& each) { return each.name == name; });
    const auto number = static_cast<std::size_t>(found - this->Mesh.patches.begin());
    if (found == this->Mesh.patches.end())
    {
      this->Mesh.patches.push_back(part);
      this->Mesh.patches.back().name = name;
      this->Mesh.patches.back().size = 0;
    }
    return number;
  }

  std::vector<Segment> segments()
  {
    std::vector<Segment> found;
    for (const bool ofProcessors : { false, true }) // whose patches come after the others
    {
      for (std::size_t p = 0; p < this->Processors.size(); ++p)
      {
        for (const FoamPatch& patch : this->Processors[p].mesh.patches)
        {
          if (patch.ofProcessor() != ofProcessors || (this->Sewn && patch.betweenProcessors()))
          {
            continue;
          }
          const bool part = this->Sewn && !patch.whole.empty();
          const std::size_t number = this->patchNamed(part ? patch.whole : patch.name, patch);
          const auto self = static_cast<int>(p);
          found.push_back({ number, self, part ? patch.neighborProcessor : self, self, &patch });
        }
      }
    }
    return found;
  }

  void addPatches()
  {
    std::vector<Segment> found = this->segments();
    for (Segment& segment : found)
    {
      const std::string& neighbor = this->Mesh.patches[segment.patch].neighbor;
      const auto other = std::find_if(this->Mesh.patches.begin(), this->Mesh.patches.end(),
        [&neighbor](const FoamPatch& each) { return each.name == neighbor; });
      if (static_cast<std::size_t>(other - this->Mesh.patches.begin()) < segment.patch)
      {
        std::swap(segment.first, segment.second); // the second half of a cyclic pair
      }
    }
    std::stable_sort(found.begin(), found.end(),
      [](const Segment& a, const Segment& b)
      { return std::tie(a.patch, a.first, a.second) < std::tie(b.patch, b.first, b.second); });
    for (const Segment& segment : found)
    {
      for (Index i = 0; i < segment.part->size; ++i)
      {
        const Index face = segment.part->start + i;
        this->add(segment.processor, face, this->globalCell(segment.processor, face));
      }
      this->Mesh.patches[segment.patch].size += segment.part->size;
    }
    Index next = this->Mesh.numberOfInternalFaces();
    for (FoamPatch& patch : this->Mesh.patches)
    {
      patch.start = std::exchange(next, next + patch.size);
    }
  }

  void addZones()
  {
    for (std::size_t p = 0; p < this->Processors.size(); ++p)
    {
      for (const FoamZone& zone : this->Processors[p].mesh.cellZones)
      {
        std::vector<Index> members(zone.members);
        for (Index& cell : members)
        {
          cell += this->Numbers.firstCell[p];
        }
        addZone(this->Mesh.cellZones, zone.name, std::move(members));
      }
      for (const FoamZone& zone : this->Processors[p].mesh.faceZones)
      {
        addZone(this->Mesh.faceZones, zone.name, mapped(zone.members, this->Numbers.faces[p]));
      }
    }
  }

  const std::vector<FoamProcessor>& Processors;
  bool Sewn;
  FoamMesh& Mesh;
  Index Points = 0;
  std::vector<Index> FirstPoint; ///< for each processor
  FoamNumbers Numbers;
  PointSets Sets{ 0 };
  std::vector<Face> Faces; ///< internal ones
  double Tolerance = -1.0; ///< not measured yet
};
}

//------------------------------------------------------------------------------
bool FoamAddresses::exist(const std::string& folder)
{
  return std::all_of(std::begin(AddressFiles), std::end(AddressFiles),
    [&folder](const char* name) { return foamFileExists(folder + "/" + name); });
}

//------------------------------------------------------------------------------
FoamAddresses FoamAddresses::read(const std::string& folder)
{
  FoamAddresses result;
  std::vector<Index>* lists[] = { &result.points, &result.cells, &result.faces, &result.patches };
  for (std::size_t i = 0; i < std::size(AddressFiles); ++i)
  {
    *lists[i] = readAddresses(folder, AddressFiles[i]);
  }
  return result;
}

//------------------------------------------------------------------------------
void addZone(std::vector<FoamZone>& zones, const std::string& name, std::vector<Index> members)
{
  auto zone = std::find_if(
    zones.begin(), zones.end(), [&name](const FoamZone& each) { return each.name == name; });
  if (zone == zones.end())
  {
    zone = zones.insert(zone, { name, {} });
  }
  members.insert(members.end(), zone->members.begin(), zone->members.end());
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  zone->members = std::move(members);
}

//------------------------------------------------------------------------------
std::string composeByAddresses(const std::vector<FoamProcessor>& processors, FoamPiece& whole)
{
  return Composition(processors, whole).compose();
}

//------------------------------------------------------------------------------
FoamNumbers joinProcessors(
  const std::vector<FoamProcessor>& processors, FoamSeams seams, FoamMesh& joined)
{
  return Join(processors, seams, joined).join();
}
}
