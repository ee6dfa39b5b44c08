// SPDX-License-Identifier: BSD-3-Clause
// Which settings of Optimize Mesh need the whole mesh in one place.
#include "OptimizerSetup.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Whether the objectives have targets from a reference mesh.
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
NeedOfWholeMesh needOfWholeMesh(const OptimizerSettings& settings, bool features, bool animation)
{
  if (animation)
  {
    return { "iterations that are kept as time steps", "switch Animation off" };
  }
  const NeedOfWholeMesh need = needOfWholeMesh(settings.boundary, features);
  if (!need.what.empty())
  {
    return need;
  }
  if (hasReference(settings))
  {
    return { "targets of a reference mesh", "choose another preset or target" };
  }
  OptimizeOptions options = settings.options;
  options.objectives =
    settings.preset == Preset::Custom ? customObjectives(settings) : options.objectives;
  return needOfWholeMesh(options);
}
}
