#include "vessel/prepare/prepare.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "vessel/centreline/centreline_extraction.h"
#include "vessel/prepare/deviations.h"
#include "vessel/prepare/level_set.h"
#include "vessel/prepare/open_ends.h"
#include "vessel/repair/fairing.h"
#include "vessel/repair/mesh_target.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Largest number of voxels on the wall; bounds the memory of the grid. */
constexpr double kMaxWallVoxels = 4e7;
/** Volume of a crumb relative to the vessel; loose components below it are dropped. */
constexpr double kCrumb = 1e-4;
constexpr int kBridgingRounds = 5;
/** Default voxel relative to the distance tolerance. The grid rounds right-angled edges by half a voxel. */
constexpr double kVoxelShare = 2.0 / 3.0;
/** Depth below the outer surface of an inner wall, in voxels. */
constexpr double kHollowDepth = 1.5;
/** Fraction of the distance tolerance for the deviation of facets; smoothing uses the rest. */
constexpr double kFacetShare = 0.5;
/** Largest displacement by smoothing, relative to the lumen's radius; preserves narrow lumens. */
constexpr double kRadiusShare = 0.1;
constexpr int kRefinements = 4;
constexpr int kRefinementRounds = 2;

void requireValid(const PrepareOptions& options, const std::string& source)
{
  const auto positive = [&](double value, const char* option, bool zero_allowed)
  {
    if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !zero_allowed))
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
    throw InputError(source, "--bridge",
                     "excludes --hollow: bridges join components of a solid vessel; remove one of the two");
  if (options.facets_around < 8 || options.facets_around > 200)
    throw InputError(source, "--facets-around", "must be between 8 and 200");
  if (options.smoothing_rounds < 0 || options.smoothing_rounds > 10000)
    throw InputError(source, "--smoothing-rounds", "must be between 0 and 10000");
}

/** Pipeline of the mesh preparation. */
class Preparation
{
public:
  Preparation(const geometry::TriangleMesh& input, const std::string& source, const PrepareOptions& options,
              const Progress& progress)
    : input_(input), source_(source), options_(options), progress_(progress)
  {
    requireValid(options, source);
    voxel_ = options.voxel > 0.0 ? options.voxel : kVoxelShare * options.max_distance;
  }

  PreparedVessel run()
  {
    check();
    unitePieces();
    remeshWall();
    smooth();
    if (options_.centreline)
    {
      findCentreline();
      openEnds();
    }
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
      throw InputError(source_, "", "has no triangles, or vertices that are not finite; export the mesh again");
    if (report().before.area > kMaxWallVoxels * voxel_ * voxel_)
      throw InputError(source_, "--voxel", "is too small for a wall of this area; increase it, or check --unit");
    ClosedMesh closed = closeHoles(input_);
    report().holes = std::move(closed.holes);
    soup_ = std::move(closed.mesh);
    const geometry::MeshDistance walls(input_);
    for (const Plug& plug : options_.plugs)
      discs_.push_back(fitDisc(plug, walls, 0.5 * voxel_, source_));
    own_triangles_ = input_.triangles.size();
    appendDiscs();
    if (options_.hollow)
      extractInnerWall();
  }

  /** Computes the union of the components. Bridges to loose components are added as long as new ones are found. */
  void unitePieces()
  {
    for (int round = 0; round < kBridgingRounds; ++round)
    {
      begin(round == 0 ? "computing the union" : "computing the union with bridges");
      UnitedSurface united = unite(soup_, voxel_);
      report().separated_sheets = std::move(united.separated);
      std::vector<geometry::TriangleMesh> pieces = splitComponents(united.mesh);
      united_ = std::move(pieces.front());
      if (united_.signedVolume() < min_volume_)
        refuseHollow();
      pieces.erase(pieces.begin());
      if (!addBridges(pieces))
        return;
    }
  }

  [[noreturn]] void refuseHollow() const
  {
    throw InputError(source_, "--hollow", "finds no cavity inside the wall; close every opening with a --plug");
  }

