#include "test/common/input_error_of.h"
#include "vessel/io/stl_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "test/vessel/io/mesh_files.h"

namespace endovascular_sim::vessel
{
namespace
{

const std::string kByteOrderMark = "\xEF\xBB\xBF";

/** Mesh and remarks of an STL file with this content. */
std::pair<geometry::TriangleMesh, MeshRemarks> read(const std::string& bytes)
{
  MeshBuilder builder("v.stl", 1e-3, bytes.size());
  readStl(bytes, "v.stl", builder);
  geometry::TriangleMesh mesh = builder.build();
  return {mesh, builder.remarks()};
}

std::string refusalOf(const std::string& bytes)
{
  return inputErrorOf([&] { read(bytes); });
}

TEST(StlReader, ReadsABinaryFileWithSurplusBytesAndWarns)
{
  const std::string bytes = binaryStlFile(capsule(16, 10));
  const std::uint64_t hash = read(bytes).first.hash();
  EXPECT_TRUE(read(bytes).second.warnings.empty());
  for (const std::string& surplus : {std::string("\n"), std::string(2, '\0'), std::string(500, '\0')})
  {
    const auto [mesh, remarks] = read(bytes + surplus);
    EXPECT_EQ(mesh.hash(), hash);
    ASSERT_EQ(remarks.warnings.size(), 1U);
    EXPECT_EQ(remarks.warnings[0], "v.stl: has " + std::to_string(surplus.size()) +
                                       (surplus.size() == 1 ? " byte" : " bytes") +
                                       " after its 352 triangles; they are ignored");
  }
}

TEST(StlReader, RefusesTruncatedFilesAndCountsThatWereNotFilledIn)
{
  std::string bytes = binaryStlFile(capsule(16, 10));
  EXPECT_NE(refusalOf(bytes.substr(0, bytes.size() - 25)).find("is truncated"), std::string::npos);
  EXPECT_NE(refusalOf(bytes + std::string(100000, 'x')).find("damaged"), std::string::npos);
  std::fill_n(bytes.begin() + 80, 4, '\0');
  const std::string text = refusalOf(bytes);
  EXPECT_NE(text.find("the header says 0 facets"), std::string::npos) << text;
  bytes.replace(0, 5, "solid");
  EXPECT_NE(refusalOf(bytes).find("the header says 0 facets"), std::string::npos);
}

TEST(StlReader, ReadsAsciiInUpperCaseAfterBlanksAndAByteOrderMark)
{
  const std::string text = asciiStlFile(capsule(16, 10));
  const std::uint64_t hash = read(text).first.hash();
  std::string upper = text;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  EXPECT_EQ(read(upper).first.hash(), hash);
  EXPECT_EQ(read("  " + text).first.hash(), hash);
  EXPECT_EQ(read("\r\n" + text).first.hash(), hash);
  EXPECT_EQ(read(kByteOrderMark + text).first.hash(), hash);
}

}  // namespace
}  // namespace endovascular_sim::vessel
