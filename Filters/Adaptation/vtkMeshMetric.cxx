// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMetric.h"

#include "Blocks.h"
#include "GatheredExecution.h"
#include "MeshAdapter.h"
#include "MeshOutput.h"
#include "PointMerge.h"
#include "ProgressStep.h"
#include "tautline/Adaptation/MakeMetric.h"
#include "tautline/Adaptation/MetricEllipsoids.h"
#include "tautline/Core/Interruption.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cfloat>
#include <limits>
#include <numeric>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkMeshMetric);

namespace
{
enum OutputPorts
{
  MeshPort,
  EllipsoidPort,
  NumberOfOutputPorts
};
enum InputArrays
{
  SizeArray,
  FieldArray,
  DistanceArray,
  WallArray,
  OtherArray
};
constexpr const char* FilterName = "Metric Tensor"; // in the menu
constexpr int TensorComponents = 6, MatrixComponents = 9;

/// The fractions of the diagonal of the bounding box that a value of 0 stands for.
constexpr double AutomaticSmallest = 1e-6, AutomaticLargest = 0.1, AutomaticDetail = 1e-3;

/// The values of an array, `components` per tuple, times a factor.
std::vector<double> valuesOf(
  vtkDataArray* array, const std::vector<int>& components, double factor = 1.0)
{
  std::vector<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    tautline::pollInterruption(i);
    for (const int component : components)
    {
      values.push_back(factor * array->GetComponent(i, component));
    }
  }
  return values;
}

/// The same for an array with one component.
std::vector<double> scalarsOf(vtkDataArray* array, const char* purpose, double factor)
{
  if (array->GetNumberOfComponents() != 1)
  {
    throw tautline::Error(std::string("The array ") + purpose + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components: choose one with 1.");
  }
  return valuesOf(array, { 0 }, factor);
}

/// Converts sizes or metric tensors to another unit of length.
tautline::PointSizes sizesOf(
  vtkDataArray* array, const char* purpose, double unit, std::vector<double>& values)
{
  const int components = array->GetNumberOfComponents();
  if (components != 1 && components != TensorComponents && components != MatrixComponents)
  {
    throw tautline::Error(std::string("The array ") + purpose + " has " +
      std::to_string(components) +
      " components: choose one with 1 (sizes), or with 6 (xx yy zz xy yz xz) or 9 (metric "
      "tensors).");
  }
  if (components == 1)
  {
    values = valuesOf(array, { 0 }, 1.0 / unit);
    return { values.data(), 1 };
  }
  values = components == TensorComponents ? valuesOf(array, { 0, 1, 2, 3, 4, 5 }, unit * unit)
                                          : valuesOf(array, { 0, 4, 8, 1, 5, 2 }, unit * unit);
  return { values.data(), TensorComponents };
}

/// A new array with one number per ellipsoid, repeated for all its points.
template <class Array, class Value>
void addEllipsoidArray(
  vtkPolyData* output, const char* name, const std::vector<Value>& values, std::size_t pointsOfEach)
{
  vtkNew<Array> array;
  array->SetName(name);
  for (const Value value : values)
  {
    for (std::size_t k = 0; k < pointsOfEach; ++k)
    {
      array->InsertNextValue(value);
    }
  }
  output->GetPointData()->AddArray(array);
}

void fillEllipsoids(const tautline::MetricEllipsoids& ellipsoids, vtkPolyData* output)
{
  output->Initialize();
  output->SetPoints(tautline::makePoints(ellipsoids.points, 3));
  output->SetPolys(tautline::makeCells(ellipsoids.triangles, 3));
  const std::size_t each = ellipsoids.pointsOfEach();
  addEllipsoidArray<vtkDoubleArray>(output, "Size", ellipsoids.sizes, each);
  addEllipsoidArray<vtkDoubleArray>(output, "Anisotropy", ellipsoids.ratios, each);
  addEllipsoidArray<vtkIdTypeArray>(output, "PointId", ellipsoids.centers, each);
  output->GetPointData()->SetActiveScalars("Size");
}

/// Adds the tensors to the output, in its unit of length.
void addTensors(
  const std::string& name, std::vector<double>& tensors, double unit, vtkDataSet* output)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(TensorComponents);
  array->SetNumberOfTuples(output->GetNumberOfPoints());
  const char* components[TensorComponents] = { "XX", "YY", "ZZ", "XY", "YZ", "XZ" };
  for (int c = 0; c < TensorComponents; ++c)
  {
    array->SetComponentName(c, components[c]);
  }
  for (std::size_t i = 0; i < tensors.size(); ++i)
  {
    tautline::pollInterruption(static_cast<tautline::Index>(i));
    double& entry = tensors[i];
    const bool ofDiagonal = i % TensorComponents < 3;
    entry = entry / unit / unit;
    if (!std::isfinite(entry) || (ofDiagonal && entry < DBL_MIN)) // smaller ones lose digits
    {
      throw tautline::Error("The inverse squares of the sizes are beyond the range of double "
                            "precision: scale the mesh with Transform.");
    }
    array->SetValue(static_cast<vtkIdType>(i), entry);
  }
  output->GetPointData()->AddArray(array);
  output->GetPointData()->SetActiveTensors(name.c_str());
}
}