  void appendDiscs()
  {
    for (const Disc& disc : discs_)
      append(soup_, disc.mesh);
  }

  /** Reduces the soup to the inner wall and the discs of its openings. */
  void extractInnerWall()
  {
    begin("extracting the inner wall");
    const geometry::TriangleMesh outside = unite(soup_, voxel_).mesh;
    geometry::TriangleMesh walls = innerWall(soup_, outside, kHollowDepth * voxel_, discs_);
    if (walls.triangles.empty())
      refuseHollow();
    own_triangles_ = walls.triangles.size();
    min_volume_ = kCrumb * outside.signedVolume();
    soup_ = std::move(walls);
    appendDiscs();
  }

  /** Classifies loose components as crumbs, cavities, bridged or dropped.
   *  @return true if a bridge was added to the soup */
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
      if (piece_volume < 0.0)  // a cavity inside the vessel
        continue;
      const Gap gap = findGap(piece, united_);
      if (gap.radius > 0.0 && gap.width <= options_.bridge)
      {
        append(soup_, bridgeMesh(gap));
        report().bridges.push_back(gap);
        added = true;
      }
      else
        report().dropped.push_back({piece_volume, gap.from, gap.width});
    }
    return added;
  }

  void remeshWall()
  {
    begin("computing the target edge lengths");
    SizingRule rule;
    rule.facets_around = options_.facets_around;
    rule.deviation = 0.5 * kFacetShare * options_.max_distance;
    rule.shortest = std::min(0.75 * voxel_, options_.longest_facet);
    rule.longest = options_.longest_facet;
    MeshTarget wall(united_, rule);
    begin("remeshing");
    result_.mesh = remesh(united_, wall);
    for (int round = 0; round < kRefinements; ++round)
    {
      begin("refining facets beyond the tolerance");
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
    measureResultToInput(input, result_.mesh, report());
    if (!options_.full_report)
      return;
    measureInputToResult(input, result_.mesh, report());
    if (!options_.hollow)  // gaps outside of a thick wall are irrelevant
      report().gaps = measureGaps(input, result_.mesh);
  }

  void findCentreline()
  {
    begin("extracting the centreline");
    result_.centreline = extractCentreline(result_.mesh);
    if (!options_.full_report)
      return;
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
    const std::vector<CentrelineEnd> ends = selectEnds(result_.centreline, options_.open, source_);
    if (!ends.empty())
      begin("opening ends");
    for (const CentrelineEnd& end : ends)
      report().openings.push_back(openEnd(result_.mesh, result_.centreline, end, options_.cut_back, source_));
    const std::vector<ClosedHole> rims = closeHoles(result_.mesh).holes;
    report().rims = static_cast<int>(rims.size());
    if (rims.size() != ends.size() || !std::all_of(rims.begin(), rims.end(), isFlatEnd))
      throw InputError(source_, "--open", "an end has no planar rim; specify another --cut-back, or omit the end");
  }

  const geometry::TriangleMesh& input_;
  std::string source_;
  PrepareOptions options_;
  Progress progress_;
  double voxel_ = 0.0;
  std::vector<Disc> discs_;        ///< discs of the plugged openings
  std::size_t own_triangles_ = 0;  ///< number of triangles of the input in soup_
  double min_volume_ = 0.0;        ///< smallest volume of a vessel [m³]
  geometry::TriangleMesh soup_;    ///< input, lids, discs, bridges
  geometry::TriangleMesh united_;  ///< outer wall at the resolution of the grid
  std::vector<double> limits_;     ///< largest displacement by smoothing, per vertex [m]
  PreparedVessel result_;
};

}  // namespace

PreparedVessel prepareVessel(const geometry::TriangleMesh& input, const std::string& source,
                             const PrepareOptions& options, const Progress& progress)
{
  return Preparation(input, source, options, progress).run();
}

}  // namespace endovascular_sim::vessel
