// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileNames.h
 * @brief Splitting file names and finding companion files.
 */
#ifndef tautline_FileNames_h
#define tautline_FileNames_h

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include <sys/stat.h>

namespace tautline
{
/// "a/b.1.NODE" gives "a/b.1" and "node"; without an extension, the name and "".
inline std::pair<std::string, std::string> splitExtension(const std::string& name)
{
  const std::size_t dot = name.find_last_of("./\\");
  if (dot == name.npos || name[dot] != '.')
  {
    return { name, "" };
  }
  std::string extension = name.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return { name.substr(0, dot), extension };
}

inline bool fileExists(const std::string& name)
{
  struct stat status;
  return stat(name.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}
}
#endif
