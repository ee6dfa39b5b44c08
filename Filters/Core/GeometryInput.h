// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GeometryInput.h
 * @brief The surface that points slide on instead of their own.
 */
#ifndef tautline_GeometryInput_h
#define tautline_GeometryInput_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/Mesh.h"

#include <functional>

class vtkDataSet;

namespace tautline
{
/**
 * @brief Calls use() with the facets of a surface, in a frame. Throws Error with the remedy for
 * data without facets or with volume cells.
 * @param surface may be null
 */
TAUTLINECORE_EXPORT void withGeometry(vtkDataSet* surface, const CoordinateFrame& frame,
  int threads, const std::function<void(const Mesh&)>& use);
}
#endif
