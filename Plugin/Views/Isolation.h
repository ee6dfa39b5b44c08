// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::Isolation
 * @brief Shows elements inside a mesh: the mesh fades, the elements are filled and outlined, and
 * layers of their neighbors are drawn around them.
 *
 * The additional displays belong neither to the pipeline nor to saved states. end() restores the
 * view.
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
  /// Restores nothing: when the program exits, the view is already half destroyed.
  ~Isolation() = default;
  Isolation(const Isolation&) = delete;
  Isolation& operator=(const Isolation&) = delete;

  /**
   * @brief Fades a mesh with its edges in a 3D view and hides everything else there. A hidden
   * mesh is shown.
   * @param array the cell array whose values are written beside the selected elements
   * @return "", or the error with a fix; then nothing changes.
   */
  std::string begin(pqOutputPort* mesh, const std::string& array);

  /// Whether begin() succeeded and end() has not been called since.
  bool active() const { return static_cast<bool>(this->Restore); }

  /**
   * @brief Draws elements and their neighbors; they replace the previous ones.
   * @param layers number of layers of neighbors that share a point, at least 0
   */
  void show(const std::vector<ElementName>& names, int layers);

  /// Moves the camera to the elements drawn by show().
  void zoom() const;

  /// Reverts the changes of begin() and removes the additional displays.
  void end();

private:
  /// An additional display.
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
  std::function<void()> Restore; ///< reverts the changes of begin()
};

} // namespace tautline

#endif
