// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTautlineTimedAlgorithm
 * @brief Base class of Tautline's filters whose work can be ended by a time limit.
 *
 * Abstract. After the time limit a filter that improves a result step by step (KeepsBest()) returns
 * the best one so far and reports this in its summary; other filters end with an error. The time is
 * wall time. With several processes, only filters that limit their own work end.
 *
 * @sa vtkTautlineAlgorithm
 */

#ifndef vtkTautlineTimedAlgorithm_h
#define vtkTautlineTimedAlgorithm_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkTautlineAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

class TAUTLINECORE_EXPORT vtkTautlineTimedAlgorithm : public vtkTautlineAlgorithm
{
public:
  vtkTypeMacro(vtkTautlineTimedAlgorithm, vtkTautlineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The time limit in seconds of each execution, that is, for each time step and for all blocks of
   * composite data together, at least 0; 0 means no limit. The default is 600.
   */
  vtkTautlineSetRangeMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

protected:
  vtkTautlineTimedAlgorithm();
  ~vtkTautlineTimedAlgorithm() override;

  double GetExecutionSeconds() const override { return this->TimeLimit; }

  double TimeLimit = 600.0;

private:
  vtkTautlineTimedAlgorithm(const vtkTautlineTimedAlgorithm&) = delete;
  void operator=(const vtkTautlineTimedAlgorithm&) = delete;
};

#endif
