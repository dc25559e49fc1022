#include "rviz_plugin/model/treatment_drawing.h"

#include <algorithm>
#include <vector>

#include "intervention/stent_placement.h"
#include "rviz_plugin/model/message_points.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kBalloonSides = 24;
constexpr int kStrutSides = 5;
constexpr double kSmallestStrut = 0.05e-3;  ///< smallest drawn radius of a strut [m]
constexpr double kLongestBody = 0.5;        ///< longest balloon or stent; the number of struts follows the length [m]
constexpr visualization::TranslucentColour kBalloonColour{{0.95F, 0.85F, 0.35F}, 0.55F};
constexpr visualization::TranslucentColour kStrutColour{{0.85F, 0.87F, 0.9F}, 1.0F};

/** Reason why a body cannot be drawn; null for a valid one. */
const char* problemOfBody(const intervention::RoundBody& body)
{
  if (const char* problem = visualization::problemOfTube(body.axis, body.radii))
    return problem;
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < body.axis.size(); ++i)
    length += (body.axis[i + 1] - body.axis[i]).norm();
  return length > 0.0 && length < kLongestBody ? nullptr : "implausible length";
}

void appendBalloon(const intervention::RoundBody& body, visualization::Surface& surface)
{
  visualization::TubeAxis axis;
  for (std::size_t i = 0; i < body.axis.size(); ++i)
    axis.add(body.axis[i], body.radii[i], kBalloonColour);
  visualization::TubeBuilder(kBalloonSides).append(axis, surface);
}

void appendStent(const intervention::RoundBody& body, double thickness, visualization::Surface& surface)
{
  visualization::TubeBuilder builder(kStrutSides);
  visualization::TubeAxis strut;
  for (const std::vector<Eigen::Vector3d>& ring : intervention::stentStruts(body))
  {
    strut.clear();
    for (const Eigen::Vector3d& point : ring)
      strut.add(point, std::max(0.5 * thickness, kSmallestStrut), kStrutColour);
    if (visualization::problemOfTube(strut.points, strut.radii) == nullptr)
      builder.append(strut, surface);
  }
}

}  // namespace

std::string TreatmentDrawing::update(const TreatmentVisual& message, const motion::MotionMap& map)
{
  clear();
  intervention::RoundBody body;
  std::vector<Eigen::Vector3d> rest;
  const auto problem = [&](const TreatmentBody& drawn) -> const char*
  {
    toEigen(drawn.axis, rest);
    map.positions(rest, body.axis);
    body.radii.assign(drawn.radius.begin(), drawn.radius.end());
    return problemOfBody(body);
  };
  for (const TreatmentBody& balloon : message.balloons)
  {
    if (const char* reason = problem(balloon))
    {
      clear();
      return std::string("balloon: ") + reason;
    }
    appendBalloon(body, balloons_);
  }
  for (const TreatmentBody& stent : message.stents)
  {
    const char* reason = problem(stent);
    if (reason != nullptr || !(stent.thickness >= 0.0 && stent.thickness < 0.1))
    {
      clear();
      return std::string("stent: ") + (reason != nullptr ? reason : "thickness not finite");
    }
    appendStent(body, stent.thickness, struts_);
  }
  return {};
}

void TreatmentDrawing::clear()
{
  balloons_.clear();
  struts_.clear();
}

}  // namespace endovascular_sim::rviz_plugin
