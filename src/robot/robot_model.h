#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drive/drive_limits.h"

namespace endovascular_sim::robot
{

enum class JointKind
{
  kFixed,
  kPrismatic,   ///< positions in m, efforts in N
  kRevolute,    ///< positions in rad, efforts in N·m
  kContinuous,  ///< as kRevolute, without a limit of the position
  kOther,       ///< planar or floating
};

/** Coupling of a joint to another one: position = multiplier · (position of the other) + offset. */
struct Mimic
{
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

/** Joint of a robot. */
struct Joint
{
  std::string name;
  JointKind kind = JointKind::kFixed;
  int line = 0;                          ///< line of the URDF
  std::optional<drive::Interval> range;  ///< positions; empty: no limit
  std::optional<double> speed;           ///< largest speed; empty: no limit
  std::optional<double> effort;          ///< largest force or torque; empty: no limit
  std::optional<Mimic> mimic;

  /** True for a joint with one position: prismatic, revolute or continuous. */
  bool isMovable() const { return kind != JointKind::kFixed && kind != JointKind::kOther; }
};

/** Robot of a URDF. */
struct RobotModel
{
  std::string file;
  std::string name;
  std::string urdf;                   ///< text of the file
  std::string root_link;              ///< link without a parent
  std::vector<std::string> links;     ///< in the order of the file
  std::vector<Joint> joints;          ///< all joints in the order of the file
  std::vector<std::string> warnings;  ///< parts of the file that have no effect, each with file, line and remedy

  /** Joint with a name; null if there is none. */
  const Joint* find(const std::string& joint) const;

  /** Names of the movable joints, with commas, for messages. */
  std::string movableNames() const;
};

/** Positions, or velocities, of all movable joints in the order of the model, with those of mimic joints.
 *  @param own values of the joints without mimic; those of mimic joints are replaced
 *  @param offsets true for positions, false for velocities */
void followMimics(const RobotModel& model, std::vector<double>& own, bool offsets);

}  // namespace endovascular_sim::robot
