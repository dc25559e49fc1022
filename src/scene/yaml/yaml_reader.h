#pragma once

#include <string>
#include <vector>

#include "scene/yaml/fields.h"
#include "scene/yaml/yaml_tree.h"

namespace endovascular_sim::scene
{

/** Numeric key of the schema. */
struct NumericKey
{
  std::string path;      ///< key path; a list index is written as N
  std::string unit;      ///< unit of the value; empty for a pure number
  std::string usual;     ///< usual magnitudes
  std::string accepted;  ///< accepted values
};

/** Results of reading, besides the values. */
struct ReadingReport
{
  /** Unusual values, each as `file: key.path (line): is VALUE: question for the likely unit`. */
  std::vector<std::string> warnings;
  std::vector<NumericKey> keys;  ///< numeric keys in the order of the visits, also those without a value
};

/** Reader of the fields of one map of a scene file. finish() reports keys that the schema did not visit. */
class SceneReader : public SceneFields
{
public:
  /** @param node map to read, or nullptr if it is missing
   *  @param parent source of file and line in errors if the map is missing
   *  @param path key path of the map; empty for the scene itself
   *  @param report receives warnings and numeric keys. Without a report, values of any magnitude are accepted: those of
   *         a recording have been judged before. */
  SceneReader(const SceneNode* node, const SceneNode& parent, std::string path, ReadingReport* report);

  /** @throws InputError for an unknown key, suggesting the nearest known one */
  void finish() const;

  bool reading() const override { return true; }
  bool has(const std::string& key) override;
  bool hasMap(const std::string& key) override;
  bool hasWord(const std::string& key) override;
  void number(const std::string& key, double& value, const Quantity& quantity, const Range& range, Need need) override;
  void optionalNumber(const std::string& key, double& value, const Quantity& quantity, const Range& range) override;
  void integer(const std::string& key, int& value, int min, int max, Need need) override;
  void bigInteger(const std::string& key, std::uint64_t& value) override;
  void boolean(const std::string& key, bool& value) override;
  void text(const std::string& key, std::string& value, Need need) override;
  void choice(const std::string& key, int& value, const std::vector<std::string>& words, Need need) override;
  void numbers(const std::string& key, double* values, int size, const Quantity& quantity, Need need) override;
  void rows(const std::string& key, std::vector<std::vector<double>>& values, const std::vector<Quantity>& columns,
            Need need) override;
  void map(const std::string& key, const Visit& visit) override;
  void list(const std::string& key, std::size_t size, const std::function<void(std::size_t)>& resize,
            const std::function<void(SceneFields&, std::size_t)>& visit, Need need) override;
  [[noreturn]] void reject(const std::string& key, const std::string& remedy) const override;
  void warn(const std::string& key, const std::string& remedy) const override;

private:
  /** Throws InputError for an unknown key within edit distance 2 of a missing known key. A misspelling is a better
   *  explanation than the missing value. */
  void rejectMisspeltKey() const;
  const SceneNode* visit(const std::string& key, Need need, const std::string& expected);
  /** Adds a key to the report. */
  void list(const std::string& key, const Quantity& quantity, const Range& range);
  /** Adds a warning for an unusual value.
   *  @throws InputError for an impossible value */
  void judge(const SceneNode& node, const std::string& path, const Quantity& quantity, double value);
  std::string pathOf(const std::string& key) const;
  /** Deepest existing value on a path below this map. */
  const SceneNode& deepestOn(const std::string& path) const;

  const SceneNode* node_;
  const SceneNode& parent_;
  std::string path_;
  ReadingReport* report_;
  std::vector<std::string> known_;
};

/** Word of @p known nearest to @p word in edit distance; empty if none is close. */
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

}  // namespace endovascular_sim::scene
