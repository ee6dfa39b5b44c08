// SPDX-License-Identifier: BSD-3-Clause
#include "BoundarySetup.h"

#include "GeometrySurface.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
template <class Array, class Value>
void addArray(vtkDataSetAttributes* to, const char* name, const std::vector<Value>& values)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  to->AddArray(array);
}

/// The kinds in a point array; merged points get the largest of theirs. Empty without an array.
std::vector<signed char> kindsOf(vtkDataArray* array, const std::vector<Index>& representative)
{
  std::vector<signed char> kinds;
  for (double value : scalarsOf(array, "feature kinds"))
  {
    if (!(value == DetectKind || value == PatchPoint || value == CurvePoint ||
          value == CornerPoint))
    {
      throw Error("The array of feature kinds has the value " + std::to_string(value) +
        " at point " + std::to_string(kinds.size()) +
        "; it must be 0 (patch), 1 (curve), 2 (corner) or -1 (as detected).");
    }
    kinds.push_back(static_cast<signed char>(value));
  }
  for (std::size_t p = 0; !kinds.empty() && p < representative.size(); ++p)
  {
    kinds[representative[p]] = std::max(kinds[representative[p]], kinds[p]);
  }
  return kinds;
}
}

//------------------------------------------------------------------------------
bool choosesFeatures(const BoundaryProperties& properties, vtkDataSet* input)
{
  const auto isChosen = [&](int index)
  {
    try
    {
      return input && input->GetNumberOfPoints() > 0 &&
        chosenArray(properties.arrays, index, input, "");
    }
    catch (const Error&)
    {
      return true;
    }
  };
  return isChosen(properties.kindArray) || isChosen(properties.regionArray);
}

//------------------------------------------------------------------------------
NeedOfWholeMesh needOfWholeMesh(const BoundaryProperties& properties, bool features)
{
  if (properties.motion == BoundaryMotion::OnSurface || properties.geometry)
  {
    return { "points that slide on curved surfaces and geometries",
      "choose the Boundary Fixed, Slide on flat parts (sliding) or Free, without a Geometry" };
  }
  if (features)
  {
    return { "regions and feature kinds", "choose None for these arrays" };
  }
  if (properties.freeInvalid)
  {
    return { "points of invalid elements that are freed", "switch Free Invalid Elements off" };
  }
  if (properties.showFeatures)
  {
    return { "features that are shown", "switch Show Features off" };
  }
  return {};
}

