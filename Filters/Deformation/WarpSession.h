// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSession.h
 * @brief What Warp Mesh keeps between executions: meshes at rest, matrices, time steps.
 */
#ifndef tautline_WarpSession_h
#define tautline_WarpSession_h

#include "Blocks.h"
#include "RestingMesh.h"
#include "TargetMatch.h"
#include "WarpOutput.h"
#include "tautline/Deformation/PointMotion.h"
#include "tautline/Deformation/Warp.h"

#include "vtkPointSet.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>

namespace tautline
{
/// How the boundary moves; the numbers of vtkMeshWarp::Motions.
enum class MotionSource : int
{
  Displacement = 0,
  Target = 1,
  Transform = 2,
  TimeSteps = 3
};

/// Indices of SetInputArrayToProcess(). All arrays are of the mesh: ParaView's pipeline takes those
/// of one port at consecutive indices only.
enum WarpArrays
{
  DisplacementArray = 0,
  MovedArray = 1,
  FixedArray = 2,
  TensorArray = 3,
  RegionArray = 4
};

/// The properties of the filter.
struct WarpSettings
{
  MotionSource motion = MotionSource::Transform;
  double amount = 1.0;           ///< of the motion, along its path; at least 0
  bool fromPreviousStep = false; ///< whether a time step starts from the one before
  Correspondence correspondence = Correspondence::Automatic;
  std::string targetIds; ///< a point array of the target; "" or "None": none
  MovedPart part = MovedPart::Automatic;
  std::vector<int> partNumbers;               ///< from 1
  std::vector<double> partValues;             ///< of the array at MovedArray
  PointMotion transform;                      ///< of MotionSource::Transform
  bool tensorsByRegion = false;               ///< PerCell: from `regions`, not from TensorArray
  std::vector<std::array<double, 4>> regions; ///< value, alpha, beta, gamma
  bool mergePoints = true;                    ///< whether coincident points on seams are one
  WarpOptions options;                        ///< all that needs no data set
  vtkAlgorithm* arrays = nullptr;             ///< whose input arrays are chosen
  std::function<bool(int, double)> progress;  ///< block, fraction; false stops
  std::function<double()> secondsLeft;        ///< of the execution; 0 is no limit

  /// Whether the method has coefficients.
  bool anisotropic() const { return isAnisotropic(this->options.method); }
};

// Errors.
constexpr const char* NoTimeSteps =
  "The input has no time steps its boundary could move over: choose another Motion.";
// Messages of a result.
constexpr const char* NothingMoves = "No point of the boundary moves: set the motion.";
constexpr const char* PreviousInvalid =
  "The time step before was not valid, so this one started from the first.";
constexpr const char* PreviousLimited =
  "A time step before this one had reached the time limit, and this one started from there: raise "
  "the Time Limit.";
/// Says so in a result if the one that it started from was limited, or says so.
void notePrevious(const WarpResult& previous, WarpResult& result);

/// The name of a method in the menu.
const char* nameOf(WarpMethod method);
/// The point array that moves the boundary: the chosen one, or `Displacement`, or the vectors; or
/// null.
vtkDataArray* displacementArray(vtkAlgorithm* algorithm, vtkDataSet* input);

/// A data set of the input.
struct WarpBlock
{
  RestingMesh rest;
  vtkSmartPointer<vtkPointSet> first; ///< at the first time step
  std::map<int, WarpResult> frames;   ///< at time steps, each warped from the one before
};

/// Drops the time steps that are kept if another one would need too much memory: going back starts
/// from the first then, and ends in the same place.
/// @param numbers of coordinates of a time step
void limitFrames(WarpBlock& block, std::size_t numbers);

/// The requested motion of a data set.
struct WarpTask
{
  PointFlags prescribed, stay;
  PointFlags own; ///< points whose motion is given, the others of the boundary stay; empty: all
  std::vector<double> displacement; ///< at the amount, from the mesh at rest
  /// The same after a fraction (0 to 1) of the way, where it is not straight; or empty.
  std::function<std::vector<double>(double)> path;
  std::vector<double> tensors; ///< or empty
  std::string correspondence;  ///< or ""
};

/// Which part of the boundary moves, as far as the settings say; of a data set or piece.
PartChoice partChoice(const WarpSettings& settings, vtkDataSet* input);
/// The coefficients per cell of a data set or piece, 6 each; empty if the method has none of these.
std::vector<double> chosenTensors(const WarpSettings& settings, vtkDataSet* input);
/// Fixes points where they are: they are prescribed, and do not move.
void holdStaying(WarpTask& task);
/// Whether nothing moves, not even on the way: full turns end where they began.
bool staysAtRest(const WarpTask& task);
/// The result of that. @param points as they are
WarpResult resultAtRest(const WarpSettings& settings, std::vector<double> points);
WarpResult runWarp(Warper& warper, const WarpTask& task);
/**
 * @brief Places the nodes between the corners of curved cells, which follow; on the boundary where
 * they have motions of their own, there, if the corners came to the end of theirs.
 * @param rest what the corners started from; with CurvedMesh
 */
void followCorners(const RestingMesh& rest, const WarpTask& task, int threads,
  std::vector<double>& points, double amount);
/// What the report says of the settings.
WarpFacts factsOf(const WarpSettings& settings, const WarpTask& task);

/**
 * @class tautline::WarpSession
 * @brief The executions of a filter: for each data set the mesh at rest with its matrices and, of
 * motions over time, the time steps that others start from.
 */
class WarpSession
{
public:
  WarpSettings settings; ///< set them before each call

