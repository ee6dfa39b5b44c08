// SPDX-License-Identifier: BSD-3-Clause
// The elements of all shapes and orders against the cells of VTK: places of nodes, shape functions.
#include "Registry.h"

#include "tautline/Core/Random.h"
#include "tautline/Elements/ElementType.h"

#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkHigherOrderHexahedron.h"
#include "vtkHigherOrderQuadrilateral.h"
#include "vtkHigherOrderWedge.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"

#include <thread>

using namespace tautline;

namespace
{
constexpr double rounding = 1e-12;

struct CellKind
{
  int vtkType;
  int nodes;
  ElementOrders orders = { 0, 0, 0 };
};

/// A VTK cell with points at the nodes of the element.
vtkSmartPointer<vtkCell> makeCell(const CellKind& kind, const ElementType& element)
{
  auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(kind.vtkType));
  cell->GetPointIds()->SetNumberOfIds(kind.nodes);
  cell->GetPoints()->SetNumberOfPoints(kind.nodes);
  for (int k = 0; k < kind.nodes; ++k)
  {
    cell->GetPointIds()->SetId(k, k);
    cell->GetPoints()->SetPoint(k, element.coordinates()[k].data());
  }
  const ElementOrders& p = element.orders();
  if (auto* quadrilateral = dynamic_cast<vtkHigherOrderQuadrilateral*>(cell.Get()))
  {
    quadrilateral->SetOrder(p[0], p[1]);
  }
  if (auto* hexahedron = dynamic_cast<vtkHigherOrderHexahedron*>(cell.Get()))
  {
    hexahedron->SetOrder(p[0], p[1], p[2]);
  }
  if (auto* wedge = dynamic_cast<vtkHigherOrderWedge*>(cell.Get()))
  {
    wedge->SetOrder(p[0], p[1], p[2], kind.nodes);
  }
  cell->Initialize();
  return cell;
}

/// VTK's parametric coordinates of a place: the pyramid with 19 nodes uses the pyramid
/// between the planes t = 1/2 and t = 1.
Vec3 parametric(const CellKind& kind, const Vec3& at)
{
  if (kind.vtkType != VTK_TRIQUADRATIC_PYRAMID)
  {
    return at;
  }
  const double h = 1 - at[2];
  return { 0.5 + h * (at[0] - 0.5), 0.5 + h * (at[1] - 0.5), 0.5 + 0.5 * at[2] };
}

void testAgainstVtk(const CellKind& kind)
{
  const Context context(
    "VTK type " + std::to_string(kind.vtkType) + ", " + std::to_string(kind.nodes) + " nodes");
  const ElementType& element = ElementType::ofVtk(kind.vtkType, kind.nodes, kind.orders);
  const vtkSmartPointer<vtkCell> cell = makeCell(kind, element);
  TAUTLINE_CHECK_EQUAL(element.nodes(), kind.nodes);
  const double* expected = cell->GetParametricCoords();
  TAUTLINE_CHECK(expected != nullptr);
  for (int k = 0; expected && k < kind.nodes; ++k)
  {
    const Context node("node " + std::to_string(k));
    const Vec3 at = parametric(kind, element.coordinates()[k]);
    // The parameters u and v of the apex are free.
    const bool apex = element.shape() == ElementShape::Pyramid && element.coordinates()[k][2] == 1;
    for (int c = apex ? 2 : 0; c < 3; ++c)
    {
      TAUTLINE_CHECK_NEAR(at[c], expected[3 * k + c], rounding);
    }
  }
  SplitMix random(1, static_cast<std::uint64_t>(kind.vtkType), kind.nodes);
  std::vector<double> weights(kind.nodes);
  for (int n = 0; n < 10; ++n)
  {
    Vec3 at = { random.uniform(), random.uniform(), random.uniform() };
    if (element.dimension() == 2)
    {
      at[2] = 0;
    }
    const Vec3 own = parametric(kind, at);
    cell->InterpolateFunctions(own.data(), weights.data());
    const std::vector<double> values = element.shapeFunctions(at);
    for (int k = 0; k < kind.nodes; ++k)
    {
      TAUTLINE_CHECK_NEAR(values[k], weights[k], 1e-10);
    }
  }
}
}

