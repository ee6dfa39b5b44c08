// SPDX-License-Identifier: BSD-3-Clause
#include "NastranFile.h"

#include "CardFile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace tautline
{
namespace
{
constexpr std::size_t SmallField = 8, LargeField = 16;
constexpr std::size_t SmallFields = 8, LargeFields = 4; ///< data fields per line

// Node i of VTK's cell is node order[i] of Nastran's: midside nodes of vertical edges come before
// the top edges, and the normal of a wedge's first triangle points inward.
constexpr int NastranWedge[] = { 0, 2, 1, 3, 5, 4 };
constexpr int NastranWedge15[] = { 0, 2, 1, 3, 5, 4, 8, 7, 6, 14, 13, 12, 9, 11, 10 };
constexpr int NastranHexahedron20[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12,
  13, 14, 15 };

/// An element card; `first` is the field of the first node, from 0 after the name.
struct ElementCard
{
  const char* name;
  std::size_t first;
  std::size_t nodes; ///< for the linear cell
  unsigned char type;
  const int* order;
  std::size_t quadraticNodes; ///< 0 if there is no such cell
  unsigned char quadraticType;
  const int* quadraticOrder;
};

constexpr ElementCard NastranElements[] = {
  { "CTRIA3", 2, 3, FileTriangle, nullptr, 0, 0, nullptr },
  { "CTRIAR", 2, 3, FileTriangle, nullptr, 0, 0, nullptr },
  { "CTRIA6", 2, 3, FileTriangle, nullptr, 6, FileTriangle6, nullptr },
  { "CQUAD4", 2, 4, FileQuadrilateral, nullptr, 0, 0, nullptr },
  { "CQUADR", 2, 4, FileQuadrilateral, nullptr, 0, 0, nullptr },
  { "CSHEAR", 2, 4, FileQuadrilateral, nullptr, 0, 0, nullptr },
  { "CQUAD8", 2, 4, FileQuadrilateral, nullptr, 8, FileQuadrilateral8, nullptr },
  { "CQUAD", 2, 4, FileQuadrilateral, nullptr, 9, FileQuadrilateral9, nullptr },
  { "CQUAD9", 2, 4, FileQuadrilateral, nullptr, 9, FileQuadrilateral9, nullptr }, // used by meshio
  { "CTETRA", 2, 4, FileTetrahedron, nullptr, 10, FileTetrahedron10, nullptr },
  { "CPYRAM", 2, 5, FilePyramid, nullptr, 13, FilePyramid13, nullptr },
  { "CPYRA", 2, 5, FilePyramid, nullptr, 13, FilePyramid13, nullptr },
  { "CPENTA", 2, 6, FileWedge, NastranWedge, 15, FileWedge15, NastranWedge15 },
  { "CHEXA", 2, 8, FileHexahedron, nullptr, 20, FileHexahedron20, NastranHexahedron20 },
  { "CROD", 2, 2, FileLine, nullptr, 0, 0, nullptr },
  { "CTUBE", 2, 2, FileLine, nullptr, 0, 0, nullptr },
  { "CBAR", 2, 2, FileLine, nullptr, 0, 0, nullptr },
  { "CBEAM", 2, 2, FileLine, nullptr, 0, 0, nullptr },
  { "CONROD", 1, 2, FileLine, nullptr, 0, 0, nullptr },
};

/// Prefixes of the names of C cards that have no shape.
constexpr const char* Shapeless[] = { "CORD", "CONM", "CMASS", "CELAS", "CDAMP", "CVISC", "CBUSH",
  "CGAP", "CSET", "CSUPEXT", "CTRIAX", "CONV", "CHBDY", "CAABSF", "CFAST", "CWELD", "CREEP", "COMP",
  "CSCHD", "CSTM", "CSUPER", "CFLSTR", "CINTC", "COUPMASS", "CLOAD", "CYJOIN", "CYSYM", "CONTACT",
  "CONTROL", "CQUADX" };

/// The logical fields of a card after its name, and its start.
struct Card
{
  std::string name;
  std::vector<std::string_view> fields;
  CardPlace place;

  std::string_view field(std::size_t i) const
  {
    return i < this->fields.size() ? this->fields[i] : std::string_view();
  }
};

/// A coordinate system: its origin and the directions of its axes, as rows.
struct NastranSystem
{
  char kind = 'R'; ///< R, C or S
  Index reference = 0;
  std::array<double, 9> points{}; ///< A (origin), B (on z), C (in the plane x z), in the reference
  CardPlace place;
  bool resolved = false, visited = false;
  std::array<double, 3> origin{};
  std::array<double, 9> axes{ 1, 0, 0, 0, 1, 0, 0, 0, 1 };
};

struct GridPoint
{
  Index number, system;
  std::array<double, 3> point;
  CardPlace place;
};

class NastranParser
{
public:
  explicit NastranParser(const std::string& name)
    : Name(name)
    , Text(name)
  {
  }
  void parse();
  MeshFile assemble();

private:
  bool next(std::string_view& line);
  bool readCard(Card& card);
  void addFields(std::string_view line, bool first, Card& card);
  bool continues(std::string_view line) const;
  void handle(const Card& card);
  void readGrid(const Card& card);
  void readSystem(const Card& card);
  void readElement(const Card& card, const ElementCard& element);
  void include(std::string_view line);
  double real(const Card& card, std::size_t field, const char* what) const;
  Index integer(const Card& card, std::size_t field, const char* what, Index blank) const;
  const NastranSystem& resolve(Index number, const CardPlace& place);
  std::array<double, 3> inBasic(std::array<double, 3> point, Index system, const CardPlace& place);

  std::string Name;
  CardText Text;
  std::vector<GridPoint> Grids;
  std::map<Index, NastranSystem> Systems;
  NumberedCells Cells;
  std::vector<Index> Properties;
  Index DefaultSystem = 0;
  std::map<std::string, Index> LeftOut;
  std::deque<std::string> Expanded; ///< lines with tabs
};

/// The next line without its comment and with tabs as blanks; blank lines are skipped.
bool NastranParser::next(std::string_view& line)
{
  while (this->Text.next(line))
  {
    line = line.substr(0, line.find('$'));
    if (trimmed(line).empty())
    {
      continue;
    }
    if (line.find('\t') != line.npos && line.find(',') == line.npos)
    {
      std::string text;
      for (const char c : line)
      {
        text.append(c == '\t' ? SmallField - text.size() % SmallField : 1, c == '\t' ? ' ' : c);
      }
      this->Expanded.push_back(std::move(text));
      line = this->Expanded.back();
    }
    return true;
  }
  return false;
}

/// Whether a line continues the previous card.
bool NastranParser::continues(std::string_view line) const
{
  if (line.find(',') != line.npos)
  {
    const std::string_view first = trimmed(line.substr(0, line.find(',')));
    return first.empty() || first[0] == '+' || first[0] == '*';
  }
  const std::string_view first = trimmed(line.substr(0, SmallField));
  return first.empty() || first[0] == '+' || first[0] == '*';
}

void NastranParser::addFields(std::string_view line, bool first, Card& card)
{
  std::vector<std::string_view> fields;
  std::string_view name;
  std::size_t count = SmallFields;
  if (line.find(',') != line.npos)
  {
    fields = splitAtCommas(line);
    name = fields[0];
    fields.erase(fields.begin());
    count = !name.empty() && (name.back() == '*' || name[0] == '*') ? LargeFields : SmallFields;
  }
  else
  {
    name = trimmed(line.substr(0, SmallField));
    const bool large = !name.empty() && (name.back() == '*' || name[0] == '*');
    count = large ? LargeFields : SmallFields;
    const std::size_t width = large ? LargeField : SmallField;
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::size_t begin = SmallField + i * width;
      fields.push_back(
        begin < line.size() ? trimmed(line.substr(begin, width)) : std::string_view());
    }
  }
  if (first)
  {
    card.name = upperCase(name);
    if (!card.name.empty() && card.name.back() == '*')
    {
      card.name.pop_back();
    }
    card.name = std::string(trimmed(card.name));
  }
  fields.resize(count); // the rest is the continuation mark
  card.fields.insert(card.fields.end(), fields.begin(), fields.end());
}

bool NastranParser::readCard(Card& card)
{
  std::string_view line;
  if (!this->next(line))
  {
    return false;
  }
  card.fields.clear();
  card.place = this->Text.place();
  card.name = upperCase(trimmed(line).substr(0, trimmed(line).find_first_of(" '\",")));
  if (card.name == "INCLUDE")
  {
    this->include(line);
    return true;
  }
  this->addFields(line, true, card);
  while (this->next(line))
  {
    if (!this->continues(line))
    {
      this->Text.putBack();
      break;
    }
    this->addFields(line, false, card);
  }
  return true;
}

void NastranParser::include(std::string_view line)
{
  const std::size_t quote = line.find_first_of("'\"");
  const std::size_t end = quote == line.npos ? quote : line.find(line[quote], quote + 1);
  const std::string_view plain = trimmed(line);
  constexpr std::size_t length = 7; // INCLUDE
  const std::string_view name =
    end == line.npos ? trimmed(plain.substr(length)) : line.substr(quote + 1, end - quote - 1);
  if (name.empty() || (quote != line.npos && end == line.npos))
  {
    this->Text.fail("the name of the included file is expected in quotes, in one line");
  }
  this->Text.include(std::string(name));
}

/// 1.5, 1.5E3, 1.5D3, 1.5+3; a blank field is 0.
double NastranParser::real(const Card& card, std::size_t field, const char* what) const
{
  const std::string_view text = card.field(field);
  std::string word = upperCase(text);
  std::replace(word.begin(), word.end(), 'D', 'E');
  word.erase(0, !word.empty() && word[0] == '+');
  const std::size_t sign = word.find_last_of("+-");
  if (sign != word.npos && sign > 0 && word[sign - 1] != 'E')
  {
    word.insert(sign, 1, 'E');
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (!word.empty() &&
    (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)))
  {
    card.place.fail(
      card.name + ": " + what + " is '" + std::string(text) + "'; a number is expected");
  }
  return value;
}

Index NastranParser::integer(
  const Card& card, std::size_t field, const char* what, Index blank) const
{
  const std::string_view text = card.field(field);
  if (text.empty() && blank >= 0)
  {
    return blank;
  }
  Index value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 ||
    value == LargestCardNumber)
  {
    card.place.fail(
      card.name + ": " + what + " is '" + std::string(text) + "'; a whole number is expected");
  }
  return value;
}

