// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::QualityTotals
 * @brief Gathers the measurements of vtkElementQuality on blocks and processes, and fills its
 * tables.
 */
#ifndef tautline_QualityTotals_h
#define tautline_QualityTotals_h

#include "Blocks.h"
#include "tautline/Quality/CurvedQuality.h"
#include "tautline/Quality/Statistics.h"

#include <map>
#include <string>
#include <vector>

class vtkDataArray;
class vtkMultiProcessController;
class vtkPolyData;
class vtkTable;

namespace tautline
{
class QualityTotals
{
public:
  explicit QualityTotals(const std::vector<Metric>& metrics);

  const std::vector<Metric>& metrics() const { return this->Metrics; }

  /// Call before adding the metrics of a block: adds its dimension, validity and angles. `skip` as
  /// in CellValues.
  void addBlock(const Mesh& mesh, const signed char* validity, const unsigned char* skip,
    const BlockPlace& place, int threads);

  /**
   * @brief Call next for a block with curved cells.
   * @param places their positions in the output Worst, a point per cell of the mesh; must be kept
   * alive until the next block
   */
  void addCurved(const MissedCells& missed, const double* places);

  /**
   * @brief Adds the values of metric number m for the last block added.
   * @param globalIds of its cells, or null
   */
  void addValues(std::size_t m, const Mesh& mesh, const CellValues& data, vtkDataArray* globalIds);

  /// Sets the checks of solvers, the same on all processes.
  void setChecks(const std::vector<int>& checks);
  std::vector<int> checks() const;
  /// Adds the values of a check of solvers for the last block added, see ElementChecks.h.
  void addCheck(int check, const signed char* validity, const unsigned char* skip,
    const double* values, Index cells);

  /// Sends everything to process 0. Collective; does nothing without a controller.
  void gather(vtkMultiProcessController* controller);

  /// Fills the tables; may reorder the gathered data.
  void tabulate(vtkTable* statistics, int bins, vtkTable* distribution, vtkTable* angles,
    vtkPolyData* worst, vtkTable* histogram);

  /// A few lines for the user.
  std::string summary() const;

  /// Bytes held.
  std::size_t bytes() const;

private:
  struct Worst
  {
    WorstElement element; ///< its cell is a global id, or numbered over blocks and processes
    Vec3 center;
    bool isGlobal = false; ///< whether it is a global id
    Index cell = 0;        ///< its index in its data set
    BlockPlace place;      ///< of its data set
    int process = 0;       ///< the process that has it
  };
  struct PerMetric
  {
    std::vector<double> measured;
    std::vector<Worst> worst;
    MetricStatistics statistics;
  };
  /// The range of a check over the measured cells.
  struct CheckRange
  {
    double least, most;
  };
  void mergeWorst(std::size_t m, std::vector<Worst> more);
  void fillDistribution(int bins, vtkTable* table);
  void fillHistogram(int bins, vtkTable* table) const;
  void fillStatistics(vtkTable* statistics) const;
  void fillWorstColumns(vtkTable* statistics) const;
  void fillWorstPoints(vtkPolyData* output) const;
  void fillAngles(vtkTable* angles) const;
  std::string nameOf(const Worst& worst) const;

  std::vector<Metric> Metrics;
  std::vector<PerMetric> Results;
  std::array<Index, angleBins.size() - 1> Angles{};
  ValidityCounts Counts;
  MissedCells Missed;
  std::map<int, CheckRange> Checks;
  const double* Places = nullptr; ///< for the last block added, if it has curved cells
  Index CellsBefore = 0;          ///< cells of the blocks before the last one
  Index CellsOfLast = 0;
  int Dimension = 2;
  bool HasGlobalIds = false;
  BlockPlace Place;  ///< of the block added last
  int Processes = 1; ///< number of processes that have cells
};
}
#endif
