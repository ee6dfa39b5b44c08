// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFieldTransfer.h"

#include "Blocks.h"
#include "GatheredExecution.h"
#include "LackingArrays.h"
#include "PointMerge.h"
#include "ProgressStep.h"
#include "TableRows.h"
#include "TransferPieces.h"
#include "tautline/Adaptation/FieldTransfer.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

vtkStandardNewMacro(vtkFieldTransfer);

namespace
{
enum InputPorts
{
  TargetPort,
  SourcePort,
  NumberOfInputPorts
};
constexpr int NumberOfTransferOutputs = 2;
constexpr const char* TransferName = "Transfer"; // in the menu
constexpr int Associations[] = { vtkDataObject::POINT, vtkDataObject::CELL };
/// Warns if the target covers less than this fraction of the source and totals are kept.
constexpr double LeastCovered = 0.9;
constexpr std::size_t ArraysInSummary = 20;
constexpr double Percent = 100.0;

const char* nameOf(int association)
{
  return association == vtkDataObject::CELL ? "cell" : "point";
}

/// Whether an array is averaged: arrays of floating-point numbers are.
bool isAveraged(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
}

/// Ghost marks and ids, which are specific to a mesh.
bool belongsToMesh(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  return std::string(array->GetName()) == vtkDataSetAttributes::GhostArrayName() ||
    array == data->GetGlobalIds() || array == data->GetPedigreeIds();
}

/// "a, b and c"
std::string listed(const std::vector<std::string>& names)
{
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return text;
}

/// The values of an array, over all pieces.
std::vector<double> fieldValuesOf(
  const std::vector<tautline::TransferPiece>& pieces, int association, const std::string& name)
{
  std::vector<double> values;
  for (const tautline::TransferPiece& piece : pieces)
  {
    vtkDataArray* array = piece.data(association)->GetArray(name.c_str());
    const vtkIdType count = piece.count(association);
    for (vtkIdType i = 0; i < count; ++i)
    {
      tautline::pollInterruption(i);
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      {
        values.push_back(array->GetComponent(i, c));
      }
    }
  }
  return values;
}

/// Copies the name, the components and the component names of an array of the source.
void copyNames(vtkAbstractArray* from, vtkAbstractArray* to)
{
  to->SetName(from->GetName());
  to->SetNumberOfComponents(from->GetNumberOfComponents());
  for (int c = 0; from->HasAComponentName() && c < from->GetNumberOfComponents(); ++c)
  {
    if (from->GetComponentName(c))
    {
      to->SetComponentName(c, from->GetComponentName(c));
    }
  }
}

/// Makes an array active if it is in the source and the target has no active array of that kind.
void activate(vtkDataSetAttributes* from, vtkAbstractArray* given, vtkDataSetAttributes* to)
{
  for (const int kind :
    { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS, vtkDataSetAttributes::TENSORS })
  {
    if (from->GetAbstractAttribute(kind) == given && !to->GetAbstractAttribute(kind))
    {
      to->SetActiveAttribute(given->GetName(), kind);
    }
  }
}
}

//------------------------------------------------------------------------------
/// Both meshes.
struct vtkFieldTransfer::Meshes
{
  std::vector<tautline::TransferPiece> targets, sources;
  tautline::CoordinateFrame frame;
  double sizeUnit = 1.0; ///< of areas or volumes

  /// The place of an item of the source.
  std::pair<const tautline::TransferPiece*, vtkIdType> find(int association, vtkIdType number) const
  {
    const int kind = association == vtkDataObject::CELL ? 1 : 0;
    auto next = std::upper_bound(this->sources.begin(), this->sources.end(), number,
      [kind](vtkIdType value, const tautline::TransferPiece& piece)
      { return value < piece.first[kind]; });
    --next;
    return { &*next, number - next->first[kind] };
  }
};

//------------------------------------------------------------------------------
/// The arrays to transfer.
struct vtkFieldTransfer::Arrays
{
  struct Entry
  {
    int association;
    std::string name;
    bool averaged;
    std::size_t field; ///< its index in `fields`, if it is averaged
  };
  std::vector<Entry> entries;
  std::vector<tautline::TransferField> fields;
  std::vector<std::string> replaced, kept, lacking;
  tautline::TransferResult result;

