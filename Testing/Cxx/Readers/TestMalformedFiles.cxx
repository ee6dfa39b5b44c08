// SPDX-License-Identifier: BSD-3-Clause
// Malformed files: the message names file, line and problem. Sets with files of two writes are
// refused. (Mutations of samples: TestFuzzTargets.)

#include "MeshFileChecks.h"

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
  if (said.find(problem) == std::string::npos || said.find(output) != 0)
  {
    std::cerr << "of\n"
              << text.substr(0, 200) << "\nmessage: " << said << "\nnot: " << problem << "\n";
    TAUTLINE_CHECK(!"message");
  }
}

void testTetGenMessages()
{
  const std::string good = "4 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n3 0 1 0 1\n4 0 0 1 1\n";
  expect("node", "", "bad.node:1: no header");
  expect(
    "node", "4 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n", "bad.node:1: number of vertices is 4, more than");
  expect("node", "4 3 0 0\n1 0 0 0.00\n2 1 0 0.00\n3 1 0 0.0000000\n",
    "bad.node:5: the file ends before vertex 4");
  expect("node", "2 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 1\n",
    "bad.node:4: the file continues after the last vertex");
  expect(
    "node", "2 3 0 0\n1 0 nan 0\n2 1 0 0\n", "bad.node:2: coordinate is not a finite number: nan");
  expect("node", "2 3 0 0\n1 0 0 1e999\n2 1 0 0\n",
    "bad.node:2: coordinate is not a finite number: 1e999");
  expect("node", "2 3 0 0\n1 0 0\n2 1 0 0 0\n",
    "bad.node:2: expected a number (coordinate), the line ends");
  expect("node", "2 3 0 0\n1 0 0 0,5\n2 1 0 0\n",
    "bad.node:2: expected a number (coordinate), found '0,5'");
  expect(
    "node", "2 3 0 0\n1 0 0 0 9\n2 1 0 0\n", "bad.node:2: the line has more than it should: '9'");
  expect("node", "2 3 0 0\n1 0 0 0\n5 1 0 0\n", "bad.node:3: expected vertex 2, found number 5");
  expect("node", "-2 3 0 0\n", "bad.node:1: number of vertices is -2");
  expect("node", "9000000000000000000 3 0 0\n1 0 0 0\n", "more than the rest of the file can hold");
  expect("node", "99999999999999999999 3 0 0\n", "expected a whole number (number of vertices)");
  expect("node", "2 4 0 0\n", "bad.node:1: dimension is 4, from 2 to 3 are allowed");
  expect("node",
    std::string("\x7f"
                "ELF\x02\x01\x00",
      7),
    "expected a whole number (number of vertices), found '\\x7fELF");
  std::remove((output + "/bad.node").c_str());
  expect("ele", "1 4 0\n1 1 2 3 4\n", "bad.node: cannot be opened (the vertices of");
  writeText(output + "/bad.node", good);
  expect("ele", "1 4 0\n1 1 2 3 5\n", "bad.ele:2: vertex is 5, from 1 to 4 are allowed");
  expect("ele", "1 4 0\n1 1 2 3 -4\n", "bad.ele:2: vertex is -4");
  expect("ele", "1 5 0\n1 1 2 3 4 4\n", "bad.ele:1: elements with 5 nodes in 3D");
  expect("ele", "2 4 0\n1 1 2 3 4\n2 1 2 3  \n    ",
    "bad.ele:3: expected a whole number (vertex), the line ends");
  std::remove((output + "/bad.ele").c_str());
  expect(
    "face", "1 1\n1 1 2         \n", "bad.face:2: expected a whole number (vertex), the line ends");
  std::remove((output + "/bad.face").c_str());
  expect("smesh", good + "1 0\n4 1 2 3\n", "the file ends inside a polygon");
  expect("smesh", good + "1 0\n0\n", "number of corners is 0");
  expect("poly", good + "1 0\n1 0\n99999999 1 2\n", "number of corners is 99999999, more than");
  std::remove((output + "/bad.node").c_str());
  expect("poly", "0 3 0 0\n1 0\n1\n3 1 2 3\n0\n", "bad.node: cannot be opened");
  TAUTLINE_CHECK(complaint(output).find("is expected as the file's ending") != std::string::npos);
}

