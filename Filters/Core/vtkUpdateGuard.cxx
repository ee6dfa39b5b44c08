// SPDX-License-Identifier: BSD-3-Clause
#include "vtkUpdateGuard.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <exception>
#include <functional>
#include <new>
#include <system_error>

#include <unistd.h>

vtkStandardNewMacro(vtkUpdateGuard);

namespace
{
constexpr char Remedy[] =
  "use a smaller mesh, fewer threads, or a higher memory limit of the process";

std::string messageOf(const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    return tautline::errorText(error, Remedy);
  }
  catch (const tautline::Interrupted&)
  {
    return "Interrupted.";
  }
  return "";
}

/// Ends VTK's readers and writers when they report progress.
void abortIfInterrupted(vtkObject* caller, unsigned long, void*, void*)
{
  if (tautline::InterruptScope::interrupted())
  {
    static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
    // These do not check for an abort before all arrays are written. Their destructor closes the
    // file.
    if (caller->IsA("vtkXMLWriterBase"))
    {
      throw tautline::Interrupted();
    }
  }
}

std::string update(vtkAlgorithm* algorithm, const std::function<void()>& work)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(abortIfInterrupted);
  const unsigned long tag = algorithm->AddObserver(vtkCommand::ProgressEvent, observer);
  std::string message = messageOf(work);
  algorithm->RemoveObserver(tag);
  return message;
}

/// Allocates nothing.
void print(const char* text)
{
  std::size_t length = 0;
  while (text[length])
  {
    ++length;
  }
  (void)!::write(STDERR_FILENO, text, length);
}

std::terminate_handler Before = nullptr;

void endWithMessage()
{
  try
  {
    if (const std::exception_ptr error = std::current_exception())
    {
      std::rethrow_exception(error);
    }
  }
  catch (const std::bad_alloc&)
  {
    print("tautline: Not enough memory: ");
    print(Remedy);
    print(".\n");
    _exit(1);
  }
  catch (const std::system_error& error)
  {
    print("tautline: ");
    print(error.what());
    print(": ");
    print(Remedy);
    print(".\n");
    _exit(1);
  }
  catch (...)
  {
  }
  if (Before)
  {
    Before();
  }
}
}

//------------------------------------------------------------------------------
std::string vtkUpdateGuard::Update(vtkAlgorithm* algorithm)
{
  return update(algorithm, [algorithm] { algorithm->Update(); });
}

//------------------------------------------------------------------------------
std::string vtkUpdateGuard::UpdateWholeExtent(vtkAlgorithm* algorithm)
{
  return update(algorithm, [algorithm] { algorithm->UpdateWholeExtent(); });
}

//------------------------------------------------------------------------------
void vtkUpdateGuard::EndWithMessage()
{
  const std::terminate_handler before = std::set_terminate(endWithMessage);
  if (before != endWithMessage)
  {
    Before = before;
  }
}

//------------------------------------------------------------------------------
void vtkUpdateGuard::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
