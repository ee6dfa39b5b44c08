// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NodeNames.h
 * @brief Numbering of the nodes on edges and faces, consistent for all cells that share them.
 * Internal: not installed.
 */
#ifndef tautline_NodeNames_h
#define tautline_NodeNames_h

#include "tautline/Core/Types.h"

#include <unordered_map>
#include <utility>

namespace tautline
{
/// The corners of the edge or face of a node, in increasing order, and the weight of each; unused
/// entries are -1 and 0.
class NodeName
{
public:
  static constexpr std::size_t MaxCorners = 4;

  NodeName() { this->Parts.fill({ -1, 0 }); }

  void add(Index corner, int share)
  {
    int at = this->Size++;
    const std::pair<Index, int> part = { corner, share };
    for (; at > 0 && part < this->Parts[at - 1]; --at)
    {
      this->Parts[at] = this->Parts[at - 1];
    }
    this->Parts[at] = part;
  }
  bool operator==(const NodeName& other) const { return this->Parts == other.Parts; }

  struct Hash
  {
    std::size_t operator()(const NodeName& name) const
    {
      std::uint64_t hash = 0;
      for (const auto& [corner, share] : name.Parts)
      {
        // Multipliers of the random number generators splitmix64 and MMIX.
        hash = (hash ^ static_cast<std::uint64_t>(corner)) * 0x9e3779b97f4a7c15u;
        hash = (hash ^ (hash >> 32) ^ static_cast<std::uint64_t>(share)) * 6364136223846793005u;
      }
      return static_cast<std::size_t>(hash ^ (hash >> 29));
    }
  };

private:
  std::array<std::pair<Index, int>, MaxCorners> Parts;
  int Size = 0;
};

using NodeNumbers = std::unordered_map<NodeName, Index, NodeName::Hash>;
}
#endif
