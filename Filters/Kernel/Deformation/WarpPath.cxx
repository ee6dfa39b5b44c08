// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPath.h"

#include "tautline/Core/UnionFind.h"

#include <Eigen/Dense>

namespace tautline
{
namespace
{
using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

/// Extents below this fraction of the largest are treated as 0: the points lie in a plane or on a
/// line.
constexpr double FlatExtent = 1e-6;
/// The largest residual of an affine map, as a fraction of the displacements (root mean square).
constexpr double AffineResidual = 0.05;

/// The connected component of each point, -1 if it is not prescribed. Points are connected by
/// facets (edges of planar cells) all of whose points are prescribed. Components are numbered by
/// their smallest points.
std::vector<Index> findPieces(const Mesh& mesh, const WarpParts& parts, std::size_t& pieces)
{
  const std::vector<unsigned char>& prescribed = parts.prescribed();
  const MeshView& view = mesh.view();
  const Index n = view.numberOfPoints;
  UnionFind sets(n);
  const auto join = [&](const Index* nodes, int count, const auto& local)
  {
    for (int k = 0; k < count; ++k)
    {
      if (!prescribed[nodes[local(k)]])
      {
        return;
      }
    }
    for (int k = 1; k < count; ++k)
    {
      sets.join(nodes[local(0)], nodes[local(k)]);
    }
  };
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* nodes = view.connectivity + view.offsets[block.cell(i)];
      for (int f = 0; f < t.faces; ++f)
      {
        join(nodes, t.faceSizes[f], [&](int k) { return t.faceNodes[f][k]; });
      }
      for (int e = 0; t.dimension == 2 && e < t.edges; ++e)
      {
        join(nodes, 2, [&](int k) { return t.edgeNodes[e][k]; });
      }
    }
  }
  Index count = 0;
  std::vector<Index> pieceOf = parts.ranks().numberSets(sets, prescribed, count);
  pieces = static_cast<std::size_t>(count);
  return pieceOf;
}

/// Means and second moments of the points of a component and of their displacements.
struct PathMoments
{
  double count = 0;
  Vector center = Vector::Zero(), shift = Vector::Zero();
  Matrix points = Matrix::Zero(); ///< sum of x x^T, from the mean
  Matrix mixed = Matrix::Zero();  ///< sum of d x^T
  double moved = 0;               ///< sum of |d|^2
};

std::vector<PathMoments> momentsOf(const MeshView& view, const std::vector<Index>& pieceOf,
  std::size_t pieces, const double* displacement, const Ranks& ranks)
{
  std::vector<PathMoments> moments(pieces);
  const auto forEach = [&](const auto& visit)
  {
    for (Index i = 0; i < view.numberOfPoints; ++i)
    {
      if (pieceOf[i] >= 0 && ranks.owns(i))
      {
        visit(moments[pieceOf[i]], Eigen::Map<const Vector>(view.points + 3 * i),
          Eigen::Map<const Vector>(displacement + 3 * i));
      }
    }
  };
  forEach(
    [](PathMoments& m, const auto& x, const auto& d)
    {
      m.count += 1;
      m.center += x;
      m.shift += d;
    });
  constexpr std::size_t components = 3;
  addUp(ranks, moments,
    [](PathMoments& m) {
      return std::array<double*, 3>{ &m.count, m.center.data(), m.shift.data() };
    },
    { 1, components, components });
  for (PathMoments& m : moments)
  {
    m.center /= m.count;
    m.shift /= m.count;
  }
  forEach(
    [](PathMoments& m, const auto& x, const auto& d)
    {
      const Vector a = x - m.center, b = d - m.shift;
      m.points += a * a.transpose();
      m.mixed += b * a.transpose();
      m.moved += b.squaredNorm();
    });
  addUp(ranks, moments,
    [](PathMoments& m) {
      return std::array<double*, 3>{ m.points.data(), m.mixed.data(), &m.moved };
    },
    { components * components, components * components, 1 });
  return moments;
}

/// Completes a map that is only defined in a plane: the normal rotates with the plane. False if the
/// plane collapses to a line, or a planar mesh is mirrored.
bool completePlane(const Matrix& axes, bool planarMesh, Matrix& map)
{
  const Vector normal = axes.col(0);
  const Vector u = map * axes.col(1), v = map * axes.col(2);
  const Vector other = axes.col(1).cross(axes.col(2));
  Vector image = u.cross(v);
  const double length = image.norm();
  if (!(length > 0))
  {
    return false;
  }
  image *= (other.dot(normal) < 0 ? -1.0 : 1.0) / length;
  map += (image - map * normal) * normal.transpose();
  return !planarMesh || image.dot(normal) >= 0;
}

