// SPDX-License-Identifier: BSD-3-Clause
#include "MeshChecks.h"

#include "FaceShape.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr auto All = static_cast<std::size_t>(MeshCheckKind::Number);
constexpr bool always = false, thorough = true, counts = false, warns = true;

/// A component of a unit vector below this is 0.
constexpr double AxisTolerance = 1e-6;
/// Points of a wedge patch are in its plane up to this distance.
const double WedgeTolerance = std::sqrt(1e-15);

constexpr double MostOpenness = 1e-6, MostAspectRatio = 1000, LeastSize = 1e-300,
                 LeastPyramid = -1e-15, MostSkewness = 4, LeastTetQuality = 1e-30,
                 LeastFlatness = 0.8, LeastDeterminant = 1e-3, MostConcavity = -1e-6,
                 LeastWeight = 0.05, LeastVolumeRatio = 0.01, ShortEdge = 1e-6, MostTurn = 10,
                 WrongAngle = 90;
/// A face is wrong if it exceeds the cosine of a right angle by this.
constexpr double WrongCosine = 1e-15;

}

//------------------------------------------------------------------------------
std::vector<MeshCheck> emptyMeshChecks()
{
  using Kind = MeshCheckKind;
  using Item = CheckedItem;
  const auto check = [](Kind kind, const char* name, const char* label, Item item, bool onRequest,
                       bool onlyWarns, double limit) {
    return MeshCheck{ { 0, 0, 0, limit }, kind, name, label, item, onRequest, onlyWarns };
  };
  return {
    check(Kind::IllegalCells, "illegal_cells", "Cells with fewer than four faces", Item::Cells,
      always, counts, 4),
    check(
      Kind::UnusedPoints, "unused_points", "Points of no face", Item::Points, always, counts, 0),
    check(Kind::FaceOrder, "face_order", "Internal faces not in upper triangular order",
      Item::Faces, always, counts, 0),
    check(Kind::OpenCells, "open_cells", "Cells with an edge of one face", Item::Cells, thorough,
      counts, 0),
    check(Kind::EdgeAlignment, "edge_alignment", "Edges askew of the layer or wedge", Item::Edges,
      always, counts, 0),
    check(Kind::BoundaryOpenness, "boundary_openness", "Boundary openness", Item::Mesh, always,
      counts, MostOpenness),
    check(
      Kind::CellOpenness, "openness", "Cell openness", Item::Cells, always, counts, MostOpenness),
    check(Kind::CellAspectRatio, "cell_aspect_ratio", "Cell aspect ratio", Item::Cells, always,
      counts, MostAspectRatio),
    check(Kind::FaceArea, "face_area", "Face area", Item::Faces, always, counts, LeastSize),
    check(Kind::CellVolume, "cell_volume", "Cell volume", Item::Cells, always, counts, LeastSize),
    check(Kind::NonOrthogonality, "non_orthogonality", "Non-orthogonality", Item::Faces, always,
      counts, WrongAngle),
    check(Kind::PyramidVolume, "pyramid_volume", "Face pyramid volume", Item::Faces, always, counts,
      LeastPyramid),
    check(Kind::FaceSkewness, "face_skewness", "Face skewness", Item::Faces, always, counts,
      MostSkewness),
    check(Kind::CoupledPoints, "coupled_points", "Faces of coupled patches that do not match",
      Item::Faces, always, counts, 0),
    check(Kind::FaceTets, "face_tets", "Tetrahedra of faces", Item::Faces, thorough, counts,
      LeastTetQuality),
    check(Kind::EdgeLength, "edge_length", "Points of short edges", Item::Points, thorough, warns,
      ShortEdge),
    check(Kind::FaceConcavity, "face_concavity", "Face concavity", Item::Faces, thorough, warns,
      MostTurn),
    check(Kind::FaceFlatness, "face_flatness", "Face flatness", Item::Faces, thorough, warns,
      LeastFlatness),
    check(Kind::CellDeterminant, "cell_determinant", "Cell determinant", Item::Cells, thorough,
      counts, LeastDeterminant),
    check(Kind::CellConcavity, "cell_concavity", "Cell concavity", Item::Cells, thorough, counts,
      MostConcavity),
    check(Kind::FaceWeight, "face_weight", "Face interpolation weight", Item::Faces, thorough,
      counts, LeastWeight),
    check(Kind::VolumeRatio, "volume_ratio", "Volume ratio of neighbors", Item::Faces, thorough,
      counts, LeastVolumeRatio),
  };
}

