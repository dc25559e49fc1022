#include "benchmark/studies/contact_study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "benchmark/harness/bench_run.h"
#include "benchmark/studies/bounding_volumes.h"
#include "common/error.h"
#include "common/time/processor_time.h"
#include "contact/detector.h"
#include "geometry/loop_subdivision.h"
#include "geometry/mesh_distance.h"
#include "vessel/anatomy/tube.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kNodes = 380;
constexpr double kLength = 0.45;         // length of the wire [m]
constexpr double kRadius = 0.445e-3;     // radius of the wire [m]
constexpr double kAway = 0.45e-3;        // distance between its axis and the wall [m]
constexpr double kTravel = 0.035e-3;     // travel per step of 1 ms at 35 mm/s [m]
constexpr double kMargin = 0.25e-3;      // margin of the query [m]
constexpr double kCollectRadius = 2e-3;  // radius of a typical query of the detector [m]
constexpr int kSteadySteps = 400;

struct StudyMesh
{
  std::string name;
  geometry::TriangleMesh mesh;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/** Mesh aortic_arch_tree.obj with the entry of peer_wire.yaml, else a channel. */
StudyMesh baseMesh(const StudyOptions& options)
{
  StudyMesh base;
  if (!options.vessel_mesh.empty())
  {
    base.name = "aortic_arch_tree";
    base.mesh = vessel::repairMesh(vessel::readMesh(options.vessel_mesh, 1e-3), options.vessel_mesh).mesh;
    base.start = {-0.035, 0.065, 0.005};
    base.direction = {-1.0, -1.0, 0.0};
    return base;
  }
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 3e-3;
  shape.facets_around = 20;
  shape.pieces = {{0.1, 0.0, 0.0}, {0.06, 20.0, 0.3}, {0.3, 0.0, 0.0}};
  base.name = "channel";
  base.mesh = vessel::tubeMesh(shape);
  return base;
}

/** Mesh aorta_coronary_female.obj in the folder of the other mesh, without repair: timing requires no closed surface.
 *  @return mesh without triangles if the file is missing */
StudyMesh biggestMesh(const StudyOptions& options)
{
  StudyMesh big;
  const std::filesystem::path file =
      std::filesystem::path(options.vessel_mesh).parent_path() / "aorta_coronary_female.obj";
  if (options.vessel_mesh.empty() || !std::filesystem::exists(file))
    return big;
  big.name = "aorta_coronary_female";
  big.mesh = vessel::readMesh(file.string(), 1e-3);
  // Near the lowest point of the mesh, upwards: inside or outside the descending aorta, which is equivalent here.
  big.start = *std::min_element(big.mesh.vertices.begin(), big.mesh.vertices.end(),
                                [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); });
  big.start += Eigen::Vector3d(0.1e-3, 0.1e-3, 0.3e-3);
  return big;
}

contact::Query queryAlong(const std::vector<Eigen::Vector3d>& curve, double curve_spacing, double shift)
{
  contact::Query query;
  query.margin.assign(kNodes, kMargin);
  query.radius.assign(kNodes, kRadius);
  for (int i = 0; i < kNodes; ++i)
  {
    const double at = (shift + i * kLength / (kNodes - 1)) / curve_spacing;
    const auto k = std::min(static_cast<std::size_t>(at), curve.size() - 2);
    const double t = at - static_cast<double>(k);
    query.nodes.push_back((1.0 - t) * curve[k] + t * curve[k + 1]);
  }
  return query;
}

/** Detection times of one mesh. */
struct DetectionTime
{
  double steady = 0.0;    ///< median over the steps of a sliding wire [µs]
  double cold = 0.0;      ///< first call of a detector, fastest of several [µs]
  double features = 0.0;  ///< mean number of features per step
  double build_ms = 0.0;  ///< time of building the detector [ms]
};

