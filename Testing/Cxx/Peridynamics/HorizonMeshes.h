// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HorizonMeshes.h
 * @brief Meshes with an interaction layer, and the values of the notes, for the tests of nonlocal
 * models.
 */
#ifndef tautline_HorizonMeshes_h
#define tautline_HorizonMeshes_h

#include "Meshes.h"

#include "tautline/Peridynamics/Peridynamics.h"
#include "tautline/Solvers/Lanczos.h"

namespace tautline
{
inline constexpr PeridynamicBasis bases[] = { PeridynamicBasis::Constant, PeridynamicBasis::Linear,
  PeridynamicBasis::DiscontinuousLinear };

/** The matrices of the module. */
struct NonlocalCase
{
  const char* name;
  PeridynamicBasis basis;
  PeridynamicModel model;
  Discretization discretization = Discretization::Exact;
};
inline constexpr NonlocalCase nonlocalCases[] = {
  { "linear", PeridynamicBasis::Linear, PeridynamicModel::Scalar },
  { "constant", PeridynamicBasis::Constant, PeridynamicModel::Scalar },
  { "discontinuous", PeridynamicBasis::DiscontinuousLinear, PeridynamicModel::Scalar },
  { "elastic", PeridynamicBasis::Linear, PeridynamicModel::Elastic },
  { "constant elastic", PeridynamicBasis::Constant, PeridynamicModel::Elastic },
  { "state-based", PeridynamicBasis::Linear, PeridynamicModel::StateBased },
  { "constant state-based", PeridynamicBasis::Constant, PeridynamicModel::StateBased },
  { "dissertation", PeridynamicBasis::Linear, PeridynamicModel::Scalar,
    Discretization::Dissertation },
  { "constant dissertation", PeridynamicBasis::Constant, PeridynamicModel::Scalar,
    Discretization::Dissertation },
  { "discontinuous dissertation", PeridynamicBasis::DiscontinuousLinear, PeridynamicModel::Elastic,
    Discretization::Dissertation },
};

inline std::vector<double> times(const SparseMatrix& matrix, const std::vector<double>& x)
{
  std::vector<double> y(matrix.size);
  matrix.multiply(x.data(), y.data());
  return y;
}

/** A square (0,1)^2 with an interaction layer of whole layers; inner points moved by up to `shake`
 * element sizes. */
inline HorizonMesh shakenSquare(int n, int layers, double shake, unsigned seed = 5)
{
  HorizonMesh mesh;
  Random random(seed);
  const int m = n + 2 * layers;
  const auto fixed = [&](int i) { return i == 0 || i == m || i == layers || i == m - layers; };
  for (int j = 0; j <= m; ++j)
  {
    for (int i = 0; i <= m; ++i)
    {
      const bool still = fixed(i) || fixed(j);
      const double dx = random.uniform(-shake, shake), dy = random.uniform(-shake, shake);
      mesh.points.push_back((i - layers + (still ? 0.0 : dx)) / n);
      mesh.points.push_back((j - layers + (still ? 0.0 : dy)) / n);
    }
  }
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const Index a = j * (m + 1) + i, d = a + m + 1;
      for (const Index id : { a, a + 1, d + 1, a, d + 1, d })
      {
        mesh.triangles.push_back(id);
      }
      const bool inside = i >= layers && i < m - layers && j >= layers && j < m - layers;
      mesh.layer.insert(mesh.layer.end(), 2, inside ? 0 : 1);
    }
  }
  return mesh;
}

inline double conditionOf(const HorizonMesh& mesh, const PeridynamicOptions& options)
{
  return extremeEigenvalues(assemblePeridynamics(mesh, options).matrix).condition;
}

/** A cell of Tables 4.1 to 4.3: printed value, column of the rules that reproduce it, reference. */
struct TableCell
{
  int table, aspectRatio, n;
  double delta, printed, column, reference;
  bool printedIsRight; ///< the notes list it among those the column reproduces
};

