#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "motion/map/motion_map.h"
#include "nodes/expert/expert_course.h"
#include "nodes/player/bag_timeline.h"

namespace endovascular_sim::nodes
{

/** Recording of an expert: the bag of a session, or of the scripted operator. */
class ExpertRecording
{
public:
  /** @param folder of results with a session.bag
   *  @throws InputError when the bag holds no state of instruments */
  explicit ExpertRecording(const std::string& folder);

  const ExpertCourse& course() const { return course_; }
  const std::optional<SessionInfo>& info() const { return timeline_.info(); }

  /** State of the instruments at a moment of the course, as recorded. */
  RodStateVisual state(std::size_t moment) const;

  /** Balloons and stents at a moment of the course; empty before the first ones. */
  std::optional<TreatmentVisual> treatment(std::size_t moment) const;

  /** Motion of the patient at a moment of the course; the identity in a patient at rest.
   *  @throws InputError for an impossible motion */
  motion::MotionMap motion(std::size_t moment) const;

private:
  std::optional<std::uint32_t> lastUpTo(std::size_t moment, const std::vector<std::uint32_t>& entries) const;
  std::vector<RunMoment> momentsOf() const;

  BagTimeline timeline_;
  std::vector<std::uint32_t> states_, treatments_, steps_, motions_;  ///< entries of the timeline
  ExpertCourse course_;
};

/** Point of the instrument that reaches farthest [m]; empty without nodes. */
std::optional<geometry_msgs::Point> tipOf(const RodStateVisual& state);

/** Distance of the tips of two states [m]; NaN where one has no node. */
double tipDistance(const RodStateVisual& a, const RodStateVisual& b);

}  // namespace endovascular_sim::nodes
