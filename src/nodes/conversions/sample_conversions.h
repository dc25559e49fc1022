#pragma once

#include "endovascular_sim/SessionSample.h"
#include "results/session_sample.h"

namespace endovascular_sim::nodes
{

/** Converts a sample; the caller sets the header and the step. */
void toMessage(const results::Sample& sample, SessionSample& message);

/** Sample of a message, without the branches of the tips.
 *  @param instruments number of the scene's instruments
 *  @throws InputError when a list has another length */
results::Sample fromMessage(const SessionSample& message, std::size_t instruments);

}  // namespace endovascular_sim::nodes
