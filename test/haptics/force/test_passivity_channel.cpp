#include "haptics/force/passivity_channel.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::haptics
{
namespace
{

constexpr double kPeriod = 1e-3;     // sampling period [s]
constexpr double kStep = 5e-5;       // step of the integration of the device [s]
constexpr double kForceLimit = 5.0;  // largest force of the device [N]

/** Model of a device and a hand at a virtual wall at 0: mass, friction, encoder, sample and hold, and delay in each
 *  direction. */
struct Device
{
  double stiffness = 1000.0;      ///< stiffness of the wall [N/m]
  double mass = 0.2;              ///< moving mass [kg]
  double friction = 0.5;          ///< viscous friction of the device [N·s/m]
  double count = 0.1e-3;          ///< resolution of the encoder [m]; 0: exact
  double delay = 5e-3;            ///< round-trip delay [s]
  double hand_stiffness = 200.0;  ///< stiffness of the hand [N/m]
  double hand_damping = 1.0;      ///< damping of the hand [N·s/m]
  double hand_at = 2e-3;          ///< rest position of the hand [m]
  bool controlled = true;
  /** Force of the environment at the position known to the host [N]. */
  std::function<double(double)> environment = [this](double x) { return stiffness * std::max(0.0, x); };

  struct Result
  {
    std::vector<double> amplitude;  ///< largest speed of each half second [m/s]
    double largest_injected = 0.0;  ///< largest injected force [N]
    double largest_force = 0.0;     ///< largest rendered force [N]
    double end = 0.0;               ///< mean position over the last half second [m]
    bool identical = true;          ///< true if the rendered force equals the force of the environment at each sample
    PassivityReport report;
  };

  Result run(double seconds, double start = -5e-3) const
  {
    PassivitySettings settings;
    settings.resolution = count;
    settings.delay = delay;
    PassivityChannel channel(settings);
    struct InFlight
    {
      double arrival;
      double value;
    };
    std::deque<InFlight> samples;
    std::deque<InFlight> forces;
    Result result;
    double x = start;
    double speed = 0.0;
    double force = 0.0;
    double largest_speed = 0.0;
    double sum = 0.0;
    const int steps = static_cast<int>(std::lround(seconds / kStep));
    const int per_sample = static_cast<int>(std::lround(kPeriod / kStep));
    const int per_window = static_cast<int>(std::lround(0.5 / kStep));
    for (int i = 0; i < steps; ++i)
    {
      const double now = i * kStep;
      if (i % per_sample == 0)
        samples.push_back({now + 0.5 * delay, count > 0.0 ? count * std::floor(x / count) : x});
      while (!samples.empty() && samples.front().arrival <= now + 1e-12)
      {
        const double measured = samples.front().value;
        samples.pop_front();
        channel.observe(measured, kPeriod, now);
        const double wanted = environment(measured);
        const double shaped = controlled ? channel.control(wanted) : wanted;
        result.identical = result.identical && shaped == wanted;
        result.largest_injected = std::max(result.largest_injected, std::abs(shaped - wanted));
        const double rendered = std::clamp(shaped, -kForceLimit, kForceLimit);
        channel.rendered(rendered, now);
        forces.push_back({now + 0.5 * delay, rendered});
      }
      while (!forces.empty() && forces.front().arrival <= now + 1e-12)
      {
        force = forces.front().value;
        forces.pop_front();
      }
      result.largest_force = std::max(result.largest_force, std::abs(force));
      const double pull = hand_stiffness * (hand_at - x) - hand_damping * speed;
      speed += kStep * (pull - friction * speed - force) / mass;
      x += kStep * speed;
      largest_speed = std::max(largest_speed, std::abs(speed));
      sum += x;
      if (i % per_window != per_window - 1)
        continue;
      result.amplitude.push_back(largest_speed);
      result.end = sum / per_window;
      largest_speed = sum = 0.0;
    }
    result.report = channel.report();
    return result;
  }

  /** Damping required by the sampled wall with delay (Colgate and Brown: b > K(T/2 + delay)) [N·s/m]. */
  double dampingNeeded() const { return stiffness * (0.5 * kPeriod + delay); }
};

TEST(PassivityChannel, StabilisesACoarseDeviceThatOscillatesWithoutIt)
{
  for (const double delay : {2e-3, 3e-3, 5e-3})
    for (const double stiffness : {1000.0, 2000.0})
    {
      Device device;
      device.delay = delay;
      device.stiffness = stiffness;
      ASSERT_GT(device.dampingNeeded(), device.friction + device.hand_damping) << "violates the stability condition";
      device.controlled = false;
      const Device::Result without = device.run(4.0);
      device.controlled = true;
      const Device::Result with = device.run(4.0);
      EXPECT_GT(without.amplitude.back(), 0.05)
          << "K " << stiffness << ", delay " << delay << ": the oscillation does not decay";
      // The remaining motion comes from the wall force over a few counts of the encoder.
      EXPECT_LT(with.amplitude.back(), 0.2 * without.amplitude.back()) << "K " << stiffness << ", delay " << delay;
      EXPECT_GT(with.report.activations, 0U);
      EXPECT_GT(with.report.dissipated, 0.0);
    }
}

TEST(PassivityChannel, EndsTheOscillationWithinASecond)
{
  Device device;
  device.controlled = false;
  const Device::Result without = device.run(2.0);
  device.controlled = true;
  const Device::Result with = device.run(2.0);
  EXPECT_GT(without.amplitude[2], 0.4);
  EXPECT_LT(with.amplitude[2], 0.05 * without.amplitude[2]);
}

TEST(PassivityChannel, LeavesLittleMotionWithAFineEncoder)
{
  Device device;
  device.count = 1e-6;
  device.stiffness = 1500.0;
  device.mass = 0.5;
  device.delay = 3e-3;
  device.controlled = false;
  const Device::Result without = device.run(4.0);
  device.controlled = true;
  const Device::Result with = device.run(4.0);
  EXPECT_GT(without.amplitude.back(), 0.05);
  EXPECT_LT(with.amplitude.back(), 0.03 * without.amplitude.back());
}

TEST(PassivityChannel, DoesNotChangeTheEquilibriumOfHandAndWall)
{
  Device device;
  const Device::Result with = device.run(6.0);
  // Equilibrium of the hand's spring and the wall, within half a count and the remaining oscillation.
  const double balance = device.hand_stiffness * device.hand_at / (device.hand_stiffness + device.stiffness);
  EXPECT_NEAR(with.end, balance, 1.5 * device.count);
}

TEST(PassivityChannel, ObeysItsOwnLimitAndTheLimitOfTheDevice)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 20; ++i)
  {
    Device device;
    device.stiffness = 500.0 + 8000.0 * share(random);
    device.mass = 0.05 + 0.5 * share(random);
    device.delay = 1e-3 + 9e-3 * share(random);
    const Device::Result with = device.run(1.0);
    EXPECT_LE(with.largest_injected, PassivitySettings().force_limit + 1e-12);
    EXPECT_LE(with.largest_force, kForceLimit);
  }
}

