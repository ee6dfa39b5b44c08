// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::MeshAdapter
 * @brief Shows a vtkDataSet to the kernel as a tautline::Mesh, copying only what it must.
 *
 * Point coordinates in double precision and 64-bit cell arrays are used where they are. Float
 * coordinates, 32-bit cell arrays and the implicit cells of image data, rectilinear and structured
 * grids are copied. Pixels and voxels become quadrilaterals and hexahedra; polygons with three or
 * four points become triangles and quadrilaterals. Hexahedra, wedges, pyramids and quadrilaterals
 * that list points more than once become what remains of them, see remainingShape() of the kernel.
 * The numbering of cells and points is the data set's.
 *
 * The data set must outlive the adapter and not change meanwhile.
 */
#ifndef tautline_MeshAdapter_h
#define tautline_MeshAdapter_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/CellOrder.h"
#include "tautline/Mesh/CoincidentPoints.h"
#include "tautline/Mesh/CollapsedCells.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/Mesh/PointCopies.h"

#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkPoints;

namespace tautline
{
/// What MeshAdapter::remarks() finds.
struct MeshRemarks
{
  Index higherOrderCells = 0, nonFinitePoints = 0;
  std::map<int, Index> notMeasured; ///< the numbers of cells that are left out, by VTK's type
  /// The numbers of cells that list points more than once, by collapsedKey().
  std::map<int, Index> collapsed;
  std::string coarseness; ///< see MeshAdapter::coarseness()
};

/// What a collapsed cell is and becomes as one number: two digits for each type.
constexpr int collapsedKey(CellType given, CellType remaining)
{
  return 100 * static_cast<int>(given) + static_cast<int>(remaining);
}

class TAUTLINECORE_EXPORT MeshAdapter
{
public:
  /// Throws tautline::Error if the mesh is malformed. An empty data set gives an empty mesh.
  explicit MeshAdapter(vtkDataSet* input, int threads = 0);

  Mesh& mesh() { return *this->TheMesh; }
  const Mesh& mesh() const { return *this->TheMesh; }

  /**
   * @brief Gives copies of a point one place in mesh(), see joinCopies() of the kernel; to be
   * called before mergeCoincidentPoints(). inputView() keeps their places.
   * @param globalIds of the points of the data set; null: nothing is done
   * @return what was joined, without the points
   */
  JoinedCopies joinCopies(vtkDataArray* globalIds);
  /**
   * @brief Treats coincident points on seams as one, see findCoincidentPoints(): in mesh(), cells
   * use the representatives, and the other points are of no cell. Ids do not change. So are the
   * points of cells that are copies of another one, as where pieces overlap.
   * @param dropCopies whether mesh() is without these copies, see dropCells()
   */
  void mergeCoincidentPoints(int threads = 0, bool dropCopies = false);
  /// Makes cells of mesh() ones of a type that is not supported, without points; given() keeps
  /// them. @param flags one per cell, nonzero for those; or empty
  void dropCells(const std::vector<unsigned char>& flags);
  /// One flag per cell: dropped; empty if none is.
  const std::vector<unsigned char>& droppedCells() const { return this->Dropped; }
  /// What was merged; empty before mergeCoincidentPoints().
  const CoincidentPoints& coincident() const { return this->Coincident; }
  /**
   * @brief Makes mesh() consistent: cells that list their points in the opposite order of the
   * others are listed in theirs (see consistentOrder()); a mesh that is reversed throughout is
   * viewed as its mirror image. The data set is not changed, ids do not change. To be called after
   * mergeCoincidentPoints() and enterFrame(), where these are.
   * @param validity null, or the place of one value per cell, which it gets: that of the result
   * @param required whether to throw Error where a part has no consistent order; else its cells
   * stay as they are
   * @return what was found, in sentences for the user, or ""
   */
  std::string orient(signed char* validity = nullptr, bool required = true);
  /**
   * @brief The same with what is known of the whole mesh, of which this is a piece.
   * @param piece the number of this piece in `found`
   */
  std::string orient(signed char* validity, const RankOrder& found, std::size_t piece = 0);
  /// What consistentOrder() finds of this mesh alone.
  RankOrder findOrder(signed char* validity) const;
  /// Lists the cells with nonzero flags (one per cell) in the opposite order in mesh().
  void reverseCells(const std::vector<unsigned char>& flags);
  /// The cells that orient() listed in the opposite order, one flag per cell; empty if there are
  /// none.
  const std::vector<unsigned char>& reversedCells() const { return this->Reversed; }
  /// The mesh with the points that its cells have in the data set.
  const Mesh& given() const { return this->Given ? *this->Given : *this->TheMesh; }

  /// Which cells and points are not as others.
  /// @param ghosts whether ghost cells count
  MeshRemarks remarks(bool ghosts = true) const;

