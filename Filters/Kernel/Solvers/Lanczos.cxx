// SPDX-License-Identifier: BSD-3-Clause
#include "Lanczos.h"

#include "SolverOptions.h"

#include "Tridiagonal.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Random.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index VectorChunk = 1024; // entries per chunk of the ordered sums
constexpr Index ChunksAtOnce = 4;   // number of chunks per task of a thread

Index chunksOf(Index n)
{
  return (n + VectorChunk - 1) / VectorChunk;
}

/// Calls work(chunk, begin, end) for each chunk of a vector.
template <class Work>
void forEachPiece(Index n, int threads, const Work& work)
{
  const Index chunks = chunksOf(n);
  parallelFor(chunks, ChunksAtOnce, threads,
    [&](Index chunk) { work(chunk, chunk * VectorChunk, std::min(n, (chunk + 1) * VectorChunk)); });
}

/// A scalar product with eight independent sums, for vectorization; the order is fixed.
double sumOf(const double* x, const double* y, Index begin, Index end)
{
  double sums[8] = {};
  Index i = begin;
  for (; i + 8 <= end; i += 8)
  {
    for (int l = 0; l < 8; ++l)
    {
      sums[l] += x[i + l] * y[i + l];
    }
  }
  for (; i < end; ++i)
  {
    sums[0] += x[i] * y[i];
  }
  return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

/// A scalar product, bitwise the same for any number of threads.
double product(const std::vector<double>& x, const std::vector<double>& y, int threads)
{
  const auto n = static_cast<Index>(x.size());
  std::vector<double> partial(chunksOf(n));
  forEachPiece(n, threads,
    [&](Index chunk, Index begin, Index end)
    { partial[chunk] = sumOf(x.data(), y.data(), begin, end); });
  double sum = 0.0;
  for (const double p : partial)
  {
    sum += p;
  }
  return sum;
}

/// w -= V (V^T w) for the first `count` columns of V, each of length n.
void orthogonalize(
  const std::vector<std::vector<double>>& basis, Index count, std::vector<double>& w, int threads)
{
  const auto n = static_cast<Index>(w.size());
  // Classical Gram-Schmidt: all coefficients refer to the same w, so that the chunks are
  // independent.
  std::vector<double> partial(chunksOf(n) * count), coefficients(count, 0.0);
  forEachPiece(n, threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index j = 0; j < count; ++j)
      {
        partial[chunk * count + j] = sumOf(basis[j].data(), w.data(), begin, end);
      }
    });
  // The order of the chunks is fixed, so the sums do not depend on the number of threads.
  for (Index chunk = 0; chunk < chunksOf(n); ++chunk)
  {
    for (Index j = 0; j < count; ++j)
    {
      coefficients[j] += partial[chunk * count + j];
    }
  }
  forEachPiece(n, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index j = 0; j < count; ++j)
      {
        const double c = coefficients[j];
        const double* v = basis[j].data();
        for (Index i = begin; i < end; ++i)
        {
          w[i] -= c * v[i];
        }
      }
    });
}

/// The sum of the basis vectors times weights.
std::vector<double> combine(const std::vector<std::vector<double>>& basis,
  const std::vector<double>& weights, Index n, int threads)
{
  std::vector<double> result(n, 0.0);
  forEachPiece(n, threads,
    [&](Index, Index begin, Index end)
    {
      // A piece of the result stays in the cache while all vectors are added to it.
      for (std::size_t j = 0; j < weights.size(); ++j)
      {
        for (Index i = begin; i < end; ++i)
        {
          result[i] += weights[j] * basis[j][i];
        }
      }
    });
  return result;
}

std::vector<double> startVector(Index n)
{
  std::vector<double> x(n);
  std::uint64_t state = SplitMix::Increment;
  for (double& v : x)
  {
    state += SplitMix::Increment;
    // All positive, like the lowest mode.
    v = SplitMix::unit(SplitMix::hash(state)) + 0.25;
  }
  return x;
}

/// Below this amount of work, several threads are slower than one.
int threadsFor(const SparseMatrix& matrix, const LanczosOptions& options)
{
  constexpr Index worthwhile = 300000; // entries
  return matrix.nonzeros() < worthwhile ? 1 : options.threads;
}

