// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFileAdapter.h"

#include "ImageFile.h"

#include "vtkBMPReader.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkJPEGReader.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"
#include "vtkPNMReader.h"
#include "vtkPointData.h"
#include "vtkTIFFReader.h"

namespace tautline
{
namespace
{
vtkSmartPointer<vtkImageReader2> makeReader(const ImageHeader& header)
{
  switch (header.format)
  {
    case ImageFormat::Png:
      return vtkSmartPointer<vtkPNGReader>::New();
    case ImageFormat::Jpeg:
      return vtkSmartPointer<vtkJPEGReader>::New();
    case ImageFormat::Tiff:
      return vtkSmartPointer<vtkTIFFReader>::New();
    case ImageFormat::Bmp:
    {
      // VTK would take the end of the file for the end of the pixels.
      auto reader = vtkSmartPointer<vtkBMPReader>::New();
      reader->SetHeaderSize(header.dataOffset);
      return reader;
    }
    default:
      return vtkSmartPointer<vtkPNMReader>::New();
  }
}

/// The first message of a reader; VTK reports damaged pixels as warnings.
void keepMessage(vtkObject*, unsigned long, void* kept, void* message)
{
  auto& text = *static_cast<std::string*>(kept);
  if (text.empty() && message)
  {
    text = static_cast<const char*>(message);
    text.erase(text.find_last_not_of(" \n\r\t") + 1);
    const std::size_t object =
      text.rfind("): "); // before it: "ERROR: In file, line ...\nvtk...(0x...
    text.erase(0, object == text.npos ? 0 : object + 3);
  }
}
/// The rows in the opposite order: VTK has the first row of a TIFF file, the top one, at y = 0, and
/// the rows of all other formats from the bottom up.
vtkSmartPointer<vtkImageData> flipped(vtkImageData* image)
{
  auto made = vtkSmartPointer<vtkImageData>::New();
  made->CopyStructure(image);
  vtkDataArray* from = image->GetPointData()->GetScalars();
  const auto to = vtkSmartPointer<vtkDataArray>::Take(from->NewInstance());
  to->SetName(from->GetName());
  to->SetNumberOfComponents(from->GetNumberOfComponents());
  to->SetNumberOfTuples(from->GetNumberOfTuples());
  const vtkIdType width = image->GetDimensions()[0], height = image->GetDimensions()[1];
  for (vtkIdType row = 0; row < height; ++row)
  {
    to->InsertTuples(row * width, width, (height - 1 - row) * width, from);
  }
  made->GetPointData()->SetScalars(to);
  return made;
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> readImage(const std::string& name)
{
  const ImageHeader header = checkImage(name);
  const vtkSmartPointer<vtkImageReader2> reader = makeReader(header);
  std::string message;
  vtkNew<vtkCallbackCommand> keep;
  keep->SetCallback(keepMessage);
  keep->SetClientData(&message);
  reader->AddObserver(vtkCommand::ErrorEvent, keep);
  reader->AddObserver(vtkCommand::WarningEvent, keep);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, keep);
  reader->SetFileName(name.c_str());
  reader->Update();
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  const int* size = image->GetDimensions();
  if (message.empty() &&
    (size[0] != static_cast<int>(header.width) || size[1] != static_cast<int>(header.height)))
  {
    message = "the pixels do not have the size of the header";
  }
  if (!message.empty())
  {
    throw FileError(name + ": the image cannot be read: " + message);
  }
  return header.format == ImageFormat::Tiff ? flipped(image) : image;
}
}
