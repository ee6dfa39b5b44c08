// SPDX-License-Identifier: BSD-3-Clause
#include "LackingArrays.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkPointData.h"

#include <set>

namespace tautline
{
namespace
{
/// In the information of a mesh: names of arrays, each followed by the piece that lacks it.
vtkInformationStringVectorKey* lackingKey(bool ofCells)
{
  static vtkInformationStringVectorKey* points =
    vtkInformationStringVectorKey::MakeKey("LACKING_POINT_ARRAYS", "tautline");
  static vtkInformationStringVectorKey* cells =
    vtkInformationStringVectorKey::MakeKey("LACKING_CELL_ARRAYS", "tautline");
  return ofCells ? cells : points;
}

vtkDataSetAttributes* dataOf(vtkDataSet* mesh, bool ofCells)
{
  return ofCells ? static_cast<vtkDataSetAttributes*>(mesh->GetCellData()) : mesh->GetPointData();
}
}

//------------------------------------------------------------------------------
void noteLackingArrays(const std::vector<vtkDataSet*>& pieces, const std::vector<int>& processes,
  bool several, vtkDataSet* mesh)
{
  for (const bool ofCells : { false, true })
  {
    std::set<std::string> names;
    for (vtkDataSet* piece : pieces)
    {
      vtkDataSetAttributes* data = dataOf(piece, ofCells);
      for (int i = 0; i < data->GetNumberOfArrays(); ++i)
      {
        const char* name = data->GetArrayName(i);
        names.insert(name ? name : "");
      }
    }
    mesh->GetInformation()->Remove(lackingKey(ofCells));
    for (const std::string& name : names)
    {
      for (std::size_t i = 0; i < pieces.size(); ++i)
      {
        if (pieces[i]->GetNumberOfCells() > 0 &&
          !dataOf(pieces[i], ofCells)->HasArray(name.c_str()))
        {
          mesh->GetInformation()->Append(lackingKey(ofCells), name.c_str());
          mesh->GetInformation()->Append(lackingKey(ofCells),
            (several ? " in process " + std::to_string(processes[i])
                     : " in partition " + std::to_string(i + 1))
              .c_str());
          break;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
std::string lackingPiece(vtkDataSet* mesh, const std::string& array, bool ofCells)
{
  vtkInformation* info = mesh->GetInformation();
  for (int i = 0; i + 1 < info->Length(lackingKey(ofCells)); i += 2)
  {
    if (array == info->Get(lackingKey(ofCells), i))
    {
      return info->Get(lackingKey(ofCells), i + 1);
    }
  }
  return "";
}
}
