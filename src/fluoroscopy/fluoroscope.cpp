#include "fluoroscopy/fluoroscope.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/fast_math.h"
#include "common/wide_vectors.h"
#include "fluoroscopy/projection/vessel_projection.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kMeasuringField =
    0.5;  // diameter of the measuring field of the exposure control, relative to the detector

/** Signal that prevents infinite logarithms behind very thick layers. */
constexpr float kSmallestLogSignal = -60.0F;

/** Stream of the noise of a pulse. */
std::uint64_t noiseOf(const Pulse& pulse)
{
  return pulse.number + (static_cast<std::uint64_t>(pulse.detector) << 62);
}

void checkScene(const XRayScene& scene)
{
  for (const double value : {scene.iodine, scene.tissue_thickness})
    if (!std::isfinite(value) || value < 0.0)
      throw InputError("X-ray scene", "iodine, tissue_thickness", "must be non-negative");
}

EVS_WIDE_VECTORS void exponentials(float* values, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k)
    values[k] = fastExp(values[k]);
}

/** Density of tissue that attenuates like blood, in the beam behind 20 cm of tissue [kg/m³]. */
double bloodAsTissue(const Beam& beam, const MaterialLibrary& library)
{
  const EnergyTable tissue = massAttenuationTable(library.composition("soft_tissue"));
  const EnergyTable blood = massAttenuationTable(library.composition("blood"));
  const Spectrum weight = filtered(beam.signal(), tissue, 200.0);
  double sum_tissue = 0.0, sum_blood = 0.0;
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
  {
    sum_tissue += weight[e] * tissue[e];
    sum_blood += weight[e] * blood[e];
  }
  return library.density("blood") * sum_blood / sum_tissue;
}

}  // namespace

Fluoroscope::Fluoroscope(const CArmPose& pose, const XRayScene& scene, const MaterialLibrary& library)
  : geometry_(pose),
    scene_((checkScene(scene), scene)),
    blood_density_(bloodAsTissue(Beam(scene.beam), library)),
    table_(Beam(scene.beam), library),
    response_(Beam(scene.beam), library),
    exposure_(Beam(scene.beam), scene.exposure),
    collimator_(pose.pixels, pose.detector_width, pose.field_width, pose.field_height),
    detector_(pose.pixels, pose.detector_width, pose.source_to_detector, exposure_.water(), collimator_.side()),
    display_(scene.display),
    patient_(std::make_unique<SlabPatient>(scene.tissue_thickness, library.density("soft_tissue"))),
    plain_mean_(pose.pixels),
    background_mean_(pose.pixels)
{
  tissue_ = response_.solid("soft_tissue");
  blood_ = response_.blood(0.0);
  iodine_ = response_.blood(1.0) - blood_;
}

void Fluoroscope::setPose(const CArmPose& pose)
{
  const CArmPose before = geometry_.pose();
  if (pose == before)
    return;
  const XRayGeometry geometry(pose);
  requireVesselInFrontOfSource(geometry, vessel_.mesh());
  geometry_ = geometry;
  vessel_is_current_ = false;
  background_valid_ = false;
  contrast_.reset();
  display_.reset();
  if (pose.pixels != before.pixels || pose.detector_width != before.detector_width ||
      pose.source_to_detector != before.source_to_detector || pose.field_width != before.field_width ||
      pose.field_height != before.field_height)
  {
    collimator_ = Collimator(pose.pixels, pose.detector_width, pose.field_width, pose.field_height);
    detector_ =
        DetectorImage(pose.pixels, pose.detector_width, pose.source_to_detector, exposure_.water(), collimator_.side());
    plain_mean_ = background_mean_ = CoarseImage(pose.pixels);
  }
}

void Fluoroscope::setVessel(geometry::TriangleMesh mesh)
{
  requireVesselInFrontOfSource(geometry_, mesh);
  if (contrast_.lumen() != nullptr && !contrast_.lumen()->fits(mesh))
  {
    contrast_.setLumen(nullptr);
    concentrations_.clear();
  }
  vessel_.setMesh(std::move(mesh));
  vessel_is_current_ = false;
  background_valid_ = false;
  contrast_.reset();
}

void Fluoroscope::setLumen(std::shared_ptr<const contrast::LumenCells> lumen)
{
  if (lumen && !lumen->fits(vessel_.mesh()))
    throw InputError("X-ray scene", "lumen",
                     "is that of another vessel; set the vessel whose lumen was divided before");
  setContrast({});
  contrast_.setLumen(std::move(lumen));
}

