#include "fluoroscopy/projection/coaxial_stack.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const MaterialLibrary& library()
{
  static const MaterialLibrary kLibrary = MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
  return kLibrary;
}

const DeviceResponse& response()
{
  static const DeviceResponse kResponse(Beam({}), library());
  return kResponse;
}

const DeviceDensity kAround{100.0, 1000.0}, kLumen{10.0, 900.0};

/** Straight centreline of 40 edges of 1 mm along z. */
std::vector<Eigen::Vector3d> centreline()
{
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i <= 40; ++i)
    nodes.emplace_back(0.0, 0.0, 1e-3 * i);
  return nodes;
}

instrument::Instrument tube(const std::vector<double>& lengths, const std::vector<double>& radii,
                            const std::vector<instrument::Material>& materials)
{
  instrument::Instrument result;
  result.name = "tube";
  result.wire.sections.resize(lengths.size());
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    result.wire.sections[k].length = lengths[k];
    result.wire.sections[k].radius = radii[k];
  }
  result.materials = materials;
  return result;
}

XRayWire stackOf(const std::vector<instrument::Instrument>& instruments, const std::vector<double>& behind)
{
  std::vector<XRayInstrument> seen;
  for (const instrument::Instrument& each : instruments)
    seen.emplace_back(each, response());
  return coaxialStack(centreline(), seen, behind, {{kAround, kLumen}});
}

/** Profile at a height, whose last node is at 40 mm. */
const WireProfile& at(const XRayWire& wire, double z)
{
  std::size_t j = 0;
  while (wire.nodes[j + 1].z() < z)
    ++j;
  return wire.profiles[wire.edge_profile[j]];
}

TEST(CoaxialStack, ChangesSectionsAtTheirExactDistanceFromTheTip)
{
  using M = instrument::Material;
  const XRayWire wire =
      stackOf({tube({1.0, 0.0103, 0.02}, {3e-3, 2e-3, 1e-3}, {M::kSteel, M::kNitinol, M::kPlatinum})}, {0.0});
  EXPECT_NO_THROW(checkWire(wire));
  ASSERT_EQ(at(wire, 0.0201).size(), 1U);
  EXPECT_EQ(at(wire, 0.0201)[0], (WireLayer{1e-3, response().solid("platinum") - kAround}));
  EXPECT_EQ(at(wire, 0.0199)[0], (WireLayer{2e-3, response().solid("nitinol") - kAround}));
  EXPECT_EQ(at(wire, 0.0098)[0], (WireLayer{2e-3, response().solid("nitinol") - kAround}));
  EXPECT_EQ(at(wire, 0.0096)[0], (WireLayer{3e-3, response().solid("steel") - kAround}));
}

TEST(CoaxialStack, FillsTheLumenAndDisplacesItsFluidByAWire)
{
  using M = instrument::Material;
  instrument::Instrument guide = tube({1.0}, {1e-3}, {M::kFilledPolymer});
  guide.inner_radius = 0.9e-3;
  const XRayWire wire = stackOf({guide, tube({1.0}, {0.18e-3}, {M::kSteel})}, {0.01, 0.0});
  const DeviceDensity polymer = response().solid("filled_polymer"), steel = response().solid("steel");
  const WireProfile inside = {{1e-3, polymer - kAround}, {0.9e-3, kLumen - polymer}, {0.18e-3, steel - kLumen}};
  EXPECT_EQ(at(wire, 0.02), inside);
  EXPECT_EQ(at(wire, 0.0299), inside);
  EXPECT_EQ(at(wire, 0.0301), (WireProfile{{0.18e-3, steel - kAround}}));
}

TEST(CoaxialStack, ShowsMarkersAsBandsAroundTheLumen)
{
  using M = instrument::Material;
  instrument::Instrument catheter = tube({1.0}, {0.5e-3}, {M::kPolymer});
  catheter.inner_radius = 0.3e-3;
  catheter.markers.resize(1);
  catheter.markers[0].from_tip = 5.25e-3;
  catheter.markers[0].length = 1e-3;
  catheter.markers[0].material = M::kPlatinum;
  const XRayWire wire = stackOf({catheter}, {0.0});
  const DeviceDensity platinum = response().solid("platinum"), polymer = response().solid("polymer");
  EXPECT_EQ(at(wire, 0.0342), (WireProfile{{0.5e-3, platinum - kAround}, {0.3e-3, kLumen - platinum}}));
  for (const double z : {0.0337, 0.0348})
    EXPECT_EQ(at(wire, z), (WireProfile{{0.5e-3, polymer - kAround}, {0.3e-3, kLumen - polymer}}));
}

