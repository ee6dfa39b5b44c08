#include "vtkElementQuality.h"

#include "ColorMaps.h"
#include "MeshAdapter.h"
#include "MetricSelection.h"
#include "QualityTotals.h"
#include "TargetChoice.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSignedCharArray.h"
#include "vtkTable.h"

#include <algorithm>

vtkStandardNewMacro(vtkElementQuality);
vtkCxxSetObjectMacro(vtkElementQuality, Controller, vtkMultiProcessController);

namespace
{
enum Ports
{
  MeshPort,
  StatisticsPort,
  DistributionPort,
  AnglesPort,
  WorstPort,
  NumberOfPorts
};
}

//------------------------------------------------------------------------------
vtkElementQuality::vtkElementQuality()
  : Selection(std::make_unique<tautline::MetricSelection>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(NumberOfPorts);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

//------------------------------------------------------------------------------
vtkElementQuality::~vtkElementQuality()
{
  this->SetController(nullptr);
}

//------------------------------------------------------------------------------
void vtkElementQuality::AddMetric(int metric)
{
  try
  {
    if (this->Selection->add(metric))
    {
      this->Modified();
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::AddMetricByName(const char* name)
{
  try
  {
    if (this->Selection->addByName(name))
    {
      this->Modified();
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::ClearMetrics()
{
  if (this->Selection->clear())
  {
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkElementQuality::GetNumberOfMetrics() const
{
  return this->Selection->count();
}

//------------------------------------------------------------------------------
vtkMultiProcessController* vtkElementQuality::GetController()
{
  return this->Controller;
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetStatistics()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(StatisticsPort));
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetDistribution()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(DistributionPort));
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetAngles()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(AnglesPort));
}

//------------------------------------------------------------------------------
vtkPolyData* vtkElementQuality::GetWorst()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(WorstPort));
}

//------------------------------------------------------------------------------
int vtkElementQuality::GetNumberOfKnownMetrics()
{
  return static_cast<int>(tautline::metricRegistry().size());
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetKnownMetric(int i)
{
  return i >= 0 && i < GetNumberOfKnownMetrics()
    ? tautline::describeMetric(tautline::metricRegistry()[i])
    : std::string();
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetKnownMetricFields()
{
  return tautline::metricFields();
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetColorMapSettings()
{
  return tautline::colorMapSettings(tautline::metricColorMaps());
}

//------------------------------------------------------------------------------
int vtkElementQuality::FillInputPortInformation(int port, vtkInformation* info)
{
  // The composite type first: the tables are then those of the whole, not of each block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), port == 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkElementQuality::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(),
    port == MeshPort      ? "vtkDataObject"
      : port == WorstPort ? "vtkPolyData"
                          : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkElementQuality::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  if (!input)
  {
    return 0;
  }
  const auto provide = [&](int port, vtkDataObject* made)
  {
    const auto object = vtkSmartPointer<vtkDataObject>::Take(made);
    vtkInformation* info = outputVector->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || std::string(output->GetClassName()) != object->GetClassName())
    {
      info->Set(vtkDataObject::DATA_OBJECT(), object);
    }
  };
  provide(MeshPort, input->NewInstance());
  provide(StatisticsPort, vtkTable::New());
  provide(DistributionPort, vtkTable::New());
  provide(AnglesPort, vtkTable::New());
  provide(WorstPort, vtkPolyData::New());
  return 1;
}

//------------------------------------------------------------------------------
int vtkElementQuality::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  this->Notice.clear();
  this->Summary.clear();
  this->WorkingBytes = 0;
  tautline::QualityTotals totals(this->Selection->metrics());
  std::string problem;
  try
  {
    this->MeasureBlocks(vtkDataObject::GetData(inputVector[0]),
      vtkDataObject::GetData(inputVector[1]), output, totals);
  }
  catch (const std::bad_alloc&)
  {
    problem = "Not enough memory: choose fewer metrics or measure the mesh in parts.";
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }

  // Every process takes part in what follows, whatever befell its own blocks.
  totals.gather(this->Controller);
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    output->Initialize();
    return 0;
  }
  if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
  {
    totals.tabulate(vtkTable::GetData(outputVector, StatisticsPort), this->HistogramBins,
      vtkTable::GetData(outputVector, DistributionPort),
      vtkTable::GetData(outputVector, AnglesPort), vtkPolyData::GetData(outputVector, WorstPort));
    this->Summary = totals.summary();
  }
  if (!this->Notice.empty())
  {
    vtkWarningMacro(<< this->Notice);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkElementQuality::MeasureBlocks(vtkDataObject* input, vtkDataObject* reference,
  vtkDataObject* output, tautline::QualityTotals& totals)
{
  if (auto* mesh = vtkDataSet::SafeDownCast(input))
  {
    if (reference && !vtkDataSet::SafeDownCast(reference))
    {
      throw tautline::Error(
        "The mesh is a single data set but the reference has blocks: extract the "
        "block that is the reference (Extract Block).");
    }
    this->Measure(
      mesh, vtkDataSet::SafeDownCast(reference), vtkDataSet::SafeDownCast(output), totals);
    return;
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(input);
  auto* references = vtkCompositeDataSet::SafeDownCast(reference);
  if (reference && !references)
  {
    throw tautline::Error("The mesh has blocks but the reference has none: give a reference of the "
                          "same structure, or merge the blocks first (Merge Blocks).");
  }
  auto* results = vtkCompositeDataSet::SafeDownCast(output);
  results->CopyStructure(blocks);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    auto* block = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    if (!block)
    {
      continue;
    }
    auto result = vtkSmartPointer<vtkDataSet>::Take(block->NewInstance());
    results->SetDataSet(walk, result);
    this->Measure(block,
      references ? vtkDataSet::SafeDownCast(references->GetDataSet(walk)) : nullptr, result,
      totals);
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::Measure(
  vtkDataSet* input, vtkDataSet* reference, vtkDataSet* output, tautline::QualityTotals& totals)
{
  using namespace tautline;
  output->ShallowCopy(input);
  MeshAdapter adapter(input, this->Threads);
  Mesh& mesh = adapter.mesh();
  const Index cells = mesh.view().numberOfCells;
  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("Validity");
  validity->SetNumberOfValues(cells);
  this->SettleOrientation(adapter, validity->GetPointer(0), output);
  const std::vector<unsigned char> skip = cellsToSkip(adapter);
  const unsigned char* skipped = skip.empty() ? nullptr : skip.data();
  totals.addBlock(mesh, validity->GetPointer(0), skipped, this->Threads);

  const Targets targets = this->MakeTargets(input, reference, adapter);
  EvaluationOptions options;
  options.parameters = { this->Beta, this->Epsilon };
  options.combination = static_cast<tautline::Combination>(this->Combination);
  options.power = this->Power;
  options.targets = this->TargetType == IDEAL ? nullptr : &targets;
  options.threads = this->Threads;
  const auto& metrics = totals.metrics();
  for (std::size_t m = 0; m < metrics.size() && !this->GetAbortExecute(); ++m)
  {
    const MetricInfo& info = metricInfo(metrics[m]);
    vtkNew<vtkDoubleArray> values;
    values->SetName(info.name);
    values->SetNumberOfValues(cells);
    evaluateMetric(mesh, info.metric, options, values->GetPointer(0));
    output->GetCellData()->AddArray(values);
    totals.addValues(m, mesh,
      { cells, values->GetPointer(0), validity->GetPointer(0), mesh.view().cellTypes, skipped },
      input->GetCellData()->GetGlobalIds());
    this->UpdateProgress(static_cast<double>(m + 1) / static_cast<double>(metrics.size()));
  }
  output->GetCellData()->AddArray(validity);
  // Without active point scalars, views colour by the metric.
  output->GetPointData()->SetActiveScalars(nullptr);
  output->GetCellData()->SetActiveScalars(metricInfo(metrics.front()).name);
  this->WorkingBytes = std::max(this->WorkingBytes,
    static_cast<double>(adapter.copiedBytes() + skip.size() + totals.bytes() +
      targets.inverse.size() * sizeof(double) + targets.offsets.size() * sizeof(Index)));
}

//------------------------------------------------------------------------------
void vtkElementQuality::SettleOrientation(
  tautline::MeshAdapter& adapter, signed char* validity, vtkDataSet* output)
{
  tautline::Mesh& mesh = adapter.mesh();
  mesh.classifyCells(validity, this->Threads);
  const tautline::Orientation orientation = mesh.orientation(validity);
  std::string text = describe(orientation, mesh);
  if (orientation.state == tautline::Orientation::Reversed)
  {
    text += this->ReversedMesh == MEASURE_AS_GIVEN ? " Its elements count as inverted."
      : this->ReversedMesh == MEASURE_FLIPPED      ? " It is measured as if its cells were flipped."
                                                   : " Its cells are flipped in the output.";
    if (this->ReversedMesh != MEASURE_AS_GIVEN)
    {
      mesh.setMirrored(true);
      mesh.classifyCells(validity, this->Threads);
    }
    if (this->ReversedMesh == FLIP_OUTPUT)
    {
      tautline::flipCells(output);
    }
  }
  for (const std::string& sentence : { text, adapter.notice() })
  {
    this->Notice += (this->Notice.empty() || sentence.empty() ? "" : " ") + sentence;
  }
}

//------------------------------------------------------------------------------
tautline::Targets vtkElementQuality::MakeTargets(
  vtkDataSet* input, vtkDataSet* reference, const tautline::MeshAdapter& adapter)
{
  tautline::TargetChoice choice;
  choice.type = static_cast<tautline::TargetType>(this->TargetType);
  choice.reference = reference;
  choice.size.array = this->TargetType == SIZE
    ? this->GetInputArrayToProcess(0, input, choice.size.association)
    : nullptr;
  choice.tensor.array = this->TargetType == TENSOR
    ? this->GetInputArrayToProcess(1, input, choice.tensor.association)
    : nullptr;
  return tautline::makeTargets(adapter.mesh(), choice, this->Threads);
}

//------------------------------------------------------------------------------
void vtkElementQuality::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Metrics:";
  for (tautline::Metric metric : this->Selection->metrics())
  {
    os << " " << tautline::metricInfo(metric).name;
  }
  os << "\n" << indent << "Combination: " << this->Combination << "\n";
  os << indent << "Power: " << this->Power << "\n";
  os << indent << "TargetType: " << this->TargetType << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "Epsilon: " << this->Epsilon << "\n";
  os << indent << "ReversedMesh: " << this->ReversedMesh << "\n";
  os << indent << "HistogramBins: " << this->HistogramBins << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "Notice: " << this->Notice << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
  os << indent << "WorkingBytes: " << this->WorkingBytes << "\n";
}