//------------------------------------------------------------------------------
std::vector<double> scalarsOf(vtkDataArray* array, const char* purpose)
{
  std::vector<double> values;
  if (array && array->GetNumberOfComponents() != 1)
  {
    throw Error(std::string("The array of ") + purpose + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components; one is expected.");
  }
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

//------------------------------------------------------------------------------
BoundarySetup::BoundarySetup(
  const BoundaryProperties& properties, const InputBlock& block, MovableMesh& mesh)
  : Properties(properties)
  , Block(block)
  , TheMesh(mesh)
{
  this->setFixed();
  this->setFeatures();
  this->setSurfaceTolerance();
  this->findLeaving();
}

//------------------------------------------------------------------------------
vtkDataArray* BoundarySetup::regionArray() const
{
  return chosenArray(this->Properties.arrays, this->Properties.regionArray, this->Block.input,
    "of regions", ArrayOf::Cells);
}

//------------------------------------------------------------------------------
/// The given kinds of points, or none.
std::vector<signed char> BoundarySetup::kinds() const
{
  return kindsOf(chosenArray(this->Properties.arrays, this->Properties.kindArray, this->Block.input,
                   "of feature kinds", ArrayOf::Points),
    this->TheMesh.representative());
}

//------------------------------------------------------------------------------
void BoundarySetup::setFixed()
{
  MovableMesh& mesh = this->TheMesh;
  mesh.fix(chosenArray(this->Properties.arrays, this->Properties.fixedArray, this->Block.input,
             "of fixed points", ArrayOf::Points),
    false);
  mesh.fixSelected(this->Block.selected);
  const bool onSurface =
    this->Properties.motion == BoundaryMotion::OnSurface && !this->slidesOnModel();
  if (this->Properties.motion == BoundaryMotion::Fixed)
  {
    mesh.fixBoundary();
  }
  else if (this->Properties.motion == BoundaryMotion::FlatParts || onSurface)
  {
    this->Shape = boundaryShape(mesh.inPieces() ? mesh.local() : mesh.mesh(),
      this->Properties.flatAngle, onSurface ? this->Properties.featureAngle : 0.0, mesh.division());
    mesh.fixCorners(this->Shape);
    for (std::size_t i = 0; i < 3 * mesh.fixed().size(); ++i)
    {
      if (mesh.fixed()[i / 3])
      {
        this->Shape.planes[i] = this->Shape.lines[i] = 0;
      }
    }
    for (std::size_t i = 0; i < this->Shape.surface.size(); ++i)
    {
      this->Shape.surface[i] &= !mesh.fixed()[i];
    }
    this->Constraints.slideSurface =
      this->Shape.onSurface > 0 ? this->Shape.surface.data() : nullptr;
    this->Constraints.slidePlanes = this->Shape.planes.data();
    this->Constraints.slideLines = this->Shape.lines.data();
  }
  if (this->Properties.freeInvalid)
  {
    mesh.freeInvalid();
  }
  this->Constraints.fixed = mesh.fixed().data();
}

//------------------------------------------------------------------------------
/// @param onGeometry whether the mesh slides on the Geometry
void BoundarySetup::findFeaturesOf(bool onGeometry)
{
  const std::vector<signed char> kinds = this->kinds();
  const std::vector<double> regions = scalarsOf(this->regionArray(), "regions");
  FeatureOptions options;
  options.angle = this->Properties.featureAngle;
  options.kinds = kinds.empty() ? nullptr : kinds.data();
  options.regions = regions.empty() ? nullptr : regions.data();
  this->HasFeatures = true;
  if (!onGeometry)
  {
    this->Found = findFeatures(this->TheMesh.mesh(), options);
    return;
  }
  const bool planar = this->TheMesh.mesh().dimension() == Dimension::Planar;
  const GeometrySurface surface(counterpartOf(this->Block, this->Properties.geometry),
    this->TheMesh.frame(), planar, this->Properties.threads);
  this->Match =
    matchGeometry(this->TheMesh.mesh(), options, this->TheMesh.fixed().data(), surface.mesh());
  this->Found = this->Match.features;
  this->HasGeometry = true;
}

//------------------------------------------------------------------------------
/// Whether all points of the surface or the boundary are kept on its features.
bool BoundarySetup::slidesOnModel() const
{
  const bool surface = this->TheMesh.mesh().dimension() == Dimension::Surface;
  return this->Properties.keepFeatures &&
    (surface ? this->Properties.projectToSurface
             : this->Properties.motion == BoundaryMotion::OnSurface);
}

//------------------------------------------------------------------------------
void BoundarySetup::setFeatures()
{
  if (this->TheMesh.inPieces())
  {
    return; // see needOfWholeMesh()
  }
  const bool keep = this->slidesOnModel() || (this->Properties.keepFeatures && this->regionArray());
  if (this->Properties.geometry && !this->slidesOnModel())
  {
    throw Error(
      "With a Geometry, points must be able to slide on it: switch Keep Features and "
      "Project To Surface on and, for volume meshes, allow the boundary to slide on smooth "
      "parts.");
  }
  if (keep || this->Properties.showFeatures)
  {
    this->findFeaturesOf(keep && this->Properties.geometry);
  }
  if (!keep)
  {
    return;
  }
  this->holdPoints();
  this->Constraints.slideSurface = nullptr;
  this->Constraints.fixed = this->TheMesh.fixed().data();
  this->Constraints.parts = this->Parts.data();
  if (this->Properties.geometry)
  {
    this->Constraints.model = &this->Match.model;
    this->placePoints();
    return;
  }
  // The rest of the tolerance is left for the chord error of the elements between the points.
  constexpr double shareOfPoints = 0.5;
  const bool surface = this->TheMesh.mesh().dimension() == Dimension::Surface;
  const double tolerance = surface ? this->tolerance() : 0.0;
  this->Model = makeSurfaceModel(this->TheMesh.mesh(), this->Found, this->Properties.smoothSurface,
    false, tolerance > 0 ? shareOfPoints * tolerance : std::numeric_limits<double>::infinity());
  this->Constraints.model = &this->Model;
}

//------------------------------------------------------------------------------
/// Starts with the points on the geometry; points of elements that would become invalid stay in
/// place, and slide as soon as a step moves them onto it.
void BoundarySetup::placePoints()
{
  const Mesh& mesh = this->TheMesh.mesh();
  const MeshView& view = mesh.view();
  const std::vector<signed char>& before = this->TheMesh.validity();
  std::vector<double>& points = this->Match.points;
  // A point that is moved back may make elements beside it invalid. Each round moves at least one
  // point back for good.
  for (bool more = true; more;)
  {
    more = false;
    const std::vector<signed char> after = this->TheMesh.validityAt(points);
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      pollInterruption(cell);
      const bool lost = before[cell] == Valid && after[cell] != Valid;
      for (Index n = view.offsets[cell]; lost && n < view.offsets[cell + 1]; ++n)
      {
        const double* from = view.points + 3 * view.connectivity[n];
        double* to = &points[3 * view.connectivity[n]];
        more = more || !std::equal(from, from + 3, to);
        std::copy_n(from, 3, to);
      }
    }
  }
  MeshView placed = view;
  placed.points = points.data();
  this->Placed = std::make_unique<Mesh>(placed, this->Properties.threads);
  this->Placed->setMirrored(mesh.mirrored());
}

//------------------------------------------------------------------------------
/// The surface tolerance in the coordinates of the mesh; 0 allows any distance.
double BoundarySetup::tolerance() const
{
  const double diagonal = diagonalOf(this->TheMesh.mesh().view());
  return this->Properties.surfaceTolerance > 0 && std::isfinite(diagonal)
    ? this->Properties.surfaceTolerance * diagonal
    : 0.0;
}

//------------------------------------------------------------------------------
void BoundarySetup::setSurfaceTolerance()
{
  this->Constraints.onGeometry = this->HasGeometry;
  if (this->TheMesh.inPieces())
  {
    return;
  }
  const bool surface = this->TheMesh.mesh().dimension() == Dimension::Surface;
  const bool slides = surface
    ? this->Properties.projectToSurface && !this->HasGeometry // whose points are on that
    : this->Properties.motion == BoundaryMotion::OnSurface || !this->Model.interfaces.empty();
  this->Constraints.surfaceTolerance = slides ? this->tolerance() : 0.0;
}

//------------------------------------------------------------------------------
/// The points of the outer surface that are fixed at most as features, and that the user has not
/// chosen as features.
void BoundarySetup::findLeaving()
{
  if (!this->Properties.leaving || !this->slidesOnModel() || this->HasGeometry)
  {
    return;
  }
  const std::vector<signed char> kinds = this->kinds();
  const bool planar = this->TheMesh.mesh().dimension() == Dimension::Planar;
  this->Leaving.assign(this->Found.kind.size(), 0);
  std::vector<unsigned char> onInterface = this->Leaving;
  const auto mark = [&](Index p, bool interface)
  { (interface ? onInterface : this->Leaving)[p] = 1; };
  for (const Features::Facet& facet : this->Found.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      mark(facet.nodes[k], facet.interface);
    }
  }
  for (const Features::Edge& edge : this->Found.edges)
  {
    if (planar)
    {
      mark(edge.first, edge.interface);
      mark(edge.second, edge.interface);
    }
  }
  for (std::size_t p = 0; p < this->Leaving.size(); ++p)
  {
    const bool chosen = !kinds.empty() && kinds[p] > PatchPoint;
    this->Leaving[p] = this->Leaving[p] && !onInterface[p] && !this->Held[p] && !chosen;
  }
  this->Constraints.leaving = this->Leaving.data();
}

