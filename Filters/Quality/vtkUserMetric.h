// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkUserMetric
 * @brief A metric whose values are computed by an observer; used to register metrics in Python.
 *
 * Set the properties, add an observer of vtkCommand::UserEvent and call AddToRegistry(). The metric
 * is then available by its name in all filters that measure, in criteria and in ParaView's menus
 * (of proxies created afterwards). As an objective it uses derivatives by differences, with
 * optimizers that move all points together.
 *
 * The event is invoked once for all measured cells of a type. The observer reads GetCellType() and
 * GetCorners() (a tuple x y z for each corner of each cell, cell after cell) and fills GetValues(),
 * which has a tuple per cell; on failure it calls SetFailure(). Values that are not finite become
 * 0. A planar mesh is given in its plane (z is 0), counterclockwise if valid; a volume mesh that is
 * reversed throughout is given mirrored.
 *
 * @par Example (Python; tautline.register_metric() does this):
 * @code
 * metric = vtkUserMetric()
 * metric.SetName("height")
 * metric.AddObserver("UserEvent", lambda m, event: fill(m.GetCorners(), m.GetValues()))
 * metric.AddToRegistry()
 * @endcode
 *
 * @sa tautline/Quality/UserMetric.h, for metrics in C++ that can be optimized
 */

#ifndef vtkUserMetric_h
#define vtkUserMetric_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkNew.h"                // for Corners, Values
#include "vtkObject.h"

#include <memory> // for Facts
#include <string> // for Failure

class vtkDoubleArray;

class TAUTLINEQUALITY_EXPORT vtkUserMetric : public vtkObject
{
public:
  static vtkUserMetric* New();
  vtkTypeMacro(vtkUserMetric, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The properties, as in tautline::MetricDescription. The name consists of lowercase letters,
   * digits and underscores; label and symbol are the name by default. They take effect when
   * AddToRegistry() is called.
   */
  void SetName(const char* text);
  void SetLabel(const char* text);
  void SetSymbol(const char* text);
  void SetAliases(const char* text);
  void SetFormula(const char* text);
  void SetSource(const char* text);
  void SetUnit(const char* text);
  void SetFullRange(double low, double high);
  void SetAcceptableRange(double low, double high);
  void SetIdeal(double value);
  ///@}
  /// 0: smaller is better (the default), 1: larger is better, 2: neither.
  void SetDirection(int direction);
  /// Whether the value of a cell is independent of its size or orientation. This is checked.
  void SetInvariances(bool scale, bool rotation);
  ///@{
  /// The VTK cell types for which the metric is defined. The default is all six.
  void ClearCellTypes();
  void AddCellType(int type);
  ///@}

  /// Registers the metric. @return false after an error
  bool AddToRegistry();
  /// Removes a registered metric. @return false after an error if it does not exist
  static bool RemoveFromRegistry(const char* name);
  /// Loads a library that registers metrics. @return "" or the error message
  static std::string LoadLibrary(const char* file);
  /// The error messages for the libraries in the environment variable TAUTLINE_METRICS, or "".
  static std::string GetLoadErrors();

  ///@{
  /// The data for the observer.
  int GetCellType() const { return this->CellType; }
  vtkDoubleArray* GetCorners();
  vtkDoubleArray* GetValues();
  void SetFailure(const char* message);
  ///@}

protected:
  vtkUserMetric();
  ~vtkUserMetric() override;

private:
  vtkUserMetric(const vtkUserMetric&) = delete;
  void operator=(const vtkUserMetric&) = delete;

  struct Facts;
  std::unique_ptr<Facts> TheFacts;
  vtkNew<vtkDoubleArray> Corners;
  vtkNew<vtkDoubleArray> Values;
  int CellType = 0;
  std::string Failure;
};

#endif
