#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "contact/wall/wall_law.h"
#include "drive/drive_limits.h"
#include "flow/body/circulation.h"
#include "fluoroscopy/gantry/gantry_limits.h"
#include "instrument/instrument.h"
#include "motion/body/motion_settings.h"
#include "robot/command_fault.h"
#include "robot/joint_link.h"
#include "robot/robot_model.h"
#include "rod/stepping/scheme_traits.h"
#include "rod/stepping/stepper.h"
#include "scene/model/scene_contrast.h"
#include "scene/model/scene_procedure.h"
#include "sensor/sensor_settings.h"
#include "vessel/anatomy/tube.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::scene
{

/** Vessel of a scene. Exactly one of mesh, anatomy and tube is set. */
struct VesselScene
{
  std::string mesh;   ///< path of an OBJ, STL or PLY file
  double unit = 1.0;  ///< metres per unit of the mesh file (0.001 for millimetres)
  /** Transform from the frame of the mesh file, after the unit, to the patient frame: x left, y posterior, z head. */
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  int smoothing = 0;       ///< number of Loop subdivisions of the mesh, 0 to 3
  bool repair = true;      ///< true: repair defects that are safe to repair; false: reject a mesh with defects
  std::string centreline;  ///< path of an anatomy file with the mesh's centreline and its names; empty: extracted

  std::string anatomy;  ///< path of an anatomy YAML file, for a generated vessel

  /** Channel of circular cross-section; it starts at the entry, whatever its own start is. */
  std::optional<vessel::TubeShape> tube;

  /** Shape of the wall: the facets, or the smooth surface through their vertices. */
  contact::WallShape wall = contact::WallShape::kFacets;
  /** Stiffness of the wall per length of wire [N/m²]; infinite: rigid. */
  double stiffness = std::numeric_limits<double>::infinity();
  double friction = 0.0;  ///< Coulomb coefficient of the wall [1]

  std::vector<contact::WallLaw::FrictionRegion> friction_regions;

  std::vector<vessel::Lesion> lesions;  ///< lesions added to the smoothed vessel
};

/** Entry of the wire into the vessel: a pose, or an end of the centreline. */
struct EntryScene
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< position in the patient frame [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit vector into the vessel
  /** Material director d1 of the wire at rotation 0; made orthogonal to direction. */
  Eigen::Vector3d up = Eigen::Vector3d::UnitX();
  bool nearest_centreline_end = false;  ///< true: use the centreline end nearest to position
  std::string centreline_end;           ///< name of a branch, to use its end; empty: not used
  double offset = 0.0;                  ///< distance of the entry from that end along the centreline [m]
  double valve_friction = 0.0;          ///< dry friction of the introducer's hemostatic valve on the wire [N]
};

/** Function of time: piecewise linear interpolation of points plus amplitude·sin(2π·frequency·t + phase). */
struct DriveProfile
{
  struct Point
  {
    double time = 0.0;   ///< time [s]
    double value = 0.0;  ///< value in the unit of the profile
  };
  std::vector<Point> points;  ///< increasing in time; constant before the first and after the last
  double amplitude = 0.0;     ///< amplitude in the unit of the profile
  double frequency = 0.0;     ///< frequency [Hz]
  double phase = 0.0;         ///< phase [rad]

  /** Value at time t [s]. */
  double at(double t) const;

  /** True if the value is zero at all times. */
  bool isTrivial() const { return points.empty() && amplitude == 0.0; }
};

/** Source of the commands for an instrument. */
enum class DriveSource
{
  kNone,       ///< no drive (bench scene)
  kScript,     ///< profiles of the scene
  kDevice,     ///< haptic device (in the node graph); offline, the profiles replace the operator
  kTopic,      ///< /instruments/<name>/servo_jp from another source, e.g. a robot or a bag
  kProcedure,  ///< scripted operator of the scene's procedure
};

/** Drive of an instrument at its handle. */
struct DriveScene
{
  DriveSource source = DriveSource::kNone;
  /** Constant insertion speed until `travel` is reached [m/s]; NaN: use the insertion profile. */
  double speed = std::numeric_limits<double>::quiet_NaN();
  double travel = 0.0;             ///< distance covered at `speed` beyond initial_insertion [m]
  double initial_insertion = 0.0;  ///< length of the wire beyond the introducer at the start [m]
  double initial_rotation = 0.0;   ///< rotation at the start, added to the profile [rad]
  DriveProfile insertion;          ///< insertion relative to initial_insertion [m]
  DriveProfile rotation;           ///< rotation relative to initial_rotation [rad]
  DriveProfile pressure;           ///< pressure at the inflator of the instrument's balloon [Pa]
  drive::Grip grip = drive::Grip::kFingers;
  double force_limit = 5.0;    ///< axial force at which the grip slips or stops [N]
  double torque_limit = 0.05;  ///< torque at which the grip slips or stops [N·m]
  drive::DriveLimits limits;   ///< of the speed, and of the commands of a topic or device

  /** Commanded insertion at time t [s]: initial_insertion + min(speed·t, travel), or + insertion.at(t) without a speed;
   *  initial_insertion if the source is kNone [m]. */
  double insertionAt(double t) const;
  /** Commanded rotation at time t [s]: initial_rotation + rotation.at(t); initial_rotation if the source is kNone
   *  [rad]. */
  double rotationAt(double t) const;
  /** Commanded pressure of the balloon above blood pressure at time t [s]; 0 if the source is kNone [Pa]. */
  double pressureAt(double t) const;
};

/** Instrument with its drive. Several instruments are concentric (docs/PHYSICS.md, "Concentric stack"): an outer one
 *  can be inserted only over an inner one that fits into its lumen. */
struct DrivenInstrument
{
  instrument::Instrument instrument;
  DriveScene drive;
  double friction = 0.05;  ///< Coulomb coefficient with the next outer instrument [1]
  double fit_load = 0.0;   ///< normal load per length between the two when both are straight [N/m]

  /** Limits of the drive without empty values. */
  drive::DriveLimits limits() const
  {
    return drive.limits.completed(instrument.wire.length(), drive.force_limit, drive.torque_limit);
  }
};

/** Frame in which a robot stands. */
enum class RobotFrame
{
  kIntroducer,  ///< x into the vessel, at the entry
  kPatient,
};

/** Robot whose joints move instruments. */
struct RobotScene
{
  std::string urdf;         ///< path of the URDF
  robot::RobotModel model;  ///< its content; empty in a scene of a recording
  RobotFrame frame = RobotFrame::kIntroducer;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< origin of the robot's root link in the frame [m]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();       ///< its rotation about the fixed axes x, y and z, as URDF [rad]
  std::vector<robot::JointLink> joints;

  /** Transform of the root link to the frame. */
  Eigen::Isometry3d pose() const;
};

/** Prescribed motion of a held distal end. */
struct DistalScene
{
  bool twist_held = false;  ///< true: a clamped end also holds the twist
  /** Direction of the displacement; zero: the direction of the wire, so that negative values compress the wire. */
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  DriveProfile displacement;                            ///< displacement along direction [m]
  Eigen::Vector3d tilt_axis = Eigen::Vector3d::Zero();  ///< axis of the tilt
  DriveProfile tilt;                                    ///< rotation of the clamp's direction about tilt_axis [rad]
  DriveProfile rotation;  ///< rotation of a clamp with held twist about the wire's axis [rad]

  /** True if the end moves or holds the twist (SchemeTraits::moves_distal_end). */
  bool isDriven() const
  {
    return twist_held || !displacement.isTrivial() || !tilt.isTrivial() || !rotation.isTrivial();
  }
};

/** Force or torque on a point of the wire (bench scenes). */
struct PointLoad
{
  double position = 0.0;                            ///< distance from the proximal end [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< force [N]
  double torque = 0.0;                              ///< torque about the wire's axis, at the tip only [N·m]
  double ramp_time = 0.0;                           ///< duration of the linear ramp from zero [s]
};

/** Loads on the wire other than contact and the drive. */
struct LoadScene
{
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< gravitational acceleration [m/s²]
  double fluid_density = 0.0;     ///< density of the surrounding fluid [kg/m³]; 0: neither drag nor buoyancy
  double drag_coefficient = 1.2;  ///< drag coefficient of a cylinder in cross flow [1]
  double damping = 0.0;           ///< mass-proportional damping, for quasi-static bench scenes [1/s]
  std::vector<PointLoad> point_loads;
};

/** Rigid cylinder on which the wire rests or that presses it (bench scenes). */
struct RollerScene
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< point of its axis at the start [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      ///< unit vector
  double radius = 0.0;                                  ///< [m]
  double friction = 0.0;                                ///< Coulomb coefficient; 0: the wire slides freely
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< of the displacement, unit
  DriveProfile displacement;                            ///< displacement along direction [m]

  /** Point of the axis at time t [s]. */
  Eigen::Vector3d positionAt(double t) const { return position + displacement.at(t) * direction; }
};

enum class SamplingKind
{
  kUniform,
  kAdaptive,
};

/** Spatial discretisation of the wire. */
struct SamplingScene
{
  SamplingKind kind = SamplingKind::kUniform;
  int nodes = 240;  ///< number of nodes of the whole wire, uniform sampling
  // Adaptive sampling:
  double min_edge = 0.5e-3;     ///< edge length at or below which curvature causes no further split [m]
  double max_edge = 2.0e-3;     ///< largest edge length [m]
  double turn_per_edge = 0.05;  ///< turning angle of an edge above which it is split [rad]
  double min_age = 0.05;        ///< age from which edges may be merged [s]
};

/** Time integration. */
struct SolverScene
{
  std::string scheme = "kkt";               ///< name of the scheme (rod::SchemeTraits)
  rod::StepperSettings stepper;             ///< settings of the scheme
  double time_step = 1e-3;                  ///< time step [s]
  double max_travel_per_substep = 0.05e-3;  ///< largest travel of a handle per sub-step [m]
  double guide_length = 19e-3;              ///< length of the introducer's guide before its mouth [m]

  const rod::SchemeTraits& traits() const { return rod::schemeTraits(scheme); }
};

/** Instruments on which the stream of blood acts. */
enum class FlowDrag
{
  kNone,
  kSoft,  ///< sections with a bending stiffness below 50 N·mm²; the stream does not move stiffer ones visibly
  kAll,
};

/** Flow of blood in the vessel. */
struct FlowScene
{
  flow::Circulation circulation;
  double time_step = 5e-3;     ///< of the flow, a multiple of that of the solver [s]
  double heart_rate = 0.0;     ///< at the beginning [Hz]
  double mean_pressure = 0.0;  ///< at the beginning [Pa]
  bool hyperaemia = false;     ///< at the beginning
  FlowDrag drag = FlowDrag::kSoft;
};

/** Motion of the patient: heartbeat and breathing. */
struct MotionScene
{
  motion::MotionSettings patient;
  double heart_rate = 0.0;      ///< at the beginning [Hz]; with flow, that of the flow
  double breathing_rate = 0.0;  ///< at the beginning [Hz]
  bool breath_held = false;     ///< at the beginning
};

/** Body around the vessel in the X-ray image: procedural, or a CT. */
struct PatientScene
{
  bool body = false;  ///< true: procedural thorax, abdomen and pelvis
  std::string ct;     ///< otherwise: path of a CT volume written by volume_import
  /** Registration of the CT: transform from its frame to the patient frame. If empty, that of the vessel's mesh. */
  std::optional<Eigen::Isometry3d> patient_from_ct;
};

/** C-arm and X-ray imaging. */
struct FluoroscopyScene
{
  double rate = 15.0;               ///< frame rate [Hz]
  int pixels = 512;                 ///< width and height of the image [pixels]
  double primary_angle = 0.0;       ///< primary C-arm angle, positive LAO [rad]
  double secondary_angle = 0.0;     ///< secondary C-arm angle, positive cranial [rad]
  std::string view;                 ///< view that gives the two angles (fluoroscopy/gantry/view.h); empty: none
  double source_to_detector = 1.2;  ///< source-to-image distance (SID) [m]
  double source_to_patient = 0.75;  ///< source-to-object distance (SOD) [m]
  double detector_width = 0.30;     ///< width of the detector [m]
  double field_width = 0.0;         ///< width of the collimated field at the detector [m]; 0: open
  double field_height = 0.0;        ///< height of the collimated field at the detector [m]; 0: open
  /** Isocentre in the patient frame [m]; if empty, the centre of the vessel's bounding box. */
  std::optional<Eigen::Vector3d> isocentre;
  double tube_voltage = 80.0;  ///< tube voltage [kV]
  double aluminium = 2.5e-3;   ///< total filtration with aluminium [m]
  double copper = 0.2e-3;      ///< additional filtration with copper [m]
  /** Photon energy of a monoenergetic beam [keV]; if empty, the tube with its voltage and filtration. */
  std::optional<double> energy;
  double detector_dose = 30e-9;              ///< air kerma per frame at the detector [Gy]
  double max_air_kerma_rate = 88e-3 / 60.0;  ///< limit at the reference point [Gy/s]
  double edge_enhancement = 0.3;             ///< weight of the edges in the display image
  double zoom = 1.0;                         ///< magnification of the display image
  bool inverted = false;                     ///< true: contrast medium is bright in the display image
  double recursive_filter = 0.0;             ///< weight of the preceding frame in the display image
  double iodine = 150.0;                     ///< iodine concentration in the vessel [mgI/ml]
  double tissue_thickness = 0.20;            ///< thickness of the slab of soft tissue, without patient [m]
  std::optional<PatientScene> patient;       ///< if empty: the slab
  bool follow_tip = true;                    ///< true: the isocentre follows the tip of the wire
  fluoroscopy::GantryLimits gantry;          ///< limits and speeds of the C-arm and its table

  /** Initial pose of the C-arm; without an isocentre, that is the origin. */
  fluoroscopy::CArmPose pose() const;
};

/** Recording of results. */
struct RecordScene
{
  double pose_rate = 30.0;         ///< rate of the recorded poses [Hz]
  double trajectory_rate = 100.0;  ///< rows of trajectory.csv per second [Hz]
  /** Normal force of one contact above which its duration is counted [N]. The default of 0.1 N is about the tip load
   *  (10 gf) of wires for penetrating occlusions. Navigation in a healthy vessel should stay well below it. */
  double wall_force_threshold = 0.1;
  bool x_ray_frames = false;  ///< true: the bag contains every X-ray frame, at about 260 kB each before compression
};

/** Limits beyond which a session reports an error of the trainee (docs/PROCEDURES.md, "Errors"). They do not affect the
 *  motion. */
struct ErrorLimits
{
  double perforation_force = 0.5;    ///< force of a guidewire's tip in any step, of another tip if it lasts [N]
  double tip_force = 0.1;            ///< force of a foremost guidewire's tip that may not last [N]
  double tip_force_time = 1.0;       ///< time for which it may be larger [s]
  double support_time = 1.5;         ///< time for which catheter and wire may be out of the branch of their support [s]
  double support_withdrawal = 5e-3;  ///< withdrawal of the catheter's handle from which on this is intended [m]
};

/** Scene: all inputs of a run. docs/SCENES.md lists the keys of its YAML file. */
struct Scene
{
  std::string name;
  std::string file;  ///< path of the scene file
  std::uint64_t seed = 0;
  double duration = 10.0;  ///< simulated time [s]
  std::optional<VesselScene> vessel;
  EntryScene entry;
  std::vector<DrivenInstrument> instruments;        ///< ordered from the inside out; at least one
  std::optional<ProcedureScene> procedure;          ///< procedure of the scripted operator
  rod::EndHold proximal_end = rod::EndHold::kFree;  ///< bench scenes; a driven wire is held by its introducer
  rod::EndHold distal_end = rod::EndHold::kFree;
  DistalScene distal;      ///< motion of a held distal end
  bool introducer = true;  ///< true: the wire enters through an introducer; false: bench scene with the whole wire
  LoadScene loads;
  std::vector<RollerScene> rollers;  ///< in place of a vessel
  SamplingScene sampling;
  SolverScene solver;
  std::optional<FlowScene> flow;          ///< if empty, blood does not flow
  std::optional<ContrastScene> contrast;  ///< if empty, no contrast medium is injected
  std::optional<MotionScene> motion;      ///< if empty, the patient does not move
  std::optional<FluoroscopyScene> fluoroscopy;
  bool haptic_device = false;  ///< true: start the haptic device node
  std::optional<RobotScene> robot;
  std::vector<sensor::SensorSettings> sensors;
  std::vector<robot::FaultSettings> faults;  ///< of the robot's drives
  RecordScene record;
  std::optional<ErrorLimits> errors;  ///< empty: the defaults
  std::vector<std::string> warnings;  ///< unusual values, each with file, key and likely unit
  std::string resolved_yaml;          ///< canonical text of the scene, with overrides and included files merged

  /** Index of the instrument that injects contrast medium. @pre the scene has the key `contrast` */
  std::size_t injectingInstrument() const;

  /** Length of the longest instrument [m]. */
  double longest() const;

  /** Hash of resolved_yaml. */
  std::uint64_t hash() const;

  /** Hash of resolved_yaml without what does not belong to a state of the simulation: `fluoroscopy`, and who drives the
   *  instruments, the scripted operator (`procedure`) or a person (`guided`, `topic`). */
  std::uint64_t motionHash() const;
};

/** Nodes that a scene requires, by executable name, in the order of their start. */
std::vector<std::string> requiredNodes(const Scene& scene);

}  // namespace endovascular_sim::scene
