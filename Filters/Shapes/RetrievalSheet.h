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
/// A small picture: grey values, RetrievalSheet::Stored in each direction, the lowest row first.
using Thumbnail = std::vector<unsigned char>;

/**
 * @brief A square sheet of small pictures: in each row a query, in a grey frame, and its best
 * matches in frames, green where they are of its class and red where not.
 *
 * The rows fill one or more columns from the top left; the pictures are as large as the sheet
 * allows.
 */
class RetrievalSheet
{
public:
  static constexpr int Stored = 128;  ///< width of a small picture as it is kept, pixels
  static constexpr int Largest = 256; ///< and as it is drawn, at most
  static constexpr int Shown = 10;    ///< matches of a query, at most
  static constexpr std::array<unsigned char, 3> Query = { 120, 120, 120 };
  static constexpr std::array<unsigned char, 3> Right = { 0, 150, 60 };
  static constexpr std::array<unsigned char, 3> Wrong = { 215, 25, 30 };

  /// Where the pictures are, in pixels from the top left.
  struct Layout
  {
    int picture = 0;   ///< width of a picture without its frame; 0: they do not fit
    int frame = 0;     ///< width of a frame
    int gap = 0;       ///< between a query and its matches, and between rows
    int perColumn = 0; ///< queries
    int shown = 0;     ///< matches of a query

    int cell() const { return this->picture + 2 * this->frame; }
    /// The left and the upper end of the frame of a query (rank 0) or match (from 1).
    std::array<int, 2> place(int query, int rank) const;
  };
  /// The layout with the largest pictures.
  static Layout layout(int size, int queries, int matches);

  /// The image scaled to a small picture, centred, with its grey values from black to white.
  static Thumbnail thumbnail(const ImageView& image);

  /// A match of a query.
  struct Match
  {
    Index shape;
    bool right; ///< whether it is of the query's class
  };
  /**
   * @brief Draws the sheet, colours in the array `Sheet`.
   * @param shapes the small picture of each shape
   * @param matches of each shape, the best first
   * @param size width and height of the sheet, pixels
   */
  static void draw(const std::vector<Thumbnail>& shapes,
    const std::vector<std::vector<Match>>& matches, int size, vtkImageData* sheet);
};
}
#endif
