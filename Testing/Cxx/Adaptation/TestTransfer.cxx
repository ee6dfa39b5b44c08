// SPDX-License-Identifier: BSD-3-Clause
// Fields on another mesh: totals, bounds, exactness and orders of the kernel, meshes that cover
// each other in part, surfaces, mixed cells; and the filter with its arrays, blocks and errors.
#include "Registry.h"
#include "Surfaces.h"
#include "VtkMeshes.h"
#include "tautline/Adaptation/FieldTransfer.h"
#include "tautline/Geometry/SimplexOverlap.h"
#include "vtkFieldTransfer.h"

#include "vtkFloatArray.h"

using namespace tautline;

namespace
{
constexpr double TotalTolerance = 1e-12;

/// A square or cube of side 1; its inner points are moved at random by up to a part of the spacing.
MeshData shakenBlock(CellType type, Index n, unsigned seed, double part = 0.2)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  Random random(seed);
  data.transform(
    [&](const Vec3& p)
    {
      Vec3 moved = p;
      for (int k = 0; k < (flat ? 2 : 3); ++k)
      {
        const double step = random.uniform(-part, part);
        moved[k] += p[k] > 0.5 && p[k] < double(n) - 0.5 ? step : 0.0;
      }
      return (1.0 / double(n)) * moved;
    });
  return data;
}

MeshData shifted(MeshData data, const Vec3& by)
{
  data.transform([by](const Vec3& p) { return p + by; });
  return data;
}

TransferMesh transferMesh(const MeshData& data)
{
  TransferMesh mesh(elementDimension(data.view()));
  mesh.add(data.view(), nullptr);
  return mesh;
}

template <class Function>
TransferField pointField(const TransferMesh& mesh, const Function& f)
{
  TAUTLINE_LET(TransferField, field, values = collect<double>(mesh.points(), f));
  return field;
}

template <class Function>
TransferField cellField(const TransferMesh& mesh, const Function& f)
{
  TAUTLINE_LET(TransferField, field, ofCells = true,
    values = collect<double>(mesh.numberOfCells(), [&](Index c) { return f(mesh.center(c)); }));
  return field;
}

double linear(const Vec3& x)
{
  return 1.0 + 2.0 * x[0] - x[1] + 3.0 * x[2];
}
double smooth(const Vec3& x)
{
  return std::sin(3.0 * x[0]) * std::cos(2.0 * x[1]) * std::exp(x[2]);
}
double step(const Vec3& x)
{
  return x[0] > 0.45 ? 1.0 : 0.0;
}
double constant(const Vec3&)
{
  return 3.7;
}

/// The total is kept, and no value is outside of the range of the source.
void checkTotals(const TransferredField& field, double tolerance = TotalTolerance)
{
  for (const TransferTotal& total : field.totals)
  {
    TAUTLINE_CHECK_NEAR(total.after, total.before, tolerance * total.magnitude);
    const double beyond = total.excess + 1e-14 * std::abs(total.maximumBefore);
    TAUTLINE_CHECK(total.minimumAfter >= total.minimumBefore - beyond);
    TAUTLINE_CHECK(total.maximumAfter <= total.maximumBefore + beyond);
  }
}

void checkBounds(const TransferredField& field)
{
  checkTotals(field);
  TAUTLINE_CHECK_EQUAL(field.totals[0].excess, 0);
}

/// All that holds for two meshes of the same place.
void testSamePlace(const MeshData& before, const MeshData& after)
{
  const TransferMesh source = transferMesh(before), target = transferMesh(after);
  const std::vector<TransferField> fields = { pointField(source, linear),
    pointField(source, constant), pointField(source, step), pointField(source, smooth),
    cellField(source, constant), cellField(source, step), cellField(source, smooth) };
  for (const CellReconstruction cells :
    { CellReconstruction::Constant, CellReconstruction::Linear })
  {
    for (const bool keeps : { true, false })
    {
      TAUTLINE_LET(TransferOptions, options, cells = cells, keepTotal = keeps);
      const TransferResult result = transferFields(target, source, fields, options);
      for (const TransferredField& field : result.fields)
      {
        checkBounds(field);
      }
      TAUTLINE_CHECK_NEAR(result.sourceCovered, result.sourceSize, 1e-12);
      TAUTLINE_CHECK_NEAR(result.targetCovered, result.targetSize, 1e-12);
      for (Index p = 0; p < target.numberOfPoints(); ++p)
      {
        TAUTLINE_CHECK_NEAR(result.fields[0].values[p], linear(target.points()[p]), 2e-12);
        TAUTLINE_CHECK_NEAR(result.fields[1].values[p], 3.7, 1e-14);
      }
      for (Index c = 0; c < target.numberOfCells(); ++c)
      {
        TAUTLINE_CHECK_NEAR(result.fields[4].values[c], 3.7, 1e-14);
      }
    }
  }
}