double percentile(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

DetectionTime detectionTime(const StudyMesh& mesh, bool quick)
{
  const double spacing = 0.2e-3;
  const auto count = static_cast<int>((kLength + kSteadySteps * kTravel) / spacing) + 3;
  const std::vector<Eigen::Vector3d> curve =
      curveAlongWall(mesh.mesh, mesh.start, mesh.direction, kAway, spacing, count);
  DetectionTime time;
  std::vector<double> cold;
  std::vector<double> steady;
  contact::ContactSet set;
  for (int k = 0; k < (quick ? 3 : 7); ++k)
  {
    const double begin = processorSeconds();
    contact::Detector detector(mesh.mesh, contact::WallLaw{});
    time.build_ms = 1e3 * (processorSeconds() - begin);
    for (int step = 0; step < kSteadySteps; ++step)
    {
      const contact::Query query = queryAlong(curve, spacing, step * kTravel);
      const double start = processorSeconds();
      detector.detect(query, set);
      const double us = 1e6 * (processorSeconds() - start);
      (step == 0 ? cold : steady).push_back(us);
      time.features += static_cast<double>(set.features.size());
    }
  }
  time.features /= static_cast<double>(cold.size() + steady.size());
  time.steady = percentile(steady, 0.5);
  time.cold = percentile(cold, 0.0);
  return time;
}

Section volumes(const StudyMesh& base, const StudyMesh& big, bool quick, const Progress& progress)
{
  Section section(contactTables(), "contact_volumes");
  section.text =
      "Hierarchies of FCL over the same triangles, traversed from the root by the same code with the distance bound "
      "of each volume. Collect: all triangles possibly within 2 mm of a node, the query of a new detector. Nearest: "
      "the nearest triangle, the query of signs and free distances. Fastest of several runs.";
  std::vector<StudyMesh> meshes;
  StudyMesh fine = base;
  fine.mesh = geometry::midpointSubdivision(base.mesh, 2);
  meshes.push_back(fine);
  if (!big.mesh.triangles.empty())
    meshes.push_back(big);
  double done = 0.0;
  for (const StudyMesh& mesh : meshes)
  {
    progress(0.2 * done++ / static_cast<double>(meshes.size()), "bounding volumes, " + mesh.name);
    const std::vector<Eigen::Vector3d> curve =
        curveAlongWall(mesh.mesh, mesh.start, mesh.direction, kAway, kLength / kNodes, kNodes);
    for (const VolumeResult& r : compareBoundingVolumes(mesh.mesh, curve, kCollectRadius, quick ? 3 : 15))
      section.table.add({mesh.name, std::to_string(mesh.mesh.triangles.size()), r.name, std::to_string(r.bytes),
                         number(r.build_ms), number(r.collect_us), number(r.collect_tests), number(r.collect_leaves),
                         number(r.nearest_us), number(r.nearest_tests), number(r.nearest_leaves)});
  }
  return section;
}

/** Slope of the least-squares line of y over x. */
double slope(const std::vector<double>& x, const std::vector<double>& y)
{
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
  {
    mean_x += x[k] / static_cast<double>(x.size());
    mean_y += y[k] / static_cast<double>(x.size());
  }
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
  {
    xy += (x[k] - mean_x) * (y[k] - mean_y);
    xx += (x[k] - mean_x) * (x[k] - mean_x);
  }
  return xx > 0.0 ? xy / xx : NAN;
}

/** Exponent of the fitted power law. */
double exponent(const std::vector<double>& triangles, const std::vector<double>& times)
{
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t k = 0; k < times.size(); ++k)
  {
    x.push_back(std::log(triangles[k]));
    y.push_back(std::log(times[k]));
  }
  return slope(x, y);
}

