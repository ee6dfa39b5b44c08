// SPDX-License-Identifier: BSD-3-Clause
// Values against ParaView's own Mesh Quality (the Verdict library), for every measure both define.
//
// Before VTK 9.6 Verdict takes the corners of a wedge the other way round than VTK does: its volume
// of a wedge made by VTK is negative. Its wedges below are therefore renumbered. Not compared,
// because they differ: aspect ratio of quadrilaterals (there by perimeter and area; ours is
// Verdict's "max edge ratio"); equiangle skew of hexahedra (there above 1 at times: its faces are
// not walked round); condition and shape of wedges (there against another corner); shape of
// pyramids (there of heights); normalized inradius of tetrahedra; all that is relative to an
// average size.
#include "Registry.h"
#include "VerdictCompatibility.h"
#include "VtkMeshes.h"

using namespace tautline;

namespace
{
constexpr int cellsPerType = 500;
constexpr double tolerance = 1e-9; // relative; Verdict's arc cosines and cube roots are not better
constexpr double one = 1;

enum class Relation
{
  Equal,
  AtMost, ///< Verdict's is not above Tautline's
  AtLeast ///< Verdict's is not below Tautline's
};

/// Verdict's value is Tautline's to a power, with the corners combined as stated.
struct Comparison
{
  const char* name;
  CellType type;
  VerdictFunction verdict;
  Metric metric;
  Combination combination = Combination::Mean;
  double power = 1;
  Relation relation = Relation::Equal;
};

constexpr auto Mean = Combination::Mean;
constexpr auto Worst = Combination::Worst;
using Q = VerdictFunctions;
using M = Metric;

constexpr auto tri = CellType::Triangle;
constexpr auto quad = CellType::Quadrilateral;
constexpr auto tet = CellType::Tetrahedron;
constexpr auto hex = CellType::Hexahedron;
constexpr auto wedge = CellType::Wedge;
constexpr auto pyramid = CellType::Pyramid;

const Comparison comparisons[] = {
  { "area", tri, Q::TriangleArea, M::Size },
  { "edge ratio", tri, Q::TriangleEdgeRatio, M::EdgeRatio },
  { "aspect ratio", tri, Q::TriangleAspectRatio, M::AspectRatio },
  { "radius ratio", tri, Q::TriangleRadiusRatio, M::NormalizedRadiusRatio },
  { "aspect Frobenius", tri, Q::TriangleAspectFrobenius, M::InverseMeanRatio },
  { "minimum angle", tri, Q::TriangleMinAngle, M::MinimumAngle },
  { "maximum angle", tri, Q::TriangleMaxAngle, M::MaximumAngle },
  { "condition", tri, Q::TriangleCondition, M::ConditionNumber },
  { "scaled Jacobian", tri, Q::TriangleScaledJacobian, M::ScaledJacobian },
  { "shape", tri, Q::TriangleShape, M::MeanRatio },
  { "equiangle skew", tri, Q::TriangleEquiangleSkew, M::EquiangleSkew },
  { "normalized inradius", tri, Q::TriangleNormalizedInradius, M::NormalizedRadiusRatio, Mean,
    -one },

  { "area", quad, Q::QuadArea, M::Size },
  { "edge ratio", quad, Q::QuadEdgeRatio, M::EdgeRatio },
  { "max edge ratio", quad, Q::QuadMaxEdgeRatio, M::AspectRatio },
  { "mean aspect Frobenius", quad, Q::QuadMedAspectFrobenius, M::InverseMeanRatio },
  { "max aspect Frobenius", quad, Q::QuadMaxAspectFrobenius, M::InverseMeanRatio, Worst },
  { "condition", quad, Q::QuadCondition, M::ConditionNumber, Worst },
  { "minimum angle", quad, Q::QuadMinAngle, M::MinimumAngle },
  { "maximum angle", quad, Q::QuadMaxAngle, M::MaximumAngle },
  { "scaled Jacobian", quad, Q::QuadScaledJacobian, M::ScaledJacobian },
  { "shape", quad, Q::QuadShape, M::MeanRatio, Worst },
  { "equiangle skew", quad, Q::QuadEquiangleSkew, M::EquiangleSkew },

  { "volume", tet, Q::TetVolume, M::Size },
  { "edge ratio", tet, Q::TetEdgeRatio, M::EdgeRatio },
  { "aspect ratio", tet, Q::TetAspectRatio, M::AspectRatio },
  { "radius ratio", tet, Q::TetRadiusRatio, M::NormalizedRadiusRatio },
  { "aspect Frobenius", tet, Q::TetAspectFrobenius, M::InverseMeanRatio },
  { "aspect gamma", tet, Q::TetAspectGamma, M::InverseMeanRatio, Mean, 1.5 },
  // Verdict leaves out the edges 0-2 and 1-3.
  { "minimum angle", tet, Q::TetMinAngle, M::MinimumAngle, Mean, one, Relation::AtLeast },
  { "condition", tet, Q::TetCondition, M::ConditionNumber },
  { "scaled Jacobian", tet, Q::TetScaledJacobian, M::ScaledJacobian },
  { "shape", tet, Q::TetShape, M::MeanRatio },
  { "mean ratio", tet, Q::TetMeanRatio, M::MeanRatio, Mean, Q::tetMeanRatioPower },
  // Verdict adds the dihedral angles to the angles of the faces.
  { "equiangle skew", tet, Q::TetEquiangleSkew, M::EquiangleSkew, Mean, one, Relation::AtLeast },

  { "volume", hex, Q::HexVolume, M::Size },
  // Verdict does not use all pairs of edges.
  { "edge ratio", hex, Q::HexEdgeRatio, M::EdgeRatio, Mean, one, Relation::AtMost },
  { "max edge ratio", hex, Q::HexMaxEdgeRatio, M::AspectRatio },
  { "condition", hex, Q::HexCondition, M::ConditionNumber, Worst },
  { "mean aspect Frobenius", hex, Q::HexMedAspectFrobenius, M::ConditionNumber },
  // Verdict adds the Jacobian of the center to the Jacobians of the corners.
  { "scaled Jacobian", hex, Q::HexScaledJacobian, M::ScaledJacobian, Mean, one, Relation::AtMost },
  { "shape", hex, Q::HexShape, M::MeanRatio, Worst, one, Relation::AtMost },

  { "volume", wedge, Q::WedgeVolume, M::Size },
  { "edge ratio", wedge, Q::WedgeEdgeRatio, M::EdgeRatio },
  { "scaled Jacobian", wedge, Q::WedgeScaledJacobian, M::ScaledJacobian },
  { "equiangle skew", wedge, Q::WedgeEquiangleSkew, M::EquiangleSkew },

  { "volume", pyramid, Q::PyramidVolume, M::Size },
  { "equiangle skew", pyramid, Q::PyramidEquiangleSkew, M::EquiangleSkew },
};

/// The same cells for VTK; wedges in Verdict's order.
vtkSmartPointer<vtkUnstructuredGrid> toVerdict(MeshData data)
{
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    if (Q::wedgesReversed && data.types[i] == static_cast<int>(wedge))
    {
      Index* node = &data.connectivity[data.offsets[i]];
      std::swap(node[1], node[2]);
      std::swap(node[4], node[5]);
    }
  }
  return toGrid(data);
}

