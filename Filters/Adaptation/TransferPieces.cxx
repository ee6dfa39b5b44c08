// SPDX-License-Identifier: BSD-3-Clause
#include "TransferPieces.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
TransferMesh joinPieces(std::vector<TransferPiece>& pieces, const CoordinateFrame& frame)
{
  int dimension = 2; // no element
  for (const TransferPiece& piece : pieces)
  {
    dimension = std::max(dimension, elementDimension(piece.adapter->mesh().view()));
  }
  TransferMesh mesh(dimension);
  for (TransferPiece& piece : pieces)
  {
    piece.first[0] = mesh.numberOfPoints();
    piece.first[1] = mesh.numberOfCells();
    MeshView view = piece.adapter->mesh().view();
    std::vector<double> points(view.points, view.points + 3 * view.numberOfPoints);
    frame.enter(points);
    view.points = points.data();
    mesh.add(view, piece.adapter->ghostCells());
  }
  return mesh;
}

//------------------------------------------------------------------------------
void requireSupported(const TransferPiece& piece, const char* which)
{
  const Mesh& mesh = piece.adapter->mesh();
  const std::string where =
    std::string(" of the ") + which + (piece.name.empty() ? "" : " (" + piece.name + ")") + " are ";
  if (mesh.higherOrderCells() > 0)
  {
    throw Error(std::to_string(mesh.higherOrderCells()) + " cells" + where +
      "of higher order: run Curve Mesh with order 1 first to make them linear.");
  }
  if (mesh.polyhedra() > 0)
  {
    throw Error(
      std::to_string(mesh.polyhedra()) + " cells" + where + "polyhedra: run Tetrahedralize first.");
  }
}

//------------------------------------------------------------------------------
CoordinateFrame frameOf(const std::vector<TransferPiece>& pieces)
{
  CoordinateRange all;
  for (const TransferPiece& piece : pieces)
  {
    const CoordinateRange range = coordinateRange(piece.adapter->inputView());
    if (!(range.extent > 0.0))
    {
      continue;
    }
    const bool first = !(all.extent > 0.0);
    for (int k = 0; k < 3; ++k)
    {
      all.low[k] = first ? range.low[k] : std::min(all.low[k], range.low[k]);
      all.high[k] = first ? range.high[k] : std::max(all.high[k], range.high[k]);
    }
    all.extent = std::max(all.extent, range.extent);
  }
  return CoordinateFrame(all);
}

//------------------------------------------------------------------------------
std::string describeInverted(std::vector<TransferPiece>& pieces, const char* which)
{
  Index inverted = 0;
  for (TransferPiece& piece : pieces)
  {
    std::vector<signed char> validity(piece.count(vtkDataObject::CELL));
    piece.adapter->orient(validity.data(), false);
    const unsigned char* ghosts = piece.adapter->ghostCells();
    for (std::size_t cell = 0; cell < validity.size(); ++cell)
    {
      inverted += validity[cell] == Inverted && !(ghosts && ghosts[cell] != 0);
    }
  }
  return inverted == 0 ? ""
                       : std::to_string(inverted) + " elements of the " + which +
      " are inverted: the absolute values of their areas or volumes count.";
}
}
