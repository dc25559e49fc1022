#include "phantom/diseased_vessel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/error.h"
#include "common/numerics/parallel_for.h"
#include "common/text/format.h"

namespace endovascular_sim::phantom
{
namespace
{

// Hounsfield units.
constexpr double kLumen = 400.0;
constexpr double kWall = 60.0;
constexpr double kFat = -90.0;
constexpr double kBone = 1100.0;
constexpr double kMetal = 2500.0;
constexpr double kFalseLumen = 230.0;
constexpr double kWallThickness = 6e-4;  // m
constexpr int kPoints = 100;             ///< of a voxel whose mean is its value

double offAxis(const Eigen::Vector3d& p)
{
  return std::hypot(p.x(), p.y());
}

/** Step from 0 to 1 between two places, without a kink. */
double smoothStep(double from, double to, double x)
{
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/** Lumen, wall and fat. */
double layered(double to_wall)
{
  return to_wall < 0.0 ? kLumen : to_wall < kWallThickness ? kWall : kFat;
}

class Aneurysm : public DiseasedVessel
{
public:
  explicit Aneurysm(double diameter) : widest_(0.5 * diameter) {}

  double toWall(const Eigen::Vector3d& p) const override
  {
    const double bump = std::exp(-0.5 * p.z() * p.z() / (kLength * kLength));
    const double slope = (widest_ - kRadius) * bump * p.z() / (kLength * kLength);
    const double x = p.x() - kShift * (widest_ - kRadius) * bump;
    return (std::hypot(x, p.y()) - kRadius - (widest_ - kRadius) * bump) / std::hypot(1.0, slope);
  }
  double valueAt(const Eigen::Vector3d& p) const override { return layered(toWall(p)); }
  std::vector<Eigen::Vector3d> clicks() const override { return {{2e-3, 1e-3, -0.06}, {-1e-3, 2e-3, 0.06}}; }
  Eigen::Vector3d halfExtent() const override
  {
    const double across = 1.3 * widest_ + 0.006;
    return {across, across, 0.07};
  }
  PhantomSettings usualImage() const override
  {
    PhantomSettings settings = DiseasedVessel::usualImage();
    settings.grid = gridOfBox(-halfExtent(), halfExtent(), Eigen::Vector3d::Constant(9e-4));
    return settings;
  }

private:
  static constexpr double kRadius = 0.0125;  // m
  static constexpr double kLength = 0.014;   ///< standard deviation along the axis [m]
  static constexpr double kShift = 0.3;      ///< of the centre, in excesses of the radius
  double widest_;
};

class Stenosis : public DiseasedVessel
{
public:
  explicit Stenosis(double degree) : degree_(degree) {}

  double toWall(const Eigen::Vector3d& p) const override
  {
    const double t = std::clamp(p.z() / kHalfLength, -1.0, 1.0);
    const double radius = kRadius * (1.0 - 0.5 * degree_ * (1.0 + std::cos(M_PI * t)));
    const double slope = kRadius * 0.5 * degree_ * M_PI / kHalfLength * std::sin(M_PI * t);
    return (offAxis(p) - radius) / std::hypot(1.0, slope);
  }
  double valueAt(const Eigen::Vector3d& p) const override
  {
    // The plaque fills the former lumen, so the wall lies where it was.
    const double to_lumen = toWall(p);
    return to_lumen < 0.0 ? kLumen : offAxis(p) < kRadius + kWallThickness ? kWall : kFat;
  }
  std::vector<Eigen::Vector3d> clicks() const override { return {{4e-4, 2e-4, -0.018}, {-2e-4, 4e-4, 0.018}}; }
  Eigen::Vector3d halfExtent() const override { return {0.008, 0.008, 0.022}; }

private:
  static constexpr double kRadius = 1.5e-3;    // m
  static constexpr double kHalfLength = 5e-3;  ///< of the lesion [m]
  double degree_;
};

class DimLumen : public DiseasedVessel
{
public:
  explicit DimLumen(double darkest) : darkest_(darkest) {}

  double toWall(const Eigen::Vector3d& p) const override { return offAxis(p) - kRadius; }
  double valueAt(const Eigen::Vector3d& p) const override
  {
    constexpr double kBrightest = 1000.0;
    constexpr double kSurrounding = 120.0;
    if (toWall(p) >= 0.0)
      return kSurrounding;
    return kBrightest * (1.0 - (1.0 - darkest_) * (p.x() + kRadius) / (2.0 * kRadius));
  }
  std::vector<Eigen::Vector3d> clicks() const override { return {{2e-3, 1e-3, -0.045}, {-1e-3, 2e-3, 0.045}}; }
  Eigen::Vector3d halfExtent() const override { return {0.024, 0.024, 0.055}; }
  PhantomSettings usualImage() const override
  {
    PhantomSettings settings;
    settings.modality = image::Modality::kOther;
    settings.noise = 20.0;
    settings.point_spread = 6e-4;
    settings.grid = gridOfBox(-halfExtent(), halfExtent(), {8.8e-4, 8.8e-4, 1.5e-3});
    return settings;
  }

private:
  static constexpr double kRadius = 0.0105;  // m
  double darkest_;
};

class BesideBone : public DiseasedVessel
{
public:
  explicit BesideBone(double gap) : gap_(gap) {}

  double toWall(const Eigen::Vector3d& p) const override { return offAxis(p) - kRadius; }
  double valueAt(const Eigen::Vector3d& p) const override
  {
    const bool is_bone = p.x() > kRadius + kWallThickness + gap_ && std::abs(p.z()) < 0.01;
    return is_bone ? kBone : layered(toWall(p));
  }
  std::vector<Eigen::Vector3d> clicks() const override { return {{5e-4, 3e-4, -0.018}, {-3e-4, 5e-4, 0.018}}; }
  Eigen::Vector3d halfExtent() const override { return {0.009, 0.009, 0.022}; }

private:
  static constexpr double kRadius = 2e-3;  // m
  double gap_;
};

class Dissection : public DiseasedVessel
{
public:
  /** @param bulge radius of the flap [m]; 0: flat */
  Dissection(double flap, double bulge) : flap_(flap), bulge_(bulge) {}

  double toWall(const Eigen::Vector3d& p) const override
  {
    const double slope = (flapAt(p.z() + 1e-5) - flapAt(p.z() - 1e-5)) / 2e-5;
    return std::max(offAxis(p) - kRadius, beforeFlap(p) / std::hypot(1.0, slope));
  }
  double valueAt(const Eigen::Vector3d& p) const override
  {
    if (toWall(p) < 0.0)
      return kLumen;
    const double r = offAxis(p);
    if (r < kRadius)
      return beforeFlap(p) > kFlap ? kFalseLumen : kWall;
    const bool is_strut = p.z() < kGraftEnd && r < kRadius + kStrut &&
                          std::abs(std::remainder(p.z() - kGraftEnd, kStrutSpacing) + 2e-3) < 0.5 * kStrut;
    return is_strut ? kMetal : r < kRadius + kAorticWall ? kWall : kFat;
  }
  std::vector<Eigen::Vector3d> clicks() const override
  {
    return {{3e-3, 2e-3, -0.045}, {0.5 * (kRadius + flap_ * kRadius), 2e-3, 0.045}};
  }
  Eigen::Vector3d halfExtent() const override { return {0.022, 0.022, 0.055}; }
  PhantomSettings usualImage() const override
  {
    PhantomSettings settings = DiseasedVessel::usualImage();
    settings.grid = gridOfBox(-halfExtent(), halfExtent(), Eigen::Vector3d::Constant(7e-4));
    return settings;
  }

private:
  /** Place of the flap's surface towards the true lumen; −R: it lies on the wall. */
  double flapAt(double z) const
  {
    return kRadius * (-1.0 + (1.0 + flap_) * smoothStep(kGraftEnd, kGraftEnd + 0.03, z));
  }

  /** Distance from the flap's surface towards the true lumen, positive in the false one [m]. */
  double beforeFlap(const Eigen::Vector3d& p) const
  {
    const double flap = flapAt(p.z());
    return bulge_ > 0.0 ? bulge_ - std::hypot(p.x() - flap + bulge_, p.y()) : flap - p.x();
  }

  static constexpr double kRadius = 0.014;       // m
  static constexpr double kAorticWall = 1.5e-3;  // m
  static constexpr double kFlap = 1.2e-3;        ///< thickness [m]
  static constexpr double kGraftEnd = -0.02;     // m
  static constexpr double kStrut = 5e-4;         ///< diameter of the wires [m]
  static constexpr double kStrutSpacing = 8e-3;  // m
  double flap_;
  double bulge_;
};

class FlatDissection : public Dissection
{
public:
  explicit FlatDissection(double flap) : Dissection(flap, 0.0) {}
};

class Crescent : public Dissection
{
public:
  explicit Crescent(double flap) : Dissection(flap, 0.01) {}
};

/** Kind of a disease. */
struct DiseaseKind
{
  double usual, least, most;
  std::unique_ptr<DiseasedVessel> (*make)(double degree);
};

template <typename Vessel>
std::unique_ptr<DiseasedVessel> make(double degree)
{
  return std::make_unique<Vessel>(degree);
}

constexpr std::array<DiseaseKind, 6> kKinds = {{{0.06, 0.025, 0.08, make<Aneurysm>},
                                                {0.8, 0.0, 0.95, make<Stenosis>},
                                                {0.35, 0.1, 1.0, make<DimLumen>},
                                                {2e-4, 0.0, 5e-3, make<BesideBone>},
                                                {-0.1, -0.9, 0.6, make<FlatDissection>},
                                                {0.5, -0.9, 0.8, make<Crescent>}}};

}  // namespace

PhantomSettings DiseasedVessel::usualImage() const
{
  PhantomSettings settings;
  settings.grid = gridOfBox(-halfExtent(), halfExtent(), Eigen::Vector3d::Constant(4.5e-4));
  return settings;
}

const std::vector<std::string>& diseaseNames()
{
  static const std::vector<std::string> kNames = {"aneurysm", "stenosis",   "dim_lumen",
                                                  "bone",     "dissection", "crescent"};
  return kNames;
}

std::unique_ptr<DiseasedVessel> diseasedVessel(const std::string& name, double degree)
{
  const auto found = std::find(diseaseNames().begin(), diseaseNames().end(), name);
  if (found == diseaseNames().end())
    throw InputError("disease", name, "is unknown; choose aneurysm, stenosis, dim_lumen, bone, dissection or crescent");
  const DiseaseKind& kind = kKinds[static_cast<std::size_t>(found - diseaseNames().begin())];
  const double wanted = std::isnan(degree) ? kind.usual : degree;
  if (!(wanted >= kind.least && wanted <= kind.most))
    throw InputError("disease", name,
                     "its degree must be between " + shortNumber(kind.least) + " and " + shortNumber(kind.most));
  return kind.make(wanted);
}

namespace
{

/** Values of the voxels of a vessel. */
class VoxelMeans
{
public:
  VoxelMeans(const DiseasedVessel& vessel, const image::VolumeGrid& grid) : vessel_(vessel), grid_(grid) {}

