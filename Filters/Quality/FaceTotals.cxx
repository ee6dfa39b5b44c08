// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTotals.h"

#include "TableRows.h"

#include "vtkAppendPolyData.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <sstream>

namespace tautline
{
//------------------------------------------------------------------------------
void FaceTotals::add(const std::vector<MeshCheck>& checks)
{
  this->Report.checks = this->empty() ? checks : joinChecks({ this->Report.checks, checks });
}

//------------------------------------------------------------------------------
void FaceTotals::tabulate(vtkTable* table) const
{
  TableRows rows;
  for (const MeshCheck& check : this->Report.checks)
  {
    rows.begin();
    rows.addText("Check", check.name);
    rows.addText("Label", check.label);
    rows.add("Minimum", check.least);
    rows.add("Maximum", check.most);
    rows.add("Mean", check.mean);
    rows.add("Limit", check.limit);
    rows.add("Offending", static_cast<double>(check.offending));
    rows.add("Severe", static_cast<double>(check.warned));
    rows.add("OnRequest", check.thorough ? 1 : 0);
    rows.add("Failed", check.failed() ? 1 : 0);
    rows.add("Bit", static_cast<double>(1u << static_cast<int>(check.kind)));
  }
  rows.fill(table);
}

//------------------------------------------------------------------------------
void FaceTotals::copyTo(vtkPolyData* output) const
{
  if (this->Faces.size() == 1)
  {
    output->ShallowCopy(this->Faces.front());
  }
  else if (!this->Faces.empty())
  {
    vtkNew<vtkAppendPolyData> append;
    for (const auto& faces : this->Faces)
    {
      append->AddInputData(faces);
    }
    append->Update();
    output->ShallowCopy(append->GetOutput());
  }
}

//------------------------------------------------------------------------------
std::string FaceTotals::summary() const
{
  if (this->empty())
  {
    return "";
  }
  std::ostringstream text;
  text << "checkMesh: " << this->Report.verdict(false)
       << " With all checks: " << this->Report.verdict(true);
  for (const MeshCheck& check : this->Report.checks)
  {
    if (check.offending > 0)
    {
      text << "\n"
           << (check.onlyWarns ? "Warning: " : "Failed: ") << check.label << ": "
           << check.offending;
      const bool ranged = check.least != 0 || check.most != 0;
      if (ranged)
      {
        text << " beyond " << check.limit << " (" << check.least << " to " << check.most << ")";
      }
      text << (check.thorough ? "; on request only." : ".");
    }
  }
  const MeshCheck& angles = this->Report[MeshCheckKind::NonOrthogonality];
  if (angles.warned > 0)
  {
    text << "\nWarning: " << angles.warned << " faces with a non-orthogonality above 70 degrees.";
  }
  return text.str();
}
}
