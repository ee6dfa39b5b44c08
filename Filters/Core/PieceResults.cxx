// SPDX-License-Identifier: BSD-3-Clause
#include "PieceResults.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/Types.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkStaticPointLocator.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <utility>

namespace tautline
{
/// The data that a process receives for a piece or from a mesh.
struct PieceResults::Package
{
  int process = FirstProcess, group = 0;
  vtkSmartPointer<vtkTable> points, cells; ///< values, a row for each
  vtkSmartPointer<vtkDataSet> mesh;        ///< or cells
};

namespace
{
constexpr int ResultTag = 27411;
constexpr char PointsColumn[] = "Tautline points";
constexpr char ActiveColumn[] = "Tautline active";

//------------------------------------------------------------------------------
/// The arrays that a result has and its mesh lacks.
std::vector<vtkAbstractArray*> newArrays(vtkFieldData* result, vtkFieldData* mesh)
{
  std::vector<vtkAbstractArray*> found;
  for (int i = 0; i < result->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = result->GetAbstractArray(i);
    if (array->GetName() && array != mesh->GetAbstractArray(array->GetName()))
    {
      found.push_back(array);
    }
  }
  return found;
}

const char* activeName(vtkDataSetAttributes* data)
{
  vtkAbstractArray* active = data->GetAbstractAttribute(vtkDataSetAttributes::SCALARS);
  return active && active->GetName() ? active->GetName() : "";
}

/// The new values of the points or cells of a piece.
vtkSmartPointer<vtkTable> packTable(
  vtkDataSetAttributes* result, vtkDataSetAttributes* mesh, const std::vector<vtkIdType>& numbers)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (vtkAbstractArray* array : newArrays(result, mesh))
  {
    table->AddColumn(rowsOf(array, numbers));
  }
  vtkNew<vtkStringArray> active;
  active->SetName(ActiveColumn);
  active->InsertNextValue(activeName(result));
  table->GetFieldData()->AddArray(active);
  return table;
}

/// Adds the values to a piece.
void unpackTable(vtkTable* table, vtkDataSetAttributes* data)
{
  for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
  {
    if (std::string(table->GetColumn(c)->GetName()) != PointsColumn)
    {
      data->AddArray(table->GetColumn(c));
    }
  }
  auto* active =
    vtkStringArray::SafeDownCast(table->GetFieldData()->GetAbstractArray(ActiveColumn));
  const std::string name = active ? std::string(active->GetValue(0)) : "";
  data->SetActiveScalars(name.empty() ? nullptr : name.c_str());
}

//------------------------------------------------------------------------------
/// Sends the names of arrays in order, and their types. Messages with data sets preserve neither:
/// active arrays come first, and a signed char becomes a char.
void sendLayout(vtkMultiProcessStream& stream, vtkDataSetAttributes* data)
{
  stream << data->GetNumberOfArrays();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    const char* name = data->GetArrayName(i);
    stream << std::string(name ? name : "") << data->GetAbstractArray(i)->GetDataType();
  }
}

/// The array itself, or a copy with the given type.
vtkSmartPointer<vtkAbstractArray> ofType(vtkAbstractArray* array, int type)
{
  if (!vtkDataArray::SafeDownCast(array) || array->GetDataType() == type)
  {
    return array;
  }
  auto copy = vtkSmartPointer<vtkAbstractArray>::Take(vtkDataArray::CreateDataArray(type));
  copy->DeepCopy(array);
  return copy;
}

/// Restores the order and types of the arrays sent by sendLayout().
void restoreLayout(vtkMultiProcessStream& stream, vtkDataSetAttributes* data)
{
  vtkNew<vtkCellData> received;
  received->ShallowCopy(data);
  int count = 0;
  stream >> count;
  const auto arrayOf = [&received](const std::string& name)
  { return name.empty() ? nullptr : received->GetAbstractArray(name.c_str()); };
  std::vector<vtkSmartPointer<vtkAbstractArray>> ordered;
  for (int i = 0; i < count; ++i)
  {
    std::string name;
    int type = 0;
    stream >> name >> type;
    vtkAbstractArray* array = arrayOf(name);
    ordered.push_back(array ? ofType(array, type) : nullptr);
  }
  const bool known = count == received->GetNumberOfArrays() &&
    std::find(ordered.begin(), ordered.end(), nullptr) == ordered.end();
  if (!known)
  {
    return; // arrays without names, or with one name
  }
  data->Initialize();
  for (const auto& array : ordered)
  {
    data->AddArray(array);
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    if (vtkAbstractArray* active = received->GetAbstractAttribute(type))
    {
      data->SetActiveAttribute(active->GetName(), type);
    }
  }
}

