// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedGuard.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr Index ElementsPerChunk = 256;

/// The tolerance between the bounds of a minimum, relative to the largest coefficient: for finding
/// its location, and for comparing it with the samples.
constexpr double PlaceTolerance = 1e-2, LevelTolerance = 1e-6;
}

//------------------------------------------------------------------------------
CurvedGuard::CurvedGuard(const std::vector<CurvedElement>& elements, int dimension, int threads)
  : Elements(elements)
  , Threads(threads)
  , Normal(dimension == 2 ? Vec3{ 0, 0, 1 } : Vec3{ 0, 0, 0 })
{
  // Certifiers are expensive to set up, so elements of the same type and orientation share one.
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    this->Groups[{ elements[e].type, elements[e].mirrored }].push_back(static_cast<Index>(e));
  }
}

//------------------------------------------------------------------------------
/// @param judge called with a certifier and an element: returns whether it is acceptable, or the
///   weak location
template <class Judge>
std::vector<WeakPlace> CurvedGuard::find(const std::vector<double>& x, const Judge& judge) const
{
  std::vector<WeakPlace> places;
  for (const auto& [key, elements] : this->Groups)
  {
    const auto& [type, mirrored] = key;
    const auto count = static_cast<Index>(elements.size());
    const Index chunks = (count + ElementsPerChunk - 1) / ElementsPerChunk;
    std::vector<std::vector<WeakPlace>> found(chunks);
    ScratchPool<JacobianCertifier> pool(
      [this, t = type, m = mirrored] { return JacobianCertifier(*t, this->Normal, m); });
    runChunks(chunks, this->Threads,
      [&, &own = elements](Index chunk)
      {
        pool.with(
          [&](JacobianCertifier& certifier)
          {
            const Index end = std::min(count, (chunk + 1) * ElementsPerChunk);
            judge(certifier, x.data(), own.data() + chunk * ElementsPerChunk,
              end - chunk * ElementsPerChunk, found[chunk]);
          });
      });
    for (const std::vector<WeakPlace>& list : found)
    {
      places.insert(places.end(), list.begin(), list.end());
    }
  }
  // The order of the elements does not depend on the groups or the threads.
  std::sort(places.begin(), places.end(),
    [](const WeakPlace& a, const WeakPlace& b) { return a.element < b.element; });
  return places;
}

//------------------------------------------------------------------------------
std::vector<WeakPlace> CurvedGuard::invalid(const std::vector<double>& x) const
{
  return this->find(x,
    [this](JacobianCertifier& certifier, const double* points, const Index* elements, Index count,
      std::vector<WeakPlace>& found)
    {
      std::vector<const Index*> nodes(count);
      std::vector<ElementValidity> validity(count);
      for (Index i = 0; i < count; ++i)
      {
        nodes[i] = this->Elements[elements[i]].nodes.data();
      }
      certifier.classify(points, nodes.data(), count, validity.data());
      for (Index i = 0; i < count; ++i)
      {
        if (validity[i] != ElementValidity::Valid)
        {
          MinimumTolerance tolerance;
          tolerance.relative = PlaceTolerance;
          found.push_back({ elements[i], certifier.minimum(points, nodes[i], tolerance).at });
        }
      }
    });
}

//------------------------------------------------------------------------------
std::vector<WeakPlace> CurvedGuard::notRepresented(const std::vector<double>& x,
  const std::vector<double>& sampled, std::vector<double>* lower) const
{
  if (lower)
  {
    lower->assign(this->Elements.size(), 0.0);
  }
  return this->find(x,
    [&](JacobianCertifier& certifier, const double* points, const Index* elements, Index count,
      std::vector<WeakPlace>& found)
    {
      for (Index i = 0; i < count; ++i)
      {
        // Samples represent an element if its certified minimum is at least LeastShare of the
        // smallest sampled determinant.
        MinimumTolerance tolerance;
        tolerance.relative = LevelTolerance;
        tolerance.level = std::max(LeastShare * sampled[elements[i]], 0.0);
        const JacobianBound bound =
          certifier.minimum(points, this->Elements[elements[i]].nodes.data(), tolerance);
        if (lower)
        {
          (*lower)[elements[i]] = bound.validity == ElementValidity::Valid ? bound.lower : 0;
        }
        if (bound.validity != ElementValidity::Valid || !(bound.lower >= tolerance.level))
        {
          found.push_back({ elements[i], bound.at });
        }
      }
    });
}
}
