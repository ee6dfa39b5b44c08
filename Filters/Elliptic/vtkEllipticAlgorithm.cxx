// SPDX-License-Identifier: BSD-3-Clause
#include "vtkEllipticAlgorithm.h"

#include "Blocks.h"
#include "EllipticInput.h"
#include "ProgressStep.h"
#include "TableRows.h"

#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkSelection.h"
#include "vtkTable.h"

#include <algorithm>
#include <optional>
#include <sstream>

namespace
{
enum Ports
{
  MeshPort = 0,
  SelectionPort = 1, // input
  TablePort = 1,
  NumberOfPorts = 2
};

enum Arrays
{
  FixedArray = 0,
  SourceArray = 1,
  GivenArray = 2,
  TensorArray = 3,
  StiffnessArray = 4
};

constexpr double AssemblyShare = 0.25; // fraction of the progress on a mesh
}

//------------------------------------------------------------------------------
vtkEllipticAlgorithm::vtkEllipticAlgorithm()
{
  this->DeclarePorts(NumberOfPorts, NumberOfPorts, { SelectionPort });
}

//------------------------------------------------------------------------------
vtkEllipticAlgorithm::~vtkEllipticAlgorithm() = default;

//------------------------------------------------------------------------------
/// A system and the mesh on which it was assembled, without the output of that execution.
struct vtkEllipticAlgorithm::KeptSystem
{
  KeptSystem(const tautline::LocalMesh& mesh, const tautline::EllipticChoice& choice,
    vtkAlgorithm* algorithm, tautline::RankGroup& processes, int threads)
    : Mesh(mesh)
    , Input(this->Mesh, choice, algorithm, processes, threads)
  {
    this->Mesh.output = nullptr;
  }

  tautline::LocalMesh Mesh;
  tautline::EllipticInput Input;
};

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::ForgetSystems()
{
  this->Systems.clear();
}

//------------------------------------------------------------------------------
const tautline::EllipticInput& vtkEllipticAlgorithm::Assembled(const tautline::LocalMesh& mesh,
  const tautline::EllipticChoice& choice, tautline::RankGroup& processes)
{
  const std::size_t number = static_cast<std::size_t>(mesh.number);
  this->Systems.resize(std::max(this->Systems.size(), number + 1));
  std::shared_ptr<KeptSystem>& kept = this->Systems[number];
  if (!kept)
  {
    kept = std::make_shared<KeptSystem>(mesh, choice, this, processes, this->Threads);
    ++this->Assemblies;
  }
  return kept->Input;
}

//------------------------------------------------------------------------------
tautline::EllipticChoice vtkEllipticAlgorithm::GetChoice() const
{
  const auto vector = [](const double* v) { return tautline::Vec3{ v[0], v[1], v[2] }; };
  const bool elastic = this->Equation == ELASTICITY;
  tautline::EllipticChoice choice;
  choice.pde = static_cast<tautline::Pde>(this->Equation);
  choice.diffusion = { this->Alpha, this->Beta, this->Gamma };
  choice.reaction = this->Reaction;
  choice.tensorArray = TensorArray;
  choice.youngsModulus = this->YoungsModulus;
  choice.poissonRatio = this->PoissonRatio;
  choice.plane = static_cast<tautline::PlaneState>(this->PlaneState);
  choice.stiffnessArray = StiffnessArray;
  choice.source = { "source", this->SourceType,
    elastic ? vector(this->BodyForce) : tautline::Vec3{ this->SourceValue, 0, 0 }, SourceArray,
    this->SourceExpression };
  choice.given = { "given solution", this->GivenType,
    elastic ? vector(this->GivenDisplacement) : tautline::Vec3{ this->GivenValue, 0, 0 },
    GivenArray, this->GivenExpression };
  choice.given.finite = false; // only the values at fixed points count, which the system checks
  choice.fixedPart = this->FixedPart;
  choice.fixedWhere = this->FixedWhere;
  choice.fixedArray = FixedArray;
  choice.redistribution = static_cast<tautline::Redistribution>(this->Redistribute);
  return choice;
}

//------------------------------------------------------------------------------
int vtkEllipticAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  this->ClearResult();
  this->Failed = false;
  this->Fraction = 0.0;
  this->Unknowns = 0;
  this->AssemblySeconds = 0.0;
  if (!this->KeepsSystems())
  {
    this->ForgetSystems();
  }
  const int succeeded = this->Attempt(outputVector, "solve on a coarser mesh, or on more processes",
    [&]
    {
      const auto group = tautline::makeProcessGroup();
      tautline::RankGroup& processes = *group;
      processes.together(
        [&]
        {
          const tautline::EllipticChoice choice = this->GetChoice();
          tautline::TableRows rows;
          const vtkSmartPointer<vtkDataObject> selected =
            tautline::markSelected(input, vtkSelection::GetData(inputVector[SelectionPort]));
          tautline::forEachMesh(input, selected, output, this->MergeCoincidentPoints, processes,
            [&](tautline::LocalMesh& mesh)
            {
              std::optional<tautline::ProgressStep> assembly(std::in_place, this,
                static_cast<double>(mesh.number) / mesh.meshes,
                (mesh.number + AssemblyShare) / mesh.meshes);
              const tautline::EllipticInput& problem = this->Assembled(mesh, choice, processes);
              assembly.reset();
              this->Unknowns += problem.system().unknowns();
              this->AssemblySeconds += problem.system().assembleSeconds();
              this->HaveBest();
              processes.agree(); // before PETSc communicates
              this->Compute(problem, mesh, processes, rows);
              this->Describe(mesh, problem.notice());
              if (!this->KeepsSystems())
              {
                this->Systems[mesh.number].reset(); // frees its memory before the next one
              }
            });
          if (processes.rank() == 0)
          {
            rows.fill(vtkTable::GetData(outputVector, TablePort));
          }
        });
    });
  if (!succeeded)
  {
    this->ForgetSystems();
  }
  if (succeeded && this->Failed)
  {
    vtkWarningMacro(<< this->Summary);
  }
  return succeeded;
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::ClearResult()
{
  this->Superclass::ClearResult();
  this->Failed = false;
  this->Unknowns = 0;
  this->AssemblySeconds = 0.0;
  this->Reset();
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::Reset()
{
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::Describe(const tautline::LocalMesh& mesh, const std::string& text)
{
  if (!text.empty())
  {
    this->AddToSummary((mesh.name.empty() ? "" : "In " + mesh.name + ": ") + text);
  }
}

//------------------------------------------------------------------------------
bool vtkEllipticAlgorithm::Report(const tautline::LocalMesh& mesh, double fraction)
{
  const double done = AssemblyShare + (1.0 - AssemblyShare) * fraction;
  this->Fraction = (mesh.number + done) / mesh.meshes;
  return this->Proceed(this->Fraction);
}

//------------------------------------------------------------------------------
std::function<bool()> vtkEllipticAlgorithm::Cancelled()
{
  return [this]() { return !this->Proceed(this->Fraction); };
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Equation: " << this->Equation << "\n";
  os << indent << "SourceType: " << this->SourceType << "\n";
  os << indent << "FixedPart: " << this->FixedPart << "\n";
  os << indent << "GivenType: " << this->GivenType << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "Redistribute: " << this->Redistribute << "\n";
  os << indent << "PETScOptions: " << this->PETScOptions << "\n";
}
