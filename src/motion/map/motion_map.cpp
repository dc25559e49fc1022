#include "motion/map/motion_map.h"

#include <cmath>

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

/** Squares of |∇φ − 1| at the places of a packet. */
EVS_WIDE_VECTORS void measure(const FieldTerms& terms, const Packet& packet, Wide& square)
{
  FieldPoint<Wide> at;
  evaluate(terms, packet.rest, at);
  Wide gradient[3][3];
  differentiate(terms, at, gradient);
  square = at.weight - at.weight;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const Wide strain = i == j ? gradient[i][j] - 1.0 : gradient[i][j];
      square += strain * strain;
    }
}

/** Cofactors of a gradient: they turn normals of the wall at rest into those of the moved one, up to their length. */
[[gnu::always_inline]] inline void cofactors(const Wide (&g)[3][3], Wide (&cofactor)[3][3])
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      cofactor[i][j] = g[(i + 1) % 3][(j + 1) % 3] * g[(i + 2) % 3][(j + 2) % 3] -
                       g[(i + 1) % 3][(j + 2) % 3] * g[(i + 2) % 3][(j + 1) % 3];
}

/** Motion of material at the places of a packet.
 *  @param now field of the present map
 *  @param change of the field
 *  @param turn half the curl of that motion in the moved patient */
EVS_WIDE_VECTORS void moveMaterial(const FieldTerms& now, const FieldTerms& change, const Packet& packet,
                                   Wide (&displacement)[3], Wide (&turn)[3])
{
  FieldPoint<Wide> at;
  evaluate(now, packet.rest, at);
  Wide g[3][3], d[3][3], cofactor[3][3];
  differentiate(now, at, g);
  cofactors(g, cofactor);
  evaluate(change, packet.rest, at);
  differentiate(change, at, d);
  for (int i = 0; i < 3; ++i)
  {
    displacement[i] = at.weight * at.value[i];
    d[i][i] = d[i][i] - 1.0;
  }
  const Wide half = 0.5 / (g[0][0] * cofactor[0][0] + g[0][1] * cofactor[0][1] + g[0][2] * cofactor[0][2]);
  Wide change_of[3][3];  // d times the adjugate of g
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      change_of[i][j] = d[i][0] * cofactor[j][0] + d[i][1] * cofactor[j][1] + d[i][2] * cofactor[j][2];
  for (int i = 0; i < 3; ++i)
    turn[i] = half * (change_of[(i + 2) % 3][(i + 1) % 3] - change_of[(i + 1) % 3][(i + 2) % 3]);
}

/** Moves the wall at the places of a packet. @param normal at rest; of any length in the moved patient */
EVS_WIDE_VECTORS void moveWall(const FieldTerms& terms, const Packet& packet, Wide (&moved)[3], Wide (&normal)[3])
{
  FieldPoint<Wide> at;
  evaluate(terms, packet.rest, at);
  Wide g[3][3], cofactor[3][3];
  differentiate(terms, at, g);
  cofactors(g, cofactor);
  const Wide n[3] = {normal[0], normal[1], normal[2]};
  for (int i = 0; i < 3; ++i)
  {
    moved[i] = packet.rest[i] + at.weight * at.value[i];
    normal[i] = cofactor[i][0] * n[0] + cofactor[i][1] * n[1] + cofactor[i][2] * n[2];
  }
}

/** Moves the wall at the targets of a packet, whose places at rest are near its `rest`, from one map to another.
 *  @param moved change of the position, then added to the target
 *  @param normal in the first map; of any length in the second one */
EVS_WIDE_VECTORS void carryWall(const FieldTerms& from, const FieldTerms& to, Packet& packet, Wide (&moved)[3],
                                Wide (&normal)[3])
{
  newtonStep(from, packet.target, packet.rest);
  FieldPoint<Wide> before, after;
  evaluate(from, packet.rest, before);
  evaluate(to, packet.rest, after);
  Wide g[3][3], cofactor[3][3], n[3];
  differentiate(from, before, g);
  for (int j = 0; j < 3; ++j)
    n[j] = g[0][j] * normal[0] + g[1][j] * normal[1] + g[2][j] * normal[2];
  differentiate(to, after, g);
  cofactors(g, cofactor);
  for (int i = 0; i < 3; ++i)
  {
    moved[i] = packet.target[i] + (after.weight * after.value[i] - before.weight * before.value[i]);
    normal[i] = cofactor[i][0] * n[0] + cofactor[i][1] * n[1] + cofactor[i][2] * n[2];
  }
}

/** Calls act(packet) with the points of a packet, its last lanes filled; the packet becomes empty. */
template <typename Act>
void flush(Packet& packet, Wide (&points)[3], const Act& act)
{
  if (packet.size == 0)
    return;
  for (int lane = packet.size; lane < kLanes; ++lane)
    for (Wide& point : points)
      point[lane] = point[0];
  act(packet);
  packet.size = 0;
}

/** Sets the lanes to the vectors of a packet's points, its last lanes to the first of them. */
void gather(const std::vector<Vector3d>& vectors, const Packet& packet, Wide (&wide)[3])
{
  for (int lane = 0; lane < kLanes; ++lane)
    for (int i = 0; i < 3; ++i)
      wide[i][lane] = vectors[packet.index[lane < packet.size ? lane : 0]][i];
}

