/**
 * @file Processes.h
 * @brief What the processes of a parallel run agree on. All of them call these functions together.
 */
#ifndef tautline_Processes_h
#define tautline_Processes_h

class vtkDataObject;

namespace tautline
{
/// The least of the numbers of all processes.
int leastOfAll(int own);

/// Throws Error, on all processes, if a data set has cells on several of them.
void requireOneProcess(vtkDataObject* input);
}
#endif
