// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::Isolation
 * @brief Shows elements inside a mesh: the mesh fades, the elements are filled and outlined, and
 * layers of their neighbors are drawn around them.
 *
 * What is drawn in addition is neither part of the pipeline nor of saved states. end() restores
 * the view.
 */

#ifndef tautline_Isolation_h
#define tautline_Isolation_h

#include "ElementSelection.h"

#include "vtkSmartPointer.h"

#include <QPointer>

#include <functional>
#include <string>
#include <vector>

class pqDataRepresentation;
class pqOutputPort;
class pqRenderView;
class vtkSMProxy;
class vtkSMSourceProxy;

namespace tautline
{

class Isolation
{
public:
  Isolation() = default;
  /// Restores nothing: at the end of the program the view is half destroyed.
  ~Isolation() = default;
  Isolation(const Isolation&) = delete;
  Isolation& operator=(const Isolation&) = delete;

  /**
   * @brief Fades a mesh with its edges in a 3D view and hides what else is shown there. A hidden
   * mesh is shown.
   * @param array the cell array whose values are written beside the selected elements
   * @return "" or what is wrong, with the remedy; then nothing changes.
   */
  std::string begin(pqOutputPort* mesh, const std::string& array);

  /// Whether begin() succeeded, and end() was not called since.
  bool active() const { return static_cast<bool>(this->Restore); }

  /**
   * @brief Draws elements and their neighbors instead of those drawn before.
   * @param layers of neighbors that share a point, from 0
   */
  void show(const std::vector<ElementName>& names, int layers);

  /// Moves the camera to what show() drew.
  void zoom() const;

  /// Restores what begin() changed, and removes what was drawn.
  void end();

private:
  /// Something drawn in addition.
  struct Drawn
  {
    vtkSmartPointer<vtkSMSourceProxy> selection, cells;
    vtkSmartPointer<vtkSMProxy> shown;
  };

  bool planar() const;
  void fade(pqDataRepresentation* mesh, const std::string& array, bool shownBefore);
  void draw(const std::vector<ElementName>& names, int layers, bool outline);
  void remove();

  QPointer<pqOutputPort> Mesh;
  QPointer<pqRenderView> View;
  QPointer<pqDataRepresentation> Faded;
  std::vector<Drawn> Additions;
  std::function<void()> Restore; ///< undoes what begin() changed
};

} // namespace tautline

#endif