void NastranParser::readGrid(const Card& card)
{
  GridPoint grid{};
  grid.number = this->integer(card, 0, "the number", -1);
  grid.system = this->integer(card, 1, "the coordinate system", 0);
  grid.place = card.place;
  if (card.field(1).empty())
  {
    grid.system = -1; // GRDSET may come later
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    grid.point[c] = this->real(card, 2 + c, "a coordinate");
  }
  this->Grids.push_back(grid);
}

void NastranParser::readSystem(const Card& card)
{
  NastranSystem system;
  system.kind = card.name[5];
  system.place = card.place;
  const Index number = this->integer(card, 0, "the number", -1);
  system.reference = this->integer(card, 1, "the reference system", 0);
  for (std::size_t i = 0; i < system.points.size(); ++i)
  {
    system.points[i] = this->real(card, 2 + i, "a coordinate");
  }
  if (number == 0 || !this->Systems.emplace(number, system).second)
  {
    card.place.fail("the coordinate system " + std::to_string(number) + " is given twice");
  }
}

void NastranParser::readElement(const Card& card, const ElementCard& element)
{
  const Index number = this->integer(card, 0, "the number", -1);
  const bool ofProperty = element.first > 1;
  const Index property = ofProperty ? this->integer(card, 1, "the property", number) : 0;
  std::vector<Index> nodes(std::max(element.nodes, element.quadraticNodes));
  std::size_t middle = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const bool corner = i < element.nodes;
    nodes[i] = this->integer(card, element.first + i, "a grid point", corner ? -1 : 0);
    middle += !corner && nodes[i] > 0;
  }
  if (middle > 0 && middle != element.quadraticNodes - element.nodes)
  {
    card.place.fail(card.name + " " + std::to_string(number) + " has " + std::to_string(middle) +
      " of its " + std::to_string(element.quadraticNodes - element.nodes) +
      " midside nodes: elements between the first and the second order are not supported");
  }
  this->Cells.add(middle ? element.quadraticType : element.type, number, nodes.data(),
    middle ? element.quadraticOrder : element.order, card.place);
  this->Properties.push_back(property);
}

