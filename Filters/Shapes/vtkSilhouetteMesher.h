// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSilhouetteMesher
 * @brief "Silhouette to Mesh": converts the shape in an image to a triangulated polygon.
 *
 * The largest foreground component of a binary, gray or color image is traced with subpixel
 * accuracy, a simple polygon with nearly equally spaced vertices is fitted to its outline, and the
 * polygon gets a constrained Delaunay triangulation without interior points (dissertation sections
 * 5.2.1 and 5.2.2). The result is the source shape for Match Shape.
 *
 * @par Input:
 * vtkImageData of one slice with square pixels and a point or cell array: gray values, colors
 * (converted to luminance), or with an alpha channel (used if it is not constant). Input array 0
 * selects it; the default is the active scalars.
 *
 * @par Output 0, Mesh:
 * vtkUnstructuredGrid of n - 2 triangles. Point arrays `BoundaryOrder` (0 to n - 1,
 * counterclockwise) and `EliminationOrder` (the step at which dynamic programming eliminates the
 * vertex; the last two are never eliminated); cell array `EliminationStep`. Field arrays:
 * `CentreOfMass` (2, in space, of the area inside the outline), `MaximumDistance` (d_max, from this
 * center to the outline), `Area`, `Components`, `Holes`, `TouchesBorder`.
 *
 * @par Output 1, Outline:
 * vtkPolyData, the traced outline as one closed line.
 *
 * @par Limitations:
 * Holes and smaller components are counted but ignored. The image must be planar: extract a slice
 * of a volume first.
 *
 * @par Example:
 * @code
 * vtkNew<vtkSilhouetteMesher> mesher;
 * mesher->SetInputConnection(reader->GetOutputPort());
 * mesher->SetSpacing(15);
 * @endcode
 *
 * @sa vtkShapeMatcher, tautline::traceSilhouette (tautline/Shapes/Silhouette.h)
 */

#ifndef vtkSilhouetteMesher_h
#define vtkSilhouetteMesher_h

#include "TautlineShapesModule.h" // for export macro
#include "vtkTautlineSetRange.h"  // for the setters
#include "vtkUnstructuredGridAlgorithm.h"

#include <string> // for Summary

class TAUTLINESHAPES_EXPORT vtkSilhouetteMesher : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSilhouetteMesher* New();
  vtkTypeMacro(vtkSilhouetteMesher, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The side of the threshold that is the shape.
   */
  enum Foregrounds
  {
    AUTOMATIC = 0,
    BRIGHT = 1,
    DARK = 2
  };

  ///@{
  /**
   * The ideal distance of vertices along the outline, in pixels, above 0. The default is 25, the
   * dissertation's.
   */
  vtkSetMacro(Spacing, double);
  vtkGetMacro(Spacing, double);
  ///@}

  ///@{
  /**
   * Whether to use Threshold. If off, the default, the threshold is midway between the minimum and
   * the maximum.
   */
  vtkSetMacro(UseThreshold, bool);
  vtkGetMacro(UseThreshold, bool);
  vtkBooleanMacro(UseThreshold, bool);
  ///@}

  ///@{
  /**
   * The gray value that separates the shape from its surroundings. The default is 127.5.
   */
  vtkSetMacro(Threshold, double);
  vtkGetMacro(Threshold, double);
  ///@}

  ///@{
  /**
   * The side of the threshold that is the shape: AUTOMATIC (0, the default: the side with fewer
   * pixels on the border of the image), BRIGHT (1) or DARK (2).
   */
  vtkTautlineSetRangeMacro(Foreground, int, AUTOMATIC, DARK);
  vtkGetMacro(Foreground, int);
  ///@}

  ///@{
  /**
   * A summary of the findings, and the counts.
   */
  vtkGetMacro(Summary, std::string);
  vtkGetMacro(NumberOfComponents, int);
  vtkGetMacro(NumberOfHoles, int);
  ///@}

  ///@{
  /**
   * Time limit of an execution in seconds, at least 0; 0 means no limit. After it the execution
   * ends with an error. The default is 600.
   */
  vtkTautlineSetRangeMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  /// Ends the execution on abort and at the time limit.
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkSilhouetteMesher();
  ~vtkSilhouetteMesher() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  double TimeLimit = 600.0;

private:
  vtkSilhouetteMesher(const vtkSilhouetteMesher&) = delete;
  void operator=(const vtkSilhouetteMesher&) = delete;

  double Spacing = 25.0;
  bool UseThreshold = false;
  double Threshold = 127.5;
  int Foreground = AUTOMATIC;
  std::string Summary;
  int NumberOfComponents = 0;
  int NumberOfHoles = 0;
};

#endif
