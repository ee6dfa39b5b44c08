// SPDX-License-Identifier: BSD-3-Clause
#include "WholeOnAll.h"

#include "WholeMesh.h"
#include "tautline/Core/RankGroup.h"

#include "vtkCellData.h"
#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

namespace tautline
{
namespace
{
/// Points and cells with the arrays that are needed to put pieces together, and one more.
vtkSmartPointer<vtkDataSet> bare(vtkDataSet* piece, const std::string& array)
{
  auto copy = vtkSmartPointer<vtkDataSet>::Take(piece->NewInstance());
  copy->CopyStructure(piece);
  const char* ghosts = vtkDataSetAttributes::GhostArrayName();
  const auto keep = [&](vtkDataSetAttributes* from, vtkDataSetAttributes* to)
  {
    if (from->GetAbstractArray(ghosts))
    {
      to->AddArray(from->GetAbstractArray(ghosts));
    }
    to->SetGlobalIds(from->GetGlobalIds());
  };
  keep(piece->GetPointData(), copy->GetPointData());
  keep(piece->GetCellData(), copy->GetCellData());
  if (vtkAbstractArray* given = piece->GetPointData()->GetAbstractArray(array.c_str()))
  {
    copy->GetPointData()->AddArray(given);
  }
  return copy;
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> assembleOnAll(
  RankGroup& group, vtkDataSet* piece, const std::string& array)
{
  Bytes own;
  group.together(
    [&]
    {
      if (!piece || piece->GetNumberOfPoints() == 0)
      {
        return;
      }
      vtkNew<vtkCharArray> buffer;
      if (!vtkCommunicator::MarshalDataObject(bare(piece, array), buffer))
      {
        throw Error(std::string("A piece of a ") + piece->GetClassName() +
          " could not be sent to other processes: gather it, in ParaView by Aggregate Dataset.");
      }
      own.assign(buffer->GetPointer(0), buffer->GetPointer(0) + buffer->GetNumberOfValues());
    });
  const std::vector<Bytes> all = group.allGather(own);
  vtkSmartPointer<vtkDataSet> whole;
  group.together(
    [&]
    {
      std::vector<vtkSmartPointer<vtkDataObject>> received;
      std::vector<vtkDataSet*> pieces;
      for (const Bytes& bytes : all)
      {
        if (bytes.empty())
        {
          continue;
        }
        vtkNew<vtkCharArray> buffer;
        buffer->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
        std::copy(bytes.begin(), bytes.end(), buffer->GetPointer(0));
        received.push_back(vtkCommunicator::UnMarshalDataObject(buffer));
        pieces.push_back(vtkDataSet::SafeDownCast(received.back()));
      }
      if (pieces.empty())
      {
        throw Error("The data set is empty on all processes: choose another one.");
      }
      whole = assemble(pieces).mesh;
    });
  return whole;
}
}
