// SPDX-License-Identifier: BSD-3-Clause
#include "ElementType.h"

#include "VtkElement.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

namespace tautline
{
namespace
{
/// A dense matrix, row by row.
struct DenseMatrix
{
  int rows, columns;
  std::vector<long double> values;

  DenseMatrix(int m, int n)
    : rows(m)
    , columns(n)
    , values(static_cast<std::size_t>(m) * n)
  {
  }
  long double* operator[](int row) { return this->values.data() + row * this->columns; }
};

/// Replaces b by A^-1 b, by Gaussian elimination with row pivots; false if A is singular.
bool solve(DenseMatrix a, DenseMatrix& b)
{
  constexpr long double singular = 1e-12L;
  for (int k = 0; k < a.rows; ++k)
  {
    int pivot = k;
    for (int i = k + 1; i < a.rows; ++i)
    {
      pivot = std::abs(a[i][k]) > std::abs(a[pivot][k]) ? i : pivot;
    }
    if (!(std::abs(a[pivot][k]) > singular))
    {
      return false;
    }
    if (pivot != k)
    {
      std::swap_ranges(a[k], a[k] + a.columns, a[pivot]);
      std::swap_ranges(b[k], b[k] + b.columns, b[pivot]);
    }
    for (int i = 0; i < a.rows; ++i)
    {
      const long double factor = i == k ? 0 : a[i][k] / a[k][k];
      for (int j = k; j < a.columns && factor != 0; ++j)
      {
        a[i][j] -= factor * a[k][j];
      }
      for (int j = 0; j < b.columns && factor != 0; ++j)
      {
        b[i][j] -= factor * b[k][j];
      }
    }
  }
  for (int k = 0; k < a.rows; ++k)
  {
    std::transform(b[k], b[k] + b.columns, b[k], [&](long double x) { return x / a[k][k]; });
  }
  return true;
}

/// The points exponents / degree, each of which is the maximum of a Bernstein polynomial: they
/// determine a polynomial of the space.
std::vector<std::array<long double, 3>> latticeOf(const BernsteinSpace& space)
{
  std::vector<std::array<long double, 3>> points(space.size());
  for (int k = 0; k < space.size(); ++k)
  {
    points[k] = { 0, 0, 0 };
    for (std::size_t f = 0; f < space.factors().size(); ++f)
    {
      const BernsteinFactor& factor = space.factors()[f];
      for (int c = 0; c < factor.dimension; ++c)
      {
        const int coordinate = space.firstCoordinate(static_cast<int>(f)) + c;
        points[k][coordinate] =
          static_cast<long double>(space.exponents(k)[coordinate]) / factor.degree;
      }
    }
  }
  return points;
}

/// The Bernstein coefficients of the functions of a basis, one column per function.
DenseMatrix coefficientsOf(const BernsteinSpace& space, const ElementBasis& basis)
{
  const int size = space.size(), count = static_cast<int>(basis.functions.size());
  DenseMatrix collocation(size, size), result(size, count);
  const std::vector<std::array<long double, 3>> points = latticeOf(space);
  for (int i = 0; i < size; ++i)
  {
    const std::vector<long double> row = space.valuesAt(points[i]);
    std::copy(row.begin(), row.end(), collocation[i]);
    for (int j = 0; j < count; ++j)
    {
      result[i][j] = basis.value(j, points[i]);
    }
  }
  solve(collocation, result);
  return result;
}

void appendRow(ControlMatrix& matrix, const long double* row, int columns)
{
  // Entries are fractions with small denominators; smaller numbers are rounding errors.
  constexpr long double nothing = 1e-14L;
  double sum = 0;
  for (int j = 0; j < columns; ++j)
  {
    if (std::abs(row[j]) > nothing)
    {
      matrix.columns.push_back(j);
      matrix.values.push_back(static_cast<double>(row[j]));
      sum += std::abs(matrix.values.back());
    }
  }
  matrix.norm = std::max(matrix.norm, sum);
  matrix.longest =
    std::max(matrix.longest, static_cast<int>(matrix.columns.size()) - matrix.offsets.back());
  matrix.offsets.push_back(static_cast<int>(matrix.columns.size()));
}

/// The values of the functions of the basis at the nodes, by node. Without functions, the Bernstein
/// polynomials themselves are the basis.
DenseMatrix valuesAtNodes(const VtkElement& element, const BernsteinSpace& space)
{
  const ElementBasis& basis = element.basis;
  const int count = static_cast<int>(element.coordinates.size());
  DenseMatrix values(count, count);
  for (int i = 0; i < count; ++i)
  {
    const Vec3& node = element.coordinates[i];
    const std::array<long double, 3> at = { node[0], node[1], node[2] };
    const std::vector<long double> bernstein = space.valuesAt(at);
    for (int j = 0; j < count; ++j)
    {
      values[i][j] = basis.functions.empty() ? bernstein[j] : basis.value(j, at);
    }
    if (element.controlPoints)
    {
      // The coefficient of the polynomial that has its maximum at the node.
      std::fill_n(values[i], count, 0.0L);
      values[i][std::max_element(bernstein.begin(), bernstein.end()) - bernstein.begin()] = 1;
    }
  }
  return values;
}
}

//------------------------------------------------------------------------------
ElementType::ElementType(
  ElementShape shape, const ElementOrders& orders, const std::vector<Vec3>& coordinates)
  : ElementType(VtkElement{ shape, orders, coordinates, completeBasis(shape, orders), false })
{
}

//------------------------------------------------------------------------------
const ElementType& ElementType::ofVtk(int vtkType, int nodes, const ElementOrders& orders)
{
  static std::mutex mutex;
  static std::map<std::tuple<int, int, ElementOrders>, std::unique_ptr<const ElementType>> types;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = types.find({ vtkType, nodes, orders });
  if (found != types.end())
  {
    return *found->second;
  }
  std::unique_ptr<const ElementType> type(new ElementType(vtkElement(vtkType, nodes, orders)));
  return *types.emplace(std::make_tuple(vtkType, nodes, orders), std::move(type)).first->second;
}

//------------------------------------------------------------------------------
ElementType::ElementType(const VtkElement& element)
  : Shape(element.shape)
  , Orders(element.orders)
  , Coordinates(element.coordinates)
  , Space(element.basis.factors)
{
  const ElementBasis& basis = element.basis;
  const int size = this->Space.size(), count = this->nodes();
  const int functions = basis.functions.empty() ? size : static_cast<int>(basis.functions.size());
  if (functions != count)
  {
    const ElementOrders& p = element.orders;
    throw Error("An element with the orders " + std::to_string(p[0]) + ", " + std::to_string(p[1]) +
      ", " + std::to_string(p[2]) + " has " + std::to_string(functions) + " nodes, not " +
      std::to_string(count) + "; specify the orders of the element.");
  }
  // The control points are coefficients * values^-1 * nodes.
  DenseMatrix inverse(count, count);
  for (int i = 0; i < count; ++i)
  {
    inverse[i][i] = 1;
  }
  if (!solve(valuesAtNodes(element, this->Space), inverse))
  {
    throw Error("The nodes of an element do not determine its polynomials; specify distinct "
                "reference coordinates for all nodes.");
  }
  if (basis.functions.empty())
  {
    for (int k = 0; k < size; ++k)
    {
      appendRow(this->Controls, inverse[k], count);
    }
  }
  else
  {
    DenseMatrix coefficients = coefficientsOf(this->Space, basis);
    std::vector<long double> row(count);
    for (int k = 0; k < size; ++k)
    {
      std::fill(row.begin(), row.end(), 0.0L);
      for (int f = 0; f < count; ++f)
      {
        for (int j = 0; j < count; ++j)
        {
          row[j] += coefficients[k][f] * inverse[f][j];
        }
      }
      appendRow(this->Controls, row.data(), count);
    }
  }
  this->Determinant = DeterminantForm(this->Space, this->Shape == ElementShape::Pyramid);
}

//------------------------------------------------------------------------------
std::vector<double> ElementType::shapeFunctions(const Vec3& at) const
{
  const std::vector<long double> bernstein = this->Space.valuesAt({ at[0], at[1], at[2] });
  std::vector<double> values(this->Coordinates.size());
  for (int k = 0; k < this->Controls.rows(); ++k)
  {
    for (int e = this->Controls.offsets[k]; e < this->Controls.offsets[k + 1]; ++e)
    {
      values[this->Controls.columns[e]] +=
        static_cast<double>(bernstein[k]) * this->Controls.values[e];
    }
  }
  return values;
}
}
