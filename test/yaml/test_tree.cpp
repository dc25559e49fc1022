#include "test/common/input_error_of.h"
#include "yaml/tree.h"

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::yaml
{
namespace
{

/** Value of an override of `vessel.mesh`. */
Node overridden(const std::string& value)
{
  Node root = parseTree("vessel: {mesh: a.obj}\n", "scene.yaml");
  overrideTree(root, "vessel.mesh=" + value, "scene.yaml");
  const Node* vessel = root.find("vessel");
  const Node* mesh = vessel->find("mesh");
  return mesh == nullptr ? Node() : *mesh;
}

TEST(YamlTree, APlainOverrideNeedsNoQuotes)
{
  for (const std::string path :
       {"my vessels #2/left.obj", "a/vessel: left.obj", "my vessels #2/vessel: left.obj", "a b.obj", "血管/模型.obj"})
    EXPECT_EQ(overridden(path).text, path);
  EXPECT_EQ(overridden("\"my #2/a.obj\"").text, "my #2/a.obj");
  EXPECT_EQ(overridden("'a: b.obj'").text, "a: b.obj");
}

TEST(YamlTree, OtherOverridesAreYaml)
{
  EXPECT_EQ(overridden("null").kind, Node::Kind::kNull);
  EXPECT_EQ(overridden("~").kind, Node::Kind::kNull);
  EXPECT_EQ(overridden("[1, 2]").items.size(), 2U);
  EXPECT_EQ(overridden("{a: 1}").fields.size(), 1U);
  EXPECT_EQ(overridden("-1.5").text, "-1.5");
  EXPECT_THROW(overridden("[1, 2"), InputError);
}

TEST(YamlTree, RefusesAKeyThatIsGivenTwiceAmongMany)
{
  std::string text;
  for (int k = 0; k < 20000; ++k)
    text += "k" + std::to_string(k) + ": 1\n";
  EXPECT_NO_THROW(parseTree(text, "scene.yaml"));
  const std::string message = inputErrorOf([&] { parseTree(text + "k7: 2\n", "scene.yaml"); });
  EXPECT_NE(message.find("k7 (line 20001): duplicate key, given first in line 8"), std::string::npos) << message;
}

}  // namespace
}  // namespace endovascular_sim::yaml
