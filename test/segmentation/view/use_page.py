#!/usr/bin/env python3
"""Uses the page for clicks in Chromium as an operator does, and prints the clicks that it would save: PAGE.html.

Events of mouse and keys: the wheel leafs to a slice, a press moves the cross, `a` adds a click, `n` leads to the nearest lumen, `u`
undoes. Exit code 1 with a message if the page judges a click wrongly."""
import html
import pathlib
import re
import subprocess
import sys

ACTIONS = """
<pre id="result"></pre>
<script>
const axial = element("v2"), failures = [];
function expect(is, text) { if (!is) failures.push(text + ": " + element("verdict").textContent); }
function press(key) { document.dispatchEvent(new KeyboardEvent("keydown", {key})); }
function type(id, value) { element(id).value = value; element(id).dispatchEvent(new Event("input")); }
function clickAt(position) {
  const relative = position.map((p, a) => p - grid.origin[a]);
  const v = [0, 1, 2].map(k => Math.round([0, 1, 2].reduce((s, a) => s + grid.axes[k][a] * relative[a], 0) / grid.spacing[k]));
  while (cross[2] != v[2]) axial.dispatchEvent(new WheelEvent("wheel", {deltaY: cross[2] < v[2] ? -1 : 1, cancelable: true}));
  const box = axial.getBoundingClientRect(), scale = Math.min(box.width / axial.width, box.height / axial.height), part = region(layout[2]);
  axial.dispatchEvent(new MouseEvent("mousedown", {button: 0,
    clientX: box.left + box.width / 2 + scale * axial.width * ((v[0] + 0.5 - part.column) / part.width - 0.5),
    clientY: box.top + box.height / 2 + scale * axial.height * ((v[1] + 0.5 - part.row) / part.height - 0.5)}));
  return v;
}
const place = clickAt([0, 1, 5]);
expect(cross.join() == place.join(), "the cross is not at the click");
type("name", "größe");
type("radius", "9");
press("a");
expect(element("verdict").className == "" && /lumen about [678][.]. mm wide/.test(element("verdict").textContent), "lumen");
clickAt([0, 9, 5]);
press("a");
expect(element("verdict").className == "fault" && /fat/.test(element("verdict").textContent), "fat");
press("u");
expect(clicks.length == 1, "undo");
press("n");
expect(faultAt(cross) == "", "nearest lumen");
clickAt([0, 2, 8]);
press("a");
expect(/nearer than the lumen is wide/.test(element("verdict").textContent), "close clicks");
press("u");
clickAt([24, 0, 84]);
press("a");
expect(element("verdict").className == "" && /from the click before/.test(element("verdict").textContent), "distance");
element("result").textContent = failures.length ? "FAILURE " + failures.join("; ") : element("yaml").value;
</script>
"""


def main(page):
    text = pathlib.Path(page).read_text(encoding="utf-8")
    at = text.rindex("</body>")
    driven = pathlib.Path(page).with_name("driven.html")
    driven.write_text(text[:at] + ACTIONS + text[at:], encoding="utf-8")
    dom = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,713", "--virtual-time-budget=5000",
                          "--dump-dom", driven.resolve().as_uri()], check=True, capture_output=True, text=True, timeout=120).stdout
    result = html.unescape(re.search(r'<pre id="result">(.*?)</pre>', dom, re.DOTALL).group(1))
    print(result)
    return 1 if not result or result.startswith("FAILURE") else 0


sys.exit(main(*sys.argv[1:]))
