#!/bin/bash
# The packages in a bare Debian system: installed, used by an ordinary user, upgraded and removed.
#   test_package.sh [SUITE]     bookworm (the default) or trixie
#
# ENDOVASCULAR_PACKAGES names a folder with packages, which are not built then.
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
. "$(dirname "$0")/../packages_of_a_test.sh"
suite=${1:-bookworm}
packages_for "$suite"
root=$folder/system
names=(ros-crtk-msgs endovascular-sim endovascular-sim-rviz endovascular-sim-import endovascular-sim-dev)

step() { printf '== %s\n' "$*"; }
fail() { printf '%s\n' "$*"; exit 1; }
inside() { in_chroot "$root" "$@"; }
as_user() { in_chroot --user user "$root" "$@"; }
# Files and folders of the system, without those of users, of apt and of caches.
files() {
  (cd "$root" && find . -xdev \( -path ./home -o -path ./tmp -o -path ./root -o -path ./packages -o -path ./old -o -path ./var/cache -o -path ./var/log -o \
    -path ./var/lib/apt -o -path ./var/lib/dpkg -o -path ./dev -o -path ./proc -o -path ./sys \) -prune -o -print | sort)
}
seconds_since() { awk -v from="$1" -v to="$(date +%s.%N)" 'BEGIN { printf "%.0f s", to - from }'; }

# older_packages: the packages with version 0.0.1 and a file that the present ones do not hold.
older_packages() {
  local file name
  mkdir "$folder/old"
  for file in "$packages"/*.deb; do
    name=$(dpkg-deb -f "$file" Package)
    rm -rf "$folder/content"
    dpkg-deb -R "$file" "$folder/content"
    mkdir -p "$folder/content/usr/share/endovascular_sim/config/old"
    echo "$name" > "$folder/content/usr/share/endovascular_sim/config/old/$name.yaml"
    sed -i -E -e 's/^Version: .*/Version: 0.0.1/' -e "s/\(= $(dpkg-deb -f "$file" Version | sed 's/[.+~]/\\&/g')\)/(= 0.0.1)/g" "$folder/content/DEBIAN/control"
    dpkg-deb --root-owner-group -Zgzip -b "$folder/content" "$folder/old" > /dev/null
  done
}

step "a bare system of $suite"
make_chroot "$suite" "$root"
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"

step "dependencies"
start=$(date +%s.%N)
others=$(inside sh -c 'apt-get install -s --no-install-recommends /packages/*.deb' | sed -n 's/^Inst \([^ ]*\).*/\1/p' | grep -vxF "$(printf '%s\n' "${names[@]}")")
# shellcheck disable=SC2086  # names
apt_in_chroot "$root" install --no-install-recommends $others cmake g++ > "$folder/dependencies.log"
dependencies=$(seconds_since "$start")
files > "$folder/before"

step "upgrade of an older version leaves none of its files"
older_packages
cp -r "$folder/old" "$root/old"
apt_in_chroot "$root" install --no-install-recommends $(cd "$root" && printf '/%s\n' old/*.deb) > "$folder/old.log"
[ "$(inside find /usr/share/endovascular_sim/config/old -type f | wc -l)" -eq ${#names[@]} ]
start=$(date +%s.%N)
apt_in_chroot "$root" install --no-install-recommends $(cd "$root" && printf '/%s\n' packages/*.deb) > "$folder/new.log"
installation=$(seconds_since "$start")
[ ! -e "$root/usr/share/endovascular_sim/config/old" ] || fail "files of the older version are left"

step "first picture"
start=$(date +%s.%N)
as_user endovascular_sim simulate tube --x-ray --seconds 0.01 --no-plots --quiet --out first
[ -s "$root/home/user/first/x_ray.png" ]
printf 'dependencies %s, packages %s, first X-ray image %s\n' "$dependencies" "$installation" "$(seconds_since "$start")"

step "command, tools, Python and messages, as an ordinary user"
as_user endovascular_sim --version
as_user endovascular_sim --help | grep -q vessel_prepare
as_user endovascular_sim volume_import --help > /dev/null
as_user sh -c 'cd / && rosrun endovascular_sim scene_check tube' > /dev/null
as_user endovascular_sim simulate tube --no-plots --quiet --out run
hash=$(sed -n 's/.*"trajectory_hash": *"\([0-9a-f]*\)".*/\1/p' "$root/home/user/run/result.json")
[ -n "$hash" ]
as_user python3 -c "
import crtk_msgs.msg, endovascular_sim as evs
from endovascular_sim.msg import DriveApplied
session = evs.World('tube').session()
session.step(n=10**6)
assert session.trajectory_hash == '$hash', session.trajectory_hash"
refused=0
as_user endovascular_sim contact_lenses 2> "$folder/refusal" || refused=$?
[ $refused -eq 2 ] && grep -q 'no command' "$folder/refusal"

step "demonstration without a display, from any folder"
as_user sh -c 'cd /usr && endovascular_sim demo --headless' > "$folder/demo.log" 2>&1 || { cat "$folder/demo.log"; fail "the demonstration failed"; }
tail -n 25 "$folder/demo.log"
for file in session.bag report.html metrics.json tip_path.png rviz.png; do
  ls "$root"/home/user/endovascular_sim/pci-*/"$file" > /dev/null
done
as_user sh -c 'endovascular_sim bag_check endovascular_sim/pci-*/session.bag'

step "a lesson on a virtual screen"
as_user sh -c '
  export ROS_MASTER_URI=http://localhost:$(python3 -c "import socket; s = socket.socket(); s.bind((\"localhost\", 0)); print(s.getsockname()[1])")
  export LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1 ROS_HOSTNAME=localhost
  xvfb-run -a -s "-screen 0 1280x800x24" endovascular_sim lesson bifurcation expert:=false > lesson.log 2>&1 &
  timeout 240 sh -c "until timeout 10 rostopic echo -n 1 /rod/state_visual/header > state 2> /dev/null && rosservice list 2> /dev/null | grep -q ^/rviz/; do sleep 1; done" ||
    { cat lesson.log; exit 1; }
  rosservice list | grep -c . > services
  pkill -INT -u user roslaunch
  wait' || fail "the lesson did not run"
ls "$root"/home/user/endovascular_sim/lesson_bifurcation-*/session.bag > /dev/null

step "a C++ program by find_package"
cp -r "$repository/test/install/plain_cmake" "$root/home/user/plain"
inside chown -R user: /home/user/plain
as_user sh -c 'cmake -S plain -B built && cmake --build built && built/step_a_scene' > "$folder/plain.log" || { cat "$folder/plain.log"; exit 1; }
grep -q "trajectory_hash $hash" "$folder/plain.log" || fail "the program has another trajectory: $(tail -n 1 "$folder/plain.log")"

step "removal leaves nothing"
apt_in_chroot "$root" purge "${names[@]}" > "$folder/purge.log"
files > "$folder/after"
diff "$folder/before" "$folder/after" || fail "the removal does not restore the system"
echo "results of the user: $(cd "$root/home/user/endovascular_sim" && ls | paste -sd' ')"
