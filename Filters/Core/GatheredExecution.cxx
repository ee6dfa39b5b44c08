// SPDX-License-Identifier: BSD-3-Clause
#include "GatheredExecution.h"

#include "Blocks.h"
#include "LackingArrays.h"
#include "MeshGroups.h"
#include "PieceResults.h"
#include "Processes.h"
#include "SelectionMarks.h"
#include "ValidateInput.h"
#include "WholeMesh.h"
#include "tautline/Core/Memory.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObjectTypes.h"
#include "vtkDataSet.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkDummyController.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSelection.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <utility>

namespace tautline
{
namespace
{
constexpr int DataTag = 27410;
constexpr double Copies = 3.0; // of the mesh: as received, as joined, and as the result
constexpr double BytesPerKibibyte = 1024.0;
constexpr char MemoryRemedy[] =
  "run the first process on a machine with more memory, or divide the mesh";

using Pipeline = vtkStreamingDemandDrivenPipeline;
using Rebuilt = vtkSmartPointer<vtkDataSet>;

//------------------------------------------------------------------------------
/// A piece that another process sends, and its place in a GatheredMesh.
struct ExpectedPiece
{
  int process;
  std::size_t group, index;
};

//------------------------------------------------------------------------------
/// The mesh on an input port: the pieces of this process and, on the first, the whole.
struct PortMesh
{
  int port = 0;
  vtkDataObject* data = nullptr;
  int groups = 0;
  std::vector<GroupedPiece> pieces;
  std::vector<vtkSmartPointer<vtkDataSet>> sent; ///< the pieces with their selected parts marked

  // On the first process:
  GatheredMesh gathered;
  std::vector<ExpectedPiece> expected;
  vtkSmartPointer<vtkDataObject> structure, whole;
};

//------------------------------------------------------------------------------
/// Sets the data objects of ports temporarily.
class ReplacedData
{
public:
  ~ReplacedData()
  {
    for (const auto& [info, data] : this->Before)
    {
      info->Set(vtkDataObject::DATA_OBJECT(), data);
    }
  }

  void replace(vtkInformation* info, vtkDataObject* data)
  {
    this->Before.emplace_back(info, info->Get(vtkDataObject::DATA_OBJECT()));
    info->Set(vtkDataObject::DATA_OBJECT(), data);
  }

private:
  std::vector<std::pair<vtkInformation*, vtkSmartPointer<vtkDataObject>>> Before;
};

//------------------------------------------------------------------------------
/// Keeps the first error event of an algorithm and hides it from other observers.
class CaughtError
{
public:
  explicit CaughtError(vtkAlgorithm* algorithm)
    : Algorithm(algorithm)
  {
    constexpr float first = 1.0F;
    this->Observer->SetCallback(
      [](vtkObject*, unsigned long, void* client, void* text)
      {
        auto& message = *static_cast<std::string*>(client);
        message = message.empty() && text ? static_cast<const char*>(text) : message;
      });
    this->Observer->SetClientData(&this->Message);
    this->Observer->SetAbortFlagOnExecute(1);
    this->Tag = algorithm->AddObserver(vtkCommand::ErrorEvent, this->Observer, first);
  }
  ~CaughtError() { this->Algorithm->RemoveObserver(this->Tag); }

  /// Strips the text that vtkErrorMacro() writes before and after the message.
  std::string text() const
  {
    constexpr char before[] = "): ";
    const std::size_t at = this->Message.find(before);
    std::string text =
      at == std::string::npos ? this->Message : this->Message.substr(at + sizeof(before) - 1);
    text.erase(text.find_last_not_of("\n ") + 1);
    return text;
  }

private:
  vtkAlgorithm* Algorithm;
  vtkNew<vtkCallbackCommand> Observer;
  std::string Message;
  unsigned long Tag = 0;
};

//------------------------------------------------------------------------------
/// An image with the announced extent, with 0 where it has no pixels; other data are unchanged.
vtkSmartPointer<vtkDataObject> enlarged(vtkDataObject* data, vtkInformation* info)
{
  auto* image = vtkImageData::SafeDownCast(data);
  if (!image || !info->Has(Pipeline::WHOLE_EXTENT()))
  {
    return data;
  }
  int extent[6], own[6];
  info->Get(Pipeline::WHOLE_EXTENT(), extent);
  image->GetExtent(own);
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  if (std::equal(extent, extent + 6, own) || !pixels)
  {
    return data;
  }
  auto larger = vtkSmartPointer<vtkImageData>::New();
  larger->CopyStructure(image);
  larger->SetExtent(extent);
  larger->AllocateScalars(pixels->GetDataType(), pixels->GetNumberOfComponents());
  vtkDataArray* all = larger->GetPointData()->GetScalars();
  all->SetName(pixels->GetName());
  all->Fill(0.0);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double place[3];
    image->GetPoint(i, place);
    const vtkIdType at = larger->FindPoint(place);
    if (at >= 0)
    {
      all->SetTuple(at, i, pixels);
    }
  }
  return larger;
}

//------------------------------------------------------------------------------
class GatheredExecution
{
public:
  GatheredExecution(vtkAlgorithm* algorithm, vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs, const GatheredRules& rules)
    : Algorithm(algorithm)
    , Request(request)
    , Inputs(inputs)
    , Outputs(outputs)
    , Rules(rules)
    , Controller(severalProcesses() ? severalProcesses() : this->Alone.Get())
    , Rank(this->Controller->GetLocalProcessId())
    , Count(this->Controller->GetNumberOfProcesses())
  {
  }

