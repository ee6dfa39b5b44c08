// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Meshes.h
 * @brief Meshes in memory for the tests of the kernel: single cells and scattered ones. See also
 * Blocks.h.
 */

#ifndef tautline_Meshes_h
#define tautline_Meshes_h

#include "Loops.h"
#include "Set.h"
#include "tautline/Quality/Metrics.h"
#include "tautline/Quality/Targets.h"

#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>

namespace tautline
{

/** A mesh that owns its arrays. */
struct MeshData
{
  std::vector<double> points;
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 };
  std::vector<Index> connectivity;

  Index numberOfPoints() const { return static_cast<Index>(this->points.size() / 3); }
  Index numberOfCells() const { return static_cast<Index>(this->types.size()); }
  Vec3 point(Index i) const
  {
    return { this->points[3 * i], this->points[3 * i + 1], this->points[3 * i + 2] };
  }
  void setPoint(Index i, const Vec3& p) { std::copy(p.begin(), p.end(), &this->points[3 * i]); }
  Index addPoint(const Vec3& p)
  {
    this->points.insert(this->points.end(), p.begin(), p.end());
    return this->numberOfPoints() - 1;
  }
  void addPoints(const std::vector<Vec3>& places)
  {
    for (const Vec3& p : places)
    {
      this->addPoint(p);
    }
  }
  std::vector<Index> nodes(Index cell) const
  {
    const auto begin = this->connectivity.begin();
    return { begin + this->offsets[cell], begin + this->offsets[cell + 1] };
  }
  /** Exchanges two nodes of each cell, or of every step-th from one on. */
  void swapNodes(Index a, Index b, Index first = 0, Index step = 1)
  {
    for (Index cell = first; cell < this->numberOfCells(); cell += step)
    {
      Index* const of = &this->connectivity[this->offsets[cell]];
      std::swap(of[a], of[b]);
    }
  }
  void addCell(int vtkType, const std::vector<Index>& nodes)
  {
    this->types.push_back(static_cast<unsigned char>(vtkType));
    this->connectivity.insert(this->connectivity.end(), nodes.begin(), nodes.end());
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  }
  void addCell(CellType type, const std::vector<Index>& nodes)
  {
    this->addCell(static_cast<int>(type), nodes);
  }
  /** Adds a cell with points of its own. */
  void addCell(CellType type, const std::vector<Vec3>& corners)
  {
    std::vector<Index> nodes;
    for (const Vec3& p : corners)
    {
      nodes.push_back(this->addPoint(p));
    }
    this->addCell(type, nodes);
  }
  /** Replaces every point by f(point). */
  template <class Function>
  void transform(const Function& f)
  {
    for (Index i = 0; i < this->numberOfPoints(); ++i)
    {
      this->setPoint(i, f(this->point(i)));
    }
  }
  MeshView view() const
  {
    MeshView view;
    view.numberOfPoints = this->numberOfPoints();
    view.points = this->points.data();
    view.numberOfCells = this->numberOfCells();
    view.cellTypes = this->types.data();
    view.offsets = this->offsets.data();
    view.connectivity = this->connectivity.data();
    return view;
  }
};

/** A function of a place p that gives the place of these coordinates, for MeshData::transform(). */
#define TAUTLINE_PLACE(...) [=](const tautline::Vec3& p) { return tautline::Vec3{ __VA_ARGS__ }; }

inline std::vector<double> valuesOf(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options = {})
{
  std::vector<double> values(mesh.view().numberOfCells);
  evaluateMetric(mesh, metric, options, values.data());
  return values;
}

inline std::vector<double> valuesOf(
  const MeshData& data, Metric metric, const EvaluationOptions& options = {})
{
  return valuesOf(Mesh(data.view()), metric, options);
}

/** Values and gradients of all cells; three components per entry of the connectivity. */
struct Gradients
{
  std::vector<double> values, gradients;
};

inline Gradients gradientsOf(const Mesh& mesh, Metric metric, const EvaluationOptions& options = {})
{
  const MeshView& view = mesh.view();
  Gradients result;
  result.values.resize(view.numberOfCells);
  result.gradients.resize(3 * view.offsets[view.numberOfCells]);
  evaluateMetricGradient(mesh, metric, options, result.values.data(), result.gradients.data());
  return result;
}

inline std::vector<signed char> validityOf(const Mesh& mesh)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data());
  return validity;
}

inline std::vector<signed char> validityOf(const MeshData& data)
{
  return validityOf(Mesh(data.view()));
}

constexpr CellType allTypes[] = { CellType::Triangle, CellType::Quadrilateral,
  CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };

/** Corners of the ideal cell with unit edges, in VTK's order. */
inline std::vector<Vec3> idealCell(CellType type)
{
  const double h = std::sqrt(3.0) / 2;
  switch (type)
  {
    case CellType::Triangle:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 } };
    case CellType::Quadrilateral:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
    case CellType::Tetrahedron:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 }, { 0.5, h / 3, std::sqrt(2.0 / 3) } };
    case CellType::Hexahedron:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
        { 1, 1, 1 }, { 0, 1, 1 } };
    case CellType::Wedge: // the triangle 0 1 2 is counter-clockwise seen from below
      return { { 0, 0, 0 }, { 0.5, h, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0.5, h, 1 }, { 1, 0, 1 } };
    default:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, std::sqrt(0.5) } };
  }
}

inline MeshData singleCell(CellType type, const std::vector<Vec3>& corners)
{
  MeshData data;
  data.addCell(type, corners);
  return data;
}

