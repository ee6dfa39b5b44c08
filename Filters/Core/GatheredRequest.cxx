// SPDX-License-Identifier: BSD-3-Clause
// Requests to filters that do not derive from vtkTautlineAlgorithm.
#include "GatheredExecution.h"

#include "Processes.h"
#include "tautline/Core/Memory.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"

namespace tautline
{
//------------------------------------------------------------------------------
int processGathered(vtkAlgorithm* algorithm, const ExecutionLimits& limits, GatheredResult result,
  const InputRules& rules, vtkInformation* request, vtkInformationVector** inputs,
  vtkInformationVector* outputs, const std::function<int()>& work,
  const std::function<bool()>& takesPieces)
{
  const auto execute = [&] { return processInScope(algorithm, limits, request, outputs, work); };
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()) || !isGathered(algorithm, result))
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
    return takesPieces && takesPieces() ? execute()
                                        : executeGathered(algorithm, request, inputs, outputs,
                                            { result, 0, nullptr, nullptr }, execute);
  }
  vtkErrorWithObjectMacro(algorithm, << problem);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    emptyOutput(outputs->GetInformationObject(port));
  }
  return 0;
}

//------------------------------------------------------------------------------
bool takeOrFail(std::string& error, const std::function<bool()>& take)
{
  error.clear();
  try
  {
    return take();
  }
  catch (const std::exception& problem)
  {
    error = errorText(problem, "divide the mesh");
    return true;
  }
}
}