TAUTLINE_PART(testPlanar)
{
  testSamePlace(shakenBlock(CellType::Triangle, 9, 1), shakenBlock(CellType::Triangle, 7, 2));
  testSamePlace(shakenBlock(CellType::Quadrilateral, 6, 3), shakenBlock(CellType::Triangle, 11, 4));
  testSamePlace(shakenBlock(CellType::Triangle, 3, 5), shakenBlock(CellType::Quadrilateral, 20, 6));
}

TAUTLINE_PART(testVolumes)
{
  testSamePlace(shakenBlock(CellType::Tetrahedron, 4, 1), shakenBlock(CellType::Tetrahedron, 3, 2));
  testSamePlace(shakenBlock(CellType::Tetrahedron, 3, 3), shakenBlock(CellType::Hexahedron, 5, 4));
  testSamePlace(shakenBlock(CellType::Wedge, 3, 5), shakenBlock(CellType::Pyramid, 2, 6));
}

/// Pieces of an intersection fill it, and coordinates sum to 1.
TAUTLINE_PART(testOverlaps)
{
  Random random(7);
  const SimplexCorners<4> large = { Vec3{ -9, -9, -9 }, Vec3{ 90, -9, -9 }, Vec3{ -9, 90, -9 },
    Vec3{ -9, -9, 90 } };
  for (int i = 0; i < 200; ++i)
  {
    SimplexCorners<4> x, y;
    for (int k = 0; k < 4; ++k)
    {
      x[k] = random.vector(-1, 1);
      y[k] = random.vector(-1, 1);
    }
    const auto sizeOf = [](const SimplexCorners<4>& a, const SimplexCorners<4>& b)
    {
      double sum = 0;
      SimplexOverlap<4>(a, b).forEachPiece(
        [&](const auto& first, const auto& second, double size)
        {
          sum += size;
          for (int corner = 0; corner < 4; ++corner)
          {
            double one = 0, other = 0;
            Vec3 there = { 0, 0, 0 };
            for (int k = 0; k < 4; ++k)
            {
              one += first(corner, k);
              other += second(corner, k);
              there += first(corner, k) * a[k] - second(corner, k) * b[k];
            }
            TAUTLINE_CHECK_NEAR(one, 1, 1e-12);
            TAUTLINE_CHECK_NEAR(other, 1, 1e-12);
            TAUTLINE_CHECK(norm(there) < 1e-9);
          }
        });
      return sum;
    };
    const double whole = std::abs(simplexSize(x));
    TAUTLINE_CHECK_NEAR(sizeOf(x, x), whole, 1e-13);
    TAUTLINE_CHECK_NEAR(sizeOf(x, large), whole, 1e-13);
    TAUTLINE_CHECK_NEAR(sizeOf(x, y), sizeOf(y, x), 1e-12);
  }
}

