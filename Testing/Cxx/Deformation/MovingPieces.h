// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovingPieces.h
 * @brief A mesh in pieces whose points move with time, for tests.
 */
#ifndef tautline_MovingPieces_h
#define tautline_MovingPieces_h

#include "WarpingRanks.h"

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGridAlgorithm.h"

namespace tautline
{
/// The piece of a process at each time: the hole turns, and inner points drift; with the array `d`,
/// the displacements from time 0.
class MovingPieces : public vtkUnstructuredGridAlgorithm
{
public:
  static MovingPieces* New() { VTK_STANDARD_NEW_BODY(MovingPieces); }
  vtkTypeMacro(MovingPieces, vtkUnstructuredGridAlgorithm);

  std::function<RankPart(double time)> PartAt; ///< the piece
  double Middle = 0;                           ///< of the hole, of edges of 1
  bool Flat = false;
  std::vector<double> Times = { 0, 1, 2, 3, 4 };
  double Degrees = 8;    ///< per unit of time
  bool Moves = true;     ///< or only its array does
  bool Numbered = false; ///< whether it has global ids
  double FailsAt = -1;   ///< the time at which it cannot be computed
  double BrokenAt = -1;  ///< the time at which coordinates are not finite
  int Executions = 0;

  /// Where a point is at a time.
  Vec3 placeOf(const Vec3& p, double time) const
  {
    const double angle = time * this->Degrees * Pi / 180;
    const double x = p[0] - this->Middle, y = p[1] - this->Middle;
    const double z = this->Flat ? 0.0 : p[2] - this->Middle;
    const double far = std::max({ std::abs(x), std::abs(y), std::abs(z) });
    if (far < 0.6) // the hole
    {
      return { this->Middle + std::cos(angle) * x - std::sin(angle) * y,
        this->Middle + std::sin(angle) * x + std::cos(angle) * y, p[2] };
    }
    return far < this->Middle - 0.3 ? p + Vec3{ 0.03 * time, 0, 0 } : p;
  }

protected:
  MovingPieces() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    using Pipeline = vtkStreamingDemandDrivenPipeline;
    vtkInformation* info = outputVector->GetInformationObject(0);
    if (!this->Times.empty())
    {
      const double range[2] = { this->Times.front(), this->Times.back() };
      info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
      info->Set(Pipeline::TIME_RANGE(), range, 2);
    }
    info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
    return 1;
  }

  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double asked = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    const double time = this->Times.empty()
      ? 0.0
      : *std::prev(std::upper_bound(this->Times.begin() + 1, this->Times.end(), asked));
    ++this->Executions;
    if (time == this->FailsAt)
    {
      vtkErrorMacro("The time step cannot be computed.");
      return 0;
    }
    const RankPart part = this->PartAt(time);
    auto grid = this->Numbered ? numberedGridOf(part) : gridOf(part);
    const auto moved = arrayOf("d", part.data.numberOfPoints(), 3,
      [&](Index i, int k)
      { return this->placeOf(part.data.point(i), time)[k] - part.data.point(i)[k]; });
    grid->GetPointData()->AddArray(moved);
    for (vtkIdType i = 0; this->Moves && i < grid->GetNumberOfPoints(); ++i)
    {
      const Vec3 p = this->placeOf(part.data.point(i), time);
      grid->GetPoints()->SetPoint(i, p.data());
    }
    if (time == this->BrokenAt)
    {
      grid->GetPoints()->GetData()->SetComponent(0, 1, std::nan(""));
    }
    vtkUnstructuredGrid::GetData(outputVector)->ShallowCopy(grid);
    return 1;
  }
};

/// The points of the whole mesh from the output of a process; HUGE_VAL where it has none.
inline std::vector<double> spreadOf(const MeshData& whole, const RankPart& part, vtkDataSet* output)
{
  std::vector<double> points(whole.points.size(), HUGE_VAL);
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfPoints(), part.data.numberOfPoints());
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    output->GetPoint(p, &points[3 * part.pointOf[p]]);
  }
  return points;
}
}
#endif
