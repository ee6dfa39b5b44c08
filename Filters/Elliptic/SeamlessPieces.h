// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SeamlessPieces.h
 * @brief Partitions of a mesh with coincident points merged. Internal.
 */
#ifndef tautline_SeamlessPieces_h
#define tautline_SeamlessPieces_h

#include "MergedPieces.h"
#include "MeshAdapter.h"
#include "PointMerge.h"
#include "tautline/Core/UnionFind.h"

#include "vtkIdTypeArray.h"

#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>

namespace tautline
{
/// A sentence on point arrays that differ between merged points, or "".
inline std::string differingArrays(vtkDataSet* input, const std::vector<Index>& representative)
{
  std::string names;
  for (int i = 0; i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = input->GetPointData()->GetArray(i);
    const bool ids = array && array == input->GetPointData()->GetGlobalIds();
    bool differs = false;
    for (std::size_t p = 0; array && !ids && !differs && p < representative.size(); ++p)
    {
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      {
        const double own = array->GetComponent(static_cast<vtkIdType>(p), c);
        const double other = array->GetComponent(representative[p], c);
        differs = differs || (own != other && !(std::isnan(own) && std::isnan(other)));
      }
    }
    names += differs ? (names.empty() ? "'" : ", '") + std::string(array->GetName()) + "'" : "";
  }
  return names.empty() ? ""
                       : "Their values differ in the point array" +
      std::string(names.find(',') == std::string::npos ? " " : "s ") + names +
      ": the values of the point with the smallest id are used.";
}

/// Whether a cell has two points with one number, so that it would collapse if they were merged.
inline bool anyCollapse(vtkDataSet* input, const std::vector<Index>& numbers)
{
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    input->GetCellPoints(cell, points);
    for (vtkIdType a = 1; a < points->GetNumberOfIds(); ++a)
    {
      for (vtkIdType b = 0; b < a; ++b)
      {
        if (points->GetId(a) != points->GetId(b) &&
          numbers[points->GetId(a)] == numbers[points->GetId(b)])
        {
          return true;
        }
      }
    }
  }
  return false;
}

/**
 * @brief Merges points with the same id and position, even if no facet joins them.
 * @param ids one per point, or none
 * @param view with the points at their positions after joinCopies()
 * @param representative of each point; empty if no points are merged
 * @return the number of additional merged points
 */
inline Index joinSameIds(
  const std::vector<Index>& ids, const MeshView& view, std::vector<Index>& representative)
{
  if (ids.empty())
  {
    return 0;
  }
  UnionFind sets(static_cast<Index>(ids.size()));
  for (std::size_t p = 0; p < representative.size(); ++p)
  {
    sets.join(representative[p], static_cast<Index>(p));
  }
  Index joined = 0;
  std::unordered_map<Index, Index> known;
  for (Index p = 0; p < static_cast<Index>(ids.size()); ++p)
  {
    const Index first = known.emplace(ids[p], p).first->second;
    if (sets.find(first) != sets.find(p) && pointOf(view, first) == pointOf(view, p))
    {
      sets.join(first, p);
      ++joined;
    }
  }
  representative.resize(joined > 0 ? ids.size() : representative.size());
  for (std::size_t p = 0; joined > 0 && p < representative.size(); ++p)
  {
    representative[p] = sets.find(static_cast<Index>(p));
  }
  return joined;
}

/// A sentence on merged points that no facet joins, or "".
inline std::string describeUnited(Index points)
{
  return points == 0 ? ""
                     : std::to_string(points) +
      (points == 1
          ? " point that shares only a corner with a coincident one was treated as one with it."
          : " points that share only corners with coincident ones were treated as one with them.");
}

/// The pieces with their coincident points merged, and the mapping back.
class Seamless
{
public:
  std::vector<Piece> pieces;
  std::string notice;

  Seamless(const std::vector<Piece>& given, bool mergePoints)
    : pieces(given)
    , Given(given)
    , Made(given.size())
  {
    for (std::size_t i = 0; mergePoints && i < given.size(); ++i)
    {
      vtkDataSet* input = given[i].input;
      MeshAdapter adapter(input);
      const std::vector<Index> ids = idsOf(input->GetPointData()->GetGlobalIds());
      this->add(describeJoined(adapter.joinCopies(input->GetPointData()->GetGlobalIds())));
      CoincidentPoints found =
        findCoincidentPoints(adapter.mesh(), nullptr, 1, adapter.ghostCells());
      this->add(describeMerged(found, adapter.mesh()));
      if (found.apart() > 0)
      {
        throw Error(this->notice + " Or switch Merge Coincident Points off to keep all apart.");
      }
      const Index united = joinSameIds(ids, adapter.mesh().view(), found.representative);
      if (united > 0 && anyCollapse(input, found.representative))
      {
        throw Error("A cell has two coincident points with the same global id: run Clean to Grid "
                    "first, or Generate Global Ids again.");
      }
      this->add(describeUnited(united));
      if (found.any() || united > 0)
      {
        this->add(differingArrays(input, found.representative));
        this->Made[i] = std::make_unique<Merged>(
          std::vector<Piece>{ given[i] }, std::vector<std::vector<Index>>{ found.representative });
        keepIds(ids, *this->Made[i]);
        this->Outputs.push_back(vtkSmartPointer<vtkUnstructuredGrid>::New());
        this->Outputs.back()->ShallowCopy(this->Made[i]->Input);
        this->pieces[i] = { this->Made[i]->Input, this->Made[i]->Selected, this->Outputs.back() };
      }
    }
  }

  /// Copies new arrays from the outputs of the pieces to the given outputs.
  void scatter() const
  {
    for (std::size_t i = 0; i < this->Made.size(); ++i)
    {
      if (this->Made[i])
      {
        this->Made[i]->scatter(this->pieces[i].output, { this->Given[i] });
      }
    }
  }

private:
  /// Appending drops the global ids of points.
  static void keepIds(const std::vector<Index>& ids, const Merged& made)
  {
    if (ids.empty())
    {
      return;
    }
    vtkNew<vtkIdTypeArray> kept;
    kept->SetName("GlobalPointIds");
    for (Index point : made.GlobalIds) // the numbers of the representatives
    {
      kept->InsertNextValue(ids[point]);
    }
    made.Input->GetPointData()->SetGlobalIds(kept);
  }

  void add(const std::string& sentence)
  {
    this->notice += (this->notice.empty() || sentence.empty() ? "" : " ") + sentence;
  }

  std::vector<Piece> Given;
  std::vector<std::unique_ptr<Merged>> Made; ///< null where no points are one
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> Outputs;
};
}
#endif
