// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineRunDock.h"

#include "FetchOutput.h"
#include "ProxyKind.h"
#include "QtCompatibility.h"
#include "RunControl.h"
#include "RunPlot.h"
#include "StopWindow.h"

#include "tautline/Quality/Metrics.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"

#include "vtkAbstractArray.h"
#include "vtkPVProxyDefinitionIterator.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyDefinitionManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QProgressBar>
#include <QRegularExpression>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cstring>

#include <xcb/xcb.h>

namespace
{
constexpr const char* StopTip = "End the run with the best mesh so far.";
constexpr const char* Stopped = ": stopped";
constexpr const char* IdleTip = "No Tautline filter is running.";

bool isIterative(const QString& filter)
{
  return std::any_of(std::begin(tautline::DrawnInDock), std::end(tautline::DrawnInDock),
    [&filter](const auto& drawn) { return filter == drawn[1]; });
}

/**
 * The column of the table History for the left axis (0) or the right axis (1): the objective, and
 * the worst element or the number of inverted elements. For Improve Mesh, a count and the worst
 * element.
 */
vtkIdType columnOf(vtkTable* table, int axis)
{
  static const QRegularExpression left("^(Objective|N below target)$"),
    right("( worst|^Worst .*|^Inverted)$");
  for (vtkIdType column = 0; column < table->GetNumberOfColumns(); ++column)
  {
    if ((axis == 0 ? left : right).match(table->GetColumnName(column)).hasMatch())
    {
      return column;
    }
  }
  return -1;
}

/// Whether the worst value of several blocks is the smallest one.
bool isLargerBetter(const QString& column)
{
  const QString metric = QString(column).remove(QRegularExpression("( worst$|^Worst )"));
  const tautline::MetricInfo* info = tautline::findMetric(metric.toStdString());
  return info && info->direction == tautline::Direction::LargerIsBetter;
}

/**
 * The values of a column by iteration. The rows of several blocks follow each other: their worst
 * value is taken, or their sum for counts and objectives. A block that ended earlier keeps its last
 * value.
 */
std::vector<double> valuesOf(vtkTable* table, vtkIdType column)
{
  vtkAbstractArray* names = table->GetColumnByName("Block");
  std::vector<std::vector<double>> blocks;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const bool same =
      row > 0 && (!names || names->GetVariantValue(row) == names->GetVariantValue(row - 1));
    if (!same)
    {
      blocks.emplace_back();
    }
    blocks.back().push_back(table->GetValue(row, column).ToDouble());
  }
  std::size_t iterations = 0;
  for (const std::vector<double>& block : blocks)
  {
    iterations = std::max(iterations, block.size());
  }
  const QString name = table->GetColumnName(column);
  const bool worst = name.contains("worst", Qt::CaseInsensitive);
  const bool smallest = worst && isLargerBetter(name);
  std::vector<double> values;
  for (std::size_t i = 0; i < iterations; ++i)
  {
    double value = blocks[0][std::min(i, blocks[0].size() - 1)];
    for (std::size_t b = 1; b < blocks.size(); ++b)
    {
      const double other = blocks[b][std::min(i, blocks[b].size() - 1)];
      value = smallest ? std::min(value, other) : worst ? std::max(value, other) : value + other;
    }
    values.push_back(value);
  }
  return values;
}

/// The value of a string property; empty if there is none.
QString textOf(vtkSMProxy* proxy, const char* property)
{
  vtkSMProperty* found = proxy->GetProperty(property);
  if (!found)
  {
    return {};
  }
  proxy->UpdatePropertyInformation(found);
  return QString::fromUtf8(vtkSMPropertyHelper(found).GetAsString());
}

/// The outcome of the last run of a filter, from its summary.
QString endOf(vtkSMProxy* filter)
{
  const QString summary = textOf(filter, "Summary"), reason = textOf(filter, "Reason");
  return filter->GetProperty("Summary") && summary.isEmpty() ? ": failed, see Output Messages"
    : reason.startsWith("Stopped")                           ? Stopped
    : reason.contains("limit")                               ? ": ended at its limit"
    : summary.startsWith("Warning: ")                        ? ": finished with a warning"
                                                             : ": finished";
}

