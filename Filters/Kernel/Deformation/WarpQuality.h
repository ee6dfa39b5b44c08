/**
 * @file WarpQuality.h
 * @brief How much a deformation has changed the shapes of the elements.
 */
#ifndef tautline_WarpQuality_h
#define tautline_WarpQuality_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/**
 * @brief The TMP shape metric (4.22) of each element at new points against the mesh, the mean over
 * its corners; NaN where it is inverted or degenerate, or of a type that is not computed with.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> shapeSimilarity(
  const Mesh& mesh, const double* points, int threads = 0);
}
#endif
