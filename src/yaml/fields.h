#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/quantity.h"

namespace endovascular_sim::yaml
{

/** Interval of valid values. */
struct Range
{
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool open = false;       ///< true if min is excluded
  bool infinite = false;   ///< true if infinity is valid
  const char* words = "";  ///< the interval in the unit of daily use, for messages, e.g. "20 to 300 per minute"

  bool contains(double value) const;
  /** Description for messages, e.g. "positive" or "between 0 and 1". */
  std::string description() const;

  static Range any() { return {}; }
  static Range positive() { return {0.0, std::numeric_limits<double>::max(), true, false}; }
  static Range positiveUpTo(double high) { return {0.0, high, true, false}; }
  static Range nonNegative() { return {0.0, std::numeric_limits<double>::max(), false, false}; }
  static Range between(double low, double high) { return {low, high, false, false}; }
};

enum class Need
{
  kOptional,  ///< a missing key leaves the value unchanged
  kRequired,  ///< a missing key is an error
};

/** Visitor of the fields of one map of a YAML file.
 *
 *  A schema is written once against this interface, for both reading and writing. Reading throws InputError for a
 *  value that is missing, of the wrong type or out of range. Each key that the schema visits counts as known. The
 *  quantity of a number gives its unit, and its usual magnitudes for messages about mistakes of unit. A number may be
 *  written with another unit of the same dimension (common/written_unit.h), and is read in the quantity's. */
class Fields
{
public:
  virtual ~Fields() = default;

  virtual bool reading() const = 0;
  /** True if the map contains a value for @p key; false while writing. */
  virtual bool has(const std::string& key) = 0;
  /** True if the value of @p key is a map. */
  virtual bool hasMap(const std::string& key) = 0;
  /** True if the value of @p key is a word, i.e. text that begins with a letter. */
  virtual bool hasWord(const std::string& key) = 0;
  /** Keys of the map, in the order of the file; empty while writing. For maps from names of the user's choice. */
  virtual std::vector<std::string> keys() = 0;

  virtual void number(const std::string& key, double& value, const Quantity& quantity, const Range& range,
                      Need need = Need::kOptional) = 0;
  /** Visits a number that may be missing; NaN represents a missing one. */
  virtual void optionalNumber(const std::string& key, double& value, const Quantity& quantity, const Range& range) = 0;
  virtual void integer(const std::string& key, int& value, int min, int max, Need need = Need::kOptional) = 0;
  virtual void bigInteger(const std::string& key, std::uint64_t& value) = 0;
  virtual void boolean(const std::string& key, bool& value) = 0;
  virtual void text(const std::string& key, std::string& value, Need need = Need::kOptional) = 0;
  /** Visits one of @p words; the value is its index. */
  virtual void choice(const std::string& key, int& value, const std::vector<std::string>& words,
                      Need need = Need::kOptional) = 0;
  /** Visits a list of @p size numbers, e.g. [0, 0, 1]. */
  virtual void numbers(const std::string& key, double* values, int size, const Quantity& quantity,
                       Need need = Need::kOptional) = 0;
  /** Visits a table of rows with one number per column, e.g. [[0, 0], [1, 0.03]]. */
  virtual void rows(const std::string& key, std::vector<std::vector<double>>& values,
                    const std::vector<Quantity>& columns, Need need = Need::kOptional) = 0;

  using Visit = std::function<void(Fields&)>;
  /** Visits a map. A missing map is visited as an empty one, so that its missing required keys are reported. */
  virtual void map(const std::string& key, const Visit& visit) = 0;
  /** Visits a list of maps. @p resize is called with the length while reading; @p size is the length while writing. */
  virtual void list(const std::string& key, std::size_t size, const std::function<void(std::size_t)>& resize,
                    const std::function<void(Fields&, std::size_t)>& visit, Need need = Need::kOptional) = 0;

  /** Throws InputError for @p key, which may be a path below this map; an empty key denotes the map itself. */
  [[noreturn]] virtual void reject(const std::string& key, const std::string& remedy) const = 0;

  /** Adds a warning about @p key, as reject() names it. */
  virtual void warn(const std::string& key, const std::string& remedy) const = 0;

  /** Judges a value that follows from @p key and the unit of the file; adds a warning if it is unusual.
   *  @param value value in the unit of the quantity
   *  @throws InputError for an impossible value */
  virtual void judge(const std::string& key, const Quantity& quantity, double value) const = 0;

  /** Line of the value of @p key, which may be a path below this map, e.g. "line 7"; empty while writing. */
  virtual std::string place(const std::string& key) const = 0;

  void vector3(const std::string& key, Eigen::Vector3d& value, const Quantity& quantity, Need need = Need::kOptional)
  {
    numbers(key, value.data(), 3, quantity, need);
  }

  template <typename Enum>
  void option(const std::string& key, Enum& value, const std::vector<std::string>& words, Need need = Need::kOptional)
  {
    int index = static_cast<int>(value);
    choice(key, index, words, need);
    value = static_cast<Enum>(index);
  }
};

}  // namespace endovascular_sim::yaml
