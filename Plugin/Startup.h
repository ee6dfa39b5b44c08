// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Startup.h
 * @brief What the plugin does when ParaView loads it, in the GUI, in pvpython and on a server
 * alike.
 */

#ifndef tautline_Startup_h
#define tautline_Startup_h

/** Warns when the running ParaView is not the one the plugin was built for. */
void tautlineCheckVersion();

/** Gives the arrays of Tautline's filters default colour maps; the user's own take precedence. */
void tautlineInstallColorMaps();

/** Lets ParaView create the domain of the menus of metrics. */
void tautlineRegisterDomains();

/** Lets the user stop a run of a filter that keeps its best result so far; see RunControl.h. */
void tautlineInstallRunControl();

#endif
