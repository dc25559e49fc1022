#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <sstream>

#include "common/error.h"
#include "common/hash.h"
#include "common/quantities.h"
#include "common/text/yaml_text.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::vessel
{
namespace
{

/** YAML map with its location; errors name file, line and key. */
class YamlMap
{
public:
  /** @param warnings receives unusual values */
  YamlMap(const std::string& file, const YAML::Node& node, std::string path, std::vector<std::string>& warnings)
    : file_(file), node_(node), path_(std::move(path)), warnings_(warnings)
  {
    if (!node_.IsMap())
      reject("", "expected keys and values");
  }

  [[noreturn]] void reject(const std::string& key, const std::string& remedy) const
  {
    throw InputError(file_, location(key), remedy);
  }

  /** Warns of an unusual value.
   *  @param value value in the unit of the quantity, i.e. a length in metres
   *  @throws InputError for an impossible value */
  void judge(const std::string& key, const Quantity& quantity, double value) const
  {
    const Plausibility result = plausibility(quantity, value);
    if (result == Plausibility::kUsual)
      return;
    const std::string message = "in metres " + plausibilityMessage(quantity, value) + "; check it and unit";
    if (result == Plausibility::kImpossible)
      reject(key, message);
    warnings_.push_back(file_ + ": " + location(key) + ": " + message);
  }

  /** Positive length in the unit of the file, converted to metres.
   *  @param unit unit of the file [m] */
  double length(const std::string& key, double unit, const Quantity& quantity, const std::string& meaning) const
  {
    const double metres = unit * number(key, kTiny, kHuge, meaning);
    judge(key, quantity, metres);
    return metres;
  }

  /** Rejects keys that are not in the list. */
  void allow(std::initializer_list<const char*> keys) const
  {
    for (const auto& entry : node_)
    {
      const auto key = entry.first.as<std::string>();
      if (std::find(keys.begin(), keys.end(), key) != keys.end())
        continue;
      std::string known;
      for (const char* k : keys)
        known += std::string(known.empty() ? "" : ", ") + k;
      reject(key, "unknown key; expected one of " + known);
    }
  }

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }

  double number(const std::string& key, double lowest, double highest, const std::string& meaning) const
  {
    requirePresent(key, meaning);
    return checked(key, node_[key], lowest, highest, meaning);
  }

  std::string text(const std::string& key, const std::string& meaning) const
  {
    requirePresent(key, meaning);
    if (!node_[key].IsScalar() || node_[key].Scalar().empty())
      reject(key, "expected " + meaning);
    return node_[key].Scalar();
  }

  Eigen::Vector3d vector(const std::string& key, const std::string& meaning) const
  {
    requirePresent(key, meaning);
    return vectorAt(key, node_[key], meaning);
  }

  std::vector<Eigen::Vector3d> vectors(const std::string& key, const std::string& meaning) const
  {
    std::vector<Eigen::Vector3d> out;
    for (const YAML::Node& item : list(key, meaning))
      out.push_back(vectorAt(key, item, meaning));
    return out;
  }

  std::vector<std::pair<double, double>> pairs(const std::string& key, const std::string& meaning) const
  {
    std::vector<std::pair<double, double>> out;
    for (const YAML::Node& item : list(key, meaning))
    {
      if (!item.IsSequence() || item.size() != 2)
        reject(key, "expected " + meaning);
      out.emplace_back(checked(key, item[0], 0.0, 1.0, "a fraction from 0 to 1"),
                       checked(key, item[1], kTiny, kHuge, "a positive diameter"));
    }
    return out;
  }

  std::vector<YamlMap> maps(const std::string& key) const
  {
    std::vector<YamlMap> out;
    const std::string prefix = path_ + (path_.empty() ? "" : ".") + key;
    int k = 0;
    if (has(key))
      for (const YAML::Node& item : list(key, "a list"))
      {
        const bool named = item.IsMap() && item["name"] && item["name"].IsScalar();
        const std::string label = named ? item["name"].Scalar() : std::to_string(k);
        out.emplace_back(file_, item, std::string(prefix).append("[").append(label).append("]"), warnings_);
        ++k;
      }
    return out;
  }

  static constexpr double kTiny = 1e-12;
  static constexpr double kHuge = 1e12;

private:
  /** Key path with its line. */
  std::string location(const std::string& key) const
  {
    std::string where = path_ + (path_.empty() || key.empty() ? "" : ".") + key;
    const YAML::Mark mark = !key.empty() && node_.IsMap() && node_[key] ? node_[key].Mark() : node_.Mark();
    if (mark.line >= 0)
      where += std::string(where.empty() ? "" : " ") + "(line " + std::to_string(mark.line + 1) + ")";
    return where;
  }

  void requirePresent(const std::string& key, const std::string& meaning) const
  {
    if (!has(key))
      reject(key, "missing; give " + meaning);
  }

  YAML::Node list(const std::string& key, const std::string& meaning) const
  {
    requirePresent(key, meaning);
    if (!node_[key].IsSequence())
      reject(key, "expected " + meaning);
    return node_[key];
  }

  double checked(const std::string& key, const YAML::Node& node, double lowest, double highest,
                 const std::string& meaning) const
  {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value >= lowest) || !(value <= highest))
      reject(key, (node.IsScalar() ? "\"" + node.Scalar() + "\" is not " : "expected ") + meaning);
    return value;
  }

  Eigen::Vector3d vectorAt(const std::string& key, const YAML::Node& node, const std::string& meaning) const
  {
    if (!node.IsSequence() || node.size() != 3)
      reject(key, "expected " + meaning);
    Eigen::Vector3d v;
    for (std::size_t i = 0; i < 3; ++i)
      v[static_cast<Eigen::Index>(i)] = checked(key, node[i], -kHuge, kHuge, "a number");
    return v;
  }

  const std::string& file_;
  YAML::Node node_;
  std::string path_;
  std::vector<std::string>& warnings_;
};

