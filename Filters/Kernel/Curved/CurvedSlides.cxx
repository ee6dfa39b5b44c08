// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedSlides.h"

namespace tautline
{
//------------------------------------------------------------------------------
void CurvedSlides::slide(Index p, const SlidingBoundary& boundary, Index piece)
{
  Point& point = this->Points[p];
  point.kind = Kind::OnPiece;
  point.boundary = &boundary;
  point.curve = boundary.pieces()[piece].form->line;
  point.place.piece = point.tried.piece = piece;
}

//------------------------------------------------------------------------------
void CurvedSlides::slide(Index p, const SurfaceProjection& surface)
{
  Point& point = this->Points[p];
  point.kind = Kind::OnSurface;
  point.surface = &surface;
  point.curve = surface.isCurve();
}

//------------------------------------------------------------------------------
void CurvedSlides::place(std::vector<double>& x, int threads)
{
  constexpr Index grain = 16;
  parallelFor(static_cast<Index>(this->Points.size()), grain, threads,
    [&](Index p)
    {
      Point& point = this->Points[p];
      if (point.kind < Kind::OnPiece || point.held)
      {
        return;
      }
      const Vec3 at = { x[3 * p], x[3 * p + 1], x[3 * p + 2] };
      // The search begins at the last accepted position, so that a rejected step has no effect.
      if (point.kind == Kind::OnPiece)
      {
        point.tried = point.boundary->closest(point.place, at);
      }
      else
      {
        point.tried.point = point.surface->closest(at, point.tried.direction);
      }
      for (int c = 0; c < 3; ++c)
      {
        x[3 * p + c] = point.tried.point[c];
      }
    });
}

//------------------------------------------------------------------------------
void CurvedSlides::accept()
{
  for (Point& point : this->Points)
  {
    if (!point.held)
    {
      point.place = point.tried;
    }
  }
}

//------------------------------------------------------------------------------
void CurvedSlides::release()
{
  for (Point& point : this->Points)
  {
    point.held = false;
  }
  this->Held = 0;
}

//------------------------------------------------------------------------------
Vec3 CurvedSlides::along(const Point& point, const Vec3& v)
{
  if (point.held)
  {
    return { 0, 0, 0 };
  }
  const Vec3& d = point.place.direction;
  // The direction is the tangent of a curve or the normal of a surface.
  const Vec3 part = dot(d, v) * d;
  return point.curve ? part : v - part;
}

//------------------------------------------------------------------------------
void CurvedSlides::project(std::vector<double>& v) const
{
  for (std::size_t p = 0; p < this->Points.size(); ++p)
  {
    const Point& point = this->Points[p];
    if (point.kind == Kind::Free)
    {
      continue;
    }
    const Vec3 kept = point.kind == Kind::Fixed
      ? Vec3{ 0, 0, 0 }
      : along(point, { v[3 * p], v[3 * p + 1], v[3 * p + 2] });
    for (int c = 0; c < 3; ++c)
    {
      v[3 * p + c] = kept[c];
    }
  }
}

//------------------------------------------------------------------------------
void CurvedSlides::project(Index p, PointBlock& block) const
{
  const Point& point = this->Points[p];
  if (point.kind == Kind::Free)
  {
    return;
  }
  // P B P + 1 - P, with the symmetric projection P.
  PointBlock projection;
  for (int c = 0; c < 3; ++c)
  {
    Vec3 axis = { 0, 0, 0 };
    axis[c] = 1;
    projection[c] = point.kind == Kind::Fixed ? Vec3{ 0, 0, 0 } : along(point, axis);
  }
  PointBlock half, full;
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      half[r][c] = 0;
      for (int k = 0; k < 3; ++k)
      {
        half[r][c] += block[r][k] * projection[k][c];
      }
    }
  }
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      full[r][c] = (r == c) - projection[r][c];
      for (int k = 0; k < 3; ++k)
      {
        full[r][c] += projection[r][k] * half[k][c];
      }
    }
  }
  block = full;
}
}
