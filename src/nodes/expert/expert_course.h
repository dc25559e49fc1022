#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace endovascular_sim::nodes
{

/** Way in which the expert follows the trainee; values as in ExpertState. */
enum class ExpertAlignment : std::uint8_t
{
  kHidden,
  kStart,
  kPhase,
  kInsertion,
  kAlone,
};

/** Moment of a run. */
struct RunMoment
{
  double time = 0.0;              ///< simulated [s]
  std::vector<double> insertion;  ///< of each instrument [m]
  std::size_t step = 0;           ///< of the procedure, from 1; 0: before the first one, or without a procedure
};

/** Course of the expert's run: which of its moments belongs to one of the trainee. Free of ROS. */
class ExpertCourse
{
public:
  /** @param moments in the order of their times, at least one
   *  @throws std::invalid_argument without a moment, or for times that fall */
  explicit ExpertCourse(std::vector<RunMoment> moments);

  const std::vector<RunMoment>& moments() const { return moments_; }

  /** Index of the moment of the expert that belongs to one of the trainee.
   *
   *  kStart: by the time since the beginning. kPhase: by the time since the beginning of the step of the procedure;
   * before the first step as kStart, in a step that the expert does not have its last moment. kInsertion: the moment in
   * the same step whose insertions have the smallest largest difference, the latest of equal ones.
   *  @param begin simulated time at which the trainee's run began [s]
   *  @param step_begin simulated time at which the trainee's step began [s]
   *  @pre the alignment is one of these three */
  std::size_t momentOf(ExpertAlignment alignment, const RunMoment& trainee, double begin, double step_begin) const;

  /** Index of the last moment at or before a time since the beginning [s]; the first one before it. */
  std::size_t momentAfter(double elapsed) const;

private:
  /** Moments of one step of the procedure: [first, last]. */
  struct Span
  {
    std::size_t first, last;
  };

  Span spanOf(std::size_t step) const;
  std::size_t lastAtOrBefore(double time, Span span) const;
  std::size_t byInsertion(const RunMoment& trainee) const;

  std::vector<RunMoment> moments_;
};

}  // namespace endovascular_sim::nodes
