// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHtmlReport
 * @brief Writes results as one HTML file that needs no other file.
 *
 * A report on the quality of a mesh, and of the mesh before it was changed, has a fixed order of
 * sections: source, pipeline, mesh, result, pictures, histograms, tables. They are given in any
 * order, and AddSections() writes those that there are. ParaView's Save Report and
 * `tautline.report()` write their files with it.
 *
 * @code
 * vtkNew<vtkHtmlReport> report;
 * report->Begin("part.vtu", "Element Quality");
 * report->SetFile(vtkHtmlReport::AFTER, "part.vtu");
 * report->SetQuality(vtkHtmlReport::AFTER, quality); // a vtkElementQuality that was executed
 * report->AddSections();
 * std::ofstream("report.html") << report->GetHtml();
 * @endcode
 *
 * Other reports are written part by part, from the top to the bottom: headings, texts, rows of
 * names and values, tables, histograms and pictures. All text is escaped; pictures are part of the
 * file.
 *
 * @sa vtkElementQuality
 */

#ifndef vtkHtmlReport_h
#define vtkHtmlReport_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for outputs

#include <array>   // for sides
#include <map>     // for outputs
#include <string>  // for Html
#include <utility> // for pictures
#include <vector>  // for pictures

class vtkDataObject;
class vtkElementQuality;
class vtkImageData;
class vtkTable;

class TAUTLINEQUALITY_EXPORT vtkHtmlReport : public vtkObject
{
public:
  static vtkHtmlReport* New();
  vtkTypeMacro(vtkHtmlReport, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The mesh that the report is of, and the one before it was changed, which may be missing.
  enum Sides
  {
    BEFORE = 0,
    AFTER = 1
  };

  /// Begins a report, and forgets what was added and set. @param line below the title: the subject
  void Begin(const char* title, const char* line);

  ///@{
  /**
   * What AddSections() writes. SetFile(): the name of the file of a side. AddStep(): a filter, from
   * the reader on, with its settings, a line each; "" stands for default settings. SetResult(): the
   * text of the last filter. SetQuality(): what vtkElementQuality has found of a side.
   * SetQualityOutput(): one of its outputs by its name in ParaView: "Mesh", "Statistics",
   * "Distribution", "Angles", "Histogram", "Criteria", "MeshChecks". SetQualitySummary(): its text.
   * SetCriteria(): as of vtkElementQuality; their limits are marked in the histograms.
   * AddResultTable(): another table of the last filter, such as its history.
   */
  void SetFile(int side, const char* name);
  void AddStep(const char* name, const char* settings);
  void SetResult(const char* text);
  void SetQuality(int side, vtkElementQuality* measured);
  void SetQualityOutput(int side, const char* output, vtkDataObject* data);
  void SetQualitySummary(int side, const char* text);
  void SetCriteria(const char* criteria);
  void AddResultTable(const char* name, vtkTable* table);
  ///@}

  /**
   * Adds the sections. Statistics and the other tables are of both sides if there are two.
   * @return false, after an error event, if a mesh cannot be drawn
   */
  bool AddSections();

  void AddHeading(const char* text);
  /// A paragraph; its lines stay lines.
  void AddText(const char* text);
  /// A name and its value; rows that follow each other are a table.
  void AddRow(const char* name, const char* value);

  /**
   * The rows of a table, at most 60, and how many there are; more than 12 are folded. Columns of
   * more than 3 components are left out. A null or empty table adds nothing.
   */
  void AddTable(vtkTable* table);

  /**
   * The histograms of the tables Statistics and Histogram of vtkElementQuality, one per metric,
   * with axes; the axis of counts is logarithmic. The bars have the colors of the pictures. Other
   * tables add nothing.
   * @return the number of histograms
   */
  int AddHistograms(vtkTable* statistics, vtkTable* histogram);

  /// A picture of bytes in one, three or four channels; null, or other data, adds nothing.
  /// @param description for those who do not see it
  void AddImage(vtkImageData* image, const char* description);

  ///@{
  /**
   * A picture of a mesh measured by vtkElementQuality, see MeshPicture.h: colored
   * by a metric, the inverted and degenerate elements and those that fail the criteria visible
   * through the others, with the colors of the metric below. It needs no display. For two meshes
   * the pictures are beside each other, with the same colors for the same values.
   * @param mesh, before, after with the cell arrays of the metric and `Validity`; a data set or
   * composite data
   * @param metric name of the metric and of the cell array
   * @return false, after an error event, if a data set has no such array or cannot be drawn
   */
  bool AddMeshPicture(vtkDataObject* mesh, const char* metric);
  bool AddMeshPictures(vtkDataObject* before, vtkDataObject* after, const char* metric);
  ///@}

  /// The whole report.
  std::string GetHtml() const;

protected:
  vtkHtmlReport();
  ~vtkHtmlReport() override;

private:
  vtkHtmlReport(const vtkHtmlReport&) = delete;
  void operator=(const vtkHtmlReport&) = delete;

  void Add(const std::string& html);
  bool IsSide(int side); ///< else an error
  vtkDataObject* Output(int side, const char* name) const;
  vtkTable* Table(int side, const char* name) const;
  bool IsComparison() const;
  void AddSource();
  void AddPipeline();
  void AddMeshFacts();
  bool AddQualityPictures();
  void AddChanges();
  void AddQualityHistograms();
  void AddTables(const char* output, const char* heading);
  bool AddPictures(const std::vector<std::pair<vtkDataObject*, std::string>>& meshes,
    const std::string& metric, int width);
  void AddPng(vtkImageData* image, const std::string& description, const std::string& caption);

  std::string Title;
  std::string Html;
  bool InRows = false;

  /// What AddSections() writes of a side.
  struct Measured
  {
    std::string File, Summary;
    std::map<std::string, vtkSmartPointer<vtkDataObject>> Outputs;
  };
  std::array<Measured, 2> BothSides;
  std::vector<std::pair<std::string, std::string>> Steps;
  std::vector<std::pair<std::string, vtkSmartPointer<vtkTable>>> ResultTables;
  std::string Result, Criteria;
};

#endif
