#include "fluoroscopy/angiography/angiography.h"

#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "fluoroscopy/angiography/subtraction.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr std::pair<XRayMode, const char*> kModes[] = {{XRayMode::kLive, "live"},
                                                       {XRayMode::kSubtraction, "dsa"},
                                                       {XRayMode::kRoadmap, "roadmap"},
                                                       {XRayMode::kHold, "hold"}};

}  // namespace

const char* nameOf(XRayMode mode)
{
  for (const auto& [value, name] : kModes)
    if (value == mode)
      return name;
  return "";
}

XRayMode xRayModeOf(const std::string& name)
{
  for (const auto& [value, known] : kModes)
    if (known == name)
      return value;
  throw InputError("X-ray", "mode", "unknown mode '" + name + "'; known: live, dsa, roadmap, hold");
}

void Angiography::begin(XRayMode mode, int mask_frames)
{
  if (mask_frames < 0 || mask_frames > kMostMaskFrames)
    throw InputError("X-ray", "mask_frames",
                     formatted("is %d; must lie between 0 and %d", mask_frames, kMostMaskFrames));
  if (mask_frames > 0 && mode != XRayMode::kSubtraction)
    throw InputError("X-ray", "mask_frames", "only the mode dsa takes a mask; leave mask_frames at 0");
  if (mode == XRayMode::kSubtraction && mask_frames == 0 && !(mask_ && mask_->isComplete()))
    throw InputError("X-ray", "mask_frames", "there is no mask to subtract; give mask_frames of 1 or more to take one");
  if (mode == XRayMode::kRoadmap && peak_.empty())
    throw InputError("X-ray", "mode",
                     "a roadmap needs a DSA run with contrast medium; begin one with the mode dsa, and inject in it");
  if (mask_frames > 0)
    mask_.emplace(mask_frames);
  if (mode == XRayMode::kSubtraction)
    peak_ = PeakOpacity();
  roadmap_ = mode == XRayMode::kRoadmap ? peak_.image() : std::vector<float>();
  mode_ = mode;
}

void Angiography::setShift(const Eigen::Vector2d& shift)
{
  if (!(shift.cwiseAbs().maxCoeff() <= kLargestShift) || !shift.allFinite())
    throw InputError("X-ray", "shift",
                     formatted("is (%g, %g) pixels; must lie between -%g and %g", shift.x(), shift.y(), kLargestShift,
                               kLargestShift));
  shift_ = shift;
}

void Angiography::setShare(double share)
{
  if (!(share >= 0.0 && share <= 1.0))
    throw InputError("X-ray", "share", formatted("is %g; must lie between 0 and 1", share));
  share_ = share;
}

/** Mixes the roadmap into the display while nothing has moved since its mask. */
void Angiography::prepareRoadmap()
{
  AngiographyFrame& frame = *last_;
  std::vector<float> overlay;
  if (mode_ == XRayMode::kRoadmap)
  {
    frame.remark = motionBetween(mask_->pose(), fluoroscope_.geometry().pose());
    frame.mask = frame.remark.empty() ? MaskState::kValid : MaskState::kInvalid;
    if (frame.mask == MaskState::kValid)
      overlay = roadmap_;
    else
      frame.remark += " since the roadmap was taken; begin a new DSA run";
  }
  for (float& value : overlay)
    value *= static_cast<float>(share_);
  fluoroscope_.setOverlay(std::move(overlay));
}

/** Takes the frame into the mask, or subtracts the mask from it. */
void Angiography::subtract()
{
  AngiographyFrame& frame = *last_;
  const CArmPose& pose = fluoroscope_.geometry().pose();
  if (!mask_->isComplete())
  {
    mask_->add(frame.pulse, frame.native.raw, frame.native.tube_charge, pose);
    frame.mask = MaskState::kTaking;
    frame.remark = formatted("frame %d of %d of the mask", mask_->taken(), mask_->wanted());
    return;
  }
  frame.remark = motionBetween(mask_->pose(), pose);
  frame.mask = frame.remark.empty() ? MaskState::kValid : MaskState::kInvalid;
  if (frame.mask == MaskState::kInvalid)
  {
    frame.remark += " since the mask was taken; take a new one";
    return;
  }
  const std::vector<float> difference =
      logDifference(frame.native.raw, mask_->logarithms(), frame.native.pixels, shift_);
  peak_.add(difference, frame.native.pixels);
  display_.drawDifference(frame.native.pixels, fluoroscope_.collimator(), difference, frame.subtracted);
}

const AngiographyFrame& Angiography::draw(std::uint64_t pulse, const std::vector<XRayWire>& wires, bool display,
                                          bool complete)
{
  if (!last_)
    last_.emplace();
  AngiographyFrame& frame = *last_;
  frame.pulse = pulse;
  frame.mode = mode_;
  frame.subtracted.clear();
  frame.mask = MaskState::kNone;
  frame.remark.clear();
  prepareRoadmap();
  Pulse exposed;
  exposed.number = pulse;
  exposed.detector = detector_;
  exposed.complete = complete || mode_ != XRayMode::kLive;
  const bool has_mask = mode_ == XRayMode::kSubtraction && mask_->taken() > 0;
  const bool is_next = has_mask && mask_->pose() == fluoroscope_.geometry().pose() && pulse == mask_->lastPulse() + 1;
  if (has_mask && (mask_->isComplete() || is_next))
    exposed.tube_charge = mask_->tubeCharge();
  frame.native = fluoroscope_.render(wires, exposed, display);
  if (mode_ == XRayMode::kSubtraction)
    subtract();
  return frame;
}

}  // namespace endovascular_sim::fluoroscopy
