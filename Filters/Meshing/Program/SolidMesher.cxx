// SPDX-License-Identifier: BSD-3-Clause
#include "SolidMesher.h"

#include "Termination.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/VectorAlgebra.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifndef TETLIBRARY
#define TETLIBRARY // errors are thrown
#endif
#include <tetgen.h>

namespace tautline
{
namespace
{
int narrow(Index value, const char* what)
{
  if (value < 0 || value > std::numeric_limits<int>::max())
  {
    throw Error(std::string("TetGen cannot count that many ") + what);
  }
  return static_cast<int>(value);
}

void checkBoundary(const SolidBoundary& boundary)
{
  const auto points = static_cast<Index>(boundary.points.size() / 3);
  for (std::size_t i = 0; i < boundary.points.size(); ++i)
  {
    if (!std::isfinite(boundary.points[i]))
    {
      throw Error(
        "point " + std::to_string(i / 3) + " has a coordinate that is not a finite number");
    }
  }
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    for (const std::vector<Index>& polygon : boundary.facets[f].polygons)
    {
      for (const Index id : polygon)
      {
        if (id < 0 || id >= points)
        {
          throw Error("facet " + std::to_string(f) + " has a point that does not exist");
        }
      }
    }
  }
  if (points < 4 || boundary.facets.size() < 4)
  {
    throw Error("a closed surface has at least 4 points and 4 facets; this one has " +
      std::to_string(points) + " and " + std::to_string(boundary.facets.size()));
  }
}

double* copy(const std::vector<double>& values)
{
  auto* memory = new REAL[values.size() + 1]; // tetgenio deletes it
  std::copy(values.begin(), values.end(), memory);
  return memory;
}

void setFacet(const SolidFacet& from, tetgenio::facet& to)
{
  tetgenio::init(&to);
  to.numberofpolygons = narrow(static_cast<Index>(from.polygons.size()), "polygons");
  to.polygonlist = new tetgenio::polygon[from.polygons.size()];
  for (std::size_t p = 0; p < from.polygons.size(); ++p)
  {
    tetgenio::polygon& polygon = to.polygonlist[p];
    tetgenio::init(&polygon);
    polygon.numberofvertices = narrow(static_cast<Index>(from.polygons[p].size()), "corners");
    polygon.vertexlist = new int[from.polygons[p].size()];
    std::transform(from.polygons[p].begin(), from.polygons[p].end(), polygon.vertexlist,
      [](Index id) { return static_cast<int>(id); });
  }
  if (!from.holes.empty())
  {
    to.numberofholes = narrow(static_cast<Index>(from.holes.size()), "holes");
    to.holelist = new REAL[3 * from.holes.size()];
    for (std::size_t h = 0; h < from.holes.size(); ++h)
    {
      std::copy(from.holes[h].begin(), from.holes[h].end(), to.holelist + 3 * h);
    }
  }
}

/// @param numbers whether facets are marked by their number, from 1, instead of their marker
void setInput(
  const SolidBoundary& boundary, const SolidOptions& options, bool numbers, tetgenio& in)
{
  in.numberofpoints = narrow(static_cast<Index>(boundary.points.size() / 3), "points");
  in.pointlist = copy(boundary.points);
  in.numberoffacets = narrow(static_cast<Index>(boundary.facets.size()), "facets");
  in.facetlist = new tetgenio::facet[boundary.facets.size()];
  in.facetmarkerlist = new int[boundary.facets.size()];
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    setFacet(boundary.facets[f], in.facetlist[f]);
    in.facetmarkerlist[f] = numbers ? static_cast<int>(f) + 1 : boundary.facets[f].marker;
  }
  if (!boundary.holes.empty())
  {
    in.numberofholes = narrow(static_cast<Index>(boundary.holes.size() / 3), "holes");
    in.holelist = copy(boundary.holes);
  }
  if (!options.regions.empty())
  {
    in.numberofregions = narrow(static_cast<Index>(options.regions.size() / 5), "regions");
    in.regionlist = copy(options.regions);
  }
  if (!options.pointSizes.empty())
  {
    in.numberofpointmtrs = 1;
    in.pointmtrlist = copy(options.pointSizes);
  }
}

