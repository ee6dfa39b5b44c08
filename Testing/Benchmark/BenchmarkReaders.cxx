// SPDX-License-Identifier: BSD-3-Clause
// Reading a mesh of a million tetrahedra from text, one thread: megabytes per second, and the time
// of ParaView's own reader of legacy ASCII files on the same mesh, divided by Tautline's.
//
// usage: BenchmarkReaders [TETRAHEDRA [DIRECTORY]]

#include "vtkDataSetTriangleFilter.h"
#include "vtkGmshReader.h"
#include "vtkGmshWriter.h"
#include "vtkImageData.h"
#include "vtkMeditReader.h"
#include "vtkMeditWriter.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkTetGenReader.h"
#include "vtkTetGenWriter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridReader.h"
#include "vtkUnstructuredGridWriter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <sys/stat.h>

namespace
{
double megabytes(const std::string& name)
{
  struct stat status;
  return stat(name.c_str(), &status) == 0 ? static_cast<double>(status.st_size) / 1e6 : 0.0;
}

/// Seconds of the fastest of three runs.
template <class Work>
double seconds(const Work& work)
{
  double best = 1e300;
  for (int run = 0; run < 3; ++run)
  {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(
      best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// Tetrahedra of a grid of cubes, with coordinates of full length.
vtkSmartPointer<vtkUnstructuredGrid> makeMesh(int tetrahedra)
{
  const int side = static_cast<int>(std::lround(std::cbrt(tetrahedra / 5.0))) + 1;
  vtkNew<vtkImageData> image;
  image->SetDimensions(side, side, side);
  vtkNew<vtkDataSetTriangleFilter> cut;
  cut->SetInputData(image);
  cut->Update();
  vtkSmartPointer<vtkUnstructuredGrid> mesh = cut->GetOutput();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double x[3];
    mesh->GetPoint(i, x);
    points->InsertNextPoint(x[0] + shift(random), x[1] + shift(random), x[2] + shift(random));
  }
  mesh->SetPoints(points);
  return mesh;
}

/// Writes the mesh, reads it back three times, prints one row of the table.
template <class Writer, class Reader>
void measure(const char* label, vtkUnstructuredGrid* mesh, const std::string& name,
  const std::vector<std::string>& files, double legacy, bool binary = false)
{
  vtkNew<Writer> writer;
  writer->SetInputData(mesh);
  writer->SetFileName(name.c_str());
  if constexpr (std::is_same_v<Writer, vtkGmshWriter>)
  {
    writer->SetBinary(binary);
  }
  const double writing = seconds([&] { writer->Write(); });
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  const double reading = seconds(
    [&]
    {
      reader->Modified();
      reader->Update();
    });
  if (reader->GetOutput()->GetNumberOfCells() != mesh->GetNumberOfCells())
  {
    std::printf("%s: not the mesh that was written\n", label);
    std::exit(EXIT_FAILURE);
  }
  double size = 0.0;
  for (const std::string& file : files)
  {
    size += megabytes(file);
    std::remove(file.c_str());
  }
  std::printf("%-22s %8.1f %9.3f %8.0f %9.1f %10.3f %8.0f\n", label, size, reading, size / reading,
    legacy / reading, writing, size / writing);
}
}

int main(int argc, char* argv[])
{
  const int tetrahedra = argc > 1 ? std::atoi(argv[1]) : 1000000;
  const std::string stem = std::string(argc > 2 ? argv[2] : ".") + "/benchmark-readers";
  const vtkSmartPointer<vtkUnstructuredGrid> mesh = makeMesh(tetrahedra);
  std::printf("%lld tetrahedra, %lld points\n", static_cast<long long>(mesh->GetNumberOfCells()),
    static_cast<long long>(mesh->GetNumberOfPoints()));
  std::printf("%-22s %8s %9s %8s %9s %10s %8s\n", "format", "MB", "read [s]", "MB/s", "legacy/it",
    "write [s]", "MB/s");

  const std::string vtk = stem + ".vtk";
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileName(vtk.c_str());
  writer->SetFileTypeToASCII();
  const double writing = seconds([&] { writer->Write(); });
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(vtk.c_str());
  const double legacy = seconds(
    [&]
    {
      reader->Modified();
      reader->Update();
    });
  const double size = megabytes(vtk);
  std::remove(vtk.c_str());
  std::printf("%-22s %8.1f %9.3f %8.0f %9.1f %10.3f %8.0f\n", "ParaView legacy ASCII", size, legacy,
    size / legacy, 1.0, writing, size / writing);

  measure<vtkTetGenWriter, vtkTetGenReader>(
    "TetGen .node .ele", mesh, stem + ".node", { stem + ".node", stem + ".ele" }, legacy);
  measure<vtkMeditWriter, vtkMeditReader>(
    "Medit .mesh", mesh, stem + ".mesh", { stem + ".mesh" }, legacy);
  measure<vtkGmshWriter, vtkGmshReader>(
    "Gmsh 4.1 .msh", mesh, stem + ".msh", { stem + ".msh" }, legacy);
  measure<vtkGmshWriter, vtkGmshReader>(
    "Gmsh 4.1 binary .msh", mesh, stem + ".msh", { stem + ".msh" }, legacy, true);
  return EXIT_SUCCESS;
}