/// The order of the L2 error of a smooth function: 2 for points, 1 for cells, and with linear
/// functions in them 2 away from the boundary.
TAUTLINE_PART(testOrders)
{
  const auto errors = [](Index n)
  {
    const MeshData before = shakenBlock(CellType::Triangle, n, 1);
    const TransferMesh source = transferMesh(before),
                       target = transferMesh(shakenBlock(CellType::Triangle, n + n / 4, 2));
    const std::vector<TransferField> fields = { pointField(source, smooth),
      cellField(source, smooth) };
    std::vector<double> found;
    for (const CellReconstruction cells :
      { CellReconstruction::Constant, CellReconstruction::Linear })
    {
      TAUTLINE_LET(TransferOptions, options, cells = cells);
      const TransferResult result = transferFields(target, source, fields, options);
      const double ofPoints = sumOf(0.0, target.numberOfPoints(),
        [&](Index p)
        {
          const double d = result.fields[0].values[p] - smooth(target.points()[p]);
          return d * d / double(target.numberOfPoints());
        });
      const double ofCells = sumOf(0.0, target.numberOfCells(),
        [&](Index c)
        {
          const double d = result.fields[1].values[c] - smooth(target.center(c));
          return d * d * target.sizeOfCell(c);
        });
      found.push_back(std::sqrt(ofPoints));
      found.push_back(std::sqrt(ofCells));
    }
    return found;
  };
  const std::vector<double> coarse = errors(16), fine = errors(32);
  const auto order = [&](int i) { return std::log2(coarse[i] / fine[i]); };
  TAUTLINE_CHECK(order(0) > 1.8);
  TAUTLINE_CHECK(order(1) > 0.8);
  TAUTLINE_CHECK(order(3) > 1.4); // the limiter acts along the boundary
  TAUTLINE_CHECK(fine[3] < 0.3 * fine[1]);
}

/// Fields of a mesh on itself do not change.
TAUTLINE_PART(testIdentity)
{
  for (const CellType type :
    { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron, CellType::Quadrilateral })
  {
    const TransferMesh mesh = transferMesh(shakenBlock(type, 4, 3));
    const std::vector<TransferField> fields = { pointField(mesh, smooth), cellField(mesh, smooth),
      pointField(mesh, step) };
    TAUTLINE_LET(TransferOptions, options, cellLabels = true, pointLabels = true);
    const TransferResult result = transferFields(mesh, mesh, fields, options);
    for (std::size_t f = 0; f < fields.size(); ++f)
    {
      for (std::size_t i = 0; i < fields[f].values.size(); ++i)
      {
        TAUTLINE_CHECK_NEAR(result.fields[f].values[i], fields[f].values[i], 1e-12);
      }
    }
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      TAUTLINE_CHECK_EQUAL(result.cells[c], c);
    }
    for (Index p = 0; p < mesh.numberOfPoints(); ++p)
    {
      TAUTLINE_CHECK_EQUAL(result.points[p], p);
    }
  }
}

/// Boundaries that differ: totals are kept, or values bounded.
TAUTLINE_PART(testGaps)
{
  const TransferMesh source = transferMesh(shakenBlock(CellType::Triangle, 12, 1));
  const TransferMesh moved =
    transferMesh(shifted(shakenBlock(CellType::Triangle, 10, 2), { 0.11, -0.04, 0 }));
  const std::vector<TransferField> fields = { pointField(source, smooth),
    pointField(source, constant), cellField(source, smooth), cellField(source, constant) };
  const TransferResult kept = transferFields(moved, source, fields, {});
  for (const TransferredField& field : kept.fields)
  {
    checkTotals(field);
  }
  TAUTLINE_CHECK_NEAR(kept.sourceCovered, 0.89 * 0.96, 1e-12);
  TAUTLINE_CHECK_NEAR(kept.targetCovered, 0.89 * 0.96, 1e-12);
  TAUTLINE_CHECK(kept.nearestCells > 0 && kept.nearestPoints > 0);
  // Both squares have the same area: a constant stays.
  TAUTLINE_CHECK_NEAR(kept.fields[1].totals[0].excess, 0, 1e-12);
  TAUTLINE_CHECK_NEAR(kept.fields[3].totals[0].excess, 0, 1e-12);
  TAUTLINE_LET(TransferOptions, bounded, keepTotal = false);
  const TransferResult free = transferFields(moved, source, fields, bounded);
  for (const TransferredField& field : free.fields)
  {
    TAUTLINE_CHECK_EQUAL(field.totals[0].excess, 0);
  }
  TAUTLINE_CHECK(std::abs(free.fields[0].totals[0].after - free.fields[0].totals[0].before) > 1e-3);
  // Far from the gap, nothing changes.
  for (Index p = 0; p < moved.numberOfPoints(); ++p)
  {
    const Vec3& x = moved.points()[p];
    if (x[0] > 0.4 && x[0] < 0.7 && x[1] > 0.3 && x[1] < 0.7)
    {
      TAUTLINE_CHECK_EQUAL(kept.fields[0].values[p], free.fields[0].values[p]);
    }
  }
  for (Index c = 0; c < moved.numberOfCells(); ++c)
  {
    const Vec3& x = moved.center(c);
    if (x[0] > 0.4 && x[0] < 0.7 && x[1] > 0.3 && x[1] < 0.7)
    {
      TAUTLINE_CHECK_EQUAL(kept.fields[2].values[c], free.fields[2].values[c]);
    }
  }
  // A smaller target takes all of a constant, which leaves its bounds next to the gap only.
  MeshData half = shakenBlock(CellType::Triangle, 10, 2);
  half.transform([](const Vec3& p) { return Vec3{ 0.9 * p[0], p[1], 0 }; });
  const TransferMesh smaller = transferMesh(half);
  const TransferResult all = transferFields(smaller, source, fields, {});
  checkTotals(all.fields[1]);
  TAUTLINE_CHECK(all.fields[1].totals[0].excess > 0.1);
  for (Index p = 0; p < smaller.numberOfPoints(); ++p)
  {
    const bool far = smaller.points()[p][0] < 0.5;
    TAUTLINE_CHECK(!far || std::abs(all.fields[1].values[p] - 3.7) < 1e-13);
  }
}