  int run(const std::function<int()>& execute);

private:
  void listInputs();
  void addSelections();
  std::string announce();
  void exchangeStructures();
  void gather();
  void preparePieces();
  void preparePiece(PortMesh& mesh, int process, const PieceSize& size, std::size_t& own);
  void assembleAll();
  void execute(const std::function<int()>& execute);
  void prepareOutputs(ReplacedData& replaced);
  bool shareOutcome();
  void distribute();
  int fail(const std::string& message);
  void emptyOutputs();
  std::string attempt(const std::function<void()>& work);

  vtkAlgorithm* Algorithm;
  vtkInformation* Request;
  vtkInformationVector** Inputs;
  vtkInformationVector* Outputs;
  const GatheredRules& Rules;
  vtkNew<vtkDummyController> Alone; ///< stands for the others if there are none
  vtkMultiProcessController* Controller;
  int Rank, Count;

  std::vector<PortMesh> Meshes; ///< the mesh of port 0 first
  std::vector<int> SelectionPorts;
  std::vector<std::vector<PieceSize>> Announced; ///< on the first process: by process

  // The outcome.
  int Result = 1;
  bool Aborted = false, Continuing = false;
  std::string Failure;
  std::vector<vtkSmartPointer<vtkDataObject>> Results; ///< of the ports, on the first process
};

//------------------------------------------------------------------------------
std::string GatheredExecution::attempt(const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    return errorText(error, MemoryRemedy);
  }
  return "";
}

//------------------------------------------------------------------------------
void GatheredExecution::emptyOutputs()
{
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    emptyOutput(this->Outputs->GetInformationObject(port));
  }
  this->Request->Remove(Pipeline::CONTINUE_EXECUTING());
}

//------------------------------------------------------------------------------
int GatheredExecution::fail(const std::string& message)
{
  vtkErrorWithObjectMacro(this->Algorithm, << message);
  this->emptyOutputs();
  return 0;
}

//------------------------------------------------------------------------------
/// The meshes and selections of the ports on this process.
void GatheredExecution::listInputs()
{
  for (int port = 0; port < this->Algorithm->GetNumberOfInputPorts(); ++port)
  {
    vtkDataObject* data = this->Inputs[port]->GetNumberOfInformationObjects() > 0
      ? vtkDataObject::GetData(this->Inputs[port], 0)
      : nullptr;
    if (vtkSelection::SafeDownCast(data))
    {
      this->SelectionPorts.push_back(port);
    }
    else if (vtkDataSet::SafeDownCast(data) || vtkCompositeDataSet::SafeDownCast(data))
    {
      this->Meshes.emplace_back();
      PortMesh& mesh = this->Meshes.back();
      mesh.port = port;
      mesh.data = data;
      mesh.pieces = listPieces(data, mesh.groups);
      for (const GroupedPiece& piece : mesh.pieces)
      {
        mesh.sent.push_back(vtkSmartPointer<vtkDataSet>::Take(piece.data->NewInstance()));
        mesh.sent.back()->ShallowCopy(piece.data);
      }
    }
  }
  this->addSelections();
}

