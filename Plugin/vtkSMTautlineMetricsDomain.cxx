// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMTautlineMetricsDomain.h"

#include "vtkClientServerInterpreter.h"
#include "vtkObjectFactory.h"
#include "vtkSMStringVectorProperty.h"

#include <sstream>
#include <string>

vtkStandardNewMacro(vtkSMTautlineMetricsDomain);

namespace
{
vtkObjectBase* create(void*)
{
  return vtkSMTautlineMetricsDomain::New();
}
}

//------------------------------------------------------------------------------
void vtkSMTautlineMetricsDomain::Register(vtkClientServerInterpreter* interpreter)
{
  interpreter->AddNewInstanceFunction("vtkSMTautlineMetricsDomain", create);
}

//------------------------------------------------------------------------------
void vtkSMTautlineMetricsDomain::Update(vtkSMProperty*)
{
  auto* list = vtkSMStringVectorProperty::SafeDownCast(this->GetRequiredProperty("List"));
  if (!list || list->GetNumberOfElements() == 0)
  {
    return;
  }
  bool added = false;
  std::istringstream lines(list->GetElement(0));
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t tab = line.find('\t');
    unsigned int index = 0;
    const int number = std::stoi(line);
    if (tab != std::string::npos && !this->IsInDomain(number, index))
    {
      this->AddEntry(line.substr(tab + 1).c_str(), number);
      added = true;
    }
  }
  if (added)
  {
    this->DomainModified();
  }
}
