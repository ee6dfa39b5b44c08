// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Startup.h
 * @brief Actions of the plugin when ParaView loads it in the GUI, in pvpython or on a server.
 */

#ifndef tautline_Startup_h
#define tautline_Startup_h

/** Warns if the plugin was built for a version of ParaView other than the running one. */
void tautlineCheckVersion();

/** Sets default color maps for arrays of Tautline's filters; the user's maps take precedence. */
void tautlineInstallColorMaps();

/** Registers the domain of the metric menus with ParaView. */
void tautlineRegisterDomains();

/** Enables the user to stop filters that keep their best result so far; see RunControl.h. */
void tautlineInstallRunControl();

#endif