void Fluoroscope::setContrast(std::vector<double> concentrations)
{
  if (!concentrations.empty())
  {
    if (contrast_.lumen() == nullptr || concentrations.size() != contrast_.lumen()->part_of_cell.size())
      throw InputError("X-ray scene", "contrast", "must have one concentration for each cell of the lumen");
    for (const double value : concentrations)
      if (!std::isfinite(value) || value < 0.0)
        throw InputError("X-ray scene", "contrast", "must be non-negative");
  }
  if (concentrations.empty() != concentrations_.empty())
    background_valid_ = false;
  if (concentrations != concentrations_)
    contrast_is_current_ = false;
  concentrations_ = std::move(concentrations);
}

void Fluoroscope::setPatient(std::unique_ptr<Patient> patient)
{
  patient_ = std::move(patient);
  setPatientMotion();
}

void Fluoroscope::setPhases(std::shared_ptr<const PhaseGrid> phases)
{
  phases_ = std::move(phases);
  setPatientMotion();
}

void Fluoroscope::setPatientMotion()
{
  patient_->setMotion(phases_ ? phases_->nearest(motion_) : motion_);
  background_valid_ = false;
}

void Fluoroscope::setMotion(const BodyMotion& motion)
{
  if (motion == motion_)
    return;
  motion_ = motion;
  vessel_is_current_ = false;
  setPatientMotion();
}

LocalFluids Fluoroscope::vesselFluids() const
{
  const DeviceDensity blood = response_.blood(scene_.iodine);
  return {blood, blood};
}

LocalFluids Fluoroscope::tissueFluids() const
{
  return {tissue_, tissue_};
}

/** True in the central circle, as far as it lies in the field of the collimator. */
bool Fluoroscope::isMeasured(int row, int column) const
{
  const double centre = geometry_.centre(), radius = 0.5 * kMeasuringField * geometry_.pixels();
  return (row - centre) * (row - centre) + (column - centre) * (column - centre) <= radius * radius &&
         collimator_.share(row, column) > 0.99F;
}

Fluoroscope::Sum Fluoroscope::measuredSignal() const
{
  const int n = geometry_.pixels();
  Sum sum;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      if (isMeasured(row, column))
      {
        sum.value += static_cast<double>(background_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) +
                                                     static_cast<std::size_t>(column)]);
        ++sum.pixels;
      }
  return sum;
}

/** Densities along a pixel's ray, of which a length lies in the vessel; without iodine. */
ArealDensities Fluoroscope::densitiesAt(const ArealDensityImage& patient, std::size_t pixel, double length) const
{
  ArealDensities densities{static_cast<double>(patient.tissue[pixel]), static_cast<double>(patient.bone[pixel]), 0.0};
  if (length > 0.0)
    densities.tissue = std::max(densities.tissue - patient_->lumenDensity() * length, 0.0) + blood_density_ * length;
  return densities;
}

void Fluoroscope::updateBackground(bool complete)
{
  if (complete)
    patient_->complete(geometry_);
  const ArealDensityImage& patient = patient_->frame(geometry_);
  if (!background_valid_ || patient_->revision() != patient_revision_)
    drawBackground(patient);
  if (!concentrations_.empty() && !contrast_is_current_)
    drawContrast(patient);
}

void Fluoroscope::drawBackground(const ArealDensityImage& patient)
{
  patient_revision_ = patient_->revision();
  if (!vessel_is_current_)
    vessel_.project(geometry_, motion_.map());
  vessel_is_current_ = true;
  const std::vector<double>& lengths = vessel_.lengths();
  const double even_iodine = concentrations_.empty() ? scene_.iodine : 0.0;
  background_.resize(lengths.size());
  weight_.resize(lengths.size());
  steel_slope_.resize(lengths.size());
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    ArealDensities densities = densitiesAt(patient, k, lengths[k]);
    densities.iodine = even_iodine * lengths[k];
    const Response response = table_.at(densities);
    background_[k] = std::max(response.log_signal, kSmallestLogSignal);
    weight_[k] = response.variance_weight;
    steel_slope_[k] = response.steel_slope;
  }
  exponentials(background_.data(), background_.size());
  collimator_.apply(background_);
  background_mean_.average(background_);
  const Sum sum = measuredSignal();
  measured_ = std::log(sum.value / static_cast<double>(sum.pixels));
  background_valid_ = true;
  plain_pixels_.clear();
  plain_mean_ = background_mean_;
  plain_sum_ = sum;
  contrast_is_current_ = false;
}

