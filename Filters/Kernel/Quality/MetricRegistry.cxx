// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricRegistry.cxx
 * @brief The table of facts about every metric.
 */
#include "Metrics.h"
#include "RegisteredMetrics.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double sizeDecides = std::numeric_limits<double>::quiet_NaN();

// Cell types as bits, in the order of topologies().
constexpr unsigned triangles = 1, quads = 2, tets = 4, hexes = 8, wedges = 16, pyramids = 32;
constexpr unsigned simplices = triangles | tets;
constexpr unsigned flat = triangles | quads;
constexpr unsigned solid = tets | hexes | wedges | pyramids;
constexpr unsigned all = flat | solid;

constexpr Range atLeast(double low)
{
  return { low, infinity };
}

constexpr auto Target = MetricFamily::Target;
constexpr auto Simplex = MetricFamily::Simplex;
constexpr auto Cell = MetricFamily::Cell;
constexpr auto Faces = MetricFamily::Faces;
constexpr auto Smaller = Direction::SmallerIsBetter;
constexpr auto Larger = Direction::LargerIsBetter;
constexpr auto Neutral = Direction::Neutral;
constexpr auto Negative = InvertedValue::Negative;
constexpr auto Growing = InvertedValue::Larger;
constexpr auto Unsigned = InvertedValue::Unsigned;
constexpr bool barrier = true, noBarrier = false, smooth = true, kinked = false;
constexpr bool scaleFree = true, sized = false, rotates = true, oriented = false;

constexpr const char* knupp2001 =
  "Knupp, Algebraic mesh quality metrics, SIAM J. Sci. Comput. 23 (2001)";
constexpr const char* knupp2012 = "Knupp, Introducing the target-matrix paradigm for mesh "
                                  "optimization by node-movement, Eng. Comput. 28 (2012)";
constexpr const char* tmop = "Dobrev et al., The target-matrix optimization paradigm for "
                             "high-order meshes, SIAM J. Sci. Comput. 41 (2019)";
constexpr const char* shewchuk =
  "Shewchuk, What is a good linear element?, Int. Meshing Roundtable (2002)";
constexpr const char* verdict = "Knupp et al., The Verdict library reference manual, Sandia (2006)";
constexpr const char* johnen = "Johnen, Weill, Remacle, Robust and efficient validation of the "
                               "linear hexahedral element, Procedia Eng. 203 (2017)";

constexpr const char* checkMesh = "OpenFOAM v1912 checkMesh: primitiveMeshTools, polyMeshTools";
constexpr const char* snappy = "OpenFOAM v1912 snappyHexMesh, meshQualityControls";

