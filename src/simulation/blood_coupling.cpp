#include "simulation/blood_coupling.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/units.h"
#include "contrast/lumen/divide_lumen.h"
#include "flow/coupling/contrast_grid.h"
#include "flow/drag/drag.h"
#include "rod/kkt/insertion_forces.h"

namespace endovascular_sim::simulation
{
namespace
{

using units::kPi;

constexpr double kSoft = 50e-6;          // bending stiffness below which the stream bends a section visibly [N·m²]
constexpr double kStreamSpacing = 8e-3;  // between two points of the wire at which the stream is found [m]
constexpr double kWidest = 0.9;          // largest ratio of an instrument to its lumen in the axial drag
constexpr double kSlowest = 1e-3;        // speed of the stream below which it has no effect [m/s]
constexpr auto kTag = "blood";           // in saved states
constexpr double kWideBalloon = 1.2;     // ratio of a balloon to its shaft from which on it bears a thrust

double timeStepOf(const scene::Scene& scene)
{
  return scene.flow->time_step;
}

/** Distance of an instrument's tip from the end of the wire [m]. */
double behindEnd(int instrument, const rod::State& state)
{
  if (state.layers.empty())
    return 0.0;
  return std::max(0.0, state.layers[static_cast<std::size_t>(state.reference)].inserted_length -
                           state.layers[static_cast<std::size_t>(instrument)].inserted_length);
}

double insertionOf(int instrument, const rod::State& state)
{
  return rod::handleState(state, instrument).inserted_length;
}

/** Point of the wire at a distance from its end. */
struct WirePoint
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  int node = 0;        ///< first node of its edge
  double share = 0.0;  ///< position on the edge, 0 to 1
};

/** @param positions of the nodes, in the moved patient or at rest [m] */
WirePoint pointOf(const rod::State& state, const std::vector<Eigen::Vector3d>& positions,
                  const rod::Discretisation& rod, double from_end)
{
  const double arc = rod.length() - from_end;
  const auto after = std::upper_bound(rod.position.begin() + state.first_node, rod.position.end(), arc);
  const int last = rod.nodes() - 2;
  WirePoint point;
  point.node = std::clamp(static_cast<int>(after - rod.position.begin()) - 1, std::min(state.first_node, last), last);
  point.share = std::clamp((arc - rod.position[point.node]) / rod.rest_length[point.node], 0.0, 1.0);
  point.position = positions[point.node] + point.share * (positions[point.node + 1] - positions[point.node]);
  return point;
}

/** Velocity in the moved patient of a stream along a vessel that moves. @param at_rest its place at rest [m] */
Eigen::Vector3d carried(const Eigen::Vector3d& velocity, const Eigen::Vector3d& at_rest, const motion::MotionMap& map)
{
  return velocity.norm() * (map.gradient(at_rest) * velocity).normalized() + map.velocity(at_rest);
}

/** Velocity linear between two samples, which descend by their distance from the end. */
template <typename Sample>
Sample between(const Sample& a, const Sample& b, double from_end)
{
  const double length = b.from_end - a.from_end;
  const double share = length > 0.0 ? std::clamp((from_end - a.from_end) / length, 0.0, 1.0) : 0.0;
  Sample mixed;
  mixed.from_end = from_end;
  mixed.velocity = a.velocity + share * (b.velocity - a.velocity);
  mixed.axial = a.axial + share * (b.axial - a.axial);
  mixed.crosswise = a.crosswise + share * (b.crosswise - a.crosswise);
  return mixed;
}

flow::VesselFlowTree flowTreeOf(const scene::Scene& scene, const vessel::Vessel& vessel)
{
  return flow::vesselFlowTree(flow::withoutLesions(vessel.centreline, vessel.lesions), scene.flow->circulation, {},
                              flow::branchesWithLesions(vessel.centreline.branches.size(), vessel.lesions));
}

}  // namespace

std::vector<flow::LineSettings> pressureLines(const scene::Scene& scene)
{
  std::vector<flow::LineSettings> lines;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    if (const std::optional<instrument::PressureLine> line = instrument::pressureLineOf(driven.instrument))
      lines.push_back({line->from_tip, line->natural_frequency, line->damping});
  return lines;
}

