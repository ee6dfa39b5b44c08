// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapeRetrieval
 * @brief "Shape Retrieval": matches the silhouettes of a set with each other, and ranks the
 * matches.
 *
 * @par Input:
 * vtkMultiBlockDataSet of images, as from vtkSilhouetteSetReader: the name of a block is the name
 * of the shape, and its field array `Label` (string or number) the class. Without labels, the class
 * is the name up to its first digit.
 *
 * @par Output ports 0 to 3, vtkTable:
 * Port 0, Distances: `Name`, `Label` and a column per shape with the distance to it; -1 if the run
 * ended before it was computed. Port 1, Ranking: a row for each of the best matches of each query:
 * `Query`, `QueryLabel`, `Rank`, `Match`, `MatchLabel`, `Distance`, `Correct`. Port 2, Statistics:
 * a row per rank, `Rank`, `Correct` (number of queries whose match at this rank belongs to their
 * class), `Rate` in percent of the queries; the field array `RecognitionRate` (percent of all)
 * equals GetRecognitionRate(). Port 3, Confusion: `Label` and a column per class: the percentage of
 * the best matches of a class's shapes that belong to each class.
 *
 * @par Output port 4, vtkImageData:
 * Sheet: a square picture (colors, the array `Sheet`) with a row for each query, in a gray frame,
 * and its best matches, at most 10, in a green frame if they belong to its class, otherwise in a
 * red one.
 *
 * The recognition rate is the number of best matches of the query's own class, as a fraction of the
 * possible number (dissertation section 5.3); the query itself does not count.
 *
 * @sa vtkSilhouetteSetReader, vtkShapeMatcher, tautline::retrieveShapes
 * (tautline/Shapes/ShapeRetrieval.h)
 */

#ifndef vtkShapeRetrieval_h
#define vtkShapeRetrieval_h

#include "TautlineShapesModule.h" // for export macro
#include "vtkShapeAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <memory> // for the group

namespace tautline
{
class RankGroup;
struct RetrievalOptions;
}

class TAUTLINESHAPES_EXPORT vtkShapeRetrieval : public vtkShapeAlgorithm
{
public:
  static vtkShapeRetrieval* New();
  vtkTypeMacro(vtkShapeRetrieval, vtkShapeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The names of the settings.
   */
  enum Settings
  {
    CUSTOM = 0,
    DISSERTATION = 1,
    FELZENSZWALB = 2,
    HIGHEST = 3
  };

  ///@{
  /**
   * CUSTOM (0): the current properties. DISSERTATION (1): spacing 25, 30 x 30 grid, a = 4 b, theta
   * = d_max / 3. FELZENSZWALB (2): the same without the distortion and the center of mass. HIGHEST
   * (3, the default): polygons are matched with outlines instead of images, in order
   * (tautline/Shapes/OutlineMatch.h), independent of the sizes, directions and mirroring of the
   * shapes. All settings except CUSTOM override the properties of the energy, the locations, the
   * spacing, the rule and Symmetric.
   */
  vtkTautlineSetRangeMacro(Setting, int, CUSTOM, HIGHEST);
  vtkGetMacro(Setting, int);
  ///@}

  ///@{
  /**
   * Distance of vertices along the outlines in pixels, above 0. The default is 25.
   */
  vtkSetMacro(Spacing, double);
  vtkGetMacro(Spacing, double);
  ///@}

  ///@{
  /**
   * Whether the distance includes both directions, each weighted by its number of triangles. The
   * default is off.
   */
  vtkSetMacro(Symmetric, bool);
  vtkGetMacro(Symmetric, bool);
  vtkBooleanMacro(Symmetric, bool);
  ///@}

  ///@{
  /**
   * The number of other shapes with which each shape is matched (the ones with the most similar
   * distribution of descriptors), at least 0; 0, the default, means all. Only with HIGHEST.
   * Distances that are not computed are -1.
   */
  vtkSetMacro(Shortlist, int);
  vtkGetMacro(Shortlist, int);
  ///@}

  ///@{
  /**
   * The number of nearest neighbors in the graphs over which distances are diffused, at least 0; 0,
   * the default, means no diffusion. Diffused distances depend on the whole set, so that rates with
   * and without diffusion are not comparable.
   */
  vtkSetMacro(Neighbors, int);
  vtkGetMacro(Neighbors, int);
  ///@}

  ///@{
  /**
   * Number of matches per query that count, at least 1. The default is 10.
   */
  vtkSetMacro(BestMatches, int);
  vtkGetMacro(BestMatches, int);
  ///@}

  ///@{
  /**
   * Width and height of the sheet of pictures, pixels, 64 to 20,000. The default is 1200.
   */
  vtkTautlineSetRangeMacro(SheetSize, int, 64, 20000);
  vtkGetMacro(SheetSize, int);
  ///@}

  ///@{
  /**
   * Results of the last run: the rate in percent, and a summary.
   */
  vtkGetMacro(RecognitionRate, double);
  ///@}

protected:
  vtkShapeRetrieval();
  ~vtkShapeRetrieval() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkShapeRetrieval(const vtkShapeRetrieval&) = delete;
  void operator=(const vtkShapeRetrieval&) = delete;

  /// The work of the other processes in step with the first, which is in RequestData().
  void Assist();

  tautline::RetrievalOptions GetOptionsOfRun();

  std::unique_ptr<tautline::RankGroup> Group; ///< for several processes, during an execution
  int Setting = HIGHEST;
  double Spacing = 25.0;
  bool Symmetric = false;
  int Shortlist = 0;
  int Neighbors = 0;
  int BestMatches = 10;
  int SheetSize = 1200;
  double RecognitionRate = 0.0;
};

#endif
