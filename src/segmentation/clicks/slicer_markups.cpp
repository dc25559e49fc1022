#include "segmentation/clicks/slicer_markups.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "common/error.h"
#include "common/input_file.h"
#include "common/text/csv_fields.h"
#include "common/text/plain_name.h"
#include "common/units.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr auto kRemedy = "save the markups in 3D Slicer as .mrk.json or .fcsv";
using units::kMillimetre;

constexpr std::size_t kSelectedColumn = 9;  ///< of a fiducial list
constexpr std::size_t kLabelColumn = 11;    ///< likewise

/** Labels that 3D Slicer gives by itself. */
const std::set<std::string> kDefaultLabels = {
    "", "F", "C", "OC", "L", "CC", "N", "P", "Markups", "Node", "Line", "Curve", "A", "R", "MarkupsFiducial"};

/** Types of markups without a course along a vessel, which are refused. */
const std::set<std::string> kNoCourse = {"ClosedCurve", "Angle", "Plane", "ROI"};

/** Sign of x and y that turns a coordinate system into LPS. Slicer writes names or, in early versions, numbers. */
double signOf(const std::string& system, const std::string& file)
{
  if (system == "LPS" || system == "1")
    return 1.0;
  if (system == "RAS" || system == "0")
    return -1.0;
  throw InputError(file, "coordinate system", "is '" + system + "'; must be LPS or RAS");
}

/** Metres per unit of a name of 3D Slicer. */
double unitOf(const std::string& name, const std::string& file, const std::string& place)
{
  const std::map<std::string, double> units = {{"mm", kMillimetre}, {"cm", 1e-2}, {"m", 1.0}, {"um", 1e-6}};
  const auto found = units.find(name);
  if (found == units.end())
    throw InputError(file, place, "its coordinateUnits are '" + name + "'; must be mm, cm, m or um");
  return found->second;
}

/** Label without a number at its end. */
std::string stemOf(std::string label)
{
  while (!label.empty() && std::isdigit(static_cast<unsigned char>(label.back())) != 0)
    label.pop_back();
  while (!label.empty() && (label.back() == '-' || label.back() == '_' || label.back() == ' '))
    label.pop_back();
  return label;
}

/** True for the name of a list that SlicerVMTK makes of the ends of a vessel. */
bool isListOfEnds(std::string name)
{
  const std::string begin = "endpoint";
  name = name.substr(0, begin.size());
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name == begin;
}

/** Control point of a list. */
struct ControlPoint
{
  std::string label;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< LPS [m]
  std::string where;                                   ///< place in the file
  bool is_selected = true;                             ///< false: beginning of a tree, in a list of its ends
};

/** Collects labelled points into branches, in the order of their first points. */
class Grouping
{
public:
  explicit Grouping(std::string file) : file_(std::move(file)) {}

  /** @param list number of the list of points; points of different lists never share a branch */
  void add(const ControlPoint& point, int list)
  {
    const std::pair<int, std::string> key(list, stemOf(point.label));
    auto found = std::find(keys_.begin(), keys_.end(), key);
    if (found == keys_.end())
    {
      keys_.push_back(key);
      branches_.emplace_back();
      begins_.emplace_back();
      found = keys_.end() - 1;
    }
    const auto branch = static_cast<std::size_t>(found - keys_.begin());
    if (!point.is_selected && !begins_[branch])
      begins_[branch] = branches_[branch].clicks.size();
    branches_[branch].clicks.push_back({point.position, point.where});
    if (point.label.empty() && unlabelled_.count(list) == 0)
      unlabelled_[list] = point.where;
    else if (!point.label.empty())
      labels_[list] = point.label;
  }