flow::FlowEngine makeFlowEngine(const scene::Scene& scene, const vessel::Vessel& vessel, const ContrastVessel* contrast)
{
  std::vector<double> volumes;
  if (scene.contrast)
    volumes = contrast != nullptr ? contrast->lumen->volumes : ContrastVessel(scene, vessel).lumen->volumes;
  return flow::FlowEngine(vessel.centreline, vessel.lesions, scene.flow->circulation, timeStepOf(scene),
                          pressureLines(scene), std::move(volumes));
}

void BloodCoupling::StreamSample::archive(Archive& archive)
{
  archive(from_end, velocity, axial, crosswise);
}

void BloodCoupling::Thrust::archive(Archive& archive)
{
  archive(instrument, from_end, force);
}

ContrastVessel::ContrastVessel(const scene::Scene& scene, const vessel::Vessel& vessel)
  : cells(flow::contrastCells(flowTreeOf(scene, vessel), vessel.centreline)),
    lumen(std::make_shared<const contrast::LumenCells>(contrast::divideLumen(vessel.mesh, vessel.centreline, cells)))
{
}

BloodVessel::BloodVessel(const scene::Scene& scene, const vessel::Vessel& vessel)
  : paths(vessel.centreline),
    places(flowTreeOf(scene, vessel), vessel.centreline.branches.size()),
    lumens(vessel.mesh, vessel.centreline, vessel.lesions)
{
}

BloodCoupling::BloodCoupling(const scene::Scene& scene, std::shared_ptr<const BloodVessel> vessel,
                             const scene::EntryPose& entry, std::shared_ptr<flow::FlowSource> source)
  : period_(static_cast<std::uint64_t>(std::llround(timeStepOf(scene) / scene.solver.time_step))),
    settings_(*scene.flow),
    vessel_(std::move(vessel)),
    lumens_(vessel_->lumens),
    source_(std::move(source)),
    entry_(vessel_->paths.locate(entry.position)),
    controls_{settings_.heart_rate, settings_.mean_pressure, settings_.hyperaemia}
{
  int lines = 0;
  for (const scene::DrivenInstrument& driven : scene.instruments)
  {
    std::vector<Piece> pieces;
    double from_tip = 0.0;
    const std::vector<rod::Section>& sections = driven.instrument.wire.sections;
    for (auto section = sections.rbegin(); section != sections.rend(); ++section)
    {
      if (!pieces.empty() && pieces.back().radius == section->radius)
        pieces.back().end += section->length;
      else
        pieces.push_back({from_tip, from_tip + section->length, section->radius});
      from_tip += section->length;
    }
    pieces_.push_back(std::move(pieces));
    lines_.push_back(instrument::pressureLineOf(driven.instrument));
    line_of_.push_back(lines_.back() ? lines++ : -1);
  }
}

int BloodCoupling::lineOf(int instrument) const
{
  return line_of_.at(static_cast<std::size_t>(instrument));
}

HeartClock BloodCoupling::heartClock(std::uint64_t step, double time_step) const
{
  const double rate = controls_.heart_rate;
  const double since = static_cast<double>(step % period_ + 1) * time_step;  // since the last result
  const double phase = (now_ ? now_->field.phase : 0.0) +
                       rate * (since + (now_ ? 0.0 : static_cast<double>(step - step % period_) * time_step)) +
                       rate * settings_.circulation.heart.contraction;
  return {phase - std::floor(phase), rate};
}

void BloodCoupling::take()
{
  if (pending_ && !next_)
    next_ = source_->answer();
  pending_ = false;
  if (!next_)
    return;
  now_ = std::move(next_);
  next_.reset();
  request_.state = now_->state;
}

void BloodCoupling::exchange(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest,
                             const motion::MotionMap* map, const rod::Discretisation& rod,
                             const BalloonTreatments& treatments, const std::vector<Eigen::Vector3d>& wall,
                             std::uint64_t version)
{
  take();
  sampleStream(state, at_rest, map, rod);
  findThrusts(state, treatments);
  if (!is_measured_ || version != measured_version_)
  {
    request_.lumens = lumens_.measure(wall);
    measured_version_ = version;
    is_measured_ = true;
  }
  request_.controls = controls_;
  describeInstruments(state, at_rest, rod, treatments);
  source_->request(request_);
  request_.injection = {};
  ++request_.step;
  pending_ = true;
}

