/**
 * @file OptimizerSetup.h
 * @brief The parts of vtkMeshOptimizer: a row of its objectives, what it hands to the kernel, what
 * comes back. Internal.
 */
#ifndef tautline_OptimizerSetup_h
#define tautline_OptimizerSetup_h

#include "vtkMeshOptimizer.h"

#include "MovableMesh.h"
#include "tautline/Mesh/BoundaryShape.h"

#include "vtkMath.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

/// One objective.
struct vtkMeshOptimizer::Row
{
  int metric = static_cast<int>(tautline::Metric::InverseMeanRatio);
  int form = DEFAULT_TEMPLATE;
  double weight = 1.0;
  int target = IDEAL;
};

/// What became of one data set.
struct vtkMeshOptimizer::Run
{
  struct Frame
  {
    int iteration;
    std::vector<double> points;
  };
  tautline::OptimizeResult result;
  std::vector<Frame> frames; ///< of the animation, every stride-th iteration
  int stride = 1;
  int iterations = 0;
  std::string summary;

  /// Keeps the points of an iteration, and fewer of the others when memory ends.
  void keep(const tautline::IterationState& state, std::size_t coordinates, double megabytes)
  {
    if (this->iterations % this->stride != 0)
    {
      return;
    }
    this->frames.push_back({ this->iterations, std::vector<double>(coordinates) });
    state.points(this->frames.back().points.data());
    const auto bytes = static_cast<double>(this->frames.size() * coordinates * sizeof(double));
    if (bytes > megabytes * 1e6)
    {
      this->stride *= 2;
      const auto dropped = std::remove_if(this->frames.begin(), this->frames.end(),
        [this](const Frame& frame) { return frame.iteration % this->stride != 0; });
      this->frames.erase(dropped, this->frames.end());
    }
  }

  /// The points at a time; those of the input before the first iteration that is kept.
  std::vector<double> at(double time, const tautline::MeshView& input) const
  {
    if (vtkMath::IsNan(time) || time >= this->iterations)
    {
      return this->result.points;
    }
    const auto later = std::find_if(this->frames.begin(), this->frames.end(),
      [time](const Frame& frame) { return frame.iteration > time; });
    return later == this->frames.begin()
      ? std::vector<double>(input.points, input.points + 3 * input.numberOfPoints)
      : (later - 1)->points;
  }
};

/// Options of the kernel for one data set, and all that they point to.
struct vtkMeshOptimizer::Setup
{
  tautline::MovableMesh mesh;
  std::array<tautline::Targets, 4> targets; ///< by type
  std::vector<double> weights, limits;
  tautline::BoundaryShape shape;
  tautline::OptimizeOptions options;

  Setup(vtkMeshOptimizer* self, const tautline::InputBlock& block)
    : mesh(block.input, self->Threads)
  {
    this->setFixed(self, block);
    this->setObjectives(self, block);
    this->setAlgorithm(self);
    this->options.fixed = this->mesh.fixed().data();
  }

private:
  void setFixed(vtkMeshOptimizer* self, const tautline::InputBlock& block);
  void setObjectives(vtkMeshOptimizer* self, const tautline::InputBlock& block);
  void setAlgorithm(vtkMeshOptimizer* self);
  const tautline::Targets* target(
    vtkMeshOptimizer* self, const tautline::InputBlock& block, int type);
};

#endif
