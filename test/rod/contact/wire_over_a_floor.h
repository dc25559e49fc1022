#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rod/contact/contact_solver.h"
#include "rod/kkt/kkt_stepper.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{

/** A free wire along x above the floor z = 0, with a contact solver. */
class WireOverAFloor : public testing::Test
{
protected:
  /** Raises the wire linearly along its length, and detects its contacts. Heights are those of the lower surface. */
  void place(double first, double last)
  {
    for (int i = 0; i < kNodes; ++i)
      state_.position[i].z() = kRadius + first + (last - first) * i / (kNodes - 1);
    beginStep();
    contacts_.invalidate();
    contacts_.refresh(state_, report_);
    passes_ = 0;
  }

  void beginStep() { contacts_.beginStep(StepInput(), &floor_, passes_, timer_); }

  /** Motion of one node along x. */
  static NodalMotion motionOf(int node, double distance)
  {
    NodalMotion motion(kNodes, Eigen::Vector3d::Zero());
    motion[node] = Eigen::Vector3d(distance, 0.0, 0.0);
    return motion;
  }

  NodalMotion randomMotion(double size)
  {
    std::uniform_real_distribution<double> uniform(-size, size);
    NodalMotion motion(kNodes);
    for (Eigen::Vector3d& of_node : motion)
      of_node = Eigen::Vector3d(uniform(random_), uniform(random_), uniform(random_));
    return motion;
  }

  double truncation(const NodalMotion& motion) { return contacts_.truncation(state_, motion, 1.0, report_); }

  /** A snap-through: a solve that would move a node of a level wire far aside, and the next detection. */
  void snap(int node, double height)
  {
    place(height, height);
    truncation(motionOf(node, 3e-3));
    contacts_.detect(state_, report_);
    ASSERT_GT(contacts_.marginOf(node), settings_.contact_margin);
  }

  /** Fills a balloon at one node up to a radius [m]. */
  void setBalloon(int node, double radius)
  {
    least_radius_[node] = radius;
    contacts_.setRadii(least_radius_);
  }

  double radius(int node) const { return std::max(kRadius, least_radius_[node]); }
  double gap(int node) const { return state_.position[node].z() - radius(node); }

  /** Margin of a body outside of snap-throughs [m]. */
  double marginOf(double radius) const
  {
    MarginRule rule = contacts_.marginRule();
    rule.snap = {};
    return rule.at(0, radius);
  }

  static Boundary freeEnds()
  {
    Boundary boundary;
    boundary.introducer = false;
    return boundary;
  }

  static constexpr double kEi = 4.9469e-5;
  static constexpr double kRadius = 1.8e-4;
  static constexpr double kFriction = 0.2;
  static constexpr int kNodes = 21;
  Discretisation rod_ = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const Boundary boundary_ = freeEnds();
  const StepperSettings settings_{};
  ContactSolver contacts_{rod_, boundary_, settings_};
  PlaneWall floor_{kFriction};
  State state_ = KktStepper(rod_, boundary_, Environment(), StepperSettings()).initialState(0.0, 0.0);
  PhaseTimer timer_;
  StepReport report_;
  std::uint32_t passes_ = 0;
  std::mt19937 random_{3};
  std::vector<double> least_radius_ = std::vector<double>(kNodes, 0.0);
};

}  // namespace endovascular_sim::rod
