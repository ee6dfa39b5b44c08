// SPDX-License-Identifier: BSD-3-Clause
#include "FoamCase.h"

#include "ArrayIndex.h"
#include "FoamProcessors.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Reads the meshes of some processors, with their addresses on request.
std::vector<FoamProcessor> readProcessors(
  const std::vector<std::string>& folders, bool addressed, int first = 0, int step = 1)
{
  std::vector<FoamProcessor> processors;
  for (std::size_t i = static_cast<std::size_t>(first); i < folders.size();
       i += static_cast<std::size_t>(step))
  {
    processors.push_back({ folders[i], readFoamMesh(folders[i]),
      addressed ? FoamAddresses::read(folders[i]) : FoamAddresses() });
  }
  return processors;
}

bool allHaveAddresses(const std::vector<std::string>& folders)
{
  return std::all_of(folders.begin(), folders.end(), FoamAddresses::exist);
}

FoamPiece wholeOfProcessors(const std::vector<std::string>& folders)
{
  const bool addressed = allHaveAddresses(folders);
  const std::vector<FoamProcessor> processors = readProcessors(folders, addressed);
  FoamPiece whole;
  const std::string problem = addressed ? composeByAddresses(processors, whole) : std::string();
  if (!addressed || !problem.empty())
  {
    whole = FoamPiece();
    whole.pointNumbers = joinProcessors(processors, FoamSeams::Sewn, whole.mesh).points;
  }
  if (!problem.empty())
  {
    whole.warnings.push_back("the meshes of the processors are joined along their patches, in a "
                             "different order: the addresses of decomposePar do not fit them (" +
      problem + ")");
  }
  whole.folders = folders;
  return whole;
}

/// Appends the numbers in the whole mesh of the entities of some processors.
void addNumbers(const FoamProcessor& processor, const FoamNumbers& inPiece, std::size_t i,
  const std::vector<Index>& points, const std::vector<Index>& cells,
  const std::vector<Index>& faces, FoamPiece& piece)
{
  piece.pointIds.insert(piece.pointIds.end(), points.begin(), points.end());
  piece.cellIds.insert(piece.cellIds.end(), cells.begin(), cells.end());
  piece.faceIds.resize(at(piece.mesh.numberOfFaces()));
  for (Index face = 0; face < processor.mesh.numberOfFaces(); ++face)
  {
    piece.faceIds[at(inPiece.faces[i][at(face)])] = faces[at(face)];
  }
}

/// Throws unless the addresses have the sizes of the mesh.
void checkAddresses(const FoamProcessor& processor)
{
  const FoamAddresses& a = processor.addresses;
  if (static_cast<Index>(a.points.size()) != processor.mesh.numberOfPoints() ||
    static_cast<Index>(a.cells.size()) != processor.mesh.cells ||
    static_cast<Index>(a.faces.size()) != processor.mesh.numberOfFaces())
  {
    throw FileError(processor.folder +
      "/pointProcAddressing: the lists *ProcAddressing have other "
      "sizes than the mesh: delete them, or run decomposePar again");
  }
}

std::vector<Index> faceNumbers(const std::vector<Index>& addresses)
{
  std::vector<Index> numbers(addresses.size());
  std::transform(addresses.begin(), addresses.end(), numbers.begin(),
    [](Index address) { return std::abs(address) - 1; });
  return numbers;
}

/// The processors of a piece, with numbers in the whole mesh from their addresses.
FoamPiece pieceByAddresses(const std::vector<std::string>& folders, int piece, int pieces)
{
  FoamPiece result;
  const std::vector<FoamProcessor> processors = readProcessors(folders, true, piece, pieces);
  const FoamNumbers numbers = joinProcessors(processors, FoamSeams::Kept, result.mesh);
  for (std::size_t i = 0; i < processors.size(); ++i)
  {
    const FoamAddresses& addresses = processors[i].addresses;
    checkAddresses(processors[i]);
    addNumbers(processors[i], numbers, i, addresses.points, addresses.cells,
      faceNumbers(addresses.faces), result);
  }
  for (const std::string& folder : folders)
  {
    const FoamAddresses addresses = FoamAddresses::read(folder);
    for (const Index cell : addresses.cells)
    {
      result.allCells = std::max(result.allCells, cell + 1);
    }
    for (const Index face : addresses.faces)
    {
      result.allFaces = std::max(result.allFaces, std::abs(face));
    }
  }
  result.pointNumbers = numbers.points;
  return result;
}

