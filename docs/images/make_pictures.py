#!/usr/bin/python3
"""Makes the pictures of the documentation, and tells which are older than their inputs.

  docs/images/make_pictures.py --check        names the pictures that are not current; exit code 1 if there is one
  docs/images/make_pictures.py                makes all pictures that are not current
  docs/images/make_pictures.py NAME…          makes these pictures, e.g. tips.png
  docs/images/make_pictures.py --all          makes all pictures
  docs/images/make_pictures.py --list         lists the pictures with their pages and the state of each

manifest.yaml holds for each picture of docs the command that makes it, its inputs, and the hash of command and inputs when it was made.
"""
import argparse
import fnmatch
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

HERE = pathlib.Path(__file__).resolve().parent
DOCS, REPOSITORY = HERE.parent, HERE.parent.parent
MANIFEST = HERE / "manifest.yaml"
KINDS = (".png", ".jpg", ".svg")
LARGEST = 400e3        # size of a picture [byte]
QUALITIES = (92, 85, 78, 70)  # of JPEG files, the first one that fits
REFERENCE = re.compile(r"!\[[^]]*\]\(([^)\s]+)\)")
HASH = re.compile(r"^  made: .*$", re.MULTILINE)


def read_manifest():
    """Entries of the manifest by the picture's path below docs."""
    return yaml.safe_load(MANIFEST.read_text(encoding="utf-8"))


