// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFoamPointsWriter.h"

#include "ArrayIndex.h"
#include "FileNames.h"
#include "FoamCase.h"
#include "FoamFileAdapter.h"
#include "FoamPoints.h"
#include "TextOutput.h"
#include "VtkCompatibility.h"
#include "tautline/Core/Interruption.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <filesystem>

vtkStandardNewMacro(vtkFoamPointsWriter);

namespace
{
namespace fs = std::filesystem;

bool isFolder(const std::string& name)
{
  std::error_code error;
  return fs::is_directory(name, error);
}

std::string parentOf(const std::string& name)
{
  return fs::absolute(name).parent_path().string();
}

/// The directories in the array FoamCase; empty if it is missing.
std::vector<std::string> foldersOf(vtkDataObject* mesh)
{
  std::vector<std::string> folders;
  auto* names = mesh
    ? vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray(tautline::FoamCaseArray))
    : nullptr;
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    folders.push_back(names->GetValue(i));
  }
  return folders;
}

/// Throws unless the first cells of a mesh equal the cells of the case, in any order of their
/// points.
void checkCells(vtkDataSet* mesh, const tautline::FoamCells& cells, const std::string& name)
{
  const auto count = static_cast<vtkIdType>(cells.types.size());
  const auto refuse = [&name](const std::string& difference)
  {
    throw tautline::Error(
      name + ": the mesh does not belong to the case, or the case has changed: " + difference);
  };
  if (mesh->GetNumberOfCells() < count)
  {
    refuse("it has " + std::to_string(mesh->GetNumberOfCells()) + " cells, but the case has " +
      std::to_string(count));
  }
  vtkNew<vtkIdList> scratch;
  std::vector<vtkIdType> found, expected;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    tautline::pollInterruption(cell);
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    tautline::cellPoints(mesh, cell, size, ids, scratch);
    found.assign(ids, ids + size);
    expected.assign(cells.connectivity.begin() + cells.offsets[tautline::at(cell)],
      cells.connectivity.begin() + cells.offsets[tautline::at(cell) + 1]);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    if (found != expected)
    {
      refuse("cell " + std::to_string(cell) + " has different points");
    }
  }
}

/// The coordinates of a mesh; the file's coordinates if they are equal in the mesh's precision.
std::vector<double> coordinates(vtkDataSet* mesh, const std::vector<double>& inFile)
{
  std::vector<double> points(inFile.size());
  auto* set = vtkPointSet::SafeDownCast(mesh);
  const bool single = set && set->GetPoints()->GetDataType() == VTK_FLOAT;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    tautline::pollInterruption(i);
    double* point = points.data() + 3 * i;
    mesh->GetPoint(i, point);
    for (int axis = 0; single && axis < 3; ++axis)
    {
      const double old = inFile[tautline::at(3 * i + axis)];
      point[axis] = static_cast<double>(static_cast<float>(old)) == point[axis] ? old : point[axis];
    }
  }
  return points;
}
}

//------------------------------------------------------------------------------
std::string vtkFoamPointsWriter::TargetName()
{
  const std::vector<std::string> folders = foldersOf(this->GetInput());
  if (this->FileName && this->FileName[0])
  {
    return this->FileName;
  }
  if (folders.empty())
  {
    throw tautline::Error(
      "no file name, and the mesh has no field array FoamCase: give the .foam file of the case");
  }
  return folders[0];
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkFoamPointsWriter::MeshFolders(vtkDataSet* mesh) const
{
  std::vector<std::string> folders = foldersOf(mesh);
  if (!this->FileName || !this->FileName[0])
  {
    return folders;
  }
  // a new marker of a case is made by WriteDataSet()
  tautline::FoamRequest request;
  request.name = tautline::fileExists(this->FileName) || isFolder(this->FileName)
    ? this->FileName
    : parentOf(this->FileName);
  if (folders.empty() || !tautline::splitFoamPath(folders[0]).constant)
  {
    return tautline::locateFoamCase(request).folders;
  }
  const std::string folder = tautline::foamCaseFolder(request.name);
  for (std::string& each : folders)
  {
    each = folder + "/" + tautline::splitFoamPath(each).inside;
  }
  return folders;
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkFoamPointsWriter::WriteDataSet(
  vtkDataSet* mesh, const std::string& name)
{
  this->Rounding = 0.0;
  const std::vector<std::string> folders = this->MeshFolders(mesh);
  const auto moving = tautline::movingFoamMeshes(tautline::splitFoamPath(folders.at(0)));
  if (!moving.empty())
  {
    throw tautline::Error(name + ": the mesh of the case moves: it has " + moving[0] +
      ", whose points are used from that time on; delete it, or write to that directory");
  }
  const tautline::FoamPiece whole = tautline::readFoamFolders(folders);
  if (mesh->GetNumberOfPoints() != whole.mesh.numberOfPoints())
  {
    throw tautline::Error(name + ": the mesh has " + std::to_string(mesh->GetNumberOfPoints()) +
      " points, but the case has " + std::to_string(whole.mesh.numberOfPoints()) +
      ": it is not the mesh of the case, or the case has changed");
  }
  checkCells(mesh, whole.cells, name);
  std::vector<std::string> files = tautline::writeFoamPoints(folders, whole.pointNumbers,
    coordinates(mesh, whole.mesh.points), this->KeepOriginal, &this->Rounding);
  if (this->FileName && this->FileName[0] && !fs::exists(this->FileName))
  {
    tautline::TextOutput(this->FileName).close();
    files.emplace_back(this->FileName);
  }
  return files;
}

//------------------------------------------------------------------------------
void vtkFoamPointsWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "KeepOriginal: " << this->KeepOriginal << "\n";
}
