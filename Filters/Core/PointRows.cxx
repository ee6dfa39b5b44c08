// SPDX-License-Identifier: BSD-3-Clause
#include "PointRows.h"

#include "PieceResults.h"

#include "vtkAbstractArray.h"
#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkTable.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace tautline
{
namespace
{
constexpr char Separator = '\0';

/// Identifies an array on all ranks.
std::string signatureOf(vtkAbstractArray* array)
{
  return std::string(array->GetName()) + "\n" + std::to_string(array->GetDataType()) + "\n" +
    std::to_string(array->GetNumberOfComponents());
}

/// The process that provides the values of each requested point.
class Directory
{
public:
  Directory(RankGroup& group, const std::vector<Index>& numbers)
    : Group(group)
  {
    std::vector<std::vector<Index>> sent(group.size());
    for (const Index number : numbers)
    {
      if (number >= 0)
      {
        sent[this->keeper(number)].push_back(number);
      }
    }
    const std::vector<std::vector<Index>> received = group.exchangeItems(sent);
    for (std::size_t r = 0; r < received.size(); ++r)
    {
      for (const Index number : received[r])
      {
        this->Entries.push_back({ number, static_cast<Index>(r) });
      }
    }
    std::sort(this->Entries.begin(), this->Entries.end());
  }

  /// Per rank, the requested numbers that it has. Collective.
  std::vector<std::vector<Index>> find(const std::vector<Index>& wanted) const
  {
    std::vector<std::vector<Index>> asked(this->Group.size());
    for (const Index number : wanted)
    {
      asked[this->keeper(number)].push_back(number);
    }
    std::vector<std::vector<Entry>> answers;
    for (const std::vector<Index>& list : this->Group.exchangeItems(asked))
    {
      answers.emplace_back();
      for (const Index number : list)
      {
        const auto at =
          std::lower_bound(this->Entries.begin(), this->Entries.end(), Entry{ number, 0 });
        if (at != this->Entries.end() && at->number == number)
        {
          answers.back().push_back(*at);
        }
      }
    }
    std::vector<std::vector<Index>> found(this->Group.size());
    for (const std::vector<Entry>& list : this->Group.exchangeItems(answers))
    {
      for (const Entry& entry : list)
      {
        found[entry.rank].push_back(entry.number);
      }
    }
    return found;
  }

private:
  struct Entry
  {
    Index number, rank;
    bool operator<(const Entry& other) const
    {
      return this->number != other.number ? this->number < other.number : this->rank < other.rank;
    }
  };

  std::size_t keeper(Index number) const
  {
    return static_cast<std::size_t>(number % this->Group.size());
  }

  RankGroup& Group;
  std::vector<Entry> Entries;
};

/// Rows of all arrays as bytes.
Bytes packRows(vtkPointData* data, const std::vector<vtkIdType>& points)
{
  vtkNew<vtkTable> table;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    table->AddColumn(rowsOf(data->GetAbstractArray(i), points));
  }
  vtkNew<vtkCharArray> bytes;
  if (!vtkCommunicator::MarshalDataObject(table, bytes))
  {
    throw Error("The values of points cannot be sent between processes.");
  }
  return Bytes(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
}

/// Copies rows received as bytes to their destinations.
void takeRows(const Bytes& bytes, const std::vector<Index>& numbers,
  const std::vector<Index>& wanted, vtkPointData* rows)
{
  if (bytes.empty())
  {
    return;
  }
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  vtkNew<vtkTable> table;
  if (!vtkCommunicator::UnMarshalDataObject(array, table))
  {
    throw Error("The values of points from another process cannot be read.");
  }
  for (int i = 0; i < rows->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* to = rows->GetAbstractArray(i);
    vtkAbstractArray* from = table->GetColumnByName(to->GetName());
    for (std::size_t k = 0; k < numbers.size(); ++k)
    {
      const auto row = std::lower_bound(wanted.begin(), wanted.end(), numbers[k]) - wanted.begin();
      to->SetTuple(static_cast<vtkIdType>(row), static_cast<vtkIdType>(k), from);
    }
  }
}
}

//------------------------------------------------------------------------------
void keepCommonArrays(RankGroup& group, vtkPointData* data, Index points)
{
  std::string own;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    own += array->GetName() ? signatureOf(array) + Separator : "";
  }
  const std::vector<Bytes> all = group.allGather(Bytes(own.begin(), own.end()));
  const auto counts = group.gatherItems(std::vector<Index>{ points });
  const auto isCommon = [&](vtkAbstractArray* array)
  {
    const std::string wanted = Separator + signatureOf(array) + Separator;
    for (std::size_t r = 0; r < all.size(); ++r)
    {
      const std::string texts = Separator + std::string(all[r].begin(), all[r].end());
      if (counts[r][0] > 0 && texts.find(wanted) == std::string::npos)
      {
        return false;
      }
    }
    return true;
  };
  for (int i = data->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (!array->GetName() || !isCommon(array))
    {
      data->RemoveArray(i);
    }
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPointData> pointRows(RankGroup& group, vtkPointData* data,
  const std::vector<Index>& numbers, const std::vector<Index>& wanted)
{
  const std::vector<std::vector<Index>> asked = Directory(group, numbers).find(wanted);
  const std::vector<std::vector<Index>> questions = group.exchangeItems(asked);
  std::vector<Bytes> answers(group.size());
  std::vector<vtkIdType> order(numbers.size());
  std::iota(order.begin(), order.end(), vtkIdType(0));
  std::stable_sort(
    order.begin(), order.end(), [&](vtkIdType a, vtkIdType b) { return numbers[a] < numbers[b]; });
  for (std::size_t r = 0; r < questions.size(); ++r)
  {
    std::vector<vtkIdType> points;
    for (const Index number : questions[r])
    {
      points.push_back(*std::lower_bound(order.begin(), order.end(), number,
        [&](vtkIdType a, Index value) { return numbers[a] < value; }));
    }
    answers[r] = points.empty() ? Bytes() : packRows(data, points);
  }
  const std::vector<Bytes> received = group.exchange(answers);
  auto rows = vtkSmartPointer<vtkPointData>::New();
  rows->ShallowCopy(data); // for the order and the attributes
  const std::vector<vtkIdType> none(wanted.size(), -1);
  for (int i = 0; i < rows->GetNumberOfArrays(); ++i)
  {
    rows->AddArray(rowsOf(data->GetAbstractArray(i), none)); // replaces the array of this name
  }
  for (std::size_t r = 0; r < received.size(); ++r)
  {
    takeRows(received[r], asked[r], wanted, rows);
  }
  return rows;
}
}
