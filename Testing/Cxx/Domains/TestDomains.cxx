// SPDX-License-Identifier: BSD-3-Clause
// Every domain: number of cells, valid cells, exact size, markers, motion; structured ones exactly.

#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Domains/Domains.h"
#include "tautline/Mesh/Mesh.h"
#include "vtkDomainSource.h"
#include "vtkTestErrorObserver.h"

#include <cstring>
#include <fstream>
#include <sstream>

using namespace tautline;

namespace
{
/// Sum of the sizes; each must be positive.
double totalSize(vtkUnstructuredGrid* mesh)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    Vec3 p[4];
    vtkIdType size;
    const vtkIdType* ids;
    mesh->GetCellPoints(i, size, ids);
    for (vtkIdType c = 0; c < size; ++c)
    {
      mesh->GetPoint(ids[c], p[c].data());
    }
    const Vec3 a = p[1] - p[0], b = p[2] - p[0];
    const Vec3 normal = cross(a, b);
    const double cell = size == 3 ? 0.5 * normal[2] : dot(normal, p[3] - p[0]) / 6.0;
    TAUTLINE_CHECK(cell > 0.0);
    sum += cell;
  }
  return sum;
}

/// Sizes that follow from the shapes; curved ones are approached from inside.
const std::map<std::string, double> ExactSize = { { "barrier2d", 7.72 }, { "barrier3d", 7.72 },
  { "rectangle", 2.0 }, { "bar", 0.984 }, { "gate", 1.964 }, { "bending-bar", 0.972 },
  { "box-in-box", 0.973 } };

void checkDomain(int index)
{
  const DomainInfo& info = domains()[static_cast<std::size_t>(index)];
  TAUTLINE_NEW(vtkDomainSource, source, SetDomain(index), Update());
  vtkUnstructuredGrid* mesh = source->GetOutput();
  const auto cells = static_cast<double>(mesh->GetNumberOfCells());
  const bool exact = !std::strcmp(info.name, "square") || !std::strcmp(info.name, "rectangle");
  std::cout << info.name << ": " << mesh->GetNumberOfPoints() << " points, " << cells << " cells\n";
  TAUTLINE_CHECK(exact || std::abs(cells / static_cast<double>(info.cells) - 1.0) < 0.05);

  const double size = totalSize(mesh);
  const auto known = ExactSize.find(info.name);
  TAUTLINE_CHECK(known == ExactSize.end() || std::abs(size / known->second - 1.0) < 1e-9);

  // the marked points are exactly the boundary points of the mesh
  std::vector<double> points(static_cast<std::size_t>(3 * mesh->GetNumberOfPoints()));
  std::vector<Index> offsets = { 0 }, nodes;
  std::vector<unsigned char> types;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    mesh->GetPoint(i, points.data() + 3 * i);
  }
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    vtkIdType count;
    const vtkIdType* ids;
    mesh->GetCellPoints(i, count, ids);
    nodes.insert(nodes.end(), ids, ids + count);
    offsets.push_back(static_cast<Index>(nodes.size()));
    types.push_back(static_cast<unsigned char>(mesh->GetCellType(i)));
  }
  const Mesh view({ mesh->GetNumberOfPoints(), points.data(), mesh->GetNumberOfCells(),
    types.data(), offsets.data(), nodes.data() });
  const Boundary boundary = view.boundary();
  TAUTLINE_CHECK(boundary.nonManifold == 0);
  vtkDataArray* markers = mesh->GetPointData()->GetArray("BoundaryMarker");
  vtkDataArray* fixed = mesh->GetPointData()->GetArray("Fixed");
  vtkDataArray* displacement = mesh->GetPointData()->GetArray("Displacement");
  TAUTLINE_CHECK(markers && fixed && (displacement != nullptr) == info.moving);
  double farthest = 0.0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const bool onBoundary = boundary.isBoundaryPoint[static_cast<std::size_t>(i)] != 0;
    TAUTLINE_CHECK(
      (markers->GetTuple1(i) != 0) == onBoundary && (fixed->GetTuple1(i) != 0) == onBoundary);
    for (int c = 0; displacement && c < 3; ++c)
    {
      farthest = std::max(farthest, std::abs(displacement->GetComponent(i, c)));
      TAUTLINE_CHECK(onBoundary || displacement->GetComponent(i, c) == 0.0);
    }
  }
  TAUTLINE_CHECK(!info.moving || (farthest > 0.1 && farthest < 1.0));

  auto* deformed = vtkPolyData::SafeDownCast(source->GetOutputDataObject(1));
  const bool structured = info.kind == DomainKind::Structured;
  TAUTLINE_CHECK(structured || deformed->GetNumberOfCells() == boundary.facets);
}

