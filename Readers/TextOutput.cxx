#include "TextOutput.h"

#include <cerrno>
#include <cstring>

namespace tautline
{
namespace
{
constexpr std::size_t BufferSize = std::size_t{ 1 } << 20;
}

//------------------------------------------------------------------------------
TextOutput::TextOutput(const std::string& name)
  : Name(name)
  , File(std::fopen((name + ".part").c_str(), "wb"))
{
  if (!this->File)
  {
    throw FileError(name + ": cannot be written: " + std::strerror(errno));
  }
  this->Buffer.reserve(BufferSize + 4096);
}

//------------------------------------------------------------------------------
TextOutput::~TextOutput()
{
  if (this->File)
  {
    std::fclose(this->File);
    std::remove((this->Name + ".part").c_str());
  }
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
  if (this->Buffer.size() > BufferSize)
  {
    this->flush();
  }
}

//------------------------------------------------------------------------------
void TextOutput::flush()
{
  if (std::fwrite(this->Buffer.data(), 1, this->Buffer.size(), this->File) != this->Buffer.size())
  {
    throw FileError(this->Name + ": cannot be written: " + std::strerror(errno));
  }
  this->Buffer.clear();
}

//------------------------------------------------------------------------------
void TextOutput::close()
{
  this->flush();
  const bool closed = std::fclose(this->File) == 0;
  this->File = nullptr;
  const std::string part = this->Name + ".part";
  if (!closed || std::rename(part.c_str(), this->Name.c_str()) != 0)
  {
    const std::string reason = std::strerror(errno);
    std::remove(part.c_str());
    throw FileError(this->Name + ": cannot be written: " + reason);
  }
}
}
