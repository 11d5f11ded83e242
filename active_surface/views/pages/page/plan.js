// The plate from above, with its rim, actuators and a path: the page of a sweep and the app draw it alike.

const AXIS = { gridcolor: GRID, zeroline: false, showline: true, linecolor: SOFT, automargin: true };
const LOOKS = {
  rim: { mode: "lines", line: { color: INK, width: 1.5 }, hoverinfo: "skip", showlegend: false },
  actuator: { mode: "markers", name: "actuator", marker: { symbol: "triangle-up", size: 10, color: "#ffffff", line: { color: INK, width: 1.5 } } },
  path: { mode: "lines", name: "path", line: { color: PATH, width: 2.5, dash: "solid" } },
  start: { mode: "markers", name: "start", marker: { symbol: "circle-open", size: 11, color: INK, line: { width: 2 } } },
  end: { mode: "markers", name: "end", marker: { symbol: "x-thin-open", size: 10, color: INK, line: { width: 2.5 } } },
};

// The first and the second of each pair of numbers.
function pairs(numbers) {
  return { x: numbers.filter((_, k) => k % 2 === 0), y: numbers.filter((_, k) => k % 2 === 1) };
}

function rimTrace(rim) {
  const curves = rim.map((curve) => pairs(unpack(curve)));
  return { ...LOOKS.rim, x: curves.flatMap(({ x }) => [...x, null]), y: curves.flatMap(({ y }) => [...y, null]) };
}

// The range of an axis that shows all of these numbers, with some room, and is no shorter than `least`.
function padded(numbers, least = 0) {
  const known = Array.from(numbers).filter(Number.isFinite);
  if (!known.length) return [-1, 1];
  const low = known.reduce((a, b) => Math.min(a, b)), high = known.reduce((a, b) => Math.max(a, b));
  const room = Math.max(0.06 * (high - low), (least - (high - low)) / 2) || 1;
  return [low - room, high + room];
}

function planLayout(x, y, unit, margin, more = {}) {
  const axis = (name, range) => ({ ...AXIS, range, title: { text: `${name} [${unit}]`, standoff: 4 } });
  return { font: FONT, margin, paper_bgcolor: CARD, plot_bgcolor: CARD, xaxis: { ...axis("x", x), ...more },
    yaxis: { ...axis("y", y), ...more, scaleanchor: "x" } };
}
