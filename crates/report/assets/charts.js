// Line charts and order spectra, drawn by uPlot.
const dashOf = series => DASHES[["solid", "dashed", "dotted"].indexOf(series.dash)];

function textWidth(text) {
  const ctx = document.createElement("canvas").getContext("2d");
  ctx.font = font(12, "600");
  return ctx.measureText(text).width;
}

// Where a curve swings within a few pixels, lines would fill the paper: a band from its least to its largest value there, and a line in
// the band's middle. Four pixels are one place; a place that has few points is drawn as it is.
const PLACE = 4, FEW = 6, straight = uPlot.paths.linear();
const translucent = colour => (colour.startsWith("#") ? `${colour}59` : colour.replace("rgb(", "rgba(").replace(")", ", 0.35)"));
function bandPaths(u, series, first, last) {
  const x = u.data[0], y = u.data[series], ratio = devicePixelRatio, size = PLACE * ratio;
  if ((last - first) * size < FEW * u.bbox.width) return { ...straight(u, series, first, last), fill: null };
  const stroke = new Path2D(), fill = new Path2D(), places = new Map();
  for (let k = first; k <= last; k++) {
    if (y[k] == null) continue;
    const place = Math.floor(u.valToPos(x[k], "x", true) / size), known = places.get(place);
    if (known) { known[0] = Math.min(known[0], y[k]); known[1] = Math.max(known[1], y[k]); } else places.set(place, [y[k], y[k]]);
  }
  const run = [...places].map(([place, ends]) => [(place + 0.5) * size, ...ends.map(v => u.valToPos(v, "y", true))]);
  run.forEach(([at, low, high], k) => {
    const middle = (low + high) / 2;
    k && at - run[k - 1][0] < 1.5 * size ? stroke.lineTo(at, middle) : stroke.moveTo(at, middle);
    fill.rect(at - size / 2, high, size, low - high);
  });
  return { stroke, fill };
}

// The toolbar, the chart made anew for every theme and width, and the legend for the keyboard.
function chart(figure, place, hint, data, optionsFor, window, d) {
  let plot = null, shown = null, range = window, mark = null;
  const abscissa = d.x ? withUnit(d.x.label, d.x.unit) : null;
  const reset = () => { range = null; draw(); };
  place.before(element("div", { className: "tools" }, element("span", { className: "hint", textContent: hint }), button("Show all", reset),
    ...downloads(figure, { PNG: () => chartPng(figure, plot), SVG: () => chartSvg(figure, plot, d), CSV: () => chartCsv(plot) })));
  place.setAttribute("role", "group");
  place.setAttribute("aria-label", figure.querySelector("figcaption").textContent);

  function draw() {
    if (plot) { shown = plot.series.map(s => s.show); plot.destroy(); }
    const width = drawingWidth(place), options = optionsFor(width);
    options.width = width;
    // As high as the title of the ordinate is long.
    const title = textWidth(options.axes[1].label) + 80;
    options.height = Math.round(Math.max(Math.min(430, Math.max(260, width * 0.38)), Math.min(title, 520)));
    if (shown) options.series.forEach((s, i) => { s.show = shown[i]; });
    options.scales.x = { ...options.scales.x, time: false };
    if (abscissa) {
      // One cursor for all charts over the same; a picture in space follows it, and says where it stands.
      const pub = type => type === "mousemove" || type === "mouseleave";
      options.cursor = { ...options.cursor, y: false, sync: { key: abscissa, setSeries: false, scales: ["x", null], filters: { pub } } };
      const said = u => u.cursor.event && u.cursor.idx != null && tell(`${abscissa} of a chart`, data[0][u.cursor.idx]);
      options.hooks = { ...options.hooks, setCursor: [said], draw: [...(options.hooks?.draw ?? []), u => mark !== null && lineAt(u, mark)] };
    }
    options.hooks = { ...options.hooks, setScale: [(u, key) => { if (key === "x" && u.status === 1) range = zoomed(u); }] };
    plot = new uPlot(options, data, place);
    if (range) plot.setScale("x", { min: range[0], max: range[1] });
    legendForKeyboard(plot);
  }
  const zoomed = u => {
    const { min, max } = u.scales.x, x = data[0];
    return min > x[0] || max < x[x.length - 1] ? [min, max] : null;
  };
  figures.push(draw);
  followers.push({ axis: abscissa, follow: x => { mark = x; plot?.redraw(false); } });
}

const legendValue = (u, v) => (v == null ? "" : number(v, 5));

// Named abscissas: a dashed line each, the names above the chart where there is room.
function marks(u, list, base) {
  const { ctx } = u, ratio = devicePixelRatio, { left, top: roof, width } = u.bbox;
  let free = -Infinity;
  ctx.font = font(12 * ratio);
  ctx.textBaseline = "bottom"; ctx.textAlign = "left";
  for (const { order, label } of [...list].sort((a, b) => a.order - b.order)) {
    const x = u.valToPos(order, "x", true);
    if (x < left || x > left + width) continue;
    ctx.strokeStyle = colour("--line"); ctx.lineWidth = ratio;
    ctx.setLineDash([3 * ratio, 3 * ratio]);
    ctx.beginPath(); ctx.moveTo(x, roof); ctx.lineTo(x, base); ctx.stroke();
    ctx.setLineDash([]);
    const text = label ? `${number(order)} · ${label}` : number(order), half = ctx.measureText(text).width / 2;
    const at = Math.min(Math.max(x - half, left), left + width - 2 * half);
    if (at < free) continue;
    ctx.fillStyle = colour("--faint"); ctx.fillText(text, at, roof - 4 * ratio);
    free = at + 2 * half + 8 * ratio;
  }
}

