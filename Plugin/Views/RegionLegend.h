// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionLegend.h
 * @brief Domain and interaction layer in two colours, with their names in the legend.
 */
#ifndef tautline_RegionLegend_h
#define tautline_RegionLegend_h

class pqDataRepresentation;

namespace tautline
{
/**
 * Colours a mesh of Interaction Layer or Mesh Domain by its array Reference, as categories, if
 * there is one. Arrays of this name from readers have other values: the colour map is that of this
 * representation alone.
 */
void showRegions(pqDataRepresentation* mesh);
}

#endif
