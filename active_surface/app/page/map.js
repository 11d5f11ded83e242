// The map: the plate from above, the surface at the moment of the clock, and over them what follows the hand at once,
// which Plotly is too slow for: the path and what can be dragged.

const NODES = 150, EDGE = 1e-4; // along each side of the drawing of heights, and what belongs to both neighbours
const CLOSEST = 0.02; // of the plate, what is shown around a path at least
const STEP = 0.01, FINE = 0.1; // of the window's width for an arrow key, and of that with Shift
const HEIGHTS = 0; // the number of a trace
const NOWHERE = { x: [], y: [] };
let mapData = null, around = false, dragged = null, aiming = false, target = null;
let nowPath = null, savedPath = null;
let onDrag = () => {}, onDrop = () => {}, onPick = () => {}, onTarget = () => {};

function place([x, y]) { return `(${said(x)}, ${said(y)}) ${mapData.unit}`; }

function perMetre(unit) { return { m: 1, mm: 1e3, "µm": 1e6, "μm": 1e6, um: 1e6, nm: 1e9 }[unit] ?? mapData.perSI; }

function mapAxes() { const { xaxis, yaxis } = element("map")._fullLayout; return [xaxis, yaxis]; }

function mapWidth() { const [low, high] = mapAxes()[0].range; return high - low; }

// What the map shows: all of the plate, or the surroundings of the path and its start.
function rangesOfMap() {
  if (dragged) return mapAxes().map((axis) => axis.range);
  const { box, endless } = mapData, all = [0, 1].map((k) => [box[0][k], box[1][k]]);
  if (!nowPath || !(around || endless)) return all.map((ends) => padded(ends));
  const ends = [[mapData.start, mapData.heading], [[nowPath.x.at(-1), nowPath.y.at(-1)], nowPath.heading]];
  const faces = mapData.face ? ends.flatMap((end) => faceAt(mapData.face, ...end)).flat() : [];
  return ["x", "y"].map((axis, k) => padded([...nowPath[axis], ...(savedPath?.[axis] ?? []), ...faces.map((place) => place[k])], (endless ? 1 : CLOSEST) * (all[0][1] - all[0][0])));
}

// Draw all of the map.
function drawMap() {
  if (!mapData) return;
  const quiet = { hoverinfo: "skip", showlegend: false }, places = mapData.dragged ? [] : mapData.actuators.flat(); // too many to be dragged
  const traces = [
    { ...quiet, type: "heatmap", z: [[]], zsmooth: "fast", showscale: false }, rimTrace(mapData.rim),
    { ...LOOKS.path, ...quiet, ...(savedPath ?? NOWHERE), line: { color: SOFT, width: 1.5 } },
    { ...LOOKS.actuator, ...quiet, ...pairs(places), marker: { symbol: "line-ew-open", size: 3, color: INK } },
  ];
  const layout = planLayout(...rangesOfMap(), mapData.unit, { l: 30, r: 8, t: 8, b: 24 }, { fixedrange: true, exponentformat: "none" });
  Plotly.react("map", traces, { ...layout, dragmode: false, hovermode: false, showlegend: false }, { ...CONFIG, displayModeBar: false });
  if (!element("over").dataset.follows) element("map").on("plotly_afterplot", placeOver);
  element("over").dataset.follows = "map";
  drawPath();
  drawHandles();
  drawHeights();
}

// The path as it is known now.
function drawPath() {
  const { x, y, coarse, exact } = nowPath ?? NOWHERE, last = x.length - 1;
  element("map-box").classList.toggle("coarse", Boolean(nowPath && !exact));
  element("path-line").classList.toggle("coarse", Boolean(coarse?.length));
  element("path-line").setAttribute("points", Array.from(x, (c, k) => `${c},${-y[k]}`).join(" "));
  element("end").hidden = last < 0;
  if (!exact) element("here").hidden = true;
  if (last >= 0) put(element("end"), [x[last], y[last]], nowPath.heading);
}

