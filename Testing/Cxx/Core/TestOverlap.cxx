// SPDX-License-Identifier: BSD-3-Clause
// Parts of a mesh that overlap: copies of cells count once and their points move alike, in both
// orders; parts on top of each other with other cells are kept apart, or rejected.
#include "Registry.h"
#include "Seams.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/CellCopies.h"
#include "tautline/Mesh/CoincidentPoints.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"

using namespace tautline;

namespace
{
constexpr double Middle = 3.0; ///< of a block of 6 cells each way

const auto types = { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
  CellType::Hexahedron };

/// A mesh in two pieces with points of their own, and the mesh without copies.
struct Overlapping
{
  MeshData whole, pieces;
  std::vector<Index> pointOf; ///< per point of the pieces: its number in the whole mesh

  void add(const RankPart& part)
  {
    const Index first = this->pieces.numberOfPoints();
    for (Index p = 0; p < part.data.numberOfPoints(); ++p)
    {
      this->pieces.addPoint(part.data.point(p));
    }
    for (Index cell = 0; cell < part.data.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes = part.data.nodes(cell);
      for (Index& node : nodes)
      {
        node += first;
      }
      this->pieces.addCell(static_cast<int>(part.data.types[cell]), nodes);
    }
    this->pointOf.insert(this->pointOf.end(), part.pointOf.begin(), part.pointOf.end());
  }
};

/// Halves with a layer of cells of the other one each, or the mesh and a copy of it.
Overlapping overlapping(const MeshData& whole, bool twice)
{
  Overlapping both = { whole, {}, {} };
  for (int piece = 0; piece < 2; ++piece)
  {
    both.add(partOf(
      whole, piece,
      [&](Index cell) { return twice ? piece : int(centerOf(whole, cell)[0] > Middle); }, true));
  }
  return both;
}

/// A mesh and a copy of it with other points inside.
Overlapping onTopOfEachOther(CellType type)
{
  Overlapping both =
    overlapping(blockMesh(type, 6, 6, topology(type).dimension == 3 ? 6 : 0), true);
  const std::vector<char> boundary = Mesh(both.whole.view()).boundary().isBoundaryPoint;
  Random random(4);
  for (Index p = both.whole.numberOfPoints(); p < both.pieces.numberOfPoints(); ++p)
  {
    for (int c = 0; c < topology(type).dimension && !boundary[both.pointOf[p]]; ++c)
    {
      both.pieces.points[3 * p + c] += random.uniform(-0.2, 0.2);
    }
  }
  return both;
}

/// The points move as in the whole mesh.
template <class Filter, class Set>
void checkAlike(const Overlapping& both, bool exact, bool boundaryStays, const Set& set)
{
  vtkNew<Filter> pieces, whole;
  Messages messages(pieces);
  set(pieces.Get());
  set(whole.Get());
  TAUTLINE_SET(pieces, SetInputDataObject(0, toGrid(both.pieces)), Update());
  TAUTLINE_SET(whole, SetInputDataObject(0, toGrid(both.whole)), Update());
  TAUTLINE_CHECK(!messages.has("ERROR: "));
  TAUTLINE_CHECK(contains(pieces->GetSummary(), wording("they-count-once")));
  TAUTLINE_CHECK(!contains(whole->GetSummary(), wording("they-count-once")));
  TAUTLINE_CHECK_EQUAL(pieces->GetInvertedAfter(), whole->GetInvertedAfter());
  const std::vector<char> boundary = Mesh(both.whole.view()).boundary().isBoundaryPoint;
  std::vector<Vec3> first(both.whole.numberOfPoints(), Vec3{ HUGE_VAL, 0, 0 });
  double apart = 0, far = 0, moved = 0;
  for (Index p = 0; p < both.pieces.numberOfPoints(); ++p)
  {
    Vec3 x, expected;
    const Index of = both.pointOf[p];
    pointsOf(pieces)->GetPoint(p, x.data());
    pointsOf(whole)->GetPoint(of, expected.data());
    first[of] = first[of][0] == HUGE_VAL ? x : first[of];
    apart = std::max(apart, norm(x - first[of]));
    far = std::max(far, norm(x - expected));
    moved = std::max(moved, norm(x - both.pieces.point(p)));
    TAUTLINE_CHECK(!boundaryStays || !boundary[of] || x == both.pieces.point(p));
  }
  TAUTLINE_CHECK_EQUAL(apart, 0.0);
  TAUTLINE_CHECK(far <= (exact ? 1e-12 : 0.1));
  TAUTLINE_CHECK(moved > 0.05);
}

TAUTLINE_PART(testOptimize)
{
  for (const CellType type : types)
  {
    for (const bool twice : { false, true })
    {
      const Overlapping both = overlapping(rough(type, 6), twice);
      for (const bool reproducible : { false, true })
      {
        for (const int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING })
        {
          for (const int preset : { vtkMeshOptimizer::BEST_SHAPE, vtkMeshOptimizer::FAST_CLEAN_UP,
                 vtkMeshOptimizer::WORST_ELEMENT })
          {
            const Context context(std::string(topology(type).name) + (twice ? " twice" : " layer") +
              (reproducible ? " reproducible" : " own") + " boundary " + std::to_string(boundary) +
              " preset " + std::to_string(preset));
            const bool exact = reproducible && preset != vtkMeshOptimizer::WORST_ELEMENT;
            checkAlike<vtkMeshOptimizer>(both, exact, boundary == vtkMeshOptimizer::FIXED,
              [&](vtkMeshOptimizer* filter)
              {
                filter->SetBoundary(boundary);
                filter->SetPreset(preset);
                filter->SetReproducibleOrder(exact);
              });
          }
        }
      }
    }
  }
}