//------------------------------------------------------------------------------
Vec3 centerOf(vtkDataSet* mesh, vtkIdType cell, vtkIdList* ids)
{
  mesh->GetCellPoints(cell, ids);
  Vec3 sum = { 0, 0, 0 };
  for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
  {
    Vec3 p;
    mesh->GetPoint(ids->GetId(k), p.data());
    sum = sum + p;
  }
  return (1.0 / static_cast<double>(std::max<vtkIdType>(ids->GetNumberOfIds(), 1))) * sum;
}

/// The process with the old cell nearest to a given position.
class NearestOwner
{
public:
  void add(const GatheredGroup& group)
  {
    vtkNew<vtkIdList> ids;
    for (std::size_t c = 0; c < group.whole.cells.size(); ++c)
    {
      const Vec3 center = centerOf(group.whole.mesh, static_cast<vtkIdType>(c), ids);
      this->Centers->InsertNextPoint(center.data());
      this->Owners.push_back(group.processes[static_cast<std::size_t>(group.whole.cells[c].piece)]);
    }
  }

  std::vector<int> of(vtkDataSet* mesh)
  {
    std::vector<int> owners(static_cast<std::size_t>(mesh->GetNumberOfCells()), FirstProcess);
    const bool single = std::all_of(this->Owners.begin(), this->Owners.end(),
      [this](int owner) { return owner == this->Owners.front(); });
    if (single)
    {
      std::fill(
        owners.begin(), owners.end(), this->Owners.empty() ? FirstProcess : this->Owners[0]);
      return owners;
    }
    vtkNew<vtkUnstructuredGrid> places;
    places->SetPoints(this->Centers);
    vtkNew<vtkStaticPointLocator> locator;
    locator->SetDataSet(places);
    locator->BuildLocator();
    vtkNew<vtkIdList> ids;
    for (std::size_t c = 0; c < owners.size(); ++c)
    {
      const Vec3 center = centerOf(mesh, static_cast<vtkIdType>(c), ids);
      const vtkIdType nearest = locator->FindClosestPoint(center.data());
      owners[c] = nearest < 0 ? FirstProcess : this->Owners[static_cast<std::size_t>(nearest)];
    }
    return owners;
  }

private:
  vtkNew<vtkPoints> Centers;
  std::vector<int> Owners;
};
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkAbstractArray> rowsOf(
  vtkAbstractArray* array, const std::vector<vtkIdType>& numbers)
{
  auto rows = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
  rows->SetName(array->GetName());
  rows->SetNumberOfComponents(array->GetNumberOfComponents());
  rows->CopyComponentNames(array);
  rows->SetNumberOfTuples(static_cast<vtkIdType>(numbers.size()));
  if (auto* values = vtkDataArray::SafeDownCast(rows))
  {
    values->Fill(0.0);
  }
  for (std::size_t k = 0; k < numbers.size(); ++k)
  {
    if (numbers[k] >= 0)
    {
      rows->SetTuple(static_cast<vtkIdType>(k), numbers[k], array);
    }
  }
  return rows;
}

//------------------------------------------------------------------------------
std::string shareText(vtkMultiProcessController* controller, const std::string& text)
{
  std::string shared = text;
  auto length = static_cast<vtkIdType>(shared.size());
  controller->Broadcast(&length, 1, FirstProcess);
  shared.resize(static_cast<std::size_t>(length));
  controller->Broadcast(&shared[0], length, FirstProcess);
  return shared;
}

//------------------------------------------------------------------------------
PieceResults::PieceResults(vtkMultiProcessController* controller, vtkDataObject* input,
  const std::vector<GroupedPiece>& pieces, const GatheredMesh& gathered)
  : Controller(controller)
  , Input(input)
  , Pieces(pieces)
  , Gathered(gathered)
{
}

