#include "vessel/prepare/prepare.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "vessel/centreline/centreline_extraction.h"
#include "vessel/prepare/deviations.h"
#include "vessel/prepare/level_set.h"
#include "vessel/prepare/open_ends.h"
#include "vessel/repair/fairing.h"
#include "vessel/repair/mesh_sizing.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Grids beyond this many voxels of wall do not fit into memory. */
constexpr double kMostWallVoxels = 4e7;
/** A loose piece below this fraction of the vessel's volume is a crumb. */
constexpr double kCrumb = 1e-4;
constexpr int kBridgingRounds = 5;
/** Of the stated distance: the grid cuts right-angled edges by half a voxel. */
constexpr double kVoxelShare = 2.0 / 3.0;
/** A wall is told from the outside when it lies this many voxels inside. */
constexpr double kHollowDepth = 1.5;
/** Facets may leave the fine surface by this share of the stated distance; smoothing has the rest. */
constexpr double kFacetShare = 0.5;
/** Smoothing moves no vertex by more than this fraction of the lumen's radius, so that narrow lumens stay. */
constexpr double kRadiusShare = 0.1;
constexpr int kRefinements = 4;
constexpr int kRefinementRounds = 2;

void requireSane(const PrepareOptions& options, const std::string& source)
{
  const auto positive = [&](double value, const char* option, bool zero_too)
  {
    if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !zero_too))
      throw InputError(source, option, "must be a positive length in metres, e.g. 0.0002");
  };
  positive(options.max_distance, "--max-distance", false);
  positive(options.voxel, "--voxel", true);
  positive(options.bridge, "--bridge", true);
  positive(options.longest_facet, "--longest-facet", false);
  positive(options.cut_back, "--cut-back", false);
  for (const Plug& plug : options.plugs)
    positive(plug.radius, "--plug", false);
  if (options.hollow && options.bridge > 0.0)
    throw InputError(source, "--bridge", "joins pieces of a vessel, not hollows; leave it or --hollow out");
  if (options.facets_around < 8 || options.facets_around > 200)
    throw InputError(source, "--facets-around", "must be between 8 and 200");
  if (options.smoothing_rounds < 0 || options.smoothing_rounds > 10000)
    throw InputError(source, "--smoothing-rounds", "must be between 0 and 10000");
}

class Preparation
{
public:
  Preparation(const geometry::TriangleMesh& input, const std::string& source, const PrepareOptions& options,
              const Progress& progress)
    : input_(input), source_(source), options_(options), progress_(progress)
  {
    requireSane(options, source);
    voxel_ = options.voxel > 0.0 ? options.voxel : kVoxelShare * options.max_distance;
  }

  PreparedVessel run()
  {
    check();
    unitePieces();
    makeFacets();
    smooth();
    findCentreline();
    openEnds();
    report().after = numbersOf(result_.mesh);
    return std::move(result_);
  }

private:
  PrepareReport& report() { return result_.report; }

  void begin(const std::string& stage) const
  {
    if (progress_)
      progress_(stage);
  }

  void check()
  {
    begin("checking the input");
    report().source = source_;
    report().voxel = voxel_;
    report().max_distance = options_.max_distance;
    report().hollow = options_.hollow;
    report().before = numbersOf(input_);
    if (input_.triangles.empty() || report().before.defects.invalid_faces.count > 0)
      throw InputError(source_, "", "has no triangles, or vertices that are not finite; export it again");
    if (report().before.area > kMostWallVoxels * voxel_ * voxel_)
      throw InputError(source_, "--voxel", "is too small for a wall of this area; give a larger one, or check --unit");
    ClosedMesh closed = closeHoles(input_);
    report().holes = std::move(closed.holes);
    soup_ = std::move(closed.mesh);
    const geometry::MeshDistance walls(input_);
    for (const Plug& plug : options_.plugs)
      discs_.push_back(discOver(plug, walls, 0.5 * voxel_, source_));
    own_triangles_ = input_.triangles.size();
    appendDiscs();
    if (options_.hollow)
      takeHollow();
  }

  /** Unites, and joins loose pieces by bridges while that brings new ones into reach. */
  void unitePieces()
  {
    for (int round = 0; round < kBridgingRounds; ++round)
    {
      begin(round == 0 ? "uniting the pieces" : "uniting the pieces and bridges");
      UnitedSurface united = unite(soup_, voxel_);
      report().parted = std::move(united.cleared);
      std::vector<geometry::TriangleMesh> pieces = separatePieces(united.mesh);
      united_ = std::move(pieces.front());
      if (united_.signedVolume() < least_volume_)
        throw InputError(source_, "--hollow", "finds no hollow inside of the wall; stop every opening up by a --plug");
      pieces.erase(pieces.begin());
      if (!addBridges(pieces))
        return;
    }
  }

  void appendDiscs()
  {
    for (const Disc& disc : discs_)
      append(soup_, disc.mesh);
  }

  /** Leaves the walls of the hollow only in the soup, and the discs that stop it up. */
  void takeHollow()
  {
    begin("telling the hollow's walls from the outside");
    const geometry::TriangleMesh outside = unite(soup_, voxel_).mesh;
    geometry::TriangleMesh walls = hollowWalls(soup_, outside, kHollowDepth * voxel_, discs_);
    own_triangles_ = walls.triangles.size();
    least_volume_ = kCrumb * outside.signedVolume();
    soup_ = std::move(walls);
    appendDiscs();
  }

