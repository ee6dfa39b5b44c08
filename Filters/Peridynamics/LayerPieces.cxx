// SPDX-License-Identifier: BSD-3-Clause
#include "LayerPieces.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Peridynamics/PeridynamicsGeometry.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

namespace tautline
{
namespace
{
/// An edge of the boundary on its way to the first process.
struct SentEdge
{
  TriangleKey key; ///< of its triangle, and which edge of it: the order of one process
  int side;
  int owner; ///< of its first point
  BoundaryEdge edge;
};

/// A corner of a triangle of the layer.
struct LayerCorner
{
  Index number; ///< of a point of the mesh; -1: a new one
  int owner;    ///< the process that has the point of the mesh
  Index id;     ///< of all corners that are one
  Vec2 place;
};
using LayerTriangle = std::array<LayerCorner, 3>;

/// A point of the mesh that another process has.
struct SentPoint
{
  Index number;
  Vec3 place;
};

//------------------------------------------------------------------------------
/// Writes rows of arrays as bytes, each array with its name and type.
Bytes packRows(vtkDataSetAttributes* data, const std::vector<vtkIdType>& rows)
{
  Bytes bytes;
  const auto put = [&bytes](const void* from, std::size_t size)
  {
    const char* begin = static_cast<const char*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  for (int a = 0; a < data->GetNumberOfArrays() && !rows.empty(); ++a)
  {
    vtkDataArray* array = data->GetArray(a);
    if (!array || !array->GetName())
    {
      continue;
    }
    auto copy =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
    copy->SetNumberOfComponents(array->GetNumberOfComponents());
    copy->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      copy->SetTuple(static_cast<vtkIdType>(i), rows[i], array);
    }
    const std::string name = array->GetName();
    const std::int64_t head[4] = { static_cast<std::int64_t>(name.size()), array->GetDataType(),
      array->GetNumberOfComponents(), static_cast<std::int64_t>(rows.size()) };
    put(head, sizeof(head));
    put(name.data(), name.size());
    put(copy->GetVoidPointer(0),
      static_cast<std::size_t>(copy->GetNumberOfValues()) *
        static_cast<std::size_t>(copy->GetDataTypeSize()));
  }
  return bytes;
}

/// Sets rows of the arrays with the same names, beginning with `first`.
void unpackRows(const Bytes& bytes, vtkIdType first, vtkDataSetAttributes* data)
{
  const char* at = bytes.data();
  while (at < bytes.data() + bytes.size())
  {
    std::int64_t head[4];
    std::memcpy(head, at, sizeof(head));
    at += sizeof(head);
    const std::string name(at, static_cast<std::size_t>(head[0]));
    at += head[0];
    auto rows =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(static_cast<int>(head[1])));
    rows->SetNumberOfComponents(static_cast<int>(head[2]));
    rows->SetNumberOfTuples(head[3]);
    const std::size_t size = static_cast<std::size_t>(rows->GetNumberOfValues()) *
      static_cast<std::size_t>(rows->GetDataTypeSize());
    std::memcpy(rows->GetVoidPointer(0), at, size);
    at += size;
    vtkDataArray* to = data->GetArray(name.c_str());
    for (vtkIdType i = 0;
         to && to->GetNumberOfComponents() == rows->GetNumberOfComponents() && i < head[3]; ++i)
    {
      to->SetTuple(first + i, i, rows);
    }
  }
}

//------------------------------------------------------------------------------
/// The local triangles in the plane.
HorizonMesh planarMesh(const HorizonPieces& pieces)
{
  const MeshView& view = pieces.view();
  HorizonMesh mesh;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const auto place = pieces.plane().project(pointOf(view, p));
    mesh.points.insert(mesh.points.end(), place.begin(), place.end());
  }
  mesh.triangles.assign(view.connectivity, view.connectivity + view.offsets[view.numberOfCells]);
  mesh.layer.assign(view.numberOfCells, 0);
  return mesh;
}

/**
 * @class LayerPieces
 * @brief The layer, on its way from the boundary to the pieces.
 */
class LayerPieces
{
public:
  LayerPieces(const HorizonPieces& pieces, vtkDataSet* input)
    : Pieces(pieces)
    , Group(pieces.group())
    , Input(input)
  {
  }

  void run(const InteractionLayerOptions& options, double seconds, vtkUnstructuredGrid* output);

private:
  std::vector<SentEdge> ownEdges(LayerBoundary& boundary) const;
  std::vector<std::vector<LayerTriangle>> compute(std::vector<SentEdge> edges,
    LayerBoundary boundary, const InteractionLayerOptions& options, double seconds) const;
  void choosePoints();
  void takeFromOthers(const std::vector<LayerTriangle>& layer);
  void build(const std::vector<LayerTriangle>& layer, vtkUnstructuredGrid* output);

