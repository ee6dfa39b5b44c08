// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StopWindow.h
 * @brief Notices clicks on a widget while the application processes no events.
 */

#ifndef tautline_StopWindow_h
#define tautline_StopWindow_h

#include <functional>
#include <memory>

class QWidget;

namespace tautline
{

/**
 * @class tautline::StopWindow
 * @brief An invisible window of the X server over a widget, which takes the clicks on it.
 *
 * Without processing events Qt notices no click. With it, a run of a filter would be entered again:
 * timers open dialogs and update the pipeline within the update. This window belongs to a
 * connection of its own to the X server, on which a thread waits: nothing of Qt or ParaView is
 * executed because of a click.
 *
 * Window systems other than X11 have no such window (ParaView 5.11 runs on X11 on Linux).
 */
class StopWindow
{
public:
  /// @param clicked called on another thread when the left button is pressed
  explicit StopWindow(std::function<void()> clicked);
  ~StopWindow();
  StopWindow(const StopWindow&) = delete;
  StopWindow& operator=(const StopWindow&) = delete;

  /// Whether the window system has such windows.
  bool isAvailable() const;

  /// Covers a widget, if it is visible, until uncover().
  void cover(QWidget* widget);
  void uncover();

private:
  struct Connection;
  std::unique_ptr<Connection> Server;
};

} // namespace tautline

#endif