//------------------------------------------------------------------------------
/// The selection on the mesh of port 0, as arrays of its pieces.
void GatheredExecution::addSelections()
{
  for (const int port : this->SelectionPorts)
  {
    PortMesh& mesh = this->Meshes.front();
    const auto marked =
      markSelected(mesh.data, vtkSelection::GetData(this->Inputs[port]->GetInformationObject(0)));
    int groups = 0;
    const auto marks = marked ? listPieces(marked, groups) : std::vector<GroupedPiece>();
    for (std::size_t i = 0; i < mesh.sent.size(); ++i)
    {
      vtkDataSet* piece = mesh.sent[i];
      vtkDataSet* mark = marks.size() == mesh.sent.size() ? marks[i].data : nullptr;
      addMarks(mark ? mark->GetPointData() : nullptr, piece->GetNumberOfPoints(), port,
        piece->GetPointData());
      addMarks(mark ? mark->GetCellData() : nullptr, piece->GetNumberOfCells(), port,
        piece->GetCellData());
    }
  }
}

//------------------------------------------------------------------------------
/// Sends the sizes of the pieces to the first process. @return the problem that it finds
std::string GatheredExecution::announce()
{
  vtkMultiProcessStream own;
  own << static_cast<int>(this->Meshes.size());
  for (const PortMesh& mesh : this->Meshes)
  {
    own << mesh.groups << static_cast<int>(mesh.pieces.size());
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    {
      own << mesh.pieces[i].group << std::string(mesh.sent[i]->GetClassName())
          << static_cast<vtkTypeInt64>(mesh.sent[i]->GetNumberOfPoints())
          << static_cast<double>(mesh.sent[i]->GetActualMemorySize());
    }
  }
  std::vector<vtkMultiProcessStream> all;
  this->Controller->Gather(own, all, FirstProcess);
  if (this->Rank != FirstProcess)
  {
    return "";
  }
  double kibibytes = 0.0;
  for (int process = 0; process < this->Count; ++process)
  {
    vtkMultiProcessStream& stream = all[static_cast<std::size_t>(process)];
    int meshes = 0;
    stream >> meshes;
    this->Announced.emplace_back();
    for (int m = 0; m < meshes; ++m)
    {
      int groups = 0, pieces = 0;
      stream >> groups >> pieces;
      for (int i = 0; i < pieces; ++i)
      {
        PieceSize size;
        vtkTypeInt64 points = 0;
        double memory = 0.0;
        stream >> size.group >> size.type >> points >> memory;
        size.mesh = m;
        size.points = points;
        kibibytes += memory;
        this->Announced.back().push_back(size);
      }
    }
  }
  return this->attempt(
    [&]
    {
      requireMemory(
        Copies * BytesPerKibibyte * kibibytes, "the whole mesh on the first process", MemoryRemedy);
    });
}

//------------------------------------------------------------------------------
/// The structure of composite data is taken from the process with the most meshes.
void GatheredExecution::exchangeStructures()
{
  for (PortMesh& mesh : this->Meshes)
  {
    int most = 0, sender = 0;
    this->Controller->AllReduce(&mesh.groups, &most, 1, vtkCommunicator::MAX_OP);
    const int candidate = mesh.groups == most ? this->Rank : this->Count;
    this->Controller->AllReduce(&candidate, &sender, 1, vtkCommunicator::MIN_OP);
    const auto nothing = [](int, vtkDataSet*) { return Rebuilt(); };
    if (this->Rank == FirstProcess)
    {
      mesh.structure = sender == FirstProcess
        ? vtkSmartPointer<vtkDataObject>(mesh.data)
        : vtkSmartPointer<vtkDataObject>::Take(
            this->Controller->ReceiveDataObject(sender, DataTag));
    }
    else if (this->Rank == sender)
    {
      this->Controller->Send(rebuild(mesh.data, false, nothing), FirstProcess, DataTag);
    }
    mesh.groups = most;
  }
}

