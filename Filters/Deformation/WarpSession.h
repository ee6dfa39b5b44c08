// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSession.h
 * @brief The state of Warp Mesh between executions: meshes at rest, matrices, time steps.
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
/// The motion of the boundary; the values of vtkMeshWarp::Motions.
enum class MotionSource : int
{
  Displacement = 0,
  Target = 1,
  Transform = 2,
  TimeSteps = 3
};

/// Indices for SetInputArrayToProcess(). All arrays belong to the mesh; ParaView's pipeline
/// requires consecutive indices for the arrays of one port.
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
  double amount = 1.0;           ///< fraction of the motion, along its path; at least 0
  bool fromPreviousStep = false; ///< whether a time step starts from the previous one
  Correspondence correspondence = Correspondence::Automatic;
  std::string targetIds; ///< a point array of the target; "" or "None": none
  MovedPart part = MovedPart::Automatic;
  std::vector<int> partNumbers;               ///< from 1
  std::vector<double> partValues;             ///< in the array at MovedArray
  PointMotion transform;                      ///< of MotionSource::Transform
  bool tensorsByRegion = false;               ///< PerCell: from `regions`, not from TensorArray
  std::vector<std::array<double, 4>> regions; ///< value, alpha, beta, gamma
  bool mergePoints = true;                    ///< whether coincident points on seams are one
  WarpOptions options;                        ///< all options that need no data set
  vtkAlgorithm* arrays = nullptr;             ///< the filter whose input arrays are chosen
  std::function<bool(int, double)> progress;  ///< block, fraction; false stops
  std::function<double()> secondsLeft;        ///< of the execution; 0 is no limit

  /// Whether the method has coefficients.
  bool anisotropic() const { return isAnisotropic(this->options.method); }
};

// Errors.
constexpr const char* NoTimeSteps =
  "The input has no time steps for the motion of its boundary: choose another Motion.";
// Messages of a result.
constexpr const char* NothingMoves = "No point of the boundary moves: set the motion.";
constexpr const char* PreviousInvalid =
  "The previous time step was not valid, so this one started from the first.";
constexpr const char* PreviousLimited = "An earlier time step reached the time limit, and this one "
                                        "started from its result: raise the Time Limit.";
/// Adds the time-limit remark to a result if the result it started from was limited or has the
/// remark.
void notePrevious(const WarpResult& previous, WarpResult& result);

/// The name of a method in menus.
const char* nameOf(WarpMethod method);
/// The point array that moves the boundary: the chosen one, `Displacement`, or the active vectors;
/// or null.
vtkDataArray* displacementArray(vtkAlgorithm* algorithm, vtkDataSet* input);

/// A data set of the input.
struct WarpBlock
{
  RestingMesh rest;
  vtkSmartPointer<vtkPointSet> first; ///< at the first time step
  std::map<int, WarpResult> frames;   ///< at time steps, each warped from the previous one
};

/// Drops the kept time steps if another one would need too much memory: going back in time then
/// starts from the first step, with the same result.
/// @param numbers the number of coordinates of a time step
void limitFrames(WarpBlock& block, std::size_t numbers);

/// The requested motion of a data set.
struct WarpTask
{
  PointFlags prescribed, stay;
  PointFlags own; ///< points with a given motion; others on the boundary stay; empty: all
  std::vector<double> displacement; ///< at the amount, from the mesh at rest
  /// The same after a fraction (0 to 1) of the path, if it is not straight; or empty.
  std::function<std::vector<double>(double)> path;
  std::vector<double> tensors; ///< or empty
  std::string correspondence;  ///< or ""
};

/// The moving part of the boundary of a data set or piece, as far as the settings define it.
PartChoice partChoice(const WarpSettings& settings, vtkDataSet* input);
/// The coefficients per cell of a data set or piece, 6 each; empty if the method has no such
/// coefficients.
std::vector<double> chosenTensors(const WarpSettings& settings, vtkDataSet* input);
/// Fixes points at their positions: they are prescribed and do not move.
void holdStaying(WarpTask& task);
/// Whether nothing moves, not even along the path (a full turn ends where it started).
bool staysAtRest(const WarpTask& task);
/// The result in this case. @param points the unchanged points
WarpResult resultAtRest(const WarpSettings& settings, std::vector<double> points);
WarpResult runWarp(Warper& warper, const WarpTask& task);
/**
 * @brief Places the nodes between the corners of curved cells, which follow the corners. Boundary
 * nodes with their own motion follow it if the corners completed theirs.
 * @param rest the initial mesh; with CurvedMesh
 */
void followCorners(const RestingMesh& rest, const WarpTask& task, int threads,
  std::vector<double>& points, double amount);
/// The facts on the settings for the report.
WarpFacts factsOf(const WarpSettings& settings, const WarpTask& task);

/**
 * @class tautline::WarpSession
 * @brief Holds the data of executions of a filter: for each data set, the mesh at rest with its
 * matrices and, for motions over time, the time steps from which others start.
 */
class WarpSession
{
public:
  WarpSettings settings; ///< set them before each call

  // Time steps in sequence, for a motion over time.
  std::vector<double> ownTimes; ///< from the inputs of this process
  std::vector<double> times;    ///< of all processes, see agreeOnTimes()
  bool looping = false;         ///< another pass of the same execution
  bool begun = false; ///< the first time step is known (or this process has nothing of it)
  int requested = 0, current = 0; ///< numbers of time steps
  // On several processes.
  bool piecewise = false;   ///< each process keeps its piece, or the first the whole mesh
  bool gathers = false;     ///< since the pieces change over time
  bool startsAgain = false; ///< the first time step must be requested again

  /// Whether the settings define a motion over time, if there are time steps.
  bool overTime() const;
  /// Whether a result needs data of other times.
  bool sequence() const;
  /// Whether the data belong to the requested time.
  bool atRequested() const { return !this->sequence() || this->current == this->requested; }
  /// Uses the time steps of the first process that has any: readers may give none to a process
  /// without cells. Collective.
  /// @param needed if false, each process keeps its own
  void agreeOnTimes(bool needed);
  /// Throws Error if the time steps of processes differ.
  void requireSameTimes() const;
  /**
   * @brief Chooses the time step to request. Collective.
   * @param time the requested time, or nothing if this process has no time
   * @param own the modification time of the filter
   */
  void plan(std::optional<double> time, vtkMTimeType upstream, vtkMTimeType own);
  /// Does the work on a data set for this time step; warps it if the time step is the requested
  /// one.
  void visit(const InputBlock& block, vtkDataObject* target, vtkDataObject* selected,
    TableRows& history, TableRows& statistics, WarpTotals& totals);
  /**
   * @brief The boundary points of a data set that move, whatever the amount; for a motion over
   * time, the whole boundary. One flag per point; warps nothing. Throws Error as visit() does.
   */
  PointFlags movingPoints(const InputBlock& block, vtkDataObject* target, vtkDataObject* selected);
  /// The mesh of a data set after movingPoints().
  const RestingMesh& restingMesh(int block) const { return this->Blocks.at(block).rest; }
  /// The data that a process keeps for its piece of a mesh on several processes.
  WarpBlock& ownPiece() { return this->Blocks[0]; }
  /// The piece at the first time step, with its global ids; the input's piece if none is kept yet.
  /// Null if points are implicit, or for blocks.
  vtkPointSet* firstPiece(vtkDataObject* input);
  /// Drops all pieces; the first time step is requested again and the mesh is gathered from then
  /// on.
  void beginGathered();
  /// Drops the data sets from a given number on.
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
