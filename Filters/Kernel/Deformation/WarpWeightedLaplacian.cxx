// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPointwise.h"

#include "WarpBatches.h"
#include "WarpParts.h"
#include "WarpSystem.h"
#include "tautline/Core/EigenCompatibility.h"
#include "tautline/Core/LineSearch.h"
#include "tautline/Core/UnionFind.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <sstream>

namespace tautline
{
namespace
{
/// @param why the message of the solver, or ""
[[noreturn]] void throwUnsolved(double tolerance, const std::string& why)
{
  std::ostringstream text;
  text << "the linear system of weighted Laplacian smoothing could not be solved to " << tolerance
       << "; raise the tolerance or choose another method" << why;
  throw Error(text.str());
}

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr int NewtonSteps = 50;
/// Newton's method stops at this (squared) decrement, which is invariant under affine maps of the
/// neighbors, and has succeeded if it reaches the second.
constexpr double Enough = 1e-27, Acceptable = 1e-20;
/// The drop tolerance of the incomplete factorization.
constexpr double DropTolerance = 1e-3;
constexpr int FillFactor = 6;
/// Iterations of the linear solver between two checks of the limits, and the number of restarts.
constexpr int RunLength = 300, MaxRuns = 20;

/// The neighbors of a point and its convex combination of them.
struct WeightedNeighbors
{
  std::vector<Index> neighbors;
  std::vector<double> weights;
};

/// Solution of a positive definite system of the leading rows, by elimination; the other components
/// are 0.
Vec3 solved(std::array<Vec3, 3> a, Vec3 b, int dimension)
{
  const auto n = static_cast<std::size_t>(dimension);
  for (std::size_t k = 0; k < n; ++k)
  {
    for (std::size_t i = k + 1; i < n; ++i)
    {
      const double factor = a[i][k] / a[k][k];
      b[i] -= factor * b[k];
      for (std::size_t j = k; j < n; ++j)
      {
        a[i][j] -= factor * a[k][j];
      }
    }
  }
  Vec3 x = { 0, 0, 0 };
  for (std::size_t k = n; k-- > 0;)
  {
    double sum = b[k];
    for (std::size_t j = k + 1; j < n; ++j)
    {
      sum -= a[k][j] * x[j];
    }
    x[k] = sum / a[k][k];
  }
  return x;
}

/**
 * @brief The weights w > 0 with sum 1 and w . offsets = 0 that have the largest product.
 *
 * They are 1 / (n + l . offset): l, which has as many components as space, minimizes -sum log(n + l
 * . offset). If the point is not inside the convex hull of its neighbors, there is no minimum, and
 * all weights are equal.
 */
void maximizeProduct(const std::vector<Vec3>& offsets, int dimension, std::vector<double>& weights)
{
  const auto n = static_cast<double>(offsets.size());
  const auto functionAt = [&](const Vec3& l)
  {
    double sum = 0;
    for (const Vec3& offset : offsets)
    {
      const double denominator = n + dot(l, offset);
      if (denominator <= 0)
      {
        return std::numeric_limits<double>::infinity();
      }
      sum -= std::log(denominator / n);
    }
    return sum;
  };
  Vec3 l = { 0, 0, 0 };
  double value = 0;
  double decrease = std::numeric_limits<double>::infinity();
  for (int step = 0; step < NewtonSteps; ++step)
  {
    std::array<Vec3, 3> hessian = {};
    Vec3 gradient = { 0, 0, 0 }; // negative
    for (std::size_t j = 0; j < offsets.size(); ++j)
    {
      const double w = 1 / (n + dot(l, offsets[j]));
      weights[j] = w;
      gradient += w * offsets[j];
      for (std::size_t a = 0; a < 3; ++a)
      {
        hessian[a] += (w * w * offsets[j][a]) * offsets[j];
      }
    }
    const Vec3 direction = solved(hessian, gradient, dimension);
    decrease = dot(gradient, direction);
    if (!(decrease > Enough) || !std::isfinite(decrease))
    {
      break;
    }
    // The step is halved until it reduces the function; near the minimum, where rounding dominates,
    // a full step is used.
    constexpr double Bottom = 1e-12, Shortest = 1e-10;
    double length = 1;
    double next = functionAt(l + direction);
    while (length > Shortest && decrease > Bottom &&
      !(next <= value - ArmijoConstant * length * decrease))
    {
      length *= 0.5;
      next = functionAt(l + length * direction);
    }
    if (!std::isfinite(next) || length <= Shortest)
    {
      break;
    }
    l += length * direction;
    value = next;
  }
  const bool found = decrease <= Acceptable;
  double sum = 0;
  for (double& w : weights)
  {
    w = found && std::isfinite(w) && w > 0 ? w : 1 / n;
    sum += w;
  }
  for (double& w : weights)
  {
    w /= sum;
  }
}

/// The neighbors and weights at the points of a mesh.
class Combinations
{
public:
  /// Neighbors are in the order of their ids, so that the weights do not depend on the ranks.
  explicit Combinations(const Mesh& mesh, const Ranks& ranks = {})
    : Input(mesh)
    , TheRanks(ranks)
    , Around(mesh.vertexCells())
  {
  }

