#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::yaml
{
class Fields;
}

namespace endovascular_sim::motion
{

constexpr double kLeastHeartRate = 1.0 / 3.0;  ///< [Hz]
constexpr double kLargestHeartRate = 5.0;      ///< [Hz]
constexpr double kLeastBreathingRate = 0.03;   ///< [Hz]
constexpr double kLargestBreathingRate = 1.0;  ///< [Hz]
constexpr double kLeastFade = 0.05;            ///< width of the fade [m]

/** Motion of the heart from end-diastole to end-systole. Rows of the courses: share of the part of the beat;
 * longitudinal motion, radial motion and twist as shares of their amplitudes. */
struct CardiacMotion
{
  double rate = 70.0 / 60.0;         ///< [Hz]
  double systole = 0.463;            ///< from end-diastole to end-systole, extrapolated to a rate of zero [s]
  double systole_per_rate = -0.102;  ///< its change with the rate [s/Hz]
  double base_displacement = 0.012;  ///< of the base towards the apex [m]
  double radial_shortening = 0.06;   ///< of the distances from the axis [1]
  double base_rotation = -0.052;     ///< about the axis, counter-clockwise as seen from the apex [rad]
  double apex_rotation = 0.175;      ///< the same at the apex [rad]
  std::vector<std::vector<double>> contraction = {{0.0, 0.0, 0.0, 0.0},
                                                  {0.15, 0.05, 0.05, 0.03},
                                                  {0.5, 0.5, 0.46, 0.46},
                                                  {0.85, 0.92, 0.92, 0.92},
                                                  {1.0, 1.0, 1.0, 1.0}};
  std::vector<std::vector<double>> relaxation = {
      {0.0, 1.0, 1.0, 1.0},    {0.1, 0.88, 0.9, 0.6},    {0.3, 0.44, 0.4, 0.2}, {0.45, 0.29, 0.24, 0.1},
      {0.6, 0.24, 0.18, 0.07}, {0.75, 0.23, 0.17, 0.06}, {1.0, 0.0, 0.0, 0.0}};

  /** Share of a beat that systole takes [1]. @param beat_rate [Hz] */
  double systolicShare(double beat_rate) const;
};

/** Motion of the heart with a breath, from end-expiration to end-inspiration: rigid. Rows of the courses: share of the
 *  part of the breath; share of the amplitude. */
struct RespiratoryMotion
{
  double rate = 0.25;                                  ///< [Hz]
  double inspiration = 0.4;                            ///< share of a breath [1]
  Eigen::Vector3d translation{0.0, -0.0013, -0.0049};  ///< patient frame: left, posterior, superior [m]
  Eigen::Vector3d rotation{-0.026, 0.021, 0.0};        ///< rotation vector about the middle of the axis [rad]
  double diaphragm = 0.018;                            ///< displacement of the diaphragm towards the feet [m]
  std::vector<std::vector<double>> inhalation = {{0.0, 0.0}, {0.5, 0.5}, {1.0, 1.0}};
  std::vector<std::vector<double>> exhalation = {{0.0, 1.0}, {0.25, 0.55}, {0.5, 0.16}, {0.75, 0.02}, {1.0, 0.0}};
};

/** Region that moves: names of branches that tell where the heart is, or points. */
struct MotionRegion
{
  std::string left_ostium = "left_main";                 ///< branch that begins at the left coronary ostium
  std::string right_ostium = "right_coronary";           ///< branch that begins at the right coronary ostium
  std::string apex_branch = "left_anterior_descending";  ///< branch that ends at the apex
  std::vector<std::string> fixed;                        ///< branches that the motion must not reach
  double fade = kLeastFade;                              ///< distance from full motion to none [m]
  std::optional<Eigen::Vector3d> base, apex;             ///< ends of the axis instead of those of the branches [m]
  std::optional<Eigen::Vector3d> centre;                 ///< of the fade instead of the fitted one [m]
  double core = 0.0;                                     ///< radius of full motion around that centre [m]
};

/** Motion of a patient: heartbeat, breathing, and the region that moves. */
struct MotionSettings
{
  CardiacMotion heart;
  RespiratoryMotion breathing;
  MotionRegion region;
};

/** Schema of a motion: the file of one, and the key `motion.patient` of a scene. */
void visitMotion(yaml::Fields& fields, MotionSettings& motion);

/** Reads a motion.
 *  @throws InputError that names the key, e.g. for an amplitude beyond the fade */
MotionSettings readMotion(const std::string& file);

}  // namespace endovascular_sim::motion
