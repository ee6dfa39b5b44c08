// SPDX-License-Identifier: BSD-3-Clause
// The filters of the module Shapes: the documented arrays and tables, images of all kinds, errors.

#include "Registry.h"
#include "Shapes.h"
#include "VtkMeshes.h"
#include "vtkCommand.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPNGWriter.h"
#include "vtkShapeMatcher.h"
#include "vtkShapeRetrieval.h"
#include "vtkSilhouetteMesher.h"
#include "vtkSilhouetteSetReader.h"

#include <filesystem>
#include <fstream>

using namespace tautline;

namespace
{
vtkSmartPointer<vtkImageData> makeImage(
  const Picture& picture, int components = 1, double spacing = 1.0)
{
  auto image = TAUTLINE_CHANGED(vtkSmartPointer<vtkImageData>::New(),
    SetDimensions(static_cast<int>(picture.width), static_cast<int>(picture.height), 1),
    SetSpacing(spacing, spacing, 1.0), SetOrigin(10.0, 20.0, 3.0));
  TAUTLINE_NEW(vtkUnsignedCharArray, values, SetName("Pixels"), SetNumberOfComponents(components),
    SetNumberOfTuples(image->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      // With an alpha channel the colors are constant: only the alpha shows the shape.
      const bool alpha = c == components - 1 && components % 2 == 0;
      values->SetComponent(
        i, c, components % 2 == 0 && !alpha ? 77.0 : picture.values[static_cast<std::size_t>(i)]);
    }
  }
  image->GetPointData()->SetScalars(values);
  return image;
}

TAUTLINE_PART(testMesher)
{
  const Picture picture = blob(100, 50, 50, 25);
  TAUTLINE_NEW(vtkSilhouetteMesher, mesher, SetInputData(makeImage(picture, 1, 0.5)),
    SetSpacing(15), Update());
  auto* mesh = outputOf<vtkUnstructuredGrid>(mesher);
  const vtkIdType n = mesh->GetNumberOfPoints();
  TAUTLINE_CHECK(n > 6 && mesh->GetNumberOfCells() == n - 2);
  for (const char* name : { "BoundaryOrder", "EliminationOrder" })
  {
    vtkDataArray* array = mesh->GetPointData()->GetArray(name);
    TAUTLINE_CHECK(
      array && array->GetRange()[0] == 0 && array->GetRange()[1] == static_cast<double>(n - 1));
  }
  TAUTLINE_CHECK_EQUAL(
    mesh->GetCellData()->GetArray("EliminationStep")->GetRange()[1], static_cast<double>(n - 3));
  // In space: origin and spacing of the image.
  const Silhouette shape = traceSilhouette(picture.view());
  TAUTLINE_CHECK_NEAR(mesh->GetFieldData()->GetArray("CentreOfMass")->GetComponent(0, 0),
    10.0 + 0.5 * shape.centre[0], 1e-9);
  TAUTLINE_CHECK_NEAR(
    mesh->GetFieldData()->GetArray("MaximumDistance")->GetTuple1(0), 0.5 * shape.maxDistance, 1e-9);
  TAUTLINE_CHECK_NEAR(
    mesh->GetFieldData()->GetArray("Area")->GetTuple1(0), 0.25 * shape.area, 1e-9);
  TAUTLINE_CHECK_NEAR(mesh->GetPoint(0)[2], 3.0, 1e-12);
  auto* outline = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  TAUTLINE_CHECK_EQUAL(outline->GetNumberOfPoints(), static_cast<vtkIdType>(shape.outline.size()));
  TAUTLINE_CHECK(contains(mesher->GetSummary(), "triangles"));
  // Gray, gray with alpha, color, color with alpha: the same mesh.
  for (int components : { 2, 3, 4 })
  {
    TAUTLINE_NEW(vtkSilhouetteMesher, other, SetInputData(makeImage(picture, components, 0.5)),
      SetSpacing(15), Update());
    auto* same = outputOf<vtkUnstructuredGrid>(other);
    TAUTLINE_CHECK_EQUAL(same->GetNumberOfPoints(), n);
    TAUTLINE_EACH(vtkIdType, i, std::min(n, same->GetNumberOfPoints()),
      TAUTLINE_CHECK_NEAR(same->GetPoint(i)[0], mesh->GetPoint(i)[0], 1e-9));
  }
}

/// Values of cells are pixels, half a pixel off: as the GDAL reader of ParaView gives PNG files.
TAUTLINE_PART(testCellPixels)
{
  const Picture picture = blob(80, 40, 40, 20);
  auto points = makeImage(picture);
  TAUTLINE_NEW(vtkImageData, cells, SetDimensions(81, 81, 1), SetOrigin(9.5, 19.5, 3.0),
    GetCellData()->SetScalars(points->GetPointData()->GetScalars()));
  vtkNew<vtkSilhouetteMesher> first, second;
  first->SetInputData(points);
  second->SetInputData(cells);
  first->Update();
  second->Update();
  auto* a = outputOf<vtkUnstructuredGrid>(first);
  auto* b = outputOf<vtkUnstructuredGrid>(second);
  TAUTLINE_CHECK(a->GetNumberOfPoints() > 3 && a->GetNumberOfPoints() == b->GetNumberOfPoints());
  TAUTLINE_EACH(vtkIdType, i, std::min(a->GetNumberOfPoints(), b->GetNumberOfPoints()),
    TAUTLINE_CHECK_NEAR(a->GetPoint(i)[1], b->GetPoint(i)[1], 1e-9));
}

/// A picture without a shape is left out with a warning that names it; at least two are needed.
TAUTLINE_PART(testLeftOut)
{
  const Picture empty = paint(60, 60, [](double, double) { return -1.0; });
  const std::vector<Picture> pictures = { blob(100, 50, 50, 25), empty, disc(60, 30, 30, 12),
    blob(100, 50, 50, 20, 0.5) };
  for (const int setting : { vtkShapeRetrieval::HIGHEST, vtkShapeRetrieval::FELZENSZWALB })
  {
    vtkNew<vtkMultiBlockDataSet> set;
    for (unsigned int i = 0; i < pictures.size(); ++i)
    {
      set->SetBlock(i, makeImage(pictures[i]));
      set->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), "picture " + std::to_string(i));
    }
    TAUTLINE_NEW(vtkShapeRetrieval, retrieval, SetInputDataObject(0, set), SetSetting(setting));
    Messages messages(retrieval);
    retrieval->Update();
    TAUTLINE_CHECK(!messages.has("ERROR: "));
    TAUTLINE_CHECK(messages.has(wording("shape-was-left-out")) && messages.has("picture 1: "));
    TAUTLINE_CHECK(contains(retrieval->GetSummary(), "picture 1: "));
    auto* distances = vtkTable::SafeDownCast(retrieval->GetOutputDataObject(0));
    TAUTLINE_CHECK_EQUAL(distances->GetNumberOfRows(), 3);
    TAUTLINE_CHECK_EQUAL(distances->GetColumnByName("picture 1"), nullptr);
    set->SetBlock(0, nullptr);
    set->SetBlock(3, nullptr);
    TAUTLINE_SET(retrieval, Modified(), Update());
    TAUTLINE_CHECK(messages.has("ERROR: ") && messages.has("picture 1: "));
  }
}

