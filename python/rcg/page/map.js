'use strict';
// A map on a canvas: zoom, place and value. The colours are those of rc-render, which draws all figures.

const PREFIX = ['f', 'p', 'n', 'µ', 'm', '', 'k', 'M', 'G', 'T'];
// A number with its unit: 3e-6 m is 3 µm, 3e-12 m2 is 3 µm².
function shown(value, unit, digits = 5) {
  if (!Number.isFinite(value)) return 'missing';
  const power = +(/^m([23])/.exec(unit)?.[1] ?? 1), name = unit === '1' ? '' : unit.replace(/m2\b/, 'm²').replace(/m3\b/, 'm³');
  const scaled = value !== 0 && /^(m|N|Pa|J|W|s)/.test(unit);
  const third = scaled ? Math.min(Math.max(Math.floor(Math.log10(Math.abs(value) * 1.0000001) / 3 / power), -5), 4) : 0;
  const text = String(+(value / 10 ** (3 * third * power)).toPrecision(digits)).replace('-', '−');
  return text + (name && ` ${PREFIX[third + 5]}${name}`);
}

// One of two nodes that share a pixel; a missing one does not count.
const KEEP = {
  largest: (a, b) => (a > b || b !== b ? a : b),
  smallest: (a, b) => (a < b || b !== b ? a : b),
};
function mean(...four) {
  const there = four.filter(v => v === v);
  return there.reduce((sum, v) => sum + v, 0) / there.length;
}
// The next level of the pyramid, of half the size. With `largest` no node of a contact vanishes in it.
function halved({values, nx, ny}, keep) {
  const mx = Math.ceil(nx / 2), my = Math.ceil(ny / 2), half = new Float32Array(mx * my), pick = KEEP[keep];
  for (let r = 0; r < my; r++) {
    const one = 2 * r * nx, two = Math.min(2 * r + 1, ny - 1) * nx;
    for (let c = 0; c < mx; c++) {
      const left = 2 * c, right = Math.min(left + 1, nx - 1);
      const a = values[one + left], b = values[one + right], d = values[two + left], e = values[two + right];
      half[r * mx + c] = pick ? pick(pick(a, b), pick(d, e)) : mean(a, b, d, e);
    }
  }
  return {values: half, nx: mx, ny: my};
}
// The smallest and the largest value, or the percentiles 0.5 and 99.5 of some 100 000 values.
function range(values, clip) {
  if (clip) {
    const step = Math.ceil(values.length / 1e5), some = values.filter((v, k) => v === v && k % step === 0).sort();
    return some.length ? [some[Math.floor(0.005 * some.length)], some[Math.ceil(0.995 * some.length) - 1]] : [0, 0];
  }
  let low = Infinity, high = -Infinity;
  for (const v of values) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  return low <= high ? [low, high] : [0, 0];
}

