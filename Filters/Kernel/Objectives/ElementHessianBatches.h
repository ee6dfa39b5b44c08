// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementHessianBatches.h
 * @brief The second derivatives of the terms of an objective, for batches of elements of one type.
 * Internal: not installed.
 *
 * Coordinates have the dimension of the mesh: two in the plane of a planar mesh, three in a volume
 * (see hessianAxes()), and two in the plane of each element of a surface (see elementAxes()).
 * Elements are translation invariant, so that the Hessian acts on the vectors from the first node
 * to the others: 9 x 9 numbers for a tetrahedron, of which one half is stored.
 *
 * The Hessian of the inverse mean ratio is analytic. With N = |T|^2 and D = det T at a corner (see
 * TargetMetrics.h), the ratio is a function q(N, D), where N is quadratic in the edges of the
 * corner and D is linear in each of them. For the other metrics, central differences of the
 * analytic gradients are used.
 *
 * N / D^(2/n) is a jointly convex function of T and D, and decreases with D. The Hessian is
 * therefore the sum of a positive semidefinite part and the second derivatives of D times a
 * negative factor. The latter can be omitted: they cancel if the factor is the same in all elements
 * around a point, because the total volume of these elements does not depend on the point. (V.
 * Garanzha et al., "Foldover-free maps in 50 lines of code", ACM Trans. Graph. 40, 2021, section 4,
 * do so for a similar function.)
 */
#ifndef tautline_ElementHessianBatches_h
#define tautline_ElementHessianBatches_h

#include "ObjectiveSum.h"
#include "ObjectiveSumState.h"

#include <cmath>

