// SPDX-License-Identifier: BSD-3-Clause
// Files of OpenFOAM's meshes: all forms give the same mesh, cells get the types of VTK, and what is
// wrong is an error that names file and line.

#include "FoamFileAdapter.h"
#include "FoamMesh.h"
#include "FoamPoints.h"
#include "Readers/FoamSamples.h"
#include "Registry.h"

#include "vtkCell.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

#include <random>

using namespace tautline;

namespace
{
std::string output;

std::string folder()
{
  return output + "/foam-files/polyMesh";
}

bool sameMesh(const FoamMesh& a, const FoamMesh& b)
{
  bool equal = same(a.points, b.points) && a.faceOffsets == b.faceOffsets &&
    a.facePoints == b.facePoints && a.owner == b.owner && a.neighbor == b.neighbor &&
    a.cells == b.cells && a.patches.size() == b.patches.size();
  for (std::size_t i = 0; equal && i < a.patches.size(); ++i)
  {
    equal = a.patches[i].name == b.patches[i].name && a.patches[i].type == b.patches[i].type &&
      a.patches[i].start == b.patches[i].start && a.patches[i].size == b.patches[i].size &&
      a.patches[i].neighbor == b.patches[i].neighbor;
  }
  return equal;
}

TAUTLINE_PART(testForms)
{
  const FoamMesh expected = readFoamMesh(writeFoam(folder(), twoCubes()));
  TAUTLINE_CHECK_EQUAL(expected.cells, 2);
  TAUTLINE_CHECK_EQUAL(expected.numberOfFaces(), 11);
  TAUTLINE_CHECK_EQUAL(expected.numberOfInternalFaces(), 1);
  TAUTLINE_CHECK_EQUAL(expected.patches.at(1).neighbor, "low");
  TAUTLINE_CHECK_EQUAL(expected.patches.at(2).type, "wall");
  for (int bits = 0; bits < 64; ++bits)
  {
    const FoamForm form{ (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0,
      bits & 16 ? 8 : 4, bits & 32 ? 8 : 4 };
    const Context context("form " + std::to_string(bits));
    TAUTLINE_CHECK(sameMesh(readFoamMesh(writeFoam(folder(), twoCubes(), form)), expected));
  }
}

TAUTLINE_PART(testListForms)
{
  const FoamFormatter format{ FoamForm() };
  const FoamSample cube = oneCell(towerPoints(0, 1), FoamRows{ CubeBottom, CubeTop } + CubeSides);
  const FoamMesh expected = readFoamMesh(writeFoam(folder(), cube));
  writeText(folder() + "/owner", format.header("labelList") + "6{0}");
  writeText(folder() + "/neighbour", format.header("labelList") + "0()");
  writeText(folder() + "/faces",
    format.header("faceList") +
      "( 4(0 2 3 1) /* top */ 4 (4 5 7 6)(0 1 5 4)4(1 3 7 5)4(3 2 6 7)4(2 0 4 6))");
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-expected-a-whole-number"));
  writeText(folder() + "/faces",
    format.header("faceList") +
      "( 4(0 2 3 1) /* top */ 4 (4 5 7 6)4(0 1 5 4)4(1 3 7 5)4(3 2 6 7)4(2 0 4 6))// end");
  TAUTLINE_CHECK(sameMesh(readFoamMesh(folder()), expected));
  // older files fill the neighbors of the boundary, and a binary list without entries is a number
  writeText(folder() + "/neighbour", format.header("labelList") + "6(-1 -1 -1 -1 -1 -1)");
  TAUTLINE_CHECK(sameMesh(readFoamMesh(folder()), expected));
  writeText(folder() + "/neighbour",
    FoamFormatter(FoamForm{ true, false, false, false, 4, 8 }).header("labelList") + "\n0\n");
  TAUTLINE_CHECK(sameMesh(readFoamMesh(folder()), expected));
}

/// The outward normal of a cell's face, by its fan, times the vector from the cell's center to it.
double outwards(vtkCell* cell, vtkCell* face)
{
  const auto mean = [](vtkCell* of, double* centre)
  {
    std::fill_n(centre, 3, 0.0);
    for (vtkIdType i = 0; i < of->GetNumberOfPoints(); ++i)
    {
      double point[3];
      of->GetPoints()->GetPoint(i, point);
      TAUTLINE_EACH(
        int, axis, 3, centre[axis] += point[axis] / static_cast<double>(of->GetNumberOfPoints()));
    }
  };
  double centre[3], faceCentre[3], a[3], b[3], c[3];
  mean(cell, centre);
  mean(face, faceCentre);
  face->GetPoints()->GetPoint(0, a);
  face->GetPoints()->GetPoint(1, b);
  face->GetPoints()->GetPoint(2, c);
  double product = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double normal = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    product += normal * (faceCentre[i] - centre[i]);
  }
  return product;
}

/// Faces in another order, each from another point on.
FoamRows shuffled(FoamRows faces, std::mt19937& random)
{
  std::shuffle(faces.begin(), faces.end(), random);
  for (std::vector<Index>& face : faces)
  {
    std::rotate(
      face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()), face.end());
  }
  return faces;
}

