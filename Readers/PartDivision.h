// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartDivision.h
 * @brief The recursive bisection of MeshPart.h, of cells that are spread over the ranks.
 *
 * Each rank sorts its cells along the longest side of a group. All ranks together search for the
 * cell at the cut, by its place and number, a key of 128 bits: in each round they add up how many
 * of their cells are below some keys, 63 for a few groups and fewer for many.
 */
#ifndef tautline_PartDivision_h
#define tautline_PartDivision_h

#include "FileRanges.h"
#include "MeshFile.h"

namespace tautline
{
/**
 * @brief The part of each own cell, of as many parts as there are ranks. Collective.
 * @param mesh the own cells
 * @param points x y z of the points that the connectivity has
 * @param numbers of the own cells in the file, ascending
 */
std::vector<int> divideCells(const FileRanges& ranges, const MeshFile& mesh,
  const std::vector<double>& points, const std::vector<Index>& numbers);
}
#endif