flow::TreePath BloodCoupling::pathOf(int instrument, const rod::State& state,
                                     const std::vector<Eigen::Vector3d>& at_rest, const rod::Discretisation& rod) const
{
  if (insertionOf(instrument, state) <= 0.0)
    return flow::TreePath({});
  return paths().between(paths().locate(pointOf(state, at_rest, rod, behindEnd(instrument, state)).position), entry_);
}

/** Sets what instruments leave of the lumen, and the places of their openings and balloons. */
void BloodCoupling::describeInstruments(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest,
                                        const rod::Discretisation& rod, const BalloonTreatments& treatments)
{
  request_.instruments.clear();
  request_.probes.clear();
  std::vector<flow::TreePlace> ends;
  for (int k = 0; k < static_cast<int>(pieces_.size()); ++k)
  {
    const auto index = static_cast<std::size_t>(k);
    const double inserted = insertionOf(k, state);
    const flow::TreePath path = pathOf(k, state, at_rest, rod);
    for (const Piece& piece : pieces_[index])
      path.addSpans(piece.begin, std::min(piece.end, inserted), piece.radius, request_.instruments);
    if (lines_[index])
      request_.probes.push_back(lines_[index]->from_tip < inserted ? path.at(lines_[index]->from_tip)
                                                                   : flow::TreePlace());
    const intervention::Treatment* treatment = treatments.of(k);
    if (treatment == nullptr)
      continue;
    const bool is_inside = treatment->end() < inserted;
    const double radius = treatment->radiusAt(0.5 * (treatment->begin() + treatment->end()));
    if (is_inside && radius > 0.0)
      path.addSpans(treatment->begin(), treatment->end(), radius, request_.instruments);
    ends.push_back(is_inside ? path.at(treatment->end()) : flow::TreePlace());
    ends.push_back(is_inside ? path.at(treatment->begin()) : flow::TreePlace());
  }
  request_.probes.insert(request_.probes.end(), ends.begin(), ends.end());
}

/** Finds the thrust Δp·A of the blood on inflated balloons, by the pressures at their ends. */
void BloodCoupling::findThrusts(const rod::State& state, const BalloonTreatments& treatments)
{
  thrusts_.clear();
  if (!now_)
    return;
  auto end = static_cast<std::size_t>(
      std::count_if(lines_.begin(), lines_.end(), [](const auto& line) { return line.has_value(); }));
  for (int k = 0; k < static_cast<int>(pieces_.size()); ++k)
  {
    const intervention::Treatment* treatment = treatments.of(k);
    if (treatment == nullptr)
      continue;
    const double before = now_->field.probes.at(end), behind = now_->field.probes.at(end + 1);
    end += 2;
    const double centre = 0.5 * (treatment->begin() + treatment->end());
    const double radius = std::min(treatment->radiusAt(centre), treatments.presentRadius(k));
    const double from_end = behindEnd(k, state) + centre;
    if (treatment->end() >= insertionOf(k, state) ||
        radius < kWideBalloon * pieces_[static_cast<std::size_t>(k)].front().radius)
      continue;
    thrusts_.push_back({k, from_end, (before - behind) * kPi * radius * radius});
  }
}

bool BloodCoupling::isSoft(const rod::Discretisation& rod, int node) const
{
  return settings_.drag == scene::FlowDrag::kAll || rod.bending_stiffness[node] < kSoft;
}