//------------------------------------------------------------------------------
/// Determines which points slide on which part of the model, and which stay.
void BoundarySetup::holdPoints()
{
  const Mesh& mesh = this->TheMesh.mesh();
  const Features& found = this->Found;
  const bool surface = mesh.dimension() == Dimension::Surface;
  const bool onBoundary = surface || this->Properties.motion == BoundaryMotion::OnSurface;
  this->Parts = this->HasGeometry ? this->Match.parts : partsOfPoints(found);
  this->Held = this->TheMesh.fixed();
  BoundaryShape held;
  held.fixed.assign(found.kind.size(), 0);
  // Points on interfaces slide, except on a boundary that moves in another way.
  std::vector<char> onInterface(found.kind.size(), 0), outside(found.kind.size(), 0);
  for (const Features::Facet& facet : found.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      (facet.interface ? onInterface : outside)[facet.nodes[k]] = 1;
    }
  }
  for (const Features::Edge& edge : found.edges)
  {
    for (Index p : { edge.first, edge.second })
    {
      (edge.interface ? onInterface : outside)[p] |= mesh.dimension() == Dimension::Planar;
    }
  }
  for (std::size_t p = 0; p < found.kind.size(); ++p)
  {
    const bool slides = onBoundary || (onInterface[p] && !outside[p]);
    held.fixed[p] = slides ? found.kind[p] == CornerPoint : onInterface[p] && outside[p];
    this->Parts[p] = slides ? this->Parts[p] : -1;
  }
  // The border of a surface that slides on straight parts is fixed elsewhere, see setFixed().
  for (std::size_t i = 0; surface && i < this->Shape.lines.size(); ++i)
  {
    this->Shape.lines[i] = this->Shape.planes[i] = 0;
  }
  for (std::size_t p = 0; !surface && p < this->Parts.size() && !this->Shape.lines.empty(); ++p)
  {
    for (int c = 0; c < 3 && this->Parts[p] >= 0; ++c)
    {
      this->Shape.lines[3 * p + c] = this->Shape.planes[3 * p + c] = 0;
    }
  }
  this->TheMesh.fixCorners(held);
}

