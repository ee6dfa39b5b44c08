// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VersionCheck.h
 * @brief Compares the ParaView version a plugin was built for with the version that loads it.
 *
 * A plugin shares the memory layout of ParaView's classes, and ParaView no longer rejects plugins
 * from another build: such a plugin may load and crash later. As in Debian's rule for plugins, the
 * major, minor and patch numbers must match.
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
  std::string vtk; ///< version of ParaView's VTK, "9.2.20230111"
};

/** The message to the user, with a fix; empty if the two versions are compatible. */
std::string versionMismatch(const ParaViewVersion& built, const ParaViewVersion& running);

} // namespace tautline

#endif
