// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FetchOutput.h
 * @brief Brings a small output of a filter from the server to the client.
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
 * @brief The data on an output port of a filter that was executed: a table, or a few points.
 *
 * Of several processes the first one's, which has the tables of Tautline's filters.
 * @param port the name of the port, "Statistics"
 * @return the data, or null: there is no such port, or the filter was not executed with the current
 * values of its properties
 */
vtkSmartPointer<vtkDataObject> fetchOutput(pqPipelineSource* source, const char* port);

/// The part of one process of the data on a port; `time` as in the time keeper of the server.
vtkSmartPointer<vtkDataObject> fetchPart(
  vtkSMSourceProxy* source, unsigned int port, int process, double time);

} // namespace tautline

#endif
