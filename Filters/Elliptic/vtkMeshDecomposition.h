// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshDecomposition
 * @brief Divides a mesh into parts for several processes, and counts the communication cost of a
 * division.
 *
 * For the study `decomposition`: nothing is sent, so that divisions into more parts than there are
 * processes can be compared. Errors are error events; the array or the table is then empty.
 *
 * @par Example (Python):
 * @code
 * decomposition = vtkMeshDecomposition()
 * decomposition.SetNumberOfParts(16)
 * decomposition.DivideGraph(mesh, parts)
 * decomposition.Count(mesh, parts, table)
 * @endcode
 *
 * @sa tautline/Mesh/DecompositionCounts.h, tautline/Solvers/GraphPartition.h
 */

#ifndef vtkMeshDecomposition_h
#define vtkMeshDecomposition_h

#include "TautlineEllipticModule.h" // for export macro
#include "vtkObject.h"
#include "vtkTautlineSetRange.h" // for the setters

class vtkDataSet;
class vtkIntArray;
class vtkTable;

class TAUTLINEELLIPTIC_EXPORT vtkMeshDecomposition : public vtkObject
{
public:
  static vtkMeshDecomposition* New();
  vtkTypeMacro(vtkMeshDecomposition, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The number of parts, 1 to 1,000,000; the default is 2.
  vtkTautlineSetRangeMacro(NumberOfParts, int, 1, 1000000);
  vtkGetMacro(NumberOfParts, int);
  ///@}

  /// Divides the graph of the cells by PT-Scotch, see tautline::partitionGraph(). @param parts
  /// receives the part number of each cell
  void DivideGraph(vtkDataSet* mesh, vtkIntArray* parts);

  /**
   * Counts the cost of sweeps over the interior points of the mesh, see
   * tautline::countDecomposition().
   * @param parts the part number of each cell, from 0
   * @param table receives a row per part with the columns `Cells`, `Points`, `Free Points`, `Halo
   * Points`, `Neighbours`, `Messages`, `Sent Points`
   */
  void Count(vtkDataSet* mesh, vtkIntArray* parts, vtkTable* table);

  ///@{
  /// Results of the last Count(): the number of independent sets, the number of points that move in
  /// a sweep, and the number of sequential moves if the processes synchronize after each set.
  vtkGetMacro(NumberOfSets, vtkIdType);
  vtkGetMacro(FreePoints, vtkIdType);
  vtkGetMacro(SlowestPoints, vtkIdType);
  ///@}

protected:
  vtkMeshDecomposition() = default;
  ~vtkMeshDecomposition() override = default;

private:
  vtkMeshDecomposition(const vtkMeshDecomposition&) = delete;
  void operator=(const vtkMeshDecomposition&) = delete;

  int NumberOfParts = 2;
  vtkIdType NumberOfSets = 0, FreePoints = 0, SlowestPoints = 0;
};

#endif