//------------------------------------------------------------------------------
struct vtkMeshMetric::Arrays
{
  std::vector<double> sizes, field, distances, others;
  std::vector<unsigned char> walls, skip;
};

//------------------------------------------------------------------------------
vtkMeshMetric::vtkMeshMetric()
{
  this->DeclarePorts(1, NumberOfOutputPorts);
}

//------------------------------------------------------------------------------
vtkMeshMetric::~vtkMeshMetric() = default;

//------------------------------------------------------------------------------
int vtkMeshMetric::FillOutputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillOutputPortInformation(port, info);
  if (port == EllipsoidPort)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  }
  return 1;
}

//------------------------------------------------------------------------------
bool vtkMeshMetric::NeedsFinitePoints(int) const
{
  return true;
}

//------------------------------------------------------------------------------
std::string vtkMeshMetric::FindSettingProblem() const
{
  if (this->ArrayName.empty())
  {
    return "Array Name is empty: give the array of metric tensors a name.";
  }
  if (this->Source == HESSIAN && this->TargetValue == 0.0)
  {
    return "Target Value is 0: give a number above 0.";
  }
  if (this->Source == HESSIAN && this->Norm > 0.0 && this->Norm < 1.0)
  {
    return "Norm is below 1: give an exponent of at least 1, or 0 for the largest error.";
  }
  if (this->Gradation > 0.0 && this->Gradation <= 1.0)
  {
    return "Gradation is at most 1: give a growth factor above 1, or 0 for none.";
  }
  if (this->LargestSize > 0.0 && this->SmallestSize > this->LargestSize)
  {
    return "Smallest Size is above Largest Size: exchange them.";
  }
  if (this->EllipsoidScale == 0.0)
  {
    return "Ellipsoid Scale is 0: give a number above 0, or set Maximum Ellipsoids to 0.";
  }
  return this->Superclass::FindSettingProblem();
}

//------------------------------------------------------------------------------
int vtkMeshMetric::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(FilterName);
  return this->Attempt(outputVector, "compute the metric of parts of the mesh",
    [&]
    {
      vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
      const int blocks = tautline::countBlocks(input);
      tautline::MetricEllipsoids ellipsoids;
      tautline::forEachBlock(input, nullptr, nullptr, vtkDataObject::GetData(outputVector),
        [&](const tautline::InputBlock& block)
        {
          block.output->ShallowCopy(block.input);
          if (block.input->GetNumberOfPoints() > 0 && block.input->GetNumberOfCells() > 0)
          {
            this->Compute(block, blocks, ellipsoids);
          }
        });
      fillEllipsoids(
        ellipsoids, vtkPolyData::SafeDownCast(vtkDataObject::GetData(outputVector, EllipsoidPort)));
    });
}

