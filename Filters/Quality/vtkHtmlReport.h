// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHtmlReport
 * @brief Writes results as one HTML file that needs no other file.
 *
 * The parts are added from the top to the bottom: headings, texts, rows of names and values,
 * tables, histograms and pictures. All text is escaped; pictures are part of the file. ParaView's
 * Save Report and `tautline.report()` write their files with it.
 *
 * @code
 * vtkNew<vtkHtmlReport> report;
 * report->Begin("part.vtu", "Element Quality");
 * report->AddHeading("Result");
 * report->AddText(quality->GetSummary());
 * report->AddHistograms(quality->GetStatistics(), quality->GetHistogram());
 * report->AddMeshPicture(quality->GetOutputDataObject(0), "imr");
 * std::ofstream("report.html") << report->GetHtml();
 * @endcode
 *
 * @sa vtkElementQuality
 */

#ifndef vtkHtmlReport_h
#define vtkHtmlReport_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkObject.h"

#include <string>  // for Html
#include <utility> // for pictures
#include <vector>  // for pictures

class vtkDataObject;
class vtkImageData;
class vtkTable;

class TAUTLINEQUALITY_EXPORT vtkHtmlReport : public vtkObject
{
public:
  static vtkHtmlReport* New();
  vtkTypeMacro(vtkHtmlReport, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Begins a report, and forgets what was added. @param line below the title: what it is of
  void Begin(const char* title, const char* line);

  void AddHeading(const char* text);
  /// A paragraph; its lines stay lines.
  void AddText(const char* text);
  /// A name and its value; rows that follow each other are a table.
  void AddRow(const char* name, const char* value);

  /**
   * The rows of a table, at most 60, and how many there are. Columns of more than 3 components are
   * left out. A null or empty table adds nothing.
   */
  void AddTable(vtkTable* table);

  /**
   * The histograms of the tables Statistics and Histogram of vtkElementQuality, one per metric. The
   * height of a bar is the root of its count. Other tables add nothing.
   * @return the number of histograms
   */
  int AddHistograms(vtkTable* statistics, vtkTable* histogram);

  /// A picture of bytes in one, three or four channels; null, or other data, adds nothing.
  /// @param description for those who do not see it
  void AddImage(vtkImageData* image, const char* description);

  ///@{
  /**
   * A picture of a mesh measured by vtkElementQuality, see MeshPicture.h: coloured
   * by a metric, the inverted and degenerate elements and those that fail the criteria visible
   * through the others, with the colours of the metric below. It needs no display. Of two meshes
   * the pictures are beside each other, with the same colours for the same values.
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
  bool AddPictures(const std::vector<std::pair<vtkDataObject*, std::string>>& meshes,
    const std::string& metric, int width);
  void AddPng(vtkImageData* image, const std::string& description, const std::string& caption);

  std::string Title;
  std::string Html;
  bool InRows = false;
};

#endif
