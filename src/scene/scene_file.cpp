#include "scene/scene_file.h"

#include <filesystem>

#include "common/error.h"
#include "common/file/file_name.h"
#include "robot/urdf_source.h"
#include "scene/file_search.h"
#include "scene/instrument_library.h"
#include "scene/schema/scene_schema.h"
#include "yaml/reader.h"
#include "yaml/writer.h"

namespace endovascular_sim::scene
{
namespace
{

/** Replaces the path of a procedure with the content of the file. */
void expandProcedure(yaml::Node& procedure, const std::string& file)
{
  if (procedure.kind == yaml::Node::Kind::kScalar)
    procedure = yaml::readTree(findSceneFile(procedure, "procedure", file));
}

/** Replaces the word or the path of a circulation with the content of its file; `flow: adult` is short for
 * `flow: {circulation: adult}`. */
void expandFlow(yaml::Node& flow, const std::string& file)
{
  if (flow.kind == yaml::Node::Kind::kScalar)
  {
    const yaml::Node word = flow;
    flow.kind = yaml::Node::Kind::kMap;
    flow.fields.emplace_back("circulation", word);
  }
  yaml::Node* circulation = flow.field("circulation");
  if (circulation != nullptr && circulation->kind == yaml::Node::Kind::kScalar)
    *circulation = yaml::readTree(findCirculation(*circulation, "flow.circulation", file));
}

/** Replaces the word or the path of a patient's motion with the content of its file; `motion: adult` is short for
 * `motion: {patient: adult}`. */
void expandMotion(yaml::Node& motion, const std::string& file)
{
  if (motion.kind == yaml::Node::Kind::kScalar)
  {
    const yaml::Node word = motion;
    motion.kind = yaml::Node::Kind::kMap;
    motion.fields.emplace_back("patient", word);
  }
  yaml::Node* patient = motion.field("patient");
  if (patient != nullptr && patient->kind == yaml::Node::Kind::kScalar)
    *patient = yaml::readTree(findMotion(*patient, "motion.patient", file));
}

/** Treats `part: none` as a missing key. */
void removeIfNone(yaml::Node* part)
{
  if (part != nullptr && part->kind == yaml::Node::Kind::kScalar && part->text == "none")
    part->kind = yaml::Node::Kind::kNull;
}

/** Expands references to instrument and procedure files, and removes optional parts that are `none`. */
void normalise(yaml::Node& root, const std::string& file)
{
  if (yaml::Node* instrument = root.field("instrument"))
    expandInstrument(*instrument, "instrument", file);
  if (yaml::Node* instruments = root.field("instruments"))
    for (std::size_t k = 0; k < instruments->items.size(); ++k)
      if (yaml::Node* instrument = instruments->items[k].field("instrument"))
        expandInstrument(*instrument, "instruments." + std::to_string(k) + ".instrument", file);
  if (yaml::Node* procedure = root.field("procedure"))
    expandProcedure(*procedure, file);
  for (const char* part : {"vessel", "sensors", "faults", "flow", "motion"})
    removeIfNone(root.field(part));
  if (yaml::Node* flow = root.field("flow"))
    expandFlow(*flow, file);
  if (yaml::Node* motion = root.field("motion"))
    expandMotion(*motion, file);
  yaml::Node* fluoroscopy = root.field("fluoroscopy");
  removeIfNone(fluoroscopy);
  if (fluoroscopy != nullptr)
    removeIfNone(fluoroscopy->field("patient"));
}

/** Resolves the paths of the vessel's files and of the CT. The resolved text retains the paths as written, so that the
 *  hash of the scene does not depend on the machine. */
void resolvePaths(Scene& scene, const yaml::Node& root)
{
  const yaml::Node* x_ray = root.find("fluoroscopy");
  const yaml::Node* patient = x_ray == nullptr ? nullptr : x_ray->find("patient");
  if (const yaml::Node* ct = patient == nullptr ? nullptr : patient->find("ct"))
    scene.fluoroscopy->patient->ct = findSceneFile(*ct, "fluoroscopy.patient.ct", scene.file);
  const yaml::Node* vessel = root.find("vessel");
  if (vessel == nullptr)
    return;
  if (const yaml::Node* mesh = vessel->find("mesh"))
    scene.vessel->mesh = findSceneFile(*mesh, "vessel.mesh", scene.file);
  if (const yaml::Node* centreline = vessel->find("centreline"))
    scene.vessel->centreline = findSceneFile(*centreline, "vessel.centreline", scene.file);
  if (const yaml::Node* anatomy = vessel->find("anatomy"))
    scene.vessel->anatomy = findAnatomy(*anatomy, "vessel.anatomy", scene.file);
}

/** Motion of an instrument at the start. */
double startOf(const DriveScene& drive, robot::Motion motion)
{
  return motion == robot::Motion::kInsertion  ? drive.insertionAt(0.0)
         : motion == robot::Motion::kRotation ? drive.rotationAt(0.0)
                                              : drive.pressureAt(0.0);
}

/** Reads the robot's URDF, checks its joints, and adds their limits to those of the instruments. The resolved text has
 *  these limits, so that a recording needs no URDF. */
void resolveRobot(Scene& scene, const yaml::Node& root)
{
  if (!scene.robot)
    return;
  RobotScene& robot = *scene.robot;
  const yaml::Node& node = *root.find("robot");
  robot.model = robot::loadUrdf(findSceneFile(*node.find("urdf"), "robot.urdf", scene.file));
  std::vector<DriveScene*> drives;
  std::vector<double> starts;
  std::vector<drive::DriveLimits> limits;
  for (const robot::JointLink& link : robot.joints)
    for (DrivenInstrument& driven : scene.instruments)
      if (driven.instrument.name == link.instrument)
      {
        drives.push_back(&driven.drive);
        starts.push_back(startOf(driven.drive, link.motion));
        driven.drive.limits = driven.limits();
      }
  if (const std::optional<robot::LinkFault> fault = robot::findFault(robot.model, robot.joints, starts))
  {
    const yaml::Node& link = node.find("joints")->items[fault->link];
    const yaml::Node* value = link.find(fault->key);
    throw InputError(scene.file,
                     "robot.joints." + std::to_string(fault->link) + "." + fault->key +
                         (value != nullptr ? *value : link).location(),
                     fault->remedy);
  }
  for (std::size_t k = 0; k < robot.joints.size(); ++k)
    drives[k]->limits =
        robot::withJoint(drives[k]->limits, robot.joints[k], *robot.model.find(robot.joints[k].joint), starts[k]);
  scene.warnings.insert(scene.warnings.end(), robot.model.warnings.begin(), robot.model.warnings.end());
  for (const std::string& joint : robot::idleJoints(robot.model, robot.joints))
    scene.warnings.push_back(robot.model.file + ": joint '" + joint +
                             "': moves no instrument; it stays at rest unless robot.joints lists it");
}

/** Origin of a scene's text. */
enum class Origin
{
  kUser,       ///< values are judged; the vessel's files must exist
  kRecording,  ///< values were judged before recording; the recording contains the vessel
};

Scene buildScene(yaml::Node root, const std::string& file, const std::vector<std::string>& overrides,
                 Origin origin = Origin::kUser)
{
  normalise(root, file);
  for (const std::string& override_text : overrides)
  {
    yaml::overrideTree(root, override_text, file);
    normalise(root, file);
  }
  Scene scene;
  scene.file = file;
  scene.name = fileNameOf(std::filesystem::path(file).stem().string());
  yaml::ReadingReport report;
  yaml::Reader reader(root, origin == Origin::kUser ? &report : nullptr);
  visitScene(reader, scene);
  reader.finish();
  scene.warnings = report.warnings;
  if (origin == Origin::kUser)
    resolveRobot(scene, root);
  yaml::Writer writer;
  visitScene(writer, scene);
  scene.resolved_yaml = writer.yaml();
  if (origin == Origin::kUser)
    resolvePaths(scene, root);
  return scene;
}

}  // namespace

Scene loadScene(const std::string& file, const std::vector<std::string>& overrides)
{
  return buildScene(yaml::readTree(file), file, overrides);
}

Scene parseScene(const std::string& yaml, const std::string& origin, const std::vector<std::string>& overrides)
{
  return buildScene(yaml::parseTree(yaml, origin), origin, overrides);
}

std::string recordSubject(const std::string& file, const std::vector<std::string>& overrides)
{
  yaml::Node root = yaml::readTree(file);
  // Other overrides may need files that the scene names.
  for (const std::string& override_text : overrides)
    if (override_text.rfind("record.", 0) == 0)
      yaml::overrideTree(root, override_text, file);
  const yaml::Node* record = root.find("record");
  const yaml::Node* subject = record != nullptr ? record->find("subject") : nullptr;
  return subject != nullptr ? subject->text : std::string();
}

Scene parseRecordedScene(const std::string& yaml, const std::string& origin)
{
  return buildScene(yaml::parseTree(yaml, origin), origin, {}, Origin::kRecording);
}

}  // namespace endovascular_sim::scene
