// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFileAdapter.h
 * @brief An image file as vtkImageData: its header is checked, then VTK's reader reads it.
 */
#ifndef tautline_ImageFileAdapter_h
#define tautline_ImageFileAdapter_h

#include "vtkSmartPointer.h"

#include <string>

class vtkImageData;

namespace tautline
{
/// Throws FileError with the name of the file: see checkImage(); every message of VTK is an error.
vtkSmartPointer<vtkImageData> readImage(const std::string& name);
}
#endif
