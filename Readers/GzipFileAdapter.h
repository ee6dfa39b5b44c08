// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GzipFileAdapter.h
 * @brief Reads and writes files compressed with gzip, using VTK's zlib. Internal: not installed.
 */
#ifndef tautline_GzipFileAdapter_h
#define tautline_GzipFileAdapter_h

#include "TextCursor.h"

namespace tautline
{
/// The content of a compressed file; several members are concatenated. Throws FileError if it is
/// damaged or truncated.
std::string gunzipped(const FileContent& packed);

/// The same bytes compressed.
std::string gzipped(const std::string& bytes);
}
#endif
