// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "FetchOutput.h"
#include "ReportPipeline.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"
#include "pqView.h"

#include "vtkCell.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkHtmlReport.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"

#include <QByteArray>
#include <QDateTime>
#include <QSaveFile>
#include <QStringList>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

namespace tautline
{
namespace
{

constexpr unsigned int MeshPort = 0;
constexpr const char* QualityProxy = "ElementQuality";
/// The tables of Element Quality in the report.
constexpr const char* QualityTables[] = { "Statistics", "Distribution", "Angles", "Histogram",
  "Criteria", "MeshChecks" };

using Source = vtkSmartPointer<vtkSMSourceProxy>;
using Data = vtkSmartPointer<vtkDataObject>;

bool isQuality(pqPipelineSource* source)
{
  return std::strcmp(source->getProxy()->GetXMLName(), QualityProxy) == 0;
}

/// Whether an output is a mesh that can be measured; the cells of an image are all equal.
bool isMesh(pqOutputPort* port)
{
  vtkPVDataInformation* info = port->getDataInformation();
  return info->GetNumberOfCells() > 0 && info->GetDataSetType() != VTK_IMAGE_DATA &&
    info->GetDataSetType() != VTK_RECTILINEAR_GRID;
}

/// The output on a port; if several processes have cells, their parts become blocks.
Data fetchAll(vtkSMSourceProxy* source, unsigned int port, pqServer* server)
{
  const double time = server->getTimeKeeper()->getTime();
  std::vector<Data> parts;
  for (int process = 0; process < std::max(1, server->getNumberOfPartitions()); ++process)
  {
    const Data part = fetchPart(source, port, process, time);
    if (parts.empty() || (part && part->GetNumberOfElements(vtkDataObject::CELL) > 0))
    {
      parts.push_back(part);
    }
  }
  // The first process has no cells, but another one may have them.
  if (parts.size() > 1 &&
    (!parts.front() || parts.front()->GetNumberOfElements(vtkDataObject::CELL) == 0))
  {
    parts.erase(parts.begin());
  }
  if (parts.size() == 1)
  {
    return parts.front();
  }
  const auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    blocks->SetBlock(static_cast<unsigned int>(i), parts[i]);
  }
  return blocks;
}

std::vector<vtkDataSet*> leavesOf(vtkDataObject* data)
{
  std::vector<vtkDataSet*> leaves;
  if (auto* single = vtkDataSet::SafeDownCast(data))
  {
    leaves.push_back(single);
  }
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> iterator;
    iterator.TakeReference(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      if (auto* leaf = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject()))
      {
        leaves.push_back(leaf);
      }
    }
  }
  return leaves;
}

/// The highest dimension of the cells.
int dimensionOf(vtkDataObject* mesh)
{
  int dimension = 0;
  for (vtkDataSet* leaf : leavesOf(mesh))
  {
    for (vtkIdType cell = 0; cell < leaf->GetNumberOfCells() && dimension < 3; ++cell)
    {
      dimension = std::max(dimension, leaf->GetCell(cell)->GetCellDimension());
    }
  }
  return dimension;
}

/// Whether two meshes have the same cells at the same positions.
bool isSameMesh(vtkDataObject* a, vtkDataObject* b)
{
  const std::vector<vtkDataSet*> first = leavesOf(a), second = leavesOf(b);
  return std::equal(first.begin(), first.end(), second.begin(), second.end(),
    [](vtkDataSet* one, vtkDataSet* other)
    {
      if (one->GetNumberOfPoints() != other->GetNumberOfPoints() ||
        one->GetNumberOfCells() != other->GetNumberOfCells())
      {
        return false;
      }
      for (vtkIdType point = 0; point < one->GetNumberOfPoints(); ++point)
      {
        std::array<double, 3> x{}, y{};
        one->GetPoint(point, x.data());
        other->GetPoint(point, y.data());
        if (x != y)
        {
          return false;
        }
      }
      vtkNew<vtkIdList> here, there;
      for (vtkIdType cell = 0; cell < one->GetNumberOfCells(); ++cell)
      {
        one->GetCellPoints(cell, here);
        other->GetCellPoints(cell, there);
        if (one->GetCellType(cell) != other->GetCellType(cell) ||
          !std::equal(here->begin(), here->end(), there->begin(), there->end()))
        {
          return false;
        }
      }
      return true;
    });
}

