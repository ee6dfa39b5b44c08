#include "MovableMesh.h"

#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Patches/SimplexMesh.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkExtractSelection.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkSelection.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
vtkDataSet* withPoints(vtkDataSet* input)
{
  if (!vtkPointSet::SafeDownCast(input))
  {
    throw Error(std::string("The points of ") + input->GetClassName() +
      " are implicit and cannot move: run Image Data to Point Set or Rectilinear Data to Point Set "
      "first, which give them coordinates.");
  }
  return input;
}
}

//------------------------------------------------------------------------------
MovableMesh::MovableMesh(vtkDataSet* input, int threads)
  : Input(vtkPointSet::SafeDownCast(withPoints(input)))
  , Adapter(input, threads)
  , Threads(threads)
{
  Mesh& mesh = this->Adapter.mesh();
  if (mesh.dimension() == Dimension::None)
  {
    throw Error("There is no element whose points could move. " + this->Adapter.notice());
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error("The mesh has " + std::to_string(mesh.higherOrderCells()) +
      " cells of quadratic or higher order, whose midpoints would stay behind: run Tessellate "
      "first.");
  }
  this->Validity.resize(mesh.view().numberOfCells);
  mesh.classifyCells(this->Validity.data(), threads);
  const Orientation orientation = mesh.orientation(this->Validity.data());
  if (orientation.state == Orientation::Mixed)
  {
    throw Error(describe(orientation, mesh));
  }
  if (orientation.state == Orientation::Reversed)
  {
    this->Notice = describe(orientation, mesh) + " It is treated as if its cells were flipped.";
    mesh.setMirrored(true);
    mesh.classifyCells(this->Validity.data(), threads);
  }
  const std::string more = this->Adapter.notice();
  this->Notice += (this->Notice.empty() || more.empty() ? "" : " ") + more;
  this->Skip = cellsToSkip(this->Adapter);
  this->Fixed.assign(mesh.view().numberOfPoints, 0);
  this->fixWhatStays();
}

//------------------------------------------------------------------------------
const unsigned char* MovableMesh::skipped() const
{
  return this->Skip.empty() ? nullptr : this->Skip.data();
}

//------------------------------------------------------------------------------
void MovableMesh::fixWhatStays()
{
  const Mesh& mesh = this->mesh();
  const MeshView& view = mesh.view();
  std::vector<char> onBoundary;
  if (mesh.dimension() == Dimension::Volume && !this->Skip.empty())
  {
    onBoundary = boundaryPoints(mesh);
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool ghost = this->Adapter.ghostCells() && this->Adapter.ghostCells()[cell];
    const bool measured = this->Validity[cell] != NotMeasured;
    if (measured && (this->Skip.empty() || !this->Skip[cell]))
    {
      continue;
    }
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      // The triangles on the boundary of a solid do not keep its points from sliding.
      const Index point = view.connectivity[n];
      if (ghost || onBoundary.empty() || !onBoundary[point])
      {
        this->Fixed[point] = 1;
      }
    }
  }
}

//------------------------------------------------------------------------------
void MovableMesh::fix(vtkDataArray* array, bool ofCells)
{
  const MeshView& view = this->mesh().view();
  for (Index cell = 0; array && ofCells && cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      this->Fixed[view.connectivity[n]] |= array->GetComponent(cell, 0) != 0;
    }
  }
  for (Index i = 0; array && !ofCells && i < view.numberOfPoints; ++i)
  {
    this->Fixed[i] |= array->GetComponent(i, 0) != 0;
  }
}

//------------------------------------------------------------------------------
void MovableMesh::fixBoundary()
{
  const std::vector<char> boundary = boundaryPoints(this->mesh());
  std::transform(this->Fixed.begin(), this->Fixed.end(), boundary.begin(), this->Fixed.begin(),
    [](unsigned char fixed, char on) { return fixed || on; });
}

//------------------------------------------------------------------------------
void MovableMesh::fixCorners(const BoundaryShape& shape)
{
  std::transform(this->Fixed.begin(), this->Fixed.end(), shape.fixed.begin(), this->Fixed.begin(),
    [](unsigned char fixed, unsigned char corner) { return fixed || corner; });
}

