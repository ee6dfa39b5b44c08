// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextOutput.h
 * @brief Writes text through one large buffer, with the shortest numbers that read back the same.
 */
#ifndef tautline_TextOutput_h
#define tautline_TextOutput_h

#include "AtomicFile.h"
#include "MeshFile.h"

#include <charconv>
#include <cstdint>
#include <string_view>

namespace tautline
{
/// A failure leaves an existing file unchanged, see AtomicFile.
class TextOutput
{
public:
  /// Throws FileError if the file cannot be created.
  explicit TextOutput(const std::string& name);
  TextOutput(TextOutput&&) noexcept = default;
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;

  TextOutput& operator<<(std::string_view text)
  {
    this->Buffer.append(text);
    return *this;
  }
  TextOutput& operator<<(char c)
  {
    this->Buffer.push_back(c);
    return *this;
  }
  TextOutput& operator<<(double value) { return this->number(value); }
  TextOutput& operator<<(Index value) { return this->number(value); }
  TextOutput& operator<<(int value) { return this->number(value); }
  /// Writes value i of an array, in the format of its type.
  void value(const MeshArray& array, std::size_t i);
  /// Writes the bytes in memory.
  template <class T>
  void binary(const T& value)
  {
    this->Buffer.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// Ends a line and passes full buffers to the system.
  void endLine();
  /// Passes full buffers to the system, for records that are not lines.
  void endRecord();
  /// A checksum of the content so far, without cryptographic strength.
  std::uint64_t checkSum() const;
  /// The complete file, to be replaced together with others; throws FileError if a byte was not
  /// written.
  AtomicFile finish();
  /// Replaces the file; throws FileError if not everything could be written.
  void close();

private:
  template <class T>
  TextOutput& number(T value)
  {
    char text[40];
    const auto result = std::to_chars(text, text + sizeof(text), value);
    this->Buffer.append(text, static_cast<std::size_t>(result.ptr - text));
    return *this;
  }
  void flush();

  AtomicFile File;
  std::string Buffer;
  std::uint64_t FlushedSum = 0; ///< checksum of flushed content
};

/// A checksum of two checksums in this order.
std::uint64_t combine(std::uint64_t first, std::uint64_t second);
}
#endif
