#include "WarpPointwise.h"

#include "Parallel.h"

namespace tautline
{
std::vector<double> warpByInverseDistance(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement,
  const WarpOptions& options)
{
  const PrescribedMotion motion(mesh, prescribed, displacement, options.threads);
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  std::vector<Vec3> x;
  for (const Index id : motion.prescribed())
  {
    x.push_back(motion.local(id));
  }
  forEachChunk(static_cast<Index>(rest.size()), options.threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end && !x.empty(); ++i)
      {
        const Vec3 y = motion.local(motion.free()[i]);
        double sum = 0;
        for (std::size_t j = 0; j < x.size(); ++j)
        {
          const Vec3 d = y - x[j];
          const double w = std::pow(dot(d, d) + 1e-300, -0.5 * options.distancePower);
          sum += w;
          rest[i] += w * motion.rest(j);
        }
        rest[i] = (1 / sum) * rest[i];
      }
    });
  return motion.displacements(rest);
}
}