void checkMotion()
{
  // the center of the moved cylinder and bar; the ends of the bent bar; the bore's mouths stay
  const Vec3 d = domainDisplacement("cylinder-diagonal", { 0.8, 0.65, 0 }, 2, 0.5);
  TAUTLINE_CHECK(d == (Vec3{ 0.3, 0.05, 0 }));
  TAUTLINE_CHECK(domainDisplacement("cylinder", { 0, 0, 0 }, 1, 1.0)[0] == 0.0);
  const Vec3 clamped = domainDisplacement("bending-bar", { 0.15, 0.5, 0 }, 2, 1.0);
  TAUTLINE_CHECK(std::abs(clamped[0]) < 1e-15 && std::abs(clamped[1]) < 1e-15);
  const Vec3 tip = domainDisplacement("bending-bar", { 0.85, 0.5, 0 }, 2, 1.0);
  const double phi = std::acos(-1.0) / 3.0, radius = 0.7 / phi;
  TAUTLINE_CHECK(std::abs(tip[0] + 0.7 - radius * std::sin(phi)) < 1e-14);
  TAUTLINE_CHECK(std::abs(tip[1] - radius * (1.0 - std::cos(phi))) < 1e-14);
  // a turn along a circle, not a chord
  for (const double amount : { 1.0 / 6.0, 0.5, 1.0 })
  {
    const Vec3 corner = { 0.65, 0.5, 0.35 };
    const Vec3 turn = domainDisplacement("box-in-box", corner, 2, amount);
    const double angle = std::acos(-1.0) * amount;
    TAUTLINE_CHECK(std::abs(turn[0] + 0.15 - 0.15 * std::cos(angle)) < 1e-15);
    TAUTLINE_CHECK(std::abs(turn[1] - 0.15 * std::sin(angle)) < 1e-15 && turn[2] == 0.0);
  }
  TAUTLINE_CHECK(domainDisplacement("gate", { 0.94, 1.0, 0 }, 2, 1.0)[1] == 0.0);
  TAUTLINE_CHECK(std::abs(domainDisplacement("gate", { 1, 0.6, 0 }, 2, 1.0)[1] + 0.4) < 1e-15);
}

/// h = 0.1, interaction layer 0.2: 14 x 14 squares; aspect ratio 4: 5 x 20 rectangles with 1 and 4
/// layers around.
void checkSquare()
{
  const StructuredMesh isotropic = structuredSquare(0.1, 1.0, 0.2);
  TAUTLINE_CHECK(
    isotropic.cellReferences.size() == 2 * 14 * 14 && isotropic.points.size() == 3 * 15 * 15);
  const StructuredMesh stretched = structuredSquare(0.1, 4.0, 0.2);
  TAUTLINE_CHECK(stretched.cellReferences.size() == 2 * 7 * 28);
  for (const StructuredMesh* mesh : { &isotropic, &stretched })
  {
    const auto inside = std::count(mesh->cellReferences.begin(), mesh->cellReferences.end(), 1);
    TAUTLINE_CHECK(inside == 200); // the same for every aspect ratio
    const double ratio = mesh == &isotropic ? 1.0 : 4.0;
    for (std::size_t t = 0; t < mesh->triangles.size(); t += 3)
    {
      double lengths[3];
      for (std::size_t e = 0; e < 3; ++e)
      {
        const double* p = mesh->points.data() + 3 * mesh->triangles[t + e];
        const double* q = mesh->points.data() + 3 * mesh->triangles[t + (e + 1) % 3];
        lengths[e] = std::hypot(p[0] - q[0], p[1] - q[1]);
      }
      std::sort(lengths, lengths + 3);
      TAUTLINE_CHECK(std::abs(lengths[1] / lengths[0] - ratio) < 1e-12);
      TAUTLINE_CHECK(std::abs(lengths[0] * lengths[1] - 0.01) < 1e-14);
    }
  }
  bool thrown = false;
  try
  {
    structuredSquare(0.1, 3.0, 0.2);
  }
  catch (const Error& error)
  {
    thrown = contains(error.what(), wording("whole-numbers"));
  }
  TAUTLINE_CHECK(thrown);
  const StructuredMesh rectangle = structuredRectangle(800);
  TAUTLINE_CHECK(rectangle.cellReferences.size() == 784 || rectangle.cellReferences.size() == 900);
}

