#include "flow/coupling/flow_engine.h"

#include <stdexcept>
#include <utility>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kBehindLesion = 0.02;  // distance of the pressure behind a lesion from its end [m]
constexpr unsigned kSettlingBeats = 6;  // of the vessel with its lesions, at the beginning of a run

std::vector<TreePlace> placesBehind(const std::vector<vessel::PlacedLesion>& lesions)
{
  std::vector<TreePlace> places;
  for (const vessel::PlacedLesion& lesion : lesions)
    places.push_back({lesion.branch, lesion.end + kBehindLesion});
  return places;
}

}  // namespace

std::vector<bool> branchesWithLesions(std::size_t branches, const std::vector<vessel::PlacedLesion>& lesions)
{
  std::vector<bool> fine(branches, false);
  for (const vessel::PlacedLesion& lesion : lesions)
    fine.at(static_cast<std::size_t>(lesion.branch)) = true;
  return fine;
}

void FlowEngine::Sums::archive(Archive& archive)
{
  archive(root, readings, lesions, beat, samples, hyperaemia);
}

FlowEngine::FlowEngine(const vessel::CentrelineTree& centreline, const std::vector<vessel::PlacedLesion>& lesions,
                       const Circulation& circulation, double time_step, std::vector<LineSettings> lines,
                       std::vector<double> volumes)
  : behind_lesions_(placesBehind(lesions)),
    body_(withoutLesions(centreline, lesions), circulation, time_step,
          branchesWithLesions(centreline.branches.size(), lesions)),
    at_rest_(body_),
    line_settings_(std::move(lines))
{
  if (!volumes.empty())
    contrast_.emplace(body_.vessel(), centreline, std::move(volumes));
}

void FlowEngine::setControls(const FlowControls& controls)
{
  body_.heart().setRate(controls.heart_rate);
  if (body_.meanPressure() != controls.mean_pressure)
    body_.setMeanPressure(controls.mean_pressure);
  if (body_.isHyperaemic() != controls.hyperaemia)
    body_.setHyperaemia(controls.hyperaemia);
}

/** Begins a run: the flow in the healthy vessel at rest adapts to the controls and to the lesions. */
void FlowEngine::begin(const FlowRequest& request)
{
  body_ = at_rest_;
  if (contrast_)
    contrast_->clear(body_.network());
  setControls(request.controls);
  body_.setObstruction(request.lumens, request.instruments);
  const unsigned end = body_.heart().beats() + kSettlingBeats;
  while (request.controls.heart_rate > 0.0 && body_.heart().beats() < end)
    body_.step();
  lines_.clear();
  for (std::size_t k = 0; k < line_settings_.size(); ++k)
    lines_.emplace_back(line_settings_[k].frequency, line_settings_[k].damping, pressureAtPlace(request.probes[k]));
  clearSums();
  means_ = BeatMeans();
  means_.readings = sums_.readings;
  means_.lesions = sums_.lesions;
}

/** Pressure at a place; outside the vessel that of the air [Pa]. */
double FlowEngine::pressureAtPlace(const TreePlace& place) const
{
  return place.branch < 0 ? 0.0 : body_.pressureAt(place.branch, place.arc);
}

void FlowEngine::step(const FlowRequest& request, FlowAnswer& answer)
{
  if (request.probes.size() < line_settings_.size())
    throw std::invalid_argument("flow: the request has fewer places than there are pressure lines");
  if (request.state.empty())
    begin(request);
  else
  {
    Archive before(request.state);
    archive(before);
    setControls(request.controls);
    body_.setObstruction(request.lumens, request.instruments);
  }
  if (contrast_)
    contrast_->beforeStep(request.injection, body_.network());
  else if (request.injection.volume != 0.0)
    throw std::invalid_argument("flow: contrast medium is injected into a vessel whose volumes are not known");
  body_.step();
  if (contrast_)
    contrast_->afterStep(body_.network());
  for (std::size_t k = 0; k < lines_.size(); ++k)
    lines_[k].step(pressureAtPlace(request.probes[k]), body_.network().settings().time_step);
  addToBeat(request);
  fill(request, answer.field);
  answer.step = request.step;
  Archive after;
  archive(after);
  answer.state = after.bytes();
}

