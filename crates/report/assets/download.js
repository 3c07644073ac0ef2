// PNG, SVG and CSV of a figure, made from what the page holds: no network is needed.
function save(name, content, type) {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  const link = element("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

const figureTitle = figure => figure.querySelector("figcaption").textContent;
const fileName = figure => figureTitle(figure).replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 80) || "figure";
const escapeXml = text => text.replace(/[&<>"]/g, c => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
const csvCell = text => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
const csvNumber = v => (v == null || Number.isNaN(v) ? "" : String(v));
const SVG_FONT = "font-family='system-ui, Segoe UI, Roboto, DejaVu Sans, sans-serif' font-size='12'";

function downloads(figure, makers) {
  const kinds = { PNG: "image/png", SVG: "image/svg+xml", CSV: "text/csv" };
  return Object.entries(makers).map(([kind, make]) => {
    const store = content => save(`${fileName(figure)}.${kind.toLowerCase()}`, content, kinds[kind]);
    const node = button(kind, () => { const made = make(); made instanceof Promise ? made.then(store) : store(made); });
    node.setAttribute("aria-label", `${kind} of ${figureTitle(figure)}`);
    return node;
  });
}

// Canvases side by side on the page's paper, the title above, lines of text below.
function canvasesToPng(figure, canvases, lines = []) {
  const ratio = devicePixelRatio, head = 30 * ratio, line = 20 * ratio;
  const width = canvases.reduce((sum, c) => sum + c.width, 0), height = Math.max(...canvases.map(c => c.height));
  const sheet = element("canvas", { width, height: head + height + line * lines.length + 8 * ratio }), ctx = sheet.getContext("2d");
  ctx.fillStyle = colour("--paper"); ctx.fillRect(0, 0, sheet.width, sheet.height);
  ctx.fillStyle = colour("--ink"); ctx.textBaseline = "middle";
  ctx.font = font(14 * ratio, "600");
  ctx.fillText(figureTitle(figure), 8 * ratio, head / 2, width - 16 * ratio);
  let x = 0;
  for (const c of canvases) { ctx.drawImage(c, x, head); x += c.width; }
  ctx.font = font(12 * ratio);
  lines.forEach(({ text, stroke }, i) => {
    const y = head + height + line * (i + 0.5);
    ctx.fillStyle = stroke; ctx.fillRect(12 * ratio, y - ratio, 22 * ratio, 2 * ratio);
    ctx.fillStyle = colour("--ink"); ctx.fillText(text, 42 * ratio, y);
  });
  return new Promise(resolve => sheet.toBlob(resolve, "image/png"));
}

const shownSeries = plot => plot.series.map((s, i) => ({ s, i })).slice(1).filter(({ s }) => s.show);
const strokeOf = (plot, i) => { const s = plot.series[i].stroke; return typeof s === "function" ? s(plot, i) : s; };

function chartPng(figure, plot) {
  const lines = shownSeries(plot).map(({ s, i }) => ({ text: s.label, stroke: strokeOf(plot, i) }));
  return canvasesToPng(figure, [plot.ctx.canvas], lines);
}

function chartSvg(figure, plot, d) {
  const ratio = devicePixelRatio, b = plot.bbox, left = b.left / ratio, top = b.top / ratio + 30, w = b.width / ratio, h = b.height / ratio;
  const X = v => left + plot.valToPos(v, "x"), Y = v => top + plot.valToPos(v, "y");
  const { x, y } = plot.scales, shown = shownSeries(plot), ink = colour("--ink"), grid = colour("--grid");
  const width = plot.width, height = plot.height + 30 + 20 * shown.length + 8, out = [];
  const text = (at, up, words, more = "") => out.push(`<text x='${at.toFixed(1)}' y='${up.toFixed(1)}' fill='${ink}' ${SVG_FONT} ${more}>${escapeXml(words)}</text>`);
  const line = (a, c, e, f, colour, more = "") => out.push(`<line x1='${a.toFixed(2)}' y1='${c.toFixed(2)}' x2='${e.toFixed(2)}' y2='${f.toFixed(2)}' stroke='${colour}' ${more}/>`);
  text(8, 18, figureTitle(figure), "font-weight='600'");
  for (const v of ticks(x.min, x.max)) { line(X(v), top, X(v), top + h, grid); text(X(v), top + h + 16, number(v, 6), "text-anchor='middle'"); }
  for (const v of y.distr === 3 ? logSplits(plot, 1, y.min, y.max) : ticks(y.min, y.max)) {
    line(left, Y(v), left + w, Y(v), grid);
    text(left - 6, Y(v) + 4, y.distr === 3 ? power(v) : number(v, 6), "text-anchor='end'");
  }
  text(left + w / 2, top + h + 34, plot.axes[0].label, "text-anchor='middle' font-weight='600'");
  text(0, 0, plot.axes[1].label, `text-anchor='middle' font-weight='600' transform='translate(14 ${(top + h / 2).toFixed(1)}) rotate(-90)'`);
  // An inner picture cuts what a zoom leaves outside.
  out.push(`<svg x='${left}' y='${top}' width='${w}' height='${h}' viewBox='${left} ${top} ${w} ${h}'>`);
  for (const { i } of shown) {
    const colour = strokeOf(plot, i), xs = plot.data[0], ys = plot.data[i];
    if (d.orders) {
      for (let k = 0; k < xs.length; k++) if (ys[k] > y.min) line(X(xs[k]), Y(y.min), X(xs[k]), Y(ys[k]), colour, "stroke-width='1.5'");
      continue;
    }
    let path = "", pen = "M";
    for (let k = 0; k < xs.length; k++) {
      if (ys[k] == null) { pen = "M"; continue; }
      path += `${pen}${X(xs[k]).toFixed(2)} ${Y(ys[k]).toFixed(2)}`;
      pen = "L";
    }
    out.push(`<path d='${path}' fill='none' stroke='${colour}' stroke-width='1.5' stroke-dasharray='${dashOf(d.series[i - 1]).join(" ")}'/>`);
  }
  out.push(`</svg><rect x='${left}' y='${top}' width='${w}' height='${h}' fill='none' stroke='${colour("--line")}'/>`);
  shown.forEach(({ s, i }, n) => {
    const at = plot.height + 30 + 20 * n + 6;
    line(12, at, 34, at, strokeOf(plot, i), "stroke-width='2'");
    text(42, at + 4, s.label);
  });
  return `<svg xmlns='http://www.w3.org/2000/svg' width='${width}' height='${height}' viewBox='0 0 ${width} ${height}'>` +
    `<rect width='100%' height='100%' fill='${colour("--paper")}'/>${out.join("")}</svg>`;
}

function chartCsv(plot) {
  const rows = [plot.series.map(s => csvCell(s.label)).join(",")];
  for (let k = 0; k < plot.data[0].length; k++) rows.push(plot.data.map(column => csvNumber(column[k])).join(","));
  return rows.join("\n") + "\n";
}
