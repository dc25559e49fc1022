#include "benchmark/fuzz/fuzz_vessels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <Eigen/Geometry>

#include "benchmark/harness/table.h"
#include "common/error.h"
#include "contact/wall/smooth_wall.h"
#include "geometry/loop_subdivision.h"
#include "scene/file_search.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/centreline_extraction.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kCheckedSag = 10e-6;  // of the chords of the tessellation of a smooth wall, mostly [m]
constexpr int kForks = 6;
constexpr int kTries = 200;
constexpr double kSmoothedUpTo = 20000;  // largest number of triangles of a mesh that is also used after smoothing

vessel::TubeShape randomShape(FuzzRandom& random)
{
  vessel::TubeShape shape;
  shape.radius = random.logBetween(0.8e-3, 6e-3);
  shape.facets_around = random.integer(8, 40);
  shape.facet_length = shape.radius * random.between(0.3, 2.5);
  shape.pieces.push_back({random.between(0.015, 0.04), 0.0, 0.0});
  for (int k = random.integer(1, 3); k > 0; --k)
  {
    const double bend = std::max(5e-3, shape.radius * random.logBetween(3.0, 12.0));
    shape.pieces.push_back({bend * random.between(0.3, 2.2), 1.0 / bend, random.between(0.0, 2.0 * M_PI)});
    shape.pieces.push_back({random.between(0.0, 0.03) + 1e-3, 0.0, 0.0});
  }
  return shape;
}

/** Checks that a channel does not intersect itself: the winding number is 1 and the axis lies at the centre. */
bool isPlain(const WireCheck& check, const geometry::TriangleMesh& mesh, const vessel::TubeShape& shape)
{
  const vessel::CentrelineTree axis = vessel::tubeCentreline(shape);
  const std::vector<Eigen::Vector3d>& points = axis.branches.front().points;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const bool near_cap =
        (points[k] - points.front()).norm() < shape.radius || (points[k] - points.back()).norm() < shape.radius;
    if (near_cap)
      continue;
    if (check.signedDistance(points[k]) < 0.7 * shape.radius ||
        std::abs(geometry::windingNumber(mesh, points[k]) - 1.0) > 1e-6)
      return false;
  }
  return true;
}

std::unique_ptr<FuzzVessel> randomChannel(FuzzRandom& random)
{
  for (int attempt = 0; attempt < kTries; ++attempt)
  {
    const vessel::TubeShape shape = randomShape(random);
    auto made = std::make_unique<FuzzVessel>();
    made->vessel->mesh = vessel::tubeMesh(shape);
    made->check = std::make_unique<WireCheck>(made->vessel->mesh);
    if (!isPlain(*made->check, made->vessel->mesh, shape))
      continue;
    made->name = "channel";
    made->vessel->centreline = vessel::tubeCentreline(shape);
    made->narrowest = shape.radius * std::cos(M_PI / shape.facets_around);
    double curvature = 0.0;
    for (const vessel::TubePiece& piece : shape.pieces)
      curvature = std::max(curvature, piece.curvature);
    made->tightest = 1.0 / curvature;
    made->detail = "radius " + number(1e3 * shape.radius) + " mm, bends from " + number(1e3 * made->tightest) +
                   " mm, " + std::to_string(shape.facets_around) + " facets of " + number(1e3 * shape.facet_length) +
                   " mm around";
    return made;
  }
  throw InputError("fuzz", "", "no channel without self-intersection found");
}

/** Trunk with two branches. @param which number of the variant, which determines widths and angles */
vessel::Anatomy forkAnatomy(int which)
{
  FuzzRandom random(20260101, static_cast<std::uint64_t>(which));
  const double width = random.between(4e-3, 14e-3);
  vessel::Anatomy anatomy;
  anatomy.name = anatomy.file = "fork_" + std::to_string(which);
  anatomy.facets_around = random.integer(8, 20);
  anatomy.longest_facet = random.between(1e-3, 4e-3);
  anatomy.blend = random.between(0.1, 1.5);
  const auto arm = [&random](double side)
  {
    const double out = side * random.between(0.4, 1.2);
    return std::vector<Eigen::Vector3d>{{0.0, 0.0, 0.05}, {0.02 * out, 0.004, 0.068}, {0.05 * out, 0.0, 0.09}};
  };
  const double left = width * random.between(0.5, 0.9);
  const double right = width * random.between(0.4, 0.8);
  vessel::AnatomyBranch trunk;
  trunk.name = "trunk";
  trunk.points = {{0.0, 0.0, 0.0}, {0.0, 0.003, 0.025}, {0.0, 0.0, 0.05}};
  trunk.diameters = {{0.0, width}, {1.0, 0.9 * width}};
  anatomy.branches.push_back(trunk);
  vessel::AnatomyBranch branch;
  branch.parent = 0;
  branch.name = "left";
  branch.points = arm(1.0);
  branch.diameters = {{0.0, left}, {1.0, 0.8 * left}};
  anatomy.branches.push_back(branch);
  branch.name = "right";
  branch.points = arm(-1.0);
  branch.diameters = {{0.0, right}, {1.0, 0.8 * right}};
  anatomy.branches.push_back(branch);
  return anatomy;
}

vessel::Vessel forkVessel(int which)
{
  const vessel::Anatomy anatomy = forkAnatomy(which);
  const std::vector<vessel::AnatomyChain> chains = vessel::sampleChains(anatomy);
  vessel::Vessel made;
  made.centreline = vessel::anatomyCentreline(anatomy, chains);
  made.mesh = vessel::generateAnatomyMesh(anatomy, chains);
  return made;
}