/// Totals are not kept by a mesh that has a small part of the other, in either order.
TAUTLINE_PART(testParts)
{
  MeshData part = shakenBlock(CellType::Triangle, 5, 2);
  part.transform([](const Vec3& p) { return 0.4 * p; });
  const TransferMesh whole = transferMesh(shakenBlock(CellType::Triangle, 9, 1)),
                     small = transferMesh(part);
  for (const bool fromWhole : { true, false })
  {
    const TransferMesh &source = fromWhole ? whole : small, &target = fromWhole ? small : whole;
    const std::vector<TransferField> fields = { pointField(source, linear),
      cellField(source, smooth) };
    const TransferResult result = transferFields(target, source, fields, {});
    TAUTLINE_CHECK(!result.totalsKept);
    TAUTLINE_CHECK_EQUAL(result.fields[0].totals[0].excess, 0);
    TAUTLINE_CHECK_EQUAL(result.fields[1].totals[0].excess, 0);
    TAUTLINE_CHECK_NEAR((fromWhole ? result.sourceCovered : result.targetCovered), 0.16, 1e-12);
  }
}

/// Surfaces in space, on which areas differ.
TAUTLINE_PART(testSurfaces)
{
  const auto sphere = [](int n, double turn)
  {
    MeshData data = cellSurface(CellType::Triangle, n, [](int, int, int) { return true; });
    const Columns turned = rotation({ 1, 2, 3 }, turn);
    data.transform(
      [&](const Vec3& p)
      {
        const Vec3 d = 2.0 * p - Vec3{ 1, 1, 1 };
        return turned * ((1.0 / norm(d)) * d);
      });
    return data;
  };
  const auto rmsOf = [&](int n, double& excess)
  {
    const TransferMesh source = transferMesh(sphere(n, 0.0)),
                       target = transferMesh(sphere(n + 1, 0.4));
    const std::vector<TransferField> fields = { pointField(source, smooth),
      cellField(source, smooth), pointField(source, constant) };
    const TransferResult result = transferFields(target, source, fields, {});
    TAUTLINE_CHECK(result.surface && result.nearestCells == 0 && result.nearestPoints == 0);
    TAUTLINE_CHECK_RELATIVE(result.targetCovered, result.sourceSize, 1e-12); // scaled
    for (const TransferredField& field : result.fields)
    {
      checkTotals(field);
    }
    excess = result.fields[2].totals[0].excess;
    return std::sqrt(sumOf(0.0, target.numberOfPoints(),
      [&](Index p)
      {
        const double d = result.fields[0].values[p] - smooth(target.points()[p]);
        return d * d / double(target.numberOfPoints());
      }));
  };
  double coarse = 0, fine = 0;
  const double first = rmsOf(8, coarse), second = rmsOf(16, fine);
  TAUTLINE_CHECK(first < 0.05 && second < 0.4 * first);
  TAUTLINE_CHECK(coarse < 0.02 * 3.7 && fine < 0.4 * coarse);
  // The two sides of a thin plate do not mix, whichever way the triangles are listed.
  const auto plate = [](int n, bool reversed)
  {
    MeshData data = cellSurface(CellType::Triangle, n, [](int, int, int) { return true; });
    data.transform([](const Vec3& p) { return Vec3{ p[0], p[1], 0.02 * p[2] }; });
    for (Index c = 0; reversed && c < data.numberOfCells(); ++c)
    {
      std::swap(data.connectivity[data.offsets[c]], data.connectivity[data.offsets[c] + 1]);
    }
    return data;
  };
  for (const bool reversed : { false, true })
  {
    const TransferMesh source = transferMesh(plate(4, false)),
                       target = transferMesh(plate(3, reversed));
    const std::vector<TransferField> fields = { cellField(
      source, [](const Vec3& x) { return x[2] > 0.019 ? 1.0
                                    : x[2] < 0.001    ? -1.0
                                                      : 0.0; }) };
    const TransferResult result = transferFields(target, source, fields, {});
    for (Index c = 0; c < target.numberOfCells(); ++c)
    {
      const double z = target.center(c)[2];
      TAUTLINE_CHECK(z < 0.0199 || std::abs(result.fields[0].values[c] - 1) < 1e-9);
      TAUTLINE_CHECK(z > 0.0001 || std::abs(result.fields[0].values[c] + 1) < 1e-9);
    }
  }
}

