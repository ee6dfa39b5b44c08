#include "WarpPointwise.h"

namespace tautline
{
std::vector<double> warpByWeightedLaplacian(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement,
  const WarpOptions& options)
{
  return warpByInverseDistance(mesh, prescribed, displacement, options);
}
}
