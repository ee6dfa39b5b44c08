// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Criteria.h
 * @brief Quality criteria: limits per metric and cell type, grades of elements, one index, a
 * verdict.
 *
 * A criterion has five limits for a cell type, from the value of an ideal element to the worst:
 * ideal, good, warn, fail, worst. An element whose value is beyond `warn` gets a warning, one
 * beyond `fail` fails; a value at a limit belongs to the better side. Inverted and degenerate
 * elements fail, unless all criteria are finite-volume metrics, which measure them in their own
 * way.
 *
 * The penalty of a value is 0 at ideal, 1/4 at good, 1/2 at warn, 3/4 at fail and 1 at worst,
 * linear between and constant beyond. The quality index of an element is the weighted mean of the
 * penalties of its criteria, or 1 for an invalid element. The index of a mesh is the mean over its
 * elements: 0 is ideal, 1 the worst.
 *
 * Criteria are written in JSON, for example
 *
 *     { "name": "My project", "source": "Rules for solid models, 2024",
 *       "criteria": [
 *         { "metric": "imr", "weight": 2, "limits": {
 *             "all": { "ideal": 1, "good": 1.5, "warn": 3, "fail": 10, "worst": 100 } } },
 *         { "metric": "min_angle", "weight": 1, "limits": {
 *             "triangle": { "ideal": 60, "good": 40, "warn": 20, "fail": 5, "worst": 0 } } } ] }
 *
 * `metric` is also the name of a check of solvers (see ElementChecks.h): these are defined on all
 * types. `limits` is by cell type (triangle, quadrilateral, tetrahedron, hexahedron, wedge,
 * pyramid; for finite-volume metrics also polygon and polyhedron) or "all" for the other types on
 * which the metric is defined. `name`, `source`, a text or a list of its lines, `weight` (1) and,
 * at the top, `convention` ("esi" or "foundation": of face centers, see FaceGeometry.h) may be left
 * out.
 */
#ifndef tautline_Criteria_h
#define tautline_Criteria_h

#include "Metrics.h"

#include <optional>

namespace tautline
{
/// The five limits, rising or falling from ideal to worst.
struct QualityLimits
{
  double ideal = 0, good = 0, warn = 0, fail = 0, worst = 0;
};

/// The grade of an element or of a mesh.
enum class Grade : signed char
{
  None = -1, ///< no criterion applies
  Passed = 0,
  Warning = 1,
  Failed = 2
};

/// "passed", "warning", "failed" or "none".
TAUTLINE_KERNEL_EXPORT const char* gradeName(Grade grade);

/// The cell types that can have limits: the types of topologies(), then polygons and polyhedra.
constexpr int NumberOfGradedTypes = NumberOfCellTypes + 2;

/// The position of a VTK type among them, or -1.
TAUTLINE_KERNEL_EXPORT int gradedTypeIndex(int vtkCellType);

/// The limits of one metric, or of a check of solvers.
struct QualityCriterion
{
  Metric metric = Metric::InverseMeanRatio;
  int check = -1; ///< a position in elementChecks(), see ElementChecks.h; negative: the metric
  double weight = 1;
  std::array<std::optional<QualityLimits>, NumberOfGradedTypes> limits; ///< by gradedTypeIndex()

  /// The name of the metric or the check.
  TAUTLINE_KERNEL_EXPORT const char* name() const;
  TAUTLINE_KERNEL_EXPORT const char* label() const;
};

/// Criteria with the name and source of their limits.
struct QualityCriteria
{
  std::string name, source;
  std::string convention;                 ///< "esi", "foundation" or "": not stated
  std::vector<QualityCriterion> criteria; ///< at least one, each with a different metric
};

/**
 * @brief Reads criteria.
 * @param json see above
 *
 * Throws Error, with the location, for text that is not JSON; unknown keys, metrics or cell types;
 * metrics that are undefined on a cell type; limits that are not finite, not monotonic, or ordered
 * against the direction of the metric; and weights that are negative or all 0.
 */
TAUTLINE_KERNEL_EXPORT QualityCriteria parseCriteria(const std::string& json);

/// The cells that criteria have limits for: "shells" (triangles, quadrilaterals), "solids" (the
/// others) or "shells and solids"; "finite volumes" if all criteria are finite-volume metrics.
TAUTLINE_KERNEL_EXPORT std::string gradedCells(const QualityCriteria& criteria);

/// The names of the presets.
TAUTLINE_KERNEL_EXPORT const std::vector<std::string>& criteriaPresets();

/// The JSON of a preset; throws Error, listing the names, for another name.
TAUTLINE_KERNEL_EXPORT std::string presetCriteria(const std::string& name);

/// The grade of a value.
TAUTLINE_KERNEL_EXPORT Grade gradeOf(const QualityLimits& limits, double value);

/// The penalty of a value, 0 to 1.
TAUTLINE_KERNEL_EXPORT double penaltyOf(const QualityLimits& limits, double value);

/// Sums over elements; the sums of several parts of a mesh can be added.
struct TAUTLINE_KERNEL_EXPORT CriteriaTotals
{
  struct PerCriterion
  {
    Index graded = 0, warned = 0, failed = 0; ///< valid elements with limits for their type
    double penalty = 0;                       ///< sum
  };
  Index graded = 0, warned = 0, failed = 0; ///< elements; failed ones include invalid ones
  double index = 0;                         ///< sum
  std::vector<PerCriterion> criteria;       ///< as in QualityCriteria

  /// The verdict on the mesh: the grade of its worst element; None without elements.
  Grade verdict() const;
  /// The index of the mesh; 0 without elements.
  double meanIndex() const { return this->graded > 0 ? this->index / this->graded : 0.0; }
};

/**
 * @brief Grades the cells of a mesh.
 * @param criteria the criteria to grade
 * @param mesh its cell types
 * @param validity per cell, see Validity
 * @param uncounted nonzero: the cell is excluded from the totals; may be null
 * @param skip nonzero: the cell gets no grade; may be null
 * @param values per criterion: the values of its metric, one per cell
 * @param grades a Grade per cell, overwritten
 * @param indices the quality index per cell, overwritten; 0 without a grade
 * @param totals incremented by the contributions of the cells
 */
TAUTLINE_KERNEL_EXPORT void gradeCells(const QualityCriteria& criteria, const Mesh& mesh,
  const signed char* validity, const unsigned char* uncounted, const unsigned char* skip,
  const std::vector<const double*>& values, signed char* grades, double* indices,
  CriteriaTotals& totals);
}
#endif
