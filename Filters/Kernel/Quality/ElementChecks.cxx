// SPDX-License-Identifier: BSD-3-Clause
#include "ElementChecks.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Elements/ElementSamples.h"
#include "tautline/Elements/JacobianCertifier.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
enum Check
{
  JacobianRatio,
  JacobianIntegration,
  JacobianCorners,
  JacobianNodes,
  JacobianHighOrder,
  AnsysJacobianRatio,
  CalculixJacobian,
  Distortion,
  TangentOffset,
  NormalOffset,
  MidnodeAngle,
  MidnodeRatio,
  MidnodeChord
};

constexpr auto Smaller = Direction::SmallerIsBetter;
constexpr auto Larger = Direction::LargerIsBetter;

constexpr const char* hyperMesh =
  "Altair HyperMesh 2021 reference guide, *elementchecksettings, methods of Jacobian 0 to 3; 2024 "
  "help, Element Quality Calculations, HyperMesh: ratio of the smallest to the largest determinant";
constexpr const char* quadraticOnly = "0 (ratio: 1) if an edge has no single middle node";

struct Edge
{
  int from, to, middle; ///< nodes
};

/// The edges with exactly one node inside.
std::vector<Edge> edgesWithMiddle(const ElementType& type)
{
  // In the uncollapsed shape, where edges are straight.
  std::vector<Vec3> places = type.coordinates();
  for (Vec3& p : places)
  {
    // In a pyramid, the collapse scales the first two coordinates by 1 - z.
    const double h = type.shape() == ElementShape::Pyramid ? 1 - p[2] : 1;
    p = { p[0] * h, p[1] * h, p[2] };
  }
  constexpr CellType corners[] = { CellType::Triangle, CellType::Quadrilateral,
    CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };
  const CellTopology& t = topology(corners[static_cast<int>(type.shape())]);
  std::vector<Edge> edges;
  for (int e = 0; e < t.edges; ++e)
  {
    const int a = t.edgeNodes[e][0], b = t.edgeNodes[e][1];
    const Vec3 along = places[b] - places[a];
    int inside = 0, middle = -1;
    for (int k = t.nodes; k < type.nodes(); ++k)
    {
      constexpr double near = 1e-9;
      const Vec3 d = places[k] - places[a];
      if (norm(cross(d, along)) < near && dot(d, along) > 0 && dot(d, along) < dot(along, along))
      {
        ++inside;
        middle = k;
      }
    }
    if (inside == 1)
    {
      edges.push_back({ a, b, middle });
    }
  }
  return edges;
}

double edgeValue(int check, const Vec3& a, const Vec3& b, const Vec3& m)
{
  const Vec3 chord = b - a, first = m - a, second = b - m;
  const double length = norm(chord);
  switch (check)
  {
    case TangentOffset:
      return std::abs(dot(first, chord) / (length * length) - 0.5);
    case NormalOffset:
      return norm(first - (dot(first, chord) / (length * length)) * chord) / length;
    case MidnodeAngle:
      // The arc tangent is accurate for all angles; the arc cosine is not near 0 and 180 degrees.
      return std::atan2(norm(cross(first, second)), dot(first, second)) * 180 / Pi;
    case MidnodeRatio:
      return std::min(norm(first), norm(second)) / std::max(norm(first), norm(second));
    default:
      return (norm(first) + norm(second)) / length;
  }
}

/// The smallest over the largest absolute determinant.
double ratioOf(double least, double most)
{
  const double largest = std::max(std::abs(least), std::abs(most));
  return largest > 0 ? least / largest : 0;
}

/// The points used by ANSYS, see the note of the check.
ElementRule ansysPlaces(const ElementType& type)
{
  ElementRule rule = cornersOf(type);
  const bool middle = *std::max_element(type.orders().begin(), type.orders().end()) > 1;
  const Vec3 centroid = { 0.5, 0.5, type.dimension() == 3 ? 0.5 : 0 };
  // At the apex itself, the map of the collapsed coordinates is singular.
  constexpr double nearApex = 0.99;
  switch (type.shape())
  {
    case ElementShape::Hexahedron:
      rule = middle ? nodesOf(type) : rule;
      rule.places.push_back(centroid);
      break;
    case ElementShape::Quadrilateral:
      rule.places.push_back(centroid);
      break;
    case ElementShape::Pyramid:
      rule.places.push_back({ 0.5, 0.5, nearApex });
      break;
    default:
      break;
  }
  rule.weights.assign(rule.places.size(), 1.0 / static_cast<double>(rule.places.size()));
  return rule;
}

ElementRule placesOf(int check, const ElementType& type)
{
  switch (check)
  {
    case JacobianCorners:
      return cornersOf(type);
    case JacobianNodes:
      return nodesOf(type);
    case JacobianRatio:
    case JacobianHighOrder:
      return quadratureOf(type);
    case AnsysJacobianRatio:
      return ansysPlaces(type);
    default:
      return integrationPoints(type);
  }
}

