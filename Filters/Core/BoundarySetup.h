// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySetup.h
 * @brief Translates the properties of the group Boundary into the constraints of the kernel, for
 * one data set.
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
  bool keepFeatures = true;      ///< on surfaces, and where points slide on the boundary
  bool smoothSurface = true;     ///< slide on a smooth surface through the points, not on facets
  bool projectToSurface = true;  ///< keep the points of a surface in space on it
  double surfaceTolerance = 0.0; ///< for OnSurface, as a fraction of the diagonal; 0: any distance
  bool leaving = false;          ///< set BoundaryConstraints::leaving
  bool showFeatures = false;     ///< add the arrays of the features to the output
  bool freeInvalid = false;      ///< see MovableMesh::freeInvalid()
  vtkDataObject* geometry = nullptr; ///< the surface to slide on instead of the input's, or null
  vtkAlgorithm* arrays = nullptr;    ///< the filter whose input arrays are chosen, by these indices
  int fixedArray = 0, kindArray = 0, regionArray = 0;
  int threads = 0;
};

/// Whether feature kinds or regions are chosen, including missing arrays, which are reported later.
TAUTLINECORE_EXPORT bool choosesFeatures(const BoundaryProperties& properties, vtkDataSet* input);
/// @param features whether feature kinds or regions are chosen, on any process
TAUTLINECORE_EXPORT NeedOfWholeMesh needOfWholeMesh(
  const BoundaryProperties& properties, bool features);

/// The values of an array with one component; empty without an array. Throws Error if it has more
/// components.
TAUTLINECORE_EXPORT std::vector<double> scalarsOf(vtkDataArray* array, const char* purpose);

/**
 * @class tautline::BoundarySetup
 * @brief The constraints of a data set, with the data that they point to. Throws Error for arrays
 * that are missing or do not fit.
 */
class TAUTLINECORE_EXPORT BoundarySetup
{
public:
  /// @param mesh of the block, framed; must outlive the setup; receives the fixed points.
  /// Collective if the mesh is in pieces, for which features are not supported: the caller rejects
  /// settings that need them.
  BoundarySetup(const BoundaryProperties& properties, const InputBlock& block, MovableMesh& mesh);
  BoundarySetup(const BoundarySetup&) = delete;
  BoundarySetup& operator=(const BoundarySetup&) = delete;

  /// They point to data of this object.
  const BoundaryConstraints& constraints() const { return this->Constraints; }
  /// The initial mesh; if there is a geometry, its points are placed on it.
  const Mesh& start() const { return this->Placed ? *this->Placed : this->TheMesh.mesh(); }
  /// Adds the point arrays `FeatureKind` and `PatchId`, and for surfaces also the cell array
  /// `PatchId`.
  void addFeatures(vtkDataSet* output) const;
  /// A sentence on the features found; "" if they were not searched for.
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
