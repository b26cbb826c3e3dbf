// Curves of the tables, and the table of attempts.
const column = (table, name) => table.columns[table.header.indexOf(name)] || [];

/** Groups of columns that are shown together. */
const PRESETS = [
  ['contact force', (name) => /^contact\..*\.force\./.test(name)],
  ['contact area, pressure and penetration', (name) => /^contact\..*\.(area|max_pressure|max_penetration)$/.test(name)],
  ['contact points by status', (name) => /^contact\..*\.(stick|slip)$/.test(name)],
  ['reactions', (name) => name.startsWith('reaction.')],
  ['displacements of groups', (name) => name.startsWith('displacement.')],
  ['motion of tools', (name) => /^tool\..*\.(translation|rotation)\./.test(name)],
  ['forces and moments of tools', (name) => /^tool\..*\.(force|moment)\./.test(name)],
  ['energies', (name) => name.startsWith('energy.')],
  ['all columns', () => true],
];
const LEADING = new Set(['time', 'step', 'increment']);

class Curves {
  constructor() {
    this.chart = new Chart($('history-chart'), 'History of the run');
    this.energy = new Chart($('energy-chart'), 'Energies over time');
    this.audit = new Chart($('audit-chart'), 'Audit and equilibrium over time');
    this.size = new Chart($('size-chart'), 'Length and iterations of attempts');
    this.residual = new Chart($('residual-chart'), 'Unbalanced force over iterations');
    this.chosen = new Set();
    this.options();
    ['preset', 'abscissa', 'log'].forEach((id) => $(id).addEventListener('change', () => { if (id === 'preset') this.take(); this.refresh(); }));
    $('search').addEventListener('input', () => this.boxes());
    $('none').addEventListener('click', () => { this.chosen.clear(); this.boxes(); this.refresh(); });
    $('only-cuts').addEventListener('change', () => this.attempts());
    $('which').addEventListener('change', () => this.iterations());
    this.refresh();
  }

  /** Fills what can be chosen; again when a table has got its first rows. */
  options() {
    const names = DATA.history.header;
    this.known = names.length;
    const option = (value) => element('option', { value }, value);
    const there = PRESETS.filter(([, is]) => names.some((name) => !LEADING.has(name) && is(name)));
    $('preset').replaceChildren(...there.map(([name]) => option(name)));
    $('abscissa').replaceChildren(...names.map(option));
    this.take();
  }

  take() {
    const preset = PRESETS.find(([name]) => name === $('preset').value);
    this.chosen = new Set(preset ? DATA.history.header.filter((name) => !LEADING.has(name) && preset[1](name)) : []);
    this.boxes();
  }

  boxes() {
    const wanted = $('search').value.toLowerCase(), legend = element('legend', {}, 'Columns of history.csv');
    const names = DATA.history.header.filter((name) => !LEADING.has(name) && name.toLowerCase().includes(wanted));
    $('columns').replaceChildren(legend, ...names.map((name) => {
      const box = element('input', { type: 'checkbox', checked: this.chosen.has(name) });
      box.addEventListener('change', () => { this.chosen[box.checked ? 'add' : 'delete'](name); this.refresh(); });
      return element('label', {}, box, ` ${name}`);
    }));
  }

  refresh() {
    const { history, increments } = DATA;
    if (history.header.length !== this.known) this.options();
    const x = column(history, $('abscissa').value), time = column(history, 'time');
    const series = (names, along) => names.map((name) => ({ name, x: along, y: column(history, name) }));
    const log = $('log').checked;
    this.chart.update(series([...this.chosen], x), { x: $('abscissa').value }, log);
    const named = (start) => history.header.filter((name) => name.startsWith(start) && column(history, name).some((value) => value));
    this.energy.update(series(named('energy.'), time), { x: 'time' }, false);
    this.audit.update(series([...named('audit.'), ...named('equilibrium.')], time), { x: 'time' }, true);
    const number = column(increments, 'increment').map((_, i) => i + 1), cut = column(increments, 'accepted').map((yes) => !yes);
    const only = (list, is) => list.filter((_, i) => is(i));
    const good = (i) => !cut[i], bad = (i) => cut[i], dt = column(increments, 'dt');
    this.size.update([
      { name: 'length of the increment', x: number, y: dt },
      { name: 'cut', x: only(number, bad), y: only(dt, bad), marks: true, label: true },
      { name: 'iterations', x: number, y: column(increments, 'iterations') },
      ...(number.some((_, i) => good(i)) ? [] : [{ name: 'none was accepted', x: [], y: [] }]),
    ], { x: 'attempt' }, true);
    this.attempts();
    const choice = $('which'), held = choice.value, list = [...new Set(column(DATA.iterations, 'increment'))];
    choice.replaceChildren(...list.map((value) => element('option', { value }, String(value))));
    choice.value = this.pinned && list.includes(Number(held)) ? held : String(list[list.length - 1] ?? '');
    choice.onchange = () => { this.pinned = true; };
    this.iterations();
  }

  attempts() {
    const { increments } = DATA, only = $('only-cuts').checked;
    const names = ['increment', 'attempt', 'time', 'dt', 'iterations', 'residual', 'open', 'stick', 'slip', 'reason'].filter((name) => increments.header.includes(name));
    const columns = names.map((name) => column(increments, name)), cut = column(increments, 'accepted').map((yes) => !yes);
    let rows = cut.map((_, i) => i).filter((i) => !only || cut[i]);
    const told = rows.length > 1000 ? element('p', {}, `the last 1000 of ${rows.length}`) : '';
    rows = rows.slice(-1000);
    const line = (i) => element('tr', { class: cut[i] ? 'cut' : null }, ...columns.map((list, c) => element('td', { class: names[c] === 'reason' ? 'why' : 'n' }, names[c] === 'reason' ? (list[i] ?? '') : shown(list[i]))));
    const head = element('tr', {}, ...names.map((name) => element('th', { scope: 'col' }, name)));
    $('increments').replaceChildren(told, rows.length ? element('table', {}, element('thead', {}, head), element('tbody', {}, ...rows.map(line))) : element('p', {}, only ? 'Nothing was cut.' : 'There is none yet.'));
  }

  iterations() {
    const table = DATA.iterations, wanted = Number($('which').value), increment = column(table, 'increment');
    const rows = increment.map((_, i) => i).filter((i) => increment[i] === wanted);
    const attempts = [...new Set(rows.map((i) => column(table, 'attempt')[i]))];
    const pick = (name, attempt) => rows.filter((i) => column(table, 'attempt')[i] === attempt).map((i) => column(table, name)[i]);
    const series = attempts.map((attempt) => ({ name: `attempt ${attempt}`, x: pick('iteration', attempt), y: pick('residual', attempt) }));
    if (series.length) {
      const last = Math.max(...series.flatMap((one) => one.x), 1), tolerance = column(table, 'tolerance')[rows[rows.length - 1]];
      series.push({ name: 'tolerance', x: [0, last], y: [tolerance, tolerance], color: '#888888', label: true });
    }
    this.residual.update(series, { x: 'iteration' }, true);
  }
}
