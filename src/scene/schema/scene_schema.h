#pragma once

#include <string>
#include <utility>

#include "common/quantities.h"
#include "scene/model/scene.h"
#include "yaml/fields.h"

namespace endovascular_sim::scene
{

using yaml::Need;
using yaml::Range;

/** Schema of a scene: visits each key and, while reading, rejects inconsistent values. docs/SCENES.md documents the
 *  same keys for the user. */
void visitScene(yaml::Fields& fields, Scene& scene);

/** Parts of the schema. */
void visitVessel(yaml::Fields& fields, VesselScene& vessel);
/** Key `friction`: a coefficient, or one of the words `hydrophilic`, `ptfe`, `bare`. If optional, it may remain NaN. */
void visitFriction(yaml::Fields& fields, double& friction, Need need);
void visitEntry(yaml::Fields& fields, EntryScene& entry, const std::optional<VesselScene>& vessel);
/** True for a name that can be a part of a topic: letters, digits and _, with a letter first. */
bool isTopicName(const std::string& name);
/** Schema of any instrument of the library. */
void visitInstrument(yaml::Fields& fields, instrument::Instrument& instrument);
/** Schema of an instrument with a drive: any kind except a separate stent. */
void visitDrivenInstrument(yaml::Fields& fields, instrument::Instrument& instrument);
/** Schema of the balloon of a balloon catheter. */
void visitBalloon(yaml::Fields& fields, instrument::Instrument& instrument);
/** Schema of a stent, on a balloon or separate. */
void visitStent(yaml::Fields& fields, instrument::Instrument& instrument);
/** Schema of `instrument` and `drive` of a single instrument, or of the list `instruments`. */
void visitInstruments(yaml::Fields& fields, Scene& scene);
/** Path of the map that contains the drive of an instrument: empty for a single one, otherwise `instruments.<k>.`. */
std::string drivePath(const Scene& scene, std::size_t k);
/** Rejects invalid combinations of concentric instruments. */
void checkStack(const yaml::Fields& fields, const Scene& scene);
/** Schema of `robot`. Checks what does not depend on the URDF; the joints are checked when it has been read. */
void visitRobot(yaml::Fields& fields, Scene& scene);
/** Schema of the list `sensors`. */
void visitSensors(yaml::Fields& fields, Scene& scene);
/** Schema of the list `faults`. */
void visitFaults(yaml::Fields& fields, Scene& scene);
/** Key `instrument`, the name of one of the scene's instruments; optional where there is only one. */
void visitInstrumentName(yaml::Fields& fields, const Scene& scene, std::size_t& instrument);
/** Schema of a drive.
 *  @param initial_insertion valid range of the initial insertion [m]
 *  @param balloon true if the instrument has a balloon that the drive can inflate */
void visitDrive(yaml::Fields& fields, DriveScene& drive, const Range& initial_insertion, bool balloon);
/** Schema of the limits of a drive, keys `drive.limits`. */
void visitLimits(yaml::Fields& fields, drive::DriveLimits& limits, bool balloon);
void visitProfile(yaml::Fields& fields, DriveProfile& profile, const Quantity& quantity);
/** Schema of `flow`. */
void visitFlow(yaml::Fields& fields, FlowScene& flow);
/** Rejects flow without a tree of vessels, or at a rate that the steps do not divide. */
void checkFlow(const yaml::Fields& fields, const Scene& scene);
/** Schema of `contrast`. @param scene with its instruments */
void visitContrast(yaml::Fields& fields, ContrastScene& contrast, const Scene& scene);
/** Keys `volume`, `rate` and `rise` of an injection. */
void visitInjection(yaml::Fields& fields, double& volume, double& rate, double& rise);
/** Rejects the value of an injection that a refusal of contrast::refusalOf() names by its first word.
 *  @param path of the injection, with a final dot */
void rejectInjection(const yaml::Fields& fields, const std::string& path, const std::string& refusal);
/** Rejects contrast medium without flow, beside an even one, without an instrument that injects it, and injections that
 *  overlap or have nothing inside. */
void checkContrast(const yaml::Fields& fields, const Scene& scene);
/** Schema of `motion`. @param flow drives the heart, if there is one */
void visitMotion(yaml::Fields& fields, MotionScene& motion, const std::optional<FlowScene>& flow);
/** Rejects motion without a vessel that instruments enter, and with a scheme whose walls rest. */
void checkMotion(const yaml::Fields& fields, const Scene& scene);
void visitEnds(yaml::Fields& fields, Scene& scene);
void visitLoads(yaml::Fields& fields, LoadScene& loads, double wire_length);
/** Schema of the list `rollers`. */
void visitRollers(yaml::Fields& fields, Scene& scene);
/** Rejects rollers beside a vessel, and those that the straight wire penetrates at the start. */
void checkRollers(const yaml::Fields& fields, const Scene& scene);
void visitSolver(yaml::Fields& fields, SolverScene& solver);
void visitFluoroscopy(yaml::Fields& fields, FluoroscopyScene& fluoroscopy);
/** Rejects a body without a vessel. */
void checkPatient(const yaml::Fields& fields, const Scene& scene);
/** Keys `rotation`, or `head` and `left`: rotation from the frame of a file to the patient frame. */
void visitRotation(yaml::Fields& fields, Eigen::Isometry3d& transform);
/** Keys of the initial angles: `view`, or `primary_angle` and `secondary_angle`. */
void visitAngulation(yaml::Fields& fields, FluoroscopyScene& fluoroscopy);
/** Keys `field` and `gantry`. Rejects an initial pose beyond the limits. */
void visitGantry(yaml::Fields& fields, FluoroscopyScene& fluoroscopy);
void visitProcedure(yaml::Fields& fields, ProcedureScene& procedure);

/** Rejects a view beyond the limits of the scene's gantry.
 *  @param key path of the view */
void checkView(const yaml::Fields& fields, const std::string& key, const std::string& view, const Scene& scene);

/** Rejects a procedure that is inconsistent with the scene. */
void checkProcedure(const yaml::Fields& fields, const Scene& scene);

/** Lower and upper bound of a profile. */
std::pair<double, double> bounds(const DriveProfile& profile);

/** Rejects inconsistent end conditions, wires and loads. */
void checkEnds(const yaml::Fields& fields, const Scene& scene);

}  // namespace endovascular_sim::scene