namespace tautline
{
/// The number of rows of the Hessian of an element, and of entries in its lower triangle.
template <int Dim>
constexpr int rowsFor(int nodes)
{
  return Dim * (nodes - 1);
}
template <int Dim>
constexpr int entriesFor(int nodes)
{
  return rowsFor<Dim>(nodes) * (rowsFor<Dim>(nodes) + 1) / 2;
}
constexpr int triangleEntry(int row, int column)
{
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

/// The axes of the coordinates in which Hessians are taken: right-handed for the elements, so that
/// a mirrored mesh has mirrored axes. Two for a planar mesh, otherwise three.
inline std::array<Vec3, 3> hessianAxes(const Mesh& mesh)
{
  if (mesh.dimension() == Dimension::Planar)
  {
    const int first = mesh.mirrored() ? 1 : 0;
    return { mesh.frame()[first], mesh.frame()[1 - first], mesh.normal() };
  }
  return { Vec3{ mesh.mirrored() ? -1.0 : 1.0, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
}

/// For each element of a surface: an edge, and the perpendicular direction in the plane of the
/// element (for a quadrilateral, perpendicular to its mean normal).
inline void elementAxes(const CellTopology& topology, const Batch& batch, Packet (&axes)[2][3])
{
  const bool triangle = topology.nodes == 3;
  Packet u[3], v[3], normal[3];
  subtract(batch.points[triangle ? 1 : 2], batch.points[0], u);
  subtract(batch.points[triangle ? 2 : 3], batch.points[triangle ? 0 : 1], v);
  cross(u, v, normal);
  subtract(batch.points[1], batch.points[0], u);
  cross(normal, u, axes[1]);
  cross(axes[1], normal, axes[0]);
  for (Packet(&axis)[3] : axes)
  {
    const Packet over = finiteOrZero(1.0 / sqrt(dot(axis, axis)));
    for (Packet& c : axis)
    {
      c = c * over;
    }
  }
}

/// The axes of the coordinates of a batch, which loadNodes() has mirrored in a volume.
template <int Dim>
void batchAxes(const BatchContext& context, const Batch& batch, Packet (&axes)[Dim][3])
{
  if constexpr (Dim == 2)
  {
    if (context.mesh->dimension() == Dimension::Surface)
    {
      elementAxes(*context.topology, batch, axes);
      return;
    }
  }
  const std::array<Vec3, 3> ofMesh = hessianAxes(*context.mesh);
  for (int a = 0; a < Dim; ++a)
  {
    for (int c = 0; c < 3; ++c)
    {
      axes[a][c] = broadcast(Dim == 3 ? (a == c ? 1.0 : 0.0) : ofMesh[a][c]);
    }
  }
}

/// Whether the Hessian of an objective is analytic.
inline bool hasAnalyticHessian(const Objective& objective)
{
  const EvaluationOptions& options = objective.evaluation;
  return objective.metric == Metric::InverseMeanRatio &&
    (objective.objectiveTemplate == ObjectiveTemplate::SumOfSquares ||
      objective.objectiveTemplate == ObjectiveTemplate::Sum) &&
    options.combination == Combination::Mean &&
    (!options.targets || options.targets->metricRoots.empty());
}

/// The requested Hessian of the inverse mean ratio. For other metrics, it is always exact.
enum class HessianForm
{
  Exact, ///< may be indefinite
  Convex ///< the positive semidefinite part: without the second derivatives of D
};

//------------------------------------------------------------------------------
/// One corner of a batch of elements, in the coordinates of hessianAxes().
template <int Dim>
struct RatioCorner
{
  Packet edge[Dim][Dim];
  Packet gram[Dim][Dim];                     ///< N = sum gram[k][l] edge[k] . edge[l]
  Packet slopeN[Dim][Dim], slopeD[Dim][Dim]; ///< of N and D with respect to each edge
  Packet det;                                ///< of the inverse target
  Packet q, qN, qD, qND, qDD;                ///< the ratio and its derivatives; qNN is 0
};

template <int Dim>
void loadRatioTarget(
  const BatchContext& context, const Batch& batch, int sample, RatioCorner<Dim>& corner)
{
  Packet w[Dim][Dim];
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      w[r][c] = broadcast(context.topology->idealInverse[sample][3 * r + c]);
    }
  }
  if (const Targets* targets = context.options->targets)
  {
    for (int l = 0; l < PacketWidth; ++l)
    {
      const double* own = targets->inverse.data() + 9 * (targets->offsets[batch.cells[l]] + sample);
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim; ++c)
        {
          w[r][c][l] = own[3 * r + c];
        }
      }
    }
  }
  for (int k = 0; k < Dim; ++k)
  {
    for (int l = 0; l < Dim; ++l)
    {
      corner.gram[k][l] = Packet{};
      for (int c = 0; c < Dim; ++c)
      {
        corner.gram[k][l] += w[k][c] * w[l][c];
      }
    }
  }
  if constexpr (Dim == 2)
  {
    corner.det = w[0][0] * w[1][1] - w[0][1] * w[1][0];
  }
  else
  {
    Packet rows[3];
    cross(w[0], w[1], rows);
    corner.det = dot(rows, w[2]);
  }
}

