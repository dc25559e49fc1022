#pragma once

#include <string>
#include <utility>

#include "scene/model/scene.h"
#include "scene/yaml/fields.h"

namespace endovascular_sim::scene
{

/** The schema of a scene: visits every key, and while reading refuses values that contradict each other.
 *  docs/SCENES.md lists the same keys for the user. */
void visitScene(SceneFields& fields, Scene& scene);

/** Parts of the schema. */
void visitVessel(SceneFields& fields, VesselScene& vessel);
/** The key `friction`: a coefficient, or one of the words `hydrophilic`, `ptfe`, `bare`. Optional, it may stay NaN. */
void visitFriction(SceneFields& fields, double& friction, Need need);
void visitEntry(SceneFields& fields, EntryScene& entry, const std::optional<VesselScene>& vessel);
/** Any instrument of the library. */
void visitInstrument(SceneFields& fields, instrument::Instrument& instrument);
/** One that a hand or a drive pushes: any but a stent by itself. */
void visitDrivenInstrument(SceneFields& fields, instrument::Instrument& instrument);
/** The balloon of a balloon catheter, and the stent on it or by itself. */
void visitBalloon(SceneFields& fields, instrument::Instrument& instrument);
void visitStent(SceneFields& fields, instrument::Instrument& instrument);
/** `instrument` and `drive` of one, or the list `instruments` of several. */
void visitInstruments(SceneFields& fields, Scene& scene);
/** Path of the map that holds the drive of an instrument: empty for the only one, else `instruments.<k>.`. */
std::string drivePath(const Scene& scene, std::size_t k);
/** Refuses what several instruments on one centreline cannot be. */
void checkStack(const SceneFields& fields, const Scene& scene);
/** @param initial_insertion what it may be [m]
 *  @param balloon whether the instrument has one, which the drive can inflate */
void visitDrive(SceneFields& fields, DriveScene& drive, const Range& initial_insertion, bool balloon);
void visitProfile(SceneFields& fields, DriveProfile& profile, const std::string& unit);
void visitEnds(SceneFields& fields, Scene& scene);
void visitLoads(SceneFields& fields, LoadScene& loads, double wire_length);
void visitSolver(SceneFields& fields, SolverScene& solver);
void visitFluoroscopy(SceneFields& fields, FluoroscopyScene& fluoroscopy);
void visitProcedure(SceneFields& fields, ProcedureScene& procedure);

/** Refuses a procedure that the scene cannot carry out. */
void checkProcedure(const SceneFields& fields, const Scene& scene);

/** Lowest and highest value of a profile. */
std::pair<double, double> bounds(const DriveProfile& profile);

/** Refuses what the held ends, the wire and the loads cannot do together. */
void checkEnds(const SceneFields& fields, const Scene& scene);

}  // namespace endovascular_sim::scene
