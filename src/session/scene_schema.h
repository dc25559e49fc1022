#pragma once

#include "session/scene.h"
#include "session/scene_fields.h"

namespace endovascular_sim::session
{

/** The schema of a scene: visits every key, and while reading refuses values that contradict each other.
 *  docs/SCENES.md lists the same keys for the user. */
void visitScene(SceneFields& fields, Scene& scene);

/** Parts of the schema. */
void visitVessel(SceneFields& fields, VesselScene& vessel);
void visitEntry(SceneFields& fields, EntryScene& entry, const std::optional<VesselScene>& vessel);
void visitInstrument(SceneFields& fields, instrument::Instrument& instrument);
void visitDrive(SceneFields& fields, DriveScene& drive);
void visitLoads(SceneFields& fields, LoadScene& loads, double wire_length);
void visitSolver(SceneFields& fields, SolverScene& solver);
void visitFluoroscopy(SceneFields& fields, FluoroscopyScene& fluoroscopy);

}  // namespace endovascular_sim::session