/** The value of a metric on one cell. */
inline double valueOf(
  CellType type, const std::vector<Vec3>& corners, Metric metric, const EvaluationOptions& o = {})
{
  return valuesOf(singleCell(type, corners), metric, o)[0];
}

/** Seeded random numbers. */
class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {
  }
  double uniform(double low, double high)
  {
    return low + (high - low) * (this->Engine() >> 11) * 0x1p-53;
  }
  Index integer(Index count) { return static_cast<Index>(this->Engine() % count); }
  Vec3 vector(double low, double high)
  {
    return { this->uniform(low, high), this->uniform(low, high), this->uniform(low, high) };
  }

  /** The numbers below count in a random order. */
  std::vector<Index> permutation(Index count)
  {
    std::vector<Index> order(count);
    for (Index i = 0; i < count; ++i)
    {
      order[i] = i;
      std::swap(order[i], order[this->integer(i + 1)]);
    }
    return order;
  }

private:
  std::mt19937_64 Engine;
};

/** A 3 x 3 matrix by its columns. */
using Columns = std::array<Vec3, 3>;

inline Vec3 operator*(const Columns& m, const Vec3& p)
{
  return p[0] * m[0] + p[1] * m[1] + p[2] * m[2];
}

/** Rotation about an axis by an angle. */
inline Columns rotation(const Vec3& axis, double angle)
{
  const Vec3 u = (1 / norm(axis)) * axis;
  const double c = std::cos(angle), s = std::sin(angle);
  Columns r;
  for (int k = 0; k < 3; ++k)
  {
    Vec3 e = { 0, 0, 0 };
    e[k] = 1;
    r[k] = c * e + s * cross(u, e) + ((1 - c) * u[k]) * u;
  }
  return r;
}

inline Columns randomRotation(Random& random)
{
  return rotation(random.vector(0.1, 1), random.uniform(0.5, 3));
}

/** Determinants of the corner Jacobians over the lengths of their edges: sines of solid corners.
 * In 2D against the given normal. */
inline std::vector<double> cornerSines(
  CellType type, const std::vector<Vec3>& p, const Vec3& normal = { 0, 0, 1 })
{
  const CellTopology& t = topology(type);
  std::vector<double> sines;
  for (int c = 0; c < t.corners; ++c)
  {
    const auto& n = t.cornerNodes[c];
    const Vec3 a = p[n[1]] - p[n[0]], b = p[n[2]] - p[n[0]];
    const Vec3 d = t.dimension == 2 ? normal : p[n[3]] - p[n[0]];
    sines.push_back(dot(cross(a, b), d) / (norm(a) * norm(b) * norm(d)));
  }
  return sines;
}

/** The ideal cell with each corner moved by up to `amplitude` in each direction its dimension has.
 */
inline std::vector<Vec3> perturbedCell(CellType type, double amplitude, Random& random)
{
  std::vector<Vec3> corners = idealCell(type);
  for (Vec3& p : corners)
  {
    Vec3 d = random.vector(-amplitude, amplitude);
    d[2] = topology(type).dimension == 2 ? 0 : d[2];
    p += d;
  }
  return corners;
}

/** A perturbed cell whose corners all have a sine above `sine`. */
inline std::vector<Vec3> validCell(CellType type, double amplitude, double sine, Random& random)
{
  for (;;)
  {
    std::vector<Vec3> corners = perturbedCell(type, amplitude, random);
    const std::vector<double> sines = cornerSines(type, corners);
    if (*std::min_element(sines.begin(), sines.end()) > sine)
    {
      return corners;
    }
  }
}

/** A well-shaped cell, or one with corners anywhere; no corner nearly flat. */
inline std::vector<Vec3> unflatCell(CellType type, bool anywhere, Random& random)
{
  for (;;)
  {
    std::vector<Vec3> p = perturbedCell(type, anywhere ? 0.8 : 0.25, random);
    const std::vector<double> sines = cornerSines(type, p);
    if (std::none_of(sines.begin(), sines.end(), [](double s) { return std::abs(s) < 0.05; }))
    {
      return p;
    }
  }
}

/**
 * Cells without common points, half of them well-shaped. On a surface each 2D cell is turned into a
 * plane of its own, where it is viewed from its own positive side; `cells` has its coordinates
 * there.
 */
inline MeshData scatteredCells(
  CellType type, bool surface, int count, Random& random, std::vector<std::vector<Vec3>>& cells)
{
  MeshData data;
  for (int i = 0; i < count; ++i)
  {
    std::vector<Vec3> seen = unflatCell(type, i % 2 == 1, random), placed = seen;
    if (surface)
    {
      const Columns turn = randomRotation(random);
      double area = 0;
      for (std::size_t k = 0; k < seen.size(); ++k)
      {
        area += cross(seen[k], seen[(k + 1) % seen.size()])[2] / 2; // the shoelace formula
        placed[k] = turn * seen[k];
      }
      for (Vec3& p : seen)
      {
        p[0] *= area < 0 ? -1 : 1;
      }
    }
    cells.push_back(seen);
    data.addCell(type, placed);
  }
  return data;
}

/** The ideal cell flattened to a part of its height, along a direction of no symmetry. */
inline std::vector<Vec3> flattenedCell(CellType type, double height)
{
  std::vector<Vec3> corners = idealCell(type);
  const Vec3 d = topology(type).dimension == 2 ? Vec3{ 0.8, 0.6, 0 } : Vec3{ 0.48, 0.36, 0.8 };
  for (Vec3& p : corners)
  {
    p -= ((1 - height) * dot(p, d)) * d;
  }
  return corners;
}

} // namespace tautline

#endif
