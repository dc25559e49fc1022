// Comparison of the vessel projection with the ray tracer Embree.

#include <gtest/gtest.h>

// Debian 12 has Embree 3, Debian 13 Embree 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <vector>

#include "fluoroscopy/projection/vessel_projection.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Closed tube of varying radius along a trefoil knot, 120,000 triangles. */
geometry::TriangleMesh knot()
{
  constexpr int kRings = 1500, kColumns = 40;
  const auto centre = [](double t) -> Eigen::Vector3d
  {
    return 0.03 * Eigen::Vector3d(std::sin(t) + 2.0 * std::sin(2.0 * t), -0.5 * std::sin(3.0 * t),
                                  std::cos(t) - 2.0 * std::cos(2.0 * t));
  };
  geometry::TriangleMesh mesh;
  for (int i = 0; i < kRings; ++i)
  {
    const double t = 2.0 * M_PI * i / kRings;
    const Eigen::Vector3d along = (centre(t + 1e-4) - centre(t - 1e-4)).normalized();
    const Eigen::Vector3d side = along.cross(Eigen::Vector3d(0.1, 1.0, 0.2)).normalized(), up = along.cross(side);
    const double radius = 1e-2 * (1.0 + 0.4 * std::sin(7.0 * t));
    for (int j = 0; j < kColumns; ++j)
    {
      const double phi = 2.0 * M_PI * j / kColumns;
      mesh.vertices.emplace_back(centre(t) + radius * (std::cos(phi) * side + std::sin(phi) * up));
    }
  }
  const auto at = [](int i, int j) { return (i % kRings) * kColumns + j % kColumns; };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kColumns; ++j)
    {
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
    }
  if (mesh.signedVolume() < 0.0)
    for (Eigen::Vector3i& triangle : mesh.triangles)
      std::swap(triangle[1], triangle[2]);
  return mesh;
}

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;

void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray)
{
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  rtcInitRayQueryContext(&context);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;

void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray)
{
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
#endif

struct Sum
{
  QueryContext context;
  double length = 0.0;
};

/** Adds the signed distance of a hit and rejects it, so that the ray continues. */
void addHit(const RTCFilterFunctionNArguments* arguments)
{
  auto* sum = reinterpret_cast<Sum*>(arguments->context);
  const float* normal_x = &RTCHitN_Ng_x(arguments->hit, arguments->N, 0);
  const double cosine = static_cast<double>(*normal_x) * RTCRayN_dir_x(arguments->ray, arguments->N, 0) +
                        static_cast<double>(RTCHitN_Ng_y(arguments->hit, arguments->N, 0)) *
                            RTCRayN_dir_y(arguments->ray, arguments->N, 0) +
                        static_cast<double>(RTCHitN_Ng_z(arguments->hit, arguments->N, 0)) *
                            RTCRayN_dir_z(arguments->ray, arguments->N, 0);
  const double distance = RTCRayN_tfar(arguments->ray, arguments->N, 0);
  sum->length += cosine > 0.0 ? distance : -distance;
  arguments->valid[0] = 0;
}

class Tracer
{
public:
  explicit Tracer(const geometry::TriangleMesh& mesh) : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_))
  {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      for (int k = 0; k < 3; ++k)
        *vertices++ = static_cast<float>(vertex[k]);
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        *indices++ = static_cast<unsigned>(triangle[k]);
    rtcSetGeometryIntersectFilterFunction(geometry, addHit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Tracer()
  {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  double pathLength(const Eigen::Vector3d& source, const Eigen::Vector3d& direction) const
  {
    Sum sum;
    RTCRayHit ray{};
    const Eigen::Vector3f s = source.cast<float>(), d = direction.normalized().cast<float>();
    ray.ray = {s.x(), s.y(), s.z(), 0.0F, d.x(), d.y(), d.z(), 0.0F, 2.0F, 0xffffffffU, 0, 0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene_, sum.context, ray);
    return sum.length;
  }

private:
  RTCDevice device_;
  RTCScene scene_;
};

TEST(VesselProjectionEmbree, EqualsAMultiHitRayTracerInFourPoses)
{
  // Single-precision coordinates, in both.
  geometry::TriangleMesh mesh = knot();
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = vertex.cast<float>().cast<double>();
  const Tracer tracer(mesh);
  const double kPoses[][2] = {{0.0, 0.0}, {0.7, 0.0}, {-0.52, -0.35}, {0.79, 0.44}};
  for (const auto& angles : kPoses)
  {
    CArmPose pose;
    pose.primary_angle = angles[0];
    pose.secondary_angle = angles[1];
    const XRayGeometry geometry(pose);
    const std::vector<double> length = vesselPathLength(geometry, mesh);
    double squares = 0.0, total = 0.0;
    int off = 0;
    for (int row = 0; row < pose.pixels; ++row)
      for (int column = 0; column < pose.pixels; ++column)
      {
        const double seen = length[static_cast<std::size_t>(row * pose.pixels + column)];
        const double exact = tracer.pathLength(geometry.source(), geometry.axes() * geometry.ray(column, row));
        if (std::abs(seen - exact) > 1e-4)
        {
          ++off;
          continue;
        }
        squares += (seen - exact) * (seen - exact);
        total += exact * exact;
      }
    EXPECT_LE(off, 5) << angles[0];
    EXPECT_LE(std::sqrt(squares / total), 1e-5) << angles[0];
  }
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
