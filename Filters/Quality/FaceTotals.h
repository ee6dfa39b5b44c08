// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceTotals
 * @brief Gathers the checks of checkMesh and the faces of blocks and processes.
 */
#ifndef tautline_FaceTotals_h
#define tautline_FaceTotals_h

#include "tautline/FiniteVolume/MeshChecks.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkMultiProcessController;
class vtkPolyData;
class vtkTable;

namespace tautline
{
class FaceTotals
{
public:
  /// Adds the checks of a block.
  void add(const MeshCheckReport& report, const FaceMesh& mesh);
  /// Adds faces to the output.
  void add(vtkSmartPointer<vtkPolyData> faces) { this->Faces.push_back(std::move(faces)); }

  /// Adds up the processes. Collective; without a controller, nothing.
  void gather(vtkMultiProcessController* controller);

  bool empty() const { return this->Report.checks.empty(); }
  /// A row for each check; none if no block was checked.
  void tabulate(vtkTable* table) const;
  void copyTo(vtkPolyData* output) const;
  /// The verdict, and the checks that fail, in lines for the user; "" if no block was checked.
  std::string summary() const;
  const MeshCheckReport& report() const { return this->Report; }

private:
  MeshCheckReport Report;      ///< without faces and cells
  std::vector<double> Weights; ///< of the mean of each check
  std::vector<vtkSmartPointer<vtkPolyData>> Faces;
};
}
#endif
