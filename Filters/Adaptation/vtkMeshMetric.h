// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshMetric
 * @brief Computes a metric tensor per point, which defines the target edge lengths there.
 *
 * In a metric tensor M the length of an edge e is sqrt(e . M e). Along a principal axis with
 * eigenvalue v, the target size is 1 / sqrt(v). The tensors come from a Source:
 *
 * - SIZES: an array of sizes, or of metric tensors;
 * - HESSIAN: the metric with the least interpolation error of a field in the L^p norm, for a number
 *   of elements, a complexity or an error (tautline/Adaptation/LpMetric.h); if the field has
 *   several components, the metrics of their Hessians are intersected;
 * - CURVATURE: sqrt(8 ChordError R) along each principal direction of curvature with the radius R,
 *   at points of the boundary of a volume, of a surface, or of the border of a planar mesh;
 *   elsewhere the largest size (tautline/Adaptation/CurvatureMetric.h);
 * - DISTANCE: layers at a wall, whose thickness grows by a constant factor along the gradient of
 *   the distance (tautline/Adaptation/DistanceMetric.h).
 *
 * The tensors are then intersected with a second array of metrics, if one is given (so that filters
 * can be chained), the sizes are limited, and Gradation limits the growth of sizes between
 * neighbors (tautline/Adaptation/MetricFields.h).
 *
 * Supports triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed. In a
 * planar mesh or on a surface, the size along the normal is the larger of the two in-plane sizes,
 * so that it affects neither the anisotropy nor the smallest size. Points without an element get
 * the largest size.
 *
 * @par Input arrays (SetInputArrayToProcess, all point arrays):
 * 0 for SIZES: sizes (one component), or metric tensors with six (xx yy zz xy yz xz) or nine
 * components; 1 the field, for HESSIAN; 2 the distance and 3 the wall, for DISTANCE: without a
 * distance array, the straight-line distance to the boundary facets whose points all have a nonzero
 * value in 3, or to the whole boundary; 4 the metrics to intersect with, in the format of 0.
 *
 * @par Output port 0 `Mesh`:
 * The input with the point array ArrayName: six components (xx yy zz xy yz xz) in double precision.
 * It is the active tensor array. Element Quality and Optimize Mesh use it as the target tensor,
 * Improve Mesh for its target lengths.
 *
 * @par Output port 1 `Ellipsoids`:
 * A vtkPolyData with ellipsoids at evenly spread points, whose semi-axes are the sizes times
 * EllipsoidScale; in planar meshes and on surfaces they are flat. Point arrays: `Size` (geometric
 * mean of the sizes), `Anisotropy` (largest over smallest size) and `PointId` (within its block).
 *
 * @par Limitations:
 * Each block of composite data gets its own metric, and the target applies to each block. Cells of
 * higher order are not supported. Lengths are in double precision; squared sizes beyond its range,
 * for example in a mesh with a diagonal of 1e-160, are an error.
 *
 * @par Several processes:
 * The pieces are gathered on the first process; results do not depend on how the mesh is divided.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshMetric> metric;
 * metric->SetInputConnection(reader->GetOutputPort());
 * metric->SetSource(vtkMeshMetric::HESSIAN);
 * metric->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "u");
 * metric->SetTargetValue(5000);
 * metric->Update();
 * std::cout << metric->GetElements() << " elements\n" << metric->GetSummary() << "\n";
 * @endcode
 *
 * @sa tautline::makeMetric (tautline/Adaptation/MakeMetric.h), vtkElementQuality, vtkMeshOptimizer,
 * vtkMeshImprover
 */

#ifndef vtkMeshMetric_h
#define vtkMeshMetric_h

#include "TautlineAdaptationModule.h" // for export macro
#include "vtkTautlineSetRange.h"      // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <limits> // for the range of Norm
#include <string> // for ArrayName

class vtkPolyData;

namespace tautline
{
class MeshAdapter;
struct InputBlock;
struct MetricEllipsoids;
struct MetricOptions;
struct MetricResult;
}

