#include "ProcessGroup.h"

#include "Processes.h"

#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPICommunicator.h"
#endif

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

  void start(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override
  {
    // Nobody waits for a message that is too long: this ends the job, not only the filter.
    const auto length = [](const RankMessage& message)
    {
      if (message.bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      {
        throw Error("A process would send more than 2 GiB to another one: take more processes.");
      }
      return static_cast<int>(message.bytes.size());
    };
    constexpr int tag = 7241;
    this->Requests.resize(sent.size() + received.size());
    auto request = this->Requests.begin();
    for (RankMessage& message : received)
    {
      this->Mpi->NoBlockReceive(
        message.bytes.data(), length(message), message.rank, tag, *request++);
    }
    for (const RankMessage& message : sent)
    {
      this->Mpi->NoBlockSend(message.bytes.data(), length(message), message.rank, tag, *request++);
    }
  }

  void finish() override
  {
    // (vtkMPICommunicator::WaitAll() waits for copies of the requests.)
    for (vtkMPICommunicator::Request& request : this->Requests)
    {
      request.Wait();
    }
    this->Requests.clear();
  }

  std::vector<Bytes> allGather(const Bytes& own) override
  {
    const auto mine = static_cast<vtkIdType>(own.size());
    std::vector<vtkIdType> lengths(this->size()), offsets(this->size(), 0);
    this->Controller->AllGather(&mine, lengths.data(), 1);
    std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
    Bytes joined(static_cast<std::size_t>(offsets.back() + lengths.back()) + 1);
    char none = 0; // the address of nothing
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

private:
  vtkMultiProcessController* Controller;
  vtkMPICommunicator* Mpi;
  std::vector<vtkMPICommunicator::Request> Requests;
};
#endif
}

//------------------------------------------------------------------------------
std::unique_ptr<RankGroup> makeProcessGroup()
{
  const Processes processes; // throws without MPI
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  if (processes.count() > 1)
  {
    vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
    return std::make_unique<ProcessGroup>(
      controller, vtkMPICommunicator::SafeDownCast(controller->GetCommunicator()));
  }
#endif
  return std::make_unique<SingleRank>();
}
}