void checkNames()
{
  vtkNew<vtkDomainSource> source;
  vtkNew<vtkTest::ErrorObserver> errors;
  TAUTLINE_SET(source, AddObserver(vtkCommand::ErrorEvent, errors), SetDomainByName("gate"));
  TAUTLINE_CHECK(!std::strcmp(vtkDomainSource::GetDomainName(source->GetDomain()), "gate"));
  source->SetDomainByName("nonsense");
  TAUTLINE_CHECK(
    contains(errors->GetErrorMessage(), wording("there-is-no-domain-nonsense-there-are")));
  TAUTLINE_CHECK(vtkDomainSource::GetDomainName(-1) == nullptr);
}

/// The menu of ParaView lists the registry.
void checkXml(const std::string& data)
{
  std::ifstream file(data + "/../ServerManager/Domains.xml.in");
  std::ostringstream text;
  text << file.rdbuf();
  int value = 0;
  for (const DomainInfo& info : domains())
  {
    const std::string entry =
      std::string("<Entry text=\"") + info.label + "\" value=\"" + std::to_string(value++) + "\"/>";
    TAUTLINE_CHECK(contains(text.str(), entry));
    TAUTLINE_CHECK(contains(text.str(), std::string("**") + info.label + "**: " + info.source));
  }
  TAUTLINE_CHECK(!contains(text.str(), "value=\"" + std::to_string(value) + "\"/>"));
}

/// Table 2.4: vertices of wrench and hinge for the numbers of elements given there.
void checkTable()
{
  const struct
  {
    const char* name;
    vtkIdType cells;
    double vertices;
  } rows[] = { { "wrench", 19796, 10142 }, { "wrench", 99197, 50161 }, { "wrench", 199055, 100267 },
    { "hinge", 18359, 9989 }, { "hinge", 96483, 49986 }, { "hinge", 195131, 99949 } };
  for (const auto& row : rows)
  {
    TAUTLINE_NEW(
      vtkDomainSource, source, SetDomainByName(row.name), SetNumberOfCells(row.cells), Update());
    const auto vertices = static_cast<double>(source->GetOutput()->GetNumberOfPoints());
    std::cout << row.name << " " << source->GetOutput()->GetNumberOfCells() << " of " << row.cells
              << " cells, " << vertices << " of " << row.vertices << " vertices\n";
    TAUTLINE_CHECK(std::abs(vertices / row.vertices - 1.0) < 0.05);
  }
}

/// The same properties give the same mesh, bit by bit.
void checkDeterminism(const char* name)
{
  std::vector<double> points[2];
  for (std::vector<double>& copy : points)
  {
    TAUTLINE_NEW(vtkDomainSource, source, SetDomainByName(name), SetNumberOfCells(5000), Update());
    for (vtkIdType i = 0; i < source->GetOutput()->GetNumberOfPoints(); ++i)
    {
      const double* x = source->GetOutput()->GetPoint(i);
      copy.insert(copy.end(), x, x + 3);
    }
  }
  TAUTLINE_CHECK(!points[0].empty() && points[0] == points[1]);
}

/// Without the meshers the others are errors that state the reason.
void checkMissingMeshers()
{
  vtkNew<vtkDomainSource> source;
  vtkNew<vtkTest::ErrorObserver> errors;
  TAUTLINE_SET(source, AddObserver(vtkCommand::ErrorEvent, errors),
    GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors), SetDomainByName("disk2d"),
    Update());
  TAUTLINE_CHECK(source->GetOutput()->GetNumberOfCells() == 0);
  TAUTLINE_CHECK(contains(errors->GetErrorMessage(), wording("without-the-module-meshing")));
}

