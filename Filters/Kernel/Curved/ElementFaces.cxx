// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFaces.h"

#include <algorithm>

namespace tautline
{
namespace
{
using Faces = std::vector<ElementFace>;

Faces triangleEdges()
{
  return {
    { false,
      [](double s, double) {
        return Vec3{ s, 0, 0 };
      },
      [](const Vec3& a) { return a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[0], 0 };
      },
      { 0, -1 } },
    { false,
      [](double s, double) {
        return Vec3{ 1 - s, s, 0 };
      },
      [](const Vec3& a) { return 1 - a[0] - a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[1], 0 };
      },
      { 0, -1 } },
    { false,
      [](double s, double) {
        return Vec3{ 0, 1 - s, 0 };
      },
      [](const Vec3& a) { return a[0]; },
      [](const Vec3& a) {
        return Vec2{ 1 - a[1], 0 };
      },
      { 0, -1 } },
  };
}

Faces squareEdges()
{
  return {
    { false,
      [](double s, double) {
        return Vec3{ s, 0, 0 };
      },
      [](const Vec3& a) { return a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[0], 0 };
      },
      { 0, -1 } },
    { false,
      [](double s, double) {
        return Vec3{ 1, s, 0 };
      },
      [](const Vec3& a) { return 1 - a[0]; },
      [](const Vec3& a) {
        return Vec2{ a[1], 0 };
      },
      { 1, -1 } },
    { false,
      [](double s, double) {
        return Vec3{ 1 - s, 1, 0 };
      },
      [](const Vec3& a) { return 1 - a[1]; },
      [](const Vec3& a) {
        return Vec2{ 1 - a[0], 0 };
      },
      { 0, -1 } },
    { false,
      [](double s, double) {
        return Vec3{ 0, 1 - s, 0 };
      },
      [](const Vec3& a) { return a[0]; },
      [](const Vec3& a) {
        return Vec2{ 1 - a[1], 0 };
      },
      { 1, -1 } },
  };
}

/// The normals (place by s x place by t) point outward.
Faces tetrahedronFaces()
{
  return {
    { true,
      [](double s, double t) {
        return Vec3{ 0, t, s };
      },
      [](const Vec3& a) { return a[0]; },
      [](const Vec3& a) {
        return Vec2{ a[2], a[1] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ s, 0, t };
      },
      [](const Vec3& a) { return a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[0], a[2] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ t, s, 0 };
      },
      [](const Vec3& a) { return a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[0] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ 1 - s - t, s, t };
      },
      [](const Vec3& a) { return 1 - a[0] - a[1] - a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[2] };
      },
      { 0, 0 } },
  };
}

Faces cubeFaces()
{
  return {
    { false,
      [](double s, double t) {
        return Vec3{ 0, t, s };
      },
      [](const Vec3& a) { return a[0]; },
      [](const Vec3& a) {
        return Vec2{ a[2], a[1] };
      },
      { 2, 1 } },
    { false,
      [](double s, double t) {
        return Vec3{ 1, s, t };
      },
      [](const Vec3& a) { return 1 - a[0]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[2] };
      },
      { 1, 2 } },
    { false,
      [](double s, double t) {
        return Vec3{ s, 0, t };
      },
      [](const Vec3& a) { return a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[0], a[2] };
      },
      { 0, 2 } },
    { false,
      [](double s, double t) {
        return Vec3{ t, 1, s };
      },
      [](const Vec3& a) { return 1 - a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[2], a[0] };
      },
      { 2, 0 } },
    { false,
      [](double s, double t) {
        return Vec3{ t, s, 0 };
      },
      [](const Vec3& a) { return a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[0] };
      },
      { 1, 0 } },
    { false,
      [](double s, double t) {
        return Vec3{ s, t, 1 };
      },
      [](const Vec3& a) { return 1 - a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[0], a[1] };
      },
      { 0, 1 } },
  };
}

Faces wedgeFaces()
{
  return {
    { true,
      [](double s, double t) {
        return Vec3{ t, s, 0 };
      },
      [](const Vec3& a) { return a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[0] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ s, t, 1 };
      },
      [](const Vec3& a) { return 1 - a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[0], a[1] };
      },
      { 0, 0 } },
    { false,
      [](double s, double t) {
        return Vec3{ 0, t, s };
      },
      [](const Vec3& a) { return a[0]; },
      [](const Vec3& a) {
        return Vec2{ a[2], a[1] };
      },
      { 1, 0 } },
    { false,
      [](double s, double t) {
        return Vec3{ s, 0, t };
      },
      [](const Vec3& a) { return a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[0], a[2] };
      },
      { 0, 1 } },
    { false,
      [](double s, double t) {
        return Vec3{ 1 - s, s, t };
      },
      [](const Vec3& a) { return 1 - a[0] - a[1]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[2] };
      },
      { 0, 1 } },
  };
}

/// The coordinate u or v of the collapsed cube at height b, from the coordinate a of the pyramid.
double collapsed(double a, double b)
{
  // Rounding must not yield a value above 1; at the apex, any value denotes the same point.
  return b < 1 ? std::min(a / (1 - b), 1.0) : 0;
}

/// The apex is on all side faces.
Faces pyramidFaces()
{
  return {
    { false,
      [](double s, double t) {
        return Vec3{ t, s, 0 };
      },
      [](const Vec3& a) { return a[2]; },
      [](const Vec3& a) {
        return Vec2{ a[1], a[0] };
      },
      { 1, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ 0, collapsed(t, s), s };
      },
      [](const Vec3& a) { return a[0] * (1 - a[2]); },
      [](const Vec3& a) {
        return Vec2{ a[2], a[1] * (1 - a[2]) };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ 1, collapsed(s, t), t };
      },
      [](const Vec3& a) { return (1 - a[0]) * (1 - a[2]); },
      [](const Vec3& a) {
        return Vec2{ a[1] * (1 - a[2]), a[2] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ collapsed(s, t), 0, t };
      },
      [](const Vec3& a) { return a[1] * (1 - a[2]); },
      [](const Vec3& a) {
        return Vec2{ a[0] * (1 - a[2]), a[2] };
      },
      { 0, 0 } },
    { true,
      [](double s, double t) {
        return Vec3{ collapsed(t, s), 1, s };
      },
      [](const Vec3& a) { return (1 - a[1]) * (1 - a[2]); },
      [](const Vec3& a) {
        return Vec2{ a[2], a[0] * (1 - a[2]) };
      },
      { 0, 0 } },
  };
}
}

//------------------------------------------------------------------------------
const std::vector<ElementFace>& facesOf(ElementShape shape)
{
  static const std::array<Faces, 6> faces = { triangleEdges(), squareEdges(), tetrahedronFaces(),
    cubeFaces(), wedgeFaces(), pyramidFaces() };
  return faces[static_cast<std::size_t>(shape)];
}
}
