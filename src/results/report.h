#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "results/wall_force_map.h"

namespace endovascular_sim::results
{

/** Largest, mean and latest value of a quantity that is sampled over a run. */
class RunningValue
{
public:
  /** Adds a sample; samples that are not finite are left out. */
  void add(double value);

  std::uint64_t count() const { return count_; }
  double max() const { return max_; }      ///< of the magnitudes; 0 before the first sample
  double mean() const;                     ///< of the magnitudes; 0 before the first sample
  double final() const { return final_; }  ///< latest sample with its sign

private:
  std::uint64_t count_ = 0;
  double max_ = 0.0;
  double sum_ = 0.0;
  double final_ = 0.0;
};

/** What a session is of; all of it is known before the first step. */
struct SessionIdentity
{
  std::string scene_name;
  std::string scene_file;
  std::uint64_t scene_hash = 0;
  std::uint64_t mesh_hash = 0;  ///< 0 without a vessel
  std::uint64_t seed = 0;
  double time_step = 0.0;  ///< [s]
  double duration = 0.0;   ///< of the scene [s]
  std::string software_version;
  std::string commit;  ///< commit of the sources
  int physics = 0;     ///< number of the physics, see common/version.h
};

/** What became of the recording. */
struct RecordingOutcome
{
  std::string file;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;  ///< messages that the disk was too slow for
  std::string error;          ///< why it ended early; empty: it is complete
};

/** Collects what happens in a session and writes it down. Knows no clock and no messages. */
class SessionReport
{
public:
  explicit SessionReport(SessionIdentity identity);

  void setMeshHash(std::uint64_t mesh_hash) { identity_.mesh_hash = mesh_hash; }
  const SessionIdentity& identity() const { return identity_; }

  /** One step of the simulation.
   *  @param step its index, from 0
   *  @param wall_time when it ended, on any steady scale [s]
   *  @param stale true when a pass of it used an old contact set
   *  @param state_hash hash of the state after it */
  void addStep(std::uint64_t step, double wall_time, bool stale, std::uint64_t state_hash);

  /** Force [N] and torque [N·m] at the hand. */
  void addHand(double force, double torque);

  /** The wire's tip in the patient frame and how much wire is inside, both [m]. */
  void addTip(const Eigen::Vector3d& tip, double inserted_length, std::size_t nodes);

  /** Largest contact force at one moment [N] and the number of contacts that carry force. */
  void addContacts(double largest, std::size_t count);

  /** What the wall has borne so far, in place of what was told before.
   *  @param triangles how many were touched */
  void setWallForces(WallForceSummary summary, std::size_t triangles);

  /** Widens the vessel's bounding box by a vertex, patient frame [m]. */
  void addVesselPoint(const Eigen::Vector3d& point) { vessel_box_.extend(point); }

  void addFluoroscopyFrame() { ++fluoroscopy_frames_; }
  void addFluoroscopyPicture() { ++fluoroscopy_pictures_; }

  /** Latest value of a node's diagnostics, kept as it came. */
  void addDiagnostic(const std::string& node, const std::string& key, const std::string& value);

  std::uint64_t steps() const { return steps_; }
  double simulatedTime() const;  ///< [s]
  double wallTime() const;       ///< between the first and the last step [s]
  /** Simulated over elapsed time; nothing before the second step. */
  std::optional<double> realTimeFactor() const;
  /** Latest value of a node's diagnostics; nothing when it did not come or is not a number. */
  std::optional<double> diagnosticNumber(const std::string& node, const std::string& key) const;
  const RunningValue& handForce() const { return hand_force_; }
  double insertedLength() const { return inserted_length_.final(); }

  /** The report as JSON: SI units, hashes as 16 hexadecimal digits.
   *  @param error why the session ended too soon; empty: it did not */
  std::string json(const RecordingOutcome& recording, const std::string& error) const;

private:
  SessionIdentity identity_;
  std::uint64_t steps_ = 0;
  std::uint64_t first_step_ = 0;
  std::uint64_t last_step_ = 0;
  std::uint64_t missed_steps_ = 0;
  std::uint64_t repeated_steps_ = 0;
  std::uint64_t stale_steps_ = 0;
  std::uint64_t last_state_hash_ = 0;
  double first_wall_time_ = 0.0;
  double last_wall_time_ = 0.0;
  double longest_pause_ = 0.0;
  RunningValue hand_force_;
  RunningValue hand_torque_;
  RunningValue inserted_length_;
  RunningValue contact_force_;
  RunningValue contact_count_;
  std::optional<WallForceSummary> wall_forces_;
  std::size_t touched_triangles_ = 0;
  std::optional<Eigen::Vector3d> tip_;
  double tip_path_ = 0.0;
  std::size_t nodes_ = 0;
  Eigen::AlignedBox3d vessel_box_;
  std::uint64_t fluoroscopy_frames_ = 0;
  std::uint64_t fluoroscopy_pictures_ = 0;
  std::map<std::string, std::map<std::string, std::string>> diagnostics_;
};

}  // namespace endovascular_sim::results
