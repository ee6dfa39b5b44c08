#include "ExecutionScope.h"

#include "vtkInterruption.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <sstream>

namespace tautline
{
namespace
{
PollHook hookOfProcess = nullptr;

bool isAlone()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return !controller || controller->GetNumberOfProcesses() <= 1;
}

void pollAlgorithm(vtkAlgorithm* algorithm, const ExecutionLimits& limits, const Stopwatch& time)
{
  algorithm->InvokeEvent(vtkInterruption::PollEvent);
  const bool keepsBest = limits.keepsBest && limits.keepsBest();
  if (hookOfProcess)
  {
    hookOfProcess(algorithm, keepsBest);
  }
  if (keepsBest)
  {
    return;
  }
  if (algorithm->GetAbortExecute())
  {
    throw Interrupted();
  }
  if (time.reached(limits.seconds))
  {
    std::ostringstream text;
    text << "The time limit of " << limits.seconds
         << " s is reached: set a higher Time Limit (0 is none), or take a smaller input.";
    throw Error(text.str());
  }
}
}

//------------------------------------------------------------------------------
int processInScope(vtkAlgorithm* algorithm, const ExecutionLimits& limits, vtkInformation* request,
  vtkInformationVector* outputs, const std::function<int()>& work)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()) || !isAlone())
  {
    return work();
  }
  try
  {
    const Stopwatch time;
    const PollScope scope([&] { pollAlgorithm(algorithm, limits, time); });
    return work();
  }
  catch (const Interrupted&)
  {
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
      {
        output->Initialize();
      }
    }
    // A filter that executes itself once per time step ends here.
    request->Remove(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING());
    algorithm->SetAbortExecute(1);
    return 1;
  }
}

//------------------------------------------------------------------------------
void setPollHook(PollHook hook)
{
  hookOfProcess = hook;
}
}
