// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemMesh.h
 * @brief Reads the curved meshes of the tests that are in MFEM's format: one type of element, nodes
 * of a space H1 or L2.
 */
#ifndef tautline_MfemMesh_h
#define tautline_MfemMesh_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace tautline
{
struct MfemMesh
{
  std::vector<std::vector<Index>> elements; ///< vertices
  std::vector<std::vector<Index>> edges;    ///< of each element its edges, numbered as they come up
  Index vertices = 0, edgeCount = 0;
  std::string collection; ///< of finite elements
  std::vector<Vec3> nodes;
};

/// The edges of an element with so many vertices, in MFEM's order.
inline std::vector<std::array<int, 2>> mfemEdges(int dimension, std::size_t vertices)
{
  if (dimension == 2)
  {
    return vertices == 3
      ? std::vector<std::array<int, 2>>{ { 0, 1 }, { 1, 2 }, { 2, 0 } }
      : std::vector<std::array<int, 2>>{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } };
  }
  return { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
}

inline MfemMesh readMfemMesh(const std::string& name)
{
  MfemMesh mesh;
  std::ifstream file(name);
  int dimension = 0;
  std::string word;
  while (file >> word)
  {
    if (word == "dimension")
    {
      file >> dimension;
    }
    else if (word == "elements")
    {
      Index count = 0;
      file >> count;
      constexpr int corners[] = { 1, 2, 3, 4, 4, 8 }; // by MFEM's geometry
      for (Index n = 0; n < count; ++n)
      {
        int attribute = 0, geometry = 0;
        file >> attribute >> geometry;
        std::vector<Index>& element = mesh.elements.emplace_back(corners[geometry]);
        for (Index& v : element)
        {
          file >> v;
        }
      }
    }
    else if (word == "vertices")
    {
      file >> mesh.vertices;
    }
    else if (word == "FiniteElementCollection:")
    {
      int components = 0, ordering = 0;
      std::string key;
      file >> mesh.collection >> key >> components >> key >> ordering;
      std::vector<double> numbers;
      for (double x = 0; file >> x;)
      {
        numbers.push_back(x);
      }
      const std::size_t count = numbers.size() / components;
      for (std::size_t n = 0; n < count; ++n)
      {
        Vec3& node = mesh.nodes.emplace_back(Vec3{ 0, 0, 0 });
        for (int c = 0; c < components; ++c)
        {
          node[c] = numbers[ordering == 0 ? c * count + n : components * n + c];
        }
      }
    }
  }
  std::map<std::pair<Index, Index>, Index> numberOf;
  for (const std::vector<Index>& element : mesh.elements)
  {
    std::vector<Index>& edges = mesh.edges.emplace_back();
    for (const auto& [a, b] : mfemEdges(dimension, element.size()))
    {
      const auto key = std::minmax(element[a], element[b]);
      edges.push_back(numberOf.emplace(key, static_cast<Index>(numberOf.size())).first->second);
    }
  }
  mesh.edgeCount = static_cast<Index>(numberOf.size());
  return mesh;
}

/// The points of elements given by the numbers of their nodes.
inline std::vector<std::vector<Vec3>> pointsOf(
  const MfemMesh& mesh, const std::vector<std::vector<Index>>& nodes)
{
  std::vector<std::vector<Vec3>> elements;
  for (const std::vector<Index>& element : nodes)
  {
    std::vector<Vec3>& points = elements.emplace_back();
    for (Index n : element)
    {
      points.push_back(mesh.nodes.at(n));
    }
  }
  return elements;
}

/// The tetrahedra of a mesh of order 2, in VTK's order.
inline std::vector<std::vector<Vec3>> quadraticTetrahedra(const MfemMesh& mesh)
{
  std::vector<std::vector<Index>> nodes = mesh.elements;
  for (std::size_t e = 0; e < nodes.size(); ++e)
  {
    // MFEM's edges 01 02 03 12 13 23, VTK's 01 12 20 03 13 23.
    for (int edge : { 0, 3, 1, 2, 4, 5 })
    {
      nodes[e].push_back(mesh.vertices + mesh.edges[e][edge]);
    }
  }
  return pointsOf(mesh, nodes);
}
}

#endif