  const HorizonPieces& Pieces;
  RankGroup& Group;
  vtkDataSet* Input;
  std::vector<vtkIdType> Kept, NewId;         ///< points of the piece in the output, and back
  std::vector<Index> FirstOf;                 ///< per local point, the first of the piece, or -1
  std::vector<std::vector<SentPoint>> Others; ///< points that other processes sent
  std::vector<Bytes> OtherRows;
};

//------------------------------------------------------------------------------
/// The edges of one triangle whose point of the lowest number this process owns: it has all
/// triangles there. @param boundary gets the box around the triangles of this process
std::vector<SentEdge> LayerPieces::ownEdges(LayerBoundary& boundary) const
{
  const DistributedMesh& mesh = this->Pieces.mesh().mesh();
  const HorizonMesh planar = planarMesh(this->Pieces);
  const auto place = [&planar](Index p) {
    return Vec2{ planar.points[2 * p], planar.points[2 * p + 1] };
  };
  struct Use
  {
    Index triangle, a, b;
    int side, count = 0;
  };
  std::map<std::pair<Index, Index>, Use> uses;
  for (Index t = 0; t < planar.numberOfTriangles(); ++t)
  {
    // Counter-clockwise, as one process lists the edges.
    Index corner[3];
    std::copy_n(&planar.triangles[3 * t], 3, corner);
    const Vec2 a = place(corner[0]), b = place(corner[1]), c = place(corner[2]);
    if (cross(b - a, c - a) < 0)
    {
      std::swap(corner[1], corner[2]);
    }
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 p = place(corner[k]);
      boundary.low = { std::min(boundary.low[0], p[0]), std::min(boundary.low[1], p[1]) };
      boundary.high = { std::max(boundary.high[0], p[0]), std::max(boundary.high[1], p[1]) };
      const Index from = corner[k], to = corner[(k + 1) % 3];
      if (mesh.owned(std::min(from, to)))
      {
        Use& use = uses[{ std::min(from, to), std::max(from, to) }];
        use = { t, from, to, k, use.count + 1 };
      }
    }
  }
  std::vector<SentEdge> edges;
  for (const auto& [ends, use] : uses)
  {
    if (use.count == 1)
    {
      edges.push_back({ this->Pieces.keyOf(use.triangle), use.side, mesh.owners()[use.a],
        { place(use.a), place(use.b), mesh.numbers()[use.a], mesh.numbers()[use.b] } });
    }
  }
  return edges;
}

//------------------------------------------------------------------------------
/// On the first process: the triangles of the layer, by the process that gets them.
std::vector<std::vector<LayerTriangle>> LayerPieces::compute(std::vector<SentEdge> edges,
  LayerBoundary boundary, const InteractionLayerOptions& options, double seconds) const
{
  const Stopwatch time;
  const PollScope scope(
    [&]
    {
      if (time.reached(seconds))
      {
        std::ostringstream text;
        text << "The time limit of " << seconds
             << " s is reached: set a higher Time Limit (0 is none), or take a smaller input.";
        throw Error(text.str());
      }
    });
  std::sort(edges.begin(), edges.end(),
    [](const SentEdge& a, const SentEdge& b)
    { return a.key != b.key ? a.key < b.key : a.side < b.side; });
  std::map<Index, int> ownerOf;
  for (const SentEdge& edge : edges)
  {
    boundary.edges.push_back(edge.edge);
    ownerOf[edge.edge.first] = edge.owner; // every point of the boundary is the first of an edge
  }
  const LayerTriangles layer = surroundByLayer(boundary, options);
  std::vector<std::vector<LayerTriangle>> ofRanks(this->Group.size());
  Index polled = 0;
  for (const auto& t : layer.triangles)
  {
    pollInterruption(polled++);
    LayerTriangle triangle;
    Vec2 centre = { 0, 0 };
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto id = static_cast<std::size_t>(t[k]);
      const bool old = id < layer.boundary.size();
      const Index number = old ? layer.boundary[id] : -1;
      triangle[k] = { number, old ? ownerOf.at(number) : -1, t[k],
        { layer.points[2 * id], layer.points[2 * id + 1] } };
      centre = centre + (1.0 / 3.0) * triangle[k].place;
    }
    double nearest = 1e300;
    int owner = 0;
    for (const SentEdge& edge : edges)
    {
      const Vec2 d = 0.5 * (edge.edge.a + edge.edge.b) - centre;
      owner = dot(d, d) < nearest ? edge.owner : owner;
      nearest = std::min(nearest, dot(d, d));
    }
    ofRanks[owner].push_back(triangle);
  }
  return ofRanks;
}

