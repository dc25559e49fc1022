#include "scene/schema/scene_schema.h"

#include <algorithm>
#include <cmath>

#include "common/file/file_name.h"
#include "common/text/one_line.h"
#include "common/units.h"

namespace endovascular_sim::scene
{
namespace
{

// Words of DriveSource and SamplingKind, in the order of the enumerators.
const std::vector<std::string> kDriveSources = {"none", "script", "device", "topic", "procedure"};
const std::vector<std::string> kGrips = {"fingers", "chuck"};  // order of drive::Grip
const std::vector<std::string> kSamplingKinds = {"uniform", "adaptive"};
const std::vector<std::string> kLinearSolvers = {"banded", "suitesparse"};  // order of rod::LinearSolver

constexpr double kSameLength = 1e-9;     // tolerance for the equality of lengths [m]
constexpr double kTravelsPerEdge = 4.0;  // smallest ratio of edge length to travel per sub-step
constexpr double kEdgePerGuide = 0.5;    // largest ratio of edge length to guide length
constexpr double kSmoothEdge = 0.25;     // largest ratio without ripple of the hand force
using units::kAtmosphere;
constexpr double kShortestEdge = 2e-5;  // smallest ratio of edge length to wire length

void visitSampling(yaml::Fields& fields, SamplingScene& sampling, double wire_length)
{
  fields.option("kind", sampling.kind, kSamplingKinds);
  const bool adaptive = sampling.kind == SamplingKind::kAdaptive;
  for (const char* key : {"min_edge", "max_edge", "turn_per_edge", "min_age"})
    if (fields.reading() && !adaptive && fields.has(key))
      fields.reject(key, "belongs to adaptive sampling; set kind: adaptive, or remove it");
  if (!adaptive)
  {
    fields.integer("nodes", sampling.nodes, 3, 100000);
    return;
  }
  if (fields.reading() && fields.has("nodes"))
    fields.reject("nodes", "belongs to uniform sampling; remove it, or set kind: uniform");
  fields.number("min_edge", sampling.min_edge, quantities::kEdge, Range::positive());
  fields.number("max_edge", sampling.max_edge, quantities::kEdge, Range::positive());
  fields.number("turn_per_edge", sampling.turn_per_edge, quantities::kTurnPerEdge, {0.0, 1.0, true, false});
  fields.number("min_age", sampling.min_age, quantities::kReaction, Range::nonNegative());
  if (!fields.reading())
    return;
  if (sampling.max_edge < sampling.min_edge)
    fields.reject("max_edge", "is less than min_edge");
  if (sampling.min_edge < kShortestEdge * wire_length)
    fields.reject("min_edge", "gives more than 100000 nodes; must be at least " +
                                  std::to_string(kShortestEdge * wire_length) + " m");
  if (sampling.max_edge > 0.5 * wire_length)
    fields.reject("max_edge",
                  "is longer than half the wire; must be at most " + std::to_string(0.5 * wire_length) + " m");
}

void visitErrors(yaml::Fields& fields, ErrorLimits& errors)
{
  fields.number("perforation_force", errors.perforation_force, quantities::kWallForce, Range::positive());
  fields.number("tip_force", errors.tip_force, quantities::kWallForce, Range::positive());
  fields.number("tip_force_time", errors.tip_force_time, quantities::kReaction, Range::nonNegative());
  fields.number("support_time", errors.support_time, quantities::kReaction, Range::nonNegative());
  fields.number("support_withdrawal", errors.support_withdrawal, quantities::kInsertion, Range::positive());
}

void visitRecord(yaml::Fields& fields, RecordScene& record)
{
  fields.number("pose_rate", record.pose_rate, quantities::kRate, Range::positive());
  fields.number("trajectory_rate", record.trajectory_rate, quantities::kRate, Range::positive());
  fields.number("wall_force_threshold", record.wall_force_threshold, quantities::kWallForce, Range::nonNegative());
  fields.boolean("x_ray_frames", record.x_ray_frames);
  if (!fields.reading())
    return;
  // The pseudonym of a trainee is no part of the scene: its text and hash are those of all trainees (recordSubject()).
  std::string subject;
  fields.text("subject", subject);
  if (!isOneLine(subject))
    fields.reject("subject", "must be one line of at most " + std::to_string(kLongestLine) +
                                 " bytes in UTF-8, without control characters");
}

/** Schema of the scene's name, which names the folder of the results. */
void visitName(yaml::Fields& fields, std::string& name)
{
  fields.text("name", name);
  if (fields.reading() && name != fileNameOf(name))
    fields.reject("name", "names the folder of the results; must consist of at most " +
                              std::to_string(kLongestFileName) +
                              " letters, digits, _, - and ., with a letter, digit or _ first");
}

/** Rejects a drive that inserts a wire beyond its length, or that pulls a single wire out of the introducer.
 *  @param path path of the map that contains `drive`, with a final dot; empty for a single instrument */
void checkInsertion(const yaml::Fields& fields, const DrivenInstrument& driven, const std::string& path)
{
  const DriveScene& drive = driven.drive;
  const bool by_speed = !std::isnan(drive.speed);
  const auto [low, high] = by_speed ? std::pair(0.0, drive.travel) : bounds(drive.insertion);
  const double length = driven.instrument.wire.length();
  const std::string key = path + (by_speed ? "drive.travel" : "drive.insertion");
  if (drive.initial_insertion + high > length + kSameLength)
    fields.reject(key, "inserts the wire by " + std::to_string(drive.initial_insertion + high) + " m, but it is " +
                           std::to_string(length) + " m long; must be at most the wire's length");
  if (path.empty() && drive.initial_insertion + low < -kSameLength)
    fields.reject(key, "pulls the wire out of its introducer; the insertion must stay zero or positive");
}

/** Rejects an insertion in a bench scene. Without an introducer, the drive can only rotate the proximal clamp. */
void checkBenchDrive(const yaml::Fields& fields, const Scene& scene)
{
  const DriveScene& drive = scene.instruments.front().drive;
  if (!std::isnan(drive.speed) || !drive.insertion.isTrivial() || drive.initial_insertion != 0.0)
    fields.reject(std::isnan(drive.speed) ? "drive.insertion" : "drive.speed",
                  "nothing can be inserted without an introducer; set introducer: true, or drive the rotation only");
  if (drive.source != DriveSource::kNone && scene.proximal_end != rod::EndHold::kClamped)
    fields.reject("proximal_end", "is not clamped, so that the drive has no effect; set proximal_end: clamped");
}

/** Rejects edge lengths that do not suit the introducer's guide.
 *
 *  Nodes leave the guide one after another. An edge must be longer than the travel per sub-step. A guide that holds
 *  fewer than two edges releases the wire in jumps. */
void checkEdges(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.introducer)
    return;
  const double longest = kEdgePerGuide * scene.solver.guide_length;
  if (scene.sampling.kind == SamplingKind::kUniform)
  {
    const auto fewest = static_cast<int>(std::ceil(scene.longest() / longest)) + 1;
    if (scene.sampling.nodes < fewest)
      fields.reject("sampling.nodes",
                    "makes edges too long for the introducer's guide, which must contain two; must be "
                    "at least " +
                        std::to_string(fewest));
    return;
  }
  if (scene.sampling.max_edge > longest)
    fields.reject("sampling.max_edge",
                  "is too long for the introducer's guide, which must contain two edges; must be at "
                  "most half of solver.guide_length, " +
                      std::to_string(longest) + " m");
  const double shortest = kTravelsPerEdge * scene.solver.max_travel_per_substep;
  if (scene.sampling.min_edge < shortest - kSameLength)
    fields.reject("sampling.min_edge",
                  "is too short for the travel per sub-step; must be at least 4 times "
                  "solver.max_travel_per_substep, " +
                      std::to_string(shortest) + " m");
}

/** Warns of edges with which the force at the hand ripples while nodes leave the introducer's guide. */
void judgeEdges(const yaml::Fields& fields, const Scene& scene)
{
  const double longest = kSmoothEdge * scene.solver.guide_length;
  const bool uniform = scene.sampling.kind == SamplingKind::kUniform;
  const double edge = uniform ? scene.longest() / (scene.sampling.nodes - 1) : scene.sampling.max_edge;
  if (!scene.introducer || edge <= longest + kSameLength)
    return;
  const std::string fault = "edges of " + std::to_string(edge) +
                            " m are longer than a quarter of solver.guide_length, " + std::to_string(longest) +
                            " m: the force at the hand ripples; give at ";
  if (uniform)
    fields.warn("sampling.nodes",
                fault + "least " + std::to_string(static_cast<int>(std::ceil(scene.longest() / longest)) + 1));
  else
    fields.warn("sampling.max_edge", fault + "most that");
}

/** Rejects a smooth wall that a balloon would move. */
void checkWall(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.vessel || scene.vessel->wall != contact::WallShape::kSmooth)
    return;
  for (const DrivenInstrument& driven : scene.instruments)
    if (driven.instrument.balloon)
      fields.reject("vessel.wall",
                    "is smooth, but a balloon moves the wall, which only facets follow; set vessel.wall: "
                    "facets, or use an instrument without a balloon");
}

