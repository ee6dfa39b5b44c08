// SPDX-License-Identifier: BSD-3-Clause
// The panels of properties, in ParaView's own panel but without its window. With the default values
// each fits on the screen: rows and pixels are bounded. The result is on top, settings follow, then
// sections that are closed, with names from a list. Sections open, and a search finds what is in
// closed ones. Metrics are narrowed by a text and counted; a selection and the objectives take a
// line each.
// usage: TestPanels PLUGIN MESH [DIRECTORY]: MESH has 282 elements with an unacceptable imr;
// DIRECTORY gets a picture of each panel. Prints rows and pixels of each panel, without and with
// advanced properties.
#include "pqActiveObjects.h"
#include "pqCoreUtilities.h"
#include "pqInterfaceTracker.h"
#include "pqObjectBuilder.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqPluginManager.h"
#include "pqPropertiesPanel.h"
#include "pqProxyWidget.h"
#include "pqSearchBox.h"
#include "pqServer.h"
#include "pqServerResource.h"
#include "pqStandardPropertyWidgetInterface.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QApplication>
#include <QDialog>
#include <QElapsedTimer>
#include <QGridLayout>
#include <QLineEdit>
#include <QMainWindow>
#include <QToolButton>
#include <QTreeWidget>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace
{
constexpr int Width = 420, Height = 900; // of the window
constexpr int Delay = 20;                // milliseconds until the panel is up to date
constexpr int MostRows = 11, MostPixels = 460, LinePixels = 45;
constexpr const char* BadOfMesh = "282";
const QString SectionPrefix = "Section_";

/// The names of sections in their order.
const QStringList& sectionNames()
{
  static const QStringList names = { "Right-hand side", "Boundary and geometry", "Target",
    "Finite volumes", "Scalarization", "Coefficients", "Limits of the size", "Arrays",
    "Interaction layer", "Solution", "Time", "Energy", "Size array", "Stop", "Algorithm", "Output",
    "Parallel" };
  return names;
}

struct Case
{
  const char* group;
  const char* name;
  int rows = MostRows;
  int pixels = MostPixels;
  const char* property = nullptr; ///< that is set
  int value = 0;
};

/// The histogram and the list of metrics are high, and so is ParaView's box.
const std::vector<Case>& cases()
{
  static const std::vector<Case> all = { { "filters", "ElementQuality", MostRows, 840 },
    { "filters", "MeshOptimizer" }, { "filters", "MeshOptimizer", MostRows, 320, "Preset", 0 },
    { "filters", "MeshImprover" }, { "filters", "MeshImprover", MostRows, 320, "Preset", 0 },
    { "filters", "MeshUntangler" }, { "filters", "MeshWarp", 14, 620 },
    { "filters", "MeshComparison" }, { "filters", "MeshMetric" }, { "filters", "FieldTransfer" },
    { "filters", "MeshCurving" }, { "filters", "MeshPerturbation" },
    { "filters", "EllipticSolver" }, { "filters", "ConditionEstimator" },
    { "filters", "SolverStudy" }, { "filters", "PeridynamicCondition", 15 },
    { "filters", "InteractionLayer" }, { "filters", "HorizonNeighbors" },
    { "filters", "SilhouetteToMesh" }, { "filters", "MatchShape" }, { "filters", "ShapeRetrieval" },
    { "filters", "TriangleMesher" }, { "filters", "TetGenMesher" }, { "sources", "MetricField" },
    { "sources", "MeshDomain" } };
  return all;
}

int failures = 0;
QString pictures; ///< the directory for pictures; empty: none

void save(QWidget* widget, const QString& name)
{
  if (!pictures.isEmpty())
  {
    widget->grab().save(pictures + "/" + name + ".png");
  }
}

bool check(bool holds, const std::string& what)
{
  if (!holds)
  {
    ++failures;
    std::cerr << "Failed: " << what << "\n";
  }
  return holds;
}

void settle()
{
  QElapsedTimer timer;
  for (timer.start(); timer.elapsed() < Delay;)
  {
    QApplication::processEvents(QEventLoop::AllEvents, Delay);
  }
}

/// The first visible widget of each row that has one, from the top.
std::vector<QWidget*> rowsOf(const QWidget* panel)
{
  auto* grid = qobject_cast<QGridLayout*>(panel->layout());
  std::vector<QWidget*> rows;
  for (int row = 0; grid && row < grid->rowCount(); ++row)
  {
    for (int column = 0; column < grid->columnCount(); ++column)
    {
      QLayoutItem* item = grid->itemAtPosition(row, column);
      if (item && item->widget() && item->widget()->isVisibleTo(panel))
      {
        rows.push_back(item->widget());
        break;
      }
    }
  }
  return rows;
}

int heightOf(const QWidget* panel)
{
  return panel->layout()->hasHeightForWidth() ? panel->layout()->heightForWidth(panel->width())
                                              : panel->layout()->sizeHint().height();
}

/// The sections are the last rows, have names of the list, are in its order, and closed.
void checkSections(const std::string& panel, const std::vector<QWidget*>& rows)
{
  int last = -1;
  for (const QWidget* row : rows)
  {
    const QString name = row->objectName();
    if (!name.startsWith(SectionPrefix))
    {
      check(last < 0, panel + " has the row " + name.toStdString() + " below a section");
      continue;
    }
    const QString title = name.mid(SectionPrefix.size()).replace('_', ' ');
    const int place = sectionNames().indexOf(title);
    check(place >= 0, panel + " has a section " + title.toStdString());
    check(place > last, panel + " has the section " + title.toStdString() + " too late");
    check(!qobject_cast<const QToolButton*>(row)->isChecked(),
      panel + " begins with an open section " + title.toStdString());
    last = place;
  }
}

class Panels
{
public:
  Panels(pqPVApplicationCore& core, const QString& plugin)
    : Builder(core.getObjectBuilder())
  {
    pqCoreUtilities::setMainWidget(&this->Window);
    core.interfaceTracker()->addInterface(
      new pqStandardPropertyWidgetInterface(core.interfaceTracker()));
    this->Server = this->Builder->createServer(pqServerResource("builtin:"));
    QString error;
    core.getPluginManager()->loadExtension(this->Server, plugin, &error, false);
    check(error.isEmpty(), error.toStdString());
    this->Panel = new pqPropertiesPanel(&this->Window);
    this->Window.setCentralWidget(this->Panel);
    this->Window.resize(Width, Height);
    this->Window.show();
    pqActiveObjects::instance().setActiveServer(this->Server);
    this->Mesh = this->Builder->createSource("sources", "SphereSource", this->Server);
    this->Mesh->updatePipeline();
  }

  /// Makes a source or filter, and returns its panel.
  pqProxyWidget* show(const Case& c, pqPipelineSource* input = nullptr)
  {
    const bool filter = std::string(c.group) == "filters";
    this->Shown = filter ? this->Builder->createFilter(c.group, c.name, input ? input : this->Mesh)
                         : this->Builder->createSource(c.group, c.name, this->Server);
    if (!this->Shown) // in a build without one of the parts
    {
      return nullptr;
    }
    if (c.property)
    {
      vtkSMPropertyHelper(this->Shown->getProxy(), c.property).Set(c.value);
    }
    pqActiveObjects::instance().setActiveSource(this->Shown);
    settle();
    const auto all = this->Panel->findChildren<pqProxyWidget*>("ProxyPanel");
    for (pqProxyWidget* panel : all)
    {
      if (panel->proxy() == this->Shown->getProxy())
      {
        return panel;
      }
    }
    check(false, std::string(c.name) + " has no panel");
    return nullptr;
  }

  void filter(pqProxyWidget* panel, bool advanced, const QString& text = QString())
  {
    this->Panel->findChild<pqSearchBox*>("SearchBox")->setText(text);
    settle();
    panel->filterWidgets(advanced, text);
    settle();
  }

  pqPipelineSource* read(const QString& file)
  {
    pqPipelineSource* mesh =
      this->Builder->createReader("sources", "XMLUnstructuredGridReader", { file }, this->Server);
    mesh->updatePipeline();
    return mesh;
  }

  pqPipelineSource* shown() const { return this->Shown; }

private:
  QMainWindow Window;
  pqObjectBuilder* Builder;
  pqServer* Server;
  pqPropertiesPanel* Panel;
  pqPipelineSource* Mesh;
  pqPipelineSource* Shown = nullptr;
};

void measure(Panels& panels, const Case& c)
{
  pqProxyWidget* panel = panels.show(c);
  if (!panel)
  {
    // The meshers are optional parts of a build.
    check(
      std::string(c.name).find("Mesher") != std::string::npos, std::string(c.name) + " is missing");
    return;
  }
  const std::string name = std::string(c.name) + (c.property ? "-Custom" : "");
  for (const bool advanced : { true, false })
  {
    panels.filter(panel, advanced);
    const std::vector<QWidget*> rows = rowsOf(panel);
    const int count = static_cast<int>(rows.size()), height = heightOf(panel);
    std::cout << name << (advanced ? " (advanced): " : ": ") << count << " rows, " << height
              << " pixels\n";
    // A few advanced properties are not in a section.
    const int more = advanced ? 2 : 0;
    check(count > 0 && count <= c.rows + more, name + " has " + std::to_string(count) + " rows");
    check(
      height <= c.pixels + more * LinePixels, name + " has " + std::to_string(height) + " pixels");
    checkSections(name, rows);
    check(!panel->proxy()->GetProperty("Summary") || rows.front()->objectName() == "Summary",
      name + " does not begin with its result");
    save(panel, QString::fromStdString(name) + (advanced ? "-advanced" : ""));
  }
}

/// Sections open and close; a search finds what is in closed ones.
void checkOpening(Panels& panels)
{
  pqProxyWidget* panel = panels.show({ "filters", "MeshOptimizer" });
  panels.filter(panel, false);
  auto* limit = panel->findChild<QWidget*>("TimeLimit");
  auto* threads = panel->findChild<QWidget*>("Threads");
  auto* stop = panel->findChild<QToolButton*>(SectionPrefix + "Stop");
  auto* selection = panel->findChild<QWidget*>("FixedSelection");
  auto* boundary = panel->findChild<QToolButton*>(SectionPrefix + "Boundary_and_geometry");
  if (!check(
        limit && threads && stop && selection && boundary, "a widget of Optimize Mesh is missing"))
  {
    return;
  }
  check(limit->isHidden() && threads->isHidden(), "a closed section shows a property");
  stop->click();
  settle();
  check(!limit->isHidden() && threads->isHidden(), "a click does not open one section");
  stop->click();
  settle();
  check(limit->isHidden(), "a second click does not close the section");
  panels.filter(panel, false, "Threads");
  check(!threads->isHidden() && limit->isHidden(), "the search does not find Threads alone");
  check(stop->isHidden(), "the search shows a section without a match");
  panels.filter(panel, false);
  check(threads->isHidden(), "the section is open after the search");
  boundary->click();
  settle();
  check(!selection->isHidden() && selection->height() <= LinePixels,
    "a selection takes " + std::to_string(selection->height()) + " pixels");
  save(panel, "MeshOptimizer-open");
  boundary->click();
  settle();

  pqProxyWidget* custom =
    panels.show({ "filters", "MeshOptimizer", MostRows, MostPixels, "Preset", 0 });
  panels.filter(custom, false);
  auto* objectives = custom->findChild<QWidget*>("tautline_objectives");
  check(objectives && !objectives->isHidden() && objectives->height() <= LinePixels,
    "the objectives take more than a line");
  save(custom->findChild<QDialog*>("ObjectivesDialog"), "Objectives");
}

/// The number of metrics whose items are shown.
int shownMetrics(const QTreeWidget* tree)
{
  int shown = 0;
  for (int group = 0; group < tree->topLevelItemCount(); ++group)
  {
    const QTreeWidgetItem* title = tree->topLevelItem(group);
    for (int i = 0; !title->isHidden() && i < title->childCount(); ++i)
    {
      shown += !title->child(i)->isHidden();
    }
  }
  return shown;
}

/// Texts narrow the list of metrics; the choice stays; bad elements are counted after a run.
void checkMetrics(Panels& panels, const QString& file)
{
  pqProxyWidget* panel = panels.show({ "filters", "ElementQuality" }, panels.read(file));
  auto* metrics = panel->findChild<QWidget*>("Metrics");
  auto* tree = metrics ? metrics->findChild<QTreeWidget*>("TreeWidget") : nullptr;
  auto* text = metrics ? metrics->findChild<QLineEdit*>("Filter") : nullptr;
  if (!check(tree && text, "there is no list of metrics"))
  {
    return;
  }
  const int all = shownMetrics(tree);
  check(all >= 59, "the list has " + std::to_string(all) + " metrics");
  text->setText("min_angle");
  check(shownMetrics(tree) == 1, "a name does not find its metric alone");
  text->setText("jacobian");
  check(shownMetrics(tree) == 2, "a part of a name does not find the metrics with it");
  text->setText("finite volumes");
  const int faces = shownMetrics(tree);
  check(faces > 10 && faces < all, "the title of a group does not find its metrics");
  text->setText("no metric has this");
  check(shownMetrics(tree) == 0, "metrics are shown that do not have the text");
  text->clear();
  check(shownMetrics(tree) == all, "an empty text hides metrics");
  QTreeWidgetItem* first = tree->topLevelItem(0)->child(0);
  check(first->checkState(0) == Qt::Checked && first->text(1).isEmpty(),
    "the first metric is not chosen, or counted before the run");
  panels.shown()->setModifiedState(pqProxy::UNMODIFIED); // as ParaView's Apply does
  panels.shown()->updatePipeline();
  settle();
  check(first->text(1) == BadOfMesh, "bad elements counted: " + first->text(1).toStdString());
  save(panel, "ElementQuality-run");
  QTreeWidgetItem* second = tree->topLevelItem(0)->child(1);
  second->setCheckState(0, Qt::Checked);
  panel->apply();
  check(vtkSMPropertyHelper(panel->proxy(), "Metrics").GetNumberOfElements() == 2,
    "a metric that was chosen is not in the property");
}
}

int main(int argc, char* argv[])
{
  QApplication application(argc, argv);
  QApplication::setOrganizationName("Tautline");
  QApplication::setApplicationName("TestPanels");
  if (argc < 3)
  {
    std::cerr << "usage: TestPanels PLUGIN MESH [DIRECTORY]\n";
    return EXIT_FAILURE;
  }
  const QString plugin = argv[1], mesh = argv[2];
  pictures = argc > 3 ? argv[3] : "";
  pqPVApplicationCore core(argc, argv);
  Panels panels(core, plugin);
  for (const Case& c : cases())
  {
    measure(panels, c);
  }
  checkOpening(panels);
  checkMetrics(panels, mesh);
  std::cout << failures << " failures\n";
  std::cout.flush();
  std::_Exit(failures ? EXIT_FAILURE : EXIT_SUCCESS); // the plugin ends with ParaView's window
}
