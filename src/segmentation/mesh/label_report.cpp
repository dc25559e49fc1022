#include "segmentation/mesh/label_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "common/text/format.h"
#include "geometry/mesh_distance.h"
#include "vessel/centreline/lumen_section.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Json = nlohmann::ordered_json;

double rounded(double value)
{
  constexpr double kUnit = 1e-6;  // m
  return std::round(value / kUnit) * kUnit;
}

Json toJson(const Scan& scan, const Eigen::Vector3d& p)
{
  const Eigen::Vector3d in_patient = scan.toPatient(p);
  return {rounded(in_patient.x()), rounded(in_patient.y()), rounded(in_patient.z())};
}

Json toJson(const Scan& scan, const std::vector<Eigen::Vector3d>& points)
{
  Json json = Json::array();
  for (const Eigen::Vector3d& p : points)
    json.push_back(toJson(scan, p));
  return json;
}

/** Mean over the first or last tenth of the sections, of one section at least. */
double meanOfTenth(const std::vector<double>& values, bool first)
{
  const std::size_t count = std::max<std::size_t>(1, values.size() / 10);
  const auto begin = first ? values.begin() : values.end() - static_cast<std::ptrdiff_t>(count);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) / static_cast<double>(count);
}

Json maskJson(const Scan& scan, const LabelVessel& vessel)
{
  const MaskChanges& changes = vessel.changes;
  Json islands = Json::array();
  for (const Island& island : changes.islands)
    islands.push_back({{"volume", island.volume}, {"gap", island.gap}, {"position", toJson(scan, island.location)}});
  return {{"volume", vessel.mask_volume},
          {"islands", islands},
          {"joined", toJson(scan, changes.joints)},
          {"cavities", changes.cavities},
          {"cavity_volume", static_cast<double>(changes.cavity_voxels) * scan.spacing().prod()},
          {"filled_handles", toJson(scan, changes.tunnels)},
          {"cut_loops", toJson(scan, changes.cut_loops)},
          {"touches_of_the_border", toJson(scan, vessel.touches)}};
}

Json branchJson(const Scan& scan, const LabelVessel& vessel, std::size_t b, const BranchSections& sections)
{
  const vessel::CentrelineBranch& branch = vessel.centreline.branches[b];
  Json arc = Json::array();
  Json diameter = Json::array();
  for (std::size_t k = 0; k < sections.arc.size(); ++k)
  {
    arc.push_back(rounded(sections.arc[k]));
    diameter.push_back(rounded(sections.diameter[k]));
  }
  const std::string parent =
      branch.parent < 0 ? "" : vessel.centreline.branches[static_cast<std::size_t>(branch.parent)].name;
  return {{"name", branch.name},
          {"parent", parent},
          {"length", sections.arc.back()},
          {"first_diameter", meanOfTenth(sections.diameter, true)},
          {"last_diameter", meanOfTenth(sections.diameter, false)},
          {"least_diameter", sections.diameter[sections.narrowest]},
          {"least_diameter_at", sections.arc[sections.narrowest]},
          {"least_diameter_position", toJson(scan, branch.points[sections.narrowest])},
          {"sections", {{"arc", arc}, {"diameter", diameter}}}};
}

/** Cross-sections at the points of a centreline. */
BranchSections sectionsAlong(const vessel::CentrelineBranch& line, const geometry::MeshDistance& wall)
{
  const std::size_t n = line.points.size();
  BranchSections sections;
  for (std::size_t k = 0; k < n; ++k)
  {
    sections.arc.push_back(k == 0 ? 0.0 : sections.arc.back() + (line.points[k] - line.points[k - 1]).norm());
    const Eigen::Vector3d along = line.points[std::min(k + 1, n - 1)] - line.points[k > 0 ? k - 1 : 0];
    sections.diameter.push_back(vessel::lumenDiameter(wall, line.points[k], along.normalized()));
  }
  // A tip is no cross-section of the lumen.
  sections.narrowest = n / 2;
  for (std::size_t k = 0; k < n; ++k)
    if (sections.arc[k] >= line.radii.front() && sections.arc.back() - sections.arc[k] >= line.radii.back() &&
        sections.diameter[k] < sections.diameter[sections.narrowest])
      sections.narrowest = k;
  return sections;
}

}  // namespace

std::vector<BranchSections> sectionsOf(const LabelVessel& vessel)
{
  const geometry::MeshDistance wall(vessel.closed);
  std::vector<BranchSections> sections;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
    sections.push_back(sectionsAlong(branch, wall));
  return sections;
}

std::string labelJson(const Scan& scan, const LabelVessel& vessel, const std::vector<ChosenLabel>& labels,
                      const std::vector<std::string>& warnings)
{
  Json json;
  json["modality"] = "labels";
  json["spacing"] = {scan.spacing().x(), scan.spacing().y(), scan.spacing().z()};
  json["warnings"] = warnings;
  json["labels"] = Json::array();
  for (const ChosenLabel& label : labels)
    json["labels"].push_back({{"label", label.number}, {"name", label.name}, {"voxels", label.voxels}});
  json["mask"] = maskJson(scan, vessel);
  json["genus"] = vessel.genus;
  json["open_ends"] = Json::array();
  for (const LabelOpening& opening : vessel.openings)
    json["open_ends"].push_back({{"branch", opening.branch},
                                 {"position", toJson(scan, opening.location)},
                                 {"radius", rounded(opening.radius)},
                                 {"at_border", opening.at_border}});
  json["branches"] = Json::array();
  const std::vector<BranchSections> sections = sectionsOf(vessel);
  for (std::size_t b = 0; b < vessel.centreline.branches.size(); ++b)
    json["branches"].push_back(branchJson(scan, vessel, b, sections[b]));
  return json.dump(1) + "\n";
}

std::string labelText(const LabelVessel& vessel, const std::vector<ChosenLabel>& labels)
{
  std::string text;
  for (const ChosenLabel& label : labels)
    text += formatted("label %ld: %s, %zu voxels\n", label.number, label.name.c_str(), label.voxels);
  const MaskChanges& changes = vessel.changes;
  text += formatted(
      "mask of %.2f ml: %zu island(s) removed, %zu gap(s) closed, %zu cavity(ies) and %zu handle(s) filled, "
      "%zu loop(s) cut\n",
      1e6 * vessel.mask_volume, changes.islands.size(), changes.joints.size(), changes.cavities, changes.tunnels.size(),
      changes.cut_loops.size());
  text += "branch                       length  diameter: first  last  least at\n";
  const std::vector<BranchSections> sections = sectionsOf(vessel);
  for (std::size_t b = 0; b < vessel.centreline.branches.size(); ++b)
  {
    const BranchSections& s = sections[b];
    text += formatted("%-26s %6.1f mm        %6.2f %5.2f %6.2f %5.1f mm\n", vessel.centreline.branches[b].name.c_str(),
                      1e3 * s.arc.back(), 1e3 * meanOfTenth(s.diameter, true), 1e3 * meanOfTenth(s.diameter, false),
                      1e3 * s.diameter[s.narrowest], 1e3 * s.arc[s.narrowest]);
  }
  return text;
}

}  // namespace endovascular_sim::segmentation
