// SPDX-License-Identifier: BSD-3-Clause
#include "FoamPoints.h"

#include "ArrayIndex.h"
#include "AtomicFile.h"
#include "FileNames.h"
#include "FoamFile.h"
#include "GzipFileAdapter.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// The new bytes of a points file.
class PointsRewriter
{
public:
  PointsRewriter(const FoamContent& content, const std::vector<double>& points)
    : Content(content)
    , Cursor(content.text())
    , Points(points)
  {
  }

  FoamPointsContent rewrite()
  {
    const FoamCursor::Places places = this->Cursor.openPoints();
    this->checkCount(places.count < 0 ? this->countText() : places.count);
    const auto bytes =
      static_cast<std::size_t>(this->Content.text().end() - this->Content.text().begin());
    this->Result.bytes.reserve(bytes + bytes / 8);
    if (this->Cursor.header().binary && places.count >= 0)
    {
      this->Cursor.header().scalarBytes == 8 ? this->rewriteBinary<double>(places.first)
                                             : this->rewriteBinary<float>(places.first);
    }
    else
    {
      this->rewriteText();
    }
    this->Result.bytes.append(this->Kept, this->Content.text().end());
    this->Result.name = this->Content.packed.name();
    if (this->Content.compressed)
    {
      this->Result.bytes = gzipped(this->Result.bytes);
    }
    return std::move(this->Result);
  }

private:
  /// The number of points of a list without a count.
  Index countText()
  {
    const char* begin = this->Cursor.place();
    Index count = 0;
    for (; !this->Cursor.take(')'); ++count)
    {
      this->Cursor.openVector();
      std::for_each(std::begin(Axes), std::end(Axes), [this](int) { this->Cursor.coordinate(); });
      this->Cursor.closeVector();
    }
    this->Cursor.moveTo(begin);
    return count;
  }

  void checkCount(Index count) const
  {
    const auto expected = static_cast<Index>(this->Points.size() / 3);
    if (count != expected)
    {
      throw FileError(this->Content.packed.name() + ": has " + std::to_string(count) +
        " points, and the mesh has " + std::to_string(expected));
    }
  }

  void rewriteText()
  {
    this->Kept = this->Content.text().begin();
    char text[40];
    for (std::size_t i = 0; i < this->Points.size(); i += 3)
    {
      this->Cursor.countRecord();
      this->Cursor.openVector();
      for (const int axis : Axes)
      {
        this->Cursor.skipSpace();
        const char* begin = this->Cursor.place();
        const double old = this->Cursor.coordinate();
        const double value = this->Points[i + static_cast<std::size_t>(axis)];
        if (value != old)
        {
          this->Result.bytes.append(this->Kept, begin);
          const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
          this->Result.bytes.append(text, end);
          this->Kept = this->Cursor.place();
        }
      }
      this->Cursor.closeVector();
    }
  }

  template <class T>
  void rewriteBinary(const char* first)
  {
    this->Result.bytes.append(this->Content.text().begin(), first);
    const char* at = first;
    for (std::size_t i = 0; i < this->Points.size(); ++i, at += sizeof(T))
    {
      pollInterruption(static_cast<Index>(i));
      char bytes[sizeof(T)];
      const auto load = [&](const char* from)
      {
        std::copy_n(from, sizeof(T), bytes);
        if (this->Cursor.header().swapped)
        {
          std::reverse(bytes, bytes + sizeof(T));
        }
      };
      load(at);
      T old;
      std::memcpy(&old, bytes, sizeof(T));
      const double value = this->Points[i];
      if (value != static_cast<double>(old))
      {
        if (std::abs(value) > static_cast<double>(std::numeric_limits<T>::max()))
        {
          throw FileError(this->Content.packed.name() + ": coordinate " + std::to_string(i % 3) +
            " of point " + std::to_string(i / 3) + " is too large for numbers of 4 bytes");
        }
        const T made = static_cast<T>(value);
        this->Result.rounding =
          std::max(this->Result.rounding, std::abs(static_cast<double>(made) - value));
        std::memcpy(bytes, &made, sizeof(T));
        const std::string native(bytes, sizeof(T));
        load(native.data());
        this->Result.bytes.append(bytes, sizeof(T));
      }
      else
      {
        this->Result.bytes.append(at, sizeof(T));
      }
    }
    this->Kept = at;
  }

  static constexpr int Axes[] = { 0, 1, 2 };

  const FoamContent& Content;
  FoamCursor Cursor;
  const std::vector<double>& Points;
  FoamPointsContent Result;
  const char* Kept = nullptr; ///< start of the part that is not yet in the result
};

AtomicFile completeFile(const std::string& name, const char* bytes, std::size_t size)
{
  AtomicFile file(name);
  file.write(bytes, size);
  file.finish();
  return file;
}

/// The name of the copy of a points file.
std::string originalName(const std::string& name)
{
  const auto [stem, ending] = splitExtension(name);
  return ending == "gz" ? stem + ".orig.gz" : name + ".orig";
}
}

//------------------------------------------------------------------------------
FoamPointsContent withFoamPoints(const std::string& folder, const std::vector<double>& points)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!std::isfinite(points[i]))
    {
      throw FileError(folder + "/points: cannot be written: coordinate " + std::to_string(i % 3) +
        " of point " + std::to_string(i / 3) + " is not a finite number");
    }
  }
  const FoamContent content(folder + "/points", "the points of the case");
  return PointsRewriter(content, points).rewrite();
}

//------------------------------------------------------------------------------
std::vector<std::string> writeFoamPoints(const std::vector<std::string>& folders,
  const std::vector<std::vector<Index>>& numbers, const std::vector<double>& points,
  bool keepOriginal, double* rounding)
{
  std::vector<AtomicFile> files, originals;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < folders.size(); ++i)
  {
    std::vector<double> own;
    for (const Index point : numbers.empty() ? std::vector<Index>() : numbers[i])
    {
      own.insert(own.end(), points.begin() + 3 * point, points.begin() + 3 * point + 3);
    }
    const FoamPointsContent made = withFoamPoints(folders[i], numbers.empty() ? points : own);
    if (rounding)
    {
      *rounding = std::max(*rounding, made.rounding);
    }
    const std::string original = originalName(made.name);
    if (keepOriginal && !fileExists(original))
    {
      const FileContent older(made.name);
      originals.push_back(completeFile(
        original, older.begin(), static_cast<std::size_t>(older.end() - older.begin())));
    }
    files.push_back(completeFile(made.name, made.bytes.data(), made.bytes.size()));
    names.push_back(made.name);
  }
  // replaceAll() begins with the last
  std::move(originals.begin(), originals.end(), std::back_inserter(files));
  replaceAll(files);
  return names;
}
}
