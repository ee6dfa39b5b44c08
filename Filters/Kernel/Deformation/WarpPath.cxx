#include "WarpPath.h"

#include <Eigen/Dense>

#include <numeric>

namespace tautline
{
WarpPath::WarpPath(const Mesh& mesh, const WarpParts& parts, const double* displacement)
  : Input(mesh)
  , Displacement(displacement, displacement + 3 * mesh.view().numberOfPoints)
{
  // Pieces: points joined by facets all of whose points are prescribed.
  const MeshView& view = mesh.view();
  const Index n = view.numberOfPoints;
  const std::vector<unsigned char>& prescribed = parts.prescribed();
  std::vector<Index> parent(n);
  std::iota(parent.begin(), parent.end(), Index(0));
  const auto root = [&](Index i)
  {
    while (parent[i] != i)
    {
      i = parent[i] = parent[parent[i]];
    }
    return i;
  };
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
      const Index a = root(nodes[local(0)]), b = root(nodes[local(k)]);
      parent[std::max(a, b)] = std::min(a, b);
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
  this->PieceOf.assign(n, -1);
  for (Index i = 0; i < n; ++i)
  {
    if (prescribed[i])
    {
      const Index r = root(i);
      if (r == i)
      {
        this->PieceOf[i] = static_cast<Index>(this->Pieces.size());
        this->Pieces.emplace_back();
      }
      else
      {
        this->PieceOf[i] = this->PieceOf[r];
      }
    }
  }

  // The affine map of each piece, split into a rotation and a stretch.
  using Matrix = Eigen::Matrix3d;
  using Vector = Eigen::Vector3d;
  struct Sums
  {
    double count = 0;
    Vector center = Vector::Zero(), shift = Vector::Zero();
    Matrix before = Matrix::Zero(), between = Matrix::Zero();
    double moved = 0; ///< sum of squares
  };
  std::vector<Sums> sums(this->Pieces.size());
  const auto forEach = [&](const auto& visit)
  {
    for (Index i = 0; i < n; ++i)
    {
      if (this->PieceOf[i] >= 0)
      {
        visit(sums[this->PieceOf[i]], Eigen::Map<const Vector>(view.points + 3 * i),
          Eigen::Map<const Vector>(displacement + 3 * i));
      }
    }
  };
  forEach(
    [](Sums& s, const auto& x, const auto& d)
    {
      s.count += 1;
      s.center += x;
      s.shift += d;
    });
  for (Sums& s : sums)
  {
    s.center /= s.count;
    s.shift /= s.count;
  }
  forEach(
    [](Sums& s, const auto& x, const auto& d)
    {
      const Vector a = x - s.center, b = d - s.shift;
      s.before += a * a.transpose();
      s.between += b * a.transpose();
      s.moved += b.squaredNorm();
    });
  for (std::size_t p = 0; p < sums.size(); ++p)
  {
    const Sums& s = sums[p];
    Piece& piece = this->Pieces[p];
    for (int c = 0; c < 3; ++c)
    {
      piece.center[c] = s.center[c];
      piece.shift[c] = s.shift[c];
    }
    constexpr double flat = 1e-6;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(s.before);
    const Matrix axes = eigen.eigenvectors();
    Matrix inverse = Matrix::Zero();
    int spanned = 0;
    for (int k = 0; k < 3; ++k)
    {
      if (eigen.eigenvalues()[k] > flat * flat * eigen.eigenvalues()[2])
      {
        inverse += axes.col(k) * axes.col(k).transpose() / eigen.eigenvalues()[k];
        ++spanned;
      }
    }
    if (spanned < 2)
    {
      continue; // a line: its turn is not known
    }
    // What the map leaves of the displacements: much of it, and the turn is none of the piece's.
    constexpr double affineEnough = 0.05;
    const Matrix linear = s.between * inverse;
    const double rest = s.moved - (linear * s.between.transpose()).trace();
    if (rest > affineEnough * affineEnough * s.moved)
    {
      continue;
    }
    Matrix map = Matrix::Identity() + linear;
    if (spanned == 2)
    {
      // The normal of a plane follows the plane.
      const Vector normal = axes.col(0);
      const Vector u = map * axes.col(1), v = map * axes.col(2);
      const Vector other = axes.col(1).cross(axes.col(2));
      Vector image = u.cross(v);
      const double length = image.norm();
      if (!(length > 0))
      {
        continue;
      }
      image *= (other.dot(normal) < 0 ? -1.0 : 1.0) / length;
      map += (image - map * normal) * normal.transpose();
      if (mesh.dimension() == Dimension::Planar && image.dot(normal) < 0)
      {
        continue; // mirrored in the plane
      }
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
/// Displacement of a point that goes with a piece.
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
