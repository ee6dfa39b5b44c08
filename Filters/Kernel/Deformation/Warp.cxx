// SPDX-License-Identifier: BSD-3-Clause
#include "Warp.h"

#include "WarpBoundary.h"
#include "WarpPath.h"
#include "WarpStep.h"
#include "WarpSteps.h"
#include "tautline/Mesh/CoordinateFrame.h"

#include <sstream>

namespace tautline
{
namespace
{
/// "1 element", "2 elements"
std::string counted(Index count, const char* what)
{
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// The choice of Automatic and the reason: the result of each method tried.
std::string explainChoice(const WarpResult& result)
{
  std::ostringstream chosen, others;
  for (const WarpAttempt& attempt : result.attempts)
  {
    std::ostringstream& text = attempt.method == result.chosen ? chosen : others;
    text << (attempt.method == WarpMethod::RadialBasis ? "radial basis functions"
                                                       : "inverse distances with rotations")
         << " (" << counted(attempt.inverted, "inverted element")
         << ", worst inverse mean ratio against the mesh at rest " << attempt.worstRatio << ")";
  }
  const bool repaired = std::any_of(result.history.begin(), result.history.end(),
    [](const WarpRecord& record)
    { return record.stage == "untangle" || record.stage == "optimize"; });
  return "Automatic chose " + chosen.str() + (others.str().empty() ? "" : " over " + others.str()) +
    (repaired ? ". Untangling and optimization followed." : ".");
}

void checkOptions(const Mesh& mesh, const WarpOptions& options, const Ranks& ranks)
{
  const auto refuse = [](bool wrong, const char* text)
  {
    if (wrong)
    {
      throw Error(text);
    }
  };
  refuse(!isKnown(options.method), "Unknown method: choose one of WarpMethod.");
  refuse(!isKnown(options.coefficients),
    "Unknown choice of coefficients: choose one of WarpCoefficients.");
  refuse(options.steps < 0 || options.maximumSteps < 1,
    "The number of steps must not be negative, and their limit at least 1.");
  refuse(!(options.tolerance > 0 && options.tolerance < 1),
    "The tolerance of the solves must lie between 0 and 1 (both exclusive).");
  refuse(!(options.poissonRatio > -1 && options.poissonRatio < 0.5),
    "Poisson's ratio must lie between -1 and 0.5 (both exclusive).");
  refuse(!(options.stiffeningPower >= 0) || !std::isfinite(options.stiffeningPower) ||
      !(options.stiffeningFactor > 1) || options.maximumStiffenings < 0,
    "The power of the stiffening must not be negative, its factor must exceed 1, and the number of "
    "rounds must not be negative.");
  refuse(!(options.untanglingBeta >= 0) || !std::isfinite(options.untanglingBeta),
    "Beta must not be negative.");
  refuse(!(options.maximumSeconds >= 0), "The time limit must not be negative.");
  const bool anisotropic = isAnisotropic(options.method);
  if (anisotropic && options.coefficients == WarpCoefficients::Manual)
  {
    const SymmetricTensor& t = options.tensor;
    refuse(!isPositiveSemidefinite(t.data()) || !(std::max({ t[0], t[1], t[2] }) > 0),
      "The coefficients must be finite and positive semidefinite, and not all 0: for example 1, 0, "
      "0 "
      "for a motion along x.");
  }
  if (anisotropic && options.coefficients == WarpCoefficients::PerCell)
  {
    refuse(!options.tensors && mesh.view().numberOfCells > 0,
      "Coefficients per cell are selected, but not provided.");
    for (Index i = 0; i < mesh.view().numberOfCells; ++i)
    {
      if (!isPositiveSemidefinite(options.tensors + 6 * i))
      {
        // Cell numbers are local to a rank.
        throw Error("The coefficients of " +
          (ranks.several() ? "a cell" : "cell " + std::to_string(i)) +
          " are not finite or not positive semidefinite: correct them, or choose other "
          "coefficients.");
      }
    }
  }
}

void checkMesh(const Mesh& mesh, const WarpParts& parts, const WarpOptions& options)
{
  const Ranks& ranks = parts.ranks();
  if (parts.dimension() == Dimension::None)
  {
    throw Error("The mesh has no cells that can be warped: triangles, quadrilaterals, tetrahedra, "
                "hexahedra, wedges or pyramids.");
  }
  ranks.together([&] { requireOrdinaryScale(mesh.view(), "Warping"); });
  const Index curved = ranks.sum(mesh.higherOrderCells());
  if (curved > 0)
  {
    throw Error(counted(curved, "cell") +
      " of quadratic or higher order: warp the linear cells of the corners, and let the other "
      "nodes "
      "follow, as Warp Mesh does (vtkMeshWarp).");
  }
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), options.threads);
  Index count = 0, first = -1;
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    if (validity[cell] != Valid && validity[cell] != NotMeasured && ranks.ownsCell(cell))
    {
      first = count++ == 0 ? cell : first;
    }
  }
  count = ranks.sum(count);
  if (count > 0)
  {
    // Cell numbers are local to a rank.
    throw Error(counted(count, "element") + (count == 1 ? " is" : " are") +
      " inverted or degenerate before anything moves" +
      (ranks.several() ? "" : ", the first is cell " + std::to_string(first)) +
      ". Untangle the mesh first, or reverse the order of its cells' points.");
  }
  if (parts.prescribedPoints() == 0)
  {
    throw Error("No point of the mesh has a prescribed displacement: select some of its boundary.");
  }
}
}

