#include "haptics/device/motion_script.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/error.h"
#include "common/input_file.h"

namespace endovascular_sim::haptics
{

MotionScript MotionScript::load(const std::string& file)
{
  std::ifstream stream = openInputFile(file, "give a CSV file of time [s], insertion [m], rotation [rad]");
  MotionScript script;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
  {
    const auto first = std::find_if(line.begin(), line.end(), [](unsigned char c) { return std::isspace(c) == 0; });
    if (first == line.end() || *first == '#' || std::isalpha(static_cast<unsigned char>(*first)) != 0)
      continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    Point point;
    std::string rest;
    if (!(words >> point.time >> point.motion.insertion >> point.motion.rotation) || words >> rest)
      throw InputError(file, "line " + std::to_string(number), "needs three numbers: time, insertion, rotation");
    if (!std::isfinite(point.time + point.motion.insertion + point.motion.rotation))
      throw InputError(file, "line " + std::to_string(number), "every number must be finite");
    if (!script.points_.empty() && point.time <= script.points_.back().time)
      throw InputError(file, "line " + std::to_string(number), "time must increase from row to row");
    script.points_.push_back(point);
  }
  if (script.points_.empty())
    throw InputError(file, "", "contains no row; give at least one of time [s], insertion [m], rotation [rad]");
  return script;
}

HandMotion MotionScript::at(double time) const
{
  const auto next = std::upper_bound(points_.begin(), points_.end(), time,
                                     [](double t, const Point& point) { return t < point.time; });
  if (next == points_.begin())
    return points_.front().motion;
  if (next == points_.end())
    return points_.back().motion;
  const Point& a = *(next - 1);
  const double s = (time - a.time) / (next->time - a.time);
  return {a.motion.insertion + s * (next->motion.insertion - a.motion.insertion),
          a.motion.rotation + s * (next->motion.rotation - a.motion.rotation)};
}

}  // namespace endovascular_sim::haptics
