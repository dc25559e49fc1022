#pragma once

#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** Validation of a contact set received from another process. @return whether the set belongs to the query (step,
 *  sub-step, pass, edges), all numbers are in range, and each gap is the distance between the wire's surface and the
 *  plane through its point. */
bool isValidAnswer(const Query& query, const ContactSet& set);

}  // namespace endovascular_sim::contact