/// An executed Element Quality of an output, with the settings of another one or the defaults.
Source measure(pqOutputPort* port, vtkSMSourceProxy* like)
{
  const pqScopedUndoExclude notUndone;
  vtkSMSourceProxy* input = port->getSourceProxy();
  Source quality;
  quality.TakeReference(vtkSMSourceProxy::SafeDownCast(
    input->GetSessionProxyManager()->NewProxy("filters", QualityProxy)));
  if (!quality)
  {
    return nullptr;
  }
  vtkSMPropertyHelper(quality, "Input").Set(input, static_cast<unsigned>(port->getPortNumber()));
  if (like)
  {
    quality->Copy(like, "vtkSMInputProperty");
    quality->GetProperty("Reference")->Copy(like->GetProperty("Reference"));
    vtkSMPropertyHelper(quality, "Input").Set(input, static_cast<unsigned>(port->getPortNumber()));
  }
  quality->UpdateVTKObjects();
  quality->UpdatePipeline(port->getServer()->getTimeKeeper()->getTime());
  return quality;
}

QString summaryOf(vtkSMProxy* proxy)
{
  vtkSMProperty* summary = proxy->GetProperty("Summary");
  if (!summary)
  {
    return {};
  }
  proxy->UpdatePropertyInformation(summary);
  return vtkSMPropertyHelper(summary).GetAsString();
}

void setQuality(
  vtkHtmlReport* report, int side, vtkSMSourceProxy* quality, vtkDataObject* mesh, pqServer* server)
{
  constexpr int firstProcess = 0; // has the tables
  const double time = server->getTimeKeeper()->getTime();
  report->SetQualityOutput(side, "Mesh", mesh);
  for (const char* table : QualityTables)
  {
    const int port = outputPort(quality, table);
    if (port >= 0)
    {
      report->SetQualityOutput(
        side, table, fetchPart(quality, static_cast<unsigned int>(port), firstProcess, time));
    }
  }
  report->SetQualitySummary(side, summaryOf(quality).toUtf8().data());
  report->SetCriteria(vtkSMPropertyHelper(quality, "Criteria").GetAsString());
}

/// The measured meshes of a filter.
struct Sides
{
  Source after, before;
  Data afterMesh, beforeMesh;
  bool beforeInFile = false; ///< no filter is before it
};

/// The mesh before the filter or, for Element Quality, before the last filter that changed it.
void findBefore(pqPipelineSource* source, vtkSMSourceProxy* like, Sides& sides)
{
  const std::vector<pqPipelineSource*> steps = pipelineOf(source);
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
  {
    pqOutputPort* input = inputOf(*step);
    if (!input || !isMesh(input) || (*step != source && !like))
    {
      return;
    }
    // Element Quality passes its mesh on: comparing the two would fetch the mesh for nothing.
    if (isQuality(*step))
    {
      continue;
    }
    pqServer* server = input->getServer();
    const auto port = static_cast<unsigned int>(input->getPortNumber());
    const Data mesh = fetchAll(input->getSourceProxy(), port, server);
    if (!mesh || dimensionOf(mesh) != dimensionOf(sides.afterMesh))
    {
      return;
    }
    if (!isSameMesh(mesh, sides.afterMesh))
    {
      sides.before = measure(input, like);
      sides.beforeMesh = sides.before ? fetchAll(sides.before, MeshPort, server) : Data();
      sides.beforeInFile = !inputOf(input->getSource());
      return;
    }
  }
}

Sides sidesOf(pqPipelineSource* source)
{
  Sides sides;
  pqOutputPort* output = source->getOutputPort(static_cast<int>(MeshPort));
  if (!isMesh(output))
  {
    return sides;
  }
  vtkSMSourceProxy* own = isQuality(source) ? source->getSourceProxy() : nullptr;
  sides.after = own ? Source(own) : measure(output, nullptr);
  sides.afterMesh = sides.after ? fetchAll(sides.after, MeshPort, source->getServer()) : Data();
  if (sides.afterMesh)
  {
    findBefore(source, own, sides);
  }
  return sides;
}

