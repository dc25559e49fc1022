#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include <ros/ros.h>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/WallDisplacement.h"
#include "endovascular_sim/WallState.h"
#include "intervention/deformable_wall.h"
#include "nodes/runtime/direct_callback_queue.h"

namespace endovascular_sim::nodes
{

/** Deformable wall of vessel_server, behind its topics.
 *
 *  vessel_server publishes displacements to the contact node. The contact node defers its response until it has the
 *  version that a rod state requests. A missing vessel_server therefore appears to the rod as a missing contact node.
 *  States of the wall pass through services of both nodes. */
class RemoteDeformableWall : public intervention::DeformableWall
{
public:
  /** @param version initial version of the vessel */
  RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version);

  /** Waits for the subscription of vessel_server; earlier loads would be lost. @return false when ROS shut down */
  bool waitForServer() const;

  std::uint64_t applyLoad(std::uint64_t step, const intervention::BalloonLoad& load) override;
  void activate(std::uint64_t version) override { detected_ = version; }  // every rod/state requests its version
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

  ros::NodeHandle node_;
  std::uint64_t version_;
  std::uint64_t detected_;  ///< version that contact detection searches
  std::atomic<std::uint64_t> received_;
  std::atomic<bool> at_risk_{false};
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  BalloonLoad message_;
  ros::Subscriber subscriber_;  ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
