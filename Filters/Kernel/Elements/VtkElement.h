// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VtkElement.h
 * @brief The nodes and the polynomials of VTK's cell types.
 * Internal: not installed.
 */
#ifndef tautline_VtkElement_h
#define tautline_VtkElement_h

#include "ElementBasis.h"

namespace tautline
{
struct VtkElement
{
  ElementShape shape = ElementShape::Triangle;
  ElementOrders orders = { 0, 0, 0 };
  std::vector<Vec3> coordinates;
  ElementBasis basis;
  bool controlPoints = false; ///< whether the nodes are Bernstein coefficients
};

/// The element of a VTK type (see ElementType.h); throws Error for others.
VtkElement vtkElement(int vtkType, int nodes, const ElementOrders& orders);
}
#endif