/// Shows the drawing, although no event is processed.
void flush()
{
  if (xcb_connection_t* display = tautline::xcbConnection())
  {
    xcb_flush(display);
  }
}
}

//------------------------------------------------------------------------------
pqTautlineRunDock::pqTautlineRunDock(QWidget* parentObject)
  : Superclass("Tautline Run", parentObject)
  , Content(new QWidget(this))
  , Filter(new QLabel(this->Content))
  , Values(new QLabel(this->Content))
  , Bar(new QProgressBar(this->Content))
  , Stop(new QToolButton(this->Content))
  , Plot(new tautline::RunPlot(this->Content))
  , Cover(std::make_unique<tautline::StopWindow>([] { tautline::requestStop(true); }))
{
  this->Content->setObjectName("Content");
  this->Filter->setObjectName("Filter");
  this->Values->setObjectName("Values");
  this->Bar->setObjectName("Progress");
  this->Stop->setObjectName("Stop");
  this->Plot->setObjectName("Plot");
  this->Filter->setText("No run yet.");
  this->setStop("Stop", IdleTip, false);
  this->Stop->setToolButtonStyle(Qt::ToolButtonTextOnly);
  this->Stop->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  // The texts change while the layout cannot be updated.
  constexpr int letters = 28, lines = 3;
  this->Values->setMinimumWidth(letters * this->fontMetrics().averageCharWidth());
  this->Values->setMinimumHeight(lines * this->fontMetrics().lineSpacing());
  this->Values->setAlignment(Qt::AlignTop | Qt::AlignLeft);

  auto* left = new QVBoxLayout;
  left->addWidget(this->Filter);
  left->addWidget(this->Values);
  left->addWidget(this->Bar);
  left->addWidget(this->Stop);
  left->addStretch();
  auto* layout = new QHBoxLayout(this->Content);
  layout->addLayout(left);
  layout->addWidget(this->Plot, 1);
  this->setWidget(this->Content);
  this->hide();

  auto* core = pqApplicationCore::instance();
  auto* manager = core->getProgressManager();
  QObject::connect(manager, &pqProgressManager::progress, this, &pqTautlineRunDock::progress);
  QObject::connect(manager, &pqProgressManager::progressEndEvent, this, &pqTautlineRunDock::end);
  auto* model = core->getServerManagerModel();
  QObject::connect(
    model, &pqServerManagerModel::dataUpdated, this, &pqTautlineRunDock::dataUpdated);
  QObject::connect(
    model, &pqServerManagerModel::sourceAdded, this, &pqTautlineRunDock::sourceAdded);
  QObject::connect(
    model, &pqServerManagerModel::serverAdded, this, &pqTautlineRunDock::serverAdded);
  for (pqServer* server : model->findItems<pqServer*>())
  {
    this->serverAdded(server);
  }
}

//------------------------------------------------------------------------------
pqTautlineRunDock::~pqTautlineRunDock() = default;

//------------------------------------------------------------------------------
bool pqTautlineRunDock::drawn() const
{
  return this->Plot->curves()[0].points.size() > 1;
}

//------------------------------------------------------------------------------
int pqTautlineRunDock::iterations() const
{
  const auto& points = this->Plot->curves()[0].points;
  return points.empty() ? 0 : points.back().first;
}