void testOtherMessages()
{
  const std::string mesh = "MeshVersionFormatted 2\nDimension 2\nVertices 3\n0 0 1\n1 0 1\n0 1 1\n";
  expect("mesh", mesh, "bad.mesh:7: the file ends without the keyword End");
  expect("mesh", mesh + "Triangles\n1\n1 2 4 0\nEnd\n",
    "bad.mesh:9: vertex is 4, from 1 to 3 are allowed");
  expect("mesh", mesh + "Triangles\n-1\nEnd\n", "bad.mesh:8: number of Triangles is negative: -1");
  expect("mesh", mesh + "Triangles\n77777777777\nEnd\n", "more than the rest of the file can hold");
  expect("mesh", mesh + "Corners\n1\n4\nEnd\n", "Corner: number 4 is out of range");
  expect("mesh", mesh + "1 1 1\nEnd\n", "bad.mesh:7: expected the name of a section, found '1'");
  expect("mesh", "solid stl\n", "bad.mesh:1: expected MeshVersionFormatted");
  expect("mesh", "MFEM mesh v1.0\n\ndimension\n2\n", "bad.mesh:1: this is a mesh of MFEM");
  writeText(output + "/bad.mesh", mesh + "End\n");
  expect("sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n2\n1 1\n1\n2\nEnd\n",
    "SolAtVertices has 2 values, the mesh has 3");
  expect("sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 4\n1\n2\n3\nEnd\n",
    "bad.sol:5: type of a field is 4");
  std::remove((output + "/bad.sol").c_str());

  const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  expect("msh", format, "the file ends without $Nodes");
  expect(
    "msh", "$MeshFormat\n3 0 8\n$EndMeshFormat\n", "version 3.00 of the format cannot be read");
  const std::string old = "$NOD\n2\n1 0 0 0\n2 1 0 0\n$ENDNOD\n$ELM\n1\n1 1 0 0 ";
  expect("msh", "$NOD\n2\n1 0 0 0\n2 1 0 0\n$EndNOD\n", "bad.msh:5: expected $ENDNOD");
  expect("msh", old + "3 1 2 2\n$ENDELM\n", "bad.msh:8: an element of type 1 with 3 nodes");
  expect("msh", old + "2 1 3\n$ENDELM\n", "bad.msh:8: an element uses node 3");
  expect("msh", old + "2 1\n$ENDELM\n", "bad.msh:8: expected a whole number (node)");
  expect("msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n1 2\n1 2 0 1\n1 0 0 0\n$EndNodes\n",
    "the blocks have 1 nodes, the header of $Nodes announces 2");
  expect("msh", format + "$PhysicalNames\n1\n7 5 \"a\"\n", "bad.msh:6: dimension is 7");
  expect("msh", format + "$Nodes\n1 2 1 2\n2 1 0 1\n1\n0 0 0\n$EndNodes\n",
    "the blocks have 1 nodes, the header of $Nodes announces 2");
  expect("msh", format + "$Nodes\n1 2 1 2\n2 1 0 2\n1\n1\n0 0 0\n0 0 0\n$EndNodes\n",
    "node number 1 is given twice");
  expect("msh",
    format +
      "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n1 1 1 1\n1 1 "
      "2\n$EndElements\n",
    "bad.msh:12: an element uses node 2, which is not in $Nodes");
  expect("msh",
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 94 0 "
    "1\n$EndElements\n",
    "bad.msh:10: an element of type 94");
  expect("msh",
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$ElementData\n1\n\"a\"\n"
    "0\n3\n0\n1\n0\n$EndElementData\n$Elements\n1\n1 15 0 1\n$EndElements\n",
    "bad.msh:8: $ElementData comes before $Elements: move it behind that section");
  expect("msh", "$MeshFormat\n2.2 1 8\n\1", "the file ends before the byte order");
  expect("msh", "1 2\n", "this is no .msh file");
  expect("msh", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n1 2 9 0\n",
    "bad.msh:5: vertex is 9, from 1 to 3 are allowed");

  expect("off", "PLY\n", "expected OFF, COFF, NOFF or CNOFF, found 'PLY'");
  expect("off", "OFF BINARY\n", "binary OFF files cannot be read");
  expect("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
    "bad.off:6: vertex is 3, from 0 to 2 are allowed");
  expect(
    "off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "bad.off:7: the file ends before face 1");
  expect("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 300 0 0\n", "a colour is 300");
  expect("off", "OFF\n3 1000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "more than the rest of the file can hold");
}

/// CRLF, a byte order mark, comments and blank lines change nothing.
void testHarmlessForms()
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
void testMixedSets()
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
      TAUTLINE_CHECK(message.find("does not belong to " + mixed) != std::string::npos);
      // Without its mark, as other programs write it, the file is taken.
      writeText(mixed + ending, whole.substr(0, whole.rfind("# Tautline set")));
      TAUTLINE_CHECK_EQUAL(complaint(mixed + endings[0]), std::string());
    }
  }
}
}

int TestMalformedFiles(int, char* argv[])
{
  data = argv[1];
  output = std::string(argv[2]) + "/malformed";
  const std::string makeFolder = "mkdir -p '" + output + "'";
  TAUTLINE_CHECK(std::system(makeFolder.c_str()) == 0);
  testTetGenMessages();
  testOtherMessages();
  testHarmlessForms();
  testMixedSets();
  return exitCode();
}
