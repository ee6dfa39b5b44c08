// SPDX-License-Identifier: BSD-3-Clause
// MFEM: nodes that are values of a polynomial arrive at its values at the nodes of VTK, whatever
// the space and however neighbors are turned; numbers of MFEM's own samples; errors.

#include "MeshFileChecks.h"
#include "MfemFile.h"
#include "Registry.h"

#include "vtkMfemReader.h"
#include "vtkNew.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace tautline;

namespace
{
std::string output;

constexpr int Triangles = 2, Squares = 3, Tetrahedra = 4, Cubes = 5, Prisms = 6;

/// A curved map of degree 2.
Vec3 curved(const Vec3& x)
{
  return { x[0] + 0.1 * x[1] * x[2] - 0.05 * x[0] * x[0], x[1] + 0.07 * x[0] * x[2],
    x[2] + 0.11 * x[0] * x[1] + 0.03 * x[2] * x[2] };
}

Vec3 curvedPlane(const Vec3& x)
{
  return { x[0] + 0.1 * x[1] * x[1], x[1] - 0.2 * x[0] * x[1], 0.0 };
}

/// Elements of one shape with straight vertices.
struct Sample
{
  int geometry;
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> elements;
};

/// The linear, or multilinear, position of a reference point.
Vec3 position(const Sample& sample, std::size_t element, const Vec3& at)
{
  const std::vector<int>& v = sample.elements[element];
  std::vector<double> share;
  if (sample.geometry == Tetrahedra || sample.geometry == Triangles)
  {
    share = { 1.0 - at[0] - at[1] - at[2], at[0], at[1], at[2] };
  }
  else if (sample.geometry == Prisms)
  {
    for (const double k : { 1.0 - at[2], at[2] })
    {
      share.insert(share.end(), { (1.0 - at[0] - at[1]) * k, at[0] * k, at[1] * k });
    }
  }
  else
  {
    for (const double k : { 1.0 - at[2], at[2] })
    {
      share.insert(share.end(),
        { (1.0 - at[0]) * (1.0 - at[1]) * k, at[0] * (1.0 - at[1]) * k, at[0] * at[1] * k,
          (1.0 - at[0]) * at[1] * k });
    }
  }
  Vec3 point = { 0.0, 0.0, 0.0 };
  for (std::size_t i = 0; i < v.size(); ++i)
  {
    point = point + share[i] * sample.vertices[static_cast<std::size_t>(v[i])];
  }
  return point;
}

/// The nodes of Lobatto on [0, 1], of order 3 and 4, by their known values.
double lobatto(int i, int order)
{
  const double inner = order == 3 ? std::sqrt(0.2) : std::sqrt(3.0 / 7.0);
  const std::vector<double> nodes = order == 3
    ? std::vector<double>{ -1.0, -inner, inner, 1.0 }
    : std::vector<double>{ -1.0, -inner, 0.0, inner, 1.0 };
  return 0.5 * (1.0 + nodes[static_cast<std::size_t>(i)]);
}

/// The node of MFEM's triangles and tetrahedra of a lattice place.
Vec3 simplexNode(const LatticePoint& place, int order)
{
  const double x = lobatto(place[0], order), y = lobatto(place[1], order);
  const double z = lobatto(place[2], order);
  const double w = x + y + z + lobatto(order - place[0] - place[1] - place[2], order);
  return { x / w, y / w, z / w };
}

std::string text(const std::vector<Vec3>& values, int dimension)
{
  std::ostringstream lines;
  lines.precision(17);
  for (const Vec3& value : values)
  {
    for (int c = 0; c < dimension; ++c)
    {
      lines << value[static_cast<std::size_t>(c)] << (c + 1 < dimension ? " " : "\n");
    }
  }
  return lines.str();
}

std::string header(const Sample& sample, const std::string& collection)
{
  const int dimension = sample.geometry < Tetrahedra ? 2 : 3;
  std::ostringstream lines;
  lines << "MFEM mesh v1.0\n# a comment\ndimension\n" << dimension << "\n\nelements\n";
  lines << sample.elements.size() << "\n";
  for (std::size_t e = 0; e < sample.elements.size(); ++e)
  {
    lines << e + 7 << ' ' << sample.geometry;
    for (const int vertex : sample.elements[e])
    {
      lines << ' ' << vertex;
    }
    lines << "\n";
  }
  lines << "\nboundary\n0\n\nvertices\n" << sample.vertices.size();
  lines << "\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: " << collection;
  lines << "\nVDim: " << dimension << "\nOrdering: 1\n\n";
  return lines.str();
}

/// The places of all nodes of the cells, one cell after the other.
std::vector<double> places(const MeshFile& mesh)
{
  std::vector<double> result;
  for (const Index point : mesh.connectivity)
  {
    result.insert(result.end(), &mesh.points[static_cast<std::size_t>(3 * point)],
      &mesh.points[static_cast<std::size_t>(3 * point)] + 3);
  }
  return result;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b)
{
  TAUTLINE_CHECK_EQUAL(a.size(), b.size());
  double largest = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// Written for MFEM, cells and attributes read back; as a copy of the file they came from, the file
/// is the same, and has other nodes where the mesh has moved.
void checkWritten(const MeshFile& mesh, const std::string& source, bool lowerCells)
{
  const std::string copy = output + "/copy.mesh";
  const bool periodic = !mesh.warnings.empty();
  for (const bool continuous : { true, false })
  {
    if (continuous && periodic)
    {
      continue;
    }
    writeMfem(mesh, copy, continuous);
    const MeshFile again = readMfem(copy, lowerCells);
    TAUTLINE_CHECK(again.cellTypes == mesh.cellTypes);
    TAUTLINE_CHECK_NEAR(largestDifference(places(again), places(mesh)), 0.0, 1e-13);
    TAUTLINE_CHECK(findArray(again.cellArrays, "Reference")->values ==
      findArray(mesh.cellArrays, "Reference")->values);
  }
  rewriteMfem(mesh, source, copy);
  TAUTLINE_CHECK(readText(copy) == readText(source));
  MeshFile moved = mesh;
  for (std::size_t i = 0; i < moved.points.size(); i += 3)
  {
    moved.points[i] += 0.01 * moved.points[i + 1] * moved.points[i + 1];
    moved.points[i + 1] -= 0.02 * moved.points[i];
  }
  rewriteMfem(moved, source, copy);
  const MeshFile again = readMfem(copy, lowerCells);
  TAUTLINE_CHECK(again.connectivity == mesh.connectivity);
  TAUTLINE_CHECK_NEAR(largestDifference(again.points, moved.points), 0.0, 1e-13);
}

MeshFile readLines(const std::string& lines, bool lowerCells = false)
{
  const std::string name = output + "/sample.mesh";
  writeText(name, lines);
  MeshFile mesh = readMfem(name, lowerCells);
  if (lines.find("FiniteElementSpace") != lines.npos)
  {
    checkWritten(mesh, name, lowerCells);
  }
  return mesh;
}

/// Whether each point of each cell is where the map has it.
void checkPoints(const MeshFile& mesh, const Sample& sample, Vec3 (*map)(const Vec3&))
{
  TAUTLINE_CHECK(mesh.cellTypes.size() >= sample.elements.size());
  double largest = 0.0;
  for (std::size_t cell = 0; cell < sample.elements.size(); ++cell)
  {
    const auto begin = static_cast<std::size_t>(mesh.offsets[cell]);
    const int nodes = static_cast<int>(mesh.offsets[cell + 1] - mesh.offsets[cell]);
    const ElementType& type = ElementType::ofVtk(mesh.cellTypes[cell], nodes);
    for (std::size_t i = 0; i < static_cast<std::size_t>(nodes); ++i)
    {
      Vec3 at = type.coordinates()[i];
      if (mesh.cellTypes[cell] == FileWedge18)
      {
        std::swap(at[0], at[1]);
      }
      const Vec3 expected = map(position(sample, cell, at));
      const double* found = mesh.points.data() + 3 * mesh.connectivity[begin + i];
      for (std::size_t c = 0; c < 3; ++c)
      {
        largest = std::max(largest, std::abs(found[c] - expected[c]));
      }
    }
  }
  TAUTLINE_CHECK_NEAR(largest, 0.0, 1e-13);
}

/// The lattice of a shape, the first coordinate fastest, as in MFEM's discontinuous spaces.
std::vector<LatticePoint> lattice(int geometry, int order)
{
  std::vector<LatticePoint> places;
  for (int k = 0; k <= (geometry < Tetrahedra ? 0 : order); ++k)
  {
    for (int j = 0; j <= order; ++j)
    {
      for (int i = 0; i <= order; ++i)
      {
        const bool triangle = geometry == Triangles || geometry == Prisms;
        const int sum = i + j + (geometry == Tetrahedra ? k : 0);
        if (sum <= order || !(triangle || geometry == Tetrahedra))
        {
          places.push_back({ i, j, k });
        }
      }
    }
  }
  return places;
}

/// A file of a discontinuous space with evenly spaced nodes.
std::string discontinuous(const Sample& sample, int order, Vec3 (*map)(const Vec3&))
{
  const int dimension = sample.geometry < Tetrahedra ? 2 : 3;
  std::vector<Vec3> values;
  for (std::size_t e = 0; e < sample.elements.size(); ++e)
  {
    for (const LatticePoint& place : lattice(sample.geometry, order))
    {
      values.push_back(map(position(sample, e,
        { static_cast<double>(place[0]) / order, static_cast<double>(place[1]) / order,
          static_cast<double>(place[2]) / order })));
    }
  }
  const std::string name = "L2_T4_" + std::to_string(dimension) + "D_P" + std::to_string(order);
  return header(sample, name) + text(values, dimension);
}

const std::array<std::array<int, 2>, 12> CubeEdges = { { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 },
  { 4, 5 }, { 5, 6 }, { 7, 6 }, { 4, 7 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } } };
const std::array<std::array<int, 4>, 6> CubeFaces = { { { 3, 2, 1, 0 }, { 0, 1, 5, 4 },
  { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 }, { 4, 5, 6, 7 } } };
const std::array<std::array<int, 2>, 6> TetrahedronEdges = { { { 0, 1 }, { 0, 2 }, { 0, 3 },
  { 1, 2 }, { 1, 3 }, { 2, 3 } } };
const std::array<std::array<int, 3>, 4> TetrahedronFaces = { { { 1, 2, 3 }, { 0, 3, 2 },
  { 0, 1, 3 }, { 0, 2, 1 } } };

Vec3 cubeCorner(int c)
{
  return { static_cast<double>(c % 4 == 1 || c % 4 == 2), static_cast<double>(c % 4 >= 2),
    static_cast<double>(c >= 4) };
}

/// The node of a face that node (i, j) of an element is, by MFEM's tables: `base` are the vertices
/// of the face in its first element, `own` those in this one.
int turnedSquareNode(const std::vector<int>& base, const std::vector<int>& own, int i, int j, int n)
{
  const auto start = std::find(own.begin(), own.end(), base[0]) - own.begin();
  const bool same = own[static_cast<std::size_t>((start + 1) % 4)] == base[1];
  const int m = n - 1;
  const int table[] = { i + j * n, j + i * n, j + (m - i) * n, (m - i) + j * n,
    (m - i) + (m - j) * n, (m - j) + (m - i) * n, (m - j) + i * n, i + (m - j) * n };
  return table[same ? 2 * start : 2 * start + 1];
}

int turnedTriangleNode(
  const std::vector<int>& base, const std::vector<int>& own, int i, int j, int p)
{
  const int k = p - 3 - i - j;
  int orientation = own[1] == base[0] ? 4 : 3;
  if (own[0] == base[0])
  {
    orientation = own[1] == base[1] ? 0 : 5;
  }
  else if (own[0] == base[1])
  {
    orientation = own[1] == base[0] ? 1 : 2;
  }
  const auto row = [p](int r) { return (p - 1) * (p - 2) / 2 - (p - 1 - r) * (p - 2 - r) / 2; };
  const int table[] = { row(j) + i, row(j) + k, row(i) + k, row(k) + i, row(k) + j, row(i) + j };
  return table[orientation];
}

/// The values of a continuous space by node; elements must agree.
class Numbered
{
public:
  void set(int node, const Vec3& value)
  {
    if (node >= static_cast<int>(this->Values.size()))
    {
      this->Values.resize(static_cast<std::size_t>(node) + 1, this->Unset);
    }
    Vec3& old = this->Values[static_cast<std::size_t>(node)];
    const Vec3 change = value - old;
    TAUTLINE_CHECK(old[0] == this->Unset[0] || std::sqrt(dot(change, change)) < 1e-12);
    old = value;
  }
  const std::vector<Vec3>& values() const { return this->Values; }

private:
  const Vec3 Unset = { 1e9, 1e9, 1e9 };
  std::vector<Vec3> Values;
};

/// The numbers of edges or faces, as they occur first.
class Entities
{
public:
  int number(const std::vector<int>& vertices)
  {
    std::vector<int> key = vertices;
    std::sort(key.begin(), key.end());
    const auto found = std::find(this->Keys.begin(), this->Keys.end(), key);
    if (found != this->Keys.end())
    {
      return static_cast<int>(found - this->Keys.begin());
    }
    this->Keys.push_back(key);
    this->First.push_back(vertices);
    return static_cast<int>(this->Keys.size()) - 1;
  }
  int size() const { return static_cast<int>(this->Keys.size()); }
  const std::vector<int>& first(int n) const { return this->First[static_cast<std::size_t>(n)]; }

private:
  std::vector<std::vector<int>> Keys, First;
};

/// A file of H1 in three dimensions, numbered by MFEM's tables of orientations.
template <class Edges, class Faces>
std::string continuous(const Sample& sample, int order, const Edges& edges, const Faces& faces)
{
  const bool cubes = sample.geometry == Cubes;
  Entities edgeNumbers, faceNumbers;
  const auto pick = [&](std::size_t e, const auto& corners)
  {
    std::vector<int> vertices;
    for (const int corner : corners)
    {
      vertices.push_back(sample.elements[e][static_cast<std::size_t>(corner)]);
    }
    return vertices;
  };
  for (std::size_t e = 0; e < sample.elements.size(); ++e)
  {
    for (const auto& edge : edges)
    {
      edgeNumbers.number(pick(e, edge));
    }
    for (const auto& face : faces)
    {
      faceNumbers.number(pick(e, face));
    }
  }
  const int n = order - 1;
  const int faceNodes = cubes ? n * n : n * (n - 1) / 2;
  const int firstEdge = static_cast<int>(sample.vertices.size());
  const int firstFace = firstEdge + edgeNumbers.size() * n;
  int inside = firstFace + faceNumbers.size() * faceNodes;
  // The place i steps from corner a to b and j steps from a to c.
  const auto between = [&](int a, int b, int c, int i, int j)
  {
    const auto corner = [&](int v, std::size_t x)
    { return cubes ? static_cast<int>(cubeCorner(v)[x]) : static_cast<int>(v == int(x) + 1); };
    LatticePoint place{};
    for (std::size_t x = 0; x < 3; ++x)
    {
      const int start = corner(a, x);
      place[x] = order * start + i * (corner(b, x) - start) + j * (corner(c, x) - start);
    }
    return place;
  };
  Numbered nodes;
  for (std::size_t e = 0; e < sample.elements.size(); ++e)
  {
    const auto valueAt = [&](const LatticePoint& place)
    {
      const Vec3 at = cubes
        ? Vec3{ lobatto(place[0], order), lobatto(place[1], order), lobatto(place[2], order) }
        : simplexNode(place, order);
      return curved(position(sample, e, at));
    };
    for (int c = 0; c < static_cast<int>(sample.elements[e].size()); ++c)
    {
      nodes.set(sample.elements[e][static_cast<std::size_t>(c)], valueAt(between(c, c, c, 0, 0)));
    }
    for (const auto& edge : edges)
    {
      const std::vector<int> own = pick(e, edge);
      for (int i = 1; i < order; ++i)
      {
        nodes.set(firstEdge + edgeNumbers.number(own) * n + (own[0] < own[1] ? i - 1 : n - i),
          valueAt(between(edge[0], edge[1], edge[0], i, 0)));
      }
    }
    for (const auto& face : faces)
    {
      const std::vector<int> own = pick(e, face);
      const int number = faceNumbers.number(own);
      const std::vector<int>& base = faceNumbers.first(number);
      for (int j = 1; j < order; ++j)
      {
        for (int i = 1; i < (cubes ? order : order - j); ++i)
        {
          const int node = cubes ? turnedSquareNode(base, own, i - 1, j - 1, n)
                                 : turnedTriangleNode(base, own, i - 1, j - 1, order);
          nodes.set(firstFace + number * faceNodes + node,
            valueAt(between(face[0], face[1], face.back(), i, j)));
        }
      }
    }
    for (const LatticePoint& place : lattice(sample.geometry, order))
    {
      const auto [low, high] = std::minmax_element(place.begin(), place.end());
      const int top = cubes ? *high : place[0] + place[1] + place[2];
      if (*low > 0 && top < order)
      {
        nodes.set(inside++, valueAt(place));
      }
    }
  }
  return header(sample, "H1_3D_P" + std::to_string(order)) + text(nodes.values(), 3);
}

/// The rotations of a cube, as orders of its corners.
std::vector<std::vector<int>> rotations()
{
  std::vector<std::vector<int>> found;
  std::array<std::size_t, 3> axis = { 0, 1, 2 };
  do
  {
    for (int flips = 0; flips < 8; ++flips)
    {
      std::vector<int> order(8);
      for (int c = 0; c < 8; ++c)
      {
        const Vec3 from = cubeCorner(c);
        Vec3 to{};
        for (std::size_t x = 0; x < 3; ++x)
        {
          to[axis[x]] = (flips >> x) & 1 ? 1.0 - from[x] : from[x];
        }
        int target = 0;
        while (dot(cubeCorner(target) - to, cubeCorner(target) - to) > 0.0)
        {
          ++target;
        }
        order[static_cast<std::size_t>(c)] = target;
      }
      const Vec3 a = cubeCorner(order[0]);
      if (dot(cross(cubeCorner(order[1]) - a, cubeCorner(order[3]) - a), cubeCorner(order[4]) - a) >
        0.0)
      {
        found.push_back(order);
      }
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return found;
}

TAUTLINE_PART(testTurnedCubes)
{
  Sample sample{ Cubes, {}, {} };
  for (int x = 0; x < 3; ++x)
  {
    for (const int c : { 0, 3, 7, 4 })
    {
      sample.vertices.push_back({ static_cast<double>(x), cubeCorner(c)[1], cubeCorner(c)[2] });
    }
  }
  const std::vector<int> left = { 0, 4, 5, 1, 3, 7, 6, 2 }, right = { 4, 8, 9, 5, 7, 11, 10, 6 };
  const std::vector<std::vector<int>> turns = rotations();
  TAUTLINE_CHECK(turns.size() == 24);
  for (const int order : { 3, 4 })
  {
    for (const std::vector<int>& turn : turns)
    {
      sample.elements = { left, {} };
      for (const int corner : turn)
      {
        sample.elements[1].push_back(right[static_cast<std::size_t>(corner)]);
      }
      const MeshFile mesh = readLines(continuous(sample, order, CubeEdges, CubeFaces));
      checkPoints(mesh, sample, curved);
      TAUTLINE_CHECK(mesh.numberOfPoints() == (2 * order + 1) * (order + 1) * (order + 1));
      TAUTLINE_CHECK(mesh.cellTypes[0] == FileLagrangeHexahedron && mesh.warnings.empty());
    }
  }
}

TAUTLINE_PART(testTurnedTetrahedra)
{
  Sample sample{ Tetrahedra, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 1 } },
    {} };
  for (const int order : { 3, 4 })
  {
    std::vector<int> second = { 1, 2, 3, 4 };
    do
    {
      sample.elements = { { 0, 1, 2, 3 }, second };
      const MeshFile mesh =
        readLines(continuous(sample, order, TetrahedronEdges, TetrahedronFaces));
      checkPoints(mesh, sample, curved);
      const Index face = (order + 1) * (order + 2) / 2;
      TAUTLINE_CHECK(mesh.numberOfPoints() == 2 * (face * (order + 3) / 3) - face);
    } while (std::next_permutation(second.begin(), second.end()));
  }
}

TAUTLINE_PART(testDiscontinuousSpaces)
{
  Sample cube{ Cubes, {}, { { 0, 1, 2, 3, 4, 5, 6, 7 } } };
  for (int c = 0; c < 8; ++c)
  {
    cube.vertices.push_back(cubeCorner(c));
  }
  const Sample prism{ Prisms,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } },
    { { 0, 1, 2, 3, 4, 5 } } };
  const Sample tetrahedron{ Tetrahedra, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    { { 0, 1, 2, 3 } } };
  const Sample square{ Squares,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 2, 1, 0 } },
    { { 0, 1, 2, 3 }, { 4, 5, 2, 1 } } };
  const Sample triangle{ Triangles, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } },
    { { 0, 1, 2 }, { 3, 2, 1 } } };
  for (const int order : { 2, 3, 4 })
  {
    for (const Sample& sample : { cube, prism, tetrahedron })
    {
      checkPoints(readLines(discontinuous(sample, order, curved)), sample, curved);
    }
    for (const Sample& sample : { square, triangle })
    {
      const MeshFile mesh = readLines(discontinuous(sample, order, curvedPlane));
      checkPoints(mesh, sample, curvedPlane);
      // Nodes of the common edge are one point.
      TAUTLINE_CHECK(mesh.numberOfPoints() == mesh.offsets.back() - (order + 1));
    }
  }
}

