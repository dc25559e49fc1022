#!/bin/bash
# `catkin_ws/release` makes the same archive of the sources twice, names its commit in it, and refuses a commit whose versions differ.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
git -C "$repository" rev-parse HEAD > /dev/null 2>&1 || { echo "skipped: not a git checkout"; exit 77; }
export GIT_AUTHOR_NAME=test GIT_AUTHOR_EMAIL=test@localhost GIT_COMMITTER_NAME=test GIT_COMMITTER_EMAIL=test@localhost

# The present files as a commit of a repository of their own.
mkdir "$folder/tree"
(cd "$repository" && git ls-files -z --cached --others --exclude-standard -- ':!:docs/images' ':!:test/fuzz' |
  while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done | tar --null -T - -c) | tar -C "$folder/tree" -x
cd "$folder/tree"
git init -q
git add -A
git commit -qm "All files"
version=$(sed -n 's/^project(endovascular_sim VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)

catkin_ws/release --sources-only --twice --out "$folder/out"
(cd "$folder/out" && sha256sum -c SHA256SUMS)
tar -xzf "$folder/out/endovascular_sim-$version.tar.gz" -C "$folder"
[ "$(cat "$folder/endovascular_sim-$version/cmake/archived_commit.txt")" = "$(git rev-parse HEAD)" ]
# A build of the archive knows its commit, also inside another repository.
cmake -DSOURCE="$repository" -DHEADER="$folder/commit.h" -P "$folder/endovascular_sim-$version/cmake/write_commit.cmake"
grep -q "\"$(git rev-parse HEAD | cut -c 1-12)\"" "$folder/commit.h"

# refused REASON ARGUMENT…: `release ARGUMENT…` fails with a reason.
refused() {
  local reason=$1
  shift
  if catkin_ws/release "$@" 2> "$folder/refusal"; then echo "released, in place of '$reason'"; exit 1; fi
  grep -qF "$reason" "$folder/refusal" || { echo "another reason than '$reason':"; cat "$folder/refusal"; exit 1; }
}
# refuses REASON FILE EXPRESSION: a commit with a changed file is not released.
refuses() {
  sed -i "$3" "$2"
  git commit -qam "Changed $2"
  refused "$1" --check-only
  git reset -q --hard HEAD~
}
refuses "package.xml has '9.9.9'" package.xml 's|<version>.*</version>|<version>9.9.9</version>|'
refuses "CITATION.cff has '9.9.9'" CITATION.cff 's/^version: .*/version: 9.9.9/'
refuses "CHANGELOG.md has '9.9.9'" CHANGELOG.md 's/^## Unreleased/## 9.9.9 (2026-01-01)/'
refuses "not 'VERSION (YYYY-MM-DD)'" CHANGELOG.md 's/^## Unreleased/## soon/'
refuses "src/common/releases.cpp has" CMakeLists.txt '/^project/s/VERSION [0-9.]*/VERSION 9.9.9/'
refuses "no samples of this release" CMakeLists.txt '/^project/s/VERSION [0-9.]*/VERSION 9.9.9/'
refuses "present physics number" src/common/version.h 's/\(kPhysicsNumber = \)[0-9]*/\1999/'
refuses "present physics number" src/simulation/saved_state.h 's/\(kStateFormat = \)[0-9]*/\1999/'
echo changed >> README.md
refused "not committed" --check-only
git checkout -q README.md

# A tag needs a heading with the version, and stays with its commit.
refused "first heading of CHANGELOG.md is 'Unreleased'" --sources-only --out "$folder/tagged" --tag
sed -i "s/^## Unreleased/## $version (2026-01-01)/" CHANGELOG.md
git commit -qam "Release"
catkin_ws/release --sources-only --out "$folder/tagged" --tag
[ "$(git rev-parse "v$version^{commit}")" = "$(git rev-parse HEAD)" ]
git commit -q --allow-empty -m "Later"
refused "belongs to another commit" --check-only

# Fields of CITATION.cff that CFF 1.2.0 requires, and no unknown ones.
/usr/bin/python3 - <<'PYTHON'
import yaml
REQUIRED = {"cff-version", "message", "title", "authors"}
OPTIONAL = {"abstract", "commit", "contact", "date-released", "doi", "identifiers", "keywords", "license", "license-url",
            "preferred-citation", "references", "repository", "repository-artifact", "repository-code", "type", "url", "version"}
with open("CITATION.cff", encoding="utf-8") as file:
    citation = yaml.safe_load(file)
assert REQUIRED <= set(citation) <= REQUIRED | OPTIONAL, set(citation)
assert citation["cff-version"] == "1.2.0" and citation["type"] == "software" and citation["license"] == "BSD-3-Clause"
assert citation["authors"] and all(set(author) == {"name"} for author in citation["authors"])
PYTHON
