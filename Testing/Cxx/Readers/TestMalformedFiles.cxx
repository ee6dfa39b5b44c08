// SPDX-License-Identifier: BSD-3-Clause
// Malformed files: the message names file, line and problem. Sets with files of two writes are
// rejected. (Mutations of samples: TestFuzzTargets.)

#include "MeshFileChecks.h"
#include "Registry.h"

using namespace tautline;

namespace
{
std::string data;
std::string output;

/// Writes `text` to a file of the kind and checks the error message.
void expect(const std::string& extension, const std::string& text, const std::string& problem)
{
  const std::string name = output + "/bad." + extension;
  writeText(name, text);
  const std::string said = complaint(name);
  if (!contains(said, problem) || said.find(output) != 0)
  {
    std::cerr << "of\n"
              << text.substr(0, 200) << "\nmessage: " << said << "\nnot: " << problem << "\n";
    TAUTLINE_CHECK(!"message");
  }
}

TAUTLINE_PART(testTetGenMessages)
{
  const std::string good = "4 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n3 0 1 0 1\n4 0 0 1 1\n";
  expect("node", "", wording("bad-node-1-no-header"));
  expect("node", "4 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n", wording("bad-node-1-number-of-vertices-is-2"));
  expect("node", "4 3 0 0\n1 0 0 0.00\n2 1 0 0.00\n3 1 0 0.0000000\n",
    wording("bad-node-5-the-file-ends-before"));
  expect(
    "node", "2 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 1\n", wording("bad-node-4-the-file-continues-after"));
  expect("node", "2 3 0 0\n1 0 nan 0\n2 1 0 0\n", wording("bad-node-2-coordinate-is-not-a-2"));
  expect("node", "2 3 0 0\n1 0 0 1e999\n2 1 0 0\n", wording("bad-node-2-coordinate-is-not-a"));
  expect(
    "node", "2 3 0 0\n1 0 0\n2 1 0 0 0\n", wording("bad-node-2-expected-a-number-coordinate-2"));
  expect(
    "node", "2 3 0 0\n1 0 0 0,5\n2 1 0 0\n", wording("bad-node-2-expected-a-number-coordinate"));
  expect("node", "2 3 0 0\n1 0 0 0 9\n2 1 0 0\n", wording("bad-node-2-the-line-has-more"));
  expect("node", "2 3 0 0\n1 0 0 0\n5 1 0 0\n", wording("bad-node-3-expected-vertex-2-found"));
  expect("node", "-2 3 0 0\n", wording("bad-node-1-number-of-vertices-is"));
  expect("node", "9000000000000000000 3 0 0\n1 0 0 0\n", wording("more-than-the-rest-of-the-file"));
  expect("node", "99999999999999999999 3 0 0\n",
    wording("expected-a-whole-number-number-of-vertices-2"));
  expect("node", "2 4 0 0\n", wording("bad-node-1-dimension-is-4-from"));
  expect("node",
    std::string("\x7f"
                "ELF\x02\x01\x00",
      7),
    wording("expected-a-whole-number-number-of-vertices"));
  std::remove((output + "/bad.node").c_str());
  expect("ele", "1 4 0\n1 1 2 3 4\n", wording("bad-node-cannot-be-opened-the-vertices"));
  writeText(output + "/bad.node", good);
  expect("ele", "1 4 0\n1 1 2 3 5\n", wording("bad-ele-2-vertex-is-5-from"));
  expect("ele", "1 4 0\n1 1 2 3 -4\n", wording("bad-ele-2-vertex-is-4"));
  expect("ele", "1 5 0\n1 1 2 3 4 4\n", wording("bad-ele-1-elements-with-5-nodes"));
  expect("ele", "2 4 0\n1 1 2 3 4\n2 1 2 3  \n    ", wording("bad-ele-3-expected-a-whole-number"));
  std::remove((output + "/bad.ele").c_str());
  expect("face", "1 1\n1 1 2         \n", wording("bad-face-2-expected-a-whole-number"));
  std::remove((output + "/bad.face").c_str());
  expect("smesh", good + "1 0\n4 1 2 3\n", wording("the-file-ends-inside-a-polygon"));
  expect("smesh", good + "1 0\n0\n", wording("number-of-corners-is-0"));
  expect(
    "poly", good + "1 0\n1 0\n99999999 1 2\n", wording("number-of-corners-is-99999999-more-than"));
  std::remove((output + "/bad.node").c_str());
  expect("poly", "0 3 0 0\n1 0\n1\n3 1 2 3\n0\n", wording("bad-node-cannot-be-opened"));
  TAUTLINE_CHECK(contains(complaint(output), wording("is-expected-as-the-file-s-ending")));
}

TAUTLINE_PART(testOtherMessages)
{
  const std::string mesh = "MeshVersionFormatted 2\nDimension 2\nVertices 3\n0 0 1\n1 0 1\n0 1 1\n";
  expect("mesh", mesh, wording("bad-mesh-7-the-file-ends-without"));
  expect("mesh", mesh + "Triangles\n1\n1 2 4 0\nEnd\n", wording("bad-mesh-9-vertex-is-4-from"));
  expect("mesh", mesh + "Triangles\n-1\nEnd\n", wording("bad-mesh-8-number-of-triangles-is"));
  expect("mesh", mesh + "Triangles\n77777777777\nEnd\n", wording("more-than-the-rest-of-the-file"));
  expect("mesh", mesh + "Corners\n1\n4\nEnd\n", wording("corner-number-4-is-out-of-range"));
  expect("mesh", mesh + "1 1 1\nEnd\n", wording("bad-mesh-7-expected-the-name-of"));
  expect("mesh", "solid stl\n", wording("bad-mesh-1-expected-meshversionformatted"));
  expect("mesh", "MFEM mesh v1.0\n\ndimension\n2\n", wording("bad-mesh-1-this-is-a-mesh"));
  writeText(output + "/bad.mesh", mesh + "End\n");
  expect("sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n2\n1 1\n1\n2\nEnd\n",
    wording("solatvertices-has-2-values-the-mesh-has"));
  expect("sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 4\n1\n2\n3\nEnd\n",
    wording("bad-sol-5-type-of-a-field"));
  std::remove((output + "/bad.sol").c_str());

  const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  expect("msh", format, wording("the-file-ends-without-nodes"));
  expect(
    "msh", "$MeshFormat\n3 0 8\n$EndMeshFormat\n", wording("version-3-00-of-the-format-cannot"));
  const std::string old = "$NOD\n2\n1 0 0 0\n2 1 0 0\n$ENDNOD\n$ELM\n1\n1 1 0 0 ";
  expect("msh", "$NOD\n2\n1 0 0 0\n2 1 0 0\n$EndNOD\n", wording("bad-msh-5-expected-endnod"));
  expect("msh", old + "3 1 2 2\n$ENDELM\n", wording("bad-msh-8-an-element-of-type"));
  expect("msh", old + "2 1 3\n$ENDELM\n", wording("bad-msh-8-an-element-uses-node"));
  expect("msh", old + "2 1\n$ENDELM\n", wording("bad-msh-8-expected-a-whole-number"));
  expect("msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n1 2\n1 2 0 1\n1 0 0 0\n$EndNodes\n",
    wording("the-blocks-have-1-nodes-the-header"));
  expect("msh", format + "$PhysicalNames\n1\n7 5 \"a\"\n", wording("bad-msh-6-dimension-is-7"));
  expect("msh", format + "$Nodes\n1 2 1 2\n2 1 0 1\n1\n0 0 0\n$EndNodes\n",
    wording("the-blocks-have-1-nodes-the-header"));
  expect("msh", format + "$Nodes\n1 2 1 2\n2 1 0 2\n1\n1\n0 0 0\n0 0 0\n$EndNodes\n",
    wording("node-number-1-is-given-twice"));
  expect("msh",
    format +
      "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n1 1 1 1\n1 1 "
      "2\n$EndElements\n",
    wording("bad-msh-12-an-element-uses-node"));
  expect("msh",
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 94 0 "
    "1\n$EndElements\n",
    wording("bad-msh-10-an-element-of-type"));
  expect("msh",
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$ElementData\n1\n\"a\"\n"
    "0\n3\n0\n1\n0\n$EndElementData\n$Elements\n1\n1 15 0 1\n$EndElements\n",
    wording("bad-msh-8-elementdata-comes-before-elements"));
  expect("msh", "$MeshFormat\n2.2 1 8\n\1", wording("the-file-ends-before-the-byte-order"));
  expect("msh", "1 2\n", wording("this-is-no-msh-file"));
  expect("msh", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n1 2 9 0\n", wording("bad-msh-5-vertex-is-9-from"));

  expect("off", "PLY\n", wording("expected-off-coff-noff-or-cnoff-found"));
  expect("off", "OFF BINARY\n", wording("binary-off-files-cannot-be-read"));
  expect(
    "off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", wording("bad-off-6-vertex-is-3-from"));
  expect(
    "off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", wording("bad-off-7-the-file-ends-before"));
  expect("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 300 0 0\n", wording("a-colour-is-300"));
  expect("off", "OFF\n3 1000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    wording("more-than-the-rest-of-the-file"));
}

/// CRLF, a byte order mark, comments and blank lines change nothing.
TAUTLINE_PART(testHarmlessForms)
{
  for (const char* name :
    { "cube.smesh", "zoo.mesh", "house.off", "plate.poly", "tent.msh", "part.msh" })
  {
    const std::string text = readText(data + "/" + name);
    std::string changed = "\xef\xbb\xbf";
    for (const char c : text)
    {
      changed += c == '\n' ? "\r\n" : std::string(1, c);
    }
    const std::string copy = output + "/crlf." + splitExtension(name).second;
    writeText(copy, changed);
    if (std::string(name) == "zoo.mesh")
    {
      writeText(output + "/crlf.sol", readText(data + "/zoo.sol"));
    }
    TAUTLINE_CHECK(same(readByName(data + "/" + name, true), readByName(copy, true)));
  }
}

/// The parts of two writes, as a process leaves them that is killed between two renames.
TAUTLINE_PART(testMixedSets)
{
  MeshFile mesh;
  mesh.points = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  mesh.addCells(FileTetrahedron, { 0, 1, 2, 3 });
  mesh.addCells(FileTriangle, { 0, 1, 2 });
  mesh.addCells(FileLine, { 0, 1 });
  mesh.pointArrays.push_back({ "t", 1, MeshArray::Doubles{ 1, 2, 3, 4 } });
  MeshFile moved = mesh; // the same counts
  moved.points[0] = -1;
  for (const std::vector<std::string>& endings :
    { std::vector<std::string>{ "node", "ele", "face", "edge" }, { "mesh", "sol" } })
  {
    const std::string older = output + "/older." + endings[0], mixed = output + "/mixed.";
    const bool medit = endings[0] == "mesh";
    medit ? writeMedit(mesh, older) : writeTetGen(mesh, older);
    for (const std::string& ending : endings)
    {
      const Context context(ending);
      medit ? writeMedit(moved, mixed + "mesh") : writeTetGen(moved, mixed + "node");
      TAUTLINE_CHECK_EQUAL(complaint(mixed + endings[0]), std::string());
      const std::string whole = readText(output + "/older." + ending);
      writeText(mixed + ending, whole);
      const std::string message = complaint(mixed + endings[0]);
      TAUTLINE_CHECK(contains(message, "does not belong to " + mixed));
      // Without its mark, as other programs write it, the file is taken.
      writeText(mixed + ending, whole.substr(0, whole.rfind(wording("tautline-set"))));
      TAUTLINE_CHECK_EQUAL(complaint(mixed + endings[0]), std::string());
    }
  }
}
}

TAUTLINE_TEST(TestMalformedFiles)
{
  data = argv[1];
  output = std::string(argv[2]) + "/malformed";
  const std::string makeFolder = "mkdir -p '" + output + "'";
  TAUTLINE_CHECK(std::system(makeFolder.c_str()) == 0);
}
