#pragma once

namespace endovascular_sim::segmentation
{

/** HTML of the page before the data. */
constexpr auto kPageBegin = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Clicks into the lumen</title><style>
body { margin: 0; background: #181818; color: #ddd; font: 14px sans-serif; }
#views { display: grid; grid-template-columns: 1fr 1fr; gap: 4px; width: 66%; float: left; }
#views div { position: relative; background: #000; height: 49vh; }
canvas { width: 100%; height: 100%; object-fit: contain; cursor: crosshair; }
#views span { position: absolute; left: 6px; top: 4px; pointer-events: none; text-shadow: 0 0 3px #000; }
#side { margin-left: 67%; padding: 8px; }
#verdict { min-height: 2.4em; margin: 4px 0; color: #8d8; }
#verdict.fault { color: #f96; }
textarea { width: 95%; height: 34vh; background: #222; color: #ddd; font: 13px monospace; }
button, input { font-size: 14px; margin: 3px 3px 3px 0; padding: 3px 8px; }
</style></head><body>
<div id="views">
<div><canvas id="v2"></canvas><span>axial: patient's right on the left</span></div>
<div><canvas id="v1"></canvas><span>coronal, from the front</span></div>
<div><canvas id="v0"></canvas><span>sagittal, from the left</span></div>
<div><canvas id="v3"></canvas><span>projection of maximal values</span></div>
</div>
<div id="side">
<p>Click a plane to move the cross, turn the wheel to leaf through, drag with the right button to set brightness and contrast.
Shift and wheel, or the keys <b>+</b> and <b>-</b>, enlarge the surroundings of the cross. A click into the projection goes to the
brightest voxel there. Keys: <b>a</b> adds the cross as a click to the branch, <b>u</b> undoes the last click, <b>n</b> moves the cross to
the nearest lumen.</p>
<p>Two clicks per branch suffice: one near each end, inside the lumen. Give a largest radius only where a branch widens to more than
1.6 times its lumen at the clicks, e.g. in an aneurysm.</p>
<p>Projection <select id="axis"><option value="1">from the front</option><option value="0">from the left</option><option value="2">from
the feet</option></select> of <select id="slab"><option value="40">40 mm around the cross</option><option value="20">20 mm around the cross</option><option
value="0">the whole image</option></select></p>
<p id="place">reading the image</p>
<p>Branch <input id="name" value="left_anterior_descending" size="20" list="names"><datalist id="names"></datalist>
radius up to <input id="radius" type="number" min="0.5" max="100" step="0.5" placeholder="by clicks" style="width: 5em"> mm</p>
<p><button id="add">add click (a)</button><button id="undo">undo (u)</button><button id="nearest">nearest lumen (n)</button></p>
<p id="verdict"></p>
<textarea id="yaml" wrap="off" readonly></textarea><br>
<button id="copy">copy</button><button id="save">save clicks.yaml</button>
</div>
<script>
)html";

/** Beginning of the script, after the data. */
constexpr auto kPageImage = R"html(
const bytes = Uint8Array.from(atob(data), c => c.charCodeAt(0));
const n = grid.size, cross = n.map(k => k >> 1), clicks = [], radii = new Map();
let low = 0, high = 255, zoom = 1;
const at = (i, j, k) => bytes[(k * n[1] + j) * n[0] + i];
)html";

/** Script of the views and of the clicks. */
constexpr auto kPageEnd = R"html(
const element = id => document.getElementById(id);
// Column and row axis of every view; images show the patient's head up, or the front up in the axial plane.
const layout = [{fixed: 0, column: 1, row: 2, up: true}, {fixed: 1, column: 0, row: 2, up: true},
                {fixed: 2, column: 0, row: 1, up: false}, null];  // the last view is the projection
// Maximal values along the fixed axis of the last view, from first to last, and the place of each.
let projected = "", most = null, depth = null;
function project() {
  const view = layout[3] = layout[Number(element("axis").value)], f = view.fixed;
  const slab = Number(element("slab").value) / 2, half = slab ? Math.round(slab / grid.spacing[f]) : n[f];
  const first = Math.max(0, cross[f] - half), last = Math.min(n[f] - 1, cross[f] + half), q = [0, 0, 0];
  if (projected == [f, first, last].join()) return;
  projected = [f, first, last].join();
  most = new Uint8Array(n[view.column] * n[view.row]); depth = new Uint16Array(most.length);
  for (q[2] = f == 2 ? first : 0; q[2] < (f == 2 ? last + 1 : n[2]); q[2]++)
    for (q[1] = f == 1 ? first : 0; q[1] < (f == 1 ? last + 1 : n[1]); q[1]++)
      for (q[0] = f == 0 ? first : 0; q[0] < (f == 0 ? last + 1 : n[0]); q[0]++) {
        const v = at(q[0], q[1], q[2]), p = q[view.row] * n[view.column] + q[view.column];
        if (v > most[p]) { most[p] = v; depth[p] = q[f]; }
      }
}
// Part of a view that is shown: first column and row, and their numbers; it contains the cross.
function region(view) {
  const w = n[view.column], h = n[view.row], width = w / zoom, height = h / zoom;
  const clamp = (v, most) => Math.max(0, Math.min(most, v));
  const row = view.up ? h - 1 - cross[view.row] : cross[view.row];
  return {column: clamp(cross[view.column] + 0.5 - width / 2, w - width), row: clamp(row + 0.5 - height / 2, h - height), width, height};
}
function position() {
  return [0, 1, 2].map(a => grid.origin[a] + [0, 1, 2].reduce((s, k) => s + grid.axes[k][a] * grid.spacing[k] * cross[k], 0));
}
function draw() {
  project();
  layout.forEach((view, number) => {
    const canvas = document.getElementById("v" + number), w = n[view.column], h = n[view.row];
    const stretch = grid.spacing[view.row] / grid.spacing[view.column], scale = Math.max(1, Math.round(600 / Math.max(w, h * stretch)));
    const W = w * scale, H = Math.round(h * scale * stretch);
    canvas.width = W; canvas.height = H;
    const context = canvas.getContext("2d"), small = new ImageData(w, h), q = cross.slice();
    for (let r = 0; r < h; r++) for (let c = 0; c < w; c++) {
      q[view.column] = c; q[view.row] = view.up ? h - 1 - r : r;
      const raw = number == 3 ? most[q[view.row] * w + q[view.column]] : at(q[0], q[1], q[2]);
      const v = 255 * (raw - low) / (high - low), p = 4 * (r * w + c);
      small.data[p] = small.data[p + 1] = small.data[p + 2] = v; small.data[p + 3] = 255;
    }
    const buffer = document.createElement("canvas");
    buffer.width = w; buffer.height = h; buffer.getContext("2d").putImageData(small, 0, 0);
    const part = region(view);
    context.imageSmoothingEnabled = true;
    context.drawImage(buffer, part.column, part.row, part.width, part.height, 0, 0, W, H);
    const x = v => (v + 0.5 - part.column) * W / part.width;
    const y = v => ((view.up ? h - 0.5 - v : v + 0.5) - part.row) * H / part.height;
    context.strokeStyle = "#0af8"; context.beginPath();
    context.moveTo(x(cross[view.column]), 0); context.lineTo(x(cross[view.column]), H);
    context.moveTo(0, y(cross[view.row])); context.lineTo(W, y(cross[view.row])); context.stroke();
    for (const click of clicks) {
      const off = Math.abs(click.voxel[view.fixed] - cross[view.fixed]);
      if (number != 3 && off > 3) continue;
      context.strokeStyle = click.fault ? "#f42" : "#fd0"; context.beginPath();
      context.arc(x(click.voxel[view.column]), y(click.voxel[view.row]), 5, 0, 7); context.stroke();
    }
  });
  describe();
}
// Place, value and width at the cross; in the lumen also the distance from the last click of the branch.
function describe() {
  const p = position(), fault = faultAt(cross), last = clicks.filter(c => c.name == branchName()).pop();
  element("place").textContent = "(" + p.map(c => c.toFixed(1)).join(", ") + ") mm, about " + Math.round(valueAt(cross)) + grid.unit +
    (fault ? ": " + fault : ", lumen about " + widthAt(cross).toFixed(1) + " mm wide") +
    (last && last.voxel.join() != cross.join() ? ", " + distance(p, last.position).toFixed(1) + " mm from the last click" : "");
}
function tell(text, isFault) { element("verdict").textContent = text; element("verdict").className = isFault ? "fault" : ""; }
// Name of the branch: letters of any script, digits, _, - and .
function branchName() { return element("name").value.replace(/[\x00-\x7f]/g, c => /[A-Za-z0-9_.-]/.test(c) ? c : "_") || "_"; }
const written = name => /^[A-Za-z_][A-Za-z0-9_-]*$/.test(name) && !/^(true|false|yes|no|on|off|null|y|n)$/i.test(name) ? name : '"' + name + '"';
function yaml() {
  const names = [...new Set(clicks.map(c => c.name))], text = element("yaml");
  text.value = "frame: LPS\nunit: 0.001\nbranches:\n" + names.map(name => "  - name: " + written(name) +
    (radii.has(name) ? "\n    largest_radius: " + radii.get(name) : "") +
    "\n    clicks:\n" + clicks.filter(c => c.name == name).map(c => "      - [" + c.position.map(p => p.toFixed(2)).join(", ") +
    "]  # about " + c.value + grid.unit + (c.fault ? ": " + c.fault : "") + "\n").join("")).join("");
  text.scrollTop = text.scrollHeight;
  element("names").replaceChildren(...names.map(name => new Option(name, name)));
}
// Judges the newest click: its tissue, its distance from the one before it in the branch, and the widths of the lumen at both.
function judge(click) {
  const own = clicks.filter(c => c.name == click.name), before = own[own.length - 2];
  const about = click.name + ", click " + own.length + ": about " + click.value + grid.unit + ", ";
  if (click.fault)
    return tell(about + click.fault + ". Undo it (u); the key n moves the cross to the nearest lumen.", true);
  const away = before ? distance(click.position, before.position) : 0;
  const text = about + "lumen about " + click.width.toFixed(1) + " mm wide" + (before ? ", " + away.toFixed(1) + " mm from the click before" : "");
  if (before && away < Math.min(click.width, before.width))
    return tell(text + ": nearer than the lumen is wide. Click near the other end of the branch.", true);
  const widest = before ? Math.max(click.width, before.width) : 0;
  if (widest > 10 && widest > 3 * Math.min(click.width, before.width))
    return tell(text + ", " + before.width.toFixed(1) + " mm there. If the branch itself is so wide, give its largest radius, e.g. " +
      Math.ceil(0.8 * widest) + " mm.", true);
  tell(text + ".", false);
}
function add() {
  const name = branchName();
  if (clicks.some(c => c.name == name && c.voxel.join() == cross.join()))  // the key was pressed twice
    return tell("This click is already in the list: move the cross to the other end of the branch.", true);
  const click = {name, voxel: cross.slice(), position: position(), value: Math.round(valueAt(cross)), width: widthAt(cross), fault: faultAt(cross)};
  clicks.push(click); judge(click); yaml(); draw();
}
function undo() {
  const click = clicks.pop();
  if (!click) return;
  click.voxel.forEach((k, a) => { cross[a] = k; });
  if (!clicks.some(c => c.name == click.name)) radii.delete(click.name);
  element("name").value = click.name; element("radius").value = radii.get(click.name) || "";
  tell("Removed the last click of " + click.name + "; the cross stands there.", false); yaml(); draw();
}
function toNearestLumen() {
  const found = nearestLumen(cross);
  if (!found) return tell("There is no lumen within 10 mm.", true);
  found.forEach((k, a) => { cross[a] = k; });
  tell("", false); draw();
}
[0, 1, 2, 3].forEach(number => {
  const canvas = document.getElementById("v" + number);
  const place = (event, view) => {
    const box = canvas.getBoundingClientRect(), scale = Math.min(box.width / canvas.width, box.height / canvas.height);
    const x = (event.clientX - box.left - (box.width - scale * canvas.width) / 2) / (scale * canvas.width);
    const y = (event.clientY - box.top - (box.height - scale * canvas.height) / 2) / (scale * canvas.height);
    const part = region(view), clamp = (v, m) => Math.max(0, Math.min(m - 1, Math.floor(v)));
    const column = clamp(part.column + x * part.width, n[view.column]), row = clamp(part.row + y * part.height, n[view.row]);
    return [column, view.up ? n[view.row] - 1 - row : row];
  };
  canvas.onmousedown = event => {
    if (event.button != 0) return;
    const view = layout[number];
    [cross[view.column], cross[view.row]] = place(event, view);
    if (number == 3) cross[view.fixed] = depth[cross[view.row] * n[view.column] + cross[view.column]];
    draw();
  };
  canvas.onmousemove = event => {
    if (event.buttons != 2) return;
    low += event.movementY / 2 - event.movementX / 4; high = Math.max(low + 8, high + event.movementY / 2 + event.movementX / 4); draw();
  };
  canvas.oncontextmenu = event => event.preventDefault();
  canvas.onwheel = event => {
    event.preventDefault();
    if (event.shiftKey) return enlarge((event.deltaY || event.deltaX) < 0);
    const view = layout[number];
    cross[view.fixed] = Math.max(0, Math.min(n[view.fixed] - 1, cross[view.fixed] + (event.deltaY > 0 ? -1 : 1))); draw();
  };
});
function enlarge(more) { zoom = Math.max(1, Math.min(8, more ? zoom * 1.5 : zoom / 1.5)); draw(); }
for (const name of ["axis", "slab"]) element(name).onchange = event => { event.target.blur(); draw(); };
element("name").oninput = () => { element("radius").value = radii.get(branchName()) || ""; describe(); };
element("radius").oninput = event => {
  if (Number(event.target.value) > 0) radii.set(branchName(), Number(event.target.value)); else radii.delete(branchName());
  yaml();
};
element("add").onclick = add;
element("undo").onclick = undo;
element("nearest").onclick = toNearestLumen;
document.onkeydown = event => {
  if (event.target.tagName == "INPUT" || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key == "a") add();
  if (event.key == "u") undo();
  if (event.key == "n") toNearestLumen();
  if (event.key == "+" || event.key == "-") enlarge(event.key == "+");
};
element("copy").onclick = () => { const t = element("yaml"); t.select(); document.execCommand("copy"); };
element("save").onclick = () => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([element("yaml").value])); link.download = "clicks.yaml"; link.click();
};
yaml(); draw();
</script></body></html>
)html";

}  // namespace endovascular_sim::segmentation