TAUTLINE_PART(testLinearAndQuadratic)
{
  for (const CellKind& kind :
    std::vector<CellKind>{ { VTK_TRIANGLE, 3 }, { VTK_QUAD, 4 }, { VTK_TETRA, 4 },
      { VTK_HEXAHEDRON, 8 }, { VTK_WEDGE, 6 }, { VTK_PYRAMID, 5 }, { VTK_QUADRATIC_TRIANGLE, 6 },
      { VTK_QUADRATIC_QUAD, 8 }, { VTK_QUADRATIC_TETRA, 10 }, { VTK_QUADRATIC_HEXAHEDRON, 20 },
      { VTK_QUADRATIC_WEDGE, 15 }, { VTK_QUADRATIC_PYRAMID, 13 }, { VTK_BIQUADRATIC_QUAD, 9 },
      { VTK_TRIQUADRATIC_HEXAHEDRON, 27 }, { VTK_QUADRATIC_LINEAR_QUAD, 6 },
      { VTK_QUADRATIC_LINEAR_WEDGE, 12 }, { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18 },
      { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24 }, { VTK_BIQUADRATIC_TRIANGLE, 7 },
      { VTK_TRIQUADRATIC_PYRAMID, 19 } })
  {
    testAgainstVtk(kind);
  }
}

TAUTLINE_PART(testLagrange)
{
  for (int p = 1; p <= 5; ++p)
  {
    const int line = p + 1, triangle = line * (p + 2) / 2;
    testAgainstVtk({ VTK_LAGRANGE_TRIANGLE, triangle });
    testAgainstVtk({ VTK_LAGRANGE_QUADRILATERAL, line * line });
    testAgainstVtk({ VTK_LAGRANGE_TETRAHEDRON, triangle * (p + 3) / 3 });
    testAgainstVtk({ VTK_LAGRANGE_HEXAHEDRON, line * line * line });
    testAgainstVtk({ VTK_LAGRANGE_WEDGE, triangle * line });
  }
}

TAUTLINE_PART(testOrdersByAxis)
{
  for (int p = 1; p <= 4; ++p)
  {
    for (int q = 1; q <= 4; ++q)
    {
      testAgainstVtk({ VTK_LAGRANGE_QUADRILATERAL, (p + 1) * (q + 1), { p, q, 0 } });
      testAgainstVtk({ VTK_LAGRANGE_WEDGE, (p + 1) * (p + 2) / 2 * (q + 1), { p, p, q } });
      const int r = (p + q) % 4 + 1;
      testAgainstVtk({ VTK_LAGRANGE_HEXAHEDRON, (p + 1) * (q + 1) * (r + 1), { p, q, r } });
    }
  }
}

TAUTLINE_PART(testBubbles)
{
  testAgainstVtk({ VTK_LAGRANGE_TRIANGLE, 7 });
  testAgainstVtk({ VTK_LAGRANGE_TETRAHEDRON, 15 });
  testAgainstVtk({ VTK_LAGRANGE_WEDGE, 21 });
}

TAUTLINE_PART(testBezier)
{
  for (int p = 1; p <= 4; ++p)
  {
    const int line = p + 1, triangle = line * (p + 2) / 2;
    testAgainstVtk({ VTK_BEZIER_TRIANGLE, triangle });
    testAgainstVtk({ VTK_BEZIER_QUADRILATERAL, line * line });
    testAgainstVtk({ VTK_BEZIER_TETRAHEDRON, triangle * (p + 3) / 3 });
    testAgainstVtk({ VTK_BEZIER_HEXAHEDRON, line * line * line });
    testAgainstVtk({ VTK_BEZIER_WEDGE, triangle * line });
  }
}

