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
  double time = 0.0;                              ///< simulated time [s]
  double insertion = 0.0;                         ///< insertion at the handle [m]
  double rotation = 0.0;                          ///< rotation at the handle [rad]
  double hand_force = 0.0;                        ///< rendered force [N]
  double hand_torque = 0.0;                       ///< rendered torque [N·m]
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip in the patient frame [m]
  std::size_t nodes = 0;                          ///< number of nodes beyond the introducer
  double pressure = 0.0;                          ///< largest pressure at the inflators of balloons [Pa]
  double tip_rotation = 0.0;                      ///< rotation of the material at the tip [rad]
};

/** Header of trajectory.csv. */
constexpr auto kTrajectoryColumns =
    "time,insertion,rotation,hand_force,hand_torque,tip_x,tip_y,tip_z,nodes,pressure,tip_rotation";

/** Text of a row without line break; numbers are written with all digits. */
std::string toCsv(const TrajectoryRow& row);

/** Writer of trajectory.csv with at most a given number of rows per simulated second. */
class TrajectoryFile
{
public:
  /** @param file path of the file
   *  @param rate rows per simulated second [Hz]
   *  @throws InputError if the file cannot be written */
  TrajectoryFile(const std::string& file, double rate);

  /** Writes a row if it is the first one in its time slot.
   *  @return false on failure, and when the file was removed meanwhile; errno is then the reason */
  bool add(const TrajectoryRow& row);

  /** Flushes the file to the operating system. @return false on failure */
  bool flush();

  /** File, reason and remedy of the first failure; empty without one. */
  const std::string& error() const { return error_; }

private:
  bool isGood();

  std::string file_;
  std::string error_;
  std::ofstream stream_;
  double rate_;
  double last_slot_ = -1.0;
};

}  // namespace endovascular_sim::results
