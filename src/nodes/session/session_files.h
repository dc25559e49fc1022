#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::nodes
{

/** Bags of one session. */
struct SessionFiles
{
  std::string name;               ///< path that the user gave, or that of the bag's folder below it
  std::string folder;             ///< name of a folder for results of this session, relative; unique among the sessions
  std::vector<std::string> bags;  ///< in the order of their steps; several when the recorder was started again
};

/** Sessions of files and folders, in their order. A file is one session. A folder gives those in it and below it:
 *  session.bag, session_2.bag and so on are one session, as the session node names them; every other bag is one of its
 * own.
 *  @throws InputError for a path that does not exist, and for a folder without a bag */
std::vector<SessionFiles> sessionsOf(const std::vector<std::string>& paths);

/** Bags of files and folders, as sessionsOf() finds them. */
std::vector<std::string> bagsOf(const std::vector<std::string>& paths);

/** Bags of one session: files, or a folder with a single session in it or below it.
 *  @throws InputError as sessionsOf(), and for a folder with several sessions */
std::vector<std::string> bagsOfOneSession(const std::vector<std::string>& paths);

}  // namespace endovascular_sim::nodes
