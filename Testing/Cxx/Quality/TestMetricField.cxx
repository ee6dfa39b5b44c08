// SPDX-License-Identifier: BSD-3-Clause
// The field of a metric: ideal at the apex of the ideal cell, symmetric, negative below the base,
// the same when streamed in pieces, and smooth enough to contour.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Quality/MetricField.h"
#include "vtkContourFilter.h"
#include "vtkMetricField.h"

using namespace tautline;

namespace
{
const double height = std::sqrt(3.0) / 2;

/// Sets the grid to a single point.
void setPoint(vtkMetricField* field, double x, double y, double z)
{
  TAUTLINE_SET(field, SetBounds(x, x, y, y, z, z), SetDimensions(1, 1, 1));
}

TAUTLINE_PART(testDefaults)
{
  TAUTLINE_NEW(vtkMetricField, field, Update());
  vtkImageData* image = field->GetOutput();
  const int* size = image->GetDimensions();
  TAUTLINE_CHECK(size[0] == 301 && size[1] == 201 && size[2] == 1);
  const double* bounds = image->GetBounds();
  const double expected[] = { -1, 2, 0, 2, 0, 0 };
  TAUTLINE_EACH(int, i, 6, TAUTLINE_CHECK_NEAR(bounds[i], expected[i], 1e-14));
  TAUTLINE_CHECK_EQUAL(image->GetPointData()->GetNumberOfArrays(), 2);
  TAUTLINE_CHECK_EQUAL(std::string(image->GetPointData()->GetScalars()->GetName()), "imr");

  // Every value against the formula, and its mirror image about x = 0.5.
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const Vec3 p = { image->GetPoint(i)[0], image->GetPoint(i)[1], 0 };
    const double q = component(image->GetPointData(), "imr", i);
    const double edges = 1 + dot(p, p) + dot(p - Vec3{ 1, 0, 0 }, p - Vec3{ 1, 0, 0 });
    const bool flat = i < 301;
    const double formula = flat ? 0 : edges / (2 * std::sqrt(3.0) * p[1]);
    TAUTLINE_CHECK_NEAR(q, formula, 1e-12 * std::max(1.0, formula));
    TAUTLINE_CHECK_EQUAL(component(image->GetPointData(), "Validity", i), flat ? 0 : 1);
    const vtkIdType mirror = i - i % 301 + 300 - i % 301;
    TAUTLINE_CHECK_NEAR(component(image->GetPointData(), "imr", mirror), q, 1e-9 * q);
  }
}

// (3.3): (|A - beta| - (A - beta)) / 2 with A = y / 2, everywhere on the default grid.
TAUTLINE_PART(testBeta)
{
  TAUTLINE_NEW(vtkMetricField, field, ClearMetrics(), AddMetricByName("untangle_beta"));
  TAUTLINE_CHECK_NEAR(field->GetBeta(), 0.25, 0);
  for (double beta : { 0.25, 0.0, 0.6, -0.1 })
  {
    TAUTLINE_SET(field, SetBeta(beta), Update());
    vtkImageData* image = field->GetOutput();
    double largest = 0;
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      const double q = component(image->GetPointData(), "untangle_beta", i);
      TAUTLINE_CHECK_NEAR(q, std::max(0.0, beta - 0.5 * image->GetPoint(i)[1]), 1e-14);
      largest = std::max(largest, q);
    }
    TAUTLINE_CHECK_NEAR(largest, std::max(0.0, beta), 1e-14);
  }
}

TAUTLINE_PART(testIdealApex)
{
  vtkNew<vtkMetricField> field;
  for (int cell : { vtkMetricField::TRIANGLE, vtkMetricField::TETRAHEDRON })
  {
    const bool flat = cell == vtkMetricField::TRIANGLE;
    TAUTLINE_SET(field, SetCell(cell), ClearMetrics());
    for (const MetricInfo& info : elementMetrics())
    {
      if (info.definedOn(flat ? CellType::Triangle : CellType::Tetrahedron))
      {
        field->AddMetric(static_cast<int>(info.metric));
      }
    }
    field->SetBeta(0);
    auto values = [&](double y, double z)
    {
      setPoint(field, 0.5, y, z);
      field->Update();
      return field->GetOutput()->GetPointData();
    };
    vtkPointData* apex = values(flat ? height : height / 3, flat ? 0 : std::sqrt(2.0 / 3));
    TAUTLINE_CHECK(field->GetNumberOfMetrics() > 25);
    TAUTLINE_CHECK_EQUAL(apex->GetNumberOfArrays(), field->GetNumberOfMetrics() + 1);
    for (const MetricInfo& info : elementMetrics())
    {
      const Context context(info.name);
      const double ideal = info.ideal(flat ? 2 : 3);
      if (apex->GetArray(info.name) && std::isfinite(ideal))
      {
        // mu_98, mu_14 and similar metrics also need the ideal cell's orientation, which this has.
        TAUTLINE_CHECK_NEAR(component(apex, info.name, 0), ideal, 1e-6);
      }
    }
    vtkPointData* below = values(flat ? -height : height / 3, -std::sqrt(2.0 / 3));
    TAUTLINE_CHECK_EQUAL(component(below, "Validity", 0), -1);
    TAUTLINE_CHECK_NEAR(component(below, "imr", 0), -1, 1e-12);
    TAUTLINE_CHECK(component(below, "size", 0) < 0);
  }
}

