// SPDX-License-Identifier: BSD-3-Clause
#ifndef tautline_Version_h
#define tautline_Version_h

#include "tautline/KernelExport.h"

namespace tautline
{

/** The version of the loaded kernel library, "major.minor.patch". */
TAUTLINE_KERNEL_EXPORT const char* version();

} // namespace tautline

#endif
