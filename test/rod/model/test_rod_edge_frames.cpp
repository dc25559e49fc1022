#include "rod/model/rod_edge_frames.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(RodEdgeFrames, RotationsAgreeWithEigens)
{
  for (const double angle : {1e-9, 0.1, 0.19, 0.21, 2.0, 3.1})
  {
    const Vector3d axis = Vector3d(0.3, -0.5, 0.7).normalized();
    const Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Vector3d v(0.2, 1.0, -0.4);
    EXPECT_LT((rotationOf(angle * axis) - expected).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((turned(v, angle * axis) - expected * v).norm(), 1e-14);
  }
}

/** Part of a loaded rod, integrated by the Runge–Kutta method over the arc length s from its beginning. */
struct Integrated
{
  static constexpr int kSteps = 400;
  Matrix3d frame = Matrix3d::Identity();
  Vector3d point = Vector3d::Zero();
  Vector3d force{0.7, -1.1, 0.9};  ///< at s = 0
  Vector3d load{0.8, 1.3, -0.6};
  Vector3d moment{0.4, -0.3, 0.5};
  Vector3d rest{0.6, 1.2, 0.0};
  Vector3d flexibility{1.0, 1.0, 1.3};

  struct Rate
  {
    Matrix3d frame;
    Vector3d point, moment;
  };

  Rate rate(double s, const Matrix3d& r, const Vector3d& m) const
  {
    const Vector3d k = flexibility.cwiseProduct(r.transpose() * m) + rest;
    Matrix3d cross;
    cross << 0.0, -k.z(), k.y(), k.z(), 0.0, -k.x(), -k.y(), k.x(), 0.0;
    return {r * cross, r.col(2), (force - s * load).cross(r.col(2))};
  }

  void advance(double from, double to)
  {
    const double ds = (to - from) / kSteps;
    for (int i = 0; i < kSteps; ++i)
    {
      const double s = from + i * ds;
      const Rate a = rate(s, frame, moment);
      const Rate b = rate(s + 0.5 * ds, frame + 0.5 * ds * a.frame, moment + 0.5 * ds * a.moment);
      const Rate c = rate(s + 0.5 * ds, frame + 0.5 * ds * b.frame, moment + 0.5 * ds * b.moment);
      const Rate d = rate(s + ds, frame + ds * c.frame, moment + ds * c.moment);
      frame += ds / 6.0 * (a.frame + 2.0 * b.frame + 2.0 * c.frame + d.frame);
      point += ds / 6.0 * (a.point + 2.0 * b.point + 2.0 * c.point + d.point);
      moment += ds / 6.0 * (a.moment + 2.0 * b.moment + 2.0 * c.moment + d.moment);
    }
  }
};

/** Errors of an edge of the length h around s = 0.3. */
struct Errors
{
  double ends = 0.0;       ///< error of the frames at the ends against the chord
  double between = 0.0;    ///< error of the rotation between both frames
  double moment = 0.0;     ///< error of the difference of the moments about the chord, from the load
  double curvature = 0.0;  ///< error of the curvature in the middle
};

Errors errorsOf(double h)
{
  Integrated begin;
  begin.advance(0.0, 0.3 - 0.5 * h);
  Integrated middle = begin;
  middle.advance(0.3 - 0.5 * h, 0.3);
  Integrated end = middle;
  end.advance(0.3, 0.3 + 0.5 * h);
  const Vector3d chord = (end.point - begin.point).normalized();
  // Frame with the chord as its third axis: the material frame, rotated least.
  const Vector3d across = middle.frame.col(2).cross(chord);
  Matrix3d frame = rotationOf(across) * middle.frame;
  frame.col(2) = chord;
  frame.col(0) = (frame.col(0) - frame.col(0).dot(chord) * chord).normalized();
  frame.col(1) = chord.cross(frame.col(0));
  EdgeLoad edge;
  edge.length = h;
  edge.flexibility = 1.0;
  edge.twist_flexibility = 1.3;
  edge.rest_curvature = begin.rest;
  edge.load = frame.transpose() * begin.load;
  edge.tension = (begin.force - 0.3 * begin.load).dot(chord);
  edge.moment = {frame.transpose() * begin.moment, frame.transpose() * end.moment};
  const RodEdgeFrames shape(edge);
  // The angle of the frame about the chord is an input: that of the end.
  const Vector3d found = frame * shape.turn[1].col(0);
  const Vector3d tangent = end.frame.col(2);
  const double about = std::atan2(found.cross(end.frame.col(0)).dot(tangent), found.dot(end.frame.col(0)));
  Errors errors;
  errors.between = (shape.turn[0].transpose() * shape.turn[1] - begin.frame.transpose() * end.frame).norm();
  errors.ends = (frame * shape.turn[1].col(2) - tangent).norm() +
                (frame * shape.turn[0].col(2) - begin.frame.col(2)).norm() + std::abs(about);
  const Vector3d curvature = frame * shape.curvature;
  errors.moment = std::abs((end.moment - begin.moment).dot(chord) -
                           h * h * h / 12.0 * begin.load.dot(curvature - curvature.dot(chord) * chord));
  errors.curvature =
      (curvature -
       middle.frame * (middle.flexibility.cwiseProduct(middle.frame.transpose() * middle.moment) + middle.rest))
          .norm();
  return errors;
}

TEST(RodEdgeFrames, AgreesWithTheIntegratedRodToTheOrderThatTheSchemeNeeds)
{
  const Errors coarse = errorsOf(0.2);
  const Errors fine = errorsOf(0.1);
  EXPECT_NEAR(std::log2(coarse.between / fine.between), 5.0, 0.2);
  EXPECT_NEAR(std::log2(coarse.ends / fine.ends), 4.0, 0.2);
  EXPECT_NEAR(std::log2(coarse.moment / fine.moment), 5.0, 0.2);
  EXPECT_NEAR(std::log2(coarse.curvature / fine.curvature), 4.0, 0.2);
  EXPECT_LT(fine.between, 1e-6);
  EXPECT_LT(fine.ends, 1e-5);
}

}  // namespace
}  // namespace endovascular_sim::rod
