// SPDX-License-Identifier: BSD-3-Clause
#include "PointFunction.h"

#include "Blocks.h"

#include "vtkCallbackCommand.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkExprTkFunctionParser.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>

namespace tautline
{
namespace
{
constexpr int VectorSize = 3;
constexpr std::array<const char*, VectorSize> CoordinateNames = { "x", "y", "z" };
constexpr std::array<const char*, VectorSize> ComponentSuffixes = { "_X", "_Y", "_Z" };

/// "(1, 2, 0.5)"
std::string placeOf(vtkDataSet* data, vtkIdType point)
{
  double p[3];
  data->GetPoint(point, p);
  std::ostringstream text;
  text << "(" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  return text.str();
}

/// A variable of the parser and the source of its value at a point.
struct Variable
{
  int index;
  std::function<double(vtkIdType)> value;
};

/// The parser with its variables and its first error.
class Evaluator
{
public:
  Evaluator(const std::string& expression, vtkDataSet* data)
  {
    vtkNew<vtkCallbackCommand> keep;
    keep->SetClientData(this);
    keep->SetCallback(
      [](vtkObject*, unsigned long, void* self, void* text)
      {
        std::string& message = static_cast<Evaluator*>(self)->Message;
        message = message.empty() ? static_cast<const char*>(text) : message;
      });
    this->Parser->AddObserver(vtkCommand::ErrorEvent, keep);
    this->Parser->SetFunction(expression.c_str());
    for (int k = 0; k < VectorSize; ++k)
    {
      this->addScalar(CoordinateNames[k],
        [data, k](vtkIdType i)
        {
          double p[3];
          data->GetPoint(i, p);
          return p[k];
        });
    }
    vtkPointData* arrays = data->GetPointData();
    for (int a = 0; a < arrays->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* array = arrays->GetArray(a);
      const std::string name = array && array->GetName() ? array->GetName() : "";
      // Only arrays whose name occurs are relevant; coordinates come first.
      if (name.empty() || expression.find(name) == std::string::npos ||
        std::find(CoordinateNames.begin(), CoordinateNames.end(), name) != CoordinateNames.end())
      {
        continue;
      }
      if (array->GetNumberOfComponents() == 1)
      {
        this->addScalar(name, [array](vtkIdType i) { return array->GetComponent(i, 0); });
      }
      else if (array->GetNumberOfComponents() == VectorSize)
      {
        for (int k = 0; k < VectorSize; ++k)
        {
          this->addScalar(name + ComponentSuffixes[k],
            [array, k](vtkIdType i) { return array->GetComponent(i, k); });
        }
        this->addVector(name, array);
      }
    }
    this->Message.clear(); // from names that cannot be variables
  }

  /// Sets the variables to the values at a point; after the first point, only the variables needed.
  void moveTo(vtkIdType point)
  {
    for (const Variable& scalar : this->Scalars)
    {
      if (point == 0 || this->Parser->GetScalarVariableNeeded(scalar.index))
      {
        this->Parser->SetScalarVariableValue(scalar.index, scalar.value(point));
      }
    }
    for (std::size_t v = 0; v < this->Vectors.size(); ++v)
    {
      vtkDataArray* array = this->Vectors[v];
      this->Parser->SetVectorVariableValue(static_cast<int>(v), array->GetComponent(point, 0),
        array->GetComponent(point, 1), array->GetComponent(point, 2));
    }
  }

  vtkNew<vtkExprTkFunctionParser> Parser;
  std::string Message;

private:
  static std::string quoted(const std::string& name)
  {
    return vtkExprTkFunctionParser::SanitizeName(name.c_str()) == name ? name : "\"" + name + "\"";
  }

  void addScalar(const std::string& name, std::function<double(vtkIdType)> value)
  {
    this->Parser->SetScalarVariableValue(quoted(name), 0.0);
    const int index = this->Parser->GetScalarVariableIndex(quoted(name));
    if (index >= 0)
    {
      this->Scalars.push_back({ index, std::move(value) });
    }
  }

  void addVector(const std::string& name, vtkDataArray* array)
  {
    this->Parser->SetVectorVariableValue(quoted(name), 0.0, 0.0, 0.0);
    if (this->Parser->GetVectorVariableIndex(quoted(name)) ==
      static_cast<int>(this->Vectors.size()))
    {
      this->Vectors.push_back(array);
    }
  }

  std::vector<Variable> Scalars;
  std::vector<vtkDataArray*> Vectors;
};

/// Extracts the problem from the parser's "... Msg: ERR201 - Undefined symbol: 'q'<tab>Expression:
/// ..." or another message.
std::string plain(std::string message)
{
  const auto after = [&message](const std::string& mark)
  {
    const std::size_t at = message.find(mark);
    message = at == std::string::npos ? message : message.substr(at + mark.size());
  };
  after("): ");
  after("Msg: ");
  after(" - ");
  message = message.substr(0, message.find_first_of("\t\n"));
  return message;
}

/// An expression that is evaluated at the points of a data set.
class Expression
{
public:
  Expression(std::string text, const std::string& what, vtkDataSet* data, int components)
    : Subject("The expression '" + text + "' of the " + what)
    , Text(std::move(text))
    , Data(data)
    , Components(components)
    , Values(checked(this->Text, what, components), data)
  {
  }

  /// Writes NaN instead of throwing an error if the value is not finite.
  void allowInvalid()
  {
    this->Values.Parser->SetReplaceInvalidValues(true);
    this->Values.Parser->SetReplacementValue(std::numeric_limits<double>::quiet_NaN());
  }

