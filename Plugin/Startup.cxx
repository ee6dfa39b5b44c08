// SPDX-License-Identifier: BSD-3-Clause
#include "Startup.h"

#include "VersionCheck.h"

#include "vtkElementQuality.h"
#include "vtkOutputWindow.h"
#include "vtkPVVersion.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSettings.h"
#include "vtkVersion.h"

//------------------------------------------------------------------------------
void tautlineCheckVersion()
{
  const tautline::ParaViewVersion built = { PARAVIEW_VERSION_MAJOR, PARAVIEW_VERSION_MINOR,
    PARAVIEW_VERSION_PATCH, VTK_VERSION };
  const tautline::ParaViewVersion running = { vtkSMProxyManager::GetVersionMajor(),
    vtkSMProxyManager::GetVersionMinor(), vtkSMProxyManager::GetVersionPatch(),
    vtkVersion::GetVTKVersion() };
  const std::string message = tautline::versionMismatch(built, running);
  if (!message.empty())
  {
    vtkGenericWarningMacro(<< message);
  }
}

//------------------------------------------------------------------------------
void tautlineInstallColorMaps()
{
  // A metric may be registered later; color maps from an earlier session remain.
  static int known = 0;
  const int now = vtkElementQuality::GetNumberOfKnownMetrics();
  if (now == known)
  {
    return;
  }
  known = now;
  constexpr double belowSiteAndUser = -1.0;
  vtkSMSettings::GetInstance()->AddCollectionFromString(
    vtkElementQuality::GetColorMapSettings(), belowSiteAndUser);
}
