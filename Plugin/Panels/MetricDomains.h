// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * @brief Properties for metrics get the domain that also has the metrics registered at run time.
 *
 * A client that was started with --url and --plugins connects before it loads its plugins, and
 * makes the proxies of its menus from the XML that the server sends: there, ParaView has none of
 * Tautline's classes yet. So the XML has ParaView's EnumerationDomain, and the definitions are
 * changed in the client when the plugin is loaded, and when definitions or connections are added.
 *
 * @sa vtkSMTautlineMetricsDomain
 */

#ifndef MetricDomains_h
#define MetricDomains_h

class vtkSMSession;

namespace tautline
{
/// Changes the definitions of a session, now and when others arrive. Null is no session.
void watchMetricDomains(vtkSMSession* session);
}

#endif