  WeightedNeighbors at(Index id) const
  {
    const MeshView& view = this->Input.view();
    WeightedNeighbors result;
    Vec3 normal = { 0, 0, 0 }; // of the surrounding cells if they are flat
    for (Index c = this->Around.offsets[id]; c < this->Around.offsets[id + 1]; ++c)
    {
      const Index cell = this->Around.cells[c];
      const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
      const Index* nodes = view.connectivity + view.offsets[cell];
      result.neighbors.insert(result.neighbors.end(), nodes, nodes + t.nodes);
      if (t.dimension == 2)
      {
        std::array<Vec3, 4> p = {};
        for (int k = 0; k < t.nodes; ++k)
        {
          p[static_cast<std::size_t>(k)] = pointOf(view, nodes[k]);
        }
        normal += vectorArea(t, p.data());
      }
    }
    std::sort(result.neighbors.begin(), result.neighbors.end(),
      [this](Index a, Index b)
      { return this->TheRanks.several() ? this->TheRanks.id(a) < this->TheRanks.id(b) : a < b; });
    result.neighbors.erase(
      std::unique(result.neighbors.begin(), result.neighbors.end()), result.neighbors.end());
    result.neighbors.erase(
      std::remove(result.neighbors.begin(), result.neighbors.end(), id), result.neighbors.end());

    std::vector<Vec3> offsets;
    double longest = 0;
    for (const Index neighbor : result.neighbors)
    {
      offsets.push_back(pointOf(view, neighbor) - pointOf(view, id));
      longest = std::max(longest, norm(offsets.back()));
    }
    const bool volume = this->Input.dimension() == Dimension::Volume;
    if (!volume)
    {
      this->flatten(normal, offsets);
    }
    for (Vec3& offset : offsets)
    {
      offset = (longest > 0 ? 1 / longest : 0.0) * offset;
    }
    result.weights.resize(offsets.size());
    maximizeProduct(offsets, volume ? 3 : 2, result.weights);
    return result;
  }

private:
  /// Components of the offsets in the plane of the mesh, or in the tangent plane of a surface.
  void flatten(Vec3 normal, std::vector<Vec3>& offsets) const
  {
    std::array<Vec3, 2> frame = this->Input.frame();
    const double length = norm(normal);
    if (this->Input.dimension() != Dimension::Planar && length > 0)
    {
      normal = (1 / length) * normal;
      const auto least =
        static_cast<std::size_t>(std::min_element(normal.begin(), normal.end(),
                                   [](double a, double b) { return std::abs(a) < std::abs(b); }) -
          normal.begin());
      Vec3 axis = { 0, 0, 0 };
      axis[least] = 1;
      frame[0] = cross(normal, axis);
      frame[0] = (1 / norm(frame[0])) * frame[0];
      frame[1] = cross(normal, frame[0]);
    }
    for (Vec3& offset : offsets)
    {
      offset = { dot(offset, frame[0]), dot(offset, frame[1]), 0 };
    }
  }

