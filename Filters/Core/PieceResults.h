// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceResults.h
 * @brief Sends what the first process has computed for a whole mesh to the pieces it came from.
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

/// A piece that a process announces.
struct PieceSize
{
  int mesh, group;
  std::string type;
  Index points;
};

/// A mesh on the first process, with the pieces of all processes in their order.
struct GatheredGroup
{
  std::vector<vtkSmartPointer<vtkDataSet>> pieces;
  std::vector<int> processes; ///< that have them
  WholeMesh whole;
};

/// The meshes of an input port; empty on other processes.
struct GatheredMesh
{
  std::vector<GatheredGroup> groups;
};

/// The text of the first process, on all. Collective.
TAUTLINECORE_EXPORT std::string shareText(
  vtkMultiProcessController* controller, const std::string& text);

/// The rows of an array for points or cells with these numbers in it; 0 or "" for those below 0.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkAbstractArray> rowsOf(
  vtkAbstractArray* array, const std::vector<vtkIdType>& numbers);

/**
 * @class tautline::PieceResults
 * @brief The pieces of a mesh that get results.
 */
class PieceResults
{
public:
  /**
   * @param input what this process has of the mesh
   * @param pieces the pieces in it
   * @param gathered the whole, on the first process
   */
  PieceResults(vtkMultiProcessController* controller, vtkDataObject* input,
    const std::vector<GroupedPiece>& pieces, const GatheredMesh& gathered);

  /**
   * @brief Fills the output of each process. Collective; throws Error on all processes.
   * @param result that of the whole mesh; null on all but the first process
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
