#pragma once

namespace endovascular_sim::segmentation
{

/** Script of the page that judges places as vessel_segment judges clicks: by the values and limits of `grid.contrast`.
 */
constexpr auto kPageLumen = R"html(
const isCt = grid.unit == " HU", limits = grid.contrast;
const physical = raw => grid.window[0] + raw / 255 * (grid.window[1] - grid.window[0]);
const offset = (v, d) => v.map((k, a) => Math.max(0, Math.min(n[a] - 1, k + d[a])));
const axes6 = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
// Value of the lumen at a voxel: the third brightest of the voxel and its six neighbours.
function valueAt(v) {
  return physical([v, ...axes6.map(d => offset(v, d))].map(q => at(q[0], q[1], q[2])).sort((a, b) => b - a)[2]);
}
// Value around the lumen: that of soft tissue in a CT, else the darker third of a cube of 10 mm.
function backgroundAt(v) {
  if (isCt) return limits.soft;
  const values = [];
  for (let c = -2; c <= 2; c++) for (let b = -2; b <= 2; b++) for (let a = -2; a <= 2; a++) {
    const q = offset(v, [a, b, c].map((k, axis) => Math.round(2.5 * k / grid.spacing[axis])));
    values.push(physical(at(q[0], q[1], q[2])));
  }
  return values.sort((a, b) => a - b)[37];
}
// Shortest chord through a voxel in 13 directions, in mm; at most 80.
function widthAt(v) {
  const least = (valueAt(v) + backgroundAt(v)) / 2, step = Math.min(...grid.spacing) / 2;
  const reach = d => {
    const u = d.map((k, a) => k / Math.hypot(...d) / grid.spacing[a]);
    let s = 0;
    for (; s < 40; s += step) {
      const q = v.map((k, a) => Math.round(k + s * u[a]));
      if (q.some((k, a) => k < 0 || k >= n[a]) || physical(at(q[0], q[1], q[2])) < least) break;
    }
    return s;
  };
  let shortest = 80;
  for (let k = 14; k < 27; k++) {
    const d = [k % 3 - 1, Math.floor(k / 3) % 3 - 1, Math.floor(k / 9) - 1];
    shortest = Math.min(shortest, reach(d) + reach(d.map(c => -c)));
  }
  return shortest;
}
// Value of the lumen at the clicks that lie in one; undefined without any.
function reference() {
  const values = clicks.filter(c => !c.fault).map(c => c.value).sort((a, b) => a - b);
  return values[values.length >> 1];
}
// Reason why a place is not in the lumen; empty in the lumen.
function faultAt(v) {
  const value = valueAt(v), lumen = reference();
  if (!isCt) return value < 1.3 * backgroundAt(v) ? "not brighter than its surroundings" : "";
  const tissue = limits.tissues.find(t => value < t.below);
  if (tissue) return tissue.name;
  if (lumen !== undefined && value < limits.soft + limits.onWall * (lumen - limits.soft))
    return "the wall: the other clicks have about " + Math.round(lumen) + grid.unit;
  return value > limits.most ? limits.brightest : "";
}
// Nearest voxel within 10 mm that lies in the lumen, with its neighbours; null without any.
function nearestLumen(v) {
  const lumen = reference() || (isCt ? 350 : physical(200)), base = isCt ? limits.soft : 0, reach = grid.spacing.map(s => Math.floor(10 / s));
  const least = base + limits.inLumen * (lumen - base), most = isCt ? Math.min(limits.most, 1.5 * lumen) : Infinity;
  let best = null, shortest = 10;
  for (let k = -reach[2]; k <= reach[2]; k++) for (let j = -reach[1]; j <= reach[1]; j++) for (let i = -reach[0]; i <= reach[0]; i++) {
    const away = Math.hypot(i * grid.spacing[0], j * grid.spacing[1], k * grid.spacing[2]), q = [v[0] + i, v[1] + j, v[2] + k];
    if (away >= shortest || q.some((c, a) => c < 1 || c >= n[a] - 1)) continue;
    if ([q, ...axes6.map(d => offset(q, d))].every(w => { const h = physical(at(w[0], w[1], w[2])); return h >= least && h <= most; })) {
      best = q; shortest = away;
    }
  }
  return best;
}
)html";

}  // namespace endovascular_sim::segmentation