//------------------------------------------------------------------------------
std::string MovableMesh::move(vtkPointSet* output, const std::vector<double>& points) const
{
  const Mesh& mesh = this->mesh();
  vtkPoints* like = this->Input->GetPoints();
  std::string note;
  if (like->GetDataType() == VTK_FLOAT)
  {
    std::vector<double> rounded(points.size());
    std::transform(points.begin(), points.end(), rounded.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
    const auto before = this->validityAt(points), after = this->validityAt(rounded);
    const auto lost = std::inner_product(before.begin(), before.end(), after.begin(), Index(0),
      std::plus<>(), [](signed char a, signed char b) { return Index(a == Valid && b != Valid); });
    if (lost > 0)
    {
      like = nullptr;
      note = "The points are given in double precision: in single precision " +
        std::to_string(lost) + " valid elements would not be valid.";
    }
  }
  output->SetPoints(makePoints(points, like));
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("Displacement");
  displacement->SetNumberOfComponents(3);
  displacement->SetNumberOfTuples(mesh.view().numberOfPoints);
  std::transform(points.begin(), points.end(), mesh.view().points, displacement->GetPointer(0),
    [](double now, double then) { return std::isfinite(now - then) ? now - then : 0.0; });
  output->GetPointData()->AddArray(displacement);
  return note;
}

//------------------------------------------------------------------------------
std::vector<signed char> MovableMesh::validityAt(const std::vector<double>& points) const
{
  MeshView view = this->mesh().view();
  view.points = points.data();
  Mesh moved(view, this->Threads);
  moved.setMirrored(this->mesh().mirrored());
  std::vector<signed char> validity(view.numberOfCells);
  moved.classifyCells(validity.data(), this->Threads);
  return validity;
}

//------------------------------------------------------------------------------
void forEachBlock(vtkDataObject* input, vtkDataObject* reference, vtkDataObject* selected,
  vtkDataObject* output, const std::function<void(const InputBlock&)>& visit)
{
  const bool composite = vtkCompositeDataSet::SafeDownCast(input);
  if (reference && composite != (vtkCompositeDataSet::SafeDownCast(reference) != nullptr))
  {
    throw Error(composite
        ? "The mesh has blocks but the reference has none: give a reference of the same "
          "structure, or merge the blocks first (Merge Blocks)."
        : "The mesh is a single data set but the reference has blocks: extract the block that is "
          "the reference (Extract Block).");
  }
  if (!composite)
  {
    visit({ vtkDataSet::SafeDownCast(input), vtkDataSet::SafeDownCast(reference),
      vtkDataSet::SafeDownCast(selected), vtkDataSet::SafeDownCast(output), 0, "", 0 });
    return;
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(input);
  auto* references = vtkCompositeDataSet::SafeDownCast(reference);
  auto* selections = vtkCompositeDataSet::SafeDownCast(selected);
  auto* results = vtkCompositeDataSet::SafeDownCast(output);
  results->CopyStructure(blocks);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  int number = 0;
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    auto* block = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    if (!block)
    {
      continue;
    }
    const unsigned int index = walk->GetCurrentFlatIndex();
    const std::string name = "block " + std::to_string(index);
    const auto at = [&walk](vtkCompositeDataSet* set)
    { return set ? vtkDataSet::SafeDownCast(set->GetDataSet(walk)) : nullptr; };
    auto result = vtkSmartPointer<vtkDataSet>::Take(block->NewInstance());
    results->SetDataSet(walk, result);
    try
    {
      visit({ block, at(references), at(selections), result, number++, name, index });
    }
    catch (const Error& error)
    {
      throw Error("In " + name + ": " + error.what());
    }
  }
}

//------------------------------------------------------------------------------
void forEachLeaf(vtkDataObject* data, const std::function<void(unsigned int, vtkDataSet*)>& visit)
{
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (auto* single = vtkDataSet::SafeDownCast(data))
  {
    visit(0, single);
  }
  if (!blocks)
  {
    return;
  }
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    if (auto* leaf = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject()))
    {
      visit(walk->GetCurrentFlatIndex(), leaf);
    }
  }
}

//------------------------------------------------------------------------------
vtkDataSet* counterpartOf(const InputBlock& block, vtkDataObject* data)
{
  const bool composite = vtkCompositeDataSet::SafeDownCast(data);
  vtkDataSet* found = nullptr;
  forEachLeaf(data,
    [&](unsigned int index, vtkDataSet* leaf)
    { found = !composite || index == block.flatIndex ? leaf : found; });
  return found;
}

