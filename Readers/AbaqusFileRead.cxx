// SPDX-License-Identifier: BSD-3-Clause
#include "AbaqusFile.h"

#include "CardFile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tautline
{
namespace
{
/// Up to this number, sets become arrays; the names of others are listed in a warning.
constexpr std::size_t MaxSets = 256;

using CardNumbers = std::vector<Index>;

/// A part, an instance with its own mesh, or the content outside of parts.
struct AbaqusPart
{
  NumberedNodes nodes;
  NumberedCells cells;
  std::map<std::string, CardNumbers> nodeSets, cellSets; ///< numbers by name
};

/// y = rotation x + translation.
struct AbaqusPlacement
{
  std::array<double, 9> rotation{ 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  std::array<double, 3> translation{};
  bool moved = false;
};

struct AbaqusInstance
{
  std::string name;
  std::string part; ///< in uppercase
  AbaqusPlacement placement;
  AbaqusPart own; ///< nodes and elements between *INSTANCE and *END INSTANCE
  CardPlace place;
};

/// A set of the assembly: members of an instance, or of the mesh outside of parts for "".
struct AssemblySet
{
  bool ofNodes;
  std::string name, instance;
  CardNumbers members;
};

/// A keyword line: the keyword and its parameters, in uppercase, with their values.
struct AbaqusKeyword
{
  std::string name;
  std::map<std::string, std::string> values;
  bool has(const char* parameter) const { return this->values.count(parameter) > 0; }
  std::string value(const char* parameter) const
  {
    const auto found = this->values.find(parameter);
    return found == this->values.end() ? std::string() : found->second;
  }
};

class AbaqusParser
{
public:
  explicit AbaqusParser(const std::string& name)
    : Text(name)
  {
  }
  void parse();
  MeshFile assemble();

private:
  AbaqusPart& current();
  AbaqusKeyword readKeyword(std::string_view line);
  void handle(const AbaqusKeyword& keyword);
  bool nextData(std::vector<std::string_view>& fields);
  double real(std::string_view text, const char* what) const;
  Index integer(std::string_view text, const char* what) const;
  void readNodes(const AbaqusKeyword& keyword);
  void readElements(const AbaqusKeyword& keyword);
  void readSet(const AbaqusKeyword& keyword, bool ofNodes);
  void addMembers(const AbaqusKeyword& keyword, const std::vector<std::string_view>& fields,
    bool ofNodes, CardNumbers& members);
  const CardNumbers* findSet(const std::string& name, const std::string& instance, bool ofNodes);
  void beginInstance(const AbaqusKeyword& keyword);
  void readPlacement(AbaqusPlacement& placement);
  void append(MeshFile& mesh, const AbaqusPart& part, const AbaqusPlacement& placement,
    const std::string& instance, CardNumbers& instanceOfCell);
  void appendSets(MeshFile& mesh);

  CardText Text;
  AbaqusPart Global; ///< outside of parts
  std::map<std::string, AbaqusPart> Parts;
  std::vector<std::string> PartOrder;
  std::deque<AbaqusInstance> Instances;
  std::vector<AssemblySet> AssemblySets;
  std::string InPart; ///< the name in uppercase
  bool InInstance = false, InAssembly = false;
  std::map<std::string, Index> LeftOut; ///< elements by type
  /// Members of the sets as points and cells of the mesh, by name.
  std::map<std::string, CardNumbers> PointsOf, CellsOf;
  std::map<const AbaqusPart*, std::unordered_map<Index, Index>> CellNumbers;
  std::vector<std::string> InstanceNames;
};

AbaqusPart& AbaqusParser::current()
{
  return this->InInstance  ? this->Instances.back().own
    : this->InPart.empty() ? this->Global
                           : this->Parts[this->InPart];
}

std::string unquoted(std::string_view text)
{
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return std::string(quoted ? text.substr(1, text.size() - 2) : text);
}

/// A comma at the end of the line continues it.
AbaqusKeyword AbaqusParser::readKeyword(std::string_view line)
{
  AbaqusKeyword keyword;
  std::string all(trimmed(line));
  while (!all.empty() && all.back() == ',' && this->Text.next(line))
  {
    all += trimmed(line);
  }
  const std::vector<std::string_view> parts = splitAtCommas(std::string_view(all).substr(1));
  keyword.name = upperCase(parts[0]);
  for (std::size_t i = 1; i < parts.size(); ++i)
  {
    const std::size_t equals = parts[i].find('=');
    const std::string name = upperCase(trimmed(parts[i].substr(0, equals)));
    keyword.values[name] =
      equals == parts[i].npos ? std::string() : unquoted(trimmed(parts[i].substr(equals + 1)));
  }
  return keyword;
}

/// The next data line; false at a keyword, whose line is kept, or at the end of the file.
bool AbaqusParser::nextData(std::vector<std::string_view>& fields)
{
  for (std::string_view line; this->Text.next(line);)
  {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.substr(0, 2) == "**")
    {
      continue;
    }
    if (text[0] == '*')
    {
      this->Text.putBack();
      return false;
    }
    fields = splitAtCommas(text);
    return true;
  }
  return false;
}

double AbaqusParser::real(std::string_view text, const char* what) const
{
  std::string word(text);
  word.erase(0, !word.empty() && word[0] == '+');
  std::replace_if(
    word.begin(), word.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (!word.empty() &&
    (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)))
  {
    this->Text.fail(std::string(what) + " is '" + std::string(text.substr(0, 40)) +
      "'; a finite number is expected");
  }
  return value; // an empty field is 0
}

Index AbaqusParser::integer(std::string_view text, const char* what) const
{
  Index value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value < 0 ||
    value == LargestCardNumber)
  {
    this->Text.fail(std::string(what) + " is '" + std::string(text.substr(0, 40)) +
      "'; a whole number is expected");
  }
  return value;
}

void AbaqusParser::readNodes(const AbaqusKeyword& keyword)
{
  const std::string system = upperCase(keyword.value("SYSTEM"));
  if (!system.empty() && system != "R")
  {
    this->Text.fail("nodes in cylindrical or spherical coordinates are not supported");
  }
  AbaqusPart& part = this->current();
  CardNumbers* set = keyword.has("NSET") ? &part.nodeSets[keyword.value("NSET")] : nullptr;
  for (std::vector<std::string_view> fields; this->nextData(fields);)
  {
    const Index number = this->integer(fields[0], "the number of a node");
    if (fields.size() < 2)
    {
      this->Text.fail("node " + std::to_string(number) + " has no coordinates");
    }
    double point[3] = {};
    for (std::size_t c = 0; c < 3 && c + 1 < fields.size(); ++c)
    {
      point[c] = this->real(fields[c + 1], "a coordinate");
    }
    part.nodes.add(number, point, this->Text.place());
    if (set)
    {
      set->push_back(number);
    }
  }
}

void AbaqusParser::readElements(const AbaqusKeyword& keyword)
{
  const std::string type = upperCase(keyword.value("TYPE"));
  const AbaqusElement element = abaqusElement(type);
  if (element.kind == AbaqusElement::Unknown)
  {
    this->Text.fail("elements of the type '" + type + "' are not supported");
  }
  AbaqusPart& part = this->current();
  CardNumbers* set = keyword.has("ELSET") ? &part.cellSets[keyword.value("ELSET")] : nullptr;
  const auto size = static_cast<std::size_t>(cellNodes(element.type));
  std::vector<std::string_view> fields;
  for (std::vector<Index> row; this->nextData(fields);)
  {
    if (element.kind == AbaqusElement::NoCell)
    {
      ++this->LeftOut[type];
      continue;
    }
    const CardPlace place = this->Text.place();
    row.clear();
    do
    {
      for (const std::string_view field : fields)
      {
        if (!field.empty()) // after the comma at the end of a line
        {
          row.push_back(this->integer(field, "the number of a node"));
        }
      }
    } while (row.size() < size + 1 && this->nextData(fields));
    if (row.size() != size + 1)
    {
      place.fail("an element of the type " + type + " has " + std::to_string(size) + " nodes; " +
        std::to_string(row.size() - 1) + " follow its number");
    }
    part.cells.add(element.type, row[0], row.data() + 1, element.order, place);
    if (set)
    {
      set->push_back(row[0]);
    }
  }
}

const CardNumbers* AbaqusParser::findSet(
  const std::string& name, const std::string& instance, bool ofNodes)
{
  const auto same = [&](const std::string& other) { return upperCase(other) == upperCase(name); };
  for (AssemblySet& set : this->AssemblySets)
  {
    if (set.ofNodes == ofNodes && set.instance == instance && same(set.name))
    {
      return &set.members;
    }
  }
  AbaqusPart& part = this->current();
  for (auto& [other, members] : ofNodes ? part.nodeSets : part.cellSets)
  {
    if (same(other))
    {
      return &members;
    }
  }
  return nullptr;
}

void AbaqusParser::addMembers(const AbaqusKeyword& keyword,
  const std::vector<std::string_view>& fields, bool ofNodes, CardNumbers& members)
{
  if (keyword.has("GENERATE"))
  {
    if (fields.size() < 2)
    {
      this->Text.fail("the first and the last number of a set are expected");
    }
    const Index first = this->integer(fields[0], "the first number of a set");
    const Index last = this->integer(fields[1], "the last number of a set");
    const Index step =
      fields.size() > 2 && !fields[2].empty() ? this->integer(fields[2], "the step of a set") : 1;
    constexpr Index most = 1'000'000'000;
    if (step < 1 || last < first || (last - first) / step > most)
    {
      this->Text.fail("the numbers of a set go from " + std::to_string(first) + " to " +
        std::to_string(last) + " by " + std::to_string(step));
    }
    for (Index i = first; i <= last; i += step)
    {
      members.push_back(i);
    }
    return;
  }
  for (const std::string_view field : fields)
  {
    if (field.empty())
    {
      continue;
    }
    if (field[0] >= '0' && field[0] <= '9')
    {
      members.push_back(this->integer(field, "a member of a set"));
    }
    else if (const CardNumbers* other =
               this->findSet(unquoted(field), upperCase(keyword.value("INSTANCE")), ofNodes))
    {
      const CardNumbers copy = *other; // may be the set itself
      members.insert(members.end(), copy.begin(), copy.end());
    } // a set of an instance, such as PART-1-1.SET: not needed for the mesh
  }
}

void AbaqusParser::readSet(const AbaqusKeyword& keyword, bool ofNodes)
{
  const std::string name = keyword.value(ofNodes ? "NSET" : "ELSET");
  if (name.empty())
  {
    this->Text.fail("a set without a name");
  }
  CardNumbers members;
  for (std::vector<std::string_view> fields; this->nextData(fields);)
  {
    this->addMembers(keyword, fields, ofNodes, members);
  }
  if (keyword.has("INTERNAL"))
  {
    return;
  }
  if (this->InAssembly && !this->InInstance)
  {
    this->AssemblySets.push_back(
      { ofNodes, name, upperCase(keyword.value("INSTANCE")), std::move(members) });
    return;
  }
  AbaqusPart& part = this->current();
  CardNumbers& set = (ofNodes ? part.nodeSets : part.cellSets)[name];
  set.insert(set.end(), members.begin(), members.end());
}

/// Rotates about the axis through a and b.
void setRotation(AbaqusPlacement& placement, const double* a, const double* b, double angle)
{
  double axis[3] = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
  const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  const double c = std::cos(angle * CardDegree), s = std::sin(angle * CardDegree);
  for (double& component : axis)
  {
    component /= length;
  }
  const double cross[9] = { 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0 };
  for (std::size_t i = 0; i < 3; ++i)
  {
    for (std::size_t j = 0; j < 3; ++j)
    {
      placement.rotation[3 * i + j] =
        (i == j ? c : 0.0) + (1.0 - c) * axis[i] * axis[j] + s * cross[3 * i + j];
    }
  }
  // the axis passes through a: x + t is rotated about it
  std::array<double, 3> moved{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    moved[i] = a[i];
    for (std::size_t j = 0; j < 3; ++j)
    {
      moved[i] += placement.rotation[3 * i + j] * (placement.translation[j] - a[j]);
    }
  }
  placement.translation = moved;
}

void AbaqusParser::readPlacement(AbaqusPlacement& placement)
{
  std::vector<std::string_view> fields;
  if (!this->nextData(fields))
  {
    return;
  }
  placement.moved = true;
  for (std::size_t i = 0; i < 3 && i < fields.size(); ++i)
  {
    placement.translation[i] = this->real(fields[i], "a translation");
  }
  if (!this->nextData(fields))
  {
    return;
  }
  constexpr std::size_t numbers = 7; // two points and an angle
  double values[numbers];
  if (fields.size() < numbers)
  {
    this->Text.fail("a rotation is given by seven numbers");
  }
  for (std::size_t i = 0; i < numbers; ++i)
  {
    values[i] = this->real(fields[i], "a number of a rotation");
  }
  if (std::equal(values, values + 3, values + 3))
  {
    this->Text.fail("the axis of a rotation has no length");
  }
  setRotation(placement, values, values + 3, values[6]);
}

void AbaqusParser::beginInstance(const AbaqusKeyword& keyword)
{
  AbaqusInstance instance;
  instance.name = keyword.value("NAME");
  instance.part = upperCase(keyword.value("PART"));
  instance.place = this->Text.place();
  if (!this->Parts.count(instance.part))
  {
    this->Text.fail("there is no part '" + keyword.value("PART") + "' before this instance");
  }
  this->readPlacement(instance.placement);
  this->Instances.push_back(std::move(instance));
  this->InInstance = true;
}

void AbaqusParser::handle(const AbaqusKeyword& keyword)
{
  static const char* const generating[] = { "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY",
    "SYSTEM", "PARAMETER", "SUBMODEL", "TRANSFORM NODES", "IMPORT" };
  if (std::find(std::begin(generating), std::end(generating), keyword.name) != std::end(generating))
  {
    this->Text.fail(
      "*" + keyword.name + " is not supported: write a file that lists all nodes and elements");
  }
  const bool reads = keyword.name == "NODE" || keyword.name == "ELEMENT" ||
    keyword.name == "NSET" || keyword.name == "ELSET" || keyword.name == "INCLUDE";
  if (reads && keyword.has("INPUT"))
  {
    this->Text.include(keyword.value("INPUT"));
  }
  if (keyword.name == "NODE")
  {
    this->readNodes(keyword);
  }
  else if (keyword.name == "ELEMENT")
  {
    this->readElements(keyword);
  }
  else if (keyword.name == "NSET" || keyword.name == "ELSET")
  {
    this->readSet(keyword, keyword.name == "NSET");
  }
  else if (keyword.name == "PART")
  {
    this->InPart = upperCase(keyword.value("NAME"));
    if (this->InPart.empty() || this->Parts.count(this->InPart))
    {
      this->Text.fail("a part without a name of its own");
    }
    this->Parts[this->InPart];
    this->PartOrder.push_back(this->InPart);
  }
  else if (keyword.name == "END PART")
  {
    this->InPart.clear();
  }
  else if (keyword.name == "ASSEMBLY" || keyword.name == "END ASSEMBLY")
  {
    this->InAssembly = keyword.name == "ASSEMBLY";
  }
  else if (keyword.name == "INSTANCE")
  {
    this->beginInstance(keyword);
  }
  else if (keyword.name == "END INSTANCE")
  {
    this->InInstance = false;
  }
}

void AbaqusParser::parse()
{
  bool any = false;
  for (std::string_view line; this->Text.next(line);)
  {
    const std::string_view text = trimmed(line);
    if (!text.empty() && text[0] == '*' && text.substr(0, 2) != "**")
    {
      any = true;
      this->handle(this->readKeyword(text));
    }
    else if (!text.empty() && text[0] != '*' && !any)
    {
      this->Text.fail("a keyword of Abaqus, which begins with *, is expected");
    }
  }
  if (!this->InPart.empty() || this->InInstance || this->InAssembly)
  {
    this->Text.fail(
      std::string("the file ends within ") + (this->InPart.empty() ? "an assembly" : "a part"));
  }
}

void AbaqusParser::append(MeshFile& mesh, const AbaqusPart& part, const AbaqusPlacement& placement,
  const std::string& instance, CardNumbers& instanceOfCell)
{
  const Index firstPoint = mesh.numberOfPoints(), firstCell = mesh.numberOfCells();
  for (std::size_t i = 0; i < part.nodes.numbers.size(); ++i)
  {
    const double* from = &part.nodes.coordinates[3 * i];
    for (std::size_t row = 0; row < 3; ++row)
    {
      const double* r = &placement.rotation[3 * row];
      mesh.points.push_back(placement.moved
          ? r[0] * from[0] + r[1] * from[1] + r[2] * from[2] + placement.translation[row]
          : from[row]);
    }
  }
  appendCells(mesh, part.cells, part.nodes, firstPoint);
  auto& numbers = this->CellNumbers[&part];
  if (numbers.empty())
  {
    for (std::size_t cell = 0; cell < part.cells.numbers.size(); ++cell)
    {
      const Index number = part.cells.numbers[cell];
      if (!numbers.emplace(number, static_cast<Index>(cell)).second)
      {
        part.cells.places[cell].fail("element " + std::to_string(number) + " is given twice");
      }
    }
  }
  const auto addSet = [&](const std::string& name, const CardNumbers& members, bool ofNodes)
  {
    CardNumbers& set = (ofNodes ? this->PointsOf : this->CellsOf)[name];
    const auto& positions = ofNodes ? part.nodes.positions : numbers;
    for (const Index number : members)
    {
      if (const auto found = positions.find(number); found != positions.end())
      {
        set.push_back(found->second + (ofNodes ? firstPoint : firstCell));
      }
    }
  };
  for (const auto& [name, members] : part.nodeSets)
  {
    addSet(name, members, true);
  }
  for (const auto& [name, members] : part.cellSets)
  {
    addSet(name, members, false);
  }
  for (const AssemblySet& set : this->AssemblySets)
  {
    if (set.instance == upperCase(instance))
    {
      addSet(set.name, set.members, set.ofNodes);
    }
  }
  instanceOfCell.resize(
    static_cast<std::size_t>(mesh.numberOfCells()), static_cast<Index>(this->InstanceNames.size()));
  this->InstanceNames.push_back(instance);
}

void AbaqusParser::appendSets(MeshFile& mesh)
{
  std::size_t left = 0;
  for (const bool ofNodes : { true, false })
  {
    auto& arrays = ofNodes ? mesh.pointArrays : mesh.cellArrays;
    const Index size = ofNodes ? mesh.numberOfPoints() : mesh.numberOfCells();
    for (const auto& [name, members] : ofNodes ? this->PointsOf : this->CellsOf)
    {
      if (arrays.size() >= MaxSets)
      {
        ++left;
        continue;
      }
      MeshArray::Bytes flags(static_cast<std::size_t>(size), 0);
      for (const Index member : members)
      {
        flags[static_cast<std::size_t>(member)] = 1;
      }
      arrays.push_back({ name, 1, std::move(flags) });
    }
  }
  if (left > 0)
  {
    mesh.warnings.push_back(std::to_string(left) + " sets are left out; " +
      std::to_string(MaxSets) + " of points and of cells are read");
  }
}

MeshFile AbaqusParser::assemble()
{
  MeshFile mesh;
  CardNumbers instanceOfCell;
  for (const AbaqusInstance& instance : this->Instances)
  {
    const bool own = !instance.own.nodes.numbers.empty();
    this->append(mesh, own ? instance.own : this->Parts.at(instance.part), instance.placement,
      instance.name, instanceOfCell);
  }
  for (const std::string& part : this->PartOrder) // a file with only parts
  {
    if (this->Instances.empty())
    {
      this->append(mesh, this->Parts.at(part), AbaqusPlacement(), part, instanceOfCell);
    }
  }
  if (!this->Global.nodes.numbers.empty() || !this->Global.cells.numbers.empty())
  {
    this->append(mesh, this->Global, AbaqusPlacement(), std::string(), instanceOfCell);
  }
  if (mesh.points.empty())
  {
    this->Text.fail("the file has no nodes");
  }
  this->appendSets(mesh);
  if (this->InstanceNames.size() > 1)
  {
    mesh.cellArrays.push_back({ "Instance", 1, std::move(instanceOfCell) });
    mesh.fieldStrings.push_back({ "Instances", this->InstanceNames });
  }
  for (const auto& [type, count] : this->LeftOut)
  {
    mesh.warnings.push_back(std::to_string(count) + " elements of the type " + type +
      ", which have no size, are left out");
  }
  return mesh;
}
}

//------------------------------------------------------------------------------
MeshFile readAbaqus(const std::string& name, bool lowerCells)
{
  AbaqusParser parser(name);
  parser.parse();
  MeshFile mesh = parser.assemble();
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  return mesh;
}
}
