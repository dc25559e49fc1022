#include "scene/model/scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/hash.h"
#include "scene/model/portable_text.h"

namespace endovascular_sim::scene
{
namespace
{

/** True for a line of resolved YAML that tells who drives an instrument: the scripted operator or a person. */
bool namesDriver(const std::string& line)
{
  const std::size_t begin = line.find_first_not_of(' ');
  const std::string entry = begin == std::string::npos || begin == 0 ? "" : line.substr(begin);
  return entry == "guided: true" || entry == "source: procedure" || entry == "source: topic";
}

}  // namespace

double DriveProfile::at(double t) const
{
  const double sine = amplitude == 0.0 ? 0.0 : amplitude * std::sin(2.0 * M_PI * frequency * t + phase);
  if (points.empty())
    return sine;
  const auto after = std::upper_bound(points.begin(), points.end(), t,
                                      [](double time, const Point& point) { return time < point.time; });
  if (after == points.begin())
    return points.front().value + sine;
  const Point& a = *(after - 1);
  if (after == points.end())
    return a.value + sine;
  return a.value + (after->value - a.value) * ((t - a.time) / (after->time - a.time)) + sine;
}

fluoroscopy::CArmPose FluoroscopyScene::pose() const
{
  fluoroscopy::CArmPose pose;
  pose.primary_angle = primary_angle;
  pose.secondary_angle = secondary_angle;
  pose.source_to_detector = source_to_detector;
  pose.source_to_patient = source_to_patient;
  pose.isocentre = isocentre.value_or(Eigen::Vector3d::Zero());
  pose.detector_width = detector_width;
  pose.pixels = pixels;
  pose.field_width = field_width;
  pose.field_height = field_height;
  return pose;
}

double DriveScene::insertionAt(double t) const
{
  if (source == DriveSource::kNone)
    return initial_insertion;
  return initial_insertion + (std::isnan(speed) ? insertion.at(t) : std::min(speed * t, travel));
}

double DriveScene::rotationAt(double t) const
{
  return source == DriveSource::kNone ? initial_rotation : initial_rotation + rotation.at(t);
}

double DriveScene::pressureAt(double t) const
{
  return source == DriveSource::kNone ? 0.0 : pressure.at(t);
}

Eigen::Isometry3d RobotScene::pose() const
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  pose.translation() = position;
  return pose;
}

std::size_t Scene::injectingInstrument() const
{
  const auto found = std::find_if(instruments.begin(), instruments.end(),
                                  [this](const DrivenInstrument& driven)
                                  { return driven.instrument.name == contrast.value().instrument; });
  return static_cast<std::size_t>(found - instruments.begin());
}

double Scene::longest() const
{
  double length = 0.0;
  for (const DrivenInstrument& driven : instruments)
    length = std::max(length, driven.instrument.wire.length());
  return length;
}

std::uint64_t Scene::hash() const
{
  Hash64 hash;
  hash.add(resolved_yaml);
  return hash.value();
}

namespace
{

std::uint64_t motionHashOf(const std::string& yaml)
{
  std::istringstream text(yaml);
  std::string kept;
  bool omitted = false;
  for (std::string line; std::getline(text, line);)
  {
    if (!line.empty() && line.front() != ' ')
      omitted = line.rfind("fluoroscopy:", 0) == 0;
    if (!omitted && !namesDriver(line))
      kept += line + '\n';
  }
  Hash64 hash;
  hash.add(kept);
  return hash.value();
}

}  // namespace

std::uint64_t Scene::motionHash() const
{
  return motionHashOf(withoutFolders(resolved_yaml));
}

std::uint64_t formerMotionHash(const Scene& scene)
{
  return motionHashOf(scene.resolved_yaml);
}

std::string withoutFolders(const std::string& yaml)
{
  std::istringstream lines(yaml);
  std::string text;
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t colon = line.find(": ");
    const std::size_t value = colon == std::string::npos ? std::string::npos : line.find_first_not_of("\"'", colon + 2);
    if (value != std::string::npos && line[value] == '/')
      line.erase(value, line.rfind('/') + 1 - value);
    text += line + '\n';
  }
  if (!yaml.empty() && yaml.back() != '\n')
    text.pop_back();
  return text;
}

std::vector<std::string> requiredNodes(const Scene& scene)
{
  std::vector<std::string> nodes;
  if (scene.vessel)
    nodes.emplace_back("vessel_server");
  nodes.emplace_back("rod_dynamics");
  if (scene.vessel)
    nodes.emplace_back("contact");
  if (scene.flow)
    nodes.emplace_back("hemodynamics");
  if (scene.haptic_device)
    nodes.emplace_back("haptic_device");
  if (scene.fluoroscopy)
    nodes.emplace_back("fluoroscopy");
  if (scene.robot)
    nodes.emplace_back("robot");
  nodes.emplace_back("session");
  return nodes;
}

}  // namespace endovascular_sim::scene
