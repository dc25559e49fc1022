#include "yaml/reader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "common/error.h"
#include "common/quantities.h"
#include "common/releases.h"
#include "common/text/format.h"
#include "common/text/words.h"
#include "common/written_unit.h"

namespace endovascular_sim::yaml
{
namespace
{

bool isPureNumber(const Quantity& quantity)
{
  return std::string(quantity.unit) == "1";
}

std::string inUnit(const Quantity& quantity)
{
  return isPureNumber(quantity) ? "" : std::string(" in ") + quantity.unit;
}

[[noreturn]] void rejectNode(const Node& node, const std::string& path, const std::string& remedy)
{
  throw InputError(node.file, path + node.location(), remedy);
}

/** Key path with N in place of list indices. */
std::string withoutIndices(const std::string& path)
{
  std::string result;
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');)
  {
    const bool is_index = !word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) != 0;
    result += (result.empty() ? "" : ".") + (is_index ? "N" : word);
  }
  return result;
}

/** Values that pass both the validity range and the accepted magnitudes of the quantity. */
std::string acceptedText(const Quantity& quantity, const Range& range)
{
  const std::string infinity = range.infinite ? ", .inf" : "";
  const double high = std::min(range.max, quantity.highest);
  if (range.min < 0.0)
    return shortNumber(std::max(range.min, -quantity.highest), 4) + " to " + shortNumber(high, 4) + infinity;
  const double low = std::max(range.min, quantity.lowest);
  const bool zero = range.min == 0.0 && !range.open && low > 0.0;
  return (zero ? "0, " : "") + shortNumber(low, 4) + " to " + shortNumber(high, 4) + infinity;
}

/** Number of a text without a sign, in the unit of the quantity: with a unit behind it, e.g. "5F" or "0.035 in", or
 *  without. */
double toMagnitude(const Node& node, const std::string& path, const Quantity& quantity, const std::string& magnitude)
{
  // std::from_chars also accepts "inf" and "nan", which are plain words in YAML.
  const bool starts_with_digit =
      !magnitude.empty() && (std::isdigit(static_cast<unsigned char>(magnitude[0])) != 0 || magnitude[0] == '.');
  const char* end = magnitude.data() + magnitude.size();
  double value = 0.0;
  const auto result = std::from_chars(magnitude.data(), end, value);
  if (!starts_with_digit || result.ec != std::errc())
    rejectNode(node, path, "\"" + node.text + "\" is not a number; expected a number" + inUnit(quantity));
  const std::string unit(magnitude, static_cast<std::size_t>(result.ptr - magnitude.data()));
  if (unit.empty())
    return value;
  const std::string name = unit.substr(std::min(unit.find_first_not_of(' '), unit.size() - 1));
  const std::optional<double> of_unit = unitValue(quantity, name);
  if (!of_unit)
    rejectNode(node, path, "is \"" + node.text + "\": " + unitRemedy(quantity, name));
  return value * *of_unit;
}

double toNumber(const Node& node, const std::string& path, const Quantity& quantity, const Range& range)
{
  if (node.kind != Node::Kind::kScalar)
    rejectNode(node, path, "expected one number" + inUnit(quantity));
  const std::string& text = node.text;
  const bool signed_text = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string magnitude = signed_text ? text.substr(1) : text;
  double value = 0.0;
  if (magnitude == ".inf" || magnitude == ".Inf" || magnitude == ".INF")
    value = std::numeric_limits<double>::infinity();
  else if (magnitude == ".nan" || magnitude == ".NaN" || magnitude == ".NAN")
    rejectNode(node, path, "is not a number (NaN); expected a finite number" + inUnit(quantity));
  else
    value = toMagnitude(node, path, quantity, magnitude);
  if (signed_text && text[0] == '-')
    value = -value;
  if (!range.contains(value))
  {
    const std::string question = unitQuestion(quantity, value);
    rejectNode(node, path,
               "is " + text + "; must be " + range.description() + inUnit(quantity) +
                   (*range.words == '\0' ? "" : std::string(", ") + range.words) +
                   (question.empty() ? "" : "; " + question));
  }
  return value;
}

/** Units of the columns of a table, e.g. " in s and m". */
std::string inUnits(const std::vector<Quantity>& columns)
{
  std::vector<std::string> units;
  for (const Quantity& column : columns)
    if (!isPureNumber(column) && std::find(units.begin(), units.end(), column.unit) == units.end())
      units.emplace_back(column.unit);
  std::string text;
  for (const std::string& unit : units)
    text += (text.empty() ? " in " : " and ") + unit;
  return text;
}

/** @param columns quantity of each number */
std::vector<double> toNumbers(const Node& node, const std::string& path, const std::vector<Quantity>& columns)
{
  if (node.kind != Node::Kind::kSequence || node.items.size() != columns.size())
    rejectNode(node, path, "expected a list of " + std::to_string(columns.size()) + " numbers" + inUnits(columns));
  std::vector<double> values;
  for (std::size_t i = 0; i < node.items.size(); ++i)
    values.push_back(toNumber(node.items[i], path + "." + std::to_string(i), columns[i], Range::any()));
  return values;
}

}  // namespace

