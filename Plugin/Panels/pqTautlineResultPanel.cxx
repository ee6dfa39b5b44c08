// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineResultPanel.h"

#include "ElementSelection.h"
#include "PanelWidth.h"
#include "Report.h"
#include "SideBySide.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqFileDialog.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QAbstractTextDocumentLayout>
#include <QApplication>
#include <QClipboard>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QRegularExpression>
#include <QScrollBar>
#include <QStringList>
#include <QTextBrowser>
#include <QTimer>
#include <QToolButton>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>

namespace
{
constexpr int FewestLines = 1;
constexpr int MostLines = 8;       // the settings below stay in sight
constexpr int MostOfVerdict = 100; // letters
constexpr const char* LinkScheme = "element";
constexpr const char* WarningPrefix = "Warning: ";
constexpr const char* WarningColor = "#b00020";
/// The property of filters that can free the points of invalid elements.
constexpr const char* FreeInvalid = "FreeInvalid";

/// Whether a filter reports invalid elements whose points it was not told to free.
bool canFreeInvalid(vtkSMProxy* filter, const QString& text)
{
  static const QRegularExpression left(
    "^Warning: \\d+ elements? (is|are) (inverted or degenerate|not valid)");
  return filter->GetProperty(FreeInvalid) &&
    vtkSMPropertyHelper(filter, FreeInvalid).GetAsInt() == 0 && left.match(text).hasMatch();
}
}

//------------------------------------------------------------------------------
pqTautlineResultPanel::pqTautlineResultPanel(
  vtkSMProxy* smproxy, vtkSMProperty* smproperty, QWidget* parentObject)
  : Superclass(smproxy, parentObject)
  , Browser(new QTextBrowser(this))
  , Copy(new QToolButton(this))
  , Save(new QToolButton(this))
  , Compare(new QToolButton(this))
  , Retry(new QToolButton(this))
  , Note(new QLabel(this))
{
  this->setShowLabel(false);
  this->Browser->setObjectName("Text");
  this->Browser->setOpenLinks(false);
  this->Browser->setLineWrapMode(QTextEdit::WidgetWidth);
  this->Browser->setToolTip(pqPropertyWidget::getTooltip(smproperty));
  this->Copy->setObjectName("Copy");
  this->Copy->setText("Copy");
  this->Copy->setToolTip("Copy the text to the clipboard.");
  this->Save->setObjectName("SaveReport");
  this->Save->setText("Save Report...");
  this->Save->setToolTip("Save mesh, settings, result, tables, histogram and the picture of the "
                         "active view as one HTML file.");
  this->Compare->setObjectName("SideBySide");
  this->Compare->setText("Side by Side");
  this->Compare->setToolTip("Show the quality of the mesh before and after in two views beside "
                            "each other, with one legend and linked cameras; of Match Shape, "
                            "source and target.");
  this->Retry->setObjectName("FreeAndRetry");
  this->Retry->setText("Free Their Points and Retry");
  this->Retry->setToolTip(
    "Switch Free Invalid Elements on and apply the filter again. The boundary "
    "may change its shape at these elements.");
  this->Retry->hide();
  this->Note->setObjectName("Note");
  this->Note->setWordWrap(true);
  this->Note->hide();

  auto* buttons = new QHBoxLayout;
  buttons->addStretch();
  buttons->addWidget(this->Compare);
  buttons->addWidget(this->Copy);
  buttons->addWidget(this->Save);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Browser);
  layout->addWidget(this->Retry);
  layout->addWidget(this->Note);
  layout->addLayout(buttons);

  QObject::connect(
    this->Browser, &QTextBrowser::anchorClicked, this, &pqTautlineResultPanel::follow);
  QObject::connect(this->Copy, &QToolButton::clicked, this, &pqTautlineResultPanel::copy);
  QObject::connect(this->Compare, &QToolButton::clicked, this, &pqTautlineResultPanel::sideBySide);
  QObject::connect(this->Retry, &QToolButton::clicked, this, &pqTautlineResultPanel::freeAndRetry);
  QObject::connect(this->Save, &QToolButton::clicked, this, &pqTautlineResultPanel::saveReport);
  QObject::connect(this->Browser->document()->documentLayout(),
    &QAbstractTextDocumentLayout::documentSizeChanged, this, &pqTautlineResultPanel::fitHeight);
  this->setText(QString());
  this->addPropertyLink(this, "text", SIGNAL(textChanged()), smproperty);
}

