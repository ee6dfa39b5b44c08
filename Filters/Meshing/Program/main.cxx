// SPDX-License-Identifier: BSD-3-Clause
// tautline-mesher VERSION PARENT: reads a request from standard input, meshes it, and writes the
// answer to standard output, both as MesherMessages.h has them. The library TautlineMeshGenerators
// runs it.

#include "MesherMessages.h"
#include "Termination.h"

#include "tautline/Core/Version.h"

#include <CGAL/version.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>

#include <fcntl.h>
#include <unistd.h>

namespace
{
using namespace tautline;

constexpr int ExitUsage = 2;

/// The two ends of the connection. Throws Error if the other side has ended.
class Channel
{
public:
  /// Takes over standard input and output, so that output printed by libraries is not sent.
  Channel()
    : In(::dup(STDIN_FILENO))
    , Out(::dup(STDOUT_FILENO))
  {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
  }

  std::vector<char> receive(MesherMessage& kind)
  {
    MessageHeader header;
    this->read(&header, sizeof(header));
    kind = header.kind;
    std::vector<char> bytes(header.bytes);
    this->read(bytes.data(), bytes.size());
    return bytes;
  }
  void send(MesherMessage kind, const std::vector<char>& bytes)
  {
    const MessageHeader header = { kind, bytes.size() };
    this->write(&header, sizeof(header));
    this->write(bytes.data(), bytes.size());
  }

private:
  void read(void* to, std::size_t size)
  {
    char* bytes = static_cast<char*>(to);
    while (size > 0)
    {
      const ssize_t count = ::read(this->In, bytes, size);
      if (count == 0 || (count < 0 && errno != EINTR))
      {
        throw Error("the request is incomplete");
      }
      bytes += std::max<ssize_t>(0, count);
      size -= static_cast<std::size_t>(std::max<ssize_t>(0, count));
    }
  }
  void write(const void* from, std::size_t size)
  {
    const char* bytes = static_cast<const char*>(from);
    while (size > 0)
    {
      const ssize_t count = ::write(this->Out, bytes, size);
      if (count < 0 && errno != EINTR)
      {
        throw Error("the reader of the answer has ended");
      }
      bytes += std::max<ssize_t>(0, count);
      size -= static_cast<std::size_t>(std::max<ssize_t>(0, count));
    }
  }

  int In, Out;
};

/// Closes inherited descriptors that the parent program expects to be closed when it ends: server
/// connections, files.
void closeInheritedFiles()
{
  std::vector<int> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error))
  {
    files.push_back(std::atoi(entry.path().filename().c_str()));
  }
  for (const int file : files)
  {
    if (file > STDERR_FILENO)
    {
      ::close(file);
    }
  }
}

template <class Boundary, class Options, class Mesh>
std::vector<char> answer(MessageReader& request, Mesh (*mesher)(const Boundary&, const Options&),
  const std::function<void(Options&)>& prepare)
{
  Boundary boundary;
  Options options;
  request(boundary, options);
  prepare(options);
  Mesh mesh = mesher(boundary, options);
  MessageWriter writer;
  writer(mesh);
  return std::move(writer.Bytes);
}

std::vector<char> mesh(Channel& channel, const std::string& version)
{
  MesherMessage kind{};
  const std::vector<char> bytes = channel.receive(kind); // all of it, otherwise the answer is lost
  if (version != tautline::version())
  {
    throw Error(std::string("the package tautline-meshers has version ") + tautline::version() +
      ", the libraries have version " + version + ": install the same version of both");
  }
  MessageReader request(bytes);
  if (kind == MesherMessage::Planar)
  {
    const auto report = [&channel](Index points)
    {
      MessageWriter writer;
      writer(points);
      channel.send(MesherMessage::Progress, writer.Bytes);
      return true;
    };
    return answer<PlanarBoundary, PlanarOptions, PlanarMesh>(
      request, meshPlane, [&report](PlanarOptions& options) { options.progress = report; });
  }
  if (kind == MesherMessage::Solid)
  {
    return answer<SolidBoundary, SolidOptions, SolidMesh>(request, meshSolid, [](SolidOptions&) {});
  }
  throw Error("this is not a request for a mesh");
}

int serve(const std::string& version)
{
  Channel channel;
  const auto fail = [&channel](MesherMessage kind, const std::string& text)
  { channel.send(kind, std::vector<char>(text.begin(), text.end())); };
  try
  {
    try
    {
      channel.send(MesherMessage::Result, mesh(channel, version));
      return EXIT_SUCCESS;
    }
    catch (const std::bad_alloc&)
    {
      fail(MesherMessage::NoMemory, "");
    }
    catch (const std::exception& error)
    {
      fail(MesherMessage::Failure, error.what());
    }
  }
  catch (const std::exception&) // error of the channel, which cannot be reported
  {
  }
  return EXIT_FAILURE;
}
}

int main(int count, char** arguments)
{
  if (count == 2 && std::string(arguments[1]) == "--version")
  {
    std::printf("tautline-mesher %s, with TetGen and CGAL %s; under the GNU Affero General Public "
                "License, version 3 or later\n",
      tautline::version(), CGAL_VERSION_STR);
    return EXIT_SUCCESS;
  }
  if (count != 3)
  {
    std::fputs("tautline-mesher generates meshes for Tautline's filters, which start it\n", stderr);
    return ExitUsage;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, SIG_IGN); // sent by a terminal to both: the parent decides
  closeInheritedFiles();
  if (!tautline::endWithParent(std::atoi(arguments[2]), SIGTERM))
  {
    return EXIT_FAILURE;
  }
  return serve(arguments[1]);
}
