// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzTargets.h"

#include <cstdlib>
#include <stdexcept>

namespace tautline
{
const std::vector<FuzzTarget>& fuzzTargets()
{
  static const std::vector<FuzzTarget> targets = {
    { "tetgen", fuzzTetGen },
    { "medit", fuzzMedit },
    { "gmsh", fuzzGmsh },
    { "off", fuzzOff },
    { "abaqus", fuzzAbaqus },
    { "nastran", fuzzNastran },
    { "mfem", fuzzMfem },
    { "foam", fuzzFoam },
    { "quality", fuzzQuality },
    { "mesh", fuzzMesh },
    { "move", fuzzMove },
    { "reconnection", fuzzReconnection },
#ifndef TAUTLINE_KERNEL_TARGETS // these need the filters or PETSc
    { "image", fuzzImage },
    { "imagelist", fuzzImageList },
    { "silhouette", fuzzSilhouette },
    { "petscoptions", fuzzPetscOptions },
#endif
  };
  return targets;
}

const FuzzTarget* findFuzzTarget(const std::string& name)
{
  for (const FuzzTarget& target : fuzzTargets())
  {
    if (name == target.name)
    {
      return &target;
    }
  }
  return nullptr;
}

const std::string& fuzzFolder()
{
  static const std::string folder = []
  {
    const char* given = std::getenv("TAUTLINE_FUZZ_DIR");
    return std::string(given ? given : "/tmp");
  }();
  return folder;
}

void expectThat(bool holds, const std::string& property)
{
  if (!holds)
  {
    throw std::logic_error("not true: " + property);
  }
}
}