void checkScene(const yaml::Fields& fields, const Scene& scene)
{
  checkEdges(fields, scene);
  judgeEdges(fields, scene);
  const bool held_twice = scene.introducer && scene.proximal_end != rod::EndHold::kFree;
  if (held_twice)
    fields.reject("proximal_end",
                  "the introducer holds the wire already; set introducer: false, or proximal_end: free");
  if (!scene.introducer && scene.entry.valve_friction > 0.0)
    fields.reject("entry.valve_friction", "requires an introducer; set introducer: true, or 0");
  for (std::size_t k = 0; k < scene.instruments.size() && scene.introducer; ++k)
    checkInsertion(fields, scene.instruments[k], drivePath(scene, k));
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (!scene.instruments[k].drive.pressure.isTrivial() && !scene.solver.traits().balloons)
      fields.reject(drivePath(scene, k) + "drive.pressure",
                    "scheme '" + scene.solver.scheme + "' simulates no balloon; set solver.scheme: kkt");
  if (scene.sampling.kind == SamplingKind::kAdaptive && !scene.solver.traits().adaptive)
    fields.reject("sampling.kind", "scheme '" + scene.solver.scheme +
                                       "' does not support adaptive sampling; set sampling.kind: uniform");
  if (!scene.introducer)
    checkBenchDrive(fields, scene);
  checkWall(fields, scene);
  if (scene.instruments.size() > 1)
    checkStack(fields, scene);
  checkContrast(fields, scene);
  checkProcedure(fields, scene);
  checkPatient(fields, scene);
  checkEnds(fields, scene);
  checkRollers(fields, scene);
  checkFlow(fields, scene);
  checkMotion(fields, scene);
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].drive.source == DriveSource::kDevice && !scene.haptic_device)
      fields.reject(drivePath(scene, k) + "drive.source",
                    "is device, but haptic_device is not true; set haptic_device: true");
  if (scene.duration < scene.solver.time_step)
    fields.reject("duration", "is shorter than one step; must be at least solver.time_step");
  if (!scene.vessel || !scene.vessel->tube)
    return;
  for (const DrivenInstrument& driven : scene.instruments)
    for (const rod::Section& section : driven.instrument.wire.sections)
      if (section.radius >= scene.vessel->tube->radius)
        fields.reject("vessel.tube.radius", "the tube is narrower than the wire; must be greater than " +
                                                std::to_string(section.radius) + " m");
}

}  // namespace

