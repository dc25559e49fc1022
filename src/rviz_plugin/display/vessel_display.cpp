#include "rviz_plugin/display/vessel_display.h"

#include <algorithm>
#include <cmath>

#include <OgreCamera.h>
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/display/copied_config.h"
#include "rviz_plugin/display/frame_placement.h"
#include "rviz_plugin/display/guarded.h"
#include "rviz_plugin/display/motion_subscription.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/legend_picture.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kNamesPeriod = 0.25;    ///< shortest time between two placements of the names [s]
constexpr float kGlow = 0.3F;            ///< of the far wall, relative to its colour
constexpr double kMiddleDistance = 0.2;  ///< of the vessel from the camera [m]
constexpr double kMotionOfNames = 12.0;  ///< motion of the picture after which names are placed anew [pixels]
constexpr double kShareOfNames = 0.05;   ///< change of the distance after which they are placed anew, relative
constexpr double kSmallMotion = 0.1;     ///< motion of the picture after which names are drawn anew [pixels]
constexpr double kSmallShare = 1e-4;     ///< change of the distance after which they are drawn anew, relative
constexpr double kCutawayPeriod = 0.2;   ///< shortest time between two cutaways [s]
constexpr double kCutawayShare = 0.1;    ///< motion of the tip that moves the cutaway, relative to its radius

template <typename Message>
QString typeOf()
{
  return QString::fromStdString(ros::message_traits::datatype<Message>());
}

visualization::Colour toColour(const QColor& colour)
{
  return {static_cast<float>(colour.redF()), static_cast<float>(colour.greenF()), static_cast<float>(colour.blueF())};
}

Eigen::Vector3d toEigen(const Ogre::Vector3& vector)
{
  return {vector.x, vector.y, vector.z};
}

/** True if a view differs from another one.
 *  @param motion of a point in the middle distance, in the picture [pixels]
 *  @param share change of its distance, relative */
bool hasMoved(const visualization::PictureView& view, const visualization::PictureView& from, double motion,
              double share)
{
  const Eigen::Vector3d point = from.eye + kMiddleDistance * from.forward;
  return view.width != from.width || view.height != from.height || view.depth(point) <= 0.0 ||
         view.project(point).norm() > motion || std::abs(view.depth(point) / kMiddleDistance - 1.0) > share ||
         from.focal * (view.up - from.up).norm() > motion;
}

}  // namespace

