#pragma once

#include <string>

#include "yaml/fields.h"

namespace endovascular_sim::yaml
{

/** Text in double quotes of YAML. */
std::string quoted(const std::string& value);

/** Writer of fields as canonical YAML: schema order, all values explicit, numbers in the shortest form that reads back
 *  to the same bits. */
class Writer : public Fields
{
public:
  explicit Writer(int depth = 0) : depth_(depth) {}

  const std::string& yaml() const { return yaml_; }

  bool reading() const override { return false; }
  bool has(const std::string& /*key*/) override { return false; }
  bool hasMap(const std::string& /*key*/) override { return false; }
  bool hasWord(const std::string& /*key*/) override { return false; }
  std::vector<std::string> keys() override { return {}; }
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
  /** Does nothing: values were judged when they were read. */
  void warn(const std::string& /*key*/, const std::string& /*remedy*/) const override {}
  void judge(const std::string& /*key*/, const Quantity& /*quantity*/, double /*value*/) const override {}
  std::string place(const std::string& /*key*/) const override { return ""; }

private:
  void line(const std::string& key, const std::string& value);

  int depth_;
  std::string yaml_;
};

}  // namespace endovascular_sim::yaml
