// SPDX-License-Identifier: BSD-3-Clause
#include "FileSet.h"

#include <cstdio>

namespace tautline
{
namespace
{
constexpr std::string_view Title = "# Tautline set ";
constexpr std::size_t Digits = 16;

/// The mark in the last line of a file, or "".
std::string markOf(const FileContent& file)
{
  std::string_view text(file.begin(), static_cast<std::size_t>(file.end() - file.begin()));
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  const std::size_t size = Title.size() + Digits;
  const std::string_view last = text.substr(text.size() - std::min(size, text.size()));
  return std::string(last.substr(0, Title.size()) == Title ? last.substr(Title.size()) : "");
}
}

//------------------------------------------------------------------------------
std::vector<std::string> replaceSet(std::vector<TextOutput>& files)
{
  // The mark depends only on the contents: the same mesh gives the same files.
  std::uint64_t sum = 0;
  for (const TextOutput& file : files)
  {
    sum = combine(sum, file.checkSum());
  }
  char digits[Digits + 1];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(sum));
  std::vector<AtomicFile> finished;
  std::vector<std::string> names;
  for (TextOutput& file : files)
  {
    if (files.size() > 1)
    {
      file << Title << std::string_view(digits) << '\n';
    }
    finished.push_back(file.finish());
    names.push_back(finished.back().name());
  }
  replaceAll(finished);
  return names;
}

//------------------------------------------------------------------------------
const FileContent& SetCheck::add(const FileContent& file)
{
  const std::string mark = markOf(file);
  if (!mark.empty() && !this->Mark.empty() && mark != this->Mark)
  {
    throw FileError(file.name() + ": does not belong to " + this->Name +
      ": the marks in their last lines differ, because a writer was interrupted or a file was "
      "replaced; write the mesh again, or remove these lines if the files do belong together");
  }
  if (!mark.empty())
  {
    this->Mark = mark;
    this->Name = file.name();
  }
  return file;
}
}