  ClickSet take()
  {
    if (branches_.empty())
      throw InputError(file_, "", std::string("holds no points; ") + kRemedy);
    for (const auto& [list, where] : unlabelled_)
      if (labels_.count(list) > 0)
        throw InputError(file_, where,
                         "has no label, others of its list have one; label it as those of its branch, e.g. " +
                             stemOf(labels_.at(list)) + "-3, or delete it");
    std::string name = std::filesystem::path(file_).filename().string();
    name = name.substr(0, name.find('.'));
    for (std::size_t k = 0; k < branches_.size(); ++k)
    {
      const bool is_default = kDefaultLabels.count(keys_[k].second) > 0;
      std::string own = is_default ? name : keys_[k].second;
      if (is_default && branches_.size() > 1)
        own += "_" + std::to_string(k + 1);
      branches_[k].name = plainNameOf(own);
      branches_[k].are_ends = isListOfEnds(own);
      if (std::vector<Click>& clicks = branches_[k].clicks; branches_[k].are_ends && begins_[k])
        std::rotate(clicks.begin(), clicks.begin() + static_cast<std::ptrdiff_t>(*begins_[k]),
                    clicks.begin() + static_cast<std::ptrdiff_t>(*begins_[k]) + 1);
    }
    ClickSet set;
    set.file = file_;
    set.branches = std::move(branches_);
    return set;
  }

private:
  std::string file_;
  std::vector<std::pair<int, std::string>> keys_;
  std::vector<BranchClicks> branches_;
  std::vector<std::optional<std::size_t>> begins_;  ///< first point of each branch that is not selected
  std::map<int, std::string> unlabelled_;           ///< first point without a label of each list
  std::map<int, std::string> labels_;               ///< a label of each list
};

}  // namespace

ClickSet readMarkupsJson(const std::string& file)
{
  std::ifstream in = openInputFile(file, kRemedy);
  Grouping grouping(file);
  try
  {
    const nlohmann::json root = nlohmann::json::parse(in);
    int list = 0;
    for (const nlohmann::json& markup : root.at("markups"))
    {
      const std::string place = "markup " + std::to_string(++list);
      const std::string type = markup.value("type", "");
      if (kNoCourse.count(type) > 0)
        throw InputError(file, place,
                         "is a " + type + ", which has no two ends; give a point list, a line or an open curve");
      const nlohmann::json& system = markup.at("coordinateSystem");
      const double sign = signOf(system.is_string() ? system.get<std::string>() : system.dump(), file);
      const double unit = unitOf(markup.value("coordinateUnits", "mm"), file, place);
      int number = 0;
      for (const nlohmann::json& point : markup.at("controlPoints"))
      {
        const std::string where = place + ", point " + std::to_string(++number);
        if (point.value("positionStatus", "defined") != "defined")
          continue;
        const auto p = point.at("position").get<std::vector<double>>();
        if (p.size() != 3)
          throw InputError(file, where, "its position must have three numbers");
        grouping.add({point.value("label", ""), unit * Eigen::Vector3d(sign * p[0], sign * p[1], p[2]), where,
                      point.value("selected", true)},
                     list);
      }
    }
  }
  catch (const nlohmann::json::exception& error)
  {
    throw InputError(file, "", std::string("is no markups file (") + error.what() + "); " + kRemedy);
  }
  return grouping.take();
}

ClickSet readFiducialCsv(const std::string& file)
{
  std::ifstream in = openInputFile(file, kRemedy);
  Grouping grouping(file);
  double sign = 0.0;
  int number = 0;
  for (std::string line; std::getline(in, line);)
  {
    const std::string where = "line " + std::to_string(++number);
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    if (line.empty())
      continue;
    if (line[0] == '#')
    {
      const std::size_t equal = line.find('=');
      if (line.find("CoordinateSystem") != std::string::npos && equal != std::string::npos)
      {
        std::string system = line.substr(equal + 1);
        system.erase(std::remove(system.begin(), system.end(), ' '), system.end());
        sign = signOf(system, file);
      }
      continue;
    }
    const std::vector<std::string> fields = csvFields(line);
    double p[3];
    for (std::size_t k = 0; k < 3; ++k)
    {
      char* end = nullptr;
      p[k] = fields.size() > k + 1 ? std::strtod(fields[k + 1].c_str(), &end) : 0.0;
      if (end == nullptr || *end != '\0' || fields[k + 1].empty())
        throw InputError(file, where, std::string("has no position; ") + kRemedy);
    }
    if (sign == 0.0)
      throw InputError(file, where, std::string("no line '# CoordinateSystem = LPS' before the points; ") + kRemedy);
    // A remark may follow the label: "LAD-1, ostium".
    const std::string label = fields.size() > kLabelColumn ? fields[kLabelColumn] : "";
    const bool is_selected = fields.size() <= kSelectedColumn || fields[kSelectedColumn] != "0";
    grouping.add({label.substr(0, label.find(',')), kMillimetre * Eigen::Vector3d(sign * p[0], sign * p[1], p[2]),
                  where, is_selected},
                 0);
  }
  return grouping.take();
}

}  // namespace endovascular_sim::segmentation
