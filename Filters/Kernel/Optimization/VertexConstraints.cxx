// SPDX-License-Identifier: BSD-3-Clause
// Where a vertex may go: on its surface or curve, in its plane or line, within its limit.
#include "VertexOptimizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Steps on a surface with a limit are tried in full, then with a half, a quarter, ...
constexpr int maxProjections = 3;

/// A unit vector perpendicular to n, and the third axis.
void tangentsOf(const Vec3& n, Vec3* tangents)
{
  int smallest = 0;
  for (int c = 1; c < 3; ++c)
  {
    smallest = std::abs(n[c]) < std::abs(n[smallest]) ? c : smallest;
  }
  Vec3 axis = { 0, 0, 0 };
  axis[smallest] = 1.0;
  const Vec3 t = cross(n, axis);
  tangents[0] = (1.0 / norm(t)) * t;
  tangents[1] = cross(n, tangents[0]);
}
}

//------------------------------------------------------------------------------
template <int Dim>
void VertexOptimizer<Dim>::findTangents(std::int32_t v, Vec3* tangents) const
{
  // The normal is the sum of the vector areas around the vertex.
  const double* x = this->Simplices.coordinates();
  const auto at = [=](std::int32_t i)
  {
    const double* p = x + VertexStride * static_cast<std::size_t>(i);
    return Vec3{ p[0], p[1], p[2] };
  };
  const Vec3 center = at(v);
  Vec3 normal = { 0, 0, 0 };
  for (std::int32_t i = this->Simplices.patchStart(v); i < this->Simplices.patchStart(v + 1); ++i)
  {
    const std::int32_t* others = this->Simplices.patchVertices() + 2 * static_cast<std::size_t>(i);
    normal += cross(at(others[0]) - center, at(others[1]) - center);
  }
  const double length = norm(normal);
  normal = length > 0 ? (1.0 / length) * normal : Vec3{ 0, 0, 1 };
  tangentsOf(normal, tangents);
  // On a curve the first is its tangent.
  const Vec3 along = this->isOnCurve(v) ? this->surfaceOf(v)->direction(center) : Vec3{ 0, 0, 0 };
  const Vec3 across = cross(normal, along);
  const double width = norm(across);
  if (dot(along, along) > 0)
  {
    tangents[0] = along;
    tangents[1] = width > 0 ? (1.0 / width) * across : tangents[1];
  }
}

//------------------------------------------------------------------------------
/// The vector areas of the triangles at v.
template <int Dim>
std::vector<Vec3> VertexOptimizer<Dim>::normalsAt(std::int32_t v) const
{
  std::vector<Vec3> normals;
  const auto at = [this](std::int32_t i)
  {
    const double* p = this->Simplices.coordinates() + VertexStride * static_cast<std::size_t>(i);
    return Vec3{ p[0], p[1], p[2] };
  };
  const Vec3 center = at(v);
  for (std::int32_t i = this->Simplices.patchStart(v); i < this->Simplices.patchStart(v + 1); ++i)
  {
    const std::int32_t* others =
      this->Simplices.patchVertices() + Dim * static_cast<std::size_t>(i);
    normals.push_back(cross(at(others[0]) - center, at(others[1]) - center));
  }
  return normals;
}

