#include "vessel/prepare/prepare_report.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/text/format.h"

namespace endovascular_sim::vessel
{
namespace
{

using Json = nlohmann::ordered_json;

/** Largest number of listed ends. */
constexpr std::size_t kMaxEnds = 40;

template <typename... Values>
std::string line(const char* format, Values... values)
{
  return formatted(format, values...) + "\n";
}

Json point(const Eigen::Vector3d& p)
{
  return {p.x(), p.y(), p.z()};
}

Json numbers(const MeshNumbers& mesh)
{
  const MeshReport& d = mesh.defects;
  return {{"vertices", mesh.vertices},
          {"triangles", mesh.triangles},
          {"area", mesh.area},
          {"volume", d.signed_volume},
          {"components", d.components.size()},
          {"genus", d.genus},
          {"boundary_edges", d.boundary_edges.count},
          {"non_manifold_edges", d.non_manifold_edges.count},
          {"non_manifold_vertices", d.non_manifold_vertices.count},
          {"misoriented_edges", d.misoriented_edges.count},
          {"degenerate_faces", d.degenerate_faces.count},
          {"duplicate_faces", d.duplicate_faces.count}};
}

Json deviation(const geometry::Deviation& d)
{
  return {{"largest", d.largest},
          {"p99", d.p99},
          {"rms", d.rms},
          {"place", point(d.location)},
          {"area_beyond_stated", d.beyond}};
}

Json centreline(const CentrelineTree& tree)
{
  Json branches = Json::array();
  for (const CentrelineBranch& branch : tree.branches)
  {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : branch.points)
      points.push_back(point(p));
    branches.push_back({{"name", branch.name}, {"parent", branch.parent}, {"points", points}, {"radii", branch.radii}});
  }
  return branches;
}

Json ends(const CentrelineTree& tree)
{
  Json list = Json::array();
  for (const CentrelineEnd& end : centrelineEnds(tree))
    list.push_back({{"branch", tree.branches[static_cast<std::size_t>(end.branch)].name},
                    {"position", point(end.position)},
                    {"inward", point(end.inward)},
                    {"radius", end.radius}});
  return list;
}

std::string table(const MeshNumbers& before, const MeshNumbers& after)
{
  std::string text = line("%-24s %14s %14s", "", "before", "after");
  const auto count = [&text](const char* name, std::size_t a, std::size_t b)
  { text += line("%-24s %14zu %14zu", name, a, b); };
  const auto defect = [&](const char* name, MeshDefect MeshReport::*which)
  {
    count(name, static_cast<std::size_t>((before.defects.*which).count),
          static_cast<std::size_t>((after.defects.*which).count));
  };
  count("triangles", before.triangles, after.triangles);
  count("components", before.defects.components.size(), after.defects.components.size());
  text += line("%-24s %14d %14d", "genus", before.defects.genus, after.defects.genus);
  defect("boundary edges", &MeshReport::boundary_edges);
  defect("non-manifold edges", &MeshReport::non_manifold_edges);
  defect("misoriented edges", &MeshReport::misoriented_edges);
  defect("degenerate faces", &MeshReport::degenerate_faces);
  text += line("%-24s %14.1f %14.1f", "area [mm2]", 1e6 * before.area, 1e6 * after.area);
  text += line("%-24s %14.3f %14.3f", "signed volume [ml]", 1e6 * before.defects.signed_volume,
               1e6 * after.defects.signed_volume);
  return text;
}

std::string deviationLine(const char* name, const geometry::Deviation& d, double stated)
{
  return line("%-24s largest %.3f mm at %s, 99 %% within %.3f, rms %.4f; beyond %.3g mm: %.3g mm2", name,
              1e3 * d.largest, formatLocation(d.location).c_str(), 1e3 * d.p99, 1e3 * d.rms, 1e3 * stated,
              1e6 * d.beyond);
}

std::string changesText(const PrepareReport& r)
{
  std::string text;
  double lids = 0.0;
  for (const ClosedHole& hole : r.holes)
    lids += hole.area;
  if (!r.holes.empty())
    text += line("closed %zu holes with lids of %.3g mm2", r.holes.size(), 1e6 * lids);
  for (const Gap& gap : r.bridges)
    text += line("bridge of %.2f mm, radius %.2f mm, from %s", 1e3 * gap.width, 1e3 * gap.radius,
                 formatLocation(gap.from).c_str());
  for (const LoosePiece& piece : r.dropped)
    text += line("DROPPED a loose component of %.3g ml, %.2f mm from the vessel at %s; --bridge %.4f joins it",
                 1e6 * piece.volume, 1e3 * piece.gap, formatLocation(piece.location).c_str(), 1.1 * piece.gap + 1e-4);
  if (r.crumbs > 0)
    text += line("dropped %d crumbs of %.2g ml in total", r.crumbs, 1e6 * r.crumb_volume);
  if (!r.separated_sheets.empty())
    text += line("separated touching sheets at %zu locations, the first near %s", r.separated_sheets.size(),
                 formatLocation(r.separated_sheets.front()).c_str());
  if (r.inner_area > 0.0)
    text +=
        line("removed walls %s: %.1f mm2", r.hollow ? "outside of the lumen" : "inside the vessel", 1e6 * r.inner_area);
  return text;
}

std::string gapText(const PrepareReport& r)
{
  if (r.hollow)
    return "";
  const NarrowGaps& g = r.gaps;
  if (g.kept + g.closed == 0)
    return "no gap between walls is narrower than two voxels\n";
  std::string text = line("gaps between walls below two voxels: %d of %d samples retained", g.kept, g.kept + g.closed);
  if (g.closed > 0)
    text += line("  the widest closed gap was %.3f mm, near %s: a septum there requires --voxel %.2g",
                 1e3 * g.widest_closed, formatLocation(g.closed_location).c_str(), 0.5 * g.widest_closed);
  return text;
}

std::string radiiText(const PrepareReport& r)
{
  double largest = 0.0;
  double mean = 0.0;
  for (const RadiusChange& radius : r.radii)
  {
    largest = std::max(largest, std::abs(radius.after - radius.before));
    mean += (radius.after - radius.before) / static_cast<double>(r.radii.size());
  }
  return line("radius along the centreline changes by %+.4f mm on average, at most %.3f mm", 1e3 * mean, 1e3 * largest);
}

std::string endsText(const CentrelineTree& tree, const std::vector<Opening>& openings)
{
  std::vector<CentrelineEnd> ends = centrelineEnds(tree);
  std::stable_sort(ends.begin(), ends.end(),
                   [](const CentrelineEnd& a, const CentrelineEnd& b) { return a.radius > b.radius; });
  std::string text = "ends by decreasing radius:\n";
  for (std::size_t k = 0; k < std::min(ends.size(), kMaxEnds); ++k)
  {
    const std::string& name = tree.branches[static_cast<std::size_t>(ends[k].branch)].name;
    const bool opened =
        std::any_of(openings.begin(), openings.end(),
                    [&](const Opening& o) { return o.end == name && o.outward.dot(ends[k].inward) < 0.0; });
    text += line("  %-12s radius %6.2f mm at %s%s", name.c_str(), 1e3 * ends[k].radius,
                 formatLocation(ends[k].position).c_str(), opened ? ", opened" : "");
  }
  if (ends.size() > kMaxEnds)
    text += line("  and %zu narrower ends: many ends indicate a thick wall; see --plug", ends.size() - kMaxEnds);
  return text;
}

}  // namespace

