// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFoamPointsWriter
 * @brief Writes the points of a mesh back into the OpenFOAM case that it was read from.
 *
 * Only the files `points` change, of a decomposed case those of all processors, and in them only
 * the coordinates of points that have moved: format, width and compression stay, and so do
 * boundary, zones and fields. The files are replaced all together, or none of them.
 *
 * The case is that of FileName (as in vtkFoamMeshReader) or, without one, that of the field array
 * `FoamCase`, which vtkFoamMeshReader adds. With both, FileName may be a copy of the case, in
 * another directory; `FoamCase` names the region and the processors.
 *
 * Refused: a mesh with other cells or another number of points than the case, as after it has
 * changed; coordinates that are not finite; and a case with points of time steps, which would hold
 * instead. Points of the input in single precision that are those of the file, rounded, have not
 * moved.
 *
 * The input is a vtkUnstructuredGrid with the cells of vtkFoamMeshReader first; others behind them,
 * as the faces of the patches, and all arrays are ignored.
 *
 * @sa vtkFoamMeshReader vtkMeshFileWriter tautline::writeFoamPoints
 */
#ifndef vtkFoamPointsWriter_h
#define vtkFoamPointsWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkFoamPointsWriter : public vtkMeshFileWriter
{
public:
  static vtkFoamPointsWriter* New();
  vtkTypeMacro(vtkFoamPointsWriter, vtkMeshFileWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether a file that is replaced is kept beside it as points.orig; one that exists stays. The
   * default is off.
   */
  vtkSetMacro(KeepOriginal, bool);
  vtkGetMacro(KeepOriginal, bool);
  vtkBooleanMacro(KeepOriginal, bool);
  ///@}

  /**
   * The largest change of a coordinate by files with numbers of 4 bytes, the last time.
   */
  double GetRounding() const { return this->Rounding; }

protected:
  vtkFoamPointsWriter() = default;
  ~vtkFoamPointsWriter() override = default;
  std::vector<std::string> WriteDataSet(vtkDataSet* mesh, const std::string& name) override;
  std::string TargetName() override;

  bool KeepOriginal = false;

private:
  std::vector<std::string> MeshFolders(vtkDataSet* mesh) const;

  double Rounding = 0.0;

  vtkFoamPointsWriter(const vtkFoamPointsWriter&) = delete;
  void operator=(const vtkFoamPointsWriter&) = delete;
};

#endif
