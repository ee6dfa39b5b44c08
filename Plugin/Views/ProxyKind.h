// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProxyKind.h
 * @brief Identifies Tautline's proxies, and names their outputs.
 */

#ifndef tautline_ProxyKind_h
#define tautline_ProxyKind_h

class vtkPVXMLElement;
class vtkSMProxy;

namespace tautline
{

/// Whether the hints of a proxy put it in the Tautline menu. False for null.
bool isInMenu(vtkPVXMLElement* hints);

/// Whether the proxy is a filter or source in the Tautline menu. False for null.
bool isTautline(vtkSMProxy* proxy);

/// The filters whose runs the dock draws and Stop can end: names of the proxy and in the menu.
constexpr const char* DrawnInDock[][2] = { { "MeshOptimizer", "Optimize Mesh" },
  { "MeshUntangler", "Untangle Mesh" }, { "MeshImprover", "Improve Mesh" } };

/// Whether the proxy is one of DrawnInDock. False for null.
bool isDrawnInDock(vtkSMProxy* proxy);

/// The output of Element Quality with the elements drawn inside the mesh.
constexpr const char* BadElementsPort = "Bad";

/// The output of Solve PDE with the sections drawn inside the mesh.
constexpr const char* SectionsPort = "Sections";

} // namespace tautline

#endif