const char* const Straight = "MFEM mesh v1.0\ndimension\n2\nelements\n1\n5 3 0 1 2 3\nboundary\n1\n"
                             "8 1 0 1\nvertices\n4\n2\n0 0\n1 0\n1 1\n0 1\n";

TAUTLINE_PART(testStraight)
{
  const MeshFile mesh = readLines(Straight, true);
  TAUTLINE_CHECK(mesh.numberOfPoints() == 4 && mesh.numberOfCells() == 2);
  TAUTLINE_CHECK(mesh.cellTypes[0] == FileQuadrilateral && mesh.cellTypes[1] == FileLine);
  const MeshArray* reference = findArray(mesh.cellArrays, "Reference");
  TAUTLINE_CHECK(reference && reference->at(0) == 5.0 && reference->at(1) == 8.0);
  TAUTLINE_CHECK(mesh.points[6] == 1.0 && mesh.points[7] == 1.0 && mesh.points[8] == 0.0);
}

/// Each straight shape lists its vertices as VTK does, except the wedge.
TAUTLINE_PART(testStraightVolumes)
{
  const MeshFile mesh = readLines("MFEM mesh v1.0\ndimension\n3\nelements\n4\n1 4 0 1 2 3\n"
                                  "2 7 0 1 2 4 5\n3 6 0 1 2 3 4 5\n4 5 0 1 2 3 4 5 6 7\n"
                                  "boundary\n1\n1 2 0 1 2\nvertices\n8\n3\n0 0 0\n1 0 0\n2 0 0\n"
                                  "3 0 0\n4 0 0\n5 0 0\n6 0 0\n7 0 0\n",
    true);
  const unsigned char types[] = { FileTetrahedron, FilePyramid, FileWedge, FileHexahedron,
    FileTriangle };
  TAUTLINE_CHECK(std::equal(mesh.cellTypes.begin(), mesh.cellTypes.end(), types, types + 5));
  std::vector<double> vertices;
  for (const Index point : mesh.connectivity)
  {
    vertices.push_back(mesh.points[static_cast<std::size_t>(3 * point)]);
  }
  TAUTLINE_CHECK(vertices ==
    std::vector<double>(
      { 0, 1, 2, 3, 0, 1, 2, 4, 5, 0, 2, 1, 3, 5, 4, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2 }));
}

