#include "yaml/tree.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "common/error.h"
#include "yaml/text.h"

namespace endovascular_sim::yaml
{
namespace
{

Node convert(const YAML::Node& yaml, const std::string& file, const std::string& path)
{
  Node node;
  node.file = file;
  node.line = yaml.Mark().line + 1;
  std::map<std::string, int> lines;  // of the keys of a map
  switch (yaml.Type())
  {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      break;
    case YAML::NodeType::Scalar:
      node.kind = Node::Kind::kScalar;
      node.text = yaml.Scalar();
      break;
    case YAML::NodeType::Sequence:
      node.kind = Node::Kind::kSequence;
      for (std::size_t i = 0; i < yaml.size(); ++i)
        node.items.push_back(convert(yaml[i], file, keyPath(path, std::to_string(i))));
      break;
    case YAML::NodeType::Map:
      node.kind = Node::Kind::kMap;
      for (const auto& entry : yaml)
      {
        if (!entry.first.IsScalar())
          throw InputError(file, path + node.location(), "a key must be a plain word");
        const std::string& key = entry.first.Scalar();
        const int line = entry.first.Mark().line + 1;
        if (const auto [earlier, is_new] = lines.emplace(key, line); !is_new)
          throw InputError(
              file, keyPath(path, key) + " (line " + std::to_string(line) + ")",
              "duplicate key, given first in line " + std::to_string(earlier->second) + "; keep one of the two");
        node.fields.emplace_back(key, convert(entry.second, file, keyPath(path, key)));
        node.fields.back().second.line = line;
      }
      break;
  }
  return node;
}

/** True for the text of a plain scalar. All others begin with an indicator of YAML, or stand on several lines. */
bool isPlainText(const std::string& text)
{
  const bool is_item = text == "-" || text.substr(0, 2) == "- " || text.substr(0, 2) == "? ";
  return !text.empty() && !is_item && text.find_first_of("[]{}\"'&*!|>%@`#,\n") != 0 &&
         text.find('\n') == std::string::npos;
}

/** Value of an override. A plain text is taken as a whole: in a path, ` #` begins no comment and `: ` no map. */
Node valueOf(const std::string& text, const std::string& origin, const std::string& where)
{
  const bool needs_quotes = text.find(": ") != std::string::npos || text.find(" #") != std::string::npos;
  if (!isPlainText(text) || !needs_quotes)
    return convert(parseYamlText(text, origin, where), origin, where);
  Node node;
  node.file = origin;
  node.kind = Node::Kind::kScalar;
  node.text = text;
  return node;
}

void markAsOverride(Node& node)
{
  node.line = 0;
  for (Node& item : node.items)
    markAsOverride(item);
  for (auto& field : node.fields)
    markAsOverride(field.second);
}

/** Index of a list; empty for a word that is none. */
std::optional<std::size_t> indexOf(const std::string& word)
{
  const bool is_index = !word.empty() && word.size() < 7 &&
                        std::all_of(word.begin(), word.end(), [](unsigned char c) { return c >= '0' && c <= '9'; });
  return is_index ? std::optional<std::size_t>(std::stoul(word)) : std::nullopt;
}

Node& descend(Node& node, const std::string& key, const std::string& where, const std::string& origin)
{
  if (node.kind == Node::Kind::kSequence)
  {
    const std::size_t index = indexOf(key).value_or(node.items.size());
    if (index >= node.items.size())
      throw InputError(origin, where,
                       "\"" + key + "\" is not an index of this list; it has " + std::to_string(node.items.size()) +
                           " elements, counted from 0");
    return node.items[index];
  }
  if (node.kind == Node::Kind::kScalar)
    throw InputError(origin, where, "\"" + key + "\" is below the scalar \"" + node.text + "\", which has no keys");
  node.kind = Node::Kind::kMap;
  if (Node* existing = node.field(key))
    return *existing;
  Node fresh;
  fresh.file = origin;
  node.fields.emplace_back(key, fresh);
  return node.fields.back().second;
}

}  // namespace

const Node* Node::find(const std::string& key) const
{
  for (const auto& field : fields)
    if (field.first == key)
      return field.second.kind == Kind::kNull ? nullptr : &field.second;
  return nullptr;
}

Node* Node::field(const std::string& key)
{
  for (auto& field : fields)
    if (field.first == key)
      return &field.second;
  return nullptr;
}

const Node* Node::below(const std::string& word) const
{
  if (kind != Kind::kSequence)
    return find(word);
  const std::optional<std::size_t> index = indexOf(word);
  return index && *index < items.size() && items[*index].kind != Kind::kNull ? &items[*index] : nullptr;
}

std::string Node::place() const
{
  return line > 0 ? "line " + std::to_string(line) : "--set";
}

std::string keyPath(const std::string& path, const std::string& key)
{
  return path.empty() ? key : path + "." + key;
}

Node parseTree(const std::string& yaml, const std::string& origin)
{
  Node root = convert(parseYamlText(yaml, origin), origin, "");
  if (root.kind != Node::Kind::kMap)
    throw InputError(origin, "line 1", "has no keys; expected `key: value` lines");
  return root;
}

Node readTree(const std::string& file, const std::string& remedy)
{
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(file, "", "no such file; " + remedy);
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file, "", "is not a file; " + remedy);
  std::ifstream stream(file);
  if (!stream)
    throw InputError(file, "", "cannot be read; check its permissions");
  std::ostringstream text;
  text << stream.rdbuf();
  return parseTree(text.str(), file);
}

void overrideTree(Node& root, const std::string& override_text, const std::string& origin)
{
  const std::string where = "--set " + override_text;
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(origin, where, "expected key.path=value, e.g. --set drive.speed=0.02");
  Node* node = &root;
  std::istringstream path(override_text.substr(0, equals));
  for (std::string key; std::getline(path, key, '.');)
    node = &descend(*node, key, where, origin);
  *node = valueOf(override_text.substr(equals + 1), origin, where);
  markAsOverride(*node);
}

}  // namespace endovascular_sim::yaml
