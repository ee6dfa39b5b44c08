// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::CriteriaGrader
 * @brief Grades the measurements of vtkElementQuality by quality criteria, over blocks and
 * processes.
 */
#ifndef tautline_CriteriaGrader_h
#define tautline_CriteriaGrader_h

#include "tautline/Quality/Criteria.h"

#include <string>

class vtkDataSet;
class vtkMultiProcessController;
class vtkTable;

namespace tautline
{
/// JSON as it is, or the content of the preset or file that the text names; throws Error.
std::string criteriaText(const std::string& text);

class CriteriaGrader
{
public:
  /// Without criteria: does nothing.
  CriteriaGrader() = default;
  /**
   * @param text JSON, the name of a preset, or the name of a file with JSON; "" for no criteria.
   * Throws Error for any other text, and for invalid criteria.
   */
  explicit CriteriaGrader(const std::string& text);

  bool active() const { return !this->Criteria.criteria.empty(); }

  /// The convention of face centers that the criteria state, or "".
  const std::string& convention() const { return this->Criteria.convention; }

  /// These metrics, followed by the metrics of the criteria that are not among them.
  std::vector<Metric> withMetrics(std::vector<Metric> metrics) const;

  /// The same for the checks of solvers.
  std::vector<int> withChecks(std::vector<int> checks) const;

  /// Grades the cells of a block by its cell arrays of the metrics and checks; adds the arrays
  /// `Grade` and `QualityIndex`. `uncounted` and `skip` as for gradeCells().
  void grade(const Mesh& mesh, const signed char* validity, const unsigned char* uncounted,
    const unsigned char* skip, vtkDataSet* output);

  /// Adds up the results of the processes. Collective; does nothing without a controller.
  void gather(vtkMultiProcessController* controller);

  /// A row for each criterion.
  void tabulate(vtkTable* table) const;

  /// A sentence with the verdict, or "".
  std::string summary() const;

  const CriteriaTotals& totals() const { return this->Totals; }

private:
  QualityCriteria Criteria;
  CriteriaTotals Totals;
};
}
#endif
