#include "common/archive.h"
#include "common/archive_checks.h"
#include "intervention/treatment.h"
#include "intervention/vessel_dilatation.h"

// Serialization of the state of treatments and of the deformable wall.

namespace endovascular_sim::intervention
{

void archive(Archive& archive, RoundBody& body)
{
  archive(body.axis, body.radii);
  if (!archive.reading())
    return;
  requireLength(body.axis.size(), body.radii);
  requireLoaded(body.axis.size() != 1, "holds a body whose axis is one point");
  requireFinite(body.axis, body.radii);
}

void archive(Archive& archive, BalloonLoad& load)
{
  archive(load.balloon, load.pressure, load.sleeve);
  if (archive.reading())
    requireFinite(load.pressure);
}

void archive(Archive& archive, WallDisplacement& displacement)
{
  archive(displacement.indices, displacement.positions);
}

void requireFit(const WallDisplacement& displacement, std::size_t vertices)
{
  requireLength(displacement.indices.size(), displacement.positions);
  for (const int index : displacement.indices)
    requireIndex(index, 0, static_cast<int>(vertices));
  requireFinite(displacement.positions);
}

static void archive(Archive& archive, TreatmentEvents& events)
{
  archive(events.above_rated, events.burst, events.stent_placed, events.over_expanded, events.stent_lost);
}

void BalloonInflation::archive(Archive& archive)
{
  archive(pressure_, peak_pressure_, burst_);
  if (archive.reading())
    requireFinite(pressure_, peak_pressure_);
}

void StentPlacement::archive(Archive& archive)
{
  archive(state_, inner_diameter_, over_expanded_, sleeve_);
  if (!archive.reading())
    return;
  requireIndex(static_cast<int>(state_), 0, static_cast<int>(State::kLost) + 1);
  requireFinite(inner_diameter_);
}

void Treatment::archive(Archive& archive)
{
  archive(inflation_, dislodged_, events_, load_);
  if (stent_)
    archive(*stent_);
}

/** Saves or loads the vertices whose state differs from the initial one. */
void VesselDilatation::archive(Archive& archive)
{
  std::vector<int> changed;
  for (std::size_t v = 0; v < vertices_.size() && !archive.reading(); ++v)
    if (vertices_[v].active || vertices_[v].peak != 0.0 || vertices_[v].base != initial_vertices_[v] ||
        mesh_.vertices[v] != initial_vertices_[v])
      changed.push_back(static_cast<int>(v));
  for (std::size_t v = 0; v < vertices_.size() && archive.reading(); ++v)
  {
    VertexState initial;
    initial.base = mesh_.vertices[v] = initial_vertices_[v];
    initial.healthy_radius = vertices_[v].healthy_radius;
    vertices_[v] = initial;
  }
  archive(changed, active_, next_.first, next_.second, empty_, largest_displacement_, peak_pressure_, largest_stretch_);
  archive(surroundings_.axis, surroundings_.widest, surroundings_.displacement);
  if (archive.reading())
    requireFinite(largest_displacement_, peak_pressure_, largest_stretch_, surroundings_.widest,
                  surroundings_.displacement);
  for (const std::vector<int>* indices : {&changed, &active_})
    for (const int v : *indices)
      requireIndex(v, 0, static_cast<int>(vertices_.size()));
  for (int v : changed)
  {
    VertexState& vertex_state = vertices_.at(static_cast<std::size_t>(v));
    archive(mesh_.vertices[static_cast<std::size_t>(v)], vertex_state.base, vertex_state.peak, vertex_state.rest,
            vertex_state.held, vertex_state.active);
    if (archive.reading())
      requireFinite(mesh_.vertices[static_cast<std::size_t>(v)], vertex_state.base, vertex_state.peak,
                    vertex_state.rest, vertex_state.held);
  }
  if (!archive.reading())
    return;
  requireFinite(surroundings_.axis);
  requireLoaded(surroundings_.axis.size() != 1, "holds a body whose axis is one point");
  near_.clear();
  if (!surroundings_.axis.empty())
    findNear();
}

}  // namespace endovascular_sim::intervention
