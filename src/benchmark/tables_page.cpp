#include "benchmark/tables_page.h"

#include <sstream>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr auto kHead =
    "# Tables of the validation\n\nWritten by `rosrun endovascular_sim benchmark STUDY --out DIR`. "
    "Times are "
    "medians on one core of the machine of the run; ratios are comparable.\n\n";
const std::string kChapter = "## ";

/** Part of the page that describes one table. */
std::string markdown(const Section& section)
{
  const TableSpec& spec = section.spec;
  std::string text = "### " + spec.heading + "\n\nTable: [" + spec.name + ".csv](" + spec.name + ".csv), " +
                     std::to_string(section.table.rows()) + " rows\n\n" + section.text + "\n\n";
  if (!spec.plot.empty() && section.table.rows() > 0)
    text += "![" + spec.heading + "](" + spec.plot + ")\n\n";
  return text;
}

}  // namespace

TablesPage::TablesPage(const std::string& existing)
{
  std::istringstream stream(existing);
  std::string* chapter = nullptr;
  for (std::string line; std::getline(stream, line);)
  {
    if (line.rfind(kChapter, 0) == 0)
      chapter = &chapters_[line.substr(kChapter.size())];
    if (chapter != nullptr)
      *chapter += line + "\n";
  }
}

void TablesPage::set(const Study& study, const std::string& command, const std::vector<Section>& sections)
{
  std::string text = kChapter + study.heading + "\n\n`" + command + "`\n\n";
  for (const Section& section : sections)
    text += markdown(section);
  chapters_[study.heading] = text;
}

std::string TablesPage::text(const std::vector<Study>& studies) const
{
  std::string text = kHead;
  for (const Study& study : studies)
    if (const auto chapter = chapters_.find(study.heading); chapter != chapters_.end())
      text += chapter->second;
  return text;
}

}  // namespace endovascular_sim::benchmark
