# Builds with sanitizers, below catkin_ws/sanitized. Sourced by `test`, after workspace.sh.

# build_sanitized address|thread TARGET…: configures and builds targets, with low priority.
build_sanitized() {
  local sanitizer=$1 folder="$workspace/sanitized/$1" log="$workspace/sanitized/$1.log" launcher=()
  shift
  mkdir -p "$folder"
  if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  say "Building with the $sanitizer sanitizer, $(build_jobs) job(s); log: $log"
  {
    cmake -S "$repository" -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
      -DENDOVASCULAR_SANITIZE="$sanitizer" -DCATKIN_ENABLE_TESTING=ON -DCATKIN_DEVEL_PREFIX="$folder/devel" \
      -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 "${launcher[@]}" &&
      nice cmake --build "$folder" -j "$(build_jobs)" --target "$@"
  } > "$log" 2>&1 || { tail -n 40 "$log" >&2; die "the build with the $sanitizer sanitizer failed; the whole log is $log"; }
}

# run_sanitized FOLDER|'' true|false OPTION…: builds what the selection needs, and replaces this process by its tests.
run_sanitized() {
  local only=$1 rostest=$2 folder=${1%%/*} name
  shift 2
  local address=(tests fuzz) thread=(test_common test_contact test_haptics test_nodes test_simulation test_vessel)
  check_path "$repository"
  clean_environment
  install_packages packages.txt
  install_packages packages-test.txt
  case "$only" in
    '') ;;
    fuzz) address=(fuzz) thread=() ;;
    *)
      address=("test_$folder")
      case " ${thread[*]} " in *" test_$folder "*) thread=("test_$folder") ;; *) thread=() ;; esac ;;
  esac
  if $rostest && { [ -z "$only" ] || [ "$only" = nodes ]; }; then
    thread+=(all)
    for name in "$repository"/test/nodes/*.test; do thread+=("test_$(basename "$name" .test)_graph"); done
  fi
  build_sanitized address "${address[@]}"
  if [ ${#thread[@]} -gt 0 ]; then build_sanitized thread "${thread[@]}"; fi
  find_meshes
  set +u
  # Messages and programs of Python are those of the sanitized build.
  . "$workspace/sanitized/address/devel/setup.bash"
  set -u
  exec python3 "$workspace/lib/run_sanitized.py" "$repository" "$@"
}
