#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include <Eigen/Core>

namespace endovascular_sim::results
{

/** One row of trajectory.csv. */
struct TrajectoryRow
{
  double time = 0.0;                              ///< simulated [s]
  double insertion = 0.0;                         ///< [m]
  double rotation = 0.0;                          ///< [rad]
  double hand_force = 0.0;                        ///< [N]
  double hand_torque = 0.0;                       ///< [N·m]
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< patient frame [m]
  std::size_t nodes = 0;                          ///< nodes beyond the introducer
  double pressure = 0.0;                          ///< largest at the inflators of balloons [Pa]
};

/** The head line of trajectory.csv. */
constexpr auto kTrajectoryColumns = "time,insertion,rotation,hand_force,hand_torque,tip_x,tip_y,tip_z,nodes,pressure";

/** One row as text, numbers with all their digits, without the line's end. */
std::string toCsv(const TrajectoryRow& row);

/** Writes trajectory.csv with at most a given number of rows per simulated second. */
class TrajectoryFile
{
public:
  /** @param file path; @param rate rows per second [Hz]
   *  @throws InputError when the file cannot be written */
  TrajectoryFile(const std::string& file, double rate);

  /** Writes the row, or leaves it out when its slot is taken. @return false when the disk refused it */
  bool add(const TrajectoryRow& row);

  /** Hands everything to the operating system. @return false when the disk refused it */
  bool flush();

private:
  std::ofstream stream_;
  double rate_;
  double last_slot_ = -1.0;
};

}  // namespace endovascular_sim::results
