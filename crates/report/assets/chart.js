// Curves one can zoom into and read.
const LINES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#8a8a8a', '#e69f00', '#56b4e9'];
const DASHES = ['', '6 3', '1.5 2.5', '7 2.5 1.5 2.5'];

/** Round values of a logarithmic axis, by their logarithms: decades, and 2 and 5 between few of them. */
function decades(low, high, count) {
  if (high - low > 3) return ticks(low, high, Math.min(count, high - low)).filter((y) => Math.abs(y - Math.round(y)) < 1e-9);
  const out = [];
  for (let decade = Math.floor(low); decade <= high; decade++) [1, 2, 5].forEach((m) => out.push(decade + Math.log10(m)));
  const inside = out.filter((y) => y >= low && y <= high);
  return inside.length > 1 ? inside : ticks(low, high, count);
}

class Chart {
  /** `host` is an element; `title` is what is read aloud. */
  constructor(host, title) {
    this.title = title;
    this.series = [];
    this.window = null;
    this.at = null;
    this.host = host;
    this.svg = element('svg', { tabindex: 0, role: 'application', 'aria-roledescription': 'chart', 'aria-label': title });
    this.tip = element('div', { class: 'tip', hidden: true });
    this.told = element('p', { class: 'unseen', role: 'status', 'aria-live': 'polite' });
    this.legend = element('ul', { class: 'legend' });
    const button = (text, label, call) => {
      const made = element('button', { type: 'button', 'aria-label': `${label}: ${title}` }, text);
      made.addEventListener('click', call);
      return made;
    };
    this.bar = element('div', { class: 'controls small' },
      button('+', 'Nearer', () => this.zoom(0.5)), button('−', 'Farther', () => this.zoom(2)), button('whole', 'Whole', () => this.whole()));
    this.table = element('details', { class: 'values' }, element('summary', {}, 'values as a table'));
    this.table.addEventListener('toggle', () => this.fillTable());
    host.replaceChildren(this.svg, this.tip, this.legend, this.bar, this.table, this.told);
    this.draw = gathered(() => this.paint());
    new ResizeObserver(() => this.draw()).observe(host);
    onColors.push(() => this.draw());
    this.listen();
  }

  /** Series: `{ name, x, y, marks }`, all of them arrays of numbers or nulls. `names`: of both axes. */
  show(series, names = {}, log = false) {
    this.series = series.map((one, i) => ({ ...one, color: one.color || LINES[i % LINES.length], dash: DASHES[Math.floor(i / LINES.length) % DASHES.length], hidden: false }));
    this.names = names;
    this.log = log;
    this.at = null;
    this.legend.replaceChildren(...this.series.map((one) => {
      const box = element('input', { type: 'checkbox', checked: true });
      box.addEventListener('change', () => { one.hidden = !box.checked; this.draw(); });
      const sample = element('svg', { width: 22, height: 8, 'aria-hidden': true }, element('line', { x1: 0, x2: 22, y1: 4, y2: 4, stroke: one.color, 'stroke-width': 2.5, 'stroke-dasharray': one.dash }));
      return element('li', {}, element('label', {}, box, sample, ` ${one.name}`));
    }));
    this.fillTable();
    this.draw();
  }

  whole() { this.window = null; this.draw(); }

  /** New rows of the same series: what is in view stays. */
  update(series, names, log) {
    const hidden = new Set(this.series.filter((one) => one.hidden).map((one) => one.name));
    const same = series.length === this.series.length && series.every((one, i) => one.name === this.series[i].name) && log === this.log;
    if (!same) { this.show(series, names, log); return; }
    series.forEach((one, i) => Object.assign(this.series[i], one, { hidden: hidden.has(one.name) }));
    this.names = names;
    this.draw();
  }

  value(y) { return this.log ? (y > 0 ? Math.log10(y) : NaN) : y; }

