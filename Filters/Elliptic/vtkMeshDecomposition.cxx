// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshDecomposition.h"

#include "MeshAdapter.h"
#include "TableRows.h"
#include "tautline/Core/Memory.h"
#include "tautline/Mesh/DecompositionCounts.h"
#include "tautline/Solvers/GraphPartition.h"

#include "vtkDataSet.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

#include <vector>

vtkStandardNewMacro(vtkMeshDecomposition);

namespace
{
constexpr char Remedy[] = "use a smaller mesh";
}

//------------------------------------------------------------------------------
void vtkMeshDecomposition::DivideGraph(vtkDataSet* mesh, vtkIntArray* parts)
{
  if (!mesh || !parts)
  {
    vtkErrorMacro("DivideGraph needs a mesh and an array for the parts.");
    return;
  }
  parts->Initialize();
  try
  {
    const tautline::MeshAdapter adapter(mesh);
    const std::vector<int> found = tautline::partitionGraph(adapter.mesh(), this->NumberOfParts);
    parts->SetNumberOfValues(static_cast<vtkIdType>(found.size()));
    std::copy(found.begin(), found.end(), parts->GetPointer(0));
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< tautline::errorText(error, Remedy));
  }
}

//------------------------------------------------------------------------------
void vtkMeshDecomposition::Count(vtkDataSet* mesh, vtkIntArray* parts, vtkTable* table)
{
  this->NumberOfSets = this->FreePoints = this->SlowestPoints = 0;
  if (!mesh || !parts || !table)
  {
    vtkErrorMacro("Count needs a mesh, the parts of its cells and a table.");
    return;
  }
  table->Initialize();
  try
  {
    const tautline::MeshAdapter adapter(mesh);
    const std::vector<char> boundary = adapter.mesh().boundary().isBoundaryPoint;
    std::vector<unsigned char> free(boundary.size());
    for (std::size_t p = 0; p < free.size(); ++p)
    {
      free[p] = !boundary[p];
    }
    const int* first = parts->GetPointer(0);
    const auto counts = tautline::countDecomposition(adapter.mesh().view(),
      std::vector<int>(first, first + parts->GetNumberOfValues()), this->NumberOfParts, free);
    tautline::TableRows rows;
    for (const tautline::PartCounts& part : counts.parts)
    {
      rows.begin();
      rows.add("Cells", static_cast<double>(part.cells));
      rows.add("Points", static_cast<double>(part.points));
      rows.add("Free Points", static_cast<double>(part.freePoints));
      rows.add("Halo Points", static_cast<double>(part.haloPoints));
      rows.add("Neighbours", static_cast<double>(part.neighbours));
      rows.add("Messages", static_cast<double>(part.messages));
      rows.add("Sent Points", static_cast<double>(part.sentPoints));
    }
    rows.fill(table);
    this->NumberOfSets = counts.sets;
    this->FreePoints = counts.freePoints;
    this->SlowestPoints = counts.slowestPoints;
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< tautline::errorText(error, Remedy));
  }
}

//------------------------------------------------------------------------------
void vtkMeshDecomposition::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfParts: " << this->NumberOfParts << "\n";
  os << indent << "NumberOfSets: " << this->NumberOfSets << "\n";
  os << indent << "FreePoints: " << this->FreePoints << "\n";
  os << indent << "SlowestPoints: " << this->SlowestPoints << "\n";
}