void judgePoint(const YamlMap& section, const std::string& key, const Eigen::Vector3d& metres)
{
  section.judge(key, quantities::kPosition, metres.cwiseAbs().maxCoeff());
}

void readDiameters(const YamlMap& section, double unit, AnatomyBranch& branch)
{
  branch.diameters = section.pairs("diameters", "a list of [fraction of the branch's length, diameter]");
  if (branch.diameters.empty())
    section.reject("diameters", "needs at least one [fraction, diameter]");
  for (std::size_t k = 0; k < branch.diameters.size(); ++k)
  {
    branch.diameters[k].second *= unit;
    section.judge("diameters", quantities::kVesselDiameter, branch.diameters[k].second);
    if (k > 0 && !(branch.diameters[k].first > branch.diameters[k - 1].first))
      section.reject("diameters", "the fractions must increase from one entry to the next");
  }
}

void readStenoses(const YamlMap& section, double unit, AnatomyBranch& branch)
{
  for (const YamlMap& entry : section.maps("stenoses"))
  {
    entry.allow({"name", "position", "length", "reduction"});
    Stenosis stenosis;
    stenosis.position =
        entry.number("position", 0.0, 1.0, "the position of the throat as a fraction of the branch's length, 0 to 1");
    stenosis.length = entry.length("length", unit, quantities::kLesionLength, "a positive length");
    stenosis.reduction =
        entry.number("reduction", 0.0, 0.95, "the reduction of the diameter, 0 to 0.95 (an occlusion has no lumen)");
    branch.stenoses.push_back(stenosis);
  }
}

int indexOf(const Anatomy& anatomy, const YamlMap& section, const std::string& key)
{
  const std::string name = section.text(key, "the name of an earlier branch");
  for (std::size_t k = 0; k < anatomy.branches.size(); ++k)
    if (anatomy.branches[k].name == name)
      return static_cast<int>(k);
  section.reject(key, "no earlier branch \"" + name + "\"; a parent must precede its children");
}

int readFacets(const YamlMap& section)
{
  return static_cast<int>(section.number("facets_around", 8.0, 64.0, "a number from 8 to 64"));
}