TAUTLINE_PART(testMesherErrors)
{
  const auto with = [](vtkImageData* image, const char* part)
  {
    TAUTLINE_NEW(vtkSilhouetteMesher, mesher, SetInputData(image));
    TAUTLINE_CHECK(contains(errorOf(mesher), part));
    TAUTLINE_CHECK_EQUAL(outputOf<vtkUnstructuredGrid>(mesher)->GetNumberOfPoints(), 0);
  };
  with(makeImage(paint(9, 9, [](double, double) { return 1.0; })), "one value");
  auto oblong = makeImage(disc(30, 15, 15, 9));
  oblong->SetSpacing(1, 2, 1);
  with(oblong, "not square");
  TAUTLINE_NEW(vtkImageData, volume, SetDimensions(4, 4, 4), AllocateScalars(VTK_FLOAT, 1));
  with(volume, "slice");
  TAUTLINE_NEW(vtkImageData, bare, SetDimensions(4, 4, 1));
  with(bare, "no array");
  vtkNew<vtkSilhouetteMesher> empty;
  vtkNew<vtkImageData> none;
  empty->SetInputData(none);
  TAUTLINE_CHECK(errorOf(empty).empty());
}

TAUTLINE_PART(testMatcher)
{
  auto source = makeImage(blob(100, 50, 50, 25)), target = makeImage(blob(120, 60, 58, 30, 0.3));
  TAUTLINE_NEW(vtkSilhouetteMesher, mesher, SetInputData(source));
  vtkNew<vtkShapeMatcher> fromImage, fromMesh;
  fromImage->SetInputDataObject(0, source);
  fromMesh->SetInputConnection(0, mesher->GetOutputPort());
  for (vtkShapeMatcher* matcher : { fromImage.Get(), fromMesh.Get() })
  {
    TAUTLINE_SET(matcher, SetTargetData(target), SetGridSize(16, 16), Update());
  }
  TAUTLINE_CHECK(fromImage->GetExact());
  TAUTLINE_CHECK_RELATIVE(fromMesh->GetEnergy(), fromImage->GetEnergy(), 1e-5);
  auto* mesh = outputOf<vtkUnstructuredGrid>(fromMesh);
  auto* table = vtkTable::SafeDownCast(fromMesh->GetOutputDataObject(1));
  auto* before = outputOf<vtkUnstructuredGrid>(mesher);
  TAUTLINE_CHECK_EQUAL(mesh->GetNumberOfCells(), before->GetNumberOfCells());
  vtkDataArray* displacement = mesh->GetPointData()->GetArray("Displacement");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    // The vertices keep their order along the boundary: found again by their old place.
    double x[3];
    mesh->GetPoint(i, x);
    double old[3] = { x[0] - displacement->GetComponent(i, 0),
      x[1] - displacement->GetComponent(i, 1), x[2] - displacement->GetComponent(i, 2) };
    const vtkIdType id = before->FindPoint(old);
    TAUTLINE_CHECK(id >= 0 && std::abs(before->GetPoint(id)[0] - old[0]) < 1e-9);
  }
  double sum = sumOf<double>(0.0, mesh->GetNumberOfCells(),
    [&](vtkIdType t) { return mesh->GetCellData()->GetArray("Energy")->GetTuple1(t); });
  TAUTLINE_CHECK_RELATIVE(sum, fromMesh->GetEnergy(), 1e-9);
  const auto value = [&](const char* name) { return table->GetValueByName(0, name).ToDouble(); };
  TAUTLINE_CHECK_RELATIVE(
    value("EdgeCost") + 12 * value("Deformation") + 3 * value("Distortion"), value("Energy"), 1e-9);
  TAUTLINE_CHECK_EQUAL(value("Rank"), 1.0);
  TAUTLINE_CHECK_EQUAL(value("Stop"), 0.0);

  // A smaller target after a larger one, in one filter: each image is requested as a whole.
  fromImage->SetTargetData(makeImage(blob(80, 40, 40, 20)));
  TAUTLINE_CHECK(errorOf(fromImage).empty());
  fromImage->SetInputDataObject(0, makeImage(blob(60, 30, 30, 15)));
  TAUTLINE_CHECK(errorOf(fromImage).empty());
  TAUTLINE_CHECK(fromImage->GetExact());

  // A time limit keeps the best so far. Where the set-up alone takes longer, it is an error.
  double limit = 1e-9;
  fromMesh->SetTimeLimit(limit);
  while (!errorOf(fromMesh).empty() && limit < 1)
  {
    limit *= 10;
    fromMesh->SetTimeLimit(limit);
  }
  TAUTLINE_CHECK(!fromMesh->GetExact() && mesh->GetNumberOfCells() == before->GetNumberOfCells());
  TAUTLINE_CHECK(contains(fromMesh->GetSummary(), wording("best-so-far")));
  // Wrong input is named.
  TAUTLINE_NEW(vtkShapeMatcher, wrong, SetInputDataObject(0, source), SetTargetData(target),
    SetGridSize(1, 1));
  TAUTLINE_CHECK(contains(errorOf(wrong), wording("too-small")));
  TAUTLINE_NEW(vtkShapeMatcher, weights, SetInputDataObject(0, source), SetTargetData(target),
    SetDistortionWeight(std::nan("")));
  TAUTLINE_CHECK(contains(errorOf(weights), wording("distortion-weight")));
  TAUTLINE_NEW(vtkUnstructuredGrid, loose, DeepCopy(before), GetPoints()->InsertNextPoint(0, 0, 3));
  loose->GetPointData()->Initialize(); // its arrays have no value for that point
  TAUTLINE_NEW(vtkShapeMatcher, stray, SetInputDataObject(0, loose), SetTargetData(target));
  TAUTLINE_CHECK(contains(errorOf(stray), wording("points-inside")));
}

