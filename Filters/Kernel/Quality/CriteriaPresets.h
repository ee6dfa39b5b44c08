// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CriteriaPresets.h
 * @brief The texts of the preset criteria.
 * Internal: not installed.
 *
 * The limits `warn` and `fail` come from the stated source; `ideal` is the value of the ideal
 * element, and `good` and `worst`, which only affect the quality index, are chosen here.
 */
#ifndef tautline_CriteriaPresets_h
#define tautline_CriteriaPresets_h

#include <array>

namespace tautline
{
struct CriteriaPreset
{
  const char* name;
  const char* json;
};

constexpr std::array<CriteriaPreset, 14> CriteriaPresetTexts = { {
  { "fem", R"json({
  "name": "FEM default, shells and solids",
  "source": [
    "warn: the acceptable ranges of the metrics, most of them of Knupp et al., The Verdict library",
    "reference manual, Sandia (2006); fail: chosen for linear finite elements" ],
  "criteria": [
    { "metric": "imr", "weight": 2,
      "limits": { "all": { "ideal": 1, "good": 1.5, "warn": 3, "fail": 10, "worst": 100 } } },
    { "metric": "scaled_jacobian", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.6, "warn": 0.3, "fail": 0.1, "worst": 0 } } },
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 90, "warn": 120, "fail": 160, "worst": 180 },
        "quadrilateral": { "ideal": 90, "good": 105, "warn": 120, "fail": 160, "worst": 180 },
        "tetrahedron": { "ideal": 70.5288, "good": 110, "warn": 150, "fail": 170, "worst": 180 },
        "hexahedron": { "ideal": 90, "good": 120, "warn": 150, "fail": 170, "worst": 180 } } }
  ]
}
)json" },
  { "skewness", R"json({
  "name": "Equiangle skewness, shells and solids",
  "source": [
    "ANSYS ICEM CFD help 2024 R2, 35.11.3 Checking the Skewness, Table 35.1, of 1 - skewness:",
    "excellent to 0.25, good to 0.5, fair to 0.75, poor to 0.98, bad (sliver) beyond; formula:",
    "largest deviation of a face angle from the ideal face, over the largest possible" ],
  "criteria": [
    { "metric": "equiangle_skew", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 0.5, "warn": 0.75, "fail": 0.98, "worst": 1 } } }
  ]
}
)json" },
  { "optistruct", R"json({
  "name": "OptiStruct shells",
  "source": [
    "Altair OptiStruct help, CTRIA6 (corner nodes) and CQUAD4 Element Checks and Default Bound",
    "Values: limits of warnings and of errors; formulas: longest edge / shortest edge; smallest",
    "and largest angle between adjacent edges (degrees)" ],
  "criteria": [
    { "metric": "edge_ratio", "weight": 1,
      "limits": {
        "triangle": { "ideal": 1, "good": 5, "warn": 50, "fail": 500, "worst": 100000 },
        "quadrilateral": { "ideal": 1, "good": 5, "warn": 100, "fail": 1000, "worst": 100000 } } },
    { "metric": "min_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 40, "warn": 15, "fail": 3, "worst": 0 },
        "quadrilateral": { "ideal": 90, "good": 60, "warn": 15, "fail": 3, "worst": 0 } } },
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 90, "warn": 165, "fail": 177, "worst": 180 },
        "quadrilateral": { "ideal": 90, "good": 120, "warn": 165, "fail": 177, "worst": 180 } } }
  ]
}
)json" },
  { "optistruct_solids", R"json({
  "name": "OptiStruct solids (tetrahedra)",
  "source": [
    "Altair OptiStruct 2021 help, CTETRA Element Checks and Default Bound Values: edge angle, the",
    "largest of |90 - angle between two faces| (degrees), limits of warnings (75) and, of CTETRA4,",
    "of errors (87), as limits of the dihedral angles. Omitted, as no metric has their",
    "definition: aspect ratio, skew and vertex angles of faces, collapse; and the other solids" ],
  "criteria": [
    { "metric": "min_angle", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 70.5288, "good": 40, "warn": 15, "fail": 3, "worst": 0 } } },
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 70.5288, "good": 110, "warn": 165, "fail": 177, "worst": 180 } } }
  ]
}
)json" },
  { "hypermesh", R"json({
  "name": "HyperMesh shells",
  "source": [
    "Altair HyperMesh: the default criteria of the quality index of shells, the string array of",
    "*setqualitycriteria in command files of the versions 2021, 2022.3 and 2025; formulas: Altair",
    "HyperMesh 2024 help, Element Quality Calculations, HyperMesh, with the shortest edge as",
    "length. Omitted, as no metric has their definition: warpage, skew, Jacobian, taper, length" ],
  "criteria": [
    { "metric": "edge_ratio", "weight": 1,
      "limits": {
        "triangle": { "ideal": 1, "good": 2, "warn": 4.4, "fail": 5, "worst": 10 },
        "quadrilateral": { "ideal": 1, "good": 2, "warn": 4.4, "fail": 5, "worst": 10 } } },
    { "metric": "min_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 50, "warn": 34, "fail": 30, "worst": 15 },
        "quadrilateral": { "ideal": 90, "good": 70, "warn": 46, "fail": 40, "worst": 20 } } },
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 80, "warn": 112, "fail": 120, "worst": 150 },
        "quadrilateral": { "ideal": 90, "good": 110, "warn": 134, "fail": 140, "worst": 160 } } }
  ]
}
)json" },
  { "hypermesh_solids", R"json({
  "name": "HyperMesh solids",
  "source": [
    "Altair HyperMesh 2021 reference guide, *elementtestequiaskew, equiangle skew of 2D and 3D",
    "elements: the threshold of its example, as the reference gives no default; an element beyond",
    "it fails; 2024 help, Element Quality Calculations, HyperMesh, Jacobian: at Gauss points",
    "values of 0.7 and above are generally acceptable, below it there is a warning; there is no",
    "limit of failure, so that elements fail where it is negative. Omitted, as no metric has",
    "their definition: aspect ratio, warpage, skew, interior angles of faces, tetra collapse,",
    "volumetric skew and volumetric aspect ratio" ],
  "criteria": [
    { "metric": "jacobian_integration", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 1, "good": 0.85, "warn": 0.7, "fail": 0, "worst": 0 },
        "hexahedron": { "ideal": 1, "good": 0.85, "warn": 0.7, "fail": 0, "worst": 0 },
        "wedge": { "ideal": 1, "good": 0.85, "warn": 0.7, "fail": 0, "worst": 0 },
        "pyramid": { "ideal": 1, "good": 0.85, "warn": 0.7, "fail": 0, "worst": 0 } } },
    { "metric": "equiangle_skew", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 0, "good": 0.5, "warn": 0.7, "fail": 0.7, "worst": 1 },
        "hexahedron": { "ideal": 0, "good": 0.5, "warn": 0.7, "fail": 0.7, "worst": 1 },
        "wedge": { "ideal": 0, "good": 0.5, "warn": 0.7, "fail": 0.7, "worst": 1 },
        "pyramid": { "ideal": 0, "good": 0.5, "warn": 0.7, "fail": 0.7, "worst": 1 } } }
  ]
}
)json" },
  { "nastran", R"json({
  "name": "Autodesk Nastran shells",
  "source": [
    "Autodesk Nastran 2025 reference, section 5, geometry processor parameters TRIMINIATOL,",
    "TRIMAXIATOL, QUADMINIATOL, QUADMAXIATOL: default tolerances of warnings; there are none of",
    "errors by default, so that elements fail at 0 and 180 degrees; TRIMAXEPADTOL, QUADMAXEPADTOL",
    "(30): edge-point angular deviation, whose formula the reference does not state. Omitted, as",
    "no metric has their definition: skew, taper, warping, edge-point length ratio, and angles of",
    "the faces of solids" ],
  "criteria": [
    { "metric": "midnode_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 0, "good": 15, "warn": 30, "fail": 180, "worst": 180 },
        "quadrilateral": { "ideal": 0, "good": 15, "warn": 30, "fail": 180, "worst": 180 } } },
    { "metric": "min_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 40, "warn": 10, "fail": 0, "worst": 0 },
        "quadrilateral": { "ideal": 90, "good": 60, "warn": 25, "fail": 0, "worst": 0 } } },
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 90, "warn": 170, "fail": 180, "worst": 180 },
        "quadrilateral": { "ideal": 90, "good": 120, "warn": 165, "fail": 180, "worst": 180 } } }
  ]
}
)json" },
  { "nastran_solids", R"json({
  "name": "Autodesk Nastran solids (tetrahedra)",
  "source": [
    "Autodesk Nastran 2019 and 2023 reference, section 5, geometry processor parameters",
    "TETFACEMINIATOL (5) and TETFACEMAXIATOL (170): default tolerances of the angles of faces",
    "(degrees); both are an equiangle skew of 55 / 60 = 110 / 120. There are no errors by default,",
    "so that elements fail at 1; TETMAXEPADTOL (30): edge-point angular deviation, whose formula",
    "the reference does not state. Omitted, as no metric has their definition: aspect ratio,",
    "skew, edge-point length ratio; and the other solids, whose two tolerances are different",
    "skews" ],
  "criteria": [
    { "metric": "midnode_angle", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 0, "good": 15, "warn": 30, "fail": 180, "worst": 180 } } },
    { "metric": "equiangle_skew", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 0, "good": 0.5, "warn": 0.9166666666666666, "fail": 1,
          "worst": 1 } } }
  ]
}
)json" },
  { "ansys", R"json({
  "name": "ANSYS Mechanical APDL shells (triangles)",
  "source": [
    "ANSYS Mechanical APDL 2023 R2 command reference, SHPP, notes: maximum corner angle of a",
    "triangle; formula: ANSYS Mechanical APDL theory reference, 12.1 Element Shape Testing.",
    "Omitted, as no metric has their definition: aspect ratio, parallel deviation, Jacobian ratio,",
    "warping factor. See skewness for ANSYS ICEM CFD" ],
  "criteria": [
    { "metric": "max_angle", "weight": 1,
      "limits": {
        "triangle": { "ideal": 60, "good": 90, "warn": 165, "fail": 179.9, "worst": 180 } } }
  ]
}
)json" },
  { "ansys_solids", R"json({
  "name": "ANSYS solids (tetrahedra)",
  "source": [
    "Ansys Discovery 2024 R2 user manual, Mesh Metrics, structural simulations: default lower",
    "limit of the element quality, 0.05; below it an element fails. The element quality is the",
    "volume over the square root of the cube of the sum of the squares of the edges, 1 for the",
    "ideal element: in tetrahedra the mean ratio to the power 3/2, whose limit is 0.05 to the",
    "power 2/3. Omitted, as no metric has their definition: Jacobian ratio, aspect ratio; and the",
    "other solids" ],
  "criteria": [
    { "metric": "mean_ratio", "weight": 1,
      "limits": {
        "tetrahedron": { "ideal": 1, "good": 0.6, "warn": 0.1357208808297453,
          "fail": 0.1357208808297453, "worst": 0 } } }
  ]
}
)json" },
  { "openfoam", R"json({
  "name": "OpenFOAM checkMesh (openfoam.com)",
  "source": [
    "OpenFOAM v1912, checkMesh without options: limits of primitiveMeshCheck; warnings of the",
    "non-orthogonality from 70 degrees. Volumes and areas are in the unit of the mesh" ],
  "convention": "esi",
  "criteria": [
    { "metric": "non_orthogonality", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 40, "warn": 70, "fail": 90, "worst": 180 } } },
    { "metric": "face_skewness", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 1, "warn": 4, "fail": 4, "worst": 20 } } },
    { "metric": "cell_aspect_ratio", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 100, "warn": 1000, "fail": 1000,
        "worst": 1e6 } } },
    { "metric": "openness", "weight": 0,
      "limits": { "all": { "ideal": 0, "good": 1e-9, "warn": 1e-6, "fail": 1e-6, "worst": 1 } } },
    { "metric": "pyramid_volume", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 0, "warn": -1e-15, "fail": -1e-15,
        "worst": -1 } } },
    { "metric": "cell_volume", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 1e-300, "warn": 1e-300, "fail": 1e-300,
        "worst": 0 } } },
    { "metric": "face_area", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 1e-300, "warn": 1e-300, "fail": 1e-300,
        "worst": 0 } } }
  ]
}
)json" },
  { "openfoam.org", R"json({
  "name": "OpenFOAM checkMesh (openfoam.org)",
  "source": [
    "OpenFOAM v1912, checkMesh without options: limits of primitiveMeshCheck; warnings of the",
    "non-orthogonality from 70 degrees. Volumes and areas are in the unit of the mesh" ],
  "convention": "foundation",
  "criteria": [
    { "metric": "non_orthogonality", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 40, "warn": 70, "fail": 90, "worst": 180 } } },
    { "metric": "face_skewness", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 1, "warn": 4, "fail": 4, "worst": 20 } } },
    { "metric": "cell_aspect_ratio", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 100, "warn": 1000, "fail": 1000,
        "worst": 1e6 } } },
    { "metric": "openness", "weight": 0,
      "limits": { "all": { "ideal": 0, "good": 1e-9, "warn": 1e-6, "fail": 1e-6, "worst": 1 } } },
    { "metric": "pyramid_volume", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 0, "warn": -1e-15, "fail": -1e-15,
        "worst": -1 } } },
    { "metric": "cell_volume", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 1e-300, "warn": 1e-300, "fail": 1e-300,
        "worst": 0 } } },
    { "metric": "face_area", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 1e-300, "warn": 1e-300, "fail": 1e-300,
        "worst": 0 } } }
  ]
}
)json" },
  { "snappy", R"json({
  "name": "snappyHexMesh, default mesh quality controls",
  "source": [
    "OpenFOAM v1912, etc/caseDicts/meshQualityDict: maxNonOrtho 65, maxBoundarySkewness 20,",
    "maxInternalSkewness 4, maxConcave 80, minVol 1e-13, minTetQuality 1e-15, minTwist 0.02,",
    "minDeterminant 0.001, minFaceWeight 0.05, minVolRatio 0.01. Volumes are in the unit of the",
    "mesh" ],
  "convention": "esi",
  "criteria": [
    { "metric": "non_orthogonality", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 40, "warn": 65, "fail": 65, "worst": 180 } } },
    { "metric": "internal_skewness", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 1, "warn": 4, "fail": 4, "worst": 20 } } },
    { "metric": "boundary_skewness", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 1, "warn": 20, "fail": 20, "worst": 100 } } },
    { "metric": "face_concavity", "weight": 1,
      "limits": { "all": { "ideal": 0, "good": 10, "warn": 80, "fail": 80, "worst": 90 } } },
    { "metric": "pyramid_volume", "weight": 0,
      "limits": { "all": { "ideal": 1, "good": 1e-13, "warn": 1e-13, "fail": 1e-13,
        "worst": -1 } } },
    { "metric": "center_tet_quality", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.1, "warn": 1e-15, "fail": 1e-15, "worst": -1 } } },
    { "metric": "fan_tet_quality", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.1, "warn": 1e-15, "fail": 1e-15, "worst": -1 } } },
    { "metric": "face_twist", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.5, "warn": 0.02, "fail": 0.02, "worst": -1 } } },
    { "metric": "area_determinant", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.1, "warn": 0.001, "fail": 0.001, "worst": 0 } } },
    { "metric": "face_weight", "weight": 1,
      "limits": { "all": { "ideal": 0.5, "good": 0.25, "warn": 0.05, "fail": 0.05, "worst": 0 } } },
    { "metric": "volume_ratio", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.25, "warn": 0.01, "fail": 0.01, "worst": 0 } } }
  ]
}
)json" },
  { "fluent", R"json({
  "name": "ANSYS Fluent, orthogonal quality",
  "source": [
    "ANSYS Fluent user's guide, Mesh Quality: the orthogonal quality of all cells should be above",
    "0.01, of most above 0.1" ],
  "criteria": [
    { "metric": "orthogonal_quality", "weight": 1,
      "limits": { "all": { "ideal": 1, "good": 0.5, "warn": 0.1, "fail": 0.01, "worst": 0 } } }
  ]
}
)json" },
} };
}
#endif
