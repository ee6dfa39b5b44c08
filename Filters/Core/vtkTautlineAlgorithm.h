// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTautlineAlgorithm
 * @brief Base class of Tautline's filters; handles ports, threads, the summary, errors and
 * progress.
 *
 * Abstract. It implements the common behavior, so that a filter consists only of its own properties
 * and a RequestData() that checks the input, passes a view of it to the kernel and attaches the
 * result.
 *
 * @par Ports:
 * Input port 0 accepts a data set or a composite data set (the composite type comes first, so that
 * a filter gets all blocks and its tables describe the whole). The other input ports are optional
 * and accept the same types, or a vtkSelection if declared as selections. Output port 0 has the
 * type of the input on port 0; the others are tables. A derived class declares its ports with
 * DeclarePorts() in its constructor and overrides FillInputPortInformation() or
 * FillOutputPortInformation() if they differ: RequestDataObject() creates objects of the announced
 * types.
 *
 * @par Validation:
 * Before RequestData() all inputs are checked: sizes of arrays, ids, offsets and types of cells,
 * selections. A defect is reported as an error, and the filter is not executed. Null leaves of
 * composite data are skipped; leaves that are not data sets (tables, ...) are left out with a
 * warning.
 *
 * @par Errors:
 * RequestData() does its work in Attempt(). An exception (tautline::Error, or any other) becomes an
 * error event with its message, and all outputs are empty, so that a partial result is not mistaken
 * for a complete one. For an incomplete but useful result, the summary is reported as a warning.
 *
 * @par Abort and time limit:
 * AbortExecute and the time limit of an execution are checked about ten times a second in the loops
 * of the kernel. A filter that can return its best result so far does so (KeepsBest()); others
 * return empty outputs after an abort, and report an error after the time limit.
 *
 * @par Derived classes:
 * vtkTautlineTimedAlgorithm adds a time limit, vtkMeshMotionAlgorithm the fixed points and the
 * iteration history of filters that move points. Tautline filters that produce or accept only one
 * type of data set (sources, meshers) derive from VTK's classes for this type.
 *
 * @sa vtkTautlineTimedAlgorithm, vtkMeshMotionAlgorithm
 */

#ifndef vtkTautlineAlgorithm_h
#define vtkTautlineAlgorithm_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkDataObjectAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <chrono>           // for Start
#include <functional>       // for work
#include <initializer_list> // for ports
#include <string>           // for Summary
#include <vector>           // for SelectionPorts

class vtkTable;

namespace tautline
{
class ResultStream;
struct GatheredRules;
}