def repository_files():
    """Paths of all files of the repository, relative to it, except for results of a build."""
    output = subprocess.run(["git", "-C", str(REPOSITORY), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            stdout=subprocess.PIPE, check=True).stdout
    return sorted(name for name in output.decode().split("\0") if name)


def content(pattern, files):
    """Names and contents of the inputs of a pattern: PATTERN, or FILE:WORD for the lines with a word."""
    pattern, _, word = pattern.partition(":")
    found = [name for name in files if name == pattern or fnmatch.fnmatch(name, pattern)]
    if not found:
        raise ValueError("input '%s' matches no file" % pattern)
    for name in found:
        data = (REPOSITORY / name).read_bytes()
        if word:
            data = b"\n".join(line for line in data.splitlines() if word.encode() in line)
            if not data:
                raise ValueError("input '%s' has no line with '%s'" % (name, word))
        yield name, data


def hash_of(entry, files):
    """Hash of the command and the inputs of a picture."""
    digest = hashlib.sha256(entry["command"].encode())
    seen = {}
    for pattern in entry["inputs"]:
        seen.update(content(pattern, files))
    for name in sorted(seen):
        digest.update(b"\0" + name.encode() + b"\0" + seen[name])
    return digest.hexdigest()[:16]


def references():
    """Pages that show each picture: its path below docs, and the pages relative to the repository."""
    found = {}
    for page in sorted([*DOCS.rglob("*.md"), *REPOSITORY.glob("*.md")]):
        for target in REFERENCE.findall(page.read_text(encoding="utf-8")):
            if "://" not in target:
                picture = (page.parent / target).resolve()
                if DOCS in picture.parents:
                    found.setdefault(picture.relative_to(DOCS).as_posix(), set()).add(page.relative_to(REPOSITORY).as_posix())
    return found


def faults(manifest, files):
    """Texts about pictures that are not current, without entry, without page or too large, and entries without picture."""
    shown = references()
    present = {name[len("docs/"):] for name in files if name.startswith("docs/") and name.endswith(KINDS)}
    for name in sorted(present - set(manifest)):
        yield "%s: no entry in docs/images/manifest.yaml" % name
    for name in sorted(set(shown) - present):
        yield "%s: missing, but shown by %s" % (name, ", ".join(sorted(shown[name])))
    for name, entry in manifest.items():
        if name not in present:
            yield "%s: entry without picture; docs/images/make_pictures.py %s makes it" % (name, name)
            continue
        pages = sorted(shown.get(name, ()))
        if sorted(entry["pages"]) != pages:
            yield "%s: shown by %s, but the manifest names %s" % (name, ", ".join(pages) or "no page", ", ".join(entry["pages"]) or "none")
        if (DOCS / name).stat().st_size > LARGEST:
            yield "%s: %.0f kB, more than %.0f" % (name, (DOCS / name).stat().st_size / 1e3, LARGEST / 1e3)
        try:
            if entry["made"] != hash_of(entry, files):
                yield "%s: older than its inputs; docs/images/make_pictures.py %s makes it anew" % (name, name)
        except ValueError as error:
            yield "%s: %s" % (name, error)


def is_current(entry, files):
    return entry.get("made") == hash_of(entry, files)


def with_coarse_greys(picture, step):
    """Picture whose grey pixels, those of X-ray images, have fewer levels: their noise makes a PNG large."""
    import numpy
    from PIL import Image
    pixels = numpy.array(picture.convert("RGB"))
    grey = pixels.max(axis=2) == pixels.min(axis=2)
    pixels[grey] = numpy.minimum(pixels[grey].astype(int) // step * step + step // 2, 255)
    return Image.fromarray(pixels)


def encoded(picture, path):
    """Picture in the format of a path, within LARGEST: PNG with fewer levels of grey, or JPEG of lower quality, if needed."""
    picture = picture.convert("RGB") if picture.mode not in ("L", "RGB") else picture
    choices = ([(picture, {"quality": quality, "optimize": True}) for quality in QUALITIES] if path.suffix == ".jpg" else
               [(picture, {"optimize": True})] + [(with_coarse_greys(picture, step), {"optimize": True}) for step in (3, 6, 10)])
    for one, options in choices:
        stream = io.BytesIO()
        one.save(stream, "JPEG" if path.suffix == ".jpg" else "PNG", **options)
        if stream.tell() <= LARGEST:
            break
    return stream.getvalue()


def environment():
    """Environment of the commands: those of the build, and the helpers of this folder."""
    devel = pathlib.Path(os.environ.get("ENDOVASCULAR_DEVEL", REPOSITORY / "catkin_ws" / "devel"))
    made = dict(os.environ, REPOSITORY=str(REPOSITORY), SETUP=str(devel / "setup.bash"), ROS_HOSTNAME="localhost", PYTHONDONTWRITEBYTECODE="1")
    made["PATH"] = ":".join([str(devel / "lib" / "endovascular_sim"), str(HERE), "/usr/bin", "/bin"])
    made.setdefault("ENDOVASCULAR_DATA_DIR", str(REPOSITORY.parent / "shared" / "vessels"))
    return made


def make(name, entry):
    """Runs the command of a picture in an empty folder, where it leaves picture.png, and stores the picture. Returns a text of the failure."""
    from PIL import Image
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder, "command.log")
        with open(log, "w", encoding="utf-8") as stream:
            status = subprocess.run(["bash", "-c", 'ln -s "$REPOSITORY/config" config; . "$SETUP"; set -eu\n' + entry["command"]], cwd=folder,
                                    env=environment(), stdout=stream, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False).returncode
        picture = pathlib.Path(folder, "picture" + (".svg" if name.endswith(".svg") else ".png"))
        if status != 0 or not picture.is_file():
            return "exit code %d\n%s" % (status, log.read_text(encoding="utf-8", errors="replace")[-3000:])
        as_it_is = name.endswith(".svg") or getattr(Image.open(picture), "is_animated", False)
        data = picture.read_bytes() if as_it_is else encoded(Image.open(picture), DOCS / name)
        (DOCS / name).write_bytes(data)
    return ""


def store_hash(name, value):
    """Writes the hash of a picture into the manifest, whose other text stays."""
    text = MANIFEST.read_text(encoding="utf-8")
    begin = text.index("\n%s:\n" % name) + 1
    found = re.compile(r"\n(?=\S)").search(text, begin + len(name) + 2)
    end = found.start() + 1 if found else len(text)
    MANIFEST.write_text(text[:begin] + HASH.sub("  made: '%s'" % value, text[begin:end], count=1) + text[end:], encoding="utf-8")


def make_all(names, manifest, files):
    """Makes pictures, and stores their hashes; returns the names of those that failed."""
    failed = []
    for count, name in enumerate(names, 1):
        print("%s (%d of %d) …" % (name, count, len(names)), flush=True)
        value = hash_of(manifest[name], files)  # of the inputs before the command runs
        failure = make(name, manifest[name])
        if failure:
            print("%s failed: %s" % (name, failure), file=sys.stderr)
            failed.append(name)
        else:
            store_hash(name, value)
    return failed


def named(words, manifest):
    """Entries of the words: names with or without their folder; raises ValueError for an unknown one."""
    found = []
    for word in words:
        names = [name for name in manifest if name == word or name.rsplit("/", 1)[-1] == word]
        if not names:
            raise ValueError("no picture '%s'; --list lists them" % word)
        found += names
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("names", nargs="*", metavar="NAME", help="pictures to make")
    parser.add_argument("--check", action="store_true", help="names the pictures that are not current")
    parser.add_argument("--all", action="store_true", help="makes all pictures")
    parser.add_argument("--list", action="store_true", help="lists the pictures")
    options = parser.parse_args()
    manifest, files = read_manifest(), repository_files()
    if options.check:
        found = list(faults(manifest, files))
        print("\n".join(found) if found else "%d pictures are current" % len(manifest))
        return 1 if found else 0
    if options.list:
        for name, entry in manifest.items():
            print("%-42s %-12s %s" % (name, "current" if is_current(entry, files) else "not current", ", ".join(entry["pages"])))
        return 0
    try:
        names = named(options.names, manifest) if options.names else [
            name for name, entry in manifest.items() if options.all or not is_current(entry, files)]
    except ValueError as error:
        parser.error(str(error))
    return 1 if make_all(names, manifest, files) else 0


if __name__ == "__main__":
    sys.exit(main())
