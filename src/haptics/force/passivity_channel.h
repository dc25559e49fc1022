#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace endovascular_sim::haptics
{

/** Parameters of one direction of a device. Units: m and N for translation, rad and N·m for rotation. */
struct PassivitySettings
{
  double resolution = 0.1e-3;   ///< resolution of the encoder [m or rad]
  double damping = 0.2;         ///< lower bound of the damping of device and hand [N·s/m or N·m·s/rad]
  double damping_limit = 15.0;  ///< largest injected damping; below π/2 · moving mass / delay [N·s/m or N·m·s/rad]
  double force_limit = 2.0;     ///< largest injected force [N or N·m]
  double delay = 2e-3;          ///< delay from sending a force to the first sample of the motion under it [s]
};

/** State of a passivity observer. */
struct PassivityReport
{
  double energy = 0.0;            ///< energy absorbed by the port after high-pass filtering and bounding [J]
  double injected_damping = 0;    ///< present injected damping [N·s/m or N·m·s/rad]
  double dissipated = 0.0;        ///< energy dissipated by the injected damping so far [J]
  std::uint64_t activations = 0;  ///< number of activations of the controller
};

/** Passivity observer and controller of one direction in the time domain (Hannaford and Ryu, IEEE Trans. Robotics and
 *  Automation 18(1), 2002; on forgetting: Ryu, Preusche, Hannaford and Hirzinger, IEEE Trans. Control Systems
 *  Technology 13(4), 2005).
 *
 *  Observer: E = Σ f_k (x_k+1 − x_k) + Σ b v² dt. The first sum is the exact work of a zero-order-hold force over the
 *  measured motion; f_k is the force sent one delay earlier. The second sum is the known dissipation of device and
 *  hand.
 *
 *  Force and position pass the same high-pass filter (0.15 s) before. A linear passive port stays passive under this
 *  filter. Energy absorbed by friction over a long path, or stored in a spring for long, then gives no credit to an
 *  oscillation. E is clamped to ± the largest |f·x|, which decays with a time constant of 1 s; a spring stores at most
 *  half of f·x. So neither old credit nor an unrecoverable debt persists.
 *
 *  Controller: E < −resolution·|f| shows that the port has generated energy. The controller then injects the damping
 *  that recovers the deficit within one step, up to the limits, and lets it decay (50 ms). The velocity is averaged
 *  over 2 ms, because a single count of a coarse encoder carries too little information.
 *
 *  Without an activation the force passes unchanged. Not thread-safe. */
class PassivityChannel
{
public:
  explicit PassivityChannel(const PassivitySettings& settings = {}) : settings_(settings) {}

  /** Adds a sample of the motion.
   *  @param position measured position [m or rad]
   *  @param dt interval since the previous sample [s]
   *  @param now arrival time [s] */
  void observe(double position, double dt, double now);
  /** @return force to render for the input @p force [N or N·m] */
  double control(double force) const;
  /** Records the force sent to the device, limits included, from time @p now [s]. */
  void rendered(double force, double now);
  /** Restarts the observer after a discontinuity of the motion; the totals of the report remain. */
  void reset();

  const PassivityReport& report() const { return report_; }

private:
  /** First-order high-pass filter: x minus its low-pass filtered value. */
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
  std::size_t sent_count_ = 0;  ///< number of forces ever recorded
  HighPass force_high_;
  HighPass position_high_;
  double force_ = 0.0;     ///< high-pass filtered force [N or N·m]
  double position_ = 0.0;  ///< high-pass filtered position [m or rad]
  double last_ = 0.0;      ///< last measured position [m or rad]
  bool started_ = false;
  double speed_ = 0.0;   ///< low-pass filtered velocity [m/s or rad/s]
  double credit_ = 0.0;  ///< bound of the absolute value of the energy [J]
};

}  // namespace endovascular_sim::haptics
