// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CombineCorners.h
 * @brief Combines the values of the corners of a cell.
 * Internal: not installed.
 */
#ifndef tautline_CombineCorners_h
#define tautline_CombineCorners_h

#include "Batch.h"

namespace tautline
{
/**
 * @brief The value Q of cells from the values of their corners, according to
 * EvaluationOptions::combination.
 * @param negative the inverted corners; if a cell has any, only these are used
 * @param weights set to dQ/dq of each corner
 */
Packet combine(
  const BatchContext& context, int samples, const Packet* q, const Mask* negative, Packet* weights);
}
#endif
