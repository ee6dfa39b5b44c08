// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CombineCorners.h
 * @brief The value of a cell from those of its corners.
 * Internal: not installed.
 */
#ifndef tautline_CombineCorners_h
#define tautline_CombineCorners_h

#include "Batch.h"

namespace tautline
{
/**
 * @brief The value Q of cells from those of their corners, as EvaluationOptions::combination says.
 * @param negative the corners that are inverted: of a cell that has some, only these count
 * @param weights set to dQ/dq of each corner
 */
Packet combine(
  const BatchContext& context, int samples, const Packet* q, const Mask* negative, Packet* weights);
}
#endif
