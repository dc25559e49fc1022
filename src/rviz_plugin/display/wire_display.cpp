#include "rviz_plugin/display/wire_display.h"

#include <algorithm>
#include <cmath>

#include <OgreCamera.h>
#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/display/frame_placement.h"
#include "rviz_plugin/display/guarded.h"
#include "rviz_plugin/display/motion_subscription.h"
#include "rviz_plugin/widget/legend_picture.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kUsualHeight = 700;       // of a view [pixels]
constexpr double kShareOfRadius = 0.1;  // change of the smallest radius that is drawn

template <typename Message>
QString typeOf()
{
  return QString::fromStdString(ros::message_traits::datatype<Message>());
}

visualization::Colour toColour(const QColor& colour)
{
  return {static_cast<float>(colour.redF()), static_cast<float>(colour.greenF()), static_cast<float>(colour.blueF())};
}

}  // namespace

WireDisplay::WireDisplay()
{
  namespace names = nodes::names;
  wire_topic_ = new rviz::RosTopicProperty("Wire Topic", names::kRodStateVisual, typeOf<RodStateVisual>(),
                                           "State of the instruments.", this, SLOT(subscribe()));
  treatment_topic_ = new rviz::RosTopicProperty("Treatment Topic", names::kTreatmentVisual, typeOf<TreatmentVisual>(),
                                                "Balloons and stents.", this, SLOT(subscribe()));
  scene_topic_ = new rviz::RosTopicProperty("Scene Topic", names::kSessionInfo, typeOf<SessionInfo>(),
                                            "Scene with the shapes of the instruments.", this, SLOT(subscribe()));
  motion_topic_ = new rviz::RosTopicProperty("Motion Topic", names::kMotionState, typeOf<MotionState>(),
                                             "Motion of the patient of these instruments. Empty: the patient rests.",
                                             this, SLOT(subscribe()));
  radius_scale_ = new rviz::FloatProperty(
      "Radius Scale", 1.5F, "Drawn radius of the instruments relative to the true one.", this, SLOT(redraw()));
  radius_scale_->setMin(0.1F);
  radius_scale_->setMax(20.0F);
  smallest_width_ = new rviz::FloatProperty(
      "Smallest Width", 3.0F, "Width below which instruments are not drawn, in pixels. 0: none.", this, SLOT(redraw()));
  smallest_width_->setMin(0.0F);
  smallest_width_->setMax(50.0F);
  sides_ = new rviz::IntProperty("Sides", 12, "Number of sides of a tube.", this, SLOT(redraw()));
  sides_->setMin(3);
  sides_->setMax(64);
  catheter_opacity_ =
      new rviz::FloatProperty("Opacity over Another", 0.35F,
                              "Opacity of an instrument where another one lies in its lumen.", this, SLOT(redraw()));
  catheter_opacity_->setMin(0.0F);
  catheter_opacity_->setMax(1.0F);
  shows_forces_ =
      new rviz::BoolProperty("Forces", true, "Colours of the wall's force on each node.", this, SLOT(redraw()));
  full_force_ = new rviz::FloatProperty("Full Force", 0.0F,
                                        "Force that is drawn red, in N. 0: follows the largest force of the run.",
                                        shows_forces_, SLOT(redraw()), this);
  full_force_->setMin(0.0F);
  shows_legend_ =
      new rviz::BoolProperty("Legend", true, "Legend of the colours of force.", shows_forces_, SLOT(redraw()), this);
  shows_treatment_ =
      new rviz::BoolProperty("Balloons and Stents", true, "Draws balloons and stents.", this, SLOT(redraw()));
  const std::array<QColor, kColours> defaults{QColor(205, 212, 222), QColor(70, 160, 225), QColor(110, 200, 130),
                                              QColor(190, 140, 220)};
  for (std::size_t k = 0; k < colours_.size(); ++k)
    colours_[k] =
        new rviz::ColorProperty(QString("Colour %1").arg(k + 1), defaults[k],
                                "Colour of an instrument, counted from the inside out.", this, SLOT(redraw()));
}

WireDisplay::~WireDisplay() = default;

