#!/bin/bash
# No include of src runs upwards or in a circle between folders: each points to its own folder or to one earlier in the
# list of docs/ARCHITECTURE.md, section "Layers"; cmake/layers.cmake agrees. Only nodes, tools and rviz_plugin include ROS.
# python/core includes neither ROS nor folders above session.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../.."
exec /usr/bin/python3 - <<'PYTHON'
import os
import re
import sys

ROS = re.compile(r"(ros|rosbag|tf2_ros|diagnostic_updater|message_filters|std_srvs|\w+_msgs|endovascular_sim)/")

ABOVE_PYTHON = ("nodes", "rviz_plugin", "tools", "benchmark")

text = open("docs/ARCHITECTURE.md").read()
block = re.search(r"^## Layers\n.*?^```\w*\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
if not block:
    sys.exit("docs/ARCHITECTURE.md has no fenced list in a section 'Layers'")
level = {}
for number, line in enumerate(block.group(1).splitlines()):
    # Folders of one line are independent of each other; two spaces divide them from the description.
    for folder in re.split(r"\s{2,}", line.strip())[0].split():
        level[folder] = number

errors = []
seen = set()
for parent, folders, files in os.walk("src"):
    folders.sort()
    folder = os.path.relpath(parent, "src")
    sources = sorted(name for name in files if name.endswith((".h", ".cpp")))
    if not sources:
        continue
    seen.add(folder)
    if folder not in level:
        errors.append("src/%s is not in the list of docs/ARCHITECTURE.md" % folder)
        continue
    for name in sources:
        path = os.path.join(parent, name)
        with_ros = folder.split("/")[0] in ("nodes", "tools", "rviz_plugin")
        for number, line in enumerate(open(path), 1):
            include = re.match(r'\s*#include\s+(["<])([^">]+)[">]', line)
            if not include:
                continue
            where, target = "%s:%d: " % (path, number), include.group(2)
            if ROS.match(target):
                if not with_ros:
                    errors.append(where + "only nodes, tools and rviz_plugin include ROS: " + target)
            elif include.group(1) == '"' and "/" in target:
                other = os.path.dirname(target)
                if not os.path.exists(os.path.join("src", target)):
                    errors.append(where + "no such file: src/" + target)
                elif other != folder and not level.get(other, len(level)) < level[folder]:
                    errors.append(where + "%s is not before %s in the order of folders" % (other, folder))
for name in sorted(os.listdir("python/core")):
    for number, line in enumerate(open("python/core/" + name), 1):
        include = re.match(r'\s*#include\s+(["<])([^">]+)[">]', line)
        if include and ROS.match(include.group(2)) or include and include.group(2).split("/")[0] in ABOVE_PYTHON:
            errors.append("python/core/%s:%d: python binds the core only: %s" % (name, number, include.group(2)))
# cmake/layers.cmake: the order is that of the list, and each library links exactly the layers that it includes.
separate = re.search(r"set\(SEPARATE_FOLDERS ([^)]*)\)", open("cmake/layers.cmake").read()).group(1).split()
linked = {}
for line in re.findall(r'^  "(\w+ *:[^:]*):', open("cmake/layers.cmake").read(), re.MULTILINE):
    layer, links = (part.split() for part in line.split(":"))
    for other in links:
        if other not in linked:
            errors.append("cmake/layers.cmake: %s links %s, which is not before it" % (layer[0], other))
    linked[layer[0]] = set(links)


def all_links(layer):
    return linked[layer].union(*(all_links(other) for other in linked[layer])) if linked[layer] else set()


for layer in linked:
    included = set()
    for parent, _, files in os.walk("src/" + layer):
        if os.path.relpath(parent, "src") not in separate:
            for name in files:
                included.update(re.findall(r'^#include "(\w+)/', open(os.path.join(parent, name)).read(), re.MULTILINE))
    included &= set(linked) - {layer}
    for other in sorted(included - all_links(layer)):
        errors.append("cmake/layers.cmake: %s includes %s, but does not link it" % (layer, other))
    for other in sorted(linked[layer]):
        if not (included & ({other} | all_links(other))):
            errors.append("cmake/layers.cmake: %s links %s, of which it includes nothing" % (layer, other))
        if any(other in all_links(third) for third in linked[layer] - {other}):
            errors.append("cmake/layers.cmake: %s links %s twice" % (layer, other))
for folder in sorted(set(level) - seen):
    errors.append("docs/ARCHITECTURE.md lists %s, but src/%s holds no source" % (folder, folder))
print("\n".join(errors))
sys.exit(1 if errors else 0)
PYTHON
