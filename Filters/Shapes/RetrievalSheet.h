// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RetrievalSheet.h
 * @brief A picture of the queries of a retrieval with their best matches. Not installed.
 */
#ifndef tautline_RetrievalSheet_h
#define tautline_RetrievalSheet_h

#include "ShapeAdapter.h"

#include <array>

namespace tautline
{
/// A small picture: gray values, RetrievalSheet::Stored in each direction, the lowest row first.
using Thumbnail = std::vector<unsigned char>;

/**
 * @brief A square sheet of small pictures: in each row a query, in a gray frame, and its best
 * matches in frames, which are green for matches of the same class and red for others.
 *
 * The rows fill one or more columns from the top left; the pictures are as large as the sheet
 * allows.
 */
class RetrievalSheet
{
public:
  static constexpr int Stored = 128;  ///< stored width of a small picture, in pixels
  static constexpr int Largest = 256; ///< largest drawn width, in pixels
  static constexpr int Shown = 10;    ///< largest number of matches per query
  static constexpr std::array<unsigned char, 3> Query = { 120, 120, 120 };
  static constexpr std::array<unsigned char, 3> Right = { 0, 150, 60 };
  static constexpr std::array<unsigned char, 3> Wrong = { 215, 25, 30 };

  /// The positions of the pictures, in pixels from the top left.
  struct Layout
  {
    int picture = 0;   ///< width of a picture without its frame; 0 if they do not fit
    int frame = 0;     ///< width of a frame
    int gap = 0;       ///< between a query and its matches, and between rows
    int perColumn = 0; ///< queries
    int shown = 0;     ///< matches of a query

    int cell() const { return this->picture + 2 * this->frame; }
    /// The left and upper edge of the frame of a query (rank 0) or match (from 1).
    std::array<int, 2> place(int query, int rank) const;
  };
  /// The layout with the largest pictures.
  static Layout layout(int size, int queries, int matches);

  /// The image scaled to a small picture, centered, with gray values from black to white.
  static Thumbnail thumbnail(const ImageView& image);

  /// A match of a query.
  struct Match
  {
    Index shape;
    bool right; ///< whether it is of the query's class
  };
  /**
   * @brief Draws the sheet, with colors in the array `Sheet`.
   * @param shapes the small picture of each shape
   * @param matches of each shape, the best first
   * @param size width and height of the sheet, pixels
   */
  static void draw(const std::vector<Thumbnail>& shapes,
    const std::vector<std::vector<Match>>& matches, int size, vtkImageData* sheet);
};
}
#endif
