// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapeRetrieval
 * @brief "Shape Retrieval": matches each of a set of silhouettes with each other one, and ranks
 * them.
 *
 * @par Input:
 * vtkMultiBlockDataSet of images, as the silhouette-set reader gives them: the name of a block is
 * the name of the shape, its field array `Label` (string or number) the class. Without labels the
 * class is the name up to its first digit.
 *
 * @par Output ports 0 to 3, vtkTable:
 * Port 0, Distances: `Name`, `Label` and a column per shape with the distance to it; -1 where the
 * run ended before. Port 1, Ranking: a row for each of the best matches of each query: `Query`,
 * `QueryLabel`, `Rank`, `Match`, `MatchLabel`, `Distance`, `Correct`. Port 2, Statistics: a row per
 * rank, `Rank`, `Correct` (queries whose match at that rank is of their class), `Rate` in percent
 * of the queries; the field array `RecognitionRate` (percent of all) is also GetRecognitionRate().
 * Port 3, Confusion: `Label` and a column per class: the percentage of the best matches of a
 * class's shapes that are of each class.
 *
 * @par Output port 4, vtkImageData:
 * Sheet: a square picture (colours, the array `Sheet`) with a row for each query, in a grey frame,
 * and its best matches, at most 10, in a green frame if they are of its class, in a red one if not.
 *
 * The recognition rate is the number of best matches of the query's own class, as a fraction of
 * those possible (dissertation section 5.3); the query itself does not count.
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
   * Settings by name.
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
   * CUSTOM (0): the properties as they are. DISSERTATION (1): spacing 25, 30 x 30 grid, a = 4 b,
   * theta = d_max / 3. FELZENSZWALB (2): the same without the distortion and the centre of mass.
   * HIGHEST (3, the default): polygons are placed on outlines rather than in images, in order
   * (tautline/Shapes/OutlineMatch.h), whatever the sizes, directions and mirroring of the shapes.
   * All but CUSTOM override the properties of
   * the energy, the locations, the spacing, the rule and Symmetric.
   */
  vtkTautlineSetRangeMacro(Setting, int, CUSTOM, HIGHEST);
  vtkGetMacro(Setting, int);
  ///@}

  ///@{
  /**
   * Distance of vertices along the outlines, pixels, above 0. The default is 25.
   */
  vtkSetMacro(Spacing, double);
  vtkGetMacro(Spacing, double);
  ///@}

  ///@{
  /**
   * Whether the distance counts both directions, each by its number of triangles. Off by default.
   */
  vtkSetMacro(Symmetric, bool);
  vtkGetMacro(Symmetric, bool);
  vtkBooleanMacro(Symmetric, bool);
  ///@}

  ///@{
  /**
   * Of each shape, the number of others that it is matched with, those whose descriptors are
   * distributed most alike, at least 0; 0, the default: all. With HIGHEST only. Distances that are
   * not computed are -1.
   */
  vtkSetMacro(Shortlist, int);
  vtkGetMacro(Shortlist, int);
  ///@}

  ///@{
  /**
   * Distances are replaced by those after diffusion over graphs of so many nearest neighbours, at
   * least 0; 0, the default: they are not. They then depend on the whole set, so rates with and
   * without it do not compare.
   */
  vtkSetMacro(Neighbors, int);
  vtkGetMacro(Neighbors, int);
  ///@}

  ///@{
  /**
   * Matches per query that count, at least 1. The default is 10.
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
   * Results of the last run: the rate in percent, and what was found, in words.
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

  /// What the other processes do while the first one is in RequestData(), in step with it.
  void Assist();

  tautline::RetrievalOptions GetOptionsOfRun();

  std::unique_ptr<tautline::RankGroup> Group; ///< of several processes, in an execution
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
