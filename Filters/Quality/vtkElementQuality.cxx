// SPDX-License-Identifier: BSD-3-Clause
#include "vtkElementQuality.h"

#include "BadElements.h"
#include "Blocks.h"
#include "ColorMaps.h"
#include "CriteriaGrader.h"
#include "CurvedFacts.h"
#include "FaceQuality.h"
#include "FaceTotals.h"
#include "GatheredExecution.h"
#include "MeshAdapter.h"
#include "MeshGroups.h"
#include "MetricSelection.h"
#include "PieceFaces.h"
#include "PieceFindings.h"
#include "PieceOrientations.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "ProgressStep.h"
#include "QualityTotals.h"
#include "TargetChoice.h"
#include "tautline/Core/Memory.h"
#include "tautline/Quality/CurvedQuality.h"
#include "tautline/Quality/ElementChecks.h"

#include "vtkCellData.h"
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
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
  HistogramPort,
  CriteriaPort,
  BadPort,
  FacesPort,
  MeshChecksPort,
  NumberOfPorts
};

vtkSmartPointer<vtkDoubleArray> tripleArray(const char* name, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// The cell arrays with the positions of the smallest Jacobian determinant in curved cells.
void addPlaces(const tautline::CurvedQuality& curved, const signed char* validity,
  const unsigned char* skip, tautline::QualityTotals& totals, vtkDataSet* output)
{
  const auto places = tripleArray("MinimumCoordinates", output->GetNumberOfCells());
  const auto points = tripleArray("MinimumPoint", output->GetNumberOfCells());
  curved.places(places->GetPointer(0), points->GetPointer(0));
  output->GetCellData()->AddArray(places);
  output->GetCellData()->AddArray(points);
  totals.addCurved(curved.missed(validity, skip), points->GetPointer(0));
}
}

