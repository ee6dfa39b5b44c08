/**
 * @file ProxyKind.h
 * @brief Whether a proxy is one of Tautline's.
 */

#ifndef tautline_ProxyKind_h
#define tautline_ProxyKind_h

class vtkSMProxy;

namespace tautline
{

/// Whether the proxy is a filter or source of the menu Tautline. False for null.
bool isTautline(vtkSMProxy* proxy);

} // namespace tautline

#endif
