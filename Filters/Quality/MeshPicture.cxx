// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPicture.h"

#include "tautline/Mesh/FacetTable.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
constexpr int SmallestSize = 16, LargestSize = 4096;
constexpr int Samples = 2;            // per pixel, in each direction
constexpr double Margin = 0.04;       // of the picture, on each side
constexpr double EdgeWidth = 0.6;     // pixels
constexpr double RoomForEdges = 9;    // pixels: the smallest mean length of drawn edges
constexpr double EdgeShade = 0.45;    // factor on the color of the cell
constexpr double AmbientLight = 0.55; // light on a face seen edge-on
constexpr double Paleness = 0.6;      // paleness of cells in front of highlighted ones
constexpr double Farthest = -std::numeric_limits<double>::infinity();
constexpr Color White = { 1, 1, 1 };
const Vec3 TowardsViewer = { 0.75, -1.0, 0.55 };
const Vec3 Above = { 0, 0, 1 };

Vec3 unit(const Vec3& v)
{
  return (1 / norm(v)) * v;
}

bool isFinite(const Vec3& p)
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// The directions to the right, up and toward the viewer.
struct Camera
{
  Vec3 right, up, back;
};

Camera cameraOf(const std::vector<PicturePart>& parts)
{
  const Mesh* first = nullptr;
  for (const PicturePart& part : parts)
  {
    const bool planar = part.mesh->dimension() == Dimension::Planar;
    const bool some = part.mesh->dimension() != Dimension::None;
    first = first ? first : some ? part.mesh : nullptr;
    // Planar parts in different planes form a surface.
    if (some && (!planar || std::abs(dot(part.mesh->normal(), first->normal())) < 1 - 1e-9))
    {
      first = nullptr;
      break;
    }
  }
  if (first)
  {
    return { first->frame()[0], first->frame()[1], first->normal() };
  }
  const Vec3 back = unit(TowardsViewer);
  const Vec3 right = unit(cross(Above, back));
  return { right, cross(back, right), back };
}

/// A facet in coordinates of the picture: pixels to the right and down, depth toward the viewer.
struct Facet
{
  std::array<Vec3, MaxFaceNodes> corners;
  int size = 0;
  Color color = White;
  double light = 1;
  bool highlighted = false;
};

/// Calls visit(nodes in order around the facet, number of nodes, cell).
template <class Visit>
void forEachDrawn(const PicturePart& part, const Visit& visit)
{
  const MeshView& view = part.mesh->view();
  const bool volume = part.mesh->dimension() == Dimension::Volume;
  for (const CellBlock& block : part.mesh->blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      pollInterruption(i);
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      const bool highlighted = !part.highlighted.empty() && part.highlighted[cell];
      if (t.dimension == 2 && !volume)
      {
        visit(node, t.nodes, cell, highlighted);
      }
      for (int f = 0; t.dimension == 3 && highlighted && f < t.faces; ++f)
      {
        Index nodes[MaxFaceNodes] = {};
        for (int k = 0; k < t.faceSizes[f]; ++k)
        {
          nodes[k] = node[t.faceNodes[f][k]];
        }
        visit(nodes, t.faceSizes[f], cell, true);
      }
    }
  }
  if (volume)
  {
    FacetTable(*part.mesh)
      .forEachFacet(
        [&](Index smallest, const FacetUse* uses, Index count)
        {
          const auto& others = uses->others;
          const bool quad = others[2] >= 0;
          // The third of the other nodes is opposite the smallest.
          const Index nodes[MaxFaceNodes] = { smallest, others[0], quad ? others[2] : others[1],
            others[1] };
          if (count == 1)
          {
            visit(nodes, quad ? 4 : 3, uses->cell, false);
          }
        });
  }
}

