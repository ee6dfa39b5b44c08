// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeAdapter.h
 * @brief Between VTK's images and meshes and the kernel's silhouettes and polygons. Not installed.
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
/// One slice of grey values. Pixel coordinates become places in space with toSpace().
class GreyImage
{
public:
  /**
   * @brief Takes the grey values of a planar image.
   *
   * Colours become their luminance. Of an image with an alpha channel that is not constant, the
   * alpha is taken: what is transparent is not the shape. Throws Error on volumes, on pixels that
   * are not square, without an array.
   * @param array the values; null: the active point scalars, the first point array, or the same of
   * the cells
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
  double Shift = 0; ///< of a pixel's centre from the grid point of its number, in pixels
};

/// The polygon of a source mesh, and the point of the input each vertex was.
struct SourceMesh
{
  ShapeSource source;
  std::vector<Index> pointIds;
};

/// The boundary polygon of a planar mesh of triangles without interior points.
SourceMesh takeSourceMesh(vtkDataSet* mesh);

/// Triangles of a polygon at places in space.
void fillGrid(vtkUnstructuredGrid* grid, const PolygonMesh& mesh, const std::vector<Vec2>& points,
  const GreyImage& image);

/// Point and cell arrays with the order of vertices along the boundary and of elimination.
void addOrders(vtkUnstructuredGrid* grid, const PolygonMesh& mesh);
}
#endif