/// Nodes at the places of Gauss and Lobatto, in the order of the axes.
TAUTLINE_PART(testNodesAnywhere)
{
  const double places[] = { 0, 0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05), 1 };
  std::vector<Vec3> nodes;
  for (double v : places)
  {
    for (double u : places)
    {
      nodes.push_back({ u, v, 0 });
    }
  }
  const ElementType element(ElementShape::Quadrilateral, { 3, 3, 0 }, nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const std::vector<double> values = element.shapeFunctions(nodes[i]);
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      TAUTLINE_CHECK_NEAR(values[k], i == k ? 1.0 : 0.0, rounding);
    }
  }
  // Quadratic pyramid of 14 nodes: reproduces the coordinates of the pyramid and their squares.
  std::vector<Vec3> pyramid = ElementType::ofVtk(VTK_QUADRATIC_PYRAMID, 13).coordinates();
  pyramid.push_back({ 0.5, 0.5, 0 });
  const ElementType quadratic(ElementShape::Pyramid, { 2, 2, 2 }, pyramid);
  const std::vector<double> values = quadratic.shapeFunctions({ 0.3, 0.6, 0.2 });
  double x = 0, xx = 0, one = 0;
  for (std::size_t k = 0; k < pyramid.size(); ++k)
  {
    const double r = pyramid[k][0] * (1 - pyramid[k][2]);
    one += values[k];
    x += values[k] * r;
    xx += values[k] * r * r;
  }
  TAUTLINE_CHECK_NEAR(one, 1.0, rounding);
  TAUTLINE_CHECK_NEAR(x, 0.24, rounding);
  TAUTLINE_CHECK_NEAR(xx, 0.24 * 0.24, rounding);
}

TAUTLINE_PART(testRejected)
{
  const auto messageOf = [](const auto& work)
  {
    try
    {
      work();
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto message = [&](int type, int nodes, const ElementOrders& orders)
  { return messageOf([&] { ElementType::ofVtk(type, nodes, orders); }); };
  const char* supported = "use linear, quadratic, Lagrange or Bezier cells";
  TAUTLINE_CHECK(contains(message(VTK_POLYGON, 5, {}), supported));
  TAUTLINE_CHECK(contains(message(VTK_LAGRANGE_PYRAMID, 14, {}), supported));
  TAUTLINE_CHECK(contains(message(VTK_QUADRATIC_TETRA, 11, {}), supported));
  TAUTLINE_CHECK(contains(message(VTK_LAGRANGE_TETRAHEDRON, 11, {}), supported));
  TAUTLINE_CHECK(contains(message(VTK_LAGRANGE_HEXAHEDRON, 512, {}), supported));
  TAUTLINE_CHECK(contains(message(VTK_BEZIER_TRIANGLE, 7, {}), supported));
  TAUTLINE_CHECK(
    contains(message(VTK_LAGRANGE_HEXAHEDRON, 27, { 1, 2, 3 }), "correct the array Higher"));
  TAUTLINE_CHECK(
    contains(message(VTK_LAGRANGE_HEXAHEDRON, 32, { 1, 1, 7 }), "use orders of 1 to 6"));
  const auto built = [&](const std::vector<Vec3>& nodes, const ElementOrders& orders)
  { return messageOf([&] { ElementType(ElementShape::Triangle, orders, nodes); }); };
  const std::vector<Vec3> line = { { 0, 0, 0 }, { 0.5, 0, 0 }, { 1, 0, 0 } };
  TAUTLINE_CHECK(contains(built(line, { 1, 1, 0 }), "reference coordinates"));
  TAUTLINE_CHECK(contains(built(line, { 2, 2, 0 }), "has 6 nodes, not 3"));
  TAUTLINE_CHECK(contains(built(line, { 1, 2, 0 }), "equal orders"));
}

TAUTLINE_PART(testThreads)
{
  std::vector<std::thread> threads;
  std::vector<const ElementType*> found(4);
  for (const ElementType*& type : found)
  {
    threads.emplace_back([&type] { type = &ElementType::ofVtk(VTK_LAGRANGE_WEDGE, 126); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  TAUTLINE_EACH_OF(const ElementType* type, found, TAUTLINE_CHECK(type == found[0]));
}
