#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark/study_list.h"

namespace endovascular_sim::benchmark
{

/** The page tables.md, which describes the tables of all studies. A run of some studies replaces their chapters, so
 * that the page and the CSV files beside it are always of the same runs. */
class TablesPage
{
public:
  /** @param existing text of the present page; empty without one */
  explicit TablesPage(const std::string& existing);

  /** Replaces the chapter of a study.
   *  @param command with which the study has been run */
  void set(const Study& study, const std::string& command, const std::vector<Section>& sections);

  /** Text with the chapters in the order of @p studies; chapters of other studies are dropped. */
  std::string text(const std::vector<Study>& studies) const;

private:
  std::map<std::string, std::string> chapters_;  ///< by the heading of the study
};

}  // namespace endovascular_sim::benchmark
