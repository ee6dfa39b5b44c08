// SPDX-License-Identifier: BSD-3-Clause
#include "WarpSteps.h"

#include "WarpStep.h"

namespace tautline
{
namespace
{
/// Elements with a larger inverse mean ratio relative to the mesh at rest have collapsed: the next
/// step would start from a practically invalid mesh.
constexpr double Collapsed = 1e3;

/// A mesh with the points at the start of a step.
class MovedMesh
{
public:
  MovedMesh(const Mesh& initial, const std::vector<double>& points, int threads)
    : Points(points)
    , View(initial.view())
  {
    this->View.points = this->Points.data();
    this->Moved = std::make_unique<Mesh>(this->View, threads);
    this->Moved->setMirrored(initial.mirrored());
    this->Moved->setSpace(initial.space()); // a surface may become planar
  }
  const Mesh& mesh() const { return *this->Moved; }

private:
  std::vector<double> Points;
  MeshView View;
  std::unique_ptr<Mesh> Moved;
};
}

//------------------------------------------------------------------------------
void warpInSteps(const Mesh& mesh, const WarpParts& parts, const WarpMotion& motion, int steps,
  bool following, WarpControl& control)
{
  const WarpOptions& options = control.options();
  WarpResult& result = control.result();
  const std::size_t size = 3 * static_cast<std::size_t>(mesh.view().numberOfPoints);
  const bool automatic = steps == 0;
  constexpr double growth = 2.0, shortest = 1e-4, firstShort = 0.125; // of the motion
  const bool shortFirst = following || result.still;

  std::vector<double> points(mesh.view().points, mesh.view().points + size);
  result.points = points;
  result.amount = 0;
  auto from = std::make_unique<MovedMesh>(mesh, points, options.threads);
  double amount = 0, step = !automatic ? 1.0 / steps : shortFirst ? firstShort : 1.0;
  int done = 0;
  while (amount < 1.0)
  {
    // The last step ends exactly at 1.
    const bool last = automatic ? amount + step >= 1.0 : done + 1 == steps;
    const double next = last ? 1.0 : amount + step;
    if (!control.proceed(amount))
    {
      break;
    }
    // The displacement of this step starts at the current points, so that errors do not accumulate.
    std::vector<double> displacement(size, 0.0), to;
    motion(next, displacement.data());
    for (std::size_t i = 0; i < size; ++i)
    {
      if (parts.prescribed()[i / 3])
      {
        displacement[i] += mesh.view().points[i] - points[i];
      }
    }
    control.setRange(amount, next);
    WarpStep one(from->mesh(), mesh, parts);
    one.setFollowing(following);
    const Index inverted = one.run(displacement.data(), next, control, to);
    control.setRange(0.0, 1.0);
    const bool good =
      !automatic || (inverted == 0 && (following || result.history.back().worstRatio <= Collapsed));
    if (good && !control.stopped())
    {
      // The prescribed points get their exact positions.
      motion(next, displacement.data());
      for (std::size_t i = 0; i < size; ++i)
      {
        points[i] = parts.prescribed()[i / 3] ? mesh.view().points[i] + displacement[i] : to[i];
      }
      result.points = points;
      result.amount = amount = next;
      from = std::make_unique<MovedMesh>(mesh, points, options.threads);
      ++done;
      step = automatic ? growth * step : step;
    }
    else
    {
      step = 0.5 * (next - amount);
    }
    if (control.stopped() || step < shortest)
    {
      break;
    }
    if (automatic && done >= options.maximumSteps && amount < 1.0)
    {
      control.addMessage("The limit on the number of steps was reached.");
      break;
    }
  }
  if (result.amount < 1.0)
  {
    result.invertedWarp = result.invertedAfter =
      qualityOf(mesh, result.points.data(), options.threads, parts.ranks()).inverted;
    control.addMessage("The mesh could follow only a part of the motion, " +
      std::to_string(result.amount) + " of it, without inverted or collapsed elements.");
  }
}
}
