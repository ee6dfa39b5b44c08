// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionSteps.h
 * @brief Random operations on changing meshes, each checked: for the fuzzer and a test of many.
 */
#ifndef tautline_ReconnectionSteps_h
#define tautline_ReconnectionSteps_h

#include <cstdint>
#include <functional>

namespace tautline
{
/// Arbitrary numbers.
struct Choices
{
  std::function<std::uint32_t()> next;
  std::function<bool()> left; ///< false: no further operation
  int operator()(int count) { return static_cast<int>(this->next() % count); }
  double real(double low, double high) { return low + (high - low) * (this->next() * 0x1p-32); }
};

/**
 * @brief Changes a small planar mesh or a closed surface of triangles by flips, divisions,
 * contractions, motions and compound operations; a part of them is undone. After each, adjacency,
 * orientation, the area (of planar meshes) and Euler's number are checked.
 * @param attempts the largest number of operations tried
 * @return the number of operations that were accepted; throws std::logic_error for a violation
 */
long changeTriangles(Choices& choices, long attempts);

/// The same for tetrahedra, by the operations of CavityOperations and random motions; the volume
/// and whether the boundary is closed are checked.
long changeTetrahedra(Choices& choices, long attempts);

/// The same where points slide on flat parts of the boundary, which also changes.
long changeSliding(Choices& choices, long attempts);

/// The same of a ball or a cylinder, with a boundary that stays within a distance; the volume stays
/// within what that allows.
long changeSurface(Choices& choices, long attempts);
}
#endif
