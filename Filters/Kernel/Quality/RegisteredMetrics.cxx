// SPDX-License-Identifier: BSD-3-Clause
#include "RegisteredMetrics.h"
#include "UserMetric.h"

#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <sstream>

namespace tautline
{
namespace
{
/// Numbers of registered metrics: permanently above the numbers of built-in ones.
constexpr std::uint32_t firstNumber = 1000000, numbers = 1000000000;

/// The number of a name: FNV-1a, 32 bits.
int numberOf(const std::string& name)
{
  constexpr std::uint32_t offsetBasis = 2166136261u, prime = 16777619u;
  std::uint32_t hash = offsetBasis;
  for (const unsigned char c : name)
  {
    hash = (hash ^ c) * prime;
  }
  return static_cast<int>(firstNumber + hash % numbers);
}

/// A registered metric and the storage of its facts.
struct Registered
{
  MetricDescription description;
  std::unique_ptr<const UserMetric> metric;
  MetricInfo info;
  bool listed;
  std::string mirrored; ///< the facts received from another process; "": registered in this process
};

/**
 * @brief All metrics ever registered. Lists are never modified, only replaced, and never freed, so
 * that concurrent readers are safe.
 */
struct Registry
{
  std::mutex mutex;
  std::deque<Registered> metrics;
  std::deque<std::vector<MetricInfo>> lists;
  std::atomic<const std::vector<MetricInfo>*> current{ nullptr }; ///< null: none registered
  std::string errors;
};

Registry& registry()
{
  static Registry& instance = *new Registry; // must outlive static objects of other libraries
  return instance;
}

void publish(Registry& all)
{
  all.lists.push_back(builtInMetrics());
  for (const Registered& r : all.metrics)
  {
    if (r.listed)
    {
      all.lists.back().push_back(r.info);
    }
  }
  // Readers see the new list only after it is complete.
  all.current = &all.lists.back();
}

void completeDescription(MetricDescription& d)
{
  const auto valid = [](char c)
  { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (d.name.empty() || !(d.name[0] >= 'a' && d.name[0] <= 'z') ||
    !std::all_of(d.name.begin(), d.name.end(), valid))
  {
    throw Error("'" + d.name +
      "' cannot be the name of a metric: use lower-case letters, digits and underscores, "
      "starting with a letter.");
  }
  d.label = d.label.empty() ? d.name : d.label;
  d.symbol = d.symbol.empty() ? d.name : d.symbol;
  for (const std::string* text :
    { &d.label, &d.symbol, &d.aliases, &d.formula, &d.source, &d.unit })
  {
    // The list of metrics for other processes separates texts with tabs and line ends.
    if (std::any_of(text->begin(), text->end(), [](unsigned char c) { return c < ' '; }))
    {
      throw Error("The texts of the metric " + d.name +
        " must not contain tabs, line ends or other control characters.");
    }
  }
}

/// The cell types of the dimensions.
unsigned typesOf(const MetricDescription& d)
{
  unsigned types = 0;
  for (int i = 0; i < NumberOfCellTypes; ++i)
  {
    const bool wanted = topologies()[i].dimension == 2 ? d.in2D : d.in3D;
    types |= wanted ? d.cellTypes & (1u << i) : 0u;
  }
  return types;
}

MetricInfo infoOf(const MetricDescription& d, const UserMetric& metric)
{
  const bool target = metric.argument() == MetricArgument::Jacobian;
  const unsigned types = typesOf(d);
  const unsigned flat = 3; // triangles and quadrilaterals
  return { static_cast<Metric>(numberOf(d.name)), d.name.c_str(), d.label.c_str(), d.symbol.c_str(),
    d.aliases.c_str(), d.formula.c_str(), d.source.c_str(),
    target ? MetricFamily::Target : MetricFamily::Cell, (types & flat) != 0, (types & ~flat) != 0,
    types, d.full, d.full, d.acceptable, d.acceptable, d.ideal, d.ideal, d.direction, d.inverted,
    d.barrier, d.differentiable, d.scaleInvariant, d.rotationInvariant, d.unit.c_str(), &metric };
}

/// A metric of another process.
class MirroredMetric : public UserMetric
{
public:
  MirroredMetric(MetricArgument argument, std::string name)
    : UserMetric(argument)
    , Name(std::move(name))
  {
  }
  void evaluate(CellType, int, int, const double*, double*, double*) const override
  {
    this->refuse();
  }
  void evaluateElements(CellType, Index, const double*, double*) const override { this->refuse(); }

private:
  [[noreturn]] void refuse() const
  {
    throw Error("The metric " + this->Name +
      " is registered on a server that was connected, but not in this process.");
  }

  std::string Name;
};

/// Adds a metric to the lists; the registry is locked.
void addTo(Registry& all, MetricDescription description, std::unique_ptr<const UserMetric> metric,
  const std::string& mirrored = {})
{
  // The facts point to the texts in their final place.
  all.metrics.push_back({ std::move(description), std::move(metric), {}, true, mirrored });
  Registered& added = all.metrics.back();
  added.info = infoOf(added.description, *added.metric);
  publish(all);
}

/// Whether the metric is one of another process.
bool isMirrored(const MetricInfo& info)
{
  return dynamic_cast<const MirroredMetric*>(info.user) != nullptr;
}

/// Throws Error if another metric already has one of the names.
void requireFree(const MetricDescription& d)
{
  std::vector<std::string> names = { d.name, d.label, d.symbol };
  std::istringstream aliases(d.aliases);
  for (std::string alias; std::getline(aliases, alias, ',');)
  {
    names.push_back(alias);
  }
  for (const std::string& name : names)
  {
    const MetricInfo* other = findMetric(name);
    // A metric that is known only from another process may be replaced by its registration here.
    if (other && !(isMirrored(*other) && other->name == d.name))
    {
      throw Error("The metric " + d.name + " cannot be registered: there already is a metric '" +
        name + "' (" + other->label + "). Choose another name, label, symbol or alias" +
        (other->user ? ", or remove the other one first." : "."));
    }
  }
}
}

//------------------------------------------------------------------------------
const std::vector<MetricInfo>& knownMetrics()
{
  const std::vector<MetricInfo>* current = registry().current.load();
  return current ? *current : builtInMetrics();
}

//------------------------------------------------------------------------------
const MetricInfo* registeredMetric(Metric metric)
{
  for (const MetricInfo& info : knownMetrics())
  {
    if (info.metric == metric)
    {
      return &info;
    }
  }
  // A removed metric may still be in use.
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  // The latest registration with a number counts.
  for (auto r = all.metrics.rbegin(); r != all.metrics.rend(); ++r)
  {
    if (r->info.metric == metric)
    {
      return &r->info;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
UserMetric::~UserMetric() = default;

//------------------------------------------------------------------------------
void UserMetric::evaluateElements(
  CellType type, Index count, const double* points, double* values) const
{
  // Only metrics of many elements are evaluated this way.
  const int nodes = topology(type).nodes;
  for (Index i = 0; i < count; ++i)
  {
    this->evaluate(type, 1, 1, points + 3 * nodes * i, values + i, nullptr);
  }
}

//------------------------------------------------------------------------------
void UserMetric::evaluateAlong(CellType type, int count, int stride, const double* arguments,
  const double* along, double* values, double* slopes) const
{
  const CellTopology& t = topology(type);
  const bool ofCorners = this->Argument == MetricArgument::Corners;
  // The derivative with respect to argument (r, c) of T, or (c, r) of the corners, is weighted by
  // along[c].
  const int rows = ofCorners ? 3 : t.dimension, columns = ofCorners ? t.nodes : t.dimension;
  std::vector<double> all(static_cast<std::size_t>(rows) * columns * stride);
  this->evaluate(type, count, stride, arguments, values, all.data());
  std::fill_n(slopes, static_cast<std::size_t>(rows) * stride, 0.0);
  for (int r = 0; r < rows; ++r)
  {
    for (int c = 0; c < columns; ++c)
    {
      const int argument = ofCorners ? rows * c + r : columns * r + c;
      for (int i = 0; i < count; ++i)
      {
        slopes[r * stride + i] += along[c * stride + i] * all[argument * stride + i];
      }
    }
  }
}

//------------------------------------------------------------------------------
bool UserMetric::evaluateInvariants(CellType, int, int, const double*, double*, double*) const
{
  return false;
}

//------------------------------------------------------------------------------
Metric registerMetric(
  const MetricDescription& description, std::unique_ptr<const UserMetric> metric)
{
  if (!metric)
  {
    throw Error("The metric " + description.name + " has no function.");
  }
  MetricDescription complete = description;
  completeDescription(complete);
  requireFree(complete);
  complete.cellTypes = typesOf(complete);
  // The test calls code of the user, so the registry is not locked yet.
  tryMetric(complete, *metric);

  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const Metric number = static_cast<Metric>(numberOf(complete.name));
  for (Registered& r : all.metrics)
  {
    // A mirrored metric of the same name makes way for this one.
    r.listed = r.listed && !(!r.mirrored.empty() && r.description.name == complete.name);
    if (r.listed && r.info.metric == number)
    {
      throw Error("The names " + complete.name + " and " + r.info.name +
        " have the same number: choose another name for one of the metrics.");
    }
  }
  addTo(all, std::move(complete), std::move(metric));
  return number;
}

//------------------------------------------------------------------------------
bool isRegisteredHere(Metric metric)
{
  const MetricInfo* info = registeredMetric(metric);
  return info && !isMirrored(*info);
}

//------------------------------------------------------------------------------
bool isNumberOfUserMetric(int number)
{
  return number >= static_cast<int>(firstNumber);
}

//------------------------------------------------------------------------------
void mirrorMetric(MetricDescription description, MetricArgument argument, const std::string& facts)
{
  completeDescription(description);
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const Metric number = static_cast<Metric>(numberOf(description.name));
  for (Registered& r : all.metrics)
  {
    if (r.listed && r.info.metric == number)
    {
      // A metric of this process takes precedence, and unchanged facts need no new entry.
      if (r.mirrored.empty() || r.mirrored == facts)
      {
        return;
      }
      r.listed = false;
    }
  }
  auto metric = std::make_unique<const MirroredMetric>(argument, description.name);
  addTo(all, std::move(description), std::move(metric), facts);
}

namespace
{
/// A function of the corners of many elements.
class ElementsMetric : public UserMetric
{
public:
  explicit ElementsMetric(ElementsFunction function)
    : UserMetric(MetricArgument::Elements)
    , Function(std::move(function))
  {
  }
  void evaluate(CellType, int, int, const double*, double*, double*) const override
  {
    throw Error("A metric of many elements cannot be evaluated for only some of them.");
  }
  void evaluateElements(
    CellType type, Index count, const double* points, double* values) const override
  {
    this->Function(type, count, points, values);
  }

private:
  ElementsFunction Function;
};
}

//------------------------------------------------------------------------------
Metric registerElementsMetric(const MetricDescription& description, ElementsFunction function)
{
  if (!function)
  {
    throw Error("The metric " + description.name + " has no function.");
  }
  return registerMetric(description, std::make_unique<const ElementsMetric>(std::move(function)));
}

//------------------------------------------------------------------------------
void unregisterMetric(const std::string& name)
{
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  for (Registered& r : all.metrics)
  {
    if (r.listed && r.mirrored.empty() && r.description.name == name)
    {
      r.listed = false;
      publish(all);
      return;
    }
  }
  throw Error("No metric '" + name + "' was registered.");
}

//------------------------------------------------------------------------------
void loadMetrics(const std::string& library)
{
  const std::string before = metricLoadErrors();
  // Never unloaded, because its metrics stay registered.
  if (!dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
  {
    const char* reason = dlerror();
    throw Error("The library of metrics " + library +
      " cannot be loaded: " + (reason ? reason : "unknown reason") + ".");
  }
  // Registrations run inside dlopen() and cannot throw, so they have appended their errors to a
  // text.
  Registry& all = registry();
  std::string errors;
  {
    const std::lock_guard<std::mutex> lock(all.mutex);
    errors = all.errors.substr(before.size());
    all.errors = before;
  }
  if (!errors.empty())
  {
    errors.pop_back(); // the line end
    throw Error("In the library of metrics " + library + ": " + errors);
  }
}

//------------------------------------------------------------------------------
void loadMetricsOfEnvironment()
{
  // Not std::call_once, because a loaded library may look up metrics itself.
  static std::atomic<bool> begun{ false };
  if (begun.load(std::memory_order_relaxed) || begun.exchange(true))
  {
    return;
  }
  const char* libraries = std::getenv("TAUTLINE_METRICS");
  std::istringstream list(libraries ? libraries : "");
  for (std::string library; std::getline(list, library, ':');)
  {
    // An error in one library does not affect the others.
    try
    {
      if (!library.empty())
      {
        loadMetrics(library);
      }
    }
    catch (const std::exception& error)
    {
      MetricRegistration::addError(std::string("TAUTLINE_METRICS: ") + error.what());
    }
  }
}

//------------------------------------------------------------------------------
std::string metricLoadErrors()
{
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  return all.errors;
}

//------------------------------------------------------------------------------
void MetricRegistration::addError(const std::string& message)
{
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.errors += message + "\n";
}
}