void WireDisplay::onInitialize()
{
  guarded(*this,
          [this]
          {
            opaque_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kOpaque, DrawnFaces::kFront);
            translucent_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kInside, DrawnFaces::kFront);
            balloons_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kInside, DrawnFaces::kFront);
            struts_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kOpaque, DrawnFaces::kFront);
            legend_ = std::make_unique<PictureOverlay>();
          });
}

void WireDisplay::onEnable()
{
  subscribe();
}

void WireDisplay::onDisable()
{
  wire_subscriber_.shutdown();
  treatment_subscriber_.shutdown();
  scene_subscriber_.shutdown();
  player_subscriber_.shutdown();
  motion_subscriber_.shutdown();
  reset();
}

void WireDisplay::fixedFrameChanged()
{
  redraw();
}

void WireDisplay::reset()
{
  rviz::Display::reset();
  follower_.clearWires();
  wire_message_.reset();
  treatment_message_.reset();
  redraw();
  guarded(*this, [this] { draw(); });
}

void WireDisplay::subscribe()
{
  if (!isEnabled())
    return;
  guarded(*this,
          [this]
          {
            // Queues of one message: between two frames of a slow display only the newest one is of use.
            wire_subscriber_ = nodes::subscribeGuarded<RodStateVisual>(update_nh_, wire_topic_->getTopicStd(), 1,
                                                                       [this](const RodStateVisualConstPtr& message)
                                                                       { follower_.add(message); });
            motion_subscriber_ = subscribeToMotion(update_nh_, motion_topic_->getTopicStd(), follower_);
            treatment_subscriber_ =
                nodes::subscribeGuarded<TreatmentVisual>(update_nh_, treatment_topic_->getTopicStd(), 1,
                                                         [this](const TreatmentVisualConstPtr& message)
                                                         {
                                                           treatment_message_ = message;
                                                           is_treatment_new_ = true;
                                                         });
            scene_subscriber_ =
                nodes::subscribeGuarded<SessionInfo>(update_nh_, scene_topic_->getTopicStd(), 1,
                                                     [this](const SessionInfoConstPtr& info) { receiveScene(info); });
            player_subscriber_ = nodes::subscribeGuarded<PlayerState>(update_nh_, nodes::names::kPlayerState, 1,
                                                                      [this](const PlayerStateConstPtr& player)
                                                                      { receivePlayer(*player); });
          });
}

void WireDisplay::redraw()
{
  wire_.setSides(sides_->getInt());
  is_wire_new_ = is_treatment_new_ = true;
}

void WireDisplay::receiveScene(const SessionInfoConstPtr& info)
{
  try
  {
    wire_.setScene(sceneSummary(*info));
    setStatus(rviz::StatusProperty::Ok, "Scene", QString::fromStdString(info->scene_name));
  }
  catch (const std::exception& error)
  {
    wire_.clearScene();
    setStatus(rviz::StatusProperty::Warn, "Scene", QString::fromUtf8(error.what()));
  }
  is_wire_new_ = true;
}

void WireDisplay::receivePlayer(const PlayerState& player)
{
  if (player.jumps == jumps_ && player.peak_node_force == largest_force_)
    return;
  jumps_ = player.jumps;
  largest_force_ = player.peak_node_force;
  wire_.restartScale(largest_force_);
  is_wire_new_ = is_wire_new_ || wire_message_ != nullptr;
}

/** Takes over the shown state; balloons and stents move with the patient. */
void WireDisplay::followPatient()
{
  is_wire_new_ = is_wire_new_ || follower_.wire() != wire_message_;
  wire_message_ = follower_.wire();
  const bool stays = is_treatment_resting_ && follower_.map().resting();
  is_treatment_new_ = is_treatment_new_ || (treatment_message_ && !stays);
}

void WireDisplay::update(float wall_dt, float /*ros_dt*/)
{
  if (follower_.advance(wall_dt))
    followPatient();
  const double radius = smallestRadius();
  if (std::abs(radius - drawn_smallest_radius_) > kShareOfRadius * drawn_smallest_radius_)
    is_wire_new_ = is_wire_new_ || wire_message_ != nullptr;
  if (is_wire_new_ || is_treatment_new_)
    guarded(*this, [this] { draw(); });
}

