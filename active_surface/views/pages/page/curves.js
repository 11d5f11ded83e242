// The curves of a run over time, behind them bands for the state of the part.

const curves = pageData.curves.map((panel) => panel.lines.map((line) => unpack(line.values)));
const time = unpack(pageData.time), last = time.length - 1;

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

function drawCurves() {
  const panels = pageData.curves, gap = 0.075, height = (1 - gap * (panels.length - 1)) / panels.length;
  const traces = stateShades(), annotations = [];
  const layout = {
    font: FONT, margin: { l: 64, r: 12, t: 22, b: 44 }, paper_bgcolor: "#ffffff", plot_bgcolor: "rgba(0,0,0,0)", hovermode: "x",
    showlegend: false, dragmode: "zoom",
    xaxis: { title: { text: `time [${units.time}]` }, range: [time[0], time[last] > time[0] ? time[last] : time[0] + 1],
      anchor: `y${panels.length + 1}`, showgrid: false, zeroline: false, showline: true, linecolor: "#8a96a1" },
    yaxis: { range: [0, 1], domain: [0, 1], visible: false, fixedrange: true },
    shapes: [{ type: "line", xref: "x", yref: "paper", x0: time[shown], x1: time[shown], y0: 0, y1: 1, line: { color: INK, width: 2 } }],
    annotations,
  };
  panels.forEach((panel, k) => {
    const top = 1 - k * (height + gap);
    layout[`yaxis${k + 2}`] = {
      title: { text: `${panel.label} [${panel.unit}]`, standoff: 6 }, domain: [top - height, top], gridcolor: "#e6eaee",
      zerolinecolor: "#aab4bd", nticks: 6, showline: true, linecolor: "#8a96a1", anchor: "x",
    };
    panel.lines.forEach((line, n) => traces.push({
      x: time, y: curves[k][n], yaxis: `y${k + 2}`, mode: time.length > 1 ? "lines" : "markers", name: line.name,
      line: n ? { color: PATH, width: 1.6, dash: "dash" } : { color: INK, width: 1.8 }, marker: { color: n ? PATH : INK },
      hovertemplate: `${line.name} %{y:.4g} ${panel.unit}<extra></extra>`,
    }));
    const names = panel.lines.map((line, n) => n ? `<span style="color:${PATH}">╍╍ ${line.name}</span>` : `━ ${line.name}`);
    annotations.push({ text: names.join("   "), xref: "paper", yref: "paper", x: 0, y: top, xanchor: "left", yanchor: "bottom",
      showarrow: false, font: { size: 12 } });
  });
  return Plotly.newPlot("curves", traces, layout, CONFIG);
}