namespace
{
/// Makes the checks of one mesh.
class Checker
{
public:
  Checker(const FaceMeasures& measures, const double* points)
    : Measures(measures)
    , Mesh(measures.mesh())
    , Points(points)
  {
    this->Report.checks = emptyMeshChecks();
    this->Report.faces.assign(this->Mesh.faces(), 0);
    this->Report.cells.assign(this->Mesh.cells, 0);
  }

  MeshCheckReport run(const MeshCheckFacts& facts)
  {
    this->checkTopology(facts);
    this->checkEdges();
    this->checkBoundary();
    this->checkCells();
    this->checkFaces();
    this->checkPairs();
    this->checkTets();
    return std::move(this->Report);
  }

private:
  using Kind = MeshCheckKind;

  MeshCheck& at(Kind kind) { return this->Report.checks[static_cast<std::size_t>(kind)]; }
  static std::uint32_t bit(Kind kind) { return 1u << static_cast<int>(kind); }
  void offend(Kind kind, Index face)
  {
    ++this->at(kind).offending;
    this->Report.faces[face] |= bit(kind);
  }

  /// Sets the extremes and the mean of the counted values.
  template <class Counts>
  void summarize(Kind kind, const std::vector<double>& values, const Counts& countsIn)
  {
    MeshCheck& check = this->at(kind);
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
    Index number = 0;
    for (Index i = 0; i < static_cast<Index>(values.size()); ++i)
    {
      if (countsIn(i))
      {
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
        sum += values[i];
        ++number;
      }
    }
    if (number > 0)
    {
      check.least = least;
      check.most = most;
      check.weight = static_cast<double>(number);
      check.mean = sum / check.weight;
    }
  }

  template <class Offends>
  void ofCells(Kind kind, Metric metric, const Offends& offends)
  {
    const std::vector<double> values = this->Measures.evaluate(metric).cells;
    this->summarize(kind, values, [this](Index cell) { return this->Mesh.ownsCell(cell); });
    for (Index cell = 0; cell < this->Mesh.cells; ++cell)
    {
      if (this->Mesh.ownsCell(cell) && offends(values[cell]))
      {
        ++this->at(kind).offending;
        this->Report.cells[cell] |= bit(kind);
      }
    }
  }

  template <class Counts, class Offends>
  void ofFaces(Kind kind, Metric metric, const Counts& countsIn, const Offends& offends)
  {
    const std::vector<double> values = this->Measures.evaluate(metric).faces;
    this->summarize(kind, values, countsIn);
    for (Index face = 0; face < this->Mesh.faces(); ++face)
    {
      if (this->Mesh.ownsFace(face) && offends(face, values[face]))
      {
        this->offend(kind, face);
      }
    }
  }

  /// Calls visit(face, cell, sign) for the faces of the cells in this piece.
  template <class Visit>
  void forEachSide(const Visit& visit) const
  {
    for (Index face = 0; face < this->Mesh.faces(); ++face)
    {
      if (this->Mesh.ownsCell(this->Mesh.owner[face]))
      {
        visit(face, this->Mesh.owner[face], 1.0);
      }
      if (this->Mesh.internal(face) && this->Mesh.ownsCell(this->Mesh.neighbor[face]))
      {
        visit(face, this->Mesh.neighbor[face], -1.0);
      }
    }
  }

  /// One flag per point: nonzero if other pieces may also have it.
  std::vector<char> borderPoints() const
  {
    std::vector<char> border(this->Mesh.points, 0);
    for (Index face = 0; face < this->Mesh.faces(); ++face)
    {
      for (Index i = this->Mesh.offsets[face];
           this->Mesh.has(face, OnBorder) && i < this->Mesh.offsets[face + 1]; ++i)
      {
        border[this->Mesh.nodes[i]] = 1;
      }
    }
    return border;
  }

