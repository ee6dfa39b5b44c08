// SPDX-License-Identifier: BSD-3-Clause
// Curved elements: microseconds of one certified verdict on the validity, of the bounds of the
// minimum to 1 %, and of the certified minima of quality metrics to 1e-3, by type of element; CPU
// time of one thread.
//
// usage: BenchmarkCurved ELEMENTS REPEATS
//
// The elements are random: nodes of the straight element moved by the amplitude at which the given
// share of elements is invalid. Where TAUTLINE_TEST_DATA has the folder curved, also the mesh
// cube-holes-inv of MFEM.

#include "Clocks.h"
#include "Elements/CurvedElements.h"
#include "tautline/Elements/MetricCertifier.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

using namespace tautline;

namespace
{
const Vec3 zAxis = { 0, 0, 1 };
constexpr int quadraticTetrahedron = 24, quadraticPyramid = 27; // of VTK

struct Kind
{
  const char* name;
  int vtkType; ///< 0: a pyramid of 14 nodes
  int nodes;
  double invalid; ///< share
  double size;    ///< number of elements over the command line's
};
constexpr Kind kinds[] = { { "tri6", 22, 6, 0.023, 1 }, { "tri15", 69, 15, 0.65, 1 },
  { "quad9", 28, 9, 0.017, 1 }, { "quad16", 70, 16, 0.41, 1 }, { "quad25", 70, 25, 0.75, 1 },
  { "tet4", 10, 4, 0.02, 1 }, { "hex8", 12, 8, 0.02, 1 }, { "tet10", 24, 10, 0.022, 1 },
  { "tet20", 71, 20, 0.43, 1 }, { "tet35", 71, 35, 0.73, 1 }, { "hex20", 25, 20, 0.078, 0.5 },
  { "hex27", 29, 27, 0.223, 0.5 }, { "hex64", 72, 64, 0.26, 0.15 },
  { "hex125", 72, 125, 0.02, 0.05 }, { "wedge18", 32, 18, 0.35, 1 }, { "pyr14", 0, 14, 0.06, 1 } };

ElementType typeOf(const Kind& kind)
{
  if (kind.vtkType != 0)
  {
    return ElementType::ofVtk(kind.vtkType, kind.nodes);
  }
  std::vector<Vec3> nodes = ElementType::ofVtk(quadraticPyramid, 13).coordinates();
  nodes.push_back({ 0.5, 0.5, 0 });
  return ElementType(ElementShape::Pyramid, { 2, 2, 2 }, nodes);
}

ElementSet randomElements(const ElementType& type, double amplitude, int count)
{
  SplitMix random(7, 1, type.nodes());
  std::vector<std::vector<Vec3>> elements;
  for (int n = 0; n < count; ++n)
  {
    elements.push_back(randomElement(type, amplitude, random));
  }
  return setOf(elements);
}

Index invalidElements(const ElementType& type, const ElementSet& set)
{
  JacobianCertifier certifier(type, zAxis);
  const std::vector<ElementValidity> validity = classify(certifier, set);
  return std::count_if(validity.begin(), validity.end(),
    [](ElementValidity v) { return v != ElementValidity::Valid; });
}

/// The amplitude at which a share of random elements is invalid.
double findAmplitude(const ElementType& type, double share, int count)
{
  double low = 0, high = 1;
  for (int step = 0; step < 12; ++step)
  {
    const double middle = 0.5 * (low + high);
    const ElementSet set = randomElements(type, middle, count);
    const bool above = static_cast<double>(invalidElements(type, set)) > share * count;
    (above ? high : low) = middle;
  }
  return high;
}

/// Microseconds per element of the fastest of some runs.
template <class Work>
double fastest(int repeats, Index elements, const Work& work)
{
  double best = 1e300;
  for (int run = 0; run < repeats; ++run)
  {
    const double start = threadTime();
    work();
    best = std::min(best, threadTime() - start);
  }
  return 1e6 * best / static_cast<double>(elements);
}

void print(const std::string& name, const char* what, double value)
{
  std::printf("curved %s %s\t%.6g\n", name.c_str(), what, value);
}

/// Microseconds of a metric of the elements that are valid.
double measureMetric(const ElementType& type, ElementMetric metric, const ElementSet& set,
  const std::vector<ElementValidity>& validity, int repeats)
{
  std::vector<const Index*> elements;
  for (std::size_t e = 0; e < validity.size(); ++e)
  {
    if (validity[e] == ElementValidity::Valid)
    {
      elements.push_back(set.elements[e]);
    }
  }
  MetricCertifier certifier(type, metric, zAxis);
  return fastest(repeats, static_cast<Index>(elements.size()),
    [&]
    {
      for (const Index* element : elements)
      {
        certifier.minimum(set.coordinates(), element);
      }
    });
}

void measure(const std::string& name, const ElementType& type, const ElementSet& set, int repeats)
{
  JacobianCertifier certifier(type, zAxis);
  std::vector<ElementValidity> validity(set.elements.size());
  const double sign = fastest(repeats, set.count(),
    [&]
    { certifier.classify(set.coordinates(), set.elements.data(), set.count(), validity.data()); });
  const CertificateCounts counts = certifier.counts();
  MinimumTolerance tolerance;
  tolerance.relative = 1e-2;
  const double minimum = fastest(repeats, set.count(),
    [&]
    {
      for (const Index* element : set.elements)
      {
        certifier.minimum(set.coordinates(), element, tolerance);
      }
    });
  const auto elements = static_cast<double>(counts.elements);
  print(name, "elements", static_cast<double>(set.count()));
  print(name, "invalid", static_cast<double>(invalidElements(type, set)));
  print(name, "undecided", static_cast<double>(counts.undecided));
  print(name, "searched", static_cast<double>(counts.searched) / elements);
  print(name, "splits", static_cast<double>(counts.splits) / elements);
  print(name, "validity", sign);
  print(name, "minimum", minimum);
  const auto metric = [&](ElementMetric wanted)
  { return measureMetric(type, wanted, set, validity, std::min(repeats, 3)); };
  print(name, "mean-ratio", metric(ElementMetric::MeanRatio));
  print(name, "inverse-condition", metric(ElementMetric::InverseCondition));
  if (type.shape() != ElementShape::Pyramid)
  {
    print(name, "scaled-jacobian", metric(ElementMetric::ScaledJacobian));
  }
}
}

int main(int argc, char* argv[])
{
  const int size = std::max(20, argc > 1 ? std::atoi(argv[1]) : 2000);
  const int repeats = std::max(1, argc > 2 ? std::atoi(argv[2]) : 5);
  for (const Kind& kind : kinds)
  {
    const ElementType type = typeOf(kind);
    const int count = std::max(8, static_cast<int>(kind.size * size));
    const double amplitude = findAmplitude(type, kind.invalid, std::min(count, 500));
    print(kind.name, "amplitude", amplitude);
    measure(kind.name, type, randomElements(type, amplitude, count), repeats);
  }
  const char* data = std::getenv("TAUTLINE_TEST_DATA");
  const std::string file = std::string(data ? data : "") + "/curved/cube-holes-inv.mesh";
  if (std::filesystem::exists(file))
  {
    measure("cube-holes", ElementType::ofVtk(quadraticTetrahedron, 10),
      setOf(elementsOf(readMfem(file, false), FileTetrahedron10)), repeats);
  }
  return EXIT_SUCCESS;
}
