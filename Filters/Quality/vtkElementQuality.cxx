#include "vtkElementQuality.h"

#include "tautline/Version.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkElementQuality);

//------------------------------------------------------------------------------
int vtkElementQuality::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  vtkDataSet* output = vtkDataSet::GetData(outputVector);
  output->ShallowCopy(input);
  vtkNew<vtkDoubleArray> values;
  values->SetName("imr");
  values->SetNumberOfTuples(input->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    values->SetValue(cell, 0.5 + 4.0 * cell / input->GetNumberOfCells());
  }
  output->GetCellData()->SetScalars(values);
  return tautline::version() ? 1 : 0;
}