  Vec3 point(Index i) const { return pointAt(this->Points, this->Mesh.nodes[i]); }

  void checkTopology(const MeshCheckFacts& facts);
  void checkEdges();
  bool askew(const Vec3& edge) const;
  bool wedgesArePlane() const;
  void checkBoundary();
  void checkCells();
  void checkFaces();
  void checkPairs();
  void checkCoupledPoints();
  void checkTets();

  const FaceMeasures& Measures;
  const FaceMesh& Mesh;
  const double* Points;
  MeshCheckReport Report;
};

//------------------------------------------------------------------------------
void Checker::checkTopology(const MeshCheckFacts& facts)
{
  this->at(Kind::FaceOrder).offending = facts.facesOutOfOrder;
  std::vector<char> used(this->Mesh.points, 0);
  for (Index node : this->Mesh.nodes)
  {
    used[node] = 1;
  }
  this->at(Kind::UnusedPoints).offending = std::count(used.begin(), used.end(), 0);
  constexpr Index leastFaces = 4;
  std::vector<std::pair<Index, Index>> edges;
  for (Index cell = 0; cell < this->Mesh.cells; ++cell)
  {
    pollInterruption(cell);
    if (!this->Mesh.ownsCell(cell))
    {
      continue;
    }
    const Index begin = this->Mesh.cellOffsets[cell], end = this->Mesh.cellOffsets[cell + 1];
    if (end - begin < leastFaces)
    {
      ++this->at(Kind::IllegalCells).offending;
      this->Report.cells[cell] |= bit(Kind::IllegalCells);
    }
    edges.clear();
    for (Index i = begin; i < end; ++i)
    {
      const Index face = this->Mesh.cellFaces[i], first = this->Mesh.offsets[face];
      const Index size = this->Mesh.size(face);
      for (Index k = 0; k < size; ++k)
      {
        edges.push_back(
          std::minmax(this->Mesh.nodes[first + k], this->Mesh.nodes[first + (k + 1) % size]));
      }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();)
    {
      std::size_t next = i + 1;
      while (next < edges.size() && edges[next] == edges[i])
      {
        ++next;
      }
      if (next == i + 1)
      {
        ++this->at(Kind::OpenCells).offending;
        this->Report.cells[cell] |= bit(Kind::OpenCells);
        break;
      }
      i = next;
    }
  }
}

//------------------------------------------------------------------------------
/// Whether an edge is neither parallel nor perpendicular to the missing directions.
bool Checker::askew(const Vec3& edge) const
{
  // OpenFOAM's rule: an edge may not combine a missing direction with any other.
  int missing = 0, present = 0;
  for (int c = 0; c < 3; ++c)
  {
    if (std::abs(edge[c]) > AxisTolerance)
    {
      ++(this->Measures.directions().geometric[c] ? present : missing);
    }
  }
  return missing > 1 || (missing == 1 && present > 0);
}

//------------------------------------------------------------------------------
bool Checker::wedgesArePlane() const
{
  for (const FacePatch& patch : this->Mesh.patches)
  {
    if (!patch.isWedge() || patch.count == 0)
    {
      continue;
    }
    Vec3 normal = { 0, 0, 0 };
    for (Index face = patch.first; face < patch.first + patch.count; ++face)
    {
      normal += this->Measures.geometry().area[face];
    }
    normal = (1 / norm(normal)) * normal;
    const Vec3 origin = this->point(this->Mesh.offsets[patch.first]);
    for (Index i = this->Mesh.offsets[patch.first];
         i < this->Mesh.offsets[patch.first + patch.count]; ++i)
    {
      if (std::abs(dot(normal, this->point(i) - origin)) > WedgeTolerance)
      {
        return false;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
void Checker::checkEdges()
{
  const FaceDirections& directions = this->Measures.directions();
  const bool wedge = directions.geometric != directions.solution;
  using Edge = std::pair<Index, Index>;
  std::vector<Edge> edges, ofWedges, askew;
  std::vector<char> isShort(this->Mesh.points, 0);
  const std::vector<char> onBorder = this->borderPoints();
  const FaceExtent& extent = this->Measures.extent();
  const double shortest = this->Mesh.points > 0 ? ShortEdge * norm(extent.high - extent.low) : 0;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::vector<char> isWedgeFace(this->Mesh.faces(), 0);
  for (const FacePatch& patch : this->Mesh.patches)
  {
    std::fill_n(isWedgeFace.begin() + patch.first, patch.count, wedge && patch.isWedge());
  }
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    pollInterruption(face);
    const Index first = this->Mesh.offsets[face], size = this->Mesh.size(face);
    for (Index k = 0; k < size && this->Mesh.touches(face); ++k)
    {
      const Index a = this->Mesh.nodes[first + k], b = this->Mesh.nodes[first + (k + 1) % size];
      const Vec3 edge = pointAt(this->Points, b) - pointAt(this->Points, a);
      const double length = norm(edge);
      least = std::min(least, length);
      most = std::max(most, length);
      if (length < shortest)
      {
        isShort[a] = isShort[b] = 1;
      }
      if (isWedgeFace[face])
      {
        ofWedges.push_back(std::minmax(a, b));
      }
      if (a < b && length > 0 && directions.count() < 3 && this->askew((1 / length) * edge))
      {
        askew.emplace_back(a, b);
      }
    }
  }
  const auto unique = [](std::vector<Edge>& list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  unique(askew);
  unique(ofWedges);
  // Edges of wedge faces may be oblique. Edges on the border of a piece are left to joinReports(),
  // which counts them once.
  std::vector<Edge> counted;
  std::set_difference(
    askew.begin(), askew.end(), ofWedges.begin(), ofWedges.end(), std::back_inserter(counted));
  const auto place = [this](Index point) { return pointAt(this->Points, point); };
  for (const auto& [a, b] : counted)
  {
    if (onBorder[a] && onBorder[b])
    {
      const Vec3 p = place(a), q = place(b);
      this->Report.border.askewEdges.push_back({ std::min(p, q), std::max(p, q) });
    }
    else
    {
      ++this->at(Kind::EdgeAlignment).offending;
    }
  }
  if (wedge && !this->wedgesArePlane())
  {
    ++this->at(Kind::EdgeAlignment).offending;
  }
  MeshCheck& lengths = this->at(Kind::EdgeLength);
  lengths.weight = this->Mesh.faces() > 0 ? 1 : 0;
  lengths.least = this->Mesh.faces() > 0 ? least : 0;
  lengths.most = most;
  lengths.limit = shortest;
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    if (isShort[point] && onBorder[point])
    {
      this->Report.border.shortEdgePoints.push_back(place(point));
    }
    else
    {
      lengths.offending += isShort[point];
    }
  }
}

//------------------------------------------------------------------------------
void Checker::checkBoundary()
{
  BoundarySum& boundary = this->Report.boundary;
  for (Index face = this->Mesh.internalFaces; face < this->Mesh.faces(); ++face)
  {
    if (this->Mesh.ownsFace(face) && !this->Mesh.has(face, OnBorder))
    {
      boundary.area += this->Measures.geometry().area[face];
      boundary.size += norm(this->Measures.geometry().area[face]);
    }
  }
  setBoundaryOpenness(this->at(Kind::BoundaryOpenness), boundary);
}

//------------------------------------------------------------------------------
void Checker::checkCells()
{
  this->ofCells(
    Kind::CellOpenness, Metric::Openness, [](double value) { return value > MostOpenness; });
  this->ofCells(Kind::CellAspectRatio, Metric::CellAspectRatio,
    [](double value) { return value > MostAspectRatio; });
  this->ofCells(
    Kind::CellVolume, Metric::CellVolume, [](double value) { return value < LeastSize; });
  this->ofCells(Kind::CellDeterminant, Metric::CellDeterminant,
    [](double value) { return value < LeastDeterminant; });
  this->ofCells(
    Kind::CellConcavity, Metric::CellConcavity, [](double value) { return value > MostConcavity; });
}

//------------------------------------------------------------------------------
void Checker::checkFaces()
{
  const auto all = [this](Index face) { return this->Mesh.ownsFace(face); };
  this->ofFaces(
    Kind::FaceArea, Metric::FaceArea, all, [](Index, double value) { return value < LeastSize; });
  this->ofFaces(Kind::FaceSkewness, Metric::FaceSkewness, all,
    [this](Index face, double value)
    {
      const bool second = this->Mesh.hasTwoCells(face) && !this->Mesh.countsOnce(face);
      return value > MostSkewness && !second;
    });
  const double straight = 0;
  this->ofFaces(Kind::FaceConcavity, Metric::FaceConcavity, all,
    [=](Index, double value) { return value > straight; });
  this->ofFaces(
    Kind::FaceFlatness, Metric::FaceFlatness,
    [this](Index face) { return this->Mesh.ownsFace(face) && this->Mesh.size(face) > 3; },
    [](Index, double value) { return value < LeastFlatness; });

  // Count each side of a face.
  const FaceGeometry& g = this->Measures.geometry();
  MeshCheck& pyramids = this->at(Kind::PyramidVolume);
  pyramids.least = std::numeric_limits<double>::infinity();
  this->forEachSide(
    [&](Index face, Index cell, double sign)
    {
      const double volume = sign * dot(g.area[face], g.center[face] - g.cellCenter[cell]) / 3;
      pyramids.least = std::min(pyramids.least, volume);
      pyramids.weight = 1;
      if (volume < LeastPyramid)
      {
        this->offend(Kind::PyramidVolume, face);
      }
    });
  pyramids.least = pyramids.weight > 0 ? pyramids.least : 0;
}

//------------------------------------------------------------------------------
/// Checks that compare the cells on both sides of a face.
void Checker::checkPairs()
{
  const auto once = [this](Index face) { return this->Mesh.countsOnce(face); };
  MeshCheck& angles = this->at(Kind::NonOrthogonality);
  const double severe = std::cos(SevereAngle / DegreesPerRadian);
  std::vector<double> cosines = this->Measures.evaluate(Metric::NonOrthogonality).faces;
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    double& value = cosines[face];
    value = std::cos(value / DegreesPerRadian);
    if (!this->Mesh.ownsFace(face))
    {
      continue;
    }
    if (value <= WrongCosine)
    {
      this->offend(Kind::NonOrthogonality, face);
    }
    else if (value < severe)
    {
      ++angles.warned;
    }
  }
  this->summarize(Kind::NonOrthogonality, cosines, once);
  const auto degrees = [](double cosine)
  { return std::acos(std::clamp(cosine, -1.0, 1.0)) * DegreesPerRadian; };
  // The mean is the angle of the mean cosine.
  const bool any = angles.least != 0 || angles.most != 0;
  angles.mean = any ? degrees(angles.mean) : 0;
  const double largest = any ? degrees(angles.least) : 0;
  angles.least = any ? degrees(angles.most) : 0;
  angles.most = largest;
  this->ofFaces(Kind::FaceWeight, Metric::FaceWeight, once,
    [](Index, double value) { return value < LeastWeight; });
  this->ofFaces(Kind::VolumeRatio, Metric::VolumeRatio, once,
    [](Index, double value) { return value < LeastVolumeRatio; });
  this->checkCoupledPoints();
}

//------------------------------------------------------------------------------
/// Whether the points of coupled faces, in opposite order, match.
void Checker::checkCoupledPoints()
{
  const FaceGeometry& g = this->Measures.geometry();
  constexpr double rounding = 1e-15;
  MeshCheck& check = this->at(Kind::CoupledPoints);
  double sum = 0;
  Index compared = 0;
  for (Index face = this->Mesh.internalFaces; face < this->Mesh.faces(); ++face)
  {
    const Index other = this->Mesh.coupled(face);
    if (!this->Mesh.countsOnce(face) || this->Mesh.has(face, OnBorder))
    {
      continue;
    }
    const Index size = this->Mesh.size(face), first = this->Mesh.offsets[face];
    const Index otherFirst = this->Mesh.offsets[other];
    bool matches = size == this->Mesh.size(other);
    double radius = rounding;
    for (Index k = 0; k < size; ++k)
    {
      const Vec3 p = this->point(first + k);
      radius = std::max({ radius, norm(p - g.center[face]),
        rounding * std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) }) });
    }
    for (Index k = 0; matches && k < size; ++k)
    {
      const Vec3 mine = this->point(first + k);
      const Vec3 theirs =
        acrossPatch(this->Mesh, g, face, this->point(otherFirst + (size - k) % size));
      const double distance = norm(mine - theirs);
      sum += distance;
      ++compared;
      matches = distance <= radius;
    }
    if (!matches)
    {
      this->offend(Kind::CoupledPoints, face);
    }
  }
  check.weight = static_cast<double>(compared);
  check.mean = compared > 0 ? sum / check.weight : 0;
}