Vector3d laneOf(const Wide (&wide)[3], int lane)
{
  return {wide[0][lane], wide[1][lane], wide[2][lane]};
}

/** Calls act(packet) for all points from the first one on that are not skipped.
 *  @param member array of the packet that receives the points */
template <typename Skip, typename Act>
void forPackets(const std::vector<Vector3d>& points, std::size_t first, Wide (Packet::*member)[3], const Skip& skip,
                const Act& act)
{
  Packet packet;
  Wide(&wide)[3] = packet.*member;
  for (std::size_t k = first; k < points.size(); ++k)
  {
    if (skip(points[k]))
      continue;
    for (int i = 0; i < 3; ++i)
      wide[i][packet.size] = points[k][i];
    packet.index[packet.size++] = k;
    if (packet.size == kLanes)
      flush(packet, wide, act);
  }
  flush(packet, wide, act);
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
  forPackets(
      moved, 0, &Packet::target, [this](const Vector3d& point) { return outside(point); },
      [&](Packet& packet)
      {
        solve(terms, packet);
        for (int lane = 0; lane < packet.size; ++lane)
          rest[packet.index[lane]] = laneOf(packet.rest, lane);
      });
}

void MotionMap::pullBack(const std::vector<Vector3d>& moved, std::vector<Vector3d>& rest,
                         std::vector<double>& deformation) const
{
  rest = moved;
  deformation.assign(moved.size(), 0.0);
  if (resting_)
    return;
  const FieldTerms terms(frame_, field_);
  forPackets(
      moved, 0, &Packet::target, [this](const Vector3d& point) { return outside(point); },
      [&](Packet& packet)
      {
        solve(terms, packet);
        Wide square;
        measure(terms, packet, square);
        for (int lane = 0; lane < packet.size; ++lane)
        {
          rest[packet.index[lane]] = laneOf(packet.rest, lane);
          deformation[packet.index[lane]] = std::sqrt(square[lane]);
        }
      });
}

MotionMap MotionMap::between(const MotionMap& from, const MotionMap& to, double share)
{
  if (share == 0.0 || share == 1.0)
    return share == 0.0 ? from : to;
  const auto mix = [share](const MotionField& a, const MotionField& b) { return a + (b - a) * share; };
  return {from.frame_, mix(from.field_, to.field_), mix(from.rate_, to.rate_)};
}

void MotionMap::motionTo(const MotionMap& other, const std::vector<Vector3d>& rest, std::size_t first,
                         std::vector<Vector3d>& displacement, std::vector<Vector3d>& turn) const
{
  displacement.assign(rest.size(), Vector3d::Zero());
  turn.assign(rest.size(), Vector3d::Zero());
  const MotionField change = other.field_ - field_;
  if (change.isZero())
    return;
  const FieldTerms now(frame_, field_), then(frame_, change);
  forPackets(
      rest, first, &Packet::rest, [this](const Vector3d& point) { return outside(point); },
      [&](Packet& packet)
      {
        Wide moved[3], turned[3];
        moveMaterial(now, then, packet, moved, turned);
        for (int lane = 0; lane < packet.size; ++lane)
        {
          displacement[packet.index[lane]] = laneOf(moved, lane);
          turn[packet.index[lane]] = laneOf(turned, lane);
        }
      });
}

MotionMap::Feature MotionMap::pushForward(const Vector3d& point, const Vector3d& normal) const
{
  const Vector3d turned = gradient(point).inverse().transpose() * normal;
  const double length = turned.norm();
  return {position(point), turned / length, 1.0 / length, velocity(point)};
}

void MotionMap::pushForward(std::vector<Vector3d>& points, std::vector<Vector3d>& normals) const
{
  if (resting_)
    return;
  const FieldTerms terms(frame_, field_);
  forPackets(
      points, 0, &Packet::rest, [this](const Vector3d& point) { return outside(point); },
      [&](Packet& packet)
      {
        Wide moved[3], normal[3];
        gather(normals, packet, normal);
        moveWall(terms, packet, moved, normal);
        for (int lane = 0; lane < packet.size; ++lane)
        {
          points[packet.index[lane]] = laneOf(moved, lane);
          normals[packet.index[lane]] = laneOf(normal, lane).normalized();
        }
      });
}

void MotionMap::carryTo(const MotionMap& other, const std::vector<Vector3d>& guesses, std::vector<Vector3d>& points,
                        std::vector<Vector3d>& normals) const
{
  const FieldTerms from(frame_, field_), to(frame_, other.field_);
  forPackets(
      points, 0, &Packet::target, [this](const Vector3d& point) { return outside(point); },
      [&](Packet& packet)
      {
        Wide moved[3], normal[3];
        gather(guesses, packet, packet.rest);
        gather(normals, packet, normal);
        carryWall(from, to, packet, moved, normal);
        for (int lane = 0; lane < packet.size; ++lane)
        {
          points[packet.index[lane]] = laneOf(moved, lane);
          normals[packet.index[lane]] = laneOf(normal, lane).normalized();
        }
      });
}

Eigen::Vector3d MotionMap::restingNormal(const Eigen::Vector3d& rest, const Eigen::Vector3d& normal) const
{
  return (gradient(rest).transpose() * normal).normalized();
}

}  // namespace endovascular_sim::motion