/// The value from the determinants at the points of a check.
double valueOf(int check, const ElementRule& rule, const std::vector<double>& determinants)
{
  const auto [least, most] = std::minmax_element(determinants.begin(), determinants.end());
  switch (check)
  {
    case AnsysJacobianRatio:
    {
      constexpr double oppositeSigns = -100;
      const double small = std::min(std::abs(*least), std::abs(*most));
      return *least * *most <= 0 ? oppositeSigns
                                 : std::max(std::abs(*least), std::abs(*most)) / small;
    }
    case CalculixJacobian:
      return *least;
    case Distortion:
    {
      const double mean =
        std::inner_product(determinants.begin(), determinants.end(), rule.weights.begin(), 0.0);
      return mean != 0 ? *least / std::abs(mean) : 0;
    }
    default:
      return ratioOf(*least, *most);
  }
}

/// The range of the determinant over the whole element.
double certifiedRatio(const CurvedBlock& block, Index i, const double* points,
  const ElementSamples& samples, JacobianCertifier& certifier, JacobianCertifier& opposite)
{
  MinimumTolerance tolerance;
  tolerance.relative = 1e-6;
  // The upper bound is a value that the determinant attains.
  const double least = certifier.minimum(points, block.nodes[i], tolerance).upper;
  const bool surface = block.type->dimension() == 2 && norm(block.normal) == 0;
  if (!surface)
  {
    // The largest determinant is minus the smallest one of the mirrored element.
    return ratioOf(least, -opposite.minimum(points, block.nodes[i], tolerance).upper);
  }
  // On a surface in space the determinant is a norm, whose maximum is only sampled.
  std::vector<double> values(samples.count());
  samples.determinants(points, block.nodes[i], block.normal, false, values.data());
  return ratioOf(least, std::max(least, *std::max_element(values.begin(), values.end())));
}

using CellValue = std::function<double(Index)>;

/// The value of a check at each position of a block; one object per thread.
CellValue valueOf(const CurvedBlock& block, int check, const double* points,
  const ElementSamples& samples, const std::vector<Edge>& edges, bool mirrored)
{
  if (check == JacobianRatio)
  {
    auto own = std::make_shared<JacobianCertifier>(*block.type, block.normal, mirrored);
    auto opposite = std::make_shared<JacobianCertifier>(*block.type, block.normal, !mirrored);
    return [=, &block, &samples](Index i)
    { return certifiedRatio(block, i, points, samples, *own, *opposite); };
  }
  if (check >= TangentOffset)
  {
    return [=, &block, &edges](Index i)
    {
      // The value of a straight edge with its node in the middle.
      double worst = check == MidnodeRatio || check == MidnodeChord ? 1 : 0;
      for (const Edge& edge : edges)
      {
        const auto at = [&](int node)
        {
          const double* p = points + 3 * block.nodes[i][node];
          return Vec3{ p[0], p[1], p[2] };
        };
        const double value = edgeValue(check, at(edge.from), at(edge.to), at(edge.middle));
        worst = check == MidnodeRatio ? std::min(worst, value) : std::max(worst, value);
      }
      return worst;
    };
  }
  return [=, &block, &samples](Index i)
  {
    std::vector<double> values(samples.count());
    samples.determinants(points, block.nodes[i], block.normal, mirrored, values.data());
    return valueOf(check, samples.rule(), values);
  };
}

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}
}

