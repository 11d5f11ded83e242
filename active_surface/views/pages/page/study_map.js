// The map, curve or points of a sweep over its axes.

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
  const layout = { font: FONT, margin: { l: 62, r: 10, t: 34, b: 48 }, paper_bgcolor: CARD, plot_bgcolor: CARD, showlegend: false,
    xaxis: axisLayout(axes[0]), yaxis: upwards, hovermode: "closest", hoverdistance: pageData.kind === "points" ? -1 : 20, dragmode: "zoom", uirevision: "kept" };
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
      marker: { size: Math.max(1.5, Math.min(5, 0.3 * 500 / Math.max(...axes.slice(0, 2).map((axis) => axis.values.length)))),
        color: "#ffffff", line: { color: "#000000", width: 0.5 } } });
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