//------------------------------------------------------------------------------
pqTautlineResultPanel::~pqTautlineResultPanel() = default;

//------------------------------------------------------------------------------
QString pqTautlineResultPanel::linked(const QString& text)
{
  static const QRegularExpression element("\\b([Ee]lement|[Cc]ell)( with global id)? (\\d+)(?!\\d)"
                                          "( of partition (\\d+))?( of block (\\d+))?"
                                          "( of process (\\d+))?");
  static const QRegularExpression block("^In (?:partition (\\d+) of )?block (\\d+): ");
  QString html, part, number = "-1";
  const QStringList lines = text.split('\n');
  for (const QString& line : lines)
  {
    const QRegularExpressionMatch inBlock = block.match(line);
    part = inBlock.hasMatch() ? inBlock.captured(1) : part;
    number = inBlock.hasMatch() ? inBlock.captured(2) : number;
    int end = 0;
    const int begin = html.size();
    const bool warning = line.startsWith(WarningPrefix);
    auto matches = element.globalMatch(line);
    while (matches.hasNext())
    {
      const QRegularExpressionMatch match = matches.next();
      const bool global = !match.captured(2).isEmpty();
      QString partition = match.captured(5), of = match.captured(7), process = match.captured(9);
      if (partition.isEmpty() && of.isEmpty() && !global)
      {
        partition = part;
        of = number;
      }
      // A partitioned data set without blocks is number 0.
      of = of.isEmpty() ? (partition.isEmpty() ? "-1" : "0") : of;
      html += line.mid(end, match.capturedStart() - end).toHtmlEscaped();
      html += QString("<a href=\"%1:%2:%3:%4:%5\">%6</a>")
                .arg(LinkScheme, match.captured(3), of, process.isEmpty() ? "-1" : process,
                  partition.isEmpty() ? "0" : partition, match.captured(0).toHtmlEscaped());
      end = match.capturedEnd();
    }
    html += line.mid(end).toHtmlEscaped();
    if (warning)
    {
      html =
        html.left(begin) + "<b style=\"color:" + WarningColor + "\">" + html.mid(begin) + "</b>";
    }
    html += "<br>";
  }
  html.chop(static_cast<int>(sizeof("<br>")) - 1);
  return html;
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::setText(const QString& text)
{
  const bool changed = this->Text != text;
  this->Text = text;
  this->Note->hide();
  QString html = pqTautlineResultPanel::linked(text);
  // The verdict is the first line; a paragraph would be hard to read.
  const int end = text.indexOf('\n');
  if (end > 0 && end <= MostOfVerdict && !text.startsWith(WarningPrefix))
  {
    html.insert(html.indexOf("<br>"), "</b>").prepend("<b>");
  }
  this->Browser->setHtml(
    text.isEmpty() ? "<i>No result yet. Errors are in Output Messages.</i>" : html);
  this->Copy->setVisible(!text.isEmpty());
  this->Save->setVisible(!text.isEmpty());
  this->Retry->setVisible(canFreeInvalid(this->proxy(), text));
  pqPipelineSource* filter = this->source();
  this->Compare->setVisible(!text.isEmpty() && filter && tautline::changesMesh(filter));
  this->fitHeight();
  if (changed)
  {
    Q_EMIT this->textChanged();
  }
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::fitHeight()
{
  const int line = this->Browser->fontMetrics().lineSpacing();
  const int frame = 2 * this->Browser->frameWidth();
  const int height = static_cast<int>(this->Browser->document()->size().height()) + frame;
  this->Browser->setFixedHeight(
    std::clamp(height, FewestLines * line + frame, MostLines * line + frame));
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::changeEvent(QEvent* event)
{
  this->Superclass::changeEvent(event);
  // ParaView disables the widgets of information properties; links and buttons are to work.
  if (event->type() == QEvent::EnabledChange && !this->isEnabled())
  {
    this->setEnabled(true);
  }
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::showEvent(QShowEvent* event)
{
  this->Superclass::showEvent(event);
  // When the layout of the panel is done, and when a section is added.
  if (const QScrollBar* bar = tautline::horizontalScrollBar(this))
  {
    QObject::connect(bar, &QScrollBar::rangeChanged, this, &pqTautlineResultPanel::fitWidth,
      static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::UniqueConnection));
  }
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::fitWidth()
{
  tautline::fitDock(this);
}

//------------------------------------------------------------------------------
pqPipelineSource* pqTautlineResultPanel::source() const
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  return model->findItem<pqPipelineSource*>(this->proxy());
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::showNote(const QString& note)
{
  this->Note->setText(note);
  this->Note->setVisible(!note.isEmpty());
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::follow(const QUrl& link)
{
  pqPipelineSource* source = this->source();
  const QStringList numbers = link.toString().split(':');
  if (!source || link.scheme() != LinkScheme || numbers.size() != 5)
  {
    return;
  }
  pqOutputPort* mesh = source->getOutputPort(0);
  const std::string problem = tautline::selectElements(mesh,
    { { numbers[1].toLongLong(), numbers[2].toInt(), numbers[3].toInt(), numbers[4].toInt() } });
  if (problem.empty())
  {
    tautline::zoomToSelected(mesh);
  }
  this->showNote(problem.empty()
      ? QString("Element %1%2: %3 cell selected.")
          .arg(numbers[1])
          .arg(numbers[3].toInt() < 0 ? QString() : " of process " + numbers[3])
          .arg(tautline::countSelected(mesh))
      : QString::fromStdString(problem));
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::copy()
{
  QApplication::clipboard()->setText(this->Text);
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::freeAndRetry()
{
  for (QWidget* parent = this->parentWidget(); parent; parent = parent->parentWidget())
  {
    if (auto* panel = qobject_cast<pqPropertiesPanel*>(parent))
    {
      const pqScopedUndoSet oneStep("Free Points");
      vtkSMPropertyHelper(this->proxy(), FreeInvalid).Set(1);
      this->proxy()->UpdateVTKObjects();
      if (pqPipelineSource* filter = this->source())
      {
        filter->setModifiedState(pqProxy::MODIFIED);
      }
      // Not within the click: the panel of the filter is refreshed.
      QTimer::singleShot(0, panel, &pqPropertiesPanel::apply);
      return;
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::saveReport()
{
  pqServer* const thisComputer = nullptr;
  pqFileDialog dialog(
    thisComputer, pqCoreUtilities::mainWidget(), "Save Report", QString(), "HTML (*.html)", false);
  dialog.setObjectName("SaveReportDialog");
  dialog.setFileMode(pqFileDialog::AnyFile);
  const QPointer<pqTautlineResultPanel> panel(this); // the filter may be deleted meanwhile
  if (this->source() && dialog.exec() == QDialog::Accepted && panel && this->source() &&
    !dialog.getSelectedFiles().isEmpty())
  {
    const QString html =
      tautline::reportOf(this->source(), pqActiveObjects::instance().activeView());
    const QString file = dialog.getSelectedFiles().first();
    const QString problem = tautline::saveText(file, html);
    this->showNote(problem.isEmpty() ? "Saved: " + file : problem);
  }
}

//------------------------------------------------------------------------------
void pqTautlineResultPanel::sideBySide()
{
  if (pqPipelineSource* filter = this->source())
  {
    this->showNote(tautline::showSideBySide(filter));
  }
}
