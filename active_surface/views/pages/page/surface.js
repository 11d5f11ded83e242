// The surface of a run in three dimensions, with the part and its trail on it at the step that is shown.

let surface, part, trail, units;
let others = []; // further parts of the run
let below; // the part, at every step
let still; // the places of traces that move only up and down
const FLYING = 2; // of the part's states
// Of the surface's length, by which what lies on it is lifted so that it is seen: the part is a ball that big.
const LIFTS = { lines: 0.002, rim: 0.002, actuators: 0.012, trail: 0.006, part: 0.035, face: 0.008 };
const SPACE = 1.55; // the longest diagonal that the cameras take in
const EYES = {
  slanted: { eye: { x: 0.75, y: -1.15, z: 0.72 }, up: { x: 0, y: 0, z: 1 } },
  above: { eye: { x: 0, y: 0, z: 1.5 }, up: { x: 0, y: 1, z: 0 } },
  side: { eye: { x: 0, y: -1.5, z: 0 }, up: { x: 0, y: 0, z: 1 } },
};
const MESH = 0, LINES = 1, RIM = 2, ACTUATORS = 3, AHEAD = 4, TRAIL = 5, PART = 6;
let closeBy = false, exaggeration = 1, shown = 0;

// What this file draws, from the data of the page.
function takeSurface() {
  surface = unpackSurface(pageData.surface);
  part = Object.fromEntries(["x", "y", "z", "height", "speed", "state"].map((name) => [name, unpack(pageData.part[name])]));
  Object.assign(part, unpackFace(pageData.part));
  trail = { ...unpackSpots(pageData.trail), step: unpack(pageData.trail.step) };
  below = unpackSpots(pageData.part.below);
  others = (pageData.others ?? []).map((one) => ({ ...one, ...Object.fromEntries(["x", "y", "z"].map((name) => [name, unpack(one[name])])), below: unpackSpots(one.below), ...unpackFace(one) }));
  units = pageData.units;
  still = Object.fromEntries(["x", "y"].map((axis) => [axis, [alongRim(surface[axis]), atActuators(surface[axis])]]));
}

function unpackFace({ face, heading, plane }) {
  return face ? { face, heading: unpack(heading), plane: unpack(plane) } : {};
}

function unpackSpots(spots) {
  return { corners: unpack(spots.corners), weights: unpack(spots.weights) };
}

function unpackSurface(packed) {
  const lines = packed.lines.map((some) => ({ ...unpackSpots(some), ends: unpack(some.ends) }));
  return {
    ...packed, lines, x: unpack(packed.x), y: unpack(packed.y), triangles: unpack(packed.triangles), rim: unpack(packed.rim),
    actuators: unpack(packed.actuators), numbers: packed.numbers, shapes: unpackRows(packed.shapes), amplitudes: unpack(packed.amplitudes),
  };
}

// The heights of the surface's points at a step.
function heightsAt(step) {
  const z = new Float32Array(surface.x.length), rank = surface.shapes.length;
  for (let mode = 0; mode < rank; mode++) {
    const amplitude = surface.amplitudes[step * rank + mode], shape = surface.shapes[mode];
    for (let n = 0; n < z.length; n++) z[n] += amplitude * shape[n];
  }
  return z;
}

// Values at a spot, from those at the points of the surface.
function valueAt(spots, k, values) {
  const { corners, weights } = spots, second = weights[2 * k], third = weights[2 * k + 1];
  return (1 - second - third) * values[corners[3 * k]] + second * values[corners[3 * k + 1]] + third * values[corners[3 * k + 2]];
}

// Points of lines on the surface, one after the other with gaps between.
function alongLines(values) {
  const found = [], lines = surface.lines[closeBy ? 1 : 0];
  let next = 0;
  for (const end of lines.ends) {
    for (; next < end; next++) found.push(valueAt(lines, next, values));
    found.push(null);
  }
  return found;
}

function alongRim(values) {
  const found = [];
  for (let k = 0; k < surface.rim.length; k += 2) found.push(values[surface.rim[k]], values[surface.rim[k + 1]], null);
  return found;
}

function atActuators(values) { return Array.from(surface.actuators, (n) => values[n]); }

// By how much something is lifted, in the unit of heights.
function lift(what) {
  return LIFTS[what] * lengthOf() * pageData.perLength / exaggeration;
}

// The corners of what is shown of the surface, and the longer side of that.
function frame() {
  if (closeBy) return pageData.window;
  return [[...bounds(surface.x)], [...bounds(surface.y)]].reduce(([lows, highs], [low, high]) => [[...lows, low], [...highs, high]], [[], []]);
}

function sidesOf([low, high]) { return high.map((value, k) => value - low[k]); }

function lengthOf() { return Math.max(...sidesOf(frame())); }

