// SPDX-License-Identifier: BSD-3-Clause
#include "Yardstick.h"

#include "Clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace tautline
{
namespace
{
/// Every point is moved by up to this part of an edge in each direction.
constexpr double perturbation = 0.1;
}

//------------------------------------------------------------------------------
Yardstick::Yardstick(int cubes)
{
  const std::int32_t m = cubes + 1;
  std::mt19937 random(1);
  const auto moved = [&random](std::int32_t x)
  { return x + perturbation * (2 * (random() / 4294967296.0) - 1); };
  const std::int32_t step[3] = { 1, m, m * m };
  for (std::int32_t k = 0; k < m; ++k)
  {
    for (std::int32_t j = 0; j < m; ++j)
    {
      for (std::int32_t i = 0; i < m; ++i)
      {
        this->Points.push_back({ moved(i), moved(j), moved(k) });
        if (std::max({ i, j, k }) == cubes)
        {
          continue;
        }
        const std::int32_t first = i + m * (j + m * k);
        const std::int32_t last = first + step[0] + step[1] + step[2];
        for (int a = 0; a < 3; ++a)
        {
          const std::int32_t b = first + step[a];
          const std::int32_t c = b + step[(a + 1) % 3], d = b + step[(a + 2) % 3];
          this->Elements.push_back({ first, b, c, last });
          this->Elements.push_back({ first, d, b, last });
        }
      }
    }
  }
  this->Gradient.resize(this->Points.size());
}

//------------------------------------------------------------------------------
double Yardstick::measure()
{
  const double start = threadTime();
  this->run();
  return (threadTime() - start) / static_cast<double>(this->Elements.size());
}

//------------------------------------------------------------------------------
double Yardstick::measure(int repeats)
{
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i)
  {
    best = std::min(best, this->measure());
  }
  return best;
}

//------------------------------------------------------------------------------
void Yardstick::run()
{
  const double root3 = std::sqrt(3.0), root6 = std::sqrt(6.0);
  this->Sum = 0;
  for (const std::array<std::int32_t, 4>& element : this->Elements)
  {
    const Triple& p = this->Points[element[0]];
    const Triple &q = this->Points[element[1]], &r = this->Points[element[2]],
                 &s = this->Points[element[3]];
    double t[3][3], cofactor[3][3]; // T = A W^-1 with W of the regular tetrahedron of edge 1
    double norm = 0;
    for (int x = 0; x < 3; ++x)
    {
      const double u = q[x] - p[x], v = r[x] - p[x], w = s[x] - p[x];
      t[x][0] = u;
      t[x][1] = (2 * v - u) / root3;
      t[x][2] = (3 * w - v - u) / root6;
      norm += t[x][0] * t[x][0] + t[x][1] * t[x][1] + t[x][2] * t[x][2];
    }
    for (int x = 0; x < 3; ++x)
    {
      const double *a = t[(x + 1) % 3], *b = t[(x + 2) % 3];
      for (int y = 0; y < 3; ++y)
      {
        const int y1 = (y + 1) % 3, y2 = (y + 2) % 3;
        cofactor[x][y] = a[y1] * b[y2] - a[y2] * b[y1];
      }
    }
    const double det =
      t[0][0] * cofactor[0][0] + t[0][1] * cofactor[0][1] + t[0][2] * cofactor[0][2];
    const double size = 3 * std::cbrt(det * det);
    const double quality = norm / size;
    this->Sum += quality * quality;
    for (int x = 0; x < 3; ++x)
    {
      double g[3];
      for (int y = 0; y < 3; ++y)
      {
        g[y] = 2 * quality * (2 * t[x][y] / size - 2 * quality * cofactor[x][y] / (3 * det));
      }
      const double last = 3 * g[2] / root6;
      const double third = 2 * g[1] / root3 - g[2] / root6;
      const double second = g[0] - g[1] / root3 - g[2] / root6;
      this->Gradient[element[0]][x] -= second + third + last;
      this->Gradient[element[1]][x] += second;
      this->Gradient[element[2]][x] += third;
      this->Gradient[element[3]][x] += last;
    }
  }
}
}