//------------------------------------------------------------------------------
/// On the first process: places for the pieces, including pieces that are not sent.
void GatheredExecution::preparePieces()
{
  for (PortMesh& mesh : this->Meshes)
  {
    std::size_t own = 0;
    mesh.gathered.groups.resize(static_cast<std::size_t>(mesh.groups));
    for (int process = 0; process < this->Count; ++process)
    {
      for (const PieceSize& size : this->Announced[static_cast<std::size_t>(process)])
      {
        if (&mesh == &this->Meshes[static_cast<std::size_t>(size.mesh)])
        {
          this->preparePiece(mesh, process, size, own);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
void GatheredExecution::preparePiece(
  PortMesh& mesh, int process, const PieceSize& size, std::size_t& own)
{
  GatheredGroup& group = mesh.gathered.groups[static_cast<std::size_t>(size.group)];
  vtkSmartPointer<vtkDataObject> data;
  if (process == FirstProcess)
  {
    data = mesh.sent[own++];
  }
  else if (size.points > 0)
  {
    mesh.expected.push_back({ process, static_cast<std::size_t>(size.group), group.pieces.size() });
  }
  else
  {
    data.TakeReference(vtkDataObjectTypes::NewDataObject(size.type.c_str()));
  }
  group.pieces.push_back(vtkDataSet::SafeDownCast(data));
  group.processes.push_back(process);
}

//------------------------------------------------------------------------------
/// Only sends and receives: a failure here would leave other processes waiting.
void GatheredExecution::gather()
{
  for (PortMesh& mesh : this->Meshes)
  {
    for (std::size_t i = 0; this->Rank != FirstProcess && i < mesh.sent.size(); ++i)
    {
      if (mesh.sent[i]->GetNumberOfPoints() > 0)
      {
        this->Controller->Send(mesh.sent[i].Get(), FirstProcess, DataTag);
      }
    }
    for (const ExpectedPiece& expected : mesh.expected)
    {
      const auto data = vtkSmartPointer<vtkDataObject>::Take(
        this->Controller->ReceiveDataObject(expected.process, DataTag));
      mesh.gathered.groups[expected.group].pieces[expected.index] = vtkDataSet::SafeDownCast(data);
    }
  }
}

//------------------------------------------------------------------------------
/// On the first process: puts the pieces together.
void GatheredExecution::assembleAll()
{
  const auto& first = this->Meshes.front().gathered.groups;
  for (PortMesh& mesh : this->Meshes)
  {
    for (std::size_t g = 0; g < mesh.gathered.groups.size(); ++g)
    {
      GatheredGroup& group = mesh.gathered.groups[g];
      const std::vector<vtkDataSet*> pieces(group.pieces.begin(), group.pieces.end());
      const bool alike =
        &mesh != &this->Meshes.front() && g < first.size() && matches(pieces, first[g].whole);
      group.whole = assemble(pieces, alike ? &first[g].whole : nullptr);
      noteLackingArrays(pieces, group.processes, this->Count > 1, group.whole.mesh);
      for (const int port : this->SelectionPorts)
      {
        uniteMarks(pieces, group.whole, port);
      }
    }
    mesh.whole = rebuild(mesh.structure, true,
      [&mesh](int number, vtkDataSet*)
      {
        const GatheredGroup& group = mesh.gathered.groups[static_cast<std::size_t>(number)];
        return group.pieces.empty() ? Rebuilt() : group.whole.mesh;
      });
  }
}

//------------------------------------------------------------------------------
/// New data objects for the outputs, of the classes that the filter chooses for the whole mesh.
void GatheredExecution::prepareOutputs(ReplacedData& replaced)
{
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = this->Outputs->GetInformationObject(port);
    replaced.replace(
      info, vtkSmartPointer<vtkDataObject>::Take(vtkDataObject::GetData(info)->NewInstance()));
  }
  vtkNew<vtkInformation> request;
  request->Set(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT());
  this->Algorithm->ProcessRequest(request, this->Inputs, this->Outputs);
}

//------------------------------------------------------------------------------
/// On the first process: executes the filter, as if it were alone.
void GatheredExecution::execute(const std::function<int()>& execute)
{
  const OneProcess alone;
  ReplacedData replaced;
  for (PortMesh& mesh : this->Meshes)
  {
    replaced.replace(this->Inputs[mesh.port]->GetInformationObject(0), mesh.whole);
  }
  for (const int port : this->SelectionPorts)
  {
    replaced.replace(
      this->Inputs[port]->GetInformationObject(0), selectionOf(this->Meshes.front().whole, port));
  }
  for (const int port : this->SelectionPorts)
  {
    for (PortMesh& mesh : this->Meshes)
    {
      removeMarks(mesh.whole, port);
    }
  }
  this->prepareOutputs(replaced);
  const CaughtError error(this->Algorithm);
  this->Failure = this->attempt([&] { this->Result = execute(); });
  this->Failure = this->Failure.empty() ? error.text() : this->Failure;
  if (this->Result == 0 && this->Failure.empty())
  {
    this->Failure = "The filter has failed on the first process.";
  }
  this->Aborted = this->Algorithm->GetAbortExecute() != 0;
  this->Continuing = this->Request->Has(Pipeline::CONTINUE_EXECUTING()) != 0;
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    this->Results.emplace_back(vtkDataObject::GetData(this->Outputs, port));
  }
}

//------------------------------------------------------------------------------
/// Sends the outcome of the execution to all processes. @return whether there are results
bool GatheredExecution::shareOutcome()
{
  this->Failure = shareText(this->Controller, this->Failure);
  vtkMultiProcessStream stream;
  const bool writes = this->Rank == FirstProcess;
  for (const bool now : { writes, !writes })
  {
    if (now)
    {
      ResultStream results(stream, writes);
      results(this->Result, this->Aborted, this->Continuing);
      if (this->Failure.empty() && this->Rules.exchange)
      {
        this->Rules.exchange(results);
      }
    }
    if (now == writes)
    {
      this->Controller->Broadcast(stream, FirstProcess);
    }
  }
  if (this->Continuing)
  {
    this->Request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
  }
  else
  {
    this->Request->Remove(Pipeline::CONTINUE_EXECUTING());
  }
  return this->Failure.empty();
}

//------------------------------------------------------------------------------
/// Sends the results to the pieces.
void GatheredExecution::distribute()
{
  const auto base = std::find_if(this->Meshes.begin(), this->Meshes.end(),
    [this](const PortMesh& mesh) { return mesh.port == this->Rules.base; });
  PortMesh& mesh = base != this->Meshes.end() ? *base : this->Meshes.front();
  vtkDataObject* output = vtkDataObject::GetData(this->Outputs, 0);
  vtkDataObject* result = this->Rank == FirstProcess ? this->Results.front().Get() : nullptr;
  const PieceResults results(this->Controller, mesh.data, mesh.pieces, mesh.gathered);
  results.distribute(this->Rules.result, result, output);
  for (std::size_t port = 1; port < this->Results.size(); ++port)
  {
    vtkInformation* info = this->Outputs->GetInformationObject(static_cast<int>(port));
    vtkDataObject::GetData(info)->ShallowCopy(enlarged(this->Results[port], info));
  }
  for (int port = 1;
       this->Rank != FirstProcess && port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    emptyOutput(this->Outputs->GetInformationObject(port));
  }
}

//------------------------------------------------------------------------------
int GatheredExecution::run(const std::function<int()>& execute)
{
  std::string problem = firstProblem(this->attempt([this] { this->listInputs(); }));
  problem = problem.empty() ? shareText(this->Controller, this->announce()) : problem;
  if (!problem.empty())
  {
    return this->fail(problem);
  }
  this->exchangeStructures();
  if (this->Rank == FirstProcess)
  {
    problem = this->attempt([this] { this->preparePieces(); });
  }
  problem = shareText(this->Controller, problem);
  if (!problem.empty())
  {
    return this->fail(problem);
  }
  this->gather();
  if (this->Rank == FirstProcess)
  {
    const OneProcess alone;
    problem = this->attempt([this] { this->assembleAll(); });
  }
  // No process assists if the execution does not start.
  problem = shareText(this->Controller, problem);
  if (!problem.empty())
  {
    return this->fail(problem);
  }
  if (this->Rank == FirstProcess)
  {
    this->execute(execute);
  }
  else if (this->Rules.assist)
  {
    // Joint work also fails on the first process, which reports the error.
    this->attempt(this->Rules.assist);
  }
  if (!this->shareOutcome())
  {
    return this->fail(this->Failure);
  }
  if (this->Aborted)
  {
    this->Algorithm->SetAbortExecute(1);
  }
  problem = firstProblem(this->attempt([this] { this->distribute(); }));
  return problem.empty() ? this->Result : this->fail(problem);
}
}

//------------------------------------------------------------------------------
void emptyOutput(vtkInformation* info)
{
  vtkDataObject* output = vtkDataObject::GetData(info);
  if (!output)
  {
    return;
  }
  output->Initialize();
  auto* image = vtkImageData::SafeDownCast(output);
  if (image && severalProcesses() && info->Has(Pipeline::WHOLE_EXTENT()))
  {
    int extent[6];
    info->Get(Pipeline::WHOLE_EXTENT(), extent);
    image->SetExtent(extent);
  }
}

//------------------------------------------------------------------------------
int executeGathered(vtkAlgorithm* algorithm, vtkInformation* request, vtkInformationVector** inputs,
  vtkInformationVector* outputs, const GatheredRules& rules, const std::function<int()>& execute)
{
  return GatheredExecution(algorithm, request, inputs, outputs, rules).run(execute);
}
}
