// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineNavigator.h"

#include "ProxyKind.h"
#include "WorstOverTime.h"
#include "pqTautlineElementTable.h"
#include "pqTautlineRunDock.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include <QAction>
#include <QComboBox>
#include <QKeySequence>
#include <QLabel>
#include <QMainWindow>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QTimer>

#include <algorithm>

namespace
{
constexpr int DefaultLayers = 1, MostLayers = 9;
}

//------------------------------------------------------------------------------
pqTautlineNavigator::pqTautlineNavigator(QWidget* parentObject)
  : Superclass("Tautline Worst Elements", parentObject)
  , Measure(new QComboBox(this))
  , Layers(new QSpinBox(this))
  , Element(new QLabel(this))
  , Table(new pqTautlineElementTable(parentObject))
{
  this->setObjectName("TautlineNavigator");
  this->Measure->setObjectName("Measure");
  this->Measure->setToolTip("The measure that ranks the worst elements.");
  constexpr int fewestLetters = 11;
  this->Measure->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  this->Measure->setMinimumContentsLength(fewestLetters);
  this->Element->setObjectName("Element");
  this->Layers->setObjectName("Layers");
  this->Layers->setToolTip("Layers of neighbors that Isolate shows around the element.");
  this->Layers->setRange(0, MostLayers);
  this->Layers->setValue(DefaultLayers);
  const auto add = [this](const char* name, const char* icon, const char* key, const char* tip)
  {
    QAction* action = this->addAction(QIcon(QString(":/Tautline/Icons/") + icon + ".svg"), name);
    action->setObjectName(name);
    // ParaView and its menus use few keys with both.
    action->setShortcut(QKeySequence(QString("Alt+Shift+") + key));
    action->setToolTip(QString("%1 (%2)").arg(tip, action->shortcut().toString()));
    return action;
  };
  this->addWidget(this->Measure);
  this->Previous =
    add("Previous", "previous", "P", "Select the previous one of the worst elements.");
  this->Next = add("Next", "next", "N", "Select the next one of the worst elements.");
  this->Zoom = add("Zoom", "zoom", "Z", "Move the camera to the selected element.");
  this->Isolate = add("Isolate", "isolate", "I", "Fade the mesh to show an element inside it.");
  this->addWidget(this->Layers);
  QAction* table = add(
    "Table", "table", "T", "Show the worst elements as a table with the values of all metrics.");
  table->setCheckable(true);
  QAction* shown = this->Table->toggleViewAction();
  QObject::connect(table, &QAction::toggled, this->Table, &QWidget::setVisible);
  QObject::connect(shown, &QAction::toggled, table, &QAction::setChecked);
  this->OverTime = add("OverTime", "time", "O", "Plot the worst value of all elements over time.");
  this->addWidget(this->Element);
  this->Zoom->setCheckable(true);
  this->Zoom->setChecked(true);
  this->Isolate->setCheckable(true);

  QObject::connect(this->Previous, &QAction::triggered, this, &pqTautlineNavigator::previous);
  QObject::connect(this->Next, &QAction::triggered, this, &pqTautlineNavigator::next);
  QObject::connect(this->Zoom, &QAction::toggled, this, &pqTautlineNavigator::zoom);
  QObject::connect(this->Isolate, &QAction::toggled, this, &pqTautlineNavigator::isolate);
  QObject::connect(this->Table, &pqTautlineElementTable::chosen, this, &pqTautlineNavigator::go);
  QObject::connect(
    this->Table, &pqTautlineElementTable::shown, this, &pqTautlineNavigator::fillTable);
  QObject::connect(this->OverTime, &QAction::triggered, this, &pqTautlineNavigator::plotOverTime);
  QObject::connect(this->Layers, QOverload<int>::of(&QSpinBox::valueChanged), this,
    [this]
    {
      if (this->Isolated.active())
      {
        this->go(std::max(0, this->Current));
      }
    });
  QObject::connect(this->Measure, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
    &pqTautlineNavigator::listChanged);
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::sourceChanged, this,
    &pqTautlineNavigator::sourceChanged);
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this, &pqTautlineNavigator::dataUpdated);
  this->sourceChanged(pqActiveObjects::instance().activeSource());

  QTimer::singleShot(0, this,
    [this]
    {
      if (auto* window = qobject_cast<QMainWindow*>(this->parentWidget()))
      {
        window->insertToolBarBreak(this);
        window->addDockWidget(Qt::BottomDockWidgetArea, this->Table);
        this->Table->hide();
      }
    });
}

//------------------------------------------------------------------------------
pqTautlineNavigator::~pqTautlineNavigator() = default;