BloodCoupling::StreamSample BloodCoupling::sampleAt(const rod::State& state, const rod::Discretisation& rod, int node,
                                                    const flow::TreePlace& place) const
{
  const double speed = places().velocityAt(now_->field, place);
  StreamSample sample;
  sample.from_end = rod.length() - rod.position[node];
  if (place.branch < 0 || std::abs(speed) < kSlowest)
    return sample;
  sample.velocity = speed * paths().tangentAt(place);
  const flow::Circulation& blood = settings_.circulation;
  const Eigen::Vector3d along = rod::tangentAt(state, node);
  const Eigen::Vector3d relative = sample.velocity - state.velocity[node];
  const double across = (relative - relative.dot(along) * along).norm();
  const double radius = rod.radius[node];
  const int cell = places().cellAt(place);
  const double lumen = std::sqrt(places().tree().tree.cells[static_cast<std::size_t>(cell)].wall.area / kPi);
  sample.crosswise = flow::crosswiseDrag(2.0 * radius, across, blood.density, blood.viscosity);
  sample.axial = flow::axialDrag(std::min(radius, kWidest * lumen), lumen, blood.viscosity);
  return sample;
}

/** Finds the stream along the soft part of the wire, from its end. */
void BloodCoupling::sampleStream(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest,
                                 const motion::MotionMap* map, const rod::Discretisation& rod)
{
  stream_.clear();
  if (!now_ || settings_.drag == scene::FlowDrag::kNone)
    return;
  const double mouth = rod.length() - state.inserted_length;
  int last = -1;
  flow::TreePlace place;
  const auto sample = [&](int node)
  {
    place = paths().locate(at_rest[node], place);
    stream_.push_back(sampleAt(state, rod, node, place));
    if (map != nullptr && stream_.back().crosswise != 0.0)
      stream_.back().velocity = carried(stream_.back().velocity, at_rest[node], *map);
  };
  for (int i = rod.nodes() - 1; i > state.first_node && rod.position[i] > mouth; --i)
  {
    if (!isSoft(rod, i))
      break;
    last = i;
    if (stream_.empty() || rod.length() - rod.position[i] >= stream_.back().from_end + kStreamSpacing)
    {
      sample(i);
      last = -1;
    }
  }
  if (last >= 0)
    sample(last);
}

void BloodCoupling::addLoads(const rod::State& state, const rod::Discretisation& rod, rod::StepInput& input) const
{
  for (const Thrust& thrust : thrusts_)
  {
    const WirePoint at = pointOf(state, state.position, rod, thrust.from_end);
    const Eigen::Vector3d along = (state.position[at.node + 1] - state.position[at.node]).normalized();
    input.forces.push_back({at.node, (1.0 - at.share) * thrust.force * along, thrust.instrument});
    input.forces.push_back({at.node + 1, at.share * thrust.force * along, thrust.instrument});
  }
  if (stream_.empty())
    return;
  std::size_t k = 0;
  for (int i = rod.nodes() - 1; i > state.first_node; --i)
  {
    const double from_end = rod.length() - rod.position[i];
    if (from_end > stream_.back().from_end)
      break;
    while (k + 1 < stream_.size() && stream_[k + 1].from_end < from_end)
      ++k;
    const StreamSample here = between(stream_[k], stream_[std::min(k + 1, stream_.size() - 1)], from_end);
    if (here.crosswise == 0.0)
      continue;
    const Eigen::Vector3d along = rod::tangentAt(state, i);
    rod::NodalDrag drag;
    drag.node = i;
    drag.stream = here.velocity;
    drag.coefficient = rod.cell_length[i] * (here.crosswise * Eigen::Matrix3d::Identity() +
                                             (here.axial - here.crosswise) * along * along.transpose());
    input.drags.push_back(drag);
  }
  std::reverse(input.drags.begin(), input.drags.end());
}

void BloodCoupling::archive(Archive& archive)
{
  if (!archive.reading() && pending_ && !next_)
    next_ = source_->answer();
  std::string tag = kTag;
  archive(tag);
  requireLoaded(tag == kTag, "holds no flow of blood");
  archive(controls_, request_.step, now_, next_, stream_, thrusts_);
  if (!archive.reading())
    return;
  for (const std::optional<flow::FlowAnswer>* answer : {&now_, &next_})
    if (*answer)
    {
      requireLength(places().tree().tree.cells.size(), (*answer)->field.flows, (*answer)->field.areas);
      requireLength(static_cast<std::size_t>(places().tree().tree.nodes), (*answer)->field.pressures);
    }
  request_.state = now_ ? now_->state : "";
  pending_ = next_.has_value();
  is_measured_ = false;
}

}  // namespace endovascular_sim::simulation
