#include "motion/map/motion_map.h"

#include <Eigen/LU>

#include "common/wide_vectors.h"
#include "motion/map/field_terms.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kNewtonSteps = 4;
constexpr int kLanes = 4;

/** Numbers of several points, one a lane. */
using Wide = double __attribute__((vector_size(kLanes * sizeof(double))));

/** Points whose Newton steps are computed together. */
struct Packet
{
  Wide target[3];  ///< moved positions [m]
  Wide rest[3];    ///< their places at rest [m]
  std::size_t index[kLanes];
  int size = 0;
};

EVS_WIDE_VECTORS void solve(const FieldTerms& terms, Packet& packet)
{
  Wide x[3] = {packet.target[0], packet.target[1], packet.target[2]};
  for (int step = 0; step < kNewtonSteps; ++step)
    newtonStep(terms, packet.target, x);
  for (int i = 0; i < 3; ++i)
    packet.rest[i] = x[i];
}

/** Solves the points of a packet, which becomes empty. */
void flush(const FieldTerms& terms, Packet& packet, std::vector<Vector3d>& rest)
{
  if (packet.size == 0)
    return;
  for (int lane = packet.size; lane < kLanes; ++lane)
    for (Wide& target : packet.target)
      target[lane] = target[0];
  solve(terms, packet);
  for (int lane = 0; lane < packet.size; ++lane)
    rest[packet.index[lane]] = Vector3d(packet.rest[0][lane], packet.rest[1][lane], packet.rest[2][lane]);
  packet.size = 0;
}

void evaluateAt(const FieldTerms& terms, const Vector3d& point, FieldPoint<double>& at)
{
  const double x[3] = {point.x(), point.y(), point.z()};
  evaluate(terms, x, at);
}

/** w v at a point. */
Vector3d faded(const FieldTerms& terms, const Vector3d& rest)
{
  FieldPoint<double> at;
  evaluateAt(terms, rest, at);
  return at.weight * Vector3d(at.value[0], at.value[1], at.value[2]);
}

}  // namespace

MotionMap::MotionMap(const HeartFrame& frame, const MotionField& field, const MotionField& rate)
  : frame_(frame), field_(field), rate_(rate), resting_(field.isZero())
{
}

bool MotionMap::outside(const Vector3d& point) const
{
  const Vector3d from = point - frame_.fade.centre;
  return from.x() * from.x() + from.y() * from.y() + from.z() * from.z() >= frame_.fade.reach * frame_.fade.reach;
}

Vector3d MotionMap::displacement(const Vector3d& rest) const
{
  return resting_ || outside(rest) ? Vector3d(Vector3d::Zero()) : faded(FieldTerms(frame_, field_), rest);
}

Vector3d MotionMap::position(const Vector3d& rest) const
{
  return resting_ || outside(rest) ? rest : Vector3d(rest + faded(FieldTerms(frame_, field_), rest));
}

Vector3d MotionMap::velocity(const Vector3d& rest) const
{
  return outside(rest) ? Vector3d(Vector3d::Zero()) : faded(FieldTerms(frame_, rate_), rest);
}

Matrix3d MotionMap::gradient(const Vector3d& rest) const
{
  if (resting_ || outside(rest))
    return Matrix3d::Identity();
  const FieldTerms terms(frame_, field_);
  FieldPoint<double> at;
  evaluateAt(terms, rest, at);
  double rows[3][3];
  differentiate(terms, at, rows);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&rows[0][0]);
}

Vector3d MotionMap::pullBack(const Vector3d& moved) const
{
  if (resting_ || outside(moved))
    return moved;
  const FieldTerms terms(frame_, field_);
  const double target[3] = {moved.x(), moved.y(), moved.z()};
  double x[3] = {moved.x(), moved.y(), moved.z()};
  for (int step = 0; step < kNewtonSteps; ++step)
    newtonStep(terms, target, x);
  return {x[0], x[1], x[2]};
}

void MotionMap::positions(const std::vector<Vector3d>& rest, std::vector<Vector3d>& moved) const
{
  moved.resize(rest.size());
  const FieldTerms terms(frame_, field_);
  for (std::size_t k = 0; k < rest.size(); ++k)
    moved[k] = resting_ || outside(rest[k]) ? rest[k] : Vector3d(rest[k] + faded(terms, rest[k]));
}

void MotionMap::pullBack(const std::vector<Vector3d>& moved, std::vector<Vector3d>& rest) const
{
  rest = moved;
  if (resting_)
    return;
  const FieldTerms terms(frame_, field_);
  Packet packet;
  for (std::size_t k = 0; k < moved.size(); ++k)
  {
    if (outside(moved[k]))
      continue;
    for (int i = 0; i < 3; ++i)
      packet.target[i][packet.size] = moved[k][i];
    packet.index[packet.size++] = k;
    if (packet.size == kLanes)
      flush(terms, packet, rest);
  }
  flush(terms, packet, rest);
}

MotionMap::Feature MotionMap::pushForward(const Vector3d& point, const Vector3d& normal) const
{
  const Vector3d turned = gradient(point).inverse().transpose() * normal;
  const double length = turned.norm();
  return {position(point), turned / length, 1.0 / length, velocity(point)};
}

}  // namespace endovascular_sim::motion