function lineChart(figure, place, d) {
  const gap = d.log ? v => (Number.isNaN(v) || v <= 0 ? null : v) : v => (Number.isNaN(v) ? null : v);
  const data = [Array.from(unpack(d.abscissas, Float32Array)), ...d.series.map(s => Array.from(unpack(s.values, Float32Array), gap))];
  const markLines = u => {
    u.ctx.save();
    marks(u, d.marks, u.bbox.top + u.bbox.height);
    u.ctx.restore();
  };
  const options = () => ({
    padding: [d.marks.length ? 24 : null, null, null, null],
    hooks: { draw: d.marks.length ? [markLines] : [] },
    scales: { x: {}, y: d.log ? { distr: 3 } : {} },
    axes: [axis(d.x.label, d.x.unit, { size: 34 }), axis(d.y.label, d.y.unit, d.log ? logAxis : { size: wideAs(64) })],
    series: [{ label: withUnit(d.x.label, d.x.unit), value: legendValue }, ...d.series.map(s => ({
      label: s.name, stroke: seriesColour(s.colour), width: 1.5, ...(d.log ? {} : { fill: translucent(seriesColour(s.colour)), paths: bandPaths }), dash: dashOf(s), show: s.shown, points: { show: false }, value: legendValue,
    }))],
    legend: { markers: { width: 2, dash: (u, i) => ({ solid: "solid", dashed: "dashed", dotted: "dotted" })[d.series[i - 1].dash] } },
    focus: { alpha: 0.5 },
    cursor: { drag: { x: true, y: true, uni: 40 }, focus: { prox: 14 }, points: { size: 6 } },
  });
  const bands = !d.log && data[0].length * PLACE > FEW * 300 ? " Band: least to largest within a few pixels." : "";
  chart(figure, place, "Drag to zoom, double click for all, click a name to switch a curve." + bands, data, options, d.window, d);
}

function spectrumChart(figure, place, d) {
  const data = [Array.from(unpack(d.orders, Float32Array)), ...d.series.map(s => Array.from(unpack(s.values, Float32Array)))];
  const strongest = Math.max(...data.slice(1).map(v => v.reduce((m, a) => Math.max(m, a), 0)));
  const top = strongest > 0 ? 10 ** Math.ceil(Math.log10(strongest) + 0.05) : 1, floor = top / 10 ** d.decades;
  const marked = new Map(d.highlighted.map(h => [h.order, h.label]));

  const stems = u => {
    const { ctx } = u, ratio = devicePixelRatio, base = u.valToPos(floor, "y", true), { left, top: roof, width } = u.bbox;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, roof - 22 * ratio, width, u.bbox.height + 22 * ratio);
    ctx.clip();
    marks(u, d.highlighted, base);
    const shown = d.series.map((_, i) => i + 1).filter(i => u.series[i].show);
    const perOrder = width / Math.max(1, u.scales.x.max - u.scales.x.min);
    const spread = Math.min(6 * ratio, Math.max(3 * ratio, perOrder * 0.8 / Math.max(1, shown.length)));
    shown.forEach((i, n) => {
      const offset = (n - (shown.length - 1) / 2) * spread;
      ctx.strokeStyle = ctx.fillStyle = curveColour(i - 1);
      for (let k = 0; k < data[0].length; k++) {
        if (!(data[i][k] > floor)) continue;
        const x = u.valToPos(data[0][k], "x", true) + offset, y = u.valToPos(data[i][k], "y", true), strong = marked.has(data[0][k]);
        ctx.globalAlpha = strong || marked.size === 0 ? 1 : 0.6;
        ctx.lineWidth = (strong ? 2.5 : 1.25) * ratio;
        ctx.beginPath(); ctx.moveTo(x, base); ctx.lineTo(x, y); ctx.stroke();
        if (strong || perOrder >= 8 * ratio) { ctx.beginPath(); ctx.arc(x, y, (strong ? 3.5 : 2) * ratio, 0, 7); ctx.fill(); }
      }
    });
    ctx.restore();
  };
  const options = () => ({
    padding: [24, null, null, null],
    scales: { x: { range: (u, a, b) => (b - a < 1 ? [a - 1, b + 1] : [a - (b - a) * 0.01, b + (b - a) * 0.01]) }, y: { distr: 3, range: () => [floor, top] } },
    axes: [axis("order", "1/rev", { size: 34 }), axis(d.y.label, d.y.unit, logAxis)],
    series: [{ label: "order", value: legendValue }, ...d.series.map((s, i) => ({
      label: s.name, stroke: curveColour(i), width: 2, paths: () => null, points: { show: false }, value: legendValue,
    }))],
    legend: { markers: { width: 2 } },
    cursor: { drag: { x: true, y: false }, points: { show: false } },
    hooks: { draw: [stems] },
  });
  chart(figure, place, "Amplitude of the cosine. Drag to zoom, double click for all, click a name to switch a signal.", data, options, null, d);
}
