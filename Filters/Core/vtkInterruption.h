// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkInterruption
 * @brief Lets Ctrl-C and callbacks end the computations of filters, for languages other than C++.
 *
 * Between Begin() and End(), SIGINT and Cancel() end what the filters of Tautline compute on this
 * thread: their outputs are empty, and AbortExecute is set. Without it SIGINT has its usual effect.
 * Python's package uses it around each update; see tautline/Core/Interruption.h for C++.
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
   * Begins a part of the program in which computations of this thread can be interrupted. Parts
   * nest. No effect with several processes, which can only end together.
   * @param handleSignal whether SIGINT interrupts; its handler is replaced until End()
   */
  static void Begin(bool handleSignal);

  /// Ends the part. @return whether SIGINT has arrived in it
  static bool End();

  /// Interrupts the computations of this thread, until the outermost part ends.
  static void Cancel();

  /// Whether the computations of this thread are interrupted.
  static bool IsInterrupted();

  ///@{
  /**
   * For tests, which find computations without a poll by it: measures the longest time that a
   * thread computes between two polls, in seconds of its CPU time. MeasurePolls() forgets what was
   * measured before.
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