  bool hasLabels(int association) const
  {
    return std::any_of(this->entries.begin(), this->entries.end(),
      [association](const Entry& each)
      { return !each.averaged && each.association == association; });
  }
};

//------------------------------------------------------------------------------
vtkFieldTransfer::vtkFieldTransfer()
{
  this->DeclarePorts(NumberOfInputPorts, NumberOfTransferOutputs);
}

//------------------------------------------------------------------------------
vtkFieldTransfer::~vtkFieldTransfer() = default;

//------------------------------------------------------------------------------
int vtkFieldTransfer::FillInputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillInputPortInformation(port, info);
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 0);
  return 1;
}

//------------------------------------------------------------------------------
bool vtkFieldTransfer::NeedsFinitePoints(int) const
{
  return true;
}

//------------------------------------------------------------------------------
int vtkFieldTransfer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(TransferName);
  return this->Attempt(outputVector, "transfer fewer arrays or parts of the mesh",
    [&] { this->Compute(inputVector, outputVector); });
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::Compute(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Meshes meshes;
  const auto take = [this](std::vector<tautline::TransferPiece>& pieces, vtkDataSet* given,
                      vtkDataSet* output, const std::string& name)
  {
    pieces.push_back({ given, output, name,
      std::make_unique<tautline::MeshAdapter>(given, this->Threads), { 0, 0 }, {} });
  };
  this->GetTotals()->Initialize();
  vtkIdType cells = 0;
  tautline::forEachBlock(vtkDataObject::GetData(inputVector[TargetPort]), nullptr, nullptr,
    vtkDataObject::GetData(outputVector),
    [&](const tautline::InputBlock& block)
    {
      block.output->ShallowCopy(block.input);
      cells += block.input->GetNumberOfCells();
      take(meshes.targets, block.input, block.output, block.name);
    });
  if (cells == 0) // reported by the superclass
  {
    return;
  }
  vtkDataObject* source = vtkDataObject::GetData(inputVector[SourcePort]);
  const auto places = tautline::blockPlaces(source);
  tautline::forEachLeaf(source,
    [&](unsigned int index, vtkDataSet* leaf)
    {
      if (leaf->GetNumberOfPoints() > 0)
      {
        const auto place = places.find(index);
        take(meshes.sources, leaf, nullptr, place == places.end() ? "" : place->second.name());
      }
    });
  std::vector<std::string> notes;
  for (tautline::TransferPiece& piece : meshes.targets)
  {
    tautline::requireSupported(piece, "target");
    if (this->MergeCoincidentPoints)
    {
      piece.copies = piece.adapter->joinCopies(piece.data(vtkDataObject::POINT)->GetGlobalIds());
      piece.adapter->mergeCoincidentPoints(this->Threads);
      notes.push_back(
        tautline::describeMerged(piece.adapter->coincident(), piece.adapter->given()));
      notes.push_back(tautline::describeJoined(piece.copies));
    }
  }
  for (const tautline::TransferPiece& piece : meshes.sources)
  {
    tautline::requireSupported(piece, "source");
  }
  notes.push_back(tautline::describeInverted(meshes.targets, "target"));
  notes.push_back(tautline::describeInverted(meshes.sources, "source"));
  meshes.frame = tautline::frameOf(meshes.targets);
  tautline::TransferMesh target = tautline::joinPieces(meshes.targets, meshes.frame);
  tautline::TransferMesh from = tautline::joinPieces(meshes.sources, meshes.frame);
  meshes.sizeUnit = std::pow(meshes.frame.unit(), target.dimension());

  Arrays arrays;
  this->ChooseArrays(meshes, arrays);
  tautline::TransferOptions options;
  options.method = static_cast<tautline::TransferMethod>(this->Method);
  options.cells = static_cast<tautline::CellReconstruction>(this->CellOrder);
  options.keepTotal = this->KeepTotal;
  options.cellLabels = arrays.hasLabels(vtkDataObject::CELL);
  options.pointLabels = arrays.hasLabels(vtkDataObject::POINT);
  options.frame = meshes.frame;
  options.threads = this->Threads;
  {
    constexpr double computed = 0.9; // the rest of the progress is output
    const tautline::ProgressStep progress(this, 0.0, computed);
    arrays.result =
      tautline::transferFields(std::move(target), std::move(from), arrays.fields, options);
  }
  for (const int association : Associations)
  {
    this->AddArrays(meshes, arrays, association);
  }
  this->Report(meshes, arrays);
  for (const std::string& note : notes)
  {
    this->AddToSummary(note);
  }
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkFieldTransfer::NamesOf(const Meshes& meshes, int association) const
{
  const bool all = this->PointArrays.empty() && this->CellArrays.empty();
  std::vector<std::string> names;
  vtkDataSetAttributes* first =
    meshes.sources.empty() ? nullptr : meshes.sources[0].data(association);
  for (int i = 0; all && first && i < first->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = first->GetAbstractArray(i);
    if (array->GetName() && *array->GetName() && !belongsToMesh(first, array))
    {
      names.emplace_back(array->GetName());
    }
  }
  for (const std::string& name :
    association == vtkDataObject::CELL ? this->CellArrays : this->PointArrays)
  {
    // ParaView selects all arrays by default, including ghost marks, which a gathered mesh lacks.
    vtkAbstractArray* array = first ? first->GetAbstractArray(name.c_str()) : nullptr;
    if (name != vtkDataSetAttributes::GhostArrayName() && !(array && belongsToMesh(first, array)))
    {
      names.push_back(name);
    }
  }
  return names;
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::ChooseArrays(const Meshes& meshes, Arrays& arrays)
{
  const bool all = this->PointArrays.empty() && this->CellArrays.empty();
  std::string problems;
  for (const int association : Associations)
  {
    for (const std::string& name : this->NamesOf(meshes, association))
    {
      const std::string title = std::string(nameOf(association)) + " array " + name;
      vtkAbstractArray* array = meshes.sources.empty()
        ? nullptr
        : meshes.sources[0].data(association)->GetAbstractArray(name.c_str());
      const bool everywhere = array &&
        std::all_of(meshes.sources.begin(), meshes.sources.end(),
          [&](const tautline::TransferPiece& piece)
          {
            vtkAbstractArray* other = piece.data(association)->GetAbstractArray(name.c_str());
            return other && other->GetDataType() == array->GetDataType() &&
              other->GetNumberOfComponents() == array->GetNumberOfComponents();
          });
      if (!everywhere && !all)
      {
        const std::string lacking = meshes.sources.empty()
          ? ""
          : tautline::lackingPiece(
              meshes.sources[0].given, name, association == vtkDataObject::CELL);
        throw tautline::Error("The source has no " + title +
          (array ? " in all of its blocks: choose another one."
                 : lacking + ": choose one that it has."));
      }
      const bool inTarget = std::any_of(meshes.targets.begin(), meshes.targets.end(),
        [&](const tautline::TransferPiece& piece)
        { return piece.data(association)->HasArray(name.c_str()) != 0; });
      if (!everywhere || (inTarget && !this->ReplaceArrays))
      {
        (everywhere ? arrays.kept : arrays.lacking).push_back(title);
        continue;
      }
      Arrays::Entry entry = { association, name, isAveraged(array), arrays.fields.size() };
      if (entry.averaged)
      {
        tautline::TransferField field;
        field.ofCells = association == vtkDataObject::CELL;
        field.components = array->GetNumberOfComponents();
        field.values = fieldValuesOf(meshes.sources, association, name);
        const auto odd = std::count_if(field.values.begin(), field.values.end(),
          [](double value) { return !std::isfinite(value); });
        if (odd > 0)
        {
          problems += (problems.empty() ? "" : " ") + std::to_string(odd) + " values of the " +
            title + " of the source are not finite: replace them first (Calculator).";
          continue;
        }
        arrays.fields.push_back(std::move(field));
      }
      if (inTarget)
      {
        arrays.replaced.push_back(title);
      }
      arrays.entries.push_back(entry);
    }
  }
  if (arrays.entries.empty() && !problems.empty())
  {
    throw tautline::Error(problems);
  }
  this->Warn(problems.empty() ? "" : "Left out: " + problems);
  const bool some = std::any_of(meshes.sources.begin(), meshes.sources.end(),
    [](const tautline::TransferPiece& piece)
    {
      return piece.data(vtkDataObject::POINT)->GetNumberOfArrays() +
        piece.data(vtkDataObject::CELL)->GetNumberOfArrays() >
        0;
    });
  this->Warn(some ? "" : "The source has no arrays to transfer. Choose another source.");
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::AddArrays(const Meshes& meshes, const Arrays& arrays, int association)
{
  const bool ofCells = association == vtkDataObject::CELL;
  const std::vector<tautline::Index>& origins =
    ofCells ? arrays.result.cells : arrays.result.points;
  for (const Arrays::Entry& entry : arrays.entries)
  {
    if (entry.association != association)
    {
      continue;
    }
    vtkDataSetAttributes* from = meshes.sources[0].data(association);
    vtkAbstractArray* given = from->GetAbstractArray(entry.name.c_str());
    const int components = given->GetNumberOfComponents();
    for (const tautline::TransferPiece& piece : meshes.targets)
    {
      const vtkIdType count = piece.count(association), first = piece.first[ofCells ? 1 : 0];
      const std::vector<tautline::Index>& representative =
        piece.adapter->coincident().representative;
      const auto numberOf = [&](vtkIdType i)
      { return first + (ofCells || representative.empty() ? i : representative[i]); };
      vtkSmartPointer<vtkAbstractArray> made;
      if (entry.averaged)
      {
        const std::vector<double>& values = arrays.result.fields[entry.field].values;
        auto array = vtkSmartPointer<vtkDoubleArray>::New();
        copyNames(given, array);
        array->SetNumberOfTuples(count);
        for (vtkIdType i = 0; i < count; ++i)
        {
          tautline::pollInterruption(i);
          array->SetTypedTuple(i, values.data() + components * numberOf(i));
        }
        made = array;
      }
      else
      {
        made = vtkSmartPointer<vtkAbstractArray>::Take(given->NewInstance());
        copyNames(given, made);
        made->SetNumberOfTuples(count);
        for (vtkIdType i = 0; i < count; ++i)
        {
          tautline::pollInterruption(i);
          const auto [origin, id] = meshes.find(association, origins[numberOf(i)]);
          made->SetTuple(i, id, origin->data(association)->GetAbstractArray(entry.name.c_str()));
        }
      }
      vtkDataSetAttributes* to = piece.output->GetAttributes(association);
      to->AddArray(made);
      activate(from, given, to);
    }
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::Report(const Meshes& meshes, const Arrays& arrays)
{
  tautline::TableRows rows;
  std::ostringstream lines;
  std::size_t counts[2] = { 0, 0 }, written = 0;
  for (const Arrays::Entry& entry : arrays.entries)
  {
    ++counts[entry.association == vtkDataObject::CELL ? 1 : 0];
    if (!entry.averaged)
    {
      continue;
    }
    const auto& totals = arrays.result.fields[entry.field].totals;
    for (std::size_t c = 0; c < totals.size(); ++c)
    {
      const tautline::TransferTotal& total = totals[c];
      const double before = total.before * meshes.sizeUnit, after = total.after * meshes.sizeUnit;
      if (!std::isfinite(before) || !std::isfinite(after))
      {
        throw tautline::Error("The total of the " + std::string(nameOf(entry.association)) +
          " array " + entry.name +
          " is beyond the range of double precision: scale it with Calculator.");
      }
      rows.begin();
      rows.addText("Array", entry.name);
      rows.addText("Data", nameOf(entry.association));
      rows.add("Component", static_cast<double>(c));
      rows.add("TotalBefore", before);
      rows.add("TotalAfter", after);
      rows.add("MinimumBefore", total.minimumBefore);
      rows.add("MaximumBefore", total.maximumBefore);
      rows.add("MinimumAfter", total.minimumAfter);
      rows.add("MaximumAfter", total.maximumAfter);
      rows.add("BeyondBounds", total.excess);
      const double largest = std::max(std::abs(total.minimumBefore), std::abs(total.maximumBefore));
      const double error =
        total.magnitude > 0.0 ? std::abs(total.after - total.before) / total.magnitude : 0.0;
      this->TotalError = std::max(this->TotalError, error);
      this->LargestExcess =
        std::max(this->LargestExcess, total.excess > 0.0 ? total.excess / largest : 0.0);
      if (written++ < ArraysInSummary)
      {
        lines << "\n"
              << entry.name << (totals.size() > 1 ? " [" + std::to_string(c) + "]" : "")
              << ": total " << before << " before, " << after << " after; " << total.minimumBefore
              << " to " << total.maximumBefore << " before, " << total.minimumAfter << " to "
              << total.maximumAfter << " after.";
      }
    }
  }
  rows.fill(this->GetTotals());
  std::ostringstream text;
  text << "Transferred " << counts[0] << " point arrays and " << counts[1] << " cell arrays.";
  if (written > 0)
  {
    text << " The totals differ by at most " << this->TotalError
         << ", relative to the integral of the absolute value.";
  }
  text << lines.str();
  if (written > ArraysInSummary)
  {
    text << "\nThe table Totals has " << written - ArraysInSummary << " more.";
  }
  this->AddToSummary(text.str());
  this->DescribeCoverage(arrays);
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::DescribeCoverage(const Arrays& arrays)
{
  const tautline::TransferResult& result = arrays.result;
  if (this->Method == CONSERVATIVE)
  {
    this->SourceCovered = std::min(1.0, result.sourceCovered / result.sourceSize);
    this->TargetCovered = std::min(1.0, result.targetCovered / result.targetSize);
    std::ostringstream text;
    text << "The target covers " << Percent * this->SourceCovered << " % of the source, the source "
         << Percent * this->TargetCovered << " % of the target.";
    if (this->LargestExcess > 0.0)
    {
      text << " To keep the totals, values where only one of the meshes has elements were changed "
              "by up to "
           << this->LargestExcess
           << " of the largest absolute value beyond their bounds; switch Keep Total off to stay "
              "within them.";
    }
    this->AddToSummary(text.str());
    std::ostringstream warning;
    if (this->KeepTotal && !arrays.fields.empty() && this->SourceCovered < LeastCovered)
    {
      warning << "The target covers only " << Percent * this->SourceCovered << " % of the source: "
              << (result.totalsKept ? "the totals of the whole source are kept. Switch Keep Total "
                                      "off to leave out the part outside."
                                    : "the totals are not kept.");
    }
    else if (this->KeepTotal && !arrays.fields.empty() && !result.totalsKept)
    {
      warning << "The source covers only " << Percent * this->TargetCovered
              << " % of the target: the totals are not kept.";
    }
    this->Warn(warning.str());
  }
  if (result.nearestCells > 0 || result.nearestPoints > 0)
  {
    this->AddToSummary(std::to_string(result.nearestCells) + " elements and " +
      std::to_string(result.nearestPoints) +
      " points of the target that the source does not overlap have the nearest value.");
  }
  if (!arrays.replaced.empty())
  {
    this->AddToSummary("Replaced in the target: " + listed(arrays.replaced) + ".");
  }
  if (!arrays.kept.empty())
  {
    this->AddToSummary(
      "Not transferred, because the target already has them: " + listed(arrays.kept) + ".");
  }
  if (!arrays.lacking.empty())
  {
    this->AddToSummary("Not transferred, because only some blocks of the source have them: " +
      listed(arrays.lacking) + ".");
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::AddPointArray(const char* name)
{
  if (name && *name)
  {
    this->PointArrays.emplace_back(name);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::ClearPointArrays()
{
  if (!this->PointArrays.empty())
  {
    this->PointArrays.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::AddCellArray(const char* name)
{
  if (name && *name)
  {
    this->CellArrays.emplace_back(name);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::ClearCellArrays()
{
  if (!this->CellArrays.empty())
  {
    this->CellArrays.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::ClearResult()
{
  this->Superclass::ClearResult();
  this->TotalError = this->LargestExcess = this->SourceCovered = this->TargetCovered = 0.0;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkFieldTransfer::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->TotalError, this->LargestExcess, this->SourceCovered, this->TargetCovered);
}

//------------------------------------------------------------------------------
void vtkFieldTransfer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "CellOrder: " << this->CellOrder << "\n";
  os << indent << "KeepTotal: " << this->KeepTotal << "\n";
  os << indent << "PointArrays: " << listed(this->PointArrays) << "\n";
  os << indent << "CellArrays: " << listed(this->CellArrays) << "\n";
  os << indent << "ReplaceArrays: " << this->ReplaceArrays << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
}
