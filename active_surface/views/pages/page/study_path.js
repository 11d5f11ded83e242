// The path of the chosen cell of a sweep, and its figures in words.

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
    traces.push({ x: even(of), y: odd(of), mode: "markers", name: `ends of ${repeats} starts`, marker: { size: 5, color: colour("accent"), opacity: 0.6 } });
  }
  if (!isFirst) return traces; // the first start was refused
  traces.push({ ...start, mode: "markers", name: "start", marker: { symbol: "circle-open", size: 11, color: INK, line: { width: 2 } } });
  traces.push({ x: [of[0]], y: [of[1]], mode: "markers", name: "end", marker: { symbol: "x-thin-open", size: 10, color: INK, line: { width: 2.5 } } });
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
  const layout = { font: FONT, margin: { l: 62, r: 10, t: 60, b: 48 }, paper_bgcolor: CARD, plot_bgcolor: CARD,
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
