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

/** Reports whether the fields of a recorded definition are the first ones of a present definition, because later
 * versions appended further ones. The definitions of the types of the fields must be equal. Former names of fields
 * count as the present ones. */
bool hasFirstFields(const std::string& recorded, const std::string& present);

}  // namespace endovascular_sim::nodes
