#!/bin/bash
# catkin_ws/test counts failures, crashes and hanging tests of a gtest program, and refuses unknown folders and options.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
programs=$folder/catkin_ws/devel/lib/endovascular_sim
mkdir -p "$programs" "$folder"/test/{good,crashing,hanging,scripts}

# make_program FOLDER COMMANDS: a program that prints as gtest does.
make_program() {
  cat > "$programs/test_$1" <<PROGRAM
#!/bin/bash
case "\$*" in *--gtest_list_tests*) printf 'Suite.\n  Passes\n  Other\n'; exit 0 ;; esac
$2
PROGRAM
  chmod +x "$programs/test_$1"
}
passes="printf '%s\n' '[ RUN      ] Suite.Passes' 'a message' '[       OK ] Suite.Passes (1500 ms)'"
make_program good "$passes
printf '%s\n' '[ RUN      ] Suite.Other/0' 'reason' '[  SKIPPED ] Suite.Other/0 (0 ms)'
printf '%s\n' '[ RUN      ] Suite.Other/1' 'wrong' '[  FAILED  ] Suite.Other/1, where GetParam() = 3 (2 ms)'; exit 1"
make_program crashing "$passes; echo '[ RUN      ] Suite.Other'; kill -SEGV \$\$"
make_program hanging "$passes; echo '[ RUN      ] Suite.Other'; sleep 60"
printf 'exit 77\n' > "$folder/test/scripts/test_that_cannot_run.sh"
printf 'true\n' > "$folder/test/scripts/test_that_passes.sh"
# Each of two scripts waits for the other one.
for pair in 'first second' 'second first'; do
  set -- $pair
  printf '# Runs beside other tests.\ntouch "%s/%s"\nfor k in $(seq 600); do [ ! -e "%s/%s" ] || exit 0; sleep 0.1; done\nexit 1\n' \
    "$folder" "$1" "$folder" "$2" > "$folder/test/scripts/test_$1.sh"
done
shared=2
[ "$(nproc)" -gt 1 ] || { rm "$folder"/test/scripts/test_{first,second}.sh; shared=0; }

status=0
/usr/bin/python3 "$repository/catkin_ws/lib/run_tests.py" "$folder" --ceiling 2 > "$folder/output" || status=$?
cat "$folder/output"
[ "$status" -eq 1 ]
[ "$(tail -n 1 "$folder/output")" = "$((4 + shared)) passed, 3 failed, 2 skipped" ]
grep -q 'FAILED  Suite.Other/1: wrong' "$folder/output"
grep -q 'FAILED  Suite.Other: the program ended with code -11' "$folder/output"
grep -q 'FAILED  Suite.Other: not finished within 2 s' "$folder/output"
grep -q '1.5 s  Suite.Passes' "$folder/output"

output=$(/usr/bin/python3 "$repository/catkin_ws/lib/run_tests.py" "$folder" --only scripts --filter '*passes')
[ "$(tail -n 1 <<< "$output")" = '1 passed, 0 failed' ]

for options in '--only no_such_folder' '--nonsense' '--filter'; do
  status=0
  # shellcheck disable=SC2086
  "$repository/catkin_ws/test" $options 2> /dev/null || status=$?
  [ "$status" -eq 2 ]
done