TEST(CoaxialStack, IsEmptyForAWithdrawnInstrumentAndAShortCentreline)
{
  using M = instrument::Material;
  const XRayWire wire = stackOf({tube({1.0}, {1e-3}, {M::kSteel})}, {0.05});
  for (const WireProfile& profile : wire.profiles)
    EXPECT_TRUE(profile.empty());
  EXPECT_TRUE(coaxialStack({}, {}, {}, {{kAround, kLumen}}).nodes.empty());
}

TEST(CoaxialStack, UsesTheLocalFluidOfEachEdge)
{
  using M = instrument::Material;
  std::vector<LocalFluids> fluids(40, {kAround, kLumen});
  fluids[7].around = {500.0, 1000.0};
  const std::vector<XRayInstrument> instruments = {XRayInstrument(tube({1.0}, {1e-3}, {M::kSteel}), response())};
  const XRayWire wire = coaxialStack(centreline(), instruments, {0.0}, fluids);
  EXPECT_EQ(at(wire, 7.5e-3)[0].density, response().solid("steel") - fluids[7].around);
  EXPECT_EQ(at(wire, 8.5e-3)[0].density, response().solid("steel") - kAround);
}

TEST(CoaxialStack, FillsTheLumenOfEachInstrumentWithItsOwnFluid)
{
  using M = instrument::Material;
  instrument::Instrument guide = tube({1.0}, {2e-3}, {M::kPolymer}), catheter = tube({1.0}, {1e-3}, {M::kPolymer});
  guide.inner_radius = 1.5e-3;
  catheter.inner_radius = 0.6e-3;
  const std::vector<XRayInstrument> instruments = {XRayInstrument(tube({1.0}, {0.2e-3}, {M::kSteel}), response()),
                                                   XRayInstrument(catheter, response()),
                                                   XRayInstrument(guide, response())};
  const std::vector<DeviceDensity> lumens = {{0.0, 0.0}, {700.0, 1000.0}, {20.0, 1000.0}};
  const XRayWire wire = coaxialStack(centreline(), instruments, {0.0, 10e-3, 20e-3}, {{kAround, kLumen}}, lumens);
  const DeviceDensity polymer = response().solid("polymer");
  const WireProfile& all = at(wire, 10.5e-3);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].density, response().solid("steel") - lumens[1]) << "wire in the catheter";
  EXPECT_EQ(all[1].density, polymer - lumens[2]) << "catheter in the guiding catheter";
  EXPECT_EQ(all[2].density, lumens[1] - polymer);
  EXPECT_EQ(all[3].density, polymer - kAround);
  EXPECT_EQ(all[4].density, lumens[2] - polymer);
  EXPECT_EQ(at(wire, 25.5e-3)[1].density, polymer - kAround) << "catheter beyond the guiding catheter";
  EXPECT_EQ(at(wire, 35.5e-3)[0].density, response().solid("steel") - kAround) << "wire beyond both";
}

TEST(CoaxialStack, RejectsListsOfInconsistentLength)
{
  const std::vector<XRayInstrument> none;
  EXPECT_THROW(coaxialStack(centreline(), none, {0.0}, {{kAround, kLumen}}), InputError);
  EXPECT_THROW(coaxialStack(centreline(), none, {}, {}), InputError);
  EXPECT_THROW(coaxialStack(centreline(), none, {}, std::vector<LocalFluids>(3)), InputError);
  EXPECT_THROW(coaxialStack(centreline(), none, {}, {{kAround, kLumen}}, {kLumen}), InputError);
}

TEST(XRayInstrument, RequiresAMaterialForEverySection)
{
  EXPECT_THROW(XRayInstrument(tube({1.0, 1.0}, {1e-3, 1e-3}, {instrument::Material::kSteel}), response()), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
