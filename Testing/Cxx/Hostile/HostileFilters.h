// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HostileFilters.h
 * @brief Every class of the modules that takes data, ready to be fed with hostile data.
 */

#ifndef tautline_HostileFilters_h
#define tautline_HostileFilters_h

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace tautline
{

/** A filter or writer, and which of its inputs gets the hostile data. */
struct HostileFilter
{
  std::string module;
  std::string name;    ///< of the class
  std::string variant; ///< what is special, or ""
  /** Makes it, with small limits; other inputs are connected. */
  std::function<vtkSmartPointer<vtkAlgorithm>()> make;
  /** Data that the input takes. */
  std::function<vtkSmartPointer<vtkDataObject>()> suitable;
  int port = 0;
  /** Whether output 0 is the input on the port with other points or arrays. */
  bool keepsMesh = true;
  int selectionPort = -1;
  std::string fileName = {}; ///< of a writer
};

std::vector<HostileFilter> hostileFilters(const std::string& directory);

/** Classes without an input: bases, sources, readers. */
const std::vector<std::string>& classesWithoutInput();

} // namespace tautline

#endif
