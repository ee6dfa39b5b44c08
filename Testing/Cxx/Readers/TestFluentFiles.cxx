// SPDX-License-Identifier: BSD-3-Clause
// Files of Fluent: a cube as text and as bytes; each damaged form is a mesh or an error that names
// the file. (Polyhedra, zones and what is rejected: Testing/Python/test_fluent.py.)

#include "FluentFile.h"
#include "Readers/MeshFileChecks.h"
#include "Registry.h"

#include <array>
#include <random>

using namespace tautline;

namespace
{
std::string output;

using Quad = std::array<std::int32_t, 4>;
/// The faces of the unit cube, whose normals point into it; corner 1 + x + 2 y + 4 z.
constexpr std::array<Quad, 6> Faces = { Quad{ 1, 2, 4, 3 }, Quad{ 5, 7, 8, 6 }, Quad{ 1, 5, 6, 2 },
  Quad{ 3, 4, 8, 7 }, Quad{ 1, 3, 7, 5 }, Quad{ 2, 6, 8, 4 } };

std::string head()
{
  return "(0 \"a cube\")\n(2 3)\n(10 (0 1 8 0 3))\n(12 (0 1 1 0))\n(13 (0 1 6 0))\n"
         "(12 (2 1 1 1 4))\n(39 (3 wall sides)())\n";
}

std::string textCube()
{
  std::ostringstream file;
  file << head() << "(10 (1 1 8 1 3)(\n";
  for (int i = 0; i < 8; ++i)
  {
    file << (i & 1) << " " << (i >> 1 & 1) << " " << (i >> 2) << "\n";
  }
  file << "))\n(13 (3 1 6 3 4)(\n";
  for (const Quad& face : Faces)
  {
    file << face[0] << " " << face[1] << " " << face[2] << " " << face[3] << " 1 0\n";
  }
  file << "))\n";
  return file.str();
}

template <class T>
void append(std::string& bytes, T value)
{
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string binaryCube()
{
  std::string file = head() + "(4 (60 0 0 1 2 4 4 4 8 4 4))\n(3010 (1 1 8 1 3)(";
  for (int i = 0; i < 8; ++i)
  {
    append(file, double(i & 1));
    append(file, double(i >> 1 & 1));
    append(file, double(i >> 2));
  }
  file += ")\nEnd of Binary Section   3010)\n(2013 (3 1 6 3 4)(";
  for (const Quad& face : Faces)
  {
    for (const std::int32_t node : face)
    {
      append(file, node);
    }
    append(file, std::int32_t{ 1 });
    append(file, std::int32_t{ 0 });
  }
  return file + ")\nEnd of Binary Section   2013)\n";
}

FluentMesh readCube(const std::string& text)
{
  writeText(output + "/cube.cas", text);
  return readFluent(output + "/cube.cas");
}

TAUTLINE_PART(testCube)
{
  for (const std::string& text : { textCube(), binaryCube() })
  {
    const FluentMesh read = readCube(text);
    TAUTLINE_CHECK(isFluentFile(output + "/cube.cas"));
    TAUTLINE_CHECK_EQUAL(read.mesh.cells, 1);
    TAUTLINE_CHECK_EQUAL(read.mesh.numberOfPoints(), 8);
    TAUTLINE_CHECK_EQUAL(read.mesh.patches.at(0).size, 6);
    TAUTLINE_CHECK_EQUAL(read.mesh.patches.at(0).name, "sides");
    const FoamCells cells = fluentCells(read.mesh, read.dimension);
    TAUTLINE_CHECK_EQUAL(int(cells.types.at(0)), int(FileHexahedron));
    TAUTLINE_CHECK_EQUAL(cells.connectivity.size(), 8u);
  }
}

TAUTLINE_PART(testDamaged)
{
  constexpr int rounds = 4000;
  std::mt19937 random(11);
  int rejected = 0;
  for (const std::string& text : { textCube(), binaryCube() })
  {
    for (int round = 0; round < rounds; ++round)
    {
      std::string damaged = text;
      for (unsigned k = random() % 3; k < 3; ++k)
      {
        damaged[random() % damaged.size()] =
          round % 2 ? "0123456789abcdef() \"\n"[random() % 21] : static_cast<char>(random());
      }
      if (round % 8 == 0)
      {
        damaged.resize(random() % damaged.size());
      }
      try
      {
        const FluentMesh read = readCube(damaged);
        fluentCells(read.mesh, read.dimension);
      }
      catch (const FileError& error)
      {
        ++rejected;
        TAUTLINE_CHECK(contains(error.what(), "cube.cas"));
      }
      catch (const FoamDefect& defect)
      {
        ++rejected;
        TAUTLINE_CHECK(!defect.problem.empty());
      }
    }
  }
  TAUTLINE_CHECK(rejected > rounds);
}
}

TAUTLINE_TEST(TestFluentFiles)
{
  output = argv[2];
  static_cast<void>(argc);
}
