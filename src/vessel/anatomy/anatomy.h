#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Smallest radius of curvature of a centreline, in radii of the lumen. */
constexpr double kTightestBend = 1.15;

/** Stenosis of a branch with a cosine-shaped reduction of the diameter. */
struct Stenosis
{
  double position = 0.0;   ///< position of the throat as a fraction of the branch's length
  double length = 0.0;     ///< length of the stenosis [m]
  double reduction = 0.0;  ///< relative reduction of the diameter at the throat, in [0, 1)
};

/** Named branch of an anatomy. */
struct AnatomyBranch
{
  std::string name;
  int parent = -1;         ///< index of the parent branch, −1 at the root
  bool continues = false;  ///< continues the parent at its end without a junction (common iliac to external iliac)
  std::vector<Eigen::Vector3d> points;               ///< control points of the centreline, patient frame [m]
  std::vector<std::pair<double, double>> diameters;  ///< fraction of the branch's length, diameter [m]
  std::vector<Stenosis> stenoses;
  int facets_around = 0;  ///< facets of the mesh around the lumen; 0: those of the anatomy
};

/** Spherical bulge: a sinus of the aortic root, an aneurysm. */
struct Bulge
{
  std::string name;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< patient frame [m]
  double radius = 0.0;                               ///< [m]
  double blend = 1.0;                                ///< blending range with the lumen, in radii of the bulge
};

/** Way of contrast medium whose time is counted in frames (TIMI frame count, Gibson et al. 1996): from the origin of a
 *  branch to a place on the same or a later one. */
struct Landmark
{
  std::string name;
  int origin = 0;         ///< index of the branch at whose origin the first frame is
  int branch = 0;         ///< index of the branch of the last frame
  double position = 0.0;  ///< place on it as a fraction of its length outside of its parent
};

/** Parametric vessel tree of centrelines and diameters; the content of a file in config/anatomies. */
struct Anatomy
{
  std::string name;
  std::string file;
  double blend = 1.0;                   ///< blending range at a junction, in radii of the smaller branch
  int facets_around = 20;               ///< facets of the mesh around every lumen
  double longest_facet = 2e-3;          ///< longest edge of the mesh [m]
  std::vector<AnatomyBranch> branches;  ///< parents before their children
  std::vector<Bulge> bulges;
  std::vector<Landmark> landmarks;
  std::uint64_t content_hash = 0;     ///< hash of the file's bytes
  std::vector<std::string> warnings;  ///< unusual values, each with file, key and likely unit
};

/** Reads and validates an anatomy file. Lengths are in metres, or in the file's `unit` [m].
 *  @throws InputError naming file, key and remedy */
Anatomy readAnatomy(const std::string& file);

/** Sequence of branches that continue each other, sampled along their common spline centreline. */
struct AnatomyChain
{
  std::vector<int> branches;              ///< indices into Anatomy::branches, in order
  std::vector<std::size_t> first_sample;  ///< index of the first sample of each branch
  int parent = -1;                        ///< parent branch of the chain, −1 at the root
  int facets_around = 0;                  ///< facets of the mesh around the lumen; 0: those of the anatomy
  std::vector<Eigen::Vector3d> points;    ///< [m]
  std::vector<Eigen::Vector3d> tangents;  ///< unit
  std::vector<double> arc;                ///< arc length from the chain's start [m]
  std::vector<double> radii;              ///< radius including stenoses [m]
};

/** Samples the chains of an anatomy. The first point of a child chain is moved onto its parent's centreline.
 *  @throws InputError if a branch begins outside of its parent, or its radius of curvature is smaller than its radius
 *           */
std::vector<AnatomyChain> sampleChains(const Anatomy& anatomy);

/** Centreline tree of the sampled chains, one branch per branch of the anatomy. */
CentrelineTree anatomyCentreline(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains);

}  // namespace endovascular_sim::vessel
