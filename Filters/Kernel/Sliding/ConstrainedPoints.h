// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConstrainedPoints.h
 * @brief The constraints of the points of a mesh: fixed, sliding, within a distance of a surface,
 * or free.
 * Internal: not installed.
 */
#ifndef tautline_ConstrainedPoints_h
#define tautline_ConstrainedPoints_h

#include "QuadraticModel.h"
#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Boundary/SurfaceProjection.h"

namespace tautline
{
/**
 * @class tautline::ConstrainedPoints
 * @brief The freedom of each point of a planar or volume mesh.
 *
 * Points on a flat patch or a straight curve slide in its plane or on its line. Points on other
 * parts are free within a band around the facets of the part: distances up to half of the tolerance
 * are free of cost, larger ones have a quadratic cost. (Points sliding on facets would stop at the
 * ridges between them.) A BoundaryConstraints::surfaceTolerance of 0 is a thousandth of the
 * diagonal here. Without flags of fixed points, none is fixed.
 */
class TAUTLINE_KERNEL_EXPORT ConstrainedPoints
{
public:
  /// The mesh and the arrays of the constraints must outlive this object.
  ConstrainedPoints(const Mesh& mesh, const BoundaryConstraints& constraints);

  const BoundaryConstraints& constraints() const { return this->Given; }
  double tolerance() const { return this->Tolerance; }
  bool planar() const { return this->Planar; }
  Freedom freedom(Index p) const { return this->Freedoms[p]; }
  /// The unit direction of a line, or normal of a plane.
  const Vec3& direction(Index p) const { return this->Directions[p]; }
  /// The part whose band contains a point, or -1.
  std::int32_t band(Index p) const { return this->Bands[p]; }
  /// The position nearest to x on the facets or edges of a part.
  Vec3 nearest(std::int32_t part, const Vec3& x) const { return this->Facets[part].closest(x); }
  /// The facets of a part.
  const SurfaceProjection& facets(std::int32_t part) const { return this->Facets[part]; }
  /// The position nearest to x on the part of a point, on the smooth surface if the model is
  /// smooth.
  Vec3 onPart(Index p, const Vec3& x) const;

private:
  void slideOnPart(Index p, std::int32_t part, const Vec3& x);

  BoundaryConstraints Given;
  double Tolerance;
  bool Planar;
  Vec3 Normal; ///< of a planar mesh
  std::vector<Freedom> Freedoms;
  std::vector<Vec3> Directions;
  std::vector<std::int32_t> Bands;
  std::vector<SurfaceProjection> Facets, Smooth;
  std::vector<char> Flat; ///< per part
  std::vector<Vec3> DirectionsOfParts;
};
}
#endif
