// SPDX-License-Identifier: BSD-3-Clause
// Medit: binary files of all versions and byte orders, files that are cut anywhere, files without
// the keyword End.

#include "MeshFileChecks.h"
#include "Registry.h"

#include <algorithm>
#include <cstdint>
#include <limits>

using namespace tautline;

namespace
{
std::string data;
std::string output;

/// The numbers of a binary file of a version, in this machine's byte order or the other one.
struct Bytes
{
  std::int32_t version;
  bool swapped;
  std::string text;

  template <class T>
  void add(T value)
  {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    swapped ? std::reverse(bytes, bytes + sizeof(T)) : void();
    text.append(bytes, sizeof(T));
  }
  void word(int value) { this->add(static_cast<std::int32_t>(value)); }
  void integer(Index value)
  {
    version >= 4 ? this->add(static_cast<std::int64_t>(value))
                 : this->add(static_cast<std::int32_t>(value));
  }
  void position(std::size_t value)
  {
    version >= 3 ? this->add(static_cast<std::int64_t>(value))
                 : this->add(static_cast<std::int32_t>(value));
  }
  void real(double value)
  {
    version == 1 ? this->add(static_cast<float>(value)) : this->add(value);
  }
  void section(int code, const Bytes& content)
  {
    this->word(code);
    this->position(this->text.size() + (this->version >= 3 ? 8 : 4) + content.text.size());
    this->text += content.text;
  }
  Bytes part() const { return { this->version, this->swapped, "" }; }
};

Bytes listOf(const Bytes& file, std::initializer_list<Index> values, Index count)
{
  Bytes part = file.part();
  part.integer(count);
  for (const Index value : values)
  {
    part.integer(value);
  }
  return part;
}

/// A tetrahedron, a wedge, a triangle and a section that is not read (normals at vertices).
Bytes sample(std::int32_t version, bool swapped, bool end = true)
{
  Bytes file{ version, swapped, "" };
  file.word(1);
  file.word(version);
  Bytes dimension = file.part();
  dimension.word(3);
  file.section(3, dimension);
  Bytes vertices = file.part();
  vertices.integer(6);
  const double x[][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1.5 }, { 1, 0, 1.5 },
    { 0, 1, 1.5 } };
  for (int i = 0; i < 6; ++i)
  {
    for (const double c : x[i])
    {
      vertices.real(c);
    }
    vertices.integer(i + 10);
  }
  file.section(4, vertices);
  file.section(20, listOf(file, { 1, 1, 2, 2 }, 2));
  file.section(8, listOf(file, { 1, 2, 3, 4, 7 }, 1));
  file.section(9, listOf(file, { 1, 3, 2, 4, 6, 5, -8 }, 1));
  file.section(13, listOf(file, { 2 }, 1));
  file.section(6, listOf(file, { 1, 2, 3, 9 }, 1));
  if (end)
  {
    file.word(54);
    file.position(0);
  }
  return file;
}

constexpr const char* SameAsText =
  "MeshVersionFormatted 2\nDimension 3\nVertices 6\n0 0 0 10\n1 0 0 11\n0 1 0 12\n0 0 1.5 13\n"
  "1 0 1.5 14\n0 1 1.5 15\nTetrahedra 1\n1 2 3 4 7\nPrisms 1\n1 3 2 4 6 5 -8\nCorners 1\n2\n"
  "Triangles 1\n1 2 3 9\n";

TAUTLINE_PART(testVersions)
{
  const std::string name = output + "/sample.meshb";
  writeText(output + "/same.mesh", std::string(SameAsText) + "End\n");
  const MeshFile text = readMedit(output + "/same.mesh", true);
  TAUTLINE_CHECK(text.numberOfCells() == 3 && text.warnings.empty());
  for (const std::int32_t version : { 1, 2, 3, 4 })
  {
    for (const bool swapped : { false, true })
    {
      const Context context("version " + std::to_string(version) + (swapped ? ", swapped" : ""));
      writeText(name, sample(version, swapped).text);
      TAUTLINE_CHECK(isMeditBinary(name) && same(readMedit(name, true), text));
      TAUTLINE_CHECK(readMedit(name, false).numberOfCells() == 2);
      writeText(name, sample(version, swapped, false).text);
      const MeshFile open = readMedit(name, true);
      TAUTLINE_CHECK(same(open, text) && open.warnings.size() == 1);
    }
  }
  TAUTLINE_CHECK(!isMeditBinary(output + "/same.mesh"));
}

