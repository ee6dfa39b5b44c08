// SPDX-License-Identifier: BSD-3-Clause
// Two thousand random meshes of all cell types, valid and tangled, with every preset and boundary:
// neither the number of invalid elements, nor the worst element, nor the objective gets worse.
#include "NeverWorse.h"
#include "Registry.h"
#include "tautline/Mesh/BoundaryShape.h"

using namespace tautline;

namespace
{
enum class Motion
{
  Fixed,
  Sliding,
  OnSurface,
  Free
};
constexpr int motions = 4;
constexpr int presets = 7;
constexpr int meshes = 2000; // a fifth of them in the fast run; 5 divides no number of choices
constexpr int stride = 5;

struct Totals
{
  int valid = 0, tangled = 0, rejected = 0, better = 0, restored = 0;
};

//------------------------------------------------------------------------------
void testOne(int number, Totals& totals)
{
  const auto preset = static_cast<Preset>(1 + number / 6 % presets);
  // The interpolation metric is one of simplices.
  const CellType simplex = number % 2 == 0 ? CellType::Triangle : CellType::Tetrahedron;
  const CellType type = preset == Preset::LowInterpolationError ? simplex : allTypes[number % 6];
  const bool flat = topology(type).dimension == 2;
  const auto motion = static_cast<Motion>(number / (6 * presets) % motions);
  const bool surface = flat && number / (6 * presets * motions) % 3 == 2;
  const double amplitude = 0.1 + 0.08 * (number % 11);
  const std::string label = "mesh " + std::to_string(number) + ", preset " +
    std::to_string(static_cast<int>(preset)) + ", boundary " +
    std::to_string(static_cast<int>(motion)) + (surface ? ", surface, " : ", ") +
    topology(type).plural;
  const Context context(label);
  const MeshData data = randomMesh(type, surface, amplitude, 1000U + static_cast<unsigned>(number));
  const Mesh mesh(data.view());
  const auto points = static_cast<std::size_t>(data.numberOfPoints());

  OptimizeOptions options;
  applyPreset(preset, options);
  options.stopping.maximumIterations = 12;
  Targets targets;
  if (preset == Preset::PreserveShape)
  {
    const MeshData reference = randomMesh(type, surface, 0, static_cast<unsigned>(number));
    targets = referenceTargets(mesh, Mesh(reference.view()));
    options.objectives[0].evaluation.targets = &targets;
  }
  std::vector<unsigned char> fixed(points, 0);
  BoundaryShape shape;
  if (motion == Motion::Sliding || motion == Motion::OnSurface)
  {
    shape = boundaryShape(mesh, 1.0, motion == Motion::OnSurface ? 30.0 : 0.0);
    fixed = shape.fixed;
    TAUTLINE_SET(options, slidePlanes = shape.planes.data(), slideLines = shape.lines.data(),
      slideSurface = shape.onSurface > 0 && !surface ? shape.surface.data() : nullptr);
  }
  options.fixed = motion == Motion::Fixed ? nullptr : fixed.data();

  const Index before = invalid(data, data.points);
  OptimizeResult result;
  try
  {
    result = optimize(mesh, options);
  }
  catch (const Error& error)
  {
    std::printf("%s: %s\n", label.c_str(), error.what());
    // Presets that depend on size would shrink a mesh whose boundary moves freely.
    const bool sized = preset == Preset::UniformSize || preset == Preset::LowInterpolationError;
    TAUTLINE_CHECK(sized && motion != Motion::Fixed);
    TAUTLINE_CHECK(contains(error.what(), "shrink"));
    ++totals.rejected;
    return;
  }
  const Index after = invalid(data, result.points);
  TAUTLINE_CHECK_EQUAL(result.invertedBefore, before);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, after);
  TAUTLINE_CHECK(after <= before);
  totals.restored += result.restored > 0;
  if (before > 0)
  {
    ++totals.tangled;
    return;
  }
  ++totals.valid;
  MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
  const Mesh now(moved.view());
  constexpr double rounding = 1e-8;
  const double worst = worstOf(mesh, options, type);
  TAUTLINE_CHECK(worstOf(now, options, type) <= worst + rounding * std::abs(worst));
  const Targets* of = preset == Preset::PreserveShape ? &targets : nullptr;
  const double first = objectiveOf(preset, mesh, of), last = objectiveOf(preset, now, of);
  TAUTLINE_CHECK(last <= first * (1 + rounding));
  totals.better += last < 0.999 * first;
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestNeverWorse)
{
  Totals totals;
  const int step = slowParts() ? 1 : stride, count = meshes / step;
  for (int i = 0; i < meshes; i += step)
  {
    testOne(i, totals);
  }
  std::printf(
    "%d valid meshes, %d of them better; %d tangled; %d rejected; points restored in %d\n",
    totals.valid, totals.better, totals.tangled, totals.rejected, totals.restored);
  TAUTLINE_CHECK(totals.valid > count / 4);
  TAUTLINE_CHECK(totals.tangled > count / 4);
  TAUTLINE_CHECK(totals.better > 3 * totals.valid / 4);
  TAUTLINE_CHECK(totals.rejected < count / 5);
}
