// The page of a drift: arrows of one group at a time over areas by their ends, and where the chosen place leads.

const starts = pairs(unpack(pageData.starts)), actuators = pairs(unpack(pageData.actuators)), numbers = unpack(pageData.numbers);
const maps = pageData.maps.map((map) => ({ ...map, moving: unpack(map.moving), arrows: pairs(unpack(map.arrows)), moved: pairs(unpack(map.moved)),
  lost: unpack(map.lost), end: unpack(map.end), reached: pairs(unpack(map.reached)) }));
const HEAD = 0.3, WIDE = 0.5; // of an arrow's length, and of that
let shown = maps[0], chosen = fastest();

// The place from which a part goes the farthest in a period.
function fastest() {
  const way = (k) => Math.hypot(shown.moved.x[k], shown.moved.y[k]);
  return shown.moving.reduce((best, k) => (way(k) > way(best) ? k : best), shown.moving[0] ?? 0);
}

// Lines of arrows, with the places in their middle.
function arrowLines() {
  const x = [], y = [];
  shown.moving.forEach((place, k) => {
    const [u, v] = [shown.arrows.x[k], shown.arrows.y[k]], tip = [starts.x[place] + u / 2, starts.y[place] + v / 2];
    const barb = (side) => [tip[0] - HEAD * (u - side * WIDE * v), tip[1] - HEAD * (v + side * WIDE * u)];
    for (const [a, b] of [[tip[0] - u, tip[1] - v], tip, barb(1), tip, barb(-1), [null, null]]) { x.push(a); y.push(b); }
  });
  return { x, y };
}

function some(places, from = starts) { return { x: Array.from(places, (k) => from.x[k]), y: Array.from(places, (k) => from.y[k]) }; }

// The areas as a map of steps: a place's number in the list of colours.
function areas() {
  const rank = new Map(shown.colours.map(([number], k) => [number, k])), count = shown.colours.length;
  const cell = (number) => (number < 0 ? null : rank.get(shown.end[number])), { columns, origin, spacing } = pageData;
  const rows = Array.from({ length: numbers.length / columns }, (_, row) => Array.from(numbers.subarray(row * columns, (row + 1) * columns), cell));
  return { type: "heatmap", z: rows, x0: origin[0], dx: spacing, y0: origin[1], dy: spacing, zmin: -0.5, zmax: count - 0.5, showscale: false, hoverinfo: "skip",
    colorscale: shown.colours.flatMap(([, colour], k) => [[k / count, colour], [(k + 1) / count, colour]]) };
}

function traces() {
  const quiet = { hoverinfo: "skip", showlegend: false }, running = new Set(shown.running), one = [chosen];
  const dark = { color: "#1d2a36" }; // areas are light in the dark, too
  const all = actuators.x.map((_, k) => k), still = all.filter((k) => !running.has(k)), there = some(one), to = some(one, shown.reached);
  return [areas(), ...(pageData.rim.length ? [rimTrace(pageData.rim)] : []),
    { ...quiet, ...arrowLines(), mode: "lines", line: { ...dark, width: 1.2 } },
    { ...quiet, ...some(shown.lost), mode: "markers", marker: { symbol: "x-thin-open", size: 6, color: "#c0392b" } },
    { ...LOOKS.actuator, ...some(running, actuators), name: "runs", marker: { ...LOOKS.actuator.marker, color: dark.color } },
    { ...LOOKS.actuator, ...some(still, actuators), name: "does not run" },
    { ...quiet, ...starts, mode: "markers", marker: { size: 9, opacity: 0 }, hoverinfo: "text", text: starts.x.map((_, k) => ending(k)) },
    { ...LOOKS.path, x: [there.x[0], to.x[0]], y: [there.y[0], to.y[0]], name: "from the chosen place to where the part ends", line: { color: PATH, width: 2, dash: "dot" } },
    { ...LOOKS.start, ...there, showlegend: false, marker: { ...LOOKS.start.marker, color: PATH } },
    { ...LOOKS.end, ...to, showlegend: false, marker: { ...LOOKS.end.marker, color: PATH } }];
}

function placeSaid(places, k) {
  const digits = Math.max(0, Math.ceil(2 - Math.log10(pageData.spacing))), text = (value) => (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits).replace("-", "−");
  return `(${text(places.x[k])}, ${text(places.y[k])}) ${pageData.unit}`;
}

function ending(k) {
  const words = shown.colours.find(([number]) => number === shown.end[k])[2];
  return shown.end[k] < 0 ? words : `at ${placeSaid(shown.reached, k)}: ${words}`;
}

function draw() {
  const from = pageData.rim.length ? rimTrace(pageData.rim) : starts, range = (name) => padded(from[name]);
  const layout = planLayout(range("x"), range("y"), pageData.unit, { l: 62, r: 10, t: 60, b: 48 }, { constrain: "domain" });
  const k = Array.from(shown.moving).indexOf(chosen);
  describe(element("readout"), [["from rest at", placeSaid(starts, chosen)], ["in a period", k < 0 ? "no way" : shown.ways[k]], ["in the end", ending(chosen)]]);
  element("map-caption").textContent = shown.text;
  element("outcome-key").replaceChildren(...shown.colours.map(([, colour, words]) => {
    const entry = document.createElement("span"), sign = document.createElement("span");
    entry.className = "entry";
    sign.className = "key";
    sign.style.background = colour;
    entry.append(sign, ` ${words}`);
    return entry;
  }));
  return Plotly.react("map", traces(), { ...layout, hovermode: "closest", uirevision: "kept", showlegend: true, legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" } }, CONFIG);
}

maps.forEach((map, k) => element("group").add(new Option(map.name, k)));
element("group").addEventListener("change", (event) => { shown = maps[event.target.value]; draw(); });
draw().then((map) => {
  map.on("plotly_click", (event) => {
    const point = event.points.find((one) => one.data.marker?.opacity === 0);
    if (point) { chosen = point.pointIndex; draw(); }
  });
  document.body.dataset.ready = "true";
}).catch((error) => tellTrouble(error.message));
