#include "benchmark/study_list.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "benchmark/tables_page.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr std::size_t kSchemeColumn = 1;  ///< of the stability tables; the verdict follows

std::string textOf(const std::string& file)
{
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/** Header lines of the declared tables by the name of the CSV file. */
std::map<std::string, std::string> declaredHeaders()
{
  std::map<std::string, std::string> headers;
  for (const Study& study : studies())
    for (const TableSpec& spec : study.tables)
      EXPECT_TRUE(headers.emplace(spec.name + ".csv", Table(spec.columns).csv()).second) << spec.name;
  return headers;
}

TEST(StudyList, EveryTableNamedInTheDocumentationExistsWithTheDeclaredHeader)
{
  const std::string docs = std::string(PROJECT_DIR) + "/docs/";
  const std::map<std::string, std::string> headers = declaredHeaders();
  std::set<std::string> named;
  for (const std::string page : {"VALIDATION.md", "validation/tables.md"})
  {
    const std::string text = textOf(docs + page);
    const std::regex csv("([a-z_]+\\.csv)");
    for (auto match = std::sregex_iterator(text.begin(), text.end(), csv); match != std::sregex_iterator(); ++match)
      named.insert((*match)[1]);
  }
  for (const std::string& name : named)
  {
    ASSERT_EQ(headers.count(name), 1U) << name;
    const std::string text = textOf(docs + "validation/" + name);
    EXPECT_EQ(text.substr(0, text.find('\n') + 1), headers.at(name)) << name;
  }
  EXPECT_GE(named.size(), 20U);
}

/** Rows of a CSV file of docs/validation as fields, without the header. Commas within quotes do not separate. */
std::vector<std::vector<std::string>> rowsOf(const std::string& name)
{
  std::istringstream stream(textOf(std::string(PROJECT_DIR) + "/docs/validation/" + name + ".csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(stream, line);)
  {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char letter : line)
      if (letter == '"')
        quoted = !quoted;
      else if (letter == ',' && !quoted)
        fields.emplace_back();
      else
        fields.back() += letter;
    rows.push_back(std::move(fields));
  }
  rows.erase(rows.begin());
  return rows;
}

/** Section of tables.md about a table. */
std::string sectionOf(const std::string& name)
{
  const std::string page = textOf(std::string(PROJECT_DIR) + "/docs/validation/tables.md");
  const std::size_t begin = page.find("Table: [" + name + ".csv]");
  EXPECT_NE(begin, std::string::npos) << name;
  return page.substr(begin, page.find("\n#", begin) - begin);
}

TEST(StudyList, ThePageOfTheTablesStatesTheNumbersOfRowsOfTheirFiles)
{
  for (const Study& study : studies())
    for (const TableSpec& spec : study.tables)
      if (textOf(std::string(PROJECT_DIR) + "/docs/validation/tables.md").find(spec.name + ".csv") != std::string::npos)
      {
        EXPECT_NE(sectionOf(spec.name).find(", " + std::to_string(rowsOf(spec.name).size()) + " rows"),
                  std::string::npos)
            << spec.name;
      }
}

TEST(StudyList, ThePageOfTheTablesCountsWhatTheirFilesHold)
{
  const auto measures = rowsOf("sampling_measures");
  const auto held =
      std::count_if(measures.begin(), measures.end(), [](const auto& row) { return row.back() == "yes"; });
  EXPECT_NE(sectionOf("sampling_measures")
                .find(std::to_string(held) + " of " + std::to_string(measures.size()) + " measures"),
            std::string::npos)
      << held;
  for (const std::string table : {"stability_factors", "stability_samples"})
  {
    std::map<std::string, std::map<std::string, int>> verdicts;
    for (const std::vector<std::string>& row : rowsOf(table))
      ++verdicts[row.at(kSchemeColumn)][row.at(kSchemeColumn + 1)];
    for (auto& [name, counts] : verdicts)
    {
      const std::string text = "`" + name + "`: " + std::to_string(counts["good"]) + " good, " +
                               std::to_string(counts["rejected"]) + " rejected, " + std::to_string(counts["bad"]) +
                               " bad";
      EXPECT_NE(sectionOf(table).find(text), std::string::npos) << table << ": " << text;
    }
  }
}

TEST(TablesPage, ReplacesTheChapterOfAStudyAndKeepsTheOthers)
{
  const std::vector<Study>& all = studies();
  ASSERT_GE(all.size(), 2U);
  TablesPage first("");
  first.set(all[1], "benchmark second", {});
  first.set(all[0], "benchmark first", {});
  TablesPage second(first.text(all));
  second.set(all[0], "benchmark again", {});
  const std::string text = second.text(all);
  EXPECT_EQ(text.find("benchmark first"), std::string::npos);
  EXPECT_LT(text.find("benchmark again"), text.find("benchmark second"));
  EXPECT_NE(text.find("benchmark second"), std::string::npos);
}

TEST(StudyList, EveryDeclaredPlotExists)
{
  for (const Study& study : studies())
    for (const TableSpec& spec : study.tables)
    {
      const std::string plot = std::string(PROJECT_DIR) + "/docs/validation/" + spec.plot;
      EXPECT_TRUE(spec.plot.empty() || std::ifstream(plot)) << plot;
    }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
