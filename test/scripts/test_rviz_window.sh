#!/bin/bash
# rviz_window starts rviz on a copy of its configuration; a low quality changes the copy only. rviz is a stand-in that prints its input.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/configs"
printf '#!/bin/bash\necho "$@"; echo "$ENDOVASCULAR_RVIZ_COPY $ENDOVASCULAR_FONT_SCALE"\n' > "$folder/bin/rviz"
chmod +x "$folder/bin/rviz"
export PATH="$folder/bin:/usr/bin:/bin" ROS_HOME="$folder/ros"
window() { /usr/bin/python3 "$repository/src/tools/rviz_window" "$@"; }
fail() { echo "$1"; exit 1; }

cp "$repository"/rviz/*.rviz "$folder/configs"
before=$(sha256sum "$folder"/configs/*)
copy="$folder/ros/endovascular_sim/rviz/demo.rviz"
output=$(window "$folder/configs/demo.rviz" __name:=rviz -f patient)
[ "$output" = "-d $copy __name:=rviz -f patient
$copy 1" ] || fail "unexpected start of rviz: $output"
cmp "$copy" "$repository/rviz/demo.rviz"
output=$(window "$folder/configs/demo.rviz" --quality low --font-scale auto)
[ "$output" = "-d $copy --disable-anti-aliasing
$copy auto" ] || fail "unexpected start of rviz: $output"
for value in "Frame Rate: 15" "Sides: 6" "Near Wall Opacity: 0"; do
  grep -qx " *$value" "$copy" || fail "low quality lacks '$value'"
done
for config in "$folder"/configs/*.rviz; do
  window "$config" --quality low > "$folder/output"
  /usr/bin/python3 -c 'import sys, yaml; yaml.safe_load(open(sys.argv[1]))["Visualization Manager"]["Displays"]' \
    "$folder/ros/endovascular_sim/rviz/$(basename "$config")"
done
window "$copy" > "$folder/output"  # a copy itself stays
[ "$before" = "$(sha256sum "$folder"/configs/*)" ] || fail "an original was changed"
if output=$(window "$folder/missing.rviz" 2>&1); then fail "a missing file was accepted"; fi
case $output in *missing.rviz*) ;; *) fail "the message names no file: $output" ;; esac
window --help | grep -q "font-scale"
