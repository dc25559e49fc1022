#include "contact/wall_model.h"

#include <cstdlib>
#include <new>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "geometry/loop_subdivision.h"
#include "test/contact/contact_fixtures.h"

namespace
{

thread_local std::size_t allocated_bytes = 0;  // by operator new, in the calling thread

#ifndef ENDOVASCULAR_SANITIZED  // sanitizers have their own allocation functions
void* allocate(std::size_t size, std::size_t alignment)
{
  allocated_bytes += size;
  void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr)
    throw std::bad_alloc();
  return memory;
}
#endif

}  // namespace

#ifndef ENDOVASCULAR_SANITIZED
void* operator new(std::size_t size)
{
  return allocate(size == 0 ? 1 : size, alignof(std::max_align_t));
}

void* operator new(std::size_t size, std::align_val_t alignment)
{
  return allocate(size == 0 ? 1 : size, static_cast<std::size_t>(alignment));
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept
{
  std::free(memory);
}
#endif

namespace endovascular_sim::contact
{
namespace
{

std::vector<Query> randomWires(int count)
{
  std::mt19937 random(19);
  std::vector<Query> wires;
  for (int k = 0; k < count; ++k)
    wires.push_back(randomWire({0.0, 0.0, 0.002 * k}, random, 25));
  return wires;
}

/** A wire of 300 nodes along a tube's wall. */
Query longWire()
{
  std::mt19937 random(3);
  Query wire = randomWire({0.0, 0.0, 0.01}, random, 300);
  for (std::size_t i = 0; i < wire.nodes.size(); ++i)
    wire.nodes[i] = {3.4e-3, 0.0, 0.08e-3 * static_cast<double>(i)};
  return wire;
}

TEST(WallModel, GivesDetectorsThatShareItTheBitsOfDetectorsWithTheirOwn)
{
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 2);
  const std::shared_ptr<const WallModel> model = WallModel::create(mesh);
  Detector first(model, WallLaw{});
  Detector second(model, WallLaw{WallShape::kFacets, 1e6, 0.2, {}});
  Detector own_first(mesh, WallLaw{});
  Detector own_second(mesh, WallLaw{WallShape::kFacets, 1e6, 0.2, {}});
  ContactSet shared, own;
  std::size_t features = 0;
  std::vector<Query> wires = randomWires(15);
  wires.push_back(longWire());
  for (const Query& wire : wires)
  {
    first.detect(wire, shared);
    own_first.detect(wire, own);
    expectSameSets(shared, own);
    second.detect(wire, shared);
    own_second.detect(wire, own);
    expectSameSets(shared, own);
    features += shared.features.size();
  }
  EXPECT_GT(features, 100U);
  EXPECT_EQ(model.use_count(), 3);
}

TEST(WallModel, IsCopiedAtTheFirstMovementSoThatOtherDetectorsKeepTheirWall)
{
  geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 2);
  const std::shared_ptr<const WallModel> model = WallModel::create(mesh);
  Detector moving(model, WallLaw{});
  Detector resting(model, WallLaw{});
  Detector reference(mesh, WallLaw{});
  const std::vector<Query> wires = randomWires(15);
  ContactSet set, expected;
  for (const Query& wire : wires)
    moving.detect(wire, set);
  const WallModel* copy = nullptr;
  for (std::uint64_t version = 2; version < 5; ++version)
  {
    const Movement movement = pushOut(mesh, {0.0, 0.0, 0.005 * static_cast<double>(version)}, 6e-3, 0.2);
    apply(movement, mesh);
    moving.moveVertices(movement.indices, movement.positions, version);
    if (version > 2)
    {
      EXPECT_EQ(moving.model().get(), copy) << "only the first movement copies";
    }
    copy = moving.model().get();
    Detector moved_reference(mesh, WallLaw{}, version);
    for (const Query& wire : wires)
    {
      moving.detect(wire, set);
      moved_reference.detect(wire, expected);
      expectSameSets(set, expected);
      resting.detect(wire, set);
      reference.detect(wire, expected);
      expectSameSets(set, expected);
    }
  }
  EXPECT_NE(moving.model(), resting.model());
  expectSameWalls(resting.wall(), reference.wall());
}

TEST(WallModel, IsMovedInPlaceByItsOnlyOwner)
{
  geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 3);
  Detector detector(WallModel::create(mesh), WallLaw{});
  const WallModel* before = detector.model().get();
  const Movement movement = pushOut(mesh, {0.0, 0.0, 0.01}, 2e-3, 0.2);
  const std::size_t bytes = allocated_bytes;
  detector.moveVertices(movement.indices, movement.positions, 2);
  EXPECT_LT(allocated_bytes - bytes, 100000U);
  EXPECT_EQ(detector.model().get(), before);
}

TEST(WallModel, IsNotCopiedByAnEmptyMovement)
{
  const std::shared_ptr<const WallModel> model = WallModel::create(bentTube());
  Detector detector(model, WallLaw{});
  detector.moveVertices({}, {}, 7);
  EXPECT_EQ(detector.model(), model);
}

TEST(WallModel, LetsAFurtherDetectorCostLessThanTwoMegabytes)
{
#ifdef ENDOVASCULAR_SANITIZED
  GTEST_SKIP() << "allocations are not counted under a sanitizer";
#endif
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 4);
  ASSERT_GT(mesh.triangles.size(), 90000U);
  const std::size_t before_model = allocated_bytes;
  const std::shared_ptr<const WallModel> model = WallModel::create(mesh);
  EXPECT_GT(allocated_bytes - before_model, 20000000U) << "what every further detector would cost without sharing";
  const Query wire = longWire();
  ContactSet set;
  const std::size_t before = allocated_bytes;
  Detector detector(model, WallLaw{});
  detector.detect(wire, set);
  EXPECT_GT(set.features.size(), 100U);
  EXPECT_LT(allocated_bytes - before, 2000000U);
}

TEST(Detector, AllocatesNothingInSteadyState)
{
  Detector detector(geometry::midpointSubdivision(bentTube(), 2), WallLaw{});
  Query wire = longWire();
  ContactSet set;
  const auto rock = [&](int steps)
  {
    for (int step = 0; step < steps; ++step)
    {
      for (Eigen::Vector3d& node : wire.nodes)
        node.z() += step % 20 < 10 ? 0.1e-3 : -0.1e-3;
      detector.detect(wire, set);
    }
  };
  rock(60);
  const std::size_t before = allocated_bytes;
  rock(60);
  EXPECT_EQ(allocated_bytes, before);
}

}  // namespace
}  // namespace endovascular_sim::contact