/// Defects of the moved boundary, which no position of the interior points can repair.
struct BoundaryState
{
  Index inverted = 0, firstInverted = -1; ///< elements of prescribed points alone
  WarpBoundary::Crossing crossing;
};

//------------------------------------------------------------------------------
struct Warper::Implementation
{
  Implementation(const Mesh& mesh, const WarpOptions& options, const Ranks& ranks = {})
    : Input(mesh)
    , Options(options)
    , Parts(mesh, options.prescribed, ranks)
    , First(mesh, mesh, Parts)
    , MovedBoundary(mesh, Parts.prescribed(), ranks)
  {
    ranks.together([&] { checkOptions(mesh, options, ranks); });
    checkMesh(mesh, this->Parts, options);
  }

  double checkDisplacement(const double* displacement) const;
  bool endsWhereItBegins(const WarpMotion& path, std::vector<double>& displacement) const;
  WarpResult run(const WarpMotion& motion, const WarpMotion& path);
  void followMotion(const WarpMotion& path, const double* displacement, WarpControl& control);
  BoundaryState examineBoundary(const double* points) const;
  void explain(WarpControl& control);

  const Ranks& ranks() const { return this->Parts.ranks(); }

  const Mesh& Input;
  WarpOptions Options;
  WarpParts Parts;
  WarpStep First;
  WarpBoundary MovedBoundary;
};

/// Checks that displacements are finite and, for a planar mesh, in its plane. Returns the length of
/// the largest.
double Warper::Implementation::checkDisplacement(const double* displacement) const
{
  const std::vector<unsigned char>& prescribed = this->Parts.prescribed();
  Index wrong = 0, first = 0;
  double out = 0, largest = 0;
  const bool planar = this->Input.dimension() == Dimension::Planar;
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    const double* d = displacement + 3 * i;
    if (!prescribed[i] || !this->ranks().owns(static_cast<Index>(i)))
    {
      continue;
    }
    if (!std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2]))
    {
      first = wrong++ == 0 ? static_cast<Index>(i) : first;
      continue;
    }
    const Vec3 v = { d[0], d[1], d[2] };
    largest = std::max(largest, norm(v));
    out = planar ? std::max(out, std::abs(dot(v, this->Input.normal()))) : 0.0;
  }
  wrong = this->ranks().sum(wrong);
  if (wrong > 0)
  {
    throw Error("The displacements of " + std::to_string(wrong) +
      " prescribed points are NaN or infinite" +
      (this->ranks().several() ? "" : ", the first at point " + std::to_string(first)) + ".");
  }
  out = this->ranks().maximum(out);
  largest = this->ranks().maximum(largest);
  constexpr double rounding = 1e-9;
  if (out > rounding * largest)
  {
    throw Error("The mesh is planar, but the displacements lead out of its plane.");
  }
  return largest;
}

//------------------------------------------------------------------------------
/// Whether the final displacements are 0, or only the rounding error of a closed path such as a
/// full turn.
bool Warper::Implementation::endsWhereItBegins(
  const WarpMotion& path, std::vector<double>& displacement) const
{
  // A single full turn returns only at its end; several turns have no common fraction with these
  // samples.
  constexpr double rounding = 1e-9, somewhere = 0.3819660112501051;
  path(1.0, displacement.data());
  const double end = this->checkDisplacement(displacement.data());
  if (end == 0)
  {
    return true;
  }
  std::vector<double> between(displacement.size(), 0.0);
  path(somewhere, between.data());
  return end <= rounding * this->checkDisplacement(between.data());
}

