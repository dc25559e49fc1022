#include "benchmark/studies/study_list.h"

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

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