/// q = N / (n D^(2/n)) with its derivatives, for D > 0.
template <int Dim>
void evaluateRatio(
  const Packet (&x)[MaxNodes][Dim], const std::array<int, 4>& nodes, RatioCorner<Dim>& corner)
{
  Packet N = {}, D;
  for (int k = 0; k < Dim; ++k)
  {
    for (int c = 0; c < Dim; ++c)
    {
      corner.edge[k][c] = x[nodes[k + 1]][c] - x[nodes[0]][c];
    }
  }
  const auto& e = corner.edge;
  for (int k = 0; k < Dim; ++k)
  {
    for (int c = 0; c < Dim; ++c)
    {
      Packet sum = {};
      for (int l = 0; l < Dim; ++l)
      {
        sum += corner.gram[k][l] * e[l][c];
      }
      N += e[k][c] * sum;
      corner.slopeN[k][c] = 2.0 * sum;
    }
  }
  if constexpr (Dim == 2)
  {
    D = corner.det * (e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    corner.slopeD[0][0] = corner.det * e[1][1];
    corner.slopeD[0][1] = -corner.det * e[1][0];
    corner.slopeD[1][0] = -corner.det * e[0][1];
    corner.slopeD[1][1] = corner.det * e[0][0];
  }
  else
  {
    for (int k = 0; k < 3; ++k)
    {
      cross(e[(k + 1) % 3], e[(k + 2) % 3], corner.slopeD[k]);
      for (int c = 0; c < 3; ++c)
      {
        corner.slopeD[k][c] *= corner.det;
      }
    }
    D = dot(e[0], corner.slopeD[0]);
  }
  constexpr double power = -2.0 / Dim;
  const Packet overD = 1.0 / D;
  if constexpr (Dim == 2)
  {
    corner.qN = 0.5 * overD;
  }
  else
  {
    const Packet root = inverseCbrt(D);
    corner.qN = (1.0 / 3.0) * root * root;
  }
  corner.q = N * corner.qN;
  corner.qD = power * corner.q * overD;
  corner.qND = power * corner.qN * overD;
  corner.qDD = (power - 1.0) * corner.qD * overD;
}

/// Adds factor times the Hessian of q at a corner.
template <int Dim>
void addRatioHessian(const RatioCorner<Dim>& corner, const std::array<int, 4>& nodes, Packet factor,
  HessianForm form, Packet* h)
{
  const Packet nd = factor * corner.qND, dd = factor * corner.qDD;
  const Packet n = 2.0 * factor * corner.qN;
  const Packet d = form == HessianForm::Exact ? Packet(factor * corner.qD * corner.det) : Packet{};
  // The blocks between the edges, then between the nodes: the corner node has minus the sums.
  Packet block[Dim + 1][Dim + 1][Dim][Dim] = {};
  for (int k = 0; k < Dim; ++k)
  {
    for (int l = 0; l < Dim; ++l)
    {
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim; ++c)
        {
          Packet value = nd *
              (corner.slopeN[k][r] * corner.slopeD[l][c] +
                corner.slopeD[k][r] * corner.slopeN[l][c]) +
            dd * corner.slopeD[k][r] * corner.slopeD[l][c];
          if (r == c)
          {
            value += n * corner.gram[k][l];
          }
          // D is linear in each edge: its second derivatives only couple different edges.
          if (k != l && r != c)
          {
            if constexpr (Dim == 2)
            {
              value += (k < l) == (r < c) ? d : Packet(-d);
            }
            else
            {
              // d^2 D / de_k de_l = e_m times the permutation symbols of (k l m) and (r c s).
              const int m = 3 - k - l, s = 3 - r - c;
              const bool even = ((l - k + 3) % 3 == 1) == ((c - r + 3) % 3 == 1);
              const Packet part = d * corner.edge[m][s];
              value += even ? part : Packet(-part);
            }
          }
          block[k + 1][l + 1][r][c] = value;
          block[0][l + 1][r][c] -= value;
          block[k + 1][0][r][c] -= value;
          block[0][0][r][c] += value;
        }
      }
    }
  }
  for (int k = 0; k <= Dim; ++k)
  {
    for (int l = 0; l <= Dim; ++l)
    {
      const int row = Dim * (nodes[k] - 1), column = Dim * (nodes[l] - 1);
      if (row < 0 || column < 0 || row < column)
      {
        continue;
      }
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim && column + c <= row + r; ++c)
        {
          h[triangleEntry(row + r, column + c)] += block[k][l][r][c];
        }
      }
    }
  }
}