Section growth(const StudyMesh& base, const StudyMesh& big, bool quick, const Progress& progress)
{
  Section section(contactTables(), "contact_growth");
  std::vector<double> triangles, steady, cold, nearest;
  const auto add = [&](const StudyMesh& mesh)
  {
    const DetectionTime time = detectionTime(mesh, quick);
    const std::vector<Eigen::Vector3d> curve =
        curveAlongWall(mesh.mesh, mesh.start, mesh.direction, kAway, kLength / kNodes, kNodes);
    const double us = compareBoundingVolumes(mesh.mesh, curve, kCollectRadius, 3)[1].nearest_us;
    const double depth = std::log2(static_cast<double>(mesh.mesh.triangles.size()));
    section.table.add({mesh.name, std::to_string(mesh.mesh.triangles.size()), number(time.build_ms),
                       number(time.steady), number(time.cold), number(us), number(time.features),
                       number(time.steady / depth)});
    if (mesh.name == big.name)
      return;
    triangles.push_back(static_cast<double>(mesh.mesh.triangles.size()));
    steady.push_back(time.steady);
    cold.push_back(time.cold);
    nearest.push_back(us);
  };
  const int levels = quick ? 2 : 4;
  for (int level = 0; level <= levels; ++level)
  {
    progress(0.2 + 0.6 * level / (levels + 1), "growth, " + std::to_string(level) + " subdivisions");
    StudyMesh mesh = base;
    mesh.mesh = geometry::midpointSubdivision(base.mesh, level);
    add(mesh);
  }
  progress(0.75, "growth, " + big.name);
  if (!big.mesh.triangles.empty())
    add(big);
  std::vector<double> doublings;
  doublings.reserve(triangles.size());
  for (double t : triangles)
    doublings.push_back(std::log2(t));
  section.text =
      "One call of the detector for 380 nodes over 450 mm, all in contact with the wall (the upper bound of the "
      "cost). Steady: the wire slides along itself by 35 µm per call; median. Cold: first call of a new detector. "
      "Each "
      "refinement divides the triangles into four on the same surface. Fit over the rows of " +
      base.name + ": steady ∝ N^" + number(exponent(triangles, steady), 2) + ", cold ∝ N^" +
      number(exponent(triangles, cold), 2) + ", nearest triangle ∝ N^" + number(exponent(triangles, nearest), 2) +
      " or " + number(slope(doublings, nearest), 2) +
      " µs per doubling of N. From the coarsest to the finest mesh, N grows " +
      number(triangles.back() / triangles.front()) + " times, steady " + number(steady.back() / steady.front()) +
      " times, cold " + number(cold.back() / cold.front()) + " times, nearest triangle " +
      number(nearest.back() / nearest.front()) +
      " times. The query descends a tree of depth log N; the excess is the cost of cache misses. The sliding wire "
      "reuses its neighbour lists, whose length depends on N only for facets smaller than the skin; a new detector "
      "builds all lists.";
  return section;
}

/** Time of the first call of a new detector of the wall of a run, fastest of five [µs]. */
double coldTime(const BenchRun& run, const contact::Query& query, contact::ContactSet& set)
{
  geometry::TriangleMesh mesh;
  mesh.vertices = run.wall()->wall().vertices;
  mesh.triangles = run.wall()->wall().triangles;
  double fastest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 5; ++k)
  {
    contact::Detector detector(mesh, contact::WallLaw{});
    const double begin = processorSeconds();
    detector.detect(query, set);
    fastest = std::min(fastest, 1e6 * (processorSeconds() - begin));
  }
  return fastest;
}

