#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::nodes
{

/** Texts without what identifies the computer or its user: host name, home directory and working directory. Recordings
 * are handed to others. */
class PrivateText
{
public:
  /** @param host name of the computer
   *  @param folders paths that are replaced, each with its replacement; longer ones first */
  PrivateText(std::string host, std::vector<std::pair<std::string, std::string>> folders);

  /** That of this process. */
  static const PrivateText& ofProcess();

  /** Text with "host" for the host name, and the replacements of the folders. */
  std::string removedFrom(std::string text) const;

private:
  std::string host_;
  std::vector<std::pair<std::string, std::string>> folders_;
};

/** Name of a file without its folder if the path is absolute; else the text itself. */
std::string withoutFolder(const std::string& path);

}  // namespace endovascular_sim::nodes
