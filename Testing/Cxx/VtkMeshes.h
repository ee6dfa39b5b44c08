// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VtkMeshes.h
 * @brief What the tests of the filters share: meshes as VTK data sets, and the errors of an
 * algorithm.
 */

#ifndef tautline_VtkMeshes_h
#define tautline_VtkMeshes_h

#include "Blocks.h"
#include "Check.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridReader.h"

namespace tautline
{

inline vtkSmartPointer<vtkPoints> toPoints(const MeshData& data, int type = VTK_DOUBLE)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    points->InsertNextPoint(data.point(i).data());
  }
  return points;
}

inline vtkSmartPointer<vtkUnstructuredGrid> toGrid(const MeshData& data, int type = VTK_DOUBLE)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(toPoints(data, type));
  grid->Allocate(data.numberOfCells());
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const std::vector<vtkIdType> ids(data.connectivity.begin() + data.offsets[cell],
      data.connectivity.begin() + data.offsets[cell + 1]);
    grid->InsertNextCell(data.types[cell], static_cast<vtkIdType>(ids.size()), ids.data());
  }
  return grid;
}

/** The points and cells of a grid. */
inline MeshData toMesh(vtkUnstructuredGrid* grid)
{
  MeshData data;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    Vec3 p;
    grid->GetPoint(i, p.data());
    data.addPoint(p);
  }
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
  {
    vtkIdList* ids = grid->GetCell(i)->GetPointIds();
    data.addCell(grid->GetCellType(i), std::vector<Index>(ids->begin(), ids->end()));
  }
  return data;
}

/** The unstructured grid of a legacy VTK file, with all its arrays of scalars. */
inline vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& file)
{
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->ReadAllScalarsOn();
  reader->Update();
  return reader->GetOutput();
}

/** Every cell becomes a polygon. */
inline vtkSmartPointer<vtkPolyData> toPolyData(const MeshData& data, int type = VTK_DOUBLE)
{
  auto poly = vtkSmartPointer<vtkPolyData>::New();
  poly->SetPoints(toPoints(data, type));
  vtkNew<vtkCellArray> polygons;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const std::vector<vtkIdType> ids(data.connectivity.begin() + data.offsets[cell],
      data.connectivity.begin() + data.offsets[cell + 1]);
    polygons->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  poly->SetPolys(polygons);
  return poly;
}

/** The same cells with the points of a VTK data set. */
inline MeshData withPointsOf(MeshData data, vtkDataSet* points)
{
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    data.setPoint(i, { points->GetPoint(i)[0], points->GetPoint(i)[1], points->GetPoint(i)[2] });
  }
  return data;
}

/** An array of f of each number below a count, or of each element of a range. */
template <class Array, class Range, class Function>
vtkSmartPointer<Array> filledArray(const char* name, const Range& range, const Function& f)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  forEach(range,
    [&](const auto& x) { array->InsertNextValue(static_cast<typename Array::ValueType>(f(x))); });
  return array;
}

/** A selection of points by their numbers. */
inline vtkSmartPointer<vtkSelection> pointSelection(vtkAbstractArray* ids)
{
  TAUTLINE_NEW(vtkSelectionNode, node, SetContentType(vtkSelectionNode::INDICES),
    SetFieldType(vtkSelectionNode::POINT), SetSelectionList(ids));
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

/** The first output of a filter, null if it is not of that type. */
template <class T = vtkDataSet>
T* outputOf(vtkAlgorithm* filter)
{
  return T::SafeDownCast(filter->GetOutputDataObject(0));
}

inline vtkPointSet* meshOf(vtkAlgorithm* filter)
{
  return outputOf<vtkPointSet>(filter);
}

inline double component(vtkDataSetAttributes* data, const char* array, Index tuple, int which = 0)
{
  return data->GetArray(array)->GetComponent(tuple, which);
}

/** Calls f(caller) at each event of an object. @return the tag of the observer */
template <class Function>
unsigned long observe(vtkObject* object, unsigned long event, const Function& f)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(new Function(f));
  command->SetClientDataDeleteCallback([](void* data) { delete static_cast<Function*>(data); });
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*)
    { (*static_cast<Function*>(data))(static_cast<vtkAlgorithm*>(caller)); });
  return object->AddObserver(event, command);
}

/** Asks a filter to stop at each event at which its progress is above a number. @return the tag */
inline unsigned long stopAt(vtkAlgorithm* filter, unsigned long event, double progress = -1)
{
  return observe(filter, event,
    [progress](vtkAlgorithm* caller)
    { caller->SetAbortExecute(caller->GetProgress() > progress ? 1 : 0); });
}

/** Collects the errors and warnings of an algorithm instead of printing them. */
class Messages
{
public:
  explicit Messages(vtkAlgorithm* algorithm)
    : Sources{ algorithm, algorithm->GetExecutive() }
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback(
      [](vtkObject* caller, unsigned long event, void* data, void* text)
      {
        auto* self = static_cast<Messages*>(data);
        self->Text += static_cast<const char*>(text);
        const bool own = caller == self->Sources[0] && event == vtkCommand::ErrorEvent;
        self->Errors += own ? static_cast<const char*>(text) : "";
      });
    for (vtkObject* source : this->Sources)
    {
      source->AddObserver(vtkCommand::ErrorEvent, this->Command);
      source->AddObserver(vtkCommand::WarningEvent, this->Command);
    }
  }
  ~Messages()
  {
    for (vtkObject* source : this->Sources)
    {
      source->RemoveObserver(this->Command);
    }
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  bool has(const std::string& part) const { return contains(this->Text, part); }
  bool empty() const { return this->Text.empty(); }
  /** The errors of the algorithm itself. */
  const std::string& errors() const { return this->Errors; }
  void clear()
  {
    this->Text.clear();
    this->Errors.clear();
  }

private:
  vtkSmartPointer<vtkObject> Sources[2]; ///< outlive this
  vtkNew<vtkCallbackCommand> Command;
  std::string Text, Errors;
};

/** Executes an algorithm. @return its errors */
inline std::string errorOf(vtkAlgorithm* algorithm)
{
  const Messages messages(algorithm);
  TAUTLINE_SET(algorithm, Modified(), Update());
  return messages.errors();
}

} // namespace tautline

#endif