//------------------------------------------------------------------------------
/// An orthonormal basis of the allowed directions of a vertex, as columns; returns their number.
template <int Dim>
int VertexOptimizer<Dim>::allowed(std::int32_t v, double basis[Dim][Dim]) const
{
  const auto given = [&](const std::vector<Vec3>& directions, double* u)
  {
    if (directions.empty())
    {
      return false;
    }
    double length2 = 0;
    for (int c = 0; c < Dim; ++c)
    {
      u[c] = dot(directions[v], this->Simplices.axis(c)) / this->Simplices.scale();
      length2 += u[c] * u[c];
    }
    for (int c = 0; length2 > 0 && c < Dim; ++c)
    {
      u[c] /= std::sqrt(length2);
    }
    return length2 > 0;
  };
  double u[Dim];
  const auto across = [&]()
  {
    if constexpr (Dim == 3)
    {
      Vec3 t[2];
      tangentsOf({ u[0], u[1], u[2] }, t);
      for (int r = 0; r < 3; ++r)
      {
        basis[r][0] = t[0][r];
        basis[r][1] = t[1][r];
      }
      return 2;
    }
    basis[0][0] = -u[1];
    basis[1][0] = u[0];
    return 1;
  };
  if (given(this->Options.lines, u))
  {
    for (int r = 0; r < Dim; ++r)
    {
      basis[r][0] = u[r];
    }
    return 1;
  }
  if (given(this->Options.planes, u))
  {
    return across();
  }
  if (this->isOnCurve(v) && Dim == 2 && this->Simplices.surface())
  {
    basis[0][0] = 1; // the first tangent, see findTangents()
    basis[1][0] = 0;
    return 1;
  }
  if (const SurfaceProjection* surface =
        Dim == 2 && this->Simplices.surface() ? nullptr : this->surfaceOf(v))
  {
    const double* at = this->Simplices.coordinates() + VertexStride * static_cast<std::size_t>(v);
    const Vec3 direction = surface->direction({ at[0], at[1], at[2] });
    std::copy_n(direction.begin(), Dim, u);
    if (!(dot(direction, direction) > 0))
    {
      return Dim;
    }
    for (int r = 0; r < Dim && surface->isCurve(); ++r)
    {
      basis[r][0] = u[r];
    }
    return surface->isCurve() ? 1 : across();
  }
  return Dim;
}

//------------------------------------------------------------------------------
/// Steps along the tangents and back to the surface, and accepts the position if it is better; the
/// step is shortened if it would move the surface too far or the vertex beyond its limit.
template <int Dim>
bool VertexOptimizer<Dim>::placeOnSurface(
  std::int32_t v, const double* d, const Scalarizer& scalarizer, PatchWorker<Dim>& w)
{
  const std::size_t n = this->Functions.size();
  const double zero[Dim] = {};
  const double* at = this->Simplices.coordinates() + VertexStride * static_cast<std::size_t>(v);
  const Vec3 before = { at[0], at[1], at[2] };
  std::vector<double> old(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    old[i] = this->Functions[i]->value(w.patch, zero);
  }
  Vec3 step = { 0, 0, 0 };
  for (int c = 0; c < Dim; ++c)
  {
    step += (d[c] / this->Simplices.scale()) * w.patch.axes[c];
  }
  const std::vector<Vec3> normals =
    Dim == 2 && (this->isOnCurve(v) || this->isLoose(v)) ? this->normalsAt(v) : std::vector<Vec3>();
  const SurfaceProjection* surface = this->surfaceOf(v);
  const std::vector<SurfaceLimit*>& limits = this->Options.surfaceLimits;
  const auto onSurface = [surface](const Vec3& x) { return surface ? surface->closest(x) : x; };
  const bool bounded = this->hasLimit(v);
  const double reach = bounded ? this->Options.limits[v] : std::numeric_limits<double>::infinity();
  Vec3 start = before;
  for (int c = 0; bounded && c < 3; ++c)
  {
    start[c] = this->Options.start[VertexStride * static_cast<std::size_t>(v) + c];
  }
  const int trials = limits.empty() && !bounded ? 1 : maxProjections;
  bool placed = false;
  for (int trial = 0; trial < trials && !placed; ++trial, step = 0.5 * step)
  {
    Vec3 to = onSurface(before + step);
    if (const double way = norm(to - start); way > reach)
    {
      to = onSurface(start + (insideLimit * reach / way) * (to - start));
    }
    this->place(v, to);
    this->gather(v, w.patch);
    for (std::size_t i = 0; i < n; ++i)
    {
      w.sums[i].f = old[i];
      w.now[i] = scalarizer.onPatches() ? old[i] : w.now[i];
    }
    const bool upright = this->Options.allowInversion ||
      (this->isUpright(v, w.patch, normals) && this->staysValidInside(w.patch, zero));
    placed = norm(to - start) <= reach && upright && this->changeAt(scalarizer, w, zero) < 0 &&
      std::all_of(limits.begin(), limits.end(),
        [&](SurfaceLimit* limit) { return limit->allows(v, before); });
    for (std::size_t i = 0; !placed && limits.size() > 1 && i < limits.size(); ++i)
    {
      limits[i]->forget(v); // one limit may have allowed a step that another one rejected
    }
  }
  if (!placed)
  {
    this->place(v, before);
    return false;
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    w.change[i] += w.trial[i];
  }
  return true;
}

