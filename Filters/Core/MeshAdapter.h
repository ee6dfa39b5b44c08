// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::MeshAdapter
 * @brief Presents a vtkDataSet to the kernel as a tautline::Mesh, copying as little as possible.
 *
 * Point coordinates in double precision and 64-bit cell arrays are used in place. Float
 * coordinates, 32-bit cell arrays and the implicit cells of image data, rectilinear and structured
 * grids are copied. Pixels and voxels become quadrilaterals and hexahedra; polygons with three or
 * four points become triangles and quadrilaterals. Hexahedra, wedges, pyramids and quadrilaterals
 * that list points more than once are replaced by their remaining shape, see remainingShape() in
 * the kernel. Cells and points keep the numbering of the data set.
 *
 * The data set must outlive the adapter and must not change during its lifetime.
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
/// The result of MeshAdapter::remarks().
struct MeshRemarks
{
  Index higherOrderCells = 0, nonFinitePoints = 0;
  std::map<int, Index> notMeasured; ///< the numbers of cells that are left out, by VTK type
  /// The numbers of cells that list points more than once, by collapsedKey().
  std::map<int, Index> collapsed;
  std::string coarseness; ///< see MeshAdapter::coarseness()
};

/// The given and the remaining type of a collapsed cell as one number, two digits for each type.
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
   * @brief Moves copies of a point to one position in mesh(), see joinCopies() in the kernel; call
   * it before mergeCoincidentPoints(). inputView() keeps their positions.
   * @param globalIds of the points of the data set; nothing is done if null
   * @return the copies that were joined, without the points
   */
  JoinedCopies joinCopies(vtkDataArray* globalIds);
  /**
   * @brief Treats coincident points on seams as one, see findCoincidentPoints(): in mesh(), cells
   * use the representatives, and the other points belong to no cell. Points of cells that are
   * copies of another cell, as where pieces overlap, are treated in the same way. Ids do not
   * change.
   * @param dropCopies whether mesh() is without these copies, see dropCells()
   */
  void mergeCoincidentPoints(int threads = 0, bool dropCopies = false);
  /// Gives cells of mesh() a type that is not supported and no points; given() keeps them. @param
  /// flags one per cell, nonzero for these cells; or empty
  void dropCells(const std::vector<unsigned char>& flags);
  /// One flag per cell, set for dropped cells; empty if there are none.
  const std::vector<unsigned char>& droppedCells() const { return this->Dropped; }
  /// The merged points; empty before mergeCoincidentPoints().
  const CoincidentPoints& coincident() const { return this->Coincident; }
  /**
   * @brief Makes mesh() consistent: cells that list their points in the opposite order of the
   * others are reversed (see consistentOrder()); a mesh that is reversed throughout is treated as
   * its mirror image. The data set and ids do not change. Call it after mergeCoincidentPoints() and
   * enterFrame(), if these are used.
   * @param validity null, or space for one value per cell, which is set to the validity in the
   * result
   * @param required whether to throw Error if a part has no consistent order; otherwise its cells
   * stay as they are
   * @return the findings as sentences for the user, or ""
   */
  std::string orient(signed char* validity = nullptr, bool required = true);
  /**
   * @brief The same for a piece, with the findings for the whole mesh.
   * @param piece the number of this piece in `found`
   */
  std::string orient(signed char* validity, const RankOrder& found, std::size_t piece = 0);
  /// The result of consistentOrder() for this mesh alone.
  RankOrder findOrder(signed char* validity) const;
  /// Lists the cells with nonzero flags (one per cell) in the opposite order in mesh().
  void reverseCells(const std::vector<unsigned char>& flags);
  /// The cells that orient() listed in the opposite order, one flag per cell; empty if there are
  /// none.
  const std::vector<unsigned char>& reversedCells() const { return this->Reversed; }
  /// The mesh with the cells' points as in the data set.
  const Mesh& given() const { return this->Given ? *this->Given : *this->TheMesh; }

  /// Finds cells and points that are treated specially.
  /// @param ghosts whether ghost cells count
  MeshRemarks remarks(bool ghosts = true) const;

  /**
   * @brief Remarks for the user on the interpretation of the mesh, as sentences, or "":
   * higher-order cells measured at their corners, collapsed cells, cells left out (by type and
   * number), points with NaN coordinates, coarse coordinates.
   */
  std::string notice() const;

  /**
   * @brief A sentence, with the remedy, if the coordinates are too coarse for the cells because
   * these lie far from the origin; otherwise "".
   */
  std::string coarseness() const;

  /**
   * @brief Transforms the mesh to a frame in which its cells have ordinary size and are near the
   * origin. Has no effect on most meshes.
   * @param shifted whether the origin may move
   */
  void enterFrame(bool shifted = true);
  /// The frame of the mesh; the identity before enterFrame().
  const CoordinateFrame& frame() const { return this->Frame; }
  /**
   * @brief Transforms points of mesh() to the coordinates of the data set. Points that have not
   * moved get exactly their original coordinates.
   */
  std::vector<double> leaveFrame(const std::vector<double>& points) const;
  /// The mesh with the coordinates of the data set; not checked again.
  const MeshView& inputView() const { return this->InputView; }

  /// The number of bytes copied because VTK's arrays have other types.
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

/// The ids of points in the type of the kernel; empty without an array.
TAUTLINECORE_EXPORT std::vector<Index> idsOf(vtkDataArray* globalIds);

/// Describes the orientation of the cells in a sentence for the user; empty if it is consistent.
TAUTLINECORE_EXPORT std::string describe(const Orientation& orientation, Dimension dimension);
inline std::string describe(const Orientation& orientation, const Mesh& mesh)
{
  return describe(orientation, mesh.dimension());
}
/// The same, including the correction by MeshAdapter::orient().
TAUTLINECORE_EXPORT std::string describe(const RankOrder& order, Dimension dimension);
/// MeshAdapter::notice() of these remarks.
TAUTLINECORE_EXPORT std::string describe(const MeshRemarks& remarks);
/// Joins the remarks on all pieces of a mesh, one piece per rank. Collective.
TAUTLINECORE_EXPORT MeshRemarks joinRemarks(RankGroup& group, const MeshRemarks& own);
/// The first nonempty text among the ranks, returned on all of them. Collective.
TAUTLINECORE_EXPORT std::string firstText(RankGroup& group, const std::string& own);

/**
 * @brief Reverses the order of the points of cells, in a copy used only by this output. Throws
 * Error for data sets other than unstructured grids and poly data, and for cells of higher order.
 * @param flags one per cell, nonzero for the cells to reverse; empty for all
 */
TAUTLINECORE_EXPORT void flipCells(vtkDataSet* data, const std::vector<unsigned char>& flags = {});

/// Flags the 2D cells beside 3D ones. Empty if there are none.
TAUTLINECORE_EXPORT std::vector<unsigned char> facesBesideVolumes(const Mesh& mesh);

/**
 * @brief Cells that are not elements: ghosts, and cells of lower dimension than others, which are
 * vertices, lines and 2D cells beside 3D ones. Empty if there are none.
 */
TAUTLINECORE_EXPORT std::vector<unsigned char> cellsBesideElements(const MeshAdapter& adapter);

/// Cells to leave out of statistics: ghosts, and 2D cells beside 3D ones. Empty if there are none.
TAUTLINECORE_EXPORT std::vector<unsigned char> cellsToSkip(const MeshAdapter& adapter);

/**
 * @brief New points for an output: in single precision if `like` is, otherwise in double precision.
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkPoints> makePoints(
  const std::vector<double>& coordinates, vtkPoints* like);
}
#endif
