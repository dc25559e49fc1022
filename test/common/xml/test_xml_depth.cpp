#include "common/xml/xml_depth.h"

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim
{
namespace
{

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { requireShallowXml(text, "f.xml"); });
}

std::string repeated(const std::string& text, int times)
{
  std::string all;
  for (int k = 0; k < times; ++k)
    all += text;
  return all;
}

TEST(XmlDepth, RefusesDeepElementsWithTheirLine)
{
  EXPECT_EQ(refusalOf(repeated("<a>", 64) + repeated("</a>", 64)), "");
  EXPECT_NE(refusalOf(repeated("<a>\n", 65)).find("f.xml: line 65: elements are nested deeper"), std::string::npos);
}

TEST(XmlDepth, CountsNeitherSiblingsNorCommentsNorValues)
{
  EXPECT_EQ(refusalOf(repeated("<a b='1'/>", 1000)), "");
  EXPECT_EQ(refusalOf(repeated("<a></a>", 1000)), "");
  EXPECT_EQ(refusalOf("<!-- " + repeated("<a>", 100) + " --><a/>"), "");
  EXPECT_EQ(refusalOf("<a><![CDATA[" + repeated("<a>", 100) + "]]></a>"), "");
  EXPECT_EQ(refusalOf("<?xml version=\"1.0\"?><!DOCTYPE a><a b = \"" + repeated("<c>", 100) + "\"></a>"), "");
}

TEST(XmlDepth, IsNotDeceivedByMarksInTextsAndValues)
{
  EXPECT_NE(refusalOf(repeated("<a>/>", 100)), "");
  EXPECT_NE(refusalOf(repeated("<a b='/>'>", 100)), "");
  EXPECT_NE(refusalOf(repeated("<a b=\"</a>\">", 100)), "");
  EXPECT_NE(refusalOf(repeated("<a b=x\">", 100)), "");
  EXPECT_NE(refusalOf(repeated("<a b>", 100)), "");
}

TEST(XmlDepth, EndsOnTruncatedTexts)
{
  for (const char* text : {"<", "<a", "<a b", "<a b=", "<a b='", "<!--", "</", "<?", "<![CDATA["})
    refusalOf(text);
}

}  // namespace
}  // namespace endovascular_sim