//------------------------------------------------------------------------------
/// Checks the tetrahedra over a face, from its center and from a fan.
void Checker::checkTets()
{
  const Kind kind = Kind::FaceTets;
  const std::vector<double> fans = this->Measures.evaluate(Metric::FanTetQuality).faces;
  const auto centers = this->Measures.centerTetQualities();
  double least = std::numeric_limits<double>::infinity();
  const auto add = [&](Index face, double quality, bool offends)
  {
    least = std::min(least, quality);
    this->at(kind).weight = 1;
    if (offends)
    {
      this->offend(kind, face);
    }
  };
  this->forEachSide(
    [&](Index face, Index, double sign)
    {
      const double quality = centers[face][sign > 0 ? 0 : 1];
      add(face, quality, quality < LeastTetQuality);
    });
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    if (this->Mesh.ownsFace(face))
    {
      add(face, fans[face], !(fans[face] > LeastTetQuality));
    }
  }
  this->at(kind).least = this->at(kind).weight > 0 ? least : 0;
}
}

//------------------------------------------------------------------------------
void setBoundaryOpenness(MeshCheck& check, const BoundarySum& boundary)
{
  check.weight = 1;
  check.most = 0;
  for (int c = 0; c < 3; ++c)
  {
    check.most = std::max(check.most, std::abs(boundary.area[c]) / (boundary.size + LeastSize));
  }
  check.offending = check.most > MostOpenness;
}

