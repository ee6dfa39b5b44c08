// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointFunction.h
 * @brief A function on the points of a data set: a constant, a point array, or an expression.
 */
#ifndef tautline_PointFunction_h
#define tautline_PointFunction_h

#include "tautline/Core/Types.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataSet;

namespace tautline
{
struct PointFunction
{
  /// The values must not change: ParaView state files contain them.
  enum Kinds
  {
    Constant = 0,
    Array = 1,
    Expression = 2
  };
  std::string what; ///< "source", for messages
  int kind = Constant;
  Vec3 constant = { 0, 0, 0 };
  int arrayIndex = 0; ///< of SetInputArrayToProcess
  std::string expression;

  /// Whether values that are not finite are an error; otherwise they are passed on.
  bool finite = true;

  bool isZero() const { return this->kind == Constant && this->constant == Vec3{ 0, 0, 0 }; }
};

/**
 * @brief The values at all points, `components` (1 or 3) each; the third component of two-component
 * vectors is 0. Throws Error if the array is missing, is a cell array or has other components.
 */
std::vector<double> valuesAt(
  const PointFunction& function, vtkAlgorithm* algorithm, vtkDataSet* data, int components);

/**
 * @brief The values of an expression of x, y, z, of the point arrays by name (vectors also by
 * component: v_X, v_Y, v_Z) and, for vectors, of iHat, jHat, kHat; names with characters other than
 * letters, digits and _ must be in double quotes. Throws Error, quoting the expression, if it is
 * empty, cannot be parsed, or has a wrong number of components, and if a value is not finite,
 * unless that is allowed; the value is then NaN.
 */
std::vector<double> evaluate(const std::string& expression, const std::string& what,
  vtkDataSet* data, int components, bool finite = true);

/**
 * @class tautline::PlaceFunction
 * @brief An expression of x, y, z as a function of position. Throws Error as evaluate() does.
 */
class PlaceFunction
{
public:
  /// @param step of the central differences, in the unit of length
  PlaceFunction(
    const std::string& expression, const std::string& what, int components, double step);

  /// Writes `components` values, and their gradients by central differences, 3 each.
  void evaluate(const Vec3& place, double* values, double* gradients);

private:
  int Components;
  double Step;
  std::function<void(const Vec3& place, double* values)> Values;
};
}
#endif