void writeImage(const std::filesystem::path& file, const Picture& picture)
{
  TAUTLINE_NEW(vtkPNGWriter, writer, SetInputData(makeImage(picture)),
    SetFileName(file.string().c_str()), Write());
}

/// The frames on the sheet are as many as the ranking has right and wrong matches; the first query
/// is at the top left.
void checkSheet(vtkShapeRetrieval* retrieval)
{
  const int size = 700, queries = 6;
  retrieval->SetBestMatches(3); // two of them can be right
  TAUTLINE_SET(retrieval, SetSheetSize(size), Update());
  auto* sheet = vtkImageData::SafeDownCast(retrieval->GetOutputDataObject(4));
  TAUTLINE_CHECK_EQUAL(sheet->GetDimensions()[0], size);
  TAUTLINE_CHECK_EQUAL(sheet->GetDimensions()[1], size);
  auto* pixels = vtkUnsignedCharArray::SafeDownCast(sheet->GetPointData()->GetArray("Sheet"));
  std::map<std::array<int, 3>, vtkIdType> count;
  vtkIdType firstFrame = -1;
  for (vtkIdType i = 0; i < pixels->GetNumberOfTuples(); ++i)
  {
    const vtkIdType fromTop =
      (size - 1 - i / size) * size + i % size; // the lowest row is stored first
    const unsigned char* p = pixels->GetPointer(3 * fromTop);
    const std::array<int, 3> color = { p[0], p[1], p[2] };
    ++count[color];
    if (firstFrame < 0 && color == std::array<int, 3>{ 120, 120, 120 })
    {
      firstFrame = i;
    }
  }
  const std::array<int, 3> grey = { 120, 120, 120 };
  const vtkIdType frame = count[grey] / queries;
  TAUTLINE_CHECK(frame > 0 && count[grey] % queries == 0);
  auto* ranking = vtkTable::SafeDownCast(retrieval->GetOutputDataObject(1));
  vtkIdType right = sumOf<vtkIdType>(0, ranking->GetNumberOfRows(),
    [&](vtkIdType row) { return ranking->GetValueByName(row, "Correct").ToInt(); });
  TAUTLINE_CHECK(right > 0 && right < 3 * queries);
  const std::array<int, 3> green = { 0, 150, 60 }, red = { 215, 25, 30 };
  TAUTLINE_CHECK_EQUAL(count[green], right * frame);
  TAUTLINE_CHECK_EQUAL(count[red], (3 * queries - right) * frame);
  // At the top left: less than a tenth of the sheet from each side.
  TAUTLINE_CHECK(firstFrame / size < size / 10 && firstFrame % size < size / 10);
  retrieval->SetBestMatches(2);
}

