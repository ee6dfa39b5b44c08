// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMetricField
 * @brief A quality metric of a triangle or tetrahedron as a function of its last vertex.
 *
 * Two vertices of a triangle, or three of a tetrahedron, are held fixed. The value at each grid
 * point is the metric with the last vertex there: contours show which shapes a metric prefers and
 * how strongly it penalizes others. The defaults are as in dissertation Figures 2.1 and 3.1: the
 * base from (0, 0) to (1, 0), the free vertex in [-1, 2] x [0, 2].
 *
 * A triangle lies in the plane z = 0; the z components of Vertex1, Vertex2, Bounds and Dimensions
 * have no effect. It is positive if the free vertex is left of the line from Vertex1 to Vertex2
 * (with the defaults, above the base). A tetrahedron is positive if the free vertex is on the side
 * from which Vertex1, Vertex2, Vertex3 run counterclockwise (with the defaults, z > 0).
 *
 * @par Output:
 * vtkImageData with a point array (double) per metric, named by the metric (`imr`, `si`, ...), the
 * first one active, and the point array `Validity` (signed char): 1 valid, 0 degenerate, -1
 * inverted.
 *
 * @par Limitations:
 * Values are always finite: metrics that are singular for degenerate cells are 0 there. On the base
 * itself the inverse mean ratio therefore drops from large values to 0; contours and color ranges
 * are cleaner with Bounds that start slightly above it, or after a Threshold of Validity at 1.
 * Metrics use the ideal cell with edges of length 1 as their target. A metric whose values are
 * beyond the range of double precision is an error (`mu_size_squared` at lengths of 1e-150). Cells
 * are computed relative to Vertex1, so that no precision is lost far from the origin.
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
   * The types of cells.
   */
  enum Cells
  {
    TRIANGLE = 0,
    TETRAHEDRON = 1
  };

  ///@{
  /**
   * The type of the cell: TRIANGLE (0) or TETRAHEDRON (1). The default is TRIANGLE.
   */
  vtkTautlineSetRangeMacro(Cell, int, TRIANGLE, TETRAHEDRON);
  vtkGetMacro(Cell, int);
  void SetCellToTriangle() { this->SetCell(TRIANGLE); }
  void SetCellToTetrahedron() { this->SetCell(TETRAHEDRON); }
  ///@}

  ///@{
  /**
   * The fixed vertices. The defaults are (0, 0, 0), (1, 0, 0) and, used only by the tetrahedron,
   * (0.5, 0.866..., 0), which form an equilateral base.
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
   * The range of the free vertex: xmin, xmax, ymin, ymax, zmin, zmax. The default is -1, 2, 0, 2,
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
   * Beta of the untangling metric: the minimum area or volume that an element should have, in the
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
