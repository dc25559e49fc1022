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
constexpr double kGrid = 0.01;          // of the check for folds [m]
constexpr double kLeastVolume = 0.2;    // as for scenes: least det ∇φ [1]
constexpr double kRoundTrip = 1e-9;     // as for scenes: largest error of pulling back [m]
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

motion::MotionSettings randomSettings(FuzzRandom& random)
{
  motion::MotionSettings settings;
  settings.heart.rate = kRate;
  settings.heart.base_displacement = kAmplitude;
  settings.heart.radial_shortening = random.between(-0.05, 0.15);
  settings.heart.base_rotation = random.between(-0.1, 0.1);
  settings.heart.apex_rotation = random.between(-0.2, 0.2);
  settings.breathing.rate = 0.5;
  return settings;
}

/** Heart beside the introducer: its motion begins beyond it, on the way to the far end of the vessel. */
motion::HeartFrame randomHeart(const FuzzVessel& vessel, const scene::EntryPose& entry, FuzzRandom& random)
{
  motion::HeartFrame frame;
  frame.fade.core = random.between(1e-3, 0.03);
  frame.fade.reach = frame.fade.core + motion::kLeastFade;
  const Eigen::Vector3d far = farPoint(vessel.vessel->centreline, entry.position, random);
  frame.fade.centre = entry.position + (frame.fade.reach + kBeyondEntry + kGuide) * (far - entry.position).normalized();
  frame.base = frame.fade.centre - 0.04 * randomDirection(random);
  frame.axis = randomDirection(random);
  frame.length = 0.08;
  return frame;
}

}  // namespace

simulation::PatientMotion randomMotion(const FuzzVessel& vessel, const scene::EntryPose& entry, double time_step,
                                       FuzzRandom& random)
{
  for (int attempt = 0; attempt < kTries; ++attempt)
  {
    const motion::MotionSettings settings = randomSettings(random);
    const motion::HeartFrame frame = randomHeart(vessel, entry, random);
    motion::MovingPatient patient(frame, settings, time_step);
    motion::MapBounds bounds = motion::motionBounds(patient.motion(), motion::gridOf(frame.fade, kGrid));
    if (bounds.determinant < kLeastVolume || bounds.round_trip > kRoundTrip)
      continue;  // it folds space
    patient.setHeartPhase(random.unit(), kRate);
    bounds.include(motion::motionBounds(patient.motion(), motion::lumenPoints(vessel.vessel->centreline)));
    return {patient, bounds};
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
