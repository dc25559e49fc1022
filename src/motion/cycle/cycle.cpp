#include "motion/cycle/cycle.h"

#include "common/archive_checks.h"

namespace endovascular_sim::motion
{

void Cycle::set(double phase, double rate)
{
  phase_ = phase;
  rate_ = rate;
  next_rate_ = rate;
  standing_ = false;
}

void Cycle::hold(bool held)
{
  held_ = held;
  standing_ = standing_ || (held && phase_ == 0.0);
}

void Cycle::advance(double time_step)
{
  if (standing_ && held_)
    return;
  if (standing_)
  {
    standing_ = false;
    rate_ = next_rate_;
  }
  phase_ += time_step * rate_;
  if (phase_ < 1.0)
    return;
  ++count_;
  standing_ = held_;
  phase_ = held_ ? 0.0 : (phase_ - 1.0) * next_rate_ / rate_;
  rate_ = next_rate_;
}

void Cycle::archive(Archive& archive)
{
  archive(rate_, next_rate_, phase_, held_, standing_, count_);
  if (!archive.reading())
    return;
  requireFinite(rate_, next_rate_, phase_);
  requireLoaded(rate_ > 0.0 && next_rate_ > 0.0 && phase_ >= 0.0 && phase_ < 1.0,
                "holds a rate or a phase out of its range");
}

}  // namespace endovascular_sim::motion
