#include "contact/contract/contact_set_archive.h"
#include "rod/contact/contact_solver_state.h"

// What the contacts of one step leave to the next.

namespace endovascular_sim::rod
{

void ContactSolver::Spring::archive(Archive& archive)
{
  archive(node, weight0, weight1, stiffness, gap, force, reached, resisted, active);
}

void ContactSolver::Carried::archive(Archive& archive)
{
  archive(id, place, force);
}

void NodeRange::archive(Archive& archive)
{
  archive(begin, end);
}

void ContactSolver::archive(Archive& archive)
{
  archive(contacts_, previous_contacts_, springs_, previous_springs_, carried_, radii_);
  archive(valid_, moved_on_, step_is_stale_, stale_motion_budget_, margins_, reaches_, any_wide_, fast_, fast_before_,
          wide_motion_, step_, substep_, vessel_version_, query_.first_node, margin_rule_.widest_margin,
          margin_rule_.snap_margin, margin_rule_.snap, mouth_, mouth_edge_);
}

}  // namespace endovascular_sim::rod
