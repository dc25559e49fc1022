#include "rviz_plugin/model/motion_follower.h"

namespace endovascular_sim::rviz_plugin
{

void MotionFollower::add(const MotionState& motion)
{
  motions_.add(motion);
  without_ = 0;
  is_motion_new_ = true;
}

void MotionFollower::add(const RodStateVisualConstPtr& wire)
{
  waiting_ = wire;
  if (!motions_.empty() && ++without_ > kMostWithout)
    motions_.clear();
}

void MotionFollower::clearWires()
{
  waiting_.reset();
  wire_.reset();
  waited_ = 0.0;
}

bool MotionFollower::advance(double seconds)
{
  if (!waiting_)
    return showNewestMotion();
  waited_ += seconds;
  const motion::MotionMap* own = motions_.find(waiting_->step);
  if (own == nullptr && !motions_.empty() && waited_ < kPatience)
    return false;
  show(own != nullptr ? *own : motions_.nearest(waiting_->step));
  return true;
}

/** Before the first state the vessel moves with the newest motion. */
bool MotionFollower::showNewestMotion()
{
  if (wire_ || !is_motion_new_ || motions_.empty())
    return false;
  is_motion_new_ = false;
  map_ = motions_.newest().map;
  return true;
}

void MotionFollower::show(const motion::MotionMap& map)
{
  map_ = map;
  wire_.swap(waiting_);
  waiting_.reset();
  waited_ = 0.0;
}

}  // namespace endovascular_sim::rviz_plugin
