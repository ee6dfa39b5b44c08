#include "SolidMesher.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#ifndef TETLIBRARY
#define TETLIBRARY // errors are thrown
#endif
#include <tetgen.h>

namespace tautline
{
namespace
{
int narrow(Index value, const char* what)
{
  if (value < 0 || value > std::numeric_limits<int>::max())
  {
    throw Error(std::string("TetGen cannot count that many ") + what);
  }
  return static_cast<int>(value);
}

void checkBoundary(const SolidBoundary& boundary)
{
  const auto points = static_cast<Index>(boundary.points.size() / 3);
  for (std::size_t i = 0; i < boundary.points.size(); ++i)
  {
    if (!std::isfinite(boundary.points[i]))
    {
      throw Error(
        "point " + std::to_string(i / 3) + " has a coordinate that is not a finite number");
    }
  }
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    for (const std::vector<Index>& polygon : boundary.facets[f].polygons)
    {
      for (const Index id : polygon)
      {
        if (id < 0 || id >= points)
        {
          throw Error("facet " + std::to_string(f) + " has a point that does not exist");
        }
      }
    }
  }
  if (points < 4 || boundary.facets.size() < 4)
  {
    throw Error("a closed surface has at least 4 points and 4 facets, this one has " +
      std::to_string(points) + " and " + std::to_string(boundary.facets.size()));
  }
}

double* copy(const std::vector<double>& values)
{
  auto* memory = new REAL[values.size() + 1]; // tetgenio deletes it
  std::copy(values.begin(), values.end(), memory);
  return memory;
}

void setFacet(const SolidFacet& from, tetgenio::facet& to)
{
  tetgenio::init(&to);
  to.numberofpolygons = narrow(static_cast<Index>(from.polygons.size()), "polygons");
  to.polygonlist = new tetgenio::polygon[from.polygons.size()];
  for (std::size_t p = 0; p < from.polygons.size(); ++p)
  {
    tetgenio::polygon& polygon = to.polygonlist[p];
    tetgenio::init(&polygon);
    polygon.numberofvertices = narrow(static_cast<Index>(from.polygons[p].size()), "corners");
    polygon.vertexlist = new int[from.polygons[p].size()];
    std::transform(from.polygons[p].begin(), from.polygons[p].end(), polygon.vertexlist,
      [](Index id) { return static_cast<int>(id); });
  }
  if (!from.holes.empty())
  {
    to.numberofholes = narrow(static_cast<Index>(from.holes.size()), "holes");
    to.holelist = new REAL[3 * from.holes.size()];
    for (std::size_t h = 0; h < from.holes.size(); ++h)
    {
      std::copy(from.holes[h].begin(), from.holes[h].end(), to.holelist + 3 * h);
    }
  }
}

/// `numbers`: facets are marked by their number, from 1, instead of their marker.
void setInput(
  const SolidBoundary& boundary, const SolidOptions& options, bool numbers, tetgenio& in)
{
  in.numberofpoints = narrow(static_cast<Index>(boundary.points.size() / 3), "points");
  in.pointlist = copy(boundary.points);
  in.numberoffacets = narrow(static_cast<Index>(boundary.facets.size()), "facets");
  in.facetlist = new tetgenio::facet[boundary.facets.size()];
  in.facetmarkerlist = new int[boundary.facets.size()];
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    setFacet(boundary.facets[f], in.facetlist[f]);
    in.facetmarkerlist[f] = numbers ? static_cast<int>(f) + 1 : boundary.facets[f].marker;
  }
  if (!boundary.holes.empty())
  {
    in.numberofholes = narrow(static_cast<Index>(boundary.holes.size() / 3), "holes");
    in.holelist = copy(boundary.holes);
  }
  if (!options.regions.empty())
  {
    in.numberofregions = narrow(static_cast<Index>(options.regions.size() / 5), "regions");
    in.regionlist = copy(options.regions);
  }
  if (!options.pointSizes.empty())
  {
    if (options.pointSizes.size() != boundary.points.size() / 3)
    {
      throw Error("there must be one size for each point");
    }
    in.numberofpointmtrs = 1;
    in.pointmtrlist = copy(options.pointSizes);
  }
}

/// Runs TetGen; 0, or the number it throws.
int run(const std::string& switches, tetgenio& in, tetgenio& out)
{
  std::vector<char> text(switches.begin(), switches.end());
  text.push_back('\0');
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(text.data()))
  {
    return 10;
  }
  try
  {
    tetrahedralize(&behavior, &in, &out);
  }
  catch (const int code)
  {
    return code;
  }
  catch (const std::bad_alloc&)
  {
    return 1;
  }
  catch (...)
  {
    return 2;
  }
  return 0;
}

