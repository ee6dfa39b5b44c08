// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoadingState.h
 * @brief Whether ParaView loads a state.
 */

#ifndef tautline_LoadingState_h
#define tautline_LoadingState_h

namespace tautline
{

/**
 * Whether ParaView loads a state file now, XML or Python. What is shown then has the colours, the
 * axes and the series of the state: those that the plugin gives to new displays are not for it.
 */
bool isLoadingState();

} // namespace tautline

#endif
