// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointKey.h
 * @brief The key that identifies a point in the pieces of a mesh on several ranks.
 * Internal: not installed.
 */
#ifndef tautline_PointKey_h
#define tautline_PointKey_h

#include "RankPieces.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace tautline
{
/// A global id, or the bits of coordinates.
using PointKey = std::array<std::uint64_t, 3>;

inline PointKey keyOfPoint(const RankPiece& piece, Index point)
{
  PointKey key = { 0, 0, 0 };
  if (piece.globalIds)
  {
    key[0] = static_cast<std::uint64_t>(piece.globalIds[point]);
    return key;
  }
  const Vec3 place = pointOf(piece.mesh->view(), point) + Vec3{ 0, 0, 0 }; // -0 becomes 0
  std::memcpy(key.data(), place.data(), sizeof(key));
  return key;
}

/// Combines a hash with another value.
inline std::uint64_t addToHash(std::uint64_t hash, std::uint64_t value)
{
  constexpr std::uint64_t odd = 0x9E3779B97F4A7C15u; // 2^64 over the golden ratio
  hash = (hash ^ value) * odd;
  return hash ^ (hash >> 32);
}

/// The rank that collects all items with a hash.
inline int homeOf(std::uint64_t hash, const RankGroup& group)
{
  return static_cast<int>(hash % static_cast<std::uint64_t>(group.size()));
}

inline std::uint64_t hashOf(const PointKey& key)
{
  return addToHash(addToHash(addToHash(0, key[0]), key[1]), key[2]);
}
}
#endif
