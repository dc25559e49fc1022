#include "benchmark/reference/reference_motion.h"

#include <vector>

#include <Eigen/Dense>

#include "benchmark/harness/bench_run.h"
#include "benchmark/harness/bench_wire.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** First mode of a clamped wire at x/L. */
double firstMode(double x)
{
  constexpr double kBeta = 1.875104068711961;
  const double s = (std::cosh(kBeta) + std::cos(kBeta)) / (std::sinh(kBeta) + std::sin(kBeta));
  return std::cosh(kBeta * x) - std::cos(kBeta * x) - s * (std::sinh(kBeta * x) - std::sin(kBeta * x));
}

}  // namespace

Propagation swing(const std::string& scheme, int nodes, double turn)
{
  BenchWire wire;
  wire.scheme = scheme;
  wire.nodes = nodes;
  wire.strain_tolerance = 5e-5;
  const double line_density = wire.density * M_PI * wire.radius * wire.radius;
  const double frequency = 1.875104068711961 * 1.875104068711961 * std::sqrt(wire.bending_stiffness / line_density) /
                           (wire.length * wire.length);
  wire.time_step = turn / frequency;
  BenchRun run(sceneText(wire));
  rod::State state = run.simulation().state();
  const std::size_t first_free = scheme == "mixed" ? 1 : 2;
  for (std::size_t i = first_free; i < state.position.size(); ++i)
    state.position[i].y() = 1e-5 * wire.length * firstMode(state.position[i].x() / wire.length);
  run.simulation().setState(state);
  constexpr int kSteps = 160;
  std::vector<double> amplitude;
  for (int k = 0; k < kSteps; ++k)
  {
    run.simulation().step({});
    amplitude.push_back(run.simulation().state().position.back().y());
  }
  // The initial shape also excites higher modes of the discrete rod, which decay during the skipped steps.
  constexpr int kSkip = 60;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int k = kSkip; k + 2 < kSteps; ++k)
  {
    const Eigen::Vector2d past(amplitude[k + 1], -amplitude[k]);
    normal += past * past.transpose();
    right += amplitude[k + 2] * past;
  }
  const Eigen::Vector2d fit = normal.inverse() * right;
  const double growth = std::sqrt(fit[1]);
  return {growth, std::acos(0.5 * fit[0] / growth), medianStepTime(sceneText(wire), 100)};
}

}  // namespace endovascular_sim::benchmark
