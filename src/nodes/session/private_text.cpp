#include "nodes/session/private_text.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kShortestName = 3;  ///< a shorter one would occur in other words [characters]

/** Reports whether a word of a text ends or begins at a position. */
bool isBoundary(const std::string& text, std::size_t at)
{
  return at >= text.size() || std::isalnum(static_cast<unsigned char>(text[at])) == 0;
}

/** Replaces a name wherever it stands as a word. */
void replaceWord(std::string& text, const std::string& name, const std::string& replacement)
{
  if (name.size() < kShortestName)
    return;
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
    if ((at == 0 || isBoundary(text, at - 1)) && isBoundary(text, at + name.size()))
    {
      text.replace(at, name.size(), replacement);
      at += replacement.size();
    }
    else
      at += name.size();
}

std::string hostName()
{
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string();
}

std::vector<std::pair<std::string, std::string>> foldersOfProcess()
{
  std::vector<std::pair<std::string, std::string>> folders;
  std::error_code unknown;
  folders.emplace_back(std::filesystem::current_path(unknown).string(), "WORKING_FOLDER");
  if (const char* ros_home = std::getenv("ROS_HOME"); ros_home != nullptr)
    folders.emplace_back(ros_home, "ROS_HOME");
  if (const char* home = std::getenv("HOME"); home != nullptr)
    folders.emplace_back(home, "~");
  if (const passwd* user = ::getpwuid(::getuid()); user != nullptr)
    folders.emplace_back(user->pw_dir, "~");
  std::stable_sort(folders.begin(), folders.end(),
                   [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  return folders;
}

}  // namespace

PrivateText::PrivateText(std::string host, std::vector<std::pair<std::string, std::string>> folders)
  : host_(std::move(host)), folders_(std::move(folders))
{
}

const PrivateText& PrivateText::ofProcess()
{
  static const PrivateText text(hostName(), foldersOfProcess());
  return text;
}

std::string PrivateText::removedFrom(std::string text) const
{
  for (const auto& [folder, replacement] : folders_)
    replaceWord(text, folder, replacement);
  replaceWord(text, host_, "host");
  return text;
}

std::string withoutFolder(const std::string& path)
{
  return !path.empty() && path.front() == '/' ? std::filesystem::path(path).filename().string() : path;
}

}  // namespace endovascular_sim::nodes