/// The facets of all parts, in the coordinates of the camera.
std::vector<Facet> facetsOf(const std::vector<PicturePart>& parts, const Camera& camera)
{
  // Coordinates may have any size: they are divided by the largest, rounded to a power of two.
  double largest = 0;
  for (const PicturePart& part : parts)
  {
    const MeshView& view = part.mesh->view();
    for (Index i = 0; i < 3 * view.numberOfPoints; ++i)
    {
      largest =
        std::isfinite(view.points[i]) ? std::max(largest, std::abs(view.points[i])) : largest;
    }
  }
  const int exponent = largest > 0 ? -std::ilogb(largest) : 0;
  std::vector<Facet> facets;
  for (const PicturePart& part : parts)
  {
    const bool flat = part.mesh->dimension() == Dimension::Planar;
    forEachDrawn(part,
      [&](const Index* nodes, int size, Index cell, bool highlighted)
      {
        Facet facet;
        facet.size = size;
        facet.color = part.colors[cell];
        facet.highlighted = highlighted;
        bool finite = true;
        for (int k = 0; k < size; ++k)
        {
          Vec3 p = pointOf(part.mesh->view(), nodes[k]);
          finite = finite && isFinite(p);
          for (double& x : p)
          {
            x = std::ldexp(x, exponent);
          }
          facet.corners[k] = { dot(p, camera.right), -dot(p, camera.up), dot(p, camera.back) };
        }
        const auto& c = facet.corners;
        const Vec3 normal =
          size == 3 ? cross(c[1] - c[0], c[2] - c[0]) : cross(c[2] - c[0], c[3] - c[1]);
        const double length = norm(normal);
        const double facing = length > 0 ? std::abs(normal[2]) / length : 1;
        facet.light = flat ? 1 : AmbientLight + (1 - AmbientLight) * facing;
        if (finite)
        {
          facets.push_back(facet);
        }
      });
  }
  return facets;
}

/// Maps the facets into a picture of this size.
void fit(std::vector<Facet>& facets, int width, int height)
{
  constexpr double largest = std::numeric_limits<double>::max();
  Vec3 low = { largest, largest, largest }, high = { -largest, -largest, -largest };
  for (const Facet& facet : facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        low[axis] = std::min(low[axis], facet.corners[k][axis]);
        high[axis] = std::max(high[axis], facet.corners[k][axis]);
      }
    }
  }
  const double room = 1 - 2 * Margin;
  const auto scaleOf = [room](double pixels, double size)
  { return size > 0 ? room * pixels / size : largest; };
  double scale = std::min(scaleOf(width, high[0] - low[0]), scaleOf(height, high[1] - low[1]));
  scale = scale < largest ? scale : 1;
  for (Facet& facet : facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      Vec3& p = facet.corners[k];
      p = { 0.5 * width + scale * (p[0] - 0.5 * (low[0] + high[0])),
        0.5 * height + scale * (p[1] - 0.5 * (low[1] + high[1])), scale * (p[2] - low[2]) };
    }
  }
}

/// The mean length of the edges in the picture; 0 without any.
double meanEdge(const std::vector<Facet>& facets)
{
  double sum = 0;
  Index count = 0;
  for (const Facet& facet : facets)
  {
    for (int k = 0; k < facet.size; ++k, ++count)
    {
      const Vec3 edge = facet.corners[(k + 1) % facet.size] - facet.corners[k];
      sum += std::hypot(edge[0], edge[1]);
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Samples with their depths.
class Canvas
{
public:
  Canvas(int width, int height)
    : Width(width)
    , Height(height)
    , Colors(static_cast<std::size_t>(width) * height, White)
    , Depths(static_cast<std::size_t>(width) * height, Farthest)
  {
  }

  void draw(const Facet& facet, double edgeWidth)
  {
    // A quadrilateral is drawn as two triangles; the diagonal, the side before corner 2, is not an
    // edge.
    this->drawTriangle(facet, 0, 1, 2, edgeWidth, facet.size == 3);
    if (facet.size == 4)
    {
      this->drawTriangle(facet, 2, 3, 0, edgeWidth, false);
    }
  }

  const Color& color(std::size_t sample) const { return this->Colors[sample]; }
  bool covered(std::size_t sample) const { return this->Depths[sample] > Farthest; }

private:
  void drawTriangle(const Facet& facet, int i, int j, int k, double edgeWidth, bool allEdges)
  {
    const Vec3 &a = facet.corners[i], &b = facet.corners[j], &c = facet.corners[k];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area == 0 || !std::isfinite(area))
    {
      return;
    }
    // For the sides a-b, b-c, c-a: the barycentric coordinate times this factor is the distance in
    // pixels.
    const double heights[3] = { std::abs(area) / std::hypot(b[0] - a[0], b[1] - a[1]),
      std::abs(area) / std::hypot(c[0] - b[0], c[1] - b[1]),
      std::abs(area) / std::hypot(a[0] - c[0], a[1] - c[1]) };
    const auto pixel = [](double x, int size)
    { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size))); };
    const int left = pixel(std::min({ a[0], b[0], c[0] }), this->Width);
    const int right = pixel(std::max({ a[0], b[0], c[0] }) + 1, this->Width);
    const int top = pixel(std::min({ a[1], b[1], c[1] }), this->Height);
    const int bottom = pixel(std::max({ a[1], b[1], c[1] }) + 1, this->Height);
    for (int y = top; y < bottom; ++y)
    {
      for (int x = left; x < right; ++x)
      {
        const double px = x + 0.5, py = y + 0.5;
        const double atC = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area;
        const double atA = ((c[0] - b[0]) * (py - b[1]) - (c[1] - b[1]) * (px - b[0])) / area;
        const double atB = 1 - atA - atC;
        if (atA < 0 || atB < 0 || atC < 0)
        {
          continue;
        }
        const double depth = atA * a[2] + atB * b[2] + atC * c[2];
        const std::size_t sample = static_cast<std::size_t>(y) * this->Width + x;
        if (depth <= this->Depths[sample])
        {
          continue;
        }
        this->Depths[sample] = depth;
        const double distance =
          std::min({ atC * heights[0], atA * heights[1], allEdges ? atB * heights[2] : edgeWidth });
        const double shade = facet.light * (distance < edgeWidth ? EdgeShade : 1);
        this->Colors[sample] = { shade * facet.color[0], shade * facet.color[1],
          shade * facet.color[2] };
      }
    }
  }

  int Width, Height;
  std::vector<Color> Colors;
  std::vector<double> Depths;
};

