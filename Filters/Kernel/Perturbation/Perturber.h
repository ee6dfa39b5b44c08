// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Perturber.h
 * @brief The state of a random motion of the points of a mesh.
 * Internal: not installed.
 */
#ifndef tautline_Perturber_h
#define tautline_Perturber_h

#include "PerturbOptions.h"

#include "tautline/Core/Random.h"
#include "tautline/Mesh/Mesh.h"

#include <algorithm>

namespace tautline
{
/// Purposes of the random numbers of a vertex; each has its own stream.
enum Stream : std::uint64_t
{
  ChooseVertex = 1,
  MoveVertex,
  OrderTangling,
  TangleVertex // and above: one stream per pass
};

/// Throws Error for options out of range and for cells of higher order.
void checkPerturbation(const Mesh& mesh, const PerturbOptions& options);

/// A cell around the moving vertex.
struct Neighbour
{
  Index cell;
  const CellTopology* topology;
  Vec3 points[MaxNodes];
  std::array<bool, MaxNodes> moves; ///< whether the node is the vertex
};

/// The determinant of a corner, value + slope t, with its vertex moved by t along a direction.
struct Line
{
  double value, slope;
};

/**
 * @class tautline::Perturber
 * @brief Moves vertices one by one, each up to or past inversion, and maintains the validity of the
 * surrounding cells.
 */
class Perturber
{
public:
  Perturber(const Mesh& mesh, const unsigned char* fixed, const PerturbOptions& options);

  /// Moves the chosen vertices by less than the distance to inversion.
  void move();
  /// Moves vertices past the distance to inversion until enough elements are inverted.
  void tangle();
  Perturbation finish();

private:
  /// A vertex in a random order.
  struct Key
  {
    std::uint64_t chance;
    Index id, vertex;
    bool operator<(const Key& other) const
    {
      return this->chance != other.chance ? this->chance < other.chance : this->id < other.id;
    }
  };

  /// The number of a vertex that determines its random numbers and its turn.
  Index idOf(Index vertex) const { return this->Options.ids ? this->Options.ids[vertex] : vertex; }
  /// Moves a vertex by less than the distance to inversion, with the others fixed.
  void moveVertex(Index vertex);
  void findNormals();
  void findMovable(const unsigned char* fixed);
  std::vector<Index> sortedByChance(std::uint64_t stream) const;
  bool report(double done);

  Validity stateOf(const Neighbour& n) const;
  void gather(Index vertex);
  Vec3 direction(SplitMix& random) const;
  Line line(const Neighbour& n, int corner, const Vec3& along) const;
  double distanceToInversion(const Vec3& along) const;
  Vec3 position(double distance, const Vec3& along) const;
  void place(const Vec3& p);
  bool findStates();
  void accept(Index vertex, const Vec3& p);

  Index gain(Index limit);
  Index tangleVertex(Index vertex, int pass, Index target, Index limit);

  const Mesh& TheMesh;
  const PerturbOptions& Options;
  VertexCells Adjacency;
  const bool Surface;
  std::vector<Vec3> Normals; ///< original normals of the cells of a surface
  std::vector<signed char> States;
  std::vector<Index> Movable;
  Perturbation Result;

  std::vector<Neighbour> Star; ///< the cells around the current vertex
  double Radius = 0;           ///< distance of their farthest vertex
  Vec3 Center = { 0, 0, 0 };   ///< position of the vertex
  std::vector<signed char> NewStates;
  std::vector<double> Crossings;
};
}
#endif