/// Sizes that no memory holds are rejected before anything is allocated.
void checkSizes()
{
  constexpr Index Cells = Index{ 1 } << 50;
  for (const auto& make :
    std::vector<std::function<void()>>{
      [] { structuredRectangle(Cells); },
      [] { structuredSquare(1e-4, 1.0, 10.0); },
      [] { checkDomainSize(1e15, DomainKind::Planar); },
      [] { checkDomainSize(std::nan(""), DomainKind::Solid); },
    })
  {
    std::string message;
    try
    {
      make();
    }
    catch (const Error& error)
    {
      message = error.what();
    }
    TAUTLINE_CHECK(contains(message, wording("of-memory")));
  }
  checkDomainSize(1e5, DomainKind::Solid);
}

/// Numbers of extreme size are rejected by name, by the source and by the kernel; nothing changes.
void checkExtremes()
{
  TAUTLINE_NEW(vtkDomainSource, source, SetDomainByName("square"));
  vtkNew<vtkTest::ErrorObserver> errors;
  source->AddObserver(vtkCommand::ErrorEvent, errors);
  const auto rejects = [&](const char* name, const std::function<void()>& set)
  {
    errors->Clear();
    set();
    TAUTLINE_CHECK(contains(errors->GetErrorMessage(), name));
    TAUTLINE_CHECK(contains(errors->GetErrorMessage(), wording("is-kept")));
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double extreme : { 1e-150, 1e150, 0.0, -1.0, std::nan(""), infinity })
  {
    const Context context(std::to_string(extreme));
    rejects(wording("elementsize-is"), [&] { source->SetElementSize(extreme); });
    rejects(wording("aspectratio-is"), [&] { source->SetAspectRatio(extreme); });
    const bool tiny = extreme >= 0.0 && extreme < 1.0;
    if (!tiny)
    {
      rejects(wording("layerwidth-is"), [&] { source->SetLayerWidth(extreme); });
    }
    if (!tiny && extreme != -1.0)
    {
      rejects(wording("amount-is"), [&] { source->SetAmount(extreme); });
    }
    TAUTLINE_CHECK_THROWS(structuredSquare(extreme, 1.0, 0.2), wording("whole-elements"));
    TAUTLINE_CHECK_THROWS(structuredSquare(0.1, extreme, 0.2),
      extreme >= 1.0 ? "whole elements" : "the aspect ratio must be");
    TAUTLINE_CHECK_THROWS(
      planarBoundary("disk2d", extreme), wording("the-spacing-of-a-boundary-is"));
    TAUTLINE_CHECK_THROWS(
      solidBoundary("sphere", extreme), wording("the-spacing-of-a-boundary-is"));
  }
  rejects(wording("layerwidth-is"), [&] { source->SetLayerWidth(-1e-150); });
  // Within the limits: no layer, and one that is narrower than any element.
  source->Update();
  TAUTLINE_CHECK_EQUAL(source->GetOutput()->GetNumberOfCells(), vtkIdType(2 * 14 * 14));
  for (const double width : { 0.0, 1e-150 })
  {
    TAUTLINE_SET(source, SetLayerWidth(width), Update());
    TAUTLINE_CHECK_EQUAL(source->GetOutput()->GetNumberOfCells(), vtkIdType(200));
    TAUTLINE_CHECK(std::abs(totalSize(source->GetOutput()) - 1.0) < 1e-12);
  }
}
}

TAUTLINE_TEST(TestDomains)
{
  TAUTLINE_RUN(checkSizes());
  TAUTLINE_RUN(checkExtremes());
  TAUTLINE_RUN(checkMotion());
  TAUTLINE_RUN(checkSquare());
  TAUTLINE_RUN(checkNames());
  TAUTLINE_RUN(checkXml(argv[1]));
  for (int i = 0; i < vtkDomainSource::GetNumberOfDomains(); ++i)
  {
    const bool structured = domains()[static_cast<std::size_t>(i)].kind == DomainKind::Structured;
    if (structured || vtkDomainSource::HasMeshing())
    {
      TAUTLINE_RUN(checkDomain(i));
    }
  }
  if (!vtkDomainSource::HasMeshing())
  {
    TAUTLINE_RUN(checkMissingMeshers());
    return;
  }
  TAUTLINE_RUN_SLOW(checkTable());
  TAUTLINE_RUN(checkDeterminism("hinge"));
  TAUTLINE_RUN(checkDeterminism("bore"));
}
