// SPDX-License-Identifier: BSD-3-Clause
#include "FoamCase.h"
#include "FoamFile.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace tautline
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* MeshFolder = "polyMesh";
constexpr const char* ConstantFolder = "constant";
constexpr const char* ProcessorFolder = "processor";

/// The directory of a case, or a directory polyMesh.
fs::path folderOfCase(const std::string& name)
{
  const fs::path path = fs::absolute(name).lexically_normal();
  std::error_code error;
  if (fs::is_directory(path, error))
  {
    return path.has_filename() ? path : path.parent_path();
  }
  if (!fs::exists(path, error))
  {
    throw FileError(name + ": cannot be opened: there is no such file");
  }
  return path.filename() == "controlDict" ? path.parent_path().parent_path() : path.parent_path();
}

fs::path meshIn(const fs::path& constant, const std::string& region)
{
  return (region.empty() ? constant : constant / region) / MeshFolder;
}

bool hasMesh(const fs::path& folder)
{
  return foamFileExists((folder / "faces").string());
}

/// The names in a directory; none if it cannot be read.
std::vector<std::string> namesIn(const fs::path& folder)
{
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
  {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The number of a processor directory; -1 for other directories.
int processorNumber(const std::string& name)
{
  const std::string prefix = ProcessorFolder;
  int number = 0;
  const char* end = name.data() + name.size();
  const bool named = name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0;
  return named && std::from_chars(name.data() + prefix.size(), end, number).ptr == end ? number
                                                                                       : -1;
}

/// The number of processors with a directory; throws if one in between is missing.
int countProcessors(const std::string& name, const fs::path& folder)
{
  const std::string prefix = ProcessorFolder;
  std::vector<int> found;
  bool collated = false;
  for (const std::string& each : namesIn(folder))
  {
    const int number = processorNumber(each);
    if (number >= 0)
    {
      found.push_back(number);
    }
    collated |= each.compare(0, prefix.size() + 1, prefix + "s") == 0;
  }
  if (found.empty() && collated)
  {
    throw FileError(name +
      ": the case is decomposed in the collated format: run reconstructParMesh"
      " or decomposePar -fileHandler uncollated");
  }
  std::sort(found.begin(), found.end());
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    if (found[i] != static_cast<int>(i))
    {
      throw FileError((folder / (prefix + std::to_string(i))).string() +
        ": is missing, and there are later processors");
    }
  }
  return static_cast<int>(found.size());
}
}

//------------------------------------------------------------------------------
std::string foamCaseFolder(const std::string& name)
{
  return folderOfCase(name).string();
}

//------------------------------------------------------------------------------
FoamMeshPath splitFoamPath(const std::string& meshFolder)
{
  FoamMeshPath path;
  fs::path parent = fs::path(meshFolder).parent_path();
  const std::string name = parent.filename().string();
  path.constant = name == ConstantFolder;
  if (!path.constant && parent.parent_path().filename() == ConstantFolder)
  {
    path.constant = true;
    path.region = name;
    parent = parent.parent_path();
  }
  fs::path folder = parent.parent_path();
  path.ofTimes = folder.string();
  if (processorNumber(folder.filename().string()) >= 0)
  {
    folder = folder.parent_path();
  }
  path.folder = folder.string();
  path.inside = fs::path(meshFolder).lexically_relative(folder).string();
  return path;
}

//------------------------------------------------------------------------------
std::vector<std::string> movingFoamMeshes(const FoamMeshPath& path)
{
  std::vector<std::string> found;
  for (const std::string& each : path.constant ? namesIn(path.ofTimes) : std::vector<std::string>())
  {
    double time = 0.0;
    const char* end = each.data() + each.size();
    if (std::from_chars(each.data(), end, time).ptr == end)
    {
      const fs::path mesh = meshIn(fs::path(path.ofTimes) / each, path.region);
      if (foamFileExists((mesh / "points").string()))
      {
        found.push_back(mesh.string());
      }
    }
  }
  return found;
}

//------------------------------------------------------------------------------
FoamLocation locateFoamCase(const FoamRequest& request)
{
  FoamLocation location;
  const fs::path folder = folderOfCase(request.name);
  if (folder.filename() == MeshFolder)
  {
    location.folders.push_back(folder.string());
    return location;
  }
  const fs::path whole = meshIn(folder / ConstantFolder, request.region);
  const bool automatic = request.type == FoamCaseType::Automatic;
  const int processors =
    request.type == FoamCaseType::Reconstructed || (automatic && hasMesh(whole))
    ? 0
    : countProcessors(request.name, folder);
  location.decomposed = processors > 0;
  if (!location.decomposed && request.type == FoamCaseType::Decomposed)
  {
    throw FileError(request.name + ": there is no directory processor0 in " + folder.string());
  }
  if (!location.decomposed && !hasMesh(whole))
  {
    throw FileError(request.name + ": there is no mesh: " + (whole / "faces").string() +
      (automatic ? " and processor0 are missing" : " is missing") +
      "; run blockMesh or another mesher first");
  }
  for (int i = 0; i < processors; ++i)
  {
    const fs::path processor = folder / (ProcessorFolder + std::to_string(i));
    location.folders.push_back(meshIn(processor / ConstantFolder, request.region).string());
  }
  if (!location.decomposed)
  {
    location.folders.push_back(whole.string());
  }
  return location;
}
}
