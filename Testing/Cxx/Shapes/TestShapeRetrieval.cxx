// Rankings and rates counted by hand; families of shapes are distinguished; threads, stops, errors.

#include "Check.h"
#include "Shapes.h"

#include "tautline/Shapes/ShapeRetrieval.h"

using namespace tautline;

namespace
{
void testCounting()
{
  // Two classes of two: shape 0 finds its own class first, 1 does not, 2 and 3 do.
  const std::vector<double> distances = { 0, 1, 2, 3, /**/ 4, 0, 1, 2, /**/ 5, 6, 0, 1, /**/ 3, 3,
    2, 0 };
  const std::vector<Index> ranking = rankShapes(distances, 4);
  const std::vector<Index> expected = { 1, 2, 3, 2, 3, 0, 3, 0, 1, 2, 0, 1 };
  TAUTLINE_CHECK(ranking == expected);
  const Recognition found = recognize(ranking, { 7, 7, 9, 9 }, 1);
  TAUTLINE_CHECK_EQUAL(found.hits, 3);
  TAUTLINE_CHECK_EQUAL(found.possible, 4);
  TAUTLINE_CHECK_NEAR(found.rate, 0.75, 1e-15);
  TAUTLINE_CHECK(found.classes == (std::vector<Index>{ 7, 9 }));
  TAUTLINE_CHECK_NEAR(found.confusion[0], 0.5, 1e-15);
  TAUTLINE_CHECK_NEAR(found.confusion[1], 0.5, 1e-15);
  TAUTLINE_CHECK_NEAR(found.confusion[3], 1.0, 1e-15);
  // Of two of a class only one other can be found: more matches than that are not possible.
  TAUTLINE_CHECK_EQUAL(recognize(ranking, { 7, 7, 9, 9 }, 10).possible, 4);
  // Not computed is last.
  TAUTLINE_CHECK(
    (rankShapes({ 0, -1, 2, 1, 0, -1, -1, -1, 0 }, 3) == std::vector<Index>{ 2, 1, 0, 2, 0, 1 }));
}

void testFamilies()
{
  std::vector<Silhouette> shapes;
  std::vector<Index> labels;
  for (int k = 0; k < 3; ++k)
  {
    shapes.push_back(traceSilhouette(blob(100, 48 + k, 50, 22.0 + 2 * k, 0.5 * k).view()));
    labels.push_back(0);
    shapes.push_back(traceSilhouette(disc(100, 50, 47 + k, 20.0 + 3 * k).view()));
    labels.push_back(1);
    const double a = 10.0 + k;
    shapes.push_back(traceSilhouette(paint(100, 100,
      [=](double x, double y) {
        return std::abs(x - 50) < 40 && std::abs(y - 50) < a ? 1.0 : -1.0;
      }).view()));
    labels.push_back(2);
  }
  RetrievalOptions options = RetrievalOptions::highest();
  options.best = 2;
  options.match.threads = 1;
  const Retrieval one = retrieveShapes(shapes, labels, options);
  TAUTLINE_CHECK_NEAR(one.recognition.rate, 1.0, 1e-15);
  TAUTLINE_CHECK(one.stop == MatchStop::Complete);
  for (Index s = 0; s < one.count; ++s)
  {
    for (Index t = 0; t < one.count; ++t)
    {
      TAUTLINE_CHECK(
        one.distances[s * one.count + t] == one.distances[t * one.count + s]); // symmetric
    }
  }
  options.match.threads = 3;
  TAUTLINE_CHECK(retrieveShapes(shapes, labels, options).distances == one.distances);

  int calls = 0;
  options.symmetric = false;
  options.match.progress = [&](double part) { return part >= 0.0 && part <= 1.0 && ++calls < 4; };
  const Retrieval stopped = retrieveShapes(shapes, labels, options);
  TAUTLINE_CHECK(stopped.stop == MatchStop::Stopped);
  TAUTLINE_CHECK(std::count(stopped.distances.begin(), stopped.distances.end(), -1.0) > 0);
  TAUTLINE_CHECK_EQUAL(stopped.ranking.size(), 72u);
  options.match.progress = nullptr;
  options.match.timeLimit = 1e-9;
  TAUTLINE_CHECK(retrieveShapes(shapes, labels, options).stop == MatchStop::TimeLimit);
  options.match.timeLimit = 0;

  options.spacing = -1.0;
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), "Shape 0: The spacing");
  options.spacing = 15.0;
  options.match.energy.distortion = std::nan("");
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), "distortion weight");
  TAUTLINE_CHECK_THROWS(retrieveShapes({ shapes[0] }, { 0 }, {}), "At least 2");
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, { 0 }, {}), "label per shape");
}
}

int TestShapeRetrieval(int, char*[])
{
  testCounting();
  testFamilies();
  return exitCode();
}
