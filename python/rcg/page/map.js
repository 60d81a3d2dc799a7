// SPDX-License-Identifier: GPL-3.0-or-later
'use strict';
// A map on a canvas: zoom, place and value. The colours are those of rc-render, which draws all figures.

const PREFIX = ['f', 'p', 'n', 'µ', 'm', '', 'k', 'M', 'G', 'T'];
// A number with its unit: 3e-6 m is 3 µm, 3e-12 m2 is 3 µm². The prefix is that of the number `like`.
function shown(value, unit, digits = 5, like = value) {
  if (!Number.isFinite(value)) return 'missing';
  const power = +(/^m([23])/.exec(unit)?.[1] ?? 1), scaled = like !== 0 && /^(m|N|Pa|J|W|s|B)/.test(unit);
  const name = unit === '1' ? '' : unit.replace(/m2\b/, 'm²').replace(/m3\b/, 'm³');
  const third = scaled ? Math.floor(Math.log10(Math.abs(like) * 1.0000001) / 3 / power) : 0;
  const within = third < -5 ? 0 : Math.min(third, 4); // below a femtometre it is 2.1e-20 m
  const text = String(+(value / 10 ** (3 * within * power)).toPrecision(digits)).replaceAll('-', '−');
  return text + (name && ` ${PREFIX[within + 5]}${name}`);
}

// The value of two nodes that share a pixel; a missing one does not count.
const KEEP = {
  largest: (a, b) => (a > b || b !== b ? a : b),
  smallest: (a, b) => (a < b || b !== b ? a : b),
  mean: (a, b) => (a !== a ? b : b !== b ? a : (a + b) / 2),
};
// The next level of the pyramid, of half the size. With `largest` no node of a contact vanishes in it.
function halved({values, nx, ny}, keep) {
  const mx = Math.ceil(nx / 2), my = Math.ceil(ny / 2), half = new Float32Array(mx * my);
  for (let r = 0; r < my; r++) {
    for (let c = 0; c < mx; c++) {
      const one = 2 * (r * nx + c), next = 2 * c + 1 < nx ? 1 : 0, two = 2 * r + 1 < ny ? one + nx : one;
      half[r * mx + c] = keep(keep(values[one], values[one + next]), keep(values[two], values[two + next]));
    }
  }
  return {values: half, nx: mx, ny: my};
}

// Colours of heights from 0.5 % to 99.5 % of the nodes, where the others would take half of the range: spikes.
function clipped(values, low, high) {
  const step = Math.ceil(values.length / 65536), some = [];
  for (let k = 0; k < values.length; k += step) if (values[k] === values[k]) some.push(values[k]);
  some.sort((a, b) => a - b);
  const part = share => some[Math.round(share * (some.length - 1))];
  return part(0.995) - part(0.005) < (high - low) / 2 && part(0.995) > part(0.005) ? [part(0.005), part(0.995)] : [low, high];
}

// A section with rows of even depths, at most 1024 or one in the smallest step; between two rows it is linear.
function evenly(section, values) {
  const {nx, ny} = section, depths = section.depths.split(',').map(Number), top = depths[0], all = depths.at(-1) - top;
  const least = Math.min(...depths.slice(1).map((depth, k) => depth - depths[k]).filter(step => step > 0));
  const rows = ny > 1 ? Math.min(Math.round(all / least) + 1, 1024) : 1, dy = rows > 1 ? all / (rows - 1) : section.dy;
  const made = new Float64Array(rows * nx);
  for (let r = 0, k = 0; r < rows; r++) {
    while (k + 2 < ny && depths[k + 1] <= top + r * dy) k++;
    const part = rows > 1 ? Math.min((top + r * dy - depths[k]) / (depths[k + 1] - depths[k]), 1) : 0;
    for (let c = 0; c < nx; c++) {
      const above = values[k * nx + c];
      made[r * nx + c] = part > 0 ? (1 - part) * above + part * values[(k + 1) * nx + c] : above;
    }
  }
  return {...section, ny: rows, dy, top, values: made};
}

