#include "common/archive.h"
#include "intervention/treatment.h"

// What of a treatment and of the wall changes, to be saved and loaded.

namespace endovascular_sim::intervention
{

void archive(Archive& archive, RoundBody& body)
{
  archive(body.axis, body.radii);
}

void archive(Archive& archive, BalloonLoad& pressing)
{
  archive(pressing.balloon, pressing.pressure, pressing.sleeve);
}

static void archive(Archive& archive, TreatmentEvents& events)
{
  archive(events.above_rated, events.burst, events.stent_placed, events.over_expanded, events.stent_lost);
}

void BalloonInflation::archive(Archive& archive)
{
  archive(pressure_, peak_pressure_, burst_);
}

void StentPlacement::archive(Archive& archive)
{
  archive(state_, inner_diameter_, over_expanded_, sleeve_);
}

void Treatment::archive(Archive& archive)
{
  archive(inflation_, stripped_, events_, pressing_);
  if (stent_)
    archive(*stent_);
}

/** Saves or loads the vertices that differ from their initial state. */
void VesselOpening::archive(Archive& archive)
{
  std::vector<int> changed;
  for (std::size_t v = 0; v < walls_.size() && !archive.reading(); ++v)
    if (walls_[v].active || walls_[v].peak != 0.0 || walls_[v].base != first_[v] || mesh_.vertices[v] != first_[v])
      changed.push_back(static_cast<int>(v));
  for (std::size_t v = 0; v < walls_.size() && archive.reading(); ++v)
  {
    Wall initial;
    initial.base = mesh_.vertices[v] = first_[v];
    initial.healthy_radius = walls_[v].healthy_radius;
    walls_[v] = initial;
  }
  archive(changed, active_, next_.first, next_.second, empty_, farthest_, peak_pressure_, largest_stretch_);
  for (int v : changed)
  {
    Wall& wall = walls_.at(static_cast<std::size_t>(v));
    archive(mesh_.vertices[static_cast<std::size_t>(v)], wall.base, wall.peak, wall.rest, wall.held, wall.active);
  }
}

}  // namespace endovascular_sim::intervention
