// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTotals.h"

#include "TableRows.h"

#include "vtkAppendPolyData.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <sstream>

namespace tautline
{
namespace
{
/// How many items a check of a mesh has a value for, the weight of its mean.
double weightOf(const MeshCheck& check, const FaceMesh& mesh)
{
  switch (check.item)
  {
    case CheckedItem::Cells:
      return static_cast<double>(mesh.cells);
    case CheckedItem::Faces:
      return static_cast<double>(mesh.faces());
    default:
      return 1;
  }
}

void join(MeshCheck& all, double& weight, const MeshCheck& more, double moreWeight)
{
  if (moreWeight > 0)
  {
    all.least = weight > 0 ? std::min(all.least, more.least) : more.least;
    all.most = weight > 0 ? std::max(all.most, more.most) : more.most;
    all.mean = (weight * all.mean + moreWeight * more.mean) / (weight + moreWeight);
    all.limit = more.limit;
    weight += moreWeight;
  }
  all.offending += more.offending;
  all.warned += more.warned;
}
}

//------------------------------------------------------------------------------
void FaceTotals::add(const MeshCheckReport& report, const FaceMesh& mesh)
{
  if (mesh.cells == 0)
  {
    return;
  }
  if (this->empty())
  {
    this->Report.checks = emptyMeshChecks();
    this->Weights.assign(report.checks.size(), 0);
  }
  for (std::size_t i = 0; i < report.checks.size(); ++i)
  {
    join(
      this->Report.checks[i], this->Weights[i], report.checks[i], weightOf(report.checks[i], mesh));
  }
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

//------------------------------------------------------------------------------
void FaceTotals::gather(vtkMultiProcessController* controller)
{
  if (!controller || controller->GetNumberOfProcesses() < 2)
  {
    return;
  }
  constexpr int fields = 7;
  constexpr auto kinds = static_cast<std::size_t>(MeshCheckKind::Number);
  std::vector<double> mine(fields * kinds, 0.0);
  for (std::size_t i = 0; i < this->Report.checks.size(); ++i)
  {
    const MeshCheck& check = this->Report.checks[i];
    const double values[fields] = { this->Weights[i], check.least, check.most, check.mean,
      check.limit, static_cast<double>(check.offending), static_cast<double>(check.warned) };
    std::copy(values, values + fields, mine.begin() + static_cast<std::ptrdiff_t>(fields * i));
  }
  std::vector<double> all(mine.size() * controller->GetNumberOfProcesses());
  controller->AllGather(mine.data(), all.data(), static_cast<vtkIdType>(mine.size()));
  FaceTotals sum;
  for (int process = 0; process < controller->GetNumberOfProcesses(); ++process)
  {
    const double* values = all.data() + mine.size() * process;
    if (std::none_of(values, values + mine.size(), [](double x) { return x != 0; }))
    {
      continue;
    }
    if (sum.empty())
    {
      sum.Report.checks = emptyMeshChecks();
      sum.Weights.assign(kinds, 0);
    }
    for (std::size_t i = 0; i < kinds; ++i, values += fields)
    {
      MeshCheck more = sum.Report.checks[i];
      more.least = values[1];
      more.most = values[2];
      more.mean = values[3];
      more.limit = values[4];
      more.offending = static_cast<Index>(values[5]);
      more.warned = static_cast<Index>(values[6]);
      join(sum.Report.checks[i], sum.Weights[i], more, values[0]);
    }
  }
  this->Report = sum.Report;
  this->Weights = sum.Weights;
}
}
