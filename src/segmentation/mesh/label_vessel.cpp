#include "segmentation/mesh/label_vessel.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/text/format.h"
#include "geometry/vertex_normals.h"
#include "segmentation/gentle_bends.h"
#include "segmentation/labels/field_surface.h"
#include "segmentation/labels/label_branches.h"
#include "segmentation/labels/mask_border.h"
#include "segmentation/labels/mask_field.h"
#include "segmentation/mesh/segmented_vessel.h"
#include "vessel/prepare/open_ends.h"
#include "vessel/prepare/prepare.h"
#include "vessel/repair/end_clipping.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr int kMargin = 2;               ///< empty layers around the mask [voxels]
constexpr double kTolerance = 1.0;       ///< of the mesh from the surface of the field, in voxels
constexpr double kResolution = 0.4;      ///< of the mesh, in voxels
constexpr int kFacetsAround = 32;        ///< the facets of 24 lose 1.1 % of the volume of a tube
constexpr double kBesideClick = 3.0;     ///< distance of an end from a click, in radii
constexpr double kLeastShare = 0.33;     ///< of the voxels of the labels in their largest piece
constexpr double kLargestScale = 0.1;    ///< change of the radius by which the volume is restored, relative
constexpr double kLargeIsland = 0.02;    ///< volume of an island that a warning names, relative to the vessel
constexpr std::size_t kLostVoxels = 30;  ///< of a branch that the smoothing removes

/** Label map on its way to a vessel. */
class Builder
{
public:
  Builder(const Scan& scan, const LabelSettings& settings, const std::string& source,
          const std::function<void(const std::string&)>& stage)
    : scan_(scan), settings_(settings), source_(source), stage_(stage)
  {
  }

  LabelVessel run()
  {
    repair();
    const geometry::TriangleMesh surface = smoothSurface();
    prepare(surface);
    nameBranches();
    openEnds();
    for (vessel::CentrelineBranch& branch : vessel_.centreline.branches)
      makeBendsGentle(branch);
    return std::move(vessel_);
  }

private:
  /** End of the centreline; its border, if it leads there. */
  struct End
  {
    vessel::CentrelineEnd end;
    const BorderEnd* border = nullptr;
  };

  void begin(const std::string& stage) const
  {
    if (stage_)
      stage_(stage);
  }

  void repair()
  {
    begin("repairing the mask");
    mask_ = VoxelMask(scan_.size(), scan_.spacing(), Eigen::Vector3d::Zero());
    const std::vector<std::int16_t>& labels = scan_.volume().stored;
    for (std::size_t n = 0; n < labels.size(); ++n)
      mask_.inside[n] = labels[n] > 0 ? 1 : 0;
    mask_ = padded(mask_, kMargin);
    std::vector<Eigen::Vector3d> wanted;
    for (const Eigen::Vector3d& click : settings_.clicks)
      wanted.push_back(scan_.toGrid(click));
    const auto all = static_cast<double>(mask_.voxels());
    vessel_.changes = repairMask(mask_, wanted);
    if (wanted.empty() && static_cast<double>(mask_.voxels()) < kLeastShare * all)
      throw InputError(
          source_, "--label",
          "marks " + std::to_string(vessel_.changes.islands.size() + 1) +
              " pieces, none of which holds a third of it: the vessel is too narrow for the voxels, or give the labels "
              "between them, or a click into the piece that is wanted");
    vessel_.mask_volume = static_cast<double>(mask_.voxels()) * mask_.voxelVolume();
    border_ = continueBeyondBorder(mask_, kMargin, vessel_.touches);
    warnOfChanges();
  }

  void warnOfChanges()
  {
    const auto place = [this](const Eigen::Vector3d& p) { return vessel::formatLocation(scan_.toPatient(p)); };
    for (const Island& island : vessel_.changes.islands)
      if (island.volume > kLargeIsland * vessel_.mask_volume)
        vessel_.warnings.push_back(
            formatted("a piece of %.2f ml", 1e6 * island.volume) + " near " + place(island.location) +
            formatted(", %.1f mm from the vessel", 1e3 * island.gap) +
            ", is left out; give the label between them, or a click into the piece that is wanted");
    for (const Eigen::Vector3d& cut : vessel_.changes.cut_loops)
      vessel_.warnings.push_back("two parts of the vessel touch, or form a loop, near " + place(cut) +
                                 ": it was cut there; correct the mask if the parts belong together");
  }

