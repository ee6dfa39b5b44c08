// SPDX-License-Identifier: BSD-3-Clause
#include "HostileParts.h"
#include "VtkCompatibility.h"
#include "VtkMeshes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <sstream>

namespace tautline
{

namespace
{
/** Shows a data set as it is at time 0, and twice at time 1. */
class TimeSource : public vtkAlgorithm
{
public:
  static TimeSource* New();
  vtkTypeMacro(TimeSource, vtkAlgorithm);
  vtkSmartPointer<vtkDataObject> First, Second;

protected:
  TimeSource() { TAUTLINE_SET(this, SetNumberOfInputPorts(0), SetNumberOfOutputPorts(1)); }
  int FillOutputPortInformation(int, vtkInformation* info) override
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkUnstructuredGrid");
    return 1;
  }
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** in, vtkInformationVector* out) override
  {
    using Pipeline = vtkStreamingDemandDrivenPipeline;
    vtkInformation* info = out->GetInformationObject(0);
    if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
    {
      const double times[] = { 0, 1 };
      TAUTLINE_SET(info, Set(Pipeline::TIME_STEPS(), times, 2),
        Set(Pipeline::TIME_RANGE(), times, 2), Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1));
      return 1;
    }
    if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
    {
      const double time =
        info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 0;
      vtkDataObject* data = vtkDataObject::GetData(out);
      data->ShallowCopy(time < 0.5 ? this->First : this->Second);
      data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time < 0.5 ? 0.0 : 1.0);
      return 1;
    }
    return this->Superclass::ProcessRequest(request, in, out);
  }
};
vtkStandardNewMacro(TimeSource);

//------------------------------------------------------------------------------
/** FNV-1a, of 64 bits. */
void hash(std::uint64_t& sum, const void* data, std::size_t bytes)
{
  const auto* byte = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i)
  {
    sum = (sum ^ byte[i]) * 1099511628211u;
  }
}

void hash(std::uint64_t& sum, vtkAbstractArray* array)
{
  const vtkIdType size = array ? array->GetNumberOfValues() : -1;
  hash(sum, &size, sizeof(size));
  for (vtkIdType i = 0; i < size; ++i)
  {
    const std::string value = array->GetVariantValue(i).ToString();
    hash(sum, value.data(), value.size());
  }
}

void hash(std::uint64_t& sum, vtkCellArray* list)
{
  if (list)
  {
    hash(sum, list->GetOffsetsArray());
    hash(sum, list->GetConnectivityArray());
  }
}

void hash(std::uint64_t& sum, vtkDataSet* data)
{
  for (vtkFieldData* field : { static_cast<vtkFieldData*>(data->GetPointData()),
         static_cast<vtkFieldData*>(data->GetCellData()), data->GetFieldData() })
  {
    for (int i = 0; i < field->GetNumberOfArrays(); ++i)
    {
      hash(sum, field->GetAbstractArray(i));
    }
  }
  auto* set = vtkPointSet::SafeDownCast(data);
  hash(sum, set && set->GetPoints() ? set->GetPoints()->GetData() : nullptr);
  if (auto* mesh = vtkUnstructuredGrid::SafeDownCast(data))
  {
    hash(sum, mesh->GetCells());
    hash(sum, cellTypesOf(mesh));
  }
  if (auto* poly = vtkPolyData::SafeDownCast(data))
  {
    for (vtkCellArray* list :
      { poly->GetVerts(), poly->GetLines(), poly->GetPolys(), poly->GetStrips() })
    {
      hash(sum, list);
    }
  }
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkAlgorithm> timeSource(vtkDataObject* data)
{
  auto source = vtkSmartPointer<TimeSource>::New();
  source->First = data;
  source->Second = doubledMesh(data, 100, true);
  return source;
}

//------------------------------------------------------------------------------
std::vector<vtkDataSet*> leavesOf(vtkDataObject* data)
{
  std::vector<vtkDataSet*> leaves;
  if (auto* single = vtkDataSet::SafeDownCast(data))
  {
    leaves.push_back(single);
  }
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
    {
      if (auto* leaf = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject()))
      {
        leaves.push_back(leaf);
      }
    }
  }
  return leaves;
}

//------------------------------------------------------------------------------
std::string fingerprint(vtkDataObject* data)
{
  std::uint64_t sum = 14695981039346656037u;
  for (vtkDataSet* leaf : leavesOf(data))
  {
    hash(sum, leaf);
  }
  std::ostringstream text;
  text << data->GetClassName() << " " << sum << " of time " << data->GetMTime();
  return text.str();
}

} // namespace tautline