/// A periodic strip: the ends have the same vertices at different places.
TAUTLINE_PART(testPeriodic)
{
  std::string lines = "MFEM mesh v1.0\ndimension\n2\nelements\n3\n1 3 0 1 3 2\n1 3 1 4 5 3\n"
                      "1 3 4 0 2 5\nboundary\n0\nvertices\n6\nnodes\nFiniteElementSpace\n"
                      "FiniteElementCollection: L2_T1_2D_P1\nVDim: 2\nOrdering: 1\n";
  for (int e = 0; e < 3; ++e)
  {
    for (const char* y : { "0", "1" })
    {
      lines += std::to_string(e) + " " + y + "\n" + std::to_string(e + 1) + " " + y + "\n";
    }
  }
  const MeshFile mesh = readLines(lines);
  TAUTLINE_CHECK(mesh.numberOfPoints() == 8 && mesh.warnings.size() == 1);
}

bool fails(const std::string& lines, const std::string& expected)
{
  try
  {
    readLines(lines, true);
  }
  catch (const FileError& error)
  {
    const std::string message = error.what();
    std::cerr << (message.find(expected) == message.npos ? message + "\n" : "");
    return message.find(expected) != message.npos;
  }
  std::cerr << "no error: " << expected << "\n";
  return false;
}

