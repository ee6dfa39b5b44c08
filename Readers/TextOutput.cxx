// SPDX-License-Identifier: BSD-3-Clause
#include "TextOutput.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tautline
{
namespace
{
constexpr std::size_t BufferSize = std::size_t{ 1 } << 20;

/// Mixes the bits of a number (the finalizer of MurmurHash3, public domain).
std::uint64_t mix(std::uint64_t bits)
{
  bits = (bits ^ bits >> 33) * 0xff51afd7ed558ccdu;
  bits = (bits ^ bits >> 33) * 0xc4ceb9fe1a85ec53u;
  return bits ^ bits >> 33;
}

/// Processes eight bytes at a time.
std::uint64_t sumOf(std::uint64_t sum, std::string_view text)
{
  sum = combine(sum, text.size());
  for (std::size_t i = 0; i < text.size(); i += sizeof(std::uint64_t))
  {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, text.data() + i, std::min(sizeof(bytes), text.size() - i));
    sum = combine(sum, bytes);
  }
  return sum;
}
}

//------------------------------------------------------------------------------
std::uint64_t combine(std::uint64_t first, std::uint64_t second)
{
  return mix(first + 0x9e3779b97f4a7c15u + mix(second));
}

//------------------------------------------------------------------------------
TextOutput::TextOutput(const std::string& name)
  : File(name)
{
  this->Buffer.reserve(BufferSize + 4096);
}

//------------------------------------------------------------------------------
void TextOutput::value(const MeshArray& array, std::size_t i)
{
  if (const auto* doubles = std::get_if<MeshArray::Doubles>(&array.values))
  {
    *this << (*doubles)[i];
  }
  else if (const auto* integers = std::get_if<MeshArray::Integers>(&array.values))
  {
    *this << (*integers)[i];
  }
  else
  {
    *this << static_cast<int>(std::get<MeshArray::Bytes>(array.values)[i]);
  }
}

//------------------------------------------------------------------------------
void TextOutput::endLine()
{
  this->Buffer.push_back('\n');
  this->endRecord();
}

//------------------------------------------------------------------------------
void TextOutput::endRecord()
{
  if (this->Buffer.size() > BufferSize)
  {
    this->flush();
  }
}

//------------------------------------------------------------------------------
std::uint64_t TextOutput::checkSum() const
{
  return sumOf(this->FlushedSum, this->Buffer);
}

//------------------------------------------------------------------------------
void TextOutput::flush()
{
  throwIfInterrupted();
  this->FlushedSum = this->checkSum();
  this->File.write(this->Buffer.data(), this->Buffer.size());
  this->Buffer.clear();
}

//------------------------------------------------------------------------------
AtomicFile TextOutput::finish()
{
  this->flush();
  this->File.finish();
  return std::move(this->File);
}

//------------------------------------------------------------------------------
void TextOutput::close()
{
  AtomicFile file = this->finish();
  file.replace();
  file.syncName();
}
}