  const Mesh& Input;
  Ranks TheRanks;
  VertexCells Around;
};

/**
 * @brief Solves the system, column by column, by the stabilized biconjugate gradient method; the
 * matrix is diagonally dominant and an incomplete factorization exists. Solutions are verified.
 * @return false when the control stopped it
 */
bool solve(const Matrix& matrix, const Eigen::MatrixXd& right, double tolerance,
  WarpControl& control, Eigen::MatrixXd& solution)
{
  Eigen::BiCGSTAB<Matrix, Eigen::IncompleteLUT<double>> solver;
  solver.preconditioner().setDroptol(DropTolerance);
  solver.preconditioner().setFillfactor(FillFactor);
  solver.setTolerance(tolerance);
  solver.setMaxIterations(RunLength);
  solver.compute(matrix);
  solution.setZero(right.rows(), right.cols());
  for (Eigen::Index k = 0; k < right.cols(); ++k)
  {
    // Eigen 5 also stops at an absolute tolerance: scale the right-hand side to length 1.
    const double length = right.col(k).norm();
    if (!(length > 0.0))
    {
      continue;
    }
    const Eigen::VectorXd b = right.col(k) / length;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.rows());
    int runs = 0;
    do
    {
      if (!control.watch(0.5 + static_cast<double>(k) / 6))
      {
        return false;
      }
      if (++runs > MaxRuns)
      {
        throwUnsolved(tolerance, "");
      }
      const Eigen::VectorXd start = x;
      restartAlike();
      x = solver.solveWithGuess(b, start);
      // The method updates its residual step by step; another run starts from the true residual.
    } while (
      solver.info() != Eigen::Success || !((b - matrix * x).norm() <= ResidualFactor * tolerance));
    solution.col(k) = length * x;
  }
  return true;
}

/// The numbers of the unknown points: free points in a part with a prescribed point.
struct Unknowns
{
  std::vector<Index> points;
  std::vector<int> numberOf; ///< per point of the mesh, -1 if it is not an unknown