  /** Mean over a voxel; its value, if that is the same everywhere. */
  float at(int i, int j, int k) const
  {
    const Eigen::Vector3d centre(i, j, k);
    const double value = valueAt(centre);
    bool is_uniform = true;
    for (int n = 0; n < 27 && is_uniform; ++n)
      is_uniform = valueAt(centre + 0.5 * Eigen::Vector3d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)) == value;
    if (is_uniform)
      return static_cast<float>(value);
    double sum = 0.0;
    for (int n = 1; n <= kPoints; ++n)
      sum += valueAt(centre + pointOf(n));
    return static_cast<float>(sum / kPoints);
  }

private:
  /** Quasirandom point of a voxel: multiples of the powers of the root of x⁴ = x + 1 (M. Roberts, "The unreasonable
   *  effectiveness of quasirandom sequences", 2018). Planes along the grid get the right share, too. */
  static Eigen::Vector3d pointOf(int n)
  {
    constexpr double kRoot = 1.2207440846057596;
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = n / std::pow(kRoot, axis + 1);
    return p - p.array().floor().matrix() - Eigen::Vector3d::Constant(0.5);
  }
  double valueAt(const Eigen::Vector3d& index) const { return vessel_.valueAt(grid_.position(index)); }

  const DiseasedVessel& vessel_;
  const image::VolumeGrid& grid_;
};

}  // namespace

image::Volume imageOf(const DiseasedVessel& vessel, const PhantomSettings& settings, const ProgressReport& progress)
{
  const VoxelMeans means(vessel, settings.grid);
  const auto paint = [&](int first, std::vector<std::vector<float>>& slices, int threads)
  {
    parallelFor(slices.size(), threads,
                [&](std::size_t s)
                {
                  slices[s].clear();
                  for (int j = 0; j < settings.grid.size.y(); ++j)
                    for (int i = 0; i < settings.grid.size.x(); ++i)
                      slices[s].push_back(means.at(i, j, first + static_cast<int>(s)));
                });
  };
  return blurredImage(paint, settings, progress);
}

}  // namespace endovascular_sim::phantom
