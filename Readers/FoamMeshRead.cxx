// SPDX-License-Identifier: BSD-3-Clause
#include "ArrayIndex.h"
#include "FoamFile.h"
#include "FoamMesh.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace tautline
{
namespace
{
constexpr const char* Purpose = "a file of the mesh";

/// Reads the list of a file again up to the wrong entry, and fails there.
[[noreturn]] void failInFile(const std::string& folder, Index pointCount, const FoamDefect& defect)
{
  constexpr Index Any = std::numeric_limits<Index>::max();
  const FoamContent content(folder + "/" + defect.file, Purpose);
  FoamCursor cursor(content.text(), { defect.entry, defect.problem });
  if (defect.file == "faces")
  {
    std::vector<Index> offsets, points;
    cursor.faces(pointCount, offsets, points);
  }
  else
  {
    cursor.labels(defect.file.c_str(), -1, Any, static_cast<Index>(cursor.bytesLeft()));
  }
  throw FileError(content.packed.name() + ": " + defect.problem); // the file has changed since
}

void readPoints(const std::string& folder, FoamMesh& mesh)
{
  const FoamContent content(folder + "/points", Purpose);
  FoamCursor cursor(content.text());
  mesh.points = cursor.points();
  cursor.expectEnd("its list of points");
}

void readFaces(const std::string& folder, FoamMesh& mesh)
{
  const FoamContent content(folder + "/faces", Purpose);
  FoamCursor cursor(content.text());
  cursor.faces(mesh.numberOfPoints(), mesh.faceOffsets, mesh.facePoints);
  cursor.expectEnd("its list of faces");
}

/// Reads `owner` and `neighbour`; older files have -1 in `neighbour` for the faces of the boundary.
void readCellsOfFaces(const std::string& folder, FoamMesh& mesh)
{
  const auto faces = static_cast<Index>(mesh.faceOffsets.size()) - 1;
  const FoamContent ownerFile(folder + "/owner", Purpose);
  FoamCursor owner(ownerFile.text());
  // a mesh has fewer cells than faces
  mesh.owner = owner.labels("owner", 0, std::max<Index>(faces - 1, 0), faces);
  owner.expectEnd("its list of labels");
  if (mesh.numberOfFaces() != faces)
  {
    owner.fail("there are " + std::to_string(mesh.owner.size()) + " owners and " +
      std::to_string(faces) + " faces");
  }
  const FoamContent neighborFile(folder + "/neighbour", Purpose);
  FoamCursor neighbor(neighborFile.text());
  mesh.neighbor = neighbor.labels("neighbour", -1, std::max<Index>(faces - 1, 0), faces);
  neighbor.expectEnd("its list of labels");
  while (!mesh.neighbor.empty() && mesh.neighbor.back() < 0)
  {
    mesh.neighbor.pop_back();
  }
  Index last = -1;
  for (const Index cell : mesh.owner)
  {
    last = std::max(last, cell);
  }
  for (std::size_t i = 0; i < mesh.neighbor.size(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    if (mesh.neighbor[i] < 0 || mesh.owner[i] >= mesh.neighbor[i])
    {
      failInFile(folder, mesh.numberOfPoints(),
        { "neighbour", static_cast<Index>(i),
          mesh.neighbor[i] < 0
            ? "face " + std::to_string(i) + " has no neighbor, but later ones have one"
            : "face " + std::to_string(i) + " has owner " + std::to_string(mesh.owner[i]) +
              " and neighbor " + std::to_string(mesh.neighbor[i]) +
              ": the owner of an internal face is the lower cell" });
    }
    last = std::max(last, mesh.neighbor[i]);
  }
  mesh.cells = last + 1;
}

FoamPatch readPatch(FoamCursor& cursor, const std::string& name, const FoamMesh& mesh)
{
  constexpr Index MostProcessors = std::numeric_limits<int>::max();
  const Index faces = mesh.numberOfFaces();
  FoamPatch patch;
  patch.name = name;
  bool sized = false, started = false;
  cursor.skipSpace();
  const char* begin = cursor.place();
  for (std::string key = cursor.keyword(); !key.empty(); key = cursor.keyword())
  {
    const auto processor = [&]
    { return static_cast<int>(cursor.labelValue(key.c_str(), 0, MostProcessors)); };
    if (key == "type")
    {
      patch.type = cursor.value("type");
    }
    else if (key == "nFaces")
    {
      patch.size = cursor.labelValue("nFaces", 0, faces);
      sized = true;
    }
    else if (key == "startFace")
    {
      patch.start = cursor.labelValue("startFace", 0, std::numeric_limits<Index>::max());
      started = true;
    }
    else if (key == "neighbourPatch")
    {
      patch.neighbor = cursor.value("neighbourPatch");
    }
    else if (key == "nonOverlapPatch")
    {
      patch.rest = cursor.value("nonOverlapPatch");
    }
    else if (key == "referPatch")
    {
      patch.whole = cursor.value("referPatch");
    }
    else if (key == "myProcNo")
    {
      patch.processor = processor();
    }
    else if (key == "neighbProcNo")
    {
      patch.neighborProcessor = processor();
    }
    else
    {
      cursor.skipValue();
    }
  }
  if (patch.type.empty() || !sized || !started)
  {
    cursor.failAt(begin,
      "patch " + name + " has no " +
        (patch.type.empty() ? "type"
            : !sized        ? "nFaces"
                            : "startFace"));
  }
  return patch;
}

void readBoundary(const std::string& folder, FoamMesh& mesh)
{
  const FoamContent content(folder + "/boundary", Purpose);
  FoamCursor cursor(content.text());
  Index next = mesh.numberOfInternalFaces();
  std::unordered_map<std::string, int> numbers;
  cursor.dictionaries("patches",
    [&](const std::string& name)
    {
      const char* begin = cursor.place();
      FoamPatch patch = readPatch(cursor, name, mesh);
      if (!numbers.emplace(name, static_cast<int>(mesh.patches.size())).second)
      {
        cursor.failAt(begin, "there are two patches " + name);
      }
      if (patch.size > 0 && patch.start != next)
      {
        cursor.failAt(begin,
          "patch " + name + " starts at face " + std::to_string(patch.start) +
            "; it must start at " + std::to_string(next) +
            (next == mesh.numberOfInternalFaces() ? ", the first face without a neighbor"
                                                  : ", where the previous patch ends"));
      }
      if (patch.size > mesh.numberOfFaces() - next)
      {
        cursor.failAt(begin,
          "patch " + name + " ends at face " + std::to_string(next + patch.size) + "; there are " +
            std::to_string(mesh.numberOfFaces()) + " faces");
      }
      patch.start = next; // empty patches may have any start
      next += patch.size;
      mesh.patches.push_back(std::move(patch));
    });
  cursor.expectEnd("its list of patches");
  if (next != mesh.numberOfFaces())
  {
    cursor.fail("the patches end at face " + std::to_string(next) + "; there are " +
      std::to_string(mesh.numberOfFaces()) + " faces");
  }
}

/// The zones of a file that may not exist; `key` is the keyword of the list of their members.
std::vector<FoamZone> readZones(const std::string& name, const char* key, Index members)
{
  std::vector<FoamZone> zones;
  if (!foamFileExists(name))
  {
    return zones;
  }
  const FoamContent content(name);
  FoamCursor cursor(content.text());
  cursor.dictionaries("zones",
    [&](const std::string& zone)
    {
      zones.push_back({ zone, {} });
      for (std::string word = cursor.keyword(); !word.empty(); word = cursor.keyword())
      {
        if (word == key)
        {
          zones.back().members = cursor.labelsValue(key, 0, members - 1, members);
        }
        else
        {
          cursor.skipValue();
        }
      }
    });
  cursor.expectEnd("its list of zones");
  return zones;
}
}

//------------------------------------------------------------------------------
FoamMesh readFoamMesh(const std::string& folder, FoamCells* cells)
{
  FoamMesh mesh;
  readPoints(folder, mesh);
  readFaces(folder, mesh);
  readCellsOfFaces(folder, mesh);
  readBoundary(folder, mesh);
  mesh.cellZones = readZones(folder + "/cellZones", "cellLabels", mesh.cells);
  mesh.faceZones = readZones(folder + "/faceZones", "faceLabels", mesh.numberOfFaces());
  try
  {
    FoamCells found = cellsOf(mesh);
    if (cells)
    {
      *cells = std::move(found);
    }
  }
  catch (const FoamDefect& defect)
  {
    failInFile(folder, mesh.numberOfPoints(), defect);
  }
  return mesh;
}

//------------------------------------------------------------------------------
FoamCellFaces cellFacesOf(const FoamMesh& mesh)
{
  FoamCellFaces result;
  result.offsets.assign(at(mesh.cells) + 1, 0);
  const auto each = [&mesh](const auto& act)
  {
    for (Index face = 0; face < mesh.numberOfFaces(); ++face)
    {
      pollInterruption(face);
      act(mesh.owner[at(face)], face);
      if (face < mesh.numberOfInternalFaces())
      {
        act(mesh.neighbor[at(face)], face);
      }
    }
  };
  each([&](Index cell, Index) { ++result.offsets[at(cell) + 1]; });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  result.faces.resize(at(result.offsets.back()));
  each([&](Index cell, Index face) { result.faces[at(next[at(cell)]++)] = face; });
  return result;
}

//------------------------------------------------------------------------------
Index facesOutOfOrder(const FoamMesh& mesh, const FoamCellFaces& cellFaces)
{
  Index count = 0;
  std::vector<std::pair<Index, Index>> upper; // neighbor, face
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    pollInterruption(cell);
    upper.clear();
    for (Index i = cellFaces.offsets[at(cell)]; i < cellFaces.offsets[at(cell) + 1]; ++i)
    {
      const Index face = cellFaces.faces[at(i)];
      if (face < mesh.numberOfInternalFaces() && mesh.owner[at(face)] == cell)
      {
        upper.emplace_back(mesh.neighbor[at(face)], face);
      }
    }
    std::sort(upper.begin(), upper.end());
    for (std::size_t i = 1; i < upper.size(); ++i)
    {
      count += upper[i].first != upper[i - 1].first && upper[i].second < upper[i - 1].second;
    }
  }
  return count;
}
}