//------------------------------------------------------------------------------
const std::vector<ElementCheckInfo>& elementChecks()
{
  static const std::vector<ElementCheckInfo> checks = {
    { "jacobian_ratio", "Jacobian ratio, certified",
      "smallest determinant over the largest absolute one, in the whole element",
      "Gmsh, plugin AnalyseMeshQuality, minJ/maxJ, where the determinant is positive somewhere",
      "on surfaces in space, the largest one is taken at the quadrature points", 1, Larger },
    { "jacobian_integration", "Jacobian at integration points",
      "smallest determinant over the largest absolute one, at the integration points", hyperMesh,
      "method 0, its default, 0.7 and above is acceptable; HyperMesh uses the same for Abaqus; "
      "its points are not documented: here integrationPoints()",
      1, Larger },
    { "jacobian_corners", "Jacobian at corners",
      "the same at the corners; for a pyramid, at the corners of its base", hyperMesh, "method 1",
      1, Larger },
    { "jacobian_nodes", "Jacobian at corners and middle nodes", "the same at all nodes", hyperMesh,
      "method 2; here also at nodes inside faces and the element, if any", 1, Larger },
    { "jacobian_high_order", "Jacobian at high order points",
      "the same at the points of a rule of higher order", hyperMesh,
      "method 3; its points are not documented: here quadratureOf()", 1, Larger },
    { "ansys_jacobian_ratio", "Jacobian ratio of ANSYS",
      "largest over smallest absolute determinant at some points; -100 if the signs differ",
      "ANSYS Mechanical APDL theory reference, 12.1 Element Shape Testing, Jacobian ratio",
      "the table of points could not be verified; here: corners; for quadrilaterals also the "
      "centroid; for hexahedra with middle nodes all nodes and the centroid; for pyramids the "
      "base corners and a point near the apex",
      1, Smaller },
    { "calculix_jacobian", "Jacobian of CalculiX",
      "smallest determinant at the integration points, which must be positive",
      "CalculiX CrunchiX user's manual, C3D10: 4 integration points; message: nonpositive jacobian "
      "determinant",
      "for other elements, integrationPoints() is used", 0, Larger },
    { "distortion", "Distortion of Verdict",
      "smallest determinant at the integration points times the volume of the reference element "
      "over the volume",
      "Knupp et al., The Verdict library reference manual, Sandia (2006), distortion",
      "the volume is the mean determinant at these points; Verdict's rules for elements other "
      "than the quadratic tetrahedron may differ",
      1, Larger },
    { "midnode_tangent_offset", "Tangent offset of middle nodes",
      "largest |s - 1/2|, where s is the position of the middle node along the chord of an "
      "edge; the edge is singular at 1/4",
      "Altair OptiStruct 2021 help, Hoe Tangent Offset of 3-Node Edge", quadraticOnly, 0, Smaller },
    { "midnode_normal_offset", "Normal offset of middle nodes",
      "largest distance of a middle node from the chord of its edge over the length of the chord",
      "Altair OptiStruct 2021 help, Hoe Normal Offset of 3-Node Edge", quadraticOnly, 0, Smaller },
    { "midnode_angle", "Angle at middle nodes",
      "largest angle between the two parts of an edge, in degrees; 0: straight",
      "Autodesk Nastran 2023 reference, TETMAXEPADTOL and others, edge-point angular deviation, "
      "warning at 30",
      "the reference does not state the formula", 0, Smaller },
    { "midnode_ratio", "Ratio of the parts of an edge",
      "smallest ratio of the shorter to the longer part of an edge",
      "Altair HyperMesh 2021 reference guide, *secondorderfix2, min_midratio; Autodesk Nastran "
      "2025 reference, TETMINEPLRTOL, edge-point length ratio, warning at 0.5",
      "Autodesk's reference does not state the formula", 1, Larger },
    { "midnode_chord", "Parts of an edge over its chord",
      "largest sum of the lengths of the two parts of an edge over the length of its chord",
      "defined here", quadraticOnly, 1, Smaller },
  };
  return checks;
}

//------------------------------------------------------------------------------
std::vector<int> parseElementChecks(const std::string& list)
{
  const std::vector<ElementCheckInfo>& known = elementChecks();
  std::vector<int> checks;
  std::istringstream names(list);
  for (std::string name; std::getline(names, name, ',');)
  {
    name = trimmed(name);
    if (name.empty())
    {
      continue;
    }
    if (name == "all")
    {
      checks.resize(known.size());
      std::iota(checks.begin(), checks.end(), 0);
      return checks;
    }
    const auto found = std::find_if(
      known.begin(), known.end(), [&](const ElementCheckInfo& info) { return info.name == name; });
    if (found == known.end())
    {
      std::string all;
      for (const ElementCheckInfo& info : known)
      {
        all += std::string(", ") + info.name;
      }
      throw Error("Unknown check \"" + name + "\" of elements; available: all" + all + ".");
    }
    const int number = static_cast<int>(found - known.begin());
    if (std::find(checks.begin(), checks.end(), number) == checks.end())
    {
      checks.push_back(number);
    }
  }
  return checks;
}

//------------------------------------------------------------------------------
void evaluateElementCheck(
  const Mesh& mesh, const CurvedCellFacts& facts, int check, double* values, int threads)
{
  const MeshView& view = mesh.view();
  std::fill_n(values, view.numberOfCells, 0.0);
  for (const CurvedBlock& block : curvedBlocks(mesh, facts, true))
  {
    const ElementSamples samples(*block.type, placesOf(check, *block.type));
    const std::vector<Edge> edges = edgesWithMiddle(*block.type);
    forEachChunk(block.count(), threads,
      [&](Index, Index begin, Index end)
      {
        for (bool mirrored : { false, true })
        {
          const CellValue valueAt = valueOf(block, check, view.points, samples, edges, mirrored);
          for (Index i : block.positions(begin, end, mirrored))
          {
            const double value = valueAt(i);
            values[block.cells[i]] = std::isfinite(value) ? value : 0;
          }
        }
      });
  }
}
}
