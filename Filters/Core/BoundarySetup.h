// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySetup.h
 * @brief From the properties of the group Boundary to the constraints of the kernel, for one data
 * set.
 */
#ifndef tautline_BoundarySetup_h
#define tautline_BoundarySetup_h

#include "TautlineCoreModule.h" // for export macro

#include "Blocks.h"
#include "MovableMesh.h"
#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Boundary/GeometryMatch.h"
#include "tautline/Mesh/BoundaryShape.h"

#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// The properties, see vtkMeshBoundaryAlgorithm.
struct BoundaryProperties
{
  BoundaryMotion motion = BoundaryMotion::Fixed;
  double flatAngle = 1.0;        ///< degrees
  double featureAngle = 40.0;    ///< degrees
  bool keepFeatures = true;      ///< of surfaces, and where points slide on the boundary
  bool smoothSurface = true;     ///< slide on a smooth surface through the points, not on facets
  bool projectToSurface = true;  ///< keep the points of a surface in space on it
  double surfaceTolerance = 0.0; ///< of OnSurface, a fraction of the diagonal; 0: any distance
  bool leaving = false;          ///< set BoundaryConstraints::leaving
  bool showFeatures = false;     ///< add the arrays of the features to the output
  bool freeInvalid = false;      ///< see MovableMesh::freeInvalid()
  vtkDataObject* geometry = nullptr; ///< what points slide on instead of the input, or null
  vtkAlgorithm* arrays = nullptr;    ///< whose input arrays are chosen, by these indices
  int fixedArray = 0, kindArray = 0, regionArray = 0;
  int threads = 0;
};

/// Whether feature kinds or regions are chosen; also arrays that are missing, which others report.
TAUTLINECORE_EXPORT bool choosesFeatures(const BoundaryProperties& properties, vtkDataSet* input);
/// @param features whether feature kinds or regions are chosen, on any process
TAUTLINECORE_EXPORT NeedOfWholeMesh needOfWholeMesh(
  const BoundaryProperties& properties, bool features);

/// The values of an array of one component, or none without one; throws Error if it has more.
TAUTLINECORE_EXPORT std::vector<double> scalarsOf(vtkDataArray* array, const char* purpose);

/**
 * @class tautline::BoundarySetup
 * @brief The constraints of a data set, and all that they point to. Throws Error for arrays that
 * are missing or do not fit.
 */
class TAUTLINECORE_EXPORT BoundarySetup
{
public:
  /// @param mesh of the block, framed; outlives the setup; gets the fixed points. Collective if it
  /// is in pieces, which have no features: the caller refuses what needs these.
  BoundarySetup(const BoundaryProperties& properties, const InputBlock& block, MovableMesh& mesh);
  BoundarySetup(const BoundarySetup&) = delete;
  BoundarySetup& operator=(const BoundarySetup&) = delete;

  /// They point to what the setup has.
  const BoundaryConstraints& constraints() const { return this->Constraints; }
  /// The mesh where to start: with a geometry, its points are placed on that.
  const Mesh& start() const { return this->Placed ? *this->Placed : this->TheMesh.mesh(); }
  /// Adds the arrays `FeatureKind` and `PatchId` of points, of surfaces also `PatchId` of cells.
  void addFeatures(vtkDataSet* output) const;
  /// The features found, as a sentence; "" if they were not looked for.
  std::string describeFeatures() const;

private:
  void setFixed();
  void setFeatures();
  bool slidesOnModel() const;
  vtkDataArray* regionArray() const;
  std::vector<signed char> kinds() const;
  void findFeaturesOf(bool onGeometry);
  void placePoints();
  void holdPoints();
  double tolerance() const;
  void setSurfaceTolerance();
  void findLeaving();

  const BoundaryProperties Properties;
  const InputBlock& Block;
  MovableMesh& TheMesh;
  BoundaryShape Shape;
  Features Found;
  bool HasFeatures = false; ///< Found is set
  SurfaceModel Model;
  GeometryMatch Match;
  std::unique_ptr<Mesh> Placed;
  bool HasGeometry = false;
  std::vector<std::int32_t> Parts;
  std::vector<unsigned char> Held; ///< points that are fixed for other reasons than features
  std::vector<unsigned char> Leaving;
  BoundaryConstraints Constraints;
};
}
#endif
