// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParaViewCompatibility.h
 * @brief Differences between ParaView 5.11 and 5.13, in one place.
 */
#ifndef tautline_ParaViewCompatibility_h
#define tautline_ParaViewCompatibility_h

#include "vtkPVVersion.h"

#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
#include "vtkSMColorMapEditorHelper.h"
#else
#include "vtkSMPVRepresentationProxy.h"
#endif

namespace tautline
{
/// The static functions for the colors of a representation.
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
using ColorMaps = vtkSMColorMapEditorHelper;
#else
using ColorMaps = vtkSMPVRepresentationProxy;
#endif

/// The property of a representation that translates the displayed data.
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
inline constexpr char TranslationProperty[] = "Translation";
#else
inline constexpr char TranslationProperty[] = "Position";
#endif
} // namespace tautline

#endif