  extent() {
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const one of this.series.filter((one) => !one.hidden)) {
      for (let i = 0; i < one.x.length; i++) {
        const x = one.x[i], y = one.y[i] === null ? NaN : this.value(one.y[i]);
        if (x === null || !Number.isFinite(x) || !Number.isFinite(y)) continue;
        x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y);
      }
    }
    if (!(x0 <= x1)) return { x0: 0, x1: 1, y0: 0, y1: 1, empty: true };
    const pad = (low, high) => (high > low ? 0.04 * (high - low) : 0.5 * Math.abs(high) || 0.5);
    const py = pad(y0, y1), px = high => (x1 > x0 ? 0 : 0.5);
    return { x0: x0 - px(), x1: x1 + px(), y0: y0 - py, y1: y1 + py };
  }

  paint() {
    const width = this.host.clientWidth, height = clamp(0.42 * width, 220, 420);
    if (!width) return;
    this.all = this.extent();
    const view = this.window || this.all;
    const [left, right, top, bottom] = [64, 12, 10, 40];
    const w = Math.max(width - left - right, 10), h = height - top - bottom;
    const X = (x) => left + w * (x - view.x0) / (view.x1 - view.x0), Y = (y) => top + h * (1 - (y - view.y0) / (view.y1 - view.y0));
    this.map = { left, top, w, h, view, X, Y };
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.svg.setAttribute('height', height);
    const parts = [element('rect', { x: left, y: top, width: w, height: h, class: 'frame' })];
    const id = this.host.id + '-clip';
    parts.push(element('defs', {}, element('clipPath', { id }, element('rect', { x: left, y: top, width: w, height: h }))));
    for (const x of ticks(view.x0, view.x1, Math.max(2, w / 90))) {
      parts.push(element('line', { x1: X(x), x2: X(x), y1: top, y2: top + h, class: 'grid' }), element('text', { x: X(x), y: top + h + 15, 'text-anchor': 'middle' }, shown(Number(x.toPrecision(12)))));
    }
    for (const y of this.log ? decades(view.y0, view.y1, h / 45) : ticks(view.y0, view.y1, Math.max(2, h / 45))) {
      const label = shown(this.log ? Number((10 ** y).toPrecision(3)) : Number(y.toPrecision(12)));
      parts.push(element('line', { x1: left, x2: left + w, y1: Y(y), y2: Y(y), class: 'grid' }), element('text', { x: left - 6, y: Y(y) + 4, 'text-anchor': 'end' }, label));
    }
    const lines = element('g', { 'clip-path': `url(#${id})` });
    for (const one of this.series.filter((one) => !one.hidden)) {
      let path = '', pen = false;
      for (let i = 0; i < one.x.length; i++) {
        const x = one.x[i], y = one.y[i] === null ? NaN : this.value(one.y[i]);
        if (x === null || !Number.isFinite(y)) { pen = false; continue; }
        if (one.marks) lines.append(element('circle', { cx: X(x), cy: Y(y), r: 3.5, fill: one.color }));
        else path += `${pen ? 'L' : 'M'}${X(x).toFixed(1)} ${Y(y).toFixed(1)}`;
        pen = true;
      }
      if (path) lines.append(element('path', { d: path, stroke: one.color, 'stroke-dasharray': one.dash, class: 'curve' }));
      if (!one.marks && one.x.length === 1 && path) lines.append(element('circle', { cx: X(one.x[0]), cy: Y(this.value(one.y[0])), r: 3, fill: one.color }));
    }
    parts.push(lines);
    parts.push(element('text', { x: left + w / 2, y: height - 6, 'text-anchor': 'middle', class: 'name' }, this.names?.x || ''));
    if (this.all.empty) parts.push(element('text', { x: left + w / 2, y: top + h / 2, 'text-anchor': 'middle' }, 'nothing to show'));
    this.cursor = element('line', { y1: top, y2: top + h, class: 'cursor', visibility: 'hidden' });
    this.band = element('rect', { class: 'band', visibility: 'hidden' });
    this.svg.replaceChildren(...parts, this.cursor, this.band);
    if (this.at !== null) this.point(this.at, false);
  }

  /** The series whose abscissae the cursor walks along. */
  walk() { return this.series.find((one) => !one.hidden && !one.marks && one.x.length) || this.series.find((one) => one.x.length); }

  /** Shows the values at a row. */
  point(row, aloud) {
    const along = this.walk();
    if (!along || !this.map) return;
    this.at = clamp(row, 0, along.x.length - 1);
    const x = along.x[this.at];
    if (x === null) return;
    const at = this.map.X(x);
    this.cursor.setAttribute('x1', at); this.cursor.setAttribute('x2', at); this.cursor.setAttribute('visibility', 'visible');
    const lines = this.series.filter((one) => !one.hidden && !one.label).map((one) => [one, one.x === along.x || one.x[this.at] === x ? this.at : one.x.indexOf(x)]).filter(([, i]) => i >= 0);
    const rows = lines.map(([one, i]) => element('div', {}, element('i', { 'data-color': one.color }), `${one.name}: ${shown(one.y[i])}`));
    rows.forEach((row) => { row.firstChild.style.background = row.firstChild.dataset.color; });
    this.tip.replaceChildren(element('b', {}, `${this.names?.x || 'x'} ${shown(x)}`), ...rows.slice(0, 14));
    this.tip.hidden = false;
    const room = this.host.clientWidth - this.tip.offsetWidth - 8;
    this.tip.style.left = `${clamp(at + 12 > room ? at - this.tip.offsetWidth - 12 : at + 12, 0, Math.max(room, 0))}px`;
    if (aloud) this.told.textContent = this.tip.innerText.replace(/\n+/g, ', ');
  }

  hide() { this.tip.hidden = true; this.at = null; this.cursor?.setAttribute('visibility', 'hidden'); }

  zoom(factor, x = null) {
    const view = this.window || this.extent();
    const middle = x ?? (view.x0 + view.x1) / 2;
    this.window = { x0: middle + (view.x0 - middle) * factor, x1: middle + (view.x1 - middle) * factor, y0: view.y0, y1: view.y1 };
    if (this.window.x1 - this.window.x0 >= (this.all || view).x1 - (this.all || view).x0) this.window = null;
    else this.fitHeight();
    this.draw();
  }

  /** The height of what is in view. */
  fitHeight() {
    const { x0, x1 } = this.window;
    let [y0, y1] = [Infinity, -Infinity];
    for (const one of this.series.filter((one) => !one.hidden)) {
      one.x.forEach((x, i) => {
        const y = one.y[i] === null ? NaN : this.value(one.y[i]);
        if (x !== null && x >= x0 && x <= x1 && Number.isFinite(y)) { y0 = Math.min(y0, y); y1 = Math.max(y1, y); }
      });
    }
    if (y1 > y0) { const pad = 0.04 * (y1 - y0); Object.assign(this.window, { y0: y0 - pad, y1: y1 + pad }); }
  }

  listen() {
    const place = (event) => {
      const box = this.svg.getBoundingClientRect(), { left, top, w, h, view } = this.map;
      const px = event.clientX - box.left, py = event.clientY - box.top;
      return { px, py, x: view.x0 + (px - left) / w * (view.x1 - view.x0), y: view.y1 - (py - top) / h * (view.y1 - view.y0) };
    };
    let from = null;
    this.svg.addEventListener('pointerdown', (event) => { if (this.map && event.button === 0) from = place(event); });
    this.svg.addEventListener('pointermove', (event) => {
      if (!this.map) return;
      const now = place(event), along = this.walk();
      if (from && event.buttons) {
        const tall = Math.abs(now.py - from.py) > 12, { top, h } = this.map;
        const set = (name, value) => this.band.setAttribute(name, value);
        set('x', Math.min(from.px, now.px)); set('width', Math.abs(now.px - from.px));
        set('y', tall ? Math.min(from.py, now.py) : top); set('height', tall ? Math.abs(now.py - from.py) : h);
        set('visibility', 'visible');
      } else if (along) {
        let best = 0;
        along.x.forEach((x, i) => { if (x !== null && Math.abs(x - now.x) < Math.abs((along.x[best] ?? Infinity) - now.x)) best = i; });
        this.point(best, false);
      }
    });
    const end = (event) => {
      if (!from || !this.map) return;
      const now = place(event), wide = Math.abs(now.px - from.px) > 6, tall = Math.abs(now.py - from.py) > 12;
      if (wide) {
        const view = this.map.view, order = (a, b) => [Math.min(a, b), Math.max(a, b)];
        const [x0, x1] = order(from.x, now.x), [y0, y1] = tall ? order(from.y, now.y) : [view.y0, view.y1];
        this.window = { x0, x1, y0, y1 };
        if (!tall) this.fitHeight();
      }
      from = null;
      this.band.setAttribute('visibility', 'hidden');
      this.draw();
    };
    this.svg.addEventListener('pointerup', end);
    this.svg.addEventListener('pointerleave', () => { if (!from) this.hide(); });
    this.svg.addEventListener('dblclick', () => this.whole());
    this.svg.addEventListener('keydown', (event) => {
      const steps = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 };
      if (event.key in steps) this.point((this.at ?? -1) + steps[event.key], true);
      else if (event.key === '+' || event.key === '-') this.zoom(event.key === '+' ? 0.5 : 2, this.at === null ? null : this.walk().x[this.at]);
      else if (event.key === '0') this.whole();
      else if (event.key === 'Escape') this.hide();
      else return;
      event.preventDefault();
    });
  }

  fillTable() {
    if (!this.table.open) return;
    const along = this.walk();
    this.table.querySelector('div')?.remove();
    if (!along) return;
    const lines = this.series.filter((one) => one.x === along.x || one.x.length === along.x.length);
    const head = element('tr', {}, element('th', { scope: 'col' }, this.names?.x || 'x'), ...lines.map((one) => element('th', { scope: 'col' }, one.name)));
    const rows = along.x.map((x, i) => element('tr', {}, element('td', { class: 'n' }, shown(x)), ...lines.map((one) => element('td', { class: 'n' }, shown(one.y[i])))));
    this.table.append(element('div', { class: 'wide tall', tabindex: 0 }, element('table', {}, element('thead', {}, head), element('tbody', {}, ...rows.slice(-2000)))));
  }
}
