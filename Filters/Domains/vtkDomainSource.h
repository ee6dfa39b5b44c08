// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkDomainSource
 * @brief The geometric domains of the dissertation, meshed with a requested number of cells.
 *
 * The shapes follow the figures (tautline/Domains/Domains.h lists them with their numbers); the
 * dissertation gives no dimensions and its meshes are not published, so these are similar shapes,
 * not the same meshes. Structured domains (rectangle, square) are exact and have no dependency; the
 * others need the module Meshing and report an error if it was not built.
 *
 * Output 0, vtkUnstructuredGrid of triangles or tetrahedra. Point arrays:
 * - `BoundaryMarker`: 0 inside, 1 on the outer boundary, 2, 3, ... on holes and other parts;
 * - `Fixed`: 1 on the boundary, 0 inside, the usual choice of fixed points for an optimizer;
 * - `Displacement`: 3 components, only for moving domains: the motion of boundary points; 0 inside.
 *
 * Cell array `Reference`, square only: 1 in the unit square, 2 in the interaction layer around it.
 *
 * Output 1, vtkPolyData `Deformed Boundary`: the boundary with its points moved by Displacement
 * (not moved for domains at rest), with the cell array `BoundaryMarker` (structured domains: no
 * cells).
 *
 * The number of cells is met within 5 % (usually 0.5 % in 2D, 2 % in 3D) by repeating the meshing
 * with a corrected size, if it is at least 3,000 (2D) or 20,000 (3D); the details of a shape may
 * make fewer cells impossible. Structured domains use the nearest number that their grid allows.
 * The mesh is deterministic: the same properties give the same mesh.
 *
 * @sa vtkTriangleMesher vtkTetGenMesher tautline::domains
 */
#ifndef vtkDomainSource_h
#define vtkDomainSource_h

#include "TautlineDomainsModule.h" // for export macro
#include "vtkTautlineSetRange.h"   // for the setters
#include "vtkUnstructuredGridAlgorithm.h"

#include <string> // for the name

class TAUTLINEDOMAINS_EXPORT vtkDomainSource : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkDomainSource* New();
  vtkTypeMacro(vtkDomainSource, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The domain, as an index into GetDomainName(). The default is 0, the wrench. An invalid number
   * is an error, and the domain does not change.
   */
  void SetDomain(int domain);
  vtkGetMacro(Domain, int);
  ///@}

  /**
   * The domain, by name. An unknown name is an error that lists the names.
   */
  void SetDomainByName(const char* name);

  ///@{
  /**
   * The available domains.
   */
  static int GetNumberOfDomains();
  static const char* GetDomainName(int domain);
  ///@}

  /**
   * Whether the domains that are not structured can be made.
   */
  static bool HasMeshing();

  ///@{
  /**
   * Number of cells; 0 stands for the number in the dissertation's example. The default is 0. The
   * square is determined by ElementSize instead.
   */
  vtkTautlineSetRangeMacro(NumberOfCells, vtkIdType, 0, 100000000);
  vtkGetMacro(NumberOfCells, vtkIdType);
  ///@}

  ///@{
  /**
   * The fraction of the motion of a moving boundary; negative values reverse it. The default is 1.
   */
  vtkTautlineSetRangeMacro(Amount, double, -10.0, 10.0);
  vtkGetMacro(Amount, double);
  ///@}

  ///@{
  /**
   * Square only: leg of the isotropic right triangle. The default is 0.1.
   */
  vtkTautlineSetRangeMacro(ElementSize, double, 1e-4, 1.0);
  vtkGetMacro(ElementSize, double);
  ///@}

  ///@{
  /**
   * Square only: ratio of the legs, at the same number of triangles. The default is 1.
   */
  vtkTautlineSetRangeMacro(AspectRatio, double, 1.0, 1e4);
  vtkGetMacro(AspectRatio, double);
  ///@}

  ///@{
  /**
   * Square only: minimum width of the interaction layer. The default is 0.2.
   */
  vtkTautlineSetRangeMacro(LayerWidth, double, 0.0, 10.0);
  vtkGetMacro(LayerWidth, double);
  ///@}

  ///@{
  /**
   * Time limit of an execution in seconds, at least 0; 0 means no limit. After it the execution
   * ends with an error. The default is 600.
   */
  vtkTautlineSetRangeMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  /// Ends the execution on abort and at the time limit.
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkDomainSource();
  ~vtkDomainSource() override = default;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Domain = 0;
  vtkIdType NumberOfCells = 0;
  double Amount = 1.0;
  double ElementSize = 0.1;
  double AspectRatio = 1.0;
  double LayerWidth = 0.2;
  double TimeLimit = 600.0;

private:
  vtkDomainSource(const vtkDomainSource&) = delete;
  void operator=(const vtkDomainSource&) = delete;
};

#endif
