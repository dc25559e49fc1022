#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "results/recording_notes.h"
#include "results/wall_force_map.h"

namespace endovascular_sim::results
{

/** Running maximum, mean and latest value of a sampled quantity. */
class RunningValue
{
public:
  /** Adds a sample; non-finite samples are ignored. */
  void add(double value);

  std::uint64_t count() const { return count_; }
  double max() const { return max_; }      ///< largest absolute value; 0 without samples
  double mean() const;                     ///< mean absolute value; 0 without samples
  double final() const { return final_; }  ///< latest sample, with its sign

private:
  std::uint64_t count_ = 0;
  double max_ = 0.0;
  double sum_ = 0.0;
  double final_ = 0.0;
};

/** Identity of a session, known before the first step. */
struct SessionIdentity
{
  std::string scene_name;
  std::string scene_file;
  std::uint64_t scene_hash = 0;
  std::uint64_t mesh_hash = 0;  ///< hash of the vessel's mesh; 0 without a vessel
  std::uint64_t seed = 0;
  double time_step = 0.0;  ///< time step [s]
  double duration = 0.0;   ///< duration of the scene [s]
  std::string software_version;
  std::string commit;  ///< commit of the sources
  int physics = 0;     ///< number of the physics, see common/version.h
};

/** Outcome of the recording. */
struct RecordingOutcome
{
  std::string file;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;          ///< messages dropped: after an early end, or because the disk was too slow
  std::vector<std::string> previous;  ///< names of the bags of the same run before this one
  std::string error;                  ///< reason of an early end; empty: the recording is complete
};

/** Report of a session, accumulated from its data. The class depends on no clock and no messages. */
class SessionReport
{
public:
  explicit SessionReport(SessionIdentity identity);

  /** @param subject pseudonym of the trainee; empty: unknown */
  void setSubject(const std::string& subject) { subject_ = subject; }
  void add(const Remark& remark) { notes_.remarks.push_back(remark); }
  void add(const RecordingGap& gap) { notes_.gaps.push_back(gap); }
  const RecordingNotes& notes() const { return notes_; }

  void setMeshHash(std::uint64_t mesh_hash) { identity_.mesh_hash = mesh_hash; }
  const SessionIdentity& identity() const { return identity_; }

  /** Sets wall times that addStep() could not know, because its clock is not that of the wall.
   *  @param wall_time between the first and the last step [s]
   *  @param longest_pause between two steps [s] */
  void setWallTimes(double wall_time, double longest_pause);

  /** Sets the first step that the session should hold, by default 0. */
  void setFirstStep(std::uint64_t step) { expected_first_ = step; }

  /** Adds a step of the simulation.
   *  @param step index of the step, from 0
   *  @param wall_time end of the step on any steady clock [s]
   *  @param stale true if the step used a stale contact set
   *  @param state_hash hash of the state after the step */
  void addStep(std::uint64_t step, double wall_time, bool stale, std::uint64_t state_hash);

  /** Adds a step's rendered forces [N] and torques [N·m], one per instrument. The statistics are those of the hand with
   *  the largest one in each step. */
  void addHands(const std::vector<double>& forces, const std::vector<double>& torques);

  /** Adds the tip of the wire in the patient frame [m], the inserted length [m] and the number of nodes. */
  void addTip(const Eigen::Vector3d& tip, double inserted_length, std::size_t nodes);

  /** Sets the wall forces accumulated so far.
   *  @param triangles number of triangles with contact */
  void setWallForces(WallForceSummary summary, std::size_t triangles);

  /** Extends the bounding box of the vessel by a vertex, patient frame [m]. */
  void addVesselPoint(const Eigen::Vector3d& point) { vessel_box_.extend(point); }

  void addFluoroscopyFrame() { ++fluoroscopy_frames_; }
  void addFluoroscopyPictures(std::uint64_t count) { fluoroscopy_pictures_ += count; }

  /** Sets the latest value of a diagnostic of a node. */
  void addDiagnostic(const std::string& node, const std::string& key, const std::string& value);

  std::uint64_t steps() const { return steps_; }
  std::uint64_t lastStep() const { return steps_ > 0 ? last_step_ + 1 : 0; }  ///< number of the last step, from 1
  double simulatedTime() const;                                               ///< simulated time [s]
  double wallTime() const;                                ///< wall time between the first and the last step [s]
  double longestPause() const { return longest_pause_; }  ///< longest wall time between two steps [s]
  /** Ratio of simulated to elapsed time; empty before the second step. */
  std::optional<double> realTimeFactor() const;
  /** Latest value of a diagnostic of a node; empty if it is missing or not a number. */
  std::optional<double> diagnosticNumber(const std::string& node, const std::string& key) const;
  const RunningValue& handForce() const { return hand_force_; }
  double insertedLength() const { return inserted_length_.final(); }

  /** Report as JSON: SI units, hashes as 16 hexadecimal digits.
   *  @param error reason of an early end of the session; empty: none */
  std::string json(const RecordingOutcome& recording, const std::string& error) const;

private:
  SessionIdentity identity_;
  std::string subject_;
  RecordingNotes notes_;
  std::uint64_t steps_ = 0;
  std::uint64_t expected_first_ = 0;
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
  std::optional<WallForceSummary> wall_forces_;
  std::size_t touched_triangles_ = 0;
  std::optional<Eigen::Vector3d> tip_;
  std::size_t nodes_ = 0;
  Eigen::AlignedBox3d vessel_box_;
  std::uint64_t fluoroscopy_frames_ = 0;
  std::uint64_t fluoroscopy_pictures_ = 0;
  std::map<std::string, std::map<std::string, std::string>> diagnostics_;
};

}  // namespace endovascular_sim::results