class MapView {
  constructor(canvas, tell) {
    Object.assign(this, {canvas, tell, frame: null, pointer: null});
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener('wheel', e => { e.preventDefault(); this.zoom(Math.exp(-e.deltaY / 400), e.offsetX, e.offsetY); });
    canvas.onpointerdown = e => canvas.setPointerCapture(e.pointerId);
    canvas.onpointermove = e => {
      this.pointer = [e.offsetX, e.offsetY];
      if (e.buttons) this.move(e.movementX, e.movementY);
      this.read();
    };
    const keys = {ArrowLeft: () => this.move(40, 0), ArrowRight: () => this.move(-40, 0), ArrowUp: () => this.move(0, 40),
      ArrowDown: () => this.move(0, -40), '+': () => this.zoom(1.5), '=': () => this.zoom(1.5), '-': () => this.zoom(1 / 1.5), 0: () => this.fit()};
    canvas.onkeydown = e => {
      if (!keys[e.key] || e.ctrlKey) return;
      e.preventDefault();
      this.pointer = null; // the keys read the value in the middle
      keys[e.key]();
      this.read();
    };
    canvas.onfocus = canvas.onblur = () => this.draw();
  }
  // frame: nx, ny, dx, dy, unit, dunit, values; colours(low, high) gives 257 pixels.
  async show(frame, keep, clip, colours) {
    const same = this.frame && ['nx', 'ny', 'dx', 'dy'].every(k => this.frame[k] === frame[k]), levels = [frame];
    while (Math.max(levels.at(-1).nx, levels.at(-1).ny) > 32) levels.push(halved(levels.at(-1), keep));
    const [low, high] = range(frame.values, clip), table = await colours(low, high);
    Object.assign(this, {frame, keep, levels, low, high, table});
    if (same) this.draw(); else this.fit();
  }
  // The part of the canvas that has the map, in pixels of the page.
  room() { return {left: 12, top: 12, width: this.canvas.clientWidth - 132, height: this.canvas.clientHeight - 56}; }
  fit() {
    const {nx, ny, dx, dy} = this.frame, {left, top, width, height} = this.room();
    this.scale = Math.min(width / nx, height / (ny * dy / dx)); // pixels of the page per column
    this.x = left + (width - nx * this.scale) / 2;
    this.y = top + (height - ny * this.scale * dy / dx) / 2;
    this.draw();
  }
  middle() {
    const {left, top, width, height} = this.room();
    return [left + width / 2, top + height / 2];
  }
  zoom(by, x = this.middle()[0], y = this.middle()[1]) {
    by = Math.min(Math.max(this.scale * by, 40 / Math.max(this.frame.nx, this.frame.ny)), 80) / this.scale;
    this.scale *= by;
    this.move((1 - by) * (x - this.x), (1 - by) * (y - this.y));
  }
  move(x, y) {
    this.x += x;
    this.y += y;
    this.draw();
  }
  // Column and row at a place of the canvas, as fractions; x and y of a node, from the middle of the map.
  node(x, y) { return [(x - this.x) / this.scale, (y - this.y) / (this.scale * this.frame.dy / this.frame.dx)]; }
  at(c, r) { return [(c - (this.frame.nx - 1) / 2) * this.frame.dx, (r - (this.frame.ny - 1) / 2) * this.frame.dy]; }
  // First and last column and row that are visible.
  part() {
    const {left, top, width, height} = this.room(), within = (v, n) => Math.min(Math.max(Math.floor(v), 0), n - 1);
    const [[c, r], [d, s]] = [this.node(left, top), this.node(left + width - 0.1, top + height - 0.1)];
    return [within(c, this.frame.nx), within(r, this.frame.ny), within(d, this.frame.nx), within(s, this.frame.ny)];
  }
  read() {
    if (!this.frame) return;
    const {nx, ny, unit, dunit, values} = this.frame, [c, r] = this.node(...(this.pointer ?? this.middle())).map(Math.floor);
    const [x, y] = this.at(c, r), inside = c >= 0 && r >= 0 && c < nx && r < ny;
    this.tell(inside ? `x ${shown(x, dunit)}, y ${shown(y, dunit)}: ${shown(values[r * nx + c], unit)}` : '');
  }
  draw() {
    const {canvas, frame, low, high, table} = this, dense = devicePixelRatio, began = performance.now(), g = canvas.getContext('2d');
    if (!frame || !canvas.clientWidth) return;
    canvas.width = Math.round(canvas.clientWidth * dense);
    canvas.height = Math.round(canvas.clientHeight * dense);
    const {left, top, width, height} = this.room(), w = Math.round(width * dense), h = Math.round(height * dense);
    // The level whose nodes cover at least a pixel each, or two where the largest or smallest of them is shown: it is seen.
    const columns = 1 / (this.scale * dense), rows = columns * frame.dx / frame.dy, [first, row] = this.node(left, top);
    const most = Math.max(columns, rows), wanted = most > 1 ? Math.ceil(Math.log2(most * (KEEP[this.keep] ? 2 : 1))) : 0;
    const k = Math.min(wanted, this.levels.length - 1);
    const {values, nx} = this.levels[k], image = g.createImageData(w, h), out = new Uint32Array(image.data.buffer);
    const places = (n, from, step, all) => Int32Array.from({length: n}, (_, p) => {
      const node = Math.floor(from + (p + 0.5) * step);
      return node < 0 || node >= all ? -1 : node >> k;
    });
    const across = places(w, first, columns, frame.nx), down = places(h, row, rows, frame.ny), by = high > low ? 255 / (high - low) : 0;
    for (let r = 0; r < h; r++) {
      for (let c = 0; down[r] >= 0 && c < w; c++) {
        const v = values[down[r] * nx + across[c]];
        // Only the lowest value has its colour, which is that of no contact in a map of pressure.
        if (across[c] >= 0) out[r * w + c] = v !== v ? table[256] : table[v > low ? Math.min(255, Math.ceil((v - low) * by)) : 0];
      }
    }
    g.putImageData(image, left * dense, top * dense);
    g.setTransform(dense, 0, 0, dense, 0, 0);
    this.legend(g);
    canvas.dataset.milliseconds = (performance.now() - began).toFixed(1);
  }
  // A bar of length, a bar of colours, and the place whose value the keys read.
  legend(g) {
    const {left, top, width, height} = this.room(), {frame, low, high} = this, bar = left + width + 12, style = getComputedStyle(this.canvas);
    const most = width / 4 / this.scale * frame.dx, ten = 10 ** Math.floor(Math.log10(most)), length = [5, 2, 1].find(n => n * ten <= most) * ten;
    Object.assign(g, {font: '13px ' + style.fontFamily, fillStyle: style.color, strokeStyle: style.color, textBaseline: 'middle'});
    g.fillRect(left, top + height + 16, length / frame.dx * this.scale, 4);
    g.fillText(shown(length, frame.dunit), left + length / frame.dx * this.scale + 8, top + height + 18);
    for (const part of [0, 0.25, 0.5, 0.75, 1]) g.fillText(shown(low + part * (high - low), frame.unit, 3), bar + 24, top + 7 + (1 - part) * (height - 14));
    const image = g.createImageData(1, 256), ramp = new OffscreenCanvas(1, 256);
    new Uint32Array(image.data.buffer).set(this.table.slice(0, 256).reverse());
    ramp.getContext('2d').putImageData(image, 0, 0);
    g.drawImage(ramp, bar, top, 16, height);
    if (document.activeElement !== this.canvas) return;
    const [x, y] = this.middle();
    for (const [colour, line] of [['#fff', 3], ['#000', 1]]) {
      Object.assign(g, {strokeStyle: colour, lineWidth: line});
      g.strokeRect(x - 6, y - 6, 12, 12);
    }
  }
}
