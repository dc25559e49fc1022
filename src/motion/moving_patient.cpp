#include "motion/moving_patient.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "common/archive.h"
#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::motion
{
namespace
{

constexpr int kHeartPhases = 16;      // of the check
constexpr int kGridPerFade = 6;       // of the check
constexpr double kLeastVolume = 0.2;  // least det ∇φ
constexpr double kRoundTrip = 1e-9;   // largest error of pulling back [m]

void checkRate(double rate, double least, double largest, const char* key)
{
  if (!(rate >= least && rate <= largest))
    throw std::invalid_argument(formatted("%s: %.4g Hz = %.4g per minute; must be between %.4g and %.4g per minute",
                                          key, rate, 60.0 * rate, 60.0 * least, 60.0 * largest));
}

void checkPhase(double phase, const char* key)
{
  if (!(phase >= 0.0 && phase < 1.0))
    throw std::invalid_argument(formatted("%s: %.4g; must be at least 0 and less than 1", key, phase));
}

}  // namespace

MovingPatient::MovingPatient(const HeartFrame& frame, const MotionSettings& settings, double time_step)
  : motion_(frame, settings),
    time_step_(time_step),
    heart_(settings.heart.rate),
    breath_(settings.breathing.rate),
    map_(frame, {}, {})
{
  update();
}

void MovingPatient::update()
{
  const PatientMotion::Instant instant = motion_.at(heart_.phase(), heart_.rate(), breath_.phase(), breath_.speed());
  shares_ = instant.shares;
  map_ = motion_.map(instant);
}

void MovingPatient::advance()
{
  heart_.advance(time_step_);
  breath_.advance(time_step_);
  update();
}

void MovingPatient::advanceWithHeart(double phase, double rate)
{
  checkPhase(phase, "phase of the heart");
  checkRate(rate, kLeastHeartRate, kLargestHeartRate, "heart.rate");
  heart_.hold(false);
  heart_.set(phase, rate);
  breath_.advance(time_step_);
  update();
}

void MovingPatient::advanceInArrest()
{
  heart_.hold(true);
  advance();
}

void MovingPatient::setHeartRate(double rate)
{
  checkRate(rate, kLeastHeartRate, kLargestHeartRate, "heart.rate");
  heart_.setRate(rate);
}

void MovingPatient::setBreathingRate(double rate)
{
  checkRate(rate, kLeastBreathingRate, kLargestBreathingRate, "breathing.rate");
  breath_.setRate(rate);
}

void MovingPatient::setControls(const MotionControls& controls)
{
  const std::string refusal = refusalOf(controls);
  if (!refusal.empty())
    throw std::invalid_argument(refusal);
  heart_.setRate(controls.heart_rate);
  breath_.setRate(controls.breathing_rate);
  breath_.hold(controls.breath_held);
}

void MovingPatient::setHeartPhase(double phase, double rate)
{
  checkPhase(phase, "phase of the heart");
  checkRate(rate, kLeastHeartRate, kLargestHeartRate, "heart.rate");
  heart_.set(phase, rate);
  update();
}

void MovingPatient::setBreathPhase(double phase, double rate)
{
  checkPhase(phase, "phase of the breath");
  checkRate(rate, kLeastBreathingRate, kLargestBreathingRate, "breathing.rate");
  breath_.set(phase, rate);
  update();
}

void MovingPatient::archive(Archive& archive)
{
  archive(heart_, breath_);
  if (archive.reading())
    update();
}

MapBounds motionBounds(const PatientMotion& motion, const std::vector<Eigen::Vector3d>& points)
{
  const MotionSettings& settings = motion.settings();
  MapBounds bounds;
  for (int beat = 0; beat < kHeartPhases; ++beat)
    for (const double breath : {0.0, settings.breathing.inspiration})
    {
      const double phase = static_cast<double>(beat) / kHeartPhases;
      bounds.include(
          mapBounds(motion.map(motion.at(phase, settings.heart.rate, breath, settings.breathing.rate)), points));
    }
  return bounds;
}

std::vector<Eigen::Vector3d> lumenPoints(const vessel::CentrelineTree& tree)
{
  std::vector<Eigen::Vector3d> points;
  for (const vessel::CentrelineBranch& branch : tree.branches)
    for (std::size_t k = 0; k < branch.points.size(); ++k)
    {
      points.push_back(branch.points[k]);
      for (int i = 0; i < 3; ++i)
        for (const double side : {-1.0, 1.0})
          points.emplace_back(branch.points[k] + side * branch.radii[k] * Eigen::Vector3d::Unit(i));
    }
  return points;
}

MovingPatient makeMovingPatient(const vessel::CentrelineTree& tree, const MotionSettings& settings, double time_step,
                                const MotionSource& source)
{
  const HeartFrame frame = placeHeart(tree, settings.region, source);
  const MapBounds bounds =
      motionBounds(PatientMotion(frame, settings), gridOf(frame.fade, frame.fade.width() / kGridPerFade));
  if (!(bounds.determinant >= kLeastVolume) || !(bounds.round_trip <= kRoundTrip))
    throw InputError(source.file, source.prefix + "heart",
                     formatted("the motion folds space, or nearly so: det ∇φ falls to %.2g, must stay above %.2g, with "
                               "displacements of up to %.3g mm; give smaller displacements and rotations of heart and "
                               "breathing, or a larger region.fade than %.3g",
                               bounds.determinant, kLeastVolume, 1e3 * bounds.displacement, settings.region.fade));
  return {frame, settings, time_step};
}

}  // namespace endovascular_sim::motion
