#include "robot/robot_model.h"

#include <algorithm>
#include <cstddef>

namespace endovascular_sim::robot
{

const Joint* RobotModel::find(const std::string& joint) const
{
  const auto found = std::find_if(joints.begin(), joints.end(), [&joint](const Joint& j) { return j.name == joint; });
  return found == joints.end() ? nullptr : &*found;
}

std::string RobotModel::movableNames() const
{
  std::string names;
  for (const Joint& joint : joints)
    if (joint.isMovable())
      names += (names.empty() ? "" : ", ") + joint.name;
  return names.empty() ? "none" : names;
}

void followMimics(const RobotModel& model, std::vector<double>& own, bool offsets)
{
  std::vector<const Joint*> movable;
  for (const Joint& joint : model.joints)
    if (joint.isMovable())
      movable.push_back(&joint);
  const auto indexOf = [&movable](const std::string& name)
  {
    return static_cast<std::size_t>(
        std::find_if(movable.begin(), movable.end(), [&name](const Joint* joint) { return joint->name == name; }) -
        movable.begin());
  };
  for (std::size_t k = 0; k < movable.size(); ++k)
  {
    // A chain of mimics is one linear function of its last joint; the reader has excluded rings.
    double multiplier = 1.0;
    double offset = 0.0;
    std::size_t leader = k;
    while (movable[leader]->mimic)
    {
      const Mimic& mimic = *movable[leader]->mimic;
      offset += multiplier * mimic.offset;
      multiplier *= mimic.multiplier;
      leader = indexOf(mimic.joint);
    }
    if (leader != k)
      own[k] = multiplier * own[leader] + (offsets ? offset : 0.0);
  }
}

}  // namespace endovascular_sim::robot
