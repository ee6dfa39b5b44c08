// SPDX-License-Identifier: BSD-3-Clause
#include "RunControl.h"

#include "ExecutionScope.h"
#include "Startup.h"

#include "vtkAlgorithm.h"
#include "vtkClientSocket.h"
#include "vtkCommand.h"
#include "vtkCompositeMultiProcessController.h"
#include "vtkPVSession.h"
#include "vtkProcessModule.h"
#include "vtkSMSession.h"
#include "vtkSocketCommunicator.h"

#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

namespace tautline
{
namespace
{

std::atomic<bool> StopRequested{ false };

/// The tag of the remote call, which ParaView does not use, and its unique argument.
constexpr int StopTag = 274115;
constexpr char StopMessage[] = "Tautline: stop the run, 6f1d2ce0-93b7-4c58-8f3e-5a0e7bd4c911";
constexpr int FirstProcess = 1; // of the server, for the client

/// After the run, the request has no effect.
void ignoreStop(void*, void*, int, int)
{
}

/// The connection to the client on a server, otherwise null.
vtkSocketCommunicator* clientConnection()
{
  vtkProcessModule* module = vtkProcessModule::GetProcessModule();
  auto* session = module ? vtkPVSession::SafeDownCast(module->GetActiveSession()) : nullptr;
  auto* all = vtkCompositeMultiProcessController::SafeDownCast(
    session ? session->GetController(vtkPVSession::CLIENT) : nullptr);
  vtkMultiProcessController* client = all ? all->GetActiveController() : nullptr;
  if (!client)
  {
    return nullptr;
  }
  static vtkMultiProcessController* prepared = nullptr;
  if (all != prepared)
  {
    prepared = all;
    all->AddRMICallback(ignoreStop, nullptr, StopTag);
  }
  return vtkSocketCommunicator::SafeDownCast(client->GetCommunicator());
}

/// Whether the bytes that wait in the socket contain the request; they stay there.
bool isStopWaiting(vtkSocketCommunicator* connection)
{
  constexpr std::size_t mostBytes = 1 << 20;
  static std::vector<char> bytes(mostBytes);
  vtkClientSocket* socket = connection->GetSocket();
  const auto waiting = socket && socket->GetConnected()
    ? recv(socket->GetSocketDescriptor(), bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT)
    : -1;
  return waiting > 0 &&
    std::search(bytes.begin(), bytes.begin() + waiting, std::begin(StopMessage),
      std::end(StopMessage)) != bytes.begin() + waiting;
}

void poll(vtkAlgorithm* algorithm, bool keepsBest)
{
  vtkSocketCommunicator* client = clientConnection();
  // Shows observers that the run continues; ParaView forwards ten messages per second, or one.
  double progress = algorithm->GetProgress();
  algorithm->InvokeEvent(vtkCommand::ProgressEvent, &progress);
  if (keepsBest && (client ? isStopWaiting(client) : isStopRequested()))
  {
    algorithm->SetAbortExecute(1);
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
void requestStop(bool stop)
{
  StopRequested = stop;
}

//------------------------------------------------------------------------------
bool isStopRequested()
{
  return StopRequested;
}

//------------------------------------------------------------------------------
void sendStop(vtkSMSession* session)
{
  vtkMultiProcessController* server =
    session ? session->GetController(vtkPVSession::DATA_SERVER_ROOT) : nullptr;
  if (server)
  {
    char message[sizeof(StopMessage)];
    std::memcpy(message, StopMessage, sizeof(message));
    server->TriggerRMI(FirstProcess, message, sizeof(message), StopTag);
  }
}

} // namespace tautline

//------------------------------------------------------------------------------
void tautlineInstallRunControl()
{
  tautline::setPollHook(tautline::poll);
}