TAUTLINE_PART(testTetrahedronAgainstCells)
{
  TAUTLINE_NEW(vtkMetricField, field, SetCellToTetrahedron(), SetVertex1(0.1, 0.2, -0.3),
    SetVertex2(1.2, -0.1, 0.1), SetVertex3(0.3, 0.9, 0.2), SetBounds(-1, 1, -2, 2, -1, 3),
    SetDimensions(5, 4, 3), AddMetricByName("radius ratio"));
  field->AddMetricByName("rr"); // the same
  TAUTLINE_SET(field, AddMetricByName("mu_303"), Update());
  vtkImageData* image = field->GetOutput();
  TAUTLINE_CHECK_EQUAL(field->GetNumberOfMetrics(), 2);
  TAUTLINE_CHECK_EQUAL(image->GetNumberOfPoints(), 60);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    Vec3 p;
    image->GetPoint(i, p.data());
    const std::vector<Vec3> corners = { { 0.1, 0.2, -0.3 }, { 1.2, -0.1, 0.1 }, { 0.3, 0.9, 0.2 },
      p };
    TAUTLINE_CHECK_RELATIVE(component(image->GetPointData(), "rr", i),
      valueOf(CellType::Tetrahedron, corners, Metric::RadiusRatio), 1e-12);
    TAUTLINE_CHECK_RELATIVE(component(image->GetPointData(), "mu_shape", i),
      valueOf(CellType::Tetrahedron, corners, Metric::ShapeBarrier), 1e-12);
  }
}

TAUTLINE_PART(testPieces)
{
  vtkNew<vtkMetricField> whole, part;
  for (vtkMetricField* field : { whole.Get(), part.Get() })
  {
    TAUTLINE_SET(field, SetCellToTetrahedron(), SetDimensions(31, 21, 11));
  }
  TAUTLINE_SET(whole, SetThreads(1), Update());
  part->SetThreads(2);
  const int extent[] = { 3, 17, 5, 20, 4, 9 };
  part->UpdateExtent(extent);
  vtkImageData* image = part->GetOutput();
  TAUTLINE_EACH(int, i, 6, TAUTLINE_CHECK_EQUAL(image->GetExtent()[i], extent[i]));
  for (int k = extent[4]; k <= extent[5]; ++k)
  {
    for (int j = extent[2]; j <= extent[3]; ++j)
    {
      for (int i = extent[0]; i <= extent[1]; ++i)
      {
        int at[3] = { i, j, k };
        TAUTLINE_CHECK_EQUAL(component(image->GetPointData(), "imr", image->ComputePointId(at)),
          component(
            whole->GetOutput()->GetPointData(), "imr", whole->GetOutput()->ComputePointId(at)));
      }
    }
  }
}

TAUTLINE_PART(testContour)
{
  // Where the inverse mean ratio of a triangle is q, its apex is on a circle.
  vtkNew<vtkMetricField> field;
  TAUTLINE_NEW(vtkContourFilter, contour, SetInputConnection(field->GetOutputPort()),
    SetValue(0, 1.5), Update());
  vtkPolyData* lines = contour->GetOutput();
  TAUTLINE_CHECK(lines->GetNumberOfPoints() > 100);
  const double centre = 1.5 * height, radius = std::sqrt(centre * centre - 0.75);
  Index onCircle = 0;
  for (vtkIdType i = 0; i < lines->GetNumberOfPoints(); ++i)
  {
    const double *p = lines->GetPoint(i), r = std::hypot(p[0] - 0.5, p[1] - centre);
    // Below the first row the values fall to 0, where the cell is degenerate: a line of its own.
    TAUTLINE_CHECK(std::abs(r - radius) < 2e-4 || p[1] < 0.01);
    onCircle += std::abs(r - radius) < 2e-4;
  }
  TAUTLINE_CHECK(onCircle > 100);
}

TAUTLINE_PART(testRejections)
{
  vtkNew<vtkMetricField> field;
  Messages messages(field);
  auto rejects = [&](const std::string& part)
  {
    messages.clear();
    field->Update();
    TAUTLINE_CHECK(messages.has(part));
    TAUTLINE_CHECK_EQUAL(field->GetOutput()->GetNumberOfPoints(), 0);
  };
  TAUTLINE_SET(field, AddMetricByName("width_ratio"), SetCellToTetrahedron());
  rejects(wording("aspect-ratio-w-w-is-not-defined"));
  TAUTLINE_SET(field, ClearMetrics(), SetVertex2(0.3, 0.1, 0.7), SetVertex3(0.99, 0.33, 2.31));
  rejects(wording("are-on-a-line"));
  TAUTLINE_SET(field, SetCellToTriangle(), SetVertex2(0, 0, 5));
  rejects("coincide");
  TAUTLINE_SET(field, SetVertex2(1, 0, 0), SetBounds(1, 1, 0, 2, 0, 0));
  rejects("Along x");
  messages.clear();
  field->AddMetric(99);
  TAUTLINE_CHECK(messages.has(wording("no-metric-number-99")));
  messages.clear();
  field->AddMetricByName("nonsense");
  TAUTLINE_CHECK(messages.has(wording("no-metric-nonsense")));
  TAUTLINE_CHECK_EQUAL(field->GetNumberOfMetrics(), 0);
}

