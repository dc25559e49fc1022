#pragma once

#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/SessionSample.h"
#include "results/session_sample.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Publisher of the samples from which the session node evaluates the metrics. */
class SamplePublisher
{
public:
  SamplePublisher(ros::NodeHandle& node, const scene::Scene& scene);

  /** Adds a step, and publishes at the first step of every sampling interval.
   *  @param contacts wall contacts of the step */
  void publishStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts,
                   ros::Time now);

  /** Begins a new run. */
  void reset() { sampler_ = results::SessionSampler(); }

  bool hasSubscriber() const { return publisher_.getNumSubscribers() > 0; }

private:
  scene::Scene scene_;
  results::SessionSampler sampler_;
  ros::Publisher publisher_;
  SessionSample message_;
};

}  // namespace endovascular_sim::nodes