std::string replaced(std::string lines, const std::string& old, const std::string& by)
{
  const std::size_t at = lines.find(old);
  TAUTLINE_CHECK(at != lines.npos);
  return lines.replace(at, old.size(), by);
}

TAUTLINE_PART(testErrors)
{
  const std::string straight = Straight;
  TAUTLINE_CHECK(fails("", "ends"));
  TAUTLINE_CHECK(fails(replaced(straight, "mesh v1.0", "NC mesh v1.0"), "conforming"));
  TAUTLINE_CHECK(fails(replaced(straight, "mesh v1.0", "NURBS mesh v1.0"), "SetCurvature"));
  TAUTLINE_CHECK(fails(replaced(straight, "dimension\n2", "dimension\n1"), "lines"));
  TAUTLINE_CHECK(fails(replaced(straight, "elements\n1", "elements\n1000000"), "rest of the file"));
  TAUTLINE_CHECK(fails(replaced(straight, "5 3 0", "5 9 0"), "geometry"));
  TAUTLINE_CHECK(fails(replaced(straight, "5 3 0 1 2 3", "5 4 0 1 2 3"), "tetrahedron"));
  TAUTLINE_CHECK(fails(replaced(straight, "1 2 3\n", "1 2 4\n"), "vertex 4"));
  TAUTLINE_CHECK(fails(replaced(straight, "1 1\n0 1", "1 nan\n0 1"), "finite"));
  TAUTLINE_CHECK(fails(straight + "7\n", "continues"));
  TAUTLINE_CHECK(fails(straight.substr(0, straight.size() - 4), "rest of the file"));
  const Sample one{ Squares, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
    { { 0, 1, 2, 3 } } };
  const std::string lines = discontinuous(one, 2, curvedPlane);
  TAUTLINE_CHECK(readLines(lines).numberOfPoints() == 9);
  TAUTLINE_CHECK(fails(replaced(lines, "L2_T4_2D_P2", "L2_T4_2D_P9"), "order"));
  TAUTLINE_CHECK(fails(replaced(lines, "L2_T4_2D_P2", "L2_T4_3D_P2"), "collection"));
  TAUTLINE_CHECK(fails(replaced(lines, "L2_T4_2D_P2", "NURBS2"), "collection"));
  TAUTLINE_CHECK(fails(replaced(lines, "L2_T4_2D_P2", "L2_T4_2D_P3"), "of 32"));
  TAUTLINE_CHECK(fails(replaced(lines, "VDim: 2", "VDim: 1"), "coordinates"));
  TAUTLINE_CHECK(fails(replaced(lines, "3 0 1 2 3", "3 0 1 2 0"), "twice"));
  TAUTLINE_CHECK(fails(replaced(lines, "boundary\n0\n", "boundary\n1\n1 1 0 2\n"), "side"));
}