/// A plane of any place and a unit of any size give what the plane z = 0 gives.
TAUTLINE_PART(testPlanes)
{
  MeshData before = shakenBlock(CellType::Triangle, 5, 1),
           after = shakenBlock(CellType::Triangle, 6, 2);
  const TransferMesh source = transferMesh(before), target = transferMesh(after);
  const std::vector<TransferField> fields = { pointField(source, smooth),
    cellField(source, smooth) };
  const TransferResult plain = transferFields(target, source, fields, {});
  const Columns turned = rotation({ 1, -2, 1 }, 0.8);
  for (MeshData* data : { &before, &after })
  {
    data->transform([&](const Vec3& p) { return turned * p + Vec3{ 1, 2, 3 }; });
  }
  const TransferResult result =
    transferFields(transferMesh(after), transferMesh(before), fields, {});
  TAUTLINE_CHECK(!result.surface);
  for (std::size_t f = 0; f < fields.size(); ++f)
  {
    for (std::size_t i = 0; i < plain.fields[f].values.size(); ++i)
    {
      TAUTLINE_CHECK_NEAR(result.fields[f].values[i], plain.fields[f].values[i], 1e-11);
    }
  }
}

/// The result does not depend on the threads, bit by bit.
TAUTLINE_PART(testThreads)
{
  const TransferMesh source = transferMesh(shakenBlock(CellType::Tetrahedron, 6, 1)),
                     target = transferMesh(shakenBlock(CellType::Tetrahedron, 7, 2));
  const std::vector<TransferField> fields = { pointField(source, smooth), cellField(source, smooth),
    pointField(source, step) };
  TAUTLINE_LET(TransferOptions, one, cells = CellReconstruction::Linear, threads = 1);
  TransferOptions four = one;
  four.threads = 4;
  const TransferResult a = transferFields(target, source, fields, one),
                       b = transferFields(target, source, fields, four);
  for (std::size_t f = 0; f < fields.size(); ++f)
  {
    TAUTLINE_CHECK(a.fields[f].values == b.fields[f].values);
    TAUTLINE_CHECK_EQUAL(a.fields[f].totals[0].after, b.fields[f].totals[0].after);
  }
}