void visitProfile(yaml::Fields& fields, DriveProfile& profile, const Quantity& quantity)
{
  std::vector<std::vector<double>> rows;
  for (const DriveProfile::Point& point : profile.points)
    rows.push_back({point.time, point.value});
  fields.rows("points", rows, {quantities::kProfileTime, quantity});
  profile.points.clear();
  for (const std::vector<double>& row : rows)
  {
    if (fields.reading() && !profile.points.empty() && row[0] <= profile.points.back().time)
      fields.reject("points",
                    "times must be increasing; each row is [time in s, value in " + std::string(quantity.unit) + "]");
    profile.points.push_back({row[0], row[1]});
  }
  fields.number("amplitude", profile.amplitude, quantity, Range::any());
  fields.number("frequency", profile.frequency, quantities::kFrequency, Range::nonNegative());
  fields.number("phase", profile.phase, quantities::kAngle, Range::any());
  if (fields.reading() && profile.amplitude != 0.0 && !fields.has("frequency"))
    fields.reject("frequency", "missing; a sine with an amplitude needs its frequency in Hz");
}

std::pair<double, double> bounds(const DriveProfile& profile)
{
  double low = profile.points.empty() ? 0.0 : profile.points.front().value;
  double high = low;
  for (const DriveProfile::Point& point : profile.points)
  {
    low = std::min(low, point.value);
    high = std::max(high, point.value);
  }
  const double swing = std::abs(profile.amplitude);
  return {low - swing, high + swing};
}

namespace
{

/** Schema of the pressure at a balloon's inflator. */
void visitPressure(yaml::Fields& fields, DriveProfile& pressure)
{
  fields.map("pressure",
             [&pressure](yaml::Fields& profile) { visitProfile(profile, pressure, quantities::kPressure); });
  if (fields.reading() && bounds(pressure).first < -kAtmosphere)
    fields.reject("pressure", "is less than a vacuum; must be at least -101325 Pa");
}

}  // namespace

