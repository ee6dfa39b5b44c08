// SPDX-License-Identifier: BSD-3-Clause
#include "PieceFaces.h"

#include "vtkDataSet.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
void PieceFaces::find(const PieceOrientations& orientations, RankGroup& group,
  const std::vector<Metric>& metrics, FaceConvention convention, bool orient, int threads)
{
  for (const std::vector<vtkDataSet*>& mesh : orientations.meshes())
  {
    std::vector<FaceInput> inputs;
    for (vtkDataSet* data : mesh)
    {
      const OrientedPiece* piece = orientations.piece(data);
      this->Adapters.push_back(std::make_unique<MeshAdapter>(data, threads));
      MeshAdapter& adapter = *this->Adapters.back();
      adapter.mesh().setSpace(piece->whole->space);
      std::vector<signed char> validity(data->GetNumberOfCells());
      adapter.mesh().classifyCells(validity.data(), threads);
      if (orient)
      {
        adapter.orient(validity.data(), piece->whole->order, piece->number);
      }
      inputs.push_back({ data, &adapter });
    }
    auto faces = makeFaceQuality(group, inputs, metrics, convention, threads);
    std::vector<MeshCheckReport*> reports;
    for (const std::unique_ptr<FaceQuality>& piece : faces)
    {
      reports.push_back(&piece->check());
    }
    if (group.any(!reports.empty()))
    {
      this->Checks.push_back(joinReports(group, reports));
    }
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
      this->Pieces[inputs[i].data] = std::move(faces[i]);
    }
  }
}

//------------------------------------------------------------------------------
FaceQuality* PieceFaces::piece(vtkDataSet* data) const
{
  const auto found = this->Pieces.find(data);
  return found != this->Pieces.end() ? found->second.get() : nullptr;
}
}
