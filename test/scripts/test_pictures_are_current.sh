#!/bin/bash
# Every picture of the documentation is made by the present state of its inputs, has an entry in docs/images/manifest.yaml and pages
# that show it; a changed input, a foreign picture and a missing one are named.
# Runs beside other tests.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
"$repository/docs/images/make_pictures.py" --check

# The check itself, on a copy of the repository with one picture.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }
mkdir -p "$folder/docs/images" "$folder/config"
cp "$repository/docs/images/make_pictures.py" "$folder/docs/images"
echo "scene" > "$folder/config/scene.yaml"
printf 'one\nnumber = 1\n' > "$folder/config/version.h"
echo "![a picture](images/a.png)" > "$folder/docs/PAGE.md"
cat > "$folder/docs/images/manifest.yaml" <<'YAML'
# A comment stays.

images/a.png:
  pages: [docs/PAGE.md]
  command: /usr/bin/python3 -c 'from PIL import Image; Image.new("RGB", (2, 2)).save("picture.png")'
  inputs:
    - config/*.yaml
    - config/version.h:number
  made: never
YAML
git -C "$folder" init --quiet
mkdir "$folder/devel"
touch "$folder/devel/setup.bash"
export ENDOVASCULAR_DEVEL=$folder/devel
pictures() { "$folder/docs/images/make_pictures.py" "$@"; }
named() { output=$(pictures --check) && fail "accepted: $1"; grep -q "$1" <<< "$output" || fail "$output"; }
named "images/a.png: missing, but shown by docs/PAGE.md"
pictures
pictures --check
grep -q "A comment stays" "$folder/docs/images/manifest.yaml"
echo "comment" >> "$folder/config/version.h"
pictures --check
echo "number = 2" >> "$folder/config/version.h"
named "images/a.png: older than its inputs; docs/images/make_pictures.py images/a.png makes it anew"
pictures a.png
pictures --check
echo "changed" >> "$folder/config/scene.yaml"
named "images/a.png: older than its inputs"
pictures
cp "$folder/docs/images/a.png" "$folder/docs/images/b.png"
named "images/b.png: no entry"
rm "$folder/docs/images/b.png"
echo "![a picture](images/a.png)" > "$folder/README.md"
rm "$folder/docs/PAGE.md"
named "the manifest names docs/PAGE.md"
output=$(pictures c.png 2>&1) && fail "an unknown picture was accepted"
grep -q "no picture 'c.png'" <<< "$output"