  // Time steps one after the other, if the motion is one over time.
  std::vector<double> ownTimes; ///< as the inputs of this process have them
  std::vector<double> times;    ///< of all processes, see agreeOnTimes()
  bool looping = false;         ///< another pass of the same execution
  bool begun = false; ///< the first time step is known (or this process has nothing of it)
  int requested = 0, current = 0; ///< numbers of time steps
  // On several processes.
  bool piecewise = false;   ///< each process keeps its piece, else the first one the whole mesh
  bool gathers = false;     ///< since the pieces change over time
  bool startsAgain = false; ///< the first time step is to be requested again

  /// Whether the settings make a motion over time, if there are time steps.
  bool overTime() const;
  /// Whether a result needs more than the data at its time.
  bool sequence() const;
  /// Whether the data are those of the time that is requested.
  bool atRequested() const { return !this->sequence() || this->current == this->requested; }
  /// Takes the time steps of the first process that has any: readers may give none to a process
  /// without cells. Collective.
  /// @param needed else each process has its own
  void agreeOnTimes(bool needed);
  /// Throws Error if there were other ones on another process.
  void requireSameTimes() const;
  /**
   * @brief Chooses the time step to request. Collective.
   * @param time that is requested, or nothing if this process knows of none
   * @param own the modification time of the filter
   */
  void plan(std::optional<double> time, vtkMTimeType upstream, vtkMTimeType own);
  /// Does what this time step needs of a data set; warps it if it is the one requested.
  void visit(const InputBlock& block, vtkDataObject* target, vtkDataObject* selected,
    TableRows& history, TableRows& statistics, WarpTotals& totals);
  /**
   * @brief The points of a data set's boundary that are to move, whatever the amount; of a motion
   * over time all of the boundary. One flag per point; warps nothing. Throws Error as visit() does.
   */
  PointFlags movingPoints(const InputBlock& block, vtkDataObject* target, vtkDataObject* selected);
  /// The mesh of a data set after movingPoints().
  const RestingMesh& restingMesh(int block) const { return this->Blocks.at(block).rest; }
  /// What a process keeps of its piece of a mesh on several processes.
  WarpBlock& ownPiece() { return this->Blocks[0]; }
  /// The piece at the first time step, with its global ids; that of the input if none is kept yet.
  /// Null if points are implicit, or for blocks.
  vtkPointSet* firstPiece(vtkDataObject* input);
  /// Drops all pieces; the first time step is requested again and the mesh is gathered from then
  /// on.
  void beginGathered();
  /// Drops the data sets from a number on.
  void forgetFrom(int block);
  /// Drops all data, after an error.
  void clear();

private:
  WarpTask task(const InputBlock& block, const RestingMesh& rest, vtkDataObject* target,
    vtkDataObject* selected) const;
  void moveByArray(const InputBlock& block, const RestingMesh& rest, WarpTask& task) const;
  void moveOverTime(const InputBlock& block, const RestingMesh& rest, WarpTask& task) const;
  PointFlags movedPart(
    const InputBlock& block, const RestingMesh& rest, vtkDataObject* selected) const;
  void moveToTarget(const InputBlock& block, const RestingMesh& rest, vtkDataObject* target,
    const PointFlags& moved, WarpTask& task) const;
  void moveByTransform(const RestingMesh& rest, const PointFlags& moved, WarpTask& task) const;
  void prescribe(const InputBlock& block, const RestingMesh& rest, WarpTask& task) const;
  std::vector<double> optionValues() const;
  WarpOptions optionsFor(const RestingMesh& rest, int blockNumber);
  bool prepare(RestingMesh& rest, WarpTask& task, int blockNumber);
  WarpResult warp(WarpBlock& kept, WarpTask& task, int blockNumber, bool& reused);
  WarpResult warpFromPrevious(
    RestingMesh& rest, const WarpResult& previous, const WarpTask& task, int blockNumber);

  std::map<int, WarpBlock> Blocks; ///< by number
  vtkMTimeType Upstream = 0, Own = 0;
  std::string TimesProblem; ///< or ""
};
}
#endif
