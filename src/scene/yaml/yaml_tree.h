#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::scene
{

/** A value of a scene file with the place it came from, so that every refusal can name it. */
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
  std::string text;                                       ///< of a scalar
  std::vector<SceneNode> items;                           ///< of a sequence
  std::vector<std::pair<std::string, SceneNode>> fields;  ///< of a map, in the file's order
  std::string file;                                       ///< file it was read from
  int line = 0;                                           ///< counted from 1; 0 where an override set it

  /** Field @p key of a map; nullptr when it is absent or null. */
  const SceneNode* find(const std::string& key) const;

  /** " (line 7)", or " (--set)" for an override. */
  std::string place() const;
};

/** Reads YAML text.
 *  @param origin names the text in errors
 *  @throws InputError for broken syntax, a key given twice, an anchor that contains itself */
SceneNode parseSceneTree(const std::string& yaml, const std::string& origin);

/** Reads a YAML file whose root is a map.
 *  @throws InputError as parseSceneTree(), and for a missing or empty file */
SceneNode readSceneTree(const std::string& file);

/** Applies `key.path=value`; the value is YAML, a number in the path is a list index. The last key of the path may be
 * new.
 *  @param origin file named in errors
 *  @throws InputError for a malformed override, a path through a value that has no fields, an index out of range */
void overrideSceneTree(SceneNode& root, const std::string& override_text, const std::string& origin);

}  // namespace endovascular_sim::scene