void Fluoroscope::removeContrast()
{
  for (const PlainPixel& plain : plain_pixels_)
  {
    background_[plain.pixel] = plain.signal;
    weight_[plain.pixel] = plain.weight;
    steel_slope_[plain.pixel] = plain.steel_slope;
  }
  plain_pixels_.clear();
}

/** Draws the contrast medium over the background: a function of both, whatever was drawn before. */
void Fluoroscope::drawContrast(const ArealDensityImage& patient)
{
  removeContrast();
  contrast_.project(geometry_, motion_.map(), vessel_, concentrations_, iodine_image_);
  contrast_signal_.clear();
  for (std::size_t i = 0; i < iodine_image_.pixels.size(); ++i)
  {
    const std::size_t k = iodine_image_.pixels[i];
    plain_pixels_.push_back({k, background_[k], weight_[k], steel_slope_[k]});
    ArealDensities densities = densitiesAt(patient, k, vessel_.lengths()[k]);
    densities.iodine = static_cast<double>(iodine_image_.densities[i]);
    const Response response = table_.at(densities);
    contrast_signal_.push_back(std::max(response.log_signal, kSmallestLogSignal));
    weight_[k] = response.variance_weight;
    steel_slope_[k] = response.steel_slope;
  }
  exponentials(contrast_signal_.data(), contrast_signal_.size());
  background_mean_ = plain_mean_;
  Sum sum = plain_sum_;
  const auto n = static_cast<std::size_t>(geometry_.pixels());
  std::size_t row_begin = 0;
  int row = 0;
  for (std::size_t i = 0; i < plain_pixels_.size(); ++i)
  {
    const PlainPixel& plain = plain_pixels_[i];
    for (; plain.pixel >= row_begin + n; row_begin += n)
      ++row;
    const auto column = static_cast<int>(plain.pixel - row_begin);
    background_[plain.pixel] = contrast_signal_[i] * collimator_.transmission(row, column);
    const float change = background_[plain.pixel] - plain.signal;
    background_mean_.addPixel(row, column, change);
    if (isMeasured(row, column))
      sum.value += static_cast<double>(change);
  }
  measured_ = std::log(sum.value / static_cast<double>(sum.pixels));
  contrast_is_current_ = true;
}

void Fluoroscope::restart()
{
  frames_ = 0;
  display_.reset();
}

const Frame& Fluoroscope::render(const std::vector<XRayWire>& wires, bool display)
{
  Pulse pulse;
  pulse.number = frames_;
  const Frame& frame = render(wires, pulse, display);
  ++frames_;
  return frame;
}

const Frame& Fluoroscope::render(const std::vector<XRayWire>& wires, const Pulse& pulse, bool display)
{
  updateBackground(pulse.complete);
  wire_projection_.project(
      geometry_, wires, [this](std::uint32_t pixel) { return response_.coefficients(steel_slope_[pixel]); }, shadow_);
  signal_ = background_;
  CoarseImage mean = background_mean_;
  for (std::size_t i = 0; i < shadow_.pixels.size(); ++i)
  {
    const std::size_t k = shadow_.pixels[i];
    signal_[k] *= static_cast<float>(shadow_.transmission[i]);
    mean.addPixel(k, signal_[k] - background_[k]);
  }
  const CArmPose& pose = geometry_.pose();
  frame_.pixels = pose.pixels;
  frame_.tube_charge =
      pulse.tube_charge.value_or(exposure_.tubeCharge(measured_, pose.source_to_detector, pose.source_to_patient));
  frame_.reference_kerma = exposure_.referenceKerma(frame_.tube_charge, pose.source_to_patient);
  frame_.dose_limited = frame_.tube_charge >= exposure_.largestCharge(pose.source_to_patient);
  frame_.complete = patient_->isComplete();
  detector_.form({frame_.tube_charge, scene_.seed, noiseOf(pulse)}, signal_, mean, weight_, frame_.raw);
  if (pulse.complete)
    display_.reset();
  if (display)
    display_.draw(pose.pixels, pose.detector_width, DetectorImage::kCountsPerGray * scene_.exposure.detector_dose,
                  detector_.counts(), collimator_, frame_.raw, frame_.image);
  if (pulse.complete)
    display_.reset();
  return frame_;
}

}  // namespace endovascular_sim::fluoroscopy
