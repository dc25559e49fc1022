#include "robot/urdf/urdf_checks.h"

#include <tinyxml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "robot/ros_package.h"

namespace endovascular_sim::robot
{
namespace
{

constexpr std::size_t kMostLinks = 500;  // the checks of a tree take time quadratic in it

std::string lineOf(const TiXmlElement& element)
{
  return "(line " + std::to_string(element.Row()) + ")";
}

std::string attribute(const TiXmlElement* element, const char* name)
{
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

/** True if a text consists of finite numbers in C notation, divided by spaces, and has as many as wanted. */
bool isNumbers(const std::string& text, int wanted)
{
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  int count = 0;
  while (stream >> value)
    count += std::isfinite(value) ? 1 : wanted + 1;
  return stream.eof() && count == wanted;
}

/** Element of a joint whose attributes are numbers. */
struct NumericElement
{
  const char* element;
  std::vector<const char*> attributes;
  int numbers;  ///< of each attribute
};

const std::vector<NumericElement> kNumeric = {{"limit", {"lower", "upper", "effort", "velocity"}, 1},
                                              {"mimic", {"multiplier", "offset"}, 1},
                                              {"axis", {"xyz"}, 3},
                                              {"origin", {"xyz", "rpy"}, 3}};

void checkNumbers(const TiXmlElement& joint, const std::string& where, const std::string& file)
{
  for (const NumericElement& numeric : kNumeric)
  {
    const TiXmlElement* element = joint.FirstChildElement(numeric.element);
    for (const char* name : numeric.attributes)
    {
      if (element == nullptr || element->Attribute(name) == nullptr)
        continue;
      const std::string value = attribute(element, name);
      if (!isNumbers(value, numeric.numbers))
        throw InputError(file, where,
                         "<" + std::string(numeric.element) + " " + name + "=\"" + value + "\"> is not " +
                             (numeric.numbers == 1 ? "a finite number" : "three finite numbers") +
                             "; write it with a decimal point and without a unit");
    }
  }
}

void checkLimitIsThere(const TiXmlElement& joint, const std::string& where, const std::string& file)
{
  const std::string type = attribute(&joint, "type");
  const TiXmlElement* limit = joint.FirstChildElement("limit");
  if ((type == "prismatic" || type == "revolute") && limit == nullptr)
    throw InputError(file, where,
                     "is " + type +
                         " and has no <limit>; add <limit lower= upper= velocity= effort=/>, or make a joint that "
                         "turns without end continuous");
  for (const char* name : {"effort", "velocity"})
    if (limit != nullptr && limit->Attribute(name) == nullptr)
      throw InputError(file, where, "its <limit> has no " + std::string(name) + "; URDF requires it, in SI units");
}

/** Checks that each joint connects two links of the file, and each link has at most one parent.
 *  @return parent of each link that has one */
std::map<std::string, std::string> checkLinks(const TiXmlElement& root, const std::set<std::string>& links,
                                              const std::string& file)
{
  std::map<std::string, std::string> parents;
  std::map<std::string, std::string> joint_of_child;
  std::set<std::string> names;
  for (const TiXmlElement* joint = root.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint"))
  {
    const std::string name = attribute(joint, "name");
    if (name.empty())
      throw InputError(file, "joint " + lineOf(*joint), "has no name; give it one");
    const std::string where = "joint '" + name + "' " + lineOf(*joint);
    if (!names.insert(name).second)
      throw InputError(file, where, "another joint has this name; names of joints must differ");
    for (const char* end : {"parent", "child"})
    {
      const std::string link = attribute(joint->FirstChildElement(end), "link");
      if (links.count(link) == 0)
        throw InputError(file, where,
                         link.empty() ? "has no <" + std::string(end) + " link=…/>; add it"
                                      : std::string(end) + " link '" + link + "' does not exist; add <link name=\"" +
                                            link + "\"/>, or correct the name");
    }
    const std::string child = attribute(joint->FirstChildElement("child"), "link");
    if (!joint_of_child.emplace(child, name).second)
      throw InputError(file, where,
                       "its child link '" + child + "' is that of joint '" + joint_of_child[child] +
                           "' too; a link hangs on one joint");
    parents[child] = attribute(joint->FirstChildElement("parent"), "link");
    checkNumbers(*joint, where, file);
    checkLimitIsThere(*joint, where, file);
  }
  return parents;
}

/** Checks that all links hang on one root. */
void checkTree(const std::map<std::string, std::string>& parents, const std::vector<std::string>& links,
               const std::string& file)
{
  std::string root;
  for (const std::string& link : links)
  {
    std::string top = link;
    for (std::size_t n = 0; parents.count(top) != 0; ++n)
    {
      top = parents.at(top);
      if (n > links.size())
        throw InputError(file, "link '" + link + "'",
                         "hangs on a ring of joints; the links of a URDF form a tree, so remove one joint of the ring");
    }
    if (root.empty())
      root = top;
    else if (top != root)
      throw InputError(
          file, "link '" + top + "'",
          "is a second root beside '" + root + "'; a URDF has one root link, so connect the two with a fixed joint");
  }
}

void checkMimic(const RobotModel& model, const Joint& joint)
{
  const Joint* leader = model.find(joint.mimic->joint);
  if (leader == nullptr)
    throw InputError(
        model.file, nameOf(joint),
        "mimics '" + joint.mimic->joint + "', which does not exist; movable joints are " + model.movableNames());
  if (!leader->isMovable() || !joint.isMovable())
    throw InputError(model.file, nameOf(joint),
                     "mimics '" + leader->name +
                         "', but both must be prismatic, revolute or continuous; remove <mimic>, or change the type");
  std::size_t length = 0;
  for (const Joint* next = &joint; next != nullptr && next->mimic; next = model.find(next->mimic->joint))
    if (++length > model.joints.size())
      throw InputError(
          model.file, nameOf(joint),
          joint.mimic->joint == joint.name
              ? "mimics itself; remove <mimic>, or name the joint that it follows"
              : "mimics '" + joint.mimic->joint + "' in a ring of mimics; one joint of the ring must have no <mimic>");
}

void checkLimits(const Joint& joint, const std::string& file)
{
  if (joint.range && joint.range->low > joint.range->high)
    throw InputError(file, nameOf(joint),
                     "lower limit " + shortNumber(joint.range->low) + " exceeds the upper limit " +
                         shortNumber(joint.range->high) + "; exchange lower and upper");
  if (joint.speed && *joint.speed < 0.0)
    throw InputError(file, nameOf(joint),
                     "limit velocity=\"" + shortNumber(*joint.speed) +
                         "\" is negative; give the largest speed, which is positive in both directions");
  if (joint.effort && *joint.effort < 0.0)
    throw InputError(file, nameOf(joint),
                     "limit effort=\"" + shortNumber(*joint.effort) +
                         "\" is negative; give the largest force or torque, which is positive in both directions");
}

/** Refuses elements and expressions of xacro. A namespace alone is left over from its expansion. */
void refuseXacro(const TiXmlElement& element, const std::string& file)
{
  bool is_xacro = element.ValueStr().rfind("xacro:", 0) == 0;
  for (const TiXmlAttribute* value = element.FirstAttribute(); value != nullptr; value = value->Next())
    is_xacro = is_xacro || value->ValueStr().find("${") != std::string::npos;
  if (is_xacro)
    throw InputError(file, "<" + element.ValueStr() + "> " + lineOf(element),
                     "is a xacro file; expand it where xacro is installed (xacro IN > OUT), and give the result");
  for (const TiXmlElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    refuseXacro(*child, file);
}

/** Reason why rviz cannot find a mesh file; empty if it can, or where no ROS is set up. */
std::string reasonOfMissingMesh(const std::string& mesh)
{
  std::error_code error;
  if (mesh.rfind("package://", 0) == 0)
  {
    const std::string name = mesh.substr(10, mesh.find('/', 10) - 10);
    const std::optional<std::filesystem::path> package = findRosPackage(name);
    if (package && package->empty())
      return "no package " + name + " for \"" + mesh +
             "\", so that rviz will not show it; install the package, or "
             "give file:///…";
    const std::filesystem::path path = package ? *package / mesh.substr(std::min(mesh.size(), 11 + name.size())) : "";
    return !package || std::filesystem::is_regular_file(path, error)
               ? ""
               : "there is no file " + path.string() + ", so that rviz will not show it; correct the path";
  }
  if (mesh.rfind("file://", 0) != 0)
    return "\"" + mesh + "\" is no URL; rviz finds file:///… and package://NAME/…";
  return std::filesystem::is_regular_file(mesh.substr(7), error)
             ? ""
             : "there is no file " + mesh.substr(7) + "; correct the path";
}

std::string meshWarning(const TiXmlElement& mesh, const std::string& file)
{
  const std::string reason = reasonOfMissingMesh(attribute(&mesh, "filename"));
  return reason.empty() ? "" : file + ": mesh " + lineOf(mesh) + ": " + reason;
}

/** Adds the mesh files below an element that rviz cannot find. */
void addMissingMeshes(const TiXmlElement& element, const std::string& file, std::vector<std::string>& warnings)
{
  for (const TiXmlElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
  {
    addMissingMeshes(*child, file, warnings);
    if (child->ValueStr() != "mesh")
      continue;
    if (std::string warning = meshWarning(*child, file); !warning.empty())
      warnings.push_back(std::move(warning));
  }
}

}  // namespace

std::string nameOf(const Joint& joint)
{
  return "joint '" + joint.name + "' (line " + std::to_string(joint.line) + ")";
}

void checkXml(const TiXmlDocument& document, const std::string& file)
{
  if (document.Error())
    throw InputError(file, "line " + std::to_string(document.ErrorRow()),
                     "is no XML: " + std::string(document.ErrorDesc()) + "; correct it");
  const TiXmlElement* root = document.RootElement();
  if (root == nullptr || root->ValueStr() != "robot")
    throw InputError(file, "", "has no element <robot>; give a URDF");
  refuseXacro(*root, file);
  std::vector<std::string> links;
  std::set<std::string> known;
  for (const TiXmlElement* link = root->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
  {
    const std::string name = attribute(link, "name");
    if (name.empty() || !known.insert(name).second)
      throw InputError(file, "link '" + name + "' " + lineOf(*link),
                       name.empty() ? "has no name; give it one" : "another link has this name; names must differ");
    links.push_back(name);
    if (links.size() > kMostLinks)
      throw InputError(file, "link '" + name + "' " + lineOf(*link),
                       "is one of more than " + std::to_string(kMostLinks) + " links; give fewer");
  }
  checkTree(checkLinks(*root, known, file), links, file);
}

void checkAxis(const Joint& joint, double x, double y, double z, const std::string& file)
{
  if (joint.kind != JointKind::kFixed && joint.isMovable() && x == 0.0 && y == 0.0 && z == 0.0)
    throw InputError(file, nameOf(joint),
                     "its axis is zero; give the direction of the motion, e.g. <axis xyz=\"1 0 0\"/>");
}

void checkJoints(const RobotModel& model)
{
  for (const Joint& joint : model.joints)
  {
    checkLimits(joint, model.file);
    if (joint.mimic)
      checkMimic(model, joint);
  }
}

std::vector<std::string> xmlWarnings(const TiXmlElement& root, const std::string& file)
{
  std::vector<std::string> warnings;
  for (const TiXmlElement* transmission = root.FirstChildElement("transmission"); transmission != nullptr;
       transmission = transmission->NextSiblingElement("transmission"))
    warnings.push_back(file + ": transmission '" + attribute(transmission, "name") + "' " + lineOf(*transmission) +
                       ": has no effect; give the ratio of its joint in the scene, robot.joints.N.ratio");
  addMissingMeshes(root, file, warnings);
  return warnings;
}

std::vector<std::string> rangeWarnings(const RobotModel& model)
{
  constexpr double kTurn = 2.0 * M_PI;
  constexpr double kMostTurns = 10.0;
  std::vector<std::string> warnings;
  for (const Joint& joint : model.joints)
    if (joint.kind == JointKind::kRevolute && joint.range && joint.range->high - joint.range->low > kMostTurns * kTurn)
      warnings.push_back(model.file + ": " + nameOf(joint) + ": its limits permit " +
                         shortNumber((joint.range->high - joint.range->low) / kTurn) +
                         " turns: are they in degrees? URDF uses rad");
  return warnings;
}

}  // namespace endovascular_sim::robot