void scale(std::vector<double>& x, double factor)
{
  for (double& v : x)
  {
    v *= factor;
  }
}
}

//------------------------------------------------------------------------------
Spectrum extremeEigenvalues(const SparseMatrix& matrix, const LanczosOptions& options)
{
  const Index n = matrix.size;
  if (n == 0)
  {
    throw Error("the matrix is empty: it has no unknowns");
  }
  const Stopwatch time;
  const int threads = threadsFor(matrix, options);
  Spectrum spectrum;
  std::vector<std::vector<double>> basis;
  Tridiagonal t;
  std::vector<double> w = startVector(n);
  scale(w, 1.0 / std::sqrt(product(w, w, threads)));
  double beta = 0.0, size = 0.0;
  RitzPair low, high;
  const Index maxSteps = std::min(n, std::max<Index>(1, options.maxIterations));
  Index nextCheck = std::min<Index>(maxSteps, 12);
  for (Index k = 0; k < maxSteps; ++k)
  {
    // Whenever the number of vectors has doubled, check the memory for as many again.
    if ((k & (k - 1)) == 0)
    {
      requireMemory(static_cast<double>(k) * static_cast<double>(n) * sizeof(double),
        "room for " + std::to_string(k) + " more basis vectors",
        "allow fewer iterations, or use a smaller matrix");
    }
    basis.push_back(w);
    matrix.multiply(basis[k].data(), w.data(), threads);
    const double alpha = product(basis[k], w, threads);
    if (!std::isfinite(alpha))
    {
      throw Error("the matrix has entries that are not finite numbers");
    }
    // Full orthogonalization, twice for accuracy: no copies of eigenvalues appear.
    orthogonalize(basis, k + 1, w, threads);
    orthogonalize(basis, k + 1, w, threads);
    beta = std::sqrt(product(w, w, threads));
    t.diagonal.push_back(alpha);
    size = std::max({ size, std::abs(alpha), beta });
    // An invariant subspace: its eigenvalues are exact.
    const bool invariant = beta <= 1e-14 * size;
    const bool stop = time.reached(options.timeLimit) ||
      (options.progress &&
        !options.progress(static_cast<double>(k + 1) / static_cast<double>(maxSteps)));
    // Ritz pairs are computed at increasing intervals, because their cost grows with the steps.
    if (k + 1 >= nextCheck || k + 1 == maxSteps || invariant || stop)
    {
      low = ritzPair(t, true, invariant ? 0.0 : beta);
      high = ritzPair(t, false, invariant ? 0.0 : beta);
      spectrum.converged = low.bound <= options.tolerance * std::abs(low.value) &&
        high.bound <= options.tolerance * std::abs(high.value);
      spectrum.iterations = k + 1;
      nextCheck = k + 1 + std::max<Index>(4, (k + 1) / 10);
      if (spectrum.converged || invariant || stop)
      {
        break;
      }
    }
    t.beside.push_back(beta);
    scale(w, 1.0 / beta);
  }
  // The last beta couples to a vector that was not used, and is not part of the matrix.
  t.beside.resize(t.diagonal.size() - 1);
  spectrum.smallest = low.value;
  spectrum.largest = high.value;
  spectrum.smallestBound = low.bound;
  spectrum.largestBound = high.bound;
  // Rounding changes eigenvalues by about this much, regardless of the bounds.
  const double rounding = 1e-14 * std::max(std::abs(low.value), std::abs(high.value));
  spectrum.definite = low.value > std::max(rounding, spectrum.converged ? low.bound : 0.0);
  spectrum.condition = spectrum.definite ? high.value / low.value : 0.0;
  spectrum.smallestVector = combine(basis, low.vector, n, threads);
  spectrum.largestVector = combine(basis, high.vector, n, threads);
  return spectrum;
}

