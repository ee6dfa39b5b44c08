// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Recolor.h
 * @brief Colors a display by another array.
 */
#ifndef tautline_Recolor_h
#define tautline_Recolor_h

class pqDataRepresentation;

namespace tautline
{
/**
 * Colors a display by an array, and hides the legend of the previous array if no other display
 * needs it.
 * @param association vtkDataObject::POINT or CELL
 */
void recolor(pqDataRepresentation* shown, const char* array, int association, bool legend);
}

#endif
