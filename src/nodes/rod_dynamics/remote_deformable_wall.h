#pragma once

#include <atomic>
#include <cstdint>

#include <ros/ros.h>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/WallDisplacement.h"
#include "intervention/deformable_wall.h"
#include "nodes/runtime/direct_callback_queue.h"

namespace endovascular_sim::nodes
{

/** The wall in vessel_server, behind its topics. It answers to the contact node, which finds nothing before it has the
 *  version that it is asked for: a vessel_server that is late or away looks to the rod like a contact node that is. */
class RemoteDeformableWall : public intervention::DeformableWall
{
public:
  /** @param version of the vessel at the beginning */
  RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version);

  /** Waits until vessel_server listens: what is told before is lost. @return false when ROS ended */
  bool waitForServer() const;

  std::uint64_t applyLoad(std::uint64_t step, const intervention::BalloonLoad& pressing) override;
  void activate(std::uint64_t /*version*/) override {}  // every rod/state says it
  std::uint64_t version() const override { return version_; }
  bool atRisk() const override { return at_risk_; }
  void archive(Archive& archive) override;

private:
  std::uint64_t version_;
  std::atomic<bool> at_risk_{false};
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  BalloonLoad message_;
  ros::Subscriber subscriber_;  ///< last, so that it ends before what its callback uses
};

}  // namespace endovascular_sim::nodes