/** The cells with h = 0.1 and 0.05; Table 4.1 against column C, the others against column B of the
 * notes. */
inline const std::vector<TableCell>& tableCells()
{
  static const std::vector<TableCell> cells = {
    { 1, 1, 10, 0.2, 16.33, 16.31, 16.0772, true },
    { 1, 1, 10, 0.3, 8.70, 8.68, 8.6445, true },
    { 1, 1, 10, 0.4, 5.65, 5.64, 5.6350, true },
    { 1, 1, 20, 0.2, 17.47, 17.77, 17.7401, true },
    { 1, 1, 20, 0.3, 9.06, 9.06, 9.0625, true },
    { 1, 1, 20, 0.4, 5.79, 5.79, 5.7903, true },
    { 1, 4, 10, 0.2, 15.98, 15.04, 14.6373, false },
    { 1, 4, 10, 0.3, 8.00, 8.03, 7.9725, true },
    { 1, 4, 10, 0.4, 5.53, 5.54, 5.5320, true },
    { 1, 4, 20, 0.2, 17.55, 17.28, 17.2366, true },
    { 1, 4, 20, 0.3, 8.95, 8.97, 8.9635, true },
    { 1, 4, 20, 0.4, 5.70, 5.76, 5.7615, true },
    { 2, 1, 10, 0.2, 10.60, 9.21, 9.2827, false },
    { 2, 1, 10, 0.3, 6.12, 5.72, 5.7521, false },
    { 2, 1, 10, 0.4, 4.00, 4.00, 4.0139, true },
    { 2, 1, 20, 0.2, 13.35, 13.35, 13.3891, true },
    { 2, 1, 20, 0.3, 7.20, 7.19, 7.2041, true },
    { 2, 1, 20, 0.4, 4.70, 4.70, 4.6994, true },
    { 2, 4, 10, 0.2, 11.69, 11.68, 12.1796, true },
    { 2, 4, 10, 0.3, 7.36, 7.64, 7.7856, false },
    { 2, 4, 10, 0.4, 4.31, 4.32, 4.3895, true },
    { 2, 4, 20, 0.2, 14.43, 14.43, 14.6613, true },
    { 2, 4, 20, 0.3, 7.46, 7.45, 7.5092, true },
    { 2, 4, 20, 0.4, 4.89, 4.89, 4.9103, true },
    { 3, 1, 10, 0.2, 11.27, 11.24, 12.1362, true },
    { 3, 1, 10, 0.3, 7.80, 7.79, 8.1339, true },
    { 3, 1, 10, 0.4, 6.07, 6.07, 6.1851, true },
    { 3, 1, 20, 0.2, 21.04, 21.05, 21.3645, true },
    { 3, 1, 20, 0.3, 13.92, 13.92, 13.8885, true },
    { 3, 1, 20, 0.4, 10.45, 10.45, 10.3215, true },
    { 3, 4, 10, 0.2, 16.02, 16.01, 18.1422, true },
    { 3, 4, 10, 0.3, 13.24, 13.23, 13.8160, true },
    { 3, 4, 10, 0.4, 8.54, 8.55, 8.8438, true },
    { 3, 4, 20, 0.2, 29.81, 29.82, 30.5788, true },
    { 3, 4, 20, 0.3, 19.51, 19.50, 19.2726, true },
    { 3, 4, 20, 0.4, 17.01, 14.55, 14.1480, false },
  };
  return cells;
}

inline PeridynamicOptions optionsOf(const TableCell& cell, Discretization discretization)
{
  return TAUTLINE_CHANGED(PeridynamicOptions(), horizon = cell.delta,
    kernel.exponent = cell.table == 3 ? 2.5 : 1.0,
    basis = cell.table == 1 ? PeridynamicBasis::Constant : PeridynamicBasis::Linear,
    discretization = discretization, allowThinLayer = true);
}

} // namespace tautline

#endif
