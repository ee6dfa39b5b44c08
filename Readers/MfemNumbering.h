// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemNumbering.h
 * @brief The numbering of the nodes of a mesh in MFEM's space H1.
 *
 * Vertices come first, then the nodes inside edges, faces and elements. Edges and faces are
 * numbered in the order of their first occurrence in the elements. The nodes of an edge start from
 * its vertex with the smaller number; the nodes of a face follow the corners of the face in its
 * first element.
 *
 * Internal: not installed.
 */
#ifndef tautline_MfemNumbering_h
#define tautline_MfemNumbering_h

#include "MfemFile.h"

#include <cstdint>
#include <unordered_map>

namespace tautline
{
/// The elements, or the boundary elements, of a file.
struct MfemElements
{
  std::vector<Index> attributes;
  std::vector<unsigned char> geometries; ///< shapes by MFEM's numbers
  std::vector<Index> offsets = { 0 };
  std::vector<Index> vertices;

  std::size_t size() const { return this->geometries.size(); }
  const Index* verticesOf(std::size_t element) const
  {
    return this->vertices.data() + this->offsets[element];
  }
};

class MfemNumbering
{
public:
  /// Numbers the nodes of the elements, which must outlive the numbering.
  MfemNumbering(Index vertices, const MfemElements& elements, int order);

  Index numberOfNodes() const { return this->Total; }
  /**
   * @brief The nodes of an element, in the order of its shape's lattice.
   * @param boundary the boundary elements that contain it; null for an element passed to the
   * constructor
   * @return false for a boundary element that is not an edge or face of an element
   */
  bool nodesOf(std::size_t element, const MfemElements* boundary, std::vector<Index>& nodes) const;

private:
  /// The vertices in order, padded in front with -1 to four entries.
  using Key = std::array<Index, 4>;

  struct Hash
  {
    std::size_t operator()(const Key& key) const
    {
      constexpr std::uint64_t factor = 0x9e3779b97f4a7c15u; // 2^64 / golden ratio
      std::uint64_t hash = 0;
      for (const Index vertex : key)
      {
        hash = (hash ^ static_cast<std::uint64_t>(vertex)) * factor;
        hash ^= hash >> 32;
      }
      return hash;
    }
  };
  struct Face
  {
    Index firstNode;
    std::array<Index, 4> vertices; ///< as in the first element
  };
  /// A position in the lattice, with the corners that contribute to it.
  struct Place
  {
    LatticePoint place;
    std::vector<int> corners;
  };

  static Key keyOf(const Index* vertices, const int* corners, int count);
  Index nodeOfEdge(const MfemShape& shape, const Index* vertices, const int* corners,
    const LatticePoint& place) const;
  Index nodeOfFace(const MfemShape& shape, const Index* vertices, const int* corners, int count,
    const LatticePoint& place) const;

  const MfemElements& Elements;
  int Order;
  Index Total = 0;
  std::array<std::vector<Place>, 8> Places;   ///< by shape
  std::unordered_map<Key, Index, Hash> Edges; ///< first node
  std::unordered_map<Key, Face, Hash> Faces;
  std::vector<Index> Interiors; ///< first node of each element
};
}
#endif