  /** Surface of the smooth mask, whose topology is repaired once more: smoothing may open or close narrow places. */
  geometry::TriangleMesh smoothSurface()
  {
    begin("smoothing the mask");
    std::vector<float> field = smoothField(mask_);
    VoxelMask smooth = mask_;
    for (std::size_t n = 0; n < field.size(); ++n)
      smooth.inside[n] = field[n] < 0.0F ? 1 : 0;
    if (smooth.voxels() == 0)
      throw UnusableSurface(InputError(source_, "--label", "marks a lumen that is narrower than two voxels"));
    const MaskChanges changes = repairMask(smooth, {});
    for (const Island& island : changes.islands)
      if (island.voxels >= kLostVoxels)
        vessel_.warnings.push_back("the vessel beyond " + vessel::formatLocation(scan_.toPatient(island.location)) +
                                   " hangs on a lumen of less than two voxels and is left out");
    imposeSigns(smooth, field);
    return fieldSurface(smooth, field);
  }

  void prepare(const geometry::TriangleMesh& surface)
  {
    vessel::PrepareOptions options;
    const double voxel = scan_.spacing().minCoeff();
    options.max_distance = settings_.max_distance > 0.0 ? settings_.max_distance : kTolerance * voxel;
    options.voxel = kResolution * voxel;
    options.smooth = true;
    options.full_report = false;
    options.facets_around = kFacetsAround;
    try
    {
      vessel::PreparedVessel made = vessel::prepareVessel(surface, source_, options, stage_);
      vessel_.mesh = std::move(made.mesh);
      vessel_.centreline = std::move(made.centreline);
      vessel_.report = std::move(made.report);
    }
    catch (const InputError& error)
    {
      throw UnusableSurface(error);
    }
    restoreVolume();
    vessel_.genus = vessel::checkMesh(vessel_.closed).genus;
    if (vessel_.genus != 0)
      vessel_.warnings.push_back("the surface has a handle (genus " + std::to_string(vessel_.genus) +
                                 "): two walls are nearer than a voxel");
  }

  /** Moves the wall until the mesh has the volume of the mask. Facets lose volume and smoothing adds some, both in
   * proportion to the radius of the lumen. */
  void restoreVolume()
  {
    constexpr int kRounds = 2;
    std::vector<double> radius;
    for (const Eigen::Vector3d& p : vessel_.mesh.vertices)
      radius.push_back(radiusNear(p));
    const double wanted = static_cast<double>(mask_.voxels()) * mask_.voxelVolume();
    for (int round = 0; round < kRounds; ++round)
    {
      double growth = 0.0;  // of the volume with the relative radius
      for (const Eigen::Vector3i& t : vessel_.mesh.triangles)
      {
        const auto at = [&](int k) -> const Eigen::Vector3d&
        { return vessel_.mesh.vertices[static_cast<std::size_t>(t[k])]; };
        const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
        for (int k = 0; k < 3; ++k)
          growth += area / 3.0 * radius[static_cast<std::size_t>(t[k])];
      }
      const double scale = std::clamp((wanted - vessel_.mesh.signedVolume()) / growth, -kLargestScale, kLargestScale);
      const std::vector<Eigen::Vector3d> normals = geometry::vertexNormals(vessel_.mesh);
      for (std::size_t v = 0; v < normals.size(); ++v)
        vessel_.mesh.vertices[v] += scale * radius[v] * normals[v];
    }
    vessel_.closed = vessel_.mesh;
  }

  /** Radius of the lumen at the nearest point of the centreline [m]. */
  double radiusNear(const Eigen::Vector3d& p) const
  {
    double least = 1e30;
    double radius = 0.0;
    for (const vessel::CentrelineBranch& branch : vessel_.centreline.branches)
      for (std::size_t k = 0; k < branch.points.size(); ++k)
        if (const double distance = (branch.points[k] - p).norm() - branch.radii[k]; distance < least)
        {
          least = distance;
          radius = branch.radii[k];
        }
    return radius;
  }