MeshNumbers numbersOf(const geometry::TriangleMesh& mesh)
{
  MeshNumbers numbers;
  numbers.vertices = mesh.vertices.size();
  numbers.triangles = mesh.triangles.size();
  numbers.defects = checkMesh(mesh);
  if (numbers.defects.invalid_faces.count > 0)
    return numbers;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    numbers.area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return numbers;
}

bool PrepareReport::withinDistance() const
{
  return input_to_result.largest <= max_distance && result_to_input.largest <= max_distance;
}

std::string PrepareReport::text(const CentrelineTree& tree) const
{
  std::string text = source + ": voxel " + line("%.3g mm", 1e3 * voxel) + table(before, after) + changesText(*this);
  text += deviationLine("input to result", input_to_result, max_distance) +
          deviationLine("result to input", result_to_input, max_distance);
  text += line("%s the tolerance of %.3g mm", withinDistance() ? "within" : "BEYOND", 1e3 * max_distance);
  text += gapText(*this) + radiiText(*this);
  text += endsText(tree, openings);
  return text;
}

std::string PrepareReport::json(const CentrelineTree& tree) const
{
  Json out{{"source", source},
           {"unit", "SI: metres, square metres, cubic metres"},
           {"voxel", voxel},
           {"stated_distance", max_distance},
           {"within_stated_distance", withinDistance()},
           {"before", numbers(before)},
           {"after", numbers(after)},
           {"input_to_result", deviation(input_to_result)},
           {"result_to_input", deviation(result_to_input)},
           {"inner_walls_area", inner_area},
           {"lids_and_bridges_area", lid_area},
           {"largest_smoothing_move", largest_move},
           {"crumbs", {{"count", crumbs}, {"volume", crumb_volume}}},
           {"narrow_gaps",
            {{"kept", gaps.kept},
             {"closed", gaps.closed},
             {"widest_closed", gaps.widest_closed},
             {"widest_closed_place", point(gaps.closed_location)},
             {"narrowest_kept", gaps.narrowest_kept}}}};
  for (const char* list : {"holes", "bridges", "dropped", "parted", "openings", "radii"})
    out[list] = Json::array();
  for (const ClosedHole& h : holes)
    out["holes"].push_back({{"edges", h.edges},
                            {"perimeter", h.perimeter},
                            {"area", h.area},
                            {"unevenness", h.unevenness},
                            {"place", point(h.location)}});
  for (const Gap& g : bridges)
    out["bridges"].push_back({{"from", point(g.from)}, {"to", point(g.to)}, {"width", g.width}, {"radius", g.radius}});
  for (const LoosePiece& p : dropped)
    out["dropped"].push_back({{"volume", p.volume}, {"gap", p.gap}, {"place", point(p.location)}});
  for (const Eigen::Vector3d& location : separated_sheets)
    out["parted"].push_back(point(location));
  for (const Opening& o : openings)
    out["openings"].push_back(
        {{"branch", o.end}, {"place", point(o.location)}, {"outward", point(o.outward)}, {"radius", o.radius}});
  for (const RadiusChange& r : radii)
    out["radii"].push_back({{"branch", r.branch}, {"arc", r.arc}, {"before", r.before}, {"after", r.after}});
  out["ends"] = ends(tree);
  out["centreline"] = centreline(tree);
  return out.dump(1) + "\n";
}

}  // namespace endovascular_sim::vessel
