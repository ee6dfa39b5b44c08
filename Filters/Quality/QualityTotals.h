// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::QualityTotals
 * @brief Gathers what vtkElementQuality measures on blocks and processes, and makes its tables.
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

  /// Before the metrics of a block: its dimension, validity and angles. `skip` as in CellValues.
  void addBlock(const Mesh& mesh, const signed char* validity, const unsigned char* skip,
    const BlockPlace& place, int threads);

  /**
   * @brief After that, of a block with curved cells.
   * @param places where they are shown among the worst: a point per cell of the mesh; kept alive
   * until the next block
   */
  void addCurved(const MissedCells& missed, const double* places);

  /**
   * @brief Adds the values of metric number m of the block added last.
   * @param globalIds of its cells, or null
   */
  void addValues(std::size_t m, const Mesh& mesh, const CellValues& data, vtkDataArray* globalIds);

  /// The checks of solvers, the same on all processes.
  void setChecks(const std::vector<int>& checks);
  std::vector<int> checks() const;
  /// Adds the values of a check of solvers on the block added last, see ElementChecks.h.
  void addCheck(int check, const signed char* validity, const unsigned char* skip,
    const double* values, Index cells);

  /// Brings everything to process 0. Collective; without a controller, nothing.
  void gather(vtkMultiProcessController* controller);

  /// Fills the tables; may reorder what was gathered.
  void tabulate(vtkTable* statistics, int bins, vtkTable* distribution, vtkTable* angles,
    vtkPolyData* worst, vtkTable* histogram);

  /// A few lines for the user.
  std::string summary() const;

  /// Bytes held.
  std::size_t bytes() const;

private:
  struct Worst
  {
    WorstElement element; ///< its cell is a global id, or counts through blocks and processes
    Vec3 center;
    bool isGlobal = false; ///< the former
    Index cell = 0;        ///< its number in its data set
    BlockPlace place;      ///< of that
    int process = 0;       ///< that has it
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
  const double* Places = nullptr; ///< of the block added last, where it has curved cells
  Index CellsBefore = 0;          ///< cells of the blocks before the last one
  Index CellsOfLast = 0;
  int Dimension = 2;
  bool HasGlobalIds = false;
  BlockPlace Place;  ///< of the block added last
  int Processes = 1; ///< that have cells
};
}
#endif