void check(const std::vector<PicturePart>& parts, int width, int height)
{
  if (std::min(width, height) < SmallestSize || std::max(width, height) > LargestSize)
  {
    throw Error("A picture must have " + std::to_string(SmallestSize) + " to " +
      std::to_string(LargestSize) + " pixels in each direction, not " + std::to_string(width) +
      " x " + std::to_string(height) + ".");
  }
  for (const PicturePart& part : parts)
  {
    const auto cells = part.mesh ? static_cast<std::size_t>(part.mesh->view().numberOfCells) : 0;
    if (!part.mesh || part.colors.size() != cells ||
      (!part.highlighted.empty() && part.highlighted.size() != cells))
    {
      throw Error("A part of a picture needs a mesh with one color per cell.");
    }
  }
}
}

//------------------------------------------------------------------------------
Picture drawMeshes(const std::vector<PicturePart>& parts, int width, int height)
{
  check(parts, width, height);
  const int columns = Samples * width, rows = Samples * height;
  std::vector<Facet> facets = facetsOf(parts, cameraOf(parts));
  fit(facets, columns, rows);
  const double edgeWidth = meanEdge(facets) >= Samples * RoomForEdges ? Samples * EdgeWidth : 0;
  Canvas surface(columns, rows), inside(columns, rows);
  Index pass = 0;
  bool some = false;
  for (const Facet& facet : facets)
  {
    pollInterruption(pass++);
    (facet.highlighted ? inside : surface).draw(facet, edgeWidth);
    some = some || facet.highlighted;
  }
  Picture picture{ width, height, std::vector<unsigned char>(3u * width * height) };
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      Vec3 sum = { 0, 0, 0 };
      for (int s = 0; s < Samples * Samples; ++s)
      {
        const std::size_t sample =
          static_cast<std::size_t>(Samples * y + s / Samples) * columns + Samples * x + s % Samples;
        const bool through = inside.covered(sample);
        const Color& color = through ? inside.color(sample) : surface.color(sample);
        const double pale = some && !through ? Paleness : 0;
        sum += (1 - pale) * Vec3(color) + pale * Vec3(White);
      }
      for (int channel = 0; channel < 3; ++channel)
      {
        const double value = std::clamp(sum[channel] / (Samples * Samples), 0.0, 1.0);
        picture.rgb[3 * (static_cast<std::size_t>(y) * width + x) + channel] =
          static_cast<unsigned char>(std::lround(255 * value));
      }
    }
  }
  return picture;
}
}
