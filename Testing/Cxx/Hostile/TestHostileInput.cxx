// SPDX-License-Identifier: BSD-3-Clause
// Every filter and writer with hostile data: no crash, no hang; an error of Tautline, or a result
// that is finite, has the points, cells and arrays of the input, and leaves the input as it was.
//
//   TautlineTests TestHostileInput -- MODULE CLASS...    all of a module, whose classes these are
//   TautlineTests TestHostileInput -- only FILTER DATUM  one combination, in this process
//
// TAUTLINE_FUZZ is the number of random mutations per filter.
#include "HostileData.h"
#include "HostileFilters.h"
#include "Registry.h"
#include "Sanitized.h"
#include "VtkMeshes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkOutputWindow.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkWriter.h"

#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace tautline;

namespace
{
constexpr int RandomMutations = 12; // per filter, unless TAUTLINE_FUZZ gives another number
constexpr int SecondsPerDatum = 60; // then it hangs; filters with a time limit have one of 2 s
constexpr double TooLarge = 1e30;   // what kernels take for infinite
constexpr rlim_t MemoryLimit = 8ull << 30;

/// The error of a combination; "" if there is none.
using Verdict = std::string;

/// The errors of an algorithm and of its executive.
class Errors
{
public:
  explicit Errors(vtkAlgorithm* algorithm)
  {
    this->Observe(algorithm, this->OfFilter, this->FilterText);
    this->Observe(algorithm->GetExecutive(), this->OfPipeline, this->PipelineText);
  }
  const std::string& ofFilter() const { return this->FilterText; }
  const std::string& ofPipeline() const { return this->PipelineText; }

private:
  void Observe(vtkObject* object, vtkCallbackCommand* command, std::string& text)
  {
    command->SetClientData(&text);
    command->SetCallback([](vtkObject*, unsigned long, void* to, void* message)
      { *static_cast<std::string*>(to) += static_cast<const char*>(message); });
    object->AddObserver(vtkCommand::ErrorEvent, command);
    // Warnings are kept off the console.
    vtkNew<vtkCallbackCommand> ignore;
    ignore->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    object->AddObserver(vtkCommand::WarningEvent, ignore);
  }
  vtkNew<vtkCallbackCommand> OfFilter, OfPipeline;
  std::string FilterText, PipelineText;
};

/// Prints nothing: VTK's own classes also report errors there.
class SilentWindow : public vtkOutputWindow
{
public:
  static SilentWindow* New();
  vtkTypeMacro(SilentWindow, vtkOutputWindow);
  void DisplayText(const char*) override {}
};
vtkStandardNewMacro(SilentWindow);

//------------------------------------------------------------------------------
bool finite(vtkDataArray* array, double limit)
{
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      const double value = array->GetComponent(i, c);
      if (!std::isfinite(value) || std::abs(value) >= limit)
      {
        return false;
      }
    }
  }
  return true;
}

bool same(vtkAbstractArray* a, vtkAbstractArray* b)
{
  if (!b || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfValues() != b->GetNumberOfValues())
  {
    return false;
  }
  if (a->IsNumeric())
  {
    return a->GetNumberOfValues() == 0 ||
      std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
        static_cast<std::size_t>(a->GetNumberOfValues() * a->GetDataTypeSize())) == 0;
  }
  for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i)
  {
    if (a->GetVariantValue(i) != b->GetVariantValue(i))
    {
      return false;
    }
  }
  return true;
}

/// Arrays that the input does not have are finite.
Verdict checkArrays(vtkFieldData* output, vtkFieldData* input, double limit)
{
  for (int i = 0; i < output->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = output->GetArray(i);
    const char* name = array ? array->GetName() : nullptr;
    const bool own = name && !(input && input->GetAbstractArray(name));
    if (own && !finite(array, limit))
    {
      return std::string("the array ") + name + " has values that are not finite";
    }
  }
  return "";
}

/// The arrays of the input are there, bitwise.
Verdict checkKept(vtkFieldData* output, vtkFieldData* input)
{
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = input->GetAbstractArray(i);
    const char* name = array->GetName();
    if (name && !same(array, output->GetAbstractArray(name)))
    {
      return std::string("the array ") + name + " differs from the input";
    }
  }
  return "";
}

Verdict checkTable(vtkTable* table)
{
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i)
  {
    auto* column = vtkDataArray::SafeDownCast(table->GetColumn(i));
    if (column && !finite(column, TooLarge))
    {
      return std::string("the column ") + column->GetName() + " has values that are not finite";
    }
  }
  return "";
}