  Unknowns(const Mesh& mesh, const PrescribedMotion& motion)
    : numberOf(static_cast<std::size_t>(mesh.view().numberOfPoints), -1)
  {
    const MeshView& view = mesh.view();
    UnionFind parts(view.numberOfPoints);
    for (const CellBlock& block : mesh.blocks())
    {
      const int nodes = topology(block.type).nodes;
      for (Index i = 0; i < block.count; ++i)
      {
        const Index* ids = view.connectivity + view.offsets[block.cell(i)];
        for (int k = 1; k < nodes; ++k)
        {
          parts.join(ids[0], ids[k]);
        }
      }
    }
    std::vector<char> moves(this->numberOf.size(), 0);
    for (const Index id : motion.prescribed())
    {
      moves[parts.find(id)] = 1;
    }
    for (const Index id : motion.free())
    {
      if (moves[parts.find(id)])
      {
        this->numberOf[id] = static_cast<int>(this->points.size());
        this->points.push_back(id);
      }
    }
  }
};

/// Axes along and across the plane of a planar mesh: the solver error then stays within the plane.
std::array<Vec3, 3> axesOf(const Mesh& mesh)
{
  return mesh.dimension() == Dimension::Planar
    ? std::array<Vec3, 3>{ mesh.frame()[0], mesh.frame()[1], mesh.normal() }
    : std::array<Vec3, 3>{ Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
}

/// Each unknown minus its combination of unknowns is its combination of prescribed displacements:
/// the matrix, and the right-hand sides along three axes.
Matrix assemble(const PrescribedMotion& motion, const Unknowns& unknowns,
  const std::vector<WeightedNeighbors>& rows, const std::array<Vec3, 3>& axes,
  Eigen::MatrixXd& right)
{
  const auto n = static_cast<Eigen::Index>(rows.size());
  std::vector<Index> place(unknowns.numberOf.size(), -1);
  for (std::size_t i = 0; i < motion.prescribed().size(); ++i)
  {
    place[motion.prescribed()[i]] = static_cast<Index>(i);
  }
  std::vector<Eigen::Triplet<double>> entries;
  right = Eigen::MatrixXd::Zero(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const WeightedNeighbors& row = rows[static_cast<std::size_t>(i)];
    entries.emplace_back(i, i, 1.0);
    for (std::size_t j = 0; j < row.neighbors.size(); ++j)
    {
      const Index other = row.neighbors[j];
      if (unknowns.numberOf[other] >= 0)
      {
        entries.emplace_back(i, unknowns.numberOf[other], -row.weights[j]);
        continue;
      }
      const Vec3& d = motion.rest(static_cast<std::size_t>(place[other]));
      for (std::size_t k = 0; k < 3; ++k)
      {
        right(i, static_cast<Eigen::Index>(k)) += row.weights[j] * dot(d, axes[k]);
      }
    }
  }
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The affine motion, fitted to the prescribed points of all ranks, at the local points, 3 each.
/// @return whether the motion is affine, up to rounding
bool affineOfAll(const std::vector<PrescribedPoint>& given, const MeshView& local, int threads,
  std::vector<double>& motion)
{
  std::vector<double> points, displacements;
  for (const PrescribedPoint& one : given)
  {
    points.insert(points.end(), one.place.begin(), one.place.end());
    displacements.insert(displacements.end(), one.displacement.begin(), one.displacement.end());
  }
  points.insert(points.end(), local.points, local.points + 3 * local.numberOfPoints);
  displacements.resize(points.size(), 0.0);
  std::vector<unsigned char> flags(points.size() / 3, 0);
  std::fill_n(flags.begin(), given.size(), 1);
  const Index start = 0;
  MeshView view;
  view.numberOfPoints = static_cast<Index>(flags.size());
  view.points = points.data();
  view.offsets = &start;
  const Mesh cloud(view);
  const PrescribedMotion all(cloud, flags, displacements.data(), threads);
  const std::vector<double> moved = all.displacements({});
  motion.assign(moved.begin() + 3 * static_cast<std::ptrdiff_t>(given.size()), moved.end());
  return all.affine();
}

/// Each owned unknown minus its combination of neighbors, over all local points; other rows are
/// empty.
/// @return false if the control stopped it
bool assembleOwn(
  const Mesh& mesh, const WarpParts& parts, WarpControl& control, SparseMatrix& matrix)
{
  const Ranks& ranks = parts.ranks();
  const Index n = mesh.view().numberOfPoints;
  std::vector<Index> unknowns;
  for (Index i = 0; i < n; ++i)
  {
    if (!parts.held()[i] && ranks.owns(i))
    {
      unknowns.push_back(i);
    }
  }
  std::vector<std::vector<std::pair<Index, double>>> rows(unknowns.size());
  if (!unknowns.empty())
  {
    const Combinations combinations(mesh, ranks);
    const bool done = forEachBatch(rows.size(), 0.0, control,
      [&](std::size_t i)
      {
        const WeightedNeighbors row = combinations.at(unknowns[i]);
        rows[i].emplace_back(unknowns[i], 1.0);
        for (std::size_t j = 0; j < row.neighbors.size(); ++j)
        {
          rows[i].emplace_back(row.neighbors[j], -row.weights[j]);
        }
        std::sort(rows[i].begin(), rows[i].end());
      });
    if (!done)
    {
      return false;
    }
  }
  matrix.size = n;
  auto next = unknowns.begin();
  for (Index i = 0; i < n; ++i)
  {
    if (next != unknowns.end() && *next == i)
    {
      for (const auto& [column, value] : rows[next - unknowns.begin()])
      {
        matrix.columns.push_back(static_cast<std::int32_t>(column));
        matrix.values.push_back(value);
      }
      ++next;
    }
    matrix.offsets.push_back(matrix.nonzeros());
  }
  return true;
}
}

//------------------------------------------------------------------------------
std::vector<double> warpByWeightedLaplacian(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement, WarpControl& control)
{
  const WarpOptions& options = control.options();
  const PrescribedMotion motion(mesh, prescribed, displacement, options.threads);
  const Unknowns unknowns(mesh, motion);
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  if (!unknowns.points.empty() && !motion.affine())
  {
    const Combinations combinations(mesh);
    std::vector<WeightedNeighbors> rows(unknowns.points.size());
    if (!forEachBatch(rows.size(), 0.0, control,
          [&](std::size_t i) { rows[i] = combinations.at(unknowns.points[i]); }))
    {
      return {};
    }
    const std::array<Vec3, 3> axes = axesOf(mesh);
    Eigen::MatrixXd right, solution;
    const Matrix matrix = assemble(motion, unknowns, rows, axes, right);
    if (!solve(matrix, right, options.tolerance, control, solution))
    {
      return {};
    }
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      const int row = unknowns.numberOf[motion.free()[i]];
      for (std::size_t k = 0; k < 3 && row >= 0; ++k)
      {
        rest[i] += solution(row, static_cast<Eigen::Index>(k)) * axes[k];
      }
    }
  }
  // Parts without a prescribed point do not move.
  std::vector<double> result = motion.displacements(rest);
  for (const Index id : motion.free())
  {
    if (unknowns.numberOf[id] < 0)
    {
      std::fill_n(&result[3 * id], 3, 0.0);
    }
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> warpByWeightedLaplacian(
  const Mesh& mesh, const WarpParts& parts, const double* displacement, WarpControl& control)
{
  const WarpOptions& options = control.options();
  const Ranks& ranks = parts.ranks();
  const std::vector<unsigned char>& prescribed = parts.prescribed();
  const MeshView& view = mesh.view();
  const std::vector<PrescribedPoint> given = parts.prescribedOfAll(view, displacement);
  std::vector<double> moved;
  bool affine = false; // the same on all ranks
  SparseMatrix matrix;
  ranks.together(
    [&]
    {
      affine = affineOfAll(given, view, options.threads, moved);
      if (!affine)
      {
        assembleOwn(mesh, parts, control, matrix);
      }
    });
  constexpr double assembled = 0.5; // of the progress
  if (!control.proceed(assembled))
  {
    return {};
  }
  const Index n = view.numberOfPoints;
  std::unique_ptr<WarpSystem> system;
  if (!affine && parts.freePoints() > 0)
  {
    WarpMatrix rows(matrix);
    rows.symmetric = false;
    const int dimension = parts.dimension() == Dimension::Volume ? 3 : 2;
    system =
      std::make_unique<WarpSystem>(rows, 1, parts.held(), view.points, dimension, options, ranks);
    matrix = {};
  }
  if (!system)
  {
    return moved;
  }
  std::vector<double> rest(3 * n, 0.0);
  for (Index i = 0; i < 3 * n; ++i)
  {
    rest[i] = prescribed[i / 3] ? displacement[i] - moved[i] : 0.0;
  }
  // The plane is perpendicular to an axis, so errors stay within the plane.
  const ComponentSolution outcome =
    solveComponents({ system.get() }, parts, rest, 0.0, control, moved);
  if (control.stopped())
  {
    return {};
  }
  if (!outcome.converged)
  {
    throwUnsolved(options.tolerance, " (" + outcome.failure + ")");
  }
  return moved;
}
}
