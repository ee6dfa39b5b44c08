// SPDX-License-Identifier: BSD-3-Clause
// The nodes between the corners of curved cells: of all types exact under affine motions, in place
// without a motion, in the straight cell where they were there, and the same for neighbors.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "tautline/Elements/ElementType.h"
#include "tautline/Mesh/FollowingNodes.h"

using namespace tautline;

namespace
{
struct CurvedType
{
  int vtkType, nodes;
};

constexpr CurvedType types[] = { { 22, 6 }, { 34, 7 }, { 23, 8 }, { 28, 9 }, { 30, 6 }, { 24, 10 },
  { 25, 20 }, { 29, 27 }, { 33, 24 }, { 26, 15 }, { 32, 18 }, { 31, 12 }, { 27, 13 }, { 37, 19 },
  { 69, 10 }, { 70, 16 }, { 71, 20 }, { 72, 64 }, { 73, 40 } };

/// A cell whose nodes are moved at random from the nodes of a straight one.
MeshData curvedCell(const CurvedType& of, double size)
{
  const ElementType& type = ElementType::ofVtk(of.vtkType, of.nodes);
  Random random(11);
  MeshData data;
  std::vector<Index> nodes;
  for (const Vec3& u : type.coordinates())
  {
    // Pyramids are described by the cube that collapses to them.
    const double shrink = type.shape() == ElementShape::Pyramid ? 1 - u[2] : 1;
    Vec3 p = { 2 * shrink * u[0] + 0.3 * u[2], shrink * u[1] - 0.2 * u[2], 1.5 * u[2] };
    for (int c = 0; c < type.dimension(); ++c)
    {
      p[c] += random.uniform(-size, size);
    }
    nodes.push_back(data.addPoint(p));
  }
  data.addCell(of.vtkType, nodes);
  return data;
}

Vec3 affine(const Vec3& p)
{
  return { 1.3 * p[0] + 0.2 * p[1] - 0.3 * p[2] - 1, -0.9 * p[0] + 0.8 * p[1] + 2,
    0.1 * p[0] + 1.1 * p[2] + 0.5 };
}

Index cornersOf(const CurvedType& type)
{
  return topology(cornerType(type.vtkType)).nodes;
}

/// The points with corners moved by a map, and the other nodes placed.
std::vector<double> follow(const MeshData& data, Index corners, Vec3 (*motion)(const Vec3&))
{
  MeshData moved = data;
  for (Index i = 0; i < corners; ++i)
  {
    moved.setPoint(i, motion(data.point(i)));
  }
  FollowingNodes(Mesh(data.view())).place(data.points.data(), moved.points);
  return moved.points;
}

TAUTLINE_PART(testAffine)
{
  for (const CurvedType& type : types)
  {
    const Context context("VTK type " + std::to_string(type.vtkType));
    const MeshData data = curvedCell(type, 0.05);
    const std::vector<double> moved = follow(data, cornersOf(type), affine);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 expected = affine(data.point(i));
      TAUTLINE_EACH(int, c, 3, TAUTLINE_CHECK_NEAR(moved[3 * i + c], expected[c], 1e-12));
    }
    const auto rest = [](const Vec3& p) { return p; };
    TAUTLINE_CHECK(follow(data, cornersOf(type), rest) == data.points);
    const FollowingNodes nodes(Mesh(data.view()));
    TAUTLINE_CHECK_EQUAL(
      static_cast<Index>(nodes.points().size()), data.numberOfPoints() - cornersOf(type));
  }
}

/// Nodes of a straight cell are where the new straight cell has them, whatever the motion.
TAUTLINE_PART(testStraight)
{
  for (const CurvedType& type : types)
  {
    const Context context("VTK type " + std::to_string(type.vtkType));
    const MeshData data = curvedCell(type, 0);
    const auto bend = [](const Vec3& p) {
      return p + Vec3{ 0.2 * p[0] * p[1], 0.1 * p[1] * p[1], 0.1 * p[0] * p[2] };
    };
    const std::vector<double> moved = follow(data, cornersOf(type), bend);
    const ElementType& element = ElementType::ofVtk(type.vtkType, type.nodes);
    const std::vector<Vec3>& at = element.coordinates();
    const ElementType straight(
      element.shape(), { 1, 1, 1 }, { at.begin(), at.begin() + cornersOf(type) });
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const std::vector<double> value = straight.shapeFunctions(at[i]);
      Vec3 expected = { 0, 0, 0 };
      TAUTLINE_EACH(std::size_t, k, value.size(), expected += value[k] * bend(data.point(k)));
      TAUTLINE_EACH(int, c, 3, TAUTLINE_CHECK_NEAR(moved[3 * i + c], expected[c], 1e-12));
    }
  }
}

