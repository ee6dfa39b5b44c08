// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Seams.h
 * @brief A mesh in pieces beside the whole one, as data sets, and comparisons of what filters make
 * of them.
 */
#ifndef tautline_Seams_h
#define tautline_Seams_h

#include "Optimization/Optimizing.h"
#include "Pieces.h"
#include "VtkMeshes.h"

#include "vtkPointSet.h"

namespace tautline
{
/// A mesh in pieces, and the same as a whole: its points are those that come first.
struct Case
{
  Pieces pieces;
  MeshData whole;
  std::vector<Index> wholeId; ///< per point of the pieces

  explicit Case(const Pieces& given)
    : pieces(given)
  {
    std::map<Index, Index> known;
    for (Index p = 0; p < this->pieces.mesh.numberOfPoints(); ++p)
    {
      const auto [at, fresh] = known.emplace(this->pieces.pointOf[p], this->whole.numberOfPoints());
      if (fresh)
      {
        this->whole.addPoint(this->pieces.mesh.point(p));
      }
      this->wholeId.push_back(at->second);
    }
    const MeshData& mesh = this->pieces.mesh;
    for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes;
      for (Index n = mesh.offsets[cell]; n < mesh.offsets[cell + 1]; ++n)
      {
        nodes.push_back(this->wholeId[mesh.connectivity[n]]);
      }
      this->whole.addCell(static_cast<int>(mesh.types[cell]), nodes);
    }
  }
};

/// A block with its inner points moved; `n` cells each way, two or more to a piece.
inline MeshData rough(CellType type, Index n, double amplitude = 0.25, unsigned seed = 3)
{
  return perturbedBlock(type, n, amplitude, seed);
}

inline Case quarters(CellType type, Index n, double amplitude = 0.25)
{
  return Case(inQuarters(rough(type, n, amplitude), 0.5 * static_cast<double>(n)));
}

inline vtkPointSet* pointsOf(vtkAlgorithm* filter)
{
  return outputOf<vtkPointSet>(filter);
}

/// The largest distance between the points of the pieces and of the whole.
inline double farthest(const Case& both, vtkPointSet* pieces, vtkPointSet* whole)
{
  double distance = 0;
  for (Index p = 0; p < both.pieces.mesh.numberOfPoints(); ++p)
  {
    double a[3], b[3];
    pieces->GetPoint(p, a);
    whole->GetPoint(both.wholeId[p], b);
    for (int c = 0; c < 3; ++c)
    {
      distance = std::max(distance, std::abs(a[c] - b[c]));
    }
  }
  return distance;
}

/// The largest difference of a point array.
inline double farthest(const Case& both, vtkDataSet* pieces, vtkDataSet* whole, const char* array)
{
  vtkDataArray* a = pieces->GetPointData()->GetArray(array);
  vtkDataArray* b = whole->GetPointData()->GetArray(array);
  double distance = TAUTLINE_CHECK(a && b) ? 0 : 1;
  for (Index p = 0; a && b && p < both.pieces.mesh.numberOfPoints(); ++p)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      distance =
        std::max(distance, std::abs(a->GetComponent(p, c) - b->GetComponent(both.wholeId[p], c)));
    }
  }
  return distance;
}

template <class Filter>
void runBoth(const Case& both, Filter* pieces, Filter* whole)
{
  pieces->SetInputDataObject(0, toGrid(both.pieces.mesh));
  whole->SetInputDataObject(0, toGrid(both.whole));
  pieces->Update();
  whole->Update();
}

inline std::string said(const Case& both)
{
  return std::to_string(both.pieces.copies) + " coincident points on 1 seam were treated as one";
}
}
#endif
