// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GatheredExecution.h
 * @brief A filter on many processes, whose numbers are those of one: the first process has the
 * whole mesh while it computes, and the results go back to the pieces.
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
/// What becomes of the mesh on output port 0.
enum class GatheredResult
{
  None,     ///< the filter executes on all processes by itself
  SameMesh, ///< the pieces get its points and arrays, and keep what they have
  NewMesh,  ///< a process gets the cells next to those that it had
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

/// How the processes of a parallel server execute a filter.
struct GatheredRules
{
  GatheredResult result = GatheredResult::None;
  int base = 0; ///< the input port whose mesh the output has, with the arrays of its pieces
  /// Exchanges what the properties of the filter return; may be empty.
  std::function<void(ResultStream&)> exchange;
  /// What the other processes do while the first one executes, in step with it, by a RankGroup that
  /// was made before; empty: they wait.
  std::function<void()> assist;
  /// Whether the partitions of a partitioned or multipiece data set are one mesh on one process, as
  /// they are on several; not with None.
  bool joinsPartitions = true;
  /// Whether all processes execute the filter at once, so that an invalid input of one of them is
  /// an error on all.
  bool onAll = true;
};

/// Whether to execute a filter by executeGathered(): there are several processes, and each calls
/// the filter once; or a mesh of an input is in partitions. Not within it.
TAUTLINECORE_EXPORT bool isGathered(vtkAlgorithm* algorithm, const GatheredRules& rules);

/**
 * @brief Executes REQUEST_DATA of a filter for all processes. Collective.
 *
 * The pieces of each input are sent to the first process, which puts them together (assemble()) and
 * calls execute() with the wholes as inputs; there it is the only process, with progress, abort and
 * time limit as usual. On one process only partitions are put together. The partitions of a
 * partitioned or multipiece data set are one mesh, on all processes together; the blocks of a
 * multiblock data set are meshes of their own. A mesh on a further input whose pieces match those
 * on port 0 gets the same numbers. Selections are those of all processes. Tables and other outputs
 * than port 0 stay on the first process. Errors of any process are reported by all.
 *
 * The whole mesh is in the memory of the first process, about three times; Error before anything is
 * sent if that is not available.
 *
 * @param execute what the superclass does for the request. @return its result
 * @return 1, or 0 after an error: the outputs are empty
 */
TAUTLINECORE_EXPORT int executeGathered(vtkAlgorithm* algorithm, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs, const GatheredRules& rules,
  const std::function<int()>& execute);

/// Empties an output. With several processes an image has the announced extent, as the pipeline
/// executes a process again, alone, whose image has not.
TAUTLINECORE_EXPORT void emptyOutput(vtkInformation* info);

/**
 * @brief ProcessRequest() of a filter that does not derive from vtkTautlineAlgorithm:
 * processInScope(), on several processes within executeGathered() after the inputs are checked.
 * @param work the ProcessRequest() of the superclass
 */
TAUTLINECORE_EXPORT int processGathered(vtkAlgorithm* algorithm, const ExecutionLimits& limits,
  GatheredResult result, const InputRules& rules, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs, const std::function<int()>& work);

}
#endif
