// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkUpdateGuard
 * @brief Updates algorithms for languages that cannot catch C++ exceptions.
 *
 * VTK's own readers and writers throw std::bad_alloc if memory does not suffice. VTK's Python
 * wrappers do not catch it, and the process is aborted. The functions here return the message
 * instead.
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
   * Like the methods of vtkAlgorithm with these names. @return the message of the exception, or "".
   * After an interruption (vtkInterruption) the algorithm cannot be updated again.
   */
  static std::string Update(vtkAlgorithm* algorithm);
  static std::string UpdateWholeExtent(vtkAlgorithm* algorithm);
  ///@}

  /**
   * Makes the process exit with a message and code 1, instead of aborting, if std::bad_alloc or the
   * error of a thread that cannot be started is not caught. For programs, not for libraries.
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