void NastranParser::handle(const Card& card)
{
  const auto* element = std::find_if(std::begin(NastranElements), std::end(NastranElements),
    [&](const ElementCard& each) { return card.name == each.name; });
  if (element != std::end(NastranElements))
  {
    this->readElement(card, *element);
  }
  else if (card.name == "GRID")
  {
    this->readGrid(card);
  }
  else if (card.name == "GRDSET")
  {
    this->DefaultSystem = this->integer(card, 1, "the coordinate system", 0);
  }
  else if (card.name == "CORD2R" || card.name == "CORD2C" || card.name == "CORD2S")
  {
    this->readSystem(card);
  }
  else if (!card.name.empty() && card.name[0] == 'C' &&
    std::none_of(std::begin(Shapeless), std::end(Shapeless),
      [&](const char* each) { return card.name.rfind(each, 0) == 0; }))
  {
    ++this->LeftOut[card.name];
  }
}

bool beginsBulkData(std::string_view line)
{
  const std::string text = upperCase(trimmed(line));
  return text.rfind("BEGIN", 0) == 0 && text.find("BULK") != text.npos;
}

/// Reads the bulk data; preceding sections are skipped. A file without BEGIN BULK is all bulk data.
void NastranParser::parse()
{
  std::string_view line;
  bool bulk = false;
  for (CardText all(this->Name); !bulk && all.next(line);)
  {
    bulk = beginsBulkData(line);
  }
  while (bulk && this->Text.next(line) && !beginsBulkData(line))
  {
  }
  Card card;
  while (this->readCard(card))
  {
    if (card.name.rfind("ENDDATA", 0) == 0)
    {
      break;
    }
    if (card.name != "INCLUDE")
    {
      this->handle(card);
    }
  }
}