std::vector<MetricInfo> makeRegistry()
{
  // The largest values of the scale-invariant simplex metrics, attained by the regular simplex.
  const double root3 = std::sqrt(3.0);
  const double si2 = root3 / 12, si3 = 2 * std::sqrt(2.0) * std::sqrt(root3) / 9;
  const double ss2 = root3 / 4, ss3 = std::sqrt(2.0) / 12 * std::pow(root3 / 1.125, 0.75);
  // The dihedral angle of the regular tetrahedron, 70.5 degrees.
  const double dihedral = std::acos(1.0 / 3.0) * 180 / Pi;
  const Range any = atLeast(0), one = atLeast(1), shape = { 0, 2 }, ratio = { 1, 3 };
  const Range unit = { 0, 1 };
  return {
    { Metric::InverseMeanRatio, "imr", "Inverse mean ratio", "IMR", "inverse_mean_ratio",
      "|T|^2 / (n |det T|^(2/n)), with the sign of det T",
      "dissertation Table 2.2, 3.2.1; Munson (2007)", Target, true, true, all, one, one, ratio,
      ratio, 1, 1, Smaller, Negative, barrier, smooth, scaleFree, rotates, "" },
    { Metric::MeanRatio, "mean_ratio", "Mean ratio", "MR", "mr,shape",
      "n |det T|^(2/n) / |T|^2, with the sign of det T", knupp2001, Target, true, true, all, unit,
      unit, { 1.0 / 3, 1 }, { 1.0 / 3, 1 }, 1, 1, Larger, Negative, noBarrier, smooth, scaleFree,
      rotates, "" },
    { Metric::RadiusRatio, "rr", "Radius ratio", "RR", "radius_ratio",
      "sqrt(R / r) of the circumscribed and inscribed circles or spheres, with the sign of the "
      "size",
      "dissertation Table 2.2 (printed range corrected, see the notes)", Simplex, true, true,
      simplices, atLeast(std::sqrt(2.0)), atLeast(root3), { std::sqrt(2.0), std::sqrt(6.0) },
      { root3, 3 }, std::sqrt(2.0), root3, Smaller, Negative, barrier, smooth, scaleFree, rotates,
      "" },
    { Metric::NormalizedRadiusRatio, "rr_normalized", "Radius ratio, normalized", "R/(n r)",
      "normalized_radius_ratio", "R / (n r), with the sign of the size", verdict, Simplex, true,
      true, simplices, one, one, ratio, ratio, 1, 1, Smaller, Negative, barrier, smooth, scaleFree,
      rotates, "" },
    { Metric::ConditioningScaleInvariant, "si", "Conditioning, scale-invariant", "SI",
      "conditioning_scale_invariant", "2D: A / (s1^2 + s2^2 + s3^2); 3D: V / A_rms^(3/2)",
      "dissertation Table 2.2, (3.2); Shewchuk (2002)", Simplex, true, true, simplices, { 0, si2 },
      { 0, si3 }, { si2 / 3, si2 }, { si3 / 3, si3 }, si2, si3, Larger, Negative, noBarrier, smooth,
      scaleFree, rotates, "" },
    { Metric::ConditioningSizeShape, "si_size", "Conditioning, size and shape", "SI size",
      "conditioning_size_shape", "3D: V / A_rms^2", shewchuk, Simplex, false, true, tets, any, any,
      any, any, sizeDecides, sizeDecides, Larger, Negative, noBarrier, smooth, sized, rotates,
      "1/length" },
    { Metric::InterpolationSizeShape, "ss", "Interpolation, size and shape", "SS",
      "interpolation_size_shape",
      "2D: A / (s1 s2 s3); 3D: V sum A_k / sum_{m<n} A_m A_n l_mn^2, face m opposite vertex m",
      "dissertation Table 2.2, 3.2.1; Shewchuk (2002)", Simplex, true, true, simplices, any, any,
      any, any, sizeDecides, sizeDecides, Larger, Negative, noBarrier, smooth, sized, rotates,
      "1/length" },
    { Metric::InterpolationScaleInvariant, "ss_scale_invariant", "Interpolation, scale-invariant",
      "SS scale-invariant", "interpolation_scale_invariant",
      "2D: A / (s1 s2 s3)^(2/3); 3D: V (sum A_k / sum_{m<n} A_m A_n l_mn^2)^(3/4)", shewchuk,
      Simplex, true, true, simplices, { 0, ss2 }, { 0, ss3 }, { ss2 / 3, ss2 }, { ss3 / 3, ss3 },
      ss2, ss3, Larger, Negative, noBarrier, smooth, scaleFree, rotates, "" },
    { Metric::Size, "size", "Size (area or volume)", "V", "area,volume",
      "signed area or volume; faces are bilinear", "dissertation 3.2.1", Cell, true, true, all, any,
      any, any, any, sizeDecides, sizeDecides, Direction::Neutral, Negative, noBarrier, smooth,
      sized, rotates, "length^n" },
    { Metric::UntangleBeta, "untangle_beta", "Untangling beta", "beta", "untangling,untangle",
      "(|V - beta| - (V - beta)) / 2, V the signed size at a corner",
      "dissertation (3.3); Knupp, Hexahedral and tetrahedral mesh untangling, Eng. Comput. 17 "
      "(2001)",
      Target, true, true, all, any, any, { 0, 0 }, { 0, 0 }, 0, 0, Smaller, Growing, noBarrier,
      kinked, sized, rotates, "length^n" },
    { Metric::EdgeRatio, "edge_ratio", "Edge length ratio", "l_max/l_min", "edge_length_ratio",
      "longest edge / shortest edge", verdict, Cell, true, true, all, one, one, ratio, ratio, 1, 1,
      Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::AspectRatio, "aspect_ratio", "Aspect ratio", "AR", "",
      "simplex: longest edge / inradius, scaled to 1 for the regular simplex; quadrilateral and "
      "hexahedron: longest / "
      "shortest principal axis",
      verdict, Cell, true, true, flat | tets | hexes, one, one, ratio, ratio, 1, 1, Smaller,
      Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::WidthRatio, "width_ratio", "Aspect ratio W/w", "W/w", "",
      "longer / shorter side of the least elongated enclosing rectangle with a side on an edge",
      "dissertation Figure 4.8", Cell, true, false, triangles, one, one, { 1, 4 }, { 1, 4 },
      2 / root3, 2 / root3, Smaller, Unsigned, barrier, kinked, scaleFree, rotates, "" },
    { Metric::MinimumAngle, "min_angle", "Minimum angle", "theta_min", "minimum_angle",
      "smallest corner angle (2D) or dihedral angle (3D)", "dissertation Table 2.7", Cell, true,
      true, all, { 0, 90 }, { 0, 90 }, { 20, 90 }, { 15, 90 }, 60, dihedral, Larger, Unsigned,
      noBarrier, kinked, scaleFree, rotates, "degrees" },
    { Metric::MaximumAngle, "max_angle", "Maximum angle", "theta_max", "maximum_angle",
      "largest corner angle (2D, reflex above 180; below 60 in folded quadrilaterals) or dihedral "
      "angle (3D)",
      "dissertation Table 2.7", Cell, true, true, all, { 0, 360 }, { 60, 180 }, { 60, 120 },
      { 60, 150 }, 60, dihedral, Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates,
      "degrees" },
    { Metric::EquiangleSkew, "equiangle_skew", "Equiangle skew", "skew", "skew",
      "max((largest - e) / (180 - e), (e - smallest) / e) over the angles of the faces, e = 60 or "
      "90",
      verdict, Cell, true, true, all, unit, unit, { 0, 0.7 }, { 0, 0.7 }, 0, 0, Smaller, Unsigned,
      noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::ConditionNumber, "condition_number", "Condition number", "kappa", "condition",
      "|T| |T^-1| / n, with the sign of det T", knupp2001, Target, true, true, all, one, one, ratio,
      ratio, 1, 1, Smaller, Negative, barrier, smooth, scaleFree, rotates, "" },
    { Metric::ScaledJacobian, "scaled_jacobian", "Scaled Jacobian", "J_s", "jacobian",
      "minimum over the corners of det A / product of its edge lengths, scaled to 1 for the ideal "
      "cell (not for pyramids: their apex has no Jacobian)",
      verdict, Cell, true, true, flat | tets | hexes | wedges, unit, unit, { 0.3, 1 }, { 0.3, 1 },
      1, 1, Larger, Negative, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::ShapeBarrier, "mu_shape", "Shape, barrier", "mu_2 / mu_303", "mu_2,mu_303",
      "2D: |T|^2 / (2 det T) - 1; 3D: |T|^2 / (3 det T^(2/3)) - 1", knupp2012, Target, true, true,
      all, any, any, shape, shape, 0, 0, Smaller, Negative, barrier, smooth, scaleFree, rotates,
      "" },
    { Metric::ShapeNonBarrier, "mu_shape_nb", "Shape, non-barrier", "mu_4 / mu_360", "mu_4,mu_360",
      "2D: |T|^2 - 2 det T; 3D: |T|^3 / (3 sqrt 3) - det T", tmop, Target, true, true, all, any,
      any, any, any, 0, 0, Smaller, Growing, noBarrier, smooth, sized, rotates, "" },
    { Metric::ShapeCondition, "mu_301", "Shape, condition", "mu_301", "", "|T| |T^-1| / 3 - 1",
      tmop, Target, false, true, solid, any, any, shape, shape, 0, 0, Smaller, Negative, barrier,
      smooth, scaleFree, rotates, "" },
    { Metric::ShapeConditionSquared, "mu_302", "Shape, condition squared", "mu_302", "",
      "|T|^2 |T^-1|^2 / 9 - 1", tmop, Target, false, true, solid, any, any, { 0, 8 }, { 0, 8 }, 0,
      0, Smaller, Unsigned, barrier, smooth, scaleFree, rotates, "" },
    { Metric::ShapeSquared, "mu_50", "Shape, squared", "mu_50", "", "|T^t T|^2 / (2 det T^2) - 1",
      tmop, Target, true, false, flat, any, any, { 0, 16 }, { 0, 16 }, 0, 0, Smaller, Unsigned,
      barrier, smooth, scaleFree, rotates, "" },
    { Metric::ShapeProduct, "mu_58", "Shape, product", "mu_58", "",
      "|T^t T|^2 / det T^2 - 2 |T|^2 / det T + 2", tmop, Target, true, false, flat, any, any,
      { 0, 24 }, { 0, 24 }, 0, 0, Smaller, Unsigned, barrier, smooth, scaleFree, rotates, "" },
    { Metric::ShapeCubic, "mu_304", "Shape, cubic", "mu_304", "", "|T|^3 / (3 sqrt 3 det T) - 1",
      tmop, Target, false, true, solid, any, any, { 0, 4 }, { 0, 4 }, 0, 0, Smaller, Negative,
      barrier, smooth, scaleFree, rotates, "" },
    { Metric::ShapeSizeAdjugate, "mu_322", "Shape and size, adjugate", "mu_322", "",
      "|T - adj(T)^t|^2 / (6 det T)", tmop, Target, false, true, solid, any, any, any, any, 0, 0,
      Smaller, Negative, barrier, smooth, sized, rotates, "" },
    { Metric::ShapeSimilarity, "tmp_shape", "Shape similarity (TMP)", "TMP shape",
      "shape_similarity", "2D: |T - adj(T)^t|^2; 3D: |(|T| / sqrt 3) T - adj(T)^t|^2",
      "dissertation (4.22); Knupp (2012)", Target, true, true, all, any, any, any, any, 0, 0,
      Smaller, Growing, noBarrier, smooth, sized, rotates, "" },
    { Metric::ShapeSizeBarrier, "mu_shape_size", "Shape and size, barrier", "mu_7 / mu_321",
      "mu_7,mu_321", "|T - T^-t|^2", tmop, Target, true, true, all, any, any, any, any, 0, 0,
      Smaller, Unsigned, barrier, smooth, sized, rotates, "" },
    { Metric::ShapeSizeWeighted, "mu_9", "Shape and size, weighted", "mu_9", "",
      "det T |T - T^-t|^2", tmop, Target, true, false, flat, any, any, any, any, 0, 0, Smaller,
      Negative, barrier, smooth, sized, rotates, "" },
    { Metric::ShapeSizeLogarithm, "mu_323", "Shape and size, logarithmic", "mu_323", "",
      "|T|^3 - 3 sqrt 3 ln |det T| - 3 sqrt 3", tmop, Target, false, true, solid, any, any, any,
      any, 0, 0, Smaller, Unsigned, barrier, smooth, sized, rotates, "" },
    { Metric::SizeNonBarrier, "mu_size_nb", "Size, non-barrier", "mu_55 / mu_315", "mu_55,mu_315",
      "(det T - 1)^2", tmop, Target, true, true, all, any, any, any, any, 0, 0, Smaller, Growing,
      noBarrier, smooth, sized, rotates, "" },
    { Metric::SizeBarrier, "mu_size", "Size, barrier", "mu_56 / mu_316", "mu_56,mu_316",
      "(det T + 1 / det T) / 2 - 1", tmop, Target, true, true, all, any, any, any, any, 0, 0,
      Smaller, Negative, barrier, smooth, sized, rotates, "" },
    { Metric::SizeBarrierSquared, "mu_size_squared", "Size, squared barrier", "mu_77 / mu_318",
      "mu_77,mu_318", "(det T - 1 / det T)^2 / 2", tmop, Target, true, true, all, any, any, any,
      any, 0, 0, Smaller, Unsigned, barrier, smooth, sized, rotates, "" },
    { Metric::SizeUntangle, "mu_untangle", "Size, untangling", "mu_211 / mu_311", "mu_211,mu_311",
      "(det T - 1)^2 - det T + sqrt(det T^2 + epsilon)", tmop, Target, true, true, all, any, any,
      any, any, sizeDecides, sizeDecides, Smaller, Growing, noBarrier, smooth, sized, rotates, "" },
    { Metric::ShapeOrientation, "mu_shape_orientation_nb", "Shape and orientation, non-barrier",
      "mu_85", "mu_85", "|T - |T| I / sqrt n|^2", tmop, Target, true, true, all, any, any, any, any,
      0, 0, Smaller, Growing, noBarrier, smooth, sized, oriented, "" },
    { Metric::ShapeOrientationBarrier, "mu_shape_orientation", "Shape and orientation, barrier",
      "TShapeOrientB1", "tshapeorientb1", "(|T| - tr T / sqrt n) / (2 det T)", "Mesquite 2.99",
      Target, true, true, all, any, any, any, any, 0, 0, Smaller, Negative, barrier, smooth, sized,
      oriented, "" },
    { Metric::ShapeSizeOrientation, "mu_shape_size_orientation_nb",
      "Shape, size and orientation, non-barrier", "mu_14", "mu_14", "|T - I|^2", tmop, Target, true,
      true, all, any, any, any, any, 0, 0, Smaller, Growing, noBarrier, smooth, sized, oriented,
      "" },
    { Metric::ShapeSizeOrientationBarrier, "mu_shape_size_orientation",
      "Shape, size and orientation, barrier", "mu_98", "mu_98", "|T - I|^2 / det T", tmop, Target,
      true, true, all, any, any, any, any, 0, 0, Smaller, Negative, barrier, smooth, sized,
      oriented, "" },
    { Metric::MinimumJacobian, "min_jacobian", "Minimum Jacobian", "min det J",
      "minimum_jacobian,min_det",
      "smallest det J in the element, also between its corners; J maps from the unit square or "
      "cube, from a triangle, tetrahedron or wedge with legs of length 1, from the pyramid of "
      "height 1 over the unit square: V of a parallelepiped, n! V of a simplex",
      johnen, Cell, true, true, all, any, any, any, any, sizeDecides, sizeDecides, Larger, Negative,
      noBarrier, kinked, sized, rotates, "length^n" },
    { Metric::NonOrthogonality, "non_orthogonality", "Non-orthogonality", "theta_f",
      "nonorthoangle,non_ortho", "angle between S and d; 0 on uncoupled boundaries", checkMesh,
      Faces, true, true, all, { 0, 180 }, { 0, 180 }, { 0, 70 }, { 0, 70 }, 0, 0, Smaller, Unsigned,
      noBarrier, kinked, scaleFree, rotates, "degrees" },
    { Metric::FaceSkewness, "face_skewness", "Face skewness", "psi_f", "max_skewness",
      "|v| / w, v from where d meets the plane of the face to f (on the boundary: from the foot of "
      "C), w the largest component of p - f along v, at least 0.2 |d| (0.4 of the distance of C)",
      checkMesh, Faces, true, true, all, any, any, { 0, 4 }, { 0, 4 }, 0, 0, Smaller, Unsigned,
      noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::InternalSkewness, "internal_skewness", "Face skewness, internal", "psi_i", "",
      "face_skewness of the faces with two cells; 0 on others", snappy, Faces, true, true, all, any,
      any, { 0, 4 }, { 0, 4 }, 0, 0, Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::BoundarySkewness, "boundary_skewness", "Face skewness, boundary", "psi_b", "",
      "face_skewness of the faces with one cell; 0 on others", snappy, Faces, true, true, all, any,
      any, { 0, 20 }, { 0, 20 }, 0, 0, Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates,
      "" },
    { Metric::OrthogonalQuality, "orthogonal_quality", "Orthogonal quality", "OQ", "",
      "min of S.(f - C) / |S||f - C| and S.d / |S||d|, S out of the cell",
      "ANSYS Fluent user's guide, 6.2.2 Mesh Quality", Faces, true, true, all, { -1, 1 }, { -1, 1 },
      { 0.1, 1 }, { 0.1, 1 }, 1, 1, Larger, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::FaceWeight, "face_weight", "Face interpolation weight", "w_f", "faceweight",
      "min(a, b) / (a + b), a = |S.(f - C)|, b = |S.(C' - f)|; 1/2 on uncoupled boundaries",
      checkMesh, Faces, true, true, all, { 0, 0.5 }, { 0, 0.5 }, { 0.05, 0.5 }, { 0.05, 0.5 }, 0.5,
      0.5, Larger, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::VolumeRatio, "volume_ratio", "Volume ratio of neighbors", "V/V'", "cellvolumeratio",
      "smaller / larger volume of the two cells; 1 on uncoupled boundaries", checkMesh, Faces, true,
      true, all, unit, unit, { 0.01, 1 }, { 0.01, 1 }, 1, 1, Larger, Unsigned, noBarrier, kinked,
      scaleFree, rotates, "" },
    { Metric::PyramidVolume, "pyramid_volume", "Face pyramid volume", "V_f", "minpyrvolume",
      "S.(f - C) / 3, S out of the cell", checkMesh, Faces, true, true, all, any, any, any, any,
      sizeDecides, sizeDecides, Larger, Unsigned, noBarrier, smooth, sized, rotates, "length^3" },
    { Metric::FaceArea, "face_area", "Smallest face area", "|S|", "minarea", "|S|", checkMesh,
      Faces, true, true, all, any, any, any, any, sizeDecides, sizeDecides, Larger, Unsigned,
      noBarrier, smooth, sized, rotates, "length^2" },
    { Metric::FaceFlatness, "face_flatness", "Face flatness", "|S|/A", "flatness",
      "|S| / sum of the areas of the triangles of the edges and f; 1 of triangles", checkMesh,
      Faces, true, true, all, unit, unit, { 0.8, 1 }, { 0.8, 1 }, 1, 1, Larger, Unsigned, noBarrier,
      kinked, scaleFree, rotates, "" },
    { Metric::FaceConcavity, "face_concavity", "Face concavity", "beta_f", "concavity",
      "asin of the largest |e x e'| of edges that turn inward, from sin 10 degrees on", checkMesh,
      Faces, true, true, all, { 0, 90 }, { 0, 90 }, { 0, 0 }, { 0, 0 }, 0, 0, Smaller, Unsigned,
      noBarrier, kinked, scaleFree, rotates, "degrees" },
    { Metric::FaceTwist, "face_twist", "Face twist", "t_f", "twist",
      "least cosine between a triangle of an edge and f, and d (on the boundary f - C); 1 of "
      "triangles",
      snappy, Faces, true, true, all, { -1, 1 }, { -1, 1 }, { 0.02, 1 }, { 0.02, 1 }, 1, 1, Larger,
      Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::CenterTetQuality, "center_tet_quality", "Tetrahedron quality, centers", "q_c",
      "mintetvolume",
      "least volume, relative to the regular tetrahedron in the same sphere, of tetrahedra of "
      "an edge, f and C",
      checkMesh, Faces, true, true, all, { -1, 1 }, { -1, 1 }, { 1e-30, 1 }, { 1e-30, 1 },
      sizeDecides, sizeDecides, Larger, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::FanTetQuality, "fan_tet_quality", "Tetrahedron quality, fans", "q_b", "tet_quality",
      "the same of C and a fan of triangles of the face, with its best base point", checkMesh,
      Faces, true, true, all, { -1, 1 }, { -1, 1 }, { 1e-30, 1 }, { 1e-30, 1 }, sizeDecides,
      sizeDecides, Larger, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::CellVolume, "cell_volume", "Cell volume, of pyramids", "V_c", "cellvolume",
      "sum of S.(f - a) / 3 over the faces, a the mean of their centers", checkMesh, Faces, true,
      true, all, any, any, any, any, sizeDecides, sizeDecides, Neutral, Negative, noBarrier, smooth,
      sized, rotates, "length^3" },
    { Metric::Openness, "openness", "Cell openness", "o", "cell_openness",
      "max over x, y, z of |sum S_i| / sum |S_i|", checkMesh, Faces, true, true, all, unit, unit,
      { 0, 1e-6 }, { 0, 1e-6 }, 0, 0, Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates,
      "" },
    { Metric::CellAspectRatio, "cell_aspect_ratio", "Cell aspect ratio, of areas", "AR_c", "",
      "max of s_i / s_j and (s_x + s_y + s_z) / (6 V^(2/3)), s_i = sum |S_i|; of one layer the "
      "first",
      checkMesh, Faces, true, true, all, one, one, { 1, 1000 }, { 1, 1000 }, 1, 1, Smaller,
      Unsigned, noBarrier, kinked, scaleFree, oriented, "" },
    { Metric::CellDeterminant, "cell_determinant", "Cell determinant", "D_c", "celldeterminant",
      "|det sum (S/A) (S/A)^t| / 8 over the faces with two cells, A the mean of |S|; 1 in an empty "
      "direction",
      checkMesh, Faces, true, true, all, any, any, atLeast(0.001), atLeast(0.001), sizeDecides,
      sizeDecides, Larger, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
    { Metric::AreaDeterminant, "area_determinant", "Cell determinant, of all faces", "D_a",
      "mindeterminant", "27 det (sum S S^t / |S|) / (sum |S|)^3", snappy, Faces, true, true, all,
      unit, unit, { 0.001, 1 }, { 0.001, 1 }, sizeDecides, sizeDecides, Larger, Unsigned, noBarrier,
      smooth, scaleFree, rotates, "" },
    { Metric::CellConcavity, "cell_concavity", "Cell concavity", "k_c", "",
      "largest sine of the angle by which the center of a face is outside the plane of another",
      checkMesh, Faces, true, true, all, { -1, 1 }, { -1, 1 }, { -1, -1e-6 }, { -1, -1e-6 },
      sizeDecides, sizeDecides, Smaller, Unsigned, noBarrier, kinked, scaleFree, rotates, "" },
  };
}

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}
}

