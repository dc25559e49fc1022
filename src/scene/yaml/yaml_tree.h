#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::scene
{

/** Value of a scene file with its source location, for error messages. */
struct SceneNode
{
  enum class Kind
  {
    kNull,
    kScalar,
    kSequence,
    kMap,
  };

  Kind kind = Kind::kNull;
  std::string text;                                       ///< text of a scalar
  std::vector<SceneNode> items;                           ///< items of a sequence
  std::vector<std::pair<std::string, SceneNode>> fields;  ///< fields of a map, in the order of the file
  std::string file;                                       ///< source file
  int line = 0;                                           ///< source line from 1; 0 for an override

  /** Field @p key of a map; nullptr if it is missing or null. */
  const SceneNode* find(const std::string& key) const;

  /** Source location for messages: " (line 7)", or " (--set)" for an override. */
  std::string location() const;
};

/** Parses YAML text whose root is a map.
 *  @param origin name of the text in errors
 *  @throws InputError as parseYamlText(), and for a duplicate key */
SceneNode parseSceneTree(const std::string& yaml, const std::string& origin);

/** Reads a YAML file whose root is a map.
 *  @throws InputError as parseSceneTree(), and for a missing or empty file */
SceneNode readSceneTree(const std::string& file);

/** Applies an override `key.path=value`. The value is YAML, and a number in the path is a list index. Missing keys of
 *  the path are created. A plain value needs no quotes for ` #` and `: `, which paths of files may contain.
 *  @param origin name of the file in errors
 *  @throws InputError for a malformed override, a path through a scalar, or an index out of range */
void overrideSceneTree(SceneNode& root, const std::string& override_text, const std::string& origin);

}  // namespace endovascular_sim::scene