bool Range::contains(double value) const
{
  if (std::isnan(value))
    return false;
  if (std::isinf(value))
    return infinite && value > 0.0;
  return (open ? value > min : value >= min) && value <= max;
}

std::string Range::description() const
{
  const double unbounded = std::numeric_limits<double>::max();
  std::ostringstream text;
  if (min == 0.0 && max == unbounded)
    text << (open ? "positive" : "zero or positive") << (infinite ? ", .inf is permitted" : "");
  else if (min == -unbounded && max == unbounded)
    text << "finite";
  else if (max == unbounded)
    text << (open ? "greater than " : "at least ") << min;
  else if (min == -unbounded)
    text << "at most " << max;
  else
    text << (open ? "greater than " : "between ") << min << (open ? " and at most " : " and ") << max;
  return text.str();
}

Reader::Reader(const Node& root, ReadingReport* report, ItemLabel label)
  : node_(&root), parent_(root), report_(report), label_(label)
{
}

Reader::Reader(const Node* node, const Node& parent, std::string path, const Reader& above)
  : node_(node), parent_(parent), path_(std::move(path)), report_(above.report_), label_(above.label_)
{
  if (node_ != nullptr && node_->kind != Node::Kind::kMap)
    rejectNode(*node_, path_, "expected a map of `key: value` lines");
}

void Reader::finish() const
{
  if (node_ == nullptr)
    return;
  for (const auto& [key, value] : node_->fields)
  {
    if (std::find(known_.begin(), known_.end(), key) != known_.end())
      continue;
    const std::string former = remedyOfFormerKey(pathOf(key));
    rejectNode(value, pathOf(key), former.empty() ? "unknown key; " + suggestion(key, known_, "known keys: ") : former);
  }
}

std::string Reader::pathOf(const std::string& key) const
{
  return keyPath(path_, key);
}

const Node* Reader::visit(const std::string& key, Need need, const std::string& expected)
{
  if (std::find(known_.begin(), known_.end(), key) == known_.end())
    known_.push_back(key);
  const Node* found = node_ == nullptr ? nullptr : node_->find(key);
  if (found == nullptr && need == Need::kRequired)
  {
    reject(key, "missing; give " + expected);
  }
  return found;
}

bool Reader::has(const std::string& key)
{
  return visit(key, Need::kOptional, "") != nullptr;
}

bool Reader::hasMap(const std::string& key)
{
  const Node* node = visit(key, Need::kOptional, "");
  return node != nullptr && node->kind == Node::Kind::kMap;
}

bool Reader::hasWord(const std::string& key)
{
  const Node* node = visit(key, Need::kOptional, "");
  return node != nullptr && node->kind == Node::Kind::kScalar && !node->text.empty() &&
         std::isalpha(static_cast<unsigned char>(node->text.front())) != 0;
}

std::vector<std::string> Reader::keys()
{
  std::vector<std::string> keys;
  if (node_ != nullptr)
    for (const auto& field : node_->fields)
      keys.push_back(field.first);
  return keys;
}