void compare(const Comparison& c)
{
  const Context context(topology(c.type).name + std::string(", ") + c.name);
  Random random(13);
  MeshData data;
  for (int i = 0; i < cellsPerType; ++i)
  {
    data.addCell(c.type, validCell(c.type, 0.35, 0.05, random));
  }
  const auto grid = toVerdict(data);
  TAUTLINE_LET(EvaluationOptions, options, combination = c.combination);
  const std::vector<double> values = valuesOf(data, c.metric, options);
  for (int i = 0; i < cellsPerType; ++i)
  {
    const double theirs = c.verdict(grid->GetCell(i)), ours = std::pow(values[i], c.power);
    const double slack = tolerance * std::max(1.0, std::abs(ours));
    const double bound = c.relation == Relation::AtMost ? std::max(theirs, ours)
      : c.relation == Relation::AtLeast                 ? std::min(theirs, ours)
                                                        : theirs;
    TAUTLINE_CHECK_NEAR(bound, ours, slack);
  }
}

/// Where Verdict uses the center besides the corners, they agree if all Jacobians are the same.
TAUTLINE_PART(testAffineHexahedra)
{
  Random random(14);
  for (int i = 0; i < cellsPerType; ++i)
  {
    const Columns m = { random.vector(-1, 1), random.vector(-1, 1), random.vector(-1, 1) };
    std::vector<Vec3> corners = idealCell(hex);
    for (Vec3& p : corners)
    {
      p = m * p;
    }
    if (cornerSines(hex, corners)[0] < 0.05)
    {
      continue;
    }
    const auto grid = toVerdict(singleCell(hex, corners));
    vtkCell* cell = grid->GetCell(0);
    TAUTLINE_CHECK_NEAR(
      Q::HexScaledJacobian(cell), valueOf(hex, corners, Metric::ScaledJacobian), tolerance);
    TAUTLINE_CHECK_NEAR(Q::HexShape(cell), valueOf(hex, corners, Metric::MeanRatio), tolerance);
  }
}
}

TAUTLINE_TEST(TestVerdict)
{
  for (const Comparison& c : comparisons)
  {
    if (c.verdict.exists())
    {
      compare(c);
    }
  }
}
