// SPDX-License-Identifier: BSD-3-Clause
#include "WarpWalls.h"

#include "tautline/Core/Interruption.h"

#include <Eigen/Dense>

#include <algorithm>

namespace tautline
{
namespace
{
/// The weight of the identity in the rotation fit, so that edges that do not determine the
/// rotation, as on a straight line, turn as little as possible; far above rounding and far below
/// any edge.
constexpr double LeastTurn = 1e-9;

/// Sums over the edges and faces at a prescribed point.
struct WallSums
{
  Eigen::Matrix3d turn =
    Eigen::Matrix3d::Zero(); ///< of the products of directions after and before the motion
  double edges = 0, lengths = 0;
};

/// The smallest height of the corners of a cell, each above its largest side.
double smallestHeight(const CellTopology& t, const Vec3* p)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (int c = 0; c < t.corners; ++c)
  {
    const auto& corner = t.cornerNodes[c];
    const Vec3 a = p[corner[1]] - p[corner[0]], b = p[corner[2]] - p[corner[0]];
    const Vec3 normal = cross(a, b);
    double size = norm(normal), side = std::max(norm(a), norm(b));
    if (t.dimension == 3)
    {
      const Vec3 d = p[corner[3]] - p[corner[0]];
      side = std::max({ size, norm(cross(b, d)), norm(cross(d, a)) });
      size = std::abs(dot(normal, d));
    }
    smallest = side > 0 ? std::min(smallest, size / side) : smallest;
  }
  return smallest;
}

/// Adds a direction before and after the motion, both of length 1; does nothing if one vanishes.
void addDirection(const Vec3& before, const Vec3& after, Eigen::Matrix3d& sum)
{
  const double lengths = norm(before) * norm(after);
  if (lengths > 0)
  {
    sum += Eigen::Map<const Eigen::Vector3d>(after.data()) *
      Eigen::Map<const Eigen::Vector3d>(before.data()).transpose() / lengths;
  }
}

/// The rotation nearest to a sum of products (Kabsch).
std::array<Vec3, 3> rotationOf(Eigen::Matrix3d sum)
{
  sum += LeastTurn * std::max(sum.norm(), std::numeric_limits<double>::min()) *
    Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  std::array<Vec3, 3> columns;
  for (int k = 0; k < 3; ++k)
  {
    columns[k] = { rotation(0, k), rotation(1, k), rotation(2, k) };
  }
  return columns;
}

/// Computes the walls of a mesh, cell by cell.
class WallMaker
{
public:
  WallMaker(
    const Mesh& mesh, const std::vector<unsigned char>& prescribed, const double* displacement)
    : Input(mesh)
    , Prescribed(prescribed)
    , Displacement(displacement)
    , Walls(prescribed.size())
    , Sums(prescribed.size())
  {
  }

  void add(const CellTopology& t, const Index* node)
  {
    const MeshView& view = this->Input.view();
    Vec3 p[MaxNodes];
    int given = 0;
    for (int k = 0; k < t.nodes; ++k)
    {
      p[k] = pointOf(view, node[k]);
      given += this->Prescribed[node[k]] != 0;
    }
    if (given == 0)
    {
      return;
    }
    const double height = smallestHeight(t, p);
    for (int k = 0; k < t.nodes; ++k)
    {
      WallPoint& wall = this->Walls[node[k]];
      wall.height = this->Prescribed[node[k]] ? std::min(wall.height, height) : wall.height;
    }
    for (int e = 0; e < t.edges; ++e)
    {
      this->addEdge(t, node[t.edgeNodes[e][0]], node[t.edgeNodes[e][1]]);
    }
    for (int f = 0; f < t.faces && given >= 3; ++f)
    {
      this->addFace(t.faceSizes[f], t.faceNodes[f].data(), node);
    }
  }

  std::vector<WallPoint> walls()
  {
    const bool planar = this->Input.dimension() == Dimension::Planar;
    const double power = this->Input.dimension() == Dimension::Volume ? 2.0 : 1.0;
    for (std::size_t i = 0; i < this->Walls.size(); ++i)
    {
      WallSums& sums = this->Sums[i];
      if (!this->Prescribed[i] || !(sums.edges > 0))
      {
        continue;
      }
      if (planar)
      {
        addDirection(this->Input.normal(), this->Input.normal(), sums.turn);
      }
      WallPoint& wall = this->Walls[i];
      wall.turn = rotationOf(sums.turn);
      wall.area = wall.area > 0 ? wall.area : std::pow(sums.lengths / sums.edges, power);
    }
    return std::move(this->Walls);
  }

private:
  Vec3 moved(Index i) const
  {
    const double* d = this->Displacement + 3 * i;
    return pointOf(this->Input.view(), i) + Vec3{ d[0], d[1], d[2] };
  }

  void addEdge(const CellTopology& t, Index a, Index b)
  {
    if (!this->Prescribed[a] && !this->Prescribed[b])
    {
      return;
    }
    const Vec3 before = pointOf(this->Input.view(), b) - pointOf(this->Input.view(), a);
    const bool both = this->Prescribed[a] && this->Prescribed[b];
    const Vec3 after = both ? this->moved(b) - this->moved(a) : before;
    for (const Index i : { a, b })
    {
      WallSums& sums = this->Sums[i];
      sums.edges += 1;
      sums.lengths += norm(before);
      if (both)
      {
        addDirection(before, after, sums.turn);
        this->Walls[i].area += t.dimension == 2 ? 0.5 * norm(before) : 0.0;
      }
    }
  }

  void addFace(int size, const int* face, const Index* node)
  {
    Vec3 before[MaxFaceNodes], after[MaxFaceNodes];
    for (int k = 0; k < size; ++k)
    {
      const Index i = node[face[k]];
      if (!this->Prescribed[i])
      {
        return;
      }
      before[k] = pointOf(this->Input.view(), i);
      after[k] = this->moved(i);
    }
    const CellTopology& t = topology(size == 3 ? CellType::Triangle : CellType::Quadrilateral);
    const Vec3 normal = vectorArea(t, before), turned = vectorArea(t, after);
    for (int k = 0; k < size; ++k)
    {
      const Index i = node[face[k]];
      addDirection(normal, turned, this->Sums[i].turn);
      this->Walls[i].area += 0.5 * norm(normal) / size;
    }
  }

  const Mesh& Input;
  const std::vector<unsigned char>& Prescribed;
  const double* Displacement;
  std::vector<WallPoint> Walls;
  std::vector<WallSums> Sums;
};
}

//------------------------------------------------------------------------------
std::vector<WallPoint> wallPoints(
  const Mesh& mesh, const std::vector<unsigned char>& prescribed, const double* displacement)
{
  const MeshView& view = mesh.view();
  WallMaker maker(mesh, prescribed, displacement);
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != (mesh.dimension() == Dimension::Volume ? 3 : 2))
    {
      continue;
    }
    for (Index i = 0; i < block.count; ++i)
    {
      pollInterruption(i);
      maker.add(t, view.connectivity + view.offsets[block.cell(i)]);
    }
  }
  return maker.walls();
}
}
