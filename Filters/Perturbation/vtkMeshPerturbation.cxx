#include "vtkMeshPerturbation.h"

#include "Blocks.h"
#include "MeshAdapter.h"
#include "MovableMesh.h"
#include "tautline/Perturbation/Perturb.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkMeshPerturbation);

namespace
{
constexpr int FixedArray = 0;

/// Marks the points of the ghost cells and those where the chosen array, if any, is not 0.
std::vector<unsigned char> fixedPoints(
  vtkDataArray* chosen, const tautline::MeshAdapter& adapter, vtkIdType count)
{
  std::vector<unsigned char> fixed(count, 0);
  for (vtkIdType i = 0; chosen && i < count; ++i)
  {
    fixed[i] = chosen->GetComponent(i, 0) != 0;
  }
  const tautline::MeshView& view = adapter.mesh().view();
  for (tautline::Index cell = 0; adapter.ghostCells() && cell < view.numberOfCells; ++cell)
  {
    for (auto n = view.offsets[cell]; adapter.ghostCells()[cell] && n < view.offsets[cell + 1]; ++n)
    {
      fixed[view.connectivity[n]] = 1;
    }
  }
  return fixed;
}

/// A mesh reversed throughout is treated as its mirror image.
void settleOrientation(tautline::Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  mesh.setMirrored(mesh.orientation(validity.data()).state == tautline::Orientation::Reversed);
}
}

//------------------------------------------------------------------------------
vtkMeshPerturbation::vtkMeshPerturbation() = default;

//------------------------------------------------------------------------------
vtkMeshPerturbation::~vtkMeshPerturbation() = default;

//------------------------------------------------------------------------------
vtkDataSet* vtkMeshPerturbation::GetOutput()
{
  return vtkDataSet::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
int vtkMeshPerturbation::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshPerturbation::FillInputPortInformation(int, vtkInformation* info)
{
  // Also types that cannot be moved, so that the message can name the remedy.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshPerturbation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  vtkDataSet* output = vtkDataSet::GetData(outputVector);
  this->Report({});
  auto* points = vtkPointSet::SafeDownCast(input);
  auto* moved = vtkPointSet::SafeDownCast(output);
  if (!points || !moved)
  {
    vtkErrorMacro("The points of " << input->GetClassName()
                                   << " are implicit and cannot move: run Image Data to Point Set "
                                      "or Rectilinear Data to Point Set "
                                      "first, which give them coordinates.");
    return 0;
  }
  output->ShallowCopy(input);
  if (input->GetNumberOfPoints() == 0 || input->GetNumberOfCells() == 0)
  {
    return 1;
  }
  return this->Attempt(outputVector, "perturb the mesh in parts",
    [&]
    {
      tautline::MeshAdapter adapter(input, this->Threads);
      tautline::Mesh& mesh = adapter.mesh();
      if (mesh.dimension() == tautline::Dimension::None)
      {
        throw tautline::Error("There is no element to perturb. " + adapter.notice());
      }
      settleOrientation(mesh, this->Threads);
      const std::vector<unsigned char> fixed =
        fixedPoints(tautline::chosenArray(this, FixedArray, input, "of fixed points"), adapter,
          input->GetNumberOfPoints());
      const int type = points->GetPoints()->GetDataType();

      tautline::PerturbOptions options;
      options.percentage = this->Percentage;
      options.fraction = this->Fraction;
      options.tangledFraction = this->TangledFraction;
      options.seed = static_cast<std::uint64_t>(this->Seed);
      options.singlePrecision = type == VTK_FLOAT;
      options.threads = this->Threads;
      options.progress = [this](double fraction) { return this->Proceed(fraction); };
      const tautline::Perturbation result = tautline::perturb(mesh, fixed.data(), options);
      moved->SetPoints(
        tautline::makePoints(result.points, type == VTK_FLOAT ? points->GetPoints() : nullptr));
      tautline::addDisplacement(moved, mesh.view().points, result.points);
      this->Report(result);
    });
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::Report(const tautline::Perturbation& result)
{
  this->NumberOfMovablePoints = result.movable;
  this->NumberOfMovedPoints = result.moved;
  this->InvertedBefore = result.invertedBefore;
  this->InvertedAfter = result.invertedAfter;
  this->TangledFractionReached = result.elements > 0
    ? static_cast<double>(result.invertedAfter) / static_cast<double>(result.elements)
    : 0.0;
  this->LargestDisplacement = result.largestDisplacement;
  std::ostringstream text;
  text << result.moved << " of " << result.movable << " movable points moved.\n"
       << "Largest displacement: " << result.largestDisplacement << ".\n"
       << "Inverted elements: " << result.invertedBefore << " before, " << result.invertedAfter
       << " after, of " << result.elements << "." << (result.stopped ? "\nStopped early." : "");
  this->Summary = text.str();
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Percentage: " << this->Percentage << "\n";
  os << indent << "Fraction: " << this->Fraction << "\n";
  os << indent << "TangledFraction: " << this->TangledFraction << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
}
