// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshMotionAlgorithm
 * @brief Base class of filters that move the points of a mesh; handles fixed points, blocks and the
 * history.
 *
 * Abstract. Such a filter keeps the connectivity. Its input on port 0 is a data set with explicit
 * points, or blocks of these, which are treated one after the other, each with its own boundary
 * (the partitions of a partitioned or multipiece data set are one mesh, see GetGatheredRules()): a
 * seam between two blocks stays in place with the boundary, and causes a warning; if the boundary
 * can slide or move freely, a seam is an error, because the blocks would come apart (run Merge
 * Blocks first). A mesh that is reversed throughout is treated as its mirror image. Cells that list
 * their points in the opposite order of the others are treated as if reversed, and keep their order
 * in the output; a message reports their number. Parts without a consistent orientation (a Moebius
 * band), image data (implicit points) and cells of higher order are not supported.
 *
 * @par Fixed points:
 * A point does not move if its value in a point array is not 0 (SetInputArrayToProcess(); see the
 * documentation of the filter for the index), or if a vtkSelection contains it or one of its cells.
 * The points of ghost cells never move, so that the parts of a distributed mesh still fit together.
 *
 * @par Coincident points:
 * A mesh in pieces has coincident points on its seams. By default they are treated as one point
 * (MergeCoincidentPoints) and move together; the output has all points of the input.
 *
 * @par Outputs:
 * Port 0 has the new points, in the precision of the input unless a valid element would become
 * invalid by rounding, and the point array `Displacement` (3 components, new minus old position, in
 * the unit of the coordinates). Port 1 is the table `History`, a row per iteration or stage.
 *
 * @sa vtkMeshOptimizer, vtkMeshUntangler, vtkMeshWarp, vtkTautlineAlgorithm
 */

#ifndef vtkMeshMotionAlgorithm_h
#define vtkMeshMotionAlgorithm_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkTautlineSetRange.h"
#include "vtkTautlineTimedAlgorithm.h"

#include <memory> // for Group

class vtkDataObject;

namespace tautline
{
class MovableMesh;
class RankGroup;
struct InputBlock;
}