void testRetrieval(const std::string& output)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(output) / "silhouette-set";
  fs::remove_all(folder);
  fs::create_directories(folder / "images");
  std::ofstream list(folder / "labels.csv");
  list << "file,class_id,class\n";
  for (int k = 0; k < 3; ++k)
  {
    writeImage(
      folder / "images" / ("blob" + std::to_string(k) + ".png"), blob(90, 45, 45, 20 + k, 0.4 * k));
    writeImage(
      folder / "images" / ("disc" + std::to_string(k) + ".png"), disc(90, 45, 45, 20 + 2 * k));
    list << "blob" << k << ".png,1,lobed\ndisc" << k << ".png,2,\"round\"\n";
  }
  list.close();
  vtkNew<vtkSilhouetteSetReader> reader;
  reader->SetFileName((folder / "labels.csv").string().c_str());
  TAUTLINE_CHECK_EQUAL(reader->CanReadFile(reader->GetFileName()), 1);
  TAUTLINE_NEW(vtkShapeRetrieval, retrieval, SetInputConnection(reader->GetOutputPort()),
    SetBestMatches(2), Update());
  TAUTLINE_CHECK_NEAR(retrieval->GetRecognitionRate(), 100.0, 1e-12);
  auto* blocks = outputOf<vtkMultiBlockDataSet>(reader);
  TAUTLINE_CHECK_EQUAL(blocks->GetNumberOfBlocks(), 6u);
  TAUTLINE_CHECK(std::string(blocks->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME())) == "disc0");
  auto* label = vtkStringArray::SafeDownCast(
    vtkDataSet::SafeDownCast(blocks->GetBlock(1))->GetFieldData()->GetAbstractArray("Label"));
  TAUTLINE_CHECK(label && label->GetValue(0) == "round");
  auto* distances = outputOf<vtkTable>(retrieval);
  TAUTLINE_CHECK_EQUAL(distances->GetNumberOfRows(), 6);
  TAUTLINE_CHECK_EQUAL(distances->GetNumberOfColumns(), 8);
  TAUTLINE_CHECK_EQUAL(distances->GetValueByName(0, "blob0").ToDouble(), 0.0);
  TAUTLINE_CHECK_EQUAL(
    vtkTable::SafeDownCast(retrieval->GetOutputDataObject(1))->GetNumberOfRows(), 12);
  auto* confusion = vtkTable::SafeDownCast(retrieval->GetOutputDataObject(3));
  TAUTLINE_CHECK_NEAR(confusion->GetValueByName(0, "lobed").ToDouble(), 100.0, 1e-9);
  TAUTLINE_CHECK_NEAR(confusion->GetValueByName(0, "round").ToDouble(), 0.0, 1e-9);
  checkSheet(retrieval);
  // The images are beside each other, and where they are has no effect.
  for (unsigned int i = 1; i < blocks->GetNumberOfBlocks(); ++i)
  {
    const auto originOf = [&](unsigned int block)
    { return vtkImageData::SafeDownCast(blocks->GetBlock(block))->GetOrigin(); };
    const double* left = originOf(i - 1);
    const double* right = originOf(i);
    TAUTLINE_CHECK(right[1] < left[1] || (right[1] == left[1] && right[0] - left[0] > 90));
  }
  const double beside = distances->GetValueByName(0, "disc1").ToDouble();
  reader->SideBySideOff();
  retrieval->Update();
  blocks = outputOf<vtkMultiBlockDataSet>(reader);
  TAUTLINE_CHECK_EQUAL(vtkImageData::SafeDownCast(blocks->GetBlock(5))->GetOrigin()[0], 0.0);
  distances = outputOf<vtkTable>(retrieval);
  TAUTLINE_CHECK(beside > 0);
  TAUTLINE_CHECK_EQUAL(distances->GetValueByName(0, "disc1").ToDouble(), beside);
  reader->SideBySideOn();
  // A folder needs no list: classes from the names.
  reader->SetFileName((folder / "images").string().c_str());
  retrieval->Update();
  TAUTLINE_CHECK_NEAR(retrieval->GetRecognitionRate(), 100.0, 1e-12);

  const auto rejected = [&](const std::string& text, const char* part)
  {
    std::ofstream(folder / "bad.csv") << text;
    TAUTLINE_NEW(vtkSilhouetteSetReader, bad, SetFileName((folder / "bad.csv").string().c_str()));
    TAUTLINE_CHECK(contains(errorOf(bad), part));
  };
  rejected("", "empty");
  rejected("name,class\na,b\n", wording("bad-csv-1-no-column-file"));
  rejected("file,class\nnone.png,b\n", wording("bad-csv-2-there-is-no-file"));
  rejected("file,class\nblob0.png\n", wording("bad-csv-2-1-fields"));
  std::ofstream(folder / "images" / "text.png") << "no picture";
  rejected("file,class\ntext.png,b\n", "text.png");
  TAUTLINE_NEW(vtkSilhouetteSetReader, missing, SetFileName("nowhere.csv"));
  TAUTLINE_CHECK(contains(errorOf(missing), wording("no-such-file")));
}
}

TAUTLINE_TEST(TestShapeFilters)
{
  TAUTLINE_RUN(testRetrieval(argv[2]));
}
