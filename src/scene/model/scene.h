#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "instrument/instrument.h"
#include "rod/stepping/scheme_traits.h"
#include "rod/stepping/stepper.h"
#include "scene/model/scene_procedure.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::scene
{

/** The vessel of a scene, or none. Exactly one of mesh, anatomy, tube is set. */
struct VesselScene
{
  std::string mesh;   ///< path of an OBJ, STL or PLY file
  double unit = 1.0;  ///< metres per unit of the mesh file (0.001 for millimetres)
  /** From the mesh file's frame (after the unit) to the patient frame: x left, y posterior, z head. */
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  int smoothing = 0;   ///< Loop subdivisions of the mesh, 0 to 3
  bool repair = true;  ///< repair what is safe; false refuses every defect

  std::string anatomy;  ///< path of an anatomy YAML file, for the generated vessel

  /** A channel of circular cross-section: straight pieces and arcs, starting at the entry. */
  struct TubePiece
  {
    double length = 0.0;       ///< arc length [m]
    double curvature = 0.0;    ///< 1/m, 0 for a straight piece
    double plane_angle = 0.0;  ///< direction in which it bends, about the tube's axis at the start of the piece [rad]
  };
  struct Tube
  {
    double radius = 0.0;        ///< [m]
    double facet_length = 0.0;  ///< longest facet along the axis [m]
    int facets_around = 32;     ///< facets around the circumference
    std::vector<TubePiece> pieces;
  };
  std::optional<Tube> tube;

  double stiffness =
      std::numeric_limits<double>::infinity();  ///< of the wall per length of wire [N/m²]; infinite: rigid
  double friction = 0.0;                        ///< Coulomb coefficient [1]

  /** A ball within which the wall has a coefficient of its own. Of several that hold a place, the last counts. */
  struct FrictionRegion
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< patient frame [m]
    double radius = 0.0;                               ///< [m]
    double friction = 0.0;                             ///< Coulomb coefficient [1]
  };
  std::vector<FrictionRegion> friction_regions;

  std::vector<vessel::Lesion> lesions;  ///< put on the smoothed vessel
};

/** Where the wire enters. A pose, or the centreline end nearest to a point. */
struct EntryScene
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< patient frame [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit vector into the vessel
  Eigen::Vector3d up =
      Eigen::Vector3d::UnitX();  ///< material direction d1 of the wire at rotation 0, made orthogonal to direction
  bool nearest_centreline_end = false;  ///< replace position and direction by the nearest end of the centreline
  std::string centreline_end;           ///< or by the end of the branch of this name; empty: not used
  double offset = 0.0;                  ///< how far inside that end the wire starts [m]
  double valve_friction = 0.0;          ///< dry friction of the introducer's valve on the wire [N]
};

/** Piece-wise linear function of time plus a sine: offset + ramp(t) + amplitude·sin(2π·frequency·t + phase). */
struct DriveProfile
{
  struct Point
  {
    double time = 0.0;   ///< [s]
    double value = 0.0;  ///< [m] or [rad]
  };
  std::vector<Point> points;  ///< increasing in time; held before the first and after the last
  double amplitude = 0.0;     ///< [m] or [rad]
  double frequency = 0.0;     ///< [Hz]
  double phase = 0.0;         ///< [rad]

  /** Value at time t [s]. */
  double at(double t) const;

  /** True where the value is zero at all times. */
  bool isTrivial() const { return points.empty() && amplitude == 0.0; }
};

enum class DriveSource
{
  kNone,       ///< bench scene: nothing is driven
  kScript,     ///< the scene's own profiles
  kDevice,     ///< the haptic device (in the graph); offline, the profiles stand in for the operator
  kTopic,      ///< /instruments/<name>/servo_jp from elsewhere (a robot, a bag)
  kProcedure,  ///< the scripted operator of the scene's procedure
};

/** Where the motion at the hand comes from. */
struct DriveScene
{
  DriveSource source = DriveSource::kNone;
  /** Constant pushing speed until `travel` is reached; NaN: use the insertion profile [m/s]. */
  double speed = std::numeric_limits<double>::quiet_NaN();
  double travel = 0.0;             ///< how far `speed` pushes beyond initial_insertion [m]
  double initial_insertion = 0.0;  ///< wire beyond the introducer at the start [m]
  double initial_rotation = 0.0;   ///< added to the rotation at all times [rad]
  DriveProfile insertion;          ///< [m], added to initial_insertion
  DriveProfile rotation;           ///< [rad], added to initial_rotation
  DriveProfile pressure;           ///< at the inflator of the instrument's balloon [Pa]
  double force_limit = 5.0;        ///< axial force at which the hand slips [N]
  double torque_limit = 0.05;      ///< torque at which the hand slips [N·m]

  /** Commanded insertion at time t [s]: initial_insertion + min(speed·t, travel), or + insertion.at(t) without a speed;
   *  initial_insertion where the source is kNone [m]. */
  double insertionAt(double t) const;
  /** Commanded rotation at time t [s]: initial_rotation + rotation.at(t); initial_rotation where the source is kNone
   * [rad]. */
  double rotationAt(double t) const;
  /** Commanded pressure of the balloon at time t [s]; 0 where the source is kNone [Pa, above that of the blood]. */
  double pressureAt(double t) const;
};

/** One instrument, and the hand that drives it. Several lie one inside the other (docs/PHYSICS.md, "Concentric stack"):
 *  an outer one can only be inserted over an inner one that fits into its lumen. */
struct DrivenInstrument
{
  instrument::Instrument instrument;
  DriveScene drive;
  double friction = 0.05;  ///< Coulomb coefficient with the next outer instrument [1]
  double fit_load = 0.0;   ///< with which the two press on each other even when nothing bends [N/m]
};

