// SPDX-License-Identifier: BSD-3-Clause
#include "BlockSeams.h"

#include "Blocks.h"
#include "MeshAdapter.h"
#include "PointMerge.h"

#include "vtkBoundingBox.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace tautline
{
namespace
{
/// Whether the bounding boxes of two data sets intersect.
std::vector<char> meetingOthers(const std::vector<vtkDataSet*>& data)
{
  std::vector<vtkBoundingBox> boxes;
  for (vtkDataSet* one : data)
  {
    double bounds[6];
    one->GetBounds(bounds);
    boxes.emplace_back(bounds);
  }
  std::vector<char> meets(data.size(), 0);
  for (std::size_t a = 0; a < boxes.size(); ++a)
  {
    for (std::size_t b = 0; b < a; ++b)
    {
      if (boxes[a].IsValid() && boxes[b].IsValid() && boxes[a].Intersects(boxes[b]))
      {
        meets[a] = meets[b] = 1;
      }
    }
  }
  return meets;
}

/// Joins several meshes into one without merging points.
struct Appended
{
  std::vector<double> points;
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 };
  std::vector<Index> connectivity;
  std::vector<unsigned char> reversed; ///< per cell: whether all cells of its mesh are reversed

  void add(const Mesh& mesh, int threads)
  {
    const MeshView& view = mesh.view();
    std::vector<signed char> validity(view.numberOfCells);
    mesh.classifyCells(validity.data(), threads);
    const bool mirrored = mesh.orientation(validity.data()).state == Orientation::Reversed;
    const auto shift = static_cast<Index>(this->points.size() / 3);
    this->points.insert(this->points.end(), view.points, view.points + 3 * view.numberOfPoints);
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      if (cornerType(view.cellTypes[cell]) == CellType::Unsupported)
      {
        continue;
      }
      this->types.push_back(view.cellTypes[cell]);
      this->reversed.push_back(mirrored);
      for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
      {
        this->connectivity.push_back(view.connectivity[n] + shift);
      }
      this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
    }
  }

  MeshView view() const
  {
    MeshView view;
    view.numberOfPoints = static_cast<Index>(this->points.size() / 3);
    view.points = this->points.data();
    view.numberOfCells = static_cast<Index>(this->types.size());
    view.cellTypes = this->types.data();
    view.offsets = this->offsets.data();
    view.connectivity = this->connectivity.data();
    return view;
  }
};
}

//------------------------------------------------------------------------------
BlockSeams findBlockSeams(
  const std::vector<vtkDataSet*>& data, const std::vector<std::string>& names, int threads)
{
  BlockSeams seams;
  seams.group.resize(data.size());
  std::iota(seams.group.begin(), seams.group.end(), 0);
  const std::vector<char> meets = meetingOthers(data);
  Appended all;
  std::vector<int> blockOf; // per point of `all`
  std::vector<Index> firstOf(data.size(), 0);
  for (std::size_t i = 0; i < data.size(); ++i)
  {
    if (meets[i] && data[i]->GetNumberOfCells() > 0)
    {
      firstOf[i] = static_cast<Index>(blockOf.size());
      blockOf.resize(blockOf.size() + data[i]->GetNumberOfPoints(), static_cast<int>(i));
      all.add(MeshAdapter(data[i], threads).mesh(), threads);
    }
  }
  if (all.types.empty())
  {
    return seams;
  }
  const Mesh mesh(all.view(), threads);
  const CoincidentPoints found = findCoincidentPoints(mesh, all.reversed.data());
  for (std::size_t p = 0; p < found.representative.size(); ++p)
  {
    const int own = blockOf[p], other = blockOf[found.representative[p]];
    if (own == other)
    {
      continue;
    }
    if (seams.points++ == 0)
    {
      const auto id = static_cast<Index>(p) - firstOf[own];
      MeshView of = mesh.view();
      of.points += 3 * firstOf[own];
      seams.first = placeOf(of, id) + (names[own].empty() ? "" : " of " + names[own]);
    }
    const int from = std::max(seams.group[own], seams.group[other]);
    const int to = std::min(seams.group[own], seams.group[other]);
    std::replace(seams.group.begin(), seams.group.end(), from, to);
  }
  return seams;
}

//------------------------------------------------------------------------------
std::string describeBlockSeams(vtkDataObject* input, int threads)
{
  std::vector<vtkDataSet*> data;
  std::vector<std::string> names;
  std::map<unsigned int, BlockPlace> places = blockPlaces(input);
  forEachLeaf(input,
    [&](unsigned int index, vtkDataSet* leaf)
    {
      data.push_back(leaf);
      names.push_back(places[index].name());
    });
  if (data.size() < 2)
  {
    return "";
  }
  const BlockSeams seams = findBlockSeams(data, names, threads);
  return seams.points == 0
    ? ""
    : std::to_string(seams.points) + (seams.points == 1 ? " point" : " points") +
      " of a block coincide with points of another one; the first is " + seams.first +
      ". Each block is a mesh of its own here, and a seam between blocks is a boundary of both: "
      "run "
      "Merge Blocks first to treat them as one mesh.";
}
}
