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
textarea { width: 95%; height: 45vh; background: #222; color: #ddd; font: 13px monospace; }
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
brightest voxel there. The key <b>a</b> adds the cross as a click to the branch.</p>
<p>Two clicks per branch suffice: one near each end, inside the lumen.</p>
<p>Projection <select id="axis"><option value="1">from the front</option><option value="0">from the left</option><option value="2">from
the feet</option></select> of <select id="slab"><option value="0">the whole image</option><option value="40">40 mm around the cross</option><option
value="20">20 mm around the cross</option></select></p>
<p id="place">reading the image</p>
<p><input id="name" value="left_anterior_descending" size="26"><button id="add">add click (a)</button><button id="undo">undo</button></p>
<textarea id="yaml" wrap="off" readonly></textarea><br>
<button id="copy">copy</button><button id="save">save clicks.yaml</button>
</div>
<script>
)html";

/** Script of the page after the data. */
constexpr auto kPageEnd = R"html(
const bytes = Uint8Array.from(atob(data), c => c.charCodeAt(0));
const n = grid.size, cross = n.map(k => k >> 1), clicks = [];
let low = 0, high = 255, zoom = 1;
const at = (i, j, k) => bytes[(k * n[1] + j) * n[0] + i];
// Column and row axis of every view; images show the patient's head up, or the front up in the axial plane.
const layout = [{fixed: 0, column: 1, row: 2, up: true}, {fixed: 1, column: 0, row: 2, up: true},
                {fixed: 2, column: 0, row: 1, up: false}, null];  // the last view is the projection
// Maximal values along the fixed axis of the last view, from first to last, and the place of each.
let projected = "", most = null, depth = null;
function project() {
  const view = layout[3] = layout[Number(document.getElementById("axis").value)], f = view.fixed;
  const slab = Number(document.getElementById("slab").value) / 2, half = slab ? Math.round(slab / grid.spacing[f]) : n[f];
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
      context.strokeStyle = "#fd0"; context.beginPath();
      context.arc(x(click.voxel[view.column]), y(click.voxel[view.row]), 5, 0, 7); context.stroke();
    }
  });
  const p = position(), v = at(cross[0], cross[1], cross[2]);
  document.getElementById("place").textContent = "(" + p.map(c => c.toFixed(1)).join(", ") + ") mm, about " +
    Math.round(grid.window[0] + v / 255 * (grid.window[1] - grid.window[0])) + grid.unit;
}
function yaml() {
  const names = [...new Set(clicks.map(c => c.name))];
  const text = document.getElementById("yaml");
  text.value = "frame: LPS\nunit: 0.001\nbranches:\n" + names.map(name => "  - name: " + name +
    "\n    clicks:\n" + clicks.filter(c => c.name == name).map(c => "      - [" + c.position.map(p => p.toFixed(2)).join(", ") +
    "]  # about " + c.value + grid.unit + "\n").join("")).join("");
  text.scrollTop = text.scrollHeight;
}
function add() {
  const name = document.getElementById("name").value.replace(/[^A-Za-z0-9_.-]/g, "_"), v = at(cross[0], cross[1], cross[2]);
  if (clicks.some(c => c.name == name && c.voxel.join() == cross.join())) {  // the key was pressed twice
    document.getElementById("place").textContent = "this click is already in the list: move the cross to the other end of the branch";
    return;
  }
  clicks.push({name: name, voxel: cross.slice(), position: position(),
               value: Math.round(grid.window[0] + v / 255 * (grid.window[1] - grid.window[0]))});
  yaml(); draw();
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
for (const name of ["axis", "slab"]) document.getElementById(name).onchange = event => { event.target.blur(); draw(); };
document.getElementById("add").onclick = add;
document.getElementById("undo").onclick = () => { clicks.pop(); yaml(); draw(); };
document.onkeydown = event => {
  if (event.target.tagName == "INPUT" || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key == "a") add();
  if (event.key == "+" || event.key == "-") enlarge(event.key == "+");
};
document.getElementById("copy").onclick = () => { const t = document.getElementById("yaml"); t.select(); document.execCommand("copy"); };
document.getElementById("save").onclick = () => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([document.getElementById("yaml").value])); link.download = "clicks.yaml"; link.click();
};
yaml(); draw();
</script></body></html>
)html";

}  // namespace endovascular_sim::segmentation
