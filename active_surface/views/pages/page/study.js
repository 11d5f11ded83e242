// The page of a sweep: its numbers, and what happens when a cell is chosen.

const unpackAxis = (axis) => { const values = unpack(axis.values); return { ...axis, values, edges: unpack(axis.edges), step: stepOf(values) }; };
const axes = pageData.axes.map(unpackAxis), others = pageData.others.map(unpackAxis);
const distance = unpack(pageData.distance), outcome = unpack(pageData.outcome), units = pageData.units;
const starts = unpack(pageData.starts), ends = unpack(pageData.ends), repeats = pageData.repeats, kept = pageData.kept; // ends of a cell
const paths = unpackPaths(pageData.paths);
const MARK = 1; // the number of the trace that marks the chosen cell
let chosen = 0, value = "distance";

function unpackPaths(packed) {
  const cells = unpack(packed.cells), stops = unpack(packed.stops), [x, y] = unpackRows(packed.points);
  const found = new Map(), headings = packed.headings ? unpack(packed.headings) : [];
  cells.forEach((cell, k) => {
    const begin = k ? stops[k - 1] : 0;
    found.set(cell, { x: x.subarray(begin, stops[k]), y: y.subarray(begin, stops[k]), headings: headings.slice(2 * k, 2 * k + 2) });
  });
  return found;
}

// The numbers along the axes of a cell: it counts as rows of a table, whose last axis runs fastest.
function placeOf(cell) {
  if (pageData.kind === "points") return axes.map(() => cell);
  return axes.length === 2 ? [Math.floor(cell / axes[1].values.length), cell % axes[1].values.length] : [cell];
}

function cellOf(place) {
  return axes.length === 2 && pageData.kind === "map" ? place[0] * axes[1].values.length + place[1] : place[0];
}

// The smallest step from one value to another along a grid; of points, which lie anywhere, a thousandth of their range.
function stepOf(values) {
  const sorted = Float64Array.from(values).sort(), most = sorted[sorted.length - 1] - sorted[0];
  if (pageData.kind === "points") return most / 1000;
  return sorted.reduce((least, number, k) => (k && number > sorted[k - 1] ? Math.min(least, number - sorted[k - 1]) : least), most);
}

function valueSaid(axis, k) {
  const drawn = axis.values[k];
  return `${axis.texts.length ? axis.texts[Math.round(drawn)] : said(drawn, axis.step)} ${axis.unit}`.trim();
}

// A slider for each axis: the map for the keyboard.
function addPickers() {
  const sides = pageData.kind === "points" ? [{ name: "point", count: distance.length }] : axes.map((axis) => ({ name: axis.name, count: axis.values.length }));
  sides.forEach(({ name, count }, n) => {
    const label = document.createElement("label"), picker = document.createElement("input");
    Object.assign(picker, { type: "range", id: `picker-${n}`, min: 0, max: count - 1, step: 1 });
    label.append(name, picker);
    element("pickers").append(label);
    picker.addEventListener("input", () => choose(cellOf(sides.map((_, k) => Number(element(`picker-${k}`).value)))));
  });
}

function pathTraces(cell) {
  const { rim, actuators, face } = pageData.drawing, places = unpack(actuators), traces = rim.length ? [rimTrace(rim)] : [];
  if (places.length) traces.push({ ...LOOKS.actuator, ...pairs(places) });
  const start = { x: [starts[2 * cell]], y: [starts[2 * cell + 1]] }, of = ends.subarray(2 * kept * cell, 2 * kept * (cell + 1));
  const path = paths.get(cell), straight = { x: [start.x[0], of[0]], y: [start.y[0], of[1]] }, isFirst = Number.isFinite(of[0]);
  if (isFirst && path) traces.push({ ...LOOKS.path, x: path.x, y: path.y });
  else if (isFirst) traces.push({ ...LOOKS.path, ...straight, name: "from start to end", line: { color: PATH, width: 1.5, dash: "dot" } });
  if (kept > 1 && of.some(Number.isFinite)) {
    traces.push({ ...pairs(of), mode: "markers", name: `ends of ${repeats} starts`, marker: { size: 5, color: colour("accent"), opacity: 0.6 } });
  }
  if (!isFirst) return traces; // the first start was refused
  if (path && face) {
    const lines = [[start.x[0], start.y[0]], of].flatMap((place, k) => faceAt(face, place, path.headings[k]).flatMap((line) => [...line, [null, null]]));
    traces.push({ ...LOOKS.rim, x: lines.map(([x]) => x), y: lines.map(([, y]) => y) });
  }
  return [...traces, { ...LOOKS.start, ...start }, { ...LOOKS.end, x: [of[0]], y: [of[1]] }];
}

function drawPath(cell) {
  const traces = pathTraces(cell), range = (name) => padded(traces.flatMap((trace) => Array.from(trace[name])));
  const layout = planLayout(range("x"), range("y"), units.length, { l: 62, r: 10, t: 60, b: 48 }, { constrain: "domain" });
  return Plotly.react("path", traces, { ...layout, legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" }, showlegend: true }, CONFIG);
}

function tell(cell) {
  const place = placeOf(cell), [name, sentence] = pageData.outcomes[outcome[cell]];
  const terms = axes.map((axis, n) => [axis.name, valueSaid(axis, place[n])]);
  terms.push(...others.map((axis) => [axis.name, valueSaid(axis, cell)]));
  terms.push([repeats > 1 ? "usual outcome" : "outcome", name]);
  if (Number.isFinite(distance[cell])) terms.push([repeats > 1 ? "mean distance" : "distance", `${said(distance[cell])} ${units.distance}`]);
  describe(element("readout"), terms);
  const which = repeats > 1 ? " The path is that of the first start." : "";
  const lacks = Number.isFinite(ends[2 * kept * cell]) ? " This page has no path of this point: only where it starts and ends."
    : Number.isFinite(distance[cell]) ? " The first start was refused." : "";
  element("path-caption").textContent = sentence + (paths.has(cell) ? which : lacks);
}

// Show the path of a cell, and mark the cell.
async function choose(cell) {
  chosen = cell;
  tell(cell);
  placeOf(cell).forEach((k, n) => {
    const picker = element(`picker-${n}`);
    if (!picker) return;
    picker.value = k;
    picker.setAttribute("aria-valuetext", valueSaid(axes[n], k));
  });
  const mark = markOf(cell);
  await Promise.all([Plotly.restyle("map", { x: [mark.x], y: [mark.y] }, [MARK]), drawPath(cell)]);
}

function cellAt(point) {
  if (pageData.kind !== "map") return point.pointIndex;
  const [row, column] = point.pointIndex;
  return cellOf([column, row]);
}

function swap(button) {
  value = button.dataset.value;
  for (const other of document.querySelectorAll("[data-value]")) other.setAttribute("aria-pressed", other === button);
  outcomeKey();
  return drawMap();
}

// The first to be shown: that which went the farthest of those with a path.
function first() {
  const cells = paths.size ? [...paths.keys()] : [...distance.keys()];
  return cells.reduce((best, cell) => (distance[cell] > (distance[best] || 0) ? cell : best), cells[0] ?? 0);
}

addPickers();
outcomeKey();
mapCaption();
chosen = first();
drawMap().then((map) => {
  map.on("plotly_click", (event) => {
    const point = event.points.find((one) => one.curveNumber === 0);
    if (point) choose(cellAt(point));
  });
  for (const button of document.querySelectorAll("[data-value]")) button.addEventListener("click", () => swap(button));
  return choose(chosen);
}).then(() => { document.body.dataset.ready = "true"; }).catch((error) => tellTrouble(error.message));
