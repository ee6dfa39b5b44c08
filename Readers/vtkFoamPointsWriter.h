// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFoamPointsWriter
 * @brief Writes the points of a mesh back to its OpenFOAM case.
 *
 * Only the files `points` change (for a decomposed case, on all processors), and in them only the
 * coordinates of points that have moved: format, width and compression are kept, and so are
 * boundary, zones and fields. Either all files are replaced or none.
 *
 * The case is given by FileName (as in vtkFoamMeshReader) or, without it, by the field array
 * `FoamCase`, which vtkFoamMeshReader adds. With both, FileName may be a copy of the case in
 * another directory; `FoamCase` gives the region and the processors.
 *
 * The following are errors: a mesh whose cells or number of points differ from the case, for
 * example because the case has changed; coordinates that are not finite; and a case with points of
 * time steps, which would be used instead. Input points in single precision that equal the rounded
 * points of the file count as unmoved.
 *
 * The input is a vtkUnstructuredGrid with the cells of vtkFoamMeshReader first; further cells, such
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
   * Whether to keep a replaced file as points.orig; an existing points.orig is not changed. The
   * default is off.
   */
  vtkSetMacro(KeepOriginal, bool);
  vtkGetMacro(KeepOriginal, bool);
  vtkBooleanMacro(KeepOriginal, bool);
  ///@}

  /**
   * The largest change of a coordinate by rounding to 4-byte numbers in the last write.
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