  /**
   * @brief Remarks for the user on how the mesh is interpreted, as sentences, or "":
   * higher-order cells measured on their corners, collapsed cells, cells left out (by type and
   * number), points with NaN coordinates, coarse coordinates.
   */
  std::string notice() const;

  /**
   * @brief A sentence on coordinates that are too coarse for the cells, which lie far from the
   * origin, with the remedy; "" for others.
   */
  std::string coarseness() const;

  /**
   * @brief Replaces the mesh by the same in a frame in which its cells are of ordinary size and
   * near the origin. Without effect on most meshes.
   * @param shifted off: the origin stays where it is
   */
  void enterFrame(bool shifted = true);
  /// The frame of the mesh; the identity before enterFrame().
  const CoordinateFrame& frame() const { return this->Frame; }
  /**
   * @brief Points of mesh() in the coordinates of the data set. Those that are where they were in
   * mesh() have exactly the coordinates that they had.
   */
  std::vector<double> leaveFrame(const std::vector<double>& points) const;
  /// The mesh with the coordinates of the data set; not checked again.
  const MeshView& inputView() const { return this->InputView; }

  /// Bytes copied because VTK's arrays had other types.
  std::size_t copiedBytes() const;

  /// One flag per cell, nonzero for ghost (duplicate or hidden) cells; null if there are none.
  const unsigned char* ghostCells() const { return this->Ghosts; }

private:
  void setMirrored(bool mirrored);
  void takePoints(vtkDataSet* input);
  void takeCells(vtkDataSet* input);
  void takeCollapsed();
  bool acrossY(Index first) const;

  std::vector<double> Points, JoinedPoints;
  vtkSmartPointer<vtkUnsignedCharArray> GivenTypes; ///< that the view refers to
  std::vector<unsigned char> Types;
  std::vector<Index> Offsets;
  std::vector<Index> Connectivity;
  CollapsedCells Collapsed;
  std::vector<Index> OrientedConnectivity;
  std::vector<unsigned char> Reversed;
  const unsigned char* Ghosts = nullptr;
  int Threads;
  bool SinglePrecision = false;
  MeshView View, InputView;
  CoordinateFrame Frame;
  std::vector<double> FramedPoints;
  CoincidentPoints Coincident;
  std::vector<Index> MergedConnectivity;
  std::vector<unsigned char> Dropped, KeptTypes; ///< per cell
  std::vector<Index> KeptOffsets;
  std::unique_ptr<Mesh> Given; ///< null if it is TheMesh
  std::unique_ptr<Mesh> TheMesh;
};

/// The ids of points as those of the kernel; empty without an array.
TAUTLINECORE_EXPORT std::vector<Index> idsOf(vtkDataArray* globalIds);

/// Says how the cells are oriented, in a sentence for the user; empty when all is well.
TAUTLINECORE_EXPORT std::string describe(const Orientation& orientation, Dimension dimension);
inline std::string describe(const Orientation& orientation, const Mesh& mesh)
{
  return describe(orientation, mesh.dimension());
}
/// The same with what MeshAdapter::orient() does about it.
TAUTLINECORE_EXPORT std::string describe(const RankOrder& order, Dimension dimension);
/// MeshAdapter::notice() of these remarks.
TAUTLINECORE_EXPORT std::string describe(const MeshRemarks& remarks);
/// The remarks on all pieces of a mesh, of which each rank gives its own. Collective.
TAUTLINECORE_EXPORT MeshRemarks joinRemarks(RankGroup& group, const MeshRemarks& own);
/// The first text of the ranks that is not empty, on all. Collective.
TAUTLINECORE_EXPORT std::string firstText(RankGroup& group, const std::string& own);

/**
 * @brief Reverses the order of the points of cells in a copy that only this output uses. Throws
 * Error for data sets other than unstructured grids and poly data, and for cells of higher order.
 * @param flags one per cell, nonzero for those to reverse; empty: all
 */
TAUTLINECORE_EXPORT void flipCells(vtkDataSet* data, const std::vector<unsigned char>& flags = {});

/// Flags the 2D cells beside 3D ones. Empty if there are none.
TAUTLINECORE_EXPORT std::vector<unsigned char> facesBesideVolumes(const Mesh& mesh);

/**
 * @brief Cells that are no elements: ghosts, and cells of lower dimension than others, which are
 * vertices, lines and 2D cells beside 3D ones. Empty if there are none.
 */
TAUTLINECORE_EXPORT std::vector<unsigned char> cellsBesideElements(const MeshAdapter& adapter);

/// Cells to leave out of statistics: ghosts, and 2D cells beside 3D ones. Empty if there are none.
TAUTLINECORE_EXPORT std::vector<unsigned char> cellsToSkip(const MeshAdapter& adapter);

/**
 * @brief New points for an output: in single precision if `like` is, else in double precision.
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkPoints> makePoints(
  const std::vector<double>& coordinates, vtkPoints* like);
}
#endif
