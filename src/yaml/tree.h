#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::yaml
{

/** Value of a YAML file with its source location, for error messages. */
struct Node
{
  enum class Kind
  {
    kNull,
    kScalar,
    kSequence,
    kMap,
  };

  Kind kind = Kind::kNull;
  std::string text;                                  ///< text of a scalar
  std::vector<Node> items;                           ///< items of a sequence
  std::vector<std::pair<std::string, Node>> fields;  ///< fields of a map, in the order of the file
  std::string file;                                  ///< source file
  int line = 0;                                      ///< source line from 1; 0 for an override

  /** Field @p key of a map; nullptr if it is missing or null. */
  const Node* find(const std::string& key) const;

  /** Field @p key of a map, which may be null; nullptr if it is missing. */
  Node* field(const std::string& key);

  /** Field @p word of a map, or item of a list with this index; nullptr if it is missing or null. */
  const Node* below(const std::string& word) const;

  /** Source location, e.g. "line 7"; "--set" for an override. */
  std::string place() const;

  /** Source location after a key path in messages, e.g. " (line 7)". */
  std::string location() const { return " (" + place() + ")"; }
};

/** Path of a key in errors, e.g. "drive.speed"; the key itself below the root, whose path is empty. */
std::string keyPath(const std::string& path, const std::string& key);

/** Parses YAML text whose root is a map.
 *  @param origin name of the text in errors
 *  @throws InputError as parseYamlText(), and for a duplicate key */
Node parseTree(const std::string& yaml, const std::string& origin);

/** Reads a YAML file whose root is a map.
 *  @param remedy file to give instead of a missing one
 *  @throws InputError as parseTree(), and for a missing, unreadable or empty file */
Node readTree(const std::string& file, const std::string& remedy = "give the path of a YAML file");

/** Applies an override `key.path=value`. The value is YAML, and a number in the path is a list index. Missing keys of
 *  the path are created. A plain value needs no quotes for ` #` and `: `, which paths of files may contain.
 *  @param origin name of the file in errors
 *  @throws InputError for a malformed override, a path through a scalar, or an index out of range */
void overrideTree(Node& root, const std::string& override_text, const std::string& origin);

}  // namespace endovascular_sim::yaml
