#pragma once

#include <Eigen/Geometry>

#include "motion/moving_patient.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::motion
{

/** Centreline of the natural anatomy. */
inline const vessel::CentrelineTree& naturalCentreline()
{
  static const vessel::CentrelineTree tree = []
  {
    const vessel::Anatomy anatomy = vessel::readAnatomy(PROJECT_DIR "/config/anatomies/natural.yaml");
    return vessel::anatomyCentreline(anatomy, vessel::sampleChains(anatomy));
  }();
  return tree;
}

inline MotionSettings adultMotion()
{
  return readMotion(PROJECT_DIR "/config/motion/adult.yaml");
}

/** Heart of the natural anatomy. */
inline const HeartFrame& naturalHeart()
{
  static const HeartFrame heart =
      placeHeart(naturalCentreline(), adultMotion().region, {"scene.yaml", "motion.patient."});
  return heart;
}

/** Map of an adult in the natural anatomy. @param heart, breath phases [1] */
inline MotionMap mapAt(double heart, double breath, const HeartFrame& frame, const MotionSettings& settings)
{
  const PatientMotion motion(frame, settings);
  return motion.map(motion.at(heart, settings.heart.rate, breath, settings.breathing.rate));
}

inline MotionMap mapAt(double heart, double breath)
{
  return mapAt(heart, breath, naturalHeart(), adultMotion());
}

/** Phases at end-systole and end-inspiration of an adult. */
inline double endSystole()
{
  const CardiacMotion heart = adultMotion().heart;
  return heart.systolicShare(heart.rate);
}
inline double endInspiration()
{
  return adultMotion().breathing.inspiration;
}

/** Points within a ball around the heart that covers the fade and what is beyond. */
inline std::vector<Eigen::Vector3d> pointsAround(const HeartFrame& frame, int steps = 6)
{
  std::vector<Eigen::Vector3d> points;
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j)
      for (int k = -steps; k <= steps; ++k)
        points.push_back(frame.fade.centre + 1.07 * frame.fade.reach / steps * Eigen::Vector3d(i, j, k));
  return points;
}

inline const vessel::CentrelineBranch& branchNamed(const vessel::CentrelineTree& tree, const std::string& name)
{
  for (const vessel::CentrelineBranch& branch : tree.branches)
    if (branch.name == name)
      return branch;
  throw std::invalid_argument("no branch " + name);
}

}  // namespace endovascular_sim::motion