/// The linear part of the affine map that fits a component best (least squares). False if the
/// points do not determine it, or if its residual is too large.
bool fitMap(const PathMoments& m, bool planarMesh, Matrix& map)
{
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m.points);
  const Matrix& axes = eigen.eigenvectors();
  Matrix inverse = Matrix::Zero();
  int spanned = 0;
  for (int k = 0; k < 3; ++k)
  {
    if (eigen.eigenvalues()[k] > FlatExtent * FlatExtent * eigen.eigenvalues()[2])
    {
      inverse += axes.col(k) * axes.col(k).transpose() / eigen.eigenvalues()[k];
      ++spanned;
    }
  }
  if (spanned < 2)
  {
    return false; // points on a line do not determine a rotation
  }
  const Matrix linear = m.mixed * inverse;
  const double rest = m.moved - (linear * m.mixed.transpose()).trace();
  if (rest > AffineResidual * AffineResidual * m.moved)
  {
    return false;
  }
  map = Matrix::Identity() + linear;
  return spanned == 3 || completePlane(axes, planarMesh, map);
}
}

//------------------------------------------------------------------------------
WarpPath::WarpPath(const Mesh& mesh, const WarpParts& parts, const double* displacement)
  : Input(mesh)
  , Displacement(displacement, displacement + 3 * mesh.view().numberOfPoints)
{
  std::size_t pieces = 0;
  this->PieceOf = findPieces(mesh, parts, pieces);
  this->Pieces.resize(pieces);
  const std::vector<PathMoments> moments =
    momentsOf(mesh.view(), this->PieceOf, pieces, displacement, parts.ranks());
  for (std::size_t p = 0; p < pieces; ++p)
  {
    Piece& piece = this->Pieces[p];
    for (int c = 0; c < 3; ++c)
    {
      piece.center[c] = moments[p].center[c];
      piece.shift[c] = moments[p].shift[c];
    }
    // The polar decomposition splits the map into a rotation and a stretch.
    Matrix map;
    if (!fitMap(moments[p], parts.dimension() == Dimension::Planar, map))
    {
      continue;
    }
    const Eigen::JacobiSVD<Matrix> svd(map, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix rotation = svd.matrixU() * svd.matrixV().transpose();
    if (!(map.determinant() > 0) || !(rotation.determinant() > 0))
    {
      continue;
    }
    const Eigen::AngleAxisd turn(rotation);
    const Matrix stretch =
      svd.matrixV() * svd.singularValues().asDiagonal() * svd.matrixV().transpose();
    piece.turns = true;
    piece.angle = turn.angle();
    for (int c = 0; c < 3; ++c)
    {
      piece.axis[c] = turn.axis()[c];
      for (int k = 0; k < 3; ++k)
      {
        piece.stretch[k][c] = stretch(c, k) - (c == k ? 1.0 : 0.0);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The displacement of the point x moving with a component (Rodrigues' rotation formula).
Vec3 WarpPath::place(const Piece& piece, double amount, const Vec3& x) const
{
  const Vec3 y = x - piece.center;
  Vec3 stretched = y;
  for (int k = 0; k < 3; ++k)
  {
    stretched += (amount * y[k]) * piece.stretch[k];
  }
  const double cosine = std::cos(amount * piece.angle), sine = std::sin(amount * piece.angle);
  const Vec3& u = piece.axis;
  const Vec3 turned =
    cosine * stretched + sine * cross(u, stretched) + ((1.0 - cosine) * dot(u, stretched)) * u;
  return turned - y + amount * piece.shift;
}

void WarpPath::at(double amount, double* displacement) const
{
  const MeshView& view = this->Input.view();
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const double* given = &this->Displacement[3 * i];
    double* to = displacement + 3 * i;
    if (this->PieceOf[i] < 0)
    {
      std::fill_n(to, 3, 0.0);
      continue;
    }
    const Piece& piece = this->Pieces[this->PieceOf[i]];
    if (amount == 1.0 || !piece.turns)
    {
      std::transform(given, given + 3, to, [amount](double d) { return amount * d; });
      continue;
    }
    const Vec3 x = pointOf(view, i);
    const Vec3 whole = this->place(piece, 1.0, x), part = this->place(piece, amount, x);
    for (int c = 0; c < 3; ++c)
    {
      to[c] = part[c] + amount * (given[c] - whole[c]);
    }
  }
}
}