// Where parts go: arrows, dots where they stay and + where they are lost; nothing: none.
function drawDrift({ arrows, still, lost }) {
  const places = (packed) => { const { x, y } = packed ? pairs(unpack(packed)) : NOWHERE; return Array.from(x, (c, k) => [c, -y[k]]); };
  const size = mapWidth() / 150, dots = (list, mark) => list.map(([x, y]) => `M${x},${y}${mark}`).join("");
  const lines = [], ends = places(arrows);
  for (let k = 0; k < ends.length; k += 2) {
    const [[a, b], [x, y]] = ends.slice(k, k + 2), [u, v] = [(x - a) / 4, (y - b) / 4];
    lines.push(`M${a},${b}L${x},${y}M${x - u - v / 1.5},${y - v + u / 1.5}L${x},${y}L${x - u + v / 1.5},${y - v - u / 1.5}`);
  }
  element("drift-arrows").setAttribute("d", lines.join(""));
  element("drift-still").setAttribute("d", dots(places(still), "h0"));
  element("drift-lost").setAttribute("d", dots(places(lost), `m${-size},0h${2 * size}m${-size},${-size}v${2 * size}`));
  element("drift-layer").classList.remove("old");
}

// The surface at the moment of the clock, and the part there.
function drawHeights(step = shown) {
  const blank = !pageData || !mapData || !nowPath?.exact;
  element("shades").hidden = element("here").hidden = blank;
  if (blank) return;
  const ranges = mapAxes().map((axis) => axis.range), ratio = mapData.perSI / perMetre(units.length), [low, high] = surface.range;
  if (surface.frame !== ranges.join()) Object.assign(surface, { frame: ranges.join(), nodes: nodesIn(...ranges, ratio) });
  const { nodes } = surface, z = heightsAt(step), [left, right] = ranges[0], [bottom, top] = ranges[1];
  const rows = Array.from({ length: NODES }, (_, row) => Array.from({ length: NODES }, (_, k) => nodes.on[row * NODES + k] ? valueAt(nodes, row * NODES + k, z) : null));
  element("shades-bar").style.background = `linear-gradient(to right, ${surface.colours.map(([at, colour]) => `${colour} ${100 * at}%`).join(", ")})`;
  element("shades-range").textContent = `height, ${said(low)} to ${said(high)} ${units.height}`;
  Plotly.restyle("map", { z: [rows], zmin: low, zmax: high > low ? high : low + 1, colorscale: [surface.colours],
    x0: left, dx: (right - left) / (NODES - 1), y0: bottom, dy: (top - bottom) / (NODES - 1) }, [HEIGHTS]);
  put(element("here"), [part.x[step] * ratio, part.y[step] * ratio], part.heading?.[step]);
}

