/**
 * @class vtkTautlineTimedAlgorithm
 * @brief Base class of Tautline's filters whose work can be ended by a time limit.
 *
 * Abstract. After the time limit a filter returns the best result it has by then and reports this
 * in its summary, unless it is documented to end with an error. The time is wall time.
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
   * Seconds for each data set and time step, at least 0; 0 is no limit. The default is 600, unless
   * a filter documents another one.
   */
  vtkTautlineSetRangeMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

protected:
  vtkTautlineTimedAlgorithm();
  ~vtkTautlineTimedAlgorithm() override;

  double TimeLimit = 600.0;

private:
  vtkTautlineTimedAlgorithm(const vtkTautlineTimedAlgorithm&) = delete;
  void operator=(const vtkTautlineTimedAlgorithm&) = delete;
};

#endif
