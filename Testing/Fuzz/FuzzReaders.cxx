// SPDX-License-Identifier: BSD-3-Clause
// Mesh files of arbitrary bytes: a reader returns a consistent mesh or throws FileError with the
// name of the file; what it returns can be written, and reads back the same.

#include "FuzzTargets.h"
#include "Readers/MeshFileChecks.h"

#include "AbaqusFile.h"
#include "FoamCase.h"
#include "FoamFileAdapter.h"
#include "FoamPoints.h"
#include "MeshFileAdapter.h"
#include "MfemFile.h"
#include "NastranFile.h"

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tautline
{
namespace
{
using Read = MeshFile (*)(const std::string&, bool);
using Write = std::vector<std::string> (*)(const MeshFile&, const std::string&);

/// Files of one set: parts of the bytes that begin with a line "@ending"; the first one is read.
std::vector<std::pair<std::string, std::string_view>> splitSet(
  std::string_view bytes, const std::vector<std::string>& endings)
{
  std::vector<std::pair<std::string, std::string_view>> parts;
  while (!bytes.empty() && bytes[0] == '@')
  {
    const std::size_t line = bytes.find('\n');
    const std::string ending(bytes.substr(1, line == bytes.npos ? line : line - 1));
    if (line == bytes.npos || std::find(endings.begin(), endings.end(), ending) == endings.end())
    {
      break;
    }
    bytes.remove_prefix(line + 1);
    const std::size_t next = bytes.find("\n@");
    parts.emplace_back(ending, bytes.substr(0, next == bytes.npos ? next : next + 1));
    bytes.remove_prefix(next == bytes.npos ? bytes.size() : next + 1);
  }
  return parts;
}

void expectArrays(const std::vector<MeshArray>& arrays, std::size_t tuples)
{
  for (const MeshArray& array : arrays)
  {
    expectThat(array.size() == tuples * static_cast<std::size_t>(array.components),
      "an array has a value per point or cell");
  }
}

void expectConsistent(const MeshFile& mesh)
{
  const std::size_t cells = mesh.cellTypes.size();
  expectThat(mesh.offsets.size() == cells + 1 && mesh.offsets.front() == 0 &&
      mesh.offsets.back() == static_cast<Index>(mesh.connectivity.size()) &&
      std::is_sorted(mesh.offsets.begin(), mesh.offsets.end()),
    "offsets enclose the connectivity");
  for (const Index node : mesh.connectivity)
  {
    expectThat(node >= 0 && node < mesh.numberOfPoints(), "the nodes of cells exist");
  }
  for (const double coordinate : mesh.points)
  {
    expectThat(std::isfinite(coordinate), "coordinates are finite");
  }
  for (std::size_t i = 0; i < cells; ++i)
  {
    const int nodes = cellNodes(mesh.cellTypes[i]);
    expectThat(nodes == 0 || mesh.offsets[i + 1] - mesh.offsets[i] == nodes,
      "a cell has the nodes of its type");
  }
  expectArrays(mesh.pointArrays, static_cast<std::size_t>(mesh.numberOfPoints()));
  expectArrays(mesh.cellArrays, cells);
}

/// To VTK and back nothing is lost.
void expectAdapted(const MeshFile& mesh)
{
  vtkNew<vtkUnstructuredGrid> grid;
  toGrid(MeshFile(mesh), grid);
  const MeshFile back = fromDataSet(grid);
  expectThat(same(mesh.points, back.points) && mesh.cellTypes == back.cellTypes &&
      mesh.connectivity == back.connectivity,
    "VTK has the mesh of the file");
}

/// Writes the mesh in the format it was read from, and reads that again.
void expectRoundTrip(const MeshFile& mesh, const std::string& name, Read read, Write write)
{
  std::vector<std::string> files;
  try
  {
    files = write(mesh, name);
  }
  catch (const Error&)
  {
    return; // the format cannot hold this mesh
  }
  const bool written = std::find(files.begin(), files.end(), name) != files.end();
  const MeshFile again = read(written ? name : files.front(), true);
  expectThat(same(mesh.points, again.points), "points that were written read back");
  // Points without cells become a .node file alone, which is read as vertices.
  expectThat(mesh.cellTypes.empty() ||
      (mesh.cellTypes == again.cellTypes && mesh.connectivity == again.connectivity),
    "cells that were written read back");
}

void readAndCheck(const std::string& name, Read read, Write write)
{
  MeshFile mesh;
  try
  {
    read(name, false);
    mesh = read(name, true);
  }
  catch (const FileError& error)
  {
    const std::string stem = splitExtension(name).first;
    expectThat(std::string(error.what()).compare(0, stem.size(), stem) == 0,
      "the message begins with the name of the file: " + std::string(error.what()));
    return;
  }
  expectConsistent(mesh);
  expectAdapted(mesh);
  expectRoundTrip(mesh, fuzzFolder() + "/fuzz-out." + splitExtension(name).second, read, write);
}

void fuzzSet(
  std::string_view bytes, const std::vector<std::string>& endings, Read read, Write write)
{
  const auto parts = splitSet(bytes, endings);
  if (parts.empty())
  {
    return;
  }
  const std::string stem = fuzzFolder() + "/fuzz.";
  for (const std::string& ending : endings)
  {
    std::remove((stem + ending).c_str());
  }
  for (const auto& [ending, content] : parts)
  {
    writeText(stem + ending, std::string(content));
  }
  readAndCheck(stem + parts[0].first, read, write);
}

void fuzzFile(std::string_view bytes, const char* ending, Read read, Write write)
{
  const std::string name = fuzzFolder() + "/fuzz." + ending;
  writeText(name, std::string(bytes));
  readAndCheck(name, read, write);
}

/// For formats that are only read.
std::vector<std::string> writeNothing(const MeshFile&, const std::string& name)
{
  throw FileError(name + ": is not written");
}

/// Writes a mesh of MFEM, if it can be written: what is read of it has other numbers of points.
std::vector<std::string> writeMfemOnly(const MeshFile& mesh, const std::string& name)
{
  writeMfem(mesh, name + "-new.mesh", false);
  expectThat(readMfem(name + "-new.mesh", false).numberOfCells() <= mesh.numberOfCells(),
    "the elements are written");
  throw FileError(name + ": is not compared");
}

void expectConsistent(const FoamMesh& mesh)
{
  const Index points = mesh.numberOfPoints(), faces = mesh.numberOfFaces();
  expectThat(static_cast<Index>(mesh.faceOffsets.size()) == faces + 1 &&
      mesh.faceOffsets.back() == static_cast<Index>(mesh.facePoints.size()),
    "the starts of the faces enclose their points");
  const auto within = [](const std::vector<Index>& values, Index count)
  {
    return std::all_of(
      values.begin(), values.end(), [count](Index value) { return value >= 0 && value < count; });
  };
  expectThat(within(mesh.facePoints, points) && within(mesh.owner, mesh.cells) &&
      within(mesh.neighbor, mesh.cells),
    "points and cells of faces exist");
  Index next = mesh.numberOfInternalFaces();
  for (const FoamPatch& patch : mesh.patches)
  {
    expectThat(patch.start == next, "patches follow each other");
    next += patch.size;
  }
  expectThat(next == faces, "patches cover the boundary");
  expectThat(std::all_of(mesh.points.begin(), mesh.points.end(),
               [](double value) { return std::isfinite(value); }),
    "coordinates are finite");
}

/// The written file equals the file that was read, and a changed point is read back.
void expectPointsWritten(const FoamPiece& piece)
{
  const std::string points = piece.folders[0] + "/points";
  if (piece.folders.size() > 1 || !std::filesystem::exists(points))
  {
    return; // decomposed or compressed
  }
  std::vector<double> moved = piece.mesh.points;
  expectThat(withFoamPoints(piece.folders[0], moved).bytes == readText(points),
    "points that did not move are the file");
  moved.back() = 0.25;
  writeFoamPoints(piece.folders, piece.pointNumbers, moved, false);
  expectThat(same(readFoamFolders(piece.folders).mesh.points, moved), "points are written");
}

std::vector<std::string> writeGmshText(const MeshFile& mesh, const std::string& name)
{
  return writeGmsh(mesh, name, false);
}
}

//------------------------------------------------------------------------------
void fuzzTetGen(std::string_view bytes)
{
  fuzzSet(bytes, { "node", "ele", "face", "edge", "poly", "smesh" }, readTetGen, writeTetGen);
}

//------------------------------------------------------------------------------
void fuzzMedit(std::string_view bytes)
{
  fuzzSet(bytes, { "mesh", "meshb", "sol" }, readMedit, writeMedit);
}

//------------------------------------------------------------------------------
void fuzzFoam(std::string_view bytes)
{
  std::vector<std::string> names;
  for (const std::string prefix : { "", "processor0/", "processor1/" })
  {
    for (const char* name : { "points", "faces", "owner", "neighbour", "boundary", "cellZones",
           "faceZones", "points.gz", "pointProcAddressing", "cellProcAddressing",
           "faceProcAddressing", "boundaryProcAddressing" })
    {
      names.push_back(prefix + name);
    }
  }
  namespace fs = std::filesystem;
  const fs::path folder = fuzzFolder() + "/foam-case";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const auto& [name, content] : splitSet(bytes, names))
  {
    const fs::path file =
      folder / fs::path(name).parent_path() / "constant/polyMesh" / fs::path(name).filename();
    fs::create_directories(file.parent_path());
    writeText(file.string(), std::string(content));
  }
  for (const int pieces : { 1, 2 })
  {
    FoamRequest request;
    request.name = folder.string();
    request.piece = pieces - 1;
    request.pieces = pieces;
    try
    {
      FoamPiece piece = readFoamCase(request);
      expectConsistent(piece.mesh);
      vtkNew<vtkUnstructuredGrid> grid;
      toGrid(FoamPiece(piece), true, grid);
      if (pieces == 1)
      {
        expectPointsWritten(piece);
      }
    }
    catch (const FileError& error)
    {
      expectThat(std::string(error.what()).compare(0, fuzzFolder().size(), fuzzFolder()) == 0,
        "the message begins with the name of the file: " + std::string(error.what()));
    }
  }
}

//------------------------------------------------------------------------------
void fuzzAbaqus(std::string_view bytes)
{
  fuzzFile(bytes, "inp", readAbaqus, writeNothing);
}

//------------------------------------------------------------------------------
void fuzzNastran(std::string_view bytes)
{
  fuzzFile(bytes, "bdf", readNastran, writeNothing);
}

//------------------------------------------------------------------------------
void fuzzMfem(std::string_view bytes)
{
  fuzzFile(bytes, "mesh", readMfem, writeMfemOnly);
}

//------------------------------------------------------------------------------
void fuzzGmsh(std::string_view bytes)
{
  fuzzFile(bytes, "msh", readGmsh, writeGmshText);
}

//------------------------------------------------------------------------------
void fuzzOff(std::string_view bytes)
{
  fuzzFile(bytes, "off", readOff, writeOff);
}
}