//------------------------------------------------------------------------------
QString pqTautlineRunDock::axes() const
{
  return this->Plot->curves()[0].name + ", " + this->Plot->curves()[1].name;
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::sourceAdded(pqPipelineSource* source)
{
  if (!this->Shown && tautline::isDrawnInDock(source->getProxy()))
  {
    this->Shown = true;
    this->show();
  }
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::serverAdded(pqServer* server)
{
  auto* definitions = server->proxyManager()->GetProxyDefinitionManager();
  for (const char* group : { "filters", "sources" })
  {
    vtkSmartPointer<vtkPVProxyDefinitionIterator> all;
    all.TakeReference(definitions->NewSingleGroupIterator(group));
    for (all->InitTraversal(); !all->IsDoneWithTraversal(); all->GoToNextItem())
    {
      vtkPVXMLElement* definition = all->GetProxyDefinition();
      vtkPVXMLElement* hints = all->GetProxyHints();
      if (definition && tautline::isInMenu(hints))
      {
        QString name = definition->GetAttributeOrEmpty("class");
        this->Filters[name.remove(QRegularExpression("^vtk"))] =
          definition->GetAttributeOrEmpty("label");
      }
    }
  }
}

//------------------------------------------------------------------------------
QString pqTautlineRunDock::filterOf(const QString& text) const
{
  // "Optimize Mesh: iteration 3, ...", or the name of a class.
  const QString name = text.section(':', 0, 0);
  if (isIterative(name))
  {
    return name;
  }
  const auto found = this->Filters.find(QString(name).remove(QRegularExpression("^vtk")));
  return found == this->Filters.end() ? QString() : found->second;
}

//------------------------------------------------------------------------------
QString pqTautlineRunDock::whyNoStop(const QString& filter) const
{
  pqServer* server = pqActiveObjects::instance().activeServer();
  if (!isIterative(filter))
  {
    return filter + " has no mesh to keep before it finishes. Use its Time Limit instead.";
  }
  if (server && server->getNumberOfPartitions() > 1)
  {
    return "A run on several server processes cannot be stopped: a process that stops alone would "
           "leave the others waiting. Use the Time Limit instead.";
  }
  return this->Cover->isAvailable() ? "" : "Stop works only on X11. Use the Time Limit instead.";
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::setStop(const QString& text, const QString& tip, bool enabled)
{
  this->Stop->setText(text);
  this->Stop->setToolTip(tip);
  this->Stop->setEnabled(enabled);
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::begin(const QString& filter)
{
  this->Running = filter;
  this->Filter->setText(filter);
  this->Values->clear();
  this->Plot->clear();
  const QString reason = this->whyNoStop(filter);
  this->setStop("Stop", reason.isEmpty() ? StopTip : reason, reason.isEmpty());
  if (reason.isEmpty())
  {
    this->Cover->cover(this->Stop);
  }
  else
  {
    this->Cover->uncover();
  }
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::showValues(const QString& values)
{
  static const QRegularExpression iterationOf("^iteration (\\d+)");
  static const QRegularExpression valueOf("^(.+) (\\S+)$");
  const QStringList parts = values.split(", ");
  const QRegularExpressionMatch iteration = iterationOf.match(parts.value(0));
  if (!iteration.hasMatch())
  {
    return;
  }
  for (int i = 1; i < parts.size() && i <= 2; ++i)
  {
    const QRegularExpressionMatch value = valueOf.match(parts[i]);
    bool valid = false;
    const double number = value.captured(2).toDouble(&valid);
    if (valid)
    {
      this->Plot->add(iteration.captured(1).toInt(), value.captured(1), number, i - 1);
    }
  }
  this->Values->setText(parts.join('\n'));
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::progress(const QString& text, int percent)
{
  const QString filter = this->filterOf(text);
  if (filter.isEmpty())
  {
    return;
  }
  if (filter != this->Running)
  {
    this->begin(filter);
  }
  this->showValues(text.section(": ", 1));
  this->Bar->setValue(percent);
  if (tautline::isStopRequested())
  {
    this->setStop("Stopping ...", "The run ends after this iteration.", false);
    pqServer* server = pqActiveObjects::instance().activeServer();
    if (!this->Sent && server)
    {
      this->Sent = true;
      tautline::sendStop(server->session());
    }
  }
  if (this->isVisible())
  {
    this->Content->repaint();
    flush();
  }
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::end()
{
  if (this->Running.isEmpty())
  {
    return;
  }
  const bool stopped = tautline::isStopRequested();
  this->EndedText = this->Running + (stopped ? Stopped : ": ended");
  this->Filter->setText(this->EndedText);
  this->Ended = this->Running;
  this->Running.clear();
  this->Bar->reset();
  this->Cover->uncover();
  this->Sent = false;
  tautline::requestStop(false);
  this->setStop("Stop", IdleTip, false);
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::dataUpdated(pqPipelineSource* source)
{
  if (!tautline::isTautline(source->getProxy()))
  {
    return;
  }
  this->showHistoryLater(source);
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::stateChanged(pqServerManagerModelItem* item)
{
  auto* source = qobject_cast<pqPipelineSource*>(item);
  if (source && source->modifiedState() == pqProxy::UNMODIFIED)
  {
    QObject::disconnect(
      source, &pqPipelineSource::modifiedStateChanged, this, &pqTautlineRunDock::stateChanged);
    this->showHistoryLater(source);
  }
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::showHistoryLater(pqPipelineSource* source)
{
  // Fetching updates a pipeline, which is not possible within an update.
  const QPointer<pqPipelineSource> updated = source;
  QTimer::singleShot(0, this,
    [this, updated]
    {
      if (updated && updated->modifiedState() == pqProxy::UNMODIFIED)
      {
        this->showHistory(updated);
      }
      else if (updated)
      {
        // During Apply the data cannot be fetched yet.
        QObject::connect(updated.data(), &pqPipelineSource::modifiedStateChanged, this,
          &pqTautlineRunDock::stateChanged, Qt::UniqueConnection);
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlineRunDock::showHistory(pqPipelineSource* source)
{
  const QString filter = source->getProxy()->GetXMLLabel();
  const QString ended = filter + endOf(source->getProxy());
  if (!isIterative(filter))
  {
    if (!this->drawn()) // a curve stays until another replaces it
    {
      this->Filter->setText(ended);
      this->Values->clear();
    }
    return;
  }
  const auto data = tautline::fetchOutput(source, "History");
  vtkTable* table = vtkTable::SafeDownCast(data);
  if (!table || table->GetNumberOfRows() == 0)
  {
    if (filter == this->Ended || this->Ended.isEmpty())
    {
      this->Filter->setText(ended);
      this->Values->clear();
      this->Ended.clear();
    }
    return;
  }
  History history;
  QStringList texts;
  for (std::size_t curve = 0; curve < history.size(); ++curve)
  {
    const vtkIdType column = columnOf(table, static_cast<int>(curve));
    if (column < 0)
    {
      continue;
    }
    // As in the progress texts: "imr worst" and "Worst imr" are "worst".
    QString name =
      QString(table->GetColumnName(column)).remove(QRegularExpression("^N ")).toLower();
    history[curve].first = name.contains("worst") ? "worst" : name;
    history[curve].second = valuesOf(table, column);
    if (texts.isEmpty())
    {
      texts.append(QString("iteration %1").arg(history[curve].second.size() - 1));
    }
    constexpr int digits = 6;
    texts.append(
      history[curve].first + ' ' + QString::number(history[curve].second.back(), 'g', digits));
  }

  // ParaView also reports updates without a run. After a run that was shown live, its text stays,
  // unless the text of an upstream filter, executed in the same update, has replaced it.
  if (filter == this->Ended)
  {
    this->Filter->setText(this->EndedText.endsWith(Stopped) ? this->EndedText : ended);
    this->Ended.clear();
  }
  else if (history == this->Last)
  {
    return;
  }
  else
  {
    this->Filter->setText(ended);
  }
  this->Last = history;
  this->Plot->clear();
  for (std::size_t curve = 0; curve < history.size(); ++curve)
  {
    const auto& [name, values] = history[curve];
    for (std::size_t row = 0; row < values.size(); ++row)
    {
      this->Plot->add(static_cast<int>(row), name, values[row], static_cast<int>(curve));
    }
  }
  this->Values->setText(texts.join('\n'));
  this->Plot->update();
}
