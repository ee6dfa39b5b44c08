// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshPerturbation
 * @brief Moves interior vertices at random, either without inverting elements or past inversion.
 *
 * Makes test meshes: valid, but worse than the input by a known amount; or tangled, with a known
 * fraction of inverted elements.
 *
 * A percentage of the interior vertices is chosen. They move one after the other, each in a random
 * direction by a random fraction (uniform from 0 to Fraction) of the distance at which the first
 * adjacent element would invert, given the current positions of the other vertices. This distance
 * is exact: the determinant of every corner is linear in one vertex. The dissertation uses "less
 * than half the distance at which element inversion would occur" (section 2.7.2), which is the
 * default. No element becomes inverted or degenerate, in the precision of the output.
 *
 * With a TangledFraction above 0, interior vertices then move past inversion until this fraction of
 * the elements is inverted. It is reached to the nearest element up to about 0.8 (a mesh with a
 * fixed boundary cannot always be inverted throughout); see GetTangledFractionReached() for the
 * fraction reached.
 *
 * Vertices of a planar mesh stay in its plane. Vertices of a surface in space move in the tangent
 * plane of the adjacent elements, and so leave the surface by a second-order amount; an element
 * counts as inverted if it turns by 90 degrees or more. (Element Quality evaluates a single mesh
 * and cannot detect this: a surface triangle always agrees with its own normal. Fix the points of
 * sharp edges.)
 *
 * The result depends only on the input, the options and Seed, not on the number of threads or the
 * random numbers of the system. With the same seed, the vertices moved at a lower percentage are a
 * subset of the vertices moved at a higher one.
 *
 * @par Input:
 * Any vtkPointSet: vtkUnstructuredGrid, vtkPolyData, vtkStructuredGrid, ... with triangles,
 * quadrilaterals, tetrahedra, hexahedra, wedges, pyramids. Multiblock data are treated block by
 * block, the partitions of partitioned data as one mesh. A mesh whose elements are all reversed is
 * treated as its mirror image. The points of other cells (lines, polygons, polyhedra, 2D cells in a
 * volume mesh), of ghost cells and of cells with NaN coordinates stay. Elements that are already
 * inverted may stay so, but their neighbors do not get worse.
 *
 * @par Input array 0 (optional, SetInputArrayToProcess):
 * A point array with one component. Points where it is not 0 stay.
 *
 * @par Output:
 * The input with other points, in the same precision (integer coordinates become double). Point and
 * cell data are passed on. The point array `Displacement` (3 components, double) is added: new
 * minus old position.
 *
 * @par Curved cells:
 * Corners move as in linear cells, and the other nodes follow, see tautline/Mesh/FollowingNodes.h;
 * fixed nodes and nodes on the boundary stay. Without a TangledFraction, corners retreat toward
 * their original positions until each originally valid cell is valid. Validity and the numbers of
 * inverted elements are certified for the whole cell. Cells that ElementType does not support are
 * rejected.
 *
 * @par Limitations:
 * Points shared by two blocks are on the boundary of each and stay.
 *
 * @par Several processes:
 * The pieces are gathered on the first process. Random numbers are drawn by the global ids of the
 * points; without ids, by the order of their coordinates. The points thus equal the serial result.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshPerturbation> perturbation;
 * perturbation->SetInputConnection(reader->GetOutputPort());
 * perturbation->SetPercentage(25);
 * perturbation->SetTangledFraction(0.01);
 * perturbation->SetSeed(7);
 * perturbation->Update();
 * std::cout << perturbation->GetSummary() << "\n";
 * @endcode
 *
 * @sa tautline::perturb (tautline/Perturbation/Perturb.h), vtkElementQuality, vtkMeshComparison
 */

#ifndef vtkMeshPerturbation_h
#define vtkMeshPerturbation_h

#include "TautlinePerturbationModule.h" // for export macro
#include "vtkTautlineSetRange.h"        // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <string> // for the notices

class vtkDataSet;

namespace tautline
{
struct InputBlock;
struct Perturbation;
}

class TAUTLINEPERTURBATION_EXPORT vtkMeshPerturbation : public vtkTautlineTimedAlgorithm
{
public:
  static vtkMeshPerturbation* New();
  vtkTypeMacro(vtkMeshPerturbation, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Percentage of the movable vertices to move, between 0 and 100. The default is 50.
   */
  vtkTautlineSetRangeMacro(Percentage, double, 0.0, 100.0);
  vtkGetMacro(Percentage, double);
  ///@}

  ///@{
  /**
   * The maximum fraction of its distance to inversion by which a vertex moves, between 0 and 1; the
   * fraction is uniformly distributed from 0 to this. The default is 0.5.
   */
  vtkTautlineSetRangeMacro(Fraction, double, 0.0, 1.0);
  vtkGetMacro(Fraction, double);
  ///@}

  ///@{
  /**
   * Fraction of the elements to be inverted in the output, between 0 and 1; inverted elements of
   * the input count. With 0, the default, no element is inverted.
   */
  vtkTautlineSetRangeMacro(TangledFraction, double, 0.0, 1.0);
  vtkGetMacro(TangledFraction, double);
  ///@}

  ///@{
  /**
   * The seed of the random numbers: any number; another seed gives another mesh. The default is 0.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Whether points with the same coordinates on matching facets, for example on the seams of a mesh
   * in pieces, are treated as one and move together. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution, over all blocks: the numbers of movable interior vertices and of
   * moved vertices; the numbers of elements inverted before and after, and the fraction of elements
   * inverted after; the largest displacement.
   */
  vtkGetMacro(NumberOfMovablePoints, vtkIdType);
  vtkGetMacro(NumberOfMovedPoints, vtkIdType);
  vtkGetMacro(InvertedBefore, vtkIdType);
  vtkGetMacro(InvertedAfter, vtkIdType);
  vtkGetMacro(TangledFractionReached, double);
  vtkGetMacro(LargestDisplacement, double);
  ///@}

  /// The mesh with other points.
  vtkDataSet* GetOutput();

protected:
  vtkMeshPerturbation();
  ~vtkMeshPerturbation() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkMeshPerturbation(const vtkMeshPerturbation&) = delete;
  void operator=(const vtkMeshPerturbation&) = delete;

  /// Perturbs a data set and adds its numbers and remarks.
  void Perturb(
    const tautline::InputBlock& block, tautline::Perturbation& total, std::string& notices);
  void Report(const tautline::Perturbation& result);

  double Percentage = 50.0;
  double Fraction = 0.5;
  double TangledFraction = 0.0;
  int Seed = 0;
  bool MergeCoincidentPoints = true;

  vtkIdType NumberOfMovablePoints = 0;
  vtkIdType NumberOfMovedPoints = 0;
  vtkIdType InvertedBefore = 0;
  vtkIdType InvertedAfter = 0;
  double TangledFractionReached = 0.0;
  double LargestDisplacement = 0.0;
};

#endif
