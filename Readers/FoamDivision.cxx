// SPDX-License-Identifier: BSD-3-Clause
#include "ArrayIndex.h"
#include "FoamProcessors.h"
#include "MeshPart.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace tautline
{
namespace
{
/// A vertex for each cell, at the mean of its faces' points.
MeshFile cellCentres(const FoamMesh& mesh, const FoamCellFaces& cellFaces)
{
  MeshFile centres;
  std::vector<Index> vertices(at(mesh.cells));
  std::iota(vertices.begin(), vertices.end(), Index{ 0 });
  centres.points.assign(3 * vertices.size(), 0.0);
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    pollInterruption(cell);
    double count = 0.0;
    double* centre = centres.points.data() + 3 * cell;
    for (Index i = cellFaces.offsets[at(cell)]; i < cellFaces.offsets[at(cell) + 1]; ++i)
    {
      const Index face = cellFaces.faces[at(i)];
      for (Index k = mesh.faceOffsets[at(face)]; k < mesh.faceOffsets[at(face) + 1]; ++k)
      {
        const Index point = mesh.facePoints[at(k)];
        for (int axis = 0; axis < 3; ++axis)
        {
          centre[axis] += mesh.points[at(3 * point + axis)];
        }
        count += 1.0;
      }
    }
    std::for_each(centre, centre + 3, [count](double& value) { value /= count; });
  }
  centres.addCells(FileVertex, std::move(vertices));
  return centres;
}

/// One piece of a mesh.
class PieceOfMesh
{
public:
  PieceOfMesh(const FoamMesh& mesh, const std::vector<int>& pieceOfCell, int piece)
    : Mesh(mesh)
    , PieceOfCell(pieceOfCell)
    , Piece(piece)
    , CellNumbers(at(mesh.cells), -1)
    , FaceNumbers(mesh.owner.size(), -1)
    , PointNumbers(at(mesh.numberOfPoints()), -1)
  {
  }

  FoamPiece make()
  {
    for (Index cell = 0; cell < this->Mesh.cells; ++cell)
    {
      if (this->PieceOfCell[at(cell)] == this->Piece)
      {
        this->CellNumbers[at(cell)] = static_cast<Index>(this->Result.cellIds.size());
        this->Result.cellIds.push_back(cell);
      }
    }
    FoamMesh& mesh = this->Result.mesh;
    mesh.cells = static_cast<Index>(this->Result.cellIds.size());
    this->Result.allCells = this->Mesh.cells;
    this->Result.allFaces = this->Mesh.numberOfFaces();
    this->addFaces();
    this->addPoints();
    for (const FoamZone& zone : this->Mesh.cellZones)
    {
      addZone(mesh.cellZones, zone.name, kept(zone.members, this->CellNumbers));
    }
    for (const FoamZone& zone : this->Mesh.faceZones)
    {
      addZone(mesh.faceZones, zone.name, kept(zone.members, this->FaceNumbers));
    }
    return std::move(this->Result);
  }

private:
  static std::vector<Index> kept(
    const std::vector<Index>& members, const std::vector<Index>& numbers)
  {
    std::vector<Index> result;
    for (const Index member : members)
    {
      if (numbers[at(member)] >= 0)
      {
        result.push_back(numbers[at(member)]);
      }
    }
    return result;
  }

  void addFace(Index face, Index cell, bool reversed)
  {
    FoamMesh& mesh = this->Result.mesh;
    const auto begin = this->Mesh.facePoints.begin() + this->Mesh.faceOffsets[at(face)];
    const auto end = this->Mesh.facePoints.begin() + this->Mesh.faceOffsets[at(face) + 1];
    mesh.facePoints.insert(mesh.facePoints.end(), begin, end);
    if (reversed)
    {
      // the first point stays, except for a face in the plane, which has two
      const std::ptrdiff_t kept = end - begin == 2 ? 0 : 1;
      std::reverse(mesh.facePoints.end() - (end - begin) + kept, mesh.facePoints.end());
    }
    this->FaceNumbers[at(face)] = mesh.numberOfFaces();
    mesh.faceOffsets.push_back(static_cast<Index>(mesh.facePoints.size()));
    mesh.owner.push_back(this->CellNumbers[at(cell)]);
    this->Result.faceIds.push_back(face);
  }

  void addFaces()
  {
    FoamMesh& mesh = this->Result.mesh;
    std::map<int, std::vector<Index>> seams; // by the piece on the other side
    for (Index face = 0; face < this->Mesh.numberOfInternalFaces(); ++face)
    {
      pollInterruption(face);
      const Index owner = this->Mesh.owner[at(face)], neighbor = this->Mesh.neighbor[at(face)];
      const int piece = this->PieceOfCell[at(owner)], other = this->PieceOfCell[at(neighbor)];
      if (piece == this->Piece && other == this->Piece)
      {
        mesh.neighbor.push_back(this->CellNumbers[at(neighbor)]);
        this->addFace(face, owner, false);
      }
      else if (piece == this->Piece || other == this->Piece)
      {
        seams[piece == this->Piece ? other : piece].push_back(face);
      }
    }
    for (FoamPatch patch : this->Mesh.patches)
    {
      const Index end = patch.start + patch.size;
      const Index begin = std::exchange(patch.start, mesh.numberOfFaces());
      for (Index face = begin; face < end; ++face)
      {
        pollInterruption(face);
        if (this->PieceOfCell[at(this->Mesh.owner[at(face)])] == this->Piece)
        {
          this->addFace(face, this->Mesh.owner[at(face)], false);
        }
      }
      patch.size = mesh.numberOfFaces() - patch.start;
      mesh.patches.push_back(std::move(patch));
    }
    for (const auto& [other, faces] : seams)
    {
      this->addSeam(other, faces);
    }
  }

  void addSeam(int other, const std::vector<Index>& faces)
  {
    FoamPatch patch;
    patch.name = "procBoundary" + std::to_string(this->Piece) + "to" + std::to_string(other);
    patch.type = "processor";
    patch.start = this->Result.mesh.numberOfFaces();
    patch.size = static_cast<Index>(faces.size());
    patch.processor = this->Piece;
    patch.neighborProcessor = other;
    for (const Index face : faces)
    {
      const Index owner = this->Mesh.owner[at(face)];
      const bool own = this->PieceOfCell[at(owner)] == this->Piece;
      this->addFace(face, own ? owner : this->Mesh.neighbor[at(face)], !own);
    }
    this->Result.mesh.patches.push_back(std::move(patch));
  }

  /// The points of the faces, in the order of the whole mesh; for the first piece also points
  /// without a face.
  void addPoints()
  {
    FoamMesh& mesh = this->Result.mesh;
    std::vector<char> used(this->PointNumbers.size(), this->Piece == 0);
    for (const Index point : this->Piece == 0 ? this->Mesh.facePoints : std::vector<Index>())
    {
      used[at(point)] = 0;
    }
    for (const Index point : mesh.facePoints)
    {
      used[at(point)] = 1;
    }
    for (Index point = 0; point < this->Mesh.numberOfPoints(); ++point)
    {
      if (used[at(point)])
      {
        this->PointNumbers[at(point)] = static_cast<Index>(this->Result.pointIds.size());
        this->Result.pointIds.push_back(point);
        const auto from = this->Mesh.points.begin() + 3 * point;
        mesh.points.insert(mesh.points.end(), from, from + 3);
      }
    }
    for (Index& point : mesh.facePoints)
    {
      point = this->PointNumbers[at(point)];
    }
  }

  const FoamMesh& Mesh;
  const std::vector<int>& PieceOfCell;
  int Piece;
  std::vector<Index> CellNumbers, FaceNumbers, PointNumbers; ///< in the piece; -1 if not in it
  FoamPiece Result;
};
}

//------------------------------------------------------------------------------
FoamPiece divideMesh(const FoamMesh& mesh, int piece, int pieces)
{
  const std::vector<int> pieceOfCell = partsOfCells(cellCentres(mesh, cellFacesOf(mesh)), pieces);
  return PieceOfMesh(mesh, pieceOfCell, piece).make();
}
}