/// One cube with nodes at the places of Gauss-Legendre, or with Bernstein coefficients, of order 2.
TAUTLINE_PART(testOtherBases)
{
  Sample cube{ Cubes, {}, { { 0, 1, 2, 3, 4, 5, 6, 7 } } };
  for (int c = 0; c < 8; ++c)
  {
    cube.vertices.push_back(cubeCorner(c));
  }
  constexpr int order = 2;
  const double inner = std::sqrt(0.6);
  const std::array<double, 3> gauss = { 0.5 * (1.0 - inner), 0.5, 0.5 * (1.0 + inner) };
  std::vector<Vec3> values, coefficients;
  for (const LatticePoint& place : lattice(Cubes, order))
  {
    const auto at = [&](std::size_t axis) { return gauss[static_cast<std::size_t>(place[axis])]; };
    values.push_back(curved({ at(0), at(1), at(2) }));
    // The coefficients of x are 0, 1/2, 1, of x^2 they are 0, 0, 1; products are of other axes.
    const Vec3 linear = { 0.5 * place[0], 0.5 * place[1], 0.5 * place[2] };
    const auto square = [&](std::size_t axis) { return place[axis] == order ? 1.0 : 0.0; };
    coefficients.push_back({ linear[0] + 0.1 * linear[1] * linear[2] - 0.05 * square(0),
      linear[1] + 0.07 * linear[0] * linear[2],
      linear[2] + 0.11 * linear[0] * linear[1] + 0.03 * square(2) });
  }
  checkPoints(readLines(header(cube, "L2_3D_P2") + text(values, 3)), cube, curved);
  checkPoints(readLines(header(cube, "L2_T0_3D_P2") + text(values, 3)), cube, curved);
  checkPoints(readLines(header(cube, "L2_T2_3D_P2") + text(coefficients, 3)), cube, curved);
}

