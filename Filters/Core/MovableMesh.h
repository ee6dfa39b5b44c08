/**
 * @file MovableMesh.h
 * @brief What the filters that move points share: the mesh and its orientation, which points are
 * fixed, blocks, new points, tables.
 */
#ifndef tautline_MovableMesh_h
#define tautline_MovableMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"
#include "tautline/Optimization/Optimize.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkInformation;
class vtkInformationVector;
class vtkPointSet;
class vtkSelection;
class vtkTable;

namespace tautline
{
struct BoundaryShape;

/**
 * @class tautline::MovableMesh
 * @brief A data set whose points can move. Its orientation is settled: reversed throughout is
 * viewed as its mirror image, mixed is refused.
 */
class TAUTLINECORE_EXPORT MovableMesh
{
public:
  /**
   * @brief Throws Error that names the remedy for points that are implicit (image data), cells of
   * higher order, no cell at all that is measured, and mixed orientation.
   */
  MovableMesh(vtkDataSet* input, int threads);

  const Mesh& mesh() const { return this->Adapter.mesh(); }
  /// One per cell of the input.
  const std::vector<signed char>& validity() const { return this->Validity; }
  /// What the user should know of how the mesh is taken, or "".
  const std::string& notice() const { return this->Notice; }
  /// Cells to leave out of statistics; null if there are none.
  const unsigned char* skipped() const;

  /// The same with other points.
  std::vector<signed char> validityAt(const std::vector<double>& points) const;

  /// Marks points with a value other than 0 in a point array, or of cells with one in a cell array.
  void fix(vtkDataArray* array, bool ofCells);
  void fixBoundary();
  /// Marks points of the boundary that cannot slide; see boundaryShape().
  void fixCorners(const BoundaryShape& shape);
  /**
   * @brief The flags set so far, and those that are always set: points of ghost cells, of cells
   * that are not measured (lines, polygons, polyhedra) and of surfaces inside a volume mesh.
   */
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }

  /**
   * @brief Gives the output new points, in the precision of the input unless a valid cell would not
   * be valid in it, and the point array `Displacement`.
   * @return a sentence if single precision did not do, else ""
   */
  std::string move(vtkPointSet* output, const std::vector<double>& points) const;

private:
  void fixWhatStays();

  vtkPointSet* Input;
  MeshAdapter Adapter;
  int Threads;
  std::vector<signed char> Validity;
  std::vector<unsigned char> Skip, Fixed;
  std::string Notice;
};

/// A data set of the input, with its counterparts.
struct InputBlock
{
  vtkDataSet* input;
  vtkDataSet* reference; ///< or null
  vtkDataSet* selected;  ///< the input with the array of markSelected(), or null
  vtkDataSet* output;
  int number;             ///< counts through the data sets, from 0
  std::string name;       ///< "block 3", or "" if the input is a single data set
  unsigned int flatIndex; ///< of composite data; 0 if the input is a single data set
};

/**
 * @brief Gives a composite output the structure of the input and calls visit for each data set, or
 * once. Throws Error if reference and input do not have the same structure.
 */
TAUTLINECORE_EXPORT void forEachBlock(vtkDataObject* input, vtkDataObject* reference,
  vtkDataObject* selected, vtkDataObject* output,
  const std::function<void(const InputBlock&)>& visit);

/// The number of data sets, at least 1.
TAUTLINECORE_EXPORT int countBlocks(vtkDataObject* input);

/// Calls visit(flat index, data set) for the data sets of composite data, or with 0 for a single
/// one.
TAUTLINECORE_EXPORT void forEachLeaf(
  vtkDataObject* data, const std::function<void(unsigned int, vtkDataSet*)>& visit);

/// The data set of `data` that belongs to a block of the input: at its place, or `data` itself;
/// null: none.
TAUTLINECORE_EXPORT vtkDataSet* counterpartOf(const InputBlock& block, vtkDataObject* data);

/// The array of marks, of points or cells, in what markSelected() returns.
constexpr const char* SelectedArray = "vtkInsidedness"; // the name vtkExtractSelection gives it

/// A copy of the input with marks on what is selected; null without a selection.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataObject> markSelected(
  vtkDataObject* input, vtkSelection* selection);

/// Marks the points that markSelected() found, and those of cells it found.
TAUTLINECORE_EXPORT void fixSelected(MovableMesh& mesh, vtkDataSet* selected);

/// A point or cell array named by an algorithm's input array choice; null if none is. Throws Error.
TAUTLINECORE_EXPORT vtkDataArray* chosenArray(
  vtkAlgorithm* algorithm, int index, vtkDataSet* input, const char* what);

/// Sets what an input port takes: data sets and composite ones, or a selection of what stays.
TAUTLINECORE_EXPORT void declareInput(vtkInformation* info, bool selection, bool optional);

/// Makes the outputs: like the input on port 0, tables on the others.
TAUTLINECORE_EXPORT void provideOutputs(vtkDataObject* input, vtkInformationVector* outputs);

/// Columns that grow by rows; the names of the first row decide.
class TAUTLINECORE_EXPORT TableRows
{
public:
  void begin() { this->Next = 0; }
  void add(const std::string& column, double value);
  void addText(const std::string& column, const std::string& value);
  /// Moves everything to a table.
  void fill(vtkTable* table);

private:
  struct Column
  {
    std::string name;
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  Column& next(const std::string& name);
  std::vector<Column> Columns;
  std::size_t Next = 0;
};

/**
 * @brief Adds a row per iteration: `Block` (composite input), `Objective`, for each name `<name>
 * objective` (if there are several), `<name> mean`, `<name> worst`; `Inverted`, `N gradient`, `N
 * moving`, `Time (s)`. Row i is iteration i of the block; row 0 is the input. ParaView's charts
 * leave out the last two.
 */
TAUTLINECORE_EXPORT void addHistory(TableRows& rows, const std::vector<IterationRecord>& history,
  const std::vector<std::string>& names, const std::string& block);

/// Reason, iterations, seconds, free points and inverted elements, in sentences.
TAUTLINECORE_EXPORT std::string summarize(
  const OptimizeResult& result, const MovableMesh& mesh, const std::string& block);
}
#endif
