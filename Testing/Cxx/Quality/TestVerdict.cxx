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
  Combination combination;
  double power;
  Relation relation;
};

constexpr auto Mean = Combination::Mean;
constexpr auto Worst = Combination::Worst;
using Q = VerdictFunctions;

constexpr auto tri = CellType::Triangle;
constexpr auto quad = CellType::Quadrilateral;
constexpr auto tet = CellType::Tetrahedron;
constexpr auto hex = CellType::Hexahedron;
constexpr auto wedge = CellType::Wedge;
constexpr auto pyramid = CellType::Pyramid;

const Comparison comparisons[] = {
  { "area", tri, Q::TriangleArea, Metric::Size, Mean, one, Relation::Equal },
  { "edge ratio", tri, Q::TriangleEdgeRatio, Metric::EdgeRatio, Mean, one, Relation::Equal },
  { "aspect ratio", tri, Q::TriangleAspectRatio, Metric::AspectRatio, Mean, one, Relation::Equal },
  { "radius ratio", tri, Q::TriangleRadiusRatio, Metric::NormalizedRadiusRatio, Mean, one,
    Relation::Equal },
  { "aspect Frobenius", tri, Q::TriangleAspectFrobenius, Metric::InverseMeanRatio, Mean, one,
    Relation::Equal },
  { "minimum angle", tri, Q::TriangleMinAngle, Metric::MinimumAngle, Mean, one, Relation::Equal },
  { "maximum angle", tri, Q::TriangleMaxAngle, Metric::MaximumAngle, Mean, one, Relation::Equal },
  { "condition", tri, Q::TriangleCondition, Metric::ConditionNumber, Mean, one, Relation::Equal },
  { "scaled Jacobian", tri, Q::TriangleScaledJacobian, Metric::ScaledJacobian, Mean, one,
    Relation::Equal },
  { "shape", tri, Q::TriangleShape, Metric::MeanRatio, Mean, one, Relation::Equal },
  { "equiangle skew", tri, Q::TriangleEquiangleSkew, Metric::EquiangleSkew, Mean, one,
    Relation::Equal },
  { "normalized inradius", tri, Q::TriangleNormalizedInradius, Metric::NormalizedRadiusRatio, Mean,
    -one, Relation::Equal },

  { "area", quad, Q::QuadArea, Metric::Size, Mean, one, Relation::Equal },
  { "edge ratio", quad, Q::QuadEdgeRatio, Metric::EdgeRatio, Mean, one, Relation::Equal },
  { "max edge ratio", quad, Q::QuadMaxEdgeRatio, Metric::AspectRatio, Mean, one, Relation::Equal },
  { "mean aspect Frobenius", quad, Q::QuadMedAspectFrobenius, Metric::InverseMeanRatio, Mean, one,
    Relation::Equal },
  { "max aspect Frobenius", quad, Q::QuadMaxAspectFrobenius, Metric::InverseMeanRatio, Worst, one,
    Relation::Equal },
  { "condition", quad, Q::QuadCondition, Metric::ConditionNumber, Worst, one, Relation::Equal },
  { "minimum angle", quad, Q::QuadMinAngle, Metric::MinimumAngle, Mean, one, Relation::Equal },
  { "maximum angle", quad, Q::QuadMaxAngle, Metric::MaximumAngle, Mean, one, Relation::Equal },
  { "scaled Jacobian", quad, Q::QuadScaledJacobian, Metric::ScaledJacobian, Mean, one,
    Relation::Equal },
  { "shape", quad, Q::QuadShape, Metric::MeanRatio, Worst, one, Relation::Equal },
  { "equiangle skew", quad, Q::QuadEquiangleSkew, Metric::EquiangleSkew, Mean, one,
    Relation::Equal },

  { "volume", tet, Q::TetVolume, Metric::Size, Mean, one, Relation::Equal },
  { "edge ratio", tet, Q::TetEdgeRatio, Metric::EdgeRatio, Mean, one, Relation::Equal },
  { "aspect ratio", tet, Q::TetAspectRatio, Metric::AspectRatio, Mean, one, Relation::Equal },
  { "radius ratio", tet, Q::TetRadiusRatio, Metric::NormalizedRadiusRatio, Mean, one,
    Relation::Equal },
  { "aspect Frobenius", tet, Q::TetAspectFrobenius, Metric::InverseMeanRatio, Mean, one,
    Relation::Equal },
  { "aspect gamma", tet, Q::TetAspectGamma, Metric::InverseMeanRatio, Mean, 1.5, Relation::Equal },
  // Verdict leaves out the edges 0-2 and 1-3.
  { "minimum angle", tet, Q::TetMinAngle, Metric::MinimumAngle, Mean, one, Relation::AtLeast },
  { "condition", tet, Q::TetCondition, Metric::ConditionNumber, Mean, one, Relation::Equal },
  { "scaled Jacobian", tet, Q::TetScaledJacobian, Metric::ScaledJacobian, Mean, one,
    Relation::Equal },
  { "shape", tet, Q::TetShape, Metric::MeanRatio, Mean, one, Relation::Equal },
  { "mean ratio", tet, Q::TetMeanRatio, Metric::MeanRatio, Mean, Q::tetMeanRatioPower,
    Relation::Equal },
  // Verdict adds the dihedral angles to those of the faces.
  { "equiangle skew", tet, Q::TetEquiangleSkew, Metric::EquiangleSkew, Mean, one,
    Relation::AtLeast },

  { "volume", hex, Q::HexVolume, Metric::Size, Mean, one, Relation::Equal },
  // Verdict does not use all pairs of edges.
  { "edge ratio", hex, Q::HexEdgeRatio, Metric::EdgeRatio, Mean, one, Relation::AtMost },
  { "max edge ratio", hex, Q::HexMaxEdgeRatio, Metric::AspectRatio, Mean, one, Relation::Equal },
  { "condition", hex, Q::HexCondition, Metric::ConditionNumber, Worst, one, Relation::Equal },
  { "mean aspect Frobenius", hex, Q::HexMedAspectFrobenius, Metric::ConditionNumber, Mean, one,
    Relation::Equal },
  // Verdict adds the Jacobian of the centre to those of the corners.
  { "scaled Jacobian", hex, Q::HexScaledJacobian, Metric::ScaledJacobian, Mean, one,
    Relation::AtMost },
  { "shape", hex, Q::HexShape, Metric::MeanRatio, Worst, one, Relation::AtMost },

  { "volume", wedge, Q::WedgeVolume, Metric::Size, Mean, one, Relation::Equal },
  { "edge ratio", wedge, Q::WedgeEdgeRatio, Metric::EdgeRatio, Mean, one, Relation::Equal },
  { "scaled Jacobian", wedge, Q::WedgeScaledJacobian, Metric::ScaledJacobian, Mean, one,
    Relation::Equal },
  { "equiangle skew", wedge, Q::WedgeEquiangleSkew, Metric::EquiangleSkew, Mean, one,
    Relation::Equal },

  { "volume", pyramid, Q::PyramidVolume, Metric::Size, Mean, one, Relation::Equal },
  { "equiangle skew", pyramid, Q::PyramidEquiangleSkew, Metric::EquiangleSkew, Mean, one,
    Relation::Equal },
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

/// Where Verdict uses the centre besides the corners, the two agree if all Jacobians are the
/// same.
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