//------------------------------------------------------------------------------
void vtkMeshMetric::Compute(
  const tautline::InputBlock& block, int blocks, tautline::MetricEllipsoids& ellipsoids)
{
  tautline::MeshAdapter adapter(block.input, this->Threads);
  const tautline::JoinedCopies copies = this->MergeCoincidentPoints
    ? adapter.joinCopies(block.input->GetPointData()->GetGlobalIds())
    : tautline::JoinedCopies();
  if (this->MergeCoincidentPoints)
  {
    adapter.mergeCoincidentPoints(this->Threads);
  }
  adapter.enterFrame();
  const tautline::Mesh& mesh = adapter.mesh();
  if (mesh.dimension() == tautline::Dimension::None)
  {
    throw tautline::Error("There is no element to compute a metric for. " + adapter.notice());
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw tautline::Error(std::to_string(mesh.higherOrderCells()) +
      " cells are of higher order: run Curve Mesh with order 1 first to make them linear.");
  }
  const std::string oriented = adapter.orient(nullptr, false);
  const tautline::ProgressStep progress(
    this, static_cast<double>(block.number) / blocks, (block.number + 1.0) / blocks);
  Arrays arrays;
  tautline::MetricResult result =
    tautline::makeMetric(adapter.mesh(), this->MakeOptions(block, adapter, arrays));
  addTensors(this->ArrayName, result.tensors, adapter.frame().unit(), block.output);

  const double* places = adapter.inputView().points;
  const std::vector<tautline::Index> chosen =
    tautline::spreadPoints(places, result.points, this->MaximumEllipsoids / blocks);
  for (const tautline::Index p : chosen)
  {
    tautline::MetricTensor m;
    std::copy_n(&result.tensors[m.size() * p], m.size(), m.begin());
    tautline::addEllipsoid(p, tautline::pointOf(adapter.inputView(), p), m,
      result.normals.empty() ? nullptr : &result.normals[p], this->EllipsoidScale, ellipsoids);
  }
  this->Report(block, adapter, result);
  for (const std::string& text :
    { oriented, tautline::describeMerged(adapter.coincident(), adapter.given()),
      tautline::describeJoined(copies) })
  {
    this->AddToSummary(text);
  }
}

//------------------------------------------------------------------------------
tautline::MetricOptions vtkMeshMetric::MakeOptions(
  const tautline::InputBlock& block, const tautline::MeshAdapter& adapter, Arrays& arrays)
{
  const double unit = adapter.frame().unit();
  const auto chosen = [&](int index, const char* purpose)
  { return tautline::chosenArray(this, index, block.input, purpose, tautline::ArrayOf::Points); };
  const double diagonal = tautline::diagonalOf(adapter.mesh().view());
  if (!(diagonal > 0.0))
  {
    throw tautline::Error("All points coincide: give a mesh with an extent.");
  }
  const auto length = [&](double given, double automatic)
  { return given > 0.0 ? given / unit : automatic * diagonal; };

  tautline::MetricOptions options;
  options.source = static_cast<tautline::MetricSource>(this->Source);
  options.recovery = static_cast<tautline::HessianRecovery>(this->Recovery);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool isNorm = this->Norm > 0.0 && this->Norm < std::numeric_limits<double>::max();
  options.norm = isNorm ? this->Norm : infinity;
  options.target = static_cast<tautline::MetricTarget>(this->Target);
  options.targetValue = this->TargetValue;
  const int dimension = adapter.mesh().dimension() == tautline::Dimension::Volume ? 3 : 2;
  if (this->Target == INTERPOLATION_ERROR)
  {
    options.targetValue /= std::pow(unit, dimension / options.norm); // an integral over the mesh
  }
  options.chordError = length(this->ChordError, AutomaticDetail);
  options.featureAngle = this->FeatureAngle;
  options.layers = { length(this->WallSize, AutomaticDetail), this->WallGrowth,
    this->TangentialRatio };
  options.limits = { length(this->SmallestSize, AutomaticSmallest),
    length(this->LargestSize, AutomaticLargest), this->LargestAnisotropy };
  // A given size takes precedence over a default one.
  if (this->LargestSize == 0.0)
  {
    options.limits.largest = std::max(options.limits.largest, options.limits.smallest);
  }
  else if (this->SmallestSize == 0.0)
  {
    options.limits.smallest = std::min(options.limits.smallest, options.limits.largest);
  }
  options.gradation = this->Gradation;
  options.representative = adapter.coincident().representative;
  arrays.skip = tautline::cellsBesideElements(adapter);
  options.skip = arrays.skip.empty() ? nullptr : arrays.skip.data();
  options.threads = this->Threads;

  if (vtkDataArray* sizes = chosen(SizeArray, "of sizes"); sizes && this->Source == SIZES)
  {
    options.sizes = sizesOf(sizes, "of sizes", unit, arrays.sizes);
  }
  if (vtkDataArray* field = chosen(FieldArray, "of the field"); field && this->Source == HESSIAN)
  {
    options.fieldComponents = field->GetNumberOfComponents();
    std::vector<int> components(options.fieldComponents);
    std::iota(components.begin(), components.end(), 0);
    arrays.field = valuesOf(field, components);
    options.field = arrays.field.data();
    options.fieldPrecision = field->GetDataType() == VTK_FLOAT ? FLT_EPSILON : DBL_EPSILON;
  }
  if (this->Source == DISTANCE)
  {
    if (vtkDataArray* distance = chosen(DistanceArray, "of distances"))
    {
      arrays.distances = scalarsOf(distance, "of distances", 1.0 / unit);
      options.distances = arrays.distances.data();
    }
    else if (vtkDataArray* walls = chosen(WallArray, "of walls"))
    {
      arrays.walls.assign(block.input->GetNumberOfPoints(), 0);
      tautline::markPoints(adapter.inputView(), walls, false, arrays.walls);
      options.walls = arrays.walls.data();
    }
  }
  if (vtkDataArray* others = chosen(OtherArray, "to intersect with"))
  {
    options.others = sizesOf(others, "to intersect with", unit, arrays.others);
  }
  return options;
}

