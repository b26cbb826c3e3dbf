// The page: controls, and what they do.
class Page {
  constructor() {
    this.written = DATA.body?.written ?? 0;
    const theme = $('theme');
    theme.addEventListener('change', () => setTheme(theme.value));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => onColors.forEach((call) => call()));
    // Paper is white; the picture is drawn anew for it.
    addEventListener('beforeprint', () => { setTheme('light'); this.view?.paint(); });
    addEventListener('afterprint', () => setTheme(theme.value));
    this.curves = new Curves();
    this.controls();
    this.ready = this.open();
    if (DATA.live) this.live = new Live(this);
  }

  /** Shows the body, where there is one. */
  async open() {
    const none = (text) => { $('no-view').textContent = text; $('no-view').hidden = false; $('viewer').hidden = true; };
    if (!DATA.body) { none('No frame was written.'); return; }
    try {
      const scene = await new Scene(DATA.body).load();
      $('viewer').hidden = false;
      if (this.canvas) {
        // A canvas keeps its context; a new scene gets a new one.
        const fresh = this.canvas.cloneNode();
        this.canvas.replaceWith(fresh);
        this.pointers(fresh);
      }
      this.canvas = $('canvas');
      this.scene = scene;
      this.view = new View(scene, this.canvas, $('overlay'));
    } catch (error) {
      none(`The body cannot be shown: ${error.message}.`);
      return;
    }
    const { scene, view } = this;
    const option = (field, value) => element('option', { value }, `${field.name} ${field.words}`);
    const kept = $('quantity').selectedOptions[0]?.text;
    $('quantity').replaceChildren(...scene.fields.map(option));
    const find = (text) => [...$('quantity').options].findIndex((option) => option.text === text);
    const first = [kept, 'von_mises_averaged at nodes', 'displacement at nodes'].map(find).find((i) => i >= 0) ?? 0;
    $('quantity').value = String(first);
    $('frame').max = String(scene.frames - 1);
    $('frame').value = $('frame').max;
    $('mesh').checked = scene.triangles.length < 150000;
    ['sides', 'cutting'].forEach((id) => { $(id).hidden = scene.plane; });
    $('vectors').closest('label').hidden = $('vector-length').closest('label').hidden = !scene.traction;
    $('tools').closest('label').hidden = !scene.tools;
    this.quantity();
    this.options();
    await this.show();
    view.fit();
    this.reason();
  }

  /** A button that leads to the node or cell which the reason of a failure names. */
  reason() {
    const named = /\b(node|cell) (\d+)\b/.exec(DATA.reason || '');
    if (!named || $('to-reason') || (named[1] === 'cell' && !this.scene.hasCell(Number(named[2])))) return;
    const button = element('button', { type: 'button', id: 'to-reason' }, `show ${named[0]}`);
    button.addEventListener('click', () => (named[1] === 'node' ? this.goToNode(Number(named[2])) : this.goToCell(Number(named[2]))));
    $('reason').append(' ', button);
  }

  /** Listens to the controls; they are there once. */
  controls() {
    const on = (id, kind, call) => $(id).addEventListener(kind, call);
    on('quantity', 'change', () => { this.quantity(); this.show(); });
    on('component', 'change', () => this.show());
    on('range', 'change', () => this.show());
    ['least', 'greatest'].forEach((id) => on(id, 'change', () => { $('range').value = 'own'; this.show(); }));
    ['bands', 'mesh', 'vectors', 'tools'].forEach((id) => on(id, 'change', () => this.options()));
    ['vector-length', 'clip-at'].forEach((id) => on(id, 'input', () => this.options()));
    ['clip', 'clip-flip'].forEach((id) => on(id, 'change', () => this.options()));
    on('frame', 'input', () => this.show());
    on('factor', 'change', () => { this.view.factor = typed($('factor').value) ?? 1; $('factor').value = String(this.view.factor); this.view.fit(); });
    on('back', 'click', () => this.step(-1));
    on('forth', 'click', () => this.step(1));
    on('play', 'click', () => this.play());
    on('fit', 'click', () => { this.view.mark = null; this.view.fit(); });
    on('nearer', 'click', () => this.view.zoom(0.7));
    on('farther', 'click', () => this.view.zoom(1 / 0.7));
    document.querySelectorAll('[data-side]').forEach((button) => button.addEventListener('click', () => this.view.side(button.dataset.side)));
    on('node', 'change', () => this.goToNode(typed($('node').value), false));
    on('unpick', 'click', () => this.pick(null));
    on('save', 'click', () => this.save());
    document.querySelectorAll('.show').forEach((button) => button.addEventListener('click', () => this.goToWorst(button.dataset.figure)));
    this.pointers($('canvas'));
  }

  /** The components of the quantity. */
  quantity() {
    const field = this.scene.fields[Number($('quantity').value)];
    $('component').replaceChildren(...field.components.map((component, i) => element('option', { value: i }, component.name)));
    $('component').closest('label').hidden = field.components.length < 2;
    if ($('range').value === 'own') $('range').value = 'frame';
  }

  async options() {
    const { view, scene } = this;
    if (!view) return;
    Object.assign(view, { bands: $('bands').checked ? 10 : 0, mesh: $('mesh').checked, vectors: $('vectors').checked, showTools: $('tools').checked, stretch: 10 ** Number($('vector-length').value) });
    view.clip = $('clip').value && !scene.plane ? { axis: $('clip').value, at: Number($('clip-at').value), flip: $('clip-flip').checked } : null;
    if (view.clip) await scene.solids();
    this.colors();
    view.draw();
  }

  /** Shows the quantity, component and frame that the controls say. */
  async show() {
    const { scene, view } = this;
    if (!view) return;
    const field = scene.fields[Number($('quantity').value)], component = field.components[Number($('component').value)] || field.components[0];
    const list = await scene.values(field, component);
    const frame = Number($('frame').value);
    // Another choice may have been made meanwhile.
    if (scene !== this.scene || field !== scene.fields[Number($('quantity').value)]) return;
    this.list = list;
    this.name = field.components.length > 1 ? `${field.name} ${component.name}` : field.name;
    view.setFrame(frame, field, list);
    const values = $('range').value === 'all' ? list.values : view.now;
    let [low, high, least, most] = [Infinity, -Infinity, 0, 0];
    for (let i = 0; i < values.length; i++) {
      if (values[i] < low) { low = values[i]; least = i; }
      if (values[i] > high) { high = values[i]; most = i; }
    }
    if (!(low <= high)) [low, high] = [0, 0];
    if ($('range').value === 'own') {
      low = typed($('least').value) ?? low; high = typed($('greatest').value) ?? high;
    }
    view.range = [low, high];
    $('least').value = shown(low).replace('–', '0'); $('greatest').value = shown(high).replace('–', '0');
    const time = `time ${shown(scene.body.times[frame])}, frame ${frame + 1} of ${scene.frames}`;
    $('when').textContent = scene.body.written > scene.frames ? `${time} (${scene.body.written} were written)` : time;
    $('frame').setAttribute('aria-valuetext', time);
    const at = { node: (i) => `node ${scene.number(i)}`, cell: (i) => `cell ${i}`, contact: (i) => `contact point ${i}` }[field.where];
    if (!this.timer && $('range').value === 'frame') $('view-told').textContent = `${this.name}: least ${shown(low)} at ${at(least)}, greatest ${shown(high)} at ${at(most)}`;
    else if (!this.timer) $('view-told').textContent = `${this.name}: from ${shown(low)} to ${shown(high)}`;
    this.colors();
    this.history();
  }

  /** The scale beside the picture. */
  colors() {
    const canvas = $('scale-colors'), brush = canvas.getContext('2d'), [low, high] = this.view.range, bands = this.view.bands;
    for (let y = 0; y < 256; y++) {
      let t = 1 - y / 255;
      if (bands) t = (Math.min(Math.floor(t * bands), bands - 1) + 0.5) / bands;
      brush.fillStyle = DATA.colors[Math.round(t * (DATA.colors.length - 1))];
      brush.fillRect(0, y, 1, 1);
    }
    const marks = high > low ? ticks(low, high, 6) : [low];
    $('scale-ticks').replaceChildren(...marks.map((value) => {
      const mark = element('span', {}, shown(Number(value.toPrecision(10))));
      mark.style.bottom = `${high > low ? 100 * (value - low) / (high - low) : 50}%`;
      return mark;
    }));
    $('canvas').setAttribute('aria-label', `Picture of the body: ${this.name || ''} from ${shown(low)} to ${shown(high)}, ${$('when').textContent}`);
  }

  step(by) {
    const next = Number($('frame').value) + by;
    $('frame').value = String(clamp(next, 0, this.scene.frames - 1));
    return this.show();
  }

  play() {
    const stop = () => { clearInterval(this.timer); this.timer = null; $('play').textContent = 'play'; $('play').setAttribute('aria-pressed', 'false'); this.show(); };
    if (this.timer) { stop(); return; }
    if (Number($('frame').value) === this.scene.frames - 1) $('frame').value = '0';
    $('play').textContent = 'stop'; $('play').setAttribute('aria-pressed', 'true');
    this.timer = setInterval(() => { this.step(1); if (Number($('frame').value) >= this.scene.frames - 1) stop(); }, clamp(4000 / this.scene.frames, 40, 400));
  }

  pick(place) {
    this.view.picked = place;
    $('node').value = place === null ? '' : String(this.scene.number(place));
    this.view.draw();
    this.history();
  }

  goToNode(number, far = true) {
    const place = number === null ? null : this.scene.place(number);
    if (place === null) {
      $('view-told').textContent = number === null ? 'No node is picked.' : `There is no node ${number} here.`;
      this.pick(null);
      return;
    }
    this.pick(place);
    if (far) { this.view.goTo(this.view.nodeAt(place)); $('body').scrollIntoView(); }
  }

  async goToCell(number) {
    const nodes = (await this.scene.cellNodes(number)).map((place) => this.view.nodeAt(place));
    this.view.mark = [0, 1, 2].map((a) => nodes.reduce((sum, p) => sum + p[a], 0) / nodes.length);
    this.view.goTo(this.view.mark);
    $('view-told').textContent = `Cell ${number} is at the ring.`;
    $('body').scrollIntoView();
  }

  goToWorst(name) {
    const worst = DATA.worst.find((one) => one.name === name);
    if (!worst || !this.view) return;
    const times = this.scene.body.times, near = times.reduce((best, time, i) => (Math.abs(time - worst.time) < Math.abs(times[best] - worst.time) ? i : best), 0);
    $('frame').value = String(near);
    this.show().then(() => {
      this.view.mark = worst.position.map((x, a) => x - this.scene.middle[a]);
      this.view.goTo(this.view.mark);
      $('body').scrollIntoView();
      const exact = Math.abs(times[near] - worst.time) <= 1e-9 * Math.abs(worst.time);
      $('view-told').textContent = `${worst.words} was worst at the ring, at time ${shown(worst.time)}${exact ? '' : '; the nearest frame is shown'}.`;
    });
  }

  /** Values of the picked node over the frames. */
  history() {
    const { scene, view } = this, place = view.picked;
    $('picked').hidden = place === null;
    if (place === null) return;
    const number = scene.number(place), { starts } = scene.points, frame = view.frame;
    $('picked-heading').textContent = `Node ${number}`;
    const axes = DATA.space === 'axisymmetric' ? ['r', 'z'] : scene.plane ? ['x', 'y'] : ['x', 'y', 'z'];
    const before = axes.map((_, a) => scene.points.reference[3 * ((scene.points.still ? 0 : starts[frame]) + place) + a]);
    const moved = axes.map((_, a) => scene.points.displacement[3 * (starts[frame] + place) + a]);
    const nodal = view.field.where === 'node', value = (f) => (nodal ? this.list.values[this.list.starts[f] + place] : NaN);
    const rows = [['', ...axes], ['before any motion', ...before], ['displacement', ...moved], ['now', ...before.map((x, a) => x + moved[a])]];
    $('picked-values').replaceChildren(...rows.map(([name, ...list], i) => element('tr', {}, element('th', { scope: i ? 'row' : 'col' }, name), ...list.map((x) => element(i ? 'td' : 'th', { class: 'n' }, i ? shown(x) : x)))));
    const times = scene.body.times, series = nodal
      ? [{ name: this.name, x: times, y: times.map((_, f) => value(f)) }]
      : axes.map((axis, a) => ({ name: `displacement ${axis}`, x: times, y: times.map((_, f) => scene.points.displacement[3 * (starts[f] + place) + a]) }));
    this.nodeChart ||= new Chart($('node-chart'), 'History of the node');
    this.nodeChart.update(series, { x: 'time' }, false);
    $('view-told').textContent = `node ${number}: ${nodal ? `${this.name} ${shown(value(frame))}` : `displacement ${moved.map(shown).join(', ')}`}`;
  }

  save() {
    this.view.paint();
    this.canvas.toBlob((blob) => {
      const link = element('a', { href: URL.createObjectURL(blob), download: 'body.png' });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }

  /** Mouse, fingers and keys on the picture. */
  pointers(canvas) {
    const fingers = new Map();
    let [from, moved] = [null, false];
    const local = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener('pointerdown', (event) => {
      fingers.set(event.pointerId, local(event));
      canvas.setPointerCapture?.(event.pointerId);
      [from, moved] = [local(event), false];
    });
    canvas.addEventListener('pointermove', (event) => {
      const old = fingers.get(event.pointerId);
      if (!old || !this.view) return;
      const now = local(event), d = [now[0] - old[0], now[1] - old[1]];
      if (!moved && Math.hypot(now[0] - from[0], now[1] - from[1]) < 4) return;
      moved = true;
      const others = [...fingers].filter(([id]) => id !== event.pointerId);
      fingers.set(event.pointerId, now);
      if (others.length) {
        const [, other] = others[0], gap = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        this.view.zoom(gap(old) / Math.max(gap(now), 1), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
        this.view.move(d[0] / 2, d[1] / 2);
      } else if (this.scene.plane || event.shiftKey || event.buttons & 6) this.view.move(...d);
      else this.view.turn(d[0] / 150, d[1] / 150);
    });
    const up = (event) => {
      fingers.delete(event.pointerId);
      if (!moved && from && event.type === 'pointerup' && event.button === 0 && this.view) this.pick(this.view.pick(...from));
      from = null;
    };
    ['pointerup', 'pointercancel'].forEach((kind) => canvas.addEventListener(kind, up));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    // The wheel scrolls the page until the picture has been clicked.
    canvas.addEventListener('wheel', (event) => {
      if (document.activeElement !== canvas || !this.view) return;
      event.preventDefault();
      this.view.zoom(Math.exp(clamp(event.deltaY, -200, 200) / 400), ...local(event));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const turn = (x, y) => (this.scene.plane || event.shiftKey ? this.view.move(60 * x, 60 * y) : this.view.turn(0.15 * x, 0.15 * y));
      const keys = {
        ArrowLeft: () => turn(-1, 0), ArrowRight: () => turn(1, 0), ArrowUp: () => turn(0, -1), ArrowDown: () => turn(0, 1),
        '+': () => this.view.zoom(0.8), '-': () => this.view.zoom(1.25), 0: () => this.view.fit(), ',': () => this.step(-1), '.': () => this.step(1),
        Escape: () => this.pick(null),
      };
      if (!this.view || !(event.key in keys) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}
const page = new Page();
page.ready.then(() => { document.documentElement.dataset.ready = String(Math.round(performance.now())); });
