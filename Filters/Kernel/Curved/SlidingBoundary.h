// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlidingBoundary.h
 * @brief The curved boundary of a mesh: its facets, edges and features, and closest-point queries.
 * Internal: not installed.
 *
 * The facets are the faces of volume elements (in a plane, the edges) that belong to one element
 * only, with the polynomials of their elements. Edges at whose middle the normals of two facets
 * differ by more than the feature angle are feature edges. Curves consist of feature edges and end
 * where they bend by more than this angle or where the number of feature edges is not two. Facets
 * connected across other edges form a patch.
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
  /// By control point: for a triangle, the exponents of s, t, and 1 - s - t; for a square or
  /// interval, the exponents of s and t, where 1 - s and 1 - t have degrees - exponents.
  std::vector<std::array<int, 3>> exponents;
  std::vector<double> multinomials;
  std::array<int, 2> degrees = { 0, 0 };
};

/// A facet of the surface or an edge of a curve in its original shape.
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

/// A position on a piece.
struct CurvedPlace
{
  Index piece = -1;
  Vec3 point = { 0, 0, 0 };
  Vec3 direction = { 0, 0, 0 }; ///< unit normal (of a curve: unit tangent), or zero
  Vec2 at = { -1, -1 };         ///< s and t on the piece; negative: not known
};

class SlidingBoundary
{
public:
  /**
   * @param points 3 coordinates each; for a planar mesh, in its frame with z = 0
   * @param dimension 2 or 3
   * @param featureAngle in degrees
   */
  SlidingBoundary(const std::vector<CurvedElement>& elements, const std::vector<double>& points,
    int dimension, double featureAngle);

  /// Whether a point is on the boundary.
  bool contains(Index point) const { return this->Kinds[point] != NotOnBoundary; }
  PointKind kind(Index point) const { return static_cast<PointKind>(this->Kinds[point]); }
  /// A piece of the patch or curve that contains a point; -1 for corners and interior points.
  Index pieceOf(Index point) const { return this->PieceOf[point]; }
  const std::vector<CurvedPiece>& pieces() const { return this->Pieces; }
  int parts() const { return this->Parts; }
  bool isCurve(int part) const { return part >= this->Patches; }

  /**
   * @brief The closest position to x on the part of a piece, found by walking through adjacent,
   * nearer pieces.
   * @param from where the search begins: the piece and, if known, the position on it
   */
  CurvedPlace closest(const CurvedPlace& from, const Vec3& x) const;

  /// The closest position on all pieces of a part.
  CurvedPlace closestOfPart(int part, const Vec3& x) const;

  /**
   * @brief Whether all pieces of its part at a point lie in one plane (curves: in one line).
   * @param angle in degrees: of the normals or tangents
   */
  bool isFlat(Index point, double angle) const;

private:
  static constexpr signed char NotOnBoundary = -1;
  /// An edge of a facet; curves consist of such edges.
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
  std::vector<std::array<Index, 2>> Smooth; ///< facets that meet at a non-feature edge
  int Parts = 0, Patches = 0;
  std::vector<signed char> Kinds;
  std::vector<Index> PieceOf;
  std::vector<std::vector<Index>> PiecesAt; ///< by point of the boundary
  std::map<std::array<int, 3>, FacetForm> Forms;
};
}
#endif
