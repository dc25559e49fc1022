#pragma once

#include <cmath>

#include "fluoroscopy/motion/body_motion.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "test/motion/motion_fixtures.h"
#include "test/patient/volume_shapes.h"

namespace endovascular_sim::fluoroscopy
{

/** Motion of an adult with the heart of the natural anatomy. @param heart, breath phases [1] */
inline BodyMotion motionAt(double heart, double breath)
{
  const motion::MotionSettings settings = motion::adultMotion();
  const motion::PatientMotion motion(motion::naturalHeart(), settings);
  const motion::PatientMotion::Instant instant = motion.at(heart, settings.heart.rate, breath, settings.breathing.rate);
  return {motion.map(instant), instant.shares.breath * settings.breathing.diaphragm};
}

/** Motion at end-systole and end-inspiration. */
inline BodyMotion largestMotion()
{
  return motionAt(motion::endSystole(), motion::endInspiration());
}

/** Smooth body around the heart: a ball of tissue in lungs, waves within, and a dome below. */
inline patient::DensityVolume smoothBody(int side, double spacing)
{
  const motion::HeartFrame& heart = motion::naturalHeart();
  const Eigen::Vector3d middle = 0.5 * (heart.base + heart.apex());
  patient::DensityVolume volume(patient::cubicGrid(side, spacing, middle));
  const image::VolumeGrid grid = volume.grid();
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
      {
        const Eigen::Vector3d p = grid.position(Eigen::Vector3d(x, y, z)) - middle;
        const double ball = 1.0 / (1.0 + std::exp((p.norm() - 0.05) / 0.006));
        const double dome = 1.0 / (1.0 + std::exp((p.z() + 0.02) / 0.008));
        const double waves = 0.5 + 0.25 * std::sin(p.x() / 0.011) + 0.25 * std::cos((p.y() - p.z()) / 0.013);
        volume.set(x, y, z, {260.0 + 600.0 * std::max(ball, dome) + 150.0 * waves, 0.0});
      }
  return volume;
}

/** View of the heart. @param pixels per side */
inline CArmPose heartView(double primary_angle, double secondary_angle, int pixels)
{
  CArmPose pose;
  pose.primary_angle = primary_angle;
  pose.secondary_angle = secondary_angle;
  pose.isocentre = 0.5 * (motion::naturalHeart().base + motion::naturalHeart().apex());
  pose.pixels = pixels;
  return pose;
}

/** Root of the mean square of numbers. */
inline double rootMeanSquare(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float value : values)
    sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

inline std::vector<float> difference(const std::vector<float>& a, const std::vector<float>& b)
{
  std::vector<float> result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    result[k] = a[k] - b[k];
  return result;
}

inline double largestOf(const std::vector<float>& values)
{
  double largest = 0.0;
  for (const float value : values)
    largest = std::max(largest, static_cast<double>(std::abs(value)));
  return largest;
}

}  // namespace endovascular_sim::fluoroscopy
