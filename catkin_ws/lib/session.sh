# One session of the node graph, from a scene to a folder of results, for `catkin_ws/demo` and `endovascular_sim demo`. Sourced by
# bash, after messages.sh.
#
# The caller sets `programs` (their folder), `share` (that of config and rviz), `session_folder` (that of this file) and
# `results_folder` (where folders of results are made).

# Speed of the simulated device's line [bit/s]. 1 kHz needs 230400; the faster line halves the transmission time.
device_baud=460800
launch_pid='' device_pid='' virtual_display_pid='' session_status=1 session_interrupted=false session_phase=starting

# The scene's file, by name in config/scenes or by path.
find_scene() {
  local wanted=$1
  if [ -f "$wanted" ]; then
    printf '%s/%s\n' "$(cd "$(dirname "$wanted")" && pwd -P)" "$(basename "$wanted")"
  elif [ -f "$share/config/scenes/$wanted.yaml" ]; then
    printf '%s\n' "$share/config/scenes/$wanted.yaml"
  else
    {
      echo "error: there is no scene '$wanted': neither a file of that path nor a name of config/scenes. The names there are:"
      for file in "$share"/config/scenes/*.yaml; do [ -f "$file" ] && echo "         $(basename "$file" .yaml)"; done
    } >&2
    exit 2
  fi
}

# Chooses and creates the folder of results; never overwrites an earlier session.
prepare_results() {
  local name
  name=$(basename "$1" .yaml)
  [ -n "$results" ] || results="$results_folder/$name-$(date +%Y%m%d-%H%M%S)"
  case "$results" in /*) ;; *) results="$PWD/$results" ;; esac
  if [ -e "$results/session.bag" ] || [ -e "$results/report.json" ]; then
    die "$results already holds a session: give another folder with --out, or remove that one"
  fi
  mkdir -p "$results" || die "the folder $results cannot be created: give another one with --out"
  results=$(cd "$results" && pwd -P)
}

free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])'
}

# The graph has its own master and its own logs.
ros_environment() {
  ROS_MASTER_URI="http://localhost:$(free_port)"
  ROS_HOME="$results/ros"
  ROS_LOG_DIR="$results/log"
  # Progress appears at once, although the output is a pipe.
  ROSCONSOLE_STDOUT_LINE_BUFFERED=1
  export ROS_MASTER_URI ROS_HOME ROS_LOG_DIR ROSCONSOLE_STDOUT_LINE_BUFFERED
  mkdir -p "$ROS_HOME" "$ROS_LOG_DIR"
}

check_real_time() {
  local limit
  limit=$(ulimit -r)
  if [ "$(id -u)" -eq 0 ] || [ "$limit" = unlimited ] || [ "$limit" -gt 0 ]; then
    return
  fi
  warn "this account may not use real-time scheduling, so more steps than necessary will be late. As root, once:"
  printf '%s\n' "           echo '$(id -un) - rtprio 80' > /etc/security/limits.d/90-endovascular-sim.conf" \
    "         then log in again." >&2
}

# end_process PID SECONDS: SIGINT, then, after the given seconds, SIGTERM and SIGKILL.
end_process() {
  local pid=$1 patience=$2 signal
  for signal in INT TERM KILL; do
    kill -0 "$pid" 2>/dev/null || break
    kill "-$signal" "$pid" 2>/dev/null || break
    local waited=0
    while kill -0 "$pid" 2>/dev/null && [ $waited -lt $((patience * 10)) ]; do
      sleep 0.1
      waited=$((waited + 1))
    done
    patience=5
  done
  wait "$pid" 2>/dev/null || true
}

# Processes of the graph. roslaunch marks its children by its environment, those included that it has not registered yet
# when it is interrupted.
processes_of_graph() { grep -lzxF "ENDOVASCULAR_GRAPH=$results" /proc/[0-9]*/environ 2>/dev/null | cut -d/ -f3; }

# Ends every process of the session, those included whose number is not stored yet.
clean_up() {
  trap '' INT TERM
  local pid
  [ -n "$launch_pid" ] && end_process "$launch_pid" 25
  [ -n "$device_pid" ] && end_process "$device_pid" 3
  [ -n "$virtual_display_pid" ] && end_process "$virtual_display_pid" 3
  for pid in $(jobs -p) $(processes_of_graph); do end_process "$pid" 3; done
  rm -f "${results:-/nonexistent}/device"
  launch_pid='' device_pid='' virtual_display_pid=''
}

interrupted() {
  echo
  say "Interrupted: closing the recording and ending every node"
  clean_up
  session_interrupted=true
  # Before the graph runs there is nothing to report.
  if [ "$session_phase" = starting ]; then
    trap - EXIT
    exit 130
  fi
}

# become own|same COMMAND…: replaces a background subshell by the command, so that $! is the command's process. Restores
# SIGINT, which background processes of a script ignore. `own` creates a process group, so that Ctrl-C at the terminal
# reaches this script first.
become() {
  exec python3 -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
if sys.argv[1] == "own": os.setpgid(0, 0)
os.execvp(sys.argv[2], sys.argv[2:])' "$@"
}

# Selects progress, warnings and errors from the nodes' output, without colours and time stamps.
readable_log() {
  sed -u -n -E 's/\x1b\[[0-9;]*m//g
    s/^\[ INFO\] \[[0-9., ]+\] [^ ]*\/session: /   /p; t
    s/^\[ ?(WARN|ERROR|FATAL)\] \[[0-9., ]+\] ([^ ]*): /   \1: \2: /p; t
    /RLException|^error|has died \[|exit code [1-9]/p'
}

start_device() {
  local arguments=(--link "$results/device" --baud "$device_baud" --out "$results/device_latency.json") override
  if $keyboard; then
    exec 3<&0
    become same "$programs"/device_simulator "${arguments[@]}" --keyboard <&3 2> "$results/log/device.log" &
  else
    # The operator starts to move when the simulation responds, not during the preparation of a vessel.
    arguments+=(--scene "$scene_file" --start enabled)
    for override in "${all_overrides[@]}"; do arguments+=(--set "$override"); done
    become own "$programs"/device_simulator "${arguments[@]}" > "$results/log/device.log" 2>&1 &
  fi
  device_pid=$!
  local waited=0
  while [ ! -e "$results/device" ]; do
    kill -0 "$device_pid" 2>/dev/null || { cat "$results/log/device.log" >&2; die "the device simulator ended at once"; }
    [ $waited -ge 50 ] && die "the device simulator opened no line within 5 s (see $results/log/device.log)"
    sleep 0.1
    waited=$((waited + 1))
  done
}

# Processor times since the start of this machine [1/100 s]: of all programs, and withdrawn by the hypervisor for other
# machines. Steps during the latter are late whatever their scheduling.
machine_times() { awk '/^cpu /{ print $2 + $3 + $4 + $7 + $8, $9 }' /proc/stat; }
# Processor time of the ended children of this script [1/100 s].
children_time() { awk '{ sub(/.*\) /, ""); print $14 + $15 }' "/proc/$$/stat"; }

# write_processor_times TIME MACHINE… CHILDREN: processor.json, the use of the processors since these values [s].
write_processor_times() {
  # shellcheck disable=SC2046  # two numbers
  set -- "$@" "$(date +%s.%N)" $(machine_times) "$(children_time)"
  awk -v n="$(nproc)" 'BEGIN {
      session = (ARGV[8] - ARGV[4]) / 100; others = (ARGV[6] - ARGV[2]) / 100 - session
      printf "{\"elapsed\": %.2f, \"processors\": %d, \"session\": %.2f, \"others\": %.2f, \"withdrawn\": %.2f}\n",
        ARGV[5] - ARGV[1], n, session, (others > 0 ? others : 0), (ARGV[7] - ARGV[3]) / 100
    }' "$@" > "$results/processor.json"
}
stolen_note() {
  local stolen
  stolen=$(sed -n 's/.*"withdrawn": \([0-9.]*\).*/\1/p' "$results/processor.json")
  ! awk -v s="$stolen" 'BEGIN { exit !(s >= 0.1) }' ||
    note "during the run the host of this virtual machine withdrew $stolen s of processor time"
}

# Runs the graph until the scene's duration is over. Sets session_status.
run_session() {
  session_interrupted=false session_phase=starting
  all_overrides=("${overrides[@]}")
  [ -n "$seconds" ] && all_overrides+=("duration=$seconds")
  local check_arguments=() override
  for override in "${all_overrides[@]}"; do check_arguments+=(--set "$override"); done

  local nodes
  nodes=$("$programs"/scene_check "$scene_file" "${check_arguments[@]}" --nodes) ||
    die "the scene was refused (see above)"
  mkdir -p "$results/log"
  ros_environment
  check_real_time
  local arguments=("scene:=$scene_file" "overrides:=${all_overrides[*]}" "results:=$results")
  # At the keyboard the user ends the session, unless --seconds is given.
  if $keyboard && [ -z "$seconds" ]; then arguments+=(stop_at_duration:=false); else arguments+=(stop_at_duration:=true); fi
  local node
  local launch_file=sim.launch
  if $with_rviz && ! $headless && [ -n "${DISPLAY:-}" ]; then
    launch_file=demo.launch
    nodes+=$'\n'visualization
  fi

  for node in vessel_server contact hemodynamics rod_dynamics fluoroscopy haptic_device robot session visualization; do
    if grep -qx "$node" <<< "$nodes"; then arguments+=("$node:=true"); else arguments+=("$node:=false"); fi
  done
  local times_before
  # shellcheck disable=SC2207  # numbers
  times_before=("$(date +%s.%N)" $(machine_times) "$(children_time)")
  # From here on there are processes to end. bash cannot run a trap while it parses a command substitution: there is none
  # until the traps are removed. Earlier a signal has its default effect, unless it arrives while a command ends.
  trap interrupted INT TERM
  trap clean_up EXIT
  say "Scene $scene_file"
  note "nodes: ${nodes//$'\n'/ }"
  note "results: $results"
  if grep -qx haptic_device <<< "$nodes"; then
    start_device
    arguments+=("device:=$results/device" "baud:=$device_baud")
  elif $keyboard; then
    die "the scene starts no haptic device, so the keyboard can drive nothing"
  fi

  if $keyboard; then
    become own env "ENDOVASCULAR_GRAPH=$results" roslaunch endovascular_sim "$launch_file" "${arguments[@]}" \
      > "$results/log/launch.log" 2>&1 &
  else
    become own env "ENDOVASCULAR_GRAPH=$results" roslaunch endovascular_sim "$launch_file" "${arguments[@]}" \
      > >(tee "$results/log/launch.log" | readable_log) 2>&1 &
  fi
  launch_pid=$!
  session_phase=running
  while kill -0 "$launch_pid" 2>/dev/null; do
    if $keyboard; then
      kill -0 "$device_pid" 2>/dev/null || break  # q was pressed
      wait -n "$launch_pid" "$device_pid" || true
    else
      wait "$launch_pid" || true
    fi
    $session_interrupted && break
  done
  clean_up
  trap - EXIT INT TERM
  write_processor_times "${times_before[@]}"
  stolen_note

  if $session_interrupted && [ ! -s "$results/report.json" ]; then
    note "the session was interrupted before its first step: there is no report"
    session_status=130
  elif [ ! -s "$results/report.json" ]; then
    printf '%s\n' "error: the session wrote no report; the last lines of the graph's log:" >&2
    tail -n 20 "$results/log/launch.log" >&2
    session_status=1
  elif $session_interrupted; then
    session_status=130
  else
    session_status=0
  fi
}

# Pictures, plots and the summary.
after_session() {
  [ -s "$results/report.json" ] || return 0
  if $with_rviz; then
    draw_rviz || $session_interrupted || warn "rviz.png could not be drawn (see $results/log/rviz.log)"
    if $session_interrupted; then session_status=130; fi
  fi
  "$programs"/plots results "$results" > "$results/log/plots.log" 2>&1 ||
    { cat "$results/log/plots.log" >&2; warn "the plots could not be drawn"; }
  "$programs"/plots summary "$results" || $session_interrupted || session_status=1
}

# Origin of the X-ray images: the bag if it holds them, else they are computed.
origin_of_x_ray() {
  if grep -q '^  x_ray_frames: true' "$results/scene.yaml"; then printf recorded; else printf rendered; fi
}

# Plays the bag into rviz on a virtual screen and saves a picture at each moment that matters (rviz_pictures.py).
# An interruption ends the drawing.
draw_rviz() {
  session_phase=drawing
  local display_file="$results/log/display" config="$results/log/pictures.rviz" pictures="$session_folder/rviz_pictures.py"
  local display moments pictures_pid waited=0
  moments=$(/usr/bin/python3 "$pictures" "$results") || return 1
  [ -n "$moments" ] || { note "no instrument entered the vessel: no picture of rviz"; return 0; }
  ros_environment
  cp "$share/rviz/replay.rviz" "$config"
  # Phases of a procedure differ at the tip: an overview of the body shows neither the stenosis nor the stent.
  [ "$(wc -l <<< "$moments")" -eq 1 ] ||
    sed -i '/^    Current:/,/^    Saved:/{s/Overview/Tip/; s/Distance: 0$/Distance: 0.2/}' "$config"
  trap clean_up EXIT
  trap interrupted INT TERM
  become own Xvfb -displayfd 5 -screen 0 1280x800x24 -nolisten tcp 5> "$display_file" > "$results/log/xvfb.log" 2>&1 &
  virtual_display_pid=$!
  while [ ! -s "$display_file" ] && [ $waited -lt 50 ] && ! $session_interrupted; do sleep 0.1; waited=$((waited + 1)); done
  ! $session_interrupted || { trap - EXIT INT TERM; return 1; }
  [ -s "$display_file" ] || return 1
  read -r display < "$display_file"
  display=":$display"
  say "Drawing rviz from the recording, in software"
  become own env "ENDOVASCULAR_GRAPH=$results" DISPLAY="$display" LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1 \
    roslaunch endovascular_sim replay.launch "bag:=$results/session.bag" "x_ray:=$(origin_of_x_ray)" "rviz_config:=$config" \
    paused:=true > "$results/log/rviz.log" 2>&1 &
  launch_pid=$!
  become own env "ENDOVASCULAR_GRAPH=$results" DISPLAY="$display" timeout -s KILL 300 /usr/bin/python3 "$pictures" "$results" --play \
    >> "$results/log/rviz_pictures.log" 2>&1 &
  pictures_pid=$!
  # The pictures end before the bag does; the graph may end early by a fault.
  while kill -0 "$pictures_pid" 2>/dev/null && kill -0 "$launch_pid" 2>/dev/null && ! $session_interrupted; do sleep 0.5; done
  ! $session_interrupted || { trap - EXIT INT TERM; return 1; }
  clean_up
  trap - EXIT INT TERM
  [ -s "$results/rviz.png" ]
}
