// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapeRetrieval.h"

#include "GatheredExecution.h"
#include "ProcessGroup.h"
#include "RetrievalSheet.h"
#include "ShapeAdapter.h"
#include "tautline/Shapes/ShapeRetrieval.h"

#include "vtkAbstractArray.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <sstream>
#include <utility>

vtkStandardNewMacro(vtkShapeRetrieval);

namespace
{
constexpr int SheetPort = 4;

struct ShapeSet
{
  std::vector<std::string> names, labels;
  std::vector<tautline::Silhouette> shapes;
  std::vector<tautline::Thumbnail> pictures;
  std::vector<std::string> classes;     ///< in the order of their first shape
  std::vector<tautline::Index> numbers; ///< of the class of each shape
  std::vector<std::string> leftOut;     ///< "name: why"
};

/// Lists the shapes that are left out; "" if there are none.
std::string describeLeftOut(const ShapeSet& set)
{
  if (set.leftOut.empty())
  {
    return "";
  }
  std::string text = std::to_string(set.leftOut.size()) +
    (set.leftOut.size() == 1 ? " shape was" : " shapes were") + " left out:";
  for (const std::string& one : set.leftOut)
  {
    text += "\n" + one;
  }
  return text;
}

ShapeSet takeShapes(vtkMultiBlockDataSet* input, tautline::Foreground foreground,
  const tautline::RetrievalOptions& matching)
{
  ShapeSet set;
  vtkSmartPointer<vtkDataObjectTreeIterator> it;
  it.TakeReference(input->NewTreeIterator());
  it->VisitOnlyLeavesOn();
  for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
  {
    vtkDataObject* block = it->GetCurrentDataObject();
    std::string name = "shape " + std::to_string(set.names.size() + set.leftOut.size());
    if (it->HasCurrentMetaData() && it->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME()))
    {
      name = it->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME());
    }
    vtkImageData* picture = vtkImageData::SafeDownCast(block);
    if (!picture)
    {
      throw tautline::Error(name + " is not an image.");
    }
    vtkAbstractArray* label = picture->GetFieldData()->GetAbstractArray("Label");
    try
    {
      const tautline::GreyImage image(picture);
      tautline::SilhouetteOptions options;
      options.foreground = foreground;
      tautline::Silhouette shape = tautline::traceSilhouette(image.view(), options);
      const std::string problem = tautline::problemOf(shape, matching);
      if (!problem.empty())
      {
        throw tautline::Error(problem);
      }
      set.shapes.push_back(std::move(shape));
      set.pictures.push_back(tautline::RetrievalSheet::thumbnail(image.view()));
    }
    catch (const tautline::Error& error)
    {
      set.leftOut.push_back(name + ": " + error.what());
      continue;
    }
    set.labels.push_back(label && label->GetNumberOfTuples() > 0
        ? label->GetVariantValue(0).ToString()
        : name.substr(0, name.find_first_of("0123456789")));
    const auto found = std::find(set.classes.begin(), set.classes.end(), set.labels.back());
    set.numbers.push_back(found - set.classes.begin());
    if (found == set.classes.end())
    {
      set.classes.push_back(set.labels.back());
    }
    set.names.push_back(name);
  }
  if (set.shapes.size() < 2 && !set.leftOut.empty())
  {
    throw tautline::Error("At least 2 shapes are needed to compare. " + describeLeftOut(set));
  }
  return set;
}

template <class Array>
Array* addColumn(vtkTable* table, const char* name, vtkIdType rows)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfValues(rows);
  table->AddColumn(column);
  return column; // the table keeps it
}