/// "facets 3, 17", those TetGen's search for intersections marks; empty if it finds none.
std::string intersectingFacets(const SolidBoundary& boundary, const SolidOptions& options)
{
  tetgenio in, out;
  setInput(boundary, options, true, in);
  in.numberofpointmtrs = 0;
  if (run("pdQz", in, out) != 0 || !out.trifacemarkerlist)
  {
    return {};
  }
  const std::set<int> numbers(out.trifacemarkerlist, out.trifacemarkerlist + out.numberoftrifaces);
  std::string list;
  int listed = 0;
  for (const int number : numbers)
  {
    if (number >= 1 && number <= static_cast<int>(boundary.facets.size()) && ++listed <= 10)
    {
      list += (list.empty() ? "facets " : ", ") + std::to_string(number - 1);
    }
  }
  return listed > 10 ? list + " and " + std::to_string(listed - 10) + " more" : list;
}

[[noreturn]] void fail(int code, const SolidBoundary& boundary, const SolidOptions& options)
{
  if (code == 1)
  {
    throw Error("TetGen: not enough memory; allow larger tetrahedra");
  }
  if (code == 3 || code == 4 || code == 5 || code == 2)
  {
    const std::string facets = intersectingFacets(boundary, options);
    if (!facets.empty())
    {
      throw Error("the surface intersects itself: " + facets + "; repair it, then mesh it");
    }
  }
  switch (code)
  {
    case 3:
      throw Error("TetGen: the surface intersects itself; repair it, then mesh it");
    case 4:
      throw Error(
        "TetGen: the surface has a very small feature; merge close points (Clean to Grid), "
        "then mesh it");
    case 5:
      throw Error("TetGen: two facets are very close; preserve the surface, or part them");
    case 10:
      throw Error("TetGen: the surface is no valid input");
    default:
      throw Error("TetGen failed (code " + std::to_string(code) +
        "): is the surface closed, without duplicate or degenerate facets?");
  }
}

std::string switchesFor(const SolidOptions& options)
{
  char text[128];
  std::string switches = "pzQ";
  if (options.radiusEdgeRatio > 0.0)
  {
    std::snprintf(
      text, sizeof(text), "q%.6g/%.6g", options.radiusEdgeRatio, options.minimumDihedralAngle);
    switches += text;
  }
  if (options.volume > 0.0)
  {
    std::snprintf(text, sizeof(text), "a%.15f", options.volume); // TetGen knows no exponents
    switches += text;
  }
  switches += options.regions.empty() ? "" : "Aa";
  switches += options.pointSizes.empty() ? "" : "m";
  switches += options.preserveSurface ? "Y" : "";
  return switches;
}
}

//------------------------------------------------------------------------------
SolidMesh meshSolid(const SolidBoundary& boundary, const SolidOptions& options)
{
  checkBoundary(boundary);
  if (options.radiusEdgeRatio != 0.0 && !(options.radiusEdgeRatio > 1.0))
  {
    throw Error("the ratio of radius and edge must be larger than 1, or 0 for none");
  }
  tetgenio in, out;
  setInput(boundary, options, false, in);
  const int code = run(switchesFor(options), in, out);
  if (code != 0)
  {
    fail(code, boundary, options);
  }
  if (out.numberoftetrahedra == 0)
  {
    throw Error(
      "there is nothing inside of the surface: is it closed, do the holes leave anything?");
  }
  SolidMesh mesh;
  mesh.points.assign(
    out.pointlist, out.pointlist + 3 * static_cast<std::ptrdiff_t>(out.numberofpoints));
  mesh.references.assign(static_cast<std::size_t>(out.numberoftetrahedra), 0);
  mesh.tetrahedra.reserve(4 * mesh.references.size());
  for (std::size_t t = 0; t < mesh.references.size(); ++t)
  {
    const int* corner = out.tetrahedronlist + t * static_cast<std::size_t>(out.numberofcorners);
    mesh.tetrahedra.insert(mesh.tetrahedra.end(), corner, corner + 4);
    if (out.numberoftetrahedronattributes > 0)
    {
      const std::size_t at = t * static_cast<std::size_t>(out.numberoftetrahedronattributes);
      mesh.references[t] = static_cast<int>(std::lround(out.tetrahedronattributelist[at]));
    }
  }
  const auto faces = static_cast<std::size_t>(out.numberoftrifaces);
  mesh.faces.assign(out.trifacelist, out.trifacelist + 3 * faces);
  mesh.faceMarkers.assign(faces, 1);
  mesh.pointMarkers.assign(mesh.points.size() / 3, 0);
  for (std::size_t i = 0; i < 3 * faces; ++i)
  {
    const int value = out.trifacemarkerlist ? out.trifacemarkerlist[i / 3] : 1;
    mesh.faceMarkers[i / 3] = value;
    int& marker = mesh.pointMarkers[static_cast<std::size_t>(mesh.faces[i])];
    marker = marker == 0 || (value != 0 && value < marker) ? value : marker;
  }
  return mesh;
}
}
