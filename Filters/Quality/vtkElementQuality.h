/**
 * @class vtkElementQuality
 * @brief placeholder: passes its input through with a cell array "imr" of ones
 */

#ifndef vtkElementQuality_h
#define vtkElementQuality_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkDataSetAlgorithm.h"

class TAUTLINEQUALITY_EXPORT vtkElementQuality : public vtkDataSetAlgorithm
{
public:
  static vtkElementQuality* New();
  vtkTypeMacro(vtkElementQuality, vtkDataSetAlgorithm);

protected:
  vtkElementQuality() = default;
  ~vtkElementQuality() override = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkElementQuality(const vtkElementQuality&) = delete;
  void operator=(const vtkElementQuality&) = delete;
};

#endif
