// SPDX-License-Identifier: BSD-3-Clause
#include "MeshGroups.h"

#include "tautline/Core/Types.h"

#include "vtkDataObjectTree.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

#include <algorithm>
#include <string>

namespace tautline
{
namespace
{
using Make = std::function<vtkSmartPointer<vtkDataSet>(int group, vtkDataSet* piece)>;

/// Traverses a data object and makes one of the same structure.
class Walker
{
public:
  Walker(bool merge, const Make& make)
    : Merge(merge)
    , MakeLeaf(make)
  {
  }

  vtkSmartPointer<vtkDataObject> walk(vtkDataObject* data)
  {
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    {
      return this->walkBlocks(blocks);
    }
    if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
    {
      auto result = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
      result->CopyStructure(collection);
      for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
      {
        const auto child = this->walk(collection->GetPartitionedDataSet(i));
        result->SetPartitionedDataSet(i, vtkPartitionedDataSet::SafeDownCast(child));
      }
      return result;
    }
    if (auto* parts = vtkPartitionedDataSet::SafeDownCast(data))
    {
      return this->walkPartitions(parts);
    }
    if (vtkCompositeDataSet::SafeDownCast(data))
    {
      throw Error(std::string("A ") + data->GetClassName() +
        " is not supported on several processes: run Merge Blocks first.");
    }
    auto* piece = vtkDataSet::SafeDownCast(data);
    return this->MakeLeaf(this->Group++, piece);
  }

  int groups() const { return this->Group; }

private:
  vtkSmartPointer<vtkDataObject> walkBlocks(vtkMultiBlockDataSet* blocks)
  {
    auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    result->SetNumberOfBlocks(blocks->GetNumberOfBlocks());
    for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
    {
      if (const auto child = this->walk(blocks->GetBlock(i)))
      {
        result->SetBlock(i, child);
      }
      if (blocks->HasMetaData(i))
      {
        result->GetMetaData(i)->Copy(blocks->GetMetaData(i));
      }
    }
    return result;
  }

  vtkSmartPointer<vtkDataObject> walkPartitions(vtkPartitionedDataSet* parts)
  {
    auto result = vtkSmartPointer<vtkPartitionedDataSet>::Take(parts->NewInstance());
    const unsigned int count = parts->GetNumberOfPartitions();
    result->SetNumberOfPartitions(this->Merge ? 1 : count);
    for (unsigned int i = 0; i < (this->Merge ? 1 : count); ++i)
    {
      vtkDataSet* part =
        this->Merge ? nullptr : vtkDataSet::SafeDownCast(parts->GetPartitionAsDataObject(i));
      if (const auto made = this->MakeLeaf(this->Group, part))
      {
        result->SetPartition(i, made);
      }
    }
    ++this->Group;
    return result;
  }

  bool Merge;
  const Make& MakeLeaf;
  int Group = 0;
};
}

//------------------------------------------------------------------------------
std::vector<GroupedPiece> listPieces(vtkDataObject* data, int& groups)
{
  std::vector<GroupedPiece> pieces;
  const Make list = [&pieces](int group, vtkDataSet* piece)
  {
    if (piece)
    {
      pieces.push_back({ group, piece });
    }
    return vtkSmartPointer<vtkDataSet>();
  };
  Walker walker(false, list);
  walker.walk(data);
  groups = walker.groups();
  return pieces;
}

//------------------------------------------------------------------------------
bool hasPartitions(vtkDataObject* data)
{
  if (!vtkDataObjectTree::SafeDownCast(data))
  {
    return false;
  }
  int groups = 0;
  std::vector<int> filled;
  try
  {
    for (const GroupedPiece& piece : listPieces(data, groups))
    {
      if (piece.data->GetNumberOfCells() > 0)
      {
        filled.push_back(piece.group);
      }
    }
  }
  catch (const Error&) // other composite data among the blocks
  {
    return false;
  }
  return std::adjacent_find(filled.begin(), filled.end()) != filled.end();
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> rebuild(vtkDataObject* like, bool merge, const Make& make)
{
  Walker walker(merge, make);
  return walker.walk(like);
}
}
