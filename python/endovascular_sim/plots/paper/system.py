"""Fig. 1: parts of the system, as nodes of the graph."""

import subprocess

from .. import command
from .row import Measurement

# Parts of the paper's overview, and the nodes that have their tasks.
PARTS = {"vascular model": ["vessel_server"], "collision detection": ["contact"], "guidewire simulation": ["rod_dynamics"],
         "device with sensors and forces": ["haptic_device"], "X-ray image": ["fluoroscopy"]}


def nodes_of_the_graph(folder):
    """Nodes that the scene `demo` needs. The 3D view is rviz, which a launch file adds."""
    del folder
    program = command.programs_folder() / "scene_check"
    output = subprocess.run([str(program), str(command.find_scene("demo.yaml")), "--nodes"], stdout=subprocess.PIPE, check=True,
                            universal_newlines=True).stdout.split()
    missing = [part for part, nodes in PARTS.items() if not set(nodes) <= set(output)]
    return [Measurement("parts of the overview with a node", ", ".join(PARTS), "all" if not missing else "without " + ", ".join(missing),
                        "all", not missing, not missing)]
