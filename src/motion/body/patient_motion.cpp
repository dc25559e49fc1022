#include "motion/body/patient_motion.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

CoursePoints column(const std::vector<std::vector<double>>& rows, std::size_t index)
{
  CoursePoints points;
  for (const std::vector<double>& row : rows)
  {
    points.times.push_back(row.at(0));
    points.values.push_back(row.at(index));
  }
  return points;
}

/** Matrix of the cross product with a vector. */
Matrix3d crossMatrix(const Vector3d& a)
{
  Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

}  // namespace

PatientMotion::PatientMotion(const HeartFrame& frame, const MotionSettings& settings)
  : frame_(frame),
    settings_(settings),
    longitudinal_(column(settings.heart.contraction, 1), column(settings.heart.relaxation, 1)),
    radial_(column(settings.heart.contraction, 2), column(settings.heart.relaxation, 2)),
    twist_(column(settings.heart.contraction, 3), column(settings.heart.relaxation, 3)),
    breath_(column(settings.breathing.inhalation, 1), column(settings.breathing.exhalation, 1))
{
}

PatientMotion::Instant PatientMotion::at(double heart_phase, double heart_rate, double breath_phase,
                                         double breath_speed) const
{
  const double systole = settings_.heart.systolicShare(heart_rate);
  const TimeCourse::Sample longitudinal = longitudinal_.at(heart_phase, systole);
  const TimeCourse::Sample radial = radial_.at(heart_phase, systole);
  const TimeCourse::Sample twist = twist_.at(heart_phase, systole);
  const TimeCourse::Sample breath = breath_.at(breath_phase, settings_.breathing.inspiration);
  return {{longitudinal.value, radial.value, twist.value, breath.value},
          {longitudinal.slope * heart_rate, radial.slope * heart_rate, twist.slope * heart_rate,
           breath.slope * breath_speed}};
}

MotionField PatientMotion::heartField(const MotionShares& shares) const
{
  const CardiacMotion& heart = settings_.heart;
  const Vector3d& a = frame_.axis;
  const double descent = heart.base_displacement * shares.longitudinal;
  MotionField field;
  field.shift = descent * a;
  field.linear = -descent / frame_.length * (a * a.transpose()) -
                 heart.radial_shortening * shares.radial * (Matrix3d::Identity() - a * a.transpose()) +
                 heart.base_rotation * shares.twist * crossMatrix(a);
  field.twist = (heart.apex_rotation - heart.base_rotation) * shares.twist / frame_.length;
  return field;
}

void PatientMotion::addBreath(double share, double rate, MotionField& field, MotionField& field_rate) const
{
  // Rotation of the unnormalised quaternion (1, half): rational in the share, exactly orthogonal.
  const Vector3d axis = 0.5 * settings_.breathing.rotation;
  const Vector3d half = share * axis;
  const double norm = 1.0 + half.squaredNorm();
  const Matrix3d numerator =
      2.0 * (half * half.transpose() - half.squaredNorm() * Matrix3d::Identity() + crossMatrix(half));
  const Matrix3d turned = numerator / norm;  // rotation minus the identity
  const Matrix3d slope = (2.0 * (axis * half.transpose() + half * axis.transpose() -
                                 2.0 * axis.dot(half) * Matrix3d::Identity() + crossMatrix(axis)) -
                          turned * (2.0 * axis.dot(half))) /
                         norm;
  const Vector3d from_middle = -0.5 * frame_.length * frame_.axis;  // base − middle of the axis
  field.linear += turned;
  field.shift += turned * from_middle + share * settings_.breathing.translation;
  field_rate.linear += rate * slope;
  field_rate.shift += rate * (slope * from_middle + settings_.breathing.translation);
}

MotionMap PatientMotion::map(const Instant& instant) const
{
  MotionField field = heartField(instant.shares), rate = heartField(instant.rates);
  addBreath(instant.shares.breath, instant.rates.breath, field, rate);
  return {frame_, field, rate};
}

}  // namespace endovascular_sim::motion
