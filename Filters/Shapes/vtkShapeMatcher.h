// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapeMatcher
 * @brief "Match Shape": finds a deformable shape in an image.
 *
 * The source is a triangulated polygon; dynamic programming over the triangles finds the placement
 * of its vertices in the target image with minimum energy, exactly and without an initial guess
 * (dissertation chapter 5). If the mean of the matched vertices is too far from the target's center
 * of mass, the next best solution is tried (equation 5.2).
 *
 * @par Inputs:
 * Port 0, Input: the source, an image (Silhouette to Mesh is applied with Spacing) or a planar mesh
 * of triangles without interior points, such as the output of Silhouette to Mesh; its field arrays
 * `CentreOfMass` and `MaximumDistance` are used. Port 1, Target: a planar image with square pixels.
 *
 * @par Output 0, Detected Mesh:
 * vtkUnstructuredGrid, the source's triangles in the target. Point arrays: the arrays of a source
 * mesh, `Displacement` (3, position in the target minus position in the source), `BoundaryOrder`,
 * `EliminationOrder`. Cell arrays, unweighted: `EdgeCost`, `Deformation`, `Distortion`, and
 * `Energy`, their weighted sum; `EliminationStep`. The triangles of a source mesh are regenerated
 * from its boundary, with the same result if they are from Silhouette to Mesh.
 *
 * @par Output 1, Statistics:
 * vtkTable with one row: Energy, EdgeCost, Deformation, Distortion, Rotation, Descriptor, Ordering,
 * Rank (of the solution taken), CentreDistance (D), CentreTolerance (theta), CentreAccepted,
 * Mirrored, Angle, Scale, Exact, Stop (0 complete, 1 time limit, 2 stopped). Lengths are pixels of
 * the target.
 *
 * @par Limitations:
 * The target's center of mass and size are computed from its largest component. At the time limit
 * the filter returns the best result so far, or an error if the search has not started.
 *
 * @par Example:
 * @code
 * vtkNew<vtkShapeMatcher> matcher;
 * matcher->SetInputConnection(0, source->GetOutputPort());
 * matcher->SetInputConnection(1, target->GetOutputPort());
 * matcher->SetLocations(vtkShapeAlgorithm::CONTOUR);
 * @endcode
 *
 * @sa vtkSilhouetteMesher, vtkShapeRetrieval, tautline::matchShape (tautline/Shapes/ShapeMatch.h)
 */

#ifndef vtkShapeMatcher_h
#define vtkShapeMatcher_h

#include "TautlineShapesModule.h" // for export macro
#include "vtkShapeAlgorithm.h"

class vtkImageData;

class TAUTLINESHAPES_EXPORT vtkShapeMatcher : public vtkShapeAlgorithm
{
public:
  static vtkShapeMatcher* New();
  vtkTypeMacro(vtkShapeMatcher, vtkShapeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The target image.
   */
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkImageData* image);
  ///@}

  ///@{
  /**
   * Distance of vertices along the outline of a source image, in pixels, above 0. The default is
   * 25.
   */
  vtkSetMacro(Spacing, double);
  vtkGetMacro(Spacing, double);
  ///@}

  ///@{
  /**
   * Whether to use the gradient of the target's gray values instead of its largest component. The
   * default is off.
   */
  vtkSetMacro(GreyGradient, bool);
  vtkGetMacro(GreyGradient, bool);
  vtkBooleanMacro(GreyGradient, bool);
  ///@}

  ///@{
  /**
   * Results of the last run.
   */
  vtkGetMacro(Energy, double);
  vtkGetMacro(Rank, int);
  vtkGetMacro(CentreDistance, double);
  vtkGetMacro(Exact, bool);
  ///@}

protected:
  vtkShapeMatcher();
  ~vtkShapeMatcher() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsFinitePoints(int port) const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkShapeMatcher(const vtkShapeMatcher&) = delete;
  void operator=(const vtkShapeMatcher&) = delete;

  double Spacing = 25.0;
  bool GreyGradient = false;
  double Energy = 0.0;
  int Rank = 0;
  double CentreDistance = 0.0;
  bool Exact = false;
};

#endif