  /** Index of the label of a voxel, or of the nearest one of a label within three voxels; −1 if there is none. */
  int labelAt(const Eigen::Vector3d& p) const
  {
    constexpr int kFarthest = 3;
    const Eigen::Vector3i voxel = scan_.voxelOf(p);
    int label = -1;
    double least = 1e30;
    for (int k = -kFarthest; k <= kFarthest; ++k)
      for (int j = -kFarthest; j <= kFarthest; ++j)
        for (int i = -kFarthest; i <= kFarthest; ++i)
        {
          const Eigen::Vector3i near = voxel + Eigen::Vector3i(i, j, k);
          if ((near.array() < 0).any() || (near.array() >= scan_.size().array()).any())
            continue;
          const int value = scan_.volume().stored[scan_.volume().grid.offset(near.x(), near.y(), near.z())];
          const double distance = (scan_.centreOf(near) - scan_.centreOf(voxel)).squaredNorm();
          if (value > 0 && distance < least)
          {
            least = distance;
            label = value - 1;
          }
        }
    return label;
  }

  void nameBranches()
  {
    vessel_.centreline = namedByLabels(
        vessel_.centreline, [this](const Eigen::Vector3d& p) { return labelAt(p); }, settings_.names);
  }

  std::vector<End> endsOfTree() const
  {
    std::vector<End> ends;
    for (const vessel::CentrelineEnd& end : vessel::centrelineEnds(vessel_.centreline))
      ends.push_back({end, borderOf(end)});
    return ends;
  }

  /** Border to which an end leads: the tip lies in the continuation beyond it. */
  const BorderEnd* borderOf(const vessel::CentrelineEnd& end) const
  {
    const BorderEnd* nearest = nullptr;
    double least = 1e30;
    for (const BorderEnd& border : border_)
    {
      const Eigen::Vector3d from = end.position - border.point;
      const double beyond = from.dot(border.outward);
      const double aside = (from - beyond * border.outward).norm();
      if (beyond > 0.0 && from.norm() <= border.reach && aside < least)
      {
        least = aside;
        nearest = &border;
      }
    }
    return nearest;
  }

  /** Indices of the ends that become open. */
  std::set<std::size_t> wantedEnds(const std::vector<End>& ends) const
  {
    std::vector<vessel::CentrelineEnd> in_patient;  // in the frame of the selectors
    std::set<std::size_t> wanted;
    for (const End& end : ends)
    {
      if (end.border != nullptr)
        wanted.insert(in_patient.size());
      in_patient.push_back(end.end);
      in_patient.back().position = scan_.toPatient(end.border != nullptr ? end.border->point : end.end.position);
    }
    const auto matching = [&](const std::vector<std::string>& selectors, const char* option)
    { return vessel::matchingEnds(vessel_.centreline, in_patient, selectors, option, source_); };
    if (!settings_.open.empty())
    {
      const std::vector<std::size_t> open = matching(settings_.open, "--open");
      wanted = {open.begin(), open.end()};
    }
    addClicked(in_patient, wanted);
    if (wanted.empty() && settings_.closed.empty())
      for (std::size_t k = 0; k < ends.size(); ++k)
        wanted.insert(k);
    for (const std::size_t closed : matching(settings_.closed, "--closed"))
      wanted.erase(closed);
    return wanted;
  }

  /** Adds the ends beside clicks. Clicks within the course of a branch have none.
   *  @throws InputError if no click has an end beside it */
  void addClicked(const std::vector<vessel::CentrelineEnd>& ends, std::set<std::size_t>& wanted) const
  {
    bool any = settings_.clicks.empty();
    for (const Eigen::Vector3d& click : settings_.clicks)
      for (std::size_t k = 0; k < ends.size(); ++k)
        if ((ends[k].position - click).norm() <= kBesideClick * ends[k].radius)
        {
          wanted.insert(k);
          any = true;
        }
    if (any)
      return;
    std::string list;
    for (const vessel::CentrelineEnd& end : ends)
      list += (list.empty() ? "" : ", ") + vessel::formatLocation(end.position);
    throw InputError(
        source_, "--clicks",
        "no click lies near an end of the vessel (" + list + "); check frame and unit of the clicks, or give --open");
  }

