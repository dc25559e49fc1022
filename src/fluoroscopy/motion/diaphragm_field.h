#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/map/motion_field.h"

namespace endovascular_sim::fluoroscopy
{

/** Share of the diaphragm's displacement that a point of the body takes: g(x) = (1 − w(x)) Σ s(ρ²) p(z) over both
 * domes.
 *
 *  w is the weight of the heart's fade: the heart and its surroundings follow the heart's map alone. ρ is the distance
 *  from the axis of a dome in units of its semi-axes; s is 1 for ρ² ≤ 0.2 and 0 from ρ = 1 on. p is 1 from below the
 *  dome at full inspiration to above the dome at rest, and fades to 0 within the lung above and the abdomen below.
 *  Fades are the C² polynomial of motion::Fade. Where the domes are follows from the heart, in the ratios of the
 *  procedural body: the axis of the heart scales all lengths. */
class DiaphragmField
{
public:
  /** Dome of one side. */
  struct Dome
  {
    Eigen::Vector3d top = Eigen::Vector3d::Zero();  ///< highest point at rest [m]
    double half_width = 0.0;                        ///< semi-axis to the sides [m]
    double half_depth = 0.0;                        ///< semi-axis to front and back [m]
    double low = 0.0, high = 0.0;                   ///< heights between which p is 1 [m]
    double fade = 0.0;                              ///< height of the fade above and below [m]

    /** Box outside of which nothing moves [m]. */
    Eigen::AlignedBox3d box() const;
  };

  explicit DiaphragmField(const motion::HeartFrame& frame);

  /** Weight g at a point of the patient [1]. */
  double weight(const Eigen::Vector3d& point) const;

  const std::array<Dome, 2>& domes() const { return domes_; }

private:
  motion::Fade heart_;
  std::array<Dome, 2> domes_;
};

}  // namespace endovascular_sim::fluoroscopy
