#pragma once

#include <string>

namespace endovascular_sim::nodes
{

/** Present name of a topic of a bag. Former versions named some topics otherwise; namespaces are kept.
 *  @param topic full name, e.g. "/room/vessel/moved" */
std::string presentTopic(std::string topic);

/** Fields of a message's definition, with present names and without comments: one line per field, and the types that it
 *  contains. Messages with equal fields have equal bytes. */
std::string presentFields(const std::string& definition);

}  // namespace endovascular_sim::nodes
