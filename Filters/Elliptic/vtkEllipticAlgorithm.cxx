#include "vtkEllipticAlgorithm.h"

#include "EllipticInput.h"
#include "MovableMesh.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkSelection.h"
#include "vtkTable.h"

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
}

//------------------------------------------------------------------------------
vtkEllipticAlgorithm::vtkEllipticAlgorithm()
{
  this->SetNumberOfInputPorts(NumberOfPorts);
  this->SetNumberOfOutputPorts(NumberOfPorts);
}

//------------------------------------------------------------------------------
vtkEllipticAlgorithm::~vtkEllipticAlgorithm() = default;

//------------------------------------------------------------------------------
int vtkEllipticAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  tautline::declareInput(info, port == SelectionPort, port != MeshPort);
  return 1;
}

//------------------------------------------------------------------------------
int vtkEllipticAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == MeshPort ? "vtkDataObject" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkEllipticAlgorithm::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  if (!input)
  {
    return 0;
  }
  tautline::provideOutputs(input, outputVector);
  return 1;
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
  choice.given.finite = false; // only the values of fixed points count, which the system checks
  choice.fixedPart = this->FixedPart;
  choice.fixedWhere = this->FixedWhere;
  choice.fixedArray = FixedArray;
  return choice;
}

//------------------------------------------------------------------------------
int vtkEllipticAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  vtkTable* table = vtkTable::GetData(outputVector, TablePort);
  this->Summary.clear();
  this->Failed = false;
  this->Unknowns = 0;
  this->AssemblySeconds = 0.0;
  this->Reset();
  try
  {
    const tautline::Processes processes;
    const tautline::EllipticChoice choice = this->GetChoice();
    tautline::TableRows rows;
    vtkSmartPointer<vtkDataObject> selected;
    processes.together(
      [&]() {
        selected = tautline::markSelected(input, vtkSelection::GetData(inputVector[SelectionPort]));
      });
    tautline::forEachMesh(input, selected, output, processes,
      [&](tautline::LocalMesh& mesh)
      {
        const tautline::EllipticInput problem(mesh, choice, this, processes, this->Threads);
        this->Unknowns += problem.system().unknowns();
        this->AssemblySeconds += problem.system().assembleSeconds();
        this->Compute(problem, mesh, processes, rows);
        this->Say(mesh, problem.notice());
      });
    if (processes.rank() == 0)
    {
      rows.fill(table);
    }
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Not enough memory: solve on a coarser mesh, or on more processes.");
    output->Initialize();
    return 0;
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    output->Initialize();
    return 0;
  }
  if (this->Failed)
  {
    vtkWarningMacro(<< this->Summary);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::Reset()
{
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::Say(const tautline::LocalMesh& mesh, const std::string& text)
{
  if (!text.empty())
  {
    this->Summary += (this->Summary.empty() ? "" : "\n") +
      (mesh.name.empty() ? "" : "In " + mesh.name + ": ") + text;
  }
}

//------------------------------------------------------------------------------
bool vtkEllipticAlgorithm::Report(const tautline::LocalMesh& mesh, double fraction)
{
  this->UpdateProgress((mesh.number + fraction) / mesh.meshes);
  return !this->GetAbortExecute();
}

//------------------------------------------------------------------------------
void vtkEllipticAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Equation: " << this->Equation << "\n";
  os << indent << "SourceType: " << this->SourceType << "\n";
  os << indent << "FixedPart: " << this->FixedPart << "\n";
  os << indent << "GivenType: " << this->GivenType << "\n";
  os << indent << "PETScOptions: " << this->PETScOptions << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
}
