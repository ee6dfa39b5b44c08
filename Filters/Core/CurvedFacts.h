// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedFacts.h
 * @brief The facts that a data set states about its curved cells.
 */
#ifndef tautline_CurvedFacts_h
#define tautline_CurvedFacts_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/CurvedCells.h"

#include <vector>

class vtkDataSet;

namespace tautline
{
class MeshAdapter;

/// The facts of the cells of an adapter, after MeshAdapter::orient(); both must outlive it.
class TAUTLINECORE_EXPORT CurvedFacts
{
public:
  /// Throws Error if HigherOrderDegrees does not have three components.
  CurvedFacts(vtkDataSet* input, const MeshAdapter& adapter);
  CurvedFacts(const CurvedFacts&) = delete;
  void operator=(const CurvedFacts&) = delete;

  operator const CurvedCellFacts&() const { return this->Facts; }

private:
  CurvedCellFacts Facts;
  std::vector<double> Degrees;
};
}
#endif