void visitDrive(yaml::Fields& fields, DriveScene& drive, const Range& initial_insertion, bool balloon)
{
  fields.option("source", drive.source, kDriveSources);
  fields.optionalNumber("speed", drive.speed, quantities::kSpeed, Range::nonNegative());
  const bool by_speed = !std::isnan(drive.speed);
  if (by_speed)
    fields.number("travel", drive.travel, quantities::kInsertion, Range::nonNegative(), Need::kRequired);
  else if (fields.has("travel"))
    fields.reject("travel", "requires speed; give speed in m/s, or remove it");
  fields.number("initial_insertion", drive.initial_insertion, quantities::kInsertion, initial_insertion);
  fields.number("initial_rotation", drive.initial_rotation, quantities::kRotation, Range::any());
  if (fields.reading() && by_speed && fields.has("insertion"))
    fields.reject("insertion",
                  "conflicts with speed; keep one of the two (null removes a key: --set drive.insertion=null)");
  if (!by_speed)
    fields.map("insertion",
               [&drive](yaml::Fields& profile) { visitProfile(profile, drive.insertion, quantities::kInsertion); });
  fields.map("rotation",
             [&drive](yaml::Fields& profile) { visitProfile(profile, drive.rotation, quantities::kRotation); });
  if (balloon)
    visitPressure(fields, drive.pressure);
  else if (fields.has("pressure"))
    fields.reject("pressure", "requires a balloon; use a balloon_catheter, or remove it");
  fields.number("force_limit", drive.force_limit, quantities::kForceLimit, Range::positive());
  fields.number("torque_limit", drive.torque_limit, quantities::kTorqueLimit, Range::positive());
  // Defaults are not written: the texts and hashes of scenes without these keys stay as they are.
  if (fields.reading() || drive.grip != drive::Grip::kFingers)
    fields.option("grip", drive.grip, kGrips);
  if (fields.reading() ? fields.has("limits") : drive.limits != drive::DriveLimits())
    fields.map("limits", [&drive, balloon](yaml::Fields& limits) { visitLimits(limits, drive.limits, balloon); });
  if (fields.reading() && drive.limits.insertion && !drive.limits.insertion->contains(drive.insertionAt(0.0)))
    fields.reject("limits.insertion",
                  "does not contain the insertion at the start, " + std::to_string(drive.insertionAt(0.0)) + " m");
  const bool moves =
      by_speed || !drive.insertion.isTrivial() || !drive.rotation.isTrivial() || !drive.pressure.isTrivial();
  if (fields.reading() && drive.source == DriveSource::kNone && moves)
    fields.reject("source", "is none, but a motion is given; set source: script");
}

void visitLoads(yaml::Fields& fields, LoadScene& loads, double wire_length)
{
  fields.vector3("gravity", loads.gravity, quantities::kGravity);
  fields.number("fluid_density", loads.fluid_density, quantities::kFluidDensity, Range::nonNegative());
  fields.number("drag_coefficient", loads.drag_coefficient, quantities::kDrag, Range::nonNegative());
  fields.number("damping", loads.damping, quantities::kMassDamping, Range::nonNegative());
  fields.list(
      "point_loads", loads.point_loads.size(), [&loads](std::size_t size) { loads.point_loads.resize(size); },
      [&loads, wire_length](yaml::Fields& load_fields, std::size_t k)
      {
        PointLoad& load = loads.point_loads[k];
        if (load_fields.reading())
          load.position = wire_length;
        load_fields.number("position", load.position, quantities::kLoadPosition, Range::nonNegative());
        load_fields.vector3("force", load.force, quantities::kPointForce);
        load_fields.number("torque", load.torque, quantities::kPointTorque, Range::any());
        load_fields.number("ramp_time", load.ramp_time, quantities::kDuration, Range::nonNegative());
        if (!load_fields.reading())
          return;
        if (load.position > wire_length + kSameLength)
          load_fields.reject("position", "lies beyond the tip; must be at most the wire's length, " +
                                             std::to_string(wire_length) + " m");
        if (load.torque != 0.0 && load.position < wire_length - kSameLength)
          load_fields.reject("torque", "acts at the tip only; remove position, or torque");
      });
}

