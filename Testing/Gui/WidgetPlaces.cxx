// SPDX-License-Identifier: BSD-3-Clause
// Where a widget of the running program is on the screen, for pictures of sessions: screenshots.py
// loads this library into ParaView's Python shell. A widget is named by object names from outside
// to inside, separated by "/"; names between may be left out, so that the layout of a panel does
// not matter. A part of a widget is named by its text or object name.
#include "pqFlatTreeView.h"

#include <QAbstractItemView>
#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QScrollArea>
#include <QScrollBar>
#include <QTabBar>
#include <QToolBar>

#include <algorithm>

namespace
{

/// Has the widget the last name, and its ancestors the others in this order?
bool isNamed(const QWidget* widget, QStringList names)
{
  if (names.isEmpty() || widget->objectName() != names.takeLast())
  {
    return false;
  }
  for (const QObject* above = widget->parent(); above && !names.isEmpty(); above = above->parent())
  {
    if (above->objectName() == names.last())
    {
      names.removeLast();
    }
  }
  return names.isEmpty();
}

/// The visible widgets of this name.
QWidgetList findWidgets(const QString& path)
{
  const QStringList names = path.split('/');
  QWidgetList found = QApplication::allWidgets();
  found.erase(
    std::remove_if(found.begin(), found.end(),
      [&names](const QWidget* widget) { return !widget->isVisible() || !isNamed(widget, names); }),
    found.end());
  return found;
}

/// The one visible widget of this name, or null.
QWidget* findWidget(const QString& path)
{
  const QWidgetList found = findWidgets(path);
  return found.size() == 1 ? found.front() : nullptr;
}

QString plain(QString text)
{
  return text.remove('&').remove("...");
}

/// The first item with this text at any level below.
QModelIndex findBelow(
  const QAbstractItemModel* model, const QModelIndex& parent, const QString& text)
{
  for (int row = 0; row < model->rowCount(parent); ++row)
  {
    const QModelIndex item = model->index(row, 0, parent);
    const QModelIndex found = item.data().toString() == text ? item : findBelow(model, item, text);
    if (found.isValid())
    {
      return found;
    }
  }
  return {};
}

/// The item at the end of a path of texts, such as "ElementQuality1/Mesh"; "|1" at the end names
/// the column.
QModelIndex findItem(const QAbstractItemModel* model, const QString& path)
{
  const QStringList parts = path.split('|');
  QModelIndex item;
  const QStringList texts = parts[0].split('/');
  for (const QString& text : texts)
  {
    item = findBelow(model, item, text);
    if (!item.isValid())
    {
      return {};
    }
  }
  return parts.size() > 1 ? item.sibling(item.row(), parts[1].toInt()) : item;
}

/// In a menu or a tool bar: the action with this text or object name.
QAction* findAction(const QWidget* widget, const QString& name)
{
  const QList<QAction*> actions = widget->actions();
  const auto found = std::find_if(actions.begin(), actions.end(),
    [&name](const QAction* action)
    { return action->objectName() == name || plain(action->text()) == name; });
  return found == actions.end() ? nullptr : *found;
}

/// The rectangle of a part in its widget; an empty one if there is no such part.
QRect rectangleOf(QWidget* widget, const QString& part)
{
  if (part.isEmpty())
  {
    return widget->rect();
  }
  if (auto* tree = qobject_cast<pqFlatTreeView*>(widget)) // the pipeline browser
  {
    const QModelIndex item = findItem(tree->getModel(), part);
    tree->scrollTo(item);
    QRect area;
    tree->getVisibleRect(item, area);
    return area.translated(tree->viewport()->pos());
  }
  if (auto* view = qobject_cast<QAbstractItemView*>(widget))
  {
    const QModelIndex item = findItem(view->model(), part);
    view->scrollTo(item);
    return view->visualRect(item).translated(view->viewport()->pos());
  }
  if (auto* tabs = qobject_cast<QTabBar*>(widget))
  {
    for (int i = 0; i < tabs->count(); ++i)
    {
      if (plain(tabs->tabText(i)) == part)
      {
        return tabs->tabRect(i);
      }
    }
  }
  QAction* action = findAction(widget, part);
  if (!action)
  {
    return {};
  }
  if (auto* menu = qobject_cast<QMenu*>(widget))
  {
    return menu->actionGeometry(action);
  }
  if (auto* bar = qobject_cast<QMenuBar*>(widget))
  {
    return bar->actionGeometry(action);
  }
  auto* tools = qobject_cast<QToolBar*>(widget);
  const QWidget* button = tools ? tools->widgetForAction(action) : nullptr;
  return button ? button->geometry() : QRect();
}

void showInScrollArea(QWidget* widget)
{
  for (QWidget* above = widget->parentWidget(); above; above = above->parentWidget())
  {
    if (auto* area = qobject_cast<QScrollArea*>(above))
    {
      area->ensureWidgetVisible(widget);
    }
  }
  QApplication::processEvents();
}

/// Opens a menu at a corner of the item that leads to it.
void open(QMenu* menu, const QPoint& corner)
{
  menu->popup(corner);
  QApplication::processEvents();
}

} // anonymous namespace

