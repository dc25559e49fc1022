#include "segmentation/clicks/click_set.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/error.h"
#include "common/quantities.h"
#include "common/text/plain_name.h"
#include "segmentation/clicks/slicer_markups.h"
#include "yaml/reader.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr auto kRemedy = "give a file of clicks: .yaml, or markups of 3D Slicer (.mrk.json, .fcsv)";
constexpr double kFarthest = 10.0;      ///< of a click from the origin [m]
constexpr double kSamePlace = 1e-4;     ///< distance of two clicks that are one [m]
constexpr double kLargestRadius = 0.1;  ///< of a lumen [m]

/** Frame and unit of a file of clicks. */
struct Frame
{
  bool is_ras = false;
  double unit = 1e-3;  ///< [m]
};

BranchClicks readBranch(yaml::Fields& fields, const Frame& frame)
{
  BranchClicks branch;
  fields.text("name", branch.name, yaml::Need::kRequired);
  fields.number("largest_radius", branch.largest_radius, quantities::kNumber,
                yaml::Range::between(0.0, kLargestRadius / frame.unit));
  branch.largest_radius *= frame.unit;
  branch.are_ends = fields.has("ends");
  if (branch.are_ends && fields.has("clicks"))
    fields.reject("ends", "excludes clicks; give those of one branch as clicks, or the ends of a tree as ends");
  const std::string key = branch.are_ends ? "ends" : "clicks";
  std::vector<std::vector<double>> points;
  fields.rows(key, points, {3, quantities::kNumber});
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    Click click;
    click.position = frame.unit * Eigen::Map<const Eigen::Vector3d>(points[k].data());
    if (frame.is_ras)
      click.position.head<2>() *= -1.0;
    click.where = fields.place(key + "." + std::to_string(k));
    branch.clicks.push_back(click);
  }
  return branch;
}

ClickSet readYaml(const std::string& file)
{
  const yaml::Node root = yaml::readTree(file, kRemedy);
  yaml::Reader fields(root, nullptr, yaml::ItemLabel::kName);
  ClickSet set;
  set.file = file;
  Frame frame;
  fields.option("frame", frame.is_ras, {"LPS", "RAS"});
  fields.number("unit", frame.unit, quantities::kMeshUnit, yaml::Range::positiveUpTo(1.0), yaml::Need::kOptional);
  fields.list(
      "branches", 0, [](std::size_t) {},
      [&](yaml::Fields& branch, std::size_t) { set.branches.push_back(readBranch(branch, frame)); },
      yaml::Need::kRequired);
  fields.finish();
  return set;
}

bool endsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
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
    if (branch.name != plainNameOf(branch.name))
      throw InputError(set.file, branch.name,
                       "a branch's name consists of at most " + std::to_string(kLongestPlainName) +
                           " bytes of letters of any script, digits, '_', '-' and '.', in UTF-8; e.g. " +
                           plainNameOf(branch.name));
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
  requireDifferentNames(set);
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
    set = readYaml(file);
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
  for (const std::string& file : files)
  {
    const ClickSet set = readClicks(file);
    all.file += (all.file.empty() ? "" : " + ") + file;
    all.branches.insert(all.branches.end(), set.branches.begin(), set.branches.end());
  }
  requireDifferentNames(all);
  return all;
}

void requireDifferentNames(const ClickSet& clicks)
{
  std::set<std::string> names;
  for (const BranchClicks& branch : clicks.branches)
    if (!names.insert(branch.name).second)
      throw InputError(clicks.file, branch.name, "is the name of two branches; rename one of them");
}

}  // namespace endovascular_sim::segmentation