std::array<double, 3> difference(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

double dotProduct(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The origin and the axes of a system in the basic system.
const NastranSystem& NastranParser::resolve(Index number, const CardPlace& place)
{
  const auto found = this->Systems.find(number);
  if (found == this->Systems.end())
  {
    place.fail("the coordinate system " + std::to_string(number) +
      " is not given by CORD2R, CORD2C or CORD2S");
  }
  NastranSystem& system = found->second;
  if (system.resolved)
  {
    return system;
  }
  if (system.visited)
  {
    system.place.fail("coordinate systems refer to each other in a circle");
  }
  system.visited = true;
  std::array<std::array<double, 3>, 3> points;
  for (std::size_t i = 0; i < 3; ++i)
  {
    points[i] =
      this->inBasic({ system.points[3 * i], system.points[3 * i + 1], system.points[3 * i + 2] },
        system.reference, system.place);
  }
  std::array<double, 3> z = difference(points[1], points[0]);
  std::array<double, 3> x = difference(points[2], points[0]);
  const double along = dotProduct(x, z) / dotProduct(z, z);
  for (std::size_t c = 0; c < 3; ++c)
  {
    x[c] -= along * z[c];
  }
  const double length = std::sqrt(dotProduct(z, z)), width = std::sqrt(dotProduct(x, x));
  if (!(length > 0.0) || !(width > 0.0))
  {
    system.place.fail("the points of a coordinate system are on a line");
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    x[c] /= width;
    z[c] /= length;
  }
  const std::array<double, 3> y = { z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
    z[0] * x[1] - z[1] * x[0] };
  system.axes = { x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2] };
  system.origin = points[0];
  system.resolved = true;
  return system;
}

std::array<double, 3> NastranParser::inBasic(
  std::array<double, 3> point, Index number, const CardPlace& place)
{
  if (number == 0)
  {
    return point;
  }
  const NastranSystem& system = this->resolve(number, place);
  if (system.kind == 'C')
  {
    point = { point[0] * std::cos(point[1] * CardDegree),
      point[0] * std::sin(point[1] * CardDegree), point[2] };
  }
  else if (system.kind == 'S') // radius, angle from z, angle in the plane x y
  {
    const double radius = point[0] * std::sin(point[1] * CardDegree);
    point = { radius * std::cos(point[2] * CardDegree), radius * std::sin(point[2] * CardDegree),
      point[0] * std::cos(point[1] * CardDegree) };
  }
  std::array<double, 3> result = system.origin;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      result[c] += point[axis] * system.axes[3 * axis + c];
    }
  }
  return result;
}

MeshFile NastranParser::assemble()
{
  NumberedNodes nodes;
  for (const GridPoint& grid : this->Grids)
  {
    const Index system = grid.system < 0 ? this->DefaultSystem : grid.system;
    nodes.add(grid.number, this->inBasic(grid.point, system, grid.place).data(), grid.place);
  }
  if (nodes.numbers.empty())
  {
    this->Text.fail("the file has no GRID cards");
  }
  std::unordered_map<Index, std::size_t> seen;
  for (std::size_t cell = 0; cell < this->Cells.numbers.size(); ++cell)
  {
    if (!seen.emplace(this->Cells.numbers[cell], cell).second)
    {
      this->Cells.places[cell].fail(
        "element " + std::to_string(this->Cells.numbers[cell]) + " is given twice");
    }
  }
  MeshFile mesh;
  appendCells(mesh, this->Cells, nodes, 0);
  mesh.points = std::move(nodes.coordinates);
  mesh.cellArrays.push_back({ "Reference", 1, std::move(this->Properties) });
  for (const auto& [card, count] : this->LeftOut)
  {
    mesh.warnings.push_back(
      std::to_string(count) + " cards " + card + " are left out: such elements are not supported");
  }
  return mesh;
}
}

//------------------------------------------------------------------------------
MeshFile readNastran(const std::string& name, bool lowerCells)
{
  NastranParser parser(name);
  parser.parse();
  MeshFile mesh = parser.assemble();
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  return mesh;
}
}