/// Writes a vector, or an array of TetGen, after its length.
template <class To, class From>
void send(int pipe, const From* values, std::size_t count)
{
  const std::vector<To> copied(values, values + (values ? count : 0));
  const auto write = [pipe](const void* from, std::size_t size)
  {
    const char* bytes = static_cast<const char*>(from);
    while (size > 0)
    {
      const ssize_t written = ::write(pipe, bytes, size);
      if (written < 0 && errno != EINTR)
      {
        _exit(1);
      }
      bytes += std::max<ssize_t>(0, written);
      size -= static_cast<std::size_t>(std::max<ssize_t>(0, written));
    }
  };
  const std::uint64_t length = copied.size();
  write(&length, sizeof(length));
  write(copied.data(), length * sizeof(To));
}

/// Takes a vector from the start of the received bytes; false if there are too few.
template <class Value>
bool receive(const std::vector<char>& bytes, std::size_t& at, std::vector<Value>& values)
{
  std::uint64_t length = 0;
  if (bytes.size() - at < sizeof(length))
  {
    return false;
  }
  std::memcpy(&length, bytes.data() + at, sizeof(length));
  at += sizeof(length);
  if (length > (bytes.size() - at) / sizeof(Value))
  {
    return false;
  }
  values.resize(length);
  if (length > 0)
  {
    std::memcpy(values.data(), bytes.data() + at, length * sizeof(Value));
  }
  at += length * sizeof(Value);
  return true;
}

/// A folder for the files that TetGen 1.6 writes if facets intersect; removed at the end.
class ScratchFolder
{
public:
  ScratchFolder()
  {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "tautline-XXXXXX").string();
    if (error || !::mkdtemp(name.data()))
    {
      throw Error("no folder for temporary files of TetGen: " +
        (error ? error.message() : std::string(std::strerror(errno))));
    }
    this->Path = name;
  }
  ~ScratchFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return this->Path; }

  /// The markers of the facets that TetGen has left out because they intersect others.
  std::vector<int> skippedMarkers() const
  {
    std::vector<int> markers;
    std::ifstream file(std::filesystem::path(this->Path) / "tetgen-tmpfile_skipped.face");
    Index count = 0, number, a, b, c;
    int marker = 0;
    file >> count >> number; // whether there are markers
    while (file >> number >> a >> b >> c >> marker)
    {
      markers.push_back(marker);
    }
    return markers;
  }

private:
  std::string Path;
};

/// Runs TetGen in a separate process and writes its result to the pipe. Does not return.
[[noreturn]] void work(const std::string& switches, const SolidBoundary& boundary,
  const SolidOptions& options, bool numbers, double available, const std::string& folder, int pipe)
{
  constexpr int notBegun = 10;
  if (::chdir(folder.c_str()) != 0)
  {
    _exit(notBegun);
  }
  const rlimit noCore = { 0, 0 };
  setrlimit(RLIMIT_CORE, &noCore);
  limitMemory(available); // TetGen reports a lack of memory; the system would kill a process
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO); // TetGen prints even with -Q
  ::dup2(nowhere, STDERR_FILENO);
  int code = 0;
  try
  {
    // never deleted: the process ends here
    auto& in = *new tetgenio;
    auto& out = *new tetgenio;
    setInput(boundary, options, numbers, in);
    std::vector<char> text(switches.begin(), switches.end());
    text.push_back('\0');
    tetgenbehavior behavior;
    if (!behavior.parse_commandline(text.data()))
    {
      _exit(notBegun);
    }
    tetrahedralize(&behavior, &in, &out);
    const auto points = static_cast<std::size_t>(out.numberofpoints);
    const auto cells = static_cast<std::size_t>(out.numberoftetrahedra);
    const auto faces = static_cast<std::size_t>(out.numberoftrifaces);
    std::vector<int> references(cells, 0);
    for (std::size_t t = 0; t < cells && out.numberoftetrahedronattributes > 0; ++t)
    {
      const std::size_t at = t * static_cast<std::size_t>(out.numberoftetrahedronattributes);
      references[t] = static_cast<int>(std::lround(out.tetrahedronattributelist[at]));
    }
    send<double>(pipe, out.pointlist, 3 * points);
    send<Index>(pipe, out.tetrahedronlist, 4 * cells);
    send<int>(pipe, references.data(), cells);
    send<Index>(pipe, out.trifacelist, 3 * faces);
    send<int>(pipe, out.trifacemarkerlist, faces);
  }
  catch (const int thrown)
  {
    code = thrown;
  }
  catch (const std::bad_alloc&)
  {
    code = 1;
  }
  catch (...)
  {
    code = 2;
  }
  _exit(code);
}

