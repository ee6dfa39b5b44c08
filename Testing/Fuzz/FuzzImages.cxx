// SPDX-License-Identifier: BSD-3-Clause
// Images of arbitrary bytes, lists of images, and the outline of arbitrary pixels.

#include "FuzzTargets.h"
#include "Readers/MeshFileChecks.h"

#include "tautline/Shapes/Silhouette.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkImageFileReader.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSilhouetteSetReader.h"
#include "vtkTestErrorObserver.h"

#include <cmath>

namespace tautline
{
namespace
{
constexpr Index MaxSide = 48;

template <class Reader>
void update(Reader* reader, const std::string& name)
{
  vtkNew<vtkTest::ErrorObserver> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->SetFileName(name.c_str());
  reader->Update();
  const std::string message = errors->GetErrorMessage();
  expectThat(!errors->GetError() || message.find(fuzzFolder()) != message.npos,
    "the message names the file: " + message);
}
}

//------------------------------------------------------------------------------
void fuzzImage(std::string_view bytes)
{
  const std::string name = fuzzFolder() + "/fuzz.image";
  writeText(name, std::string(bytes));
  vtkNew<vtkImageFileReader> reader;
  update(reader.Get(), name);
  vtkImageData* image = reader->GetOutput();
  vtkDataArray* values = image->GetPointData()->GetScalars();
  expectThat(image->GetNumberOfPoints() == 0 ||
      (values && values->GetNumberOfTuples() == image->GetNumberOfPoints()),
    "an image has a value per pixel");
}

//------------------------------------------------------------------------------
void fuzzImageList(std::string_view bytes)
{
  const std::string name = fuzzFolder() + "/fuzz.csv";
  writeText(name, std::string(bytes));
  writeText(fuzzFolder() + "/a.pgm", "P5\n2 2\n255\nabcd");
  vtkNew<vtkSilhouetteSetReader> reader;
  reader->CanReadFile(name.c_str());
  update(reader.Get(), name);
}

//------------------------------------------------------------------------------
void fuzzSilhouette(std::string_view bytes)
{
  ByteReader input(bytes);
  const Index width = 1 + input.choice(MaxSide), height = 1 + input.choice(MaxSide);
  const double spacing = 1.0 + input.choice(40);
  SilhouetteOptions options;
  options.foreground = static_cast<Foreground>(input.choice(3));
  if (input.choice(4) == 0)
  {
    options.threshold = input.next<float>();
  }
  const bool bits = input.choice(2) == 0; // a binary image, or any values
  std::vector<float> values(static_cast<std::size_t>(width * height));
  for (float& value : values)
  {
    value = bits ? static_cast<float>(input.choice(2)) : input.next<float>();
  }
  try
  {
    const Silhouette shape = traceSilhouette({ values.data(), width, height }, options);
    expectThat(std::isfinite(shape.area) && shape.area > 0, "a shape has an area");
    expectThat(shape.mask.size() == values.size(), "the mask has a value per pixel");
    for (const Vec2& p : shape.outline)
    {
      expectThat(p[0] >= -1 && p[0] <= static_cast<double>(width) && p[1] >= -1 &&
          p[1] <= static_cast<double>(height),
        "the outline is in the image");
    }
    const std::vector<Vec2> polygon = approximateOutline(shape.outline, spacing);
    const PolygonMesh mesh = triangulatePolygon(polygon);
    expectThat(mesh.triangles.size() + 2 == mesh.points.size(), "n vertices, n - 2 triangles");
  }
  catch (const Error&)
  {
    // no shape in this image
  }
}
}