class TAUTLINECORE_EXPORT vtkMeshMotionAlgorithm : public vtkTautlineTimedAlgorithm
{
public:
  vtkTypeMacro(vtkMeshMotionAlgorithm, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether to treat points with the same coordinates on matching facets as one, for example on the
   * seams of a mesh in pieces; if off, they can move apart, as required for cracks and contacts.
   * The default is on. See tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Whether to treat one layer of hexahedra and wedges between two planes, as in 2D cases of
   * OpenFOAM, as a planar mesh: the points of one side move in their plane, and the points of the
   * other side move with them. The default is on. See LayerMesh in Filters/Core.
   */
  vtkSetMacro(PlanarLayers, bool);
  vtkGetMacro(PlanarLayers, bool);
  vtkBooleanMacro(PlanarLayers, bool);
  ///@}

  enum Redistributions
  {
    NO_REDISTRIBUTION = 0, ///< each process works on the points that its piece has
    KD_TREE = 1,           ///< boxes with about equal numbers of points; fast
    PT_SCOTCH = 2          ///< balanced parts with short borders; needs PETSc with PT-Scotch
  };

  ///@{
  /**
   * On a server with several processes: whether and how the mesh is redistributed among them, also
   * if all of it is on the first process, as after reading a serial file. This balances the work
   * and limits the communication. The result goes back to the pieces of the input, with the same
   * points. Steps that need the whole mesh still gather it. RedistributeOn() selects the k-d tree.
   * The default is NO_REDISTRIBUTION.
   */
  vtkTautlineSetRangeMacro(Redistribute, int, NO_REDISTRIBUTION, PT_SCOTCH);
  vtkGetMacro(Redistribute, int);
  vtkBooleanMacro(Redistribute, int);
  ///@}

  /// The table of output port 1.
  vtkTable* GetHistory() { return this->GetOutputTable(HistoryPort); }

protected:
  vtkMeshMotionAlgorithm();
  ~vtkMeshMotionAlgorithm() override;

  /// Without MergeCoincidentPoints only global ids join partitions.
  tautline::GatheredRules GetGatheredRules() override;

  enum Ports
  {
    MeshPort = 0,
    HistoryPort = 1 // output
  };

  /**
   * For TakesPieces(): whether each process works on its piece of the mesh in the next execution.
   * False if all cells are on the first process (unless redistributed) and if the mesh must be
   * gathered, with the reason in GetWhyGathered(): blocks, surfaces in space, inclined planes,
   * cells of extreme size, pieces that cannot be joined, or processes that do not communicate by
   * MPI. Collective.
   * @param input the mesh, or the mesh at the first time step
   * @param why another reason to gather the mesh, for example "features need the whole mesh"; or ""
   */
  bool TakePiece(vtkDataObject* input, const std::string& why);

  /// Releases a piece that an earlier execution did not use.
  void DropPiece();

  /// Whether this execution works on pieces; in the reproducible order there may be a single piece.
  bool WorksOnPieces() const { return this->Piece || this->ReproducibleOrder; }

  /// The mesh of a data set within ForEachBlock(), see tautline::MovableMesh; or the mesh of
  /// TakePiece(), which is then no longer kept.
  std::unique_ptr<tautline::MovableMesh> MakeMesh(const tautline::InputBlock& block, bool framed);

  /// Whether this process reports for all processes that work on pieces; true for a single process.
  bool IsFirst() const;

  /// A sentence on the reason for gathering the mesh, or "".
  const std::string& GetWhyGathered() const { return this->WhyGathered; }

  /**
   * Calls visit for each data set of the input, with its counterparts and its output, which has the
   * arrays of the input. Data sets without points or cells are passed on without a call, except
   * pieces, which may be empty.
   * @param reference a data object of the same structure, or null
   * @param fixedPort the input port with the selection of fixed points
   * @param boundaryMoves whether points of the boundary can move independently, so that a seam
   * between two blocks would open: a seam is then an Error, otherwise a warning
   */
  void ForEachBlock(vtkInformationVector** inputVector, vtkInformationVector* outputVector,
    vtkDataObject* reference, int fixedPort, bool boundaryMoves,
    const std::function<void(const tautline::InputBlock&)>& visit);

  /// Remarks on layers and on seams between blocks, or ""; known after ForEachBlock().
  const std::string& GetBlockNotice() const { return this->BlockNotice; }

  /// The number of data sets of the input, at least 1; known within ForEachBlock().
  int GetNumberOfBlocks() const { return this->NumberOfBlocks; }

  /// Reports the progress on a block, 0 to 1. @return false if the execution should be aborted
  bool ProceedInBlock(int block, double fraction);

  /// Whether layers are treated as planar meshes in the next execution.
  virtual bool TreatsLayers() { return this->PlanarLayers; }

  bool MergeCoincidentPoints = true;
  bool PlanarLayers = true;
  int Redistribute = NO_REDISTRIBUTION;
  bool ReproducibleOrder = false; ///< a property in some filters

private:
  /// Calls visit for a block, or for the planar mesh of a layer.
  void VisitBlock(const tautline::InputBlock& block,
    const std::function<void(const tautline::InputBlock&)>& visit);

  vtkMeshMotionAlgorithm(const vtkMeshMotionAlgorithm&) = delete;
  void operator=(const vtkMeshMotionAlgorithm&) = delete;

  int NumberOfBlocks = 1;
  std::string BlockNotice;
  // For an execution on several processes:
  std::unique_ptr<tautline::RankGroup> Group;   ///< outlives Piece
  std::unique_ptr<tautline::MovableMesh> Piece; ///< null: gathered, or one process
  std::string WhyGathered;
};

#endif
