// A plane mesh coloured by a value: a small rasteriser that also knows which quad lies under the cursor.
let lastScroll = -1e9; // while the page scrolls, the wheel belongs to the page
addEventListener("scroll", () => { lastScroll = performance.now(); }, { passive: true });

function fieldPicture(figure, place, d) {
  const coordinates = unpack(d.coordinates, Uint16Array), values = unpack(d.values, Float32Array);
  const quads = d.quads16 ? unpack(d.quads16, Uint16Array) : unpack(d.quads32, Uint32Array);
  const count = coordinates.length / 2, X = new Float64Array(count), Y = new Float64Array(count);
  for (let i = 0; i < count; i++) {
    X[i] = d.origin[0] + d.step * coordinates[2 * i];
    Y[i] = d.origin[1] + d.step * coordinates[2 * i + 1];
  }
  const quadCount = quads.length / 4, marks = d.marks || [];
  const shades = d.shades ? unpack(d.shades, Float32Array) : null; // of a body in space: x and y tell nothing then
  const largest = values.reduce((m, v) => Math.max(m, v), -Infinity);
  const least = values.reduce((m, v) => Math.min(m, v), Infinity);
  const peak = peakPlace(), box = bounds(), border = outline();
  let low = d.low, high = d.high, view = null, width = 0, height = 0, ratio = 1, ids = null, seen = null, pending = false;

  const canvas = element("canvas", { tabIndex: 0 });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${figure.querySelector("figcaption").textContent}: ${d.quantity}, largest ${number(largest)} ${d.unit}. ` +
    "Plus and minus zoom, arrows move, 0 shows all.");
  const bar = element("canvas", { className: "bar" });
  const readout = element("p", { className: "readout" });
  const limit = element("input", { type: "number", value: Number(high.toPrecision(4)), step: "any" });
  const lines = element("input", { type: "checkbox", checked: !!shades }); // a body in space shows its shape by them
  limit.onchange = () => { const v = Number(limit.value); if (v > low) { high = v; request(); } else limit.value = Number(high.toPrecision(4)); };
  lines.onchange = request;
  place.before(element("div", { className: "tools" },
    element("span", { className: "hint", textContent: "Wheel or +/− to zoom, drag or arrows to move." }),
    element("label", {}, lines, "mesh"),
    element("label", {}, `colours to [${d.unit}]`, limit),
    button("Largest value", () => { view = { x: peak.x, y: peak.y, width: Math.max(box.width / 12, d.step * 200) }; request(); }),
    button("Show all", () => { view = null; request(); }),
    ...downloads(figure, { PNG: () => canvasesToPng(figure, [canvas, bar]), SVG: fieldSvg, CSV: fieldCsv })));
  place.append(element("div", { className: "field" }, element("div", { className: "plane" }, canvas), bar), readout);
  if (d.window) view = { ...d.window };
  rest();

  function rest() {
    const at = shades ? "" : ` at x ${number(peak.x)}, y ${number(peak.y)} mm`;
    readout.textContent = `${d.quantity}: least ${number(least)}, largest ${number(largest)} ${d.unit}${at}`;
  }

  // All elements, the colours those of the bar.
  function fieldSvg() {
    const all = bounds(), f = 900 / all.width, w = 900, h = Math.ceil(all.height * f), x0 = all.x - all.width / 2, y1 = all.y + all.height / 2;
    const fill = (v, q) => `rgb(${mapColour((v - low) / (high - low)).map(c => Math.round(shades ? c * shades[q] : c)).join(",")})`, out = [];
    for (let q = 0; q < quadCount; q++) {
      const n = [0, 1, 2, 3].map(k => quads[4 * q + k]);
      const v = d.perNode ? n.reduce((s, k) => s + values[k], 0) / 4 : values[q];
      out.push(`<polygon points='${n.map(k => `${((X[k] - x0) * f).toFixed(2)},${((y1 - Y[k]) * f + 30).toFixed(2)}`).join(" ")}' fill='${fill(v, q)}' stroke='${fill(v, q)}' stroke-width='0.3'/>`);
    }
    for (const m of marks) {
      const x = (m.x - x0) * f, y = (y1 - m.y) * f + 30;
      if (m.sign !== "words") out.push(`<${m.sign === "ring" ? `circle cx='${x.toFixed(2)}' cy='${y.toFixed(2)}' r='6'` : `rect x='${(x - 5).toFixed(2)}' y='${(y - 5).toFixed(2)}' width='10' height='10'`} fill='none' stroke='black' stroke-width='1.5'/>`);
      out.push(`<text x='${(x + 10).toFixed(1)}' y='${(y + (m.sign === "square" ? 18 : -8)).toFixed(1)}' ${SVG_FONT} stroke='white' stroke-width='3' paint-order='stroke'>${escapeXml(m.words)}</text>`);
    }
    const words = `${figureTitle(figure)}: ${d.quantity}, ${number(low)} (dark) to ${number(high)} ${d.unit} (light)`;
    return `<svg xmlns='http://www.w3.org/2000/svg' width='${w}' height='${h + 34}' viewBox='0 0 ${w} ${h + 34}'><rect width='100%' height='100%' fill='white'/>` +
      `<text x='8' y='18' ${SVG_FONT}>${escapeXml(words)}</text>${out.join("")}</svg>`;
  }
  function fieldCsv() {
    const rows = [`x_mm,y_mm,${csvCell(`${d.quantity} [${d.unit}]`)}`];
    if (d.perNode) for (let i = 0; i < count; i++) rows.push(`${X[i]},${Y[i]},${values[i]}`);
    else for (let q = 0; q < quadCount; q++) {
      const n = [0, 1, 2, 3].map(k => quads[4 * q + k]);
      rows.push(`${n.reduce((s, k) => s + X[k], 0) / 4},${n.reduce((s, k) => s + Y[k], 0) / 4},${values[q]}`);
    }
    return rows.join("\n") + "\n";
  }
  function peakPlace() {
    let best = 0;
    for (let i = 1; i < values.length; i++) if (values[i] > values[best]) best = i;
    if (d.perNode) return { x: X[best], y: Y[best] };
    const c = [0, 1, 2, 3].map(k => quads[4 * best + k]);
    return { x: c.reduce((s, n) => s + X[n], 0) / 4, y: c.reduce((s, n) => s + Y[n], 0) / 4 };
  }
  function bounds() {
    let a = Infinity, b = -Infinity, c = Infinity, e = -Infinity;
    for (let i = 0; i < count; i++) { a = Math.min(a, X[i]); b = Math.max(b, X[i]); c = Math.min(c, Y[i]); e = Math.max(e, Y[i]); }
    return { x: (a + b) / 2, y: (c + e) / 2, width: b - a, height: e - c };
  }
  // Edges that belong to one quad only.
  function outline() {
    const edges = new Map();
    for (let q = 0; q < quadCount; q++) for (let k = 0; k < 4; k++) {
      const a = quads[4 * q + k], b = quads[4 * q + (k + 1) % 4], key = a < b ? a * count + b : b * count + a;
      if (edges.has(key)) edges.set(key, null); else edges.set(key, [a, b, q]);
    }
    return [...edges.values()].filter(e => e && e[0] !== e[1]);
  }
  // Of a body in space: whether an edge of this quad is seen about a place, in pixels.
  function isSeen(q, [x, y]) {
    for (let j = Math.round(y) - 2; j <= Math.round(y) + 1; j++) for (let i = Math.round(x) - 2; i <= Math.round(x) + 1; i++) {
      if (i >= 0 && j >= 0 && i < width && j < height && ids[j * width + i] === q) return true;
    }
    return false;
  }

  const whole = () => ({ x: box.x, y: box.y, width: 1.04 * Math.max(box.width, box.height * width / height) });
  const scale = () => width / view.width;
  const toPixel = n => [(X[n] - view.x) * scale() + width / 2, height / 2 - (Y[n] - view.y) * scale()];

  function request() {
    if (!pending) { pending = true; requestAnimationFrame(() => { pending = false; paint(); }); }
  }
  function draw() {
    ratio = printing ? 2 : devicePixelRatio;
    const room = drawingWidth(place) - 102;
    width = Math.max(120, Math.round(room * ratio));
    const most = Math.min(620, Math.max(320, room * 0.62));
    // A flat shape has no empty room above and below, but for the scale under it.
    const needed = d.window ? most : Math.max(240, room * box.height / box.width + 90);
    height = Math.round(Math.min(most, needed) * ratio);
    canvas.width = width; canvas.height = height;
    canvas.style.height = `${height / ratio}px`;
    paint(); // at once: a print does not wait for a frame
  }
  function paint() {
    if (!view) view = whole();
    raster();
    const ctx = canvas.getContext("2d"), image = ctx.createImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    const table = colours();
    for (let p = 0; p < ids.length; p++) {
      if (ids[p] < 0) continue;
      const colour = table[Math.min(255, Math.max(0, Math.round((seen[p] - low) / (high - low) * 255)))];
      pixels[p] = shades ? shaded(colour, shades[ids[p]]) : colour;
    }
    // By way of a second canvas: what putImageData writes is lost in print.
    const sheet = element("canvas", { width, height });
    sheet.getContext("2d").putImageData(image, 0, 0);
    ctx.clearRect(0, 0, width, height);
    ctx.drawImage(sheet, 0, 0);
    strokes(ctx);
    paintBar();
  }
  function colours() {
    const table = new Uint32Array(256);
    for (let i = 0; i < 256; i++) { const [r, g, b] = mapColour(i / 255); table[i] = (255 << 24 | b << 16 | g << 8 | r) >>> 0; }
    return table;
  }

  function shaded(colour, light) {
    const channel = shift => Math.round((colour >>> shift & 255) * light) << shift;
    return (255 << 24 | channel(16) | channel(8) | channel(0)) >>> 0;
  }

  function raster() {
    ids = new Int32Array(width * height).fill(-1);
    seen = new Float32Array(width * height);
    const s = scale(), px = new Float64Array(count), py = new Float64Array(count);
    for (let i = 0; i < count; i++) { px[i] = (X[i] - view.x) * s + width / 2; py[i] = height / 2 - (Y[i] - view.y) * s; }
    const value = (q, n) => (d.perNode ? values[n] : values[q]);
    for (let q = 0; q < quadCount; q++) {
      const a = quads[4 * q], b = quads[4 * q + 1], c = quads[4 * q + 2], e = quads[4 * q + 3];
      triangle(q, px, py, a, b, c, value(q, a), value(q, b), value(q, c));
      triangle(q, px, py, a, c, e, value(q, a), value(q, c), value(q, e));
    }
  }
  function triangle(q, px, py, a, b, c, va, vb, vc) {
    const ax = px[a], ay = py[a], bx = px[b], by = py[b], cx = px[c], cy = py[c];
    const x0 = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5)), x1 = Math.min(width - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    const y0 = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5)), y1 = Math.min(height - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    if (x0 > x1 || y0 > y1) return;
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    const slack = -1e-9;
    for (let y = y0; y <= y1; y++) for (let x = x0; x <= x1; x++) {
      const dx = x + 0.5, dy = y + 0.5;
      const wa = ((bx - dx) * (cy - dy) - (by - dy) * (cx - dx)) / area, wb = ((cx - dx) * (ay - dy) - (cy - dy) * (ax - dx)) / area, wc = 1 - wa - wb;
      if (wa < slack || wb < slack || wc < slack) continue;
      const p = y * width + x;
      ids[p] = q;
      seen[p] = wa * va + wb * vb + wc * vc;
    }
  }
  function strokes(ctx) {
    if (lines.checked) {
      ctx.strokeStyle = shades ? "rgba(255, 255, 255, 0.2)" : "rgba(255, 255, 255, 0.35)"; ctx.lineWidth = 0.6 * ratio; ctx.beginPath();
      const shown = shades ? new Set(ids) : null;
      for (let q = 0; q < quadCount; q++) {
        if (shown && !shown.has(q)) continue;
        const corners = [0, 1, 2, 3].map(k => toPixel(quads[4 * q + k]));
        if (corners.every(p => p[0] < 0) || corners.every(p => p[0] > width) || corners.every(p => p[1] < 0) || corners.every(p => p[1] > height)) continue;
        corners.forEach((p, k) => (k ? ctx.lineTo(...p) : ctx.moveTo(...p)));
        ctx.closePath();
      }
      ctx.stroke();
    }
    ctx.strokeStyle = colour("--ink"); ctx.lineWidth = 0.9 * ratio; ctx.beginPath();
    for (const [a, b, q] of border) {
      const from = toPixel(a), to = toPixel(b);
      if (shades && !isSeen(q, [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2])) continue;
      ctx.moveTo(...from); ctx.lineTo(...to);
    }
    ctx.stroke();
    for (const mark of marks) drawMark(ctx, mark);
    scaleMark(ctx);
  }
  function drawMark(ctx, { x, y, words, sign }) {
    const px = (x - view.x) * scale() + width / 2, py = height / 2 - (y - view.y) * scale(), r = 6 * ratio;
    const shape = () => { ctx.beginPath(); sign === "ring" ? ctx.arc(px, py, r, 0, 2 * Math.PI) : ctx.rect(px - r, py - r, 2 * r, 2 * r); ctx.stroke(); };
    ctx.save();
    ctx.lineJoin = "round";
    if (sign !== "words") {
      ctx.strokeStyle = colour("--paper"); ctx.lineWidth = 4 * ratio; shape();
      ctx.strokeStyle = colour("--ink"); ctx.lineWidth = 1.6 * ratio; shape();
    }
    ctx.font = font(12.5 * ratio, "600");
    ctx.textBaseline = "middle";
    const wide = ctx.measureText(words).width, right = px + 12 * ratio + wide < width;
    const at = sign === "words" ? px - wide / 2 : right ? px + 10 * ratio : px - 10 * ratio - wide, up = py + { ring: -12, square: 14, words: 0 }[sign] * ratio;
    ctx.strokeStyle = colour("--paper"); ctx.lineWidth = 4 * ratio; ctx.strokeText(words, at, up);
    ctx.fillStyle = colour("--ink"); ctx.fillText(words, at, up);
    ctx.restore();
  }
  // A length to measure by: 1, 2 or 5 times a power of ten, about a seventh of the width.
  function scaleMark(ctx) {
    const aim = view.width / 7, power = 10 ** Math.floor(Math.log10(aim)), length = [5, 2, 1].find(m => m * power <= aim) * power;
    const x = 14 * ratio, y = height - 14 * ratio, pixels = length * scale(), text = `${number(length)} mm`;
    ctx.font = font(12 * ratio);
    ctx.fillStyle = colour("--paper"); ctx.globalAlpha = 0.85;
    ctx.fillRect(x - 6 * ratio, y - 22 * ratio, Math.max(pixels, ctx.measureText(text).width) + 12 * ratio, 30 * ratio);
    ctx.globalAlpha = 1;
    ctx.strokeStyle = ctx.fillStyle = colour("--ink"); ctx.lineWidth = 2 * ratio;
    ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x + pixels, y); ctx.stroke();
    ctx.textBaseline = "bottom"; ctx.textAlign = "left"; ctx.fillText(text, x, y - 4 * ratio);
  }
  // What the bar shows, in lines that have room, and the unit.
  function heads(ctx, room) {
    ctx.font = font(12);
    const lines = [""];
    for (const word of d.quantity.split(" ")) {
      const longer = `${lines[lines.length - 1]} ${word}`.trim();
      if (lines[lines.length - 1] && ctx.measureText(longer).width > room) lines.push(word); else lines[lines.length - 1] = longer;
    }
    return d.unit ? [...lines, `[${d.unit}]`] : lines;
  }
  function paintBar() {
    const w = 92, h = height / ratio, ctx = bar.getContext("2d"), top = 12 + 16 * heads(ctx, w - 6).length, bottom = h - 12;
    bar.width = w * ratio; bar.height = h * ratio; bar.style.height = `${h}px`;
    ctx.scale(ratio, ratio);
    for (let y = top; y < bottom; y++) { const [r, g, b] = mapColour((bottom - y) / (bottom - top)); ctx.fillStyle = `rgb(${r}, ${g}, ${b})`; ctx.fillRect(4, y, 18, 1.5); }
    ctx.strokeStyle = colour("--faint"); ctx.strokeRect(4, top, 18, bottom - top);
    ctx.fillStyle = colour("--ink"); ctx.font = font(12); ctx.textBaseline = "middle";
    heads(ctx, w - 6).forEach((words, k) => ctx.fillText(words, 4, 10 + 16 * k, w - 6));
    ctx.textAlign = "left";
    const mark = (v, text) => { const y = bottom - (bottom - top) * (v - low) / (high - low); ctx.fillRect(22, y - 0.5, 4, 1); ctx.fillText(text, 30, y, w - 32); };
    mark(high, (largest > high * (1 + 1e-6) ? "≥ " : "") + number(high));
    mark(low, (least < low - 1e-6 * Math.abs(high) ? "≤ " : "") + number(low));
    // Round steps between the ends, about six, none within a line's height of an end.
    const aim = (high - low) / 6, power10 = 10 ** Math.floor(Math.log10(aim)), step = [1, 2, 5, 10].find(m => m * power10 >= aim) * power10;
    const clear = 16 * (high - low) / (bottom - top);
    for (let k = Math.ceil(low / step); k * step < high - clear; k++) if (k * step > low + clear) mark(k * step, number(k * step));
  }

  // Moving about.
  const place_ = e => { const r = canvas.getBoundingClientRect(); return [(e.clientX - r.left) * width / r.width, (e.clientY - r.top) * height / r.height]; };
  function zoom(factor, [x, y] = [width / 2, height / 2]) {
    const s = scale(), mx = view.x + (x - width / 2) / s, my = view.y - (y - height / 2) / s;
    view.width = Math.min(Math.max(view.width * factor, d.step * 50), 4 * whole().width);
    const t = scale();
    view.x = mx - (x - width / 2) / t; view.y = my + (y - height / 2) / t;
    request();
  }
  canvas.addEventListener("wheel", e => {
    if (performance.now() - lastScroll < 300) return;
    e.preventDefault();
    zoom(Math.exp(Math.max(-0.4, Math.min(0.4, e.deltaY * (e.deltaMode ? 0.05 : 0.0015)))), place_(e));
  }, { passive: false });
  let held = null;
  canvas.addEventListener("pointerdown", e => { held = place_(e); canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener("pointerup", () => { held = null; });
  canvas.addEventListener("pointercancel", () => { held = null; });
  canvas.addEventListener("pointermove", e => {
    const at = place_(e);
    if (held) { view.x -= (at[0] - held[0]) / scale(); view.y += (at[1] - held[1]) / scale(); held = at; request(); }
    const p = Math.floor(at[1]) * width + Math.floor(at[0]), q = ids ? ids[p] : -1;
    const x = view.x + (at[0] - width / 2) / scale(), y = view.y - (at[1] - height / 2) / scale();
    if (q >= 0 && shades) readout.textContent = `${d.quantity} ${number(seen[p])} ${d.unit}`;
    else if (q >= 0) readout.textContent = `x ${x.toFixed(2)}, y ${y.toFixed(2)} mm: ${d.quantity} ${number(seen[p])} ${d.unit} (element ${q})`.replace(/-/g, "−");
    else rest();
  });
  canvas.addEventListener("pointerleave", rest);
  canvas.addEventListener("dblclick", () => { view = null; request(); });
  canvas.addEventListener("keydown", e => {
    const step = view.width / 10;
    const keys = { "+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), 0: () => { view = null; }, ArrowLeft: () => { view.x -= step; },
      ArrowRight: () => { view.x += step; }, ArrowUp: () => { view.y += step; }, ArrowDown: () => { view.y -= step; } };
    if (keys[e.key]) { e.preventDefault(); keys[e.key](); request(); }
  });
  figures.push(draw);
}
