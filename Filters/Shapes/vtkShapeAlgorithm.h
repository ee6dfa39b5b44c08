// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapeAlgorithm
 * @brief Base class of Match Shape and Shape Retrieval: the energy, the locations and the search.
 *
 * Abstract. The energy of a placement of the source's triangles is (dissertation equation 5.1)
 *
 *     E = sum over triangles of  E_edge + a E_def + b E_dis
 *
 * and its terms are in tautline/Shapes/ShapeMatch.h. The properties below are those of dissertation
 * chapter 5, and some that are not in it: they are off unless stated otherwise. After the time
 * limit the best placement so far is returned; before the search has begun there is none, and the
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
   * Where vertices may go: a grid over the image, the grid locations near the outline, or points on
   * the outline.
   */
  enum LocationKinds
  {
    GRID = 0,
    NEAR_GRID = 1,
    CONTOUR = 2
  };

  /**
   * What a placement may do with a triangle, or with the whole shape.
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
   * a, weight of the squared log-anisotropy of the triangles, at least 0. The default is 12 (a = 4
   * b).
   */
  vtkSetMacro(DeformationWeight, double);
  vtkGetMacro(DeformationWeight, double);
  ///@}

  ///@{
  /**
   * b, weight of the edge length distortion, at least 0. The default is 3; 0 is Felzenszwalb's
   * energy.
   */
  vtkSetMacro(DistortionWeight, double);
  vtkGetMacro(DistortionWeight, double);
  ///@}

  ///@{
  /**
   * Whether the distortion distinguishes growing from shrinking; the dissertation's does not. Off
   * by default.
   */
  vtkSetMacro(SignedDistortion, bool);
  vtkGetMacro(SignedDistortion, bool);
  vtkBooleanMacro(SignedDistortion, bool);
  ///@}

  ///@{
  /**
   * Standard deviation of the Gaussian before the gradient is taken, pixels, above 0. The default
   * is 1.5.
   */
  vtkSetMacro(Smoothing, double);
  vtkGetMacro(Smoothing, double);
  ///@}

  ///@{
  /**
   * Whether an edge of the polygon must have the shape on its inner side. Off by default.
   */
  vtkSetMacro(DirectedEdges, bool);
  vtkGetMacro(DirectedEdges, bool);
  vtkBooleanMacro(DirectedEdges, bool);
  ///@}

  ///@{
  /**
   * Weight of 1 - cos(angle a triangle turns by), at least 0. The default, 0, lets shapes turn
   * freely.
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
   * Weight of unequal lengths along the outline, at least 0; contour locations only. The default is
   * 0.
   */
  vtkSetMacro(OrderingWeight, double);
  vtkGetMacro(OrderingWeight, double);
  ///@}

  ///@{
  /**
   * FORBIDDEN (0, the default): triangles that turn over count as flat. WHOLE (1): the shape or its
   * mirror image, whichever fits better. FREE (2): triangles may turn over at no cost.
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
   * theta / d_max: how far the mean of the matched vertices may be from the target's centre of mass
   * before the next best solution is taken (equation 5.2), at least 0; 0 switches the rule off. The
   * default is 1/3.
   */
  vtkSetMacro(CentreTolerance, double);
  vtkGetMacro(CentreTolerance, double);
  ///@}

  ///@{
  /**
   * Solutions to try for the rule, at least 1. The default is 1000.
   */
  vtkSetMacro(MaximumSolutions, int);
  vtkGetMacro(MaximumSolutions, int);
  ///@}

  ///@{
  /**
   * Solve on a third of the locations, then around that solution: fast, not exact. Off by default.
   */
  vtkSetMacro(CoarseToFine, bool);
  vtkGetMacro(CoarseToFine, bool);
  vtkBooleanMacro(CoarseToFine, bool);
  ///@}

  ///@{
  /**
   * Orientations of the source to try, 1 to 360; useful with a RotationWeight. The default is 1.
   */
  vtkSetMacro(Rotations, int);
  vtkGetMacro(Rotations, int);
  ///@}

  ///@{
  /**
   * Sizes of the target to try, an odd number from 1 to 31, each sqrt(2) times the next. The
   * default is 1.
   */
  vtkSetMacro(Scales, int);
  vtkGetMacro(Scales, int);
  ///@}

  ///@{
  /**
   * Which side of the automatic threshold is the shape: 0 automatic (the default), 1 bright, 2
   * dark.
   */
  vtkTautlineSetRangeMacro(Foreground, int, 0, 2);
  vtkGetMacro(Foreground, int);
  ///@}

protected:
  vtkShapeAlgorithm();
  ~vtkShapeAlgorithm() override = default;

  /// Not before the images are prepared.
  bool KeepsBest() const override { return this->Matching; }
  void ClearResult() override;

  void GetOptions(tautline::LocationOptions& locations, tautline::MatchOptions& match);

  bool Matching = false; ///< in this execution, as the search for places has begun
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
