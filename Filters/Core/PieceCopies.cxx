// SPDX-License-Identifier: BSD-3-Clause
#include "PieceCopies.h"

#include "MeshAdapter.h"
#include "tautline/Mesh/PointCopies.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

#include <cmath>
#include <string>

namespace tautline
{
PieceCopies::PieceCopies(const std::vector<vtkDataSet*>& pieces)
  : Pieces(pieces)
  , Shortest(pieces.size())
{
}

//------------------------------------------------------------------------------
double PieceCopies::shortestAt(const PieceItem& point)
{
  const auto piece = static_cast<std::size_t>(point.piece);
  if (this->Shortest[piece].empty())
  {
    this->Shortest[piece] = shortestEdges(MeshAdapter(this->Pieces[piece]).mesh().view());
  }
  return this->Shortest[piece][static_cast<std::size_t>(point.id)];
}

//------------------------------------------------------------------------------
void PieceCopies::require(const PieceItem& a, const PieceItem& b)
{
  double x[3], y[3];
  vtkDataSet* piece = this->Pieces[static_cast<std::size_t>(a.piece)];
  piece->GetPoint(a.id, x);
  this->Pieces[static_cast<std::size_t>(b.piece)]->GetPoint(b.id, y);
  const bool finite = std::isfinite(x[0] + x[1] + x[2]) && std::isfinite(y[0] + y[1] + y[2]);
  if (finite && !areCopies(x, this->shortestAt(a), y, this->shortestAt(b)))
  {
    const double id = piece->GetPointData()->GetGlobalIds()->GetComponent(a.id, 0);
    throw Error("Points at different positions have the global id " +
      std::to_string(static_cast<Index>(id)) + ": run Generate Global Ids again.");
  }
}
}
