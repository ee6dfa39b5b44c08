// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMetricField
 * @brief A quality metric of a triangle or tetrahedron as a function of its last vertex.
 *
 * Two vertices of a triangle, or three of a tetrahedron, are held fixed. At every point of a grid
 * stands the value the metric has with the last vertex there: contours show which shapes a metric
 * prefers and how strongly it penalizes the others. The defaults are those of dissertation Figures
 * 2.1 and 3.1: the base from (0, 0) to (1, 0), the free vertex in [-1, 2] x [0, 2].
 *
 * A triangle lies in the plane z = 0; the third numbers of Vertex1, Vertex2, Bounds and Dimensions
 * do not matter to it. It is positive with the free vertex left of the line from Vertex1 to Vertex2
 * (with the defaults, above the base). A tetrahedron is positive with the free vertex on the side
 * from which Vertex1, Vertex2, Vertex3 run counter-clockwise (with the defaults, z > 0).
 *
 * @par Output:
 * vtkImageData with a point array (double) per metric, named by the metric (`imr`, `si`, ...), the
 * first one active, and the point array `Validity` (signed char): 1 valid, 0 degenerate, -1
 * inverted.
 *
 * @par Limitations:
 * Values are always finite: where the cell is degenerate, metrics that are singular there are 0. On
 * the base itself the inverse mean ratio therefore drops from large values to 0; contours and
 * colour ranges are cleaner with Bounds that start slightly above it, or after a Threshold of
 * Validity at 1. Metrics take the ideal cell with edges of length 1 as their target. A metric whose
 * values are beyond the range of double precision is refused (`mu_size_squared` at lengths of
 * 1e-150). Cells are computed relative to Vertex1, so that far from the origin nothing is lost.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMetricField> field;
 * field->AddMetricByName("imr");
 * vtkNew<vtkContourFilter> contours;
 * contours->SetInputConnection(field->GetOutputPort());
 * contours->GenerateValues(10, 1.0, 3.0);
 * @endcode
 *
 * @sa tautline::MetricField (tautline/Quality/MetricField.h), vtkElementQuality
 */

#ifndef vtkMetricField_h
#define vtkMetricField_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkMetricAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

class vtkImageData;

class TAUTLINEQUALITY_EXPORT vtkMetricField : public vtkMetricAlgorithm
{
public:
  static vtkMetricField* New();
  vtkTypeMacro(vtkMetricField, vtkMetricAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Which cell the field is of.
   */
  enum Cells
  {
    TRIANGLE = 0,
    TETRAHEDRON = 1
  };

  ///@{
  /**
   * The cell: TRIANGLE (0) or TETRAHEDRON (1). The default is TRIANGLE.
   */
  vtkTautlineSetRangeMacro(Cell, int, TRIANGLE, TETRAHEDRON);
  vtkGetMacro(Cell, int);
  void SetCellToTriangle() { this->SetCell(TRIANGLE); }
  void SetCellToTetrahedron() { this->SetCell(TETRAHEDRON); }
  ///@}

  ///@{
  /**
   * The fixed vertices. The defaults are (0, 0, 0), (1, 0, 0) and, used by the tetrahedron only,
   * (0.5, 0.866..., 0): an equilateral base.
   */
  vtkSetVector3Macro(Vertex1, double);
  vtkGetVector3Macro(Vertex1, double);
  vtkSetVector3Macro(Vertex2, double);
  vtkGetVector3Macro(Vertex2, double);
  vtkSetVector3Macro(Vertex3, double);
  vtkGetVector3Macro(Vertex3, double);
  ///@}

  ///@{
  /**
   * Where the free vertex goes: xmin, xmax, ymin, ymax, zmin, zmax. The default is -1, 2, 0, 2,
   * 0, 2.
   */
  vtkSetVector6Macro(Bounds, double);
  vtkGetVector6Macro(Bounds, double);
  ///@}

  ///@{
  /**
   * Number of grid points along x, y, z, each at least 1. The default is 301, 201, 101.
   */
  vtkSetVector3Macro(Dimensions, int);
  vtkGetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /**
   * Beta of the untangling metric: the area or volume that an element should have at least, in the
   * unit of the vertices. The default is 0.25, as in dissertation Figure 3.1 (e); with 0 the metric
   * is 0 wherever the cell is not inverted.
   */
  vtkSetMacro(Beta, double);
  vtkGetMacro(Beta, double);
  ///@}

  /// The field.
  vtkImageData* GetOutput();

protected:
  vtkMetricField();
  ~vtkMetricField() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkMetricField(const vtkMetricField&) = delete;
  void operator=(const vtkMetricField&) = delete;

  void GetGrid(int wholeExtent[6], double origin[3], double spacing[3]) const;

  int Cell = TRIANGLE;
  double Vertex1[3] = { 0, 0, 0 };
  double Vertex2[3] = { 1, 0, 0 };
  double Vertex3[3] = { 0.5, 0.86602540378443864676, 0 };
  double Bounds[6] = { -1, 2, 0, 2, 0, 2 };
  int Dimensions[3] = { 301, 201, 101 };
  double Beta = 0.25;
};

#endif
