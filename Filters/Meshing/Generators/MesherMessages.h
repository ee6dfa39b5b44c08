// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MesherMessages.h
 * @brief The messages between the library TautlineMeshGenerators and its program tautline-mesher.
 * Internal: not installed.
 *
 * Both have the same version and run on one machine, so numbers are sent in their memory format.
 * The library sends one request; the program sends Progress messages (planar requests only), then a
 * Result, a Failure or NoMemory. Each message consists of a MessageHeader and its bytes.
 */
#ifndef tautline_MesherMessages_h
#define tautline_MesherMessages_h

#include "PlanarMesher.h"
#include "SolidMesher.h"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tautline
{
enum class MesherMessage : std::int64_t
{
  Planar = 1, ///< PlanarBoundary, PlanarOptions
  Solid,      ///< SolidBoundary, SolidOptions
  Progress,   ///< the number of points, an Index
  Result,     ///< PlanarMesh or SolidMesh
  Failure,    ///< the text of an Error
  NoMemory    ///< nothing; std::bad_alloc
};

struct MessageHeader
{
  MesherMessage kind = MesherMessage::Failure;
  std::uint64_t bytes = 0; ///< number of bytes that follow
};

///@{
/// The fields of a structure in the order in which they are sent; functions are not sent.
template <class Archive>
void fields(Archive& archive, PlanarBoundary& boundary)
{
  archive(boundary.points, boundary.segments, boundary.markers, boundary.holes);
}
template <class Archive>
void fields(Archive& archive, PlanarOptions& options)
{
  archive(options.minimumAngle, options.size, options.pointSizes, options.gradation,
    options.holesGiven, options.pointLimit);
}
template <class Archive>
void fields(Archive& archive, PlanarMesh& mesh)
{
  archive(mesh.points, mesh.triangles, mesh.pointMarkers, mesh.edges, mesh.edgeMarkers);
}
template <class Archive>
void fields(Archive& archive, SolidFacet& facet)
{
  archive(facet.polygons, facet.holes, facet.marker);
}
template <class Archive>
void fields(Archive& archive, SolidBoundary& boundary)
{
  archive(boundary.points, boundary.facets, boundary.holes);
}
template <class Archive>
void fields(Archive& archive, SolidOptions& options)
{
  archive(options.radiusEdgeRatio, options.minimumDihedralAngle, options.volume, options.pointSizes,
    options.preserveSurface, options.regions, options.timeLimit);
}
template <class Archive>
void fields(Archive& archive, SolidMesh& mesh)
{
  archive(
    mesh.points, mesh.tetrahedra, mesh.references, mesh.pointMarkers, mesh.faces, mesh.faceMarkers);
}
///@}

/// Appends values to bytes.
class MessageWriter
{
public:
  template <class... Values>
  void operator()(Values&... values)
  {
    (this->put(values), ...);
  }

  std::vector<char> Bytes;

private:
  template <class Value>
  void put(Value& value)
  {
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      this->append(&value, sizeof(value));
    }
    else
    {
      fields(*this, value);
    }
  }
  template <class Value>
  void put(std::vector<Value>& values)
  {
    std::uint64_t count = values.size();
    this->put(count);
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      this->append(values.data(), values.size() * sizeof(Value));
    }
    else
    {
      for (Value& value : values)
      {
        this->put(value);
      }
    }
  }
  void append(const void* from, std::size_t size)
  {
    const char* bytes = static_cast<const char*>(from);
    this->Bytes.insert(this->Bytes.end(), bytes, bytes + size);
  }
};

/// Takes values from the start of bytes. Throws Error if there are too few.
class MessageReader
{
public:
  explicit MessageReader(const std::vector<char>& bytes)
    : Bytes(bytes)
  {
  }

  template <class... Values>
  void operator()(Values&... values)
  {
    (this->take(values), ...);
  }

private:
  template <class Value>
  void take(Value& value)
  {
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      this->copy(&value, 1, sizeof(value));
    }
    else
    {
      fields(*this, value);
    }
  }
  template <class Value>
  void take(std::vector<Value>& values)
  {
    std::uint64_t count = 0;
    this->take(count);
    this->require(count, std::is_trivially_copyable_v<Value> ? sizeof(Value) : 1);
    values.resize(count);
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      this->copy(values.data(), count, sizeof(Value));
    }
    else
    {
      for (Value& value : values)
      {
        this->take(value);
      }
    }
  }
  void require(std::uint64_t count, std::size_t size) const
  {
    if (count > (this->Bytes.size() - this->At) / size)
    {
      throw Error("a message of a mesh generator is incomplete");
    }
  }
  void copy(void* to, std::uint64_t count, std::size_t size)
  {
    this->require(count, size);
    if (count > 0)
    {
      std::memcpy(to, this->Bytes.data() + this->At, count * size);
    }
    this->At += count * size;
  }

  const std::vector<char>& Bytes;
  std::size_t At = 0;
};
}
#endif