//------------------------------------------------------------------------------
WarpResult Warper::Implementation::run(const WarpMotion& motion, const WarpMotion& path)
{
  WarpResult result;
  WarpControl control(this->Options, result, this->ranks());
  const WarpMotion checked = [&](double amount, double* displacement)
  {
    path(amount, displacement);
    this->checkDisplacement(displacement);
  };
  const WarpMethod method = this->Options.method;
  std::vector<double> displacement(3 * this->Input.view().numberOfPoints, 0.0);
  result.still = this->endsWhereItBegins(motion, displacement);
  const bool small = method == WarpMethod::SmallStepFemwarp && this->Options.steps == 1;
  if (this->Options.steps > 1 || small || (this->Options.steps == 0 && !untangles(method)))
  {
    warpInSteps(this->Input, this->Parts, checked, small ? 0 : this->Options.steps, false, control);
  }
  else
  {
    // Methods with untangling try a single step first.
    control.proceed(0.0);
    this->First.run(displacement.data(), 1.0, control, result.points);
    const bool follows = result.invertedAfter > 0 || (result.still && this->Options.steps == 0);
    if (untangles(method) && follows && !control.stopped())
    {
      this->followMotion(checked, displacement.data(), control);
    }
  }
  this->explain(control);
  this->ranks().exchange(result.points.data(), 3); // also to points without a local cell
  return result;
}

//------------------------------------------------------------------------------
/// The second attempt, with short steps that are each untangled, if a single step left inverted
/// elements although the moved boundary is valid.
void Warper::Implementation::followMotion(
  const WarpMotion& path, const double* displacement, WarpControl& control)
{
  WarpResult& result = control.result();
  const bool wholeWay = this->Options.steps == 1;
  if (wholeWay)
  {
    const BoundaryState boundary = this->examineBoundary(result.points.data());
    if (boundary.inverted > 0 || boundary.crossing.pairs > 0 || result.impossible > 0)
    {
      return;
    }
  }
  // Keep the first attempt in case the second does not reach the end.
  const WarpResult before = result;
  result.impossible = 0;
  warpInSteps(this->Input, this->Parts, path, 0, true, control);
  if (result.amount == 1.0 && !control.stopped())
  {
    result.invertedWarp = before.invertedWarp;
    result.tensor = before.tensor;
    this->First.improve(displacement, 1.0, control, result.points);
  }
  else if (result.amount < 1.0 && wholeWay)
  {
    // Keep the mesh with the fewest inverted elements at the final boundary position.
    std::vector<WarpRecord> history = std::move(result.history);
    const bool aborted = result.aborted, timeLimit = result.timeLimit;
    result = before;
    result.history = std::move(history);
    result.aborted = aborted;
    result.timeLimit = timeLimit;
  }
}

//------------------------------------------------------------------------------
BoundaryState Warper::Implementation::examineBoundary(const double* points) const
{
  BoundaryState state;
  // Cells all of whose points are prescribed: no solver can change them.
  const MeshView& view = this->Input.view();
  for (const CellBlock& block : this->Input.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      Vec3 p[MaxNodes];
      bool all = true;
      for (int k = 0; k < t.nodes && all; ++k)
      {
        std::copy_n(points + 3 * node[k], 3, p[k].begin());
        all = this->Parts.prescribed()[node[k]] != 0;
      }
      if (all && this->ranks().ownsCell(cell) && this->Input.classifyCell(t, p) != Valid)
      {
        state.firstInverted = state.inverted++ == 0 ? cell : state.firstInverted;
      }
    }
  }
  state.inverted = this->ranks().sum(state.inverted);
  if (this->Parts.dimension() != Dimension::Surface) // whose boundary consists of curves in space
  {
    state.crossing = this->MovedBoundary.crossings(points);
  }
  if (state.crossing.pairs > 0)
  {
    // Boundaries that touch from the start, such as cracks, may continue to touch.
    state.crossing.pairs =
      std::max(Index(0), state.crossing.pairs - this->MovedBoundary.crossings(view.points).pairs);
  }
  return state;
}

