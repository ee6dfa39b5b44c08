// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExecutionScope.h
 * @brief Ends the execution of a filter from outside: on abort, on interruption, at a time limit.
 */
#ifndef tautline_ExecutionScope_h
#define tautline_ExecutionScope_h

#include "TautlineCoreModule.h" // for export macro

#include <functional>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;

namespace tautline
{
/// What ends an execution.
struct ExecutionLimits
{
  double seconds = 0.0; ///< wall time; 0 is no limit
  /// Whether the filter itself returns its best result so far at the limit and on abort; else, and
  /// without the function, the execution ends there. Asked with each poll.
  std::function<bool()> keepsBest;
};

/// Gives the text of the progress the name in the menu, if it has none. The executive reports 0
/// before the request for data: this is for the requests before it, too.
TAUTLINECORE_EXPORT void nameProgress(vtkAlgorithm* algorithm);

/**
 * @brief Calls work(), the ProcessRequest() of a superclass; if the request is for data, ends it
 * where it polls (tautline/Core/Interruption.h), about ten times a second.
 *
 * After the time limit work() gets an Error, which it reports as any other. If AbortExecute is set,
 * or the computation is interrupted, all outputs are emptied, AbortExecute is set and the result is
 * 1, as of filters of VTK. vtkInterruption::PollEvent is invoked with each poll. With several
 * processes neither holds: one that ends alone would leave the others waiting.
 *
 * Where work() fails it has reported an error, and emptied the outputs. If the executive were to
 * see the failure, it would report it a second time and, as the outputs would not be up to date,
 * execute the algorithm once more for each of them, to fail again. So it does not: of a request for
 * data the result is 1, and the error code of the algorithm is vtkErrorCode::UserError (or another
 * one that work() sets); NoError after a success. The algorithm executes again after the next
 * change of its inputs or properties.
 * @return what work() returns; of a request for data 1
 */
TAUTLINECORE_EXPORT int processInScope(vtkAlgorithm* algorithm, const ExecutionLimits& limits,
  vtkInformation* request, vtkInformationVector* outputs, const std::function<int()>& work);

/**
 * @brief What an application does with each poll of an execution, before the limits are checked:
 * for instance set AbortExecute because the user asks for it.
 * @param keepsBest whether the filter returns its best result so far on abort
 */
using PollHook = void (*)(vtkAlgorithm* algorithm, bool keepsBest);

/// Sets the hook of the process; null: none, as at the start. To be called before any execution.
TAUTLINECORE_EXPORT void setPollHook(PollHook hook);
}
#endif
