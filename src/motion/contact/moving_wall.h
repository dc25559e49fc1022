#pragma once

#include <vector>

#include "contact/contract/contact_set.h"
#include "contact/contract/wall_motion.h"
#include "motion/map/map_bounds.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::motion
{

/** Contact sets of a vessel that moves by a smooth map, from those of the vessel at rest (docs/MOTION.md).
 *
 *  Nodes of a query are pulled back, the source answers at rest, and features are pushed forward. The query at rest
 *  lists every feature that lies within the margin in the moved patient: lengths at rest are at most the moved ones by
 * the local compression, and an edge that is straight in the moved patient is bent at rest by its sag at most. */
class MovingWall : public contact::ContactSource, public contact::WallMotion
{
public:
  /** @param source contact sets of the vessel at rest; must outlive this
   *  @param bounds of the motion in the lumen */
  MovingWall(contact::ContactSource* source, const MapBounds& bounds);

  /** Begins a step in which the patient moves from one map to another. Queries before the first move() are answered at
   *  the first one. */
  void beginStep(const MotionMap& from, const MotionMap& to);

  /** True if a step that was begun moves anything. */
  bool moves() const { return moves_; }

  void detect(const contact::Query& query, contact::ContactSet& set) override;
  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override;

  void move(double from, double to, const std::vector<Eigen::Vector3d>& points, int first,
            contact::WallTravel& travel) override;
  void carry(std::vector<contact::Feature>& features) const override;

private:
  void pullBack(const contact::Query& query);
  double stretchAt(std::size_t node, double distance) const;
  double sagAt(const contact::Query& query, std::size_t node) const;
  void pushForward(const contact::Query& query, contact::ContactSet& set) const;
  void takeWall(const std::vector<contact::Feature>& features) const;
  void beginAnswer(contact::ContactSet& set) const;

  contact::ContactSource* source_;
  MapBounds bounds_;
  bool moves_ = false;
  MotionMap step_begin_, step_end_;             ///< of the present step
  MotionMap before_, map_;                      ///< before and after the last move
  std::vector<Eigen::Vector3d> points_, rest_;  ///< points of the last move before it, and their places at rest [m]
  mutable std::vector<Eigen::Vector3d> wall_points_, wall_normals_, guesses_;  ///< of features, kept for their memory
  contact::Query rest_query_;
  contact::ContactSet rest_set_;
  std::vector<double> deformation_;  ///< at every node of the last query [1]
};

}  // namespace endovascular_sim::motion
