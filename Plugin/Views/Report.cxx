// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "FetchOutput.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqProxy.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqView.h"

#include "vtkHtmlReport.h"
#include "vtkImageData.h"
#include "vtkNew.h"
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
#include "vtkVariant.h"

#include <QByteArray>
#include <QDateTime>
#include <QSaveFile>
#include <QStringList>

#include <cstring>
#include <string>

namespace tautline
{
namespace
{

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

void addSettings(vtkHtmlReport* report, vtkSMProxy* proxy)
{
  vtkSmartPointer<vtkSMPropertyIterator> iterator;
  iterator.TakeReference(proxy->NewPropertyIterator());
  for (iterator->Begin(); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProperty* property = iterator->GetProperty();
    const char* visibility = property->GetPanelVisibility();
    const bool hidden = visibility && std::strcmp(visibility, "never") == 0;
    if (!property->GetInformationOnly() && !property->GetIsInternal() && !hidden)
    {
      report->AddRow(property->GetXMLLabel(), valueOf(property).toUtf8().data());
    }
  }
}

void addMesh(vtkHtmlReport* report, vtkPVDataInformation* info)
{
  report->AddRow("Type", info->GetPrettyDataTypeString());
  report->AddRow("Points", std::to_string(info->GetNumberOfPoints()).c_str());
  report->AddRow("Cells", std::to_string(info->GetNumberOfCells()).c_str());
  const double* bounds = info->GetBounds();
  for (int axis = 0; axis < 3; ++axis)
  {
    const QString range = QString("%1 to %2").arg(bounds[2 * axis]).arg(bounds[2 * axis + 1]);
    report->AddRow(QString("xyz"[axis]).toUtf8().data(), range.toUtf8().data());
  }
}

/// The active view if it draws meshes, else one in which an output of the filter is visible, else
/// any that draws meshes: tables and charts that a filter opens become active.
pqView* viewOfMeshes(pqPipelineSource* source, pqView* active)
{
  if (qobject_cast<pqRenderView*>(active))
  {
    return active;
  }
  pqView* any = active;
  for (pqRenderView* view :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
  {
    any = view;
    for (int port = 0; port < source->getNumberOfOutputPorts(); ++port)
    {
      auto* shown = source->getOutputPort(port)->getRepresentation(view);
      if (shown && shown->isVisible())
      {
        return view;
      }
    }
  }
  return any;
}

/// What the view shows, if there is one.
void addView(vtkHtmlReport* report, pqView* view)
{
  auto* proxy = view ? vtkSMViewProxy::SafeDownCast(view->getProxy()) : nullptr;
  if (proxy)
  {
    vtkSmartPointer<vtkImageData> image;
    image.TakeReference(proxy->CaptureWindow(1));
    report->AddImage(image, "The view");
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
QString reportOf(pqPipelineSource* source, pqView* view)
{
  vtkSMSourceProxy* proxy = source->getSourceProxy();
  const QString line =
    QString("%1, Tautline in ParaView. %2")
      .arg(QString(proxy->GetXMLLabel()), QDateTime::currentDateTime().toString(Qt::ISODate));
  vtkNew<vtkHtmlReport> report;
  report->Begin(source->getSMName().toUtf8().data(), line.toUtf8().data());
  report->AddHeading("Mesh");
  addMesh(report, source->getOutputPort(0)->getDataInformation());
  if (vtkSMProperty* summary = proxy->GetProperty("Summary"))
  {
    proxy->UpdatePropertyInformation(summary);
    report->AddHeading("Result");
    report->AddText(vtkSMPropertyHelper(summary).GetAsString());
  }
  addView(report, viewOfMeshes(source, view));
  const auto statistics = fetchOutput(source, "Statistics"),
             bins = fetchOutput(source, "Histogram");
  auto* histogram = vtkTable::SafeDownCast(bins);
  const bool drawn = histogram && histogram->GetNumberOfRows() > 0;
  if (drawn)
  {
    report->AddHeading("Histogram");
    report->AddHistograms(vtkTable::SafeDownCast(statistics), histogram);
  }
  for (unsigned int port = 1; port < proxy->GetNumberOfOutputPorts(); ++port)
  {
    const char* portName = proxy->GetOutputPortName(port);
    const auto data = fetchOutput(source, portName);
    vtkTable* table = vtkTable::SafeDownCast(data);
    if (table && table->GetNumberOfRows() > 0 &&
      !(drawn && std::strcmp(portName, "Histogram") == 0))
    {
      report->AddHeading(portName);
      report->AddTable(table);
    }
  }
  report->AddHeading("Settings");
  addSettings(report, proxy);
  return QString::fromStdString(report->GetHtml());
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
