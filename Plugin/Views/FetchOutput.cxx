// SPDX-License-Identifier: BSD-3-Clause
#include "FetchOutput.h"

#include "pqPipelineSource.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"

#include "vtkAlgorithm.h"
#include "vtkPVDataInformation.h"
#include "vtkSMOutputPort.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <cstring>

namespace tautline
{
namespace
{

vtkSmartPointer<vtkSMSourceProxy> newFilter(
  const char* name, vtkSMSourceProxy* input, unsigned int port)
{
  vtkSmartPointer<vtkSMSourceProxy> filter;
  filter.TakeReference(
    vtkSMSourceProxy::SafeDownCast(input->GetSessionProxyManager()->NewProxy("filters", name)));
  vtkSMPropertyHelper(filter, "Input").Set(input, port);
  return filter;
}

} // anonymous namespace

//------------------------------------------------------------------------------
int outputPort(vtkSMSourceProxy* source, const char* name)
{
  for (unsigned int port = 0; port < source->GetNumberOfOutputPorts(); ++port)
  {
    const char* known = source->GetOutputPortName(port);
    if (known && std::strcmp(known, name) == 0)
    {
      return static_cast<int>(port);
    }
  }
  return -1;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> fetchOutput(pqPipelineSource* source, const char* port)
{
  const int number = outputPort(source->getSourceProxy(), port);
  if (number < 0 || source->modifiedState() != pqProxy::UNMODIFIED)
  {
    return nullptr;
  }
  constexpr int firstProcess = 0;
  return fetchPart(source->getSourceProxy(), static_cast<unsigned int>(number), firstProcess,
    source->getServer()->getTimeKeeper()->getTime());
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> fetchPart(
  vtkSMSourceProxy* source, unsigned int port, int process, double time)
{
  // Neither filter belongs to the user's pipeline.
  const pqScopedUndoExclude notUndone;
  auto reduced = newFilter("ReductionFilter", source, port);
  vtkSMPropertyHelper(reduced, "PassThrough").Set(process);
  reduced->UpdateVTKObjects();
  reduced->UpdatePipeline(time);
  vtkPVDataInformation* info = reduced->GetDataInformation(0);
  auto moved = newFilter("ClientServerMoveData", reduced, 0);
  vtkSMPropertyHelper(moved, "OutputDataType")
    .Set(info->IsCompositeDataSet() ? info->GetCompositeDataSetType() : info->GetDataSetType());
  moved->UpdateVTKObjects();
  moved->UpdatePipeline(time);
  auto* algorithm = vtkAlgorithm::SafeDownCast(moved->GetClientSideObject());
  vtkDataObject* data = algorithm ? algorithm->GetOutputDataObject(0) : nullptr;
  if (!data)
  {
    return nullptr;
  }
  vtkSmartPointer<vtkDataObject> result;
  result.TakeReference(data->NewInstance());
  result->ShallowCopy(data);
  return result;
}

} // namespace tautline
