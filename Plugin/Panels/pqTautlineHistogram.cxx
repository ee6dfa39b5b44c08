// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineHistogram.h"

#include "FetchOutput.h"
#include "HistogramPlot.h"
#include "ResultWatch.h"

#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqSelectionManager.h"
#include "pqSettings.h"

#include "vtkPVDataInformation.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkTable.h"

#include <QComboBox>
#include <QElapsedTimer>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <initializer_list>

namespace
{
enum Combinations
{
  AllConditions,
  AnyCondition
};
enum Scales
{
  Logarithmic,
  Linear
};
constexpr int MostBins = 100000;     // of the property
constexpr int ShortestPause = 40;    // milliseconds between two selections of a drag
constexpr int PauseOverDuration = 2; // of a selection
constexpr const char* ScaleSetting = "Tautline/HistogramScale";

/// The criteria of the last execution; "" of proxies without them.
std::string criteriaOf(vtkSMProxy* proxy)
{
  const char* text =
    proxy->GetProperty("Criteria") ? vtkSMPropertyHelper(proxy, "Criteria").GetAsString() : nullptr;
  return text ? text : "";
}
}

//------------------------------------------------------------------------------
pqTautlineHistogram::pqTautlineHistogram(
  vtkSMProxy* smproxy, vtkSMPropertyGroup* smgroup, QWidget* parentObject)
  : Superclass(smproxy, smgroup, parentObject)
  , Metric(new QComboBox(this))
  , Plot(new tautline::HistogramPlot(this))
  , Height(new QLabel(this))
  , Scale(new QComboBox(this))
  , Colors(new QLabel(this))
  , Combination(new QComboBox(this))
  , Conditions(new QLabel(this))
  , Count(new QLabel(this))
  , Clear(new QToolButton(this))
  , Bins(new QWidget(this))
{
  this->setShowLabel(false);
  this->Metric->setObjectName("Metric");
  this->Metric->setToolTip("The metric whose histogram is shown.");
  this->Plot->setObjectName("Plot");
  // As narrow as the panel.
  for (QComboBox* box : { this->Metric, this->Combination })
  {
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  }
  this->Scale->setObjectName("Scale");
  this->Scale->addItems({ "logarithmic", "linear" });
  this->Scale->setToolTip("The axis of the numbers of elements. A logarithmic one shows a few "
                          "elements next to many.");
  this->Scale->setCurrentIndex(pqApplicationCore::instance()
                                 ->settings()
                                 ->value(ScaleSetting, static_cast<int>(Logarithmic))
                                 .toInt() == Linear
      ? Linear
      : Logarithmic);
  this->Height->setText("Bar height: number of elements, axis");
  this->Height->setWordWrap(true);
  this->Colors->setObjectName("Colors");
  this->Colors->setWordWrap(true);
  this->Count->setWordWrap(true);
  this->Combination->setObjectName("Combination");
  this->Combination->addItems({ "all conditions (AND)", "any condition (OR)" });
  this->Combination->setToolTip(
    "Which cells are selected if ranges of several metrics are chosen.");
  this->Conditions->setObjectName("Conditions");
  this->Conditions->setWordWrap(true);
  this->Count->setObjectName("Count");
  this->Clear->setObjectName("Clear");
  this->Clear->setText("Clear");
  this->Clear->setToolTip("Select nothing.");

  auto* bins = new QSpinBox(this->Bins);
  bins->setObjectName("Number");
  bins->setRange(1, MostBins);
  bins->setToolTip(pqPropertyWidget::getTooltip(smgroup->GetProperty("HistogramBins")));
  this->addPropertyLink(bins, "HistogramBins");
  this->Bins->setObjectName("Bins");
  auto* binsRow = new QHBoxLayout(this->Bins);
  binsRow->setContentsMargins(0, 0, 0, 0);
  binsRow->addWidget(new QLabel("Histogram Bins", this->Bins));
  binsRow->addWidget(bins, 1);

  auto* heightRow = new QHBoxLayout;
  heightRow->addWidget(this->Height, 1);
  heightRow->addWidget(this->Scale);
  auto* bottom = new QHBoxLayout;
  bottom->addWidget(this->Count, 1);
  bottom->addWidget(this->Clear);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Metric);
  layout->addWidget(this->Plot);
  layout->addLayout(heightRow);
  layout->addWidget(this->Colors);
  layout->addWidget(this->Combination);
  layout->addWidget(this->Conditions);
  layout->addLayout(bottom);
  layout->addWidget(this->Bins);

  QObject::connect(pqPVApplicationCore::instance()->selectionManager(),
    &pqSelectionManager::selectionChanged, this, &pqTautlineHistogram::selectionChanged);
  const auto changed = QOverload<int>::of(&QComboBox::currentIndexChanged);
  QObject::connect(this->Metric, changed, this, &pqTautlineHistogram::metricChanged);
  QObject::connect(this->Combination, changed, this, &pqTautlineHistogram::selectElements);
  QObject::connect(
    this->Plot, &tautline::HistogramPlot::chosen, this, &pqTautlineHistogram::choose);
  QObject::connect(this->Plot, &tautline::HistogramPlot::dragged, this, &pqTautlineHistogram::drag);
  QObject::connect(this->Scale, changed, this, &pqTautlineHistogram::scaleChanged);
  this->Pause.setSingleShot(true);
  this->Pause.setInterval(ShortestPause);
  QObject::connect(&this->Pause, &QTimer::timeout, this, &pqTautlineHistogram::selectElements);
  QObject::connect(this->Clear, &QToolButton::clicked, this, &pqTautlineHistogram::clear);
  this->scaleChanged();
  this->refresh();
  this->Watch = new tautline::ResultWatch(this, smproxy, [this] { this->refresh(); });
}