//------------------------------------------------------------------------------
void vtkMeshMetric::Report(const tautline::InputBlock& block, const tautline::MeshAdapter& adapter,
  const tautline::MetricResult& result)
{
  const double unit = adapter.frame().unit();
  const double smallest = unit * result.extremes.smallest, largest = unit * result.extremes.largest;
  std::ostringstream text;
  text << (block.name.empty() ? "" : "In " + block.name + ": ") << "Metric of "
       << result.points.size() << " points: sizes from " << smallest << " to " << largest
       << ", anisotropy up to " << result.extremes.ratio << ".\nComplexity: " << result.complexity
       << ". Elements with edges of length 1: about " << std::round(result.elements) << ".";
  if (this->Gradation > 0.0)
  {
    text << "\nThe gradation changed sizes in " << result.gradation.rounds << " rounds.";
  }
  text << (result.note.empty() ? "" : "\n") << result.note;
  this->AddToSummary(text.str());
  this->Warn(adapter.coarseness());
  const bool first = !(this->LargestFound > 0.0);
  this->Complexity += result.complexity;
  this->Elements += result.elements;
  this->SmallestFound = first ? smallest : std::min(this->SmallestFound, smallest);
  this->LargestFound = std::max(this->LargestFound, largest);
  this->AnisotropyFound = std::max(this->AnisotropyFound, result.extremes.ratio);
}

//------------------------------------------------------------------------------
void vtkMeshMetric::SetArrayName(const char* name)
{
  const std::string given = name ? name : "";
  if (given != this->ArrayName)
  {
    this->ArrayName = given;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkPolyData* vtkMeshMetric::GetEllipsoids()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(EllipsoidPort));
}

//------------------------------------------------------------------------------
void vtkMeshMetric::ClearResult()
{
  this->Superclass::ClearResult();
  this->Complexity = this->Elements = this->SmallestFound = this->LargestFound =
    this->AnisotropyFound = 0.0;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshMetric::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
void vtkMeshMetric::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Complexity, this->Elements, this->SmallestFound, this->LargestFound,
    this->AnisotropyFound);
}

//------------------------------------------------------------------------------
void vtkMeshMetric::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Source: " << this->Source << "\n";
  os << indent << "Recovery: " << this->Recovery << "\n";
  os << indent << "Norm: " << this->Norm << "\n";
  os << indent << "Target: " << this->Target << "\n";
  os << indent << "TargetValue: " << this->TargetValue << "\n";
  os << indent << "ChordError: " << this->ChordError << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "WallSize: " << this->WallSize << "\n";
  os << indent << "WallGrowth: " << this->WallGrowth << "\n";
  os << indent << "TangentialRatio: " << this->TangentialRatio << "\n";
  os << indent << "SmallestSize: " << this->SmallestSize << "\n";
  os << indent << "LargestSize: " << this->LargestSize << "\n";
  os << indent << "LargestAnisotropy: " << this->LargestAnisotropy << "\n";
  os << indent << "Gradation: " << this->Gradation << "\n";
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "MaximumEllipsoids: " << this->MaximumEllipsoids << "\n";
  os << indent << "EllipsoidScale: " << this->EllipsoidScale << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
}