double readBlend(const YamlMap& section)
{
  return section.number("blend", 0.05, 3.0, "a number from 0.05 to 3");
}

AnatomyBranch readBranch(const YamlMap& section, double unit, const Anatomy& anatomy)
{
  section.allow({"name", "parent", "continues", "points", "diameters", "stenoses", "facets_around"});
  AnatomyBranch branch;
  branch.name = section.text("name", "the branch's name");
  for (const AnatomyBranch& other : anatomy.branches)
    if (other.name == branch.name)
      section.reject("name", "is the name of an earlier branch; names must be unique");
  branch.continues = section.has("continues");
  if (branch.continues && section.has("parent"))
    section.reject("continues", "excludes parent; keep one of the two");
  if (branch.continues || section.has("parent"))
    branch.parent = indexOf(anatomy, section, branch.continues ? "continues" : "parent");
  else if (!anatomy.branches.empty())
    section.reject("parent", "missing; only the first branch has no parent");
  for (const AnatomyBranch& other : anatomy.branches)
    if (branch.continues && other.continues && other.parent == branch.parent)
      section.reject("continues", "\"" + other.name + "\" already continues that branch; use parent");

  branch.points = section.vectors("points", "a list of [x, y, z]");
  for (Eigen::Vector3d& point : branch.points)
  {
    point *= unit;
    judgePoint(section, "points", point);
  }
  if (branch.points.size() < (branch.continues ? 1U : 2U))
    section.reject("points", "too few; a branch needs two points (one when it continues another)");
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    if ((branch.points[k] - branch.points[k - 1]).norm() < 1e-5)
      section.reject("points", "points " + std::to_string(k) + " and " + std::to_string(k + 1) + " coincide");
  readDiameters(section, unit, branch);
  readStenoses(section, unit, branch);
  if (section.has("facets_around"))
  {
    if (branch.continues)
      section.reject("facets_around", "belongs to the branch that this one continues; remove it here");
    branch.facets_around = readFacets(section);
  }
  return branch;
}

std::string readText(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError(file, "", "no such file, or not readable; give an anatomy as in config/anatomies/natural.yaml");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

Anatomy readAnatomy(const std::string& file)
{
  const std::string text = readText(file);
  const YAML::Node root = parseYamlText(text, file);
  if (!root.IsMap())
    throw InputError(file, "", "is not an anatomy; see config/anatomies/natural.yaml");
  Anatomy anatomy;
  const YamlMap top(file, root, "", anatomy.warnings);
  top.allow({"name", "unit", "blend", "facets_around", "longest_facet", "branches", "bulges"});

  anatomy.file = file;
  Hash64 hash;
  hash.add(text);
  anatomy.content_hash = hash.value();
  anatomy.name = top.text("name", "the anatomy's name");
  const double unit = top.number("unit", 1e-6, 1.0, "metres per unit of every length here, e.g. 0.001");
  if (top.has("blend"))
    anatomy.blend = readBlend(top);
  if (top.has("facets_around"))
    anatomy.facets_around = readFacets(top);
  if (top.has("longest_facet"))
    anatomy.longest_facet = top.length("longest_facet", unit, quantities::kFacetLength, "a positive length");
  for (const YamlMap& section : top.maps("branches"))
    anatomy.branches.push_back(readBranch(section, unit, anatomy));
  if (anatomy.branches.empty())
    top.reject("branches", "missing; give at least one branch");
  for (const YamlMap& section : top.maps("bulges"))
  {
    section.allow({"name", "centre", "radius", "blend"});
    anatomy.bulges.push_back({section.text("name", "the bulge's name"), unit * section.vector("centre", "[x, y, z]"),
                              section.length("radius", unit, quantities::kVesselRadius, "a positive radius"),
                              section.has("blend") ? readBlend(section) : anatomy.blend});
    judgePoint(section, "centre", anatomy.bulges.back().centre);
  }
  return anatomy;
}

}  // namespace endovascular_sim::vessel