VesselDisplay::VesselDisplay()
{
  namespace names = nodes::names;
  mesh_topic_ = new rviz::RosTopicProperty("Mesh Topic", names::kVesselMesh, typeOf<VesselMesh>(),
                                           "Wall of the vessel.", this, SLOT(subscribe()));
  centreline_topic_ =
      new rviz::RosTopicProperty("Centreline Topic", names::kVesselCentreline, typeOf<VesselCentreline>(),
                                 "Branches and their names.", this, SLOT(subscribe()));
  force_topic_ = new rviz::RosTopicProperty("Force Topic", names::kContactForceMap, typeOf<ContactForceMap>(),
                                            "Forces on the wall.", this, SLOT(subscribe()));
  wire_topic_ = new rviz::RosTopicProperty("Wire Topic", names::kRodStateVisual, typeOf<RodStateVisual>(),
                                           "State of the instruments; its tip is the centre of the cutaway.", this,
                                           SLOT(subscribe()));
  motion_topic_ =
      new rviz::RosTopicProperty("Motion Topic", names::kMotionState, typeOf<MotionState>(),
                                 "Motion of the patient. Empty: the patient rests.", this, SLOT(subscribe()));
  colour_ = new rviz::ColorProperty("Colour", QColor(226, 120, 110), "Colour of the wall.", this, SLOT(redraw()));
  far_opacity_ =
      new rviz::FloatProperty("Far Wall Opacity", 0.75F, "Opacity of the wall behind the lumen.", this, SLOT(redraw()));
  near_opacity_ = new rviz::FloatProperty("Near Wall Opacity", 0.18F, "Opacity of the wall before the lumen.", this,
                                          SLOT(redraw()));
  for (rviz::FloatProperty* opacity : {far_opacity_, near_opacity_})
  {
    opacity->setMin(0.0F);
    opacity->setMax(1.0F);
  }
  cutaway_ = new rviz::FloatProperty("Cutaway Radius", 0.03F, "The near wall is open around the tip, in m. 0: closed.",
                                     this, SLOT(redraw()));
  cutaway_->setMin(0.0F);
  shows_heat_ = new rviz::BoolProperty("Forces", true, "Heat map of the forces on the wall.", this, SLOT(redraw()));
  heat_of_ = new rviz::EnumProperty("Quantity", "Peak", "Quantity of the heat map.", shows_heat_, SLOT(redraw()), this);
  heat_of_->addOption("Peak", static_cast<int>(HeatQuantity::kPeak));
  heat_of_->addOption("Integral", static_cast<int>(HeatQuantity::kIntegral));
  heat_of_->addOption("Time over threshold", static_cast<int>(HeatQuantity::kTimeOverThreshold));
  full_scale_ = new rviz::FloatProperty(
      "Full Scale", 0.0F, "Value that is drawn red, in N, N·s or s. 0: follows the largest value of the run.",
      shows_heat_, SLOT(redraw()), this);
  full_scale_->setMin(0.0F);
  shows_legend_ = new rviz::BoolProperty("Legend", true, "Legend of the heat map.", shows_heat_, SLOT(redraw()), this);
  shows_names_ = new rviz::BoolProperty("Branch Names", true, "Names of the branches.", this, SLOT(redraw()));
  name_colour_ = new rviz::ColorProperty("Name Colour", QColor(245, 245, 245), "Colour of the names.", shows_names_,
                                         SLOT(redraw()), this);
  name_height_ = new rviz::FloatProperty("Name Height", 13.0F, "Height of the letters in pixels.", shows_names_,
                                         SLOT(redraw()), this);
  name_height_->setMin(4.0F);
}

VesselDisplay::~VesselDisplay()
{
  if (Ogre::Root* root = Ogre::Root::getSingletonPtr())
    root->removeFrameListener(this);
}

void VesselDisplay::onInitialize()
{
  guarded(*this,
          [this]
          {
            far_wall_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kFarWall, DrawnFaces::kBack);
            near_wall_ = std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kNearWall,
                                                         DrawnFaces::kFront);
            heat_ =
                std::make_unique<SurfaceObject>(scene_manager_, scene_node_, DrawingOrder::kInside, DrawnFaces::kBoth);
            heat_->setFlat();
            legend_ = std::make_unique<PictureOverlay>();
            name_picture_ = std::make_unique<PictureOverlay>();
            Ogre::Root::getSingleton().addFrameListener(this);
            closeWithoutQuestion(*context_);
          });
}

void VesselDisplay::onEnable()
{
  subscribe();
}

void VesselDisplay::onDisable()
{
  for (ros::Subscriber* subscriber : {&mesh_subscriber_, &centreline_subscriber_, &force_subscriber_, &wire_subscriber_,
                                      &motion_subscriber_, &scene_subscriber_, &step_subscriber_})
    subscriber->shutdown();
  reset();
}

void VesselDisplay::fixedFrameChanged()
{
  redraw();
}

void VesselDisplay::reset()
{
  rviz::Display::reset();
  force_message_.reset();
  follower_.clearWires();
  has_tip_ = false;
  if (!isEnabled())
  {
    mesh_message_.reset();  // published once: a reset of the scene's time keeps it
    centreline_message_.reset();
  }
  redraw();
  guarded(*this, [this] { draw(); });
}

