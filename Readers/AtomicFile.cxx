// SPDX-License-Identifier: BSD-3-Clause
#include "AtomicFile.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tautline
{
namespace
{
constexpr mode_t NewFileMode = 0666; // minus the umask
constexpr mode_t Permissions = 0777;

std::string folderOf(const std::string& name)
{
  const std::size_t slash = name.rfind('/');
  return slash == name.npos ? "." : slash == 0 ? "/" : name.substr(0, slash);
}

[[noreturn]] void refuse(const std::string& name, const std::string& reason)
{
  throw FileError(name + ": cannot be written: " + reason);
}

[[noreturn]] void refuse(const std::string& name, int error)
{
  refuse(name, std::string(std::strerror(error)));
}

/// The target of a link, relative to the directory of the link.
std::string linkTarget(const std::string& link)
{
  constexpr std::size_t Longest = 4096;
  char text[Longest];
  const ssize_t size = readlink(link.c_str(), text, sizeof(text));
  if (size < 0 || static_cast<std::size_t>(size) == sizeof(text))
  {
    refuse(link, size < 0 ? errno : ENAMETOOLONG);
  }
  const std::string to(text, static_cast<std::size_t>(size));
  return to[0] == '/' ? to : folderOf(link) + "/" + to;
}

/// The name after following all links.
std::string followLinks(const std::string& name)
{
  constexpr int MostLinks = 40; // as in Linux
  std::string target = name;
  struct stat link, folder;
  for (int i = 0; i < MostLinks; ++i)
  {
    if (lstat(target.c_str(), &link) != 0 || !S_ISLNK(link.st_mode))
    {
      return target;
    }
    if (stat(folderOf(target).c_str(), &folder) != 0)
    {
      refuse(name, errno);
    }
    const bool everybody = (folder.st_mode & S_ISVTX) && (folder.st_mode & S_IWOTH);
    if (everybody && link.st_uid != geteuid() && link.st_uid != folder.st_uid)
    {
      refuse(name, target + " is a link of another user");
    }
    target = linkTarget(target);
  }
  refuse(name, ELOOP);
}

std::string temporaryName(const std::string& folder)
{
  std::random_device random; // from the system, not a seeded sequence
  const auto high = static_cast<std::uint64_t>(random());
  char text[64];
  std::snprintf(text, sizeof(text), "/.tautline-%016llx.part",
    static_cast<unsigned long long>(high << 32 | static_cast<std::uint64_t>(random())));
  return folder + text;
}
}

//------------------------------------------------------------------------------
AtomicFile::AtomicFile(const std::string& name)
  : Name(name)
  , Target(followLinks(name))
{
  struct stat older;
  const bool exists = lstat(this->Target.c_str(), &older) == 0;
  if (exists && !S_ISREG(older.st_mode))
  {
    refuse(name, S_ISDIR(older.st_mode) ? "it is a directory" : "it is not a regular file");
  }
  if (exists && faccessat(AT_FDCWD, this->Target.c_str(), W_OK, AT_EACCESS) != 0)
  {
    this->fail(errno);
  }
  std::string temporary;
  do
  {
    temporary = temporaryName(folderOf(this->Target));
    this->Descriptor =
      open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, NewFileMode);
  } while (this->Descriptor < 0 && (errno == EEXIST || errno == EINTR));
  if (this->Descriptor < 0)
  {
    this->fail(errno);
  }
  this->Temporary = temporary;
  if (exists && fchmod(this->Descriptor, older.st_mode & Permissions) != 0)
  {
    // some file systems have no permissions to keep
  }
}

//------------------------------------------------------------------------------
AtomicFile::AtomicFile(AtomicFile&& other) noexcept
  : Name(std::move(other.Name))
  , Target(std::move(other.Target))
  , Temporary(std::exchange(other.Temporary, std::string()))
  , Descriptor(std::exchange(other.Descriptor, -1))
{
}

//------------------------------------------------------------------------------
AtomicFile::~AtomicFile()
{
  if (this->Descriptor >= 0)
  {
    close(this->Descriptor);
  }
  if (!this->Temporary.empty())
  {
    unlink(this->Temporary.c_str());
  }
}

//------------------------------------------------------------------------------
void AtomicFile::write(const char* bytes, std::size_t count)
{
  while (count > 0)
  {
    const ssize_t written = ::write(this->Descriptor, bytes, count);
    if (written < 0 && errno != EINTR)
    {
      this->fail(errno);
    }
    const auto step = static_cast<std::size_t>(written < 0 ? 0 : written);
    bytes += step;
    count -= step;
  }
}

//------------------------------------------------------------------------------
void AtomicFile::finish()
{
  // EINVAL: the file system cannot flush content to its disk
  if (fsync(this->Descriptor) != 0 && errno != EINVAL)
  {
    this->fail(errno);
  }
  if (close(std::exchange(this->Descriptor, -1)) != 0)
  {
    this->fail(errno);
  }
}

//------------------------------------------------------------------------------
void AtomicFile::replace()
{
  if (rename(this->Temporary.c_str(), this->Target.c_str()) != 0)
  {
    this->fail(errno);
  }
  this->Temporary.clear();
}

//------------------------------------------------------------------------------
void AtomicFile::syncName() const
{
  const int folder = open(folderOf(this->Target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0)
  {
    fsync(folder); // not supported by every file system
    close(folder);
  }
}

//------------------------------------------------------------------------------
void AtomicFile::fail(int error) const
{
  refuse(this->Name, error);
}

//------------------------------------------------------------------------------
void replaceAll(std::vector<AtomicFile>& files)
{
  std::for_each(files.rbegin(), files.rend(), [](AtomicFile& file) { file.replace(); });
  std::for_each(files.begin(), files.end(), [](const AtomicFile& file) { file.syncName(); });
}
}
