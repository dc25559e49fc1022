#pragma once

#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** Whether a set answers a query and makes sense: the same step, sub-step, pass and edges, every number what it may be,
 *  and every gap the distance between the wire's surface and the plane of its point and normal. A set that came over a
 *  wire counts only then. */
bool isValidAnswer(const Query& query, const ContactSet& set);

}  // namespace endovascular_sim::contact
