// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamSamples.h
 * @brief Small meshes of OpenFOAM, written in all forms of its files.
 */

#ifndef tautline_FoamSamples_h
#define tautline_FoamSamples_h

#include "Readers/MeshFileChecks.h"

#include <algorithm>
#include <filesystem>
#include <map>

namespace tautline
{

/** How the files of a mesh are written. */
struct FoamForm
{
  bool binary = false;
  bool compact = false;    ///< faces as faceCompactList
  bool compressed = false; ///< by gzip
  bool swapped = false;    ///< bytes in the order of other machines
  int labelBytes = 4;
  int scalarBytes = 8;
};

using FoamRows = std::vector<std::vector<Index>>;

/** A mesh; `boundary` is the list of its patches, `others` are the contents of further files. */
struct FoamSample
{
  std::vector<double> points;
  FoamRows faces;
  std::vector<Index> owner, neighbor;
  std::string boundary;
  std::map<std::string, std::string> others;
};

/** The content of the files of a mesh. */
class FoamFormatter
{
public:
  explicit FoamFormatter(const FoamForm& form)
    : Form(form)
  {
  }

  std::string header(const std::string& type) const
  {
    const std::string bits = "label=" + std::to_string(8 * this->Form.labelBytes) +
      ";scalar=" + std::to_string(8 * this->Form.scalarBytes);
    return "/* header */ FoamFile\n{\n  version 2.0;\n  format " +
      std::string(this->Form.binary ? "binary" : "ascii") + ";\n  arch \"" +
      (this->Form.swapped ? "MSB" : "LSB") + ";" + bits + "\";\n  class " + type +
      ";\n}\n// * * * //\n";
  }

  std::string labels(const std::vector<Index>& values) const
  {
    std::string text = std::to_string(values.size()) + "\n(";
    for (const Index value : values)
    {
      text += this->Form.binary ? this->label(value) : "\n" + std::to_string(value);
    }
    return text + ")\n";
  }

  std::string points(const std::vector<double>& values) const
  {
    std::string text = std::to_string(values.size() / 3) + "\n(";
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      std::ostringstream number;
      number << std::setprecision(17) << values[i];
      const char* const around[] = { "\n(", " ", " " };
      text += this->Form.binary ? this->scalar(values[i]) : around[i % 3] + number.str();
      text += !this->Form.binary && i % 3 == 2 ? ")" : "";
    }
    return text + ")\n";
  }

  std::string faces(const FoamRows& rows) const
  {
    std::vector<Index> starts = { 0 }, all;
    std::string text = std::to_string(rows.size()) + "\n(\n";
    for (const std::vector<Index>& row : rows)
    {
      all.insert(all.end(), row.begin(), row.end());
      starts.push_back(static_cast<Index>(all.size()));
      text += this->labels(row);
    }
    return this->Form.compact ? this->labels(starts) + this->labels(all) : text + ")\n";
  }

private:
  template <class T>
  std::string bytes(T value) const
  {
    std::string text(reinterpret_cast<const char*>(&value), sizeof(T));
    if (this->Form.swapped)
    {
      std::reverse(text.begin(), text.end());
    }
    return text;
  }
  std::string label(Index value) const
  {
    return this->Form.labelBytes == 8 ? this->bytes(value)
                                      : this->bytes(static_cast<std::int32_t>(value));
  }
  std::string scalar(double value) const
  {
    return this->Form.scalarBytes == 8 ? this->bytes(value)
                                       : this->bytes(static_cast<float>(value));
  }

  FoamForm Form;
};

/** Writes the files into a new directory and returns its name. */
inline std::string writeFoam(
  const std::string& folder, const FoamSample& sample, const FoamForm& form = FoamForm())
{
  const FoamFormatter format(form);
  std::map<std::string, std::string> files = sample.others;
  files["points"] = format.header("vectorField") + format.points(sample.points);
  files["faces"] =
    format.header(form.compact ? "faceCompactList" : "faceList") + format.faces(sample.faces);
  files["owner"] = format.header("labelList") + format.labels(sample.owner);
  files["neighbour"] = format.header("labelList") + format.labels(sample.neighbor);
  files["boundary"] = format.header("polyBoundaryMesh") + sample.boundary;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (const auto& [name, content] : files)
  {
    writeText(folder + "/" + name, content);
    if (form.compressed)
    {
      TAUTLINE_CHECK_EQUAL(std::system(("gzip '" + folder + "/" + name + "'").c_str()), 0);
    }
  }
  return folder;
}