//------------------------------------------------------------------------------
/// Adds the warnings of the result to its message.
void Warper::Implementation::explain(WarpControl& control)
{
  WarpResult& result = control.result();
  if (this->Parts.freePoints() == 0)
  {
    control.addMessage("There are no points between the prescribed ones: nothing had to be "
                       "computed.");
  }
  if (!result.attempts.empty() && !result.still)
  {
    control.addMessage(explainChoice(result));
  }
  if (result.still)
  {
    control.addMessage(
      this->Options.steps == 1 && this->Options.method != WarpMethod::SmallStepFemwarp
        ? "The prescribed points end where they began, so that nothing moves. For a full turn, "
          "use several steps."
        : "The prescribed points end where they began.");
  }
  if (this->Parts.loose() > 0)
  {
    control.addMessage("Without a prescribed point " + counted(this->Parts.loose(), "part") +
      " of the mesh stayed in place.");
  }
  if (result.decoupled > 0)
  {
    control.addMessage("With these coefficients no prescribed point determines " +
      counted(result.decoupled, "point") + " of the mesh, which followed the points around.");
  }
  if (result.regularization > 0)
  {
    std::ostringstream text;
    text << result.regularization;
    control.addMessage(
      "With these coefficients the motion was not bounded; the isotropic operator was added, "
      "times " +
      text.str() + ".");
  }
  const BoundaryState boundary = this->examineBoundary(result.points.data());
  result.impossible = result.invertedAfter > 0 ? std::max(result.impossible, boundary.inverted) : 0;
  result.crossings = boundary.crossing.pairs;
  if (boundary.inverted > 0)
  {
    control.addMessage("The moved boundary itself inverts " +
      counted(boundary.inverted, "element") + ", all of whose points are prescribed" +
      (this->ranks().several()
          ? "."
          : "; the first is cell " + std::to_string(boundary.firstInverted) + "."));
  }
  if (boundary.crossing.pairs > 0)
  {
    const std::string where = ", at points " + std::to_string(boundary.crossing.first[0]) +
      " and " + std::to_string(boundary.crossing.first[1]) + " for example";
    control.addMessage("The moved boundary intersects itself" +
      (this->ranks().several() ? "" : where) + ": move it less far.");
  }
  if (result.invertedAfter > 0)
  {
    control.addMessage(counted(result.invertedAfter, "element") +
      (result.invertedAfter == 1 ? " is" : " are") + " inverted or degenerate.");
  }
  if (result.timeLimit)
  {
    control.addMessage("The time limit was reached.");
  }
  if (result.aborted)
  {
    control.addMessage("Stopped on request.");
  }
}

//------------------------------------------------------------------------------
/// The data for deforming a mesh on several ranks.
struct Warper::Local
{
  Local(const DistributedMesh& spread, bool mirrored, std::vector<Index> ids, int threads)
    : Ids(std::move(ids))
    , Part(spread.view(), threads)
  {
    this->Part.setMirrored(mirrored);
  }
  std::vector<Index> Ids;
  Mesh Part;
};

//------------------------------------------------------------------------------
Warper::Warper(const Mesh& mesh, const WarpOptions& options)
  : Impl(std::make_unique<Implementation>(mesh, options))
{
}

Warper::Warper(DistributedMesh& mesh, bool mirrored, std::vector<Index> ids,
  Communicator communicator, const WarpOptions& options)
{
  mesh.group().together(
    [&]
    {
      if (!options.prescribed && mesh.localPoints() > 0)
      {
        throw Error("The prescribed points of a mesh on several ranks must be given.");
      }
      this->Here = std::make_unique<Local>(mesh, mirrored, std::move(ids), options.threads);
    });
  static const unsigned char none = 0; // not null, which would be the boundary
  static const double noTensor = 0;
  WarpOptions own = options;
  own.prescribed = options.prescribed ? options.prescribed : &none;
  own.tensors = options.tensors || mesh.view().numberOfCells > 0 ? options.tensors : &noTensor;
  this->Impl = std::make_unique<Implementation>(
    this->Here->Part, own, Ranks(mesh, this->Here->Ids, communicator));
}

Warper::~Warper() = default;

void Warper::setMaximumSeconds(double seconds)
{
  this->Impl->Options.maximumSeconds = seconds;
}

WarpResult Warper::warp(const double* displacement)
{
  this->Impl->checkDisplacement(displacement);
  const std::size_t size = 3 * this->Impl->Parts.prescribed().size();
  std::unique_ptr<WarpPath> path; // only where it is needed
  return this->Impl->run([=](double, double* to) { std::copy_n(displacement, size, to); },
    [&](double amount, double* to)
    {
      if (!path)
      {
        path = std::make_unique<WarpPath>(this->Impl->Input, this->Impl->Parts, displacement);
      }
      path->at(amount, to);
    });
}

WarpResult Warper::warp(const std::function<void(double, double*)>& motion)
{
  const WarpMotion together = [&](double amount, double* to)
  { this->Impl->ranks().together([&] { motion(amount, to); }); };
  return this->Impl->run(together, together);
}
}
