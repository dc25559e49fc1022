#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "endovascular_sim/PlayerChapter.h"
#include "nodes/player/bag_timeline.h"

namespace endovascular_sim::nodes
{

/** Course of a recorded session: its chapters, and the largest forces up to each of its states. Steps of the procedure
 *  and errors are those that the session showed; errors of the metrics follow from its samples, as live. */
class RecordedCourse
{
public:
  explicit RecordedCourse(const BagTimeline& timeline);

  const std::vector<PlayerChapter>& chapters() const { return chapters_; }  ///< in the order of their times

  /** Largest axial force on each hand from the beginning to a state [N]. */
  const std::vector<double>& peakHandForce(std::size_t state) const { return hand_forces_.at(state); }
  /** Largest force of the wall on a node of the instruments, as peakHandForce() [N]. */
  double peakNodeForce(std::size_t state) const { return node_forces_.at(state); }

  /** View to which the C-arm was last commanded at a time of the recording; empty: none. */
  std::string viewAt(ros::Time time) const;

  const std::vector<std::string>& missing() const { return missing_; }  ///< what cannot be found out

private:
  void addSteps(const BagTimeline& timeline);
  void addMetricErrors(const BagTimeline& timeline);
  void nameWrongBranches(std::vector<std::pair<double, std::string>> entries);
  void addMarks(const BagTimeline& timeline);
  void addViews(const BagTimeline& timeline);
  void followForces(const BagTimeline& timeline);
  void add(std::uint8_t kind, double time, const std::string& name);

  std::vector<PlayerChapter> chapters_;
  std::vector<std::vector<double>> hand_forces_;
  std::vector<double> node_forces_;
  std::map<ros::Time, std::string> views_;  ///< commanded to the C-arm
  std::vector<std::string> missing_;
};

}  // namespace endovascular_sim::nodes
