#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <OgreFrameListener.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <rviz/display.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "rviz_plugin/display/legend_overlay.h"
#include "rviz_plugin/display/surface_object.h"
#include "rviz_plugin/model/motion_follower.h"
#include "rviz_plugin/model/scene_summary.h"
#include "rviz_plugin/model/vessel_drawing.h"
#include "rviz_plugin/picture/branch_names.h"
#include "rviz_plugin/widget/name_picture.h"

namespace rviz
{
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
}  // namespace rviz

namespace endovascular_sim::rviz_plugin
{

/** Display of rviz: the wall with smooth shading, back faces before front faces, opened around the tip; the heat map of
 * the forces on it; the names of the branches, that of the present step's goal first. All move with the patient. */
class VesselDisplay : public rviz::Display, private Ogre::FrameListener
{
  Q_OBJECT

public:
  VesselDisplay();
  ~VesselDisplay() override;

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
  void draw();
  void drawWall();
  void drawNearWall();
  void drawHeat();
  void placeNames();
  void drawNames(const visualization::PictureView& view);
  /** Moves the names with the camera. Views move it after the update of the displays, so it stands still only here. */
  bool frameStarted(const Ogre::FrameEvent& event) override;
  void followCamera();
  bool isPlacementDue(const visualization::PictureView& view) const;
  void receiveScene(const SessionInfo& info);
  void receiveStep(const ProcedureStep& step);
  std::string goal() const;  ///< branch of the present step; empty: none
  NameStyle nameStyle() const;
  void drawLegend();
  void followPatient();
  void moveSurfaces();
  bool isCutawayDue() const;
  std::optional<visualization::PictureView> pictureView() const;

  rviz::RosTopicProperty *mesh_topic_, *centreline_topic_, *force_topic_, *wire_topic_, *motion_topic_;
  rviz::ColorProperty *colour_, *name_colour_;
  rviz::FloatProperty *far_opacity_, *near_opacity_, *cutaway_, *full_scale_, *name_height_;
  rviz::BoolProperty *shows_heat_, *shows_legend_, *shows_names_;
  rviz::EnumProperty* heat_of_;

  VesselDrawing drawing_;
  VesselMeshConstPtr mesh_message_;
  VesselCentrelineConstPtr centreline_message_;
  ContactForceMapConstPtr force_message_;
  MotionFollower follower_;
  bool is_mesh_new_ = false, is_heat_new_ = false, are_names_new_ = false;
  bool have_names_moved_ = false;                     ///< with the patient, since they were drawn
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();     ///< of the shown state [m]
  Eigen::Vector3d cut_at_ = Eigen::Vector3d::Zero();  ///< centre of the drawn cutaway, at rest [m]
  bool has_tip_ = false, is_cut_ = false;
  ros::WallTime last_cut_, names_placed_;
  MovingNames names_;
  visualization::PictureView placed_in_, drawn_in_;  ///< views for which the names were placed, and drawn
  QString legend_of_;                                ///< title and scale of the shown legend; empty: none

  std::unique_ptr<SurfaceObject> far_wall_, near_wall_, heat_;
  std::unique_ptr<PictureOverlay> legend_, name_picture_;
  std::vector<StepSummary> steps_;  ///< of the scene's procedure
  std::size_t step_ = 0;            ///< the present one, from 0
  ros::Subscriber mesh_subscriber_, centreline_subscriber_, force_subscriber_, wire_subscriber_, motion_subscriber_,
      scene_subscriber_, step_subscriber_;
};

}  // namespace endovascular_sim::rviz_plugin
