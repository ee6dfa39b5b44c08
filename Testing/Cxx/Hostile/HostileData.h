// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HostileData.h
 * @brief Data that a filter may meet but was not written for: empty, degenerate, of other types,
 * corrupt.
 */

#ifndef tautline_HostileData_h
#define tautline_HostileData_h

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkDataSet;

namespace tautline
{

/** The required reaction of a filter to a data object. */
enum class Expected
{
  Anything, ///< a result that passes the checks, or an error
  Result,   ///< a result that passes the checks
  Error     ///< an error
};

/** One hostile data object, made from one that suits the filter. */
struct HostileData
{
  std::string name;
  /** Makes it; null where it cannot be made from this data object, and there is no test. */
  std::function<vtkSmartPointer<vtkDataObject>(vtkDataObject* suitable)> make;
  Expected expected = Expected::Anything;
  /** Whether its numbers are so extreme that only crashes and hangs count. */
  bool extreme = false;
  /** Whether it has coordinates that are not finite. */
  bool nonFinite = false;
  /** If not empty: what to do with the filter besides. */
  std::function<void(vtkAlgorithm*)> prepare = {};
};

/** All of them, and `random` mutations of the suitable data with seeds from 1. */
std::vector<HostileData> hostileData(int random);

/** A data object that is shown at two time steps with different numbers of points. */
vtkSmartPointer<vtkAlgorithm> timeSource(vtkDataObject* data);

/** The data sets of composite data, or the one. */
std::vector<vtkDataSet*> leavesOf(vtkDataObject* data);

/** Hashes of all that a data object consists of, and its modification time. */
std::string fingerprint(vtkDataObject* data);

} // namespace tautline

#endif
