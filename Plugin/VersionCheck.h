// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VersionCheck.h
 * @brief Compares the ParaView a plugin was built for with the one that loads it.
 *
 * A plugin shares the memory layout of ParaView's classes, and ParaView itself no longer rejects a
 * plugin of another build: such a plugin may load and crash later. The rule here is the one Debian
 * follows for plugins, the same major, minor and patch number.
 */

#ifndef tautline_VersionCheck_h
#define tautline_VersionCheck_h

#include <string>

namespace tautline
{

struct ParaViewVersion
{
  int major = 0;
  int minor = 0;
  int patch = 0;
  std::string vtk; ///< version of the VTK inside, "9.2.20230111"
};

/** The message to the user, with the remedy; empty when the two versions are compatible. */
std::string versionMismatch(const ParaViewVersion& built, const ParaViewVersion& running);

} // namespace tautline

#endif
