// SPDX-License-Identifier: BSD-3-Clause
#include "RetrievalSheet.h"

#include "tautline/Core/Memory.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
using Color = std::array<unsigned char, 3>;
constexpr unsigned char Paper = 255;
// Fractions of the width of a picture.
constexpr double FrameWidth = 1.0 / 12;
constexpr double GapWidth = 1.0 / 6;

/// A picture with its origin at the top left.
class Canvas
{
public:
  explicit Canvas(int size)
    : Size(size)
  {
    this->Pixels->SetName("Sheet");
    this->Pixels->SetNumberOfComponents(3);
    this->Pixels->SetNumberOfTuples(static_cast<vtkIdType>(size) * size);
    std::fill_n(this->Pixels->GetPointer(0), this->Pixels->GetNumberOfValues(), Paper);
  }

  /// Draws a small picture in a frame with a given top left corner.
  void add(const Thumbnail& picture, const Color& frame, const RetrievalSheet::Layout& layout,
    const std::array<int, 2>& place)
  {
    for (int y = 0; y < layout.cell(); ++y)
    {
      for (int x = 0; x < layout.cell(); ++x)
      {
        const int u = x - layout.frame, v = layout.picture - 1 - (y - layout.frame);
        const bool inside = std::min(u, v) >= 0 && std::max(u, v) < layout.picture;
        const unsigned char grey = inside ? scaled(picture, layout.picture, u, v) : 0;
        const Color color = inside ? Color{ grey, grey, grey } : frame;
        const vtkIdType row = this->Size - 1 - (place[1] + y);
        std::copy(color.begin(), color.end(),
          this->Pixels->GetPointer(3 * (row * this->Size + place[0] + x)));
      }
    }
  }

  void fill(vtkImageData* image) const
  {
    image->Initialize();
    image->SetDimensions(this->Size, this->Size, 1);
    image->GetPointData()->SetScalars(this->Pixels);
  }

private:
  /// The mean of the pixels covered by a pixel of the smaller picture.
  static unsigned char scaled(const Thumbnail& picture, int size, int u, int v)
  {
    constexpr int stored = RetrievalSheet::Stored;
    const int left = u * stored / size, right = std::max(left + 1, (u + 1) * stored / size);
    const int low = v * stored / size, high = std::max(low + 1, (v + 1) * stored / size);
    int sum = 0;
    for (int y = low; y < high; ++y)
    {
      for (int x = left; x < right; ++x)
      {
        sum += picture[y * stored + x];
      }
    }
    return static_cast<unsigned char>(sum / ((right - left) * (high - low)));
  }

  int Size;
  vtkNew<vtkUnsignedCharArray> Pixels;
};
}

//------------------------------------------------------------------------------
std::array<int, 2> RetrievalSheet::Layout::place(int query, int rank) const
{
  const int column = query / this->perColumn, row = query % this->perColumn;
  const int width = (1 + this->shown) * this->cell() + 2 * this->gap;
  return { column * width + this->gap / 2 + rank * this->cell() + (rank > 0 ? this->gap : 0),
    row * (this->cell() + this->gap) + this->gap / 2 };
}

//------------------------------------------------------------------------------
RetrievalSheet::Layout RetrievalSheet::layout(int size, int queries, int matches)
{
  Layout best;
  best.shown = std::min(matches, Shown);
  for (int columns = 1; columns <= queries; ++columns)
  {
    const int perColumn = (queries + columns - 1) / columns;
    const double cell = 1 + 2 * FrameWidth;
    const double wide = columns * ((1 + best.shown) * cell + 2 * GapWidth);
    const double high = perColumn * (cell + GapWidth);
    const int picture = std::min(Largest, static_cast<int>(size / std::max(wide, high)));
    if (picture > best.picture)
    {
      best.picture = picture;
      best.frame = static_cast<int>(FrameWidth * picture);
      best.gap = static_cast<int>(GapWidth * picture);
      best.perColumn = perColumn;
    }
  }
  return best;
}

//------------------------------------------------------------------------------
Thumbnail RetrievalSheet::thumbnail(const ImageView& image)
{
  const Index count = image.width * image.height;
  const auto [low, high] = std::minmax_element(image.values, image.values + count);
  const double range = *high > *low ? double(*high) - *low : 1.0;
  const double scale = static_cast<double>(std::max(image.width, image.height)) / Stored;
  const double left = (static_cast<double>(image.width) - scale * Stored) / 2;
  const double bottom = (static_cast<double>(image.height) - scale * Stored) / 2;
  Thumbnail result(static_cast<std::size_t>(Stored) * Stored);
  // Outside the image its border pixels are repeated.
  const auto at = [scale](double begin, int pixel, Index length)
  {
    return std::clamp<Index>(
      static_cast<Index>(std::floor(begin + (pixel + 0.5) * scale)), 0, length - 1);
  };
  for (int v = 0; v < Stored; ++v)
  {
    for (int u = 0; u < Stored; ++u)
    {
      const double grey = image(at(left, u, image.width), at(bottom, v, image.height));
      result[v * Stored + u] = static_cast<unsigned char>(std::lround(255 * (grey - *low) / range));
    }
  }
  return result;
}

//------------------------------------------------------------------------------
void RetrievalSheet::draw(const std::vector<Thumbnail>& shapes,
  const std::vector<std::vector<Match>>& matches, int size, vtkImageData* sheet)
{
  const int queries = static_cast<int>(matches.size());
  const auto longer = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  const auto longest = std::max_element(matches.begin(), matches.end(), longer);
  const int most = longest == matches.end() ? 0 : static_cast<int>(longest->size());
  requireMemory(3.0 * size * size, "the sheet of pictures", "choose a smaller Sheet Size");
  Canvas canvas(size);
  const Layout places = layout(size, queries, most);
  for (int query = 0; places.picture > 0 && query < queries; ++query)
  {
    canvas.add(shapes[query], Query, places, places.place(query, 0));
    for (int rank = 1; rank <= std::min(places.shown, static_cast<int>(matches[query].size()));
         ++rank)
    {
      const Match& match = matches[query][rank - 1];
      canvas.add(
        shapes[match.shape], match.right ? Right : Wrong, places, places.place(query, rank));
    }
  }
  canvas.fill(sheet);
}
}
