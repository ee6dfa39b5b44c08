// SPDX-License-Identifier: BSD-3-Clause
#include "SelectionMarks.h"

#include "Blocks.h"

#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkUnsignedCharArray.h"

#include <string>

namespace tautline
{
namespace
{
std::string markName(int port)
{
  return "Tautline selected by input " + std::to_string(port);
}
}

//------------------------------------------------------------------------------
void addMarks(vtkDataSetAttributes* marked, vtkIdType count, int port, vtkDataSetAttributes* result)
{
  vtkNew<vtkUnsignedCharArray> marks; // VTK 9.1 sends signed char as char, a different type
  marks->SetName(markName(port).c_str());
  marks->SetNumberOfTuples(count);
  vtkDataArray* given = marked ? marked->GetArray(SelectedArray) : nullptr;
  for (vtkIdType i = 0; i < count; ++i)
  {
    marks->SetValue(i, static_cast<unsigned char>(given && given->GetComponent(i, 0) > 0));
  }
  result->AddArray(marks);
}

//------------------------------------------------------------------------------
void uniteMarks(const std::vector<vtkDataSet*>& pieces, const WholeMesh& whole, int port)
{
  const std::string name = markName(port);
  vtkDataArray* all = whole.mesh->GetPointData()->GetArray(name.c_str());
  for (std::size_t i = 0; all && i < pieces.size(); ++i)
  {
    vtkDataArray* own = pieces[i]->GetPointData()->GetArray(name.c_str());
    for (std::size_t k = 0; own && k < whole.pieces[i].points.size(); ++k)
    {
      if (own->GetComponent(static_cast<vtkIdType>(k), 0) > 0)
      {
        all->SetComponent(whole.pieces[i].points[k], 0, 1.0);
      }
    }
  }
}

//------------------------------------------------------------------------------
void removeMarks(vtkDataObject* whole, int port)
{
  forEachLeaf(whole,
    [port](unsigned int, vtkDataSet* leaf)
    {
      leaf->GetPointData()->RemoveArray(markName(port).c_str());
      leaf->GetCellData()->RemoveArray(markName(port).c_str());
    });
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkSelection> selectionOf(vtkDataObject* whole, int port)
{
  auto selection = vtkSmartPointer<vtkSelection>::New();
  const bool composite = vtkCompositeDataSet::SafeDownCast(whole) != nullptr;
  forEachLeaf(whole,
    [&](unsigned int index, vtkDataSet* leaf)
    {
      for (const int field : { int(vtkSelectionNode::POINT), int(vtkSelectionNode::CELL) })
      {
        vtkDataSetAttributes* data = field == vtkSelectionNode::POINT
          ? static_cast<vtkDataSetAttributes*>(leaf->GetPointData())
          : leaf->GetCellData();
        vtkDataArray* marks = data->GetArray(markName(port).c_str());
        vtkNew<vtkIdTypeArray> ids;
        for (vtkIdType i = 0; marks && i < marks->GetNumberOfTuples(); ++i)
        {
          if (marks->GetComponent(i, 0) > 0)
          {
            ids->InsertNextValue(i);
          }
        }
        if (ids->GetNumberOfTuples() == 0)
        {
          continue;
        }
        vtkNew<vtkSelectionNode> node;
        node->SetContentType(vtkSelectionNode::INDICES);
        node->SetFieldType(field);
        node->SetSelectionList(ids);
        if (composite)
        {
          node->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), static_cast<int>(index));
        }
        selection->AddNode(node);
      }
    });
  return selection;
}
}