  /** Sorts the loose pieces. @return whether a bridge was added to the soup */
  bool addBridges(const std::vector<geometry::TriangleMesh>& loose)
  {
    const double volume = united_.signedVolume();
    report().dropped.clear();
    report().crumbs = 0;
    report().crumb_volume = 0.0;
    bool added = false;
    for (const geometry::TriangleMesh& piece : loose)
    {
      const double piece_volume = piece.signedVolume();
      if (std::abs(piece_volume) < kCrumb * volume)
      {
        ++report().crumbs;
        report().crumb_volume += piece_volume;
        continue;
      }
      if (piece_volume < 0.0)  // a hollow inside of the vessel
        continue;
      const Gap gap = findGap(piece, united_);
      if (gap.radius > 0.0 && gap.width <= options_.bridge)
      {
        append(soup_, bridgeOver(gap));
        report().bridges.push_back(gap);
        added = true;
      }
      else
        report().dropped.push_back({piece_volume, gap.from, gap.width});
    }
    return added;
  }

  void makeFacets()
  {
    begin("measuring the lumen");
    SizingRule rule;
    rule.facets_around = options_.facets_around;
    rule.deviation = 0.5 * kFacetShare * options_.max_distance;
    rule.shortest = std::min(0.75 * voxel_, options_.longest_facet);
    rule.longest = options_.longest_facet;
    MeshSizing wall(united_, rule);
    begin("making even facets");
    result_.mesh = remesh(united_, wall);
    for (int round = 0; round < kRefinements; ++round)
    {
      begin("refining where the facets leave the wall");
      if (wall.refine(geometry::MeshDistance(result_.mesh), kFacetShare * options_.max_distance) == 0)
        break;
      result_.mesh = remesh(result_.mesh, wall, kRefinementRounds);
    }
    if (!options_.smooth)
      return;
    for (const Eigen::Vector3d& v : result_.mesh.vertices)
      limits_.push_back(std::min((1.0 - kFacetShare) * options_.max_distance, kRadiusShare * wall.radiusAt(v)));
  }

  void smooth()
  {
    if (options_.smooth)
    {
      begin("smoothing");
      const std::vector<Eigen::Vector3d> start = result_.mesh.vertices;
      fair(result_.mesh, limits_, options_.smoothing_rounds);
      for (std::size_t v = 0; v < start.size(); ++v)
        report().largest_move = std::max(report().largest_move, (result_.mesh.vertices[v] - start[v]).norm());
    }
    requireClean(checkMesh(result_.mesh), source_);
    begin("measuring the distances");
    const InputSurfaces input{soup_, own_triangles_, united_, voxel_};
    measureDeviations(input, result_.mesh, report());
    if (!options_.hollow)  // of a wall with a thickness, narrow spaces outside are of no interest
      report().gaps = measureGaps(input, result_.mesh);
  }

  void findCentreline()
  {
    begin("finding the centreline");
    result_.centreline = extractCentreline(result_.mesh);
    const geometry::MeshDistance before(united_);
    const geometry::MeshDistance after(result_.mesh);
    for (std::size_t b = 0; b < result_.centreline.branches.size(); ++b)
    {
      const CentrelineBranch& branch = result_.centreline.branches[b];
      double arc = 0.0;
      for (std::size_t k = 0; k < branch.points.size(); ++k)
      {
        if (k > 0)
          arc += (branch.points[k] - branch.points[k - 1]).norm();
        report().radii.push_back({static_cast<int>(b), arc, before.closest(branch.points[k]).distance,
                                  after.closest(branch.points[k]).distance});
      }
    }
  }

  void openEnds()
  {
    const std::vector<CentrelineEnd> ends = chooseEnds(result_.centreline, options_.open, source_);
    if (!ends.empty())
      begin("opening ends");
    for (const CentrelineEnd& end : ends)
      report().openings.push_back(openEnd(result_.mesh, result_.centreline, end, options_.cut_back, source_));
    const std::vector<ClosedHole> rims = closeHoles(result_.mesh).holes;
    report().rims = static_cast<int>(rims.size());
    if (rims.size() != ends.size() || !std::all_of(rims.begin(), rims.end(), isFlatEnd))
      throw InputError(source_, "--open", "an end could not be cut flat; give another --cut-back, or leave it out");
  }

  const geometry::TriangleMesh& input_;
  std::string source_;
  PrepareOptions options_;
  Progress progress_;
  double voxel_ = 0.0;
  std::vector<Disc> discs_;  ///< that stop openings up
  std::size_t own_triangles_ = 0;
  double least_volume_ = 0.0;      ///< [m³]
  geometry::TriangleMesh soup_;    ///< the input, lids, bridges
  geometry::TriangleMesh united_;  ///< the outer wall, fine
  std::vector<double> limits_;
  PreparedVessel result_;
};

}  // namespace

PreparedVessel prepareVessel(const geometry::TriangleMesh& input, const std::string& source,
                             const PrepareOptions& options, const Progress& progress)
{
  return Preparation(input, source, options, progress).run();
}

}  // namespace endovascular_sim::vessel