/// The same from the numbers after joining all processors.
FoamPiece pieceBySeams(const std::vector<std::string>& folders, int piece, int pieces)
{
  FoamPiece result;
  std::vector<FoamProcessor> processors = readProcessors(folders, false);
  FoamMesh whole;
  const FoamNumbers inWhole = joinProcessors(processors, FoamSeams::Sewn, whole);
  result.allCells = whole.cells;
  result.allFaces = whole.numberOfFaces();
  whole = FoamMesh();
  std::vector<FoamProcessor> own;
  std::vector<std::size_t> places;
  for (auto i = static_cast<std::size_t>(piece); i < processors.size();
       i += static_cast<std::size_t>(pieces))
  {
    places.push_back(i);
    own.push_back(std::move(processors[i]));
  }
  const FoamNumbers numbers = joinProcessors(own, FoamSeams::Kept, result.mesh);
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    std::vector<Index> cells(at(own[i].mesh.cells));
    for (std::size_t k = 0; k < cells.size(); ++k)
    {
      cells[k] = inWhole.firstCell[places[i]] + static_cast<Index>(k);
    }
    addNumbers(
      own[i], numbers, i, inWhole.points[places[i]], cells, inWhole.faces[places[i]], result);
  }
  result.pointNumbers = numbers.points;
  return result;
}

FoamPiece pieceOfProcessors(const std::vector<std::string>& folders, int piece, int pieces)
{
  FoamPiece result = allHaveAddresses(folders) ? pieceByAddresses(folders, piece, pieces)
                                               : pieceBySeams(folders, piece, pieces);
  for (std::size_t i = static_cast<std::size_t>(piece); i < folders.size();
       i += static_cast<std::size_t>(pieces))
  {
    result.folders.push_back(folders[i]);
  }
  return result;
}

/// Finds the cells of a mesh that was joined or divided.
void finish(FoamPiece& piece)
{
  try
  {
    piece.cells = cellsOf(piece.mesh);
  }
  catch (const FoamDefect& defect)
  {
    throw FileError((piece.folders.empty() ? std::string("a piece") : piece.folders[0]) +
      ": the mesh of several processors: " + defect.problem);
  }
}
}

//------------------------------------------------------------------------------
FoamPiece readFoamFolders(const std::vector<std::string>& folders)
{
  FoamPiece whole;
  if (folders.size() > 1)
  {
    whole = wholeOfProcessors(folders);
    finish(whole);
  }
  else
  {
    whole.mesh = readFoamMesh(folders.at(0), &whole.cells);
    whole.folders = folders;
  }
  if (whole.mesh.cells == 0)
  {
    throw FileError(folders[0] + "/owner: the mesh has no cells");
  }
  return whole;
}

//------------------------------------------------------------------------------
FoamPiece readFoamCase(const FoamRequest& request)
{
  const FoamLocation location = locateFoamCase(request);
  FoamPiece result;
  if (request.pieces <= 1)
  {
    result = readFoamFolders(location.folders);
  }
  else
  {
    result = location.decomposed
      ? pieceOfProcessors(location.folders, request.piece, request.pieces)
      : divideMesh(readFoamMesh(location.folders[0]), request.piece, request.pieces);
    finish(result);
  }
  if (!location.decomposed)
  {
    result.folders = location.folders;
  }
  const auto moving = movingFoamMeshes(splitFoamPath(location.folders[0]));
  if (!moving.empty())
  {
    result.warnings.push_back(
      "the points are from the constant mesh: there are other points in " + moving.back());
  }
  return result;
}
}
