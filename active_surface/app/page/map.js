// The map: the plate from above with what can be dragged, the path, and the surface at the moment of the clock.

const SVG = "http://www.w3.org/2000/svg";
const GRIP = { actuator: 7, start: 7, touch: 16 }; // pixels, half of a side
const COARSE = 2, SHADES = 256, EDGE = 1e-4; // pixels of the page to one of the shade, its steps, and what belongs to both neighbours
const CLOSEST = 0.02; // of the plate, what is shown around a path at least
const STEP = 0.01, FINE = 0.1; // of the window's width for an arrow key, and of that with Shift
let mapData = null, frameBox = null, around = false, dragged = null, aiming = false, target = null;
let nowPath = null, savedPath = null;
let onDrag = () => {}, onDrop = () => {}, onPick = () => {}, onTarget = () => {};

function svg(name, attributes = {}, parent = null) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent?.append(made);
  return made;
}

function pairs(packed) {
  const numbers = unpack(packed), points = [];
  for (let k = 0; k < numbers.length; k += 2) points.push([numbers[k], numbers[k + 1]]);
  return points;
}

function pointsOf(line) { return line.map(([x, y]) => `${x},${-y}`).join(" "); }

// One pixel in the unit of the map.
function pixel() {
  const { clientWidth, clientHeight } = element("map-box"), [low, high] = frameBox;
  return Math.max((high[0] - low[0]) / clientWidth, (high[1] - low[1]) / clientHeight);
}

// What the map shows: all of the plate, or the surroundings of the path and its start.
function chooseFrame() {
  const box = mapData.box, room = 0.06 * Math.max(box[1][0] - box[0][0], box[1][1] - box[0][1]);
  frameBox = [box[0].map((c) => c - room), box[1].map((c) => c + room)];
  if (!nowPath || !(around || mapData.endless)) return;
  const points = [...nowPath.points, ...(savedPath?.points ?? [])];
  const lows = [0, 1].map((k) => points.reduce((low, p) => Math.min(low, p[k]), Infinity));
  const highs = [0, 1].map((k) => points.reduce((high, p) => Math.max(high, p[k]), -Infinity));
  const size = Math.max(highs[0] - lows[0], highs[1] - lows[1], (mapData.endless ? 1 : CLOSEST) * (box[1][0] - box[0][0]));
  const middle = [0, 1].map((k) => (lows[k] + highs[k]) / 2);
  frameBox = [middle.map((c) => c - 0.7 * size), middle.map((c) => c + 0.7 * size)];
}

// Draw all of the map.
function drawMap() {
  if (!mapData) return;
  if (!dragged) chooseFrame();
  const [low, high] = frameBox, map = element("map"), px = pixel();
  map.setAttribute("viewBox", `${low[0]} ${-high[1]} ${high[0] - low[0]} ${high[1] - low[1]}`);
  map.replaceChildren();
  for (const curve of mapData.rim) svg("polyline", { class: "rim", points: pointsOf(pairs(curve)) }, map);
  if (savedPath) svg("polyline", { class: "before", points: pointsOf(savedPath.points) }, map);
  svg("polyline", { class: "path", id: "path-line" }, map);
  svg("path", { class: "end", id: "path-end" }, map);
  drawActuators(map, px);
  handle(map, "start", mapData.start, px, `Start of the part at ${place(mapData.start)}`);
  if (target) drawTarget(map, px);
  svg("circle", { class: "part", id: "map-part", r: 6 * px, visibility: "hidden" }, map);
  drawScale(px);
  drawPath();
  drawHeights();
}

// Bring what can be held, and is not, back to where the case has it.
function settleHandles() {
  for (const group of element("map").querySelectorAll(".handle")) {
    const [kind, number] = (group.dataset.key ?? "").split(" ");
    if (kind === "start") put(group, mapData.start);
    if (kind === "actuator") put(group, mapData.actuators[Number(number)]);
  }
}

// Have the handle at a place follow a field of that place, whose text is a number of a unit.
function placeHandle({ path, unit }, text) {
  const [, owner, axis] = /^(part|actuators\.\d+)\.position\.([01])$/.exec(path) ?? [];
  const group = owner && element("map").querySelector(`[data-key="${owner === "part" ? "start" : owner.replace("s.", " ")}"]`);
  if (!group) return;
  const to = [...group.place];
  to[axis] = Number.parseFloat(text) * mapData.perSI / perMetre(unit);
  put(group, to);
}

function place([x, y]) { return `(${said(x)}, ${said(y)}) ${mapData.unit}`; }