/// The tables of a filter other than Element Quality.
void addTables(vtkHtmlReport* report, pqPipelineSource* source)
{
  vtkSMSourceProxy* proxy = source->getSourceProxy();
  for (unsigned int port = 0; port < proxy->GetNumberOfOutputPorts(); ++port)
  {
    const char* name = proxy->GetOutputPortName(port);
    const auto data =
      source->getOutputPort(static_cast<int>(port))->getDataInformation()->GetDataSetType() ==
        VTK_TABLE
      ? fetchOutput(source, name)
      : Data();
    if (vtkTable* table = vtkTable::SafeDownCast(data))
    {
      // The tables of Element Quality have the same headings.
      const bool taken = std::any_of(std::begin(QualityTables), std::end(QualityTables),
        [name](const char* known) { return std::strcmp(known, name) == 0; });
      const std::string heading =
        (taken ? proxy->GetXMLLabel() + std::string(": ") : std::string()) + name;
      report->AddResultTable(heading.c_str(), table);
    }
  }
}

/// The files and the filters.
void addPipeline(vtkHtmlReport* report, pqPipelineSource* source, bool fileIsBefore)
{
  const std::vector<pqPipelineSource*> steps = pipelineOf(source);
  const QString file = fileOf(steps.front());
  if (!file.isEmpty())
  {
    report->SetFile(
      fileIsBefore ? vtkHtmlReport::BEFORE : vtkHtmlReport::AFTER, file.toUtf8().data());
  }
  for (pqPipelineSource* step : steps)
  {
    report->AddStep(
      step->getProxy()->GetXMLLabel(), changedSettings(step).join("\n").toUtf8().data());
  }
}

QString titleOf(pqPipelineSource* source)
{
  const QString file = fileOf(pipelineOf(source).front());
  const QString label = source->getProxy()->GetXMLLabel();
  return file.isEmpty()                                   ? source->getSMName()
    : isQuality(source) && pipelineOf(source).size() == 2 ? file
                                                          : file + ": " + label;
}

/// The active view if it draws meshes, otherwise one in which an output of the filter is visible,
/// otherwise any that draws meshes: tables and charts opened by a filter become active.
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

/// The picture of the view, if there is one.
void addView(vtkHtmlReport* report, pqView* view)
{
  auto* proxy = view ? vtkSMViewProxy::SafeDownCast(view->getProxy()) : nullptr;
  if (proxy)
  {
    vtkSmartPointer<vtkImageData> image;
    image.TakeReference(proxy->CaptureWindow(1));
    report->AddHeading("View");
    report->AddImage(image, "The view");
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
QString reportOf(pqPipelineSource* source, pqView* view)
{
  const QString now = QDateTime::currentDateTimeUtc().toString("yyyy-MM-dd HH:mm:ss");
  const QString line =
    QString("%1, Tautline. %2+00:00").arg(QString(source->getProxy()->GetXMLLabel()), now);
  vtkNew<vtkHtmlReport> report;
  report->Begin(titleOf(source).toUtf8().data(), line.toUtf8().data());
  const Sides sides = sidesOf(source);
  addPipeline(report, source, sides.beforeInFile);
  if (!isQuality(source))
  {
    report->SetResult(summaryOf(source->getProxy()).toUtf8().data());
    addTables(report, source);
  }
  if (sides.beforeMesh)
  {
    setQuality(report, vtkHtmlReport::BEFORE, sides.before, sides.beforeMesh, source->getServer());
  }
  if (sides.afterMesh)
  {
    setQuality(report, vtkHtmlReport::AFTER, sides.after, sides.afterMesh, source->getServer());
  }
  report->AddSections();
  if (!isQuality(source) && !sides.beforeMesh)
  {
    addView(report, viewOfMeshes(source, view));
  }
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
