#include "benchmark/fuzz/fuzz_motion.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kAmplitude = 0.01;     // m
constexpr double kRate = 1.5;           // Hz
constexpr double kBeyondEntry = 0.012;  // between the introducer and the fade [m]
constexpr double kGuide = 0.02;         // of the introducer, before its mouth [m]
constexpr double kLongestFacet = 4e-3;  // edges beyond count with this length: their middles are off the wall [m]
constexpr int kTries = 50;

Eigen::Vector3d randomDirection(FuzzRandom& random)
{
  for (;;)
  {
    const Eigen::Vector3d v(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    if (v.norm() > 0.1 && v.norm() < 1.0)
      return v.normalized();
  }
}

/** Point of the centreline far from the entry, at random. */
Eigen::Vector3d farPoint(const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry, FuzzRandom& random)
{
  Eigen::Vector3d farthest = entry;
  for (int k = 0; k < 8; ++k)
  {
    const auto& branch = tree.branches[random.integer(0, static_cast<int>(tree.branches.size()) - 1)];
    const Eigen::Vector3d& point = branch.points[random.integer(0, static_cast<int>(branch.points.size()) - 1)];
    if ((point - entry).norm() > (farthest - entry).norm())
      farthest = point;
  }
  return farthest;
}

motion::MotionSettings randomSettings(const FuzzVessel& vessel, const scene::EntryPose& entry, FuzzRandom& random)
{
  motion::MotionSettings settings;
  settings.heart.rate = kRate;
  settings.heart.base_displacement = kAmplitude;
  settings.heart.radial_shortening = random.between(-0.05, 0.15);
  settings.heart.base_rotation = random.between(-0.1, 0.1);
  settings.heart.apex_rotation = random.between(-0.2, 0.2);
  settings.breathing.rate = 0.5;
  const double core = random.between(1e-3, 0.03);
  const double reach = core + settings.region.fade;
  const Eigen::Vector3d towards =
      (farPoint(vessel.vessel->centreline, entry.position, random) - entry.position).normalized();
  const double distance = reach + kBeyondEntry + kGuide;
  settings.region.centre = entry.position + distance * towards;
  settings.region.core = core;
  settings.region.base = *settings.region.centre - 0.04 * randomDirection(random);
  settings.region.apex = *settings.region.base + 0.08 * randomDirection(random);
  return settings;
}

}  // namespace

simulation::PatientMotion randomMotion(const FuzzVessel& vessel, const scene::EntryPose& entry, double time_step,
                                       FuzzRandom& random)
{
  for (int attempt = 0; attempt < kTries; ++attempt)
  {
    const motion::MotionSettings settings = randomSettings(vessel, entry, random);
    try
    {
      motion::MovingPatient patient =
          motion::makeMovingPatient(vessel.vessel->centreline, settings, time_step, {"fuzz", ""});
      patient.setHeartPhase(random.unit(), kRate);
      const motion::MapBounds bounds =
          motion::motionBounds(patient.motion(), motion::lumenPoints(vessel.vessel->centreline));
      return {patient, bounds};
    }
    catch (const InputError&)
    {
      continue;  // it folds space
    }
  }
  throw InputError(vessel.name, "", "no motion fits");
}

void MovedVesselCheck::move(const motion::MotionMap& map)
{
  map.positions(mesh_.vertices, moved_.vertices);
}

double MovedVesselCheck::bruteSignedDistance(const motion::MotionMap& map, const Eigen::Vector3d& point)
{
  move(map);
  return WireCheck(moved_).bruteSignedDistance(point);
}

WireFinding MovedVesselCheck::check(const motion::MotionMap& map, std::vector<CheckedNode> nodes)
{
  move(map);
  const double facet = bounds_.sag(kLongestFacet);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    double longest = 0.0;
    if (i > 0)
      longest = (nodes[i].position - nodes[i - 1].position).norm();
    if (i + 1 < nodes.size())
      longest = std::max(longest, (nodes[i + 1].position - nodes[i].position).norm());
    if (!map.outside(nodes[i].position))
      nodes[i].allowance += bounds_.sag(longest) + facet;
  }
  return WireCheck(moved_).check(nodes);
}

}  // namespace endovascular_sim::benchmark
