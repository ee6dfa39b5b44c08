// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkUserMetric
 * @brief A metric whose values an observer computes: how Python registers a metric of its own.
 *
 * Set the facts, add an observer of vtkCommand::UserEvent and call AddToRegistry(). The metric is
 * then known by its name to all filters that measure, to criteria and to ParaView's menus (of
 * proxies created afterwards). As an objective it takes derivatives by differences, with optimizers
 * that move all points together.
 *
 * The event is invoked once for all cells of a type that are to be measured. The observer reads
 * GetCellType() and GetCorners() (a tuple x y z for each corner of each cell, cell after cell) and
 * fills GetValues(), which has a tuple per cell; on failure it calls SetFailure(). Values that are
 * not finite become 0. A planar mesh is seen in its plane (z is 0), counter-clockwise if valid; a
 * volume mesh that is reversed throughout is seen mirrored.
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
   * The facts, as in tautline::MetricDescription. The name consists of lower case letters, digits
   * and underscores; label and symbol are the name by default. They count when AddToRegistry() is
   * called.
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
  /// Whether the value of a cell does not change with its size or orientation. Checked.
  void SetInvariances(bool scale, bool rotation);
  ///@{
  /// The VTK types of the cells it is defined on. The default is all six.
  void ClearCellTypes();
  void AddCellType(int type);
  ///@}

  /// Registers the metric. @return false after an error that names what is wrong.
  bool AddToRegistry();
  /// Removes a registered metric. @return false after an error if there is none of the name.
  static bool RemoveFromRegistry(const char* name);
  /// Loads a library that registers metrics. @return "" or what is wrong.
  static std::string LoadLibrary(const char* file);
  /// What was wrong with the libraries of the environment variable TAUTLINE_METRICS, or "".
  static std::string GetLoadErrors();

  ///@{
  /// What the observer works on.
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
