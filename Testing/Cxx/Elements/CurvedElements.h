// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedElements.h
 * @brief What the tests of curved elements share: the Jacobian determinant computed without its
 * Bernstein form, and random elements.
 */
#ifndef tautline_CurvedElements_h
#define tautline_CurvedElements_h

#include "MfemFile.h"
#include "tautline/Core/Random.h"
#include "tautline/Elements/JacobianCertifier.h"

#include <numeric>

namespace tautline
{
/// The nodes of the cells of one type in a file, by cell.
inline std::vector<std::vector<Vec3>> elementsOf(const MeshFile& mesh, unsigned char type)
{
  std::vector<std::vector<Vec3>> elements;
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    if (mesh.cellTypes[cell] != type)
    {
      continue;
    }
    std::vector<Vec3>& nodes = elements.emplace_back();
    for (Index i = mesh.offsets[cell]; i < mesh.offsets[cell + 1]; ++i)
    {
      const double* point = mesh.points.data() + 3 * mesh.connectivity[static_cast<std::size_t>(i)];
      nodes.push_back({ point[0], point[1], point[2] });
    }
  }
  return elements;
}

/// The nodes of an element in its real shape, at the places of its reference coordinates: of a
/// pyramid not collapsed.
inline std::vector<Vec3> straightElement(const ElementType& type)
{
  std::vector<Vec3> points = type.coordinates();
  for (Vec3& p : points)
  {
    const double h = type.shape() == ElementShape::Pyramid ? 1 - p[2] : 1;
    p = { p[0] * h, p[1] * h, p[2] };
  }
  return points;
}

/// The point of an element at a place of the reference element.
inline Vec3 pointAt(const ElementType& type, const std::vector<Vec3>& nodes, const Vec3& at)
{
  const std::vector<double> values = type.shapeFunctions(at);
  Vec3 point = { 0, 0, 0 };
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    point += values[k] * nodes[k];
  }
  return point;
}

/// The derivatives of the map, by differences that are exact up to the degree 4.
inline std::array<Vec3, 3> derivativesAt(
  const ElementType& type, const std::vector<Vec3>& nodes, const Vec3& at)
{
  constexpr double h = 0.125;
  std::array<Vec3, 3> derivatives = { Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 } };
  for (int c = 0; c < type.dimension(); ++c)
  {
    const auto moved = [&](double by)
    {
      Vec3 there = at;
      there[c] += by;
      return pointAt(type, nodes, there);
    };
    derivatives[c] = (1 / (12 * h)) * (moved(-2 * h) - moved(2 * h) + 8 * (moved(h) - moved(-h)));
  }
  return derivatives;
}

/// The determinant; of an element of the plane, z of the normal.
inline double determinantAt(const ElementType& type, const std::vector<Vec3>& nodes, const Vec3& at)
{
  const std::array<Vec3, 3> d = derivativesAt(type, nodes, at);
  if (type.dimension() == 2)
  {
    return cross(d[0], d[1])[2];
  }
  const double h = type.shape() == ElementShape::Pyramid ? 1 - at[2] : 1;
  return dot(d[0], cross(d[1], d[2])) / (h * h);
}

/// A lattice of places of the reference element, all but the apex of a pyramid.
inline std::vector<Vec3> placesOf(const ElementType& type, int steps)
{
  std::vector<Vec3> places;
  const bool solid = type.dimension() == 3;
  const bool pyramid = type.shape() == ElementShape::Pyramid;
  for (int k = 0; k <= (solid ? steps - pyramid : 0); ++k)
  {
    for (int j = 0; j <= steps; ++j)
    {
      for (int i = 0; i <= steps; ++i)
      {
        const bool outside = (type.shape() == ElementShape::Tetrahedron && i + j + k > steps) ||
          ((type.shape() == ElementShape::Triangle || type.shape() == ElementShape::Wedge) &&
            i + j > steps);
        if (!outside)
        {
          const double step = 1.0 / steps;
          places.push_back({ i * step, j * step, k * step });
        }
      }
    }
  }
  return places;
}

/// The straight element with each node moved by up to `amplitude` along each axis.
inline std::vector<Vec3> randomElement(const ElementType& type, double amplitude, SplitMix& random)
{
  std::vector<Vec3> points = straightElement(type);
  for (Vec3& p : points)
  {
    for (int c = 0; c < type.dimension(); ++c)
    {
      p[c] += amplitude * random.symmetric();
    }
  }
  return points;
}

/// Many elements of one type with nodes of their own.
struct ElementSet
{
  std::vector<Vec3> points;
  std::vector<Index> nodes;
  std::vector<const Index*> elements;

  const double* coordinates() const { return this->points[0].data(); }
  Index count() const { return static_cast<Index>(this->elements.size()); }
};

inline ElementSet setOf(const std::vector<std::vector<Vec3>>& elements)
{
  ElementSet set;
  for (const std::vector<Vec3>& element : elements)
  {
    set.points.insert(set.points.end(), element.begin(), element.end());
  }
  set.nodes.resize(set.points.size());
  std::iota(set.nodes.begin(), set.nodes.end(), Index(0));
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    set.elements.push_back(set.nodes.data() + e * elements[0].size());
  }
  return set;
}

inline std::vector<ElementValidity> classify(JacobianCertifier& certifier, const ElementSet& set)
{
  std::vector<ElementValidity> validity(set.elements.size());
  certifier.classify(set.coordinates(), set.elements.data(), set.count(), validity.data());
  return validity;
}
}

#endif
