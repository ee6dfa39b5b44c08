// SPDX-License-Identifier: BSD-3-Clause
#include "Domains.h"

#include "tautline/Core/Memory.h"

#include <algorithm>
#include <cstdio>

namespace tautline
{
namespace
{
// The single list used by the registry, the menu, the documentation and the tests.
const std::vector<DomainInfo> Domains = {
  { "wrench", "Wrench", "Figure 2.2 (a), Table 2.4", DomainKind::Planar, 19796, false, 8.8 },
  { "hinge", "Hinge", "Figure 2.2 (b), Table 2.4", DomainKind::Planar, 18359, false, 21.0 },
  { "disk2d", "Disk (2D)", "Figure 3.3 (a)", DomainKind::Planar, 50000, false, Pi },
  { "barrier2d", "Barrier (2D)", "Figure 3.3 (b)", DomainKind::Planar, 50000, false, 7.7 },
  { "disk3d", "Disk (3D)", "Figure 3.3 (c)", DomainKind::Solid, 50000, false, 0.5 * Pi },
  { "barrier3d", "Barrier (3D)", "Figure 3.3 (d)", DomainKind::Solid, 50000, false, 7.7 },
  { "brain", "Brain with Ventricles", "Figure 3.11", DomainKind::Planar, 8166, true, 2.2 },
  { "bore", "Bore (3D)", "Figure 3.12", DomainKind::Solid, 109535, true, 3.5 },
  { "rectangle", "Rectangle, Structured", "Figure 4.20", DomainKind::Structured, 800, true, 2.0 },
  { "square", "Square with Interaction Layer, Structured", "Figures 4.6 and 4.7",
    DomainKind::Structured, 200, false, 1.0 },
  { "cylinder", "Cylinder in a Channel", "Figure 4.24", DomainKind::Planar, 3000, true, 2.9 },
  { "cylinder-diagonal", "Cylinder in a Channel, Diagonal", "Figure 4.33", DomainKind::Planar, 3000,
    true, 2.9 },
  { "bar", "Moving Bar", "Figure 4.27", DomainKind::Planar, 3000, true, 1.0 },
  { "gate", "Moving Gate", "Figure 4.30", DomainKind::Planar, 3000, true, 2.0 },
  { "bending-bar", "Bending Bar", "Figure 4.35", DomainKind::Planar, 3000, true, 1.0 },
  { "sphere", "Sphere in a Cube", "Figure 4.37", DomainKind::Solid, 20000, true, 1.0 },
  { "box-in-box", "Box in a Box", "not in the dissertation; the inner box rotates",
    DomainKind::Solid, 12000, true, 0.97 },
};

/// A bar of length L clamped at its left end, bent to an arc of angle phi.
Vec3 bend(const Vec3& p, double phi)
{
  constexpr double Left = 0.15, Length = 0.7, Middle = 0.5;
  if (std::abs(phi) < 1e-12)
  {
    return { 0, 0, 0 };
  }
  // The bar is bent to an arc of radius L / phi, on which its axis keeps its length.
  const double radius = Length / phi, along = (p[0] - Left) / radius, across = p[1] - Middle;
  return { Left + (radius - across) * std::sin(along) - p[0],
    Middle + radius - (radius - across) * std::cos(along) - p[1], 0 };
}
}

//------------------------------------------------------------------------------
const std::vector<DomainInfo>& domains()
{
  return Domains;
}

//------------------------------------------------------------------------------
const DomainInfo& findDomain(const std::string& name)
{
  const auto found = std::find_if(
    Domains.begin(), Domains.end(), [&](const DomainInfo& domain) { return domain.name == name; });
  if (found == Domains.end())
  {
    std::string names;
    for (const DomainInfo& domain : Domains)
    {
      names += std::string(names.empty() ? "" : ", ") + domain.name;
    }
    throw Error("unknown domain '" + name + "'; available domains: " + names);
  }
  return *found;
}

//------------------------------------------------------------------------------
void checkDomainSize(double cells, DomainKind kind)
{
  // Estimates of the peak, with the copies for VTK; the triangulation of a mesher is larger than a
  // mesh.
  constexpr double StructuredBytes = 200.0, MesherBytes = 600.0;
  const double needed = cells * (kind == DomainKind::Structured ? StructuredBytes : MesherBytes);
  char what[64];
  std::snprintf(what, sizeof(what), "a mesh of %.3g cells", cells);
  requireMemory(needed, what, "choose fewer cells, larger elements or a narrower layer");
}

//------------------------------------------------------------------------------
Vec3 domainDisplacement(const std::string& name, const Vec3& p, int marker, double amount)
{
  const bool inner = marker == 2;
  if (name == "cylinder" && inner)
  {
    return { 0.6 * amount, 0, 0 };
  }
  if (name == "cylinder-diagonal" && inner)
  {
    return { 0.6 * amount, 0.1 * amount, 0 };
  }
  if (name == "bar" && inner)
  {
    return { 0, -0.45 * amount, 0 };
  }
  if (name == "bending-bar" && inner)
  {
    return bend(p, amount * Pi / 3);
  }
  if (name == "gate" && inner)
  {
    // the sides stretch from the top, y = 1, to the tip of the gate, y = 0.6
    return { 0, -0.4 * amount * (1.0 - p[1]) / 0.4, 0 };
  }
  if (name == "rectangle" && marker == 3)
  {
    const double bump = std::sin(0.5 * Pi * p[0]); // the top, x from 0 to 2
    return { 0, -0.85 * amount * bump * bump, 0 };
  }
  if (name == "brain" && marker >= 2)
  {
    // the ventricles shrink, more in width than in height
    const double center = p[0] < 0 ? -0.2 : 0.2;
    return { -0.75 * amount * (p[0] - center), -0.4 * amount * (p[1] - 0.02), 0 };
  }
  if (name == "bore" && inner)
  {
    const double growth = 0.7 * amount * std::sin(Pi * p[2]); // the mouths stay
    return { growth * (p[0] - 1.0), growth * (p[1] - 1.0), 0 };
  }
  if (name == "sphere" && inner)
  {
    return { 0, 0, 0.3 * amount };
  }
  if (name == "box-in-box" && inner)
  {
    // half a turn about the vertical axis through the middle
    const double c = std::cos(amount * Pi) - 1.0, s = std::sin(amount * Pi);
    const double x = p[0] - 0.5, y = p[1] - 0.5;
    return { c * x - s * y, s * x + c * y, 0 };
  }
  return { 0, 0, 0 };
}
}
