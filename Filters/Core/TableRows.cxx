// SPDX-License-Identifier: BSD-3-Clause
#include "TableRows.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
void TableRows::begin(const std::string& block)
{
  this->Next = 0;
  if (!block.empty())
  {
    this->addText("Block", block);
  }
}

//------------------------------------------------------------------------------
TableRows::Column& TableRows::next(std::string_view name)
{
  if (this->Next == this->Columns.size())
  {
    this->Columns.push_back({ std::string(name), {}, {} });
  }
  return this->Columns[this->Next++];
}

//------------------------------------------------------------------------------
void TableRows::add(std::string_view column, double value)
{
  this->next(column).values.push_back(value);
}

//------------------------------------------------------------------------------
void TableRows::addText(std::string_view column, std::string_view value)
{
  this->next(column).texts.emplace_back(value);
}

//------------------------------------------------------------------------------
void TableRows::fill(vtkTable* table) const
{
  table->Initialize();
  for (const Column& column : this->Columns)
  {
    if (column.texts.empty())
    {
      vtkNew<vtkDoubleArray> array;
      array->SetName(column.name.c_str());
      array->SetNumberOfValues(static_cast<vtkIdType>(column.values.size()));
      std::copy(column.values.begin(), column.values.end(), array->GetPointer(0));
      table->AddColumn(array);
      continue;
    }
    vtkNew<vtkStringArray> array;
    array->SetName(column.name.c_str());
    array->SetNumberOfValues(static_cast<vtkIdType>(column.texts.size()));
    for (std::size_t i = 0; i < column.texts.size(); ++i)
    {
      pollInterruption(static_cast<Index>(i));
      array->SetValue(static_cast<vtkIdType>(i), column.texts[i]);
    }
    table->AddColumn(array);
  }
}
}