function bounds(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) { low = Math.min(low, value); high = Math.max(high, value); }
  return [low, high];
}

// The trail up to a step and the way from there on, on the surface as it is now.
function trailAt(step, z) {
  const passed = { x: [], y: [], z: [] }, ahead = { x: [], y: [], z: [] }, over = lift("trail");
  const here = { x: part.x[step], y: part.y[step], z: valueAt(below, step, z) + over };
  const put = (line, point) => { for (const axis of "xyz") line[axis].push(point[axis]); };
  for (let k = 0; k < trail.step.length; k++) {
    const point = { x: valueAt(trail, k, surface.x), y: valueAt(trail, k, surface.y), z: valueAt(trail, k, z) + over };
    if (trail.step[k] < step) { put(passed, point); continue; }
    if (!ahead.x.length) put(ahead, here);
    put(ahead, point);
  }
  put(passed, here);
  if (part.state[step] === FLYING) { // a line down to the surface shows where the part is
    for (const point of [{ x: null, y: null, z: null }, here, { ...here, z: part.z[step] }]) put(ahead, point);
  }
  return { passed, ahead };
}

// The parts with a face; a point has none.
function faced() { return [part, ...others].filter((one) => one.face); }

// The face of a part at a step, on the plane of its own.
function outlineAt(one, step) {
  const found = { x: [], y: [], z: [] }, [middle, ...slopes] = one.plane.subarray(3 * step, 3 * step + 3), here = [one.x[step], one.y[step]];
  for (const [x, y] of faceAt(one.face, here, one.heading[step]).flatMap((line) => [...line, [null, null]])) {
    found.x.push(x);
    found.y.push(y);
    found.z.push(x === null ? null : middle + slopes[0] * (x - here[0]) + slopes[1] * (y - here[1]) + lift("face"));
  }
  return found;
}

// The trails of the other parts up to a step, on the surface as it is now, each followed by the part itself.
function othersAt(step, z) {
  return others.flatMap((one) => [
    { x: one.x.slice(0, step + 1), y: one.y.slice(0, step + 1), z: Array.from({ length: step + 1 }, (_, k) => valueAt(one.below, k, z) + lift("trail")) },
    { x: [one.x[step]], y: [one.y[step]], z: [one.z[step] + lift(one.face ? "face" : "part")] },
  ]);
}

// What the traces of the surface show at a step.
function changingAt(step) {
  const z = heightsAt(step), { passed, ahead } = trailAt(step, z), beside = [...othersAt(step, z), ...faced().map((one) => outlineAt(one, step))];
  const raised = (values, what) => values.map((value) => value === null ? null : value + lift(what));
  const now = {
    x: [surface.x, alongLines(surface.x), ...still.x, ahead.x, passed.x, [part.x[step]], ...beside.map((one) => one.x)],
    y: [surface.y, alongLines(surface.y), ...still.y, ahead.y, passed.y, [part.y[step]], ...beside.map((one) => one.y)],
    z: [z, raised(alongLines(z), "lines"), raised(alongRim(z), "rim"), raised(atActuators(z), "actuators"),
      ahead.z, passed.z, raised([part.z[step]], part.face ? "face" : "part"), ...beside.map((one) => one.z)],
  };
  return { ...now, intensity: [z, ...Array(now.z.length - 1).fill(undefined)] };
}

