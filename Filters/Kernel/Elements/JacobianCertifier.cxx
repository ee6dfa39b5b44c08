// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCertifier.h"

#include "DeterminantWork.h"
#include "ElementPlacement.h"

#include <optional>

namespace tautline
{
namespace
{
/// De Casteljau's algorithm rounds at most once per coefficient of a line and level.
constexpr double levelRounding = 64 * 0x1p-53;
}

//------------------------------------------------------------------------------
struct JacobianCertifier::Work : ElementPlacement
{
  Work(const ElementType& elements, const Vec3& normal, bool mirror)
    : ElementPlacement(elements, normal, mirror)
    , type(elements)
    , packets(elements, surface)
    , one(elements, surface)
    , coefficients(elements.determinant().space.size())
    , searcher(elements.determinant().space, elements.determinant().bisections,
        elements.determinant().corners)
  {
    const DeterminantForm& form = elements.determinant();
    if (surface)
    {
      square.resize(form.squareSpace.size());
      squareSearcher.emplace(form.squareSpace, form.squareBisections, form.squareCorners);
    }
    int degree = 0;
    for (const BernsteinFactor& factor : form.space.factors())
    {
      degree = std::max(degree, factor.degree);
    }
    splitNoise = degree * levelRounding;
  }

  /// Loads a batch, repeating the last element.
  void loadBatch(const double* points, const Index* const* elements, int count)
  {
    Packet extent = {};
    for (std::size_t k = 0; k < this->packets.nodes.size(); ++k)
    {
      const double* p[PacketWidth];
      for (int l = 0; l < PacketWidth; ++l)
      {
        p[l] = points + 3 * elements[std::min(l, count - 1)][k];
      }
      Packet* node = this->packets.nodes[k].c;
      loadPoints(p, node);
      for (int c = 0; c < 3; ++c)
      {
        extent = max(extent, abs(node[c] - this->packets.nodes[0].c[c]));
      }
    }
    if (any(~((extent > SmallExtent) & (extent < LargeExtent))))
    {
      const Packet perUnit = 1.0 / each(extent, unitOfElement);
      for (auto& node : this->packets.nodes)
      {
        for (Packet& x : node.c)
        {
          x *= perUnit;
        }
      }
    }
    this->place(this->packets);
  }

  /// The coefficients of the batch, and their noise.
  Packet runBatch()
  {
    if (!this->surface)
    {
      this->packets.run();
      return this->packets.noise;
    }
    this->packets.runNormals();
    auto mean = this->packets.meanNormal();
    const Packet length = sqrt(mean.square());
    for (Packet& c : mean.c)
    {
      c /= length;
    }
    this->packets.project(mean);
    return 2 * this->packets.noise;
  }

  void keep(const DeterminantWork<double>& from)
  {
    std::transform(from.coefficients.begin(), from.coefficients.end(), this->coefficients.begin(),
      [](const DeterminantWork<double>::Scalar& c) { return c.value; });
  }

