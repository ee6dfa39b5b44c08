// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QtCompatibility.h
 * @brief Differences between Qt 5 and Qt 6, in one place.
 */
#ifndef tautline_QtCompatibility_h
#define tautline_QtCompatibility_h

#include <QtGlobal>

#if QT_VERSION >= QT_VERSION_CHECK(6, 2, 0)
#include <QGuiApplication>
#else
#include <QX11Info>
#endif

struct xcb_connection_t;

namespace tautline
{
/// Qt's connection to the X server; null on other window systems.
inline xcb_connection_t* xcbConnection()
{
#if QT_VERSION >= QT_VERSION_CHECK(6, 2, 0)
  const auto* x11 = qGuiApp->nativeInterface<QNativeInterface::QX11Application>();
  return x11 ? x11->connection() : nullptr;
#else
  return QX11Info::connection();
#endif
}
} // namespace tautline

#endif
