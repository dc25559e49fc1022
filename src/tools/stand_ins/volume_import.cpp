#include <cstdio>

/** Takes the place of volume_import in a build without ITK. */
int main()
{
  std::fputs(
      "volume_import: is not built, because ITK was not found. In the folder of the repository, type:\n"
      "  sudo apt-get install libinsighttoolkit5-dev\n"
      "  catkin_ws/demo --build-only\n"
      "Then start this command again. Volumes (.vol) of another computer need no ITK.\n",
      stderr);
  return 1;
}