//------------------------------------------------------------------------------
void BoundarySetup::addFeatures(vtkDataSet* output) const
{
  if (!this->HasFeatures)
  {
    return;
  }
  std::vector<signed char> kind = this->Found.kind;
  std::vector<int> patch = this->Found.patchOf;
  const std::vector<Index>& one = this->TheMesh.representative();
  for (std::size_t p = 0; p < one.size(); ++p)
  {
    kind[p] = kind[one[p]];
    patch[p] = patch[one[p]];
  }
  addArray<vtkSignedCharArray>(output->GetPointData(), "FeatureKind", kind);
  addArray<vtkIntArray>(output->GetPointData(), "PatchId", patch);
  if (!this->Found.patchOfCell.empty())
  {
    addArray<vtkIntArray>(output->GetCellData(), "PatchId", this->Found.patchOfCell);
  }
}

//------------------------------------------------------------------------------
std::string BoundarySetup::describeFeatures() const
{
  if (!this->HasFeatures)
  {
    return "";
  }
  const auto count = [](Index n, const char* one, const char* many)
  { return std::to_string(n) + " " + (n == 1 ? one : many); };
  const std::string geometry = !this->HasGeometry
    ? ""
    : " The mesh has " + std::to_string(this->Match.corners) + " of " +
      count(this->Match.cornersOfGeometry, "corner", "corners") + " and " +
      std::to_string(this->Match.curves) + " of " +
      count(this->Match.curvesOfGeometry, "curve", "curves") + " of the Geometry.";
  return "Features: " + count(this->Found.corners, "corner", "corners") + ", " +
    count(this->Found.curves, "curve", "curves") + ", " +
    count(this->Found.patches, "patch", "patches") + "." + geometry;
}
}