/// @param input with the same place in the input, or null
Verdict checkDataSet(
  vtkDataSet* output, vtkDataSet* input, bool keepsMesh, const HostileData& datum)
{
  const double limit = datum.extreme ? std::numeric_limits<double>::max() : TooLarge;
  if (keepsMesh && input &&
    (output->GetNumberOfPoints() != input->GetNumberOfPoints() ||
      output->GetNumberOfCells() != input->GetNumberOfCells()))
  {
    return "the output has other numbers of points or cells than the input";
  }
  auto* points = vtkPointSet::SafeDownCast(output);
  if (points && points->GetPoints() && !datum.nonFinite && !datum.extreme &&
    !finite(points->GetPoints()->GetData(), TooLarge))
  {
    return "points of the output are not finite";
  }
  const auto pick = [&](vtkFieldData* data) { return keepsMesh && input ? data : nullptr; };
  Verdict verdict =
    checkArrays(output->GetPointData(), pick(input ? input->GetPointData() : nullptr), limit);
  if (verdict.empty())
  {
    verdict =
      checkArrays(output->GetCellData(), pick(input ? input->GetCellData() : nullptr), limit);
  }
  if (verdict.empty() && keepsMesh && input)
  {
    verdict = checkKept(output->GetPointData(), input->GetPointData());
    verdict = verdict.empty() ? checkKept(output->GetCellData(), input->GetCellData()) : verdict;
  }
  return verdict;
}

Verdict checkOutput(
  vtkDataObject* output, vtkDataObject* input, bool keepsMesh, const HostileData& datum)
{
  if (auto* table = vtkTable::SafeDownCast(output))
  {
    return datum.extreme ? "" : checkTable(table);
  }
  if (auto* data = vtkDataSet::SafeDownCast(output))
  {
    // A filter that copies the arrays of the input to another mesh copies what is not finite.
    return datum.nonFinite && !keepsMesh
      ? ""
      : checkDataSet(data, vtkDataSet::SafeDownCast(input), keepsMesh, datum);
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(output);
  auto* others = vtkCompositeDataSet::SafeDownCast(input);
  if (!blocks)
  {
    return output ? "" : "there is no output";
  }
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    vtkDataObject* before = others && keepsMesh ? others->GetDataSet(walk) : nullptr;
    const Verdict verdict = checkOutput(
      walk->GetCurrentDataObject(), before, keepsMesh && vtkDataSet::SafeDownCast(before), datum);
    if (!verdict.empty())
    {
      return "block " + std::to_string(walk->GetCurrentFlatIndex()) + ": " + verdict;
    }
  }
  // Blocks that are meshes have not been lost.
  if (others && keepsMesh)
  {
    walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(others->NewIterator());
    for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
    {
      if (vtkDataSet::SafeDownCast(walk->GetCurrentDataObject()) &&
        !vtkDataSet::SafeDownCast(blocks->GetDataSet(walk)))
      {
        return "block " + std::to_string(walk->GetCurrentFlatIndex()) + " is missing";
      }
    }
  }
  return "";
}

Verdict checkResult(
  vtkAlgorithm* filter, vtkDataObject* data, const HostileFilter& entry, const HostileData& datum)
{
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    const Verdict verdict =
      checkOutput(filter->GetOutputDataObject(port), data, entry.keepsMesh && port == 0, datum);
    if (!verdict.empty())
    {
      return "output " + std::to_string(port) + ": " + verdict;
    }
  }
  return "";
}

/// After an error there is no output that might be taken for a result.
Verdict checkEmpty(vtkAlgorithm* filter, bool several)
{
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* output = filter->GetOutputDataObject(port);
    auto* data = vtkDataSet::SafeDownCast(output);
    // VTK executes some filters once per block: the other executions have succeeded.
    if (!several && data && data->GetNumberOfPoints() > 0)
    {
      return "there is an error and an output on port " + std::to_string(port);
    }
  }
  return "";
}

//------------------------------------------------------------------------------
/// A writer has reported an error, or there is a file.
Verdict write(vtkWriter* writer, const HostileFilter& entry, bool& succeeded)
{
  std::remove(entry.fileName.c_str());
  succeeded = writer->Write() != 0;
  const bool there = std::ifstream(entry.fileName).good();
  return succeeded && !there ? "there is no file"
    : !succeeded && there    ? "there is a file in spite of the error"
                             : "";
}

