#include "robot/urdf/urdf_reader.h"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

#include "common/error.h"
#include "common/input_file.h"
#include "common/xml/xml_depth.h"
#include "robot/urdf/urdf_checks.h"

namespace endovascular_sim::robot
{
namespace
{

constexpr std::size_t kLargestFile = 16U << 20U;  // bytes

/** Collects what urdfdom logs, in place of its output on the error stream. */
class LogOfUrdfdom : public console_bridge::OutputHandler
{
public:
  LogOfUrdfdom() { console_bridge::useOutputHandler(this); }
  ~LogOfUrdfdom() override { console_bridge::restorePreviousOutputHandler(); }
  LogOfUrdfdom(const LogOfUrdfdom&) = delete;
  LogOfUrdfdom& operator=(const LogOfUrdfdom&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override
  {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR)
      text_ += (text_.empty() ? "" : "; ") + text;
  }
  const std::string& text() const { return text_; }

private:
  std::string text_;
};

/** Model of urdfdom. @throws InputError with its log */
urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& file)
{
  static std::mutex mutex;  // the log handler of urdfdom is one for the process
  const std::lock_guard<std::mutex> lock(mutex);
  const LogOfUrdfdom log;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (!model)
    throw InputError(file, "",
                     "is no valid URDF: " + (log.text().empty() ? std::string("urdfdom refused it") : log.text()) +
                         "; correct it until check_urdf accepts it");
  return model;
}

JointKind kindOf(const urdf::Joint& joint)
{
  switch (joint.type)
  {
    case urdf::Joint::FIXED:
      return JointKind::kFixed;
    case urdf::Joint::PRISMATIC:
      return JointKind::kPrismatic;
    case urdf::Joint::REVOLUTE:
      return JointKind::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return JointKind::kContinuous;
    default:
      return JointKind::kOther;
  }
}

Joint jointOf(const urdf::Joint& source, const TiXmlElement& element)
{
  Joint joint;
  joint.name = source.name;
  joint.kind = kindOf(source);
  joint.line = element.Row();
  // urdfdom gives a joint without limits an object of zeros.
  if (source.limits && element.FirstChildElement("limit") != nullptr && joint.isMovable())
  {
    if (joint.kind != JointKind::kContinuous)
      joint.range = drive::Interval{source.limits->lower, source.limits->upper};
    joint.speed = source.limits->velocity;
    joint.effort = source.limits->effort;
  }
  if (source.mimic)
    joint.mimic = Mimic{source.mimic->joint_name, source.mimic->multiplier, source.mimic->offset};
  return joint;
}

}  // namespace

RobotModel parseUrdf(const std::string& text, const std::string& file)
{
  if (text.size() > kLargestFile)
    throw InputError(file, "", "has more than 16 MiB; a URDF refers to its meshes by file names");
  requireShallowXml(text, file);
  TiXmlDocument document;
  document.Parse(text.c_str());
  checkXml(document, file);
  const TiXmlElement& root = *document.RootElement();
  const urdf::ModelInterfaceSharedPtr source = parse(text, file);

  RobotModel model;
  model.file = file;
  model.name = source->getName();
  model.urdf = text;
  model.root_link = source->getRoot()->name;
  for (const TiXmlElement* link = root.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
    model.links.emplace_back(link->Attribute("name"));
  for (const TiXmlElement* element = root.FirstChildElement("joint"); element != nullptr;
       element = element->NextSiblingElement("joint"))
  {
    const urdf::JointConstSharedPtr joint = source->getJoint(element->Attribute("name"));
    model.joints.push_back(jointOf(*joint, *element));
    checkAxis(model.joints.back(), joint->axis.x, joint->axis.y, joint->axis.z, file);
  }
  checkJoints(model);
  model.warnings = xmlWarnings(root, file);
  for (std::string& warning : rangeWarnings(model))
    model.warnings.push_back(std::move(warning));
  return model;
}

RobotModel readUrdf(const std::string& file)
{
  std::ifstream stream = openInputFile(file, "give the path of a URDF");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return parseUrdf(text, file);
}

}  // namespace endovascular_sim::robot