/// Bent blocks: nodes of the boundary are known, and the result does not depend on the threads.
TAUTLINE_PART(testBlocks)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const bool flat = type == CellType::Triangle;
    constexpr Index n = 3;
    MeshData data = shuffled(quadraticOf(blockMesh(type, n, n, flat ? 0 : n)), 5);
    const FollowingNodes nodes(Mesh(data.view()));
    const Vec3 high = { n, n, flat ? 1.0 : n }, low = { 0, 0, flat ? -1.0 : 0.0 };
    for (const Index i : nodes.points())
    {
      const Vec3 p = data.point(i);
      bool on = false;
      TAUTLINE_EACH(int, c, 3, on = on || p[c] == low[c] || p[c] == high[c]);
      TAUTLINE_CHECK_EQUAL(nodes.boundary()[i] != 0, on);
    }
    Random random(3);
    MeshData moved = data;
    moved.transform([&](const Vec3& p) { return p + random.vector(-0.1, flat ? 0.0 : 0.1); });
    std::vector<double> one = moved.points, four = moved.points;
    nodes.place(data.points.data(), one, 1);
    nodes.place(data.points.data(), four, 4);
    TAUTLINE_CHECK(one == four);
    // Middle of the new edges: the block is straight.
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      const CellTopology& t = topology(type);
      const std::vector<Index> of = data.nodes(cell);
      for (int e = 0; e < t.edges; ++e)
      {
        const Vec3 middle =
          0.5 * (moved.point(of[t.edgeNodes[e][0]]) + moved.point(of[t.edgeNodes[e][1]]));
        TAUTLINE_EACH(
          int, c, 3, TAUTLINE_CHECK_NEAR(one[3 * of[t.nodes + e] + c], middle[c], 1e-14));
      }
    }
  }
}

/// Two triangles with points of their own on the edge between them.
TAUTLINE_PART(testSeam)
{
  MeshData data;
  data.addPoints(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 }, { 0.6, 0.6, 0 }, { 0, 0.5, 0 },
      { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 1, 0.5, 0 }, { 0.5, 1, 0 }, { 0.6, 0.6, 0 } });
  data.addCell(QuadraticTriangle, { 0, 1, 2, 3, 4, 5 });
  data.addCell(QuadraticTriangle, { 6, 7, 8, 9, 10, 11 });
  const std::vector<Index> one = { 0, 1, 2, 3, 4, 5, 1, 7, 2, 9, 10, 11 };
  const FollowingNodes apart(Mesh(data.view())), joined(Mesh(data.view()), nullptr, one);
  TAUTLINE_CHECK_EQUAL(apart.points().size(), 6u);
  TAUTLINE_CHECK_EQUAL(joined.points().size(), 5u);
  TAUTLINE_CHECK(apart.boundary()[4] != 0 && joined.boundary()[4] == 0);
  MeshData moved = data;
  moved.setPoint(0, { -2, 0.3, 0 });
  moved.setPoint(7, { 1.3, 1.2, 0 });
  std::vector<double> points = moved.points;
  joined.place(data.points.data(), points);
  TAUTLINE_EACH(int, c, 3, TAUTLINE_CHECK_EQUAL(points[3 * 4 + c], points[3 * 11 + c]));
  apart.place(data.points.data(), points);
  TAUTLINE_CHECK(points[3 * 4] != points[3 * 11]);
}

TAUTLINE_PART(testUnsupported)
{
  constexpr int lagrangeTriangle = 69;
  MeshData data;
  data.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } });
  data.addCell(lagrangeTriangle, { 0, 1, 2, 3 });
  TAUTLINE_CHECK_THROWS(FollowingNodes(Mesh(data.view())), wording("the-vtk-type-69-with-4-nodes"));
}
}
