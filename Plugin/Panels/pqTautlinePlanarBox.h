// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlinePlanarBox
 * @brief Keeps the interactive box of a planar mesh in its plane.
 *
 * In ParaView's box the left button takes the handle of a face that lies in the mesh, and makes
 * the mesh as flat as its box, a scale of 0. For a mesh in a plane z = constant the left button
 * moves the box here, with Shift it takes the handles, which scale, and with Ctrl it turns the box
 * about its center, for which ParaView's box has no action in the plane of the view. Translation
 * and scale along z and rotation about x and y stay as they are without a motion; their fields are
 * gray. The box is placed, with a thickness, by pqTautlineMovingBoundary.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_planar_box"/>` of the property with the
 * transform selects it. The proxy has the property Input.
 */

#ifndef pqTautlinePlanarBox_h
#define pqTautlinePlanarBox_h

#include "pqPropertyWidgetDecorator.h"

#include "vtkWeakPointer.h"

#include <vector>

class pqBoxPropertyWidget;
class vtkBoxRepresentation;
class vtkObject;
class vtkRenderWindowInteractor;

class pqTautlinePlanarBox : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqTautlinePlanarBox(vtkPVXMLElement* hint, pqPropertyWidget* field);
  ~pqTautlinePlanarBox() override;

private Q_SLOTS:
  /// Adapts the box to the input.
  void adapt();
  void keepInPlane();

private:
  /// The bounds of a planar input; false for others.
  bool planarBounds(double bounds[6]) const;
  pqBoxPropertyWidget* box() const;
  /// The box as drawn; null while none is shown.
  vtkBoxRepresentation* drawnBox() const;

  /// Observes the mouse in the view of the box, before the box and the camera.
  void observe(vtkRenderWindowInteractor* interactor);
  ///@{
  /// The turn by the mouse. @return whether the event is used up
  bool press(vtkObject* caller, unsigned long event, void* data);
  bool move(vtkObject* caller, unsigned long event, void* data);
  bool release(vtkObject* caller, unsigned long event, void* data);
  ///@}
  /// The direction from the center of the box to the mouse in the view, in degrees; `center`: its
  /// place in the scene.
  double direction(double center[3]) const;
  /// Turns the box in its plane about its center.
  void turn(double degrees, const double center[3]);

  vtkWeakPointer<vtkRenderWindowInteractor> Observed;
  std::vector<unsigned long> Observers;
  bool Turning = false;
  double Last = 0; ///< direction() at the last event
};

#endif