//------------------------------------------------------------------------------
vtkElementQuality::vtkElementQuality()
{
  this->DeclarePorts(2, NumberOfPorts);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

//------------------------------------------------------------------------------
vtkElementQuality::~vtkElementQuality()
{
  this->SetController(nullptr);
}

//------------------------------------------------------------------------------
vtkMultiProcessController* vtkElementQuality::GetController()
{
  return this->Controller;
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetStatistics()
{
  return this->GetOutputTable(StatisticsPort);
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetDistribution()
{
  return this->GetOutputTable(DistributionPort);
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetAngles()
{
  return this->GetOutputTable(AnglesPort);
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetHistogram()
{
  return this->GetOutputTable(HistogramPort);
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetCriteriaTable()
{
  return this->GetOutputTable(CriteriaPort);
}

//------------------------------------------------------------------------------
void vtkElementQuality::SetCriteria(const char* criteria)
{
  const std::string text = criteria ? criteria : "";
  if (text != this->Criteria)
  {
    this->Criteria = text;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::SetChecks(const char* checks)
{
  const std::string text = checks ? checks : "";
  if (text != this->Checks)
  {
    this->Checks = text;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkElementQuality::GetNumberOfKnownChecks()
{
  return static_cast<int>(tautline::elementChecks().size());
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetKnownCheck(int i)
{
  if (i < 0 || i >= GetNumberOfKnownChecks())
  {
    return std::string();
  }
  const tautline::ElementCheckInfo& info = tautline::elementChecks()[i];
  return std::string(info.name) + "\t" + info.label + "\t" + info.formula + "\t" + info.source +
    "\t" + info.note;
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetCriteriaPresets()
{
  std::string names;
  for (const std::string& name : tautline::criteriaPresets())
  {
    names += (names.empty() ? "" : "\t") + name;
  }
  return names;
}

//------------------------------------------------------------------------------
std::string vtkElementQuality::GetCriteriaPreset(const char* name)
{
  const auto& known = tautline::criteriaPresets();
  const std::string wanted = name ? name : "";
  return std::find(known.begin(), known.end(), wanted) != known.end()
    ? tautline::presetCriteria(wanted)
    : std::string();
}

//------------------------------------------------------------------------------
vtkPolyData* vtkElementQuality::GetWorst()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(WorstPort));
}

//------------------------------------------------------------------------------
vtkUnstructuredGrid* vtkElementQuality::GetBad()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(BadPort));
}

//------------------------------------------------------------------------------
vtkPolyData* vtkElementQuality::GetFaces()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(FacesPort));
}

//------------------------------------------------------------------------------
vtkTable* vtkElementQuality::GetMeshChecks()
{
  return this->GetOutputTable(MeshChecksPort);
}

//------------------------------------------------------------------------------
int vtkElementQuality::GetNumberOfKnownMetrics()
{
  return static_cast<int>(tautline::metricRegistry().size());
}

//------------------------------------------------------------------------------
int vtkElementQuality::GetNumberOfBuiltInMetrics()
{
  return tautline::numberOfBuiltInMetrics();
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
int vtkElementQuality::FillOutputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillOutputPortInformation(port, info);
  if (port == WorstPort || port == FacesPort)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  }
  if (port == BadPort)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkUnstructuredGrid");
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkElementQuality::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  return this->Attempt(outputVector, "choose fewer metrics or measure the mesh in parts",
    [&] { this->MeasureAll(inputVector, outputVector); });
}

//------------------------------------------------------------------------------
/// A failure on some processes, where a block or a file of criteria may be wrong, is a failure on
/// all.
void vtkElementQuality::Together(const char* memoryRemedy, const std::function<void()>& work)
{
  const std::string own = FailureOf(memoryRemedy, work);
  const std::string failure = this->Controller ? tautline::firstProblem(own) : own;
  if (!failure.empty())
  {
    throw tautline::Error(failure);
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::MeasureAll(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  tautline::CriteriaGrader grader;
  std::vector<int> checks;
  this->Together("use fewer criteria",
    [&]
    {
      grader = tautline::CriteriaGrader(this->Criteria);
      checks = grader.withChecks(tautline::parseElementChecks(this->Checks));
    });
  tautline::QualityTotals totals(grader.withMetrics(this->GetSelection().metrics()));
  totals.setChecks(checks);
  tautline::FaceTotals faces;
  tautline::PieceOrientations orientations;
  tautline::PieceFaces pieceFaces;
  const bool several = this->Controller && this->Controller->GetNumberOfProcesses() > 1;
  if (several || tautline::hasPartitions(input))
  {
    this->Together("divide the mesh",
      [&]
      {
        const bool all =
          !several || this->Controller == vtkMultiProcessController::GetGlobalController();
        // Without MPI, each process measures its piece as a separate mesh.
        if (const auto group = all ? tautline::tryProcessGroup() : nullptr)
        {
          group->together(
            [&]
            {
              orientations.find(input, this->Threads, *group, this->ReversedMesh,
                tautline::measuresElementsOnly(totals.metrics()));
              pieceFaces.find(orientations, *group, totals.metrics(), this->ConventionOf(grader),
                this->ReversedMesh != MEASURE_AS_GIVEN, this->Threads);
            });
        }
      });
    this->Notice = orientations.notice();
  }
  for (const std::vector<tautline::MeshCheck>& mesh : pieceFaces.checks())
  {
    faces.add(mesh);
  }
  tautline::BadElements bad;
  this->Together("choose fewer metrics or measure the mesh in parts",
    [&]
    {
      tautline::forEachBlock(input, vtkDataObject::GetData(inputVector[1]), nullptr,
        vtkDataObject::GetData(outputVector, MeshPort),
        [&](const tautline::InputBlock& block)
        { this->Measure(block, orientations, pieceFaces, totals, grader, bad, faces); });
    });
  totals.gather(this->Controller);
  grader.gather(this->Controller);
  faces.copyTo(vtkPolyData::GetData(outputVector, FacesPort));
  // Unlike the tables, this output exists on each process.
  bad.copyTo(vtkUnstructuredGrid::GetData(outputVector, BadPort));
  if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
  {
    totals.tabulate(vtkTable::GetData(outputVector, StatisticsPort), this->HistogramBins,
      vtkTable::GetData(outputVector, DistributionPort),
      vtkTable::GetData(outputVector, AnglesPort), vtkPolyData::GetData(outputVector, WorstPort),
      vtkTable::GetData(outputVector, HistogramPort));
    grader.tabulate(vtkTable::GetData(outputVector, CriteriaPort));
    faces.tabulate(vtkTable::GetData(outputVector, MeshChecksPort));
    this->Summary = grader.summary();
    this->AddToSummary(faces.summary());
    this->AddToSummary(totals.summary());
  }
  if (grader.active())
  {
    this->Verdict = tautline::gradeName(grader.totals().verdict());
    this->QualityIndex = grader.totals().meanIndex();
  }
  if (!faces.empty())
  {
    this->FailedChecks = faces.report().failed(false);
    this->FailedChecksOfAll = faces.report().failed(true);
  }
  this->Warn(this->Notice);
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkElementQuality::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.onAll = this->Controller != nullptr;
  return rules;
}

//------------------------------------------------------------------------------
void vtkElementQuality::ClearResult()
{
  this->Superclass::ClearResult();
  this->Notice.clear();
  this->Verdict.clear();
  this->WorkingBytes = this->QualityIndex = 0;
  this->FailedChecks = this->FailedChecksOfAll = -1;
}

//------------------------------------------------------------------------------
void vtkElementQuality::Measure(const tautline::InputBlock& block,
  const tautline::PieceOrientations& pieces, const tautline::PieceFaces& pieceFaces,
  tautline::QualityTotals& totals, tautline::CriteriaGrader& grader, tautline::BadElements& bad,
  tautline::FaceTotals& faceTotals)
{
  using namespace tautline;
  vtkDataSet *input = block.input, *output = block.output;
  output->ShallowCopy(input);
  // The checks are one step, each metric is one step, and the grades are the last step.
  const auto& metrics = totals.metrics();
  const int blocks = countBlocks(this->GetInputDataObject(0, 0));
  const auto stepAt = [&](std::size_t step)
  {
    const double done = static_cast<double>(step) / static_cast<double>(metrics.size() + 2);
    return (block.number + done) / blocks;
  };
  std::optional<ProgressStep> progress(std::in_place, this, stepAt(0), stepAt(1));
  MeshAdapter adapter(input, this->Threads);
  Mesh& mesh = adapter.mesh();
  const OrientedPiece* piece = pieces.piece(input);
  const WholeOrientation* whole = piece ? piece->whole : nullptr;
  mesh.setSpace(whole ? whole->space : mesh.space());
  const Index cells = mesh.view().numberOfCells;
  requireMemory(
    static_cast<double>(cells) * static_cast<double>(totals.metrics().size() * sizeof(double)),
    "the arrays of " + std::to_string(totals.metrics().size()) + " metrics",
    "choose fewer metrics or measure the mesh in parts");
  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("Validity");
  validity->SetNumberOfValues(cells);
  this->SettleOrientation(adapter, piece, validity->GetPointer(0), output);
  const auto curved = this->CertifyCurved(input, adapter, validity->GetPointer(0));
  const std::unique_ptr<FaceQuality> alone = whole
    ? nullptr
    : makeFaceQuality({ input, &adapter }, metrics, this->ConventionOf(grader), this->Threads);
  FaceQuality* faces = whole ? pieceFaces.piece(input) : alone.get();
  if (faces)
  {
    this->AddToNotice(faces->classify(validity->GetPointer(0)));
  }
  if (this->JacobianBounds)
  {
    this->AddBounds(input, adapter, output);
  }
  const std::vector<unsigned char> skip = cellsToSkip(adapter);
  const unsigned char* skipped = skip.empty() ? nullptr : skip.data();
  const Targets targets = this->MakeTargets(input, block.reference, adapter);
  EvaluationOptions options;
  options.parameters = { this->Beta, this->Epsilon };
  options.combination = static_cast<tautline::Combination>(this->Combination);
  options.power = this->Power;
  options.targets = this->TargetType == IDEAL ? nullptr : &targets;
  options.threads = this->Threads;
  if (!whole && cells > 0)
  {
    this->AddCurvedNotice(*curved, metrics, options);
    this->AddToNotice(
      findingsOf(adapter, nullptr, skipped, curved->cells(), measuresElementsOnly(metrics)).text);
  }
  totals.addBlock(mesh, validity->GetPointer(0), skipped, block.place, this->Threads);
  if (curved->cells() > 0)
  {
    addPlaces(*curved, validity->GetPointer(0), skipped, totals, output);
  }
  for (std::size_t m = 0; m < metrics.size() && !this->GetAbortExecute(); ++m)
  {
    const MetricInfo& info = metricInfo(metrics[m]);
    progress.emplace(this, stepAt(m + 1), stepAt(m + 2));
    vtkNew<vtkDoubleArray> values;
    values->SetName(info.name);
    values->SetNumberOfValues(cells);
    if (info.family == MetricFamily::Faces)
    {
      faces->measure(info.metric, values->GetPointer(0));
    }
    else
    {
      requireInRange(info, evaluateMetric(mesh, info.metric, options, values->GetPointer(0)));
      curved->measure(info.metric, options, validity->GetPointer(0), values->GetPointer(0));
    }
    output->GetCellData()->AddArray(values);
    totals.addValues(m, mesh,
      { cells, values->GetPointer(0), validity->GetPointer(0), mesh.view().cellTypes, skipped },
      input->GetCellData()->GetGlobalIds());
  }
  progress.emplace(this, stepAt(metrics.size() + 1), stepAt(metrics.size() + 2));
  this->CheckFaces(faces, alone != nullptr, faceTotals);
  this->MeasureChecks(input, adapter, validity->GetPointer(0), skipped, totals, output);
  // Ghosts get the grades of their originals but do not count.
  const std::vector<unsigned char> beside = facesBesideVolumes(mesh);
  grader.grade(
    mesh, validity->GetPointer(0), skipped, beside.empty() ? nullptr : beside.data(), output);
  output->GetCellData()->AddArray(validity);
  // Without active point scalars, views color by the metric.
  output->GetPointData()->SetActiveScalars(nullptr);
  output->GetCellData()->SetActiveScalars(metricInfo(metrics.front()).name);
  if (this->ExtractBad && mesh.dimension() == Dimension::Volume && !this->GetAbortExecute())
  {
    bad.add(output, validity->GetPointer(0), skipped, metrics);
  }
  this->WorkingBytes = std::max(this->WorkingBytes,
    static_cast<double>(adapter.copiedBytes() + skip.size() + totals.bytes() +
      targets.inverse.size() * sizeof(double) + targets.offsets.size() * sizeof(Index)));
}

//------------------------------------------------------------------------------
void vtkElementQuality::CheckFaces(
  tautline::FaceQuality* faces, bool alone, tautline::FaceTotals& totals)
{
  if (!faces || this->GetAbortExecute())
  {
    return;
  }
  if (alone)
  {
    totals.add(faces->check().checks);
  }
  if (this->FaceOutput != NO_FACES)
  {
    totals.add(faces->faces(this->FaceOutput == ALL_FACES));
  }
}

//------------------------------------------------------------------------------
tautline::FaceConvention vtkElementQuality::ConventionOf(
  const tautline::CriteriaGrader& grader) const
{
  const bool foundation = this->FaceConvention == FOUNDATION ||
    (this->FaceConvention == BY_CRITERIA && grader.convention() == "foundation");
  return foundation ? tautline::FaceConvention::Foundation : tautline::FaceConvention::Esi;
}

//------------------------------------------------------------------------------
void vtkElementQuality::SettleOrientation(tautline::MeshAdapter& adapter,
  const tautline::OrientedPiece* piece, signed char* validity, vtkDataSet* output)
{
  const tautline::RankOrder* known = piece ? &piece->whole->order : nullptr;
  adapter.mesh().classifyCells(validity, this->Threads);
  tautline::RankOrder own;
  if (!known)
  {
    own = adapter.findOrder(validity);
    this->AddToNotice(tautline::describeOrder(own, adapter.mesh().dimension(), this->ReversedMesh));
  }
  if (this->ReversedMesh != MEASURE_AS_GIVEN)
  {
    adapter.orient(validity, known ? *known : own, piece ? piece->number : 0);
  }
  if (this->ReversedMesh == FLIP_OUTPUT &&
    (adapter.mesh().mirrored() || !adapter.reversedCells().empty()))
  {
    tautline::flipCells(output, adapter.reversedCells());
  }
}

//------------------------------------------------------------------------------
std::unique_ptr<tautline::CurvedQuality> vtkElementQuality::CertifyCurved(
  vtkDataSet* input, const tautline::MeshAdapter& adapter, signed char* validity)
{
  const tautline::CurvedFacts facts(input, adapter);
  auto curved = std::make_unique<tautline::CurvedQuality>(adapter.mesh(), facts, this->Threads);
  curved->certify(validity);
  if (curved->turnedWedges() > 0)
  {
    this->AddToNotice(std::to_string(curved->turnedWedges()) +
      " curved wedges list their nodes in the opposite order, as in files of other versions of "
      "VTK, and are treated as their mirror images.");
  }
  return curved;
}

//------------------------------------------------------------------------------
void vtkElementQuality::MeasureChecks(vtkDataSet* input, const tautline::MeshAdapter& adapter,
  const signed char* validity, const unsigned char* skip, tautline::QualityTotals& totals,
  vtkDataSet* output)
{
  using namespace tautline;
  const tautline::CurvedFacts facts(input, adapter);
  const Index cells = adapter.mesh().view().numberOfCells;
  for (int check : totals.checks())
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName(elementChecks()[check].name);
    values->SetNumberOfValues(cells);
    evaluateElementCheck(adapter.mesh(), facts, check, values->GetPointer(0), this->Threads);
    output->GetCellData()->AddArray(values);
    totals.addCheck(check, validity, skip, values->GetPointer(0), cells);
  }
}

//------------------------------------------------------------------------------
void vtkElementQuality::AddCurvedNotice(const tautline::CurvedQuality& curved,
  const std::vector<tautline::Metric>& metrics, const tautline::EvaluationOptions& options)
{
  if (curved.cells() == 0)
  {
    return;
  }
  std::string wholly, atCorners;
  for (tautline::Metric metric : metrics)
  {
    std::string& list = curved.measures(metric, options) ? wholly : atCorners;
    if (metric != tautline::Metric::MinimumJacobian)
    {
      list += (list.empty() ? "" : ", ") + std::string(tautline::metricInfo(metric).name);
    }
  }
  this->AddToNotice("Validity and min_jacobian of " + std::to_string(curved.cells()) +
    " curved cells hold for the whole cell" + (wholly.empty() ? "" : ", and so do " + wholly) +
    (atCorners.empty() ? "" : "; measured at the corners: " + atCorners) + ".");
}

//------------------------------------------------------------------------------
void vtkElementQuality::AddBounds(
  vtkDataSet* input, const tautline::MeshAdapter& adapter, vtkDataSet* output)
{
  const tautline::Mesh& mesh = adapter.mesh();
  const tautline::CurvedFacts facts(input, adapter);
  vtkNew<vtkDoubleArray> bounds;
  bounds->SetName("JacobianBound");
  bounds->SetNumberOfValues(mesh.view().numberOfCells);
  tautline::boundJacobians(mesh, facts, bounds->GetPointer(0), this->Threads);
  output->GetCellData()->AddArray(bounds);
}

//------------------------------------------------------------------------------
void vtkElementQuality::AddToNotice(const std::string& sentences)
{
  // Pieces have the same remarks.
  if (this->Notice.find(sentences) == std::string::npos)
  {
    this->Notice += (this->Notice.empty() ? "" : " ") + sentences;
  }
}

//------------------------------------------------------------------------------
tautline::Targets vtkElementQuality::MakeTargets(
  vtkDataSet* input, vtkDataSet* reference, const tautline::MeshAdapter& adapter)
{
  if (input->GetNumberOfCells() == 0)
  {
    return {}; // an empty piece without arrays
  }
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
  os << indent << "Combination: " << this->Combination << "\n";
  os << indent << "Power: " << this->Power << "\n";
  os << indent << "TargetType: " << this->TargetType << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "Epsilon: " << this->Epsilon << "\n";
  os << indent << "ReversedMesh: " << this->ReversedMesh << "\n";
  os << indent << "JacobianBounds: " << this->JacobianBounds << "\n";
  os << indent << "ExtractBad: " << this->ExtractBad << "\n";
  os << indent << "HistogramBins: " << this->HistogramBins << "\n";
  os << indent << "Criteria: " << this->Criteria << "\n";
  os << indent << "FaceConvention: " << this->FaceConvention << "\n";
  os << indent << "FaceOutput: " << this->FaceOutput << "\n";
  os << indent << "FailedChecks: " << this->FailedChecks << "\n";
  os << indent << "FailedChecksOfAll: " << this->FailedChecksOfAll << "\n";
  os << indent << "Checks: " << this->Checks << "\n";
  os << indent << "Verdict: " << this->Verdict << "\n";
  os << indent << "QualityIndex: " << this->QualityIndex << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "Notice: " << this->Notice << "\n";
  os << indent << "WorkingBytes: " << this->WorkingBytes << "\n";
}
