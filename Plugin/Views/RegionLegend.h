// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionLegend.h
 * @brief Two colors for domain and interaction layer, with their names in the legend.
 */
#ifndef tautline_RegionLegend_h
#define tautline_RegionLegend_h

class pqDataRepresentation;

namespace tautline
{
/**
 * Colors a mesh of Interaction Layer or Mesh Domain by its array Reference, if there is one, as
 * categories. Arrays with this name from readers have other values: this representation has a
 * separate color map.
 */
void showRegions(pqDataRepresentation* mesh);
}

#endif
