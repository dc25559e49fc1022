#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::rod
{

/** Rodrigues' coefficients of a rotation vector [rad]: sin φ/φ and (1 − cos φ)/φ². */
struct Rodrigues
{
  double s, c;

  explicit Rodrigues(const Eigen::Vector3d& w)
  {
    const double x = w.squaredNorm();
    if (x < 0.04)
    {
      s = 1.0 + x * (-1.0 / 6.0 + x * (1.0 / 120.0 + x * (-1.0 / 5040.0 + x * (1.0 / 362880.0))));
      c = 0.5 + x * (-1.0 / 24.0 + x * (1.0 / 720.0 + x * (-1.0 / 40320.0 + x * (1.0 / 3628800.0))));
      return;
    }
    const double angle = std::sqrt(x);
    s = std::sin(angle) / angle;
    c = (1.0 - std::cos(angle)) / x;
  }
};

/** Rotation of v by a rotation vector [rad]. */
inline Eigen::Vector3d turned(const Eigen::Vector3d& v, const Eigen::Vector3d& w)
{
  const Rodrigues r(w);
  const Eigen::Vector3d across = w.cross(v);
  return v + r.s * across + r.c * w.cross(across);
}

/** Rotation matrix of a rotation vector [rad]. */
inline Eigen::Matrix3d rotationOf(const Eigen::Vector3d& w)
{
  const Rodrigues r(w);
  const Eigen::Vector3d a = r.s * w;
  const Eigen::Vector3d b = r.c * w;
  const double xy = b.x() * w.y();
  const double xz = b.x() * w.z();
  const double yz = b.y() * w.z();
  const Eigen::Vector3d square = b.cwiseProduct(w);
  Eigen::Matrix3d m;
  m << 1.0 - square.y() - square.z(), xy - a.z(), xz + a.y(),  //
      xy + a.z(), 1.0 - square.x() - square.z(), yz - a.x(),   //
      xz - a.y(), yz + a.x(), 1.0 - square.x() - square.y();
  return m;
}

/** Properties and loads of one edge of a Kirchhoff rod. Vectors are in the frame (d1, d2, chord). */
struct EdgeLoad
{
  double length = 0.0;                                       ///< arc length h [m]
  double flexibility = 0.0;                                  ///< 1/EI [1/(N·m²)]
  double twist_flexibility = 0.0;                            ///< 1/GJ [1/(N·m²)]
  Eigen::Vector3d rest_curvature = Eigen::Vector3d::Zero();  ///< κ̄ in the material frame [1/m]
  double tension = 0.0;                                      ///< force along the chord [N]
  Eigen::Vector3d load = Eigen::Vector3d::Zero();            ///< force per length [N/m]
  std::array<Eigen::Vector3d, 2> moment{Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero()};  ///< bending moment and torque at the ends [N·m]
};

/** Rotations from the chord of an edge to the material frames at its ends, to fourth order in its length.
 *
 *  In the material frame R, R′ = R[κ]× with κ = (m₁/EI, m₂/EI, m₃/GJ) + κ̄, and κ̄ is constant. The moment in the middle
 *  is known up to terms of the order h³: m = mean of the ends + F×bow + h²/8 q×t, with F×chord the difference of the
 *  ends. For κ a parabola through both ends and the middle (k₀ in the middle, k₁ the difference of the ends), the
 * Magnus expansion about the middle gives the frames at the ends,
 *
 *    Q exp(±[∫κ/2 + h² k₀×k₁/96] + h k₁/8),   ∫κ by Simpson's rule,
 *
 *  and the chord is along e₃ + h/24 k₁×e₃ + h²/24 (k₀·e₃) k₀ in the middle's frame Q. Terms that are even in h change
 *  little from edge to edge and cancel at the node between them, so that those of the order h⁴ are omitted. */
struct RodEdgeFrames
{
  std::array<Eigen::Matrix3d, 2> turn;  ///< material frame at the ends, as columns along (d1, d2, chord)
  Eigen::Vector3d curvature;            ///< κ in the middle, in the frame (d1, d2, chord) [1/m]
  double bending_energy;                ///< ½∫(m₁² + m₂²)/EI by Simpson's rule [J]
  double twist_energy;                  ///< ½∫m₃²/GJ [J]

  explicit RodEdgeFrames(const EdgeLoad& edge)
  {
    using Eigen::Matrix3d;
    using Eigen::Vector3d;
    const double h = edge.length;
    const Vector3d flexibility(edge.flexibility, edge.flexibility, edge.twist_flexibility);
    const auto bend = [&](const Vector3d& moment)
    { return Vector3d(flexibility.cwiseProduct(moment) + edge.rest_curvature); };
    const Vector3d across = edge.moment[1] - edge.moment[0];
    const Vector3d force(-across.y() / h, across.x() / h, edge.tension);
    Vector3d middle = 0.5 * (edge.moment[0] + edge.moment[1]);
    Vector3d k0 = bend(middle);
    const Vector3d bow(-k0.y(), k0.x(), 0.0);  // offset of the arc's middle from the chord, in units of h²/8
    middle += (0.125 * h * h) * (force.cross(bow) + Vector3d(edge.load.y(), -edge.load.x(), 0.0));
    k0 = bend(middle);
    Vector3d k1 = flexibility.cwiseProduct(across - h * k0.cross(middle));
    const double lean = h * k0.z();
    const Matrix3d chord = rotationOf((h / 24.0) * Vector3d(lean * k0.y() - k1.x(), -lean * k0.x() - k1.y(), 0.0));
    const Vector3d m0 = chord.transpose() * edge.moment[0];
    const Vector3d m1 = chord.transpose() * edge.moment[1];
    middle = chord.transpose() * middle;
    k0 = bend(middle);
    k1 = flexibility.cwiseProduct(m1 - m0 - h * k0.cross(middle));
    Vector3d even = (0.125 * h) * k1;
    const Vector3d start = turned(m0, 0.5 * h * k0 - even);
    const Vector3d stop = turned(m1, -0.5 * h * k0 - even);
    const Vector3d first = bend(start);
    const Vector3d second = bend(stop);
    const Vector3d energy =
        (h / 12.0) * flexibility.cwiseProduct(start.cwiseAbs2() + 4.0 * middle.cwiseAbs2() + stop.cwiseAbs2());
    bending_energy = energy.x() + energy.y();
    twist_energy = energy.z();
    k1 = second - first;
    even = (0.125 * h) * k1;
    const Vector3d odd = (h / 12.0) * (first + 4.0 * k0 + second) + (h * h / 96.0) * k0.cross(k1);
    turn = {chord * rotationOf(even - odd), chord * rotationOf(even + odd)};
    curvature = chord * k0;
  }
};

}  // namespace endovascular_sim::rod
