#include "motion/cycle/time_course.h"

#include <algorithm>
#include <stdexcept>

namespace endovascular_sim::motion
{
namespace
{

void checkPoints(const CoursePoints& points, double first, double last)
{
  const std::vector<double>&t = points.times, &y = points.values;
  if (t.size() < 2 || t.size() != y.size() || t.front() != 0.0 || t.back() != 1.0)
    throw std::invalid_argument("a time course needs points from time 0 to time 1");
  if (y.front() != first || y.back() != last)
    throw std::invalid_argument("a time course rises from 0 to 1 and falls from 1 to 0");
  for (std::size_t k = 1; k < t.size(); ++k)
    if (!(t[k] > t[k - 1]))
      throw std::invalid_argument("the times of a time course must ascend");
}

}  // namespace

TimeCourse::TimeCourse(const CoursePoints& rise, const CoursePoints& fall)
  : rise_(interpolated(rise, 0.0, 1.0)), fall_(interpolated(fall, 1.0, 0.0))
{
}

TimeCourse::Part TimeCourse::interpolated(const CoursePoints& points, double first, double last)
{
  checkPoints(points, first, last);
  Part part{points.times, points.values, std::vector<double>(points.times.size(), 0.0)};
  for (std::size_t k = 1; k + 1 < part.times.size(); ++k)
  {
    const double before = part.times[k] - part.times[k - 1], after = part.times[k + 1] - part.times[k];
    const double left = (part.values[k] - part.values[k - 1]) / before;
    const double right = (part.values[k + 1] - part.values[k]) / after;
    if (left * right > 0.0)  // weighted harmonic mean: monotone (Fritsch & Butland 1984)
      part.slopes[k] = 3.0 * (before + after) / ((2.0 * after + before) / left + (after + 2.0 * before) / right);
  }
  return part;
}

TimeCourse::Sample TimeCourse::Part::at(double time) const
{
  std::size_t k = 1;
  while (k + 1 < times.size() && time > times[k])
    ++k;
  const double width = times[k] - times[k - 1];
  const double t = std::clamp((time - times[k - 1]) / width, 0.0, 1.0);
  const double rise = values[k] - values[k - 1], begin = width * slopes[k - 1], end = width * slopes[k];
  const double square = 3.0 * rise - 2.0 * begin - end, cube = begin + end - 2.0 * rise;
  Sample sample;
  sample.value = t < 1.0 ? values[k - 1] + t * (begin + t * (square + t * cube)) : values[k];
  sample.slope = (begin + t * (2.0 * square + 3.0 * t * cube)) / width;
  return sample;
}

TimeCourse::Sample TimeCourse::at(double phase, double rise) const
{
  const bool rises = phase < rise;
  const double length = rises ? rise : 1.0 - rise;
  Sample sample = rises ? rise_.at(phase / length) : fall_.at((phase - rise) / length);
  sample.slope /= length;
  return sample;
}

}  // namespace endovascular_sim::motion