function extremes(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  return low > high ? [0, 0] : [low, high];
}
// Round numbers from low to high, three to eight of them.
function rounds(low, high) {
  const ten = 10 ** Math.floor(Math.log10((high - low) / 3)), count = step => Math.floor(high / step) - Math.ceil(low / step) + 1;
  const step = [5, 2, 1, 0.5].map(n => n * ten).find(wide => count(wide) >= 3);
  return Array.from({length: step ? count(step) : 0}, (_, k) => +((Math.ceil(low / step) + k) * step).toPrecision(12));
}

class MapView {
  constructor(canvas, tell) {
    Object.assign(this, {canvas, tell, frame: null, pointer: null});
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.onwheel = e => {
      e.preventDefault();
      this.zoom(Math.exp(-e.deltaY / 400), e.offsetX, e.offsetY);
    };
    canvas.onpointerdown = e => canvas.setPointerCapture(e.pointerId);
    canvas.onpointermove = e => {
      this.pointer = [e.offsetX, e.offsetY];
      if (e.buttons) this.move(e.movementX, e.movementY);
      this.read();
    };
    const ways = {ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40]};
    const factors = {'+': 1.5, '=': 1.5, '-': 1 / 1.5};
    canvas.onkeydown = e => {
      if (e.ctrlKey || !(e.key in ways || e.key in factors || e.key === '0')) return;
      e.preventDefault();
      this.pointer = null; // the keys read the value in the middle
      if (e.key in ways) this.move(...ways[e.key]);
      else if (e.key in factors) this.zoom(factors[e.key]);
      else this.fit();
      this.read();
    };
    canvas.onfocus = canvas.onblur = () => this.draw();
  }
  // frame: nx, ny, dx, dy, unit, dunit, values; keep: a name of KEEP; colours(low, high) gives 257 pixels.
  async show(frame, keep, colours) {
    const levels = [frame], same = ['nx', 'ny', 'dx', 'dy'].every(k => this.frame?.[k] === frame[k]);
    while (Math.max(levels.at(-1).nx, levels.at(-1).ny) > 32) levels.push(halved(levels.at(-1), KEEP[keep]));
    const [low, high] = extremes(frame.values);
    const [from, to] = keep === 'mean' ? clipped(frame.values, low, high) : [low, high];
    Object.assign(this, {frame, keep, levels, least: low, most: high, low: from, high: to, table: await colours(from, to)});
    if (same) this.draw(); else this.fit();
  }
  // The part of the canvas that has the map, and its middle, in pixels of the page.
  room() {
    const left = 12, top = 12, width = this.canvas.clientWidth - 132, height = this.canvas.clientHeight - 56;
    return {left, top, width, height, middle: [left + width / 2, top + height / 2]};
  }
  fit() {
    const {nx, ny, dx, dy} = this.frame, {width, height, middle: [x, y]} = this.room();
    this.scale = Math.min(width / nx, height / (ny * dy / dx)); // pixels of the page per column
    this.x = x - nx * this.scale / 2;
    this.y = y - ny * this.scale * dy / dx / 2;
    this.draw();
  }
  zoom(by, x = this.room().middle[0], y = this.room().middle[1]) {
    const least = 40 / Math.max(this.frame.nx, this.frame.ny);
    by = Math.min(Math.max(this.scale * by, least), 80) / this.scale;
    this.scale *= by;
    this.move((1 - by) * (x - this.x), (1 - by) * (y - this.y));
  }
  move(x, y) {
    this.x += x;
    this.y += y;
    this.draw();
  }
  // Column and row at a place of the canvas, as fractions.
  node(x, y) {
    return [(x - this.x) / this.scale, (y - this.y) / (this.scale * this.frame.dy / this.frame.dx)];
  }
  // First and last column and row that are visible.
  part() {
    const {left, top, width, height} = this.room(), sizes = [this.frame.nx, this.frame.ny];
    return [...this.node(left, top), ...this.node(left + width - 0.1, top + height - 0.1)].map((v, k) =>
      Math.min(Math.max(Math.floor(v), 0), sizes[k % 2] - 1));
  }
  read() {
    if (!this.frame) return;
    const {nx, ny, dx, dy, unit, dunit, values, section, top} = this.frame;
    const [c, r] = this.node(...(this.pointer ?? this.room().middle)).map(Math.floor);
    const down = section ? top + r * dy : (r - (ny - 1) / 2) * dy;
    const [across, below] = [(c - (nx - 1) / 2) * dx, down].map(place => shown(place, dunit));
    const inside = c >= 0 && r >= 0 && c < nx && r < ny, names = {x: ['y', 'depth'], y: ['x', 'depth']}[section] ?? ['x', 'y'];
    this.tell(inside ? `${names[0]} ${across}, ${names[1]} ${below}: ${shown(values[r * nx + c], unit)}` : '');
  }
  draw() {
    const {canvas, frame, low, high, table} = this, dense = devicePixelRatio, began = performance.now();
    if (!frame || !canvas.clientWidth) return;
    canvas.width = Math.round(canvas.clientWidth * dense);
    canvas.height = Math.round(canvas.clientHeight * dense);
    const {left, top, width, height} = this.room(), [w, h] = [width, height].map(n => Math.round(n * dense));
    const columns = 1 / (this.scale * dense), rows = columns * frame.dx / frame.dy;
    // The level whose nodes cover at least a pixel each; two where the largest or smallest of them is shown.
    const most = Math.max(columns, rows);
    const wanted = most > 1 ? Math.ceil(Math.log2(this.keep === 'mean' ? most : 2 * most)) : 0;
    const k = Math.min(wanted, this.levels.length - 1);
    const {values, nx} = this.levels[k], g = canvas.getContext('2d'), image = g.createImageData(w, h);
    const out = new Uint32Array(image.data.buffer), by = high > low ? 255 / (high - low) : 0;
    const places = (n, from, step, all) => Int32Array.from({length: n}, (_, p) => {
      const node = Math.floor(from + (p + 0.5) * step);
      return node < 0 || node >= all ? -1 : node >> k;
    });
    const [first, row] = this.node(left, top), across = places(w, first, columns, frame.nx);
    places(h, row, rows, frame.ny).forEach((down, r) => {
      for (let c = 0; down >= 0 && c < w; c++) {
        const v = values[down * nx + across[c]];
        // Only the lowest value has its colour, which is that of no contact in a map of pressure.
        const at = v > low ? Math.min(255, Math.ceil((v - low) * by)) : 0;
        if (across[c] >= 0) out[r * w + c] = table[v === v ? at : 256];
      }
    });
    g.putImageData(image, left * dense, top * dense);
    g.setTransform(dense, 0, 0, dense, 0, 0);
    this.legend(g);
    canvas.dataset.milliseconds = (performance.now() - began).toFixed(1);
  }
  // A bar of length, a bar of colours, and the place whose value the keys read.
  legend(g) {
    const {left, top, width, height, middle: [x, y]} = this.room(), {frame, low, high, canvas} = this;
    const bar = left + width + 12, most = width / 4 / this.scale * frame.dx;
    const ten = 10 ** Math.floor(Math.log10(most)), {fontFamily, color} = getComputedStyle(canvas);
    const length = [5, 2, 1].find(n => n * ten <= most) * ten, long = length / frame.dx * this.scale;
    Object.assign(g, {font: '13px ' + fontFamily, fillStyle: color, textBaseline: 'middle'});
    g.fillRect(left, top + height + 16, long, 4);
    g.fillText(shown(length, frame.dunit), left + long + 8, top + height + 18);
    for (const mark of high > low ? rounds(low, high) : [low]) {
      const y = top + (high > low ? (high - mark) / (high - low) : 0.5) * height;
      g.fillRect(bar + 16, y - 0.5, 5, 1);
      g.fillText(mark === 0 ? '0' : shown(mark, frame.unit, 4), bar + 24, Math.min(Math.max(y, top + 7), top + height - 7));
    }
    const image = g.createImageData(1, 256), ramp = new OffscreenCanvas(1, 256);
    new Uint32Array(image.data.buffer).set(this.table.slice(0, 256).reverse());
    ramp.getContext('2d').putImageData(image, 0, 0);
    g.drawImage(ramp, bar, top, 16, height);
    if (document.activeElement !== canvas) return;
    for (const [strokeStyle, lineWidth] of [['#fff', 3], ['#000', 1]]) {
      Object.assign(g, {strokeStyle, lineWidth});
      g.strokeRect(x - 6, y - 6, 12, 12);
    }
  }
}
