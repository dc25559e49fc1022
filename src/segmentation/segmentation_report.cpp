#include "segmentation/segmentation_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/text/format.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double kManyWithoutEdge = 0.3;
constexpr double kSomeCalcium = 0.04;  ///< two of 48 rays

/** Stretches of a branch whose sections fulfil a condition. */
template <typename Condition>
std::vector<Stretch> stretches(const LumenBranch& branch, const Condition& condition)
{
  const std::vector<double> arc = branch.arc();
  std::vector<Stretch> found;
  bool open = false;
  for (std::size_t k = 0; k < arc.size(); ++k)
  {
    const bool is = condition(branch.sections[k]);
    if (is && !open)
      found.push_back({arc[k], arc[k]});
    else if (is)
      found.back().to = arc[k];
    open = is;
  }
  return found;
}

Json toJson(const std::vector<Stretch>& list)
{
  Json json = Json::array();
  for (const Stretch& stretch : list)
    json.push_back({{"from", stretch.from}, {"to", stretch.to}});
  return json;
}

}  // namespace

BranchFindings findingsOf(const Scan& scan, const std::vector<LumenBranch>& branches, std::size_t branch,
                          const std::vector<std::string>& warnings)
{
  const LumenBranch& own = branches[branch];
  const std::vector<double> arc = own.arc();
  const std::size_t n = own.sections.size();
  const std::size_t tenth = std::max<std::size_t>(1, n / 10);
  BranchFindings findings;
  findings.name = own.name;
  if (own.parent >= 0)
    findings.parent = branches[static_cast<std::size_t>(own.parent)].name;
  findings.length = arc.back();
  findings.throat = throatOf(scan, own);
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k)
  {
    const double diameter = own.sections[k].diameter();
    if (k < tenth)
      findings.first_diameter += diameter / static_cast<double>(tenth);
    if (k + tenth >= n)
      findings.last_diameter += diameter / static_cast<double>(tenth);
    if (k > 0)
      findings.volume += 0.5 * (own.sections[k].area() + own.sections[k - 1].area()) * (arc[k] - arc[k - 1]);
    values.push_back(own.sections[k].lumen);
    findings.rays_without_edge += (1.0 - own.sections[k].edges()) / static_cast<double>(n);
  }
  std::sort(values.begin(), values.end());
  findings.lumen = values[n / 2];
  findings.without_edge =
      stretches(own, [](const Section& section) { return 1.0 - section.edges() > kManyWithoutEdge; });
  findings.calcium =
      stretches(own, [](const Section& section) { return section.share(RayEnd::kCalcium) > kSomeCalcium; });
  findings.bone = stretches(own, [](const Section& section) { return section.share(RayEnd::kBone) > kSomeCalcium; });
  findings.turns = turnsOf(own);
  findings.verdict = verdictOf(scan, branches, branch, warnings);
  return findings;
}

std::string segmentationJson(const Scan& scan, const std::vector<LumenBranch>& branches,
                             const std::vector<std::string>& warnings)
{
  Json json;
  json["modality"] = scan.modality() == image::Modality::kCt ? "CT" : "other";
  json["spacing"] = {scan.spacing().x(), scan.spacing().y(), scan.spacing().z()};
  json["warnings"] = warnings;
  json["branches"] = Json::array();
  for (std::size_t b = 0; b < branches.size(); ++b)
  {
    const BranchFindings f = findingsOf(scan, branches, b, warnings);
    Json branch = {{"name", f.name},
                   {"parent", f.parent},
                   {"length", f.length},
                   {"volume", f.volume},
                   {"first_diameter", f.first_diameter},
                   {"last_diameter", f.last_diameter},
                   {"least_diameter", f.throat.diameter},
                   {"least_diameter_at", f.throat.at},
                   {"least_diameter_position", {f.throat.position.x(), f.throat.position.y(), f.throat.position.z()}},
                   {"least_diameter_voxels", f.throat.voxels},
                   {"least_diameter_error", f.throat.error},
                   {"lumen_value", f.lumen},
                   {"rays_without_edge", f.rays_without_edge},
                   {"stretches_without_edge", toJson(f.without_edge)},
                   {"calcium", toJson(f.calcium)},
                   {"bone", toJson(f.bone)},
                   {"turns", toJson(f.turns)},
                   {"verdict", nameOf(f.verdict.use)},
                   {"reasons", f.verdict.reasons}};
    const std::vector<double> arc = branches[b].arc();
    Json sections = {{"arc", Json::array()}, {"diameter", Json::array()}, {"lumen_value", Json::array()}};
    for (std::size_t k = 0; k < arc.size(); ++k)
    {
      const auto rounded = [](double value, double unit) { return std::round(value / unit) * unit; };
      sections["arc"].push_back(rounded(arc[k], 1e-6));
      sections["diameter"].push_back(rounded(branches[b].sections[k].diameter(), 1e-6));
      sections["lumen_value"].push_back(rounded(branches[b].sections[k].lumen, 0.1));
    }
    branch["sections"] = sections;
    json["branches"].push_back(branch);
  }
  return json.dump(1) + "\n";
}

std::string segmentationText(const Scan& scan, const std::vector<LumenBranch>& branches,
                             const std::vector<std::string>& warnings)
{
  std::string text =
      "branch                       length  diameter: first  last  least ± error at    lumen  no edge  calcium\n";
  std::string verdicts;
  for (std::size_t b = 0; b < branches.size(); ++b)
  {
    const BranchFindings f = findingsOf(scan, branches, b, warnings);
    double calcium = 0.0;
    for (const Stretch& stretch : f.calcium)
      calcium += stretch.to - stretch.from;
    text +=
        formatted("%-26s %6.1f mm        %6.2f %5.2f %6.2f ± %4.2f %5.1f mm %5.0f %6.1f %% %5.1f mm\n", f.name.c_str(),
                  1e3 * f.length, 1e3 * f.first_diameter, 1e3 * f.last_diameter, 1e3 * f.throat.diameter,
                  1e3 * f.throat.error, 1e3 * f.throat.at, f.lumen, 100.0 * f.rays_without_edge, 1e3 * calcium);
    verdicts += f.name + ": " + nameOf(f.verdict.use);
    for (std::size_t k = 0; k < f.verdict.reasons.size(); ++k)
      verdicts += (k == 0 ? ": " : "; ") + f.verdict.reasons[k];
    verdicts += "\n";
  }
  return text + verdicts;
}

}  // namespace endovascular_sim::segmentation
