// SPDX-License-Identifier: BSD-3-Clause
#include "PanelWidth.h"

#include <QDockWidget>
#include <QMainWindow>
#include <QScrollArea>
#include <QScrollBar>
#include <QVariant>

#include <algorithm>

namespace tautline
{
namespace
{

/// Property of the dock: the width of the content that it was last widened for.
constexpr const char* Fitted = "TautlineFittedWidth";

template <class Ancestor>
Ancestor* ancestorOf(QWidget* widget)
{
  while (widget && !qobject_cast<Ancestor*>(widget))
  {
    widget = widget->parentWidget();
  }
  return qobject_cast<Ancestor*>(widget);
}

} // anonymous namespace

//------------------------------------------------------------------------------
QScrollBar* horizontalScrollBar(QWidget* widget)
{
  auto* area = ancestorOf<QScrollArea>(widget);
  return area ? area->horizontalScrollBar() : nullptr;
}

//------------------------------------------------------------------------------
void fitDock(QWidget* widget)
{
  auto* area = ancestorOf<QScrollArea>(widget);
  auto* dock = ancestorOf<QDockWidget>(area);
  auto* window = ancestorOf<QMainWindow>(dock);
  if (!window || dock->isFloating() || !area->isVisible() || !area->widget())
  {
    return;
  }
  const int needed = area->widget()->minimumSizeHint().width();
  // The vertical scroll bar may appear later.
  const int frame = 2 * area->frameWidth() + area->verticalScrollBar()->sizeHint().width();
  const int missing = needed - (area->width() - frame);
  const int widest = window->width() / 2;
  if (needed <= dock->property(Fitted).toInt())
  {
    return;
  }
  dock->setProperty(Fitted, needed);
  if (missing > 0 && dock->width() < widest)
  {
    window->resizeDocks({ dock }, { std::min(dock->width() + missing, widest) }, Qt::Horizontal);
  }
}

} // namespace tautline