//------------------------------------------------------------------------------
std::vector<MeshCheck> joinChecks(const std::vector<std::vector<MeshCheck>>& meshes)
{
  std::vector<MeshCheck> all = emptyMeshChecks();
  for (MeshCheck& check : all)
  {
    // The mean angle is the angle of the mean cosine.
    const bool angle = check.kind == MeshCheckKind::NonOrthogonality;
    double sum = 0;
    for (const std::vector<MeshCheck>& mesh : meshes)
    {
      const MeshCheck& more = mesh[static_cast<std::size_t>(check.kind)];
      check.offending += more.offending;
      check.warned += more.warned;
      if (more.weight > 0)
      {
        check.least = check.weight > 0 ? std::min(check.least, more.least) : more.least;
        check.most = check.weight > 0 ? std::max(check.most, more.most) : more.most;
        check.limit = more.limit;
        check.weight += more.weight;
        sum += more.weight * (angle ? std::cos(more.mean / DegreesPerRadian) : more.mean);
      }
    }
    if (check.weight > 0)
    {
      const double mean = sum / check.weight;
      check.mean = angle ? std::acos(std::clamp(mean, -1.0, 1.0)) * DegreesPerRadian : mean;
    }
  }
  return all;
}

//------------------------------------------------------------------------------
int MeshCheckReport::failed(bool all) const
{
  int number = 0;
  for (const MeshCheck& check : this->checks)
  {
    // checkMesh performs both as one check.
    const bool counted =
      check.kind == MeshCheckKind::CellAspectRatio && (*this)[MeshCheckKind::CellOpenness].failed();
    number += check.failed() && (all || !check.thorough) && !counted;
  }
  return number;
}

//------------------------------------------------------------------------------
std::string MeshCheckReport::verdict(bool all) const
{
  const int number = this->failed(all);
  return number == 0 ? "Mesh OK." : "Failed " + std::to_string(number) + " mesh checks.";
}

//------------------------------------------------------------------------------
MeshCheckReport checkMesh(
  const FaceMeasures& measures, const double* points, const MeshCheckFacts& facts)
{
  static_assert(All <= 32, "the kinds are bits of 32");
  return Checker(measures, points).run(facts);
}
}
