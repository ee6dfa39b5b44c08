#include "TextOutput.h"

#include <utility>

namespace tautline
{
namespace
{
constexpr std::size_t BufferSize = std::size_t{ 1 } << 20;
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
  if (this->Buffer.size() > BufferSize)
  {
    this->flush();
  }
}

//------------------------------------------------------------------------------
void TextOutput::flush()
{
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
