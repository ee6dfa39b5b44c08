// SPDX-License-Identifier: BSD-3-Clause
// Which filters gather their meshes, and requests to those that do not derive from
// vtkTautlineAlgorithm.
#include "GatheredExecution.h"

#include "MeshGroups.h"
#include "Processes.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"

namespace tautline
{
namespace
{
/// Whether a mesh of any input is in partitions.
bool takesPartitions(vtkAlgorithm* algorithm)
{
  bool any = false;
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port)
  {
    any = any ||
      (algorithm->GetNumberOfInputConnections(port) > 0 &&
        hasPartitions(algorithm->GetInputDataObject(port, 0)));
  }
  return any;
}
}

//------------------------------------------------------------------------------
bool isGathered(vtkAlgorithm* algorithm, const GatheredRules& rules)
{
  if (rules.result == GatheredResult::None || algorithm->GetNumberOfInputPorts() == 0 ||
    !(severalProcesses() || (rules.joinsPartitions && takesPartitions(algorithm))))
  {
    return false;
  }
  // VTK calls a filter that accepts only data sets once per block, so that each process makes as
  // many calls as it has blocks.
  vtkInformation* port = algorithm->GetInputPortInformation(0);
  const char* first = port->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
  const std::string type = first ? first : "";
  const bool takesBlocks = type == "vtkCompositeDataSet" || type == "vtkMultiBlockDataSet";
  return takesBlocks || !vtkCompositeDataSet::SafeDownCast(algorithm->GetInputDataObject(0, 0));
}

//------------------------------------------------------------------------------
int processGathered(vtkAlgorithm* algorithm, const ExecutionLimits& limits, GatheredResult result,
  const InputRules& rules, vtkInformation* request, vtkInformationVector** inputs,
  vtkInformationVector* outputs, const std::function<int()>& work)
{
  const auto execute = [&] { return processInScope(algorithm, limits, request, outputs, work); };
  GatheredRules gathered;
  gathered.result = result;
  gathered.joinsPartitions = false;
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()) || !isGathered(algorithm, gathered))
  {
    return execute();
  }
  std::string problem;
  for (int port = 0; port < algorithm->GetNumberOfInputPorts() && problem.empty(); ++port)
  {
    vtkDataObject* data = vtkDataObject::GetData(inputs[port], 0);
    problem = data ? inputProblem(data, rules) : "";
  }
  problem = firstProblem(problem);
  if (problem.empty())
  {
    return executeGathered(algorithm, request, inputs, outputs, gathered, execute);
  }
  vtkErrorWithObjectMacro(algorithm, << problem);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    emptyOutput(outputs->GetInformationObject(port));
  }
  return 0;
}
}
