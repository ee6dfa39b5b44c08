// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Criteria.h
 * @brief Quality criteria: limits per metric and cell type, grades of elements, one index, a
 * verdict.
 *
 * A criterion has five limits for a cell type, from the value of an ideal element to one that is as
 * bad as any: ideal, good, warn, fail, worst. An element whose value is beyond `warn` gets a
 * warning, one beyond `fail` fails; a value at a limit is still on its better side. Inverted and
 * degenerate elements fail, unless all criteria are metrics of finite volumes: these have measures
 * of their own for them.
 *
 * The penalty of a value is 0 at ideal, 1/4 at good, 1/2 at warn, 3/4 at fail and 1 at worst,
 * linear between and constant beyond. The quality index of an element is the mean of the penalties
 * of its criteria by their weights, 1 for an invalid element. The index of a mesh is the mean over
 * its elements: 0 is ideal, 1 the worst.
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
 * pyramid; of metrics of finite volumes also polygon and polyhedron) or "all" for those that are
 * not named and that the metric is defined on. `name`, `source`, a text or a list of its lines,
 * `weight` (1) and, at the top, `convention` ("esi" or "foundation": of face centers, see
 * FaceGeometry.h) may be left out.
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

/// The cell types that limits are for: those of topologies(), then polygons and polyhedra.
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

  /// Of the metric or the check.
  TAUTLINE_KERNEL_EXPORT const char* name() const;
  TAUTLINE_KERNEL_EXPORT const char* label() const;
};

/// Criteria with the name and source of their limits.
struct QualityCriteria
{
  std::string name, source;
  std::string convention;                 ///< "esi", "foundation" or "": not stated
  std::vector<QualityCriterion> criteria; ///< at least one, each of another metric
};

/**
 * @brief Reads criteria.
 * @param json see above
 *
 * Throws Error, which names the place, for text that is not JSON, unknown keys, metrics or cell
 * types, metrics not defined on a cell type, limits that are not finite, do not rise or fall
 * throughout or do so against the direction of the metric, and weights that are negative or all 0.
 */
TAUTLINE_KERNEL_EXPORT QualityCriteria parseCriteria(const std::string& json);

/// The cells that criteria have limits for: "shells" (triangles, quadrilaterals), "solids" (the
/// others) or "shells and solids"; "finite volumes" of criteria that are all metrics of these.
TAUTLINE_KERNEL_EXPORT std::string gradedCells(const QualityCriteria& criteria);

/// The names of the presets.
TAUTLINE_KERNEL_EXPORT const std::vector<std::string>& criteriaPresets();

/// The JSON of a preset; throws Error, which lists the names, for another name.
TAUTLINE_KERNEL_EXPORT std::string presetCriteria(const std::string& name);

/// The grade of a value.
TAUTLINE_KERNEL_EXPORT Grade gradeOf(const QualityLimits& limits, double value);

/// The penalty of a value, 0 to 1.
TAUTLINE_KERNEL_EXPORT double penaltyOf(const QualityLimits& limits, double value);

/// Sums over elements; those of several parts of a mesh are added.
struct TAUTLINE_KERNEL_EXPORT CriteriaTotals
{
  struct PerCriterion
  {
    Index graded = 0, warned = 0, failed = 0; ///< valid elements with limits for their type
    double penalty = 0;                       ///< sum
  };
  Index graded = 0, warned = 0, failed = 0; ///< elements; failed ones with the invalid ones
  double index = 0;                         ///< sum
  std::vector<PerCriterion> criteria;       ///< as in QualityCriteria

  /// Of the mesh: that of its worst element; None without an element.
  Grade verdict() const;
  /// The index of the mesh; 0 without an element.
  double meanIndex() const { return this->graded > 0 ? this->index / this->graded : 0.0; }
};

/**
 * @brief Grades the cells of a mesh.
 * @param criteria nothing else is graded
 * @param mesh its cell types
 * @param validity per cell, see Validity
 * @param uncounted nonzero: the cell does not count in the totals; may be null
 * @param skip nonzero: the cell gets no grade; may be null
 * @param values per criterion the values of its metric, one per cell
 * @param grades per cell a Grade, overwritten
 * @param indices per cell the quality index, overwritten; 0 without a grade
 * @param totals what the cells add
 */
TAUTLINE_KERNEL_EXPORT void gradeCells(const QualityCriteria& criteria, const Mesh& mesh,
  const signed char* validity, const unsigned char* uncounted, const unsigned char* skip,
  const std::vector<const double*>& values, signed char* grades, double* indices,
  CriteriaTotals& totals);
}
#endif
