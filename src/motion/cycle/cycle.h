#pragma once

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::motion
{

/** Phase of a periodic motion: heartbeats or breaths. A rate counts from the next cycle on, so that each cycle has one
 *  duration. The phase is a sum of equal steps: equal inputs give equal bits. */
class Cycle
{
public:
  /** @param rate [Hz], positive */
  explicit Cycle(double rate) : rate_(rate), next_rate_(rate) {}

  /** Rate from the next cycle on [Hz], positive. */
  void setRate(double rate) { next_rate_ = rate; }
  /** Sets phase and rate of the present cycle, for a clock outside, e.g. that of the flow of blood.
   *  @param phase in [0, 1)
   *  @param rate [Hz], positive */
  void set(double phase, double rate);
  /** Holds at the end of the present cycle, or goes on from there. A cycle that has not begun is held at once. */
  void hold(bool held);

  void advance(double time_step);  ///< @param time_step [s], shorter than a cycle

  double phase() const { return phase_; }                   ///< in [0, 1) [1]
  double rate() const { return rate_; }                     ///< of the present cycle [Hz]
  double speed() const { return standing_ ? 0.0 : rate_; }  ///< of the phase [1/s]
  double nextRate() const { return next_rate_; }            ///< [Hz]
  bool held() const { return held_; }                       ///< true from the request on
  bool standing() const { return standing_; }               ///< true while the cycle is held at its end
  unsigned count() const { return count_; }                 ///< completed cycles

  void archive(Archive& archive);

private:
  double rate_, next_rate_;
  double phase_ = 0.0;
  bool held_ = false;
  bool standing_ = false;
  unsigned count_ = 0;
};

}  // namespace endovascular_sim::motion
