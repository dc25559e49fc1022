#pragma once

#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** True if a set answers a query and is consistent: same step, sub-step, pass, vessel version and edges, every number
 *  in its range, and every gap equal to the distance between the wire's surface and the plane of its feature. A set
 *  received from another process is used only then. */
bool isValidAnswer(const Query& query, const ContactSet& set);

}  // namespace endovascular_sim::contact
