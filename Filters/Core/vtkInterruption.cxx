// SPDX-License-Identifier: BSD-3-Clause
#include "vtkInterruption.h"

#include "tautline/Core/Interruption.h"

#include "vtkCommand.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include <memory>
#include <vector>

vtkStandardNewMacro(vtkInterruption);

static_assert(
  static_cast<int>(vtkInterruption::PollEvent) > static_cast<int>(vtkCommand::UserEvent),
  "an event of VTK");

namespace
{
/// Null if a section has no effect.
thread_local std::vector<std::unique_ptr<tautline::InterruptScope>> parts;
}

//------------------------------------------------------------------------------
void vtkInterruption::Begin(bool handleSignal)
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  const bool alone = !controller || controller->GetNumberOfProcesses() <= 1;
  parts.push_back(alone ? std::make_unique<tautline::InterruptScope>(handleSignal) : nullptr);
}

//------------------------------------------------------------------------------
bool vtkInterruption::End()
{
  const bool signalled = tautline::InterruptScope::signalled();
  if (!parts.empty())
  {
    parts.pop_back();
  }
  return signalled;
}

//------------------------------------------------------------------------------
void vtkInterruption::Cancel()
{
  tautline::InterruptScope::cancel();
}

//------------------------------------------------------------------------------
bool vtkInterruption::IsInterrupted()
{
  return tautline::InterruptScope::interrupted();
}

//------------------------------------------------------------------------------
void vtkInterruption::MeasurePolls(bool measure)
{
  tautline::measurePolls(measure);
}

//------------------------------------------------------------------------------
double vtkInterruption::GetLongestUnpolledSeconds()
{
  return tautline::longestUnpolledSeconds();
}

//------------------------------------------------------------------------------
void vtkInterruption::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
