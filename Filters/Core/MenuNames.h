// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MenuNames.h
 * @brief The names of filters and sources in menus, for the progress text.
 */
#ifndef tautline_MenuNames_h
#define tautline_MenuNames_h

#include "TautlineCoreModule.h" // for export macro

namespace tautline
{
/// The name of a class in ParaView's menu: "Element Quality" of "vtkElementQuality"; null for a
/// class that is not in the menu. The labels of ServerManager are the same.
TAUTLINECORE_EXPORT const char* menuName(const char* className);
}
#endif