Verdict execute(const HostileFilter& entry, const HostileData& datum, vtkDataObject* data)
{
  const auto filter = entry.make();
  const Errors errors(filter);
  vtkSmartPointer<vtkAlgorithm> source;
  if (datum.name == "time steps")
  {
    source = timeSource(data);
    filter->SetInputConnection(entry.port, source->GetOutputPort());
  }
  else
  {
    filter->SetInputDataObject(entry.port, data);
  }
  if (datum.prepare)
  {
    datum.prepare(filter);
  }

  auto* writer = vtkWriter::SafeDownCast(filter);
  Verdict verdict;
  bool succeeded = true;
  const std::string before = fingerprint(data);
  if (writer)
  {
    verdict = write(writer, entry, succeeded);
  }
  else if (source)
  {
    for (const double time : { 0.0, 1.0, 0.0 })
    {
      filter->UpdateTimeStep(time);
    }
    data = filter->GetInputDataObject(entry.port, 0);
  }
  else
  {
    filter->Update();
  }
  if (!source && fingerprint(data) != before)
  {
    return "the input was changed";
  }
  if (!verdict.empty())
  {
    return verdict;
  }

  // Types that a port does not take are rejected by VTK before the filter is asked.
  const bool rejectedType = contains(errors.ofPipeline(), wording("is-of-type"));
  const std::string& own = errors.ofFilter();
  const bool failed = !own.empty() || rejectedType;
  if (writer && failed == succeeded)
  {
    return failed ? "there is an error but success is returned" : "failed without an error";
  }
  if (failed)
  {
    // "ERROR: In file, line N\nvtkClass (address): message"
    const auto at = own.find("): ");
    constexpr std::size_t Shortest = 10;
    if (!rejectedType && (at == std::string::npos || own.size() < at + Shortest))
    {
      return "the error has no message: " + own;
    }
    return datum.expected == Expected::Result
      ? "rejected: " + own + errors.ofPipeline()
      // One of several time steps may have a result.
      : checkEmpty(filter, source || vtkCompositeDataSet::SafeDownCast(data));
  }
  if (!errors.ofPipeline().empty())
  {
    return "an error of VTK only: " + errors.ofPipeline();
  }
  if (datum.expected == Expected::Error)
  {
    // A preview, which leaves the errors to Warp Mesh.
    return filter->IsA("vtkMovingBoundary") ? checkEmpty(filter, false) : "taken without an error";
  }
  return writer ? "" : checkResult(filter, data, entry, datum);
}

/// Adds what depends on the filter: time steps, and selections of absent items.
std::vector<HostileData> dataFor(const HostileFilter& entry)
{
  const char* number = std::getenv("TAUTLINE_FUZZ");
  std::vector<HostileData> list = hostileData(number ? std::atoi(number) : RandomMutations);
  const auto suitable = [](vtkDataObject* data) { return vtkSmartPointer<vtkDataObject>(data); };
  list.push_back({ "time steps",
    [](vtkDataObject* data)
    {
      return vtkSmartPointer<vtkDataObject>(
        vtkUnstructuredGrid::SafeDownCast(data) ? data : nullptr);
    } });
  const auto select = [&](const char* name, vtkAbstractArray* ids)
  {
    const auto selection = pointSelection(ids);
    const int port = entry.selectionPort;
    list.push_back({ name, suitable, Expected::Error, false, false,
      [selection, port](vtkAlgorithm* filter) { filter->SetInputDataObject(port, selection); } });
  };
  if (entry.selectionPort >= 0)
  {
    vtkNew<vtkIdTypeArray> far, negative;
    far->InsertNextValue(1000000);
    negative->InsertNextValue(-1);
    TAUTLINE_NEW(vtkStringArray, text, InsertNextValue("7"));
    select("selection of points that are not there", far);
    select("selection of a negative id", negative);
    select("selection by text", text);
  }
  return list;
}

/// Makes and executes one combination. @return whether there is such a combination
bool combine(const HostileFilter& entry, const HostileData& datum, Verdict& verdict)
{
  const auto suitable = entry.suitable();
  const auto data = datum.make(suitable);
  verdict = data ? execute(entry, datum, data) : "";
  return data != nullptr;
}

//------------------------------------------------------------------------------
std::string nameOf(const HostileFilter& entry)
{
  return entry.name + (entry.variant.empty() ? "" : "/" + entry.variant);
}

/// The child's report on a combination: its place in the list, whether it exists, the verdict.
struct Message
{
  int place = 0;
  int state = 0; // 0 begun, 1 does not exist, 2 done
  int length = 0;
};