TEST(PassivityChannel, NeverIncreasesTheOscillationOfRandomDevices)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int unstable = 0;
  for (int i = 0; i < 60; ++i)
  {
    Device device;
    device.stiffness = 200.0 + 1800.0 * share(random);
    device.mass = 0.15 + 0.35 * share(random);
    device.friction = 0.1 + 0.9 * share(random);
    device.count = std::pow(10.0, -6.0 + 2.0 * share(random));
    device.delay = 1e-3 + 4e-3 * share(random);
    device.controlled = false;
    const Device::Result without = device.run(2.5);
    device.controlled = true;
    const Device::Result with = device.run(2.5);
    const std::string what = "K " + std::to_string(device.stiffness) + " m " + std::to_string(device.mass) + " b " +
                             std::to_string(device.friction) + " count " + std::to_string(1e3 * device.count) +
                             " mm, delay " + std::to_string(1e3 * device.delay) +
                             " ms: " + std::to_string(without.amplitude.back()) + " m/s without, " +
                             std::to_string(with.amplitude.back()) + " with";
    if (without.amplitude.back() > 0.1)
    {
      ++unstable;
      EXPECT_LT(with.amplitude.back(), 0.25 * without.amplitude.back()) << what;
    }
    else
    {
      EXPECT_LT(with.amplitude.back(), without.amplitude.back() + 0.02) << what;
    }
  }
  EXPECT_GT(unstable, 15) << "the cases must include unstable ones";
}

/** Replays a motion against an environment with ideal hold. @return true if the channel stays inactive */
template <typename Motion, typename Environment>
PassivityReport play(double seconds, double count, double delay, Motion motion, Environment environment,
                     bool& identical)
{
  PassivitySettings settings;
  settings.resolution = count;
  settings.delay = delay;
  PassivityChannel channel(settings);
  identical = true;
  double before = motion(0.0);
  const int samples = static_cast<int>(seconds / kPeriod);
  for (int k = 0; k < samples; ++k)
  {
    const double now = k * kPeriod;
    const double x = motion(now);
    const double measured = count * std::floor(x / count);
    channel.observe(measured, kPeriod, now);
    const double wanted = environment(measured, x - before);
    before = x;
    const double force = channel.control(wanted);
    identical = identical && force == wanted;
    channel.rendered(force, now);
  }
  return channel.report();
}

