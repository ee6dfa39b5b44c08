// SPDX-License-Identifier: BSD-3-Clause
#include "MesherProcess.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Version.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <new>

#include <dlfcn.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tautline
{
namespace
{
/// The program's location relative to this library, installed and in the build tree.
std::string installedProgram()
{
  Dl_info info{};
  std::error_code error;
  if (::dladdr(reinterpret_cast<const void*>(&installedProgram), &info) == 0 || !info.dli_fname)
  {
    return TAUTLINE_MESHER_INSTALLED;
  }
  const std::filesystem::path library = std::filesystem::canonical(info.dli_fname, error);
  const std::filesystem::path program =
    (library.parent_path() / TAUTLINE_MESHER_FROM_LIBRARY).lexically_normal();
  return error ? TAUTLINE_MESHER_INSTALLED : program.string();
}

/// The path of the program. Throws Error if it does not exist.
std::string findProgram()
{
  const char* const given = std::getenv("TAUTLINE_MESHER");
  const bool named = given && *given;
  const std::string path = named ? given : installedProgram();
  if (::access(path.c_str(), X_OK) == 0)
  {
    return path;
  }
  throw Error("mesh generators are a separate program, tautline-mesher, which does not exist at " +
    path +
    (named ? ", given by the environment variable TAUTLINE_MESHER; correct or remove the variable"
           : "; install the Debian package tautline-meshers, or set the environment variable "
             "TAUTLINE_MESHER to the program"));
}

/// Starts the program with a socket as standard input and output. Gives its process id, or an error
/// number.
int spawn(const std::string& program, int socket, pid_t& child)
{
  const std::string parent = std::to_string(::getpid());
  std::string words[] = { program, version(), parent };
  char* arguments[] = { words[0].data(), words[1].data(), words[2].data(), nullptr };
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, socket, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, socket, STDOUT_FILENO);
  sigset_t none, handled;
  sigemptyset(&none);
  sigemptyset(&handled);
  sigaddset(&handled, SIGTERM);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &handled);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error =
    ::posix_spawn(&child, program.c_str(), &actions, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}
}

//------------------------------------------------------------------------------
MesherProcess::MesherProcess()
  : Program(findProgram())
{
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
  {
    throw Error(std::string("no socket for the mesh generators: ") + std::strerror(errno));
  }
  const int error = spawn(this->Program, ends[1], this->Child);
  ::close(ends[1]);
  if (error != 0)
  {
    ::close(ends[0]);
    throw Error("the program " + this->Program + " does not start: " + std::strerror(error));
  }
  this->Socket = ends[0];
}

//------------------------------------------------------------------------------
MesherProcess::~MesherProcess()
{
  ::close(this->Socket);
  if (this->Child > 0)
  {
    ::kill(this->Child, SIGTERM); // it then ends its own child and removes its files
    while (::waitpid(this->Child, nullptr, 0) < 0 && errno == EINTR)
    {
    }
  }
}

//------------------------------------------------------------------------------
void MesherProcess::failEnded()
{
  int status = 0;
  while (::waitpid(this->Child, &status, 0) < 0 && errno == EINTR)
  {
  }
  this->Child = -1;
  throw Error("the program " + this->Program + " ended without a result (" +
    (WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                         : "exit code " + std::to_string(WEXITSTATUS(status))) +
    "); allow larger elements if memory is short, otherwise reinstall the package "
    "tautline-meshers");
}

//------------------------------------------------------------------------------
void MesherProcess::send(const void* from, std::size_t size)
{
  const char* bytes = static_cast<const char*>(from);
  while (size > 0)
  {
    const ssize_t sent = ::send(this->Socket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR)
    {
      throwIfInterrupted();
      continue;
    }
    if (sent < 0)
    {
      this->failEnded();
    }
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

//------------------------------------------------------------------------------
void MesherProcess::receive(void* to, std::size_t size, const std::function<bool()>& proceed)
{
  constexpr int Milliseconds = 200;
  char* bytes = static_cast<char*>(to);
  while (size > 0)
  {
    pollfd poll = { this->Socket, POLLIN, 0 };
    const int ready = ::poll(&poll, 1, Milliseconds);
    throwIfInterrupted();
    if (ready == 0 && !proceed())
    {
      throw Error("stopped");
    }
    if (ready <= 0)
    {
      continue;
    }
    const ssize_t received = ::recv(this->Socket, bytes, size, 0);
    if (received < 0 && errno == EINTR)
    {
      continue;
    }
    if (received <= 0)
    {
      this->failEnded();
    }
    bytes += received;
    size -= static_cast<std::size_t>(received);
  }
}

//------------------------------------------------------------------------------
std::vector<char> MesherProcess::ask(
  MesherMessage request, const std::vector<char>& bytes, const std::function<bool(Index)>& progress)
{
  const MessageHeader asked = { request, bytes.size() };
  this->send(&asked, sizeof(asked));
  this->send(bytes.data(), bytes.size());
  Index points = 0;
  const auto proceed = [&] { return !progress || progress(points); };
  while (true)
  {
    MessageHeader header;
    this->receive(&header, sizeof(header), proceed);
    std::vector<char> answer(header.bytes);
    this->receive(answer.data(), answer.size(), proceed);
    switch (header.kind)
    {
      case MesherMessage::Progress:
        MessageReader{ answer }(points);
        if (!proceed())
        {
          throw Error("stopped");
        }
        break;
      case MesherMessage::Result:
        return answer;
      case MesherMessage::NoMemory:
        throw std::bad_alloc();
      default:
        throw Error(std::string(answer.begin(), answer.end()));
    }
  }
}

namespace
{
template <class Mesh, class Boundary, class Options>
Mesh ask(MesherMessage kind, Boundary boundary, Options options,
  const std::function<bool(Index)>& progress)
{
  MessageWriter request;
  request(boundary, options);
  MesherProcess process;
  const std::vector<char> answer = process.ask(kind, request.Bytes, progress);
  Mesh mesh;
  MessageReader{ answer }(mesh);
  return mesh;
}
}

//------------------------------------------------------------------------------
PlanarMesh meshPlane(const PlanarBoundary& boundary, const PlanarOptions& options)
{
  return ask<PlanarMesh>(MesherMessage::Planar, boundary, options, options.progress);
}

//------------------------------------------------------------------------------
SolidMesh meshSolid(const SolidBoundary& boundary, const SolidOptions& options)
{
  const auto progress = [&options](Index) { return !options.progress || options.progress(); };
  return ask<SolidMesh>(MesherMessage::Solid, boundary, options, progress);
}
}
