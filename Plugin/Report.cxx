#include "Report.h"

#include "FetchOutput.h"
#include "HistogramBars.h"

#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqView.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPVDataInformation.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMInputProperty.h"
#include "vtkSMIntVectorProperty.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <QByteArray>
#include <QDateTime>
#include <QSaveFile>
#include <QStringList>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tautline
{
namespace
{

constexpr vtkIdType MostRows = 60; // of a table
constexpr int MostComponents = 3;  // of a column; the ids and positions of the worst have more
constexpr int PictureSize = 640;   // of a histogram, pixels
constexpr int PictureHeight = 160;

const char* const Style = R"(
body { font: 15px sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; margin: 0.5em 0 1.5em; font-size: 13px; }
th, td { border: 1px solid #ccc; padding: 2px 8px; text-align: right; }
th, td:first-child { text-align: left; background: #f4f4f4; }
div.wide { overflow-x: auto; }
img, svg { max-width: 100%; }
)";

QString heading(const QString& text)
{
  return "<h2>" + text.toHtmlEscaped() + "</h2>\n";
}

QString row(const QStringList& cells, const char* tag)
{
  QString html = "<tr>";
  for (const QString& cell : cells)
  {
    html += QString("<%1>%2</%1>").arg(tag, cell.toHtmlEscaped());
  }
  return html + "</tr>\n";
}

/// The values of a property as the panel shows them.
QString valueOf(vtkSMProperty* property)
{
  if (vtkSMInputProperty::SafeDownCast(property))
  {
    auto* model = pqApplicationCore::instance()->getServerManagerModel();
    QStringList names;
    const vtkSMPropertyHelper helper(property);
    for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
    {
      auto* input = model->findItem<pqProxy*>(helper.GetAsProxy(i));
      names << (input ? input->getSMName() : QString("none"));
    }
    return names.join(", ");
  }
  QStringList values;
  auto* entries =
    vtkSMEnumerationDomain::SafeDownCast(property->FindDomain("vtkSMEnumerationDomain"));
  const vtkSMPropertyHelper helper(property, true);
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    const bool entry = entries && vtkSMIntVectorProperty::SafeDownCast(property);
    values << (entry ? QString(entries->GetEntryTextForValue(helper.GetAsInt(i)))
                     : QString::fromStdString(helper.GetAsVariant(i).ToString()));
  }
  return values.join(", ");
}

QString settingsOf(vtkSMProxy* proxy)
{
  QString html = "<table>\n";
  vtkSmartPointer<vtkSMPropertyIterator> iterator;
  iterator.TakeReference(proxy->NewPropertyIterator());
  for (iterator->Begin(); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProperty* property = iterator->GetProperty();
    const char* visibility = property->GetPanelVisibility();
    const bool hidden = visibility && std::strcmp(visibility, "never") == 0;
    if (!property->GetInformationOnly() && !property->GetIsInternal() && !hidden)
    {
      html += row({ property->GetXMLLabel(), valueOf(property) }, "td");
    }
  }
  return html + "</table>\n";
}

QString number(const vtkVariant& value)
{
  bool isNumber = false;
  const double x = value.ToDouble(&isNumber);
  return isNumber ? QString::number(x, 'g', 6) : QString::fromStdString(value.ToString());
}

QString tableOf(vtkTable* table)
{
  QStringList names;
  std::vector<vtkIdType> columns;
  for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
  {
    auto* values = vtkDataArray::SafeDownCast(table->GetColumn(c));
    if (!values || values->GetNumberOfComponents() <= MostComponents)
    {
      columns.push_back(c);
      names << table->GetColumnName(c);
    }
  }
  QString html = "<div class=\"wide\"><table>\n" + row(names, "th");
  const vtkIdType rows = std::min(MostRows, table->GetNumberOfRows());
  for (vtkIdType r = 0; r < rows; ++r)
  {
    QStringList cells;
    for (vtkIdType c : columns)
    {
      cells << number(table->GetValue(r, c));
    }
    html += row(cells, "td");
  }
  html += "</table></div>\n";
  return rows == table->GetNumberOfRows()
    ? html
    : html + QString("<p>The first %1 of %2 rows.</p>\n").arg(rows).arg(table->GetNumberOfRows());
}

/// Bars whose height is the root of their count, as in the panel.
QString pictureOf(const MetricHistogram& histogram)
{
  double most = 1;
  for (const HistogramBar& bar : histogram.bars)
  {
    most = std::max(most, static_cast<double>(bar.count));
  }
  const double width = static_cast<double>(PictureSize) / histogram.bars.size();
  QString svg = QString("<h3>%1</h3>\n<svg width=\"%2\" height=\"%3\" viewBox=\"0 0 %2 %3\">\n")
                  .arg(QString::fromStdString(histogram.label).toHtmlEscaped())
                  .arg(PictureSize)
                  .arg(PictureHeight);
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    const double height = PictureHeight * std::sqrt(static_cast<double>(bar.count) / most);
    const bool inside = bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::LastBin;
    const char* color = inside             ? "#4678b4"
      : bar.kind == HistogramBar::Inverted ? "#ff00ff"
                                           : "#8c1414";
    const int index = static_cast<int>(i);
    svg += QString("<rect x=\"%1\" y=\"%2\" width=\"%3\" height=\"%4\" fill=\"%5\"><title>%6: %7 "
                   "elements</title></rect>\n")
             .arg(i * width)
             .arg(PictureHeight - height)
             .arg(0.9 * width)
             .arg(height)
             .arg(color)
             .arg(QString::fromStdString(describeBars(histogram, index, index)).toHtmlEscaped())
             .arg(bar.count);
  }
  return svg + "</svg>\n";
}

/// The picture of a view as the address of an HTML image; "" without one.
QString captured(pqView* view)
{
  auto* proxy = view ? vtkSMViewProxy::SafeDownCast(view->getProxy()) : nullptr;
  if (!proxy)
  {
    return {};
  }
  vtkSmartPointer<vtkImageData> image;
  image.TakeReference(proxy->CaptureWindow(1));
  if (!image)
  {
    return {};
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  const QByteArray png(reinterpret_cast<const char*>(bytes->GetPointer(0)),
    static_cast<int>(bytes->GetNumberOfValues()));
  return "data:image/png;base64," + QString::fromLatin1(png.toBase64());
}

} // anonymous namespace

//------------------------------------------------------------------------------
QString reportOf(pqPipelineSource* source, pqView* view)
{
  vtkSMSourceProxy* proxy = source->getSourceProxy();
  const QString name = source->getSMName();
  QString html = QString("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                         "<title>%1</title>\n<style>%2</style>\n</head>\n<body>\n<h1>%1</h1>\n")
                   .arg(name.toHtmlEscaped(), Style);
  html += QString("<p>%1, Tautline in ParaView. %2</p>\n")
            .arg(QString(proxy->GetXMLLabel()).toHtmlEscaped(),
              QDateTime::currentDateTime().toString(Qt::ISODate));
  vtkPVDataInformation* info = source->getOutputPort(0)->getDataInformation();
  const double* bounds = info->GetBounds();
  html += heading("Mesh") + "<table>\n" + row({ "Type", info->GetPrettyDataTypeString() }, "td") +
    row({ "Points", QString::number(info->GetNumberOfPoints()) }, "td") +
    row({ "Cells", QString::number(info->GetNumberOfCells()) }, "td");
  for (int axis = 0; axis < 3; ++axis)
  {
    html += row(
      { QString("xyz"[axis]), QString("%1 to %2").arg(bounds[2 * axis]).arg(bounds[2 * axis + 1]) },
      "td");
  }
  html += "</table>\n";
  if (vtkSMProperty* summary = proxy->GetProperty("Summary"))
  {
    proxy->UpdatePropertyInformation(summary);
    const QString text = vtkSMPropertyHelper(summary).GetAsString();
    html += heading("Result") + "<p>" + text.toHtmlEscaped().replace("\n", "<br>\n") + "</p>\n";
  }
  const QString picture = captured(view);
  if (!picture.isEmpty())
  {
    html += "<p><img alt=\"The view\" src=\"" + picture + "\"></p>\n";
  }
  const auto statistics = fetchOutput(source, "Statistics"),
             bins = fetchOutput(source, "Histogram");
  const std::vector<MetricHistogram> histograms =
    histogramsOf(vtkTable::SafeDownCast(statistics), vtkTable::SafeDownCast(bins));
  html += histograms.empty() ? QString() : heading("Histogram");
  for (const MetricHistogram& histogram : histograms)
  {
    html += pictureOf(histogram);
  }
  for (unsigned int port = 1; port < proxy->GetNumberOfOutputPorts(); ++port)
  {
    const char* portName = proxy->GetOutputPortName(port);
    const auto data = fetchOutput(source, portName);
    vtkTable* table = vtkTable::SafeDownCast(data);
    const bool drawn = !histograms.empty() && std::strcmp(portName, "Histogram") == 0;
    if (table && table->GetNumberOfRows() > 0 && !drawn)
    {
      html += heading(portName) + tableOf(table);
    }
  }
  return html + heading("Settings") + settingsOf(proxy) + "</body>\n</html>\n";
}

//------------------------------------------------------------------------------
QString saveText(const QString& fileName, const QString& html)
{
  QSaveFile file(fileName);
  const QByteArray bytes = html.toUtf8();
  const bool saved =
    file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size() && file.commit();
  return saved ? QString() : fileName + " cannot be written: " + file.errorString();
}

} // namespace tautline
