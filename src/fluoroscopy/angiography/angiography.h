#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/angiography/mask.h"
#include "fluoroscopy/angiography/peak_opacity.h"
#include "fluoroscopy/fluoroscope.h"

namespace endovascular_sim::fluoroscopy
{

/** Modes of an angiography system. */
enum class XRayMode
{
  kLive,         ///< fluoroscopy or cine, without subtraction
  kSubtraction,  ///< DSA: frames minus a mask
  kRoadmap,      ///< live frames over the peak opacity of the last DSA run
  kHold          ///< no X-rays: the last image stays
};

/** Name of a mode: live, dsa, roadmap, hold. */
const char* nameOf(XRayMode mode);

/** Mode of a name. @throws InputError for an unknown one */
XRayMode xRayModeOf(const std::string& name);

/** State of the mask. */
enum class MaskState
{
  kNone,    ///< none in use
  kTaking,  ///< its frames are being taken
  kValid,
  kInvalid  ///< something has moved since
};

/** Frame in a mode. */
struct AngiographyFrame
{
  std::uint64_t pulse = 0;
  XRayMode mode = XRayMode::kLive;
  Frame native;                          ///< as the detector has taken it; its display has the roadmap
  std::vector<std::uint8_t> subtracted;  ///< display of the DSA; empty without a valid mask
  MaskState mask = MaskState::kNone;     ///< of DSA, and of the roadmap
  std::string remark;                    ///< reason and remedy of an invalid mask, progress of one that is taken
};

/** Angiography with one detector: modes, mask, pixel shift, roadmap, last-image hold.
 *
 *  A frame is a function of its pulse, the state of patient and instruments, pose, technique, mode and mask. DSA keeps
 *  the exposure of the first frame of its mask. Frames of a mask must be drawn without a gap in their pulses
 *  (takesMask()); all others may be left out. */
class Angiography
{
public:
  static constexpr int kMostMaskFrames = 64;     ///< of one mask
  static constexpr double kLargestShift = 64.0;  ///< of the mask [pixel]

  /** @param fluoroscope must outlive this
   *  @param detector 0; 1 for the second one of a biplane system */
  explicit Angiography(Fluoroscope& fluoroscope, int detector = 0)
    : fluoroscope_(fluoroscope), display_(fluoroscope.scene().display), detector_(detector)
  {
  }

  /** Begins a run in a mode.
   *  @param mask_frames frames of a new mask for DSA; 0: the present mask
   *  @throws InputError, which changes nothing: for DSA without a mask, a roadmap without a DSA run, another mode with
   *          mask frames, or too many of them */
  void begin(XRayMode mode, int mask_frames = 0);

  /** Moves the mask, from the next frame on. @throws InputError beyond kLargestShift
   *  @param shift towards larger columns and rows [pixel] */
  void setShift(const Eigen::Vector2d& shift);

  /** Share of the roadmap in the image, from the next frame on. @throws InputError outside of 0 to 1 */
  void setShare(double share);

  XRayMode mode() const { return mode_; }
  const Eigen::Vector2d& shift() const { return shift_; }  ///< [pixel]
  double share() const { return share_; }                  ///< [1]

  /** True while every pulse must be drawn. */
  bool takesMask() const { return mode_ == XRayMode::kSubtraction && !mask_->isComplete(); }

  /** Draws the frame of a pulse. @pre the mode is not kHold
   *  @param display false: without the display image of the native frame
   *  @param complete true: the patient has the final resolution from the first frame on, as in all modes but live */
  const AngiographyFrame& draw(std::uint64_t pulse, const std::vector<XRayWire>& wires, bool display = true,
                               bool complete = false);

  /** Last frame, also in the mode kHold; null before the first one. */
  const AngiographyFrame* last() const { return last_ ? &*last_ : nullptr; }

private:
  void subtract();
  void prepareRoadmap();

  Fluoroscope& fluoroscope_;
  Display display_;  ///< of the DSA
  int detector_;
  XRayMode mode_ = XRayMode::kLive;
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
  double share_ = 0.5;
  std::optional<Mask> mask_;
  PeakOpacity peak_;            ///< of the frames that mask_ was subtracted from
  std::vector<float> roadmap_;  ///< peak opacity at the beginning of the roadmap
  std::optional<AngiographyFrame> last_;
};

}  // namespace endovascular_sim::fluoroscopy