void Reader::list(const std::string& key, const Quantity& quantity, const Range& range)
{
  if (report_ != nullptr)
    report_->keys.push_back({withoutIndices(pathOf(key)), isPureNumber(quantity) ? "" : quantity.unit,
                             intervalText(quantity.low, std::min(quantity.high, range.max)),
                             acceptedText(quantity, range)});
}

void Reader::judge(const Node& node, const std::string& path, const Quantity& quantity, double value,
                   const std::string& prefix, const std::string& suffix) const
{
  if (report_ == nullptr || plausibility(quantity, value) == Plausibility::kUsual)
    return;
  const std::string message = prefix + plausibilityMessage(quantity, value) + suffix;
  if (plausibility(quantity, value) == Plausibility::kImpossible)
    rejectNode(node, path, message);
  report_->warnings.push_back(node.file + ": " + path + node.location() + ": " + message);
}

void Reader::judge(const std::string& key, const Quantity& quantity, double value) const
{
  judge(deepestOn(key), pathOf(key), quantity, value, std::string("in ") + quantity.unit + " ",
        "; check it and the unit of the file");
}

void Reader::number(const std::string& key, double& value, const Quantity& quantity, const Range& range, Need need)
{
  list(key, quantity, range);
  const Node* node = visit(key, need, "a number" + inUnit(quantity));
  if (node == nullptr)
    return;
  value = toNumber(*node, pathOf(key), quantity, range);
  judge(*node, pathOf(key), quantity, value);
}

void Reader::optionalNumber(const std::string& key, double& value, const Quantity& quantity, const Range& range)
{
  number(key, value, quantity, range, Need::kOptional);
}

void Reader::integer(const std::string& key, int& value, int min, int max, Need need)
{
  const std::string interval = std::to_string(min) + " to " + std::to_string(max);
  if (report_ != nullptr)
    report_->keys.push_back({withoutIndices(pathOf(key)), "", interval, interval});
  const Node* node = visit(key, need, "a whole number");
  if (node == nullptr)
    return;
  const double number = toNumber(*node, pathOf(key), quantities::kNumber, Range::any());
  if (number != std::floor(number) || number < min || number > max)
    rejectNode(
        *node, pathOf(key),
        "is " + node->text + "; must be a whole number between " + std::to_string(min) + " and " + std::to_string(max));
  value = static_cast<int>(number);
}

void Reader::bigInteger(const std::string& key, std::uint64_t& value)
{
  if (report_ != nullptr)
    report_->keys.push_back({withoutIndices(pathOf(key)), "", "0 to 2^64 - 1", "0 to 2^64 - 1"});
  const Node* node = visit(key, Need::kOptional, "");
  if (node == nullptr)
    return;
  const std::string& text = node->text;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (node->kind != Node::Kind::kScalar || text.empty() || result.ec != std::errc() || result.ptr != end)
    rejectNode(*node, pathOf(key), "must be a whole number, zero or positive, below 2^64");
}

void Reader::boolean(const std::string& key, bool& value)
{
  const Node* node = visit(key, Need::kOptional, "");
  if (node == nullptr)
    return;
  if (node->kind != Node::Kind::kScalar || (node->text != "true" && node->text != "false"))
    rejectNode(*node, pathOf(key), "is \"" + node->text + "\"; must be true or false");
  value = node->text == "true";
}

void Reader::text(const std::string& key, std::string& value, Need need)
{
  const Node* node = visit(key, need, "a word");
  if (node == nullptr)
    return;
  if (node->kind != Node::Kind::kScalar || node->text.empty())
    rejectNode(*node, pathOf(key), "expected one word or path");
  value = node->text;
}

void Reader::choice(const std::string& key, int& value, const std::vector<std::string>& words, Need need)
{
  const Node* node = visit(key, need, "one of " + listed(words));
  if (node == nullptr)
    return;
  const auto found = std::find(words.begin(), words.end(), node->text);
  if (node->kind != Node::Kind::kScalar || found == words.end())
    rejectNode(*node, pathOf(key), "is \"" + node->text + "\"; must be one of " + listed(words));
  value = static_cast<int>(found - words.begin());
}

