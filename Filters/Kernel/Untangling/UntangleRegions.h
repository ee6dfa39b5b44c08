// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleRegions.h
 * @brief Untangles a mesh on several ranks in the regions around its invalid elements.
 * Internal: not installed.
 */
#ifndef tautline_UntangleRegions_h
#define tautline_UntangleRegions_h

#include "UntangleProgress.h"
#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/**
 * @brief Gathers the cells within some rings around the invalid elements, in the order of their
 * global numbers, and untangles their connected parts by untangle(), each on one rank, with the
 * surrounding points held. If elements remain invalid, wider rings follow, and, except with
 * Effort::Local, the whole mesh on the first rank. Sets result.remaining and its obstacles.
 * Collective.
 * @param mesh the local mesh
 * @param validity of the local cells at result.points; kept up to date
 */
void untangleRegions(const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks,
  UntangleProgress& progress, std::vector<signed char>& validity, UntangleResult& result);
}
#endif
