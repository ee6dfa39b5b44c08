// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSilhouetteMesher
 * @brief "Silhouette to Mesh": the triangulated polygon around what an image shows.
 *
 * The largest component of the foreground of a binary, grey or colour image is traced to sub-pixel,
 * a simple polygon with nearly equally spaced vertices is laid along its outline, and the polygon
 * gets a constrained Delaunay triangulation without interior points (dissertation sections 5.2.1
 * and 5.2.2). That is the source shape of Match Shape.
 *
 * @par Input:
 * vtkImageData of one slice with square pixels and a point or cell array: grey values, colours
 * (their luminance is taken), or with an alpha channel (taken if it is not constant). Input array 0
 * chooses it; the default are the active scalars.
 *
 * @par Output 0, Mesh:
 * vtkUnstructuredGrid of n - 2 triangles. Point arrays `BoundaryOrder` (0 to n - 1,
 * counter-clockwise) and `EliminationOrder` (the step at which dynamic programming is done with the
 * vertex; the last two are never eliminated); cell array `EliminationStep`. Field arrays:
 * `CentreOfMass` (2, in space, of the area inside the outline), `MaximumDistance` (d_max, from
 * there to the outline), `Area`, `Components`, `Holes`, `TouchesBorder`.
 *
 * @par Output 1, Outline:
 * vtkPolyData, the traced outline as one closed line.
 *
 * @par Limitations:
 * Holes and smaller components are counted and ignored. The image must be planar: extract a slice
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
   * Which side of the threshold the shape is on.
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
   * Whether Threshold is used. Off, the default: midway between the minimum and the maximum.
   */
  vtkSetMacro(UseThreshold, bool);
  vtkGetMacro(UseThreshold, bool);
  vtkBooleanMacro(UseThreshold, bool);
  ///@}

  ///@{
  /**
   * The grey value between the shape and its surroundings. The default is 127.5.
   */
  vtkSetMacro(Threshold, double);
  vtkGetMacro(Threshold, double);
  ///@}

  ///@{
  /**
   * Which side of the threshold is the shape: AUTOMATIC (0, the default: the side that fewer pixels
   * of the border of the image are on), BRIGHT (1) or DARK (2).
   */
  vtkTautlineSetRangeMacro(Foreground, int, AUTOMATIC, DARK);
  vtkGetMacro(Foreground, int);
  ///@}

  ///@{
  /**
   * What was found, in words, and the counts.
   */
  vtkGetMacro(Summary, std::string);
  vtkGetMacro(NumberOfComponents, int);
  vtkGetMacro(NumberOfHoles, int);
  ///@}

  ///@{
  /**
   * Seconds for an execution, at least 0; 0 is no limit. After it the execution ends with an error.
   * The default is 600.
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