/** Four faces around the unit cube; with the bottom and the top they are its six. */
inline const FoamRows CubeSides = { { 0, 1, 5, 4 }, { 1, 3, 7, 5 }, { 3, 2, 6, 7 },
  { 2, 0, 4, 6 } };
inline const std::vector<Index> CubeBottom = { 0, 2, 3, 1 }, CubeTop = { 4, 5, 7, 6 };

inline FoamRows operator+(FoamRows a, const FoamRows& b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/** Points x y z with x and y of 0 and 1, and z from `low` to `high`. */
inline std::vector<double> towerPoints(int low, int high)
{
  std::vector<double> points;
  for (int z = low; z <= high; ++z)
  {
    for (int i = 0; i < 4; ++i)
    {
      points.insert(points.end(), { double(i % 2), double(i / 2), double(z) });
    }
  }
  return points;
}

/** Two cubes one above the other: a cyclic pair of bottom and top, and walls. */
inline FoamSample twoCubes()
{
  FoamRows upper = CubeSides;
  for (std::vector<Index>& side : upper)
  {
    std::for_each(side.begin(), side.end(), [](Index& point) { point += 4; });
  }
  return { towerPoints(0, 2), FoamRows{ CubeTop, CubeBottom, { 8, 9, 11, 10 } } + CubeSides + upper,
    { 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1 }, { 1 },
    "3\n(\n  low { type cyclic; neighbourPatch high; nFaces 1; startFace 1; }\n"
    "  high { type cyclic; neighbourPatch low; nFaces 1; startFace 2; matchTolerance 1e-4; }\n"
    "  sides\n  {\n    type wall;\n    inGroups 1(wall);\n    nFaces 8;\n    startFace 3;\n  "
    "}\n)\n",
    {} };
}

/** The lower (0) or the upper (1) of the two cubes, with a patch to the other one. */
inline FoamSample halfOfTwoCubes(int part)
{
  const std::string own = std::to_string(part), other = std::to_string(1 - part);
  const FoamRows faces = part == 0 ? FoamRows{ CubeBottom } + CubeSides + FoamRows{ CubeTop }
                                   : FoamRows{ CubeTop } + CubeSides + FoamRows{ CubeBottom };
  const std::string cyclic = part == 0 ? "low { type cyclic; neighbourPatch high; nFaces 1; "
                                         "startFace 0; } high { type cyclic; neighbourPatch low; "
                                         "nFaces 0; startFace 0; }"
                                       : "low { type cyclic; neighbourPatch high; nFaces 0; "
                                         "startFace 0; } high { type cyclic; neighbourPatch low; "
                                         "nFaces 1; startFace 0; }";
  FoamSample sample{ towerPoints(part, part + 1), faces, std::vector<Index>(6, 0), {},
    "4 ( " + cyclic + " sides { type wall; nFaces 4; startFace 1; }\n procBoundary" + own + "to" +
      other + " { type processor; nFaces 1; startFace 5; myProcNo " + own + "; neighbProcNo " +
      other + "; } )\n",
    {} };
  return sample;
}

/** The same with the lists by which decomposePar refers to the two cubes. */
inline FoamSample addressedHalf(int part)
{
  FoamSample sample = halfOfTwoCubes(part);
  const FoamFormatter format{ FoamForm() };
  const std::vector<Index> points = part == 0 ? std::vector<Index>{ 0, 1, 2, 3, 4, 5, 6, 7 }
                                              : std::vector<Index>{ 4, 5, 6, 7, 8, 9, 10, 11 };
  const std::vector<Index> faces =
    part == 0 ? std::vector<Index>{ 2, 4, 5, 6, 7, 1 } : std::vector<Index>{ 3, 8, 9, 10, 11, -1 };
  const auto list = [&](const char* name, const std::vector<Index>& values)
  { sample.others[name] = format.header("labelList") + format.labels(values); };
  list("pointProcAddressing", points);
  list("cellProcAddressing", { part });
  list("faceProcAddressing", faces);
  list("boundaryProcAddressing", { 0, 1, 2, -1 });
  return sample;
}

/** One cell with these faces, all of them on one patch. */
inline FoamSample oneCell(const std::vector<double>& points, const FoamRows& faces)
{
  const std::string size = std::to_string(faces.size());
  return { points, faces, std::vector<Index>(faces.size(), 0), {},
    "1(all { type patch; nFaces " + size + "; startFace 0; })", {} };
}

inline FoamSample oneTetrahedron()
{
  return oneCell(
    { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } });
}

} // namespace tautline

#endif