/** Detection within a simulation. */
Section loop(const StudyOptions& options, const Progress& progress)
{
  Section section(contactTables(), "contact_loop");
  section.text =
      "The wire of peer_wire.yaml with 380 nodes, pushed 400 mm at 35 mm/s and rotated; Δt 1 ms; last two seconds. "
      "Cold: first call of a new detector at the final shape, fastest of five.";
  if (options.vessel_mesh.empty())
    return section;
  for (int smoothing = 0; smoothing <= 2; ++smoothing)
  {
    progress(0.8 + 0.06 * smoothing, "loop, " + std::to_string(smoothing) + " subdivisions");
    BenchRun run(
        "vessel: {mesh: '" + options.vessel_mesh +
        "', unit: 0.001, friction: 0.1, smoothing: " + std::to_string(smoothing) +
        "}\n"
        "name: loop\n"
        "duration: 10\n"
        "entry: {position: [-0.035, 0.065, 0.005], direction: [-1, -1, 0], up: [1, -1, 0]}\n"
        "instrument: instruments/peer_j_wire.yaml\n"
        "drive: {source: script, initial_insertion: 0.0042, speed: 0.035, travel: 0.4, rotation: {amplitude: 2.0, "
        "frequency: 0.159}, force_limit: 8}\n"
        "sampling: "
        "{kind: uniform, nodes: 380}\n");
    run.advance(options.quick ? 0.2 : 9.4);
    const RunSummary summary = run.advance(options.quick ? 0.2 : 2.0);
    const double collision = summary.phase_us[static_cast<std::size_t>(Phase::kCollision)];
    const contact::Query query = run.simulation().initialQuery();
    contact::ContactSet set;
    const double cold = coldTime(run, query, set);
    section.table.add({"aortic_arch_tree, smoothed " + std::to_string(smoothing) + " times",
                       std::to_string(run.wall()->wall().triangles.size()), std::to_string(query.nodes.size()),
                       std::to_string(set.features.size()), number(collision), number(cold),
                       number(collision / summary.median_us, 2), number(summary.median_us), number(summary.p99_us),
                       number(summary.solves)});
  }
  return section;
}

}  // namespace

std::vector<Eigen::Vector3d> curveAlongWall(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& start,
                                            const Eigen::Vector3d& direction, double distance, double spacing,
                                            int count)
{
  const geometry::MeshDistance wall(mesh);
  std::vector<Eigen::Vector3d> curve;
  Eigen::Vector3d p = start;
  Eigen::Vector3d d = direction.normalized();
  for (int k = 0; k < count; ++k)
  {
    const geometry::ClosestPoint closest = wall.closest(p);
    const Eigen::Vector3d normal = (p - closest.point) / std::max(closest.distance, 1e-12);
    p = closest.point + distance * normal;
    curve.push_back(p);
    // Continues straight, tangentially to the wall.
    Eigen::Vector3d along = d - d.dot(normal) * normal;
    if (along.norm() < 1e-6)
      along = normal.unitOrthogonal();
    d = along.normalized();
    p += spacing * d;
  }
  return curve;
}

std::vector<TableSpec> contactTables()
{
  return {{"contact_volumes",
           "Bounding volumes",
           {"mesh", "triangles", "volume", "bytes", "build [ms]", "collect [µs]", "volumes looked at", "triangles left",
            "nearest [µs]", "volumes looked at (nearest)", "triangles measured"},
           "contact_volumes.png"},
          {"contact_growth",
           "Detection over the number of triangles",
           {"mesh", "triangles", "build [ms]", "steady [µs]", "cold [µs]", "nearest triangle [µs]", "features",
            "steady over log₂ of the triangles [µs]"},
           "contact_growth.png"},
          {"contact_loop",
           "Detection within a simulation",
           {"vessel", "triangles", "nodes inside", "contacts listed", "detection per step, median [µs]", "cold [µs]",
            "detection, share of the step [1]", "step, median [µs]", "step, p99 [µs]", "solves per step"},
           ""}};
}

std::vector<Section> contactStudy(const StudyOptions& options, const Progress& progress)
{
  const StudyMesh base = baseMesh(options);
  const StudyMesh big = biggestMesh(options);
  std::vector<Section> sections;
  sections.push_back(volumes(base, big, options.quick, progress));
  sections.push_back(growth(base, big, options.quick, progress));
  sections.push_back(loop(options, progress));
  if (big.mesh.triangles.empty())
    sections.front().text += " Omitted: aorta_coronary_female.obj is not in the folder of the vessel mesh.";
  if (options.vessel_mesh.empty())
    sections.back().text += " Omitted: no vessel mesh was given.";
  return sections;
}

}  // namespace endovascular_sim::benchmark
