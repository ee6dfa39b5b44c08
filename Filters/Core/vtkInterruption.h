// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkInterruption
 * @brief Allows Ctrl-C and callbacks to interrupt the computations of filters, for languages other
 * than C++.
 *
 * Between Begin() and End(), SIGINT and Cancel() interrupt Tautline filters on this thread: their
 * outputs are empty, and AbortExecute is set. Elsewhere SIGINT has its usual effect. The Python
 * package uses this class around each update; see tautline/Core/Interruption.h for C++.
 */

#ifndef vtkInterruption_h
#define vtkInterruption_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkObject.h"

class TAUTLINECORE_EXPORT vtkInterruption : public vtkObject
{
public:
  static vtkInterruption* New();
  vtkTypeMacro(vtkInterruption, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Events
  {
    /// Invoked by filters of Tautline about ten times a second while
    /// they compute.
    PollEvent = 2741 // vtkCommand::UserEvent + 1741
  };

  /**
   * Begins a section of the program in which computations of this thread can be interrupted.
   * Sections can be nested. Has no effect with several processes, which can only end together.
   * @param handleSignal whether SIGINT interrupts; its handler is replaced until End()
   */
  static void Begin(bool handleSignal);

  /// Ends the section. @return whether SIGINT has arrived in it
  static bool End();

  /// Interrupts the computations of this thread until the outermost section ends.
  static void Cancel();

  /// Whether the computations of this thread are interrupted.
  static bool IsInterrupted();

  ///@{
  /**
   * For tests, which use this to find computations without polls: measures the longest time that a
   * thread computes between two polls, in seconds of CPU time. MeasurePolls() resets the
   * measurement.
   */
  static void MeasurePolls(bool measure);
  static double GetLongestUnpolledSeconds();
  ///@}

protected:
  vtkInterruption() = default;
  ~vtkInterruption() override = default;

private:
  vtkInterruption(const vtkInterruption&) = delete;
  void operator=(const vtkInterruption&) = delete;
};

#endif
