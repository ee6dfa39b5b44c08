// Warping: the propositions of section 4.9.1, the degenerate limits, and what every method has to keep.

#include "Warping.h"

using namespace tautline;

namespace
{
/// Right triangles as in (4.12): columns at x, rows at y; all with the same diagonal.
MeshData rectangle(const std::vector<double>& x, const std::vector<double>& y)
{
  MeshData data = blockMesh(CellType::Triangle, Index(x.size()) - 1, Index(y.size()) - 1, 0);
  data.transform([&](const Vec3& p) { return Vec3{ x[Index(p[0])], y[Index(p[1])], 0 }; });
  return data;
}

std::vector<double> spaced(Index n, double length, double growth)
{
  std::vector<double> at = { 0 };
  double step = 1;
  for (Index i = 0; i < n; ++i, step *= growth)
  {
    at.push_back(at.back() + step);
  }
  const double total = at.back();
  for (double& v : at)
  {
    v *= length / total;
  }
  return at;
}

WarpOptions manual(double alpha, double beta, double gamma = 0)
{
  WarpOptions options;
  options.method = WarpMethod::AnisotropicFemwarp;
  options.coefficients = WarpCoefficients::Manual;
  options.tensor = { alpha, beta, gamma, 0, 0, 0 };
  return options;
}

//------------------------------------------------------------------------------
/// alpha = 0, beta = 1: columns are independent (1), and keep their relative spacing (2, 3).
void testPropositions()
{
  for (const double growth : { 1.0, 1.3 })
  {
    const std::vector<double> y = spaced(10, 1.0, growth);
    const MeshData data = rectangle(spaced(16, 2.0, 1.0), y);
    const auto motion = [](const Vec3& p) {
      return Vec3{ 0, p[1] > 0.999 ? -0.85 * std::pow(std::sin(1.5 * p[0]), 2) : 0.0, 0 };
    };
    WarpOptions options = manual(0, 1);
    const Warping result = warped(data, motion, options);
    double worst = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i), top = { p[0], 1, 0 };
      const double gamma = 1 + motion(top)[1]; // of Proposition 3
      if (p[0] > 0 && p[0] < 2)
      {
        worst = std::max({ worst, std::abs(result.points[3 * i + 1] - gamma * p[1]),
          std::abs(result.points[3 * i] - p[0]) });
      }
    }
    TAUTLINE_CHECK_NEAR(worst, 0, 1e-12);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK_EQUAL(result.decoupled, 0);
    TAUTLINE_CHECK_EQUAL(result.regularization, 0.0);
    // The sums of the displacements find these coefficients, to the last bit.
    options.coefficients = WarpCoefficients::DisplacementSums;
    const Warping same = warped(data, motion, options);
    TAUTLINE_CHECK((same.tensor == SymmetricTensor{ 0, 1, 0, 0, 0, 0 }));
    TAUTLINE_CHECK(same.points == result.points);
    // FEMWARP inverts elements here, Figure 4.20.
    options.method = WarpMethod::Femwarp;
    TAUTLINE_CHECK(warped(data, motion, options).invertedAfter > 0);
  }
}
}

int TestWarp(int, char*[])
{
  testPropositions();
  return exitCode();
}
