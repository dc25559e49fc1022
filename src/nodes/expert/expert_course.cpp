#include "nodes/expert/expert_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kSameTime = 1e-9;  ///< difference of times that are equal up to their rounding [s]

bool isEarlier(const RunMoment& a, const RunMoment& b)
{
  return a.time < b.time;
}

/** Largest difference of the insertions [m]. */
double difference(const RunMoment& a, const RunMoment& b)
{
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.insertion.size(), b.insertion.size()); ++k)
    largest = std::max(largest, std::abs(a.insertion[k] - b.insertion[k]));
  return largest;
}

}  // namespace

ExpertCourse::ExpertCourse(std::vector<RunMoment> moments) : moments_(std::move(moments))
{
  if (moments_.empty())
    throw std::invalid_argument("the expert's run has no moment");
  if (!std::is_sorted(moments_.begin(), moments_.end(), isEarlier))
    throw std::invalid_argument("the times of the expert's run fall");
}

/** Moments of a step; all of them for step 0, the last one for a step that the expert does not have. A repeated step
 * counts from its first beginning to its last end. */
ExpertCourse::Span ExpertCourse::spanOf(std::size_t step) const
{
  const Span all{0, moments_.size() - 1};
  if (step == 0)
    return all;
  const auto isOfStep = [step](const RunMoment& moment) { return moment.step == step; };
  const auto first = std::find_if(moments_.begin(), moments_.end(), isOfStep);
  if (first == moments_.end())
    return {all.last, all.last};
  const auto last = std::find_if(moments_.rbegin(), moments_.rend(), isOfStep);
  return {static_cast<std::size_t>(first - moments_.begin()),
          moments_.size() - 1 - static_cast<std::size_t>(last - moments_.rbegin())};
}

std::size_t ExpertCourse::lastAtOrBefore(double time, Span span) const
{
  RunMoment wanted;
  wanted.time = time + kSameTime;
  const auto begin = moments_.begin() + static_cast<std::ptrdiff_t>(span.first);
  const auto end = moments_.begin() + static_cast<std::ptrdiff_t>(span.last) + 1;
  const auto after = std::upper_bound(begin, end, wanted, isEarlier);
  return after == begin ? span.first : static_cast<std::size_t>(after - moments_.begin()) - 1;
}

std::size_t ExpertCourse::momentAfter(double elapsed) const
{
  return lastAtOrBefore(moments_.front().time + elapsed, {0, moments_.size() - 1});
}

std::size_t ExpertCourse::byInsertion(const RunMoment& trainee) const
{
  const Span span = spanOf(trainee.step);
  std::size_t nearest = span.first;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = span.first; k <= span.last; ++k)
  {
    const double found = difference(moments_[k], trainee);
    if (found > smallest)
      continue;
    smallest = found;
    nearest = k;
  }
  return nearest;
}

std::size_t ExpertCourse::momentOf(ExpertAlignment alignment, const RunMoment& trainee, double begin,
                                   double step_begin) const
{
  if (alignment == ExpertAlignment::kInsertion)
    return byInsertion(trainee);
  if (alignment != ExpertAlignment::kPhase || trainee.step == 0)
    return momentAfter(trainee.time - begin);
  const Span span = spanOf(trainee.step);
  return lastAtOrBefore(moments_[span.first].time + trainee.time - step_begin, span);
}

}  // namespace endovascular_sim::nodes