TEST(PassivityChannel, LeavesPassiveEnvironmentsUntouchedBitForBit)
{
  const double count = 0.1e-3;
  const auto stroke = [](double t) { return 0.02 * (1.0 - std::cos(2.0 * 3.14159265 * 0.5 * t)); };
  const auto insertion = [](double t) { return 0.035 * std::min(t, 5.0) - 0.035 * std::clamp(t - 8.0, 0.0, 4.0); };
  const auto spring = [](double x, double) { return 30.0 * x; };
  const auto friction = [](double, double travel) { return 0.4 * std::tanh(travel / 2e-6); };
  const auto wire = [](double x, double travel) { return 15.0 * x + 0.2 * std::tanh(travel / 2e-6); };
  for (const double delay : {0.0, 2e-3})  // an overestimated delay must have no effect
  {
    bool identical = false;
    EXPECT_EQ(play(20.0, count, delay, stroke, spring, identical).activations, 0U);
    EXPECT_TRUE(identical);
    EXPECT_EQ(play(20.0, count, delay, insertion, spring, identical).activations, 0U);
    EXPECT_TRUE(identical);
    EXPECT_EQ(play(20.0, count, delay, stroke, friction, identical).activations, 0U);
    EXPECT_TRUE(identical);
    EXPECT_EQ(play(20.0, count, delay, insertion, wire, identical).activations, 0U);
    EXPECT_TRUE(identical);
  }
}

TEST(PassivityChannel, DetectsAnActivePortAfterALongPassivePhase)
{
  // Ten seconds of friction dissipate 0.14 J. This energy must not serve as credit afterwards.
  const auto motion = [](double t) { return t < 10.0 ? 0.035 * t : 0.35 + 2e-3 * std::sin(60.0 * (t - 10.0)); };
  double time = 0.0;
  double at_beginning = 0.0;
  PassivitySettings settings;
  settings.resolution = 1e-5;
  settings.delay = 0.0;
  PassivityChannel channel(settings);
  double before = motion(0.0);
  double detected = 0.0;
  for (int k = 0; k < 11000; ++k)
  {
    time = k * kPeriod;
    const double x = motion(time);
    channel.observe(x, kPeriod, time);
    // First friction and then negative damping.
    const double speed = (x - before) / kPeriod;
    before = x;
    channel.rendered(time < 10.0 ? 0.4 : -5.0 * speed, time);
    if (time < 10.0)
      at_beginning = static_cast<double>(channel.report().activations);
    else if (detected == 0.0 && channel.report().injected_damping > 0.0)
      detected = time - 10.0;
  }
  EXPECT_EQ(at_beginning, 0.0);
  EXPECT_GT(detected, 0.0);
  EXPECT_LT(detected, 0.1);
}

TEST(PassivityChannel, DeactivatesSoonAfterAnActivePortHasBecomePassive)
{
  PassivitySettings settings;
  settings.resolution = 1e-5;
  settings.delay = 0.0;
  PassivityChannel channel(settings);
  double last_active = 0.0;
  for (int k = 0; k < 4000; ++k)
  {
    const double now = k * kPeriod;
    channel.observe(2e-3 * std::sin(60.0 * now), kPeriod, now);
    const double speed = 0.12 * std::cos(60.0 * now);
    // Active for one second, so strongly that the limits leave an energy debt. Friction follows.
    const double port = now < 1.0 ? -40.0 * speed : 2.0 * speed;
    channel.rendered(channel.control(port), now);
    if (now < 1.0 || channel.report().injected_damping > 0.0)
      last_active = now;
  }
  EXPECT_GT(last_active, 1.0);
  EXPECT_LT(last_active, 1.5);
}

TEST(PassivityChannel, RestartsAfterAGapAndRetainsItsCounters)
{
  Device device;
  PassivityChannel channel;
  channel.observe(0.0, kPeriod, 0.0);
  channel.rendered(1.0, 0.0);
  channel.observe(1e-3, 1.0, 1.0);
  EXPECT_EQ(channel.report().energy, 0.0);
  EXPECT_EQ(channel.report().injected_damping, 0.0);
  EXPECT_EQ(channel.control(0.7), 0.7);
  channel.observe(1e-3, std::nan(""), 1.001);
  EXPECT_EQ(channel.control(0.7), 0.7);
}

}  // namespace
}  // namespace endovascular_sim::haptics
