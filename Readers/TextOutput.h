// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextOutput.h
 * @brief Text written through one large buffer, numbers in the fewest digits that read back the
 * same.
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
/// A failure leaves an older file as it was, see AtomicFile.
class TextOutput
{
public:
  /// Throws FileError when the file cannot be created.
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
  /// The value i of an array, in the form of its type.
  void value(const MeshArray& array, std::size_t i);
  /// Bytes as they are in memory.
  template <class T>
  void binary(const T& value)
  {
    this->Buffer.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// Ends a line and hands full buffers to the system.
  void endLine();
  /// Hands full buffers to the system, for records that are no lines.
  void endRecord();
  /// A check sum of the content so far, not of cryptographic strength.
  std::uint64_t checkSum() const;
  /// The complete file, to be replaced with others; throws FileError when a byte was not written.
  AtomicFile finish();
  /// Replaces the file; throws FileError when anything could not be written.
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
  std::uint64_t FlushedSum = 0; ///< of what is no longer in the buffer
};

/// A check sum of two check sums in this order.
std::uint64_t combine(std::uint64_t first, std::uint64_t second);
}
#endif
