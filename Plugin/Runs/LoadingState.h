// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoadingState.h
 * @brief Checks whether ParaView is loading a state.
 */

#ifndef tautline_LoadingState_h
#define tautline_LoadingState_h

namespace tautline
{

/**
 * Whether ParaView is loading a state file, XML or Python. Its displays keep the colors, axes and
 * series of the state: the plugin's defaults for new displays do not apply.
 */
bool isLoadingState();

} // namespace tautline

#endif