void VesselDisplay::subscribe()
{
  if (!isEnabled())
    return;
  guarded(*this,
          [this]
          {
            mesh_subscriber_ = nodes::subscribeGuarded<VesselMesh>(update_nh_, mesh_topic_->getTopicStd(), 1,
                                                                   [this](const VesselMeshConstPtr& message)
                                                                   {
                                                                     mesh_message_ = message;
                                                                     is_mesh_new_ = is_heat_new_ = true;
                                                                   });
            centreline_subscriber_ =
                nodes::subscribeGuarded<VesselCentreline>(update_nh_, centreline_topic_->getTopicStd(), 1,
                                                          [this](const VesselCentrelineConstPtr& message)
                                                          {
                                                            centreline_message_ = message;
                                                            names_.clear();
                                                            are_names_new_ = true;
                                                          });
            force_subscriber_ = nodes::subscribeGuarded<ContactForceMap>(update_nh_, force_topic_->getTopicStd(), 1,
                                                                         [this](const ContactForceMapConstPtr& message)
                                                                         {
                                                                           force_message_ = message;
                                                                           is_heat_new_ = true;
                                                                         });
            wire_subscriber_ = nodes::subscribeGuarded<RodStateVisual>(update_nh_, wire_topic_->getTopicStd(), 1,
                                                                       [this](const RodStateVisualConstPtr& message)
                                                                       { follower_.add(message); });
            motion_subscriber_ = subscribeToMotion(update_nh_, motion_topic_->getTopicStd(), follower_);
            scene_subscriber_ =
                nodes::subscribeGuarded<SessionInfo>(update_nh_, nodes::names::kSessionInfo, 1,
                                                     [this](const SessionInfoConstPtr& info) { receiveScene(*info); });
            step_subscriber_ = nodes::subscribeGuarded<ProcedureStep>(update_nh_, nodes::names::kProcedureStep, 1,
                                                                      [this](const ProcedureStepConstPtr& step)
                                                                      { receiveStep(*step); });
          });
}

void VesselDisplay::receiveScene(const SessionInfo& info)
{
  steps_.clear();
  are_names_new_ = true;
  try
  {
    steps_ = sceneSummary(info).steps;
  }
  catch (const std::exception& error)
  {
    setStatus(rviz::StatusProperty::Warn, "Scene", QString::fromUtf8(error.what()));
  }
}

void VesselDisplay::receiveStep(const ProcedureStep& step)
{
  const std::string before = goal();
  step_ = std::max(step.step_of_procedure, 1U) - 1U;
  are_names_new_ = are_names_new_ || goal() != before;
}

std::string VesselDisplay::goal() const
{
  return step_ < steps_.size() ? steps_[step_].goal : std::string();
}

/** Takes over the tip and the motion of the shown state. */
void VesselDisplay::followPatient()
{
  const RodStateVisualConstPtr& wire = follower_.wire();
  if (wire && !wire->nodes.empty())
  {
    const geometry_msgs::Point& tip = wire->nodes.back();
    tip_ = {tip.x, tip.y, tip.z};
    has_tip_ = tip_.allFinite();
  }
  if (drawing_.move(follower_.map()))
    moveSurfaces();
}

void VesselDisplay::moveSurfaces()
{
  if (!far_wall_ || !heat_)
    return;
  // Before a draw the surfaces and the drawing may differ.
  if (!is_mesh_new_)
  {
    far_wall_->move(drawing_.wall(), drawing_.movingVertices());
    near_wall_->move(drawing_.wall(), drawing_.movingVertices());
  }
  if (!is_heat_new_)
    heat_->move(drawing_.heat());
  have_names_moved_ = names_.move(follower_.map()) || have_names_moved_;
  context_->queueRender();
}

void VesselDisplay::redraw()
{
  is_mesh_new_ = is_heat_new_ = are_names_new_ = true;
}