const std::vector<MetricInfo>& builtInMetrics()
{
  static const std::vector<MetricInfo> registry = makeRegistry();
  return registry;
}

const std::vector<MetricInfo>& metricRegistry()
{
  loadMetricsOfEnvironment();
  return knownMetrics();
}

int numberOfBuiltInMetrics()
{
  return static_cast<int>(builtInMetrics().size());
}

std::vector<MetricInfo> elementMetrics()
{
  std::vector<MetricInfo> metrics;
  for (const MetricInfo& info : metricRegistry())
  {
    if (info.family != MetricFamily::Faces)
    {
      metrics.push_back(info);
    }
  }
  return metrics;
}

const MetricInfo& metricInfo(Metric metric)
{
  const auto& builtIn = builtInMetrics();
  const int number = static_cast<int>(metric);
  // The built-in metrics are listed in the order of the enumeration.
  if (number >= 0 && number < static_cast<int>(builtIn.size()))
  {
    return builtIn[number];
  }
  // The number may belong to a library of the environment that has not been loaded yet.
  loadMetricsOfEnvironment();
  if (const MetricInfo* info = registeredMetric(metric))
  {
    return *info;
  }
  const std::string missing = missingMetric(number);
  throw Error(missing.empty() ? "Unknown metric number " + std::to_string(number) + "." : missing);
}

