// The curves of a run over time, behind them bands for the state of the part.

let panels, curves, moments, time, last;
const COLOURS = [INK, PATH, colour("accent"), colour("good")], DASHES = ["solid", "dash", "dashdot", "dot"], SIGNS = ["━", "╍╍", "━╍", "┅┅"];

// What this file draws, from the data of the page.
function takeCurves() {
  panels = pageData.curves.panels;
  curves = panels.map((panel) => panel.lines.map((line) => unpack(line.values)));
  moments = pageData.curves.times.map((times) => unpack(times).map((t) => t * pageData.perSecond));
  time = unpack(pageData.time);
  last = time.length - 1;
  element("curves").style.height = panels.length > 6 ? `${110 * panels.length}px` : ""; // else as page.css has it
}

// Bands behind the curves while the part is stuck or in flight.
function stateShades() {
  const looks = {
    stuck: { fillcolor: "rgba(27,79,156,0.16)" },
    flying: { fillcolor: "rgba(0,0,0,0)", fillpattern: { shape: "/", fgcolor: "#b5b5b5", size: 9, solidity: 0.14 } },
  };
  return Object.entries(pageData.stretches).flatMap(([name, packed]) => {
    const x = [], y = [], ends = unpack(packed);
    for (let k = 0; k < ends.length; k += 2) {
      x.push(ends[k], ends[k], ends[k + 1], ends[k + 1]);
      y.push(0, 1, 1, 0);
    }
    const band = { x, y, yaxis: "y", fill: "tozeroy", mode: "none", hoverinfo: "skip", showlegend: false };
    return x.length ? [{ ...looks[name], ...band }] : [];
  });
}

// A mark where a margin is smallest; its label has what the report says of it.
function leastMark({ time: moment, value, text }, k) {
  return { x: [moment * pageData.perSecond], y: [value], yaxis: `y${k + 2}`, mode: "markers", hovertemplate: `${plain(text).replaceAll("; ", "<br>").replace(" at ", "<br>at ")}<extra></extra>`,
    cliponaxis: false, showlegend: false, marker: { symbol: "diamond", size: 11, color: PATH, line: { color: "#ffffff", width: 1.2 } } };
}

function drawCurves() {
  const gap = 0.055, height = (1 - gap * (panels.length - 1)) / panels.length;
  const traces = stateShades(), annotations = [];
  const layout = {
    font: FONT, margin: { l: 64, r: 12, t: NARROW ? 22 : 50, b: 44 }, paper_bgcolor: CARD, plot_bgcolor: "rgba(0,0,0,0)", hovermode: "x",
    showlegend: false, dragmode: "zoom",
    xaxis: { title: { text: `time [${units.time}]` }, range: [time[0], time[last] > time[0] ? time[last] : time[0] + 1],
      hoverformat: besideFormat(time[last] / 100), anchor: `y${panels.length + 1}`, showgrid: false, zeroline: false, showline: true, linecolor: SOFT },
    yaxis: { range: [0, 1], domain: [0, 1], visible: false, fixedrange: true },
    shapes: [{ type: "line", xref: "x", yref: "paper", x0: time[shown], x1: time[shown], y0: 0, y1: 1, line: { color: INK, width: 2 } }],
    annotations,
  };
  panels.forEach((panel, k) => {
    const top = 1 - k * (height + gap);
    layout[`yaxis${k + 2}`] = {
      title: { text: panel.unit, standoff: 6 }, domain: [top - height, top], gridcolor: GRID,
      zerolinecolor: SOFT, nticks: 6, showline: true, linecolor: SOFT, anchor: "x",
    };
    const format = besideFormat(largest(...curves[k]));
    panel.lines.forEach((line, n) => traces.push({
      x: moments[panel.time], y: curves[k][n], yaxis: `y${k + 2}`, mode: moments[panel.time].length > 1 ? "lines" : "markers", name: line.name,
      line: { color: COLOURS[n % 4], width: n ? 1.6 : 1.8, dash: DASHES[n % 4] }, marker: { color: COLOURS[n % 4] }, connectgaps: false,
      hovertemplate: `${line.name} %{y:${format}} ${panel.unit}<extra></extra>`,
    }));
    const names = panel.lines.map((line, n) => `<span style="color:${COLOURS[n % 4]}">${SIGNS[n % 4]} ${line.name}</span>`);
    if (panel.note && !NARROW) names.push(panel.note);
    if ("limit" in panel) {
      layout.shapes.push({ type: "line", xref: "paper", yref: `y${k + 2}`, x0: 0, x1: 1, y0: panel.limit, y1: panel.limit,
        line: { color: PATH, width: 1.2, dash: "dot" } });
    }
    if (panel.least) {
      traces.push(leastMark(panel.least, k));
      names.push(`<span style="color:${PATH}">◆ ${NARROW ? "" : `${panel.least.name}, `}${said(panel.least.time * pageData.perSecond)} ${units.time}</span>`);
    }
    annotations.push({ text: `<b>${panel.label}</b>   ${names.join("   ")}`, xref: "paper", yref: "paper", x: 0, y: top, xanchor: "left", yanchor: "bottom",
      showarrow: false, font: { size: NARROW ? 10 : 12 } });
  });
  traces.push({ x: pageData.events.map((event) => event.time), y: pageData.events.map(() => 0), yaxis: "y", mode: "markers",
    text: pageData.events.map((event) => plain([event.text, event.by].filter(Boolean).join("; "))), hovertemplate: "%{text}<extra></extra>",
    cliponaxis: false, showlegend: false, marker: { symbol: "triangle-up", size: 8, color: "#b8862d", line: { color: INK, width: 0.7 } } });
  return Plotly.react("curves", traces, layout, CONFIG);
}
