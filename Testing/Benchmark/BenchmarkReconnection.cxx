// SPDX-License-Identifier: BSD-3-Clause
// Reconnection of a mesh of tetrahedra and one of triangles, one thread: CPU time per element, the
// worst values, and the number of operations, by preset and boundary.
//
// usage: BenchmarkReconnection FILE.vtk     the mesh, legacy VTK
//        BenchmarkReconnection SIZE         a cube of 6 SIZE^3 tetrahedra with moved points,
//                                    and a square of 200 SIZE^2 triangles

#include "Clocks.h"
#include "KuhnMesh.h"

#include "tautline/Reconnection/Reconnection.h"
#include "tautline/Reconnection/TriangleReconnection.h"

#include "vtkCell.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridReader.h"

#include <cstdio>
#include <cstdlib>
#include <iostream>

using namespace tautline;

namespace
{
struct Case
{
  const char* name;
  ReconnectionPreset preset;
  BoundaryMotion boundary;
  double targetAngle; ///< 0: the preset's
};

/// Points that slide on the flat parts of the boundary move farther: the target is higher.
constexpr double SlidingTarget = 38.8;

constexpr Case cases[] = {
  { "slivers", ReconnectionPreset::RemoveSlivers, BoundaryMotion::Fixed, 0.0 },
  { "swap", ReconnectionPreset::SwapOnly, BoundaryMotion::Fixed, 0.0 },
  { "swap and smooth", ReconnectionPreset::SwapAndSmooth, BoundaryMotion::Fixed, 0.0 },
  { "aggressive", ReconnectionPreset::Aggressive, BoundaryMotion::Fixed, 0.0 },
  { "sliding", ReconnectionPreset::Aggressive, BoundaryMotion::FlatParts, 0.0 },
  { "sliding, high target", ReconnectionPreset::Aggressive, BoundaryMotion::FlatParts,
    SlidingTarget },
};

MeshData readMesh(const char* name)
{
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(name);
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  MeshData data;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    double x[3];
    grid->GetPoint(i, x);
    data.addPoint({ x[0], x[1], x[2] });
  }
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, size, ids);
    data.addCell(grid->GetCellType(c), { ids, ids + size });
  }
  return data;
}

/// The points inside a cube moved at random by up to a fifth of the spacing.
MeshData makeMesh(Index n)
{
  MeshData data = cutIntoTetrahedra(blockMesh(CellType::Hexahedron, n, n, n), n);
  const double side = static_cast<double>(n);
  Random random(1);
  data.transform(
    [&](const Vec3& p)
    {
      const bool inside =
        std::all_of(p.begin(), p.end(), [&](double x) { return x > 0.0 && x < side; });
      const Vec3 d = random.vector(-0.2, 0.2);
      return inside ? p + d : p;
    });
  return data;
}

/// Cases of triangles.
constexpr Case triangleCases[] = {
  { "triangles, slivers", ReconnectionPreset::RemoveSlivers, BoundaryMotion::Fixed, 0.0 },
  { "triangles, swap", ReconnectionPreset::SwapOnly, BoundaryMotion::Fixed, 0.0 },
  { "triangles, swap and smooth", ReconnectionPreset::SwapAndSmooth, BoundaryMotion::Fixed, 0.0 },
  { "triangles", ReconnectionPreset::Aggressive, BoundaryMotion::Fixed, 0.0 },
  { "triangles, sliding", ReconnectionPreset::Aggressive, BoundaryMotion::FlatParts, 0.0 },
};

/// The points inside a square moved at random by up to a third of the spacing.
MeshData makeSheet(Index n)
{
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  const double side = static_cast<double>(n);
  Random random(1);
  data.transform(
    [&](const Vec3& p)
    {
      const bool inside = p[0] > 0.0 && p[0] < side && p[1] > 0.0 && p[1] < side;
      const Vec3 d = random.vector(-0.24, 0.24);
      return inside ? p + Vec3{ d[0], d[1], 0.0 } : p;
    });
  return data;
}

ReconnectionResult improve(const Mesh& mesh, const ReconnectionOptions& options)
{
  return improveConnectivity(mesh, options);
}

ReconnectionResult improve(const Mesh& mesh, const TriangleOptions& options)
{
  return improveTriangles(mesh, options);
}

template <class Options>
void measure(const MeshData& data, const Case& work)
{
  const Mesh mesh(data.view());
  Options options;
  applyPreset(work.preset, options);
  options.boundary = work.boundary;
  options.targetAngle = work.targetAngle > 0.0 ? work.targetAngle : options.targetAngle;
  const double start = processTime();
  const ReconnectionResult result = improve(mesh, options);
  const double seconds = processTime() - start;
  const ReconnectionRecord& last = result.history.back();
  const auto print = [&](const char* what, double value)
  { std::printf("%s: %s\t%.10g\n", work.name, what, value); };
  print("cpu seconds", seconds);
  print("microseconds per element", 1e6 * seconds / static_cast<double>(data.numberOfCells()));
  print("smallest angle", last.smallestAngle);
  print("worst inverse mean ratio", last.worstInverseMeanRatio);
  print("elements", static_cast<double>(last.tetrahedra));
  print("below target", static_cast<double>(last.belowTarget));
  print("edge removals", static_cast<double>(last.edgeRemovals));
  print("face removals", static_cast<double>(last.faceRemovals));
  print("boundary swaps", static_cast<double>(last.boundarySwaps));
  print("contractions", static_cast<double>(last.contractions));
  print("insertions", static_cast<double>(last.insertions));
  print("moves", static_cast<double>(last.moves));
}
}

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "usage: BenchmarkReconnection FILE.vtk|SIZE\n";
    return EXIT_FAILURE;
  }
  try
  {
    const Index size = std::atoll(argv[1]);
    const MeshData data = size > 0 ? makeMesh(size) : readMesh(argv[1]);
    for (const Case& work : cases)
    {
      measure<ReconnectionOptions>(data, work);
    }
    constexpr Index SquaresPerCube = 10;
    const MeshData sheet = makeSheet(SquaresPerCube * size);
    for (const Case& work : triangleCases)
    {
      if (size > 0)
      {
        measure<TriangleOptions>(sheet, work);
      }
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