//------------------------------------------------------------------------------
/// Whether no simplex at v is inverted. Unfolded triangles never are: instead, they must not have
/// flipped relative to the previous normals, if there are any.
template <int Dim>
bool VertexOptimizer<Dim>::isUpright(
  std::int32_t v, const VertexPatch<Dim>& patch, const std::vector<Vec3>& normals) const
{
  for (int i = 0; i < patch.simplices.count; ++i)
  {
    if (!(minOf(patch.simplices.packets[i].D0) > 0))
    {
      return false;
    }
  }
  const std::vector<Vec3> turned = normals.empty() ? normals : this->normalsAt(v);
  for (std::size_t i = 0; i < normals.size(); ++i)
  {
    if (!(dot(turned[i], normals[i]) > 0) && dot(normals[i], normals[i]) > 0)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// The largest step up to t that keeps x + d + t s within the limit of the vertex. On a surface in
/// space, where steps are tangential, placeOnSurface() enforces the limit.
template <int Dim>
double VertexOptimizer<Dim>::limited(
  std::int32_t v, const double* d, const double* s, double t) const
{
  if (!this->hasLimit(v) || (Dim == 2 && this->Simplices.surface()))
  {
    return t;
  }
  // |a + t s|^2 <= limit^2, where a is the displacement so far.
  const double limit = this->Options.limits[v];
  double a2 = -limit * limit, as = 0, s2 = 0;
  for (int c = 0; c < Dim; ++c)
  {
    const double a = this->Simplices.coordinates()[VertexStride * static_cast<std::size_t>(v) + c] +
      d[c] - this->Options.start[VertexStride * static_cast<std::size_t>(v) + c];
    a2 += a * a;
    as += a * s[c];
    s2 += s[c] * s[c];
  }
  const double root2 = as * as - a2 * s2;
  const double maxStep = s2 > 0 && root2 > 0 ? (std::sqrt(root2) - as) / s2 : 0.0;
  return std::max(0.0, std::min(t, maxStep));
}

//------------------------------------------------------------------------------
/// The displacement of v from its start after a displacement by d; returns its length.
template <int Dim>
double VertexOptimizer<Dim>::wayFromStart(std::int32_t v, const double* d, double* way) const
{
  double length2 = 0;
  for (int c = 0; c < Dim; ++c)
  {
    const std::size_t i = VertexStride * static_cast<std::size_t>(v) + c;
    way[c] = this->Simplices.coordinates()[i] + d[c] - this->Options.start[i];
    length2 += way[c] * way[c];
  }
  return std::sqrt(length2);
}

/// If the vertex is at its limit and `direction` points outward, replaces it by the direction along
/// the limit; search() moves the vertex back to the limit. Not on surfaces, which have a separate
/// projection.
template <int Dim>
bool VertexOptimizer<Dim>::turnAlongLimit(
  const PatchWorker<Dim>& w, const PatchSum<Dim>& sum, const double* d, double* direction) const
{
  const std::int32_t v = w.patch.vertex;
  if (!this->hasLimit(v) || this->isOnSurface(v))
  {
    return false;
  }
  double way[Dim], outwards = 0;
  const double length = this->wayFromStart(v, d, way);
  for (int c = 0; c < Dim; ++c)
  {
    outwards += direction[c] * way[c];
  }
  if (!(length > 0 && length >= insideLimit * this->Options.limits[v] && outwards > 0))
  {
    return false;
  }
  // The allowed directions without the displacement itself: the remaining vectors of an orthonormal
  // basis that begins with it.
  double basis[Dim][Dim] = {}, along[Dim][Dim] = {};
  const int allowed = this->allowed(v, basis);
  int found = 0;
  for (int i = 0; i < allowed && found + 1 < allowed; ++i)
  {
    double u[Dim], size2 = 0;
    for (int c = 0; c < Dim; ++c)
    {
      u[c] = allowed == Dim ? (c == i ? 1.0 : 0.0) : basis[c][i];
    }
    const auto remove = [&u](const auto& of, double scale)
    {
      double part = 0;
      for (int c = 0; c < Dim; ++c)
      {
        part += u[c] * of(c);
      }
      for (int c = 0; c < Dim; ++c)
      {
        u[c] -= part * scale * of(c);
      }
    };
    remove([&](int c) { return way[c]; }, 1 / (length * length));
    if (found > 0) // at most one
    {
      remove([&](int c) { return along[c][0]; }, 1.0);
    }
    for (int c = 0; c < Dim; ++c)
    {
      size2 += u[c] * u[c];
    }
    // one of the directions is nearly parallel to the displacement
    constexpr double parallel2 = 1e-2;
    for (int c = 0; size2 > parallel2 && c < Dim; ++c)
    {
      along[c][found] = u[c] / std::sqrt(size2);
    }
    found += size2 > parallel2 ? 1 : 0;
  }
  if (this->Options.newton)
  {
    this->newtonIn(along, found, sum, direction);
    return true;
  }
  double part[Dim] = {};
  for (int k = 0; k < found; ++k)
  {
    for (int c = 0; c < Dim; ++c)
    {
      part[k] += along[c][k] * direction[c];
    }
  }
  for (int c = 0; c < Dim; ++c)
  {
    direction[c] = 0;
    for (int k = 0; k < found; ++k)
    {
      direction[c] += part[k] * along[c][k];
    }
  }
  return true;
}

/// Shortens the displacement of v to its limit.
template <int Dim>
void VertexOptimizer<Dim>::keepLimit(std::int32_t v, double* to) const
{
  double way[Dim];
  const double length = this->hasLimit(v) ? this->wayFromStart(v, to, way) : 0.0;
  for (int c = 0; length > 0 && c < Dim; ++c)
  {
    to[c] -= std::max(0.0, 1 - this->Options.limits[v] / length) * way[c];
  }
}

template void VertexOptimizer<2>::findTangents(std::int32_t, Vec3*) const;
template void VertexOptimizer<3>::findTangents(std::int32_t, Vec3*) const;
template std::vector<Vec3> VertexOptimizer<2>::normalsAt(std::int32_t) const;
template std::vector<Vec3> VertexOptimizer<3>::normalsAt(std::int32_t) const;
template int VertexOptimizer<2>::allowed(std::int32_t, double (*)[2]) const;
template int VertexOptimizer<3>::allowed(std::int32_t, double (*)[3]) const;
template bool VertexOptimizer<2>::isUpright(
  std::int32_t, const VertexPatch<2>&, const std::vector<Vec3>&) const;
template bool VertexOptimizer<3>::isUpright(
  std::int32_t, const VertexPatch<3>&, const std::vector<Vec3>&) const;
template bool VertexOptimizer<2>::placeOnSurface(
  std::int32_t, const double*, const Scalarizer&, PatchWorker<2>&);
template bool VertexOptimizer<3>::placeOnSurface(
  std::int32_t, const double*, const Scalarizer&, PatchWorker<3>&);
template double VertexOptimizer<2>::limited(
  std::int32_t, const double*, const double*, double) const;
template bool VertexOptimizer<2>::turnAlongLimit(
  const PatchWorker<2>&, const PatchSum<2>&, const double*, double*) const;
template void VertexOptimizer<2>::keepLimit(std::int32_t, double*) const;
template double VertexOptimizer<2>::wayFromStart(std::int32_t, const double*, double*) const;
template double VertexOptimizer<3>::limited(
  std::int32_t, const double*, const double*, double) const;
template bool VertexOptimizer<3>::turnAlongLimit(
  const PatchWorker<3>&, const PatchSum<3>&, const double*, double*) const;
template void VertexOptimizer<3>::keepLimit(std::int32_t, double*) const;
template double VertexOptimizer<3>::wayFromStart(std::int32_t, const double*, double*) const;
}