//------------------------------------------------------------------------------
std::vector<double> inverseDiagonal(const SparseMatrix& matrix)
{
  std::vector<double> inverse(matrix.size);
  for (Index i = 0; i < matrix.size; ++i)
  {
    const double d = matrix.at(i, i);
    if (!(d > 0.0))
    {
      throw Error("the matrix is not positive definite: the diagonal entry of row " +
        std::to_string(i) + " is " + std::to_string(d));
    }
    inverse[i] = 1.0 / d;
  }
  return inverse;
}

namespace
{
/// The Lanczos matrix implicitly generated by the steps of conjugate gradients.
class RitzValues
{
public:
  /// A step of length `step`; `ratio` is the ratio of the products (r, B r) after and before it.
  void add(double step, double ratio)
  {
    // The coefficients of CG determine the Lanczos matrix (Y. Saad, "Iterative Methods for Sparse
    // Linear Systems", Section 6.7.3).
    this->T.diagonal.push_back(1.0 / step + this->Last);
    this->T.beside.push_back(std::sqrt(ratio) / step);
    this->Last = ratio / step;
  }
  void report(SolveReport& report)
  {
    const auto size = static_cast<Index>(this->T.diagonal.size());
    if (size > 0)
    {
      this->T.beside.resize(this->T.diagonal.size() - 1);
      report.ritzSmallest = this->T.eigenvalue(0);
      report.ritzLargest = this->T.eigenvalue(size - 1);
    }
  }

private:
  Tridiagonal T;
  double Last = 0.0;
};
}

//------------------------------------------------------------------------------
SolveReport solveConjugateGradients(const SparseMatrix& matrix, const std::vector<double>& b,
  std::vector<double>& x, double tolerance, const LanczosOptions& options,
  const Preconditioning& precondition)
{
  const Index n = matrix.size;
  const int threads = threadsFor(matrix, options);
  const Stopwatch time;
  SolveReport report;
  x.assign(n, 0.0);
  const std::vector<double> inverse = inverseDiagonal(matrix);
  std::vector<double> r = b, z(n), q(n);
  const double norm = std::sqrt(product(b, b, threads));
  if (!std::isfinite(norm))
  {
    throw Error("the right side has values that are not finite numbers");
  }
  if (norm == 0.0)
  {
    report.converged = true;
    return report;
  }
  // z = B r, and the product of both.
  const auto apply = [&]
  {
    if (precondition)
    {
      precondition(r.data(), z.data());
    }
    for (Index i = 0; i < n && !precondition; ++i)
    {
      z[i] = inverse[i] * r[i];
    }
    const double rho = product(r, z, threads);
    if (!(rho >= 0.0))
    {
      throw Error("the preconditioner is not positive definite: choose Jacobi");
    }
    return rho;
  };
  double rho = apply();
  std::vector<double> p = z;
  RitzValues ritz;
  report.residual = 1.0;
  while (report.residual > tolerance && report.iterations < options.maxIterations &&
    !time.reached(options.timeLimit))
  {
    matrix.multiply(p.data(), q.data(), threads);
    // One step of conjugate gradients (Golub and Van Loan, section 11.5).
    const double curvature = product(p, q, threads);
    if (!(curvature > 0.0))
    {
      throw Error("the matrix is not positive definite: the problem has no unique solution");
    }
    const double step = rho / curvature;
    for (Index i = 0; i < n; ++i)
    {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    const double next = apply();
    for (Index i = 0; i < n; ++i)
    {
      p[i] = z[i] + next / rho * p[i];
    }
    ritz.add(step, next / rho);
    rho = next;
    report.residual = std::sqrt(product(r, r, threads)) / norm;
    ++report.iterations;
    if (options.progress &&
      !options.progress(
        static_cast<double>(report.iterations) / static_cast<double>(options.maxIterations)))
    {
      break;
    }
  }
  ritz.report(report);
  // The residual was updated step by step: check the true residual.
  const bool met = report.residual <= tolerance;
  matrix.multiply(x.data(), q.data(), threads);
  for (Index i = 0; i < n; ++i)
  {
    r[i] = b[i] - q[i];
  }
  report.residual = std::sqrt(product(r, r, threads)) / norm;
  report.converged = met && report.residual <= ResidualFactor * tolerance;
  return report;
}
}