function drawActuators(map, px) {
  if (!mapData.dragged) { // too many to be held
    const dots = mapData.actuators.map(([x, y]) => `M${x - px},${-y}h${2 * px}`).join("");
    svg("path", { class: "bar-line", d: dots }, map);
    return;
  }
  mapData.actuators.forEach((at, k) => handle(map, "actuator", at, px, `Actuator ${k} at ${place(at)}`, k));
}

function handle(map, kind, at, px, label, number = null) {
  const group = svg("g", { class: `handle ${kind}`, tabindex: 0, role: "button", "aria-label": `${label}. Arrow keys move it.` }, map);
  const size = GRIP[kind] * px;
  svg("circle", { class: "touch", r: GRIP.touch * px }, group);
  if (kind === "start") svg("circle", { class: "grip", r: size }, group);
  else {
    svg("rect", { x: -size, y: -size, width: 2 * size, height: 2 * size }, group);
    svg("text", { y: -1.5 * size, "font-size": 13 * px }, group).textContent = number;
    if (String(number) === mapData.selected || mapData.selected === "*") group.classList.add("selected");
  }
  put(group, at);
  const what = { kind, number, group, at: [...at], moved: [false, false] };
  group.addEventListener("pointerdown", (event) => grab(event, what));
  group.addEventListener("keydown", (event) => nudge(event, what));
  group.addEventListener("focus", () => {
    for (const other of map.querySelectorAll(".actuator.selected")) other.classList.remove("selected");
    if (kind === "actuator") group.classList.add("selected");
    if (kind === "actuator" && String(number) !== mapData.selected && !dragged) onPick(number);
  });
  group.dataset.key = kind === "start" ? "start" : `actuator ${number}`;
  return group;
}

function move(what, to) {
  what.moved = what.moved.map((so, k) => so || to[k] !== what.group.place[k]);
  what.at = to;
  put(what.group, to);
}

function put(group, [x, y]) {
  group.place = [x, y];
  group.setAttribute("transform", `translate(${x} ${-y})`);
}

function drawTarget(map, px) {
  const size = 11 * px, group = svg("g", { class: "handle", tabindex: 0, role: "button", "aria-label": `Target at ${place(target)}. Arrow keys move it, Enter starts the search.` }, map);
  svg("circle", { class: "touch", r: GRIP.touch * px }, group);
  svg("path", { class: "target", d: `M${-size},0H${size}M0,${-size}V${size}M${-size / 2},0a${size / 2},${size / 2} 0 1 0 ${size},0a${size / 2},${size / 2} 0 1 0 ${-size},0` }, group);
  put(group, target);
  group.dataset.key = "target";
  group.addEventListener("keydown", (event) => {
    if (event.key === "Enter") { onTarget(target); return; }
    const [dx, dy] = arrow(event);
    if (!dx && !dy) return;
    target = [target[0] + dx, target[1] + dy];
    put(group, target);
  });
}

// Beside the map, so that it never lies over the plate.
function drawScale(px) {
  const about = 0.2 * element("map-box").clientWidth * px, power = 10 ** Math.floor(Math.log10(about));
  const length = [5, 2, 1].map((n) => n * power).find((n) => n <= about);
  element("scale-bar").style.width = `${length / px}px`;
  element("scale-text").textContent = `${Number(length.toPrecision(1))} ${mapData.unit}`;
}

// The path as it is known now.
function drawPath() {
  const line = element("path-line"), end = element("path-end");
  if (!line) return;
  const points = nowPath?.points ?? [], px = pixel();
  line.setAttribute("points", pointsOf(points));
  line.classList.toggle("coarse", Boolean(nowPath?.coarse.length));
  element("map-box").classList.toggle("coarse", Boolean(nowPath && !nowPath.exact));
  if (!nowPath?.exact) element("map-part").setAttribute("visibility", "hidden");
  if (!points.length) return;
  const [x, y] = points[points.length - 1], size = 6 * px;
  end.setAttribute("d", `M${x - size},${-y - size}l${2 * size},${2 * size}M${x - size},${-y + size}l${2 * size},${-2 * size}`);
}