//------------------------------------------------------------------------------
/// The points of the piece that are not those of ghost cells only.
void LayerPieces::choosePoints()
{
  const RankMesh& mesh = this->Pieces.mesh();
  const MeshView& piece = mesh.piece();
  enum Use : char
  {
    Unused,
    OfCopies,
    OfCells
  };
  std::vector<char> use(piece.numberOfPoints, Unused);
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const bool copy =
      mesh.skipped()[cell] && cornerType(piece.cellTypes[cell]) == CellType::Triangle;
    for (Index n = piece.offsets[cell]; n < piece.offsets[cell + 1]; ++n)
    {
      char& point = use[piece.connectivity[n]];
      point = std::max<char>(point, copy ? OfCopies : OfCells);
    }
  }
  this->FirstOf.assign(mesh.mesh().localPoints(), -1);
  this->NewId.assign(piece.numberOfPoints, -1);
  for (Index p = 0; p < piece.numberOfPoints; ++p)
  {
    if (use[p] != OfCopies)
    {
      this->NewId[p] = static_cast<vtkIdType>(this->Kept.size());
      this->Kept.push_back(static_cast<vtkIdType>(p));
      const Index local = mesh.mesh().localOfPiece()[p];
      if (local >= 0 && this->FirstOf[local] < 0)
      {
        this->FirstOf[local] = p;
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Gets the points of the boundary that only other processes have, with their values.
void LayerPieces::takeFromOthers(const std::vector<LayerTriangle>& layer)
{
  const DistributedMesh& mesh = this->Pieces.mesh().mesh();
  std::vector<std::vector<Index>> asked(this->Group.size());
  this->Group.together(
    [&]
    {
      for (const LayerTriangle& triangle : layer)
      {
        for (const LayerCorner& corner : triangle)
        {
          const Index local = corner.number < 0 ? -1 : mesh.local(corner.number);
          if (corner.number >= 0 && (local < 0 || this->FirstOf[local] < 0))
          {
            asked[corner.owner].push_back(corner.number);
          }
        }
      }
      for (std::vector<Index>& list : asked)
      {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
      }
    });
  asked = this->Group.exchangeItems(asked);
  std::vector<std::vector<SentPoint>> points(this->Group.size());
  std::vector<Bytes> rows(this->Group.size());
  this->Group.together(
    [&]
    {
      for (std::size_t rank = 0; rank < asked.size(); ++rank)
      {
        std::vector<vtkIdType> ids;
        for (const Index number : asked[rank])
        {
          const Index p = this->FirstOf[mesh.local(number)];
          ids.push_back(static_cast<vtkIdType>(p));
          points[rank].push_back({ number, pointOf(this->Pieces.mesh().piece(), p) });
        }
        rows[rank] = packRows(this->Input->GetPointData(), ids);
      }
    });
  this->Others = this->Group.exchangeItems(points);
  this->OtherRows = this->Group.exchange(rows);
}

//------------------------------------------------------------------------------
void LayerPieces::build(const std::vector<LayerTriangle>& layer, vtkUnstructuredGrid* output)
{
  const RankMesh& mesh = this->Pieces.mesh();
  const MeshView& piece = mesh.piece();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  for (const vtkIdType p : this->Kept)
  {
    points->InsertNextPoint(pointOf(piece, p).data());
  }
  std::map<Index, vtkIdType> idOf; // of points of the mesh that others have, by number
  std::vector<vtkIdType> firstOfRank;
  for (const std::vector<SentPoint>& list : this->Others)
  {
    firstOfRank.push_back(points->GetNumberOfPoints());
    for (const SentPoint& point : list)
    {
      idOf[point.number] = points->InsertNextPoint(point.place.data());
    }
  }
  output->Allocate(piece.numberOfCells + static_cast<vtkIdType>(layer.size()));
  vtkNew<vtkIntArray> reference;
  reference->SetName(ReferenceArray);
  std::vector<vtkIdType> cells;
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    if (mesh.skipped()[cell])
    {
      continue;
    }
    vtkIdType ids[3];
    for (int k = 0; k < 3; ++k)
    {
      const Index p = piece.connectivity[piece.offsets[cell] + k];
      ids[k] = this->NewId[this->FirstOf[mesh.mesh().localOfPiece()[p]]];
    }
    output->InsertNextCell(VTK_TRIANGLE, 3, ids);
    cells.push_back(static_cast<vtkIdType>(cell));
    reference->InsertNextValue(DomainValue);
  }
  std::map<Index, vtkIdType> newOf; // of new points
  const bool flipped = this->Pieces.mesh().mirrored();
  for (const LayerTriangle& triangle : layer)
  {
    vtkIdType ids[3];
    for (int k = 0; k < 3; ++k)
    {
      const LayerCorner& corner = triangle[flipped ? (3 - k) % 3 : k];
      const Index local = corner.number < 0 ? -1 : mesh.mesh().local(corner.number);
      if (local >= 0 && this->FirstOf[local] >= 0)
      {
        ids[k] = this->NewId[this->FirstOf[local]];
      }
      else if (corner.number >= 0)
      {
        ids[k] = idOf.at(corner.number);
      }
      else
      {
        const auto [known, fresh] = newOf.emplace(corner.id, points->GetNumberOfPoints());
        if (fresh)
        {
          points->InsertNextPoint(
            this->Pieces.plane().lift(corner.place[0], corner.place[1]).data());
        }
        ids[k] = known->second;
      }
    }
    output->InsertNextCell(VTK_TRIANGLE, 3, ids);
    reference->InsertNextValue(LayerValue);
  }
  output->SetPoints(points);
  const auto kept = static_cast<vtkIdType>(this->Kept.size());
  const auto own = static_cast<vtkIdType>(cells.size());
  passData(this->Input->GetPointData(), output->GetPointData(), points->GetNumberOfPoints(),
    [&](vtkIdType i) { return i < kept ? this->Kept[i] : -1; });
  for (std::size_t rank = 0; rank < this->OtherRows.size(); ++rank)
  {
    unpackRows(this->OtherRows[rank], firstOfRank[rank], output->GetPointData());
  }
  passData(this->Input->GetCellData(), output->GetCellData(), reference->GetNumberOfTuples(),
    [&](vtkIdType i) { return i < own ? cells[i] : -1; });
  for (vtkDataSetAttributes* data :
    std::initializer_list<vtkDataSetAttributes*>{ output->GetPointData(), output->GetCellData() })
  {
    data->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  }
  output->GetCellData()->AddArray(reference);
  output->GetCellData()->SetActiveScalars(ReferenceArray);
}

//------------------------------------------------------------------------------
void LayerPieces::run(
  const InteractionLayerOptions& options, double seconds, vtkUnstructuredGrid* output)
{
  LayerBoundary boundary;
  std::vector<std::vector<SentEdge>> sent(this->Group.size());
  this->Group.together([&] { sent[0] = this->ownEdges(boundary); });
  for (std::size_t c = 0; c < 2; ++c)
  {
    boundary.low[c] = -this->Group.maximum(-boundary.low[c]);
    boundary.high[c] = this->Group.maximum(boundary.high[c]);
  }
  const std::vector<std::vector<SentEdge>> received = this->Group.exchangeItems(sent);
  std::vector<std::vector<LayerTriangle>> ofRanks(this->Group.size());
  this->Group.together(
    [&]
    {
      if (this->Group.rank() == 0)
      {
        std::vector<SentEdge> edges;
        for (const std::vector<SentEdge>& list : received)
        {
          edges.insert(edges.end(), list.begin(), list.end());
        }
        ofRanks = this->compute(std::move(edges), boundary, options, seconds);
      }
    });
  const std::vector<LayerTriangle> layer = this->Group.exchangeItems(ofRanks)[0];
  this->Group.together([&] { this->choosePoints(); });
  this->takeFromOthers(layer);
  this->Group.together([&] { this->build(layer, output); });
}
}

//------------------------------------------------------------------------------
void passData(vtkDataSetAttributes* input, vtkDataSetAttributes* output, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& from)
{
  for (int a = 0; a < input->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = input->GetArray(a);
    if (!array)
    {
      continue;
    }
    auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    copy->SetName(array->GetName());
    copy->SetNumberOfComponents(array->GetNumberOfComponents());
    copy->SetNumberOfTuples(count);
    copy->Fill(0.0);
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (from(i) >= 0)
      {
        copy->SetTuple(i, from(i), array);
      }
    }
    output->AddArray(copy);
  }
}

//------------------------------------------------------------------------------
bool canSurround(const HorizonPieces& pieces)
{
  bool good = true;
  try
  {
    if (pieces.view().numberOfCells > 0)
    {
      const PlanarTriangles triangles(planarMesh(pieces));
    }
  }
  catch (const std::exception&)
  {
    good = false;
  }
  return !pieces.group().any(!good);
}

//------------------------------------------------------------------------------
void addLayerToPieces(const HorizonPieces& pieces, vtkDataSet* input,
  const InteractionLayerOptions& options, double seconds, vtkUnstructuredGrid* output)
{
  LayerPieces(pieces, input).run(options, seconds, output);
}
}