/// The lower triangles of a batch for objectives with hasAnalyticHessian().
template <int Nodes, int Dim>
void ratioHessians(const BatchContext& context, const ElementFunction& function, const Batch& batch,
  HessianForm form, Packet* h)
{
  Packet axes[Dim][3], x[MaxNodes][Dim];
  batchAxes<Dim>(context, batch, axes);
  for (int k = 0; k < Nodes; ++k)
  {
    Packet vector[3];
    subtract(batch.points[k], batch.points[0], vector);
    for (int a = 0; a < Dim; ++a)
    {
      x[k][a] = Dim == 3 ? vector[a] : dot(axes[a], vector);
    }
  }
  constexpr int rows = rowsFor<Dim>(Nodes);
  std::fill_n(h, entriesFor<Dim>(Nodes), Packet{});
  const CellTopology& topology = *context.topology;
  const int samples = topology.samples;
  const double share = 1.0 / samples;
  // The value of the cell, the mean over the corners, multiplies their Hessians: compute values
  // first.
  RatioCorner<Dim> corner[Nodes];
  Packet q = {}, slope[rows + Dim] = {};
  for (int s = 0; s < samples; ++s)
  {
    const auto& nodes = topology.cornerNodes[s];
    loadRatioTarget<Dim>(context, batch, s, corner[s]);
    evaluateRatio<Dim>(x, nodes, corner[s]);
    q += share * corner[s].q;
    for (int k = 0; k < Dim; ++k)
    {
      for (int c = 0; c < Dim; ++c)
      {
        const Packet g =
          share * (corner[s].qN * corner[s].slopeN[k][c] + corner[s].qD * corner[s].slopeD[k][c]);
        slope[Dim * nodes[k + 1] + c] += g;
        slope[Dim * nodes[0] + c] -= g;
      }
    }
  }
  const bool squared = function.objectiveTemplate == ObjectiveTemplate::SumOfSquares;
  const Packet weight = function.weightsOf(batch);
  const Packet first = share * weight * (squared ? Packet(2.0 * q) : broadcast(1.0));
  for (int s = 0; s < samples; ++s)
  {
    addRatioHessian<Dim>(corner[s], topology.cornerNodes[s], first, form, h);
  }
  for (int r = 0; squared && r < rows; ++r)
  {
    const Packet factor = 2.0 * weight * slope[Dim + r];
    for (int c = 0; c <= r; ++c)
    {
      h[triangleEntry(r, c)] += factor * slope[Dim + c];
    }
  }
  for (int i = 0; i < entriesFor<Dim>(Nodes); ++i)
  {
    h[i] = onlyCells(batch, finiteOrZero(select(weight > 0.0, h[i], Packet{})));
  }
}

//------------------------------------------------------------------------------
inline Packet shortestEdge(const CellTopology& topology, const Batch& batch)
{
  Packet shortest2 = broadcast(HUGE_VAL);
  for (int e = 0; e < topology.edges; ++e)
  {
    Packet edge[3];
    subtract(batch.points[topology.edgeNodes[e][1]], batch.points[topology.edgeNodes[e][0]], edge);
    shortest2 = min(shortest2, dot(edge, edge));
  }
  return sqrt(shortest2);
}

/// The lower triangles of a batch, by differences of the gradients of the terms.
template <int Nodes, int Dim, class Slope>
void differences(
  const BatchContext& context, BatchEvaluator evaluate, const Slope& slope, Batch& batch, Packet* h)
{
  // Step relative to the shortest edge: far below the height of a poor element, far above rounding.
  constexpr double relativeStep = 1e-6;
  constexpr int rows = rowsFor<Dim>(Nodes);
  Packet axes[Dim][3];
  batchAxes<Dim>(context, batch, axes);
  // Relative to the first node: far from the origin, the step would be lost in rounding.
  for (int k = Nodes - 1; k >= 0; --k)
  {
    subtract(batch.points[k], batch.points[0], batch.points[k]);
  }
  const Packet step = relativeStep * shortestEdge(*context.topology, batch);
  Packet full[rows][rows];
  for (int j = 0; j < rows; ++j)
  {
    Packet(&point)[3] = batch.points[1 + j / Dim];
    const Packet(&axis)[3] = axes[j % Dim];
    const Packet start[3] = { point[0], point[1], point[2] };
    const Packet over = finiteOrZero(0.5 / step);
    for (const double sign : { 1.0, -1.0 })
    {
      for (int c = 0; c < 3; ++c)
      {
        point[c] = start[c] + sign * step * axis[c];
      }
      evaluate(context, batch);
      replaceNonFinite(context, batch);
      const Packet factor = sign * over * slope(context, batch);
      for (int i = 0; i < rows; ++i)
      {
        const Packet(&gradient)[3] = batch.gradient[1 + i / Dim];
        const Packet along = Dim == 3 ? gradient[i % Dim] : dot(axes[i % Dim], gradient);
        const Packet part = factor * finiteOrZero(along);
        full[i][j] = sign > 0 ? part : Packet(full[i][j] + part);
      }
    }
    std::copy_n(start, 3, point);
  }
  for (int i = 0; i < rows; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      h[triangleEntry(i, j)] = onlyCells(batch, finiteOrZero(0.5 * (full[i][j] + full[j][i])));
    }
  }
}

