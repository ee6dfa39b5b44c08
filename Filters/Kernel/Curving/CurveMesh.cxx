// SPDX-License-Identifier: BSD-3-Clause
#include "CurveMesh.h"

#include "CellPlans.h"
#include "CurvedBoundary.h"
#include "NodeNames.h"
#include "tautline/Boundary/GeometryMatch.h"
#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/CellOrder.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace tautline
{
namespace
{
constexpr int maxOrder = 4;

void checkOptions(const CurvingOptions& options)
{
  if (options.order < 1 || options.order > maxOrder)
  {
    throw Error("The order is " + std::to_string(options.order) + "; it must be 1 to " +
      std::to_string(maxOrder) + ".");
  }
  if (options.geometry && !options.smooth)
  {
    throw Error("Straight cells cannot be placed on a Geometry: remove it, or choose the surface "
                "Smooth.");
  }
}

/// A location of nodes; it may have several nodes if coincident points are not merged.
struct Place
{
  Vec3 base;                 ///< its position in the input cells
  Vec3 offset = { 0, 0, 0 }; ///< from there
  bool known = false;        ///< whether the offset is known
  bool boundary = false;
};

/// The data that sampleFacet() needs for the facets of a shape.
struct FacetSamples
{
  std::vector<CurvedNode> nodes;
  /// Per sample: the shape functions of the curved facet and of its corners.
  std::vector<std::vector<double>> curved, linear;
};

FacetSamples makeSamples(CellType shape, int order, bool serendipity)
{
  FacetSamples samples;
  // With twice as many steps as the order, every second sample lies between the nodes.
  const int steps = 2 * order;
  const bool isLine = shape == CellType::Unsupported;
  const VtkCellType type = isLine ? curvedLine(order) : curvedType(shape, order, serendipity);
  samples.nodes = isLine ? curvedLineNodes(order) : curvedNodes(shape, type);
  for (int i = 0; i <= steps; ++i)
  {
    const int last = isLine ? 0 : shape == CellType::Triangle ? steps - i : steps;
    for (int j = 0; j <= last; ++j)
    {
      const Vec3 at = { static_cast<double>(i) / steps, static_cast<double>(j) / steps, 0 };
      if (isLine)
      {
        samples.curved.push_back(lineFunctions(order, at[0]));
        samples.linear.push_back(lineFunctions(1, at[0]));
        continue;
      }
      const int corners = topology(shape).nodes;
      samples.curved.push_back(ElementType::ofVtk(type.vtkType, type.nodes).shapeFunctions(at));
      samples.linear.push_back(
        ElementType::ofVtk(static_cast<int>(shape), corners).shapeFunctions(at));
    }
  }
  return samples;
}

class Curver
{
public:
  Curver(const Mesh& mesh, const MeshView& cells, const CurvedCellFacts& facts,
    const CurvingOptions& options)
    : TheMesh(mesh)
    , View(mesh.view())
    , Cells(cells)
    , Facts(facts)
    , Options(options)
    , Plans(cells, facts, options.order, options.serendipity)
  {
  }

  CurvingResult run()
  {
    this->Plans.requireSupported();
    this->findFeaturesOf();
    this->report(0.1);
    this->placeCorners();
    this->keepPoints();
    this->makeNodes();
    this->report(0.4);
    if (this->Options.smooth && this->Options.order > 1)
    {
      this->placeBoundary();
    }
    this->report(0.6);
    this->followBoundary();
    this->writePoints();
    this->report(0.7);
    this->certify();
    this->report(0.9);
    this->measureDistances();
    return std::move(this->Result);
  }

private:
  void report(double fraction) const;
  void findFeaturesOf();
  void placeCorners();
  void keepPoints();
  void makeNodes();
  Index nodeOf(const CellPlan& plan, int node, const Index* cell);
  NodeName nameOf(const CellPlan& plan, int node, const Index* cell, bool merged) const;
  Index addNode(const CellPlan& plan, int node, const Index* cell, const NodeName* name);
  Vec3 baseOf(const CellPlan& plan, int node, const Index* cell) const;
  void placeBoundary();
  void placeNode(const NodeName& name, const Vec3& target, int part);
  void placeFace(const CurvedFace& face, const std::vector<CurvedNode>& nodes);
  void followBoundary();
  void writePoints();
  void certify();
  void measureDistances();
  void sampleFacet(const SurfaceProjection& geometry, CellType shape, const Index* corners);
  Vec3 originalOf(Index p) const { return pointOf(this->View, p); }
  Vec3 cornerOf(Index p) const { return pointOf(this->Placed->view(), p); }
  Index mergedOf(Index p) const
  {
    return this->Options.representative ? this->Options.representative[p] : p;
  }
  Place& placeOfNode(Index n)
  {
    return this->Places[this->Options.representative ? this->PlaceOf[n] : n];
  }
  const NodeNumbers& placeNumbers() const
  {
    return this->Options.representative ? this->NumbersOfPlaces : this->Numbers;
  }
  Index keptPoints() const { return static_cast<Index>(this->Result.kept.size()); }

  const Mesh& TheMesh;
  const MeshView& View;
  const MeshView& Cells;
  const CurvedCellFacts& Facts;
  const CurvingOptions& Options;
  CellPlans Plans;
  Features Found;
  GeometryMatch Match;
  std::vector<SurfaceProjection> Parts; ///< of the geometry
  std::unique_ptr<Mesh> Placed;         ///< the mesh with the corners on the geometry
  std::vector<Index> NumberOf;          ///< per point of the input in the result, or -1
  NodeNumbers Numbers, NumbersOfPlaces; ///< of nodes, and of places of merged points
  std::vector<Index> PlaceOf;           ///< per node, with merged points
  std::vector<Place> Places;
  std::map<CellType, FacetSamples> Samples;
  CurvingResult Result;
};

//------------------------------------------------------------------------------
void Curver::report(double fraction) const
{
  if (this->Options.progress && !this->Options.progress(fraction))
  {
    throw Error("The execution was aborted.");
  }
}

//------------------------------------------------------------------------------
void Curver::findFeaturesOf()
{
  FeatureOptions options;
  options.angle = this->Options.featureAngle;
  options.regions = this->Options.regions;
  options.coarse = true;
  if (this->Options.geometry)
  {
    this->Match = matchGeometry(this->TheMesh, options, nullptr, *this->Options.geometry);
    this->Found = this->Match.features;
  }
  else
  {
    this->Found = findFeatures(this->TheMesh, options);
  }
  this->Result.corners = this->Found.corners;
  this->Result.curves = this->Found.curves;
  this->Result.patches = this->Found.patches;
  this->Result.curvedBefore = this->TheMesh.higherOrderCells();
}

//------------------------------------------------------------------------------
/// Moves the corners of the boundary onto the geometry.
void Curver::placeCorners()
{
  this->Placed = std::make_unique<Mesh>(this->TheMesh);
  if (!this->Options.geometry)
  {
    return;
  }
  for (const SurfacePart& part : this->Match.model.parts)
  {
    this->Parts.emplace_back(part, nullptr);
  }
  const MeshSpace space = this->TheMesh.space();
  for (Index p = 0; p < this->View.numberOfPoints && space.dimension == Dimension::Planar; ++p)
  {
    // The nearest point of a geometry in space may lie outside the plane of the mesh.
    const Vec3 original = this->originalOf(p);
    double* x = &this->Match.points[3 * p];
    const double off = dot(Vec3{ x[0], x[1], x[2] } - original, space.normal);
    for (int c = 0; c < 3; ++c)
    {
      x[c] -= off * space.normal[c];
    }
  }
  this->Placed = std::make_unique<Mesh>(this->TheMesh.at(this->Match.points.data()));
  this->Placed->setSpace(space);
}

//------------------------------------------------------------------------------
/// Keeps all points except nodes that only curved cells use.
void Curver::keepPoints()
{
  enum Use : unsigned char
  {
    Unused,
    Middle,
    Corner
  };
  std::vector<unsigned char> use(this->View.numberOfPoints, Unused);
  for (Index cell = 0; cell < this->Cells.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellPlan& plan = this->Plans.of(cell);
    const Index* nodes = this->Cells.connectivity + this->Cells.offsets[cell];
    const Index size = this->Cells.offsets[cell + 1] - this->Cells.offsets[cell];
    // A point may be a middle node of one cell and a corner of another: the corner takes
    // precedence.
    for (Index n = 0; n < size; ++n)
    {
      use[nodes[n]] = std::max<unsigned char>(use[nodes[n]], Middle);
    }
    for (int corner : plan.corners)
    {
      use[nodes[corner]] = Corner;
    }
  }
  this->NumberOf.assign(use.size(), -1);
  for (std::size_t p = 0; p < use.size(); ++p)
  {
    if (use[p] != Middle)
    {
      this->NumberOf[p] = this->keptPoints();
      this->Result.kept.push_back(static_cast<Index>(p));
    }
  }
}

//------------------------------------------------------------------------------
NodeName Curver::nameOf(const CellPlan& plan, int node, const Index* cell, bool merged) const
{
  NodeName name;
  for (const CornerShare& part : plan.nodes[node].corners)
  {
    const Index p = cell[plan.corners[part.corner]];
    name.add(merged ? this->mergedOf(p) : p, part.share);
  }
  return name;
}

//------------------------------------------------------------------------------
/// The position of a node in the given cell after its corners were placed; straight-sided unless
/// the cell keeps its shape.
Vec3 Curver::baseOf(const CellPlan& plan, int node, const Index* cell) const
{
  Vec3 base = { 0, 0, 0 };
  const std::vector<double>& linear = plan.nodes[node].linear;
  const bool keep = this->Options.smooth && plan.curved;
  for (std::size_t c = 0; c < linear.size(); ++c)
  {
    const Index p = this->mergedOf(cell[plan.corners[c]]);
    // A cell that keeps its shape is displaced by the linear interpolation of the displacements of
    // its corners.
    base += linear[c] * (keep ? this->cornerOf(p) - this->originalOf(p) : this->cornerOf(p));
  }
  for (const NodeWeight& of : plan.given[node])
  {
    if (keep)
    {
      base += of.weight * pointOf(this->Cells, cell[of.node]);
    }
  }
  return base;
}

//------------------------------------------------------------------------------
/// @param name the name of a node on an edge or face; null: inside
Index Curver::addNode(const CellPlan& plan, int node, const Index* cell, const NodeName* name)
{
  const auto number = static_cast<Index>(this->Result.starts.size());
  this->Result.starts.push_back(static_cast<Index>(this->Result.sources.size()));
  for (const NodeWeight& of : plan.given[node])
  {
    this->Result.sources.push_back(cell[of.node]);
    this->Result.weights.push_back(of.weight);
  }
  auto place = static_cast<Index>(this->Places.size());
  if (this->Options.representative)
  {
    if (name)
    {
      // The first node with this merged name has defined the place; later nodes share it.
      place =
        this->NumbersOfPlaces.emplace(this->nameOf(plan, node, cell, true), place).first->second;
    }
    this->PlaceOf.push_back(place);
  }
  if (place == static_cast<Index>(this->Places.size()))
  {
    this->Places.push_back({ this->baseOf(plan, node, cell) });
  }
  return number;
}

//------------------------------------------------------------------------------
/// The number in the result of a node of a cell.
Index Curver::nodeOf(const CellPlan& plan, int node, const Index* cell)
{
  const NodePlace place = plan.nodes[node].place;
  if (place == NodePlace::Corner)
  {
    return this->NumberOf[cell[plan.corners[plan.nodes[node].corners[0].corner]]];
  }
  if (place == NodePlace::Inside)
  {
    return this->keptPoints() + this->addNode(plan, node, cell, nullptr);
  }
  // A node on an edge or face belongs to several cells, which find it by its name.
  const NodeName name = this->nameOf(plan, node, cell, false);
  const auto next = static_cast<Index>(this->Result.starts.size());
  const auto [at, added] = this->Numbers.emplace(name, next);
  if (added)
  {
    this->addNode(plan, node, cell, &name);
  }
  return this->keptPoints() + at->second;
}

//------------------------------------------------------------------------------
void Curver::makeNodes()
{
  this->Result.offsets = { 0 };
  for (Index cell = 0; cell < this->Cells.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellPlan& plan = this->Plans.of(cell);
    const Index* nodes = this->Cells.connectivity + this->Cells.offsets[cell];
    for (int n = 0; n < plan.type.nodes; ++n)
    {
      this->Result.connectivity.push_back(this->nodeOf(plan, n, nodes));
    }
    this->Result.types.push_back(static_cast<unsigned char>(plan.type.vtkType));
    this->Result.offsets.push_back(static_cast<Index>(this->Result.connectivity.size()));
  }
  this->Result.starts.push_back(static_cast<Index>(this->Result.sources.size()));
}

//------------------------------------------------------------------------------
/// Moves a boundary node to its smooth position, or onto the nearby geometry.
void Curver::placeNode(const NodeName& name, const Vec3& target, int part)
{
  const auto at = this->placeNumbers().find(name);
  if (at == this->placeNumbers().end())
  {
    return; // of a serendipity cell
  }
  Place& place = this->Places[at->second];
  place.boundary = true;
  if (place.known)
  {
    return; // already placed by a curve or by the adjacent facet
  }
  place.known = true;
  // Curved input already approximates the boundary: its nodes are only projected and do not move to
  // a smooth surface through the corners.
  const bool keeps = this->Result.curvedBefore > 0;
  const Vec3 to = keeps ? place.base : target;
  place.offset = to - place.base;
  if (this->Options.geometry)
  {
    place.offset = this->Parts[part].closest(to) - place.base;
    if (this->TheMesh.dimension() == Dimension::Planar)
    {
      const Vec3& normal = this->TheMesh.normal();
      place.offset -= dot(place.offset, normal) * normal;
    }
  }
}

//------------------------------------------------------------------------------
void Curver::placeFace(const CurvedFace& face, const std::vector<CurvedNode>& nodes)
{
  for (const CurvedNode& node : nodes)
  {
    if (node.place != NodePlace::Face)
    {
      continue;
    }
    NodeName name;
    std::array<double, MaxFaceNodes> shares = { 0, 0, 0, 0 };
    for (const CornerShare& part : node.corners)
    {
      name.add(face.nodes[part.corner], part.share);
      shares[part.corner] = node.linear[part.corner];
    }
    this->placeNode(name, pointOn(face, shares), face.patch);
  }
}

//------------------------------------------------------------------------------
void Curver::placeBoundary()
{
  const CurvedBoundary boundary = curvedBoundary(*this->Placed, this->Found);
  const int order = this->Options.order;
  for (std::size_t e = 0; e < boundary.edges.size(); ++e)
  {
    pollInterruption(static_cast<Index>(e));
    const CurvedEdge& edge = boundary.edges[e];
    for (int i = 1; i < order; ++i)
    {
      // Integer shares of the corners identify a node exactly from each of its cells, without a
      // comparison of coordinates.
      const int share = NameUnits * i / order;
      NodeName name;
      name.add(edge.first, NameUnits - share);
      name.add(edge.second, share);
      this->placeNode(name, pointOn(edge.curve, static_cast<double>(i) / order), edge.part);
    }
  }
  // These types have all face nodes; placeNode() ignores the ones that a serendipity cell lacks.
  const auto nodesOf = [order](CellType type)
  { return curvedNodes(type, curvedType(type, order, false)); };
  const std::vector<CurvedNode> ofTriangles = nodesOf(CellType::Triangle),
                                ofQuadrilaterals = nodesOf(CellType::Quadrilateral);
  for (std::size_t f = 0; f < boundary.faces.size(); ++f)
  {
    pollInterruption(static_cast<Index>(f));
    const CurvedFace& face = boundary.faces[f];
    this->placeFace(face, face.size == 3 ? ofTriangles : ofQuadrilaterals);
  }
  double sum = 0;
  Index count = 0;
  for (const Place& place : this->Places)
  {
    const double offset = norm(place.offset);
    sum += offset;
    count += place.boundary;
    this->Result.largestOffset = std::max(this->Result.largestOffset, offset);
  }
  this->Result.meanOffset = count > 0 ? sum / static_cast<double>(count) : 0;
}

//------------------------------------------------------------------------------
/// Moves inner nodes with the nodes of the surrounding edges and faces: all faces before all cell
/// interiors.
void Curver::followBoundary()
{
  for (NodePlace kind : { NodePlace::Face, NodePlace::Inside })
  {
    for (Index cell = 0; cell < this->Cells.numberOfCells; ++cell)
    {
      pollInterruption(cell);
      const CellPlan& plan = this->Plans.of(cell);
      const Index* nodes = &this->Result.connectivity[this->Result.offsets[cell]];
      for (std::size_t n = 0; n < plan.nodes.size(); ++n)
      {
        if (plan.nodes[n].place != kind)
        {
          continue;
        }
        Place& place = this->placeOfNode(nodes[n] - this->keptPoints());
        if (place.known)
        {
          continue;
        }
        place.known = true;
        for (const NodeWeight& of : plan.nodes[n].follows)
        {
          place.offset += of.weight * this->placeOfNode(nodes[of.node] - this->keptPoints()).offset;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
void Curver::writePoints()
{
  for (Index p : this->Result.kept)
  {
    // Merged points are merged only in the mesh.
    const Index merged = this->mergedOf(p);
    const Vec3 x = pointOf(this->Cells, p) + (this->cornerOf(merged) - this->originalOf(merged));
    this->Result.points.insert(this->Result.points.end(), x.begin(), x.end());
    const bool inside = this->Found.kind[merged] == PatchPoint && this->Found.patchOf[merged] < 0;
    this->Result.onBoundary.push_back(!inside);
  }
  const auto nodes = static_cast<Index>(this->Result.starts.size()) - 1;
  for (Index n = 0; n < nodes; ++n)
  {
    pollInterruption(n);
    const Place& place = this->placeOfNode(n);
    const Vec3 x = place.base + place.offset;
    this->Result.points.insert(this->Result.points.end(), x.begin(), x.end());
    this->Result.onBoundary.push_back(place.boundary);
  }
}

//------------------------------------------------------------------------------
void Curver::certify()
{
  // Certification uses the orientation of the mesh, but the output keeps the node order of the
  // input cells.
  std::vector<Index> oriented = this->Result.connectivity;
  for (Index cell = 0; cell < this->Cells.numberOfCells && this->Facts.reversed; ++cell)
  {
    if (this->Facts.reversed[cell])
    {
      reverseCell(cornerType(this->Result.types[cell]), &oriented[this->Result.offsets[cell]]);
    }
  }
  MeshView view;
  view.numberOfPoints = static_cast<Index>(this->Result.points.size() / 3);
  view.points = this->Result.points.data();
  view.numberOfCells = this->Cells.numberOfCells;
  view.cellTypes = this->Result.types.data();
  view.offsets = this->Result.offsets.data();
  view.connectivity = oriented.data();
  Mesh mesh(view, this->Options.threads);
  mesh.setSpace(this->TheMesh.space());
  mesh.setMirrored(this->TheMesh.mirrored());
  this->Result.validity.resize(view.numberOfCells);
  mesh.classifyCells(this->Result.validity.data(), this->Options.threads);
  CurvedCellFacts facts;
  facts.reversed = this->Facts.reversed;
  certifyCurvedCells(mesh, facts, this->Result.validity.data(), nullptr, this->Options.threads);
}

//------------------------------------------------------------------------------
/// Measures the distance of the boundary from the geometry, before and after, at samples of the
/// facets.
void Curver::measureDistances()
{
  if (!this->Options.geometry)
  {
    return;
  }
  const SurfaceProjection geometry = SurfaceProjection::ofFacets(this->Match.model, nullptr);
  const bool planar = this->TheMesh.dimension() == Dimension::Planar;
  for (const Features::Edge& edge : this->Found.edges)
  {
    const Index corners[] = { edge.first, edge.second };
    if (planar)
    {
      this->sampleFacet(geometry, CellType::Unsupported, corners);
    }
  }
  for (std::size_t f = 0; f < this->Found.facets.size(); ++f)
  {
    pollInterruption(static_cast<Index>(f));
    const Features::Facet& facet = this->Found.facets[f];
    this->sampleFacet(
      geometry, facet.size == 3 ? CellType::Triangle : CellType::Quadrilateral, facet.nodes.data());
  }
}

//------------------------------------------------------------------------------
void Curver::sampleFacet(const SurfaceProjection& geometry, CellType shape, const Index* corners)
{
  auto at = this->Samples.find(shape);
  if (at == this->Samples.end())
  {
    const int order = this->Options.order;
    at = this->Samples.emplace(shape, makeSamples(shape, order, this->Options.serendipity)).first;
  }
  const FacetSamples& samples = at->second;
  std::vector<Vec3> before, now;
  for (const CurvedNode& node : samples.nodes)
  {
    NodeName name;
    for (const CornerShare& part : node.corners)
    {
      name.add(corners[part.corner], part.share);
    }
    if (node.place == NodePlace::Corner)
    {
      before.push_back(this->originalOf(corners[node.corners[0].corner]));
      now.push_back(this->cornerOf(corners[node.corners[0].corner]));
      continue;
    }
    const auto found = this->placeNumbers().find(name);
    if (found == this->placeNumbers().end())
    {
      return; // a facet next to excluded cells
    }
    const Place& place = this->Places[found->second];
    now.push_back(place.base + place.offset);
  }
  const auto sum = [](const std::vector<double>& weights, const std::vector<Vec3>& points)
  {
    Vec3 x = { 0, 0, 0 };
    for (std::size_t n = 0; n < weights.size(); ++n)
    {
      x += weights[n] * points[n];
    }
    return x;
  };
  std::int32_t piece = 0;
  const auto measure = [&](const Vec3& x, double& largest)
  {
    const double infinity = std::numeric_limits<double>::infinity();
    // A sample closer than the largest distance so far cannot change the maximum, so its search
    // stops early.
    largest = std::max(largest, geometry.distanceOf(x, largest, infinity, piece));
  };
  for (std::size_t s = 0; s < samples.curved.size(); ++s)
  {
    measure(sum(samples.linear[s], before), this->Result.distanceBefore);
    measure(sum(samples.curved[s], now), this->Result.distanceAfter);
  }
}
}

//------------------------------------------------------------------------------
CurvingResult curveMesh(const Mesh& mesh, const MeshView& cells, const CurvedCellFacts& facts,
  const CurvingOptions& options)
{
  checkOptions(options);
  return Curver(mesh, cells, facts, options).run();
}
}