/// A file that is cut anywhere is an error; after its last section it is complete.
TAUTLINE_PART(testCuts)
{
  const std::string name = output + "/cut.meshb";
  for (const std::int32_t version : { 1, 4 })
  {
    const std::string whole = sample(version, false).text;
    int taken = 0;
    for (std::size_t size = 0; size < whole.size(); ++size)
    {
      writeText(name, whole.substr(0, size));
      const std::string said = complaint(name);
      taken += said.empty();
      TAUTLINE_CHECK(said.empty() || said.find(name) == 0);
    }
    TAUTLINE_CHECK_EQUAL(taken, 4); // after tetrahedra, prisms, corners and triangles
  }
  const std::string text = SameAsText;
  int taken = 0;
  for (std::size_t size = 0; size <= text.size(); ++size)
  {
    writeText(output + "/cut.mesh", text.substr(0, size));
    const std::string said = complaint(output + "/cut.mesh");
    TAUTLINE_CHECK(said.empty() || said.find(output) == 0);
    if (!said.empty())
    {
      continue;
    }
    ++taken;
    const MeshFile mesh = readMedit(output + "/cut.mesh", true);
    TAUTLINE_CHECK(mesh.warnings.size() == 1);
    const bool line = text[size - 1] == '\n';
    TAUTLINE_CHECK(line == !contains(mesh.warnings[0], wording("last-number-may-be-cut-off")));
  }
  TAUTLINE_CHECK_EQUAL(taken, 8); // after four sections, with and without the line end
}

TAUTLINE_PART(testMessages)
{
  const std::string name = output + "/bad.meshb";
  const auto expect = [&](const std::string& content, const std::string& problem)
  {
    writeText(name, content);
    const std::string said = complaint(name);
    std::cerr << (contains(said, problem) ? "" : said + " is not: " + problem + "\n");
    TAUTLINE_CHECK(contains(said, problem) && said.find(name) == 0);
  };
  expect("MeshVersionFormatted 2\n", wording("no-binary-file-of-medit"));
  Bytes file{ 5, false, "" };
  file.word(1);
  file.word(5);
  expect(file.text, wording("version-5-of-the-format"));
  const auto changed = [](std::size_t at, std::int32_t value)
  {
    std::string text = sample(2, false).text;
    std::memcpy(text.data() + at, &value, sizeof(value));
    return text;
  };
  expect(changed(16, 4), wording("dimension-is-4-2-or-3"));
  expect(changed(24, 12), wording("truncated-or-damaged")); // the next section before this one
  expect(changed(24, -1), wording("truncated-or-damaged"));
  expect(changed(28, 1 << 30), wording("truncated-or-damaged")); // the count of vertices
  expect(changed(28, -6), wording("truncated-or-damaged"));
  std::string text = sample(2, false).text;
  const double infinite = std::numeric_limits<double>::infinity();
  std::memcpy(text.data() + 32, &infinite, sizeof(infinite));
  expect(text, wording("a-coordinate-is-not-a-finite"));
  Bytes wrong = sample(2, false, false);
  wrong.section(6, listOf(wrong, { 1, 2, 7, 0 }, 1));
  expect(wrong.text, wording("vertex-is-7-from-1-to-6"));
}