class TAUTLINECORE_EXPORT vtkTautlineAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkTautlineAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Number of threads, 0 to 1024; 0, the default, stands for one per core. The result does not
   * depend on it.
   */
  vtkTautlineSetRangeMacro(Threads, int, 0, 1024);
  vtkGetMacro(Threads, int);
  ///@}

  /**
   * The result of the last execution in sentences, a paragraph per block of a composite data set;
   * "" before the first execution and after a failed one.
   */
  const char* GetSummary() const { return this->Summary.c_str(); }

  /**
   * Updates the inputs on several processes: an input that cannot be computed on one process is an
   * error on all, so that none waits for another.
   */
  int ModifyRequest(vtkInformation* request, int when) override;

  /// Checks the inputs before RequestData() is called; a failure is reported once, see
  /// tautline::processInScope().
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkTautlineAlgorithm();
  ~vtkTautlineAlgorithm() override;

  /**
   * Sets the numbers of ports.
   * @param inputs number of input ports; port 0 is the mesh, the others are optional
   * @param outputs number of output ports; port 0 is the mesh, the others are tables
   * @param selections the input ports that take a vtkSelection
   */
  void DeclarePorts(int inputs, int outputs, std::initializer_list<int> selections = {});

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  /// Whether points with a NaN or infinite coordinate are rejected on an input port. Default: no,
  /// because the filters that measure or move points mark the cells of such points.
  virtual bool NeedsFinitePoints(int port) const;

  /// The problem with the settings on this process, whatever the input; or "", the default. Like an
  /// invalid input, it ends the execution before RequestData(), on all processes.
  virtual std::string FindSettingProblem() const;

  /**
   * The rules by which the processes of a parallel server execute the filter (GatheredExecution.h).
   * Default: each process executes it on its own data, all together if port 0 accepts composite
   * data. (VTK executes other filters once per block, and processes may have different numbers of
   * blocks.)
   */
  virtual tautline::GatheredRules GetGatheredRules();

  /**
   * Whether each process instead works on its piece of the mesh in this execution, with the current
   * settings and inputs: RequestData() is then called on all processes together. Collective, with
   * the same answer everywhere; called before RequestData() if the rules gather the mesh. Default:
   * no.
   */
  virtual bool TakesPieces(vtkInformationVector** inputs);

  /// Whether all data sets with points on port 0 have global point ids.
  bool PartitionsHaveIds();

  /// Writes or reads the members that hold results, so that all processes get the results of the
  /// first. Overrides must call the superclass's version, which exchanges the summary.
  virtual void ExchangeResult(tautline::ResultStream& stream);

  /**
   * Whether the next execution continues the same request (CONTINUE_EXECUTING): if an input then
   * fails, this filter is executed and fails, because VTK would otherwise repeat the request
   * forever. Default: no.
   */
  virtual bool ExecutesAgain() const { return false; }

  /// Time limit of an execution, in seconds; 0, the default, means no limit.
  virtual double GetExecutionSeconds() const;

  /**
   * Whether RequestData() itself returns the best result so far on abort and at the time limit.
   * Default: after HaveBest() was called in this execution; before, only the setup is done, and the
   * execution ends with an error. Called during the execution.
   */
  virtual bool KeepsBest() const;

  /// From here on RequestData() has a result that it returns on abort and at the time limit.
  void HaveBest() { this->Best = true; }

  /// The remaining time of this execution, in seconds: positive even if the limit has passed; 0
  /// means no limit. All blocks of composite data share it.
  double GetRemainingSeconds() const;

  /// Clears the results of the last execution; called if the inputs are invalid.
  virtual void ClearResult();

  /// The table on an output port.
  vtkTable* GetOutputTable(int port);

  /**
   * Does the work of RequestData(). If it throws, reports the message as an error and empties the
   * summary and all outputs; on all processes if each works on its piece and one throws.
   * @param memoryRemedy a suggestion to the user if memory does not suffice: "choose fewer metrics"
   * @return 1, or 0 after an error: the result of RequestData()
   */
  int Attempt(vtkInformationVector* outputVector, const char* memoryRemedy,
    const std::function<void()>& work);

  /// Does some work. @return the message of the exception, or "". For joint work of several
  /// processes, where an error is reported after all of them have finished.
  static std::string FailureOf(const char* memoryRemedy, const std::function<void()>& work);

  /// Reports a failure as Attempt() does. @return 0
  virtual int Fail(vtkInformationVector* outputVector, const std::string& message);

  /// Reports progress, 0 to 1; it never decreases. @return false if the execution should be aborted
  bool Proceed(double fraction);

  /// A number shown in the progress text, after its name.
  struct ProgressValue
  {
    const char* name; ///< lower case: "objective"
    double value;
  };

  /**
   * Shows an iteration in the progress text: "Optimize Mesh: iteration 3, objective 12.5, worst
   * 2.87". Values that are not finite are left out.
   * @param filter the name in the menu
   */
  void ShowIteration(
    const char* filter, int iteration, std::initializer_list<ProgressValue> values);

  /// Adds a paragraph to the summary, unless it is empty.
  void AddToSummary(const std::string& paragraph);

  /// Reports a warning, unless it is empty.
  void Warn(const std::string& text);

  int Threads = 0;
  std::string Summary;

private:
  vtkTautlineAlgorithm(const vtkTautlineAlgorithm&) = delete;
  void operator=(const vtkTautlineAlgorithm&) = delete;

  bool TakesComposite(int port);
  std::string FindInputProblem(vtkInformationVector** inputs);

  int ExecuteData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  int ExecuteGathered(tautline::GatheredRules rules, vtkInformation* request,
    vtkInformationVector** inputs, vtkInformationVector* outputs);
  int UpdateInputs(vtkInformation* request);

  std::vector<int> SelectionPorts;
  vtkMTimeType FailedInputs = 0;   ///< the time of inputs that could not be computed, or 0
  std::vector<double> FailedSteps; ///< the time step that was then requested from each
  std::string UpstreamProblem;     ///< set for a further execution, which reports it
  std::chrono::steady_clock::time_point Start; ///< of the execution
  bool Best = false;                           ///< whether HaveBest() was called in this execution
  bool InPieces = false; ///< whether each process takes its piece in this execution
};

#endif
