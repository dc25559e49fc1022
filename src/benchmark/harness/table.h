#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::benchmark
{

/** Table of results, for output as CSV or Markdown. */
class Table
{
public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /** Appends a row.
   *  @param cells one text per column */
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  std::size_t rows() const { return rows_.size(); }
  std::string csv() const;
  std::string markdown() const;

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/** Text of a number with the given count of significant digits; an empty text for NaN. */
std::string number(double value, int digits = 3);

}  // namespace endovascular_sim::benchmark