// Nodes of a grid in the frame: which are on the surface, the corners of their triangles, and the weights of these.
function nodesIn([left, right], [bottom, top], ratio) {
  const u = Float32Array.from(surface.x, (x) => (x * ratio - left) / (right - left) * (NODES - 1));
  const v = Float32Array.from(surface.y, (y) => (y * ratio - bottom) / (top - bottom) * (NODES - 1));
  const on = new Uint8Array(NODES ** 2), corners = new Uint16Array(3 * NODES ** 2), weights = new Float32Array(2 * NODES ** 2);
  const span = (...ends) => [Math.max(0, Math.floor(Math.min(...ends))), Math.min(NODES - 1, Math.ceil(Math.max(...ends)))];
  for (let k = 0; k < surface.triangles.length; k += 3) {
    const triangle = surface.triangles.subarray(k, k + 3), [a, b, c] = triangle;
    const area = (u[b] - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (v[b] - v[a]);
    const [first, last] = span(v[a], v[b], v[c]), [from, to] = span(u[a], u[b], u[c]);
    for (let row = first; area && row <= last; row++) {
      for (let column = from; column <= to; column++) {
        const second = ((column - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (row - v[a])) / area;
        const third = ((u[b] - u[a]) * (row - v[a]) - (column - u[a]) * (v[b] - v[a])) / area;
        if (second < -EDGE || third < -EDGE || second + third > 1 + EDGE) continue;
        const node = row * NODES + column;
        on[node] = 1;
        corners.set(triangle, 3 * node);
        weights.set([second, third], 2 * node);
      }
    }
  }
  return { on, corners, weights };
}

function drawHandles() {
  const focused = document.activeElement?.dataset.key;
  const made = mapData.dragged ? mapData.actuators.map((at, k) => handle("actuator", `Actuator ${k}`, at, k)) : [];
  made.push(handle("start", "Start of the part", mapData.start));
  if (target) made.push(handle("target", "Target", target));
  element("handles").replaceChildren(...made);
  placeOver();
  if (focused) handleOf(focused)?.focus();
}

// Bring what lies over the plot to where it belongs.
function placeOver() {
  const [x, y] = mapAxes(), [left, right] = x.range, [bottom, top] = y.range;
  Object.assign(element("over").style, { left: `${x._offset}px`, width: `${x._length}px`, top: `${y._offset}px`, height: `${y._length}px` });
  element("path-now").setAttribute("viewBox", `${left} ${-top} ${right - left} ${top - bottom}`);
  for (const one of [element("end"), element("here"), ...element("handles").children]) if (one.place) put(one, one.place);
}

// Start, end and the part have outlines where the part has a face, turned by a heading [rad].
function put(group, [x, y], heading = group.heading) {
  const [across, up] = mapAxes(), lines = mapData.face ? faceAt(mapData.face, [x, y], heading) : [];
  Object.assign(group, { place: [x, y], heading });
  Object.assign(group.style, { left: `${across.l2p(x)}px`, top: `${up.l2p(y)}px` });
  element(`${group.dataset.key ?? group.id}-face`)?.setAttribute("d", lines.map((line) => `M${line.map(([a, b]) => `${a},${-b}`).join("L")}`).join(""));
}

// Bring what can be dragged, and is not, back to where the case has it.
function settleHandles() { for (const group of element("handles").querySelectorAll(".start, .actuator")) put(group, group.home, mapData.heading); }

// Have the handle at a place follow a field of that place, or the start's outline its heading; the text is a number of a unit.
function placeHandle({ path, unit }, text) {
  if (path === "part.heading") put(handleOf("start"), handleOf("start").place, Number.parseFloat(text) * Math.PI / 180);
  const [, owner, axis] = /^(part|actuators\.\d+)\.position\.([01])$/.exec(path) ?? [];
  const group = owner && handleOf(owner === "part" ? "start" : owner.replace("s.", " "));
  if (!group) return;
  const to = [...group.place];
  to[axis] = Number.parseFloat(text) * mapData.perSI / perMetre(unit);
  put(group, to);
}

function handleOf(key) { return element("handles").querySelector(`[data-key="${key}"]`); }

function handle(kind, name, at, number = null) {
  const keys = kind === "target" ? "Arrow keys move it, Enter starts the search." : "Arrow keys move it.";
  const group = Object.assign(document.createElement("button"), { type: "button", className: `handle ${kind}`, textContent: number ?? "", place: at, home: at, heading: mapData.heading });
  group.setAttribute("aria-label", `${name} at ${place(at)}. ${keys}`);
  group.dataset.key = number === null ? kind : `${kind} ${number}`;
  group.classList.toggle("selected", number !== null && ["*", String(number)].includes(mapData.selected));
  const what = { kind, number, group, at: [...at], moved: [false, false] };
  group.addEventListener("pointerdown", (event) => grab(event, what));
  group.addEventListener("keydown", (event) => nudge(event, what));
  group.addEventListener("focus", () => {
    if (kind !== "actuator" || dragged) return;
    for (const other of element("handles").children) other.classList.toggle("selected", other === group);
    if (String(number) !== mapData.selected) onPick(number);
  });
  return group;
}

function move(what, to) {
  what.moved = what.moved.map((so, k) => so || to[k] !== what.group.place[k]);
  what.at = to;
  put(what.group, to);
}

// Where a pointer is on the map.
function placeOf(event) {
  const box = element("map").getBoundingClientRect(), [x, y] = mapAxes();
  return [x.p2l(event.clientX - box.left - x._offset), y.p2l(event.clientY - box.top - y._offset)];
}

function grab(event, what) {
  if (aiming || event.button) return;
  event.preventDefault();
  what.group.focus();
  const from = placeOf(event), began = what.group.place;
  dragged = what;
  what.group.setPointerCapture(event.pointerId);
  const follow = (moved) => {
    const to = placeOf(moved);
    move(what, began.map((c, k) => c + to[k] - from[k]));
    onDrag(what, moved.timeStamp);
  };
  const drop = () => {
    what.group.removeEventListener("pointermove", follow);
    dragged = null;
    if (what.moved.some(Boolean)) onDrop(what);
  };
  what.group.addEventListener("pointermove", follow);
  what.group.addEventListener("lostpointercapture", drop, { once: true }); // however it ends
}

let nudging = null;
function nudge(event, what) {
  if (what.kind === "target" && event.key === "Enter") { onTarget(target); return; }
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  const step = STEP * (event.shiftKey ? FINE : 1) * mapWidth();
  move(what, way.map((c, k) => what.group.place[k] + c * step));
  if (what.kind === "target") { target = what.at; return; }
  onDrag(what, event.timeStamp);
  clearTimeout(nudging);
  nudging = setTimeout(() => onDrop(what), 350);
}

element("map-box").addEventListener("pointerdown", (event) => {
  if (!aiming || !mapData || event.button) return;
  event.preventDefault();
  onTarget(placeOf(event));
});
