// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeAdapter.h
 * @brief Converts between VTK's images and meshes and the kernel's silhouettes and polygons. Not
 * installed.
 */
#ifndef tautline_ShapeAdapter_h
#define tautline_ShapeAdapter_h

#include "tautline/Shapes/ShapeMatch.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkImageData;
class vtkUnstructuredGrid;

namespace tautline
{
/// One slice of gray values. toSpace() converts pixel coordinates to positions in space.
class GreyImage
{
public:
  /**
   * @brief Takes the gray values of a planar image.
   *
   * Colors are converted to luminance. If an image has an alpha channel that is not constant, alpha
   * is used: transparent pixels do not belong to the shape. Throws Error for volumes, pixels that
   * are not square, and a missing array.
   * @param array the values; null for the active point scalars, the first point array, or the same
   * for cells
   */
  explicit GreyImage(vtkImageData* image, vtkDataArray* array = nullptr);

  ImageView view() const { return { this->Values.data(), this->Width, this->Height }; }
  void toSpace(const Vec2& pixel, double x[3]) const;
  double pixelSize() const { return this->Size; }

private:
  vtkSmartPointer<vtkImageData> Image;
  std::vector<float> Values;
  Index Width = 0;
  Index Height = 0;
  int AxisU = 0;
  int AxisV = 1;
  double Size = 1;
  double Shift = 0; ///< from the grid point of a pixel to its center, in pixels
};

/// The polygon of a source mesh, and the input point of each vertex.
struct SourceMesh
{
  ShapeSource source;
  std::vector<Index> pointIds;
};

/// The boundary polygon of a planar mesh of triangles without interior points.
SourceMesh takeSourceMesh(vtkDataSet* mesh);

/// Fills a grid with the triangles of a polygon at positions in space.
void fillGrid(vtkUnstructuredGrid* grid, const PolygonMesh& mesh, const std::vector<Vec2>& points,
  const GreyImage& image);

/// Adds point and cell arrays with the order of vertices along the boundary and of elimination.
void addOrders(vtkUnstructuredGrid* grid, const PolygonMesh& mesh);
}
#endif