//------------------------------------------------------------------------------
/**
 * @brief Rotates rows and columns p and q of the symmetric matrices a so that a[p][q] becomes 0,
 * and also the columns of v.
 */
template <int Rows>
void rotate(Packet (&a)[Rows][Rows], Packet (&v)[Rows][Rows], int p, int q)
{
  const Packet apq = a[p][q];
  const Packet theta = 0.5 * (a[q][q] - a[p][p]) / apq;
  const Packet signOfTheta = select(theta < 0.0, broadcast(-1.0), broadcast(1.0));
  // A vanishing entry, or one so small that theta overflows, needs no rotation.
  const Packet t = finiteOrZero(signOfTheta / (abs(theta) + sqrt(theta * theta + 1.0)));
  const Packet c = 1.0 / sqrt(t * t + 1.0), s = t * c;
  a[p][p] -= t * apq;
  a[q][q] += t * apq;
  a[p][q] = a[q][p] = select(t == 0.0, apq, Packet{});
  for (int k = 0; k < Rows; ++k)
  {
    if (k != p && k != q)
    {
      const Packet x = a[k][p], y = a[k][q];
      a[k][p] = a[p][k] = c * x - s * y;
      a[k][q] = a[q][k] = s * x + c * y;
    }
    const Packet vx = v[k][p], vy = v[k][q];
    v[k][p] = c * vx - s * vy;
    v[k][q] = s * vx + c * vy;
  }
}

//------------------------------------------------------------------------------
/**
 * @brief Calls work(number of nodes as a constant, batch, nodes, lower triangles) for each batch of
 * elements: concurrently only for batches that share no vertex, and in a fixed order for each
 * vertex.
 *
 * For PowerMean and Maximum the rank-one term that couples all elements is omitted: the derivative
 * of the slopes is taken with the mean or the maximum itself held fixed.
 */
template <int Dim, class Work>
void forEachHessian(const ObjectiveSum& objective, HessianForm form, const Work& work)
{
  const ObjectiveSumState& sum = objective.state();
  const ElementSum& elements = sum.elements;
  const ObjectiveTemplate objectiveTemplate = sum.function.objectiveTemplate;
  const bool analytic = hasAnalyticHessian(sum.objective);
  const bool scaled = objectiveTemplate == ObjectiveTemplate::PowerMean ||
    objectiveTemplate == ObjectiveTemplate::Maximum;
  const double F = scaled ? objective.value() : 0.0;
  // Called through a pointer: one body for all templates.
  using SlopeOfTemplate =
    Packet (ElementFunction::*)(const BatchContext&, const Batch&, double) const;
  const SlopeOfTemplate slopeOfTemplate = withTemplate(objectiveTemplate,
    [](auto formOfSum) -> SlopeOfTemplate
    { return &ElementFunction::slope<decltype(formOfSum)::value>; });
  const auto slope = [&](const BatchContext& context, const Batch& batch)
  { return (sum.function.*slopeOfTemplate)(context, batch, F); };
  elements.forEachChunk(
    [&](Index i)
    {
      const ElementSum::Chunk& chunk = elements.chunks()[i];
      const BatchContext context = elements.context(chunk);
      const BatchEvaluator evaluate = elements.evaluator(chunk, true);
      withNodes(*context.topology,
        [&](auto nodesOfCell)
        {
          constexpr int Nodes = decltype(nodesOfCell)::value;
          Packet h[entriesFor<Dim>(Nodes)];
          Batch batch;
          BatchNodes nodes;
          for (Index begin = chunk.begin; begin < chunk.end; begin += PacketWidth)
          {
            const int count = static_cast<int>(std::min<Index>(PacketWidth, chunk.end - begin));
            gather<Nodes>(context, elements.order(chunk), begin, count, batch, nodes);
            if (analytic)
            {
              ratioHessians<Nodes, Dim>(context, sum.function, batch, form, h);
            }
            else
            {
              differences<Nodes, Dim>(context, evaluate, slope, batch, h);
            }
            work(nodesOfCell, batch, nodes, h);
          }
        });
    });
}
}
#endif
