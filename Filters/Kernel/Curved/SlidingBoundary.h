// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlidingBoundary.h
 * @brief The curved boundary of a mesh: its facets, edges and features, and the closest places.
 * Internal: not installed.
 *
 * The facets are the faces of volume elements that no other element has, and in a plane the edges,
 * with the polynomials of their elements. Edges at which the normals of two facets differ by more
 * than the feature angle in the middle are feature edges; curves of these end where they bend by
 * more, and where other than two meet. A patch is what facets form across other edges.
 */
#ifndef tautline_SlidingBoundary_h
#define tautline_SlidingBoundary_h

#include "CurvedEnergy.h"
#include "tautline/Mesh/Features.h"

#include <map>

namespace tautline
{
/// The polynomials of a facet or edge, over the triangle, the square or the interval of 0 to 1.
struct FacetForm
{
  bool line = false, triangle = false;
  /// By control point: the exponents of s, t and the rest of a triangle; of a square and an
  /// interval those of s and t, with degrees - exponents left for 1 - s and 1 - t.
  std::vector<std::array<int, 3>> exponents;
  std::vector<double> multinomials;
  std::array<int, 2> degrees = { 0, 0 };
};

/// A facet of the surface, or an edge of a curve, as it was at the start.
struct CurvedPiece
{
  const FacetForm* form;
  std::vector<Vec3> controls;
  std::vector<Index> points; ///< its nodes
  int part;                  ///< patch or curve
  Vec3 center;               ///< of a ball around it
  double radius;
  double orientation = 1;                 ///< of the normal, so that it points outward
  std::array<Index, 2> ends = { -1, -1 }; ///< of an edge: the points at s = 0 and 1
};

/// A place on a piece.
struct CurvedPlace
{
  Index piece = -1;
  Vec3 point = { 0, 0, 0 };
  Vec3 direction = { 0, 0, 0 }; ///< unit normal, of a curve the unit tangent; or zero
  Vec2 at = { -1, -1 };         ///< s and t on the piece; negative: not known
};

class SlidingBoundary
{
public:
  /**
   * @param points 3 coordinates each; of a mesh in a plane in its frame, with z = 0
   * @param dimension 2 or 3
   * @param featureAngle in degrees
   */
  SlidingBoundary(const std::vector<CurvedElement>& elements, const std::vector<double>& points,
    int dimension, double featureAngle);

  /// Whether a point is on the boundary.
  bool contains(Index point) const { return this->Kinds[point] != NotOnBoundary; }
  PointKind kind(Index point) const { return static_cast<PointKind>(this->Kinds[point]); }
  /// A piece of the patch, or curve, that a point is in; -1 for corners and inner points.
  Index pieceOf(Index point) const { return this->PieceOf[point]; }
  const std::vector<CurvedPiece>& pieces() const { return this->Pieces; }
  int parts() const { return this->Parts; }
  bool isCurve(int part) const { return part >= this->Patches; }

  /**
   * @brief The closest place to x on the part of a piece, by way of nearer pieces that meet.
   * @param from where the search begins: its piece, and the place on it if that is known
   */
  CurvedPlace closest(const CurvedPlace& from, const Vec3& x) const;

  /// The closest place of all pieces of a part.
  CurvedPlace closestOfPart(int part, const Vec3& x) const;

  /**
   * @brief Whether all pieces of its part at a point lie in one plane (curves: in one line).
   * @param angle in degrees: of the normals or tangents
   */
  bool isFlat(Index point, double angle) const;

private:
  static constexpr signed char NotOnBoundary = -1;
  /// An edge of a facet: what a curve is made of.
  struct FacetEdge
  {
    std::array<Index, 2> ends; ///< the smaller first
    Index facet;
    std::vector<Vec3> controls;
    std::vector<Index> points;
    Vec3 normal; ///< unit normal of the facet in the middle
  };

  Index addPiece(const FacetForm& form, std::vector<Vec3> controls, std::vector<Index> points);
  void addFacets(const std::vector<CurvedElement>& elements, const std::vector<double>& points);
  void addEdges(Index facet, const std::vector<Vec2>& places);
  void addCurves(double featureAngle);
  void classifyPoints(double featureAngle);
  void joinParts();
  CurvedPlace closestOn(Index piece, const Vec3& x, Vec2 at = { -1, -1 }) const;

  int Dimension;
  std::vector<CurvedPiece> Pieces; ///< facets, then feature edges
  std::vector<FacetEdge> Edges;
  std::vector<std::array<Index, 2>> Smooth; ///< facets that meet at an edge without a feature
  int Parts = 0, Patches = 0;
  std::vector<signed char> Kinds;
  std::vector<Index> PieceOf;
  std::vector<std::vector<Index>> PiecesAt; ///< by point of the boundary
  std::map<std::array<int, 3>, FacetForm> Forms;
};
}
#endif
