// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Processes.h
 * @brief The processes of a parallel ParaView server (MPI ranks) that each have a part of the data.
 */
#ifndef tautline_Processes_h
#define tautline_Processes_h

#include "TautlineCoreModule.h" // for export macro

#include <string>

class vtkAlgorithm;
class vtkDataObject;
class vtkMultiProcessController;

namespace tautline
{
/**
 * @class tautline::OneProcess
 * @brief As long as an object exists, this process counts as the only one: nothing here
 * communicates, and executions end at their limits. For work that one process does while the others
 * wait.
 */
class TAUTLINECORE_EXPORT OneProcess
{
public:
  OneProcess();
  ~OneProcess();
  OneProcess(const OneProcess&) = delete;
  OneProcess& operator=(const OneProcess&) = delete;
};

/// The global controller; null if there is only one process or an OneProcess exists.
TAUTLINECORE_EXPORT vtkMultiProcessController* severalProcesses();

/// The minimum over all processes. Collective; MPI is not needed.
TAUTLINECORE_EXPORT int minimumOverProcesses(int own);

/// The message of the first process that has one ("In process 2: ..."), returned on all processes;
/// "" if there is none. Collective; MPI is not needed.
TAUTLINECORE_EXPORT std::string firstProblem(const std::string& own);

/// Whether processes other than the first have cells of a mesh. Collective; MPI is not needed.
TAUTLINECORE_EXPORT bool isScattered(vtkDataObject* input);

/// Throws Error, on all processes, if a data set has cells on several of them. Collective; MPI is
/// not needed.
TAUTLINECORE_EXPORT void requireOneProcess(vtkDataObject* input);

/**
 * @brief Throws Error, on all processes, if a process other than the first has cells: for filters
 * whose numbers and summary cover one process. Collective; MPI is not needed.
 * @param filter its name, for the message: "Optimize Mesh"
 */
TAUTLINECORE_EXPORT void requireFirstProcess(vtkDataObject* input, const char* filter);

/**
 * @brief The same for a filter that the pipeline calls for each block of composite data. Processes
 * may have different blocks; therefore only a process other than the first that has cells throws,
 * and none communicates.
 * @param port of the filter that `input` comes from
 */
TAUTLINECORE_EXPORT void requireFirstProcess(
  vtkAlgorithm* filter, int port, vtkDataObject* input, const char* name);
}
#endif