TAUTLINE_PART(testUntangle)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    for (const bool twice : { false, true })
    {
      const Overlapping both = overlapping(rough(type, 6, 0.6), twice);
      for (const bool reproducible : { false, true })
      {
        const Context context(std::string(topology(type).name) + (twice ? " twice" : " layer"));
        vtkNew<vtkMeshUntangler> pieces, whole;
        for (auto* filter : { pieces.Get(), whole.Get() })
        {
          filter->SetReproducibleOrder(reproducible);
        }
        TAUTLINE_SET(pieces, SetInputDataObject(0, toGrid(both.pieces)), Update());
        TAUTLINE_SET(whole, SetInputDataObject(0, toGrid(both.whole)), Update());
        TAUTLINE_CHECK(whole->GetInvertedBefore() > 0);
        TAUTLINE_CHECK_EQUAL(pieces->GetInvertedBefore(), whole->GetInvertedBefore());
        TAUTLINE_CHECK_EQUAL(pieces->GetInvertedAfter(), 0);
      }
    }
  }
}

TAUTLINE_PART(testPerturb)
{
  const Overlapping both = overlapping(rough(CellType::Triangle, 6, 0.1), false);
  TAUTLINE_NEW(vtkMeshPerturbation, filter, SetPercentage(100),
    SetInputDataObject(0, toGrid(both.pieces)), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("they-count-once")));
  std::vector<Vec3> first(both.whole.numberOfPoints(), Vec3{ HUGE_VAL, 0, 0 });
  for (Index p = 0; p < both.pieces.numberOfPoints(); ++p)
  {
    Vec3 x;
    Vec3& known = first[both.pointOf[p]];
    pointsOf(filter)->GetPoint(p, x.data());
    known = known[0] == HUGE_VAL ? x : known;
    TAUTLINE_CHECK(x == known);
  }
}

/// Other cells at the same boundary: apart in the own order, an error in the reproducible one.
TAUTLINE_PART(testOtherCells)
{
  for (const CellType type : types)
  {
    const Context context(topology(type).name);
    const Overlapping both = onTopOfEachOther(type);
    const std::vector<char> boundary = Mesh(both.pieces.view()).boundary().isBoundaryPoint;
    vtkNew<vtkMeshOptimizer> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputDataObject(0, toGrid(both.pieces)), Update());
    TAUTLINE_CHECK(messages.empty());
    for (Index p = 0; p < both.pieces.numberOfPoints(); ++p)
    {
      Vec3 x;
      pointsOf(filter)->GetPoint(p, x.data());
      TAUTLINE_CHECK(!boundary[p] || x == both.pieces.point(p));
    }
    TAUTLINE_SET(filter, ReproducibleOrderOn(), Update());
    TAUTLINE_CHECK(messages.has(wording("two-elements-on-the-same-side")));

    // With common points on the boundary, in both orders.
    MeshData joined = both.pieces;
    const std::vector<char> on = Mesh(both.whole.view()).boundary().isBoundaryPoint;
    std::map<Index, Index> first; // of the points of the whole mesh
    for (Index p = 0; p < both.pieces.numberOfPoints(); ++p)
    {
      first.emplace(both.pointOf[p], p);
    }
    for (Index& node : joined.connectivity)
    {
      node = on[both.pointOf[node]] ? first[both.pointOf[node]] : node;
    }
    for (const bool reproducible : { false, true })
    {
      vtkNew<vtkMeshOptimizer> one;
      Messages errors(one);
      TAUTLINE_SET(
        one, SetReproducibleOrder(reproducible), SetInputDataObject(0, toGrid(joined)), Update());
      TAUTLINE_CHECK(errors.has(wording("two-elements-on-the-same-side")));
    }
  }
}

/// A cell that begins with another point is a copy, its mirror image is none.
TAUTLINE_PART(testSenses)
{
  for (const CellType type : types)
  {
    const CellTopology& t = topology(type);
    std::vector<Index> a(t.nodes), turned, mirrored;
    std::iota(a.begin(), a.end(), Index(0));
    turned = mirrored = a;
    if (t.dimension == 2)
    {
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      std::reverse(mirrored.begin(), mirrored.end());
    }
    else if (t.nodes == 4)
    {
      std::rotate(turned.begin(), turned.begin() + 1, turned.begin() + 3);
      std::swap(mirrored[0], mirrored[1]);
    }
    else
    {
      std::rotate(turned.begin(), turned.begin() + 1, turned.begin() + 4);
      std::rotate(turned.begin() + 4, turned.begin() + 5, turned.end());
      std::swap_ranges(mirrored.begin(), mirrored.begin() + 4, mirrored.begin() + 4);
    }
    TAUTLINE_CHECK(sameFacets(type, a.data(), a.data()));
    TAUTLINE_CHECK(sameFacets(type, a.data(), turned.data()));
    TAUTLINE_CHECK(!sameFacets(type, a.data(), mirrored.data()));
    TAUTLINE_CHECK(sameFacets(type, a.data(), mirrored.data(), true));
    std::swap(turned[0], turned[t.nodes - 1]);
    TAUTLINE_CHECK(!sameFacets(type, a.data(), turned.data()));
  }
}
}
