#include "motion/body/motion_settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/quantities.h"
#include "common/text/format.h"
#include "motion/cycle/time_course.h"
#include "yaml/reader.h"

namespace endovascular_sim::motion
{
namespace
{

using yaml::Need;
using yaml::Range;

constexpr double kShortestSystole = 0.17;  // [s]
constexpr double kLongestSystole = 0.6;    // share of a beat

/** Refuses rows that are no course of a motion. @param motions columns after the times */
void checkCourse(const yaml::Fields& fields, const std::string& rise_key, const std::string& fall_key,
                 const std::vector<std::vector<double>>& rise, const std::vector<std::vector<double>>& fall)
{
  for (const bool rises : {true, false})
  {
    const std::vector<std::vector<double>>& rows = rises ? rise : fall;
    const std::string& key = rises ? rise_key : fall_key;
    bool valid = rows.size() >= 2;
    for (std::size_t k = 0; valid && k < rows.size(); ++k)
    {
      valid = k == 0 ? rows[k][0] == 0.0 : rows[k][0] > rows[k - 1][0];
      for (std::size_t column = 1; valid && column < rows[k].size(); ++column)
      {
        const bool first = k == 0, last = k + 1 == rows.size();
        valid = (!first || rows[k][column] == (rises ? 0.0 : 1.0)) && (!last || rows[k][column] == (rises ? 1.0 : 0.0));
      }
    }
    if (!valid || rows.back()[0] != 1.0)
      fields.reject(key, std::string("times must ascend from 0 to 1, and values go from ") +
                             (rises ? "0 to 1, e.g. [[0, 0], [1, 1]]" : "1 to 0, e.g. [[0, 1], [1, 0]]") +
                             " with a value for each motion");
  }
}

/** Refuses an amplitude for which no fade of that width is without folds: the weight's slope is 1.875 per width. */
void checkAmplitude(const yaml::Fields& fields, const std::string& key, double amplitude, double fade)
{
  const double largest = fade / 1.875;
  if (std::abs(amplitude) >= largest)
    fields.reject(key, formatted("%.4g m is beyond the fade, which would fold space; give less than %.4g, or a larger "
                                 "region.fade than %.4g",
                                 std::abs(amplitude), largest, fade));
}

void visitHeart(yaml::Fields& fields, CardiacMotion& heart)
{
  const std::vector<Quantity> columns = {quantities::kFraction, quantities::kFraction, quantities::kFraction,
                                         quantities::kFraction};
  fields.number("rate", heart.rate, quantities::kHeartRate, Range::between(kLeastHeartRate, kLargestHeartRate));
  fields.number("systole", heart.systole, quantities::kPulseTime, Range::between(0.2, 1.0));
  fields.number("systole_per_rate", heart.systole_per_rate, quantities::kNumber, Range::between(-0.5, 0.0));
  fields.number("base_displacement", heart.base_displacement, quantities::kDisplacement, Range::between(0.0, 0.05));
  fields.number("radial_shortening", heart.radial_shortening, quantities::kFraction, Range::between(0.0, 0.4));
  fields.number("base_rotation", heart.base_rotation, quantities::kAngle, Range::between(-0.7, 0.7));
  fields.number("apex_rotation", heart.apex_rotation, quantities::kAngle, Range::between(-0.7, 0.7));
  fields.rows("contraction", heart.contraction, columns);
  fields.rows("relaxation", heart.relaxation, columns);
  if (fields.reading())
    checkCourse(fields, "contraction", "relaxation", heart.contraction, heart.relaxation);
}

void visitBreathing(yaml::Fields& fields, RespiratoryMotion& breathing)
{
  const std::vector<Quantity> columns = {quantities::kFraction, quantities::kFraction};
  fields.number("rate", breathing.rate, quantities::kFrequency,
                Range::between(kLeastBreathingRate, kLargestBreathingRate));
  fields.number("inspiration", breathing.inspiration, quantities::kFraction, Range::between(0.1, 0.9));
  fields.vector3("translation", breathing.translation, quantities::kDisplacement);
  fields.vector3("rotation", breathing.rotation, quantities::kAngle);
  fields.number("diaphragm", breathing.diaphragm, quantities::kDisplacement, Range::between(0.0, 0.15));
  fields.rows("inhalation", breathing.inhalation, columns);
  fields.rows("exhalation", breathing.exhalation, columns);
  if (fields.reading())
  {
    checkCourse(fields, "inhalation", "exhalation", breathing.inhalation, breathing.exhalation);
    if (breathing.rotation.norm() > 0.5)
      fields.reject("rotation", "must be at most 0.5 rad; published values are below 0.06");
  }
}

void visitPoint(yaml::Fields& fields, const std::string& key, std::optional<Eigen::Vector3d>& point)
{
  if (!(fields.reading() ? fields.has(key) : point.has_value()))
    return;
  Eigen::Vector3d value = point.value_or(Eigen::Vector3d::Zero());
  fields.vector3(key, value, quantities::kPosition);
  point = value;
}

void visitRegion(yaml::Fields& fields, MotionRegion& region)
{
  fields.text("left_ostium", region.left_ostium);
  fields.text("right_ostium", region.right_ostium);
  fields.text("apex_branch", region.apex_branch);
  fields.list(
      "fixed", region.fixed.size(), [&region](std::size_t size) { region.fixed.resize(size); },
      [&region](yaml::Fields& item, std::size_t k) { item.text("branch", region.fixed[k], Need::kRequired); });
  fields.number("fade", region.fade, quantities::kVesselLength, Range::between(kLeastFade, 0.5));
  visitPoint(fields, "base", region.base);
  visitPoint(fields, "apex", region.apex);
  visitPoint(fields, "centre", region.centre);
  if (region.centre)
    fields.number("core", region.core, quantities::kVesselLength, Range::positiveUpTo(0.5), Need::kRequired);
  if (fields.reading() && region.base.has_value() != region.apex.has_value())
    fields.reject(region.base ? "apex" : "base", "missing; give both ends of the heart's axis, or none of them");
}

}  // namespace

double CardiacMotion::systolicShare(double beat_rate) const
{
  const double duration = std::max(systole + systole_per_rate * beat_rate, kShortestSystole);
  return std::min(duration * beat_rate, kLongestSystole);
}

void visitMotion(yaml::Fields& fields, MotionSettings& motion)
{
  fields.map("heart", [&motion](yaml::Fields& heart) { visitHeart(heart, motion.heart); });
  fields.map("breathing", [&motion](yaml::Fields& breathing) { visitBreathing(breathing, motion.breathing); });
  fields.map("region", [&motion](yaml::Fields& region) { visitRegion(region, motion.region); });
  if (!fields.reading())
    return;
  checkAmplitude(fields, "heart.base_displacement", motion.heart.base_displacement, motion.region.fade);
  checkAmplitude(fields, "breathing.translation", motion.breathing.translation.norm(), motion.region.fade);
}

MotionSettings readMotion(const std::string& file)
{
  const yaml::Node root = yaml::readTree(file, "give the path of a motion, or the name of one of config/motion");
  yaml::Reader reader(root, nullptr);
  MotionSettings motion;
  visitMotion(reader, motion);
  reader.finish();
  return motion;
}

}  // namespace endovascular_sim::motion
