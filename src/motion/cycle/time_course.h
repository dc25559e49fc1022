#pragma once

#include <vector>

namespace endovascular_sim::motion
{

/** Part of a cycle: times as shares of the part, and values [1]. */
struct CoursePoints
{
  std::vector<double> times;   ///< ascending, from 0 to 1
  std::vector<double> values;  ///< one for each time
};

/** Time course of a motion over a cycle: a rise from 0 to 1 (systole, inspiration) and a fall back to 0.
 *
 *  Between the points monotone cubics are used, level at both ends (Fritsch & Carlson 1980): the course has no
 * overshoot, and its slope is continuous, also where the parts meet. Only + − × ÷ are used, so that the bits are those
 * of every machine. */
class TimeCourse
{
public:
  /** @throws std::invalid_argument unless both parts have ascending times from 0 to 1, the rise values from 0 to 1 and
   * the fall values from 1 to 0 */
  TimeCourse(const CoursePoints& rise, const CoursePoints& fall);

  /** Value and derivative at a phase. */
  struct Sample
  {
    double value = 0.0;  ///< [1]
    double slope = 0.0;  ///< derivative by the phase [1]
  };
  /** @param phase in [0, 1]
   *  @param rise share of the cycle that the rise takes, in (0, 1) */
  Sample at(double phase, double rise) const;

private:
  struct Part
  {
    std::vector<double> times, values, slopes;
    Sample at(double time) const;
  };
  static Part interpolated(const CoursePoints& points, double first, double last);

  Part rise_, fall_;
};

}  // namespace endovascular_sim::motion