TAUTLINE_PART(testCellTypes)
{
  const std::vector<double> cube = towerPoints(0, 1);
  const std::vector<double> pyramid = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0.5, 0.5, 1 };
  const std::vector<double> wedge = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1 };
  const FoamSample tetrahedron = oneTetrahedron();
  struct Sample
  {
    unsigned char type;
    const std::vector<double>& points;
    FoamRows faces;
  };
  const std::vector<Sample> samples = {
    { FileHexahedron, cube, FoamRows{ CubeBottom, CubeTop } + CubeSides },
    { FilePyramid, pyramid,
      { { 0, 2, 3, 1 }, { 0, 1, 4 }, { 1, 3, 4 }, { 3, 2, 4 }, { 2, 0, 4 } } },
    { FileWedge, wedge,
      { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } } },
    { FileTetrahedron, tetrahedron.points, tetrahedron.faces },
    { FilePolyhedron, cube, FoamRows{ CubeBottom, { 4, 5, 7 }, { 4, 7, 6 } } + CubeSides },
    // a wrong orientation of one face makes no cell of VTK
    { FilePolyhedron, cube, FoamRows{ { 0, 1, 3, 2 }, CubeTop } + CubeSides },
  };
  std::mt19937 random(7);
  for (std::size_t s = 0; s < samples.size(); ++s)
  {
    const Context context("sample " + std::to_string(s));
    for (int round = 0; round < 20; ++round)
    {
      FoamPiece piece;
      const FoamSample sample = oneCell(samples[s].points, shuffled(samples[s].faces, random));
      piece.mesh = readFoamMesh(writeFoam(folder(), sample), &piece.cells);
      TAUTLINE_CHECK_EQUAL(int(piece.cells.types.at(0)), int(samples[s].type));
      vtkNew<vtkUnstructuredGrid> grid;
      toGrid(piece, true, grid);
      TAUTLINE_CHECK_EQUAL(
        grid->GetNumberOfCells(), static_cast<vtkIdType>(sample.faces.size()) + 1);
      vtkCell* cell = grid->GetCell(0);
      TAUTLINE_CHECK_EQUAL(cell->GetNumberOfPoints() * 3, vtkIdType(sample.points.size()));
      TAUTLINE_CHECK_EQUAL(cell->GetNumberOfFaces(), int(sample.faces.size()));
      for (int f = 0; s + 1 < samples.size() && f < cell->GetNumberOfFaces(); ++f)
      {
        vtkNew<vtkUnstructuredGrid> copy; // GetFace() and GetCell() share objects
        copy->DeepCopy(grid);
        TAUTLINE_CHECK(outwards(copy->GetCell(0), cell->GetFace(f)) > 0.0);
      }
    }
  }
}

TAUTLINE_PART(testZones)
{
  FoamSample sample = twoCubes();
  const FoamFormatter text{ FoamForm() };
  sample.others["cellZones"] = text.header("regIOobject") +
    "2 ( a { type cellZone; cellLabels List<label> 1(1); } b { type cellZone; cellLabels 0(); } )";
  sample.others["faceZones"] = text.header("regIOobject") +
    "(f { faceLabels List<label> 2(0 3); flipMap List<bool> 2{0}; type faceZone; })";
  const FoamMesh mesh = readFoamMesh(writeFoam(folder(), sample));
  TAUTLINE_CHECK_EQUAL(mesh.cellZones.size(), 2u);
  TAUTLINE_CHECK(mesh.cellZones.at(0).members == std::vector<Index>{ 1 });
  TAUTLINE_CHECK(mesh.cellZones.at(1).members.empty());
  TAUTLINE_CHECK((mesh.faceZones.at(0).members == std::vector<Index>{ 0, 3 }));
  // the same in bytes, which include brackets and semicolons
  const FoamForm binary{ true, false, false, false, 8, 8 };
  const FoamFormatter bytes{ binary };
  sample.others["cellZones"] = bytes.header("regIOobject") +
    "1 ( a { type cellZone; cellLabels List<label> " + bytes.labels({ 1 }) + "; } )";
  sample.others["faceZones"] = bytes.header("regIOobject") +
    "1 ( f { flipMap List<bool> 3\n(};)); faceLabels List<label> " + bytes.labels({ 3, 0, 5 }) +
    "; } )";
  const FoamMesh again = readFoamMesh(writeFoam(folder(), sample, binary));
  TAUTLINE_CHECK(again.cellZones.at(0).members == std::vector<Index>{ 1 });
  TAUTLINE_CHECK((again.faceZones.at(0).members == std::vector<Index>{ 3, 0, 5 }));
}