/// Points have the value at their place, cells the value of the cell at their center.
TAUTLINE_PART(testInterpolation)
{
  const TransferMesh source = transferMesh(shakenBlock(CellType::Tetrahedron, 4, 1));
  const TransferMesh target =
    transferMesh(shifted(shakenBlock(CellType::Tetrahedron, 3, 2), { 0.2, 0, 0 }));
  TAUTLINE_LET(TransferOptions, options, method = TransferMethod::Interpolate);
  const std::vector<TransferField> fields = { pointField(source, linear), cellField(source, step) };
  const TransferResult result = transferFields(target, source, fields, options);
  for (Index p = 0; p < target.numberOfPoints(); ++p)
  {
    Vec3 x = target.points()[p];
    x[0] = std::min(x[0], 1.0); // the nearest place
    TAUTLINE_CHECK_NEAR(result.fields[0].values[p], linear(x), 1e-12);
  }
  for (const double value : result.fields[1].values)
  {
    TAUTLINE_CHECK(value == 0 || value == 1);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> gridWithFields(const MeshData& data)
{
  const auto grid = toGrid(data);
  const Index points = data.numberOfPoints(), cells = data.numberOfCells();
  const auto at = [&data](Index p) { return data.point(p); };
  const auto centerOf = [&data](Index c)
  {
    Vec3 sum = { 0, 0, 0 };
    for (const Index p : data.nodes(c))
    {
      sum += (1.0 / double(data.nodes(c).size())) * data.point(p);
    }
    return sum;
  };
  TAUTLINE_SET(grid->GetPointData(),
    AddArray(filledArray<vtkDoubleArray>("u", points, [&](Index p) { return smooth(at(p)); })),
    AddArray(filledArray<vtkFloatArray>("f", points, [&](Index p) { return step(at(p)); })),
    AddArray(
      filledArray<vtkIntArray>("mark", points, [&](Index p) { return at(p)[0] > 0.5 ? 7 : 3; })));
  TAUTLINE_NEW(
    vtkDoubleArray, vectors, SetName("V"), SetNumberOfComponents(3), SetComponentName(1, "north"));
  for (Index c = 0; c < cells; ++c)
  {
    vectors->InsertNextTuple(centerOf(c).data());
  }
  vtkNew<vtkStringArray> texts;
  texts->SetName("text");
  for (Index c = 0; c < cells; ++c)
  {
    texts->InsertNextValue(centerOf(c)[0] > 0.5 ? "right" : "left");
  }
  TAUTLINE_SET(grid->GetCellData(), AddArray(vectors), AddArray(texts),
    AddArray(filledArray<vtkIntArray>(
      "region", cells, [&](Index c) { return centerOf(c)[0] > 0.5 ? 2 : 1; })));
  grid->GetCellData()->SetActiveVectors("V");
  return grid;
}

TAUTLINE_PART(testFilter)
{
  const auto source = gridWithFields(shakenBlock(CellType::Triangle, 8, 1, 0));
  const MeshData target = shakenBlock(CellType::Quadrilateral, 6, 2);
  const auto grid = toGrid(target);
  grid->GetPointData()->AddArray(
    filledArray<vtkIntArray>("u", target.numberOfPoints(), [](Index) { return 1; }));
  TAUTLINE_NEW(vtkFieldTransfer, filter, SetInputData(0, grid), SetInputData(1, source));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(filter->GetTotalError() < TotalTolerance && filter->GetLargestExcess() == 0);
  TAUTLINE_CHECK_NEAR(filter->GetSourceCovered(), 1, 1e-12);
  TAUTLINE_CHECK_NEAR(filter->GetTargetCovered(), 1, 1e-12);
  vtkTable* totals = filter->GetTotals();
  TAUTLINE_CHECK_EQUAL(totals->GetNumberOfRows(), 5); // u, f and three components of V
  TAUTLINE_CHECK_EQUAL(totals->GetValueByName(0, "Array").ToString(), "u");
  TAUTLINE_CHECK_NEAR(totals->GetValueByName(2, "TotalAfter").ToDouble(), 0.5, 1e-12);
  vtkDataSet* output = outputOf<>(filter);
  TAUTLINE_CHECK(vtkDoubleArray::SafeDownCast(output->GetPointData()->GetArray("u")));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("replaced-in-the-target")));
  auto* vectors = output->GetCellData()->GetVectors();
  TAUTLINE_CHECK(vectors && std::string(vectors->GetComponentName(1)) == "north");
  // Tags come from the largest overlap and the nearest point.
  auto* regions = vtkIntArray::SafeDownCast(output->GetCellData()->GetArray("region"));
  auto* texts = vtkStringArray::SafeDownCast(output->GetCellData()->GetAbstractArray("text"));
  for (Index c = 0; c < target.numberOfCells(); ++c)
  {
    const double x = sumOf(0.0, target.nodes(c), [&](Index p) { return target.point(p)[0] / 4.0; });
    if (std::abs(x - 0.5) > 0.15)
    {
      TAUTLINE_CHECK_EQUAL(regions->GetValue(c), x > 0.5 ? 2 : 1);
      TAUTLINE_CHECK_EQUAL(std::string(texts->GetValue(c)), x > 0.5 ? "right" : "left");
    }
  }
  for (Index p = 0; p < target.numberOfPoints(); ++p)
  {
    const double mark = component(output->GetPointData(), "mark", p);
    TAUTLINE_CHECK(mark == 3 || mark == 7);
  }
  // A choice of arrays; what the target has stays.
  TAUTLINE_SET(filter, AddPointArray("f"), AddPointArray("u"), SetReplaceArrays(false), Update());
  output = outputOf<>(filter);
  TAUTLINE_CHECK(!output->GetCellData()->GetArray("V") && output->GetPointData()->GetArray("f"));
  TAUTLINE_CHECK(vtkIntArray::SafeDownCast(output->GetPointData()->GetArray("u")));
  TAUTLINE_CHECK_EQUAL(filter->GetTotals()->GetNumberOfRows(), 1);
}