void visitSolver(yaml::Fields& fields, SolverScene& solver)
{
  std::vector<std::string> names;
  for (const rod::SchemeTraits& traits : rod::schemes())
    names.push_back(traits.name);
  int scheme = static_cast<int>(std::find(names.begin(), names.end(), solver.scheme) - names.begin());
  fields.choice("scheme", scheme, names);
  solver.scheme = names.at(static_cast<std::size_t>(scheme));
  fields.option("linear_solver", solver.stepper.linear_solver, kLinearSolvers);
  fields.number("time_step", solver.time_step, quantities::kTimeStep, {0.0, 0.1, true, false});
  fields.integer("max_newton", solver.stepper.max_iterations, 1, 1000);
  fields.number("strain_tolerance", solver.stepper.strain_tolerance, quantities::kStrain, Range::positive());
  fields.number("contact_stiffness", solver.stepper.contact_stiffness, quantities::kContactStiffness,
                Range::positive());
  fields.number("contact_margin", solver.stepper.contact_margin, quantities::kMargin, Range::positive());
  fields.number("max_travel_per_substep", solver.max_travel_per_substep, quantities::kTravel, Range::positive());
  fields.number("guide_length", solver.guide_length, quantities::kGuideLength, Range::nonNegative());
}

void visitScene(yaml::Fields& fields, Scene& scene)
{
  visitName(fields, scene.name);
  fields.bigInteger("seed", scene.seed);
  fields.number("duration", scene.duration, quantities::kDuration, Range::positive());
  if (fields.reading() ? fields.has("vessel") : scene.vessel.has_value())
  {
    if (!scene.vessel)
      scene.vessel.emplace();
    fields.map("vessel", [&scene](yaml::Fields& vessel) { visitVessel(vessel, *scene.vessel); });
  }
  fields.map("entry", [&scene](yaml::Fields& entry) { visitEntry(entry, scene.entry, scene.vessel); });
  visitInstruments(fields, scene);
  if (fields.reading() ? fields.has("procedure") : scene.procedure.has_value())
  {
    if (!scene.procedure)
      scene.procedure.emplace();
    fields.map("procedure", [&scene](yaml::Fields& procedure) { visitProcedure(procedure, *scene.procedure); });
  }
  if (fields.reading())
    scene.introducer = scene.instruments.front().drive.source != DriveSource::kNone;
  fields.boolean("introducer", scene.introducer);
  visitEnds(fields, scene);
  const double wire_length = scene.longest();
  fields.map("loads", [&](yaml::Fields& loads) { visitLoads(loads, scene.loads, wire_length); });
  if (fields.reading() ? fields.has("rollers") : !scene.rollers.empty())
    visitRollers(fields, scene);
  fields.map("sampling", [&](yaml::Fields& sampling) { visitSampling(sampling, scene.sampling, wire_length); });
  fields.map("solver", [&scene](yaml::Fields& solver) { visitSolver(solver, scene.solver); });
  if (fields.reading() ? fields.has("fluoroscopy") : scene.fluoroscopy.has_value())
  {
    if (!scene.fluoroscopy)
      scene.fluoroscopy.emplace();
    if (fields.reading() && fields.has("contrast"))
      scene.fluoroscopy->iodine = 0.0;
    fields.map("fluoroscopy", [&scene](yaml::Fields& c_arm) { visitFluoroscopy(c_arm, *scene.fluoroscopy); });
  }
  if (fields.reading() ? fields.has("flow") : scene.flow.has_value())
  {
    if (!scene.flow)
      scene.flow.emplace();
    fields.map("flow", [&scene](yaml::Fields& flow) { visitFlow(flow, *scene.flow); });
  }
  if (fields.reading() ? fields.has("contrast") : scene.contrast.has_value())
  {
    if (!scene.contrast)
      scene.contrast.emplace();
    fields.map("contrast", [&scene](yaml::Fields& keys) { visitContrast(keys, *scene.contrast, scene); });
  }
  if (fields.reading() ? fields.has("motion") : scene.motion.has_value())
  {
    if (!scene.motion)
      scene.motion.emplace();
    fields.map("motion", [&scene](yaml::Fields& motion) { visitMotion(motion, *scene.motion, scene.flow); });
  }
  fields.boolean("haptic_device", scene.haptic_device);
  if (fields.reading() ? fields.has("robot") : scene.robot.has_value())
    fields.map("robot", [&scene](yaml::Fields& robot) { visitRobot(robot, scene); });
  if (fields.reading() ? fields.has("sensors") : !scene.sensors.empty())
    visitSensors(fields, scene);
  if (fields.reading() ? fields.has("faults") : !scene.faults.empty())
    visitFaults(fields, scene);
  fields.map("record", [&scene](yaml::Fields& record) { visitRecord(record, scene.record); });
  if (fields.reading() ? fields.has("errors") : scene.errors.has_value())
  {
    if (!scene.errors)
      scene.errors.emplace();
    fields.map("errors", [&scene](yaml::Fields& errors) { visitErrors(errors, *scene.errors); });
  }
  if (fields.reading())
    checkScene(fields, scene);
}

}  // namespace endovascular_sim::scene