  const ElementType& type;
  DeterminantWork<Packet> packets;
  DeterminantWork<double> one;
  std::vector<double> coefficients; ///< of one element
  std::vector<double> square;       ///< of the normal of a surface
  BernsteinSearch searcher;
  std::optional<BernsteinSearch> squareSearcher;
  double splitNoise = 0; ///< of subdivision, over the largest coefficient
};

//------------------------------------------------------------------------------
JacobianCertifier::JacobianCertifier(const ElementType& type, const Vec3& normal, bool mirrored)
  : Memory(new Work(type, normal, mirrored))
{
}

JacobianCertifier::~JacobianCertifier() = default;
JacobianCertifier::JacobianCertifier(JacobianCertifier&&) noexcept = default;

//------------------------------------------------------------------------------
ElementValidity JacobianCertifier::search(const double* coefficients, double noise)
{
  Work& work = *this->Memory;
  double largest = 0;
  for (std::size_t k = 0; k < work.coefficients.size(); ++k)
  {
    largest = std::max(largest, std::abs(coefficients[k]));
  }
  const BernsteinSign sign = work.searcher.sign(coefficients, noise + work.splitNoise * largest);
  this->Counts.searched += work.searcher.splits() > 0;
  this->Counts.splits += work.searcher.splits();
  this->Counts.undecided += !work.searcher.decided();
  return static_cast<ElementValidity>(sign);
}

//------------------------------------------------------------------------------
ElementValidity JacobianCertifier::searchSurface()
{
  // Classifies the normals of the loaded element, first along their mean.
  Work& work = *this->Memory;
  DeterminantWork<double>& one = work.one;
  if (!std::isfinite(one.noise))
  {
    return ElementValidity::NonFinite;
  }
  DeterminantWork<double>::Vector mean = one.meanNormal();
  const double length = std::sqrt(mean.square());
  ElementValidity along = ElementValidity::Degenerate;
  if (length > 2 * one.noise)
  {
    for (double& c : mean.c)
    {
      c /= length;
    }
    one.project(mean);
    work.keep(one);
    double aside2 = 0;
    for (std::size_t k = 0; k < one.normals.size(); ++k)
    {
      double sum = 0;
      for (int c = 0; c < 3; ++c)
      {
        const double aside = one.normals[k].c[c] - work.coefficients[k] * mean.c[c];
        sum += aside * aside;
      }
      aside2 = std::max(aside2, sum);
    }
    along = this->search(work.coefficients.data(), 2 * one.noise);
    // If all normals are parallel, they vanish where they change sides.
    const bool flat = aside2 <= 16 * one.noise * one.noise;
    if (along == ElementValidity::Valid || flat)
    {
      return along;
    }
  }
  const ElementValidity square = this->searchSquare();
  return square == ElementValidity::Degenerate ? along : square;
}

//------------------------------------------------------------------------------
ElementValidity JacobianCertifier::searchSquare()
{
  // The squared normal is positive where the normal does not vanish.
  Work& work = *this->Memory;
  const DeterminantWork<double>& one = work.one;
  const DeterminantForm& form = work.type.determinant();
  std::fill(work.square.begin(), work.square.end(), 0.0);
  double longest2 = 0;
  for (int i = 0; i < form.space.size(); ++i)
  {
    const double* a = one.normals[i].c;
    longest2 = std::max(longest2, one.normals[i].square());
    for (int j = 0; j < form.space.size(); ++j)
    {
      const double* b = one.normals[j].c;
      work.square[form.square.targets(i)[j]] += form.space.multinomial(i) *
        form.space.multinomial(j) * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
  }
  for (int k = 0; k < form.squareSpace.size(); ++k)
  {
    work.square[k] /= form.squareSpace.multinomial(k);
  }
  const double noise = 4 * one.noise * std::sqrt(longest2) +
    (2 * work.splitNoise + form.square.terms() * 0x1p-51) * longest2;
  const BernsteinSign sign = work.squareSearcher->sign(work.square.data(), noise);
  this->Counts.splits += work.squareSearcher->splits();
  this->Counts.undecided += !work.squareSearcher->decided();
  return sign == BernsteinSign::Positive ? ElementValidity::Valid : ElementValidity::Degenerate;
}

//------------------------------------------------------------------------------
void JacobianCertifier::classify(
  const double* points, const Index* const* elements, Index count, ElementValidity* validity)
{
  this->Counts.elements += count;
  for (Index begin = 0; begin < count; begin += PacketWidth)
  {
    const int lanes = static_cast<int>(std::min<Index>(PacketWidth, count - begin));
    this->classifyBatch(points, elements + begin, lanes, validity + begin);
  }
}

//------------------------------------------------------------------------------
void JacobianCertifier::classifyBatch(
  const double* points, const Index* const* elements, int count, ElementValidity* validity)
{
  Work& work = *this->Memory;
  work.loadBatch(points, elements, count);
  const Packet noise = work.runBatch();
  const auto& coefficients = work.packets.coefficients;
  Packet least = coefficients[0].value, atCorners = least;
  for (const auto& c : coefficients)
  {
    least = min(least, c.value);
  }
  for (const BernsteinCorner& corner : work.type.determinant().corners)
  {
    atCorners = min(atCorners, coefficients[corner.coefficient].value);
  }
  const Mask finite = abs(noise) <= std::numeric_limits<double>::max();
  const Mask valid = finite & (least > noise);
  const Mask invalid = finite & (atCorners < -noise);
  for (int l = 0; l < count; ++l)
  {
    if (valid[l])
    {
      validity[l] = ElementValidity::Valid;
    }
    else if (work.surface)
    {
      work.load(work.one, points, elements[l]);
      work.one.runNormals();
      validity[l] = this->searchSurface();
    }
    else if (!finite[l])
    {
      validity[l] = ElementValidity::NonFinite;
    }
    else if (invalid[l])
    {
      validity[l] = ElementValidity::Invalid;
    }
    else
    {
      for (std::size_t k = 0; k < coefficients.size(); ++k)
      {
        work.coefficients[k] = coefficients[k].value[l];
      }
      validity[l] = this->search(work.coefficients.data(), noise[l]);
    }
  }
}

//------------------------------------------------------------------------------
JacobianBound JacobianCertifier::minimum(
  const double* points, const Index* nodes, const MinimumTolerance& tolerance)
{
  Work& work = *this->Memory;
  DeterminantWork<double>& one = work.one;
  JacobianBound bound;
  ++this->Counts.elements;
  const double unit = work.load(work.one, points, nodes);
  if (work.surface)
  {
    one.runNormals();
    bound.validity = this->searchSurface();
    auto mean = one.meanNormal();
    const double length = std::sqrt(mean.square());
    for (double& c : mean.c)
    {
      c /= length > 0 ? length : 1;
    }
    one.project(mean);
  }
  else
  {
    one.run();
  }
  if (!std::isfinite(one.noise))
  {
    bound.validity = ElementValidity::NonFinite;
    bound.lower = bound.upper = std::numeric_limits<double>::quiet_NaN();
    return bound;
  }
  work.keep(one);
  if (!work.surface)
  {
    const double least = *std::min_element(work.coefficients.begin(), work.coefficients.end());
    bound.validity = least > one.noise ? ElementValidity::Valid
                                       : this->search(work.coefficients.data(), one.noise);
  }
  const double scale = std::pow(unit, work.type.dimension());
  MinimumTolerance scaled = tolerance;
  scaled.level /= scale;
  const BernsteinMinimum minimum = work.searcher.minimum(work.coefficients.data(), scaled);
  this->Counts.splits += work.searcher.splits();
  bound.lower = scale * minimum.lower;
  bound.upper = scale * minimum.upper;
  bound.at = minimum.at;
  return bound;
}

//------------------------------------------------------------------------------
double JacobianCertifier::meanJacobian(const double* points, const Index* nodes)
{
  Work& work = *this->Memory;
  DeterminantWork<double>& one = work.one;
  const double scale = std::pow(work.load(work.one, points, nodes), work.type.dimension());
  if (work.surface)
  {
    one.runNormals();
    return scale * std::sqrt(one.meanNormal().square());
  }
  one.run();
  double sum = 0;
  for (const auto& c : one.coefficients)
  {
    sum += c.value;
  }
  return scale * sum / static_cast<double>(one.coefficients.size());
}

//------------------------------------------------------------------------------
ElementOrientation orientationOf(const ElementType& type, const double* points,
  const Index* const* elements, Index count, const Vec3& normal)
{
  JacobianCertifier certifier(type, normal);
  ElementOrientation orientation;
  for (Index i = 0; i < count; ++i)
  {
    const double mean = certifier.meanJacobian(points, elements[i]);
    orientation.positive += mean > 0;
    orientation.negative += mean < 0;
  }
  return orientation;
}
}
