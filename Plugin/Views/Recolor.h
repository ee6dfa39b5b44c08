// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Recolor.h
 * @brief Another array for the colours of what is shown.
 */
#ifndef tautline_Recolor_h
#define tautline_Recolor_h

class pqDataRepresentation;

namespace tautline
{
/**
 * Colours what is shown by an array, and hides the legend of the array before where nothing else
 * needs it.
 * @param association vtkDataObject::POINT or CELL
 */
void recolor(pqDataRepresentation* shown, const char* array, int association, bool legend);
}

#endif
