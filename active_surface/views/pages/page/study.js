// The page of a sweep: a map, curve or points over its axes, and the path of the chosen one.

const unpackAxis = (axis) => { const values = unpack(axis.values); return { ...axis, values, edges: unpack(axis.edges), step: stepOf(values) }; };
const axes = pageData.axes.map(unpackAxis), others = pageData.others.map(unpackAxis);
const distance = unpack(pageData.distance), outcome = unpack(pageData.outcome), units = pageData.units;
const starts = unpack(pageData.starts), ends = unpack(pageData.ends), repeats = pageData.repeats, kept = pageData.kept; // ends of a cell
const paths = unpackPaths(pageData.paths);
const MARK = 1; // the number of the trace that marks the chosen cell
const AXIS = { gridcolor: "#e6eaee", zeroline: false, showline: true, linecolor: "#8a96a1", automargin: true };
let chosen = 0, value = "distance";

function unpackPaths(packed) {
  const cells = unpack(packed.cells), stops = unpack(packed.stops), [x, y] = unpackRows(packed.points);
  const found = new Map();
  cells.forEach((cell, k) => {
    const begin = k ? stops[k - 1] : 0;
    found.set(cell, { x: x.subarray(begin, stops[k]), y: y.subarray(begin, stops[k]) });
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

function axisLayout(axis) {
  const layout = { ...AXIS, title: { text: plain(axis.label) }, type: axis.logarithmic ? "log" : "linear" };
  if (axis.edges.length) {
    const ends = [axis.edges[0], axis.edges[axis.edges.length - 1]];
    layout.range = axis.logarithmic ? ends.map(Math.log10) : ends;
  }
  if (axis.logarithmic) layout.dtick = "D2"; // ticks at 1, 2 and 5
  if (!axis.texts.length) return layout;
  const every = Math.ceil(axis.texts.length / 12), shown = axis.texts.filter((_, k) => k % every === 0);
  return { ...layout, tickvals: shown.map((_, k) => k * every), ticktext: shown.map(plain) };
}

// Colours of the outcomes as steps of a scale.
function outcomeScale() {
  const count = pageData.colours.length;
  return pageData.colours.flatMap((colour, k) => [[k / count, colour], [(k + 1) / count, colour]]);
}

function hoverTexts() {
  return Array.from(distance, (length, cell) => {
    const lines = placeOf(cell).map((k, n) => `${plain(axes[n].name)} ${plain(valueSaid(axes[n], k))}`);
    if (Number.isFinite(length)) lines.push(`distance ${said(length)} ${units.distance}`);
    return [...lines, pageData.outcomes[outcome[cell]][0]].join("<br>");
  });
}

function inRows(values) {
  const columns = axes[0].values.length, rows = axes[1].values.length;
  return Array.from({ length: rows }, (_, j) => Array.from({ length: columns }, (_, i) => values[i * rows + j]));
}

function colouring() {
  if (value === "outcome") return { cmin: -0.5, cmax: pageData.colours.length - 0.5, scale: outcomeScale(), values: outcome };
  const known = distance.filter(Number.isFinite);
  const most = known.reduce((size, length) => Math.max(size, length), 0) || 1;
  return { cmin: 0, cmax: most, scale: pageData.scale, values: Array.from(distance, (d) => Number.isFinite(d) ? d : null) };
}

function mainTrace() {
  const { cmin, cmax, scale, values } = colouring(), texts = hoverTexts();
  const bar = { title: { text: `distance [${units.distance}]`, side: "right" }, thickness: 14, outlinewidth: 0.5 };
  const look = { hoverinfo: "text", showscale: value === "distance", colorbar: bar };
  if (pageData.kind === "map") {
    return { ...look, type: "heatmap", x: axes[0].edges, y: axes[1].edges, z: inRows(values), text: inRows(texts), zmin: cmin, zmax: cmax,
      colorscale: scale, hoverongaps: false };
  }
  const marker = { color: values, cmin, cmax, colorscale: scale, size: pageData.kind === "curve" ? 9 : 7, showscale: look.showscale,
    colorbar: bar, line: { color: "#ffffff", width: 0.5 } };
  return { type: "scatter", mode: pageData.kind === "curve" ? "lines+markers" : "markers", x: axes[0].values, y: acrossFrom(), text: texts,
    hoverinfo: "text", marker, line: { color: "#9aa7b3", width: 1 } };
}

// What is drawn upwards where there are points: the second axis, or the distance.
function acrossFrom() {
  return pageData.kind === "points" && axes.length > 1 ? axes[1].values : Array.from(distance, (d) => Number.isFinite(d) ? d : null);
}

function markOf(cell) {
  const place = placeOf(cell);
  if (pageData.kind !== "map") return { x: [axes[0].values[place[0]]], y: [acrossFrom()[cell]] };
  const [[left, right], [low, high]] = place.map((k, n) => [axes[n].edges[k], axes[n].edges[k + 1]]);
  return { x: [left, right, right, left, left], y: [low, low, high, high, low] };
}

function drawMap() {
  const isMap = pageData.kind === "map";
  const mark = { type: "scatter", ...markOf(chosen), hoverinfo: "skip", showlegend: false, mode: isMap ? "lines" : "markers",
    line: { color: PATH, width: 3 }, marker: { symbol: "circle-open", size: 16, color: PATH, line: { width: 3 } } };
  const upwards = isMap || (pageData.kind === "points" && axes.length > 1) ? axisLayout(axes[1])
    : { ...AXIS, title: { text: `distance from the start [${units.distance}]` }, rangemode: "tozero" };
  const layout = { font: FONT, margin: { l: 62, r: 10, t: 34, b: 48 }, paper_bgcolor: "#ffffff", plot_bgcolor: "#ffffff", showlegend: false,
    xaxis: axisLayout(axes[0]), yaxis: upwards, hovermode: "closest", dragmode: "zoom", uirevision: "kept" };
  return Plotly.react("map", [mainTrace(), mark, ...overMap()], layout, CONFIG);
}

// What lies over the map: the outline of the study's threshold, and dots where there is a path if not everywhere.
function overMap() {
  const traces = [], quiet = { type: "scatter", hoverinfo: "skip", showlegend: false };
  if (pageData.outline.length) {
    const along = (n) => pageData.outline.flatMap(([begin, end]) => [begin[n], end[n], null]);
    for (const line of [{ color: "#000000", width: 3.5 }, { color: "#ffffff", width: 1.5 }]) {
      traces.push({ ...quiet, x: along(0), y: along(1), mode: "lines", line });
    }
  }
  if (pageData.kind === "map" && paths.size < distance.filter(Number.isFinite).length) {
    const places = [...paths.keys()].map(placeOf), along = (n) => places.map((place) => axes[n].values[place[n]]);
    traces.push({ ...quiet, x: along(0), y: along(1), mode: "markers",
      marker: { size: 5, color: "#ffffff", line: { color: "#000000", width: 1 } } });
  }
  return traces;
}

// What the map shows beside its colours, in words.
function mapCaption() {
  const known = distance.filter(Number.isFinite).length, lines = [];
  if (pageData.outline.length) lines.push(`The line: where ${pageData.threshold} begins to hold.`);
  if (pageData.kind === "map" && paths.size && paths.size < known) lines.push("Dots: points whose path this page has.");
  element("map-caption").textContent = lines.join(" ");
}

function outcomeKey() {
  const counts = new Map();
  for (const number of outcome) counts.set(number, (counts.get(number) || 0) + 1);
  element("outcome-key").replaceChildren(...[...counts].sort((a, b) => a[0] - b[0]).map(([number, count]) => {
    const entry = document.createElement("span"), sign = document.createElement("span");
    entry.className = "entry";
    sign.className = "key";
    sign.style.background = pageData.colours[number];
    entry.append(sign, ` ${pageData.outcomes[number][0]} ${said(100 * count / outcome.length)} %`);
    return entry;
  }));
  element("outcome-key").style.visibility = value === "outcome" ? "visible" : "hidden";
}

function pathTraces(cell) {
  const { rim, actuators } = pageData.drawing, places = unpack(actuators), traces = [];
  const even = (array) => array.filter((_, k) => k % 2 === 0), odd = (array) => array.filter((_, k) => k % 2 === 1);
  for (const packed of rim) {
    const curve = unpack(packed);
    traces.push({ x: even(curve), y: odd(curve), mode: "lines", line: { color: INK, width: 1.5 }, hoverinfo: "skip", showlegend: false });
  }
  if (places.length) {
    traces.push({ x: even(places), y: odd(places), mode: "markers", name: "actuator",
      marker: { symbol: "triangle-up", size: 10, color: "#ffffff", line: { color: INK, width: 1.5 } } });
  }
  const start = { x: [starts[2 * cell]], y: [starts[2 * cell + 1]] }, of = ends.subarray(2 * kept * cell, 2 * kept * (cell + 1));
  const path = paths.get(cell), straight = { x: [start.x[0], of[0]], y: [start.y[0], of[1]] }, isFirst = Number.isFinite(of[0]);
  if (isFirst) {
    traces.push({ ...(path || straight), mode: "lines", name: path ? "path" : "from start to end",
      line: { color: PATH, width: path ? 2.5 : 1.5, dash: path ? "solid" : "dot" } });
  }
  if (kept > 1 && of.some(Number.isFinite)) {
    traces.push({ x: even(of), y: odd(of), mode: "markers", name: `ends of ${repeats} starts`, marker: { size: 5, color: "#1b4f9c", opacity: 0.6 } });
  }
  if (!isFirst) return traces; // the first start was refused
  traces.push({ ...start, mode: "markers", name: "start", marker: { symbol: "circle-open", size: 11, color: "#000000", line: { width: 2 } } });
  traces.push({ x: [of[0]], y: [of[1]], mode: "markers", name: "end", marker: { symbol: "x-thin-open", size: 10, color: "#000000", line: { width: 2.5 } } });
  return traces;
}

// The range of an axis that shows all of these numbers, with some room.
function padded(numbers) {
  const known = numbers.filter(Number.isFinite), low = Math.min(...known), high = Math.max(...known);
  if (!known.length) return [-1, 1];
  const room = 0.06 * (high - low) || 1;
  return [low - room, high + room];
}

function drawPath(cell) {
  const traces = pathTraces(cell);
  const axis = { ...AXIS, constrain: "domain" }, of = (name) => padded(traces.flatMap((trace) => Array.from(trace[name])));
  const layout = { font: FONT, margin: { l: 62, r: 10, t: 60, b: 48 }, paper_bgcolor: "#ffffff", plot_bgcolor: "#ffffff",
    xaxis: { ...axis, range: of("x"), title: { text: `x [${units.length}]` } },
    yaxis: { ...axis, range: of("y"), title: { text: `y [${units.length}]` }, scaleanchor: "x" },
    legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" }, showlegend: true };
  return Plotly.react("path", traces, layout, CONFIG);
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
