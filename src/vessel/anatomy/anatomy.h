#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** A narrowing of a branch: a cosine-shaped reduction of the diameter. */
struct Stenosis
{
  double position = 0.0;   ///< of its throat, as a fraction of the branch's length
  double length = 0.0;     ///< over which the diameter is reduced [m]
  double reduction = 0.0;  ///< of the diameter at the throat, 0 to below 1
};

/** One named branch of an anatomy. */
struct AnatomyBranch
{
  std::string name;
  int parent = -1;         ///< index of the branch it leaves or continues, −1 at the root
  bool continues = false;  ///< goes on at the parent's end without a junction (common iliac to external iliac)
  std::vector<Eigen::Vector3d> points;               ///< control points of the centreline, patient frame [m]
  std::vector<std::pair<double, double>> diameters;  ///< fraction of the branch's length, diameter [m]
  std::vector<Stenosis> stenoses;
};

/** A spherical widening: a sinus of the aortic root, an aneurysm. */
struct Bulge
{
  std::string name;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< patient frame [m]
  double radius = 0.0;                               ///< [m]
};

/** A vessel tree described by centrelines and diameters: what config/anatomies holds. */
struct Anatomy
{
  std::string name;
  std::string file;
  double blend = 1.0;                   ///< range of the rounding at a junction, in radii of the smaller branch
  int facets_around = 20;               ///< of the mesh, around every lumen
  double longest_facet = 2e-3;          ///< [m]
  std::vector<AnatomyBranch> branches;  ///< parents before their children
  std::vector<Bulge> bulges;
  std::uint64_t content_hash = 0;  ///< of the file's bytes
};

/** Reads and checks an anatomy file. Lengths are in metres, or in the file's `unit` [m].
 *  @throws InputError naming file, key and remedy */
Anatomy readAnatomy(const std::string& file);

/** A run of branches that continue each other, sampled along its smooth centreline. */
struct AnatomyChain
{
  std::vector<int> branches;              ///< indices into Anatomy::branches, in order
  std::vector<std::size_t> first_sample;  ///< per branch, where it begins
  int parent = -1;                        ///< branch that the chain leaves, −1 at the root
  std::vector<Eigen::Vector3d> points;    ///< [m]
  std::vector<Eigen::Vector3d> tangents;  ///< unit
  std::vector<double> arc;                ///< arc length from the chain's start [m]
  std::vector<double> radii;              ///< with the stenoses [m]
};

/** The chains of an anatomy. The first point of a chain that leaves another is moved onto the parent's centreline.
 *  @throws InputError when a branch begins outside of its parent, or bends more tightly than it is wide */
std::vector<AnatomyChain> sampleChains(const Anatomy& anatomy);

/** The exact centreline tree, with the anatomy's names. */
CentrelineTree anatomyCentreline(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains);

}  // namespace endovascular_sim::vessel