//------------------------------------------------------------------------------
pqTautlineHistogram::~pqTautlineHistogram() = default;

//------------------------------------------------------------------------------
pqPipelineSource* pqTautlineHistogram::source() const
{
  return this->Watch ? this->Watch->source() : nullptr;
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::updateWidget(bool showAdvanced)
{
  this->Bins->setVisible(showAdvanced);
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::refresh()
{
  this->Pause.stop();
  this->Histograms.clear();
  this->Choices.clear();
  if (pqPipelineSource* source = this->source())
  {
    const auto statistics = tautline::fetchOutput(source, "Statistics");
    const auto histogram = tautline::fetchOutput(source, "Histogram");
    this->Histograms =
      tautline::histogramsOf(vtkTable::SafeDownCast(statistics), vtkTable::SafeDownCast(histogram));
  }
  {
    const QSignalBlocker blocker(this->Metric);
    const QString before = this->Metric->currentData().toString();
    this->Metric->clear();
    for (const tautline::MetricHistogram& histogram : this->Histograms)
    {
      this->Metric->addItem(
        QString::fromStdString(histogram.label), QString::fromStdString(histogram.metric));
    }
    this->Metric->setCurrentIndex(std::max(0, this->Metric->findData(before)));
  }
  const bool several = this->Histograms.size() > 1;
  this->Metric->setVisible(several);
  this->Combination->setVisible(several);
  this->metricChanged();
  this->describe(0);
}

//------------------------------------------------------------------------------
const tautline::MetricHistogram* pqTautlineHistogram::shown() const
{
  const int index = this->Metric->currentIndex();
  return index >= 0 && index < static_cast<int>(this->Histograms.size()) ? &this->Histograms[index]
                                                                         : nullptr;
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::metricChanged()
{
  const tautline::MetricHistogram* histogram = this->shown();
  const auto choice = histogram ? this->Choices.find(histogram->metric) : this->Choices.end();
  const bool chosen = choice != this->Choices.end();
  const auto limits = histogram
    ? tautline::histogramLimits(criteriaOf(this->proxy()), histogram->metric, {})
    : std::vector<tautline::HistogramLimit>();
  this->Plot->show(histogram ? *histogram : tautline::MetricHistogram(), limits,
    chosen ? choice->second.first : -1, chosen ? choice->second.last : -1);
  this->Colors->setText(
    histogram ? QString::fromStdString(tautline::describeColors(*histogram)) : QString());
  for (QWidget* widget :
    std::initializer_list<QWidget*>{ this->Colors, this->Height, this->Scale, this->Clear })
  {
    widget->setVisible(histogram);
  }
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::scaleChanged()
{
  const int scale = this->Scale->currentIndex();
  pqApplicationCore::instance()->settings()->setValue(ScaleSetting, scale);
  this->Plot->setScale(
    scale == Linear ? tautline::CountScale::Linear : tautline::CountScale::Logarithmic);
}

//------------------------------------------------------------------------------
bool pqTautlineHistogram::setChoice(int first, int last)
{
  const tautline::MetricHistogram* histogram = this->shown();
  if (histogram)
  {
    this->Choices.erase(histogram->metric);
    if (first >= 0)
    {
      this->Choices[histogram->metric] = { first, last };
    }
  }
  return histogram;
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::choose(int first, int last)
{
  if (this->setChoice(first, last))
  {
    this->selectElements();
  }
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::drag(int first, int last)
{
  // The selection follows with pauses, in which the range is drawn.
  if (this->setChoice(first, last))
  {
    this->showConditions();
    if (!this->Pause.isActive())
    {
      this->Pause.start();
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::clear()
{
  this->Choices.clear();
  this->metricChanged();
  this->selectElements();
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::selectElements()
{
  this->Pause.stop();
  pqPipelineSource* source = this->source();
  if (!source)
  {
    return;
  }
  std::vector<tautline::CellCondition> conditions;
  for (const tautline::MetricHistogram& histogram : this->Histograms)
  {
    const auto choice = this->Choices.find(histogram.metric);
    if (choice != this->Choices.end())
    {
      conditions.push_back(
        tautline::conditionOf(histogram, choice->second.first, choice->second.last));
    }
  }
  QElapsedTimer duration;
  duration.start();
  this->Selecting = true;
  const vtkTypeInt64 selected = tautline::selectWhere(
    source->getOutputPort(0), conditions, this->Combination->currentIndex() == AllConditions);
  this->Selecting = false;
  this->Pause.setInterval(
    std::max(ShortestPause, PauseOverDuration * static_cast<int>(duration.elapsed())));
  this->describe(selected);
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::selectionChanged(pqOutputPort*)
{
  // Another selection, made in a view or by Find Data, takes the place of the histogram's.
  if (!this->Selecting && !this->Choices.empty())
  {
    this->Choices.clear();
    this->metricChanged();
    this->describe(0);
  }
}

//------------------------------------------------------------------------------
QStringList pqTautlineHistogram::conditions() const
{
  QStringList conditions;
  for (const tautline::MetricHistogram& histogram : this->Histograms)
  {
    const auto choice = this->Choices.find(histogram.metric);
    if (choice != this->Choices.end())
    {
      const std::string text =
        tautline::describeBars(histogram, choice->second.first, choice->second.last);
      conditions << QString::fromStdString(histogram.metric + " " + text);
    }
  }
  return conditions;
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::showConditions()
{
  const QStringList conditions = this->conditions();
  const bool all = this->Combination->currentIndex() == AllConditions;
  this->Conditions->setText(conditions.isEmpty()
      ? this->Histograms.empty() ? "" : "Drag over the bars to select their elements."
      : conditions.join(all ? " and " : " or "));
  this->Clear->setEnabled(!conditions.isEmpty());
}

//------------------------------------------------------------------------------
void pqTautlineHistogram::describe(vtkTypeInt64 selected)
{
  this->showConditions();
  pqPipelineSource* source = this->source();
  if (this->Choices.empty() || !source)
  {
    this->Count->clear();
    return;
  }
  const vtkTypeInt64 cells = source->getOutputPort(0)->getDataInformation()->GetNumberOfCells();
  const double share = cells > 0 ? 100.0 * static_cast<double>(selected) / cells : 0.0;
  this->Count->setText(
    QString("%1 of %2 cells (%3 %)").arg(selected).arg(cells).arg(QString::number(share, 'g', 3)));
}