TAUTLINE_PART(testOrder)
{
  // three cubes in a ring of faces: cell 0 meets 1 and 2
  FoamMesh mesh;
  mesh.cells = 3;
  mesh.owner = { 0, 0, 1 };
  mesh.neighbor = { 1, 2, 2 };
  TAUTLINE_CHECK_EQUAL(facesOutOfOrder(mesh, cellFacesOf(mesh)), 0);
  mesh.neighbor = { 2, 1, 2 };
  TAUTLINE_CHECK_EQUAL(facesOutOfOrder(mesh, cellFacesOf(mesh)), 1);
  mesh.neighbor = { 1, 1, 2 }; // two faces between two cells are in order
  TAUTLINE_CHECK_EQUAL(facesOutOfOrder(mesh, cellFacesOf(mesh)), 0);
}

/// Writes the two cubes with a change of one file and checks the error.
void rejected(
  const std::string& file, const std::string& from, const std::string& to, const char* problem)
{
  writeFoam(folder(), twoCubes());
  std::string text = readText(folder() + "/" + file);
  const std::size_t place = text.rfind(from);
  TAUTLINE_CHECK(place != text.npos);
  if (place != text.npos)
  {
    writeText(folder() + "/" + file, text.replace(place, from.size(), to));
  }
  const Context context(file + ": " + to);
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), problem);
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), folder() + "/");
}