/// Sections that are not read are reported if they have cells.
TAUTLINE_PART(testCellsLeftOut)
{
  const std::string name = output + "/curved.meshb";
  Bytes file = sample(3, false, false);
  file.section(24, listOf(file, { 1, 2, 3, 4, 5, 6, 0 }, 1));
  file.word(54);
  file.position(0);
  writeText(name, file.text);
  const MeshFile mesh = readMedit(name, true);
  TAUTLINE_CHECK(mesh.warnings.size() == 1 && mesh.numberOfCells() == 3);
  const std::string text = SameAsText;
  writeText(output + "/curved.mesh", text + "TrianglesP2 1\n1 2 3 4 5 6 0\nEnd\n");
  const MeshFile same = readMedit(output + "/curved.mesh", true);
  TAUTLINE_CHECK(same.warnings.size() == 1 && contains(same.warnings[0], "TrianglesP2"));
  writeText(output + "/normals.mesh", text + "Normals 2\n0 0 1\n0 1 0\nEnd\n");
  TAUTLINE_CHECK(readMedit(output + "/normals.mesh", true).warnings.empty());
  // a section that is skipped is checked at the end of the file
  writeText(output + "/normals.mesh", text + "Normals 2\n0 0 1\n0 1 0\n");
  TAUTLINE_CHECK(complaint(output + "/normals.mesh").empty());
  writeText(output + "/normals.mesh", text + "Normals 2\n0 0 1\n0 1\n");
  TAUTLINE_CHECK(
    contains(complaint(output + "/normals.mesh"), wording("ends-within-the-section-normals")));
  writeText(output + "/normals.mesh", text + "Norm");
  TAUTLINE_CHECK(
    contains(complaint(output + "/normals.mesh"), wording("ends-within-the-section-norm")));
}

/// A .sol without the keyword End, and the .sol of a .meshb.
TAUTLINE_PART(testSolutions)
{
  const std::string sol =
    "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n6\n1 1\n1 2 3 4 5 6\n";
  for (const char* ending : { "mesh", "meshb" })
  {
    const std::string stem = output + "/with-" + ending;
    const bool binary = std::string(ending) == "meshb";
    writeText(
      stem + "." + ending, binary ? sample(2, false).text : SameAsText + std::string("End\n"));
    writeText(stem + ".sol", sol + "End\n");
    TAUTLINE_CHECK(findArray(readMedit(stem + "." + ending, true).pointArrays, "Solution1"));
    TAUTLINE_CHECK(findArray(readMedit(stem + ".sol", true).pointArrays, "Solution1"));
    writeText(stem + ".sol", sol);
    TAUTLINE_CHECK(readMedit(stem + "." + ending, true).warnings.size() == 1);
    writeText(stem + ".sol", sol.substr(0, sol.size() - 3));
    TAUTLINE_CHECK(!complaint(stem + "." + ending).empty());
    std::remove((stem + ".sol").c_str());
  }
}

TAUTLINE_PART(testWriting)
{
  const std::string name = output + "/zoo.meshb";
  MeshFile zoo = readMedit(data + "/zoo.mesh", true);
  TAUTLINE_CHECK_EQUAL(meditArraysLeftOut(zoo), std::string("Solution1, Solution2, Solution3"));
  zoo.pointArrays.resize(2);
  zoo = [&]
  {
    writeMedit(zoo, output + "/zoo-text.mesh");
    return readMedit(output + "/zoo-text.mesh", true);
  }();
  TAUTLINE_CHECK(writeMedit(zoo, name) == std::vector<std::string>{ name });
  TAUTLINE_CHECK_EQUAL(int{ readText(name)[4] }, 2);
  TAUTLINE_CHECK(same(readMedit(name, true), zoo));
  std::get<MeshArray::Integers>(zoo.cellArrays[0].values)[3] = Index{ 1 } << 40;
  writeMedit(zoo, name);
  TAUTLINE_CHECK_EQUAL(int{ readText(name)[4] }, 4);
  TAUTLINE_CHECK(same(readMedit(name, true), zoo));
  MeshFile plane;
  plane.points = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
  plane.addCells(FileTriangle, { 0, 1, 2 });
  writeMedit(plane, name);
  TAUTLINE_CHECK_EQUAL(int{ readText(name)[16] }, 2); // the dimension
  TAUTLINE_CHECK(same(readMedit(name, true).points, plane.points));
}
}

TAUTLINE_TEST(TestMeditFiles)
{
  data = argv[1];
  output = std::string(argv[2]) + "/medit";
  const std::string makeFolder = "mkdir -p '" + output + "'";
  TAUTLINE_CHECK(std::system(makeFolder.c_str()) == 0);
}
