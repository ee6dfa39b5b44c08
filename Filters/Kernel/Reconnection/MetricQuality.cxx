// SPDX-License-Identifier: BSD-3-Clause
#include "MetricQuality.h"

#include "tautline/Quality/ElementSum.h"

#include <cmath>

namespace tautline
{
namespace
{
void check(bool holds, const MetricInfo& info, const char* what)
{
  if (!holds)
  {
    throw Error(std::string(info.label) + " " + what);
  }
}
}

MetricQuality::MetricQuality(Metric metric, int exponent, double mean)
  : Info(metricInfo(metric))
  , Scale(std::ldexp(1.0, exponent))
  , Types({ static_cast<unsigned char>(CellType::Tetrahedron) })
{
  const MetricInfo& info = this->Info;
  check(info.in3D && info.definedOn(CellType::Tetrahedron), info,
    "is not defined on tetrahedra: choose another metric");
  check(info.direction != Direction::Neutral, info,
    "has no direction of improvement: choose another metric");
  check(info.rotationInvariant, info,
    "depends on the orientation in space, which is undefined for new tetrahedra: choose "
    "another metric");
  requireDerivatives(info);
  const double ideal = info.ideal3D;
  // With a positive ideal value u, the quality is x / u or u / x; otherwise x / (x + u) or u / (x +
  // u), with a typical value u.
  this->Reciprocal = std::isfinite(ideal) && ideal > 0.0;
  this->Unit = this->Reciprocal ? ideal : (ideal == 0.0 ? 1.0 : mean);
  check(this->Unit > 0.0 && std::isfinite(this->Unit), info,
    "has no positive mean on this mesh: choose another metric");

  MeshView view;
  view.numberOfPoints = 4;
  view.points = this->Points.data();
  view.numberOfCells = 1;
  view.cellTypes = this->Types.data();
  view.offsets = this->Offsets.data();
  view.connectivity = this->Connectivity.data();
  this->One = std::make_unique<Mesh>(view, 1);
  const CellBlock& block = this->One->blocks().front();
  this->Context = contextFor(*this->One, block, metric, this->Options);
  const MetricCode code = metricCode(metric);
  this->Value = evaluatorFor(*this->One, metric, code, block, false);
  this->Gradient = evaluatorFor(*this->One, metric, code, block, true);
}

/// @param slope set to the derivative of the quality
double MetricQuality::qualityOf(double value, double& slope) const
{
  const bool larger = this->Info.direction == Direction::LargerIsBetter;
  const double x = std::max(value, 0.0), u = this->Unit;
  if (this->Reciprocal)
  {
    // Values below the ideal one are rounding errors.
    slope = larger ? 1.0 / u : (x > 0.0 ? -u / (x * x) : 0.0);
    return larger ? x / u : (x > 0.0 ? u / x : 0.0);
  }
  const double sum = x + u;
  slope = (larger ? u : -u) / (sum * sum);
  return (larger ? x : u) / sum;
}

double MetricQuality::valueOf(double quality) const
{
  const bool larger = this->Info.direction == Direction::LargerIsBetter;
  const double q = quality, u = this->Unit;
  return this->Reciprocal ? (larger ? q * u : u / q)
                          : (larger ? u * q / (1.0 - q) : u * (1.0 - q) / q);
}

void MetricQuality::evaluate(
  const Vec3& p, const std::array<Vec3, 3>* faces, int count, double* values, Vec3* gradients) const
{
  Batch batch;
  for (int first = 0; first < count; first += PacketWidth)
  {
    batch.count = std::min(count - first, PacketWidth);
    batch.scaled = false;
    for (int l = 0; l < PacketWidth; ++l)
    {
      // The last one fills the packet.
      const std::array<Vec3, 3>& f = faces[first + std::min(l, batch.count - 1)];
      batch.cells[l] = 0;
      for (int c = 0; c < 3; ++c)
      {
        // The metric may have a unit, so the vectors are converted to the units of the input mesh.
        batch.points[0][c][l] = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          batch.points[k + 1][c][l] = this->Scale * (f[k][c] - p[c]);
        }
      }
    }
    normalizeExtents<4>(batch);
    (gradients ? this->Gradient : this->Value)(this->Context, batch);
    const Packet value = timesUnit(batch, batch.value, this->Context.lengthPower);
    for (int l = 0; l < batch.count; ++l)
    {
      const std::array<Vec3, 3>& f = faces[first + l];
      // The sign comes from the determinant, because not all metrics have one.
      const double determinant = dot(f[0] - p, cross(f[1] - p, f[2] - p));
      double slope = 0.0;
      const bool positive = determinant > 0.0 && std::isfinite(value[l]);
      values[first + l] =
        positive ? this->qualityOf(value[l], slope) : (determinant < 0.0 ? -1.0 : 0.0);
      for (int c = 0; c < 3 && gradients; ++c)
      {
        const Packet g = timesUnit(batch, batch.gradient[0][c], this->Context.lengthPower - 1);
        const double product = slope * this->Scale * g[l];
        gradients[first + l][c] = std::isfinite(product) ? product : 0.0;
      }
    }
  }
}

double MetricQuality::quality(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) const
{
  const std::array<Vec3, 3> face = { a, b, c };
  double value;
  this->evaluate(p, &face, 1, &value, nullptr);
  return value;
}
}
