// SPDX-License-Identifier: BSD-3-Clause
#include "ProcessGroup.h"

#include "Processes.h"

#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#endif

#include <algorithm>
#include <deque>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
class ProcessGroup : public RankGroup
{
public:
  ProcessGroup(vtkMultiProcessController* controller, vtkMPICommunicator* mpi)
    : Controller(controller)
    , Mpi(mpi)
  {
  }

  int rank() const override { return this->Controller->GetLocalProcessId(); }
  int size() const override { return this->Controller->GetNumberOfProcesses(); }
  Communicator communicator() const override { return this->Mpi->GetMPIComm()->GetHandle(); }

protected:
  void sendAll(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override
  {
    this->Requests.clear();
    for (RankMessage& message : received)
    {
      this->forEachPart(message.bytes.data(), message.bytes.size(),
        [&](char* part, int length, vtkMPICommunicator::Request& request)
        { this->Mpi->NoBlockReceive(part, length, message.rank, Tag, request); });
    }
    for (const RankMessage& message : sent)
    {
      this->forEachPart(message.bytes.data(), message.bytes.size(),
        [&](const char* part, int length, vtkMPICommunicator::Request& request)
        { this->Mpi->NoBlockSend(part, length, message.rank, Tag, request); });
    }
    // (vtkMPICommunicator::WaitAll() waits for copies of the requests.)
    for (vtkMPICommunicator::Request& request : this->Requests)
    {
      request.Wait();
    }
    this->Requests.clear();
  }

  std::vector<Bytes> gatherAll(const Bytes& own) override
  {
    const auto mine = static_cast<vtkIdType>(own.size());
    std::vector<vtkIdType> lengths(this->size()), offsets(this->size(), 0);
    this->Controller->AllGather(&mine, lengths.data(), 1);
    std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
    const vtkIdType total = offsets.back() + lengths.back();
    if (total > std::numeric_limits<int>::max()) // known on all processes
    {
      throw Error("The processes would exchange more than 2 GiB at once, which MPI does not "
                  "support: use a smaller mesh, or gather it first (Aggregate Dataset).");
    }
    Bytes joined(static_cast<std::size_t>(total) + 1);
    char none = 0; // address of an empty message
    this->Controller->AllGatherV(
      own.empty() ? &none : own.data(), joined.data(), mine, lengths.data(), offsets.data());
    std::vector<Bytes> all;
    for (std::size_t r = 0; r < lengths.size(); ++r)
    {
      const auto begin = joined.begin() + offsets[r];
      all.emplace_back(begin, begin + lengths[r]);
    }
    return all;
  }

  bool anyOfAll(bool flag) override
  {
    const int own = flag;
    int any = 0;
    this->Controller->AllReduce(&own, &any, 1, vtkCommunicator::MAX_OP);
    return any != 0;
  }

private:
  static constexpr int Tag = 7241;

  /// Calls the function for each part of a message that MPI can send at once; the parts arrive in
  /// order.
  template <class Byte, class Callback>
  void forEachPart(Byte* bytes, std::size_t size, Callback&& callback)
  {
    constexpr std::size_t longest = std::size_t(1) << 30;
    for (std::size_t begin = 0; begin == 0 || begin < size; begin += longest)
    {
      this->Requests.emplace_back();
      callback(
        bytes + begin, static_cast<int>(std::min(longest, size - begin)), this->Requests.back());
    }
  }

  vtkMultiProcessController* Controller;
  vtkMPICommunicator* Mpi;
  std::deque<vtkMPICommunicator::Request> Requests; // they stay where they are
};
#endif
}

//------------------------------------------------------------------------------
std::unique_ptr<RankGroup> makeProcessGroup()
{
  vtkMultiProcessController* controller = severalProcesses();
  if (!controller)
  {
    return std::make_unique<SingleRank>();
  }
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  auto* mpi = vtkMPICommunicator::SafeDownCast(controller->GetCommunicator());
  if (mpi && mpi->GetMPIComm())
  {
    return std::make_unique<ProcessGroup>(controller, mpi);
  }
#endif
  throw Error("There are " + std::to_string(controller->GetNumberOfProcesses()) +
    " processes that cannot communicate: MPI and a VTK built with MPI are required.");
}

//------------------------------------------------------------------------------
std::unique_ptr<RankGroup> tryProcessGroup()
{
  try
  {
    return makeProcessGroup();
  }
  catch (const Error&) // on all processes
  {
    return nullptr;
  }
}

//------------------------------------------------------------------------------
Assistants::Assistants(std::unique_ptr<RankGroup> group)
  : Group(std::move(group))
{
}

Assistants::~Assistants()
{
  try
  {
    if (this->Group && !this->Called)
    {
      this->Group->any(false);
    }
  }
  catch (const std::exception&)
  {
    // no memory for a message
  }
}

RankGroup& Assistants::call()
{
  this->Called = true;
  if (!this->Group)
  {
    return this->Alone;
  }
  this->Group->any(true);
  return *this->Group;
}

bool Assistants::areCalled(RankGroup& group)
{
  return group.any(false);
}
}
