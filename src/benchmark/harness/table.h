#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::benchmark
{

/** A table of results that is written as CSV and as Markdown. */
class Table
{
public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /** @param cells as many as there are columns */
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  std::size_t rows() const { return rows_.size(); }
  std::string csv() const;
  std::string markdown() const;

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/** A number with the given count of significant digits; an empty text for NaN. */
std::string number(double value, int digits = 3);

}  // namespace endovascular_sim::benchmark
