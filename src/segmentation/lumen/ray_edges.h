#pragma once

#include <array>
#include <vector>

#include "segmentation/lumen/edge_model.h"
#include "segmentation/lumen/edge_settings.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Edges along the rays of the sections of one path. */
struct RayTable
{
  std::vector<std::array<double, kRays>> radii;  ///< distance of the edge [m]; −1: none
  std::vector<std::array<RayEnd, kRays>> ends;
};

/** Finds the edges of the lumen on profiles of the image along the rays.
 *
 *  The edge of a ray is the first point that is as dark as EdgeModel predicts, or, before calcium, half-way to it. In a
 *  lumen wider than the blur, the value of the lumen is that of the profile just before the edge, and an edge counts
 *  only where the profile falls half-way to the background. Without Hounsfield units, the background is the median of
 *  the dark values around the section. A profile that rises to calcium behind a soft gap belongs to bone: the edge
 *  has the value of EdgeModel and the share of the bone at its distance (EdgeModel::beyondGap()). The majority of the
 * neighbours in angle and along the path decides between plaque and bone. */
class RayEdges
{
public:
  /** @param sections of one path; reach and blur are set
   *  @param step distance of two sections [m]
   *  @param pitch of the samples of a profile [m] */
  RayEdges(const Scan& scan, const std::vector<Section>& sections, double step, double pitch,
           const EdgeSettings& settings);

  /** Finds value of the lumen and edges.
   *  @param radius of the lumen at every section [m] */
  void find(const std::vector<double>& radius);

  /** Contrast in the middle of a section, as a share of that of the lumen. */
  double shareInMiddle(std::size_t section) const;

  /** Limits the radius of throats: where the middle does not reach the value of the lumen, a disc of the limited radius
   *  has the value of the middle. */
  void limitToThroats(std::vector<double>& radius) const;

  const RayTable& edges() const { return edges_; }

  /** Value of the lumen: running median of the values in the middle, where the lumen is wide enough to reach its full
   *  value there. */
  const std::vector<double>& lumen() const { return lumen_; }

private:
  /** Place at which a profile leaves the lumen. */
  struct Crossing
  {
    double radius = -1.0;  ///< [m]; −1: none
    int sample = 0;
    bool rises = false;  ///< to calcium
  };

  std::size_t indexOf(std::size_t section, int ray, int sample) const
  {
    return offsets_[section] + static_cast<std::size_t>(ray * samples_[section] + sample);
  }
  float profile(std::size_t section, int ray, int sample) const { return profiles_[indexOf(section, ray, sample)]; }
  void readProfiles();
  void smoothProfiles();
  /** Profiles of wide lumens. Images without Hounsfield units have little contrast where the signal falls. */
  const std::vector<float>& wideProfiles() const { return settings_.wall > 0.0 ? profiles_ : smoothed_; }
  EdgeModel modelOf(const Section& section) const;
  double middleOf(std::size_t section) const;
  void findLumen(const std::vector<double>& radius);
  void findBackground(const std::vector<double>& radius);
  double meanOf(const std::vector<float>& profiles, std::size_t section, int ray, double from, double to) const;
  double darkestBehind(std::size_t section, int ray, double radius, double spread) const;
  double lumenBefore(std::size_t section, int ray, double radius, double spread) const;
  double threshold(std::size_t section, int ray, double radius, const EdgeModel& model) const;
  Crossing crossingOfEvenLumen(std::size_t section, int ray, double radius, const EdgeModel& model) const;
  Crossing crossingOfWideLumen(std::size_t section, int ray, double radius, const EdgeModel& model) const;
  Crossing crossingAt(const std::vector<float>& profiles, std::size_t section, int ray, int sample, double level,
                      bool rises) const;
  double lastCrossing(const std::vector<float>& profiles, std::size_t section, int ray, int first, double level) const;
  double calciumLevel(std::size_t section) const;
  double beforeBone(std::size_t section, int ray, double radius, const Crossing& crossing,
                    const EdgeModel& model) const;
  bool isWide(std::size_t section, double radius) const;
  void findEdges(std::size_t section, double radius);
  void separateBoneFromPlaque();

  const Scan& scan_;
  const std::vector<Section>& sections_;
  double step_;
  double pitch_;
  const EdgeSettings& settings_;
  std::vector<int> samples_;          ///< of a profile, per section
  std::vector<std::size_t> offsets_;  ///< of the profiles of a section
  std::vector<float> profiles_;
  std::vector<float> smoothed_;  ///< means over neighbours in angle and along the path
  std::vector<double> lumen_;
  std::vector<double> background_;  ///< around a section
  RayTable edges_;
  std::vector<std::array<double, kRays>> before_bone_;  ///< edge of a ray, if it ends at bone [m]; −1: no gap
};

}  // namespace endovascular_sim::segmentation