void WireDisplay::draw()
{
  if (!opaque_ || !legend_)
    return;
  drawn_smallest_radius_ = smallestRadius();
  const bool is_wire_new = is_wire_new_, is_treatment_new = is_treatment_new_;
  is_wire_new_ = is_treatment_new_ = false;
  if (is_wire_new)
    drawWire();
  if (is_treatment_new)
    drawTreatment();
  drawLegend();
  context_->queueRender();
}

void WireDisplay::drawWire()
{
  if (wire_message_ && placeInFrame(*this, *context_, wire_message_->header.frame_id, *scene_node_))
  {
    const std::string problem = wire_.update(*wire_message_, style());
    if (problem.empty())
      setStatus(rviz::StatusProperty::Ok, "Wire", QString("largest force %1 N").arg(wire_.largestForce(), 0, 'f', 3));
    else
      setStatus(rviz::StatusProperty::Error, "Wire", QString::fromStdString(problem));
  }
  else
  {
    wire_.clear();
    is_wire_new_ = wire_message_ != nullptr;  // until the transform is known
  }
  opaque_->update(wire_.surface(), wire_.opaqueTriangles());
  translucent_->update(wire_.surface(), wire_.translucentTriangles());
}

void WireDisplay::drawTreatment()
{
  treatment_.clear();
  is_treatment_resting_ = follower_.map().resting();
  if (treatment_message_ && shows_treatment_->getBool())
  {
    const std::string problem = treatment_.update(*treatment_message_, follower_.map());
    if (problem.empty())
      deleteStatus("Treatment");
    else
      setStatus(rviz::StatusProperty::Error, "Treatment", QString::fromStdString(problem));
  }
  balloons_->update(treatment_.balloons(), treatment_.balloons().triangles);
  struts_->update(treatment_.struts(), treatment_.struts().triangles);
}

void WireDisplay::drawLegend()
{
  const bool is_shown = isEnabled() && shows_forces_->getBool() && shows_legend_->getBool() && wire_message_;
  const double full = is_shown ? wire_.fullForce() : 0.0;
  if (full == legend_of_)
    return;
  legend_of_ = full;
  if (!is_shown)
  {
    legend_->hide();
    return;
  }
  const visualization::Colour base = toColour(colours_[0]->getColor());
  legend_->show(legendPicture("Instrument: force", visualization::legendScale(full, "N"),
                              [&](double force) { return visualization::forceColourOver(base, force, full); }),
                legendPlace(0));
}

double WireDisplay::smallestRadius() const
{
  const rviz::ViewController* view = context_->getViewManager() ? context_->getViewManager()->getCurrent() : nullptr;
  const Ogre::Camera* camera = view != nullptr ? view->getCamera() : nullptr;
  if (camera == nullptr || !wire_message_ || wire_message_->nodes.empty())
    return 0.0;
  const geometry_msgs::Point& tip = wire_message_->nodes.back();
  const Ogre::Vector3 place = scene_node_->convertLocalToWorldPosition(
      {static_cast<float>(tip.x), static_cast<float>(tip.y), static_cast<float>(tip.z)});
  const Ogre::Viewport* viewport = camera->getViewport();
  const int height = viewport != nullptr ? std::max(viewport->getActualHeight(), 1) : kUsualHeight;
  const double pixel =
      2.0 * std::tan(0.5 * camera->getFOVy().valueRadians()) * camera->getDerivedPosition().distance(place) / height;
  return std::isfinite(pixel) ? 0.5 * smallest_width_->getFloat() * pixel : 0.0;
}

visualization::WireStyle WireDisplay::style() const
{
  visualization::WireStyle style;
  style.radius_scale = radius_scale_->getFloat();
  style.smallest_radius = drawn_smallest_radius_;
  style.opacity_over_another = catheter_opacity_->getFloat();
  style.shows_forces = shows_forces_->getBool();
  style.full_force = full_force_->getFloat();
  for (const rviz::ColorProperty* colour : colours_)
    style.colours.push_back(toColour(colour->getColor()));
  return style;
}

}  // namespace endovascular_sim::rviz_plugin

PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::WireDisplay, rviz::Display)
