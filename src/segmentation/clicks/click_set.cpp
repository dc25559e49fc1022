#include "segmentation/clicks/click_set.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "common/error.h"
#include "common/input_file.h"
#include "common/text/yaml_text.h"
#include "segmentation/clicks/slicer_markups.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr auto kRemedy = "give a file of clicks: .yaml, or markups of 3D Slicer (.mrk.json, .fcsv)";
constexpr double kFarthest = 10.0;   ///< of a click from the origin [m]
constexpr double kSamePlace = 1e-4;  ///< distance of two clicks that are one [m]

std::string placeOf(const YAML::Node& node)
{
  return "line " + std::to_string(node.Mark().line + 1);
}

/** YAML file of clicks. */
class YamlClicks
{
public:
  explicit YamlClicks(const std::string& file) : file_(file) {}

  ClickSet read()
  {
    ClickSet set;
    set.file = file_;
    std::ifstream in = openInputFile(file_, kRemedy);
    try
    {
      const YAML::Node root = parseYamlText({std::istreambuf_iterator<char>(in), {}}, file_);
      allow(root, {"frame", "unit", "branches"});
      readFrame(root);
      if (!root["branches"] || !root["branches"].IsSequence() || root["branches"].size() == 0)
        throw InputError(file_, "branches", "must list the branches, each with name and clicks");
      for (const YAML::Node& branch : root["branches"])
        set.branches.push_back(branchOf(branch));
    }
    catch (const YAML::Exception& error)
    {
      throw InputError(file_, "line " + std::to_string(error.mark.line + 1), "is not valid YAML: " + error.msg);
    }
    return set;
  }

private:
  void allow(const YAML::Node& node, const std::set<std::string>& keys) const
  {
    if (!node.IsMap())
      throw InputError(file_, placeOf(node), "must hold keys and values");
    for (const auto& entry : node)
      if (keys.count(entry.first.as<std::string>()) == 0)
      {
        std::string known;
        for (const std::string& key : keys)
          known += (known.empty() ? "" : ", ") + key;
        throw InputError(file_, placeOf(entry.first),
                         "unknown key '" + entry.first.as<std::string>() + "'; expected one of " + known);
      }
  }

  void readFrame(const YAML::Node& root)
  {
    if (root["frame"])
    {
      const auto frame = root["frame"].as<std::string>();
      if (frame != "LPS" && frame != "RAS")
        throw InputError(file_, placeOf(root["frame"]), "frame must be LPS or RAS, not '" + frame + "'");
      is_ras_ = frame == "RAS";
    }
    if (root["unit"])
      unit_ = root["unit"].as<double>();
    if (!(unit_ > 0.0 && unit_ <= 1.0))
      throw InputError(file_, "unit", "must be metres per unit: 0.001 for millimetres, 1 for metres");
  }

  BranchClicks branchOf(const YAML::Node& node) const
  {
    allow(node, {"name", "clicks", "largest_radius"});
    BranchClicks branch;
    if (!node["name"])
      throw InputError(file_, placeOf(node), "the branch has no name");
    branch.name = node["name"].as<std::string>();
    if (node["largest_radius"])
      branch.largest_radius = unit_ * node["largest_radius"].as<double>();
    if (!(branch.largest_radius >= 0.0 && branch.largest_radius <= 0.1))
      throw InputError(file_, placeOf(node["largest_radius"]), "largest_radius must be between 0 and 100 mm");
    if (node["clicks"])
      for (const YAML::Node& point : node["clicks"])
        branch.clicks.push_back(clickOf(point));
    return branch;
  }

  Click clickOf(const YAML::Node& node) const
  {
    if (!node.IsSequence() || node.size() != 3)
      throw InputError(file_, placeOf(node), "a click must be [x, y, z]");
    Click click;
    for (int axis = 0; axis < 3; ++axis)
      click.position[axis] = unit_ * node[axis].as<double>();
    if (is_ras_)
      click.position.head<2>() *= -1.0;
    click.where = placeOf(node);
    return click;
  }

  std::string file_;
  bool is_ras_ = false;
  double unit_ = 1e-3;
};

bool endsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool isPlainName(const std::string& name)
{
  return !name.empty() && name.size() <= 100 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; });
}

/** Checks that the clicks of a branch lie at different places. */
void requireDifferent(const BranchClicks& branch, const std::string& file)
{
  for (std::size_t k = 0; k < branch.clicks.size(); ++k)
    for (std::size_t m = 0; m < k; ++m)
      if ((branch.clicks[k].position - branch.clicks[m].position).norm() < kSamePlace)
        throw InputError(file, branch.name,
                         "clicks " + std::to_string(m + 1) + " and " + std::to_string(k + 1) +
                             " are at the same place; delete one, and click once near each end of the branch");
}

void check(const ClickSet& set)
{
  for (const BranchClicks& branch : set.branches)
  {
    if (!isPlainName(branch.name))
      throw InputError(set.file, branch.name, "a branch's name consists of letters, digits, '_', '-' and '.'");
    if (branch.clicks.size() < 2)
      throw InputError(set.file, branch.name,
                       "has " + std::to_string(branch.clicks.size()) +
                           " click(s); click once near each end of the branch, inside the lumen");
    for (const Click& click : branch.clicks)
      if (!click.position.allFinite() || click.position.cwiseAbs().maxCoeff() > kFarthest)
        throw InputError(set.file, branch.name + ", " + click.where,
                         "is no position in a patient; check the numbers and the unit");
    requireDifferent(branch, set.file);
  }
}

}  // namespace

ClickSet readClicks(const std::string& file)
{
  ClickSet set;
  if (endsWith(file, ".json"))
    set = readMarkupsJson(file);
  else if (endsWith(file, ".fcsv"))
    set = readFiducialCsv(file);
  else if (endsWith(file, ".yaml") || endsWith(file, ".yml"))
    set = YamlClicks(file).read();
  else
    throw InputError(file, "", kRemedy);
  check(set);
  return set;
}

ClickSet readClicks(const std::vector<std::string>& files)
{
  if (files.empty())
    throw InputError("clicks", "", kRemedy);
  ClickSet all;
  std::set<std::string> names;
  for (const std::string& file : files)
  {
    const ClickSet set = readClicks(file);
    all.file += (all.file.empty() ? "" : " + ") + file;
    for (const BranchClicks& branch : set.branches)
    {
      if (!names.insert(branch.name).second)
        throw InputError(file, branch.name, "is the name of two branches; rename one of them");
      all.branches.push_back(branch);
    }
  }
  return all;
}

}  // namespace endovascular_sim::segmentation
