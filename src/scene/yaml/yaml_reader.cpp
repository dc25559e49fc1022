#include "scene/yaml/yaml_reader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "common/error.h"

namespace endovascular_sim::scene
{
namespace
{

std::string inUnit(const std::string& unit)
{
  return unit == "1" ? "" : " in " + unit;
}

std::string listed(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

[[noreturn]] void refuseNode(const SceneNode& node, const std::string& path, const std::string& remedy)
{
  throw InputError(node.file, path + node.location(), remedy);
}

double toNumber(const SceneNode& node, const std::string& path, const std::string& unit, const Range& range)
{
  if (node.kind != SceneNode::Kind::kScalar)
    refuseNode(node, path, "expected one number" + inUnit(unit));
  const std::string& text = node.text;
  const bool signed_text = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string magnitude = signed_text ? text.substr(1) : text;
  double value = 0.0;
  if (magnitude == ".inf" || magnitude == ".Inf" || magnitude == ".INF")
    value = std::numeric_limits<double>::infinity();
  else if (magnitude == ".nan" || magnitude == ".NaN" || magnitude == ".NAN")
    refuseNode(node, path, "is not a number (NaN); expected a finite number" + inUnit(unit));
  else
  {
    // std::from_chars also accepts "inf" and "nan", which are plain words in YAML.
    const bool starts_with_digit =
        !magnitude.empty() && (std::isdigit(static_cast<unsigned char>(magnitude[0])) != 0 || magnitude[0] == '.');
    const char* end = magnitude.data() + magnitude.size();
    const auto result = std::from_chars(magnitude.data(), end, value);
    if (!starts_with_digit || result.ec != std::errc() || result.ptr != end)
      refuseNode(node, path,
                 "\"" + text + "\" is not a number; expected a number" + inUnit(unit) +
                     (unit == "1" ? "" : ", written without the unit"));
  }
  if (signed_text && text[0] == '-')
    value = -value;
  if (!range.contains(value))
    refuseNode(node, path, "is " + text + "; must be " + range.description() + inUnit(unit));
  return value;
}

std::vector<double> toNumbers(const SceneNode& node, const std::string& path, int size, const std::string& unit)
{
  if (node.kind != SceneNode::Kind::kSequence || node.items.size() != static_cast<std::size_t>(size))
    refuseNode(node, path, "expected a list of " + std::to_string(size) + " numbers" + inUnit(unit));
  std::vector<double> values;
  for (std::size_t i = 0; i < node.items.size(); ++i)
    values.push_back(toNumber(node.items[i], path + "." + std::to_string(i), unit, Range::any()));
  return values;
}

std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
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

std::string nearestWord(const std::string& word, const std::vector<std::string>& known)
{
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : known)
  {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < best)
    {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

SceneReader::SceneReader(const SceneNode* node, const SceneNode& parent, std::string path)
  : node_(node), parent_(parent), path_(std::move(path))
{
  if (node_ != nullptr && node_->kind != SceneNode::Kind::kMap)
    refuseNode(*node_, path_, "expected a map of `key: value` lines");
}

void SceneReader::finish() const
{
  if (node_ == nullptr)
    return;
  for (const auto& [key, value] : node_->fields)
  {
    if (std::find(known_.begin(), known_.end(), key) != known_.end())
      continue;
    const std::string nearest = nearestWord(key, known_);
    refuseNode(
        value, pathOf(key),
        "unknown key; " + (nearest.empty() ? "known keys: " + listed(known_) : "did you mean \"" + nearest + "\"?"));
  }
}

std::string SceneReader::pathOf(const std::string& key) const
{
  return path_.empty() ? key : path_ + "." + key;
}

const SceneNode* SceneReader::visit(const std::string& key, Need need, const std::string& expected)
{
  if (std::find(known_.begin(), known_.end(), key) == known_.end())
    known_.push_back(key);
  const SceneNode* found = node_ == nullptr ? nullptr : node_->find(key);
  if (found == nullptr && need == Need::kRequired)
  {
    refuse(key, "missing; give " + expected);
  }
  return found;
}

bool SceneReader::has(const std::string& key)
{
  return visit(key, Need::kOptional, "") != nullptr;
}

bool SceneReader::hasMap(const std::string& key)
{
  const SceneNode* node = visit(key, Need::kOptional, "");
  return node != nullptr && node->kind == SceneNode::Kind::kMap;
}

bool SceneReader::hasWord(const std::string& key)
{
  const SceneNode* node = visit(key, Need::kOptional, "");
  return node != nullptr && node->kind == SceneNode::Kind::kScalar && !node->text.empty() &&
         std::isalpha(static_cast<unsigned char>(node->text.front())) != 0;
}

void SceneReader::number(const std::string& key, double& value, const std::string& unit, const Range& range, Need need)
{
  if (const SceneNode* node = visit(key, need, "a number" + inUnit(unit)))
    value = toNumber(*node, pathOf(key), unit, range);
}

void SceneReader::optionalNumber(const std::string& key, double& value, const std::string& unit, const Range& range)
{
  number(key, value, unit, range, Need::kOptional);
}

void SceneReader::integer(const std::string& key, int& value, int min, int max, Need need)
{
  const SceneNode* node = visit(key, need, "a whole number");
  if (node == nullptr)
    return;
  const double number = toNumber(*node, pathOf(key), "1", Range::any());
  if (number != std::floor(number) || number < min || number > max)
    refuseNode(
        *node, pathOf(key),
        "is " + node->text + "; must be a whole number between " + std::to_string(min) + " and " + std::to_string(max));
  value = static_cast<int>(number);
}

void SceneReader::bigInteger(const std::string& key, std::uint64_t& value)
{
  const SceneNode* node = visit(key, Need::kOptional, "");
  if (node == nullptr)
    return;
  const std::string& text = node->text;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (node->kind != SceneNode::Kind::kScalar || text.empty() || result.ec != std::errc() || result.ptr != end)
    refuseNode(*node, pathOf(key), "must be a whole number, zero or positive, below 2^64");
}

void SceneReader::boolean(const std::string& key, bool& value)
{
  const SceneNode* node = visit(key, Need::kOptional, "");
  if (node == nullptr)
    return;
  if (node->kind != SceneNode::Kind::kScalar || (node->text != "true" && node->text != "false"))
    refuseNode(*node, pathOf(key), "is \"" + node->text + "\"; must be true or false");
  value = node->text == "true";
}

void SceneReader::text(const std::string& key, std::string& value, Need need)
{
  const SceneNode* node = visit(key, need, "a word");
  if (node == nullptr)
    return;
  if (node->kind != SceneNode::Kind::kScalar || node->text.empty())
    refuseNode(*node, pathOf(key), "expected one word or path");
  value = node->text;
}

void SceneReader::choice(const std::string& key, int& value, const std::vector<std::string>& words, Need need)
{
  const SceneNode* node = visit(key, need, "one of " + listed(words));
  if (node == nullptr)
    return;
  const auto found = std::find(words.begin(), words.end(), node->text);
  if (node->kind != SceneNode::Kind::kScalar || found == words.end())
    refuseNode(*node, pathOf(key), "is \"" + node->text + "\"; must be one of " + listed(words));
  value = static_cast<int>(found - words.begin());
}

void SceneReader::numbers(const std::string& key, double* values, int size, const std::string& unit, Need need)
{
  const SceneNode* node = visit(key, need, "a list of " + std::to_string(size) + " numbers" + inUnit(unit));
  if (node == nullptr)
    return;
  const std::vector<double> read = toNumbers(*node, pathOf(key), size, unit);
  std::copy(read.begin(), read.end(), values);
}

void SceneReader::rows(const std::string& key, std::vector<std::vector<double>>& values, int width,
                       const std::string& unit, Need need)
{
  const SceneNode* node = visit(key, need, "a list of lists of " + std::to_string(width) + " numbers" + inUnit(unit));
  if (node == nullptr)
    return;
  if (node->kind != SceneNode::Kind::kSequence)
    refuseNode(*node, pathOf(key), "expected a list of lists of " + std::to_string(width) + " numbers" + inUnit(unit));
  values.clear();
  for (std::size_t i = 0; i < node->items.size(); ++i)
    values.push_back(toNumbers(node->items[i], pathOf(key) + "." + std::to_string(i), width, unit));
}

void SceneReader::map(const std::string& key, const Visit& visit_fields)
{
  const SceneNode* node = visit(key, Need::kOptional, "");
  SceneReader child(node, node_ == nullptr ? parent_ : *node_, pathOf(key));
  visit_fields(child);
  child.finish();
}

void SceneReader::list(const std::string& key, std::size_t /*size*/, const std::function<void(std::size_t)>& resize,
                       const std::function<void(SceneFields&, std::size_t)>& visit_fields, Need need)
{
  const SceneNode* node = visit(key, need, "a list, one `- ` entry each");
  if (node == nullptr)
    return;
  if (node->kind != SceneNode::Kind::kSequence || (need == Need::kRequired && node->items.empty()))
    refuseNode(*node, pathOf(key), "expected a list, one `- ` entry each");
  resize(node->items.size());
  for (std::size_t i = 0; i < node->items.size(); ++i)
  {
    SceneReader child(&node->items[i], *node, pathOf(key) + "." + std::to_string(i));
    visit_fields(child, i);
    child.finish();
  }
}

void SceneReader::refuse(const std::string& key, const std::string& remedy) const
{
  refuseMisspeltKey();
  // The key may be a path below this map. The deepest existing value on the path supplies file and line.
  const SceneNode* deepest = node_ == nullptr ? &parent_ : node_;
  std::istringstream path(key);
  for (std::string word; std::getline(path, word, '.');)
    if (const SceneNode* next = deepest->find(word))
      deepest = next;
    else
      break;
  throw InputError(deepest->file, (key.empty() ? path_ : pathOf(key)) + deepest->location(), remedy);
}

void SceneReader::refuseMisspeltKey() const
{
  if (node_ == nullptr)
    return;
  const auto is_known = [this](const std::string& key)
  { return std::find(known_.begin(), known_.end(), key) != known_.end(); };
  for (const auto& [key, value] : node_->fields)
    for (const std::string& known : known_)
      if (!is_known(key) && editDistance(key, known) <= 2 && node_->find(known) == nullptr)
        refuseNode(value, pathOf(key), "unknown key; did you mean \"" + known + "\"?");
}

}  // namespace endovascular_sim::scene
