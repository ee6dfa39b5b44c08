// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StopWindow.h
 * @brief Detects clicks on a widget while the application processes no events.
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
 * @brief An invisible X window that covers a widget and receives its clicks.
 *
 * Qt detects clicks only when it processes events. Processing them during a run could reenter the
 * filter: timers open dialogs and update the pipeline within the update. This window has a separate
 * connection to the X server, on which a thread waits: a click executes no code of Qt or ParaView.
 *
 * Such a window exists only on X11 (on Linux, ParaView 5.11 runs on X11).
 */
class StopWindow
{
public:
  /// @param clicked called on another thread when the left button is pressed
  explicit StopWindow(std::function<void()> clicked);
  ~StopWindow();
  StopWindow(const StopWindow&) = delete;
  StopWindow& operator=(const StopWindow&) = delete;

  /// Whether the window system supports such windows.
  bool isAvailable() const;

  /// Covers a widget until uncover() is called, if the widget is visible.
  void cover(QWidget* widget);
  void uncover();

private:
  struct Connection;
  std::unique_ptr<Connection> Server;
};

} // namespace tautline

#endif