function drawSurface() {
  const [low, high] = surface.range, now = changingAt(shown), thirds = [[], [], []];
  surface.triangles.forEach((corner, k) => thirds[k % 3].push(corner));
  const flat = besideFormat(largest(surface.x, surface.y));
  const quiet = { type: "scatter3d", hoverinfo: "skip", showlegend: false };
  const traces = [
    {
      type: "mesh3d", x: now.x[MESH], y: now.y[MESH], z: now.z[MESH], i: thirds[0], j: thirds[1], k: thirds[2],
      intensity: now.z[MESH], cmin: low, cmax: high > low ? high : low + 1, colorscale: surface.colours, flatshading: false,
      lighting: { ambient: 0.88, diffuse: 0.2, specular: 0, roughness: 1, fresnel: 0 }, // little light, so that colours are those of the bar
      lightposition: { x: -2000, y: -4000, z: 6000 },
      hovertemplate: `x %{x:${flat}} ${units.length}<br>y %{y:${flat}} ${units.length}<br>height %{z:${besideFormat(largest(surface.extent))}} ${units.height}<extra></extra>`,
      showscale: high > low,
      colorbar: { title: { text: `height [${units.height}]`, side: "top" }, outlinewidth: 0.5, orientation: "h", thickness: 10, len: 0.7, y: -0.02 },
    },
    { ...quiet, mode: "lines", x: now.x[LINES], y: now.y[LINES], z: now.z[LINES],
      line: { color: "rgba(29,39,51,0.28)", width: 1 } },
    { ...quiet, mode: "lines", x: now.x[RIM], y: now.y[RIM], z: now.z[RIM], line: { color: INK, width: 4 } },
    { ...quiet, mode: surface.numbers.length ? "markers+text" : "markers", text: surface.numbers.map(String),
      textposition: "top center", textfont: { size: 14, color: INK }, x: now.x[ACTUATORS], y: now.y[ACTUATORS], z: now.z[ACTUATORS], name: "actuators",
      showlegend: surface.actuators.length > 0,
      marker: { symbol: "diamond", size: surface.actuators.length > 100 ? 2.5 : surface.actuators.length > 30 ? 3.5 : 5, color: "#ffffff", line: { color: INK, width: 1.5 } } },
    { ...quiet, mode: "lines", x: now.x[AHEAD], y: now.y[AHEAD], z: now.z[AHEAD], name: "way ahead", showlegend: true,
      line: { color: SOFT, width: 2 } },
    { ...quiet, mode: "lines", x: now.x[TRAIL], y: now.y[TRAIL], z: now.z[TRAIL], name: "trail", showlegend: true,
      line: { color: PATH, width: 6 } },
    { ...quiet, mode: "markers", x: now.x[PART], y: now.y[PART], z: now.z[PART], name: pageData.name ?? "part", showlegend: true,
      marker: { size: part.face ? 4 : 8, color: "#ffcc33", line: { color: "#000000", width: 2 } } },
    ...others.flatMap(({ name, colour, face }, k) => [PART + 1 + 2 * k, PART + 2 + 2 * k].map((n) => ({
      ...quiet, mode: n % 2 ? "lines" : "markers", x: now.x[n], y: now.y[n], z: now.z[n], name, showlegend: n % 2 === 0,
      line: { color: colour, width: 6 }, marker: { size: face ? 4 : 8, color: colour, line: { color: "#000000", width: 2 } },
    }))),
    ...faced().map(({ colour }, k) => [colour ?? "#000000", PART + 1 + 2 * others.length + k]).map(([color, n]) => (
      { ...quiet, mode: "lines", x: now.x[n], y: now.y[n], z: now.z[n], line: { color, width: 5 } })),
  ];
  const axis = { showbackground: false, gridcolor: GRID, zeroline: false, showspikes: false, nticks: 6, tickfont: { size: 11 } };
  const title = (text) => ({ title: { text, font: { size: NARROW ? 11 : 13 } } });
  const layout = {
    font: FONT, margin: { l: 0, r: 0, t: NARROW ? 0 : 28, b: 0 }, paper_bgcolor: CARD, uirevision: "kept", // above the legend its buttons
    legend: { orientation: "h", x: 0, y: 1, itemsizing: "constant", bgcolor: "rgba(0,0,0,0)", itemclick: false, itemdoubleclick: false },
    scene: {
      xaxis: { ...axis, ...title(`x [${units.length}]`) },
      yaxis: { ...axis, ...title(`y [${units.length}]`) },
      zaxis: { ...axis, ...title(""), showticklabels: false, nticks: 4, range: heightRange() }, // the bar tells heights
      bgcolor: CARD, aspectmode: "manual", aspectratio: proportions(), camera: element("surface").layout?.scene.camera ?? camera("slanted"), dragmode: "orbit",
    },
  };
  return Plotly.react("surface", traces, layout, CONFIG);
}

function camera(name) {
  const { eye, up } = EYES[name], away = NARROW ? 1.75 : 1; // a narrow window sees less to its sides
  return { eye: { x: away * eye.x, y: away * eye.y, z: away * eye.z }, up, center: { x: 0, y: 0, z: name === "slanted" ? -0.08 : 0 }, projection: { type: name === "slanted" ? "perspective" : "orthographic" } };
}

// Seen from the side, heights have an axis with numbers, and y, which is seen end on, has none; else the bar has these.
function heightAxis(told) {
  return {
    "scene.zaxis.showticklabels": told, "scene.zaxis.title.text": told ? `height [${units.height}]` : "",
    "scene.yaxis.showticklabels": !told, "scene.yaxis.title.text": told ? "" : `y [${units.length}]`,
  };
}

// The heights that the axis shows: never nothing.
function heightRange() {
  const [low, high] = surface.extent, least = 0.05 * lengthOf() * pageData.perLength / exaggeration;
  const room = Math.max(0.06 * (high - low), least);
  return [low - room, high + room];
}

function proportions() {
  const length = lengthOf(), [low, high] = heightRange(), [x, y] = sidesOf(frame());
  const z = (high - low) / pageData.perLength * exaggeration;
  const scale = Math.min(1 / length, SPACE / Math.hypot(x, y, z));
  return { x: x * scale, y: y * scale, z: z * scale };
}