/** Reads a mesh in millimetres or, if its size is then implausible, in metres. */
geometry::TriangleMesh readCleanMesh(const std::string& file)
{
  const double unit = vessel::checkMesh(vessel::readMesh(file, 1.0)).upper.cwiseAbs().maxCoeff() > 3.0 ? 1e-3 : 1.0;
  return vessel::repairMesh(vessel::readMesh(file, unit), file).mesh;
}

/** Sets the shape of a vessel's wall and its check. */
void setWall(FuzzVessel& vessel, bool smooth)
{
  if (!smooth)
  {
    vessel.check = std::make_unique<WireCheck>(vessel.vessel->mesh);
    vessel.wall = contact::WallModel::create(vessel.vessel->mesh);
    return;
  }
  vessel.vessel->mesh = contact::refinedForSmoothWall(std::move(vessel.vessel->mesh));
  vessel.wall = contact::WallModel::create(vessel.vessel->mesh, contact::WallShape::kSmooth);
  const contact::Wall& wall = vessel.wall->wall();
  const contact::SmoothWall& surface = *vessel.wall->smooth();
  std::vector<double> deviations;
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
    deviations.push_back(surface.deviationOf(t));
  const auto large = deviations.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(deviations.size()));
  std::nth_element(deviations.begin(), large, deviations.end());
  const int parts = std::clamp(static_cast<int>(std::lround(std::sqrt(*large / kCheckedSag))), 2, 8);
  vessel.checked = contact::tessellate(surface, parts);
  vessel.check = std::make_unique<WireCheck>(vessel.checked);
}

double narrowest(const vessel::CentrelineTree& tree)
{
  double least = 1.0;
  for (const vessel::CentrelineBranch& branch : tree.branches)
    for (double radius : branch.radii)
      least = std::min(least, radius);
  return least;
}

}  // namespace

FuzzVessels::FuzzVessels(const std::vector<std::string>& mesh_files, bool smooth) : smooth_(smooth)
{
  kinds_ = {"channel", "fork", "channel", "anatomy"};
  for (const std::string& file : mesh_files)
  {
    const std::string name = std::filesystem::path(file).stem().string();
    try
    {
      const std::size_t triangles = readCleanMesh(file).triangles.size();
      kinds_.push_back(name);
      file_of_kind_[name] = file;
      if (static_cast<double>(triangles) > kSmoothedUpTo)
        continue;
      kinds_.push_back(name + " smoothed");
      file_of_kind_[name + " smoothed"] = file;
    }
    catch (const InputError& error)
    {
      skipped_.push_back(name + ": " + error.what());
    }
  }
}

FuzzVessel& FuzzVessels::retain(const std::string& name, vessel::Vessel vessel)
{
  auto made = std::make_unique<FuzzVessel>();
  made->name = name;
  *made->vessel = std::move(vessel);
  setWall(*made, smooth_);
  made->narrowest = narrowest(made->vessel->centreline);
  return *(retained_[name] = std::move(made));
}

FuzzVessel& FuzzVessels::get(const std::string& kind, FuzzRandom& random)
{
  if (kind == "channel")
  {
    channel_ = randomChannel(random);
    setWall(*channel_, smooth_);
    return *channel_;
  }
  const int which = kind == "fork" ? random.integer(0, kForks - 1) : 0;
  const std::string name = kind == "fork" ? "fork_" + std::to_string(which) : kind;
  const auto known = retained_.find(name);
  if (known != retained_.end())
    return *known->second;
  if (kind == "fork")
    return retain(name, forkVessel(which));
  if (kind == "anatomy")
    return retain(name, vessel::loadAnatomy(scene::configFolder() + "/anatomies/natural.yaml"));
  vessel::Vessel vessel;
  vessel.mesh = readCleanMesh(file_of_kind_.at(kind));
  if (kind != std::filesystem::path(file_of_kind_.at(kind)).stem().string())
    vessel.mesh = geometry::loopSubdivision(std::move(vessel.mesh), 1);
  vessel.centreline = vessel::extractCentreline(vessel.mesh);
  return retain(name, std::move(vessel));
}

scene::EntryPose randomEntry(const FuzzVessel& vessel, FuzzRandom& random, double radius, double length)
{
  const double clearance = radius + 0.05e-3;
  if (vessel.name == "channel")
  {
    scene::EntryPose pose;  // the mesh starts behind the origin
    pose.wall_distance = scene::distanceToWall(pose.position, vessel.vessel->mesh);
    return pose;
  }
  const std::vector<vessel::CentrelineEnd> ends = vessel::centrelineEnds(vessel.vessel->centreline);
  for (int attempt = 0; attempt < kTries && !ends.empty(); ++attempt)
  {
    const vessel::CentrelineEnd& end = ends[random.integer(0, static_cast<int>(ends.size()) - 1)];
    scene::EntryPose pose;
    pose.direction = end.inward.normalized();
    pose.position = end.position + random.between(1e-3, 8e-3) * pose.direction;
    pose.d1 = pose.direction.unitOrthogonal();
    bool free = true;
    for (int k = 0; k <= 10 && free; ++k)
      free = vessel.check->signedDistance(pose.position + 0.1 * k * length * pose.direction) > clearance;
    pose.wall_distance = scene::distanceToWall(pose.position, vessel.vessel->mesh);
    if (free)
      return pose;
  }
  throw InputError(vessel.name, "", "no end admits a wire of " + number(1e3 * radius) + " mm radius");
}

}  // namespace endovascular_sim::benchmark
