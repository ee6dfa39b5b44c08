// SPDX-License-Identifier: BSD-3-Clause
#include "GzipFileAdapter.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"

#include "vtk_zlib.h"

#include <algorithm>
#include <limits>
#include <new>

namespace tautline
{
//------------------------------------------------------------------------------
std::string gunzipped(const FileContent& packed)
{
  constexpr std::size_t Step = std::size_t{ 1 } << 22;
  constexpr int AnyHeader = MAX_WBITS + 32; // of zlib or gzip
  std::string bytes;
  z_stream stream = {};
  if (inflateInit2(&stream, AnyHeader) != Z_OK)
  {
    throw std::bad_alloc();
  }
  struct End
  {
    z_stream* stream;
    ~End() { inflateEnd(this->stream); }
  } end{ &stream };
  const char* at = packed.begin();
  int state = Z_OK;
  std::size_t size = 0;
  while (state != Z_STREAM_END || at != packed.end())
  {
    throwIfInterrupted();
    if (state == Z_STREAM_END)
    {
      inflateReset(&stream);
    }
    if (size == bytes.size())
    {
      const std::size_t more = std::max(Step, size / 2);
      requireMemory(static_cast<double>(size + more), "the content of " + packed.name(),
        "the file expands endlessly: is it damaged?");
      bytes.resize(size + more);
    }
    constexpr std::size_t Most = std::numeric_limits<uInt>::max();
    const std::size_t in = std::min(Most, static_cast<std::size_t>(packed.end() - at));
    const std::size_t out = std::min(Most, bytes.size() - size);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(at));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + size);
    stream.avail_out = static_cast<uInt>(out);
    state = inflate(&stream, Z_NO_FLUSH);
    at += in - stream.avail_in;
    size += out - stream.avail_out;
    if (state != Z_OK && state != Z_STREAM_END)
    {
      const auto place = std::to_string(at - packed.begin());
      throw FileError(packed.name() + ": byte " + place +
        (state == Z_BUF_ERROR ? ": the compressed file is truncated"
                              : ": the compressed file is damaged"));
    }
  }
  bytes.resize(size);
  return bytes;
}

//------------------------------------------------------------------------------
std::string gzipped(const std::string& bytes)
{
  constexpr int GzipWindow = MAX_WBITS + 16, UsualMemory = 8;
  constexpr std::size_t Step = std::size_t{ 1 } << 20;
  z_stream stream = {};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, GzipWindow, UsualMemory,
        Z_DEFAULT_STRATEGY) != Z_OK)
  {
    throw std::bad_alloc();
  }
  std::string packed;
  std::size_t read = 0, written = 0;
  for (int state = Z_OK; state != Z_STREAM_END;)
  {
    const std::size_t in = std::min(Step, bytes.size() - read);
    packed.resize(written + Step);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + read));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(packed.data() + written);
    stream.avail_out = static_cast<uInt>(Step);
    state = deflate(&stream, read + in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    read += in - stream.avail_in;
    written += Step - stream.avail_out;
  }
  deflateEnd(&stream);
  packed.resize(written);
  return packed;
}
}