void fillTables(const ShapeSet& set, const tautline::Retrieval& result, vtkTable* distances,
  vtkTable* ranking, vtkTable* statistics, vtkTable* confusion)
{
  const vtkIdType n = result.count;
  auto* names = addColumn<vtkStringArray>(distances, "Name", n);
  auto* labels = addColumn<vtkStringArray>(distances, "Label", n);
  for (vtkIdType s = 0; s < n; ++s)
  {
    names->SetValue(s, set.names[s]);
    labels->SetValue(s, set.labels[s]);
  }
  for (vtkIdType t = 0; t < n; ++t)
  {
    auto* column = addColumn<vtkDoubleArray>(distances, set.names[t].c_str(), n);
    for (vtkIdType s = 0; s < n; ++s)
    {
      column->SetValue(s, result.distances[s * n + t]);
    }
  }

  const tautline::Recognition& found = result.recognition;
  const vtkIdType best = static_cast<vtkIdType>(found.hitsAt.size());
  auto* query = addColumn<vtkStringArray>(ranking, "Query", n * best);
  auto* queryLabel = addColumn<vtkStringArray>(ranking, "QueryLabel", n * best);
  auto* rank = addColumn<vtkIntArray>(ranking, "Rank", n * best);
  auto* match = addColumn<vtkStringArray>(ranking, "Match", n * best);
  auto* matchLabel = addColumn<vtkStringArray>(ranking, "MatchLabel", n * best);
  auto* distance = addColumn<vtkDoubleArray>(ranking, "Distance", n * best);
  auto* correct = addColumn<vtkIntArray>(ranking, "Correct", n * best);
  for (vtkIdType s = 0; s < n; ++s)
  {
    for (vtkIdType k = 0; k < best; ++k)
    {
      const vtkIdType row = s * best + k;
      const tautline::Index t = result.ranking[s * (n - 1) + k];
      query->SetValue(row, set.names[s]);
      queryLabel->SetValue(row, set.labels[s]);
      rank->SetValue(row, static_cast<int>(k + 1));
      match->SetValue(row, set.names[t]);
      matchLabel->SetValue(row, set.labels[t]);
      distance->SetValue(row, result.distances[s * n + t]);
      correct->SetValue(row, set.numbers[s] == set.numbers[t]);
    }
  }

  auto* at = addColumn<vtkIntArray>(statistics, "Rank", best);
  auto* hits = addColumn<vtkIntArray>(statistics, "Correct", best);
  auto* rate = addColumn<vtkDoubleArray>(statistics, "Rate", best);
  for (vtkIdType k = 0; k < best; ++k)
  {
    at->SetValue(k, static_cast<int>(k + 1));
    hits->SetValue(k, static_cast<int>(found.hitsAt[k]));
    rate->SetValue(k, 100.0 * static_cast<double>(found.hitsAt[k]) / static_cast<double>(n));
  }
  vtkNew<vtkDoubleArray> total;
  total->SetName("RecognitionRate");
  total->InsertNextValue(100.0 * found.rate);
  statistics->GetFieldData()->AddArray(total);

  auto* ofClass =
    addColumn<vtkStringArray>(confusion, "Label", static_cast<vtkIdType>(set.classes.size()));
  for (std::size_t c = 0; c < set.classes.size(); ++c)
  {
    ofClass->SetValue(static_cast<vtkIdType>(c), set.classes[c]);
  }
  for (std::size_t c = 0; c < set.classes.size(); ++c)
  {
    auto* column = addColumn<vtkDoubleArray>(
      confusion, set.classes[c].c_str(), static_cast<vtkIdType>(set.classes.size()));
    for (std::size_t row = 0; row < set.classes.size(); ++row)
    {
      column->SetValue(
        static_cast<vtkIdType>(row), 100.0 * found.confusion[row * set.classes.size() + c]);
    }
  }
}

void drawSheet(
  const ShapeSet& set, const tautline::Retrieval& result, int size, vtkImageData* sheet)
{
  using Sheet = tautline::RetrievalSheet;
  const auto best = static_cast<tautline::Index>(result.recognition.hitsAt.size());
  std::vector<std::vector<Sheet::Match>> matches(result.count);
  for (tautline::Index s = 0; s < result.count; ++s)
  {
    for (tautline::Index k = 0; k < std::min<tautline::Index>(best, Sheet::Shown); ++k)
    {
      const tautline::Index t = result.ranking[s * (result.count - 1) + k];
      matches[s].push_back({ t, set.numbers[s] == set.numbers[t] });
    }
  }
  Sheet::draw(set.pictures, matches, size, sheet);
}
}

//------------------------------------------------------------------------------
vtkShapeRetrieval::vtkShapeRetrieval()
{
  this->SetNumberOfOutputPorts(SheetPort + 1);
}

//------------------------------------------------------------------------------
vtkShapeRetrieval::~vtkShapeRetrieval() = default;

