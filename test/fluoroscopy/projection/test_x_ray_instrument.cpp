#include "fluoroscopy/projection/x_ray_instrument.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kEnergy = 60.0;     // [keV]
constexpr double kDisplaced = 20.0;  // [1/m]

MaterialLibrary table()
{
  return MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
}

/** Straight centreline of 40 edges of 1 mm along z. */
std::vector<Eigen::Vector3d> centreline()
{
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i <= 40; ++i)
    nodes.emplace_back(0.0, 0.0, 1e-3 * i);
  return nodes;
}

instrument::Instrument wire()
{
  instrument::Instrument instrument;
  instrument.wire.sections.resize(3);
  const double lengths[] = {1.0, 0.01, 0.02};
  for (int k = 0; k < 3; ++k)
  {
    instrument.wire.sections[k].length = lengths[k];
    instrument.wire.sections[k].radius = 1e-3 * (3 - k);
  }
  instrument.materials = {instrument::Material::kSteel, instrument::Material::kNitinol,
                          instrument::Material::kPlatinum};
  return instrument;
}

TEST(XRayInstrument, AssignsMaterialAndRadiusByDistanceFromTheTip)
{
  const instrument::Instrument instrument = wire();
  std::vector<XRayWire> wires;
  XRayInstrument(instrument, table(), kEnergy, kDisplaced).append(centreline(), 0.0, wires);
  ASSERT_EQ(wires.size(), 1U);
  const XRayWire& seen = wires.front();
  ASSERT_EQ(seen.attenuation.size(), 40U);
  for (std::size_t j = 0; j < 40; ++j)
  {
    const char* material = j >= 20 ? "platinum" : j >= 10 ? "nitinol" : "steel";
    EXPECT_EQ(seen.attenuation[j], table().linear(material, kEnergy) - kDisplaced) << j;
    EXPECT_EQ(seen.radius[j], j >= 20 ? 1e-3 : j >= 10 ? 2e-3 : 3e-3) << j;
  }
}

TEST(XRayInstrument, EndsAtItsTipBehindTheLastNode)
{
  const instrument::Instrument instrument = wire();
  std::vector<XRayWire> wires;
  const XRayInstrument seen(instrument, table(), kEnergy, kDisplaced);
  seen.append(centreline(), 5.5e-3, wires);
  ASSERT_EQ(wires.size(), 1U);
  EXPECT_NEAR(wires[0].nodes.back().z(), 34.5e-3, 1e-12);
  seen.append(centreline(), 50e-3, wires);
  EXPECT_EQ(wires.size(), 1U) << "the instrument is outside of the patient";
}

TEST(XRayInstrument, SubtractsTheLumenAndAddsMarkers)
{
  instrument::Instrument instrument = wire();
  instrument.kind = instrument::Kind::kCatheter;
  instrument.inner_radius = 0.5e-3;
  instrument.markers = {{3e-3, 2e-3, instrument::Material::kPlatinum}};
  std::vector<XRayWire> wires;
  XRayInstrument(instrument, table(), kEnergy, kDisplaced).append(centreline(), 0.0, wires);
  ASSERT_EQ(wires.size(), 4U);
  EXPECT_EQ(wires[1].radius[7], 0.5e-3);
  EXPECT_EQ(wires[1].attenuation[7], -wires[0].attenuation[7]);
  double low = 1.0;
  double high = 0.0;
  for (const Eigen::Vector3d& node : wires[2].nodes)
  {
    low = std::min(low, node.z());
    high = std::max(high, node.z());
  }
  EXPECT_NEAR(high, 37e-3, 1e-12);
  EXPECT_NEAR(low, 35e-3, 1e-12);
  EXPECT_EQ(wires[3].attenuation[0], -wires[2].attenuation[0]);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