void Reader::numbers(const std::string& key, double* values, int size, const Quantity& quantity, Need need)
{
  list(key, quantity, Range::any());
  const Node* node = visit(key, need, "a list of " + std::to_string(size) + " numbers" + inUnit(quantity));
  if (node == nullptr)
    return;
  const std::vector<Quantity> components(static_cast<std::size_t>(size), quantity);
  const std::vector<double> read = toNumbers(*node, pathOf(key), components);
  std::copy(read.begin(), read.end(), values);
  // The largest component decides. The others may be small in a vector along an axis.
  judge(*node, pathOf(key), quantity,
        *std::max_element(read.begin(), read.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

void Reader::rows(const std::string& key, std::vector<std::vector<double>>& values,
                  const std::vector<Quantity>& columns, Need need)
{
  for (std::size_t column = 0; column < columns.size(); ++column)
    list(key + "[" + std::to_string(column) + "]", columns[column], Range::any());
  const std::string expected = "a list of lists of " + std::to_string(columns.size()) + " numbers" + inUnits(columns);
  const Node* node = visit(key, need, expected);
  if (node == nullptr)
    return;
  if (node->kind != Node::Kind::kSequence)
    rejectNode(*node, pathOf(key), "expected " + expected);
  values.clear();
  for (std::size_t i = 0; i < node->items.size(); ++i)
  {
    const std::string path = pathOf(key) + "." + std::to_string(i);
    values.push_back(toNumbers(node->items[i], path, columns));
    for (std::size_t column = 0; column < columns.size(); ++column)
      judge(node->items[i], path, columns[column], values.back()[column]);
  }
}

void Reader::map(const std::string& key, const Visit& visit_fields)
{
  const Node* node = visit(key, Need::kOptional, "");
  Reader child(node, node_ == nullptr ? parent_ : *node_, pathOf(key), *this);
  visit_fields(child);
  child.finish();
}

void Reader::list(const std::string& key, std::size_t /*size*/, const std::function<void(std::size_t)>& resize,
                  const std::function<void(Fields&, std::size_t)>& visit_fields, Need need)
{
  const Node* node = visit(key, need, "a list, one `- ` entry each");
  if (node == nullptr)
    return;
  if (node->kind != Node::Kind::kSequence || (need == Need::kRequired && node->items.empty()))
    rejectNode(*node, pathOf(key), "expected a list, one `- ` entry each");
  resize(node->items.size());
  for (std::size_t i = 0; i < node->items.size(); ++i)
  {
    const Node& item = node->items[i];
    const Node* name = label_ == ItemLabel::kName ? item.find("name") : nullptr;
    const bool is_named = name != nullptr && name->kind == Node::Kind::kScalar;
    Reader child(&item, *node, pathOf(key) + (is_named ? "[" + name->text + "]" : "." + std::to_string(i)), *this);
    visit_fields(child, i);
    child.finish();
  }
}

void Reader::reject(const std::string& key, const std::string& remedy) const
{
  rejectMisspeltKey();
  const Node& deepest = deepestOn(key);
  throw InputError(deepest.file, (key.empty() ? path_ : pathOf(key)) + deepest.location(), remedy);
}

void Reader::warn(const std::string& key, const std::string& remedy) const
{
  if (report_ == nullptr)
    return;
  const Node& deepest = deepestOn(key);
  report_->warnings.push_back(InputError(deepest.file, pathOf(key) + deepest.location(), remedy).what());
}

const Node& Reader::deepestOn(const std::string& path) const
{
  const Node* deepest = node_ == nullptr ? &parent_ : node_;
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');)
    if (const Node* next = deepest->below(word))
      deepest = next;
    else
      break;
  return *deepest;
}

void Reader::rejectMisspeltKey() const
{
  if (node_ == nullptr)
    return;
  const auto is_known = [this](const std::string& key)
  { return std::find(known_.begin(), known_.end(), key) != known_.end(); };
  for (const auto& [key, value] : node_->fields)
    for (const std::string& known : known_)
      if (!is_known(key) && editDistance(key, known) <= 2 && node_->find(known) == nullptr)
        rejectNode(value, pathOf(key), "unknown key; did you mean \"" + known + "\"?");
}

}  // namespace endovascular_sim::yaml