//------------------------------------------------------------------------------
int vtkShapeRetrieval::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  // Accepts other types as well, so that the message can give the remedy.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeRetrieval::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == SheetPort ? "vtkImageData" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeRetrieval::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  const int extent[6] = { 0, this->SheetSize - 1, 0, this->SheetSize - 1, 0, 0 };
  vtkInformation* info = outputVector->GetInformationObject(SheetPort);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_UNSIGNED_CHAR, 3);
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeRetrieval::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkMultiBlockDataSet* input = vtkMultiBlockDataSet::GetData(inputVector[0]);
  this->ClearResult();
  tautline::Assistants assistants(std::move(this->Group));
  if (!input)
  {
    return this->Fail(outputVector,
      "Shapes are compared with each other: a multiblock data set of images is needed. Read a "
      "folder of images, or run Group Datasets.");
  }
  if (input->GetNumberOfBlocks() == 0)
  {
    return 1;
  }
  return this->Attempt(outputVector, "choose fewer shapes, or a larger spacing",
    [&]
    {
      const tautline::RetrievalOptions options = this->GetOptionsOfRun();
      const ShapeSet set =
        takeShapes(input, static_cast<tautline::Foreground>(this->Foreground), options);
      this->Warn(describeLeftOut(set));
      this->Matching = true;
      tautline::RankGroup& group = assistants.call();
      if (group.size() > 1)
      {
        tautline::shapesOfFirst(group, set.shapes);
      }
      const tautline::Retrieval result =
        tautline::retrieveShapes(group, set.shapes, set.numbers, options);
      fillTables(set, result, vtkTable::GetData(outputVector, 0),
        vtkTable::GetData(outputVector, 1), vtkTable::GetData(outputVector, 2),
        vtkTable::GetData(outputVector, 3));
      drawSheet(set, result, this->SheetSize, vtkImageData::GetData(outputVector, SheetPort));
      this->RecognitionRate = 100.0 * result.recognition.rate;
      std::ostringstream text;
      text << result.count << " shapes of " << set.classes.size()
           << " classes: " << result.recognition.hits << " of " << result.recognition.possible
           << " best matches are of the query's class, " << this->RecognitionRate << " %"
           << (this->Neighbors > 0 ? " after diffusion." : ".");
      if (result.matches < result.count * (result.count - 1))
      {
        text << " " << result.matches << " of " << result.count * (result.count - 1)
             << " pairs were matched.";
      }
      if (result.stop != tautline::MatchStop::Complete)
      {
        text << " Stopped early: distances of -1 were not computed.";
      }
      const std::string leftOut = describeLeftOut(set);
      this->Summary = text.str() + (leftOut.empty() ? "" : "\n") + leftOut;
    });
}

//------------------------------------------------------------------------------
tautline::RetrievalOptions vtkShapeRetrieval::GetOptionsOfRun()
{
  tautline::RetrievalOptions options;
  this->GetOptions(options.locations, options.match);
  options.spacing = this->Spacing;
  options.symmetric = this->Symmetric;
  if (this->Setting != CUSTOM)
  {
    const auto progress = options.match.progress;
    options = this->Setting == FELZENSZWALB ? tautline::RetrievalOptions::felzenszwalb()
      : this->Setting == DISSERTATION       ? tautline::RetrievalOptions::dissertation()
                                            : tautline::RetrievalOptions::highest();
    options.match.progress = progress;
    options.match.threads = this->Threads;
    options.match.timeLimit = this->GetRemainingSeconds();
  }
  options.best = this->BestMatches;
  options.shortlist = this->Shortlist;
  options.neighbours = this->Neighbors;
  return options;
}

//------------------------------------------------------------------------------
bool vtkShapeRetrieval::TakesPieces(vtkInformationVector**)
{
  this->Group = tautline::tryProcessGroup();
  return false;
}

//------------------------------------------------------------------------------
void vtkShapeRetrieval::Assist()
{
  const std::unique_ptr<tautline::RankGroup> several = std::move(this->Group);
  if (!several || !tautline::Assistants::areCalled(*several))
  {
    return;
  }
  tautline::RetrievalOptions options = this->GetOptionsOfRun();
  const std::vector<tautline::Silhouette> shapes = tautline::shapesOfFirst(*several, {});
  options.match.progress = nullptr; // the first process reports
  this->Matching = true;            // the limit of the run ends it, on all processes
  const std::vector<tautline::Index> labels(shapes.size(), 0); // evaluated there only
  tautline::retrieveShapes(*several, shapes, labels, options);
}

//------------------------------------------------------------------------------
void vtkShapeRetrieval::ClearResult()
{
  this->Superclass::ClearResult();
  this->RecognitionRate = 0.0;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkShapeRetrieval::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::OnFirst;
  rules.assist = [this] { this->Assist(); };
  return rules;
}

//------------------------------------------------------------------------------
void vtkShapeRetrieval::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->RecognitionRate);
}

//------------------------------------------------------------------------------
void vtkShapeRetrieval::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Setting: " << this->Setting << "\n";
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "Symmetric: " << this->Symmetric << "\n";
  os << indent << "Shortlist: " << this->Shortlist << "\n";
  os << indent << "Neighbors: " << this->Neighbors << "\n";
  os << indent << "BestMatches: " << this->BestMatches << "\n";
  os << indent << "SheetSize: " << this->SheetSize << "\n";
}
