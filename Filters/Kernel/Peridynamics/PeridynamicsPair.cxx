// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicsPair.h"

#include <algorithm>

namespace tautline
{
namespace
{
// Gauss rules on (0, 1): nodes and weights.
constexpr double gauss8[8] = { 0.019855071751231884, 0.10166676129318664, 0.23723379504183550,
  0.40828267875217510, 0.59171732124782490, 0.76276620495816450, 0.89833323870681336,
  0.98014492824876812 };
constexpr double weights8[8] = { 0.050614268145188130, 0.11119051722668724, 0.15685332293894364,
  0.18134189168918099, 0.18134189168918099, 0.15685332293894364, 0.11119051722668724,
  0.050614268145188130 };
constexpr double gauss6[6] = { 0.033765242898423987, 0.16939530676686774, 0.38069040695840155,
  0.61930959304159845, 0.83060469323313226, 0.96623475710157601 };
constexpr double weights6[6] = { 0.085662246189585173, 0.18038078652406930, 0.23395696728634552,
  0.23395696728634552, 0.18038078652406930, 0.085662246189585173 };

// Radon's rule of degree 5 on a triangle: centroid and two orbits; the centroid and the first orbit
// with the weights of `coarse` are of degree 2.
constexpr double orbit[2] = { 0.10128650732345634, 0.47014206410511509 };
constexpr double fineWeights[3] = { 0.225, 0.12593918054482715, 0.13239415278850619 };
constexpr double coarseWeights[2] = { 0.48411983265637886, 0.17196005578120705 };

constexpr int MaxDepth = 9, MaxTouchingDepth = 4, MaxParts = 3000;
constexpr double pieceLength = 2.0; // in t = asinh(s / d): eight nodes are then exact to 3e-9

int momentAt(int degree, int y)
{
  return degree * (degree + 1) / 2 + y;
}

double smoothStep(double s)
{
  return s * s * (3.0 - 2.0 * s);
}
}

//------------------------------------------------------------------------------
PairIntegrator::PairIntegrator(const PeridynamicOptions& options, int functions)
  : Kernel(options.kernel, options.horizon)
  , Horizon(options.horizon)
  , Tolerance(options.tolerance)
  , Functions(functions)
  , Components(isElastic(options.model) ? 3 : 1)
{
  this->FirstDegree = this->Components == 3 ? 2 : 0;
  this->LastDegree = this->FirstDegree + (functions == 1 ? 0 : 2);
  // The error of the Gauss rule with n nodes is about rho^(-2n), where rho + 1/rho is the sum of
  // the distances.
  const double rho = std::pow(0.1 * this->Tolerance, -1.0 / (2.0 * NodeCount));
  this->EllipseSum = rho + 1.0 / rho;
  // Integrals over the second triangle behave like a power of the distance to it; graded, like a
  // high one.
  const double p =
    options.kernel.shape == KernelShape::Power ? options.kernel.exponent - this->FirstDegree : 0.0;
  const double power = (options.basis == PeridynamicBasis::Linear ? 4.0 : 2.0) - std::max(p, 0.0);
  this->BlindDepth =
    std::clamp(static_cast<int>(std::lround(-0.5 * std::log10(this->Tolerance))), 1, 4);
  this->EdgeGrading = std::clamp(std::ceil(4.0 / (power + 1.0)), 2.0, 20.0);
}

//------------------------------------------------------------------------------
bool PairIntegrator::clip(Vec2 a, Vec2 b, double& t0, double& t1) const
{
  const double square = this->Horizon * this->Horizon;
  const double fromA = dot(a, a) - square, fromB = dot(b, b) - square;
  t0 = 0.0;
  t1 = 1.0;
  if (fromA <= 0.0 && fromB <= 0.0)
  {
    return true;
  }
  const Vec2 e = b - a;
  const double alpha = dot(e, e), beta = dot(e, a);
  const double root = beta * beta - alpha * fromA;
  if (!(root > 0.0))
  {
    return false;
  }
  const double r = std::sqrt(root);
  t0 = fromA <= 0.0 ? 0.0 : (-beta - r) / alpha;
  t1 = fromB <= 0.0 ? 1.0 : (-beta + r) / alpha;
  return t0 < t1 && t0 < 1.0 && t1 > 0.0 && t0 >= 0.0 && t1 <= 1.0;
}

//------------------------------------------------------------------------------
/// Calls work(x, y, squares, weights) for nodes z on the segment; a weight is the weight of the
/// angle times |z|^2.
template <class Work>
void PairIntegrator::forEachNodes(Vec2 a, Vec2 b, const Work& work) const
{
  const Vec2 e = b - a;
  const double length = std::sqrt(dot(e, e)), twice = cross(a, b);
  const double ra = std::sqrt(dot(a, a)), rb = std::sqrt(dot(b, b));
  if (!(length > 0.0) || std::abs(twice) <= 1e-15 * length * (ra + rb))
  {
    return; // seen edge-on: no angle
  }
  Nodes x, y, squares, weights;
  // Far from the segment, one Gauss rule suffices: the pole is outside the ellipse of convergence.
  if (2.0 * (ra + rb) >= this->EllipseSum * length)
  {
    for (int l = 0; l < NodeCount; ++l)
    {
      x[l] = a[0] + gauss8[l] * e[0];
      y[l] = a[1] + gauss8[l] * e[1];
      squares[l] = x[l] * x[l] + y[l] * y[l];
      weights[l] = weights8[l] * twice;
    }
    work(x, y, squares, weights);
    return;
  }
  // Near the segment, the nodes are spaced by s = d sinh t, where d is the distance from the line.
  const Vec2 along = (1.0 / length) * e;
  const double d = std::abs(twice) / length, sign = twice > 0.0 ? 1.0 : -1.0;
  const Vec2 foot = { sign * d * along[1], -sign * d * along[0] };
  const double first = std::asinh(dot(a, along) / d), last = std::asinh(dot(b, along) / d);
  const int pieces = std::max(1, static_cast<int>(std::ceil((last - first) / pieceLength)));
  const double step = (last - first) / pieces;
  for (int piece = 0; piece < pieces; ++piece)
  {
    for (int l = 0; l < NodeCount; ++l)
    {
      const double grown = std::exp(first + step * (piece + gauss8[l]));
      const double s = 0.5 * d * (grown - 1.0 / grown), r = 0.5 * d * (grown + 1.0 / grown);
      x[l] = foot[0] + s * along[0];
      y[l] = foot[1] + s * along[1];
      squares[l] = r * r;
      weights[l] = weights8[l] * step * sign * d * r;
    }
    work(x, y, squares, weights);
  }
}

//------------------------------------------------------------------------------
void PairIntegrator::alongEdge(Vec2 a, Vec2 b, double* m) const
{
  this->forEachNodes(a, b,
    [&](const Nodes& x, const Nodes& y, const Nodes& squares, const Nodes& weights)
    {
      Nodes ratios[5], left, right;
      this->Kernel.ratios(squares, this->FirstDegree, this->LastDegree, ratios, this->FromOrigin);
      for (int degree = this->FirstDegree; degree <= this->LastDegree; ++degree)
      {
        for (int power = 0; power <= degree; ++power)
        {
          for (int l = 0; l < NodeCount; ++l)
          {
            left[l] = weights[l] * ratios[degree][l];
            right[l] = 1.0;
          }
          for (int k = 0; k < degree; ++k)
          {
            const Nodes& factor = k < power ? y : x;
            for (int l = 0; l < NodeCount; ++l)
            {
              left[l] *= factor[l];
            }
          }
          m[momentAt(degree, power)] += ((left[0] + left[4]) + (left[1] + left[5])) +
            ((left[2] + left[6]) + (left[3] + left[7]));
        }
      }
    });
}

//------------------------------------------------------------------------------
void PairIntegrator::alongCircle(Vec2 a, Vec2 b, double* m) const
{
  // Integrals of cos^i sin^j over the angle, in closed form.
  const double angle = std::atan2(cross(a, b), dot(a, b));
  const Vec2 p = (1.0 / std::sqrt(dot(a, a))) * a, q = (1.0 / std::sqrt(dot(b, b))) * b;
  const auto change = [&](auto f) { return f(q[0], q[1]) - f(p[0], p[1]); };
  const auto add = [&](int degree, int power, double value)
  { m[momentAt(degree, power)] += this->Kernel.atHorizon(degree, this->FromOrigin) * value; };
  const double xy = change([](double x, double y) { return x * y; });
  if (this->FirstDegree == 0)
  {
    add(0, 0, angle);
    if (this->LastDegree == 0)
    {
      return;
    }
    add(1, 0, q[1] - p[1]);
    add(1, 1, p[0] - q[0]);
  }
  add(2, 0, 0.5 * (angle + xy));
  add(2, 1, 0.5 * (q[1] * q[1] - p[1] * p[1]));
  add(2, 2, 0.5 * (angle - xy));
  if (this->LastDegree < 4)
  {
    return;
  }
  add(3, 0, change([](double, double y) { return y - y * y * y / 3.0; }));
  add(3, 1, change([](double x, double) { return -x * x * x / 3.0; }));
  add(3, 2, change([](double, double y) { return y * y * y / 3.0; }));
  add(3, 3, change([](double x, double) { return -x + x * x * x / 3.0; }));
  add(4, 0, 0.375 * (angle + xy) + 0.25 * change([](double x, double y) { return x * x * x * y; }));
  add(4, 1, -0.25 * change([](double x, double) { return x * x * x * x; }));
  add(4, 2, 0.125 * (angle - change([](double x, double y) { return x * y * (x * x - y * y); })));
  add(4, 3, 0.25 * change([](double, double y) { return y * y * y * y; }));
  add(4, 4, 0.375 * (angle - xy) - 0.25 * change([](double x, double y) { return x * y * y * y; }));
}

//------------------------------------------------------------------------------
/// Moments of z = y - x over the part of the second triangle in the disk around x; false if there
/// is none.
bool PairIntegrator::moments(const Vec2* corners, Vec2 x, double* m)
{
  // In polar coordinates, the integral is a sum over the edges: along the part of each edge inside
  // the disk, and along the adjacent arcs of the circle.
  const Vec2 z[3] = { corners[0] - x, corners[1] - x, corners[2] - x };
  double t0[3], t1[3];
  bool inside[3], any = false, all = true;
  for (int k = 0; k < 3; ++k)
  {
    inside[k] = this->clip(z[k], z[(k + 1) % 3], t0[k], t1[k]);
    any = any || inside[k];
    all = all && inside[k] && t0[k] == 0.0 && t1[k] == 1.0;
  }
  this->CutSamples += any && !all;
  if (!any)
  {
    return false; // x is not in the triangle, so the disk misses it
  }
  std::fill(m + momentAt(this->FirstDegree, 0), m + momentAt(this->LastDegree + 1, 0), 0.0);
  for (int k = 0; k < 3; ++k)
  {
    const Vec2 a = z[k], b = z[(k + 1) % 3];
    if (!inside[k])
    {
      this->alongCircle(a, b, m);
      continue;
    }
    const Vec2 p = t0[k] > 0.0 ? a + t0[k] * (b - a) : a, q = t1[k] < 1.0 ? a + t1[k] * (b - a) : b;
    if (t0[k] > 0.0)
    {
      this->alongCircle(a, p, m);
    }
    this->alongEdge(p, q, m);
    if (t1[k] < 1.0)
    {
      this->alongCircle(q, b, m);
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool PairIntegrator::momentsAround(const Vec2* corners, Vec2 x, bool inside, double* m)
{
  this->FromOrigin = inside;
  const bool found = this->moments(corners, x, m);
  this->FromOrigin = false;
  return found;
}

//------------------------------------------------------------------------------
/// Adds the integrand at x to both rules.
void PairIntegrator::sample(Vec2 x, double weight, double coarseWeight)
{
  double m[Moments];
  if (!this->moments(this->Pair->second, x, m))
  {
    return;
  }
  const TrianglePair& pair = *this->Pair;
  const int n = 2 * this->Functions;
  double values[6] = { 1.0, -1.0 }; // of phi_i, extended from both sides, at x
  if (this->Functions == 3)
  {
    const auto barycentric = [x](const Vec2* c, int k)
    {
      const Vec2 a = c[(k + 1) % 3], b = c[(k + 2) % 3];
      return cross(a - x, b - x) / cross(a - c[k], b - c[k]);
    };
    for (int k = 0; k < 3; ++k)
    {
      values[k] = barycentric(pair.first, k);
    }
    for (int k = 0; k < 3; ++k)
    {
      const double other = barycentric(pair.second, k);
      if (pair.shared[k] >= 0)
      {
        // Both vanish together at common corners: use the difference of the two.
        values[pair.shared[k]] -= other;
        values[3 + k] = 0.0;
      }
      else
      {
        values[3 + k] = -other;
      }
    }
  }
  // (phi_i(x) - phi_i(y)) (phi_j(x) - phi_j(y)) is a quadratic polynomial in z = y - x.
  const int d = this->FirstDegree;
  for (int i = 0; i < this->NumberUsed; ++i)
  {
    const int a = this->Used[i];
    const Vec2 ga = this->Gradients[a];
    for (int j = i; j < this->NumberUsed; ++j)
    {
      const int b = this->Used[j];
      const Vec2 gb = this->Gradients[b];
      const double constant = values[a] * values[b];
      const Vec2 linear = { -values[a] * gb[0] - values[b] * ga[0],
        -values[a] * gb[1] - values[b] * ga[1] };
      const double xx = ga[0] * gb[0], xy = ga[0] * gb[1] + ga[1] * gb[0], yy = ga[1] * gb[1];
      for (int c = 0; c < this->Components; ++c)
      {
        // The factor z_x^(2-c) z_y^c of the tensor kernel raises the degree by two.
        double value = constant * m[momentAt(d, c)];
        if (this->Functions == 3)
        {
          value += linear[0] * m[momentAt(d + 1, c)] + linear[1] * m[momentAt(d + 1, c + 1)] +
            xx * m[momentAt(d + 2, c)] + xy * m[momentAt(d + 2, c + 1)] +
            yy * m[momentAt(d + 2, c + 2)];
        }
        const int at = (a * n + b) * this->Components + c;
        this->Fine[at] += weight * value;
        this->Coarse[at] += coarseWeight * value;
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Two rules on a part of the first triangle; true if they agree.
bool PairIntegrator::applyRules(const Triangle& part, bool cut)
{
  this->Fine.fill(0.0);
  this->Coarse.fill(0.0);
  const Vec2 a = part[0].at, b = part[1].at, c = part[2].at;
  const double area = 0.5 * std::abs(cross(b - a, c - a));
  const int touching = part[0].touches + part[1].touches + part[2].touches;
  double agreement = std::sqrt(this->Tolerance); // the error of the fine rule is the square
  if (touching == 0)
  {
    const Vec2 centre = (1.0 / 3.0) * (a + b + c);
    // Not where circles cut the second triangle, because the integrand has kinks there.
    agreement = cut ? 3.0 * std::pow(this->Tolerance, 0.75) : agreement;
    this->sample(centre, area * fineWeights[0], area * coarseWeights[0]);
    for (int ring = 0; ring < 2; ++ring)
    {
      for (const Corner& corner : part)
      {
        const Vec2 x = (1.0 - 3.0 * orbit[ring]) * corner.at + 3.0 * orbit[ring] * centre;
        this->sample(x, area * fineWeights[1 + ring], ring == 0 ? area * coarseWeights[1] : 0.0);
      }
    }
  }
  else
  {
    // Rotated so that the single touching (or single nontouching) corner is the apex.
    int apex = 0;
    while (part[apex].touches != (touching == 1))
    {
      ++apex;
    }
    const Vec2 w = part[apex].at, u = part[(apex + 1) % 3].at, v = part[(apex + 2) % 3].at;
    const double g = this->EdgeGrading;
    agreement = this->Tolerance;
    const auto tensor = [&](const double* nodes, const double* weights, int count, bool fine)
    {
      for (int i = 0; i < count; ++i)
      {
        const double s = std::pow(nodes[i], g), ds = g * s / nodes[i] * weights[i];
        // Measured from the base (two corners touch) or from the apex (one touches).
        const double height = touching == 1 ? s : 1.0 - s;
        for (int j = 0; j < count; ++j)
        {
          const double t = smoothStep(nodes[j]);
          const double dt = 6.0 * nodes[j] * (1.0 - nodes[j]) * weights[j];
          const Vec2 x = touching == 1
            ? w + s * ((1.0 - t) * (u - w) + t * (v - w))
            : (1.0 - t) * u + t * v + s * ((1.0 - t) * (w - u) + t * (w - v));
          const double weight = 2.0 * area * height * ds * dt;
          this->sample(x, fine ? weight : 0.0, fine ? 0.0 : weight);
        }
      }
    };
    tensor(gauss8, weights8, 8, true);
    tensor(gauss6, weights6, 6, false);
  }
  double difference = 0.0;
  for (int at = 0; at < this->blockSize(); ++at)
  {
    difference = std::max(difference, std::abs(this->Fine[at] - this->Coarse[at]));
  }
  return difference <= agreement * this->Scale;
}

//------------------------------------------------------------------------------
/// Whether circles around points of a part may cut the second triangle; also detects that none
/// reaches it.
bool PairIntegrator::isCut(const Triangle& part, bool& apart) const
{
  const double square = this->Horizon * this->Horizon;
  const Vec2* other = this->Pair->second;
  // The farthest corners determine whether everything is within the horizon, the nearest edge
  // points whether nothing is.
  double farthest = 0.0, nearest = 1e300;
  for (const Corner& corner : part)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 d = corner.at - other[k];
      farthest = std::max(farthest, dot(d, d));
    }
  }
  apart = false;
  if (farthest <= square)
  {
    return false;
  }
  const auto toSegment = [&](Vec2 p, Vec2 a, Vec2 b)
  {
    const Vec2 e = b - a, d = p - a;
    const double t = std::clamp(dot(d, e) / dot(e, e), 0.0, 1.0);
    const Vec2 rest = d - t * e;
    nearest = std::min(nearest, dot(rest, rest));
  };
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      toSegment(part[i].at, other[k], other[(k + 1) % 3]);
      toSegment(other[i], part[k].at, part[(k + 1) % 3].at);
    }
  }
  apart = nearest >= square;
  return !apart;
}

//------------------------------------------------------------------------------
void PairIntegrator::refine(const Triangle& part, int depth)
{
  bool apart;
  const bool cut = this->isCut(part, apart);
  if (apart)
  {
    return;
  }
  const bool touching = part[0].touches || part[1].touches || part[2].touches;
  this->CutSamples = 0;
  const bool agreed = this->applyRules(part, cut);
  // Two rules also agree if neither has a point in the cut part.
  const bool blind = cut && this->CutSamples == 0 && depth < this->BlindDepth;
  if ((agreed && !blind) || depth == MaxDepth || (touching && !cut && depth >= MaxTouchingDepth) ||
    ++this->Parts > MaxParts)
  {
    for (int at = 0; at < this->blockSize(); ++at)
    {
      this->Sum[at] += this->Fine[at];
    }
    return;
  }
  // Quarter the part at the midpoints of the edges.
  const auto between = [](const Corner& a, const Corner& b) {
    return Corner{ 0.5 * (a.at + b.at), a.touches && b.touches };
  };
  const Corner ab = between(part[0], part[1]), bc = between(part[1], part[2]),
               ca = between(part[2], part[0]);
  this->refine({ part[0], ab, ca }, depth + 1);
  this->refine({ ab, part[1], bc }, depth + 1);
  this->refine({ ca, bc, part[2] }, depth + 1);
  this->refine({ ab, bc, ca }, depth + 1);
}

//------------------------------------------------------------------------------
void PairIntegrator::identicalPair(const TrianglePair& pair, double* block)
{
  const Vec2* c = pair.first;
  const double twiceArea = cross(c[1] - c[0], c[2] - c[0]);
  // The differences of two points of a triangle fill a hexagon; one half of it suffices.
  const Vec2 e0 = c[1] - c[0], e1 = c[2] - c[1], e2 = c[0] - c[2];
  const Vec2 hexagon[4] = { e0, -1.0 * e2, e1, -1.0 * e0 };
  const int degree = this->Components == 3 ? 4 : 2;
  const double f[3] = { this->Kernel.atHorizon(degree, true),
    this->Kernel.atHorizon(degree + 1, true), this->Kernel.atHorizon(degree + 2, true) };
  double m[5] = {};
  // F_d(R) - 2 F_d+1(R) / rho + F_d+2(R) / rho^2, where rho is the distance to the hexagon, and R
  // the smaller of rho and the horizon.
  const auto along = [&](Vec2 a, Vec2 b, bool inside)
  {
    this->forEachNodes(a, b,
      [&](const Nodes& x, const Nodes& y, const Nodes& squares, const Nodes& weights)
      {
        Nodes ratios[RadialKernel::Orders];
        if (inside)
        {
          this->Kernel.ratios(squares, degree, degree + 2, ratios, true);
        }
        for (int l = 0; l < NodeCount; ++l)
        {
          const double rho = std::sqrt(squares[l]);
          const double radial = inside
            ? ratios[degree][l] - 2.0 * ratios[degree + 1][l] + ratios[degree + 2][l]
            : (f[0] - 2.0 * f[1] / rho + f[2] / squares[l]) /
              (squares[l] * (degree == 4 ? squares[l] * squares[l] : squares[l]));
          for (int power = 0; power <= degree; ++power)
          {
            double value = weights[l] * radial;
            for (int k = 0; k < degree; ++k)
            {
              value *= k < power ? y[l] : x[l];
            }
            m[power] += 2.0 * value; // the other half of the hexagon is the same
          }
        }
      });
  };
  for (int k = 0; k < 3; ++k)
  {
    const Vec2 a = hexagon[k], b = hexagon[k + 1];
    double t0, t1;
    if (!this->clip(a, b, t0, t1))
    {
      along(a, b, false);
      continue;
    }
    const Vec2 p = t0 > 0.0 ? a + t0 * (b - a) : a, q = t1 < 1.0 ? a + t1 * (b - a) : b;
    if (t0 > 0.0)
    {
      along(a, p, false);
    }
    along(p, q, true);
    if (t1 < 1.0)
    {
      along(q, b, false);
    }
  }
  const int n = 2 * this->Functions;
  for (int i = 0; i < 3; ++i)
  {
    const Vec2 gi = this->Gradients[i];
    for (int j = 0; j < 3; ++j)
    {
      const Vec2 gj = this->Gradients[j];
      for (int k = 0; k < this->Components; ++k)
      {
        block[(i * n + j) * this->Components + k] = 0.5 * 0.5 * twiceArea *
          (gi[0] * gj[0] * m[k] + (gi[0] * gj[1] + gi[1] * gj[0]) * m[k + 1] +
            gi[1] * gj[1] * m[k + 2]);
      }
    }
  }
}

//------------------------------------------------------------------------------
void PairIntegrator::integrate(const TrianglePair& pair, double* block)
{
  this->Pair = &pair;
  std::fill(block, block + this->blockSize(), 0.0);
  const int n = 2 * this->Functions;
  // Shared functions occur once, in the rows of the first triangle.
  this->NumberUsed = 0;
  for (int i = 0; i < n; ++i)
  {
    this->Gradients[i] = {};
    const bool taken = i >= this->Functions && this->Functions == 3 && pair.shared[i - 3] >= 0;
    if (!taken)
    {
      this->Used[this->NumberUsed++] = i;
    }
  }
  if (this->Functions == 3)
  {
    const Vec2* c = pair.second;
    const double twice = cross(c[1] - c[0], c[2] - c[0]);
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 e = c[(k + 2) % 3] - c[(k + 1) % 3];
      const int i = pair.identical ? k : pair.shared[k] >= 0 ? pair.shared[k] : 3 + k;
      this->Gradients[i] = (1.0 / twice) * Vec2{ -e[1], e[0] };
    }
  }
  if (pair.identical)
  {
    if (this->Functions == 3)
    {
      this->identicalPair(pair, block);
    }
    return; // a constant does not change in its own triangle
  }
  const Vec2 apart = (1.0 / 3.0) *
    ((pair.second[0] - pair.first[0]) + (pair.second[1] - pair.first[1]) +
      (pair.second[2] - pair.first[2]));
  const double square = std::min(dot(apart, apart), this->Horizon * this->Horizon);
  double k;
  this->Kernel.evaluate(&square, &k, 1);
  // A kernel may vanish at a distance; its mean does not.
  const double mean = 2.0 * this->Kernel.atHorizon(0) / (this->Horizon * this->Horizon);
  // The possible contribution of a pair: for triangles larger than the disk, limited by the disk;
  // for shared linear functions, limited by differences over the horizon.
  const auto areaOf = [](const Vec2* c) { return 0.5 * std::abs(cross(c[1] - c[0], c[2] - c[0])); };
  const double disc = Pi * this->Horizon * this->Horizon;
  const double first = areaOf(pair.first), second = areaOf(pair.second);
  this->Scale = std::min(first, disc) * std::min(second, disc) * std::max(k, 0.01 * mean);
  this->Scale *= this->Components == 3 ? square : 1.0;
  if (this->Functions == 3 && pair.contacts() > 0)
  {
    this->Scale *= std::min(1.0, disc / std::max(first, second));
  }
  this->Parts = 0;
  this->Sum.fill(0.0);
  Triangle whole;
  for (int i = 0; i < 3; ++i)
  {
    whole[i].at = pair.first[i];
    whole[i].touches = pair.contacts() < 3 &&
      (pair.touching[0] == i || pair.touching[1] == i || pair.touching[2] == i);
  }
  this->refine(whole, 0);
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int c = 0; c < this->Components; ++c)
      {
        block[(i * n + j) * this->Components + c] =
          this->Sum[(std::min(i, j) * n + std::max(i, j)) * this->Components + c];
      }
    }
  }
}
}
