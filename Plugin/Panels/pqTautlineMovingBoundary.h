// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineMovingBoundary
 * @brief Highlights the part of the boundary that Warp Mesh will move, before Apply.
 *
 * While the panel of Warp Mesh is shown and has changes that are not applied, what the properties
 * choose (Motion, Moved Part, ...) is drawn in the view. The interactive box is placed around it.
 * The proxy MovingBoundary finds it; it is not in the pipeline browser, and not saved in states.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_moving_boundary"/>` of a property of Warp Mesh
 * that is always shown selects it.
 */

#ifndef pqTautlineMovingBoundary_h
#define pqTautlineMovingBoundary_h

#include "pqPropertyWidgetDecorator.h"

#include "vtkSmartPointer.h"

#include <QPointer>
#include <QTimer>

class pqBoxPropertyWidget;
class pqPipelineSource;
class pqRenderView;
class vtkSMProxy;
class vtkSMSourceProxy;

class pqTautlineMovingBoundary : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqTautlineMovingBoundary(vtkPVXMLElement* hint, pqPropertyWidget* field);
  ~pqTautlineMovingBoundary() override;

  /// Follows the field as it is shown and hidden with the panel.
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  /// Finds what moves, and shows or hides it.
  void update();
  /// Places the box around what moves; if nothing does, around the mesh.
  void placeBox();

private:
  /// Connects the panel, which is made after this.
  void connectPanel();
  pqBoxPropertyWidget* box() const;
  pqPipelineSource* source() const;
  /// The bounds of what moves or, with `wholeMesh`, of the input; false if there is nothing.
  bool bounds(bool wholeMesh, double result[6]) const;
  /// Takes the values in the panel, applied or not. False if there is no input yet.
  bool find();
  void show(pqRenderView* view);
  void hide();

  QTimer Later;      ///< starts update() once after several changes
  QTimer PlaceLater; ///< starts placeBox() once
  bool Connected = false;
  vtkSmartPointer<vtkSMSourceProxy> Boundary;
  vtkSmartPointer<vtkSMProxy> Shown; ///< representation of Boundary in View, or null
  QPointer<pqRenderView> View;
  double Placed[6] = { 1, -1, 1, -1, 1, -1 }; ///< bounds of what moves when the box was placed
};

#endif