//------------------------------------------------------------------------------
PieceResults::Packages PieceResults::packValues(vtkDataObject* result) const
{
  int groups = 0;
  Packages packages;
  for (const auto& [g, data] : listPieces(result, groups))
  {
    const GatheredGroup& group = this->Gathered.groups[static_cast<std::size_t>(g)];
    vtkDataSet* mesh = group.whole.mesh;
    if (!mesh || data->GetNumberOfPoints() != mesh->GetNumberOfPoints() ||
      data->GetNumberOfCells() != mesh->GetNumberOfCells())
    {
      throw Error("The result does not match the points and cells of the input.");
    }
    auto* points = vtkPointSet::SafeDownCast(data);
    auto* before = vtkPointSet::SafeDownCast(mesh);
    const bool moved = points && before && points->GetPoints() != before->GetPoints();
    for (std::size_t i = 0; i < group.pieces.size(); ++i)
    {
      const PieceNumbers& numbers = group.whole.pieces[i];
      Package package;
      package.process = group.processes[i];
      package.group = g;
      package.points = packTable(data->GetPointData(), mesh->GetPointData(), numbers.points);
      package.cells = packTable(data->GetCellData(), mesh->GetCellData(), numbers.cells);
      if (moved && !numbers.points.empty())
      {
        if (!vtkPointSet::SafeDownCast(group.pieces[i]))
        {
          throw Error(std::string("The points of ") + group.pieces[i]->GetClassName() +
            " are implicit and cannot move: run Image Data to Point Set or Rectilinear Data to "
            "Point Set first, which give them coordinates.");
        }
        vtkDataArray* coordinates = points->GetPoints()->GetData();
        const auto rows = rowsOf(coordinates, numbers.points);
        rows->SetName(PointsColumn);
        package.points->AddColumn(rows);
      }
      for (vtkAbstractArray* array : newArrays(data->GetFieldData(), mesh->GetFieldData()))
      {
        package.cells->GetFieldData()->AddArray(array);
      }
      packages.push_back(package);
    }
  }
  return packages;
}

//------------------------------------------------------------------------------
PieceResults::Packages PieceResults::packCells(vtkDataObject* result) const
{
  const bool asInput = (vtkCompositeDataSet::SafeDownCast(result) != nullptr) ==
    (vtkCompositeDataSet::SafeDownCast(this->Input) != nullptr);
  int groups = 0;
  Packages packages;
  for (const auto& [g, data] : listPieces(result, groups))
  {
    NearestOwner nearest;
    for (std::size_t k = 0; k < this->Gathered.groups.size(); ++k)
    {
      if ((!asInput || static_cast<int>(k) == g) && this->Gathered.groups[k].whole.mesh)
      {
        nearest.add(this->Gathered.groups[k]);
      }
    }
    const std::vector<int> owners = nearest.of(data);
    for (int process = 0; process < this->Controller->GetNumberOfProcesses(); ++process)
    {
      std::vector<char> flags(owners.size());
      std::transform(owners.begin(), owners.end(), flags.begin(),
        [process](int owner) { return static_cast<char>(owner == process); });
      if (process == FirstProcess || std::count(flags.begin(), flags.end(), 1) > 0)
      {
        Package package;
        package.process = process;
        package.group = g;
        package.mesh = extractCells(data, flags, process == FirstProcess);
        packages.push_back(package);
      }
    }
  }
  return packages;
}

//------------------------------------------------------------------------------
/// Sends the packages of the first process to their destinations. @return the packages for this
/// process
PieceResults::Packages PieceResults::exchange(Packages& packages) const
{
  const int rank = this->Controller->GetLocalProcessId();
  Packages own;
  if (rank == FirstProcess)
  {
    for (int process = 0; process < this->Controller->GetNumberOfProcesses(); ++process)
    {
      const Packages all(packages.begin(), packages.end());
      vtkMultiProcessStream stream;
      Packages theirs;
      std::copy_if(all.begin(), all.end(), std::back_inserter(theirs),
        [process](const Package& package) { return package.process == process; });
      if (process == FirstProcess)
      {
        own = theirs;
        continue;
      }
      stream << static_cast<int>(theirs.size());
      for (const Package& package : theirs)
      {
        stream << package.group << static_cast<int>(package.mesh != nullptr);
        if (package.mesh)
        {
          sendLayout(stream, package.mesh->GetPointData());
          sendLayout(stream, package.mesh->GetCellData());
        }
        else
        {
          sendLayout(stream, package.points->GetRowData());
          sendLayout(stream, package.cells->GetRowData());
        }
      }
      this->Controller->Send(stream, process, ResultTag);
      for (const Package& package : theirs)
      {
        for (vtkDataObject* part : std::initializer_list<vtkDataObject*>{
               package.mesh.Get(), package.points.Get(), package.cells.Get() })
        {
          if (part)
          {
            this->Controller->Send(part, process, ResultTag);
          }
        }
      }
    }
    return own;
  }
  vtkMultiProcessStream stream;
  this->Controller->Receive(stream, FirstProcess, ResultTag);
  int count = 0;
  stream >> count;
  const auto receive = [this]
  {
    return vtkSmartPointer<vtkDataObject>::Take(
      this->Controller->ReceiveDataObject(FirstProcess, ResultTag));
  };
  for (int i = 0; i < count; ++i)
  {
    Package package;
    int isMesh = 0;
    stream >> package.group >> isMesh;
    if (isMesh)
    {
      package.mesh = vtkDataSet::SafeDownCast(receive());
      restoreLayout(stream, package.mesh->GetPointData());
      restoreLayout(stream, package.mesh->GetCellData());
    }
    else
    {
      package.points = vtkTable::SafeDownCast(receive());
      package.cells = vtkTable::SafeDownCast(receive());
      restoreLayout(stream, package.points->GetRowData());
      restoreLayout(stream, package.cells->GetRowData());
    }
    own.push_back(package);
  }
  return own;
}

