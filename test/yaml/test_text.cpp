#include "test/common/input_error_of.h"
#include "yaml/text.h"

#include <gtest/gtest.h>

namespace endovascular_sim::yaml
{
namespace
{

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { parseYamlText(text, "f.yaml"); });
}

TEST(YamlText, RefusesAliasesThatExpandWithoutLimit)
{
  std::string bomb = "a: &a [x, x]\n";
  for (char level = 'b'; level < 'k'; ++level)
  {
    const std::string below = std::string("*") + static_cast<char>(level - 1);
    bomb += std::string(1, level) + ": &" + level + " [" + below;
    for (int k = 1; k < 10; ++k)
      bomb += "," + below;
    bomb += "]\n";
  }
  const std::string text = refusalOf(bomb);
  EXPECT_EQ(text,
            "f.yaml: g (line 7): has more than 500000 values, those of aliases (*name) counted at each use; give "
            "fewer");
}

TEST(YamlText, ReadsAliasesOfMapsAndValues)
{
  const YAML::Node node = parseYamlText("a: &a {x: 1}\nb: *a\nc: &c 2\nd: [*c, *c]\n", "f.yaml");
  EXPECT_EQ(node["b"]["x"].as<int>(), 1);
  EXPECT_EQ(node["d"][1].as<int>(), 2);
}

TEST(YamlText, RefusesDeepTextsWrittenOutOrByAliases)
{
  EXPECT_NE(refusalOf("a: " + std::string(40, '[') + std::string(40, ']')).find("a (line 1): is nested deeper than 32"),
            std::string::npos);
  std::string chain = "a0: &a0 [x]\n";
  for (int k = 1; k < 40; ++k)
    chain += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [*a" + std::to_string(k - 1) + "]\n";
  EXPECT_NE(refusalOf(chain).find("is nested deeper than 32 levels"), std::string::npos) << refusalOf(chain);
  EXPECT_NE(refusalOf("a: &a {b: *a}\n").find("an anchor must not contain itself"), std::string::npos);
  EXPECT_NE(refusalOf(std::string(100000, '[')), "");
}

TEST(YamlText, RefusesASecondDocumentUnlessItIsEmpty)
{
  EXPECT_EQ(refusalOf("---\na: 1\n"), "");
  EXPECT_EQ(refusalOf("a: 1\n...\n"), "");
  EXPECT_EQ(refusalOf("a: 1\n---\n"), "");
  const std::string text = refusalOf("a: 1\n---\na: 2\n");
  EXPECT_NE(text.find("line 2: begins a second document (---), which would be ignored"), std::string::npos) << text;
  EXPECT_NE(refusalOf("a: 1\n--- text\n").find("second document"), std::string::npos);
}

TEST(YamlText, RefusesACommaAtTheBeginning)
{
  for (const char* text : {", a", "# comment\n, a\nname: b\n"})
    EXPECT_NE(refusalOf(text).find("comma"), std::string::npos) << text;
}

TEST(YamlText, RefusesMergeKeysByName)
{
  EXPECT_EQ(refusalOf("a: &a {x: 1}\nb:\n  <<: *a\n"),
            "f.yaml: b (line 3): merge keys (<<) are not supported; write the keys out");
  EXPECT_EQ(refusalOf("'<<': 1\n"), "") << "in quotes it is a word";
}

TEST(YamlText, NamesATabInTheIndentation)
{
  EXPECT_NE(refusalOf("a:\n\tb: 1\nc: 2\n").find("line 2: is indented by a tab"), std::string::npos)
      << refusalOf("a:\n\tb: 1\nc: 2\n");
  EXPECT_EQ(refusalOf("a: 1\t# a tab after a value\n"), "");
  EXPECT_NE(refusalOf("a: [1, 2\nb: 3\n").find("is not valid YAML"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::yaml