/// Blocks are one mesh; ghosts do not count; images and poly data; large and small units.
TAUTLINE_PART(testFilterData)
{
  const MeshData data = shakenBlock(CellType::Triangle, 6, 1);
  const auto source = gridWithFields(data);
  const auto run = [](vtkDataObject* target, vtkDataObject* from)
  {
    return TAUTLINE_CHANGED(vtkSmartPointer<vtkFieldTransfer>::New(), SetInputDataObject(0, target),
      SetInputDataObject(1, from), Update());
  };
  const auto totalOf = [](vtkFieldTransfer* filter, Index row = 0)
  { return filter->GetTotals()->GetValueByName(row, "TotalAfter").ToDouble(); };
  const double expected = totalOf(run(toGrid(shakenBlock(CellType::Triangle, 5, 2)), source));
  // Two halves of the target as blocks, and two of the source.
  const auto half = [](Index n, double from)
  {
    MeshData part = shakenBlock(CellType::Triangle, n, 4, 0);
    part.transform([from](const Vec3& p) { return Vec3{ 0.5 * p[0] + from, p[1], 0 }; });
    return part;
  };
  TAUTLINE_NEW(vtkMultiBlockDataSet, targets, SetBlock(0, toGrid(half(4, 0))),
    SetBlock(2, toGrid(half(5, 0.5))));
  const auto blocks = run(targets, source);
  TAUTLINE_CHECK_NEAR(totalOf(blocks), expected, 1e-12);
  auto* output = outputOf<vtkMultiBlockDataSet>(blocks);
  auto* second = vtkDataSet::SafeDownCast(output->GetBlock(2));
  TAUTLINE_CHECK(second && second->GetPointData()->GetArray("u"));
  TAUTLINE_NEW(vtkMultiBlockDataSet, sources, SetBlock(0, gridWithFields(half(3, 0))),
    SetBlock(1, gridWithFields(half(4, 0.5))));
  const auto joined = run(toGrid(data), sources);
  TAUTLINE_CHECK(joined->GetTotalError() < TotalTolerance && joined->GetSourceCovered() > 1 - 1e-9);
  // Ghost cells of the source twice over.
  const auto ghosts = gridWithFields(data);
  MeshData twice = data;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    twice.addCell(CellType::Triangle, data.nodes(c));
  }
  const auto doubled = gridWithFields(twice);
  auto marks = filledArray<vtkUnsignedCharArray>("vtkGhostType", twice.numberOfCells(),
    [&](Index c) { return c < data.numberOfCells() ? 0 : 1; });
  doubled->GetCellData()->AddArray(marks);
  TAUTLINE_CHECK_NEAR(totalOf(run(toGrid(data), doubled)), expected, 1e-12);
  // Images and polygons.
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(5, 4, 1), SetSpacing(0.25, 1.0 / 3, 1));
  TAUTLINE_CHECK_NEAR(totalOf(run(image, source)), expected, 1e-12);
  MeshData pentagon;
  for (const Vec3& p :
    { Vec3{ 0, 0, 0 }, Vec3{ 1, 0, 0 }, Vec3{ 0.4, 0.4, 0 }, Vec3{ 1, 1, 0 }, Vec3{ 0, 1, 0 } })
  {
    pentagon.addPoint(p);
  }
  pentagon.addCell(7, { 0, 1, 2, 3, 4 });
  TAUTLINE_NEW(vtkFieldTransfer, polygon, SetInputData(0, toPolyData(pentagon)),
    SetInputData(1, source), SetKeepTotal(false), Update());
  TAUTLINE_CHECK_NEAR(polygon->GetSourceCovered(), 0.7, 1e-12);
  TAUTLINE_CHECK_NEAR(polygon->GetTargetCovered(), 1.0, 1e-12);
  // Units of length and of the field.
  const double unit = std::ldexp(1.0, -90);
  const auto scaled = [unit](MeshData mesh)
  {
    mesh.transform([unit](const Vec3& p) { return unit * p; });
    return toGrid(mesh);
  };
  const auto tiny = scaled(data);
  tiny->GetPointData()->AddArray(filledArray<vtkDoubleArray>(
    "u", data.numberOfPoints(), [&](Index p) { return 1e200 * smooth(data.point(p)); }));
  const auto small = run(scaled(shakenBlock(CellType::Triangle, 5, 2)), tiny);
  TAUTLINE_CHECK_RELATIVE(totalOf(small), 1e200 * unit * unit * expected, 1e-11);
  TAUTLINE_CHECK(small->GetTotalError() < TotalTolerance);
}