/// Files of MFEM: points, cells of each dimension, orders.
TAUTLINE_PART(testSamplesOfMfem)
{
  const std::string folder = externalData("curved");
  struct Expected
  {
    const char* name;
    Index points;
    std::size_t cells;
    std::size_t boundary;
    unsigned char type;
  };
  const Expected files[] = { { "jagged.mesh", 325, 18, 18, FileLagrangeQuadrilateral },
    { "icf.mesh", 965, 224, 100, FileQuadrilateral9 },
    { "blade.mesh", 1860, 109, 58, FileLagrangeQuadrilateral },
    { "cube-holes-inv.mesh", 6605, 3782, 1660, FileTetrahedron10 } };
  for (const Expected& file : files)
  {
    const MeshFile mesh = readMfem(folder + "/" + file.name, true);
    TAUTLINE_CHECK(mesh.numberOfPoints() == file.points);
    TAUTLINE_CHECK(mesh.cellTypes.size() == file.cells + file.boundary);
    TAUTLINE_CHECK(mesh.cellTypes[0] == file.type && mesh.warnings.empty());
    vtkNew<vtkMfemReader> reader;
    reader->SetFileName((folder + "/" + file.name).c_str());
    TAUTLINE_CHECK(reader->CanReadFile(reader->GetFileName()) == 1);
    reader->Update();
    TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == static_cast<vtkIdType>(file.cells));
  }
}
}

TAUTLINE_TEST(TestMfemFiles)
{
  output = argv[2];
}
