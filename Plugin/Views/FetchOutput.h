// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FetchOutput.h
 * @brief Fetches a small output of a filter from the server.
 */

#ifndef tautline_FetchOutput_h
#define tautline_FetchOutput_h

#include "vtkDataObject.h"
#include "vtkSmartPointer.h"

class pqPipelineSource;
class vtkSMSourceProxy;

namespace tautline
{

/**
 * @brief The data on an output port of an executed filter: a table, or a few points.
 *
 * On several processes, the data of the first process, which has the tables of Tautline's filters.
 * @param port the name of the port, such as "Statistics"
 * @return the data, or null if there is no such port or if the filter was not executed with the
 * current values of its properties
 */
vtkSmartPointer<vtkDataObject> fetchOutput(pqPipelineSource* source, const char* port);

/// The number of the output port with a name, or -1.
int outputPort(vtkSMSourceProxy* source, const char* name);

/// The data of one process on a port; `time` as in the time keeper of the server.
vtkSmartPointer<vtkDataObject> fetchPart(
  vtkSMSourceProxy* source, unsigned int port, int process, double time);

} // namespace tautline

#endif
