// SPDX-License-Identifier: BSD-3-Clause
#include "BoundarySurface.h"

#include "Constants.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/Features.h"

#include <map>

namespace tautline
{
namespace
{

double diagonalOf(const std::vector<std::array<Vec3, 3>>& pieces)
{
  Vec3 low = pieces.front()[0], high = low;
  for (const auto& piece : pieces)
  {
    for (const Vec3& x : piece)
    {
      for (int k = 0; k < 3; ++k)
      {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    }
  }
  return norm(high - low);
}

/// The outer facets, in the order of TetrahedronMesh::face().
SurfacePart boundaryOf(const TetrahedronMesh& mesh)
{
  SurfacePart part;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    for (int i = 0; i < 4 && mesh.alive(t); ++i)
    {
      if (mesh.tet(t).neighbors[i] == NoId)
      {
        const TriangleVertices f = mesh.face(t, i);
        part.pieces.push_back({ mesh.point(f[0]), mesh.point(f[1]), mesh.point(f[2]) });
      }
    }
  }
  return part;
}

/// The points of facets between regions.
std::vector<char> interfacePoints(const TetrahedronMesh& mesh)
{
  std::vector<char> flags(mesh.pointSlots(), 0);
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (mesh.isWall(t, i) && mesh.tet(t).neighbors[i] != NoId)
      {
        for (PointId v : mesh.face(t, i))
        {
          flags[v] = 1;
        }
      }
    }
  }
  return flags;
}

bool isEvenPermutation(const TriangleVertices& f, const std::array<Index, MaxFaceNodes>& nodes)
{
  const int at = f[0] == nodes[0] ? 0 : (f[1] == nodes[0] ? 1 : 2);
  return f[(at + 1) % 3] == nodes[1];
}

/// 1 if the facets are in the order of TetrahedronMesh::face(), else -1.
double senseOf(const TetrahedronMesh& mesh, const Features& features)
{
  const auto& nodes = features.facets.front().nodes;
  std::array<Index, 3> wanted = { nodes[0], nodes[1], nodes[2] };
  std::sort(wanted.begin(), wanted.end());
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices f = mesh.face(t, i);
      std::array<Index, 3> key = { f[0], f[1], f[2] };
      std::sort(key.begin(), key.end());
      if (mesh.tet(t).neighbors[i] == NoId && key == wanted)
      {
        return isEvenPermutation(f, nodes) ? 1.0 : -1.0;
      }
    }
  }
  return 1.0;
}
}

BoundarySurface::BoundarySurface(
  const Mesh& mesh, const TetrahedronMesh& changing, const ReconnectionOptions& options)
  : Cosine(std::cos(options.surfaceAngle * (Pi / 180.0)))
{
  FeatureOptions wanted;
  wanted.angle = options.featureAngle;
  const Features features = findFeatures(mesh, wanted);
  const SurfaceModel model = makeSurfaceModel(mesh, features, false);
  for (const SurfacePart& part : model.parts)
  {
    this->Parts.emplace_back(part, nullptr);
  }
  const SurfacePart boundary = boundaryOf(changing);
  this->Patches = model.patches;
  this->Distance = std::max(options.surfaceDistance, LeastDistance) * diagonalOf(boundary.pieces);
  this->Whole.emplace_back(boundary, nullptr);
  this->Sense = senseOf(changing, features);

  // The patches that each point touches.
  std::vector<std::vector<std::int32_t>> touched(changing.pointSlots());
  for (const Features::Facet& facet : features.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      std::vector<std::int32_t>& set = touched[facet.nodes[k]];
      const auto at = std::lower_bound(set.begin(), set.end(), facet.patch);
      if (at == set.end() || *at != facet.patch)
      {
        set.insert(at, facet.patch);
      }
    }
  }
  std::map<std::vector<std::int32_t>, std::int32_t> known;
  const auto numberOf = [&](const std::vector<std::int32_t>& set)
  {
    const auto [entry, isNew] = known.insert({ set, static_cast<std::int32_t>(this->Sets.size()) });
    if (isNew)
    {
      this->Sets.push_back(set);
    }
    return entry->second;
  };
  for (std::int32_t patch = 0; patch < this->Patches; ++patch)
  {
    numberOf({ patch });
  }
  const std::vector<char> interface = interfacePoints(changing);
  const std::vector<std::int32_t> parts = partsOfPoints(features);
  this->Freedoms.resize(changing.pointSlots());
  for (PointId v = 0; v < changing.pointSlots(); ++v)
  {
    PointFreedom& freedom = this->Freedoms[v];
    if (!touched[v].empty())
    {
      freedom.patches = numberOf(touched[v]);
      freedom.part = interface[v] ? NoId : parts[v];
      freedom.kind = freedom.part == NoId ? PointFreedom::Fixed
        : freedom.part < this->Patches    ? PointFreedom::InPlane
                                          : PointFreedom::OnLine;
    }
    else if (interface[v])
    {
      freedom.kind = PointFreedom::Fixed;
    }
  }
}

PointFreedom BoundarySurface::at(const Vec3& x, PointFreedom freedom) const
{
  freedom.direction = this->Parts[freedom.part].direction(x);
  return freedom;
}

PointFreedom BoundarySurface::inPatch(int patch) const
{
  return { PointFreedom::InPlane, { 0, 0, 0 }, patch, patch };
}

bool BoundarySurface::touches(const PointFreedom& freedom, int patch) const
{
  return freedom.patches != NoId &&
    std::binary_search(
      this->Sets[freedom.patches].begin(), this->Sets[freedom.patches].end(), patch);
}

int BoundarySurface::patchOf(
  const std::array<Vec3, 3>& x, const std::array<PointFreedom, 3>& freedoms) const
{
  if (freedoms[0].patches == NoId)
  {
    return NoId;
  }
  int best = NoId;
  double smallest = 0.0;
  const Vec3 centre = (1.0 / 3.0) * (x[0] + x[1] + x[2]);
  const std::vector<std::int32_t>& candidates = this->Sets[freedoms[0].patches];
  for (std::int32_t patch : candidates)
  {
    if (!this->touches(freedoms[1], patch) || !this->touches(freedoms[2], patch))
    {
      continue;
    }
    // The distance decides only where there is a choice.
    const Vec3 d = candidates.size() > 1 ? this->Parts[patch].closest(centre) - centre : Vec3();
    if (best == NoId || dot(d, d) < smallest)
    {
      best = patch;
      smallest = dot(d, d);
    }
  }
  return best;
}

bool BoundarySurface::accepts(const std::array<Vec3, 3>& x, int patch) const
{
  const SurfaceProjection& surface = this->Parts[patch];
  const auto& [a, b, c] = x;
  const Vec3 normal = this->Sense * cross(b - a, c - a);
  // The mean normal: slivers of the input may be turned anywhere.
  Vec3 below = { 0, 0, 0 };
  for (const Vec3& p : { (1.0 / 3.0) * (a + b + c), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a) })
  {
    if (!(norm(surface.closest(p) - p) <= this->Distance))
    {
      return false;
    }
    below += surface.direction(p);
  }
  return dot(normal, below) >= this->Cosine * norm(normal) * norm(below);
}

double BoundarySurface::distance(const TetrahedronMesh& changed) const
{
  const SurfaceProjection now(boundaryOf(changed), nullptr);
  return std::max(now.distanceTo(this->Whole.front()), this->Whole.front().distanceTo(now));
}
}