// The surface at the moment of the clock as a shade, and the part there.
function drawHeights(step = shown) {
  const canvas = element("heights"), part_ = element("map-part"), { clientWidth, clientHeight } = canvas;
  canvas.width = Math.ceil(clientWidth / COARSE);
  canvas.height = Math.ceil(clientHeight / COARSE);
  const blank = !pageData || !mapData || !nowPath?.exact || !canvas.width || !canvas.height;
  element("shades").hidden = blank;
  if (blank) { part_?.setAttribute("visibility", "hidden"); return; }
  const [low, high] = frameBox, px = pixel() * COARSE, paint = canvas.getContext("2d"), image = paint.createImageData(canvas.width, canvas.height);
  const left = (low[0] + high[0]) / 2 - canvas.width * px / 2, top = (low[1] + high[1]) / 2 + canvas.height * px / 2;
  const ratio = mapData.perSI / perMetre(units.length), z = heightsAt(step), [least, most] = surface.range;
  const u = Float32Array.from(surface.x, (x) => (x * ratio - left) / px), v = Float32Array.from(surface.y, (y) => (top - y * ratio) / px);
  element("shades-bar").style.background = `linear-gradient(to right, ${surface.colours.map(([at, colour]) => `${colour} ${100 * at}%`).join(", ")})`;
  element("shades-range").textContent = `height, ${said(least)} to ${said(most)} ${units.height}`;
  const shades = Array.from({ length: SHADES + 1 }, (_, k) => shade(k / SHADES));
  const share = Float32Array.from(z, (w) => most > least ? (w - least) / (most - least) : 0);
  for (let k = 0; k < surface.triangles.length; k += 3) fill(image, surface.triangles.subarray(k, k + 3), u, v, share, shades);
  paint.putImageData(image, 0, 0);
  part_.setAttribute("cx", part.x[step] * ratio);
  part_.setAttribute("cy", -part.y[step] * ratio);
  part_.setAttribute("visibility", "visible");
}

// Fill a triangle of an image, whose shade changes evenly from corner to corner.
function fill(image, [a, b, c], u, v, share, shades) {
  const area = (u[b] - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (v[b] - v[a]), { width, height, data } = image;
  if (!area) return;
  const begin = Math.max(0, Math.floor(Math.min(v[a], v[b], v[c]))), end = Math.min(height - 1, Math.ceil(Math.max(v[a], v[b], v[c])));
  const from = Math.max(0, Math.floor(Math.min(u[a], u[b], u[c]))), to = Math.min(width - 1, Math.ceil(Math.max(u[a], u[b], u[c])));
  for (let row = begin; row <= end; row++) {
    for (let column = from; column <= to; column++) {
      const second = ((column - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (row - v[a])) / area;
      const third = ((u[b] - u[a]) * (row - v[a]) - (column - u[a]) * (v[b] - v[a])) / area;
      if (second < -EDGE || third < -EDGE || second + third > 1 + EDGE) continue;
      const value = (1 - second - third) * share[a] + second * share[b] + third * share[c];
      data.set(shades[Math.min(SHADES, Math.max(0, Math.round(SHADES * value)))], 4 * (row * width + column));
    }
  }
}

function perMetre(unit) { return { m: 1, mm: 1e3, "µm": 1e6, "μm": 1e6, um: 1e6, nm: 1e9 }[unit] ?? mapData.perSI; }

// The colour of a share of the range of heights, as in the surface's bar.
function shade(share) {
  const stops = surface.colours, k = Math.min(stops.length - 2, Math.max(0, Math.floor(share * (stops.length - 1))));
  const [from, to] = [stops[k], stops[k + 1]], t = Math.min(1, Math.max(0, (share - from[0]) / (to[0] - from[0])));
  const mix = [1, 3, 5].map((n) => Math.round((1 - t) * parseInt(from[1].slice(n, n + 2), 16) + t * parseInt(to[1].slice(n, n + 2), 16)));
  return [...mix, 255];
}

// Where a pointer is on the map.
function placeOf(event) {
  const box = element("map").getBoundingClientRect(), px = pixel(), [low, high] = frameBox;
  return [(low[0] + high[0]) / 2 + (event.clientX - box.left - box.width / 2) * px, (low[1] + high[1]) / 2 - (event.clientY - box.top - box.height / 2) * px];
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

// How far an arrow key goes.
function arrow(event) {
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }, way = ways[event.key];
  if (!way || event.ctrlKey || event.metaKey || event.altKey) return [0, 0];
  event.preventDefault();
  const step = STEP * (event.shiftKey ? FINE : 1) * (frameBox[1][0] - frameBox[0][0]);
  return way.map((c) => c * step);
}

let nudging = null;
function nudge(event, what) {
  const [dx, dy] = arrow(event);
  if (!dx && !dy) return;
  move(what, [what.group.place[0] + dx, what.group.place[1] + dy]);
  onDrag(what, event.timeStamp);
  clearTimeout(nudging);
  nudging = setTimeout(() => onDrop(what), 350);
}

element("map-box").addEventListener("pointerdown", (event) => {
  if (!aiming || !mapData || event.button) return;
  event.preventDefault();
  onTarget(placeOf(event));
});
new ResizeObserver(() => drawMap()).observe(element("map-box"));
