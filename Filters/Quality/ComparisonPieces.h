// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComparisonPieces.h
 * @brief Two meshes that are compared, in pieces on several processes.
 */
#ifndef tautline_ComparisonPieces_h
#define tautline_ComparisonPieces_h

#include "MeshAdapter.h"
#include "MeshGroups.h"
#include "tautline/Mesh/RankPieces.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// A piece of both meshes: the same cells with the same points.
struct ComparedPiece
{
  int group = 0; ///< the mesh that it is a piece of
  vtkDataSet* after = nullptr;
  vtkSmartPointer<vtkDataSet> before;
  std::unique_ptr<MeshAdapter> was, is;
  std::vector<unsigned char> skip; ///< one flag per cell: a copy (ghost cell) in either mesh
  std::vector<Index> ids;          ///< global ones of the points; empty if there are none
};

/**
 * @class tautline::ComparisonPieces
 * @brief The pieces of this process, each with the whole's space and orientation. Where the meshes
 * are cut alike, nothing but that is exchanged; else the points of the first mesh go to the pieces
 * of the second.
 */
class ComparisonPieces
{
public:
  /**
   * @brief Null, on all processes, where the meshes have to be gathered. Collective.
   *
   * Throws Error, on all processes, where the meshes differ in points or cells, or cannot be
   * matched.
   * @param why gets the reason where they have to be gathered, in words, or ""
   */
  static std::unique_ptr<ComparisonPieces> take(
    RankGroup& group, vtkDataObject* before, vtkDataObject* after, int threads, std::string& why);

  std::vector<ComparedPiece>& pieces() { return this->Pieces; }

private:
  explicit ComparisonPieces(RankGroup& group, int threads)
    : Group(group)
    , Threads(threads)
  {
  }
  using Leaves = std::vector<GroupedPiece>;

  void pairOrMatch(const Leaves& before, const Leaves& after, int groups);
  bool pair(const Leaves& before, const Leaves& after, bool& sameIds);
  void match(const Leaves& before, const Leaves& after, int groups);
  void requireDistinctCells(int groups);
  std::string settle(int groups);
  std::vector<RankPiece> ofGroup(int group, bool after);
  std::string settleOrientation(int group);

  RankGroup& Group;
  int Threads;
  std::vector<ComparedPiece> Pieces;
};
}
#endif
