// SPDX-License-Identifier: BSD-3-Clause
#include "ImageParts.h"

#include "vtkImageData.h"

#include <algorithm>
#include <array>

namespace tautline
{
//------------------------------------------------------------------------------
bool areOneImage(const std::vector<vtkDataSet*>& pieces)
{
  auto* first = vtkImageData::SafeDownCast(pieces.front());
  return first &&
    std::all_of(pieces.begin(), pieces.end(),
      [first](vtkDataSet* piece)
      {
        auto* image = vtkImageData::SafeDownCast(piece);
        return image &&
          std::equal(image->GetOrigin(), image->GetOrigin() + 3, first->GetOrigin()) &&
          std::equal(image->GetSpacing(), image->GetSpacing() + 3, first->GetSpacing());
      });
}

//------------------------------------------------------------------------------
std::vector<vtkIdType> idsOfPart(const int* part, const int* all, int unit)
{
  std::array<vtkIdType, 3> size, from, to;
  for (std::size_t a = 0; a < 3; ++a)
  {
    // A flat image has one layer of cells.
    const bool flat = all[2 * a] == all[2 * a + 1];
    size[a] = all[2 * a + 1] - all[2 * a] + 1 - (flat ? 0 : unit);
    from[a] = part[2 * a] - all[2 * a];
    to[a] = part[2 * a + 1] - all[2 * a] + 1 - (flat ? 0 : unit);
  }
  std::vector<vtkIdType> ids;
  for (vtkIdType k = from[2]; k < to[2]; ++k)
  {
    for (vtkIdType j = from[1]; j < to[1]; ++j)
    {
      for (vtkIdType i = from[0]; i < to[0]; ++i)
      {
        ids.push_back(i + size[0] * (j + size[1] * k));
      }
    }
  }
  return ids;
}
}