//------------------------------------------------------------------------------
void PieceResults::unpackValues(const Packages& packages, vtkDataObject* output) const
{
  std::size_t next = 0;
  const auto made = rebuild(this->Input, false,
    [&](int group, vtkDataSet* piece)
    {
      if (!piece || next >= packages.size() || packages[next].group != group)
      {
        return vtkSmartPointer<vtkDataSet>(piece);
      }
      const Package& package = packages[next++];
      auto result = vtkSmartPointer<vtkDataSet>::Take(piece->NewInstance());
      result->ShallowCopy(piece);
      auto* coordinates = vtkDataArray::SafeDownCast(package.points->GetColumnByName(PointsColumn));
      if (auto* set = vtkPointSet::SafeDownCast(result); set && coordinates)
      {
        vtkNew<vtkPoints> points;
        points->SetData(coordinates);
        set->SetPoints(points);
      }
      unpackTable(package.points, result->GetPointData());
      unpackTable(package.cells, result->GetCellData());
      vtkFieldData* fields = package.cells->GetFieldData();
      for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
      {
        if (std::string(fields->GetAbstractArray(i)->GetName()) != ActiveColumn)
        {
          result->GetFieldData()->AddArray(fields->GetAbstractArray(i));
        }
      }
      return result;
    });
  output->ShallowCopy(made);
}

//------------------------------------------------------------------------------
void PieceResults::unpackCells(
  const Packages& packages, bool composite, vtkDataObject* output) const
{
  output->Initialize();
  if (!composite)
  {
    if (!packages.empty())
    {
      output->ShallowCopy(packages.front().mesh);
    }
    return;
  }
  std::vector<char> used(packages.size(), 0);
  output->ShallowCopy(rebuild(this->Input, false,
    [&](int group, vtkDataSet*)
    {
      for (std::size_t i = 0; i < packages.size(); ++i)
      {
        if (packages[i].group == group && !used[i])
        {
          used[i] = 1;
          return packages[i].mesh;
        }
      }
      return vtkSmartPointer<vtkDataSet>();
    }));
}

//------------------------------------------------------------------------------
void PieceResults::distribute(
  GatheredResult kind, vtkDataObject* result, vtkDataObject* output) const
{
  Packages packages;
  std::string failure;
  const bool first = this->Controller->GetLocalProcessId() == FirstProcess;
  int isComposite = first && vtkCompositeDataSet::SafeDownCast(result) != nullptr;
  int hasTime = first && result->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP());
  double time = hasTime ? result->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()) : 0.0;
  this->Controller->Broadcast(&isComposite, 1, FirstProcess);
  this->Controller->Broadcast(&hasTime, 1, FirstProcess);
  this->Controller->Broadcast(&time, 1, FirstProcess);
  const bool alike =
    (isComposite != 0) == (vtkCompositeDataSet::SafeDownCast(this->Input) != nullptr);
  const bool same = kind == GatheredResult::SameMesh && alike;
  if (kind == GatheredResult::OnFirst)
  {
    first ? output->ShallowCopy(result) : output->Initialize();
    return;
  }
  try
  {
    const bool empty = first && result->GetNumberOfElements(vtkDataObject::POINT) == 0;
    packages = !first || empty ? Packages()
      : same                   ? this->packValues(result)
                               : this->packCells(result);
  }
  catch (const std::exception& error)
  {
    failure = errorText(error, "divide the mesh");
  }
  failure = shareText(this->Controller, failure);
  if (!failure.empty())
  {
    throw Error(failure);
  }
  const Packages own = this->exchange(packages);
  if (same && !own.empty())
  {
    this->unpackValues(own, output);
  }
  else
  {
    this->unpackCells(own, isComposite != 0, output);
  }
  if (hasTime)
  {
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
}
}
