#include "segmentation/labels/label_names.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Table of labels in a file. */
class LabelNamesFile : public ::testing::Test
{
protected:
  LabelNamesFile() : folder_(std::filesystem::temp_directory_path() / ("label_names_" + std::to_string(getpid())))
  {
    std::filesystem::create_directories(folder_);
  }
  ~LabelNamesFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const
  {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  LabelNames read(const std::string& name, const std::string& text) const { return readLabelNames(write(name, text)); }

  std::filesystem::path folder_;
};

const LabelNames kNames = {{52, "aorta"}, {65, "iliac_artery_left"}};

TEST_F(LabelNamesFile, IsReadInYamlAndJsonInEitherDirection)
{
  EXPECT_EQ(read("a.yaml", "52: aorta\n65: iliac_artery_left\n"), kNames);
  EXPECT_EQ(read("b.yml", "labels:\n  aorta: 52\n  iliac_artery_left: 65\n"), kNames);
  EXPECT_EQ(read("c.json", "{\"total\": {\n\t\"52\": \"aorta\",\n\t\"65\": \"iliac_artery_left\"}}"), kNames);
  EXPECT_EQ(read("d.json", "{\"labels\": {\"aorta\": 52, \"iliac_artery_left\": 65}, \"file_ending\": \".nii.gz\"}"),
            kNames);
  EXPECT_EQ(read("e.json", "[{\"id\": 52, \"name\": \"aorta\"}, {\"id\": 65, \"name\": \"iliac artery left\"}]"),
            kNames);
  EXPECT_EQ(read("f.yaml", "- {label: 52, name: aorta}\n- {label: 65, name: iliac_artery_left}\n"), kNames);
}

TEST_F(LabelNamesFile, IsReadInTablesWithAndWithoutTitles)
{
  EXPECT_EQ(read("a.csv", "52,aorta\n65,iliac_artery_left\n"), kNames);
  EXPECT_EQ(read("b.csv", "aorta;52\n\"iliac artery left\";65\n"), kNames);
  EXPECT_EQ(read("c.csv", "\xEF\xBB\xBFLabelValue,Name,Color_R\r\n52,aorta,128\r\n65,\"iliac artery left\",200\r\n"),
            kNames);
  EXPECT_EQ(read("g.csv", "Index;TotalSegmentator name\n52;aorta\n65;iliac_artery_left\n"), kNames);
  EXPECT_EQ(read("d.tsv", "name\tid\naorta\t52\niliac_artery_left\t65\n"), kNames);
  EXPECT_EQ(read("e.ctbl", "# Color table\n52 aorta 128 174 128 255\n65 iliac_artery_left 241 214 145 255\n"), kNames);
  EXPECT_EQ(read("f.txt", "# ITK-SNAP\n  52   255 0 0   1 1 1   \"aorta\"\n  65 0 255 0 1 1 1 \"iliac artery left\"\n"),
            kNames);
}

TEST_F(LabelNamesFile, IsRefusedWithTheRemedy)
{
  const auto error = [this](const std::string& name, const std::string& text)
  { return inputErrorOf([&] { read(name, text); }); };
  EXPECT_NE(error("a.pdf", "52 aorta").find("give a table of labels"), std::string::npos);
  EXPECT_NE(error("a.csv", "name\naorta\n").find("holds no label"), std::string::npos);
  EXPECT_NE(error("a.json", "{\"52\": ").find("is no JSON"), std::string::npos);
  EXPECT_NE(error("a.yaml", "total: {52: aorta}\ntotal_v1: {52: liver}\n").find("keep the table of one task"),
            std::string::npos);
  EXPECT_NE(inputErrorOf([] { readLabelNames("/no/such.csv"); }).find("give a table of labels"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