TAUTLINE_PART(testFilterErrors)
{
  const auto source = gridWithFields(shakenBlock(CellType::Triangle, 4, 1));
  const auto target = toGrid(shakenBlock(CellType::Triangle, 3, 2));
  const auto fails =
    [&](const char* text, vtkDataObject* onto, vtkDataObject* from, const auto& change)
  {
    TAUTLINE_NEW(
      vtkFieldTransfer, filter, SetInputDataObject(0, onto), SetInputDataObject(1, from));
    change(filter.Get());
    TAUTLINE_CHECK(contains(errorOf(filter), text));
    TAUTLINE_CHECK(outputOf<>(filter)->GetNumberOfPoints() == 0);
    TAUTLINE_CHECK(std::string(filter->GetSummary()).empty());
    TAUTLINE_CHECK_EQUAL(filter->GetTotals()->GetNumberOfRows(), 0);
  };
  const auto nothing = [](vtkFieldTransfer*) {};
  const auto solid = toGrid(shakenBlock(CellType::Tetrahedron, 2, 1));
  fails(wording("the-source-is-a-volume"), target, solid, nothing);
  fails(wording("the-target-is-a-volume"), solid, source, nothing);
  const auto far = toGrid(shifted(shakenBlock(CellType::Triangle, 3, 2), { 5, 0, 0 }));
  fails(wording("the-meshes-do-not-overlap"), far, source, nothing);
  fails("(5, 0, 0) to (6, 1, 0)", far, source, nothing);
  fails(wording("the-meshes-do-not-overlap"), far, source,
    [](vtkFieldTransfer* f) { f->SetMethod(vtkFieldTransfer::INTERPOLATE); });
  fails(wording("the-source-has-no-point-array"), target, source,
    [](vtkFieldTransfer* f) { f->AddPointArray("nothing"); });
  fails(wording("the-source-has-no-element"), target, toGrid(MeshData()), nothing);
  MeshData line;
  line.addPoint({ 0, 0, 0 });
  line.addPoint({ 1, 0, 0 });
  line.addCell(3, { 0, 1 });
  fails(wording("the-target-has-no-element"), toGrid(line), source, nothing);
  // Values that are not finite: an array that is chosen is an error, otherwise it is left out.
  source->GetPointData()->GetArray("u")->SetComponent(3, 0, NAN);
  fails(wording("1-values-of-the-point-array-u"), target, source,
    [](vtkFieldTransfer* f) { f->AddPointArray("u"); });
  TAUTLINE_NEW(vtkFieldTransfer, filter, SetInputData(0, target), SetInputData(1, source));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("1-values-of-the-point-array-u")));
  TAUTLINE_CHECK(messages.errors().empty());
  TAUTLINE_CHECK(!outputOf<>(filter)->GetPointData()->GetArray("u"));
  TAUTLINE_CHECK(outputOf<>(filter)->GetPointData()->GetArray("f"));
}
}