class TAUTLINEADAPTATION_EXPORT vtkMeshMetric : public vtkTautlineTimedAlgorithm
{
public:
  static vtkMeshMetric* New();
  vtkTypeMacro(vtkMeshMetric, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Sources
  {
    SIZES = 0,
    HESSIAN = 1,
    CURVATURE = 2,
    DISTANCE = 3
  };
  ///@{
  /// The source of the tensors, see above. The default is CURVATURE, which needs no array.
  vtkTautlineSetRangeMacro(Source, int, SIZES, DISTANCE);
  vtkGetMacro(Source, int);
  ///@}

  enum Recoveries
  {
    QUADRATIC_FIT = 0,
    DOUBLE_PROJECTION = 1
  };
  ///@{
  /**
   * The recovery of the Hessian. QUADRATIC_FIT, the default: a least-squares quadratic fit to the
   * values at the neighbors. DOUBLE_PROJECTION: element gradients, averaged twice; smoother, for
   * triangles and tetrahedra only. See tautline/Adaptation/FieldDerivatives.h.
   */
  vtkTautlineSetRangeMacro(Recovery, int, QUADRATIC_FIT, DOUBLE_PROJECTION);
  vtkGetMacro(Recovery, int);
  ///@}

  ///@{
  /**
   * The exponent p of the L^p norm of the error, at least 1; infinity or 0 stands for the maximum
   * error. Small exponents also resolve weak features beside strong ones. The default is 2.
   */
  vtkTautlineSetRangeMacro(Norm, double, 0.0, std::numeric_limits<double>::max());
  vtkGetMacro(Norm, double);
  ///@}

  enum Targets
  {
    NUMBER_OF_ELEMENTS = 0,
    COMPLEXITY = 1,
    INTERPOLATION_ERROR = 2
  };
  ///@{
  /**
   * The target quantity of HESSIAN. NUMBER_OF_ELEMENTS, the default, and COMPLEXITY apply to the
   * final metric, after intersection, limits and gradation, to within 1 % where these allow it.
   * INTERPOLATION_ERROR is in the unit of the field and applies before these steps.
   */
  vtkTautlineSetRangeMacro(Target, int, NUMBER_OF_ELEMENTS, INTERPOLATION_ERROR);
  vtkGetMacro(Target, int);
  ///@}

  ///@{
  /// The number of elements, complexity or error, above 0. The default is 10000.
  vtkTautlineSetRangeMacro(TargetValue, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TargetValue, double);
  ///@}

  ///@{
  /**
   * With CURVATURE: the largest distance between the middle of an edge and the surface, at least 0;
   * 0, the default, stands for a thousandth of the diagonal of the bounding box.
   */
  vtkTautlineSetRangeMacro(ChordError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordError, double);
  ///@}

  ///@{
  /// With CURVATURE: facets that meet at more than this many degrees meet at a sharp edge, across
  /// which there is no curvature. The default is 40.
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * With DISTANCE: the size at the wall along the gradient of the distance, at least 0; 0, the
   * default, stands for a thousandth of the diagonal of the bounding box.
   */
  vtkTautlineSetRangeMacro(WallSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(WallSize, double);
  ///@}

  ///@{
  /// With DISTANCE: the growth factor of the layers, at least 1. The default
  /// is 1.2.
  vtkTautlineSetRangeMacro(WallGrowth, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(WallGrowth, double);
  ///@}

  ///@{
  /// With DISTANCE: the ratio of the size across the gradient to the size along it, at the wall, at
  /// least 1. The default is 1.
  vtkTautlineSetRangeMacro(TangentialRatio, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TangentialRatio, double);
  ///@}

  ///@{
  /// The smallest size, at least 0; 0, the default, stands for 1e-6 of the diagonal of the bounding
  /// box.
  vtkTautlineSetRangeMacro(SmallestSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SmallestSize, double);
  ///@}

  ///@{
  /// The largest size, at least 0; 0, the default, stands for a tenth of the diagonal of the
  /// bounding box.
  vtkTautlineSetRangeMacro(LargestSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(LargestSize, double);
  ///@}

  ///@{
  /// The largest quotient of two sizes at a point, 1 (isotropic) to 10000. The default is 1000.
  vtkTautlineSetRangeMacro(LargestAnisotropy, double, 1.0, 10000.0);
  vtkGetMacro(LargestAnisotropy, double);
  ///@}

  ///@{
  /**
   * The largest growth factor of sizes between neighbors, above 1: isotropic sizes grow at most by
   * its logarithm times the distance. 0 means no limit. The default is 1.5.
   */
  vtkTautlineSetRangeMacro(Gradation, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Gradation, double);
  ///@}

  ///@{
  /// The name of the point array. The default is "Metric".
  void SetArrayName(const char* name);
  const char* GetArrayName() const { return this->ArrayName.c_str(); }
  ///@}

  ///@{
  /// The maximum number of ellipsoids, over all blocks, at least 0. The default is 500.
  vtkTautlineSetRangeMacro(MaximumEllipsoids, int, 0, 1000000);
  vtkGetMacro(MaximumEllipsoids, int);
  ///@}

  ///@{
  /// The semi-axes of the ellipsoids over the sizes, above 0. The default is 0.5: their diameters
  /// are the sizes.
  vtkTautlineSetRangeMacro(EllipsoidScale, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EllipsoidScale, double);
  ///@}

  ///@{
  /**
   * Whether to treat points with the same coordinates on matching facets as one, for example on the
   * seams of a mesh in pieces; the output keeps them all. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution, over all blocks: the complexity, which is the area or volume in
   * the metric; the number of elements with edges of length 1, which is the complexity over the
   * area or volume of the ideal element (times 2.31 for triangles, 8.49 for tetrahedra, 1 for
   * quadrilaterals and hexahedra); the smallest and the largest size; the largest quotient of two
   * sizes at a point.
   */
  vtkGetMacro(Complexity, double);
  vtkGetMacro(Elements, double);
  vtkGetMacro(SmallestFound, double);
  vtkGetMacro(LargestFound, double);
  vtkGetMacro(AnisotropyFound, double);
  ///@}

  /// The data of output port 1, Ellipsoids.
  vtkPolyData* GetEllipsoids();

protected:
  vtkMeshMetric();
  ~vtkMeshMetric() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsFinitePoints(int port) const override;
  std::string FindSettingProblem() const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkMeshMetric(const vtkMeshMetric&) = delete;
  void operator=(const vtkMeshMetric&) = delete;

  /// The arrays of a block in the kernel's format, in the unit of its frame.
  struct Arrays;

  void Compute(
    const tautline::InputBlock& block, int blocks, tautline::MetricEllipsoids& ellipsoids);
  tautline::MetricOptions MakeOptions(
    const tautline::InputBlock& block, const tautline::MeshAdapter& adapter, Arrays& arrays);
  void Report(const tautline::InputBlock& block, const tautline::MeshAdapter& adapter,
    const tautline::MetricResult& result);

  int Source = CURVATURE;
  int Recovery = QUADRATIC_FIT;
  double Norm = 2.0;
  int Target = NUMBER_OF_ELEMENTS;
  double TargetValue = 10000.0;
  double ChordError = 0.0;
  double FeatureAngle = 40.0;
  double WallSize = 0.0;
  double WallGrowth = 1.2;
  double TangentialRatio = 1.0;
  double SmallestSize = 0.0;
  double LargestSize = 0.0;
  double LargestAnisotropy = 1000.0;
  double Gradation = 1.5;
  std::string ArrayName = "Metric";
  int MaximumEllipsoids = 500;
  double EllipsoidScale = 0.5;
  bool MergeCoincidentPoints = true;

  double Complexity = 0.0;
  double Elements = 0.0;
  double SmallestFound = 0.0;
  double LargestFound = 0.0;
  double AnisotropyFound = 0.0;
};

#endif
