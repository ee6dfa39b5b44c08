// SPDX-License-Identifier: BSD-3-Clause
#include "VersionCheck.h"

#include <tuple>

namespace tautline
{
namespace
{

std::string text(const ParaViewVersion& version)
{
  return "ParaView " + std::to_string(version.major) + "." + std::to_string(version.minor) + "." +
    std::to_string(version.patch) + " (VTK " + version.vtk + ")";
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::string versionMismatch(const ParaViewVersion& built, const ParaViewVersion& running)
{
  if (std::tie(built.major, built.minor, built.patch, built.vtk) ==
    std::tie(running.major, running.minor, running.patch, running.vtk))
  {
    return {};
  }
  return "The Tautline plugin was built for " + text(built) + " but runs in " + text(running) +
    ". It may crash or give wrong results: build it again with the development files of this "
    "ParaView.";
}

} // namespace tautline