constexpr int Crashed = -1;
constexpr int Stopped = -2;
constexpr int TooLong = -3;

/// Reads the pipe until it closes or a stop is requested; 0, Stopped or TooLong.
int readAll(int pipe, const TerminationSignal& termination, const SolidOptions& options,
  std::vector<char>& bytes)
{
  using Clock = std::chrono::steady_clock;
  constexpr int Milliseconds = 200;
  const auto start = Clock::now();
  std::vector<char> buffer(1 << 16);
  while (true)
  {
    pollfd files[] = { { pipe, POLLIN, 0 }, { termination.file(), POLLIN, 0 } };
    const int ready = ::poll(files, std::size(files), Milliseconds);
    if (ready > 0 && files[1].revents != 0)
    {
      return Stopped;
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (ready == 0 && options.timeLimit > 0.0 && seconds > options.timeLimit)
    {
      return TooLong;
    }
    const ssize_t count = ready > 0 ? ::read(pipe, buffer.data(), buffer.size()) : -1;
    if (count == 0 || (count < 0 && ready > 0 && errno != EINTR))
    {
      return 0;
    }
    bytes.insert(bytes.end(), buffer.data(), buffer.data() + std::max<ssize_t>(0, count));
  }
}

/**
 * Runs TetGen; 0, the number it throws, Crashed, Stopped or TooLong. It runs in a child process:
 * TetGen 1.5 frees its memory twice when it throws, which would end this program as well, and some
 * inputs make it loop or crash. The child ends with this process; SIGTERM to this process first
 * ends the child and removes the folder of its files. If TetGen 1.6 throws, the mesh has the
 * markers of the facets that intersect others.
 */
int run(const std::string& switches, const SolidBoundary& boundary, const SolidOptions& options,
  bool numbers, SolidMesh& mesh)
{
  const TerminationSignal termination;
  const ScratchFolder folder;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
  {
    throw Error(std::string("no pipe for TetGen: ") + std::strerror(errno));
  }
  const double available = availableMemory();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0)
  {
    if (!endWithParent(parent, SIGKILL))
    {
      _exit(1);
    }
    termination.release();
    ::close(ends[0]);
    work(switches, boundary, options, numbers, available, folder.path(), ends[1]);
  }
  ::close(ends[1]);
  std::vector<char> bytes;
  const int ended = child > 0 ? readAll(ends[0], termination, options, bytes) : 0;
  ::close(ends[0]);
  if (child < 0)
  {
    throw Error(std::string("no process for TetGen: ") + std::strerror(errno));
  }
  if (ended != 0)
  {
    ::kill(child, SIGKILL);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  if (ended != 0)
  {
    return ended;
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
  {
    mesh.faceMarkers = folder.skippedMarkers();
    return WIFEXITED(status) ? WEXITSTATUS(status) : Crashed;
  }
  std::size_t at = 0;
  const bool complete = receive(bytes, at, mesh.points) && receive(bytes, at, mesh.tetrahedra) &&
    receive(bytes, at, mesh.references) && receive(bytes, at, mesh.faces) &&
    receive(bytes, at, mesh.faceMarkers);
  return complete ? 0 : Crashed;
}

/// "facets 3, 17", as marked by TetGen's search for intersections; empty if there are none.
std::string intersectingFacets(const SolidBoundary& boundary, SolidOptions options)
{
  constexpr double Seconds = 60.0;
  options.pointSizes.clear();
  options.timeLimit = Seconds;
  SolidMesh mesh;
  const int code = run("pdQz", boundary, options, true, mesh);
  if (code != 0 && mesh.faceMarkers.empty())
  {
    return {};
  }
  const std::set<int> numbers(mesh.faceMarkers.begin(), mesh.faceMarkers.end());
  std::string list;
  int listed = 0;
  for (const int number : numbers)
  {
    if (number >= 1 && number <= static_cast<int>(boundary.facets.size()) && ++listed <= 10)
    {
      list += (list.empty() ? "facets " : ", ") + std::to_string(number - 1);
    }
  }
  return listed > 10 ? list + " and " + std::to_string(listed - 10) + " more" : list;
}

[[noreturn]] void fail(int code, const SolidBoundary& boundary, const SolidOptions& options)
{
  if (code == Stopped)
  {
    throw Error("stopped");
  }
  if (code == TooLong)
  {
    throw Error("TetGen did not finish within the time limit; allow more time or larger "
                "tetrahedra, or check the surface for very small angles");
  }
  if (code == 1)
  {
    throw Error("TetGen: not enough memory; allow larger tetrahedra");
  }
  const std::string facets = intersectingFacets(boundary, options);
  if (!facets.empty())
  {
    throw Error("the surface intersects itself: " + facets + "; repair it, then mesh it");
  }
  throw Error(
    "TetGen failed: is the surface closed, without duplicate, degenerate or nearly touching "
    "facets? Merge duplicate points first (Clean to Grid), or preserve the surface");
}

/// A positive number with all its digits and without an exponent, which TetGen cannot read.
std::string withoutExponent(double value)
{
  constexpr int digits = std::numeric_limits<double>::max_digits10;
  const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(value))));
  const int length = std::snprintf(nullptr, 0, "%.*f", decimals, value);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  text.pop_back(); // the null
  return text;
}

