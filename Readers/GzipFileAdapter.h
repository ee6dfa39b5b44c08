// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GzipFileAdapter.h
 * @brief Files compressed by gzip, through the zlib that VTK has.
 * Internal: not installed.
 */
#ifndef tautline_GzipFileAdapter_h
#define tautline_GzipFileAdapter_h

#include "TextCursor.h"

namespace tautline
{
/// The content of a compressed file; of several members one after the other. Throws FileError where
/// it is damaged or truncated.
std::string gunzipped(const FileContent& packed);

/// The same bytes compressed.
std::string gzipped(const std::string& bytes);
}
#endif
