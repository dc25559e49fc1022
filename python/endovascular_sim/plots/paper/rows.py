"""All rows, in the order of the paper."""

from .row import Row


def _of(module, function):
    """Measurement that is imported when it runs: the table and the page need no compiled part."""
    def measure(folder):
        import importlib
        return getattr(importlib.import_module("." + module, __package__), function)(folder)
    return measure


ROWS = [
    Row("fig1", "Fig. 1", "Diagram: vascular model, guidewire simulation, device, 3D and X-ray view", True,
        _of("system", "nodes_of_the_graph"), "figures/layers.svg", "Every part has a node of the graph"),
    Row("fig2", "Fig. 2", "Drawing: curve γ(s) with the material frame (d1, d2, d3)", True,
        _of("framed_curve", "frame_of_the_tip"), "images/paper_fig2.png",
        "The frame is orthonormal, its first axis is the tangent, called d3 in the rod of Bergou et al."),
    Row("fig3", "Fig. 3", "Drawing: curve divided into n + 1 segments", True,
        _of("framed_curve", "segments"), "images/paper_fig3.png", "Segments keep their lengths to the tolerance of the solver"),
    Row("fig4", "Fig. 4", "Drawing: parallel transport of the frame, rotation of the wire", True,
        _of("framed_curve", "rest_curvature"), "images/paper_fig4.png", "The rest curvature turns with the handle, without loss"),
    Row("fig5", "Fig. 5", "Drawing: two edges merge into one; an edge is divided into two", True,
        _of("sampling", "merging_and_splitting"), "images/paper_fig5.png", "Edges are divided in the bend and merged behind it"),
    Row("fig6", "Fig. 6", "Photograph of the workstation with its device", True, None, "images/rviz.png",
        "Nothing is measured in it; the same views on a screen, and a simulated device"),
    Row("fig7", "Fig. 7", "Straight, angled and semicircular tip in a vessel", False,
        _of("insertion", "tip_shapes"), "images/tips.png", "All three are inserted; the shape selects the branch"),
    Row("fig8", "Fig. 8", "Wire in a coronary artery with 142, 88 and 75 nodes", True,
        _of("sampling", "samplings"), "images/paper_fig8.png",
        "Node numbers as in the paper, errors equal within a tenth of the wire's radius; the gain of time is smaller"),
    Row("fig9", "Fig. 9", "Coronary intervention from the femoral artery to the stent", False,
        _of("insertion", "intervention"), "images/pci_phases.jpg", "All phases, by a scripted operator"),
    Row("fig10", "Fig. 10", "Charts of the feedback by speed, modulus, twist and tip", False,
        _of("feedback", "charts"), "validation/hand_force.png", "One of twelve orderings; the others contradict the balance of forces, see below"),
    Row("fig11", "Fig. 11", "Completion times of three groups of persons", True, None, "",
        "Not reproducible without persons, see below"),
    Row("table1", "Table 1", "Computing time for 100 to 380 nodes", False,
        _of("speed", "computing_time"), "validation/speed.png", "Linear as in the paper, and faster"),
]


def row_of(name):
    """Row by its name."""
    return next(row for row in ROWS if row.name == name)