int MetricInfo::lengthPower(int dimension) const
{
  const std::string unit = this->unit;
  return unit == "length^n" ? dimension
    : unit == "length^3"    ? 3
    : unit == "length^2"    ? 2
    : unit == "1/length"    ? -1
                            : 0;
}

const MetricInfo* findMetric(const std::string& name)
{
  const std::string wanted = lowerCase(name);
  for (const MetricInfo& info : metricRegistry())
  {
    for (const char* candidate : { info.name, info.label, info.symbol })
    {
      if (lowerCase(candidate) == wanted)
      {
        return &info;
      }
    }
    // Commas on both sides prevent matches with a part of an alias.
    const std::string aliases = std::string(",") + info.aliases + ",";
    if (!wanted.empty() && wanted.find(',') == std::string::npos &&
      aliases.find("," + wanted + ",") != std::string::npos)
    {
      return &info;
    }
  }
  return nullptr;
}

namespace
{
std::string number(double x)
{
  std::ostringstream text;
  text.precision(6);
  text << x;
  return text.str();
}

std::string range(const Range& r)
{
  return number(r.low) + " to " + number(r.high);
}
}

std::string metricFields()
{
  return "number\tname\tlabel\tsymbol\taliases\tformula\tsource\tdimensions\tcell types\tfull 2D\t"
         "full 3D\tacceptable 2D\tacceptable 3D\tideal 2D\tideal 3D\tdirection\tinverted\tbarrier\t"
         "differentiable\tscale invariant\trotation invariant\tunit\tfamily";
}

