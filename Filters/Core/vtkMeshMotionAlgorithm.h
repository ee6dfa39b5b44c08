// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshMotionAlgorithm
 * @brief Base class of the filters that move the points of a mesh: fixed points, blocks, history.
 *
 * Abstract. Such a filter keeps the connectivity. Its input on port 0 is a data set with explicit
 * points, or blocks of these, which are treated one after the other, each with its own boundary
 * (the partitions of a partitioned or multipiece data set are one mesh, see GetGatheredRules()): a
 * seam between two blocks stays in place with the boundary, and is a warning; if the boundary can
 * slide or move freely, it is an error, as the blocks would come apart (Merge Blocks is the
 * remedy). A mesh that is reversed throughout is treated as its mirror image. Cells that list
 * their points in the opposite order of the others are treated as if they did not, and keep their
 * order in the output; a message says how many. Parts without a consistent orientation (a Moebius
 * band), image data (implicit points) and cells of higher order are refused.
 *
 * @par Fixed points:
 * A point does not move where a point array (SetInputArrayToProcess(); the index is in the
 * documentation of the filter) is not 0, and where a vtkSelection contains it or a cell of it. The
 * points of ghost cells never move, so that the parts of a distributed mesh still fit together.
 *
 * @par Coincident points:
 * A mesh in pieces has several points at the same place on its seams. They are one point by default
 * (MergeCoincidentPoints) and move together; the output has the points of the input.
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
   * Whether points with the same coordinates on facets that match are treated as one, as on the
   * seams of a mesh in pieces; off: they move apart, as a crack or a contact needs it. The default
   * is on. See tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Whether one layer of hexahedra and wedges between two planes, as 2D cases of OpenFOAM have it,
   * is treated as the planar mesh that it is: the points of one side move in their plane, those of
   * the other with them. The default is on. See LayerMesh in Filters/Core.
   */
  vtkSetMacro(PlanarLayers, bool);
  vtkGetMacro(PlanarLayers, bool);
  vtkBooleanMacro(PlanarLayers, bool);
  ///@}

  enum Redistributions
  {
    NO_REDISTRIBUTION = 0, ///< each process works on the points that its piece has
    KD_TREE = 1,           ///< boxes of about as many points: fast
    PT_SCOTCH = 2 ///< parts of about as many elements with short borders: needs PETSc's PT-Scotch
  };

  ///@{
  /**
   * On a server with several processes: whether and how the mesh is divided anew among them, also
   * where all of it is on the first process, as readers of serial files leave it. Then all of them
   * have as much to do, and little to send. The result goes back to the pieces of the input, with
   * the same points. What needs the whole mesh is gathered as without it. RedistributeOn() takes
   * the k-d tree. The default is NO_REDISTRIBUTION.
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
   * For TakesPieces(): whether each process works on its piece of the mesh in the execution to
   * come. Not where all cells are on the first process (unless redistributed), and where the mesh
   * has to be gathered, which GetWhyGathered() then says: blocks, surfaces in space, planes that
   * are inclined, cells of extreme size, and pieces that cannot be joined; and processes that do
   * not communicate by MPI. Collective.
   * @param input the mesh, or what it is at the first time step
   * @param why what else needs the whole mesh, "features need the whole mesh"; or ""
   */
  bool TakePiece(vtkDataObject* input, const std::string& why);

  /// Forgets a piece that an execution before did not use.
  void DropPiece();

  /// Whether this execution works on pieces, which may be the only one in the reproducible order.
  bool WorksOnPieces() const { return this->Piece || this->ReproducibleOrder; }

  /// The mesh of a data set within ForEachBlock(), see tautline::MovableMesh; that of TakePiece(),
  /// which is no longer kept.
  std::unique_ptr<tautline::MovableMesh> MakeMesh(const tautline::InputBlock& block, bool framed);

  /// Whether this process reports for all that work on pieces; the only one does.
  bool IsFirst() const;

  /// Why the mesh was put together, as a sentence, or "".
  const std::string& GetWhyGathered() const { return this->WhyGathered; }

  /**
   * Calls visit for each data set of the input, with its counterparts and its output, which has the
   * arrays of the input. Data sets without points or cells are passed on without a call, but for
   * pieces, which may be empty.
   * @param reference a data object of the same structure, or null
   * @param fixedPort the input port with the selection of fixed points
   * @param boundaryMoves whether points of the boundary can move by themselves, so that a seam
   * between two blocks would open: Error if there is one; else a warning
   */
  void ForEachBlock(vtkInformationVector** inputVector, vtkInformationVector* outputVector,
    vtkDataObject* reference, int fixedPort, bool boundaryMoves,
    const std::function<void(const tautline::InputBlock&)>& visit);

  /// Remarks on layers and on seams between blocks, or ""; known after ForEachBlock().
  const std::string& GetBlockNotice() const { return this->BlockNotice; }

  /// The number of data sets of the input, at least 1; known within ForEachBlock().
  int GetNumberOfBlocks() const { return this->NumberOfBlocks; }

  /// Reports the progress on a block, 0 to 1. @return false if the execution is to be aborted
  bool ProceedInBlock(int block, double fraction);

  /// Whether layers are treated so in the execution to come.
  virtual bool TreatsLayers() { return this->PlanarLayers; }

  bool MergeCoincidentPoints = true;
  bool PlanarLayers = true;
  int Redistribute = NO_REDISTRIBUTION;
  bool ReproducibleOrder = false; ///< a property of some filters

private:
  /// Calls visit for a block, of a layer for its planar mesh.
  void VisitBlock(const tautline::InputBlock& block,
    const std::function<void(const tautline::InputBlock&)>& visit);

  vtkMeshMotionAlgorithm(const vtkMeshMotionAlgorithm&) = delete;
  void operator=(const vtkMeshMotionAlgorithm&) = delete;

  int NumberOfBlocks = 1;
  std::string BlockNotice;
  // Of an execution on several processes:
  std::unique_ptr<tautline::RankGroup> Group;   ///< outlives Piece
  std::unique_ptr<tautline::MovableMesh> Piece; ///< null: gathered, or one process
  std::string WhyGathered;
};

#endif
