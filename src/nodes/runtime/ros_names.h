#pragma once

#include "drive/joint_command.h"

/** Names of all topics, services, frames and shared parameters (docs/ROS_INTERFACE.md). */
namespace endovascular_sim::nodes::names
{

// Parameters in the namespace of the graph, read by every node.
constexpr auto kSceneParameter = "scene";           ///< path of the scene file
constexpr auto kSceneTextParameter = "scene_text";  ///< text of a recorded scene, in place of the path
constexpr auto kOverridesParameter =
    "overrides";  ///< changed values of the scene: "key.path=value", separated by spaces

// Frames (REP-103). The patient frame has DICOM's axes: x to the patient's left, y posterior, z to the head.
constexpr auto kPatientFrame = "patient";
constexpr auto kIntroducerFrame = "introducer";
constexpr auto kTipFrame = "wire_tip";
constexpr auto kTipFrameOf = "_tip";  ///< after the name of an instrument with a pressure line
constexpr auto kXRaySourceFrame = "x_ray_source_optical";
constexpr auto kXRaySourceViewFrame = "x_ray_source_view_optical";

constexpr auto kVesselMesh = "vessel/mesh";
constexpr auto kVesselCentreline = "vessel/centreline";
constexpr auto kGetVessel = "vessel/get";
constexpr auto kWallState = "vessel/wall_state";
constexpr auto kTakeWall = "contact/take_wall";
constexpr auto kBalloonLoad = "vessel/balloon_load";
constexpr auto kWallDisplacement = "vessel/wall_displacement";
constexpr auto kVesselMarker = "vessel/marker";
constexpr auto kClickedPoint = "/clicked_point";  ///< of rviz's tool "Publish Point"

constexpr auto kRodState = "rod/state";
constexpr auto kRodStateVisual = "rod/state_visual";
constexpr auto kWireMarker = "wire/marker";
constexpr auto kTipPathMarker = "wire/tip_path";
constexpr auto kTreatmentVisual = "treatment/state_visual";
constexpr auto kBalloonMarker = "treatment/balloon_marker";
constexpr auto kStentMarker = "treatment/stent_marker";
constexpr auto kContactSet = "contact/set";
constexpr auto kContactForces = "contact/forces";
constexpr auto kContactForceMap = "contact/force_map";
constexpr auto kContactForceMarker = "contact/force_marker";
constexpr auto kForceLegendMarker = "contact/legend_marker";

constexpr auto kDriveApplied = "drive/applied";
constexpr auto kProcedureStep = "procedure/step";
constexpr auto kGoToStep = "procedure/go_to_step";
constexpr auto kSessionInfo = "session/info";
constexpr auto kSessionSample = "session/sample";
constexpr auto kSessionSteps = "session/steps";
constexpr auto kSessionEnd = "session/end";  ///< in recordings only
constexpr auto kSessionGap = "session/gap";  ///< in recordings only
constexpr auto kSessionStart = "session/start";
constexpr auto kSessionStop = "session/stop";
constexpr auto kSessionMark = "session/mark";  ///< service, and topic of its remarks
constexpr auto kSessionProgress = "session/progress";
constexpr auto kSessionVerdict = "session/verdict";
constexpr auto kExpertResults = "expert_results";  ///< parameter: folder of the expert's results
constexpr auto kShowExpert = "expert/show";        ///< plays the expert's recording alone
constexpr auto kAlignExpert = "expert/align";
constexpr auto kExpertState = "expert/state";
constexpr auto kExpertVisual = "expert/state_visual";
constexpr auto kExpertTreatment = "expert/treatment_visual";
constexpr auto kExpertScene = "expert/scene";
constexpr auto kSetSubject = "session/set_subject";

constexpr auto kPlayerState = "player/state";
constexpr auto kPlayerControl = "player/control";

constexpr auto kClock = "/clock";
constexpr auto kSimulationRun = "simulation/run";
constexpr auto kSimulationPause = "simulation/pause";
constexpr auto kSimulationResume = "simulation/resume";
constexpr auto kSimulationReset = "simulation/reset";
constexpr auto kSimulationSave = "simulation/save_state";
constexpr auto kSimulationLoad = "simulation/load_state";
constexpr auto kContinueRecording = "simulation/continue_recording";
constexpr auto kSimulationStep = "simulation/step";

constexpr auto kFluoroscopyRaw = "fluoroscopy/image_raw";
constexpr auto kFluoroscopyImage = "fluoroscopy/image";
constexpr auto kFluoroscopyCameraInfo = "fluoroscopy/camera_info";
constexpr auto kSourceViewRaw = "fluoroscopy/source_view/image_raw";
constexpr auto kSourceViewImage = "fluoroscopy/source_view/image";
constexpr auto kSourceViewCameraInfo = "fluoroscopy/source_view/camera_info";
constexpr auto kCArmCommand = "fluoroscopy/c_arm";
constexpr auto kFluoroscopyDsa = "fluoroscopy/dsa";
constexpr auto kFluoroscopyFrame = "fluoroscopy/frame";
constexpr auto kSetXRayMode = "fluoroscopy/mode";

constexpr auto kFlowRequest = "hemodynamics/request";
constexpr auto kFlowAnswer = "hemodynamics/answer";
constexpr auto kFlowNetwork = "hemodynamics/network";
constexpr auto kBloodFlow = "hemodynamics/flow";
constexpr auto kHeartPhase = "hemodynamics/phase";
constexpr auto kTipPressure = "hemodynamics/tip_pressure";
constexpr auto kHemodynamicControls = "hemodynamics/controls";
constexpr auto kSetHemodynamics = "hemodynamics/set";

constexpr auto kMotionState = "motion/state";
constexpr auto kMotionControls = "motion/controls";
constexpr auto kSetMotion = "motion/set";

constexpr auto kContrastCells = "contrast/cells";
constexpr auto kContrastState = "contrast/state";
constexpr auto kContrastInjection = "contrast/injection";
constexpr auto kInjectContrast = "contrast/inject";

constexpr auto kSensors = "sensors/";  ///< followed by the name of the sensor

constexpr auto kDiagnostics = "/diagnostics";

constexpr auto kRobotDescription = "robot_description";       ///< parameter with the text of the robot's URDF
constexpr auto kRobotDescriptionTopic = "robot/description";  ///< the same text, for recordings
constexpr auto kRobotJointStates = "robot/joint_states";

// CRTK names below "instruments/<name>/", "haptic/<channel>/" and "robot/".
constexpr auto kInstruments = "instruments/";
constexpr auto kRobot = "robot";
constexpr auto kHaptic = "haptic/";
constexpr auto kServoJp = "/servo_jp";
constexpr auto kServoJr = "/servo_jr";
constexpr auto kServoJv = "/servo_jv";
constexpr auto kServoJf = "/servo_jf";
constexpr auto kMoveJp = "/move_jp";
constexpr auto kMoveJr = "/move_jr";
constexpr auto kHold = "/hold";
constexpr auto kFree = "/free";
constexpr auto kStateCommand = "/state_command";
constexpr auto kMeasuredJs = "/measured_js";
constexpr auto kSetpointJs = "/setpoint_js";
constexpr auto kGoalJs = "/goal_js";
constexpr auto kMeasuredCp = "/measured_cp";
constexpr auto kMeasuredCf = "/measured_cf";
constexpr auto kOperatingState = "/operating_state";
constexpr auto kStateReason = "/state_reason";
constexpr auto kFault = "/fault";  ///< service of instruments
using drive::kInsertionJoint;
using drive::kPressureJoint;
using drive::kRotationJoint;

}  // namespace endovascular_sim::nodes::names
