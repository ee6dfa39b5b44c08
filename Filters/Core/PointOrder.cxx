// SPDX-License-Identifier: BSD-3-Clause
#include "PointOrder.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkPointData.h"

namespace tautline
{
namespace
{
/// Key of a PointOrder in the information of a mesh.
vtkInformationIntegerKey* orderKey()
{
  static vtkInformationIntegerKey* key = vtkInformationIntegerKey::MakeKey("POINTS", "tautline");
  return key;
}
}

//------------------------------------------------------------------------------
void setPointOrder(vtkDataSet* mesh, bool shared)
{
  const bool ids = mesh->GetPointData()->GetGlobalIds() != nullptr; // that all pieces have
  const PointOrder order = shared ? PointOrder::Shared
    : ids                         ? PointOrder::ById
                                  : PointOrder::Coordinates;
  mesh->GetInformation()->Set(orderKey(), static_cast<int>(order));
}

//------------------------------------------------------------------------------
PointOrder pointOrder(vtkDataSet* mesh)
{
  vtkInformation* info = mesh->GetInformation();
  return info->Has(orderKey()) ? static_cast<PointOrder>(info->Get(orderKey())) : PointOrder::Given;
}

//------------------------------------------------------------------------------
PointOrder commonOrder(vtkDataSet* mesh, vtkDataSet* other)
{
  const PointOrder a = pointOrder(mesh), b = pointOrder(other);
  if (a == PointOrder::Given && b == PointOrder::Given)
  {
    return PointOrder::Given;
  }
  // A mesh from a single place is in the order of its ids if they increase.
  const auto byId = [](vtkDataSet* set, PointOrder order)
  {
    vtkDataArray* ids = set->GetPointData()->GetGlobalIds();
    bool increase = ids && order == PointOrder::Given;
    for (vtkIdType i = 1; increase && i < set->GetNumberOfPoints(); ++i)
    {
      increase = ids->GetComponent(i - 1, 0) < ids->GetComponent(i, 0);
    }
    return increase || order == PointOrder::ById;
  };
  return b == PointOrder::Shared || (byId(mesh, a) && byId(other, b)) ? PointOrder::ById
                                                                      : PointOrder::Coordinates;
}
}
