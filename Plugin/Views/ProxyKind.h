// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProxyKind.h
 * @brief Whether a proxy is one of Tautline's, and the names of outputs.
 */

#ifndef tautline_ProxyKind_h
#define tautline_ProxyKind_h

class vtkPVXMLElement;
class vtkSMProxy;

namespace tautline
{

/// Whether hints of a proxy put it into the menu Tautline. False for null.
bool isInMenu(vtkPVXMLElement* hints);

/// Whether the proxy is a filter or source of the menu Tautline. False for null.
bool isTautline(vtkSMProxy* proxy);

/// The filters whose runs the dock draws, and that Stop applies to: name of the proxy, in the menu.
constexpr const char* DrawnInDock[][2] = { { "MeshOptimizer", "Optimize Mesh" },
  { "MeshUntangler", "Untangle Mesh" }, { "MeshImprover", "Improve Mesh" } };

/// Whether the proxy is one of DrawnInDock. False for null.
bool isDrawnInDock(vtkSMProxy* proxy);

/// The output of Element Quality with the elements that are drawn inside the mesh.
constexpr const char* BadElementsPort = "Bad";

/// The output of Solve PDE with the sections that are drawn inside the mesh.
constexpr const char* SectionsPort = "Sections";

} // namespace tautline

#endif