std::optional<visualization::PictureView> VesselDisplay::pictureView() const
{
  const rviz::ViewController* controller =
      context_->getViewManager() ? context_->getViewManager()->getCurrent() : nullptr;
  const Ogre::Camera* camera = controller != nullptr ? controller->getCamera() : nullptr;
  if (camera == nullptr)
    return std::nullopt;
  const auto axis = [&](const Ogre::Vector3& direction)
  { return toEigen(scene_node_->getOrientation().Inverse() * direction).normalized().eval(); };
  visualization::PictureView view;
  view.eye = toEigen(scene_node_->convertWorldToLocalPosition(camera->getDerivedPosition()));
  view.right = axis(camera->getDerivedRight());
  view.up = axis(camera->getDerivedUp());
  view.forward = axis(camera->getDerivedDirection());
  const Ogre::Viewport* viewport = camera->getViewport();
  if (viewport != nullptr && viewport->getActualHeight() > 0)
  {
    view.width = viewport->getActualWidth();
    view.height = viewport->getActualHeight();
  }
  view.legend_width = legendsSize().width();
  view.legend_height = legendsSize().height();
  view.focal = 0.5 * view.height / std::tan(0.5 * camera->getFOVy().valueRadians());
  if (has_tip_)
    view.reach = reachOfNames(tip_, view);
  return view;
}

void VesselDisplay::followCamera()
{
  if (!isEnabled() || (names_.empty() && !centreline_message_))
    return;
  const std::optional<visualization::PictureView> view = pictureView();
  if (!view)
    return;
  if (isPlacementDue(*view))
    placeNames();
  else if (!names_.empty() && (have_names_moved_ || hasMoved(*view, drawn_in_, kSmallMotion, kSmallShare)))
    drawNames(*view);
}

bool VesselDisplay::isPlacementDue(const visualization::PictureView& view) const
{
  if ((ros::WallTime::now() - names_placed_).toSec() <= kNamesPeriod)
    return false;
  const auto is_cut = [&view](const visualization::PlacedName& name)
  {
    return view.depth(name.end) > 0.0 &&
           (name.boxInside(view).centre() - name.box(view).centre()).norm() > kSmallMotion;
  };
  return hasMoved(view, placed_in_, kMotionOfNames, kShareOfNames) ||
         std::any_of(names_.names().begin(), names_.names().end(), is_cut);
}

bool VesselDisplay::frameStarted(const Ogre::FrameEvent& /*event*/)
{
  guarded(*this, [this] { followCamera(); });
  return true;
}

bool VesselDisplay::isCutawayDue() const
{
  const double radius = cutaway_->getFloat();
  if (radius <= 0.0 || (ros::WallTime::now() - last_cut_).toSec() < kCutawayPeriod)
    return false;
  // The opening moves with the patient.
  return has_tip_ != is_cut_ ||
         (has_tip_ && (follower_.map().pullBack(tip_) - cut_at_).norm() > kCutawayShare * radius);
}

void VesselDisplay::update(float wall_dt, float /*ros_dt*/)
{
  guarded(*this,
          [this, wall_dt]
          {
            if (follower_.advance(wall_dt))
              followPatient();
            if (is_mesh_new_ || is_heat_new_ || are_names_new_)
              draw();
            else if (near_wall_ && mesh_message_ && isCutawayDue())
            {
              drawNearWall();
              context_->queueRender();
            }
          });
}

void VesselDisplay::draw()
{
  if (!far_wall_ || !legend_)
    return;
  const bool is_mesh_new = is_mesh_new_, is_heat_new = is_heat_new_, are_names_new = are_names_new_;
  is_mesh_new_ = is_heat_new_ = are_names_new_ = false;
  if (is_mesh_new)
    drawWall();
  if (is_heat_new)
    drawHeat();
  if (are_names_new)
    placeNames();
  drawLegend();
  context_->queueRender();
}

void VesselDisplay::drawWall()
{
  static const std::vector<std::uint32_t> kNone;
  if (!mesh_message_ || !placeInFrame(*this, *context_, mesh_message_->header.frame_id, *scene_node_))
  {
    is_mesh_new_ = mesh_message_ != nullptr;  // until the transform is known
    far_wall_->update({}, kNone);
    near_wall_->update({}, kNone);
    return;
  }
  const std::string problem =
      drawing_.setVessel(*mesh_message_, {toColour(colour_->getColor()), far_opacity_->getFloat()});
  if (problem.empty())
    setStatus(rviz::StatusProperty::Ok, "Wall", QString("%1 triangles").arg(drawing_.wall().triangles.size() / 3));
  else
    setStatus(rviz::StatusProperty::Error, "Wall", QString::fromStdString(problem));
  far_wall_->setGlow(visualization::blend({}, toColour(colour_->getColor()), kGlow));
  far_wall_->update(drawing_.wall(), drawing_.wall().triangles);
  drawNearWall();
}

