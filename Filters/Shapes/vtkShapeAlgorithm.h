// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapeAlgorithm
 * @brief Base class of Match Shape and Shape Retrieval; defines the energy, the locations and the
 * search.
 *
 * Abstract. The energy of a placement of the source's triangles is (dissertation equation 5.1)
 *
 *     E = sum over triangles of  E_edge + a E_def + b E_dis
 *
 * with the terms described in tautline/Shapes/ShapeMatch.h. The properties below are from
 * dissertation chapter 5; additional ones are off unless stated otherwise. After the time limit the
 * best placement so far is returned; if the search has not started, there is none, and the
 * execution ends with an error.
 *
 * @sa vtkShapeMatcher, vtkShapeRetrieval, tautline::matchShape (tautline/Shapes/ShapeMatch.h)
 */

#ifndef vtkShapeAlgorithm_h
#define vtkShapeAlgorithm_h

#include "TautlineShapesModule.h" // for export macro
#include "vtkTautlineSetRange.h"  // for the setters
#include "vtkTautlineTimedAlgorithm.h"

namespace tautline
{
struct LocationOptions;
struct MatchOptions;
struct SilhouetteOptions;
}

class TAUTLINESHAPES_EXPORT vtkShapeAlgorithm : public vtkTautlineTimedAlgorithm
{
public:
  vtkTypeMacro(vtkShapeAlgorithm, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The possible locations of vertices: a grid over the image, the grid locations near the outline,
   * or points on the outline.
   */
  enum LocationKinds
  {
    GRID = 0,
    NEAR_GRID = 1,
    CONTOUR = 2
  };

  /**
   * The permitted reflections of triangles or of the whole shape.
   */
  enum Reflections
  {
    FORBIDDEN = 0,
    WHOLE = 1,
    FREE = 2
  };

  ///@{
  /**
   * Constant of the edge cost 1 / (lambda + |grad I|), above 0; the gradient is 1 on an ideal edge.
   * The default is 0.1.
   */
  vtkSetMacro(Lambda, double);
  vtkGetMacro(Lambda, double);
  ///@}

  ///@{
  /**
   * The weight a of the squared log-anisotropy of the triangles, at least 0. The default is 12 (a =
   * 4 b).
   */
  vtkSetMacro(DeformationWeight, double);
  vtkGetMacro(DeformationWeight, double);
  ///@}

  ///@{
  /**
   * The weight b of the edge length distortion, at least 0. The default is 3; 0 gives
   * Felzenszwalb's energy.
   */
  vtkSetMacro(DistortionWeight, double);
  vtkGetMacro(DistortionWeight, double);
  ///@}

  ///@{
  /**
   * Whether the distortion distinguishes growth from shrinkage, unlike in the dissertation. The
   * default is off.
   */
  vtkSetMacro(SignedDistortion, bool);
  vtkGetMacro(SignedDistortion, bool);
  vtkBooleanMacro(SignedDistortion, bool);
  ///@}

  ///@{
  /**
   * Standard deviation in pixels of the Gaussian filter applied before the gradient, above 0. The
   * default is 1.5.
   */
  vtkSetMacro(Smoothing, double);
  vtkGetMacro(Smoothing, double);
  ///@}

  ///@{
  /**
   * Whether an edge of the polygon must have the shape on its inner side. The default is off.
   */
  vtkSetMacro(DirectedEdges, bool);
  vtkGetMacro(DirectedEdges, bool);
  vtkBooleanMacro(DirectedEdges, bool);
  ///@}

  ///@{
  /**
   * Weight of 1 - cos(rotation angle of a triangle), at least 0. The default, 0, allows shapes to
   * rotate freely.
   */
  vtkSetMacro(RotationWeight, double);
  vtkGetMacro(RotationWeight, double);
  ///@}

  ///@{
  /**
   * Weight of the difference between the surroundings of vertices, at least 0. The default is 0.
   */
  vtkSetMacro(DescriptorWeight, double);
  vtkGetMacro(DescriptorWeight, double);
  ///@}

  ///@{
  /**
   * Weight of unequal lengths along the outline, at least 0; only for contour locations. The
   * default is 0.
   */
  vtkSetMacro(OrderingWeight, double);
  vtkGetMacro(OrderingWeight, double);
  ///@}

  ///@{
  /**
   * FORBIDDEN (0, the default): reflected triangles count as flat. WHOLE (1): the shape or its
   * mirror image, whichever fits better. FREE (2): triangles may be reflected at no cost.
   */
  vtkTautlineSetRangeMacro(Reflection, int, FORBIDDEN, FREE);
  vtkGetMacro(Reflection, int);
  ///@}

  ///@{
  /**
   * GRID (0, the default), NEAR_GRID (1) or CONTOUR (2).
   */
  vtkTautlineSetRangeMacro(Locations, int, GRID, CONTOUR);
  vtkGetMacro(Locations, int);
  ///@}

  ///@{
  /**
   * Columns and rows of the grid, each at least 2. The default is 30, 30.
   */
  vtkSetVector2Macro(GridSize, int);
  vtkGetVector2Macro(GridSize, int);
  ///@}

  ///@{
  /**
   * Points on the outline, at least 3. The default is 60.
   */
  vtkSetMacro(ContourPoints, int);
  vtkGetMacro(ContourPoints, int);
  ///@}

  ///@{
  /**
   * theta / d_max: the largest distance of the mean of the matched vertices from the target's
   * center of mass before the next best solution is tried (equation 5.2), at least 0; 0 switches
   * the rule off. The default is 1/3.
   */
  vtkSetMacro(CentreTolerance, double);
  vtkGetMacro(CentreTolerance, double);
  ///@}

  ///@{
  /**
   * Maximum number of solutions to try for this rule, at least 1. The default is 1000.
   */
  vtkSetMacro(MaximumSolutions, int);
  vtkGetMacro(MaximumSolutions, int);
  ///@}

  ///@{
  /**
   * Whether to solve on a third of the locations first, then around that solution: fast but not
   * exact. The default is off.
   */
  vtkSetMacro(CoarseToFine, bool);
  vtkGetMacro(CoarseToFine, bool);
  vtkBooleanMacro(CoarseToFine, bool);
  ///@}

  ///@{
  /**
   * Number of orientations of the source to try, 1 to 360; useful with a RotationWeight. The
   * default is 1.
   */
  vtkSetMacro(Rotations, int);
  vtkGetMacro(Rotations, int);
  ///@}

  ///@{
  /**
   * Number of target sizes to try, odd, from 1 to 31, with a factor of sqrt(2) between consecutive
   * sizes. The default is 1.
   */
  vtkSetMacro(Scales, int);
  vtkGetMacro(Scales, int);
  ///@}

  ///@{
  /**
   * The side of the automatic threshold that is the shape: 0 automatic (the default), 1 bright, 2
   * dark.
   */
  vtkTautlineSetRangeMacro(Foreground, int, 0, 2);
  vtkGetMacro(Foreground, int);
  ///@}

protected:
  vtkShapeAlgorithm();
  ~vtkShapeAlgorithm() override = default;

  /// False until the images are prepared.
  bool KeepsBest() const override { return this->Matching; }
  void ClearResult() override;

  void GetOptions(tautline::LocationOptions& locations, tautline::MatchOptions& match);

  bool Matching = false; ///< whether the search has started in this execution
  double Lambda = 0.1;
  double DeformationWeight = 12.0;
  double DistortionWeight = 3.0;
  bool SignedDistortion = false;
  double Smoothing = 1.5;
  bool DirectedEdges = false;
  double RotationWeight = 0.0;
  double DescriptorWeight = 0.0;
  double OrderingWeight = 0.0;
  int Reflection = FORBIDDEN;
  int Locations = GRID;
  int GridSize[2] = { 30, 30 };
  int ContourPoints = 60;
  double CentreTolerance = 1.0 / 3.0;
  int MaximumSolutions = 1000;
  bool CoarseToFine = false;
  int Rotations = 1;
  int Scales = 1;
  int Foreground = 0;

private:
  vtkShapeAlgorithm(const vtkShapeAlgorithm&) = delete;
  void operator=(const vtkShapeAlgorithm&) = delete;
};

#endif