//------------------------------------------------------------------------------
int countBlocks(vtkDataObject* input)
{
  int count = 0;
  forEachLeaf(input, [&count](unsigned int, vtkDataSet*) { ++count; });
  return std::max(count, 1);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> markSelected(vtkDataObject* input, vtkSelection* selection)
{
  if (!selection || selection->GetNumberOfNodes() == 0)
  {
    return nullptr;
  }
  vtkNew<vtkExtractSelection> extract;
  extract->PreserveTopologyOn();
  extract->SetInputDataObject(0, input);
  extract->SetInputDataObject(1, selection);
  extract->Update();
  return extract->GetOutputDataObject(0);
}

//------------------------------------------------------------------------------
void fixSelected(MovableMesh& mesh, vtkDataSet* selected)
{
  if (selected)
  {
    vtkDataArray* ofCells = selected->GetCellData()->GetArray(SelectedArray);
    vtkDataArray* ofPoints = selected->GetPointData()->GetArray(SelectedArray);
    mesh.fix(ofCells, true);
    mesh.fix(ofPoints, false);
  }
}

//------------------------------------------------------------------------------
vtkDataArray* chosenArray(vtkAlgorithm* algorithm, int index, vtkDataSet* input, const char* what)
{
  vtkInformation* choice = algorithm->GetInputArrayInformation(index);
  const char* name = choice->Get(vtkDataObject::FIELD_NAME());
  if (!name || !*name || std::string(name) == "None")
  {
    return nullptr;
  }
  const bool ofCells =
    choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  vtkDataArray* array =
    ofCells ? input->GetCellData()->GetArray(name) : input->GetPointData()->GetArray(name);
  if (!array)
  {
    throw Error(std::string("There is no ") + (ofCells ? "cell" : "point") + " array '" + name +
      "' " + what + ": choose another one, or None.");
  }
  return array;
}

//------------------------------------------------------------------------------
void declareInput(vtkInformation* info, bool selection, bool optional)
{
  // The composite type first, so that the tables are those of all blocks.
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), selection ? "vtkSelection" : "vtkCompositeDataSet");
  if (!selection)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  }
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), optional);
}

//------------------------------------------------------------------------------
void provideOutputs(vtkDataObject* input, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    const auto made = vtkSmartPointer<vtkDataObject>::Take(
      port == 0 ? input->NewInstance() : static_cast<vtkDataObject*>(vtkTable::New()));
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || std::string(output->GetClassName()) != made->GetClassName())
    {
      info->Set(vtkDataObject::DATA_OBJECT(), made);
    }
  }
}

//------------------------------------------------------------------------------
TableRows::Column& TableRows::next(const std::string& name)
{
  if (this->Next == this->Columns.size())
  {
    this->Columns.push_back({ name, {}, {} });
  }
  return this->Columns[this->Next++];
}

//------------------------------------------------------------------------------
void TableRows::add(const std::string& column, double value)
{
  this->next(column).values.push_back(value);
}

//------------------------------------------------------------------------------
void TableRows::addText(const std::string& column, const std::string& value)
{
  this->next(column).texts.push_back(value);
}

//------------------------------------------------------------------------------
void TableRows::fill(vtkTable* table)
{
  table->Initialize();
  for (const Column& column : this->Columns)
  {
    if (column.texts.empty())
    {
      vtkNew<vtkDoubleArray> array;
      array->SetName(column.name.c_str());
      array->SetNumberOfValues(static_cast<vtkIdType>(column.values.size()));
      std::copy(column.values.begin(), column.values.end(), array->GetPointer(0));
      table->AddColumn(array);
      continue;
    }
    vtkNew<vtkStringArray> array;
    array->SetName(column.name.c_str());
    for (const std::string& text : column.texts)
    {
      array->InsertNextValue(text);
    }
    table->AddColumn(array);
  }
}

//------------------------------------------------------------------------------
void addHistory(TableRows& rows, const std::vector<IterationRecord>& history,
  const std::vector<std::string>& names, const std::string& block)
{
  const auto at = [](const std::vector<double>& values, std::size_t i)
  { return i < values.size() ? values[i] : 0.0; };
  for (const IterationRecord& record : history)
  {
    rows.begin();
    if (!block.empty())
    {
      rows.addText("Block", block);
    }
    rows.add("Objective", record.objective);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      if (names.size() > 1)
      {
        rows.add(names[i] + " objective", at(record.objectives, i));
      }
      rows.add(names[i] + " mean", at(record.mean, i));
      rows.add(names[i] + " worst", at(record.worst, i));
    }
    rows.add("Inverted", static_cast<double>(record.inverted));
    rows.add("N gradient", record.gradientNorm);
    rows.add("N moving", static_cast<double>(record.moving));
    rows.add("Time (s)", record.seconds);
  }
}

//------------------------------------------------------------------------------
std::string summarize(
  const OptimizeResult& result, const MovableMesh& mesh, const std::string& block)
{
  std::ostringstream text;
  text << (block.empty() ? "" : "In " + block + ": ") << describe(result.reason) << "\n";
  text << result.iterations << " iterations";
  if (!result.history.empty())
  {
    const IterationRecord &first = result.history.front(), &last = result.history.back();
    text << ", " << last.seconds << " s. Objective: " << first.objective << " to "
         << last.objective;
  }
  text << ".\n"
       << result.freeVertices << " of " << mesh.mesh().view().numberOfPoints
       << " points were free to move.\nInverted elements: " << result.invertedBefore << " before, "
       << result.invertedAfter << " after, of " << mesh.mesh().view().numberOfCells
       << (result.untangled ? "; it was untangled first." : ".");
  if (result.surfaceError > 0)
  {
    text << "\nLargest distance of the elements from the input surface: " << result.surfaceError
         << ".";
  }
  return text.str();
}
}
