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
/// The limits that end an execution.
struct ExecutionLimits
{
  double seconds = 0.0; ///< wall time; 0 is no limit
  /// Whether the filter itself returns its best result so far at the limit and on abort; otherwise,
  /// and without the function, the execution ends there. Called at each poll.
  std::function<bool()> keepsBest;
};

/// Sets the progress text to the name in the menu, if it is empty. The executive reports 0 before
/// the request for data, so earlier requests call this as well.
TAUTLINECORE_EXPORT void nameProgress(vtkAlgorithm* algorithm);

/**
 * @brief Calls work(), the ProcessRequest() of a superclass; a request for data can be ended at the
 * polls (tautline/Core/Interruption.h), about ten times a second.
 *
 * After the time limit an Error is thrown within work(), which reports it like any other. If
 * AbortExecute is set or the computation is interrupted, all outputs are emptied, AbortExecute is
 * set and the result is 1, as in VTK's filters. vtkInterruption::PollEvent is invoked at each poll.
 * Neither limit applies with several processes: one that ends alone would leave the others waiting.
 *
 * When work() fails, it has reported an error and emptied the outputs. If the failure were passed
 * on to the executive, it would report it a second time and, because the outputs would not be up to
 * date, execute the algorithm again for each of them, only to fail again. The result of a request
 * for data is therefore always 1, and the error code of the algorithm is vtkErrorCode::UserError
 * (or another one that work() sets); NoError after a success. The algorithm executes again after
 * the next change of its inputs or properties.
 * @return the result of work(); 1 for a request for data
 */
TAUTLINECORE_EXPORT int processInScope(vtkAlgorithm* algorithm, const ExecutionLimits& limits,
  vtkInformation* request, vtkInformationVector* outputs, const std::function<int()>& work);

/**
 * @brief A function that an application runs at each poll of an execution, before the limits are
 * checked, for example to set AbortExecute at the user's request.
 * @param keepsBest whether the filter returns its best result so far on abort
 */
using PollHook = void (*)(vtkAlgorithm* algorithm, bool keepsBest);

/// Sets the hook of the process; null, the default, removes it. Call it before any execution.
TAUTLINECORE_EXPORT void setPollHook(PollHook hook);
}
#endif