/** What a held distal end does besides staying where it began. */
struct DistalScene
{
  bool twist_held = false;  ///< of a clamped end
  /** Direction of the displacement; zero: the wire's own, so that negative values bring the ends together. */
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  DriveProfile displacement;  ///< [m]
  Eigen::Vector3d tilt_axis = Eigen::Vector3d::Zero();
  DriveProfile tilt;      ///< of a clamp's direction about tilt_axis [rad]
  DriveProfile rotation;  ///< of a clamp that holds the twist, about the wire's axis [rad]

  /** True where the end moves, or holds the twist (SchemeTraits::moves_distal_end). */
  bool isDriven() const
  {
    return twist_held || !displacement.isTrivial() || !tilt.isTrivial() || !rotation.isTrivial();
  }
};

/** A force or a torque held on a place of the wire (bench scenes). */
struct PointLoad
{
  double position = 0.0;                            ///< distance from the proximal end [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N]
  double torque = 0.0;                              ///< about the wire's axis [N·m]; at the tip only
  double ramp_time = 0.0;                           ///< the load grows linearly over this time [s]
};

/** What acts on the wire besides the wall and the hand. */
struct LoadScene
{
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  double fluid_density = 0.0;     ///< of the fluid around the wire, for drag and buoyancy; 0 computes none [kg/m³]
  double drag_coefficient = 1.2;  ///< of a cylinder across the stream [1]
  double damping = 0.0;           ///< mass-proportional, for quasi-static bench scenes [1/s]
  std::vector<PointLoad> point_loads;
};

enum class SamplingKind
{
  kUniform,
  kAdaptive,
};

/** Discretisation of the wire in space. */
struct SamplingScene
{
  SamplingKind kind = SamplingKind::kUniform;
  int nodes = 240;  ///< over the whole wire, uniform sampling
  // Adaptive sampling:
  double min_edge = 0.5e-3;     ///< an edge this long or shorter is not split for its curvature [m]
  double max_edge = 2.0e-3;     ///< no edge is longer [m]
  double turn_per_edge = 0.05;  ///< an edge that turns by more is split [rad]
  double min_age = 0.05;        ///< that edges must have lived before they are merged [s]
};

/** Time stepping. */
struct SolverScene
{
  std::string scheme = "kkt";               ///< see rod::SchemeTraits
  rod::StepperSettings stepper;             ///< settings of the scheme
  double time_step = 1e-3;                  ///< [s]
  double max_travel_per_substep = 0.05e-3;  ///< of a handle; faster motion is divided into sub-steps [m]
  double guide_length = 19e-3;              ///< length over which the introducer's guide fades [m]

  const rod::SchemeTraits& traits() const { return rod::schemeTraits(scheme); }
};

/** C-arm and X-ray, or none. */
struct FluoroscopyScene
{
  double rate = 15.0;                        ///< [Hz]
  int pixels = 512;                          ///< width and height of the image
  double primary_angle = 0.0;                ///< positive LAO [rad]
  double secondary_angle = 0.0;              ///< positive cranial [rad]
  double source_to_detector = 1.2;           ///< SID [m]
  double source_to_patient = 0.75;           ///< SOD [m]
  double detector_width = 0.30;              ///< [m]
  std::optional<Eigen::Vector3d> isocentre;  ///< patient frame [m]; empty: the centre of the vessel's bounding box
  double energy = 60.0;                      ///< effective photon energy [keV]
  double iodine = 150.0;                     ///< concentration in the vessel [mgI/ml]
  double tissue_thickness = 0.20;            ///< slab of soft tissue [m]
  bool follow_tip = true;                    ///< the isocentre follows the wire's tip
};

/** What is written down. */
struct RecordScene
{
  double pose_rate = 30.0;         ///< [Hz]
  double trajectory_rate = 100.0;  ///< rows of trajectory.csv per second [Hz]
  /** Normal force of one contact above which its time is counted [N]. 0.1 N is about the tip load (10 gf) of wires that
   *  are made to penetrate occlusions; what steers through a healthy vessel should stay well below it. */
  double wall_force_threshold = 0.1;
};

/** One scene: everything a run depends on. Read from one YAML file; docs/SCENES.md lists every key. */
struct Scene
{
  std::string name;
  std::string file;  ///< where it was read from
  std::uint64_t seed = 0;
  double duration = 10.0;  ///< [s]
  std::optional<VesselScene> vessel;
  EntryScene entry;
  std::vector<DrivenInstrument> instruments;        ///< from the inside out; at least one
  std::optional<ProcedureScene> procedure;          ///< of a scripted operator
  rod::EndHold proximal_end = rod::EndHold::kFree;  ///< of bench scenes; an introducer holds a driven wire
  rod::EndHold distal_end = rod::EndHold::kFree;
  DistalScene distal;      ///< the motion of a held distal end
  bool introducer = true;  ///< wire born at the introducer; false: bench, the whole wire is there from the start
  LoadScene loads;
  SamplingScene sampling;
  SolverScene solver;
  std::optional<FluoroscopyScene> fluoroscopy;
  bool haptic_device = false;  ///< start the haptic device node
  RecordScene record;
  std::string resolved_yaml;  ///< canonical text of the scene with overrides and included files merged in

  /** Length of the longest instrument [m]. */
  double longest() const;

  /** Hash of resolved_yaml. */
  std::uint64_t hash() const;
};

/** The nodes that a scene needs, by executable name, in the order in which they are started. */
std::vector<std::string> requiredNodes(const Scene& scene);

}  // namespace endovascular_sim::scene
