// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlinePlanarBox
 * @brief Keeps the interactive box of a planar mesh in its plane.
 *
 * In ParaView's box the left button takes the handle of a face that lies in the mesh, and makes the
 * mesh as flat as its box, a scale of 0. For a mesh in a plane z = constant the left button moves
 * the box here (with Shift it takes the handles), and translation and scale along z and rotation
 * about x and y stay as they are without a motion; their fields are grey. The box is placed, with
 * a thickness, by pqTautlineMovingBoundary.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_planar_box"/>` of the property with the
 * transform selects it. The proxy has the property Input.
 */

#ifndef pqTautlinePlanarBox_h
#define pqTautlinePlanarBox_h

#include "pqPropertyWidgetDecorator.h"

class pqBoxPropertyWidget;

class pqTautlinePlanarBox : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqTautlinePlanarBox(vtkPVXMLElement* hint, pqPropertyWidget* field);

private Q_SLOTS:
  /// Adapts the box to the input.
  void adapt();
  void keepInPlane();

private:
  /// The bounds of a planar input; false for others.
  bool planarBounds(double bounds[6]) const;
  pqBoxPropertyWidget* box() const;
};

#endif
