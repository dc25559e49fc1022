#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <ros/ros.h>
#include <Eigen/Core>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/WallDisplacement.h"
#include "endovascular_sim/WallState.h"
#include "intervention/deformable_wall.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/one_source.h"

namespace endovascular_sim::nodes
{

/** Deformable wall of vessel_server, behind its topics.
 *
 *  vessel_server publishes displacements to the contact node. The contact node defers its response until it has the
 *  version that a rod state requests. A missing vessel_server therefore appears to the rod as a missing contact node.
 *  States of the wall pass through services of both nodes. A copy of the vertices is kept where the simulation measures
 *  lumens in them. */
class RemoteDeformableWall : public intervention::DeformableWall
{
public:
  /** @param version initial version of the vessel
   *  @param keeps_vertices true: detected() gives the vertices of the wall
   *  @throws InputError when vessel_server does not send the vertices */
  RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version, bool keeps_vertices);

  /** Waits for the subscription of vessel_server; earlier loads would be lost. @return false when ROS shut down */
  bool waitForServer() const;

  std::uint64_t applyLoad(std::uint64_t step, const intervention::BalloonLoad& load) override;
  void activate(std::uint64_t version) override { detected_ = version; }  // every rod/state requests its version
  const std::vector<Eigen::Vector3d>* detected() override;

  /** True when a version that a step may activate has not arrived; only where vertices are kept.
   *  @param step number of steps before it */
  bool isBehind(std::uint64_t step);
  std::uint64_t version() const override { return version_; }
  bool atRisk() const override { return at_risk_; }

  /** As of DeformableWall. They block while vessel_server and contact work, for some milliseconds in general: call them
   *  between two steps. After a refused load() the wall is as before. @{ */
  std::string save() override;
  void load(const std::string& state) override;
  void reset() override;
  /** @} */

private:
  WallState call(std::uint8_t operation, const std::string& state);
  void replace(std::uint8_t operation, const std::string& state);
  void waitForDisplacements() const;
  void makeContactFollow(std::uint64_t before);
  void receive(const WallDisplacement& displacement);
  void takeVertices(double patience);
  bool moveVertices();
  void takeAgain();

  ros::NodeHandle node_;
  std::uint64_t version_;
  std::uint64_t detected_;  ///< version that contact detection searches
  std::atomic<std::uint64_t> received_;
  std::atomic<bool> at_risk_{false};
  bool keeps_vertices_;
  std::vector<Eigen::Vector3d> vertices_;                      ///< of version vertices_version_
  std::atomic<std::size_t> count_{0};                          ///< of the vertices; 0 before they are known
  std::uint64_t vertices_version_ = 0;                         ///< [1]
  std::deque<std::pair<std::uint64_t, std::uint64_t>> loads_;  ///< step and version of those without an answer
  std::mutex mutex_;                                           ///< guards the next one
  std::deque<WallDisplacement> moved_;                         ///< later than the vertices
  std::condition_variable arrived_;
  OneSource source_;  ///< of displacements; used by the thread of the subscription only
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  BalloonLoad message_;
  ros::Subscriber subscriber_;  ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
