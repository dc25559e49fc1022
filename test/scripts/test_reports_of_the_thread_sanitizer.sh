#!/bin/bash
# A report of the thread sanitizer counts when this project makes all of its accesses. A program with a data race and one with
# a cycle of locks are compiled in a folder that has the layout of the repository; a race within a library does not count.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
select=$repository/catkin_ws/lib/thread_reports.py
mkdir "$folder/src" "$folder/library"

cat > "$folder/src/race.cpp" <<'CPP'
#include <thread>
#include <vector>
int main()
{
  std::vector<int> values(1);
  std::thread other([&] { values.at(0) = 1; });
  values.at(0) = 2;
  other.join();
}
CPP
cat > "$folder/src/cycle.cpp" <<'CPP'
#include <mutex>
#include <thread>
int main()
{
  std::mutex a, b;
  const auto both = [](std::mutex& first, std::mutex& second)
  {
    const std::lock_guard<std::mutex> outer(first);
    const std::lock_guard<std::mutex> inner(second);
  };
  std::thread(both, std::ref(a), std::ref(b)).join();
  std::thread(both, std::ref(b), std::ref(a)).join();
}
CPP
sed 's/int main()/void run()/' "$folder/src/race.cpp" > "$folder/library/race.cpp"
cat > "$folder/src/caller.cpp" <<'CPP'
void run();
int main()
{
  run();
}
CPP

# reports_of NAME SOURCE…: compiles and runs a program; its reports are in NAME.*
reports_of() {
  local name=$1
  shift
  clang++ -std=c++17 -g1 -O1 -fno-omit-frame-pointer -fsanitize=thread -pthread "$@" -o "$folder/$name"
  TSAN_OPTIONS="exitcode=0:second_deadlock_stack=1:log_path=$folder/$name.reports" "$folder/$name"
  grep -q 'WARNING: ThreadSanitizer' "$folder/$name".reports.* || { echo "$name: no report of the sanitizer"; exit 1; }
}
counts() { ! /usr/bin/python3 "$select" "$folder" "$folder/$1".reports.* > "$folder/selected"; }

cd "$folder"
reports_of race src/race.cpp
counts race || { echo "a data race of the project does not count:"; cat race.reports.*; exit 1; }
grep -q 'data race' selected
reports_of cycle src/cycle.cpp
counts cycle || { echo "a cycle of locks of the project does not count:"; cat cycle.reports.*; exit 1; }
grep -q 'lock-order-inversion' selected
reports_of caller src/caller.cpp library/race.cpp
! counts caller || { echo "a data race within a library counts:"; cat selected; exit 1; }
