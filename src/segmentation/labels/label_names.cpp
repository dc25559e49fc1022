#include "segmentation/labels/label_names.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "common/error.h"
#include "common/file/file_name.h"
#include "common/input_file.h"
#include "common/text/csv_fields.h"
#include "yaml/tree.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr auto kRemedy =
    "give a table of labels: .yaml or .json (number: name), .csv (number,name), or .ctbl of 3D Slicer";

const std::set<std::string> kNumberTitles = {"id", "label", "value", "index", "labelvalue", "label_id", "labelid"};
const std::set<std::string> kNameTitles = {"name", "labelname", "label_name", "structure", "text", "color name"};

std::string trimmed(const std::string& text)
{
  const auto is_blank = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_blank).base();
  return begin < end ? std::string(begin, end) : "";
}

std::string lowered(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/** Whole number of a text; empty for another text. */
std::optional<long> numberOf(const std::string& text)
{
  const std::string word = trimmed(text);
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !(std::abs(number) < 1e9) ||
      number != static_cast<double>(static_cast<long>(number)))
    return std::nullopt;
  return static_cast<long>(number);
}

/** Table under construction. */
class Table
{
public:
  explicit Table(std::string file) : file_(std::move(file)) {}

  /** @throws InputError for a second name of a label */
  void add(long label, const std::string& name, const std::string& place)
  {
    const std::string plain = fileNameOf(trimmed(name));
    const auto [entry, is_new] = names_.emplace(label, plain);
    if (!is_new && entry->second != plain)
      throw InputError(file_, place,
                       "label " + std::to_string(label) + " has the names \"" + entry->second + "\" and \"" + plain +
                           "\"; keep the table of one task");
  }

  LabelNames take()
  {
    if (names_.empty())
      throw InputError(file_, "", std::string("holds no label with a name; ") + kRemedy);
    return std::move(names_);
  }

private:
  std::string file_;
  LabelNames names_;
};

/** First field of a map with one of some titles. */
const yaml::Node* fieldOf(const yaml::Node& map, const std::set<std::string>& titles)
{
  for (const auto& [key, value] : map.fields)
    if (titles.count(lowered(key)) > 0 && value.kind == yaml::Node::Kind::kScalar)
      return &value;
  return nullptr;
}

void addTree(const yaml::Node& node, Table& table)
{
  for (const yaml::Node& item : node.items)
    addTree(item, table);
  const yaml::Node* number = fieldOf(node, kNumberTitles);
  const yaml::Node* name = fieldOf(node, kNameTitles);
  if (number != nullptr && name != nullptr && numberOf(number->text))
    return table.add(*numberOf(number->text), name->text, node.place());
  for (const auto& [key, value] : node.fields)
  {
    if (value.kind != yaml::Node::Kind::kScalar)
    {
      addTree(value, table);
      continue;
    }
    if (const auto label = numberOf(key))
      table.add(*label, value.text, value.place());
    else if (const auto of_name = numberOf(value.text))
      table.add(*of_name, key, value.place());
  }
}

/** Parses YAML or JSON; a list becomes the value of a key. */
yaml::Node treeOf(std::string text, const std::string& file, bool is_json)
{
  if (is_json)
  {
    try
    {
      text = nlohmann::json::parse(text).dump();  // without tabs, which YAML refuses
    }
    catch (const nlohmann::json::exception& error)
    {
      throw InputError(file, "", std::string("is no JSON (") + error.what() + "); " + kRemedy);
    }
  }
  const std::string begin = trimmed(text).substr(0, 1);
  if (begin == "[" || begin == "-")
    text = (begin == "[" ? "labels: " : "labels:\n") + text;
  return yaml::parseTree(text, file);
}

/** First column whose title fulfils a condition. */
template <typename Condition>
std::optional<std::size_t> columnOf(const std::vector<std::string>& fields, const Condition& condition)
{
  for (std::size_t k = 0; k < fields.size(); ++k)
    if (condition(lowered(trimmed(fields[k]))))
      return k;
  return std::nullopt;
}

/** True for the title of names, e.g. "Color name". */
bool isTitleOfNames(const std::string& title)
{
  constexpr std::size_t kName = 4;
  return kNameTitles.count(title) > 0 ||
         (title.size() > kName && title.compare(title.size() - kName, kName, "name") == 0);
}

void addCsv(std::istream& in, Table& table)
{
  std::size_t number_column = 0;
  std::size_t name_column = 1;
  char separator = 0;
  int line_number = 0;
  for (std::string line; std::getline(in, line);)
  {
    ++line_number;
    if (line_number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
      line.erase(0, 3);
    if (trimmed(line).empty() || line[0] == '#')
      continue;
    const bool is_first = separator == 0;
    if (is_first)
      separator = line.find('\t') != std::string::npos ? '\t' : line.find(';') != std::string::npos ? ';' : ',';
    const std::vector<std::string> fields = csvFields(line, separator);
    const auto name_title = columnOf(fields, isTitleOfNames);
    const auto number_title = columnOf(fields, [](const std::string& title) { return kNumberTitles.count(title) > 0; });
    if (is_first && name_title && number_title)
    {
      number_column = *number_title;
      name_column = *name_title;
      continue;
    }
    if (is_first && fields.size() > 1 && !numberOf(fields[0]) && numberOf(fields[1]))
      std::swap(number_column, name_column);
    if (fields.size() <= std::max(number_column, name_column))
      continue;
    if (const auto label = numberOf(fields[number_column]))
      table.add(*label, fields[name_column], "line " + std::to_string(line_number));
  }
}

/** Colour tables: a number, then a name and colours, or colours and a name in quotes. */
void addColours(std::istream& in, Table& table)
{
  int line_number = 0;
  for (std::string line; std::getline(in, line);)
  {
    ++line_number;
    std::istringstream words(line);
    std::string number;
    std::string name;
    words >> number >> name;
    const auto label = numberOf(number);
    if (!label || name.empty())
      continue;
    const std::size_t quote = line.find('"');
    if (quote != std::string::npos)
      name = line.substr(quote + 1, line.find('"', quote + 1) - quote - 1);
    if (quote != std::string::npos || !numberOf(name))
      table.add(*label, name, "line " + std::to_string(line_number));
  }
}

}  // namespace

LabelNames readLabelNames(const std::string& file)
{
  std::ifstream in = openInputFile(file, kRemedy, std::ios::binary);
  const std::string ending = lowered(std::filesystem::path(file).extension().string());
  Table table(file);
  if (ending == ".yaml" || ending == ".yml" || ending == ".json")
    addTree(treeOf({std::istreambuf_iterator<char>(in), {}}, file, ending == ".json"), table);
  else if (ending == ".csv" || ending == ".tsv")
    addCsv(in, table);
  else if (ending == ".ctbl" || ending == ".txt")
    addColours(in, table);
  else
    throw InputError(file, "", kRemedy);
  return table.take();
}

}  // namespace endovascular_sim::segmentation