/// Left, top, width and height on the screen. Returns the number of visible widgets with this name,
/// which should be 1, or -1 if the widget has no such part. Scroll areas scroll to the widget.
extern "C" Q_DECL_EXPORT int tautlineWidgetPlace(const char* name, const char* part, int* place)
{
  const QWidgetList found = findWidgets(QString::fromUtf8(name));
  if (found.size() != 1)
  {
    return static_cast<int>(found.size());
  }
  QWidget* widget = found.front();
  showInScrollArea(widget);
  const QRect rectangle = rectangleOf(widget, QString::fromUtf8(part));
  if (rectangle.isEmpty())
  {
    return -1;
  }
  const QPoint corner = widget->mapToGlobal(rectangle.topLeft());
  place[0] = corner.x();
  place[1] = corner.y();
  place[2] = rectangle.width();
  place[3] = rectangle.height();
  return 1;
}

/// Opens the menus along a path of texts, such as "Filters/Tautline"; an empty path closes them.
extern "C" Q_DECL_EXPORT int tautlineOpenMenu(const char* path)
{
  while (QWidget* opened = QApplication::activePopupWidget())
  {
    opened->close();
  }
  QApplication::processEvents();
  const QString texts = QString::fromUtf8(path);
  QWidget* level = findWidget("pqClientMainWindow/menubar");
  const QStringList steps = texts.isEmpty() ? QStringList() : texts.split('/');
  for (const QString& text : steps)
  {
    QAction* action = level ? findAction(level, text) : nullptr;
    if (!action || !action->menu())
    {
      return 0;
    }
    const bool inBar = qobject_cast<QMenuBar*>(level);
    const QRect item = rectangleOf(level, text);
    if (auto* menu = qobject_cast<QMenu*>(level))
    {
      menu->setActiveAction(action);
    }
    open(action->menu(), level->mapToGlobal(inBar ? item.bottomLeft() : item.topRight()));
    level = action->menu();
  }
  return level ? 1 : 0;
}

/// The size of the main window, whose corner moves to the screen's, the width of the dock with the
/// panels, and the height of the pipeline browser. The panel scrolls to its top.
extern "C" Q_DECL_EXPORT int tautlineResize(int width, int height, int dockWidth, int browserHeight)
{
  auto* window = qobject_cast<QMainWindow*>(findWidget("pqClientMainWindow"));
  auto* panel = window ? window->findChild<QDockWidget*>("propertiesDock") : nullptr;
  auto* browser = window ? window->findChild<QDockWidget*>("pipelineBrowserDock") : nullptr;
  if (!panel || !browser)
  {
    return 0;
  }
  window->move(0, 0);
  window->resize(width, height);
  QApplication::processEvents();
  window->resizeDocks({ panel }, { dockWidth }, Qt::Horizontal);
  window->resizeDocks({ browser }, { browserHeight }, Qt::Vertical);
  if (auto* area = panel->findChild<QScrollArea*>("scrollArea"))
  {
    area->verticalScrollBar()->setValue(0);
  }
  QApplication::processEvents();
  return 1;
}

/// Clears and hides the window with messages, which opens again when there is a new one.
extern "C" Q_DECL_EXPORT void tautlineHideMessages()
{
  const QWidgetList all = QApplication::allWidgets();
  for (QWidget* widget : all)
  {
    if (widget->inherits("pqOutputWidget"))
    {
      QMetaObject::invokeMethod(widget, "clear");
    }
    if (widget->objectName() == "outputWidgetDock")
    {
      widget->hide();
    }
  }
}

/// Lets Qt handle what is left to do.
extern "C" Q_DECL_EXPORT void tautlineHandleEvents()
{
  QApplication::processEvents();
}
