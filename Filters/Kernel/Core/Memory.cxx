// SPDX-License-Identifier: BSD-3-Clause
#include "Memory.h"

#include "Types.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <new>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>
#include <utility>

namespace tautline
{
namespace
{
constexpr double Unlimited = std::numeric_limits<double>::infinity();

/// The number after a word in a file of "word number" lines; `missing` if it is not there.
double valueAfter(const std::string& file, const std::string& word, double missing)
{
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
  {
    std::istringstream words(line);
    std::string first;
    double value = 0;
    if (words >> first >> value && first == word)
    {
      return value;
    }
  }
  return missing;
}

/// The number in a file; `missing` if there is no such file or it contains "max".
double valueIn(const std::string& file, double missing)
{
  std::ifstream stream(file);
  double value = 0;
  return stream >> value ? value : missing;
}

double freeOnMachine()
{
  constexpr double kibibyte = 1024;
  const double otherwise =
    static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return std::min(
    Unlimited, kibibyte * valueAfter("/proc/meminfo", "MemAvailable:", otherwise / kibibyte));
}

/// The memory left by a control group and its parents. The page cache counts as used but can be
/// reclaimed.
double leftByGroup(const std::string& root, std::string path, const char* limit, const char* usage,
  const char* droppable)
{
  double left = Unlimited;
  while (true)
  {
    const std::string group = root + path + "/";
    const double most = valueIn(group + limit, Unlimited);
    if (most < Unlimited)
    {
      const double used =
        valueIn(group + usage, 0) - valueAfter(group + "memory.stat", droppable, 0);
      left = std::min(left, most - std::max(0.0, used));
    }
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos)
    {
      return left;
    }
    path.erase(slash);
  }
}

double leftByGroups()
{
  double left = Unlimited;
  std::ifstream stream("/proc/self/cgroup");
  for (std::string line; std::getline(stream, line);)
  {
    // "0::/path" (version 2) or "7:memory:/path" (version 1)
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos)
    {
      continue;
    }
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string path = line.substr(second + 1);
    if (controllers.empty())
    {
      left = std::min(
        left, leftByGroup("/sys/fs/cgroup", path, "memory.max", "memory.current", "inactive_file"));
    }
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
    {
      left = std::min(left,
        leftByGroup("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes", "memory.usage_in_bytes",
          "total_inactive_file"));
    }
  }
  return left;
}

/// Bytes of the process.
struct Taken
{
  double addresses = 0, data = 0;
};

Taken takenMemory()
{
  // Pages: of the address space, resident, shared, code, unused, data.
  double pages[6] = {};
  std::ifstream stream("/proc/self/statm");
  for (double& number : pages)
  {
    stream >> number;
  }
  const auto size = static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return { size * pages[0], size * pages[5] };
}

/// The memory that the process limits still allow.
double leftByLimits()
{
  const Taken taken = takenMemory();
  rlimit addresses{}, data{};
  getrlimit(RLIMIT_AS, &addresses);
  getrlimit(RLIMIT_DATA, &data);
  const auto left = [](rlim_t limit, double used)
  { return limit == RLIM_INFINITY ? Unlimited : static_cast<double>(limit) - used; };
  return std::min(left(addresses.rlim_cur, taken.addresses), left(data.rlim_cur, taken.data));
}
}

//------------------------------------------------------------------------------
double availableMemory()
{
  return std::max(0.0, std::min({ freeOnMachine(), leftByGroups(), leftByLimits() }));
}

//------------------------------------------------------------------------------
void limitMemory(double more)
{
  constexpr double most = 1e18; // fits the type
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  const auto wanted = static_cast<rlim_t>(std::min(most, more + takenMemory().data));
  limit.rlim_cur = std::min(limit.rlim_cur, wanted);
  setrlimit(RLIMIT_DATA, &limit);
}

//------------------------------------------------------------------------------
std::string memoryText(double bytes)
{
  constexpr double step = 1024, most = 1000; // three digits
  double value = bytes / (step * step);
  const char* units[] = { "MiB", "GiB", "TiB" };
  int unit = 0;
  for (; unit < 2 && value >= most; ++unit)
  {
    value /= step;
  }
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %s", value, units[unit]);
  return text;
}

//------------------------------------------------------------------------------
namespace
{
thread_local double allowedInTest = 0;
}

AllowedMemory::AllowedMemory(double bytes)
  : Before(std::exchange(allowedInTest, bytes))
{
}

AllowedMemory::~AllowedMemory()
{
  allowedInTest = this->Before;
}

//------------------------------------------------------------------------------
void requireMemory(double bytes, const std::string& what, const std::string& remedy, double limit)
{
  limit = allowedInTest > 0 ? allowedInTest : limit;
  // Small amounts are not checked: if they are not available, std::bad_alloc is thrown.
  constexpr double little = 16 * 1048576.0;
  if (bytes <= little && limit <= 0)
  {
    return;
  }
  const double allowed = limit > 0 ? limit : availableMemory();
  if (!(bytes <= allowed))
  {
    throw MemoryError(what + " takes about " + memoryText(bytes) + " of memory and " +
      memoryText(allowed) + (limit > 0 ? " are allowed: " : " are available: ") + remedy);
  }
}

//------------------------------------------------------------------------------
std::string errorText(const std::exception& error, const std::string& remedy)
{
  return dynamic_cast<const std::bad_alloc*>(&error) ? "Not enough memory: " + remedy + "."
                                                     : error.what();
}
}
