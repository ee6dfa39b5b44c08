// SPDX-License-Identifier: BSD-3-Clause
// New points of a mesh in pieces, and their precision.
#include "RankMesh.h"

#include "MovableMesh.h"

#include "vtkDataArray.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>

namespace tautline
{
namespace
{
std::vector<double> toSingle(std::vector<double> points)
{
  std::transform(points.begin(), points.end(), points.begin(),
    [](double x) { return static_cast<double>(static_cast<float>(x)); });
  return points;
}
}

//------------------------------------------------------------------------------
std::vector<double> RankMesh::ofPiece(const std::vector<double>& local) const
{
  const MeshView& view = this->piece();
  std::vector<double> points(view.points, view.points + 3 * view.numberOfPoints);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index from = this->TheMesh->localOfPiece()[p];
    if (from >= 0)
    {
      std::copy_n(&local[3 * from], 3, &points[3 * p]);
    }
  }
  return points;
}

//------------------------------------------------------------------------------
Mesh RankMesh::movedPiece(const std::vector<double>& points) const
{
  MeshView view = this->piece();
  view.points = points.data();
  Mesh mesh(view, this->Threads);
  mesh.setMirrored(this->Mirrored);
  return mesh;
}

//------------------------------------------------------------------------------
std::vector<signed char> RankMesh::validityAt(const std::vector<double>& points) const
{
  std::vector<signed char> validity(this->piece().numberOfCells);
  this->movedPiece(points).classifyCells(validity.data(), this->Threads);
  return validity;
}

//------------------------------------------------------------------------------
bool RankMesh::isSingle() const
{
  vtkPoints* points = this->Input ? this->Input->GetPoints() : nullptr;
  const bool single = points && points->GetDataType() == VTK_FLOAT;
  return !this->Group.any(this->piece().numberOfPoints > 0 && !single);
}

//------------------------------------------------------------------------------
std::vector<double> RankMesh::rounded(const std::vector<double>& local) const
{
  std::vector<double> points;
  points = toSingle(local);
  return points;
}

//------------------------------------------------------------------------------
std::string RankMesh::move(vtkPointSet* output, const std::vector<double>& local) const
{
  vtkPoints* like = this->Input ? this->Input->GetPoints() : nullptr;
  Index lost = 0;
  if (like && like->GetDataType() == VTK_FLOAT)
  {
    const std::vector<double> points = this->ofPiece(local);
    const auto before = this->validityAt(points), after = this->validityAt(toSingle(points));
    const unsigned char* ghosts = this->Adapter->ghostCells();
    for (std::size_t cell = 0; cell < after.size(); ++cell)
    {
      lost += !(ghosts && ghosts[cell]) && before[cell] == Valid && after[cell] != Valid;
    }
  }
  lost = this->Group.sum(lost);
  this->move(output, local, lost == 0);
  return lost == 0 ? ""
                   : "The points are given in double precision: in single precision " +
      std::to_string(lost) + " valid elements would not be valid.";
}

void RankMesh::move(vtkPointSet* output, const std::vector<double>& local, bool single) const
{
  if (output)
  {
    const std::vector<double> points = this->ofPiece(local);
    vtkPoints* like = this->Input ? this->Input->GetPoints() : nullptr;
    output->SetPoints(makePoints(points, single ? like : nullptr));
    addDisplacement(output, this->piece().points, points);
  }
}
}