/// A tetrahedron or triangle of this size and place, with the metrics of the names, on a grid of 4
/// points along each axis.
vtkPointData* fieldAt(
  vtkMetricField* field, int cell, double size, double place, const std::vector<const char*>& names)
{
  const auto at = [=](double x) { return place + size * x; };
  TAUTLINE_SET(field, SetCell(cell), SetVertex1(at(0.25), at(0), at(0)),
    SetVertex2(at(1.25), at(0.25), at(0)), SetVertex3(at(0.5), at(1), at(0)),
    SetBounds(at(-0.5), at(1), at(0.5), at(2), at(0.5), at(1.25)), SetDimensions(4, 4, 4),
    ClearMetrics());
  for (const char* name : names)
  {
    field->AddMetricByName(name);
  }
  field->Update();
  return field->GetOutput()->GetPointData();
}

/// At extreme scales and far from the origin the values equal the values of an ordinary place,
/// times a power of the scale, or rejected by name.
TAUTLINE_PART(testScales)
{
  for (int cell : { vtkMetricField::TRIANGLE, vtkMetricField::TETRAHEDRON })
  {
    const int dimension = cell == vtkMetricField::TRIANGLE ? 2 : 3;
    const Context which("dimension " + std::to_string(dimension));
    const std::vector<const char*> names = { "imr", "rr", "mu_shape", "scaled_jacobian" };
    vtkNew<vtkMetricField> ordinary, field;
    Messages messages(field);
    vtkPointData* expected = fieldAt(ordinary, cell, 1, 0, names);
    const vtkIdType count = dimension == 2 ? 16 : 64;
    const auto same = [&](vtkPointData* data, const char* name, double factor, double tolerance)
    {
      TAUTLINE_EACH(vtkIdType, i, count,
        TAUTLINE_CHECK_RELATIVE(
          component(data, name, i), factor * component(expected, name, i), tolerance));
    };
    const struct
    {
      double size, place, tolerance;
    } cases[] = { { 1e-12, 0, 1e-9 }, { 1e12, 0, 1e-9 }, { 1e-150, 0, 1e-9 }, { 1e150, 0, 1e-9 },
      { 1e-200, 0, 1e-9 }, { 1e200, 0, 1e-9 }, { 1, 1e6, 1e-9 }, { 1, 1e12, 1e-9 },
      { 1e3, 1e15, 1e-9 } };
    for (const auto& at : cases)
    {
      const Context context(
        std::to_string(std::log10(at.size)) + " at " + std::to_string(at.place));
      vtkPointData* data = fieldAt(field, cell, at.size, at.place, names);
      TAUTLINE_CHECK(messages.empty());
      for (const char* name : names)
      {
        same(data, name, 1.0, at.tolerance);
      }
      TAUTLINE_CHECK_EQUAL(component(data, "Validity", 0), component(expected, "Validity", 0));
    }
    expected = fieldAt(ordinary, cell, 1, 0, { "size" });
    for (double size : { 1e-12, 1e12 })
    {
      same(fieldAt(field, cell, size, 0, { "size" }), "size", std::pow(size, dimension), 1e-9);
    }
    TAUTLINE_CHECK(messages.empty());
    // Values that double precision does not hold, vertices and bounds that are the same number.
    const struct
    {
      double size, place;
      const char* name;
      const char* text;
    } rejected[] = { { 1e-150, 0, "mu_size_squared", "is beyond the range of double precision" },
      { 1e150, 0, "mu_size_squared", "is beyond the range of double precision" },
      { 1e-200, 0, "size", "is beyond the range of double precision" },
      { 1e-12, 1e12, "imr", "Bounds must increase and be finite" },
      { 1e308, 0, "imr", "Bounds must increase and be finite" },
      { 0, 0, "imr", "Bounds must increase and be finite" },
      { std::nan(""), 0, "imr", "Bounds must increase and be finite" } };
    for (const auto& at : rejected)
    {
      const Context context(std::to_string(std::log10(at.size)) + " " + at.name);
      messages.clear();
      fieldAt(field, cell, at.size, at.place, { at.name });
      TAUTLINE_CHECK(messages.has(at.text));
      TAUTLINE_CHECK_EQUAL(field->GetOutput()->GetNumberOfPoints(), 0);
    }
    messages.clear();
    fieldAt(field, cell, 1, 0, { "imr" });
    for (double wrong : { std::nan(""), HUGE_VAL })
    {
      field->SetVertex2(wrong, 0, 0);
      messages.clear();
      field->Update();
      TAUTLINE_CHECK(messages.has(wording("not-finite-move-one-of-them")));
    }
  }
}

} // anonymous namespace
