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
    background_mean_(pose.pixels)
{
  tissue_ = response_.solid("soft_tissue");
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
  display_.reset();
  if (pose.pixels != before.pixels || pose.detector_width != before.detector_width ||
      pose.source_to_detector != before.source_to_detector || pose.field_width != before.field_width ||
      pose.field_height != before.field_height)
  {
    collimator_ = Collimator(pose.pixels, pose.detector_width, pose.field_width, pose.field_height);
    detector_ =
        DetectorImage(pose.pixels, pose.detector_width, pose.source_to_detector, exposure_.water(), collimator_.side());
    background_mean_ = CoarseImage(pose.pixels);
  }
}

void Fluoroscope::setVessel(geometry::TriangleMesh mesh)
{
  requireVesselInFrontOfSource(geometry_, mesh);
  vessel_.setMesh(std::move(mesh));
  vessel_is_current_ = false;
  background_valid_ = false;
}

void Fluoroscope::setPatient(std::unique_ptr<Patient> patient)
{
  patient_ = std::move(patient);
  patient_->setMotion(motion_);
  background_valid_ = false;
}

void Fluoroscope::setMotion(const BodyMotion& motion)
{
  if (motion == motion_)
    return;
  motion_ = motion;
  patient_->setMotion(motion);
  vessel_is_current_ = false;
  background_valid_ = false;
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

/** Logarithm of the mean signal in the central circle, as far as it lies in the field of the collimator. */
double Fluoroscope::measuredSignal() const
{
  const int n = geometry_.pixels();
  const double centre = geometry_.centre(), radius = 0.5 * kMeasuringField * n;
  double sum = 0.0;
  std::size_t count = 0;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      if (std::hypot(row - centre, column - centre) <= radius && collimator_.share(row, column) > 0.99F)
      {
        sum += static_cast<double>(background_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) +
                                               static_cast<std::size_t>(column)]);
        ++count;
      }
  return std::log(sum / static_cast<double>(count));
}

void Fluoroscope::updateBackground()
{
  const ArealDensityImage& patient = patient_->frame(geometry_);
  if (background_valid_ && patient_->revision() == patient_revision_)
    return;
  patient_revision_ = patient_->revision();
  if (!vessel_is_current_)
    vessel_.project(geometry_, motion_.map());
  vessel_is_current_ = true;
  const std::vector<double>& lengths = vessel_.lengths();
  const double lumen_density = patient_->lumenDensity();
  background_.resize(lengths.size());
  weight_.resize(lengths.size());
  steel_slope_.resize(lengths.size());
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    const double length = lengths[k];
    ArealDensities densities{static_cast<double>(patient.tissue[k]), static_cast<double>(patient.bone[k]), 0.0};
    if (length > 0.0)
    {
      densities.tissue = std::max(densities.tissue - lumen_density * length, 0.0) + blood_density_ * length;
      densities.iodine = scene_.iodine * length;
    }
    const Response response = table_.at(densities);
    background_[k] = std::max(response.log_signal, kSmallestLogSignal);
    weight_[k] = response.variance_weight;
    steel_slope_[k] = response.steel_slope;
  }
  exponentials(background_.data(), background_.size());
  collimator_.apply(background_);
  background_mean_.average(background_);
  measured_ = measuredSignal();
  background_valid_ = true;
}

void Fluoroscope::restart()
{
  frames_ = 0;
  exposure_.reset();
  display_.reset();
}

const Frame& Fluoroscope::render(const std::vector<XRayWire>& wires, bool display)
{
  updateBackground();
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
  frame_.tube_charge = exposure_.next(measured_, pose.source_to_detector, pose.source_to_patient);
  frame_.reference_kerma = exposure_.referenceKerma(frame_.tube_charge, pose.source_to_patient);
  frame_.dose_limited = exposure_.limited();
  detector_.form({frame_.tube_charge, scene_.seed, frames_}, signal_, mean, weight_, frame_.raw);
  if (display)
    display_.draw(pose.pixels, pose.detector_width, DetectorImage::kCountsPerGray * scene_.exposure.detector_dose,
                  detector_.counts(), collimator_, frame_.raw, frame_.image);
  ++frames_;
  return frame_;
}

}  // namespace endovascular_sim::fluoroscopy
