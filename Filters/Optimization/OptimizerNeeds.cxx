// SPDX-License-Identifier: BSD-3-Clause
// Which settings of Optimize Mesh need the whole mesh in one place.
#include "OptimizerSetup.h"

#include "vtkDataSet.h"

#include <algorithm>
#include <cctype>

namespace tautline
{
namespace
{
/// Whether an array of the input is chosen; also one that is missing, which others report.
bool isChosen(const OptimizerSettings& settings, int index, vtkDataSet* input)
{
  try
  {
    return input && input->GetNumberOfPoints() > 0 &&
      chosenArray(settings.boundary.arrays, index, input, "");
  }
  catch (const Error&)
  {
    return true;
  }
}

/// Whether the objectives have targets of a reference mesh.
bool hasReference(const OptimizerSettings& settings)
{
  const auto& rows = settings.objectives;
  return settings.preset == Preset::PreserveShape ||
    (settings.preset == Preset::Custom &&
      std::any_of(rows.begin(), rows.end(),
        [](const ObjectiveRow& row) { return row.target == TargetType::Reference; }));
}

}

//------------------------------------------------------------------------------
bool choosesFeatures(const OptimizerSettings& settings, vtkDataSet* input)
{
  return isChosen(settings, KindArray, input) || isChosen(settings, RegionArray, input);
}

//------------------------------------------------------------------------------
NeedOfWholeMesh needOfWholeMesh(const OptimizerSettings& settings, bool features, bool animation)
{
  if (animation)
  {
    return { "iterations that are kept as time steps", "switch Animation off" };
  }
  if (settings.boundary.motion == BoundaryMotion::OnSurface || settings.boundary.geometry)
  {
    return { "points that slide on curved surfaces and geometries",
      "choose the Boundary Fixed, Slide on flat parts (sliding) or Free, without a Geometry" };
  }
  if (features)
  {
    return { "regions and feature kinds", "choose None for these arrays" };
  }
  if (hasReference(settings))
  {
    return { "targets of a reference mesh", "choose another preset or target" };
  }
  if (settings.boundary.freeInvalid)
  {
    return { "points of invalid elements that are freed", "switch Free Invalid Elements off" };
  }
  if (settings.boundary.showFeatures)
  {
    return { "features that are shown", "switch Show Features off" };
  }
  OptimizeOptions options = settings.options;
  options.objectives =
    settings.preset == Preset::Custom ? customObjectives(settings) : options.objectives;
  return needOfWholeMesh(options);
}

//------------------------------------------------------------------------------
void requireLocalSettings(const OptimizerSettings& settings, bool features, bool animation)
{
  NeedOfWholeMesh need = needOfWholeMesh(settings, features, animation);
  if (!need.what.empty())
  {
    need.what[0] = static_cast<char>(std::toupper(need.what[0]));
    throw Error(need.what +
      " need one process and its own order: gather the mesh, in ParaView by Aggregate Dataset, "
      "with Reproducible Order off; or " +
      need.remedy + ".");
  }
}
}
