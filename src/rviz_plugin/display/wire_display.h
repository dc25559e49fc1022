#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <ros/subscriber.h>
#include <rviz/display.h>

#include "endovascular_sim/PlayerState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "rviz_plugin/display/legend_overlay.h"
#include "rviz_plugin/display/surface_object.h"
#include "rviz_plugin/model/motion_follower.h"
#include "rviz_plugin/model/treatment_drawing.h"
#include "rviz_plugin/model/wire_drawing.h"

namespace rviz
{
class BoolProperty;
class ColorProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
}  // namespace rviz

namespace endovascular_sim::rviz_plugin
{

/** Display of rviz: instruments as smooth tubes with the colours of force, balloons and stents.
 *
 *  A message is drawn with the next frame; of several messages between two frames only the newest one is drawn. The
 *  vessel is drawn with the motion of the same step (MotionFollower), and with it balloons and stents. */
class WireDisplay : public rviz::Display
{
  Q_OBJECT

public:
  WireDisplay();
  ~WireDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;

protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void fixedFrameChanged() override;

private Q_SLOTS:
  void subscribe();
  void redraw();

private:  // NOLINT(readability-redundant-access-specifiers): after slots
  static constexpr int kColours = 4;

  void receiveScene(const SessionInfoConstPtr& info);
  /** Takes over the largest force of a recording up to the shown time. */
  void receivePlayer(const PlayerState& player);
  void followPatient();
  void draw();
  void drawWire();
  void drawTreatment();
  void drawLegend();
  visualization::WireStyle style() const;
  double smallestRadius() const;

  rviz::RosTopicProperty *wire_topic_, *treatment_topic_, *scene_topic_, *motion_topic_;
  rviz::FloatProperty *radius_scale_, *smallest_width_, *catheter_opacity_, *full_force_;
  rviz::IntProperty* sides_;
  rviz::BoolProperty *shows_forces_, *shows_legend_, *shows_treatment_;
  std::array<rviz::ColorProperty*, kColours> colours_;

  WireDrawing wire_;
  TreatmentDrawing treatment_;
  MotionFollower follower_;
  RodStateVisualConstPtr wire_message_;  ///< shown state
  TreatmentVisualConstPtr treatment_message_;
  bool is_wire_new_ = false, is_treatment_new_ = false;
  bool is_treatment_resting_ = true;    ///< balloons and stents are drawn where they rest
  double drawn_smallest_radius_ = 0.0;  ///< [m]
  double legend_of_ = 0.0;              ///< full scale of the shown legend [N]; 0: none
  std::uint32_t jumps_ = 0;             ///< of the player of a recording
  double largest_force_ = 0.0;          ///< of a recording up to the shown time [N]

  std::unique_ptr<SurfaceObject> opaque_, translucent_, balloons_, struts_;
  std::unique_ptr<PictureOverlay> legend_;
  ros::Subscriber wire_subscriber_, treatment_subscriber_, scene_subscriber_, player_subscriber_, motion_subscriber_;
};

}  // namespace endovascular_sim::rviz_plugin
