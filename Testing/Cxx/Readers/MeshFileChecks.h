// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFileChecks.h
 * @brief What the tests of readers and writers share: files from text, comparison of meshes.
 */

#ifndef tautline_MeshFileChecks_h
#define tautline_MeshFileChecks_h

#include "Check.h"
#include "FileNames.h"
#include "GmshFile.h"
#include "MeditFile.h"
#include "OffFile.h"
#include "TetGenFile.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace tautline
{

inline void writeText(const std::string& name, const std::string& text)
{
  std::ofstream(name, std::ios::binary) << text;
}

inline std::string readText(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/** Reads by the name's ending; throws what the reader throws. */
inline MeshFile readByName(const std::string& name, bool lowerCells)
{
  const std::string extension = splitExtension(name).second;
  if (extension == "mesh" || extension == "meshb" || extension == "sol")
  {
    return readMedit(name, lowerCells);
  }
  if (extension == "msh")
  {
    return readGmsh(name, lowerCells);
  }
  return extension == "off" ? readOff(name, lowerCells) : readTetGen(name, lowerCells);
}

/** Bitwise equality of doubles, so that NaN equals itself and -0 is not 0. */
inline bool same(const std::vector<double>& a, const std::vector<double>& b)
{
  return a.size() == b.size() &&
    (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/** Whether all arrays of `a` are in `b`, with the same values. */
inline bool contains(const std::vector<MeshArray>& b, const std::vector<MeshArray>& a)
{
  for (const MeshArray& array : a)
  {
    const MeshArray* other = findArray(b, array.name);
    if (!other || other->components != array.components || other->code() != array.code())
    {
      std::cerr << "array " << array.name << " differs\n";
      return false;
    }
    const auto* doubles = std::get_if<MeshArray::Doubles>(&array.values);
    const bool equal = doubles ? same(*doubles, std::get<MeshArray::Doubles>(other->values))
                               : array.values == other->values;
    if (!equal)
    {
      std::cerr << "values of " << array.name << " differ\n";
      return false;
    }
  }
  return true;
}

inline bool same(const std::vector<MeshArray>& a, const std::vector<MeshArray>& b)
{
  return a.size() == b.size() && contains(b, a);
}

/** Everything equal, arrays in any order. */
inline bool same(const MeshFile& a, const MeshFile& b)
{
  return same(a.points, b.points) && a.cellTypes == b.cellTypes && a.offsets == b.offsets &&
    a.connectivity == b.connectivity && same(a.pointArrays, b.pointArrays) &&
    same(a.cellArrays, b.cellArrays) && same(a.fieldArrays, b.fieldArrays) &&
    a.fieldStrings.size() == b.fieldStrings.size();
}

/** The error message of a reader for a file; empty if there is none. */
inline std::string complaint(const std::string& name, bool lowerCells = true)
{
  try
  {
    readByName(name, lowerCells);
  }
  catch (const FileError& error)
  {
    return error.what();
  }
  return {};
}

inline Index countCells(const MeshFile& mesh, unsigned char type)
{
  Index count = 0;
  for (const unsigned char each : mesh.cellTypes)
  {
    count += each == type;
  }
  return count;
}

} // namespace tautline

#endif
