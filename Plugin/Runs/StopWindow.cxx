// SPDX-License-Identifier: BSD-3-Clause
#include "StopWindow.h"

#include <QGuiApplication>
#include <QWidget>

#include <xcb/xcb.h>

#include <cstdlib>
#include <cstring>
#include <thread>

namespace tautline
{

struct StopWindow::Connection
{
  xcb_connection_t* display = nullptr;
  /// Receives the message that ends the thread; always invisible.
  xcb_window_t hidden = XCB_WINDOW_NONE;
  xcb_window_t cover = XCB_WINDOW_NONE;
  std::thread waiter;
};

namespace
{
constexpr const char* Name = "Tautline Stop";

xcb_window_t inputWindow(
  xcb_connection_t* display, xcb_window_t parent, int x, int y, int width, int height)
{
  constexpr std::uint32_t events = XCB_EVENT_MASK_BUTTON_PRESS | XCB_EVENT_MASK_BUTTON_RELEASE;
  const xcb_window_t window = xcb_generate_id(display);
  xcb_create_window(display, XCB_COPY_FROM_PARENT, window, parent, static_cast<std::int16_t>(x),
    static_cast<std::int16_t>(y), static_cast<std::uint16_t>(width),
    static_cast<std::uint16_t>(height), 0, XCB_WINDOW_CLASS_INPUT_ONLY, XCB_COPY_FROM_PARENT,
    XCB_CW_EVENT_MASK, &events);
  return window;
}

/// Waits for events until the message arrives or the X server exits.
void wait(xcb_connection_t* display, const std::function<void()>& clicked)
{
  constexpr int sentMask = 0x80; // marks events sent by a client
  while (xcb_generic_event_t* event = xcb_wait_for_event(display))
  {
    const int type = event->response_type & ~sentMask;
    const bool left = type == XCB_BUTTON_PRESS &&
      reinterpret_cast<xcb_button_press_event_t*>(event)->detail == XCB_BUTTON_INDEX_1;
    std::free(event);
    if (left)
    {
      clicked();
    }
    if (type == XCB_CLIENT_MESSAGE)
    {
      return;
    }
  }
}
}

//------------------------------------------------------------------------------
StopWindow::StopWindow(std::function<void()> clicked)
  : Server(std::make_unique<Connection>())
{
  if (QGuiApplication::platformName() != "xcb")
  {
    return;
  }
  xcb_connection_t* display = xcb_connect(nullptr, nullptr);
  if (xcb_connection_has_error(display))
  {
    xcb_disconnect(display);
    return;
  }
  this->Server->display = display;
  const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(display)).data->root;
  this->Server->hidden = inputWindow(display, root, 0, 0, 1, 1);
  xcb_flush(display);
  this->Server->waiter = std::thread([display, clicked] { wait(display, clicked); });
}

//------------------------------------------------------------------------------
StopWindow::~StopWindow()
{
  if (!this->Server->display)
  {
    return;
  }
  xcb_client_message_event_t message;
  std::memset(&message, 0, sizeof(message));
  message.response_type = XCB_CLIENT_MESSAGE;
  message.format = 32;
  message.window = this->Server->hidden;
  message.type = XCB_ATOM_NOTICE;
  xcb_send_event(this->Server->display, false, this->Server->hidden, XCB_EVENT_MASK_NO_EVENT,
    reinterpret_cast<const char*>(&message));
  xcb_flush(this->Server->display);
  this->Server->waiter.join();
  xcb_disconnect(this->Server->display);
}

//------------------------------------------------------------------------------
bool StopWindow::isAvailable() const
{
  return this->Server->display != nullptr;
}

//------------------------------------------------------------------------------
void StopWindow::cover(QWidget* widget)
{
  this->uncover();
  QWidget* window = widget->window();
  if (!this->isAvailable() || widget->visibleRegion().isEmpty())
  {
    return;
  }
  const double scale = widget->devicePixelRatioF();
  const QPoint corner = widget->mapTo(window, QPoint()) * scale;
  const QSize size = widget->size() * scale;
  xcb_connection_t* display = this->Server->display;
  const xcb_window_t cover = inputWindow(display, static_cast<xcb_window_t>(window->winId()),
    corner.x(), corner.y(), size.width(), size.height());
  xcb_change_property(display, XCB_PROP_MODE_REPLACE, cover, XCB_ATOM_WM_NAME, XCB_ATOM_STRING, 8,
    static_cast<std::uint32_t>(std::strlen(Name)), Name);
  xcb_map_window(display, cover);
  xcb_flush(display);
  this->Server->cover = cover;
}

//------------------------------------------------------------------------------
void StopWindow::uncover()
{
  if (this->Server->cover != XCB_WINDOW_NONE)
  {
    xcb_destroy_window(this->Server->display, this->Server->cover);
    xcb_flush(this->Server->display);
    this->Server->cover = XCB_WINDOW_NONE;
  }
}

} // namespace tautline
