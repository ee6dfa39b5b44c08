// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMetricAlgorithm
 * @brief Base class of filters that evaluate quality metrics; holds the list of metrics.
 *
 * Abstract. A metric is given by its number (enum Metric of tautline/Quality/Metrics.h) or by its
 * name, label, symbol or alias; vtkElementQuality::GetKnownMetric() lists them. A metric that is
 * added again keeps its first position in the list. If none is added, the inverse mean ratio is
 * evaluated.
 *
 * @sa vtkElementQuality, vtkMeshComparison, vtkMetricField, vtkTautlineTimedAlgorithm
 */

#ifndef vtkMetricAlgorithm_h
#define vtkMetricAlgorithm_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkTautlineTimedAlgorithm.h"

#include <memory> // for Selection
#include <string> // for GetUserMetrics

namespace tautline
{
class MetricSelection;
}

class TAUTLINEQUALITY_EXPORT vtkMetricAlgorithm : public vtkTautlineTimedAlgorithm
{
public:
  vtkTypeMacro(vtkMetricAlgorithm, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Adds a metric. An unknown metric is an error and changes nothing; the number of a user metric
  /// that is not registered in this process is an error when the filter executes.
  void AddMetric(int metric);
  void AddMetricByName(const char* name);
  ///@}
  /// Removes all metrics.
  void ClearMetrics();
  /// The number of metrics added.
  int GetNumberOfMetrics() const;
  /// The registered metrics (vtkUserMetric, libraries), one line "number<tab>label<tab>..." each.
  static std::string GetUserMetrics();

protected:
  vtkMetricAlgorithm();
  ~vtkMetricAlgorithm() override;

  std::string FindSettingProblem() const override;
  const tautline::MetricSelection& GetSelection() const { return *this->Selection; }

private:
  vtkMetricAlgorithm(const vtkMetricAlgorithm&) = delete;
  void operator=(const vtkMetricAlgorithm&) = delete;

  std::unique_ptr<tautline::MetricSelection> Selection;
};

#endif
