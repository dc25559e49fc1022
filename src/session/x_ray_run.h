#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/angiography/angiography.h"
#include "fluoroscopy/angiography/pulse_train.h"
#include "session/session.h"
#include "simulation/fluoroscopy_system.h"

namespace endovascular_sim::session
{

/** Settings of a run of X-ray frames. */
struct XRayRunSettings
{
  /** Views of one C-arm or of both of a biplane system, in clinical notation; an empty one is that of the scene. */
  std::vector<std::string> views = {""};
  int mask_frames = 0;                              ///< of DSA; 0: without
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the mask, towards larger columns and rows [pixel]
  /** Simulated time at which the DSA run ends: from then on frames show its roadmap [s]. */
  std::optional<double> roadmap_at;
};

/** Least number of steps that reach a simulated time [s], up to rounding. */
std::uint64_t stepsUntil(double time, double time_step);

/** Run of X-ray frames at the pulses of a session, in one or two poses that rest.
 *
 *  The frames are those of the node of fluoroscopy, bit for bit, with the same pose and mode. Any of them may be left
 * out but those of a mask. Without an isocentre in the scene, and with `follow_tip`, it is the tip at the first pulse;
 * with neither, the middle of the vessel. Both detectors of a biplane system take their frames at the same pulse,
 * without scatter of the other tube. */
class XRayRun
{
public:
  /** @param world must outlive this; its patient is loaded
   *  @throws InputError for a scene without fluoroscopy, other than one or two views, an unknown view, an impossible
   * mask or shift, a roadmap without a mask */
  explicit XRayRun(const World& world, const XRayRunSettings& settings = {});

  /** True if a pulse is given at the present step. */
  bool isDue(const simulation::Simulation& simulation) const { return pulses_.isPulse(simulation.steps()); }

  /** Verifies that a run between two pulses, both included, has the frames that its settings ask for.
   *  @throws InputError if the mask, or the run of DSA before a roadmap, would be incomplete */
  void requireFrames(std::uint64_t first, std::uint64_t last) const;

  /** Draws the frames of the present step, which must be due.
   *  @throws std::logic_error if it is not
   *  @throws InputError if the source would lie in the vessel */
  void draw(const Session& session);

  /** Detectors: 1, or 2 of a biplane system. */
  std::size_t detectors() const { return planes_.size(); }

  /** Newest frame of a detector, valid until the next one. @pre draw() was called */
  const fluoroscopy::AngiographyFrame& frame(std::size_t detector = 0) const
  {
    return *planes_.at(detector).angiography.last();
  }

  const fluoroscopy::PulseTrain& pulses() const { return pulses_; }

private:
  /** One C-arm of the system. */
  struct Plane
  {
    Plane(const World& world, const std::string& view, int detector);

    simulation::FluoroscopySystem system;
    fluoroscopy::Angiography angiography;
  };

  void place(const Session& session);

  const World& world_;
  fluoroscopy::PulseTrain pulses_;
  std::uint64_t mask_frames_;
  std::optional<std::uint64_t> first_of_roadmap_;  ///< pulse
  std::deque<Plane> planes_;                       ///< a deque, because nothing in it moves
  bool placed_ = false;                            ///< the isocentre is known
  std::optional<std::uint64_t> wall_;              ///< version of the wall in the images
};

}  // namespace endovascular_sim::session