  /// Evaluates at a point, the first time at point 0.
  void evaluate(vtkIdType point, double* values)
  {
    this->Values.moveTo(point);
    vtkExprTkFunctionParser* parser = this->Values.Parser;
    const bool scalar = this->Components == 1;
    if (!this->Known && !(scalar ? parser->IsScalarResult() : parser->IsVectorResult()) &&
      this->Values.Message.empty())
    {
      throw Error(this->Subject +
        (scalar ? " is a vector; a number is expected: use a component of it."
                : " is a number; a vector is expected: write (" + this->Text +
              ")*iHat + 0*jHat, for example."));
    }
    this->Known = true;
    if (this->Values.Message.empty())
    {
      const double number = scalar ? parser->GetScalarResult() : 0.0;
      const double* result = scalar ? &number : parser->GetVectorResult();
      std::copy(result, result + this->Components, values);
    }
    if (!this->Values.Message.empty())
    {
      throw Error(this->Values.Message.find("mathematically wrong") == std::string::npos
          ? this->Subject + " is not understood: " + plain(this->Values.Message)
          : this->Subject + " is not finite at point " + std::to_string(point) + ", " +
            placeOf(this->Data, point) + ".");
    }
  }

private:
  static const std::string& checked(
    const std::string& text, const std::string& what, int components)
  {
    if (text.find_first_not_of(" \t\n") == std::string::npos)
    {
      throw Error("The expression of the " + what + " is empty: write one, such as sin(x)*y" +
        (components > 1 ? "*iHat - jHat" : "") + ".");
    }
    return text;
  }

  std::string Subject, Text;
  vtkDataSet* Data;
  int Components;
  Evaluator Values;
  bool Known = false; ///< whether the result has the components
};

/// The expression at any position, using a data set with a single point.
class ExpressionAtPlace
{
public:
  ExpressionAtPlace(const std::string& expression, const std::string& what, int components)
    : Evaluated(expression, what, this->singlePoint(), components)
  {
  }

  void evaluate(const Vec3& place, double* values)
  {
    this->Points->SetPoint(0, place.data());
    this->Evaluated.evaluate(0, values);
  }

private:
  vtkDataSet* singlePoint()
  {
    this->Points->SetDataTypeToDouble();
    this->Points->InsertNextPoint(0.0, 0.0, 0.0);
    this->Data->SetPoints(this->Points);
    return this->Data;
  }

  vtkNew<vtkPoints> Points;
  vtkNew<vtkPolyData> Data;
  Expression Evaluated;
};
}

//------------------------------------------------------------------------------
std::vector<double> evaluate(const std::string& expression, const std::string& what,
  vtkDataSet* data, int components, bool finite)
{
  Expression evaluated(expression, what, data, components);
  if (!finite)
  {
    evaluated.allowInvalid();
  }
  const vtkIdType count = data->GetNumberOfPoints();
  std::vector<double> values(static_cast<std::size_t>(components) * count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    evaluated.evaluate(i, values.data() + components * i);
  }
  return values;
}

//------------------------------------------------------------------------------
PlaceFunction::PlaceFunction(
  const std::string& expression, const std::string& what, int components, double step)
  : Components(components)
  , Step(step)
{
  const auto evaluated = std::make_shared<ExpressionAtPlace>(expression, what, components);
  this->Values = [evaluated](const Vec3& place, double* values)
  { evaluated->evaluate(place, values); };
}

//------------------------------------------------------------------------------
void PlaceFunction::evaluate(const Vec3& place, double* values, double* gradients)
{
  this->Values(place, values);
  for (int k = 0; k < VectorSize; ++k)
  {
    double before[VectorSize], after[VectorSize];
    Vec3 moved = place;
    moved[k] = place[k] - this->Step;
    this->Values(moved, before);
    moved[k] = place[k] + this->Step;
    this->Values(moved, after);
    for (int c = 0; c < this->Components; ++c)
    {
      gradients[VectorSize * c + k] = (after[c] - before[c]) / (2.0 * this->Step);
    }
  }
}

//------------------------------------------------------------------------------
std::vector<double> valuesAt(
  const PointFunction& function, vtkAlgorithm* algorithm, vtkDataSet* data, int components)
{
  const vtkIdType count = data->GetNumberOfPoints();
  if (count == 0)
  {
    return {};
  }
  if (function.kind == PointFunction::Expression)
  {
    return evaluate(function.expression, function.what, data, components, function.finite);
  }
  std::vector<double> values(static_cast<std::size_t>(components) * count);
  if (function.kind == PointFunction::Constant)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = function.constant[i % components];
    }
    return values;
  }
  const std::string purpose = "to take the " + function.what + " from";
  vtkDataArray* array =
    chosenArray(algorithm, function.arrayIndex, data, purpose.c_str(), ArrayOf::Points);
  if (!array)
  {
    throw Error("No array is chosen " + purpose + ": choose one, or a constant or an expression.");
  }
  const std::string subject =
    "The array '" + std::string(array->GetName()) + "' of the " + function.what;
  const int has = array->GetNumberOfComponents();
  if (components == 1 ? has != 1 : has != 2 && has != 3)
  {
    throw Error(subject + " has " + std::to_string(has) + " components; " +
      (components == 1 ? "one is" : "two or three are") + " expected.");
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    for (int k = 0; k < std::min(has, components); ++k)
    {
      values[components * i + k] = array->GetComponent(i, k);
      if (function.finite && !std::isfinite(values[components * i + k]))
      {
        throw Error(
          subject + " is not finite at point " + std::to_string(i) + ", " + placeOf(data, i) + ".");
      }
    }
  }
  return values;
}
}
