// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceResults.h
 * @brief Sends the results that the first process has computed for a whole mesh to its pieces.
 */
#ifndef tautline_PieceResults_h
#define tautline_PieceResults_h

#include "GatheredExecution.h"
#include "MeshGroups.h"
#include "WholeMesh.h"
#include "tautline/Core/Types.h"

#include <string>
#include <vector>

class vtkAbstractArray;
class vtkMultiProcessController;

namespace tautline
{
constexpr int FirstProcess = 0;

/// The sizes of a piece, announced by its process.
struct PieceSize
{
  int mesh, group;
  std::string type;
  Index points;
};

/// A mesh on the first process, with the pieces of all processes in order.
struct GatheredGroup
{
  std::vector<vtkSmartPointer<vtkDataSet>> pieces;
  std::vector<int> processes; ///< the processes that have the pieces
  WholeMesh whole;
};

/// The meshes of an input port; empty on other processes.
struct GatheredMesh
{
  std::vector<GatheredGroup> groups;
};

/// Sends the text of the first process to all. Collective.
TAUTLINECORE_EXPORT std::string shareText(
  vtkMultiProcessController* controller, const std::string& text);

/// The rows of an array with these indices; 0 or "" for negative indices.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkAbstractArray> rowsOf(
  vtkAbstractArray* array, const std::vector<vtkIdType>& numbers);

/**
 * @class tautline::PieceResults
 * @brief The pieces of a mesh that receive results.
 */
class PieceResults
{
public:
  /**
   * @param input the part of the mesh on this process
   * @param pieces the pieces in it
   * @param gathered the whole mesh, on the first process
   */
  PieceResults(vtkMultiProcessController* controller, vtkDataObject* input,
    const std::vector<GroupedPiece>& pieces, const GatheredMesh& gathered);

  /**
   * @brief Fills the output of each process. Collective; throws Error on all processes.
   * @param result for the whole mesh; null on all processes but the first
   * @param output of the class of the input
   */
  void distribute(GatheredResult kind, vtkDataObject* result, vtkDataObject* output) const;

private:
  struct Package;
  using Packages = std::vector<Package>;

  Packages packValues(vtkDataObject* result) const;
  Packages packCells(vtkDataObject* result) const;
  Packages exchange(Packages& packages) const;
  void unpackValues(const Packages& packages, vtkDataObject* output) const;
  void unpackCells(const Packages& packages, bool composite, vtkDataObject* output) const;

  vtkMultiProcessController* Controller;
  vtkDataObject* Input;
  const std::vector<GroupedPiece>& Pieces;
  const GatheredMesh& Gathered;
};
}
#endif