void send(int pipe, int place, int state, const std::string& text)
{
  const Message message = { place, state, static_cast<int>(text.size()) };
  const bool sent = ::write(pipe, &message, sizeof(message)) == sizeof(message) &&
    ::write(pipe, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (!sent)
  {
    _exit(EXIT_FAILURE);
  }
}

/// In a process of its own, as a crash must not hide the rest. Does not return.
[[noreturn]] void runFrom(
  int place, const HostileFilter& entry, const std::vector<HostileData>& list, int pipe)
{
  for (const int signal : { SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL })
  {
    ::signal(signal, SIG_DFL);
  }
  const rlimit noCore = { 0, 0 }, memory = { MemoryLimit, MemoryLimit };
  setrlimit(RLIMIT_CORE, &noCore);
  if (!TAUTLINE_ADDRESS_SANITIZER)
  {
    setrlimit(RLIMIT_AS, &memory);
  }
  vtkNew<SilentWindow> window;
  vtkOutputWindow::SetInstance(window);
  for (; place < static_cast<int>(list.size()); ++place)
  {
    send(pipe, place, 0, "");
    Verdict verdict;
    const bool there = combine(entry, list[static_cast<std::size_t>(place)], verdict);
    send(pipe, place, there ? 2 : 1, verdict);
  }
  _exit(EXIT_SUCCESS);
}

/// All of a pipe that is there, or nothing after a time. @return false at its end
bool receive(int pipe, void* to, std::size_t size)
{
  auto* bytes = static_cast<char*>(to);
  while (size > 0)
  {
    pollfd ready = { pipe, POLLIN, 0 };
    if (::poll(&ready, 1, 1000 * SecondsPerDatum) <= 0)
    {
      return false;
    }
    const ssize_t count = ::read(pipe, bytes, size);
    if (count <= 0)
    {
      return false;
    }
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

/// Runs all data from a place on in one process, until it ends. @return the place to go on from
int runProcess(
  int place, const HostileFilter& entry, const std::vector<HostileData>& list, int& combinations)
{
  int ends[2];
  if (::pipe(ends) != 0)
  {
    std::abort();
  }
  const pid_t child = ::fork();
  if (child == 0)
  {
    ::close(ends[0]);
    runFrom(place, entry, list, ends[1]);
  }
  ::close(ends[1]);
  bool begun = false;
  Message message;
  while (receive(ends[0], &message, sizeof(message)))
  {
    std::string text(static_cast<std::size_t>(message.length), ' ');
    if (!text.empty() && !receive(ends[0], &text[0], text.size()))
    {
      break;
    }
    begun = message.state == 0;
    place = message.place + (begun ? 0 : 1);
    combinations += message.state == 2;
    if (!text.empty())
    {
      fail(__FILE__, __LINE__) << nameOf(entry) << " with \""
                               << list[static_cast<std::size_t>(message.place)].name
                               << "\": " << text << "\n";
    }
  }
  ::close(ends[0]);
  int status = 0;
  const bool ended = ::waitpid(child, &status, WNOHANG) == child;
  if (!ended)
  {
    // It has closed the pipe and is about to end, or it hangs.
    ::usleep(200000);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
  }
  if (begun)
  {
    const bool hangs = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    fail(__FILE__, __LINE__) << nameOf(entry) << " with \""
                             << list[static_cast<std::size_t>(place)].name << "\": "
                             << (hangs ? "hangs"
                                       : "crashes, signal " + std::to_string(WTERMSIG(status)))
                             << "\n";
    ++combinations;
    ++place;
  }
  return place;
}

/// Each class that the module declares is in the list of filters or has no input.
void checkClasses(const std::string& module, const std::vector<std::string>& classes,
  const std::vector<HostileFilter>& filters)
{
  for (const std::string& name : classes)
  {
    const bool tested = std::any_of(filters.begin(), filters.end(),
      [&](const HostileFilter& entry) { return entry.module == module && entry.name == name; });
    const auto& others = classesWithoutInput();
    const bool other = std::find(others.begin(), others.end(), name) != others.end();
    if (tested == other)
    {
      fail(__FILE__, __LINE__) << name
                               << (tested ? " is in both lists of HostileFilters.cxx\n"
                                          : " has to be added to a list of HostileFilters.cxx\n");
    }
  }
  for (const HostileFilter& entry : filters)
  {
    if (entry.module == module &&
      std::find(classes.begin(), classes.end(), entry.name) == classes.end())
    {
      fail(__FILE__, __LINE__) << entry.name << " is not a class of " << module << "\n";
    }
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestHostileInput)
{
  constexpr int FirstClass = 4;
  if (argc < FirstClass)
  {
    throw std::runtime_error("A module, or \"only\", is missing.");
  }
  const std::string module = argv[FirstClass - 1];
  const std::vector<std::string> names(argv + FirstClass, argv + argc);
  const auto filters = hostileFilters(argv[2]);
  if (module == "only")
  {
    for (const HostileFilter& entry : filters)
    {
      for (const HostileData& datum : dataFor(entry))
      {
        Verdict verdict;
        if (nameOf(entry) == names.at(0) && (names.size() < 2 || datum.name == names[1]) &&
          combine(entry, datum, verdict))
        {
          std::cout << nameOf(entry) << " with \"" << datum.name << "\": " << verdict << "\n";
        }
      }
    }
    return;
  }
  TAUTLINE_RUN(checkClasses(module, names, filters));
  int combinations = 0;
  for (const HostileFilter& entry : filters)
  {
    const std::vector<HostileData> list = dataFor(entry);
    for (int place = 0; entry.module == module && place < static_cast<int>(list.size());)
    {
      place = runProcess(place, entry, list, combinations);
    }
  }
  std::cout << combinations << " combinations of the module " << module << ", " << failures()
            << " failures\n";
}
