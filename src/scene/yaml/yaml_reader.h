#pragma once

#include <string>
#include <vector>

#include "scene/yaml/fields.h"
#include "scene/yaml/yaml_tree.h"

namespace endovascular_sim::scene
{

/** Reader of the fields of one map of a scene file. finish() reports keys that the schema did not visit. */
class SceneReader : public SceneFields
{
public:
  /** @param node map to read, or nullptr if it is missing
   *  @param parent source of file and line in errors if the map is missing
   *  @param path key path of the map; empty for the scene itself */
  SceneReader(const SceneNode* node, const SceneNode& parent, std::string path);

  /** @throws InputError for an unknown key, suggesting the nearest known one */
  void finish() const;

  bool reading() const override { return true; }
  bool has(const std::string& key) override;
  bool hasMap(const std::string& key) override;
  bool hasWord(const std::string& key) override;
  void number(const std::string& key, double& value, const std::string& unit, const Range& range, Need need) override;
  void optionalNumber(const std::string& key, double& value, const std::string& unit, const Range& range) override;
  void integer(const std::string& key, int& value, int min, int max, Need need) override;
  void bigInteger(const std::string& key, std::uint64_t& value) override;
  void boolean(const std::string& key, bool& value) override;
  void text(const std::string& key, std::string& value, Need need) override;
  void choice(const std::string& key, int& value, const std::vector<std::string>& words, Need need) override;
  void numbers(const std::string& key, double* values, int size, const std::string& unit, Need need) override;
  void rows(const std::string& key, std::vector<std::vector<double>>& values, int width, const std::string& unit,
            Need need) override;
  void map(const std::string& key, const Visit& visit) override;
  void list(const std::string& key, std::size_t size, const std::function<void(std::size_t)>& resize,
            const std::function<void(SceneFields&, std::size_t)>& visit, Need need) override;
  [[noreturn]] void refuse(const std::string& key, const std::string& remedy) const override;

private:
  /** Throws InputError for an unknown key within edit distance 2 of a missing known key. A misspelling is a better
   *  explanation than the missing value. */
  void refuseMisspeltKey() const;
  const SceneNode* visit(const std::string& key, Need need, const std::string& expected);
  std::string pathOf(const std::string& key) const;

  const SceneNode* node_;
  const SceneNode& parent_;
  std::string path_;
  std::vector<std::string> known_;
};

/** Word of @p known nearest to @p word in edit distance; empty if none is close. */
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

}  // namespace endovascular_sim::scene