/** Completes the mean values of the last beat. */
void FlowEngine::endBeat(std::uint64_t step)
{
  const double count = sums_.samples;
  means_.root = sums_.root / count;
  for (std::size_t k = 0; k < lines_.size(); ++k)
    means_.readings[k] = sums_.readings[k] / count;
  for (std::size_t k = 0; k < behind_lesions_.size(); ++k)
    means_.lesions[k] = sums_.lesions[k] / count;
  means_.hyperaemia = sums_.hyperaemia;
  means_.step = step;
  clearSums();
}

void FlowEngine::clearSums()
{
  sums_ = Sums();
  sums_.beat = body_.heart().beats();
  sums_.readings.assign(lines_.size(), 0.0);
  sums_.lesions.assign(behind_lesions_.size(), 0.0);
}

void FlowEngine::addToBeat(const FlowRequest& request)
{
  if (body_.heart().beats() != sums_.beat)
    endBeat(request.step);
  ++sums_.samples;
  sums_.root += body_.rootPressure();
  for (std::size_t k = 0; k < lines_.size(); ++k)
    sums_.readings[k] += lines_[k].reading();
  for (std::size_t k = 0; k < behind_lesions_.size(); ++k)
    sums_.lesions[k] += body_.pressureAt(behind_lesions_[k].branch, behind_lesions_[k].arc);
  sums_.hyperaemia = sums_.hyperaemia && request.controls.hyperaemia;
}

void FlowEngine::fill(const FlowRequest& request, FlowField& field) const
{
  const FlowNetwork& network = body_.network();
  field.phase = body_.heart().phase();
  field.beats = body_.heart().beats();
  field.ventricle = body_.ventriclePressure();
  field.pressures.resize(static_cast<std::size_t>(network.tree().nodes));
  for (std::size_t k = 0; k < field.pressures.size(); ++k)
    field.pressures[k] = network.pressure(k);
  field.flows.resize(network.tree().cells.size());
  field.areas.resize(field.flows.size());
  for (std::size_t k = 0; k < field.flows.size(); ++k)
  {
    field.flows[k] = network.flow(k);
    field.areas[k] = network.freeArea(k);
  }
  field.probes.clear();
  for (const TreePlace& place : request.probes)
    field.probes.push_back(pressureAtPlace(place));
  field.readings.clear();
  for (const PressureLine& line : lines_)
    field.readings.push_back(line.reading());
  field.means = means_;
  field.iodine.clear();
  field.totals = IodineTotals();
  if (contrast_)
    contrast_->fill(field);
}

void FlowEngine::archive(Archive& archive)
{
  body_.archive(archive);
  if (archive.reading() && lines_.size() != line_settings_.size())
  {
    lines_.clear();
    for (const LineSettings& line : line_settings_)
      lines_.emplace_back(line.frequency, line.damping, 0.0);
  }
  for (PressureLine& line : lines_)
    line.archive(archive);
  archive(sums_, means_);
  if (archive.reading())
  {
    requireLength(lines_.size(), sums_.readings, means_.readings);
    requireLength(behind_lesions_.size(), sums_.lesions, means_.lesions);
  }
  archiveContrast(archive);
}

/** The end of a state, which only states of vessels with contrast medium have. */
void FlowEngine::archiveContrast(Archive& archive)
{
  const bool is_held = archive.reading() ? !archive.atEnd() : contrast_ && contrast_->isUsed();
  if (archive.reading() && contrast_)
    contrast_->clear(body_.network());
  if (archive.reading() && !is_held)
    body_.network().setInjected(0.0);
  if (!is_held)
    return;
  requireLoaded(contrast_.has_value(), "holds contrast medium, and the volumes of the vessel are not known");
  contrast_->archive(archive, body_.network());
}

}  // namespace endovascular_sim::flow