//------------------------------------------------------------------------------
void pqTautlineNavigator::sourceChanged(pqPipelineSource* source)
{
  if (source == this->Source && source)
  {
    return;
  }
  this->Isolate->setChecked(false);
  if (this->Source)
  {
    QObject::disconnect(this->Source, nullptr, this, nullptr);
  }
  this->Source = source;
  if (source)
  {
    // A warning opens a window during the update: the state changes after the data.
    QObject::connect(
      source, &pqProxy::modifiedStateChanged, this, [this] { this->dataUpdated(this->Source); });
  }
  // A filter being created has the same state as an applied one; fetching would execute it.
  this->Lists.clear();
  this->Measure->clear();
  this->listChanged();
  QTimer::singleShot(0, this, &pqTautlineNavigator::refresh);
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::dataUpdated(pqPipelineSource* source)
{
  if (source == this->Source)
  {
    // After the update, because fetching also updates a pipeline.
    QTimer::singleShot(0, this, &pqTautlineNavigator::refresh);
  }
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::refresh()
{
  this->Lists.clear();
  const pqScopedUndoExclude notUndone;
  if (this->Source && tautline::isTautline(this->Source->getProxy()))
  {
    this->Lists = tautline::worstElementsOf(this->Source);
  }
  {
    const QSignalBlocker blocker(this->Measure);
    const QString before = this->Measure->currentText();
    this->Measure->clear();
    for (const tautline::WorstElementList& list : this->Lists)
    {
      this->Measure->addItem(QString::fromStdString(list.label));
    }
    this->Measure->setCurrentIndex(std::max(0, this->Measure->findText(before)));
  }
  this->listChanged();
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::listChanged()
{
  this->Current = -1;
  const bool some = this->list() &&
    (!this->list()->elements.empty() || this->list()->ranking != tautline::Ranking::Complete);
  for (QAction* action : { this->Previous, this->Next, this->Isolate })
  {
    action->setEnabled(some);
  }
  this->Measure->setEnabled(this->Lists.size() > 1);
  this->OverTime->setEnabled(
    this->list() && tautline::hasTimeSteps(this->Source->getOutputPort(0)));
  this->describe();
  if (this->Table->isVisible())
  {
    this->fillTable();
  }
  if (this->Isolated.active())
  {
    some ? this->isolate(true) : this->Isolate->setChecked(false);
  }
}

//------------------------------------------------------------------------------
const tautline::WorstElementList* pqTautlineNavigator::list() const
{
  const int index = this->Measure->currentIndex();
  return index >= 0 && index < static_cast<int>(this->Lists.size()) ? &this->Lists[index] : nullptr;
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::complete()
{
  const int index = this->Measure->currentIndex();
  if (this->Source && this->list())
  {
    tautline::completeList(this->Source, this->Lists[static_cast<std::size_t>(index)]);
  }
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::fillTable()
{
  QTimer::singleShot(0, this, &pqTautlineNavigator::placeTable);
  this->complete();
  this->describe();
  this->Table->fill(this->Source ? this->Source->getOutputPort(0) : nullptr, this->list());
  this->Table->mark(this->Current);
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::placeTable()
{
  auto* window = qobject_cast<QMainWindow*>(this->parentWidget());
  auto* run = window ? window->findChild<pqTautlineRunDock*>() : nullptr;
  if (!run || this->Table->isHidden() || this->Table->isFloating())
  {
    return;
  }
  // In the area of the run dock: two docks side by side are too narrow on small screens.
  const bool beside = !window->tabifiedDockWidgets(run).contains(this->Table);
  if (beside && !run->isHidden() && !run->isFloating() &&
    window->dockWidgetArea(run) == window->dockWidgetArea(this->Table))
  {
    window->tabifyDockWidget(run, this->Table);
    this->Table->raise();
  }
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::go(int element)
{
  this->complete();
  const tautline::WorstElementList* list = this->list();
  if (!this->Source || !list || list->elements.empty())
  {
    this->describe();
    return;
  }
  const int number = static_cast<int>(list->elements.size());
  this->Current = (element + number) % number;
  pqOutputPort* mesh = this->Source->getOutputPort(0);
  const std::string problem =
    tautline::selectElements(mesh, { list->elements[this->Current].name });
  if (problem.empty())
  {
    this->Isolated.show({ list->elements[this->Current].name }, this->Layers->value());
    this->zoom(this->Zoom->isChecked());
  }
  this->Table->mark(this->Current);
  this->describe(problem);
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::describe(const std::string& problem)
{
  const tautline::WorstElementList* list = this->list();
  QString text;
  if (!problem.empty())
  {
    text = QString::fromStdString(problem);
  }
  else if (!list)
  {
    text = "No list of elements: apply Element Quality.";
  }
  else if (this->Current < 0)
  {
    text = list->ranking != tautline::Ranking::Complete ? QString("not searched yet: click Next")
      : list->elements.empty()                          ? QString("no element")
                               : QString("%1 elements").arg(list->elements.size());
  }
  else
  {
    const tautline::WorstElementEntry& entry = list->elements[this->Current];
    text = QString("%1 of %2: cell %3")
             .arg(this->Current + 1)
             .arg(list->elements.size())
             .arg(entry.name.cell);
    text += entry.name.block < 0 ? QString() : QString(" of block %1").arg(entry.name.block);
    text += ", " + QString::fromStdString(entry.text);
  }
  // Shortened to the available width: the toolbar shares a row.
  this->Element->setToolTip(text);
  this->Element->setText(text);
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::zoom(bool on)
{
  if (on && this->Isolated.active())
  {
    this->Isolated.zoom();
  }
  else if (on && this->Source && this->Current >= 0)
  {
    tautline::zoomToSelected(this->Source->getOutputPort(0));
  }
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::plotOverTime()
{
  if (const tautline::WorstElementList* list = this->list())
  {
    // A copy: the filter that is added becomes the active one.
    const std::string array = list->array;
    const bool largest = list->largestIsWorst();
    const std::string problem =
      tautline::plotWorstOverTime(this->Source->getOutputPort(0), array, largest);
    if (!problem.empty())
    {
      this->describe(problem);
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineNavigator::isolate(bool on)
{
  this->Isolated.end();
  if (!on || !this->Source)
  {
    return;
  }
  const tautline::WorstElementList* list = this->list();
  const std::string problem =
    this->Isolated.begin(this->Source->getOutputPort(0), list ? list->array : std::string());
  if (!problem.empty())
  {
    this->describe(problem);
    return;
  }
  this->go(std::max(0, this->Current));
}
