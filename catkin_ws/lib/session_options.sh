# Options of a session, shared by `catkin_ws/demo` and `endovascular_sim demo`. Sourced by bash, after messages.sh.
#
# Sets scene, overrides, seconds, headless, with_rviz, keyboard, build_only and results.

# session_usage COMMAND ACTION RESULTS: the help of a command. ACTION is the first line of its purpose, up to "runs", RESULTS the
# folder of results.
session_usage() {
  cat <<HELP
usage: $1 [options]

$2
one scene in real time with every node that the scene names, and ends with a summary and a folder of results:
session.bag, report.json, report.html, processor.json, metrics.json, metrics.html, instruments.csv, trajectory.csv,
wall_forces.csv, forces.png, tip_path.png, wall_forces.png, fluoroscopy/*.png, rviz.png, rviz_*.png.

  --scene NAME|FILE   scene to run: a name of config/scenes or a YAML file (default: pci;
                      with --keyboard: demo)
  --set KEY=VALUE     change one value of the scene, e.g. --set drive.speed=0.02; may be repeated
  --seconds N         simulated seconds (default: the scene's duration)
  --keyboard          the arrow keys of this terminal drive the wire in place of the haptic device
  --headless          no window even with a display
  --no-rviz           neither a window nor rviz.png
  --out DIR           folder for the results (default: $3/SCENE-DATE)
HELP
  ! $may_build || echo "  --build-only        install, build all programs and libraries, then stop"
  cat <<'HELP'
  --help              this text

Without a display (or with --headless) rviz_1_PHASE.png … (at most 8 phases of a procedure) and rviz.png, the last moment before
instruments are withdrawn, are drawn after the run, from the recorded bag, on a virtual screen; those of phases
follow the tip. Drawing in software during the run would take its processor time.
HELP
}

refuse_option() { echo "error: $*" >&2; exit 2; }
needs_value() { [ $# -ge 2 ] && [ -n "$2" ] || refuse_option "$1 needs a value (see --help)"; }

# KEY=VALUE, with an absolute path for a file of the current folder, because the nodes run in another folder.
with_absolute_path() {
  local value=${1#*=}
  case "$value" in /*) ;; *) [ -f "$value" ] && value="$PWD/$value" ;; esac
  printf '%s=%s\n' "${1%%=*}" "$value"
}

add_override() {
  local override
  case "$1" in *=*) ;; *) refuse_option "--set needs KEY=VALUE, not '$1'" ;; esac
  override=$(with_absolute_path "$1")
  case "$override" in *[[:space:]]*) refuse_option "--set '$override' holds a space; put such a value into the scene file" ;; esac
  overrides+=("$override")
}

# read_session_options ARGUMENT…: the caller has set may_build, whether --build-only is an option, and defined usage.
read_session_options() {
  scene='' overrides=() seconds='' headless=false with_rviz=true keyboard=false build_only=false results=''
  while [ $# -gt 0 ]; do
    case "$1" in
      --scene) needs_value "$@"; scene=$2; shift 2 ;;
      --set) needs_value "$@"; add_override "$2"; shift 2 ;;
      --seconds) needs_value "$@"; seconds=$2; shift 2 ;;
      --out) needs_value "$@"; results=$2; shift 2 ;;
      --headless) headless=true; shift ;;
      --no-rviz) with_rviz=false; shift ;;
      --keyboard) keyboard=true; shift ;;
      --build-only) $may_build || refuse_option "unknown option '$1' (see --help)"; build_only=true; shift ;;
      -h|--help) usage; exit 0 ;;
      *) refuse_option "unknown option '$1' (see --help)" ;;
    esac
  done
  if [ -n "$seconds" ]; then
    [[ $seconds =~ ^([0-9]+(\.[0-9]*)?|\.[0-9]+)$ ]] && [[ $seconds =~ [1-9] ]] ||
      refuse_option "--seconds needs a number greater than 0, not '$seconds'"
  fi
  [ -n "$scene" ] || { $keyboard && scene=demo || scene=pci; }
  ! $keyboard || [ -t 0 ] || refuse_option "--keyboard needs a terminal to read keys from"
}
