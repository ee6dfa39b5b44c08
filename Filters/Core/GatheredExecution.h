// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GatheredExecution.h
 * @brief Runs a filter on many processes with the serial result: the first process holds the whole
 * mesh while it computes, and the results go back to the pieces.
 */
#ifndef tautline_GatheredExecution_h
#define tautline_GatheredExecution_h

#include "TautlineCoreModule.h" // for export macro

#include "ExecutionScope.h"
#include "ValidateInput.h"

#include "vtkMultiProcessStream.h"

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;

namespace tautline
{
/// The distribution of the mesh on output port 0.
enum class GatheredResult
{
  None,     ///< the filter itself executes on all processes
  SameMesh, ///< the pieces keep their cells and get the new points and arrays
  NewMesh,  ///< a process gets the cells closest to its old ones
  OnFirst   ///< it stays on the first process
};

/**
 * @class tautline::ResultStream
 * @brief Writes members of a filter on the process that has computed them, or reads them elsewhere.
 */
class ResultStream
{
public:
  ResultStream(vtkMultiProcessStream& stream, bool writes)
    : Stream(stream)
    , Writes(writes)
  {
  }

  /// Numbers, bool, std::string.
  template <class... Values>
  void operator()(Values&... values)
  {
    (this->exchange(values), ...);
  }

private:
  template <class Value>
  void exchange(Value& value)
  {
    this->Writes ? static_cast<void>(this->Stream << value)
                 : static_cast<void>(this->Stream >> value);
  }

  void exchange(bool& value)
  {
    int same = value ? 1 : 0;
    this->exchange(same);
    value = same != 0;
  }

  vtkMultiProcessStream& Stream;
  bool Writes;
};

/// The rules by which the processes of a parallel server execute a filter.
struct GatheredRules
{
  GatheredResult result = GatheredResult::None;
  int base = 0; ///< the input port whose mesh the output has, with the arrays of its pieces
  /// Exchanges the results that the filter returns through its properties; may be empty.
  std::function<void(ResultStream&)> exchange;
  /// The work of the other processes while the first one executes, in step with it through a
  /// RankGroup made before; if empty, they wait.
  std::function<void()> assist;
  /// Whether the partitions of a partitioned or multipiece data set are also one mesh on a single
  /// process, as they are on several; not with None.
  bool joinsPartitions = true;
  /// Whether all processes execute the filter together, so that an invalid input on one of them is
  /// an error on all.
  bool onAll = true;
};

/// Whether to execute a filter with executeGathered(): there are several processes and each calls
/// the filter once, or a mesh of an input is in partitions. False within executeGathered().
TAUTLINECORE_EXPORT bool isGathered(vtkAlgorithm* algorithm, const GatheredRules& rules);

/**
 * @brief Executes REQUEST_DATA of a filter for all processes. Collective.
 *
 * The pieces of each input are sent to the first process, which puts them together (assemble()) and
 * calls execute() with the whole meshes as inputs; progress, abort and the time limit work there as
 * on a single process. On a single process only partitions are joined. The partitions of a
 * partitioned or multipiece data set are one mesh, on all processes together; the blocks of a
 * multiblock data set are meshes of their own. A mesh on another input whose pieces match the
 * pieces on port 0 gets the same numbering. Selections of all processes are joined. Tables and
 * outputs other than port 0 stay on the first process. All processes report the errors of any
 * process.
 *
 * The first process needs about three times the memory of the whole mesh; if it is not available,
 * an Error is thrown before anything is sent.
 *
 * @param execute the superclass's handling of the request. @return its result
 * @return 1, or 0 after an error: the outputs are empty
 */
TAUTLINECORE_EXPORT int executeGathered(vtkAlgorithm* algorithm, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs, const GatheredRules& rules,
  const std::function<int()>& execute);

/// Empties an output. With several processes an image keeps the announced extent, because the
/// pipeline executes a process again, alone, if its image lacks it.
TAUTLINECORE_EXPORT void emptyOutput(vtkInformation* info);

/**
 * @brief ProcessRequest() for a filter that does not derive from vtkTautlineAlgorithm:
 * processInScope(), on several processes within executeGathered() after the inputs are checked.
 * @param work the ProcessRequest() of the superclass
 */
TAUTLINECORE_EXPORT int processGathered(vtkAlgorithm* algorithm, const ExecutionLimits& limits,
  GatheredResult result, const InputRules& rules, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs, const std::function<int()>& work);

}
#endif
