#include "Startup.h"

#include "ColorMaps.h"
#include "VersionCheck.h"

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
  constexpr double belowSiteAndUser = -1.0;
  vtkSMSettings::GetInstance()->AddCollectionFromString(
    tautline::colorMapSettings(tautline::metricColorMaps()), belowSiteAndUser);
}
