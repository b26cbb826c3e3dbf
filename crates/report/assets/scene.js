// What is drawn: points, triangles and values, unpacked when they are asked for.
class Scene {
  constructor(body) {
    this.body = body;
    this.frames = body.times.length;
    this.plane = body.plane;
    this.cache = new Map();
    const of = (set, where) => (set ? set.fields.map((field) => ({ field, where: field.at_cells ? 'cell' : where })) : []);
    const contact = of(body.contacts, 'contact').filter(({ where }) => where === 'contact');
    const motion = { field: { name: 'displacement', at_cells: false, components: this.plane ? ['x', 'y'] : ['x', 'y', 'z'], values: body.body.displacement }, where: 'node' };
    const words = { node: 'at nodes', cell: 'in cells', contact: 'at contact points' };
    this.fields = [motion, ...of(body.body, 'node'), ...contact].map(({ field, where }) => {
      const vector = field.components.includes('x') || field.components.length > 1 && field.components.every((name) => ['x', 'y', 'z'].includes(name));
      const components = field.components.map((name, i) => ({ name: name || 'value', list: [i] }));
      if (vector) components.unshift({ name: 'length', list: field.components.map((_, i) => i) });
      return { name: field.name, where, words: words[where], components, packed: field.values };
    }).filter((field) => field.components.length);
  }

  async load() {
    const { body } = this;
    const whole = (set) => (set.still ? set.counts.slice(0, 1) : set.counts);
    const place = async (set) => ({
      counts: set.counts,
      starts: set.counts.map((_, i) => set.counts.slice(0, i).reduce((sum, count) => sum + count, 0)),
      still: set.still,
      reference: await Pack.together(set.reference, whole(set)),
      displacement: await Pack.together(set.displacement, set.counts),
    });
    [this.points, this.contacts, this.tools, this.triangles, this.triangleCells, this.edges] = await Promise.all([
      place(body.body), body.contacts && place(body.contacts), body.tools && place(body.tools.points),
      Pack.whole(body.triangles, 3 * body.triangle_count), Pack.whole(body.triangle_cells, body.triangle_count), Pack.whole(body.edges, 2 * body.edge_count[0]),
    ]);
    this.numbers = body.nodes && await Pack.whole(body.nodes, body.count);
    if (this.tools) {
      [this.toolLines, this.toolTriangles] = await Promise.all([
        Pack.whole(body.tools.lines, 2 * body.tools.line_count), Pack.whole(body.tools.triangles, 3 * body.tools.triangle_count)]);
    }
    const traction = body.contacts?.fields.find((field) => field.name === 'contact_traction');
    if (traction) {
      const parts = await Promise.all(traction.values.map((packed) => Pack.real(packed, body.contacts.counts)));
      const axes = ['x', 'y', 'z'].map((name) => parts[traction.components.indexOf(name)]);
      this.traction = new Float32Array(3 * parts[0].length);
      axes.forEach((axis, c) => { if (axis) for (let i = 0; i < axis.length; i++) this.traction[3 * i + c] = axis[i] || 0; });
    }
    // Everything is drawn about the middle of the bodies, so that small things far from the origin are exact.
    const box = this.box(this.points.reference);
    this.middle = box.low.map((low, a) => 0.5 * (low + box.high[a]));
    this.size = Math.max(...box.high.map((high, a) => high - box.low[a]), 1e-30);
    return this;
  }

  box(values) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < values.length; i++) {
      const a = i % 3;
      if (values[i] < low[a]) low[a] = values[i];
      if (values[i] > high[a]) high[a] = values[i];
    }
    return { low, high };
  }

  /** Tetrahedra, for cuts; nothing where they are not here. */
  async solids() {
    const { body } = this;
    if (!body.tetrahedron_count) return null;
    if (!this.tetrahedra) {
      this.tetrahedra = await Pack.whole(body.tetrahedra, 4 * body.tetrahedron_count);
      this.tetrahedronCells = await Pack.whole(body.tetrahedron_cells, body.tetrahedron_count);
    }
    return this.tetrahedra;
  }

  /** The first value of a set's frame, and how many there are. */
  span(set, frame) { return [set.starts[frame], set.counts[frame]]; }

  /** Where the points of a set are in a frame, about the middle. */
  positions(set, frame, factor) {
    const [first, count] = this.span(set, frame);
    const out = new Float32Array(3 * count), from = set.still ? 0 : 3 * first;
    for (let i = 0; i < 3 * count; i++) out[i] = set.reference[from + i] - this.middle[i % 3] + factor * set.displacement[3 * first + i];
    return out;
  }

  /** Values of a field in all frames: `{ values, counts, starts }`; the length of a vector is made here. */
  async values(field, component) {
    const key = `${field.where} ${field.name} ${component.name}`;
    if (!this.cache.has(key)) {
      const set = field.where === 'contact' ? this.body.contacts : this.body.body;
      const counts = field.where === 'cell' ? set.cell_counts : set.counts;
      const parts = await Promise.all(component.list.map((i) => Pack.real(field.packed[i], counts)));
      let values = parts[0];
      if (component.name === 'length') values = values.map((_, i) => Math.hypot(...parts.map((part) => part[i])));
      if (this.cache.size > 12) this.cache.delete(this.cache.keys().next().value);
      this.cache.set(key, { values, counts, starts: counts.map((_, i) => counts.slice(0, i).reduce((sum, count) => sum + count, 0)) });
    }
    return this.cache.get(key);
  }

  /** The number of a node in the mesh, and its place here. */
  number(place) { return this.numbers ? this.numbers[place] : place; }
  place(number) {
    const place = this.numbers ? this.numbers.indexOf(number) : number;
    return Number.isInteger(place) && place >= 0 && place < this.body.count ? place : null;
  }

  /** Whether a cell of the mesh is here, and its nodes by their places. */
  hasCell(number) { return !this.numbers && number < this.body.cell_count; }
  async cellNodes(number) {
    const found = new Set();
    const look = (cells, nodes, each) => cells.forEach((cell, i) => { if (cell === number) for (let k = 0; k < each; k++) found.add(nodes[each * i + k]); });
    look(this.triangleCells, this.triangles, 3);
    if (!found.size && await this.solids()) look(this.tetrahedronCells, this.tetrahedra, 4);
    return [...found];
  }
}
