/**
 * @file WarpSession.h
 * @brief What vtkMeshWarp keeps between executions: meshes at rest, matrices, time steps.
 */
#ifndef tautline_WarpSession_h
#define tautline_WarpSession_h

#include "MovedBoundary.h"
#include "WarpOutput.h"
#include "tautline/Deformation/Warp.h"
#include "vtkMeshWarp.h"

#include "vtkPointSet.h"

#include <functional>
#include <map>

/// A mesh at rest, and what was made of it.
struct RestingMesh
{
  vtkSmartPointer<vtkPointSet> data;
  vtkMTimeType time = 0; ///< of data when it was taken
  std::unique_ptr<tautline::MovableMesh> mesh;
  tautline::PointFlags boundary;
  // The elements alone, if there are other cells (lines, vertices, the triangles around a volume).
  std::vector<unsigned char> types;
  std::vector<tautline::Index> offsets, connectivity, cells;
  std::unique_ptr<tautline::Mesh> elements;
  // What the warper was made with, and looks at.
  tautline::PointFlags prescribed;
  std::vector<double> tensors, options, elementTensors;
  std::unique_ptr<tautline::Warper> warper;

  /// Takes a data set, unless it is the one that is here. Throws Error if nothing can be warped.
  void take(vtkPointSet* input, int threads);
  /// What is warped.
  const tautline::Mesh& warped() const
  {
    return this->elements ? *this->elements : this->mesh->mesh();
  }

  /// Of its boundary; found when first asked for.
  const tautline::BoundaryParts& parts() const;

private:
  void takeElements(int threads);

  mutable std::unique_ptr<tautline::BoundaryParts> Parts;
};

/// A data set of the input.
struct WarpBlock
{
  RestingMesh rest;
  vtkSmartPointer<vtkPointSet> first;         ///< at the first time step
  std::map<int, tautline::WarpResult> frames; ///< at time steps, each warped from the one before
};

/// The motion of a data set as it is asked for.
struct WarpTask
{
  tautline::PointFlags prescribed, stay;
  std::vector<double> displacement; ///< at the amount, from the mesh at rest
  /// The same after a part (0 to 1) of the way, where it is not straight; or empty.
  std::function<std::vector<double>(double)> path;
  std::vector<double> tensors; ///< or empty
  std::string correspondence;  ///< or ""
};

struct vtkMeshWarp::Session
{
  explicit Session(vtkMeshWarp* self)
    : Self(self)
  {
  }

  std::map<int, WarpBlock> blocks; ///< by number
  // Time steps one after the other, if the motion is one over time.
  std::vector<double> times;
  bool looping = false; ///< another pass of the same execution
  bool begun = false;   ///< the first time step is known (or this process has nothing of it)
  int wanted = 0, current = 0;
  vtkMTimeType upstream = 0, own = 0;
  // One execution.
  double numberOfBlocks = 1;

  /// Whether a result needs more than the data at its time.
  bool sequence() const;
  /// Chooses the time step to ask for.
  void plan(double time, vtkMTimeType upstreamTime);
  /// What there is to do with this data set at this time step; warps it if it is the one wanted.
  void visit(const tautline::InputBlock& block, vtkDataObject* target, vtkDataObject* selected,
    tautline::TableRows& history, tautline::TableRows& statistics, tautline::WarpTotals& totals);

private:
  WarpTask task(const tautline::InputBlock& block, const RestingMesh& rest, vtkDataObject* target,
    vtkDataObject* selected) const;
  void move(const tautline::InputBlock& block, const RestingMesh& rest, vtkDataObject* target,
    vtkDataObject* selected, WarpTask& task) const;
  std::vector<double> options() const;
  tautline::WarpOptions optionsFor(const RestingMesh& rest, int blockNumber);
  bool prepare(RestingMesh& rest, WarpTask& task, int blockNumber);
  tautline::WarpResult warp(WarpBlock& kept, WarpTask& task, int blockNumber, bool& reused);
  tautline::WarpResult run(tautline::Warper& warper, const WarpTask& task) const;
  void forget(WarpBlock& kept) const;

  vtkMeshWarp* Self;
};
#endif
