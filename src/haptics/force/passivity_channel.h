#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace endovascular_sim::haptics
{

/** What is known of one direction of a device. Units: m and N, or rad and N·m. */
struct PassivitySettings
{
  double resolution = 0.1e-3;   ///< of the encoder [m or rad]
  double damping = 0.2;         ///< that the device and the hand have at least [N·s/m or N·m·s/rad]
  double damping_limit = 15.0;  ///< of what is injected; below π/2 · moving mass / delay [the same]
  double force_limit = 2.0;     ///< of the injected force [N or N·m]
  double delay = 2e-3;          ///< from sending a force to the sample of the motion that it met [s]
};

/** What the observer has seen. */
struct PassivityReport
{
  double energy = 0.0;          ///< taken in by the port, slow motion and forgotten surplus left out [J]
  double injected_damping = 0;  ///< now [N·s/m or N·m·s/rad]
  double dissipated = 0.0;      ///< by what was injected, so far [J]
  std::uint64_t activations = 0;
};

/** Passivity observer and controller of one direction in the time domain (Hannaford and Ryu, IEEE Trans. Robotics and
 *  Automation 18(1), 2002; on forgetting: Ryu, Preusche, Hannaford and Hirzinger, IEEE Trans. Control Systems
 *  Technology 13(4), 2005).
 *
 *  Observed is E = Σ f_k (x_k+1 − x_k) + Σ b v² dt: the exact work of a held force over the measured motion, f_k being
 *  what was sent a delay earlier, plus what device and hand are known to dissipate. Force and position pass the same
 *  high pass (0.15 s) first: a linear passive port stays passive under it, and what friction took in over a long way or
 *  a spring has held for long is no credit for an oscillation. E stays within ± the largest f·x of the last second, of
 *  which a spring holds at most half: neither old credit nor a debt that could not be taken back lasts.
 *  E < −resolution·|f| means that the port has produced energy: then a damping is injected that takes the deficit back
 *  within a step, up to the limits, and fades (50 ms). Velocity is a mean over 2 ms, because one count of a coarse
 *  encoder in one sample says nothing.
 *
 *  While never active, the force passes unchanged. Not for more than one thread. */
class PassivityChannel
{
public:
  explicit PassivityChannel(const PassivitySettings& settings = {}) : settings_(settings) {}

  /** A sample of the motion. @param position [m or rad] @param dt since the last sample [s] @param now [s] */
  void observe(double position, double dt, double now);
  /** @return the force to render for @p force [N or N·m] */
  double control(double force) const;
  /** What was rendered, limits included, from @p now [s] on. */
  void rendered(double force, double now);
  /** The motion is no continuation of what was seen. */
  void reset();

  bool isActive() const { return report_.injected_damping > 0.0; }
  const PassivityReport& report() const { return report_; }

private:
  /** x − low pass of x. */
  struct HighPass
  {
    double low = 0.0;
    bool started = false;
    double next(double value, double dt);
  };
  struct Sent
  {
    double force = 0.0;
    double time = 0.0;
  };

  double forceAt(double time) const;
  void inject(double dt);

  PassivitySettings settings_;
  PassivityReport report_;
  std::array<Sent, 64> sent_ = {};
  std::size_t sent_count_ = 0;  ///< ever
  HighPass force_high_;
  HighPass position_high_;
  double force_ = 0.0;     ///< high-passed, over the coming interval
  double position_ = 0.0;  ///< high-passed
  double last_ = 0.0;      ///< position as measured
  bool started_ = false;
  double speed_ = 0.0;   ///< smoothed
  double credit_ = 0.0;  ///< most that the energy may be, either way [J]
};

}  // namespace endovascular_sim::haptics
