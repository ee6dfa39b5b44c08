// SPDX-License-Identifier: BSD-3-Clause
#include "ExecutionScope.h"

#include "MenuNames.h"
#include "Processes.h"
#include "vtkInterruption.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <sstream>

namespace tautline
{
namespace
{
PollHook hookOfProcess = nullptr;

/// Gives access to the protected setter of the error code.
struct ErrorCode : public vtkAlgorithm
{
  static void set(vtkAlgorithm* algorithm, unsigned long code)
  {
    (algorithm->*(&ErrorCode::SetErrorCode))(code);
  }
};

/// Requests no part of the images among the outputs, which are empty: the executive executes again
/// for an image that lacks the requested part.
void askForNothing(vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const int nothing[6] = { 0, -1, 0, -1, 0, -1 };
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    if (vtkImageData::SafeDownCast(vtkDataObject::GetData(info)))
    {
      info->Set(Pipeline::WHOLE_EXTENT(), nothing, 6);
      info->Set(Pipeline::UPDATE_EXTENT(), nothing, 6);
    }
  }
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
         << " s is reached: set a higher Time Limit (0 means none) or use a smaller input.";
    throw Error(text.str());
  }
}
}

//------------------------------------------------------------------------------
void nameProgress(vtkAlgorithm* algorithm)
{
  if (!algorithm->GetProgressText())
  {
    algorithm->SetProgressText(menuName(algorithm->GetClassName()));
  }
}

//------------------------------------------------------------------------------
int processInScope(vtkAlgorithm* algorithm, const ExecutionLimits& limits, vtkInformation* request,
  vtkInformationVector* outputs, const std::function<int()>& work)
{
  nameProgress(algorithm);
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    return work();
  }
  const auto reportOnce = [algorithm, outputs, &work]
  {
    ErrorCode::set(algorithm, vtkErrorCode::NoError);
    if (!work())
    {
      if (algorithm->GetErrorCode() == vtkErrorCode::NoError)
      {
        ErrorCode::set(algorithm, vtkErrorCode::UserError);
      }
      askForNothing(outputs);
    }
    return 1;
  };
  if (severalProcesses())
  {
    return reportOnce();
  }
  try
  {
    const Stopwatch time;
    const PollScope scope([&] { pollAlgorithm(algorithm, limits, time); });
    return reportOnce();
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
    // Ends a filter that executes itself once per time step.
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