void VesselDisplay::drawNearWall()
{
  static const std::vector<std::uint32_t> kNone;
  const bool is_drawn = near_opacity_->getFloat() > 0.0F;
  drawing_.cutAway(tip_, has_tip_ ? cutaway_->getFloat() : 0.0F, near_opacity_->getFloat());
  near_wall_->update(drawing_.wall(), is_drawn ? drawing_.wall().triangles : kNone);
  cut_at_ = follower_.map().pullBack(tip_);
  is_cut_ = has_tip_;
  last_cut_ = ros::WallTime::now();
}

void VesselDisplay::drawHeat()
{
  static const std::vector<std::uint32_t> kNone;
  if (!force_message_ || !mesh_message_ || !shows_heat_->getBool())
  {
    heat_->update({}, kNone);
    return;
  }
  const auto quantity = static_cast<HeatQuantity>(heat_of_->getOptionInt());
  const std::string problem = drawing_.setForces(*force_message_, quantity, full_scale_->getFloat());
  if (problem.empty())
    setStatus(rviz::StatusProperty::Ok, "Forces",
              QString("%1 touched triangles").arg(force_message_->triangles.size()));
  else
    setStatus(rviz::StatusProperty::Warn, "Forces", QString::fromStdString(problem));
  heat_->update(drawing_.heat(), drawing_.heat().triangles);
}

NameStyle VesselDisplay::nameStyle() const
{
  return {name_colour_->getColor(), static_cast<int>(std::lround(fontScale() * name_height_->getFloat()))};
}

void VesselDisplay::placeNames()
{
  const std::optional<visualization::PictureView> view = pictureView();
  if (!isEnabled() || !centreline_message_ || !shows_names_->getBool() || !view)
  {
    names_.clear();
    name_picture_->hide();
    return;
  }
  const NameStyle style = nameStyle();
  names_.place(branchesToName(
                   *centreline_message_, [&](const std::string& text) { return nameSize(text, style); }, goal()),
               *view, follower_.map());
  names_placed_ = ros::WallTime::now();
  placed_in_ = *view;
  drawNames(*view);
}

void VesselDisplay::drawNames(const visualization::PictureView& view)
{
  name_picture_->show(namePicture(names_.names(), view, nameStyle()), {0, 0});
  drawn_in_ = view;
  have_names_moved_ = false;
}

void VesselDisplay::drawLegend()
{
  const bool is_shown =
      isEnabled() && shows_heat_->getBool() && shows_legend_->getBool() && force_message_ && mesh_message_;
  const auto quantity = static_cast<HeatQuantity>(heat_of_->getOptionInt());
  const double full = drawing_.fullScale();
  const QString legend = is_shown ? QString("%1 %2").arg(static_cast<int>(quantity)).arg(full) : QString();
  if (legend == legend_of_)
    return;
  legend_of_ = legend;
  if (!is_shown)
  {
    legend_->hide();
    return;
  }
  const char* title = quantity == HeatQuantity::kPeak       ? "Wall: peak force"
                      : quantity == HeatQuantity::kIntegral ? "Wall: force integral"
                                                            : "Wall: time over threshold";
  const char* unit = quantity == HeatQuantity::kPeak ? "N" : quantity == HeatQuantity::kIntegral ? "N·s" : "s";
  const visualization::Colour wall = toColour(colour_->getColor());
  legend_->show(legendPicture(title, visualization::legendScale(full, unit),
                              [&](double value)
                              {
                                const visualization::TranslucentColour heat = visualization::heatColour(value, full);
                                return visualization::blend(wall, heat.colour, heat.opacity);
                              }),
                legendPlace(1));
}

}  // namespace endovascular_sim::rviz_plugin

PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::VesselDisplay, rviz::Display)