/// The power of two that scales the largest coordinate to between 1 and 2, without rounding.
double unitScale(const std::vector<double>& points)
{
  double largest = 0.0;
  for (const double x : points)
  {
    largest = std::max(largest, std::abs(x));
  }
  return largest >= std::numeric_limits<double>::min() ? std::ldexp(1.0, -std::ilogb(largest))
                                                       : 1.0;
}

void scale(std::vector<double>& lengths, double by)
{
  for (double& length : lengths)
  {
    length *= by;
  }
}

/// TetGen 1.6 compares lengths and volumes with absolute thresholds.
void scaleInput(SolidBoundary& boundary, SolidOptions& options, double by)
{
  scale(boundary.points, by);
  scale(boundary.holes, by);
  for (SolidFacet& facet : boundary.facets)
  {
    for (auto& hole : facet.holes)
    {
      for (double& x : hole)
      {
        x *= by;
      }
    }
  }
  scale(options.pointSizes, by);
  // Multiplies factor by factor: the cube of the scale alone may be infinite.
  const auto volumeOf = [by](double volume) { return volume * by * by * by; };
  options.volume = volumeOf(options.volume);
  constexpr std::size_t perRegion = 5, place = 3; // x y z, reference, volume
  for (std::size_t i = 0; i < options.regions.size(); ++i)
  {
    double& number = options.regions[i];
    number = i % perRegion < place ? by * number
      : i % perRegion > place      ? volumeOf(number)
                                   : number;
  }
}