  void openEnds()
  {
    begin("opening the ends");
    const std::vector<End> ends = endsOfTree();
    const std::set<std::size_t> wanted = wantedEnds(ends);
    for (const std::size_t k : wanted)
      open(ends[k]);
    for (const End& end : ends)
      if (end.border != nullptr)
        trim(end);
    const auto found = static_cast<std::size_t>(
        std::count_if(ends.begin(), ends.end(), [](const End& end) { return end.border != nullptr; }));
    if (found < border_.size())
      vessel_.warnings.push_back(std::to_string(border_.size() - found) +
                                 " place(s) where the mask meets the border of the image stay closed: no branch leads "
                                 "there");
  }

  /** Opens an end. One that cannot be cut stays closed, with a warning. */
  void open(const End& end)
  {
    const std::string& name = vessel_.centreline.branches[static_cast<std::size_t>(end.end.branch)].name;
    LabelOpening opening{name, end.end.position, end.end.radius, end.border != nullptr};
    try
    {
      if (end.border != nullptr)
      {
        opening.location = end.border->point;
        opening.radius = end.border->radius;
        vessel_.mesh =
            vessel::clipEnd(vessel_.mesh, {end.border->point, end.border->outward, end.border->reach}, source_);
      }
      else
      {
        const vessel::Opening cut =
            vessel::openEnd(vessel_.mesh, vessel_.centreline, end.end, settings_.cut_back, source_);
        opening.location = cut.location;
        opening.radius = cut.radius;
      }
      vessel_.openings.push_back(opening);
    }
    catch (const InputError&)
    {
      vessel_.warnings.push_back("an end of " + name + " near " +
                                 vessel::formatLocation(scan_.toPatient(end.end.position)) +
                                 " stays closed: a plane across it would cut other parts of the vessel");
    }
  }

  /** Ends a branch of the centreline at the border of the image. */
  void trim(const End& end)
  {
    vessel::CentrelineBranch& branch = vessel_.centreline.branches[static_cast<std::size_t>(end.end.branch)];
    const bool at_front = end.end.position == branch.points.front();
    if (at_front)
    {
      std::reverse(branch.points.begin(), branch.points.end());
      std::reverse(branch.radii.begin(), branch.radii.end());
    }
    const auto beyond = [&](std::size_t k) { return (branch.points[k] - end.border->point).dot(end.border->outward); };
    std::size_t n = branch.points.size();
    while (n > 2 && beyond(n - 2) >= 0.0)
      --n;
    branch.points.resize(n);
    branch.radii.resize(n);
    if (const double inner = beyond(n - 2); inner < 0.0 && beyond(n - 1) > 0.0)
    {
      const double t = inner / (inner - beyond(n - 1));
      branch.points[n - 1] = branch.points[n - 2] + t * (branch.points[n - 1] - branch.points[n - 2]);
      branch.radii[n - 1] = branch.radii[n - 2] + t * (branch.radii[n - 1] - branch.radii[n - 2]);
    }
    if (at_front)
    {
      std::reverse(branch.points.begin(), branch.points.end());
      std::reverse(branch.radii.begin(), branch.radii.end());
    }
  }

  const Scan& scan_;
  const LabelSettings& settings_;
  const std::string& source_;
  const std::function<void(const std::string&)>& stage_;
  VoxelMask mask_;
  std::vector<BorderEnd> border_;
  LabelVessel vessel_;
};

}  // namespace

LabelVessel labelVessel(const Scan& scan, const LabelSettings& settings, const std::string& source,
                        const std::function<void(const std::string& stage)>& stage)
{
  return Builder(scan, settings, source, stage).run();
}

}  // namespace endovascular_sim::segmentation
