// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkUpdateGuard
 * @brief Updates algorithms for languages that C++ exceptions would end.
 *
 * VTK's own readers and writers throw std::bad_alloc where memory does not suffice. VTK's Python
 * wrappers do not catch it: the process is aborted. The functions here return the message instead.
 */

#ifndef vtkUpdateGuard_h
#define vtkUpdateGuard_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkObject.h"

#include <string> // for messages

class vtkAlgorithm;

class TAUTLINECORE_EXPORT vtkUpdateGuard : public vtkObject
{
public:
  static vtkUpdateGuard* New();
  vtkTypeMacro(vtkUpdateGuard, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * As the methods of vtkAlgorithm with these names. @return the message of what was thrown, or "".
   * After an interruption (vtkInterruption) the algorithm cannot be updated again.
   */
  static std::string Update(vtkAlgorithm* algorithm);
  static std::string UpdateWholeExtent(vtkAlgorithm* algorithm);
  ///@}

  /**
   * Lets the process end with a message and exit code 1 where std::bad_alloc, or the error of a
   * thread that cannot be started, is not caught; it would be aborted. For programs, not for
   * libraries.
   */
  static void EndWithMessage();

protected:
  vtkUpdateGuard() = default;
  ~vtkUpdateGuard() override = default;

private:
  vtkUpdateGuard(const vtkUpdateGuard&) = delete;
  void operator=(const vtkUpdateGuard&) = delete;
};

#endif