double largestVolume(const SolidMesh& mesh)
{
  double largest = 0.0;
  for (std::size_t t = 0; t + 3 < mesh.tetrahedra.size(); t += 4)
  {
    const auto at = [&](std::size_t k)
    {
      const double* p = mesh.points.data() + 3 * mesh.tetrahedra[t + k];
      return Vec3{ p[0], p[1], p[2] };
    };
    const Vec3 a = at(0);
    largest = std::max(largest, std::abs(dot(cross(at(1) - a, at(2) - a), at(3) - a)) / 6.0);
  }
  return largest;
}

std::string switchesFor(const SolidOptions& options)
{
  char text[128];
  std::string switches = "pzQ";
  if (options.radiusEdgeRatio > 0.0)
  {
    std::snprintf(
      text, sizeof(text), "q%.6g/%.6g", options.radiusEdgeRatio, options.minimumDihedralAngle);
    switches += text;
  }
  if (options.volume > 0.0)
  {
    switches += "a" + withoutExponent(options.volume);
  }
  switches += options.regions.empty() ? "" : "Aa";
  switches += options.pointSizes.empty() ? "" : "m";
  switches += options.preserveSurface ? "Y" : "";
  return switches;
}

/// Repeats run() until no tetrahedron exceeds the volume bound, which TetGen 1.6 exceeds by up to a
/// half. Not with a preserved surface, whose facets may require larger ones. Returns the best mesh
/// so far if a later run fails or does not help.
int runWithin(const SolidBoundary& boundary, SolidOptions options, SolidMesh& mesh)
{
  using Clock = std::chrono::steady_clock;
  constexpr int mostRuns = 6;
  constexpr double rounding = 1e-9, reserve = 0.95, leastShare = 0.4;
  const double wanted = options.volume, limit = options.timeLimit;
  const auto start = Clock::now();
  double best = std::numeric_limits<double>::infinity();
  for (int i = 1;; ++i)
  {
    SolidMesh next;
    const int code = run(switchesFor(options), boundary, options, false, next);
    if (code != 0)
    {
      return i == 1 || code == Stopped ? code : 0;
    }
    const double largest = largestVolume(next);
    const bool better = largest < best;
    if (better)
    {
      mesh = std::move(next);
      best = largest;
    }
    const double bound = std::max(options.volume * reserve * wanted / largest, leastShare * wanted);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!(wanted > 0.0) || options.preserveSurface || !better ||
      best <= wanted * (1.0 + rounding) || i == mostRuns || bound >= options.volume ||
      (limit > 0.0 && seconds >= limit))
    {
      return 0;
    }
    options.volume = bound;
    options.timeLimit = limit > 0.0 ? limit - seconds : 0.0;
  }
}
}

//------------------------------------------------------------------------------
SolidMesh meshSolid(const SolidBoundary& given, const SolidOptions& wanted)
{
  checkBoundary(given);
  SolidBoundary boundary = given;
  SolidOptions options = wanted;
  const double unit = unitScale(boundary.points);
  scaleInput(boundary, options, unit);
  if (!options.pointSizes.empty() && options.pointSizes.size() != boundary.points.size() / 3)
  {
    throw Error("there must be one size for each point");
  }
  if (options.radiusEdgeRatio != 0.0 && !(options.radiusEdgeRatio > 1.0))
  {
    throw Error("the radius-edge ratio must be larger than 1, or 0 for no bound");
  }
  SolidMesh mesh;
  const int code = runWithin(boundary, options, mesh);
  if (code != 0)
  {
    fail(code, boundary, options);
  }
  if (mesh.tetrahedra.empty())
  {
    throw Error(
      "there is no region inside the surface: is it closed, and do the holes leave a region?");
  }
  scale(mesh.points, 1.0 / unit);
  mesh.faceMarkers.resize(mesh.faces.size() / 3, 1);
  mesh.pointMarkers.assign(mesh.points.size() / 3, 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
  {
    const int value = mesh.faceMarkers[i / 3];
    int& marker = mesh.pointMarkers[static_cast<std::size_t>(mesh.faces[i])];
    marker = marker == 0 || (value != 0 && value < marker) ? value : marker;
  }
  return mesh;
}
}
