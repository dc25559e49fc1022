#pragma once

#include <string>
#include <vector>

#include "yaml/fields.h"
#include "yaml/tree.h"

namespace endovascular_sim::yaml
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

/** Label of the items of lists in key paths. */
enum class ItemLabel
{
  kIndex,  ///< `branches.2.points`, as overrides name them
  kName,   ///< `branches[trunk].points` if the item has a name
};

/** Reader of the fields of one map of a YAML file. finish() reports keys that the schema did not visit. */
class Reader : public Fields
{
public:
  /** @param root map of the whole file; must outlive the reader
   *  @param report receives warnings and numeric keys. Without a report, values of any magnitude are accepted: those of
   *         a recording have been judged before. */
  Reader(const Node& root, ReadingReport* report, ItemLabel label = ItemLabel::kIndex);

  /** @throws InputError for an unknown key, suggesting the nearest known one */
  void finish() const;

  bool reading() const override { return true; }
  bool has(const std::string& key) override;
  bool hasMap(const std::string& key) override;
  bool hasWord(const std::string& key) override;
  std::vector<std::string> keys() override;
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
            const std::function<void(Fields&, std::size_t)>& visit, Need need) override;
  [[noreturn]] void reject(const std::string& key, const std::string& remedy) const override;
  void warn(const std::string& key, const std::string& remedy) const override;
  void judge(const std::string& key, const Quantity& quantity, double value) const override;
  std::string place(const std::string& key) const override { return deepestOn(key).place(); }

private:
  /** @param node map to read, or nullptr if it is missing
   *  @param parent source of file and line in errors if the map is missing
   *  @param path key path of the map */
  Reader(const Node* node, const Node& parent, std::string path, const Reader& above);
  /** Throws InputError for an unknown key within edit distance 2 of a missing known key. A misspelling is a better
   *  explanation than the missing value. */
  void rejectMisspeltKey() const;
  const Node* visit(const std::string& key, Need need, const std::string& expected);
  /** Adds a key to the report. */
  void list(const std::string& key, const Quantity& quantity, const Range& range);
  /** Adds a warning for an unusual value.
   *  @throws InputError for an impossible value */
  void judge(const Node& node, const std::string& path, const Quantity& quantity, double value,
             const std::string& prefix = "", const std::string& suffix = "") const;
  std::string pathOf(const std::string& key) const;
  /** Deepest existing value on a path below this map. */
  const Node& deepestOn(const std::string& path) const;

  const Node* node_;
  const Node& parent_;
  std::string path_;
  ReadingReport* report_;
  ItemLabel label_;
  std::vector<std::string> known_;
};

}  // namespace endovascular_sim::yaml
