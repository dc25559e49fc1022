#include "benchmark/studies/sampling_study.h"

namespace endovascular_sim::benchmark
{
namespace
{

// Push, hold, withdraw, with continuous rotation. Facets of 0.5 mm limit the noise of the force.
constexpr auto kTube = R"(
name: bent_tube
vessel:
  tube:
    radius: 3.0e-3
    facet_length: 0.5e-3
    facets_around: 96
    pieces:
      - length: 0.05
      - {length: 0.0471238898038469, curvature: 33.333333333333336, plane_angle: 0.0}
      - length: 0.05
  friction: 0.1
entry:
  position: [0, 0, 0]
  direction: [0, 0, 1]
  up: [1, 0, 0]
instrument: instruments/guidewire_035_straight.yaml
drive:
  source: script
  initial_insertion: 0.010
  insertion:
    points: [[0, 0], [4.0, 0.12], [4.3, 0.12], [5.3, 0.09]]
  rotation: {amplitude: 0.5, frequency: 0.5}
  force_limit: 8.0
)";

// Distal 120 mm of a 0.014" wire from the ostium of the left main artery. The wall is compliant: on a rigid wall the
// snap-through of the tip between facets would dominate the comparison.
constexpr auto kCoronary = R"(
name: coronary
vessel:
  anatomy: anatomies/plain.yaml
  stiffness: 5.0e6
  friction: 0.1
entry:
  position: [0.014, -0.01433, 0.2041]
  direction: [9, -0.7, 2.2]
  up: [0, 1, 0]
instrument:
  name: guidewire
  sections:
    - {length: 0.040, radius: 1.778e-4, material: steel, density: 7000, bending_stiffness: 50.0e-6, poisson_ratio: 0.3}
    - {length: 0.050, radius: 1.778e-4, material: steel, density: 7000, bending_stiffness: 10.0e-6, poisson_ratio: 0.3}
    - {length: 0.030, radius: 1.778e-4, material: platinum, density: 12000, bending_stiffness: 1.6e-6, poisson_ratio: 0.3}
drive:
  source: script
  initial_insertion: 0.002
  insertion:
    points: [[0, 0], [2.8, 0.07], [3.2, 0.07], [4.0, 0.055]]
  rotation: {amplitude: 0.5, frequency: 0.5}
)";

// From the iliac artery towards the aorta, up to the first bifurcation, beyond which the outcome is chaotic. Three
// subdivisions reduce the ridges between facets, so that the snap-through of the tip hardly depends on the sampling.
constexpr auto kArch = R"(
name: aortic_tree
vessel:
  mesh: MESH
  unit: 0.001
  smoothing: 3
  friction: 0.1
entry:
  position: [-0.035, 0.065, 0.005]
  direction: [-1, -1, 0]
  up: [1, -1, 0]
instrument: instruments/guidewire_035_straight.yaml
drive:
  source: script
  initial_insertion: 0.0042
  insertion:
    points: [[0, 0], [3.0, 0.09], [3.3, 0.09], [4.0, 0.07]]
  rotation: {amplitude: 0.5, frequency: 0.5}
  force_limit: 8.0
)";

}  // namespace

std::vector<SamplingCase> samplingCases(const std::string& mesh, bool quick)
{
  std::vector<SamplingCase> cases;
  cases.push_back({"bent tube", kTube, quick ? 2.5 : 5.3});
  cases.back().turn_per_edge = 0.036;
  cases.back().max_edge = 1.6e-3;
  cases.push_back({"coronary of the generated anatomy", kCoronary, quick ? 1.5 : 4.0});
  cases.back().turn_per_edge = 0.055;
  if (mesh.empty())
    return cases;
  std::string arch = kArch;
  arch.replace(arch.find("MESH"), 4, mesh);
  cases.push_back({"aortic tree", arch, quick ? 1.5 : 4.0});
  return cases;
}

}  // namespace endovascular_sim::benchmark