TAUTLINE_PART(testErrors)
{
  rejected("points", "(0 0 0)", "(0 nan 0)", wording("foam-coordinate-is-not-finite"));
  rejected("points", "(0 0 0)", "(0 0)", wording("foam-expected-a-number"));
  rejected("points", "(0 0 0)", "(0 0 0 0)", wording("foam-expected-parenthesis"));
  rejected("points", "12\n(", "13\n(", wording("foam-expected-point"));
  rejected("points", "12\n(", "99999999\n(", wording("foam-list-is-truncated"));
  rejected("points", "12\n(", "12{(0 0 0)}\n(", wording("foam-cannot-all-be-equal"));
  rejected("points", ")\n", "", wording("foam-after-the-last-point"));
  rejected("points", "FoamFile", "Foam", wording("foam-no-header"));
  rejected("points", "ascii", "ascent", wording("foam-format-is"));
  rejected("points", "vectorField", "#include \"x\"", wording("foam-is-a-directive"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "2\n(\n0\n2)", wording("foam-has-2-points"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "4\n(\n0\n2\n0\n1)", wording("foam-point-more-than-once"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "4\n(\n0\n2\n12\n1)", wording("foam-point-is-12"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "4\n(\n0\n2\n-1\n1)", wording("foam-point-is-1"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "99999999999999999999(0)", wording("foam-more-digits"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "4\n(\n0\n2\n7\n1)", wording("foam-cell-is-open"));
  rejected("faces", "4\n(\n0\n2\n3\n1)", "3\n(\n0\n2\n3)", wording("foam-cell-is-open"));
  rejected("owner", "11\n(", "10\n(", wording("foam-expected-closing"));
  rejected("owner", "11\n(", "12\n(", wording("foam-entries-possible"));
  rejected("owner", "\n1)", "\n11)", wording("foam-owner-is-11"));
  rejected("owner", "(\n0", "(\n1", wording("foam-owner-of-an-internal-face"));
  rejected("neighbour", "1)", "0)", wording("foam-owner-of-an-internal-face"));
  rejected("neighbour", "1\n(\n1)", "2\n(\n1\n1)", wording("foam-must-start-at-2"));
  rejected("neighbour", "1\n(\n1)", "2\n(\n-1\n1)", wording("foam-has-no-neighbour"));
  rejected("boundary", "startFace 3", "startFace 4", wording("foam-must-start-at-3"));
  rejected("boundary", "nFaces 8", "nFaces 7", wording("foam-patches-end-at-10"));
  rejected("boundary", "nFaces 8", "nFaces 9", wording("foam-patch-ends-at-12"));
  rejected("boundary", "nFaces 8", "nFaces -8", wording("foam-nfaces-is-8"));
  rejected("boundary", "nFaces 8", "nFaces $n", wording("foam-is-a-macro"));
  rejected("boundary", "nFaces 8;", "", wording("foam-has-no-nfaces"));
  rejected("boundary", "type wall;", "#include \"walls\"", wording("foam-is-a-directive"));
  rejected("boundary", "sides", "low", wording("foam-two-patches"));
  rejected("boundary", "inGroups 1(wall);", "inGroups 1(wall)", wording("foam-has-no-nfaces"));
  rejected("boundary", "startFace 3;", "startFace 3", wording("foam-expected-semicolon"));
  rejected("boundary", "startFace 3;", "a b", wording("foam-ends-inside"));
  rejected("boundary", "// * * * //", "/* * * *", wording("foam-comment-has-no-end"));
  for (const char* file : { "points", "faces", "owner", "neighbour", "boundary" })
  {
    writeFoam(folder(), twoCubes());
    std::filesystem::remove(folder() + "/" + file);
    TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-cannot-be-opened"));
  }
}

TAUTLINE_PART(testLines)
{
  // the line of the entry, also where an error is found after the list was read
  FoamSample sample = twoCubes();
  sample.owner[0] = 1;
  writeFoam(folder(), sample);
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-neighbour-line"));
  writeFoam(folder(), oneCell(towerPoints(0, 1), { { 0, 2, 1 }, { 0, 1, 4 }, { 1, 2, 4 } }));
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-owner-line"));
  sample = twoCubes();
  sample.faces[1] = { 0, 2, 3 };
  writeFoam(folder(), sample);
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-faces-line"));
}

TAUTLINE_PART(testBinaryErrors)
{
  for (const bool compact : { false, true })
  {
    const FoamForm form{ true, compact, false, false, 4, 8 };
    for (const char* file : { "points", "faces", "owner" })
    {
      writeFoam(folder(), twoCubes(), form);
      const std::string text = readText(folder() + "/" + file);
      for (std::size_t cut = 1; cut < text.size(); ++cut)
      {
        writeText(folder() + "/" + file, text.substr(0, text.size() - cut));
        if (cut > 1 || text.back() != '\n') // the last line end is not needed
        {
          TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), std::string(folder() + "/" + file));
        }
      }
    }
    FoamSample sample = twoCubes();
    sample.points[4] = std::nan("");
    writeFoam(folder(), sample, form);
    TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-binary-nan"));
    sample = twoCubes();
    sample.owner[3] = 77;
    writeFoam(folder(), sample, form);
    TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-binary-owner"));
    sample = twoCubes();
    sample.faces[4][1] = sample.faces[4][0];
    writeFoam(folder(), sample, form);
    TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-point-more-than-once"));
  }
  // scalars of another width
  const FoamForm form{ true, false, false, false, 4, 4 };
  writeFoam(folder(), twoCubes(), form);
  std::string text = readText(folder() + "/points");
  writeText(folder() + "/points", text.replace(text.find("scalar=32"), 9, "scalar=64"));
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-list-is-truncated"));
}

TAUTLINE_PART(testCompressedErrors)
{
  writeFoam(folder(), twoCubes(), FoamForm{ false, false, true, false, 4, 8 });
  const std::string bytes = readText(folder() + "/faces.gz");
  writeText(folder() + "/faces.gz", bytes.substr(0, bytes.size() / 2));
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-compressed-truncated"));
  writeText(folder() + "/faces.gz", bytes.substr(0, 20) + "damaged" + bytes.substr(27));
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-compressed-damaged"));
  // a plain file comes first, as in OpenFOAM
  const FoamFormatter format{ FoamForm() };
  writeText(folder() + "/faces", format.header("faceList") + format.faces(twoCubes().faces));
  TAUTLINE_CHECK_EQUAL(readFoamMesh(folder()).cells, 2);
}

TAUTLINE_PART(testDuplicateFaces)
{
  // a cube with two further faces that are the same: each edge has an even number of faces
  FoamRows faces = FoamRows{ CubeBottom, { 4, 5, 7 }, { 4, 7, 6 } } + CubeSides;
  faces.push_back({ 0, 3, 7 });
  faces.push_back({ 7, 3, 0 });
  writeFoam(folder(), oneCell(towerPoints(0, 1), faces));
  TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), wording("foam-have-the-same-points"));
}

TAUTLINE_PART(testHugeCounts)
{
  // counts that the file cannot hold are rejected before memory is taken for them
  const FoamFormatter format{ FoamForm() };
  for (const std::string count : { "1000000000000", "9223372036854775807" })
  {
    for (const std::string& list : { count + "(0)", count + "{0}", count })
    {
      for (const std::string file : { "points", "faces", "owner", "neighbour" })
      {
        writeFoam(folder(), twoCubes());
        writeText(folder() + "/" + file, format.header("faceCompactList") + list);
        TAUTLINE_CHECK_THROWS(readFoamMesh(folder()), file);
      }
    }
  }
}

TAUTLINE_PART(testPointsBack)
{
  const std::vector<double> before = twoCubes().points;
  for (int bits = 0; bits < 16; ++bits)
  {
    const FoamForm form{ (bits & 1) != 0, false, (bits & 2) != 0, (bits & 4) != 0, 4,
      bits & 8 ? 4 : 8 };
    const Context context("form " + std::to_string(bits));
    writeFoam(folder(), twoCubes(), form);
    const std::string name = folder() + (form.compressed ? "/points.gz" : "/points");
    const std::string original = readText(name);
    if (!form.compressed)
    {
      TAUTLINE_CHECK(withFoamPoints(folder(), before).bytes == original);
    }
    std::vector<double> moved = before;
    moved[14] += 0.1;
    double rounding = 0.0;
    const std::vector<std::string> files =
      writeFoamPoints({ folder() }, {}, moved, true, &rounding);
    TAUTLINE_CHECK(files == std::vector<std::string>{ name });
    const bool single = form.binary && form.scalarBytes == 4;
    const std::vector<double> found = readFoamMesh(folder()).points;
    TAUTLINE_CHECK_EQUAL(found[14], single ? double(float(moved[14])) : moved[14]);
    TAUTLINE_CHECK_EQUAL(rounding, std::abs(found[14] - moved[14]));
    std::vector<double> others = found;
    others[14] = before[14];
    TAUTLINE_CHECK(same(others, before));
    // the first original is kept, and comes back to the bit
    const std::string kept = folder() + (form.compressed ? "/points.orig.gz" : "/points.orig");
    TAUTLINE_CHECK(readText(kept) == original);
    writeFoamPoints({ folder() }, {}, before, true);
    TAUTLINE_CHECK(readText(kept) == original);
    if (!form.compressed)
    {
      const std::string name = folder() + "/points";
      TAUTLINE_CHECK(
        form.binary ? readText(name) == original : same(readFoamMesh(folder()).points, before));
    }
  }
}

TAUTLINE_PART(testTextOfPoints)
{
  // only the number of the coordinate that moves changes, to the shortest that reads back the same
  const FoamFormatter format{ FoamForm() };
  writeFoam(folder(), twoCubes());
  const std::string head = format.header("vectorField") + "( /* two */ (1.50 2e0\t+3)\n(4 ";
  writeText(folder() + "/points", head + "5.000 6.0e-1) ) // end\n");
  const auto written = [](const std::vector<double>& points)
  { return withFoamPoints(folder(), points).bytes; };
  TAUTLINE_CHECK(written({ 1.5, 2, 3, 4, 5, 0.6 }) == readText(folder() + "/points"));
  TAUTLINE_CHECK(written({ 1.5, 2, 3, 4, 0.1, 0.6 }) == head + "0.1 6.0e-1) ) // end\n");
  TAUTLINE_CHECK_THROWS(written({ 1.5, 2, 3 }), wording("foam-has-2-points-and-the-mesh"));
  TAUTLINE_CHECK_THROWS(
    written({ 1.5, 2, 3, 4, 5, std::nan("") }), wording("foam-cannot-be-written"));
  TAUTLINE_CHECK(readText(folder() + "/points") == head + "5.000 6.0e-1) ) // end\n");
  // numbers of 4 bytes have no room for large ones
  writeFoam(folder(), twoCubes(), FoamForm{ true, false, false, false, 4, 4 });
  std::vector<double> large = twoCubes().points;
  large[0] = 1e60;
  TAUTLINE_CHECK_THROWS(written(large), wording("foam-too-large-for-4-bytes"));
}
}

TAUTLINE_TEST(TestFoamFiles)
{
  output = argv[2];
  static_cast<void>(argc);
}