std::string describeMetric(const MetricInfo& info)
{
  std::string types;
  for (const CellTopology& t : topologies())
  {
    types += info.definedOn(t.type) ? (types.empty() ? "" : ", ") + std::string(t.name) : "";
  }
  types += info.family == MetricFamily::Faces ? ", polygon, polyhedron" : "";
  const char* yes[] = { "no", "yes" };
  const char* families[] = { "target", "simplex", "cell", "faces" };
  const std::string none = "-";
  const std::string fields[] = { std::to_string(static_cast<int>(info.metric)), info.name,
    info.label, info.symbol, info.aliases, info.formula, info.source,
    info.in2D && info.in3D ? "2, 3" : (info.in2D ? "2" : "3"), types,
    info.in2D ? range(info.full2D) : none, info.in3D ? range(info.full3D) : none,
    info.in2D ? range(info.acceptable2D) : none, info.in3D ? range(info.acceptable3D) : none,
    info.in2D && !std::isnan(info.ideal2D) ? number(info.ideal2D) : none,
    info.in3D && !std::isnan(info.ideal3D) ? number(info.ideal3D) : none,
    info.direction == Smaller ? "smaller is better"
                              : (info.direction == Larger ? "larger is better" : "neutral"),
    info.inverted == Negative ? "negative" : (info.inverted == Growing ? "larger" : "unsigned"),
    yes[info.barrier], yes[info.differentiable], yes[info.scaleInvariant],
    yes[info.rotationInvariant], info.unit, families[static_cast<int>(info.family)] };
  std::string line;
  for (const std::string& field : fields)
  {
    line += (&field == fields ? "" : "\t") + field;
  }
  return line;
}
}
