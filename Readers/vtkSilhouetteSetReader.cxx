// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSilhouetteSetReader.h"

#include "ImageFileAdapter.h"
#include "MenuNames.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Types.h"

#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

vtkStandardNewMacro(vtkSilhouetteSetReader);

namespace
{
namespace fs = std::filesystem;
using tautline::Error;

struct Entry
{
  fs::path file;
  std::string label;
};

/// The fields of a line; quotes enclose commas.
std::vector<std::string> split(const std::string& line)
{
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (char c : line)
  {
    if (c == '"')
    {
      quoted = !quoted;
    }
    else if (c == ',' && !quoted)
    {
      fields.emplace_back();
    }
    else if (c != '\r')
    {
      fields.back() += c;
    }
  }
  for (std::string& field : fields)
  {
    field.erase(0, field.find_first_not_of(" \t"));
    field.erase(field.find_last_not_of(" \t") + 1);
  }
  return fields;
}

std::size_t columnOf(
  const std::vector<std::string>& names, std::initializer_list<const char*> candidates)
{
  for (const char* name : candidates)
  {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end())
    {
      return static_cast<std::size_t>(found - names.begin());
    }
  }
  return names.size();
}

std::vector<Entry> readList(const fs::path& list)
{
  if (!fs::is_regular_file(list))
  {
    throw Error(list.string() + ": is not a regular file"); // opening a pipe would wait forever
  }
  std::ifstream stream(list);
  std::string line;
  if (!stream || !std::getline(stream, line))
  {
    throw Error(list.string() + ": cannot be read, or is empty");
  }
  const std::vector<std::string> names = split(line);
  const std::size_t file = columnOf(names, { "file" });
  const std::size_t label = columnOf(names, { "class", "label", "class_id" });
  if (file == names.size())
  {
    throw Error(
      list.string() + ":1: no column 'file'; the first line must name the columns file and class");
  }
  std::vector<Entry> entries;
  for (int number = 2; std::getline(stream, line); ++number)
  {
    const std::vector<std::string> fields = split(line);
    if (fields.size() == 1 && fields[0].empty())
    {
      continue;
    }
    if (fields.size() != names.size())
    {
      throw Error(list.string() + ":" + std::to_string(number) + ": " +
        std::to_string(fields.size()) + " fields, " + std::to_string(names.size()) +
        " are expected");
    }
    fs::path path = list.parent_path() / fields[file];
    if (!fs::exists(path))
    {
      path = list.parent_path() / "images" / fields[file];
    }
    if (!fs::exists(path))
    {
      throw Error(list.string() + ":" + std::to_string(number) + ": there is no file '" +
        fields[file] + "' beside the list or in the folder images");
    }
    entries.push_back({ path, label < fields.size() ? fields[label] : std::string() });
  }
  return entries;
}

std::vector<Entry> readFolder(const fs::path& folder)
{
  std::vector<Entry> entries;
  for (const fs::directory_entry& item : fs::directory_iterator(folder))
  {
    if (tautline::isImageFile(item.path().string()))
    {
      const std::string name = item.path().stem().string();
      entries.push_back({ item.path(), name.substr(0, name.find_first_of("0123456789 ")) });
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b) { return a.file.filename() < b.file.filename(); });
  return entries;
}

void addText(vtkImageData* image, const char* name, const std::string& text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  image->GetFieldData()->AddArray(array);
}

/// Offsets are whole pixels, so that the coordinates within an image are exactly as at the origin.
void placeSideBySide(vtkMultiBlockDataSet* images)
{
  constexpr double gap = 0.1; // fraction of the largest image
  const unsigned int count = images->GetNumberOfBlocks();
  std::array<double, 2> cell = { 0.0, 0.0 };
  for (unsigned int i = 0; i < count; ++i)
  {
    double bounds[6];
    vtkImageData::SafeDownCast(images->GetBlock(i))->GetBounds(bounds);
    cell = { std::max(cell[0], bounds[1] - bounds[0]), std::max(cell[1], bounds[3] - bounds[2]) };
  }
  for (double& length : cell)
  {
    length = std::ceil((1.0 + gap) * length);
  }
  // The number of columns that makes the arrangement about square.
  const double columns = std::ceil(std::sqrt(count * cell[1] / std::max(cell[0], 1.0)));
  for (unsigned int i = 0; i < count; ++i)
  {
    const double row = std::floor(i / columns);
    auto* image = vtkImageData::SafeDownCast(images->GetBlock(i));
    image->SetOrigin((i - columns * row) * cell[0], -row * cell[1], 0.0);
  }
}
}

//------------------------------------------------------------------------------
vtkSilhouetteSetReader::vtkSilhouetteSetReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText(tautline::menuName("vtkSilhouetteSetReader"));
}

//------------------------------------------------------------------------------
vtkSilhouetteSetReader::~vtkSilhouetteSetReader()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
int vtkSilhouetteSetReader::CanReadFile(const char* name)
{
  std::error_code ignored;
  if (name && fs::is_directory(name, ignored))
  {
    return 1;
  }
  if (!name || !fs::is_regular_file(name, ignored))
  {
    return 0;
  }
  std::ifstream stream(name);
  std::string line;
  if (fs::path(name).extension() != ".csv" || !std::getline(stream, line))
  {
    return 0;
  }
  const std::vector<std::string> names = split(line);
  return columnOf(names, { "file" }) < names.size();
}

//------------------------------------------------------------------------------
int vtkSilhouetteSetReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkMultiBlockDataSet* output = vtkMultiBlockDataSet::GetData(outputVector);
  try
  {
    const fs::path path = this->FileName ? this->FileName : "";
    if (path.empty() || !fs::exists(path))
    {
      throw Error(
        path.empty() ? "no file name is set" : path.string() + ": there is no such file or folder");
    }
    const bool list = path.extension() == ".csv";
    const std::vector<Entry> entries = fs::is_directory(path) ? readFolder(path)
      : list                                                  ? readList(path)
                                                              : readFolder(path.parent_path());
    if (entries.empty())
    {
      throw Error(path.string() + ": no images (" + tautline::ImageFormats + ")");
    }
    output->SetNumberOfBlocks(static_cast<unsigned int>(entries.size()));
    for (unsigned int i = 0; i < entries.size() && !this->GetAbortExecute(); ++i)
    {
      const vtkSmartPointer<vtkImageData> image = tautline::readImage(entries[i].file.string());
      addText(image, "Label", entries[i].label);
      addText(image, "File", entries[i].file.filename().string());
      output->SetBlock(i, image);
      output->GetMetaData(i)->Set(
        vtkCompositeDataSet::NAME(), entries[i].file.stem().string().c_str());
      this->UpdateProgress(static_cast<double>(i + 1) / static_cast<double>(entries.size()));
    }
    if (this->SideBySide && !this->GetAbortExecute())
    {
      placeSideBySide(output);
    }
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    vtkErrorMacro(<< tautline::errorText(error, "read the set in parts"));
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkSilhouetteSetReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "SideBySide: " << this->SideBySide << "\n";
}
