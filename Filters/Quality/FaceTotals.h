// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceTotals
 * @brief Adds up the results of checkMesh's checks on several meshes, and collects their faces.
 */
#ifndef tautline_FaceTotals_h
#define tautline_FaceTotals_h

#include "tautline/FiniteVolume/MeshChecks.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace tautline
{
class FaceTotals
{
public:
  /// Adds the checks of a mesh.
  void add(const std::vector<MeshCheck>& checks);
  /// Adds faces to the output.
  void add(vtkSmartPointer<vtkPolyData> faces) { this->Faces.push_back(std::move(faces)); }

  bool empty() const { return this->Report.checks.empty(); }
  /// A row for each check; none if no mesh was checked.
  void tabulate(vtkTable* table) const;
  void copyTo(vtkPolyData* output) const;
  /// The verdict and the failed checks, in lines for the user; "" if no mesh was checked.
  std::string summary() const;
  const MeshCheckReport& report() const { return this->Report; }

private:
  MeshCheckReport Report; ///< without faces and cells
  std::vector<vtkSmartPointer<vtkPolyData>> Faces;
};
}
#endif
