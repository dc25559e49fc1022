#include "test/common/input_error_of.h"
#include "yaml/reader.h"

#include <gtest/gtest.h>

#include "common/quantities.h"

namespace endovascular_sim::yaml
{
namespace
{

/** Message of the error of reading a list of named vessels of one length each; empty for a valid text. */
std::string messageOf(const std::string& text, ItemLabel label, ReadingReport& report)
{
  return inputErrorOf(
      [&]
      {
        const Node root = parseTree(text, "f.yaml");
        Reader reader(root, &report, label);
        reader.list(
            "vessels", 0, [](std::size_t) {},
            [](Fields& vessel, std::size_t)
            {
              std::string name;
              double length = 0.0;
              vessel.text("name", name);
              vessel.number("length", length, quantities::kNumber, Range::positive());
              vessel.judge("length", quantities::kVesselLength, 1e-3 * length);
            },
            Need::kRequired);
        reader.finish();
      });
}

TEST(YamlReader, LabelsItemsOfListsByIndexOrByName)
{
  const std::string text = "vessels:\n  - name: a\n    length: 10\n  - name: b\n    lenght: 10\n";
  ReadingReport report;
  const std::string remedy = " (line 5): unknown key; did you mean \"length\"?";
  EXPECT_EQ(messageOf(text, ItemLabel::kIndex, report), "f.yaml: vessels.1.lenght" + remedy);
  EXPECT_EQ(messageOf(text, ItemLabel::kName, report), "f.yaml: vessels[b].lenght" + remedy);
}

TEST(YamlReader, JudgesAValueInTheUnitOfTheQuantity)
{
  ReadingReport report;
  EXPECT_EQ(messageOf("vessels:\n  - {name: a, length: 5000}\n", ItemLabel::kName, report), "");
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_EQ(report.warnings[0].rfind("f.yaml: vessels[a].length (line 2): in m is 5: ", 0), 0U) << report.warnings[0];
  EXPECT_NE(messageOf("vessels:\n  - {name: a, length: 5e6}\n", ItemLabel::kName, report).find("in m is 5000: "),
            std::string::npos);
}

TEST(YamlReader, NamesTheLineOfAnItemOfAList)
{
  const Node root = parseTree("a:\n  - 1\n  - 2\nb: 3\n", "f.yaml");
  const Reader reader(root, nullptr);
  EXPECT_EQ(reader.place("a.1"), "line 3");
  EXPECT_EQ(reader.place("b"), "line 4");
  EXPECT_EQ(reader.place("a.7"), "line 1");
}

}  // namespace
}  // namespace endovascular_sim::yaml
