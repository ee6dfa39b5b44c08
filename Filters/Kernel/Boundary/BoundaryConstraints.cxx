// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryConstraints.h"

#include "tautline/Core/Types.h"

#include <cctype>

namespace tautline
{
void NeedOfWholeMesh::refuse() const
{
  if (this->what.empty())
  {
    return;
  }
  std::string first = this->what;
  first[0] = static_cast<char>(std::toupper(first[0]));
  throw Error(first +
    " need the whole mesh on one process: gather it (in ParaView, with Aggregate Dataset) and "
    "turn Reproducible Order off; or " +
    this->remedy + ".");
}
}
